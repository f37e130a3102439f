#include "vulkan/residencies.h"

#include "base/checked.h"
#include "base/log.h"

static SluiceResult check_sparse_queue(const SluiceVulkanStreamer *s)
{
    if (s->info.residencyMode != SLUICE_RESIDENCY_MODE_SPARSE || s->context->sparse_queue)
        return SLUICE_SUCCESS;
    slc_log(&s->vk.log, SLUICE_LOG_ERROR,
            "sparseQueue of the context is NULL, in sparse mode: give a queue, or set "
            "residencyMode to SLUICE_RESIDENCY_MODE_PAGED");
    return SLUICE_ERROR_NULL_POINTER;
}

static SluiceResult check_mode(const SluiceVulkanStreamer *s, SluiceResidencyMode mode,
                               const char *purpose)
{
    const char *missing = slc_missing_for_mode(&s->caps, mode);
    if (!missing)
        return SLUICE_SUCCESS;
    slc_log(&s->vk.log, SLUICE_LOG_ERROR, "%s has no %s%s", s->caps.public.deviceName, missing,
            purpose);
    return SLUICE_ERROR_UNSUPPORTED;
}

static SluiceResult choose_mode(SluiceVulkanStreamer *s)
{
    s->chooses_modes = s->info.residencyMode == SLUICE_RESIDENCY_MODE_AUTO;
    s->info.residencyMode =
        slc_choose_mode(&s->caps, s->info.residencyMode, s->info.maxTextureCount);
    SluiceResult result = check_mode(s, s->info.residencyMode, "");
    if (result == SLUICE_SUCCESS)
        result = check_sparse_queue(s);
    return result;
}

static struct slc_residency_create_info create_info(const SluiceVulkanStreamer *s)
{
    return (struct slc_residency_create_info){
        .vk = &s->vk,
        .caps = &s->caps,
        .cb = &s->cb,
        .sparse_queue = s->context->sparse_queue,
        .max_binds_per_call = s->context->max_binds_per_call,
        .max_image_count = s->info.maxTextureCount,
        .max_changes = slc_max_u32(s->info.maxLoadsInFlight, 1024),
        .max_touched_tiles =
            s->info.maxTouchedTiles ? s->info.maxTouchedTiles : s->caps.public.maxTouchedTiles,
        .max_region_count = s->info.maxRegionCount,
        .kept_heap_size = s->context->shared.min_tile_memory,
        .may_lack_memory = s->info.forgetTextures,
        .pages = s->pages,
        .page_user = s->page_user,
    };
}

/* Creates the paged residency beside sparse mode. Other modes can hold every paged texture. */
static SluiceResult create_paged(SluiceVulkanStreamer *s, struct slc_residency_create_info info)
{
    if (!s->info.pagedTextures || s->info.residencyMode != SLUICE_RESIDENCY_MODE_SPARSE)
        return SLUICE_SUCCESS;
    SluiceResult result = check_mode(s, SLUICE_RESIDENCY_MODE_PAGED, ", for pagedTextures");
    info.packed_outside = true;
    return result == SLUICE_SUCCESS ? slc_create_paged_residency(&info, &s->paged) : result;
}

SluiceResult slc_residencies_create(SluiceVulkanStreamer *s)
{
    SluiceResult result = choose_mode(s);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_residency_create_info info = create_info(s);
    info.whole = s->info.residencyMode != SLUICE_RESIDENCY_MODE_DENSE;
    if (info.whole)
        result = slc_create_dense_residency(&info, &s->plain);
    info.whole = false;
    if (result == SLUICE_SUCCESS)
        result = create_paged(s, info);
    if (result != SLUICE_SUCCESS)
        return result;
    switch (s->info.residencyMode) {
    case SLUICE_RESIDENCY_MODE_PAGED: return slc_create_paged_residency(&info, &s->residency);
    case SLUICE_RESIDENCY_MODE_DENSE: return slc_create_dense_residency(&info, &s->residency);
    default: return slc_create_sparse_residency(&info, &s->residency);
    }
}

void slc_residencies_destroy(SluiceVulkanStreamer *s)
{
    struct slc_residency *all[] = {s->residency, s->paged, s->plain};
    for (uint32_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (all[i])
            all[i]->interface->destroy(all[i]);
}

SluiceResult slc_residencies_update(SluiceVulkanStreamer *s)
{
    if (s->paged)
        s->paged->interface->update(s->paged, s->frame, s->completed_frame); /* cannot fail */
    return s->residency->interface->update(s->residency, s->frame, s->completed_frame);
}

/* Takes the minimum, because the textures of the next unmaps are not known. */
uint32_t slc_residencies_room_to_unmap(const SluiceVulkanStreamer *s)
{
    uint32_t room = s->residency->interface->room_to_unmap(s->residency);
    return s->paged ? slc_min_u32(room, s->paged->interface->room_to_unmap(s->paged)) : room;
}

void slc_residencies_record_begin(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    struct slc_residency *pages = slc_residency_of_pages(s);
    if (pages)
        pages->interface->record_begin(pages, s->frame, commands);
}

void slc_residencies_record_publish(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    struct slc_residency *pages = slc_residency_of_pages(s);
    if (pages)
        pages->interface->record_publish(pages, commands);
}

void slc_residencies_abandon(SluiceVulkanStreamer *s, uint64_t frame)
{
    struct slc_residency *pages = slc_residency_of_pages(s);
    if (pages)
        pages->interface->abandon(pages, frame);
}
