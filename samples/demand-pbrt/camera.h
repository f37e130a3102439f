/** Camera and film of a scene, as constants of a launch. */
#ifndef DEMAND_PBRT_CAMERA_H
#define DEMAND_PBRT_CAMERA_H

#include "camera_path.h"
#include "options.h"
#include "pbrt_shared.h"
#include "scene.h"

/** Computes the picture's size: --dim, or the rendered part of the film. */
void camera_size(const struct scene *scene, const struct pbrt_options *options, uint32_t size[2]);

/** Computes the matrix from camera space to the world, for the given view or else the scene's
 * camera. */
void camera_matrix(const struct scene *scene, const struct camera_view *view, float matrix[12]);

/** Sets the members for the origins and directions of rays. */
void camera_constants(const struct scene *scene, const float matrix[12], const uint32_t size[2],
                      struct PbrtLaunch *constants);

#endif /* DEMAND_PBRT_CAMERA_H */
