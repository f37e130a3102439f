/**
 * Descriptor sets that the application's shaders bind: one per frame or launch in flight, written
 * as that begins, when no earlier one uses the set any more. So no binding flags are required.
 *
 * Bindings in this order: storage buffers, the array of pages, the array of textures or the array
 * of storage buffers if there is one. shared/bindings.h has the numbers.
 */
#ifndef SLC_VULKAN_DESCRIPTORS_H
#define SLC_VULKAN_DESCRIPTORS_H

#include "vulkan/caps.h"
#include "vulkan/page_views.h"
#include "vulkan/texture_array.h"

#define SLC_DESCRIPTOR_BUFFERS 8u
#define SLC_DESCRIPTOR_SETS 16u

struct slc_descriptors_create_info {
    VkBuffer buffers[SLC_DESCRIPTOR_BUFFERS]; ///< bindings 0 to buffer_count - 1
    uint32_t buffer_count;
    uint32_t page_count;                      ///< elements of the array of pages
    const struct slc_texture_array *textures; ///< NULL: none
    uint32_t array_count; ///< elements of the array of storage buffers; 0: none. Without textures
    uint32_t set_count;   ///< at most SLC_DESCRIPTOR_SETS
};

#define SLC_DESCRIPTOR_ARRAY 16u

/** Elements of the array of storage buffers. */
struct slc_buffer_array {
    VkBuffer buffers[SLC_DESCRIPTOR_ARRAY];
    uint64_t generation; ///< from 1 on; changes with `buffers`
};

struct slc_descriptor_set {
    VkDescriptorSet set;
    /** Generations of the arrays that the set holds; 0: none yet. */
    uint64_t page_generation, texture_generation, array_generation;
};

/** Descriptor sets. A zeroed struct has no layout and no sets; finishing it does nothing. */
struct slc_descriptors {
    VkDescriptorSetLayout layout;
    VkDescriptorPool pool;
    uint32_t page_binding, page_count, array_count;
    struct slc_descriptor_set sets[SLC_DESCRIPTOR_SETS];
};

/**
 * Creates layout and sets. Both are VK_NULL_HANDLE if the device has fewer samplers per shader
 * stage than `page_count`. Finish the struct after an error, too.
 *
 * Errors: LIMIT_EXCEEDED, with a log message, if pages and textures are too many for a stage;
 *         OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SluiceResult slc_descriptors_init(struct slc_descriptors *descriptors, const struct slc_vk *vk,
                                  const struct slc_caps *caps,
                                  const struct slc_descriptors_create_info *info);
void slc_descriptors_finish(struct slc_descriptors *descriptors, const struct slc_vk *vk);

/** Makes set `index` current, and returns it. No commands in progress use the set. `pages`: the
 *  array that the front end's frames see. `textures`: as given at creation. */
VkDescriptorSet slc_descriptors_update(struct slc_descriptors *descriptors, const struct slc_vk *vk,
                                       uint32_t index, const struct slc_page_views *pages,
                                       const struct slc_texture_array *textures);

/** Writes the array of storage buffers of set `index`. No commands in progress use the set. */
void slc_descriptors_update_array(struct slc_descriptors *descriptors, const struct slc_vk *vk,
                                  uint32_t index, const struct slc_buffer_array *array);

/** Returns the layout for the application. Errors: UNSUPPORTED, with a log message, if there are no
 * sets. */
SluiceResult slc_descriptors_get_layout(const struct slc_descriptors *descriptors,
                                        const struct slc_vk *vk, const struct slc_caps *caps,
                                        VkDescriptorSetLayout *layout);

#endif /* SLC_VULKAN_DESCRIPTORS_H */
