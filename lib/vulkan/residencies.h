/**
 * The residencies of a streamer as one: what each of them does once per frame. The streamer's own
 * has the heaps, binds and waits. The paged one beside it never waits, so the first one says what
 * is over.
 */
#ifndef SLC_VULKAN_RESIDENCIES_H
#define SLC_VULKAN_RESIDENCIES_H

#include "vulkan/streamer.h"

/* As in slc_residency_interface. */
SluiceResult slc_residencies_update(SluiceVulkanStreamer *s);
uint32_t slc_residencies_room_to_unmap(const SluiceVulkanStreamer *s);
void slc_residencies_record_begin(SluiceVulkanStreamer *s, VkCommandBuffer commands);
void slc_residencies_record_publish(SluiceVulkanStreamer *s, VkCommandBuffer commands);
void slc_residencies_abandon(SluiceVulkanStreamer *s, uint64_t frame);

#endif /* SLC_VULKAN_RESIDENCIES_H */
