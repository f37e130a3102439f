/**
 * The array of views that shaders find pages in. All of them are valid in every mode, so that one
 * pipeline layout serves all: a place that holds no pages shows an image of one texel.
 */
#ifndef SLC_VULKAN_PAGE_VIEWS_H
#define SLC_VULKAN_PAGE_VIEWS_H

#include "vulkan/plain_image.h"

struct slc_page_views {
    VkImageView *views; ///< owned array; of views it owns only `empty`
    uint32_t count;
    uint64_t generation; ///< of the array: more with each change
    VkSampler sampler;   ///< LINEAR, one level, clamped to the edge
    struct slc_image_memory memory;
    struct slc_plain_image image;
    VkImageView empty;
};

/** After an error it can be finished. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_page_views_init(struct slc_page_views *views, const struct slc_vk *vk,
                                 const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                 uint32_t count);
void slc_page_views_finish(struct slc_page_views *views, const struct slc_vk *vk,
                           const SluiceAllocationCallbacks *cb);

/** Once, before anything is drawn: the empty image into its layout. */
void slc_page_views_record(const struct slc_page_views *views, const struct slc_vk *vk,
                           VkCommandBuffer commands);

/** From nothing into VK_IMAGE_LAYOUT_GENERAL, all layers of the only level. */
void slc_record_general_layout(const struct slc_vk *vk, VkCommandBuffer commands, VkImage image);

/** A copy of what all places of `views` are when they are empty, with an array of its own. Finish
 * it with slc_page_views_finish_copy. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_views_copy(struct slc_page_views *copy, const struct slc_page_views *views,
                                 const SluiceAllocationCallbacks *cb);
void slc_page_views_finish_copy(struct slc_page_views *copy, const SluiceAllocationCallbacks *cb);

/** VK_NULL_HANDLE: the place is empty again. Nothing happens if it is what it was. */
void slc_page_views_set(struct slc_page_views *views, uint32_t index, VkImageView view);

/** True if the place has an image of pages. */
bool slc_page_views_has(const struct slc_page_views *views, uint32_t index);

/** A view of all layers of an image of one level. */
SluiceResult slc_create_array_view(const struct slc_vk *vk, VkImage image, VkFormat format,
                                   VkImageView *view);

#endif /* SLC_VULKAN_PAGE_VIEWS_H */
