/* Buffers that shaders read and write, and queries of them. */
#include "vulkan/streamer.h"

#include "base/log.h"
#include "base/struct_size.h"

SluiceResult slc_streamer_use_addresses(SluiceVulkanStreamer *s)
{
    if (!s->info.bufferDeviceAddress)
        return SLUICE_SUCCESS;
    if (s->caps.buffer_device_address)
        s->vk.GetBufferDeviceAddress = (PFN_vkGetBufferDeviceAddress)s->vk.GetDeviceProcAddr(
            s->vk.device, "vkGetBufferDeviceAddress");
    if (s->vk.GetBufferDeviceAddress)
        return SLUICE_SUCCESS;
    slc_log(&s->vk.log, SLUICE_LOG_ERROR, "bufferDeviceAddress: %s has no such feature",
            s->caps.public.deviceName);
    return SLUICE_ERROR_UNSUPPORTED;
}

void slc_streamer_fill_buffers(const SluiceVulkanStreamer *s, SluiceVulkanBuffers *buffers)
{
    const struct slc_residency *residency = slc_residency_of_pages(s);
    /* without a page table any buffer will do: shaders do not read it */
    const struct slc_buffer *pages =
        residency ? residency->interface->page_table(residency) : &s->texture_table;
    *buffers = (SluiceVulkanBuffers){.structSize = sizeof(SluiceVulkanBuffers),
                                     .textureTable = s->texture_table.buffer,
                                     .feedback = s->feedback.buffer,
                                     .minMip = s->min_mip.buffer,
                                     .feedbackTurns = s->feedback_turns.buffer,
                                     .pageTable = pages->buffer,
                                     .textureTableAddress = s->texture_table.address,
                                     .feedbackAddress = s->feedback.address,
                                     .minMipAddress = s->min_mip.address,
                                     .feedbackTurnsAddress = s->feedback_turns.address,
                                     .pageTableAddress = pages->address,
                                     .textureTableSize = s->texture_table.size,
                                     .feedbackSize = s->feedback.size,
                                     .minMipSize = s->min_mip.size,
                                     .feedbackTurnsSize = s->feedback_turns.size,
                                     .pageTableSize = pages->size};
}

SluiceResult sluiceGetVulkanBuffers(const SluiceVulkanStreamer *streamer,
                                    SluiceVulkanBuffers *pBuffers)
{
    if (!streamer || !pBuffers)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceVulkanBuffers), pBuffers, &streamer->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    slc_streamer_fill_buffers(streamer, &buffers);
    slc_struct_write(SLC_STRUCT(SluiceVulkanBuffers), pBuffers, &buffers);
    return SLUICE_SUCCESS;
}
