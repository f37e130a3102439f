/**
 * Array of the images and samplers of all textures by table index, for shaders that choose a
 * texture by a number. Every element is valid: one without a texture shows an image of one texel.
 *
 * Cube maps have a separate array of cube views. The index of a cube is the table index of its
 * first face divided by 6. Faces have consecutive table indices, so the indices of cubes differ.
 */
#ifndef SLC_VULKAN_TEXTURE_ARRAY_H
#define SLC_VULKAN_TEXTURE_ARRAY_H

#include "vulkan/samplers.h"

#define SLC_TEXTURE_ARRAY_BINDINGS 3u

struct slc_texture_element {
    VkImageView view;
    VkSampler sampler;
    uint64_t generation; ///< generation of the array when the element last changed
};

/** Array of textures. Zeroed: no elements. */
struct slc_texture_array {
    SluiceTextureArray kind;
    struct slc_texture_element *elements; ///< owned, [count + cube_count]: textures, then cubes
    uint32_t count, cube_count;
    uint64_t generation;                 ///< grows with each change; counts from 1
    VkImageView empty, empty_cube;       ///< owned
    VkSampler empty_sampler;             ///< borrowed
    const struct slc_samplers *samplers; ///< borrowed; samplers of the textures
};

/**
 * Makes an array whose elements all show `image` with `sampler`. The image has six layers and one
 * level, and is compatible with cube views. `image`, `sampler` and `samplers` must outlive the
 * array. Finish the array after an error, too.
 *
 * Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SluiceResult slc_texture_array_init(struct slc_texture_array *array, const struct slc_vk *vk,
                                    const SluiceAllocationCallbacks *cb, SluiceTextureArray kind,
                                    uint32_t count, VkImage image, VkSampler sampler,
                                    const struct slc_samplers *samplers);
void slc_texture_array_finish(struct slc_texture_array *array, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb);

/** Shows a texture at `index`, from the next write of a set on. `cube`: view of the cube if the
 * texture is its first face, else VK_NULL_HANDLE. */
void slc_texture_array_set(struct slc_texture_array *array, uint32_t index, VkImageView view,
                           VkImageView cube, VkSampler sampler);
/** Shows no texture at `index` any more, and no cube if it is the first face of one. */
void slc_texture_array_clear(struct slc_texture_array *array, uint32_t index, bool cube);

/** Writes the layout bindings, from `binding` on. Returns how many. */
uint32_t slc_texture_array_bindings(const struct slc_texture_array *array, uint32_t binding,
                                    VkDescriptorSetLayoutBinding bindings[]);

/** Writes elements that changed after `generation` to a set, from `binding` on. 0: all elements. */
void slc_texture_array_write(const struct slc_texture_array *array, const struct slc_vk *vk,
                             VkDescriptorSet set, uint32_t binding, uint64_t generation);

#endif /* SLC_VULKAN_TEXTURE_ARRAY_H */
