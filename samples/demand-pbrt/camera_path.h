/** Cameras as matrices to the world, and interpolation between two of them. Needs no device. */
#ifndef DEMAND_PBRT_CAMERA_PATH_H
#define DEMAND_PBRT_CAMERA_PATH_H

#include <stdbool.h>

/** A camera given by --look-from or --fly-from. */
struct camera_view {
    float eye[3], look[3], up[3];
    bool given, has_up;
};

/**
 * Computes the matrix of a camera at `eye` that looks at a point. Takes the up vector from `like`
 * if none is given. Takes the lengths of the axes, and mirroring, from `like`.
 */
void camera_look_at(const struct camera_view *view, const float like[12], float matrix[12]);

/** Interpolates between two matrices by `share`, 0 to 1. Moves straight, and turns evenly the
 * shorter way around. Takes the lengths of the axes, and mirroring, from `to`. */
void camera_between(const float from[12], const float to[12], float share, float matrix[12]);

#endif /* DEMAND_PBRT_CAMERA_PATH_H */
