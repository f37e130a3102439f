/** Camera of the gallery. */
#ifndef SAMPLES_STREAMING_CAMERA_H
#define SAMPLES_STREAMING_CAMERA_H

#include "../common/vecmath.h"

struct camera {
    struct vec3 eye, target;
};

#endif /* SAMPLES_STREAMING_CAMERA_H */
