/** The room: pictures on both walls, and a tour past them. */
#ifndef SLUICE_VIEW_SCENE_ROOM_H
#define SLUICE_VIEW_SCENE_ROOM_H

#include "scene_data.h"

/** Allocates memory of a zeroed scene for `panels` pictures. False without memory. */
bool scene_room_allocate(struct scene_data *scene, const char *name, uint32_t panels);
/** Hangs images of the scene with their proportions, and completes the scene. SCENE_NO_IMAGE hangs
 * a checkerboard. False without memory. */
bool scene_room_hang(struct scene_data *scene, const uint32_t *images, uint32_t panels);

#endif /* SLUICE_VIEW_SCENE_ROOM_H */
