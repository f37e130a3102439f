/** Opens the images of a scene. */
#ifndef SLUICE_VIEW_SCENE_IMAGES_H
#define SLUICE_VIEW_SCENE_IMAGES_H

#include "scene_data.h"

struct scene_image_request {
    const char *name; ///< for people
    const char *path;
    int wrap_u, wrap_v;
    enum scene_content content;
    bool is_srgb; ///< colors are sRGB, whatever the file says
};

/** `cache`: folder for baked pictures and for images that lie inside other files. */
bool scene_images_create_opener(const char *cache, struct scene_data *scene);
/** The index of an image, opened once; SCENE_NO_IMAGE and a note if it cannot be. scene->images has
 *  room for it. */
uint32_t scene_images_add(struct scene_data *scene, const struct scene_image_request *request);
/** Puts a gray image in the place of one that the device cannot stream, and names that one.
 * Materials with its colors show a checkerboard. */
bool scene_images_replace(struct scene_data *scene, uint32_t index, SluiceResult why);
/** Pictures whose finer levels are still being made. */
uint32_t scene_images_baking(const struct scene_data *scene);
/** Pictures without tiles are baked in the background; what waits for them is the same in each
 *  run. */
void scene_images_wait(const struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_IMAGES_H */
