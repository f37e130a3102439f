/**
 * Images and samplers of all textures by table index, for shaders that choose a texture by a
 * number. Every element is valid: a place without a texture shows an image of one texel.
 *
 * Cube maps have an array of their own, of cube views. The place of a cube is the table index of
 * its first face divided by 6: faces have consecutive indices, so no two cubes have one place.
 */
#ifndef SLC_VULKAN_TEXTURE_ARRAY_H
#define SLC_VULKAN_TEXTURE_ARRAY_H

#include "vulkan/samplers.h"

#define SLC_TEXTURE_ARRAY_BINDINGS 3u

struct slc_texture_element {
    VkImageView view;
    VkSampler sampler;
    uint64_t generation; ///< of the array, in which it changed last
};

/** A zeroed one has no elements. */
struct slc_texture_array {
    SluiceTextureArray kind;
    struct slc_texture_element *elements; ///< owned; `count`, then `cube_count`
    uint32_t count, cube_count;
    uint64_t generation;                 ///< more with each change; counts from 1
    VkImageView empty, empty_cube;       ///< owned
    VkSampler empty_sampler;             ///< borrowed
    const struct slc_samplers *samplers; ///< borrowed; those of the textures
};

/**
 * Shows `image`, of six layers and one level, with `sampler` where no texture is. The image is
 * compatible with cube views. Both, and `samplers`, must outlive the array. After an error it can
 * be finished.
 *
 * Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SluiceResult slc_texture_array_init(struct slc_texture_array *array, const struct slc_vk *vk,
                                    const SluiceAllocationCallbacks *cb, SluiceTextureArray kind,
                                    uint32_t count, VkImage image, VkSampler sampler,
                                    const struct slc_samplers *samplers);
void slc_texture_array_finish(struct slc_texture_array *array, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb);

/** Shows a texture at `index`, from the next write of a set on. `cube`: of the cube whose first
 * face it is, or VK_NULL_HANDLE. */
void slc_texture_array_set(struct slc_texture_array *array, uint32_t index, VkImageView view,
                           VkImageView cube, VkSampler sampler);
/** Shows no texture at `index` any more, and no cube if it is the first face of one. */
void slc_texture_array_clear(struct slc_texture_array *array, uint32_t index, bool cube);

/** Writes the layout bindings, from `binding` on. Returns how many. */
uint32_t slc_texture_array_bindings(const struct slc_texture_array *array, uint32_t binding,
                                    VkDescriptorSetLayoutBinding bindings[]);

/** Writes to a set, from `binding` on, what changed after `generation`. 0: everything. */
void slc_texture_array_write(const struct slc_texture_array *array, const struct slc_vk *vk,
                             VkDescriptorSet set, uint32_t binding, uint64_t generation);

#endif /* SLC_VULKAN_TEXTURE_ARRAY_H */
