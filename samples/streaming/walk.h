/** Path through the gallery: equal in every run, and at rest in the end. */
#ifndef SAMPLES_STREAMING_WALK_H
#define SAMPLES_STREAMING_WALK_H

#include "camera.h"
#include "room.h"

#define WALK_FIELD_OF_VIEW 0.95f ///< vertical, radians

/** Returns the camera at `progress`, from 0 at the entrance to 1 at the end. */
struct camera walk_camera(const struct room *room, float progress);

#endif /* SAMPLES_STREAMING_WALK_H */
