/** The camera and the film of a scene, as constants of a launch. */
#ifndef DEMAND_PBRT_CAMERA_H
#define DEMAND_PBRT_CAMERA_H

#include "camera_path.h"
#include "options.h"
#include "pbrt_shared.h"
#include "scene.h"

/** Pixels of the picture: --dim, or the part of the film that is rendered. */
void camera_size(const struct scene *scene, const struct pbrt_options *options, uint32_t size[2]);

/** From camera space to the world: a view that was given, or else the scene's camera. */
void camera_matrix(const struct scene *scene, const struct camera_view *view, float matrix[12]);

/** Sets the members that say where rays begin and where they go. */
void camera_constants(const struct scene *scene, const float matrix[12], const uint32_t size[2],
                      struct PbrtLaunch *constants);

#endif /* DEMAND_PBRT_CAMERA_H */
