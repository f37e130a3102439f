/** Cameras as matrices to the world, and what lies between two of them. No device. */
#ifndef DEMAND_PBRT_CAMERA_PATH_H
#define DEMAND_PBRT_CAMERA_PATH_H

#include <stdbool.h>

/** A camera that --look-from or --fly-from names. */
struct camera_view {
    float eye[3], look[3], up[3];
    bool given, has_up;
};

/**
 * The matrix of a camera at `eye` that looks at a point. Without an up vector, up is that of
 * `like`. The lengths of the axes, and whether pictures are mirrored, are those of `like`, too.
 */
void camera_look_at(const struct camera_view *view, const float like[12], float matrix[12]);

/** The matrix at a share, 0 to 1, of the way: straight on, turning evenly the shorter way around.
 *  The lengths of the axes, and whether pictures are mirrored, are those of `to`. */
void camera_between(const float from[12], const float to[12], float share, float matrix[12]);

#endif /* DEMAND_PBRT_CAMERA_PATH_H */
