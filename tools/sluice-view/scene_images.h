/** Opens the images of a scene. */
#ifndef SLUICE_VIEW_SCENE_IMAGES_H
#define SLUICE_VIEW_SCENE_IMAGES_H

#include "scene_data.h"

struct scene_image_request {
    const char *name; ///< name shown to the user
    const char *path;
    int wrap_u, wrap_v;
    enum scene_content content;
    bool is_srgb; ///< colors are sRGB, whatever the file says
};

/** Creates the opener. `cache`: folder for baked pictures and for images inside other files. */
bool scene_images_create_opener(const char *cache, struct scene_data *scene);
/** Opens an image, unless it is open, and returns its index. SCENE_NO_IMAGE, with a note, if it
 * cannot be opened. scene->images must have room. */
uint32_t scene_images_add(struct scene_data *scene, const struct scene_image_request *request);
/** Replaces an image that the device cannot stream by a gray one, and reports it. Materials with
 * its colors show a checkerboard. */
bool scene_images_replace(struct scene_data *scene, uint32_t index, SluiceResult why);
/** Number of pictures whose finer levels are still being baked. */
uint32_t scene_images_baking(const struct scene_data *scene);
/** Waits until all pictures are baked. Makes runs equal, since baking runs in the background. */
void scene_images_wait(const struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_IMAGES_H */
