/* Waits for tiles: for reads, or until a launch has work. */
#include "base/struct_size.h"
#include "demand/page_observer.h"
#include "demand_vulkan/opening.h"
#include "demand_vulkan/refused_arguments.h"
#include "image/read_pool.h"
#include "platform/time_now.h"

#include <sluice/demand_query.h>

static void count_page(const SluiceDemandLoader *loader, uint32_t page,
                       SluiceDemandRegionProgress *progress)
{
    const struct slc_demand_residency *residency = loader->residency;
    uint32_t place;
    progress->tileCount++;
    if (slc_residency_is_resident(residency, page, &place))
        progress->residentTileCount++;
    else if (slc_residency_is_loading(residency, page))
        progress->pendingTileCount++;
    else if (!slc_residency_is_absent(residency, page))
        progress->refusedTileCount++;
}

static void count_pages(const SluiceDemandLoader *loader, const struct slc_demand_image *image,
                        const struct slc_remake_area *area, SluiceDemandRegionProgress *progress)
{
    count_page(loader, image->tail_page, progress);
    for (uint32_t level = area->region.mipLevel; level < image->regular_count; level++) {
        uint32_t width = slc_image_level_width(image, level);
        struct slc_remake_tiles t =
            slc_remake_tiles(area, level, image->tile_width, image->tile_height);
        for (uint32_t y = t.y; y < t.end_y; y++)
            for (uint32_t x = t.x; x < t.end_x; x++)
                count_page(loader, image->first_pages[level] + y * width + x, progress);
    }
    progress->ready = progress->residentTileCount == progress->tileCount;
}

/* Gets the progress of a region. `*index`: texture that has the image. */
static SluiceResult get_progress(SluiceDemandLoader *loader, const char *function,
                                 SluiceDemandTextureId id, const SluiceImageRegion *region,
                                 uint32_t *index, SluiceDemandRegionProgress *progress)
{
    struct slc_remake_area area;
    SluiceResult result = slc_texture_find(loader, id, index);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[*index].kind == SLC_TEXTURE_VARIANT)
        *index = loader->textures[*index].base;
    const struct slc_demand_texture *texture = &loader->textures[*index];
    if (texture->kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, function, id);
    progress->failed = texture->failed;
    if (texture->image == SLC_NONE || loader->images[texture->image]->state != SLC_IMAGE_OPEN)
        return SLUICE_SUCCESS;
    const struct slc_demand_image *image = loader->images[texture->image];
    progress->isOpen = true;
    result =
        slc_remake_area_read(&area, &image->info, region, UINT32_MAX, function, &loader->vk.log);
    if (result == SLUICE_SUCCESS)
        count_pages(loader, image, &area, progress);
    return result;
}

SluiceResult sluiceGetDemandRegionProgress(SluiceDemandLoader *loader,
                                           SluiceDemandTextureId textureId,
                                           const SluiceImageRegion *pRegion,
                                           SluiceDemandRegionProgress *pProgress)
{
    if (!loader || !pProgress)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceDemandRegionProgress);
    SluiceDemandRegionProgress progress = {.structSize = sizeof progress};
    uint32_t index;
    SluiceResult result = slc_struct_check(type, pProgress, &loader->vk.log);
    if (result == SLUICE_SUCCESS)
        result = get_progress(loader, __func__, textureId, pRegion, &index, &progress);
    if (result == SLUICE_SUCCESS)
        slc_struct_write(type, pProgress, &progress);
    return result;
}

static bool reads(const SluiceDemandLoader *loader)
{
    return loader->reading_count || loader->free_other_count < loader->info.maxTilesInFlight;
}

static bool is_opening(const SluiceDemandLoader *loader, uint32_t index)
{
    uint32_t slot = loader->textures[index].image;
    return slot != SLC_NONE && loader->images[slot]->state == SLC_IMAGE_OPENING;
}

/* True if a launch must take, make or start something before any read ends. `all_pending`: all
 * awaited tiles are being loaded, so that requests do not matter. */
static bool launch_has_work(const SluiceDemandLoader *loader, bool all_pending)
{
    return loader->arrived.first != SLC_NONE || loader->unproduced.first != SLC_NONE ||
           loader->produced.first != SLC_NONE ||
           (!all_pending && loader->launch != loader->processed) ||
           (loader->preload_count && !reads(loader));
}

static SluiceDemandWaitStatus status_of(SluiceDemandLoader *loader, uint32_t index,
                                        const SluiceDemandRegionProgress *p, uint64_t timeout)
{
    uint32_t done = p->residentTileCount + p->refusedTileCount;
    bool pending =
        p->isOpen ? done + p->pendingTileCount == p->tileCount : is_opening(loader, index);
    if (p->ready)
        return SLUICE_DEMAND_WAIT_READY;
    if (p->failed || (p->refusedTileCount && done == p->tileCount))
        return SLUICE_DEMAND_WAIT_FAILED;
    if (launch_has_work(loader, pending))
        return SLUICE_DEMAND_WAIT_LAUNCH;
    if (!reads(loader))
        return SLUICE_DEMAND_WAIT_NOT_REQUESTED;
    uint64_t now = slc_monotonic_time();
    uint64_t until = timeout < UINT64_MAX - now ? now + timeout : UINT64_MAX - 1;
    return slc_loader_wait_for_read(loader->reader, until) ? SLUICE_DEMAND_WAIT_LAUNCH
                                                           : SLUICE_DEMAND_WAIT_TIMEOUT;
}

SluiceResult sluiceWaitDemandRegion(SluiceDemandLoader *loader, SluiceDemandTextureId textureId,
                                    const SluiceImageRegion *pRegion, uint64_t timeoutNs,
                                    SluiceDemandWaitStatus *pStatus)
{
    SluiceDemandRegionProgress progress = {.structSize = sizeof progress};
    uint32_t index;
    if (!loader || !pStatus)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_ticket_is_canceled(&loader->tickets, 0))
        return SLUICE_ERROR_CANCELED;
    SluiceResult result = get_progress(loader, __func__, textureId, pRegion, &index, &progress);
    if (result == SLUICE_SUCCESS)
        *pStatus = status_of(loader, index, &progress, timeoutNs);
    return result;
}
