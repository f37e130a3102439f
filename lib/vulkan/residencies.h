/**
 * Calls that apply to all residencies of a streamer, once per frame. The main residency
 * (`residency`) has the heaps, binds and waits. The paged one beside it never waits, so the main
 * one decides which frames are complete.
 */
#ifndef SLC_VULKAN_RESIDENCIES_H
#define SLC_VULKAN_RESIDENCIES_H

#include "vulkan/streamer.h"

/* Functions of slc_residency_interface, for all residencies. */
SluiceResult slc_residencies_update(SluiceVulkanStreamer *s);
uint32_t slc_residencies_room_to_unmap(const SluiceVulkanStreamer *s);
void slc_residencies_record_begin(SluiceVulkanStreamer *s, VkCommandBuffer commands);
void slc_residencies_record_publish(SluiceVulkanStreamer *s, VkCommandBuffer commands);
void slc_residencies_abandon(SluiceVulkanStreamer *s, uint64_t frame);

#endif /* SLC_VULKAN_RESIDENCIES_H */
