/** The compute pass that packs feedback to bytes in a readback slot and clears it. */
#ifndef SLC_VULKAN_RESOLVE_H
#define SLC_VULKAN_RESOLVE_H

#include "vulkan/buffer.h"

struct slc_resolve {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
};

/** From `feedback` to `resolved`, both whole storage buffers. */
SluiceResult slc_resolve_init(struct slc_resolve *resolve, const struct slc_vk *vk,
                              VkBuffer feedback, VkBuffer resolved);
void slc_resolve_finish(struct slc_resolve *resolve, const struct slc_vk *vk);

void slc_resolve_bind(const struct slc_resolve *resolve, const struct slc_vk *vk,
                      VkCommandBuffer commands);
/** After slc_resolve_bind; the caller puts barriers around all dispatches. */
void slc_resolve_record(const struct slc_resolve *resolve, const struct slc_vk *vk,
                        VkCommandBuffer commands, uint32_t feedback_word, uint32_t region_count,
                        uint32_t resolved_word);

#endif /* SLC_VULKAN_RESOLVE_H */
