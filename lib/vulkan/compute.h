/** Compute passes that share one layout: storage buffers in set 0, push constants, pipelines. */
#ifndef SLC_VULKAN_COMPUTE_H
#define SLC_VULKAN_COMPUTE_H

#include "vulkan/dispatch.h"

#define SLC_COMPUTE_BINDINGS 8u
#define SLC_COMPUTE_PASSES 5u
#define SLC_COMPUTE_SETS 16u

struct slc_compute_pass {
    const uint32_t *code;  ///< SPIR-V; its entry point is main
    size_t size;           ///< bytes
    uint32_t constants[2]; ///< specialization constants 0 and 1, if the module has them
};

struct slc_compute_create_info {
    uint32_t binding_count; ///< storage buffers, from binding 0 on
    uint32_t push_size;     ///< bytes of push constants
    uint32_t set_count;
    const struct slc_compute_pass *passes;
    uint32_t pass_count;
    const char *name; ///< name of the pipelines for debuggers
};

/** Compute passes. Finishing a zeroed struct does nothing. */
struct slc_compute {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipelines[SLC_COMPUTE_PASSES];
    VkDescriptorPool pool;
    VkDescriptorSet sets[SLC_COMPUTE_SETS];
    uint32_t binding_count, push_size;
};

/** Creates passes, within the limits above. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY,
 * VULKAN; finish it then, too. */
SluiceResult slc_compute_init(struct slc_compute *compute, const struct slc_vk *vk,
                              const struct slc_compute_create_info *info);
void slc_compute_finish(struct slc_compute *compute, const struct slc_vk *vk);

/** Writes binding_count whole buffers to a set that no commands in progress use. */
void slc_compute_set_buffers(struct slc_compute *compute, const struct slc_vk *vk, uint32_t set,
                             const VkBuffer *buffers);

/** Binds the set and pushes the constants, push_size bytes. */
void slc_compute_bind(const struct slc_compute *compute, const struct slc_vk *vk,
                      VkCommandBuffer commands, uint32_t set, const void *push);
void slc_compute_dispatch(const struct slc_compute *compute, const struct slc_vk *vk,
                          VkCommandBuffer commands, uint32_t pass, uint32_t x, uint32_t y);

/** Returns `wanted`, halved until the device supports workgroups of that size, but not below 128.
 */
uint32_t slc_compute_group_size(const struct slc_vk *vk, uint32_t wanted);

/** Records a global memory barrier. */
void slc_compute_barrier(const struct slc_vk *vk, VkCommandBuffer commands,
                         VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
                         VkAccessFlags used);

#endif /* SLC_VULKAN_COMPUTE_H */
