/* Levels that are loaded because the application says so, a few at a time: coarse ones first. */
#include "base/alloc.h"
#include "demand_vulkan/opening.h"
#include "demand_vulkan/refused_arguments.h"

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

SluiceResult sluicePreloadDemandTexture(SluiceDemandLoader *loader, SluiceDemandTextureId textureId,
                                        uint32_t finestLevel, SluiceDemandTicket *pTicket)
{
    uint32_t index;
    SluiceDemandTicket ticket;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_texture_find(loader, textureId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[index].kind == SLC_TEXTURE_VARIANT)
        index = loader->textures[index].base;
    if (loader->textures[index].kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, "sluicePreloadDemandTexture", textureId);
    result = reserve(loader);
    if (result == SLUICE_SUCCESS)
        result = slc_ticket_open(&loader->tickets, &ticket);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_ticket_add(&loader->tickets, ticket, 1); /* until it is known how many there are */
    loader->preloads[loader->preload_count++] =
        (struct slc_preload){.texture = slc_texture_id(loader, index),
                             .ticket = ticket,
                             .finest_level = finestLevel,
                             .planned_count = 1};
    if (pTicket)
        *pTicket = ticket;
    slc_preloads_continue(loader);
    return SLUICE_SUCCESS;
}

/* NULL: there is nothing to load, or not yet; `*over`: nor will there be. */
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
    *over = preload->opening; /* and could not be */
    if (*over)
        return NULL;
    preload->opening =
        slc_image_request(loader, index, preload->ticket, &result) == SLC_REQUEST_LOAD;
    return NULL;
}

static uint64_t count_pages(const struct slc_demand_image *image, uint32_t finest_level)
{
    uint64_t count = 1;
    for (uint32_t l = finest_level; l < image->regular_count; l++)
        count += (uint64_t)slc_image_level_width(image, l) * slc_image_level_height(image, l);
    return count;
}

static void drop_planned(SluiceDemandLoader *loader, struct slc_preload *preload, uint32_t count)
{
    slc_ticket_drop(&loader->tickets, preload->ticket, count);
    preload->planned_count -= count;
}

static void plan(SluiceDemandLoader *loader, struct slc_preload *preload,
                 const struct slc_demand_image *image)
{
    uint64_t count = count_pages(image, preload->finest_level);
    uint32_t tasks = count < INT32_MAX ? (uint32_t)count : INT32_MAX;
    preload->planned = true;
    preload->level = image->regular_count; /* the tail */
    slc_ticket_add(&loader->tickets, preload->ticket, tasks);
    preload->planned_count += tasks;
    drop_planned(loader, preload, 1);
}

/* True: there is another page, which is `*page`. */
static bool next_page(struct slc_preload *preload, const struct slc_demand_image *image,
                      uint32_t *page)
{
    bool tail = preload->level == image->regular_count;
    uint32_t count = tail ? 1
                          : slc_image_level_width(image, preload->level) *
                                slc_image_level_height(image, preload->level);
    if (preload->next_page == count) {
        if (preload->level <= preload->finest_level || preload->level == 0)
            return false;
        preload->level--;
        preload->next_page = 0;
        tail = false;
    }
    *page = tail ? image->tail_page : image->first_pages[preload->level] + preload->next_page;
    preload->next_page++;
    return true;
}

/* What is there is not evicted for what nobody has asked for. */
static bool has_room(SluiceDemandLoader *loader)
{
    struct slc_residency_counts counts;
    slc_residency_get_counts(loader->residency, SLC_CLASS_TILES, &counts);
    return counts.resident + counts.loading < slc_tile_memory_limit(&loader->tiles);
}

/* True: it is done. */
static bool advance(SluiceDemandLoader *loader, struct slc_preload *preload)
{
    bool over;
    const struct slc_demand_image *image = find_image(loader, preload, &over);
    if (!image)
        return over;
    if (!preload->planned)
        plan(loader, preload, image);
    /* It is in use: the next launch counts as one that samples it. */
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
            return false; /* an equal tile is on its way */
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
