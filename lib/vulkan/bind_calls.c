#include "vulkan/bind_calls.h"

#include "base/alloc.h"
#include "vulkan/queues.h"
#include "vulkan/timeline.h"

#include <assert.h>

SluiceResult slc_bind_calls_init(struct slc_bind_calls *calls, const struct slc_vk *vk,
                                 VkQueue queue, const SluiceAllocationCallbacks *cb,
                                 const struct slc_bind_calls_limits *limits)
{
    *calls = (struct slc_bind_calls){.vk = vk, .queue = queue, .limits = *limits};
    calls->tiles = slc_alloc(cb, limits->tile_count, sizeof *calls->tiles);
    calls->pages = slc_alloc(cb, limits->page_count, sizeof *calls->pages);
    calls->tile_images = slc_alloc(cb, limits->image_count, sizeof *calls->tile_images);
    calls->page_images = slc_alloc(cb, limits->image_count, sizeof *calls->page_images);
    if (!calls->tiles || !calls->pages || !calls->tile_images || !calls->page_images)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return slc_timeline_create(vk, "binds", &calls->semaphore);
}

void slc_bind_calls_finish(struct slc_bind_calls *calls, const SluiceAllocationCallbacks *cb)
{
    const struct slc_bind_calls_limits *limits = &calls->limits;
    if (calls->vk)
        calls->vk->DestroySemaphore(calls->vk->device, calls->semaphore, NULL);
    slc_free(cb, calls->tiles, limits->tile_count, sizeof *calls->tiles);
    slc_free(cb, calls->pages, limits->page_count, sizeof *calls->pages);
    slc_free(cb, calls->tile_images, limits->image_count, sizeof *calls->tile_images);
    slc_free(cb, calls->page_images, limits->image_count, sizeof *calls->page_images);
}

void slc_bind_calls_begin(struct slc_bind_calls *calls)
{
    calls->tile_count = calls->page_count = 0;
    calls->tile_image_count = calls->page_image_count = 0;
}

static SluiceResult submit(struct slc_bind_calls *calls)
{
    uint64_t next = calls->signaled + 1;
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .waitSemaphoreValueCount = 1,
        .pWaitSemaphoreValues = &calls->signaled,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &next};
    const VkBindSparseInfo info = {.sType = VK_STRUCTURE_TYPE_BIND_SPARSE_INFO,
                                   .pNext = &timeline,
                                   .waitSemaphoreCount = 1,
                                   .pWaitSemaphores = &calls->semaphore,
                                   .imageBindCount = calls->tile_image_count,
                                   .pImageBinds = calls->tile_images,
                                   .imageOpaqueBindCount = calls->page_image_count,
                                   .pImageOpaqueBinds = calls->page_images,
                                   .signalSemaphoreCount = 1,
                                   .pSignalSemaphores = &calls->semaphore};
    SluiceResult result = slc_vk_result(
        calls->vk, slc_queue_bind_sparse(calls->vk, calls->queue, &info), "vkQueueBindSparse");
    if (result != SLUICE_SUCCESS)
        return result;
    calls->signaled = next;
    calls->count++;
    slc_bind_calls_begin(calls);
    return SLUICE_SUCCESS;
}

static SluiceResult make_room(struct slc_bind_calls *calls)
{
    bool is_full = calls->tile_count + calls->page_count == calls->limits.regions_per_call;
    return is_full ? submit(calls) : SLUICE_SUCCESS;
}

SluiceResult slc_bind_calls_add_tile(struct slc_bind_calls *calls, VkImage image,
                                     const VkSparseImageMemoryBind *bind)
{
    SluiceResult result = make_room(calls);
    if (result != SLUICE_SUCCESS)
        return result;
    assert(calls->tile_count < calls->limits.tile_count);
    VkSparseImageMemoryBind *tile = &calls->tiles[calls->tile_count++];
    *tile = *bind;
    uint32_t count = calls->tile_image_count;
    if (count == 0 || calls->tile_images[count - 1].image != image)
        calls->tile_images[calls->tile_image_count++] =
            (VkSparseImageMemoryBindInfo){image, 0, tile};
    calls->tile_images[calls->tile_image_count - 1].bindCount++;
    return SLUICE_SUCCESS;
}

SluiceResult slc_bind_calls_add_page(struct slc_bind_calls *calls, VkImage image,
                                     const VkSparseMemoryBind *bind)
{
    SluiceResult result = make_room(calls);
    if (result != SLUICE_SUCCESS)
        return result;
    assert(calls->page_count < calls->limits.page_count);
    VkSparseMemoryBind *page = &calls->pages[calls->page_count++];
    *page = *bind;
    uint32_t count = calls->page_image_count;
    if (count == 0 || calls->page_images[count - 1].image != image)
        calls->page_images[calls->page_image_count++] =
            (VkSparseImageOpaqueMemoryBindInfo){image, 0, page};
    calls->page_images[calls->page_image_count - 1].bindCount++;
    return SLUICE_SUCCESS;
}

SluiceResult slc_bind_calls_end(struct slc_bind_calls *calls)
{
    return submit(calls);
}
