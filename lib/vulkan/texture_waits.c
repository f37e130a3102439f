/* Waits for requests: for reads, or until a frame has work. */
#include "core/observer.h"
#include "image/read_pool.h"
#include "platform/time_now.h"
#include "vulkan/streamer.h"

#include <sluice/vulkan_control.h>

static bool reads(const SluiceVulkanStreamer *s)
{
    for (uint32_t i = 0; i < s->info.maxLoadsInFlight; i++)
        if (s->units[i].state == SLC_UNIT_READING)
            return true;
    return false;
}

static bool is_empty(const struct slc_unit_list *list)
{
    return list->first == SLC_NONE;
}

/* True if a frame can start, bind, copy or show tiles before any read ends. */
static bool frame_has_work(const SluiceVulkanStreamer *s)
{
    /* Outside of frames the manager is locked for calls of its interface. */
    uint32_t requested = slc_manager_slot_statistics(s->manager).requestedTileCount;
    return s->due_map_count || !is_empty(&s->arrived) || !is_empty(&s->binding) ||
           !is_empty(&s->copying) || !is_empty(&s->unproduced) || !is_empty(&s->produced) ||
           s->packed_queue_count || s->ended_frame != s->frame || (requested && s->free_unit_count);
}

static SluiceVulkanWaitStatus status_of(const SluiceVulkanRequestProgress *p)
{
    if (p->over)
        return SLUICE_VULKAN_WAIT_OVER;
    if (p->ready)
        return SLUICE_VULKAN_WAIT_READY;
    if (p->givenUpTileCount && p->residentTileCount + p->givenUpTileCount == p->tileCount)
        return SLUICE_VULKAN_WAIT_FAILED;
    return SLUICE_VULKAN_WAIT_FRAME;
}

static uint64_t deadline(uint64_t timeout)
{
    uint64_t now = slc_monotonic_time();
    return timeout < UINT64_MAX - now ? now + timeout : UINT64_MAX - 1;
}

SluiceResult sluiceWaitVulkanRequest(SluiceVulkanStreamer *streamer,
                                     SluiceTextureRequestId requestId, uint64_t timeoutNanoseconds,
                                     SluiceVulkanWaitStatus *pStatus)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pStatus)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanRequestProgress progress = {.structSize = sizeof progress};
    SluiceResult result = sluiceGetVulkanRequestProgress(s, requestId, &progress);
    if (result != SLUICE_SUCCESS)
        return result;
    *pStatus = status_of(&progress);
    if (*pStatus == SLUICE_VULKAN_WAIT_FRAME && reads(s) && !frame_has_work(s) &&
        !slc_loader_wait_for_read(s->loader, deadline(timeoutNanoseconds)))
        *pStatus = SLUICE_VULKAN_WAIT_TIMEOUT;
    return SLUICE_SUCCESS;
}
