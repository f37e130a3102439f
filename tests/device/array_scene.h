/** A scene whose first textures are the layers of one array, each of another pattern. */
#ifndef TESTS_DEVICE_ARRAY_SCENE_H
#define TESTS_DEVICE_ARRAY_SCENE_H

#include "device/scene.h"

#define ARRAY_LAYERS 3u

struct array_scene {
    struct scene scene; ///< textures[i] is layer i
    SluiceImageSource *layers[ARRAY_LAYERS], *source;
};

/** The pattern of a layer: neighbors differ. */
enum pattern_kind array_scene_kind(uint32_t layer);

/**
 * Adds an array of `layer_count` layers. Returns false if it is refused, which is correct only if
 * sparse images of the device have one tail for all layers.
 */
bool array_scene_add(struct scene *scene, SluiceImageSource *source, uint32_t layer_count,
                     SluiceVulkanTexture *textures);

/** Creates the scene with the patterns of array_scene_kind, or with PATTERN_LEVEL for all layers.
 * Returns false if the array is refused, as above. */
bool array_scene_init(struct array_scene *a, struct harness *h, SluiceVulkanStreamerCreateInfo info,
                      bool mixed, const uint32_t size[2], SluiceFormat format);
/** Call also after array_scene_init returned false. */
void array_scene_finish(struct array_scene *a);

#endif /* TESTS_DEVICE_ARRAY_SCENE_H */
