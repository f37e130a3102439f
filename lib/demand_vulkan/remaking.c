/* Remaking of produced pages whose content has changed. */
#include "base/log.h"
#include "demand_vulkan/opening.h"
#include "demand_vulkan/pages.h"
#include "demand_vulkan/productions.h"
#include "demand/page_observer.h"
#include "demand_vulkan/refused_arguments.h"
#include "demand_vulkan/tiles.h"

#include <inttypes.h>

/* Pages of a call: tiles of an image, or byte pages. */
struct changed {
    SluiceDemandLoader *loader;
    const struct slc_demand_image *image; ///< NULL: pages
    const struct slc_remake_area *area;
    uint32_t first, count;
};

static bool is_changed(const struct changed *c, uint32_t page)
{
    if (!c->image)
        return page >= c->first && page - c->first < c->count;
    const struct slc_demand_image *image = c->image;
    if (page == image->tail_page)
        return slc_remake_meets_tail(c->area, image->regular_count);
    uint32_t index, level = slc_tile_level(image, page, &index);
    if (level == image->regular_count)
        return false;
    struct slc_remake_tiles t =
        slc_remake_tiles(c->area, level, image->tile_width, image->tile_height);
    uint32_t width = slc_image_level_width(image, level), x = index % width, y = index / width;
    return x >= t.x && x < t.end_x && y >= t.y && y < t.end_y;
}

/* Queues a resident page to be made again. An evicted page must not be restored with old content.
 */
static void change(void *user, uint32_t page)
{
    struct changed *c = user;
    SluiceDemandLoader *loader = c->loader;
    uint32_t place;
    if (!is_changed(c, page))
        return;
    if (slc_residency_is_resident(loader->residency, page, &place))
        slc_remakes_add(&loader->remakes, page);
    else if (slc_residency_is_absent(loader->residency, page))
        slc_residency_forget(loader->residency, page, 1);
}

static void change_tiles(struct changed *c)
{
    const struct slc_demand_image *image = c->image;
    change(c, image->tail_page);
    for (uint32_t level = 0; level < image->regular_count; level++) {
        uint32_t width = slc_image_level_width(image, level);
        struct slc_remake_tiles t =
            slc_remake_tiles(c->area, level, image->tile_width, image->tile_height);
        for (uint32_t y = t.y; y < t.end_y; y++)
            for (uint32_t x = t.x; x < t.end_x; x++)
                change(c, image->first_pages[level] + y * width + x);
    }
}

/* Queues pages that launches in progress wrote. Pages that wait for their producer get new content.
 */
static void change_written(struct changed *c)
{
    SluiceDemandLoader *loader = c->loader;
    for (uint32_t at = loader->produced.first; at != SLC_NONE; at = loader->jobs[at].next) {
        const struct slc_demand_job *job = &loader->jobs[at];
        if (!job->stale && !job->remakes && is_changed(c, job->page))
            slc_remakes_add(&loader->remakes, job->page);
    }
}

/* `page_count`: pages that the call names. */
static SluiceResult change_all(struct changed *c, uint64_t page_count)
{
    SluiceDemandLoader *loader = c->loader;
    uint32_t known = slc_residency_known_count(loader->residency);
    uint32_t most = page_count < known ? (uint32_t)page_count : known;
    SluiceResult result =
        slc_remakes_reserve(&loader->remakes, most + loader->info.maxTilesInFlight);
    if (result != SLUICE_SUCCESS)
        return result;
    if (page_count >= known)
        slc_residency_visit(loader->residency, change, c);
    else if (c->image)
        change_tiles(c);
    else
        for (uint32_t i = 0; i < c->count; i++)
            change(c, c->first + i);
    change_written(c);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceRemakeDemandTiles(SluiceDemandLoader *loader, SluiceDemandTextureId textureId,
                                     const SluiceImageRegion *pRegion, uint32_t mipLevelCount)
{
    uint32_t index;
    struct slc_remake_area area;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_texture_find(loader, textureId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[index].kind == SLC_TEXTURE_VARIANT)
        index = loader->textures[index].base;
    const struct slc_demand_texture *texture = &loader->textures[index];
    if (!texture->made)
        return slc_demand_refuse(loader, __func__,
                                 "texture %#" PRIx64
                                 " has no producer; sluiceInvalidateDemandTexture drops its tiles",
                                 textureId);
    result = slc_remake_area_read(&area, &texture->made->info, pRegion, mipLevelCount, __func__,
                                  &loader->vk.log);
    if (result != SLUICE_SUCCESS || texture->image == SLC_NONE)
        return result;
    const struct slc_demand_image *image = loader->images[texture->image];
    struct changed changed = {.loader = loader, .image = image, .area = &area};
    return change_all(&changed, slc_remake_count(&area, image->regular_count, image->tile_width,
                                                 image->tile_height));
}

SluiceResult sluiceRemakeDemandPages(SluiceDemandLoader *loader, SluiceDemandResourceId resourceId,
                                     uint32_t firstPage, uint32_t count)
{
    struct slc_demand_resource *resource;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_resource_find(loader, resourceId, &resource);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t page_count = resource->info.pageCount;
    if (firstPage > page_count || count > page_count - firstPage || !resource->produced)
        return slc_demand_refuse(
            loader, __func__,
            "%" PRIu32 " pages from page %" PRIu32 " on: the resource has %" PRIu32 "%s", count,
            firstPage, page_count, resource->produced ? "" : ", and no pfnRecordPages");
    struct changed changed = {
        .loader = loader, .first = resource->first_page + firstPage, .count = count};
    return change_all(&changed, count);
}

static void start(SluiceDemandLoader *loader, uint32_t page)
{
    uint32_t index;
    switch (slc_pages_find(loader, page, &index)) {
    case SLC_OWNER_RESOURCE: slc_remake_begin(loader, NULL, loader->resources[index], page); return;
    case SLC_OWNER_TAIL:
        index = SLUICE_DEMAND_BLOCK_PAGES * index + page % SLUICE_DEMAND_BLOCK_PAGES;
        break;
    case SLC_OWNER_LEVEL: break;
    case SLC_OWNER_NOBODY:
    case SLC_OWNER_OPENING: slc_remakes_end(&loader->remakes, page); return;
    }
    slc_remake_begin(loader, loader->images[index], NULL, page);
}

/* Most jobs stay free for missing pages. Remakes of pages that are still loading wait. */
void slc_remakes_start(SluiceDemandLoader *loader)
{
    uint32_t kept = loader->info.maxTilesInFlight / 4 * 3;
    for (uint32_t left = loader->remakes.count; left > 0 && loader->free_produce_count > kept;
         left--) {
        uint32_t page = (uint32_t)slc_remakes_take(&loader->remakes);
        if (slc_residency_is_loading(loader->residency, page))
            slc_remakes_put_back(&loader->remakes, page);
        else
            start(loader, page);
    }
}

struct page_range {
    uint32_t first;
    uint64_t count;
};

static bool is_in_range(void *user, uint64_t page)
{
    const struct page_range *range = user;
    return page >= range->first && page - range->first < range->count;
}

void slc_remakes_forget(SluiceDemandLoader *loader, uint32_t first, uint64_t count)
{
    struct page_range range = {first, count};
    if (loader->remakes.count)
        slc_remakes_drop(&loader->remakes, is_in_range, &range);
}
