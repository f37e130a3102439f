/** Texels of a demand scene: array images of tiles, and an ordinary image with equal texels. */
#ifndef TESTS_DEVICE_DEMAND_IMAGES_H
#define TESTS_DEVICE_DEMAND_IMAGES_H

#include "device/demand_scene.h"

/** Called by demand_scene_init, _finish and _clear. */
void demand_images_init(struct demand_scene *s);
void demand_images_finish(struct demand_scene *s);
void demand_images_clear(struct demand_scene *s);

/** Computes a texel by a hash: k / 255, converted to the format. */
void demand_texel(const struct demand_scene *s, uint32_t index, uint32_t level, uint32_t x,
                  uint32_t y, float rgba[4]);

/** Gives each page of a texture that `wanted` selects (NULL: all) a layer with its texels. */
void demand_images_load(struct demand_scene *s, uint32_t index,
                        bool (*wanted)(void *user, uint32_t page), void *user);
/** Copies the tiles to the device. */
void demand_images_upload(struct demand_scene *s);

/** Creates an ordinary image with equal texels, and its trilinear sampler, for DEMAND_HARDWARE. */
void demand_images_plain(struct demand_scene *s, uint32_t index);
void demand_images_plain_finish(struct demand_scene *s);

#endif /* TESTS_DEVICE_DEMAND_IMAGES_H */
