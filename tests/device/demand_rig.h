/** Shared by tests of the passes of demand loading: their device, and buffer copies. */
#ifndef TESTS_DEVICE_DEMAND_RIG_H
#define TESTS_DEVICE_DEMAND_RIG_H

#include "device/harness.h"

#include "vulkan/buffer.h"

#include <stddef.h>

/** Initializes the library's own functions and limits on the harness's device. */
void demand_rig_init(struct harness *h, struct slc_vk *vk, struct slc_caps *caps);

/** Limits `vk` to `count` further allocations; UINT32_MAX: no limit. */
void demand_rig_limit_memory(struct slc_vk *vk, uint32_t count);

/** Returns zeroed memory, to be freed with free. Fails the test when out of memory. */
void *demand_rig_allocate(size_t count, size_t size);

/** Returns a random number of 30 bits, seeded with roll_seed. */
uint32_t demand_rig_random(uint32_t limit);

/** Records a copy of all of `from` to `to`, with barriers before and after. */
void demand_rig_record_upload(const struct slc_vk *vk, VkCommandBuffer commands,
                              const struct harness_buffer *from, const struct slc_buffer *to);
/** Records a copy of all of `from` to `to` and to the host. No barrier before, because the passes
 * promise one. */
void demand_rig_record_download(const struct slc_vk *vk, VkCommandBuffer commands,
                                const struct slc_buffer *from, const struct harness_buffer *to);

#endif /* TESTS_DEVICE_DEMAND_RIG_H */
