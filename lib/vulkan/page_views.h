/**
 * Array of image views in which shaders find pages. Every element is valid in every mode, so that
 * one pipeline layout suffices: an element without pages shows an image of one texel.
 */
#ifndef SLC_VULKAN_PAGE_VIEWS_H
#define SLC_VULKAN_PAGE_VIEWS_H

#include "vulkan/plain_image.h"

struct slc_page_views {
    VkImageView *views; ///< owned array, [count]; borrowed views, except `empty`
    uint32_t count;
    uint64_t generation; ///< grows with each change of the array
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

/** Records the layout transition of the empty image. Once, before anything is drawn. */
void slc_page_views_record(const struct slc_page_views *views, const struct slc_vk *vk,
                           VkCommandBuffer commands);

/** Records a transition from UNDEFINED to GENERAL layout, for all layers of an image of one level.
 */
void slc_record_general_layout(const struct slc_vk *vk, VkCommandBuffer commands, VkImage image);

/** Makes an array of its own in which all elements are empty, with the image of `views`. Finish it
 * with slc_page_views_finish_copy. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_views_copy(struct slc_page_views *copy, const struct slc_page_views *views,
                                 const SluiceAllocationCallbacks *cb);
void slc_page_views_finish_copy(struct slc_page_views *copy, const SluiceAllocationCallbacks *cb);

/** Sets an element. `view` VK_NULL_HANDLE: empties it. Does nothing if the view is unchanged. */
void slc_page_views_set(struct slc_page_views *views, uint32_t index, VkImageView view);

/** True if the element has an image of pages. */
bool slc_page_views_has(const struct slc_page_views *views, uint32_t index);

/** Creates a view of all layers of an image of one level. */
SluiceResult slc_create_array_view(const struct slc_vk *vk, VkImage image, VkFormat format,
                                   VkImageView *view);

#endif /* SLC_VULKAN_PAGE_VIEWS_H */
