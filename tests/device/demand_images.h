/** The texels of a demand scene: array images of tiles, and an ordinary image of the same texels.
 */
#ifndef TESTS_DEVICE_DEMAND_IMAGES_H
#define TESTS_DEVICE_DEMAND_IMAGES_H

#include "device/demand_scene.h"

/** Called by demand_scene_init, _finish and _clear. */
void demand_images_init(struct demand_scene *s);
void demand_images_finish(struct demand_scene *s);
void demand_images_clear(struct demand_scene *s);

/** What a texel is, by a hash: k / 255, as the format has it. */
void demand_texel(const struct demand_scene *s, uint32_t index, uint32_t level, uint32_t x,
                  uint32_t y, float rgba[4]);

/** Gives each page of a texture that `wanted` names (NULL: all) a layer with its texels. */
void demand_images_load(struct demand_scene *s, uint32_t index,
                        bool (*wanted)(void *user, uint32_t page), void *user);
/** Copies the tiles to the device. */
void demand_images_upload(struct demand_scene *s);

/** An ordinary image with the same texels, and its trilinear sampler, for DEMAND_HARDWARE. */
void demand_images_plain(struct demand_scene *s, uint32_t index);
void demand_images_plain_finish(struct demand_scene *s);

#endif /* TESTS_DEVICE_DEMAND_IMAGES_H */
