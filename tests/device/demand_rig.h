/** What tests of the passes of demand loading share: their device, and buffers that travel. */
#ifndef TESTS_DEVICE_DEMAND_RIG_H
#define TESTS_DEVICE_DEMAND_RIG_H

#include "device/harness.h"

#include "vulkan/buffer.h"

#include <stddef.h>

/** The library's own functions and limits on the harness's device. */
void demand_rig_init(struct harness *h, struct slc_vk *vk, struct slc_caps *caps);

/** From here on `vk` has memory for `count` allocations more; UINT32_MAX: for all. */
void demand_rig_limit_memory(struct slc_vk *vk, uint32_t count);

/** Zeroed; fails the test where there is none. Freed with free. */
void *demand_rig_allocate(size_t count, size_t size);

/** Seeded with roll_seed, 30 bits. */
uint32_t demand_rig_random(uint32_t limit);

/** All of `from` to `to`, with barriers before and after. */
void demand_rig_record_upload(const struct slc_vk *vk, VkCommandBuffer commands,
                              const struct harness_buffer *from, const struct slc_buffer *to);
/** All of `from` to `to`, and to the host. No barrier before: the passes promise one. */
void demand_rig_record_download(const struct slc_vk *vk, VkCommandBuffer commands,
                                const struct slc_buffer *from, const struct harness_buffer *to);

#endif /* TESTS_DEVICE_DEMAND_RIG_H */
