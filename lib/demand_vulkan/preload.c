/* Preloads: levels that the application requests, loaded a few tiles at a time, coarse ones first.
 */
#include "base/alloc.h"
#include "demand_vulkan/opening.h"
#include "demand_vulkan/refused_arguments.h"
#include "vulkan/sparse_layout.h"

#include <string.h>

static SluiceResult reserve(SluiceDemandLoader *loader)
{
    uint32_t old = loader->preload_capacity, capacity = old ? 2 * old : 16;
    if (loader->preload_count < old)
        return SLUICE_SUCCESS;
    struct slc_preload *preloads =
        slc_regrow(&loader->cb, loader->preloads, old, capacity, sizeof *preloads);
    if (!preloads)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    loader->preloads = preloads;
    loader->preload_capacity = capacity;
    return SLUICE_SUCCESS;
}

/* Reads the area of `region`. The image need not be open. The level may be above the last if the
 * region has no width. */
static SluiceResult read_area(const SluiceDemandLoader *loader, const SluiceImageInfo *info,
                              const SluiceImageRegion *region, const char *function,
                              struct slc_remake_area *area)
{
    SluiceImageRegion all = *region;
    if (region->width == 0) {
        all.mipLevel = slc_min_u32(region->mipLevel, info->mipLevelCount - 1);
        all.width = slc_mip_size(info->width, all.mipLevel);
        all.height = slc_mip_size(info->height, all.mipLevel);
    }
    return slc_remake_area_read(area, info, &all, UINT32_MAX, function, &loader->vk.log);
}

static const SluiceImageInfo *find_info(const SluiceDemandLoader *loader, uint32_t index)
{
    const struct slc_demand_texture *texture = &loader->textures[index];
    if (texture->made)
        return &texture->made->info;
    bool open =
        texture->image != SLC_NONE && loader->images[texture->image]->state == SLC_IMAGE_OPEN;
    return open ? &loader->images[texture->image]->info : NULL;
}

static SluiceResult begin(SluiceDemandLoader *loader, const char *function,
                          SluiceDemandTextureId id, const SluiceImageRegion *region,
                          SluiceDemandTicket *given)
{
    uint32_t index;
    SluiceDemandTicket ticket;
    struct slc_remake_area area;
    SluiceResult result = slc_texture_find(loader, id, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[index].kind == SLC_TEXTURE_VARIANT)
        index = loader->textures[index].base;
    if (loader->textures[index].kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, function, id);
    const SluiceImageInfo *info = find_info(loader, index);
    if (info)
        result = read_area(loader, info, region, function, &area);
    if (result == SLUICE_SUCCESS)
        result = reserve(loader);
    if (result == SLUICE_SUCCESS)
        result = slc_ticket_open(&loader->tickets, &ticket);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_ticket_add(&loader->tickets, ticket, 1); /* placeholder until the number is known */
    loader->preloads[loader->preload_count++] =
        (struct slc_preload){.texture = slc_texture_id(loader, index),
                             .ticket = ticket,
                             .region = *region,
                             .planned_count = 1};
    if (given)
        *given = ticket;
    slc_preloads_continue(loader);
    return SLUICE_SUCCESS;
}

SluiceResult sluicePreloadDemandTexture(SluiceDemandLoader *loader, SluiceDemandTextureId textureId,
                                        uint32_t finestLevel, SluiceDemandTicket *pTicket)
{
    const SluiceImageRegion levels = {.mipLevel = finestLevel};
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    return begin(loader, __func__, textureId, &levels, pTicket);
}

SluiceResult sluicePreloadDemandRegion(SluiceDemandLoader *loader, SluiceDemandTextureId textureId,
                                       const SluiceImageRegion *pRegion,
                                       SluiceDemandTicket *pTicket)
{
    if (!loader || !pRegion)
        return SLUICE_ERROR_NULL_POINTER;
    if (pRegion->width == 0 || pRegion->height == 0)
        return slc_demand_refuse(loader, __func__, "the region has %u x %u texels", pRegion->width,
                                 pRegion->height);
    return begin(loader, __func__, textureId, pRegion, pTicket);
}

/* Finds the open image of a preload. NULL: nothing to load now; `*over`: and never will be. */
static struct slc_demand_image *find_image(SluiceDemandLoader *loader, struct slc_preload *preload,
                                           bool *over)
{
    uint32_t index;
    SluiceResult result;
    *over =
        preload->detached || slc_texture_find(loader, preload->texture, &index) != SLUICE_SUCCESS ||
        slc_ticket_is_canceled(&loader->tickets, preload->ticket) || loader->textures[index].failed;
    if (*over)
        return NULL;
    const struct slc_demand_texture *texture = &loader->textures[index];
    if (texture->image != SLC_NONE && loader->images[texture->image]->state == SLC_IMAGE_OPEN)
        return loader->images[texture->image];
    if (texture->image != SLC_NONE)
        return NULL;
    *over = preload->opening; /* the opening has failed */
    if (*over)
        return NULL;
    preload->opening =
        slc_image_request(loader, index, preload->ticket, &result) == SLC_REQUEST_LOAD;
    return NULL;
}

