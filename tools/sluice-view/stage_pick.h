/** Finds the surface under a pixel, and the texels per pixel. */
#ifndef SLUICE_VIEW_STAGE_PICK_H
#define SLUICE_VIEW_STAGE_PICK_H

#include "scene_data.h"
#include "stage.h"

/** Finds the surface at x, y; see stage_pick. */
struct stage_pick scene_pick(const struct scene_data *scene, const struct view_camera *camera,
                             float aspect, float x, float y);
/** Writes the offsets of stage_pick_pixel in UV units instead of texels. */
bool scene_pick_pixel(const struct scene_data *scene, const struct stage_pick *pick,
                      const struct stage_pixel *pixel, float parts[4]);
/** Finds a point of a surface that shows an image at u, v; see stage_find_texel. */
bool scene_find_texel(const struct scene_data *scene, uint32_t image, float u, float v,
                      struct vec3 *position, struct vec3 *normal);

#endif /* SLUICE_VIEW_STAGE_PICK_H */