static void drop_planned(SluiceDemandLoader *loader, struct slc_preload *preload, uint32_t count)
{
    slc_ticket_drop(&loader->tickets, preload->ticket, count);
    preload->planned_count -= count;
}

/* Plans the tiles of a preload. False: the image has no such region. */
static bool plan(SluiceDemandLoader *loader, struct slc_preload *preload,
                 const struct slc_demand_image *image)
{
    if (read_area(loader, &image->info, &preload->region, "sluicePreloadDemandRegion",
                  &preload->area) != SLUICE_SUCCESS)
        return false;
    uint64_t count = slc_remake_count(&preload->area, image->regular_count, image->tile_width,
                                      image->tile_height);
    uint32_t tasks = count < INT32_MAX ? (uint32_t)count : INT32_MAX;
    preload->planned = true;
    preload->level = image->regular_count; /* the tail */
    slc_ticket_add(&loader->tickets, preload->ticket, tasks);
    preload->planned_count += tasks;
    drop_planned(loader, preload, 1);
    return true;
}

/* Gets the next page of a preload. False: there is none. */
static bool next_page(struct slc_preload *preload, const struct slc_demand_image *image,
                      uint32_t *page)
{
    const struct slc_remake_area *area = &preload->area;
    struct slc_remake_tiles t = {.end_x = 1, .end_y = 1}; /* the tail */
    if (preload->level < image->regular_count)
        t = slc_remake_tiles(area, preload->level, image->tile_width, image->tile_height);
    if (preload->next_page == (t.end_x - t.x) * (t.end_y - t.y)) {
        if (preload->level <= area->region.mipLevel)
            return false;
        preload->level--;
        preload->next_page = 0;
        t = slc_remake_tiles(area, preload->level, image->tile_width, image->tile_height);
    }
    uint32_t width = t.end_x - t.x, n = preload->next_page++;
    *page = preload->level == image->regular_count
                ? image->tail_page
                : image->first_pages[preload->level] +
                      (t.y + n / width) * slc_image_level_width(image, preload->level) + t.x +
                      n % width;
    return true;
}

/* True if there is room without evictions: preloads never evict. */
static bool has_room(SluiceDemandLoader *loader)
{
    struct slc_residency_counts counts;
    slc_residency_get_counts(loader->residency, SLC_CLASS_TILES, &counts);
    return counts.resident + counts.loading < slc_tile_memory_limit(&loader->tiles);
}

/* Advances a preload. Returns true when it is done. */
static bool advance(SluiceDemandLoader *loader, struct slc_preload *preload)
{
    bool over;
    const struct slc_demand_image *image = find_image(loader, preload, &over);
    if (!image)
        return over;
    if (!preload->planned && !plan(loader, preload, image))
        return true;
    /* Counts as used: the next launch may sample the image. */
    slc_image_touch(loader, loader->images[image->slot], loader->launch + 1);
    while (slc_job_is_ready(loader, slc_tile_job_kind(image))) {
        uint32_t page;
        SluiceResult result;
        if (!has_room(loader) || !next_page(preload, image, &page))
            return true;
        enum slc_request_answer answer =
            slc_tile_request(loader, loader->images[image->slot], page, preload->ticket, &result);
        if (answer == SLC_REQUEST_POSTPONED && loader->tiles.awaits) {
            preload->next_page--;
            return false; /* waits for an equal tile that is being loaded */
        }
        if (preload->planned_count)
            drop_planned(loader, preload, 1);
    }
    return false;
}

void slc_preloads_continue(SluiceDemandLoader *loader)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < loader->preload_count; i++) {
        struct slc_preload *preload = &loader->preloads[i];
        if (advance(loader, preload)) {
            drop_planned(loader, preload, preload->planned_count);
            slc_ticket_close(&loader->tickets, preload->ticket);
        } else {
            loader->preloads[kept++] = *preload;
        }
    }
    loader->preload_count = kept;
}

void slc_preloads_detach(SluiceDemandLoader *loader, uint32_t texture)
{
    for (uint32_t i = 0; i < loader->preload_count; i++) {
        struct slc_preload *preload = &loader->preloads[i];
        if ((uint32_t)preload->texture == texture && preload->planned)
            preload->detached = true;
    }
}

void slc_preloads_finish(SluiceDemandLoader *loader)
{
    slc_free(&loader->cb, loader->preloads, loader->preload_capacity, sizeof *loader->preloads);
    loader->preloads = NULL;
}
