/* Tiles and tails: their texels and reads. */
#include "demand_vulkan/tiles.h"

#include "base/log.h"
#include "demand/tail_place.h"
#include "demand_vulkan/opening.h"

#include <assert.h>

#define STAGING_ALIGNMENT 16u /* bytes: multiple of every texel and block size */

uint32_t slc_tile_level(const struct slc_demand_image *image, uint32_t page, uint32_t *index)
{
    for (uint32_t l = 0; l < image->regular_count; l++) {
        uint32_t count = slc_image_level_width(image, l) * slc_image_level_height(image, l);
        *index = page - image->first_pages[l];
        if (page >= image->first_pages[l] && *index < count)
            return l;
    }
    *index = 0;
    return image->regular_count; /* the tail */
}

static struct slc_tail_cut tail_cut(const struct slc_demand_image *image)
{
    return slc_tail_cut(image->tile_width, image->tile_height, image->blocks,
                        slc_mip_size(image->info.width, image->regular_count),
                        slc_mip_size(image->info.height, image->regular_count),
                        image->info.mipLevelCount - image->regular_count);
}

static uint32_t write_tail(const struct slc_demand_image *image, uint32_t place,
                           struct slc_tile_part parts[SLC_TILE_MAX_PARTS])
{
    uint32_t count = image->info.mipLevelCount - image->regular_count, offset = 0;
    assert(count <= SLC_TILE_MAX_PARTS);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t level = image->regular_count + k;
        uint32_t width = slc_mip_size(image->info.width, level);
        uint32_t height = slc_mip_size(image->info.height, level);
        struct slc_demand_place at =
            slc_demand_tail_place(image->tile_width, image->tile_height, image->blocks, place, k);
        parts[k] = (struct slc_tile_part){
            {level, 0, 0, width, height, image->origin.arrayLayer}, offset, at.x, at.y};
        uint32_t size = (uint32_t)sluiceGetFormatRegionSize(image->info.format, width, height);
        offset += (size + STAGING_ALIGNMENT - 1) / STAGING_ALIGNMENT * STAGING_ALIGNMENT;
    }
    return count;
}

static SluiceImageRegion tile_region(const struct slc_demand_image *image, uint32_t level,
                                     uint32_t index)
{
    uint32_t x = index % slc_image_level_width(image, level) * image->tile_width;
    uint32_t y = index / slc_image_level_width(image, level) * image->tile_height;
    return (SluiceImageRegion){
        .mipLevel = level,
        .x = x,
        .y = y,
        .width = slc_min_u32(image->tile_width, slc_mip_size(image->info.width, level) - x),
        .height = slc_min_u32(image->tile_height, slc_mip_size(image->info.height, level) - y),
        .arrayLayer = image->origin.arrayLayer};
}

uint32_t slc_tile_parts(const struct slc_demand_image *image, uint32_t page, uint32_t place,
                        struct slc_tile_part parts[SLC_TILE_MAX_PARTS])
{
    uint32_t index, level = slc_tile_level(image, page, &index);
    if (level == image->regular_count)
        return write_tail(image, place, parts);
    parts[0] = (struct slc_tile_part){.region = tile_region(image, level, index)};
    return 1;
}

static SluiceResult submit(SluiceDemandLoader *loader, struct slc_demand_image *image,
                           struct slc_demand_job *job, uint32_t rank, SluiceDemandTicket ticket)
{
    struct slc_tile_part parts[SLC_TILE_MAX_PARTS];
    SluiceImageRegion regions[SLC_TILE_MAX_PARTS];
    void *texels[SLC_TILE_MAX_PARTS];
    uint32_t count = slc_tile_parts(image, job->page, job->place, parts);
    for (uint32_t i = 0; i < count; i++) {
        regions[i] = parts[i].region;
        texels[i] = slc_job_memory(loader, job) + parts[i].offset;
    }
    SluiceTileRead read = {.source = image->source,
                           .regionCount = count,
                           .pRegions = regions,
                           .ppTexels = texels,
                           .priority = SLUICE_DEMAND_RANKS - rank};
    return slc_job_submit(loader, job, &read, ticket);
}

/* Begins the read of a page that has a place. */
static SluiceResult begin_read(SluiceDemandLoader *loader, struct slc_demand_image *image,
                               const struct slc_page_request *request, SluiceDemandTicket ticket)
{
    struct slc_demand_job *job = slc_job_take(loader, SLC_JOB_TILE);
    job->page = request->page;
    job->owner = image->slot;
    job->image = image;
    job->id = slc_texture_id(loader, image->texture);
    job->place = slc_residency_place(loader->residency, request->page);
    SluiceResult result = submit(loader, image, job, request->rank, ticket);
    if (result == SLUICE_SUCCESS) {
        image->job_count++;
        loader->reading_count++;
    } else {
        slc_job_free(loader, job);
    }
    return result;
}

/* Requests a page that can share the texels of an equal tile, if there is a key. */
static enum slc_request_answer request_shared(SluiceDemandLoader *loader,
                                              const struct slc_page_request *request,
                                              const struct slc_tile_key *key, SluiceResult *result)
{
    struct slc_tile_memory *tiles = &loader->tiles;
    tiles->offered = key;
    tiles->offer_taken = false;
    tiles->retaken = SLC_NO_PLACE;
    enum slc_request_answer answer = slc_residency_request(loader->residency, request, result);
    tiles->offered = NULL;
    if (answer != SLC_REQUEST_LOAD || !tiles->offer_taken)
        return answer;
    slc_residency_loaded(loader->residency, request->page,
                         slc_residency_place(loader->residency, request->page));
    loader->counts.sharedCount++;
    loader->has_shared = true;
    return SLC_REQUEST_RESTORED;
}

/* Requests a page. `key`: key of a tile that can be shared; or NULL. */
static enum slc_request_answer request_page(SluiceDemandLoader *loader,
                                            struct slc_demand_image *image,
                                            const struct slc_page_request *request,
                                            const struct slc_tile_key *key,
                                            SluiceDemandTicket ticket, SluiceResult *result)
{
    struct slc_page_pool *pool = loader->pages;
    slc_images_make_room(loader, request->page);
    enum slc_share share = SLC_SHARE_NONE;
    if (key && slc_residency_is_absent(loader->residency, request->page))
        share = slc_page_share_look(pool, loader->page_user, key);
    loader->tiles.awaits = share == SLC_SHARE_WAIT;
    if (share == SLC_SHARE_WAIT)
        return SLC_REQUEST_POSTPONED;
    enum slc_request_answer answer =
        request_shared(loader, request, share == SLC_SHARE_READY ? key : NULL, result);
    if (key && loader->tiles.retaken != SLC_NO_PLACE)
        slc_page_share_adopt(pool, loader->page_user, key, loader->tiles.retaken);
    if (answer != SLC_REQUEST_LOAD)
        return answer;
    if (image->made) {
        slc_tile_production_begin(loader, image, request->page);
        return SLC_REQUEST_LOAD;
    }
    *result = begin_read(loader, image, request, ticket);
    if (*result == SLUICE_SUCCESS && key) {
        slc_page_share_announce(pool, loader->page_user, key);
        slc_page_share_place(pool, loader->page_user, key,
                             slc_residency_place(loader->residency, request->page));
    }
    if (*result == SLUICE_SUCCESS)
        return SLC_REQUEST_LOAD;
    slc_residency_failed(loader->residency, request->page, false);
    return SLC_REQUEST_POSTPONED;
}

void slc_tiles_limit(SluiceDemandLoader *loader)
{
    uint64_t limit = slc_tile_memory_limit_now(&loader->tiles);
    if (limit == loader->tile_limit)
        return;
    loader->tile_limit = limit;
    slc_residency_set_class(loader->residency, SLC_CLASS_TILES, limit, &loader->tile_interface);
}

/* Requests a tail. Tails are not shared: streamers have packed levels in images of their own. */
static enum slc_request_answer request_tail(SluiceDemandLoader *loader,
                                            struct slc_demand_image *image,
                                            const struct slc_page_request *request,
                                            SluiceDemandTicket ticket, SluiceResult *result)
{
    struct slc_tile_memory *tiles = &loader->tiles;
    struct slc_tail_cut cut = tail_cut(image);
    tiles->tail = &cut;
    tiles->tail_format = (SluiceFormat)request->kind;
    slc_tiles_limit(loader);
    enum slc_request_answer answer = request_page(loader, image, request, NULL, ticket, result);
    tiles->tail = NULL;
    if (answer == SLC_REQUEST_LOAD)
        slc_image_gets_tail(loader, image);
    slc_tiles_limit(loader);
    return answer;
}

enum slc_request_answer slc_tile_request(SluiceDemandLoader *loader, struct slc_demand_image *image,
                                         uint32_t page, SluiceDemandTicket ticket,
                                         SluiceResult *result)
{
    *result = SLUICE_SUCCESS;
    loader->tiles.awaits = false;
    if (image->state != SLC_IMAGE_OPEN)
        return SLC_REQUEST_RESIDENT; /* the requested owner is gone */
    if (!slc_job_is_ready(loader, slc_tile_job_kind(image)))
        return SLC_REQUEST_POSTPONED;
    bool tail = page == image->tail_page;
    uint32_t index, level = slc_tile_level(image, page, &index);
    if (level == image->regular_count && !tail)
        return SLC_REQUEST_RESIDENT; /* an unused id: ranges are whole blocks of ids */
    const struct slc_page_request request = {
        .page = page,
        .class_index = SLC_CLASS_TILES,
        .rank = (uint8_t)(tail ? 0 : slc_image_level_rank(image, level)),
        .pinned = tail,
        .kind = slc_page_format(image->info.format, image->made)};
    if (tail)
        return request_tail(loader, image, &request, ticket, result);
    if (image->made)
        return request_page(loader, image, &request, NULL, ticket, result);
    const SluiceImageRegion region = tile_region(image, level, index);
    const struct slc_tile_key key = slc_tile_key(image->source, &region, image->generation);
    return request_page(loader, image, &request, &key, ticket, result);
}

/* Logs a failure once per image until a read succeeds again. Statistics count all failures. */
static void log_failure(const SluiceDemandLoader *loader, struct slc_demand_image *image,
                        uint32_t page, SluiceResult result)
{
    const char *name = slc_image_name(image);
    struct slc_demand_texture *texture = &loader->textures[image->texture];
    char retrying[48];
    slc_retries_words(loader, retrying, sizeof retrying);
    const char *done = image->made ? "made" : "read";
    uint32_t index, level = slc_tile_level(image, page, &index);
    if (level == image->regular_count && !texture->told)
        slc_log(&loader->vk.log, SLUICE_LOG_ERROR,
                "%s: levels from %u on cannot be %s, and so it cannot be sampled: %s; %s.", name,
                level, done, sluiceGetResultName(result), retrying);
    else if (level < image->regular_count && !image->told)
        slc_log(&loader->vk.log, SLUICE_LOG_WARNING,
                "%s: level %u, tile (%u, %u) cannot be %s: %s. Showing a coarser level; %s.", name,
                level, index % slc_image_level_width(image, level),
                index / slc_image_level_width(image, level), done, sluiceGetResultName(result),
                retrying);
    if (level == image->regular_count)
        texture->told = texture->told_tail = true;
    else
        image->told = true;
}

/* A tail that is loaded ends its texture's trouble; a tile that had failed ends its image's. */
void slc_tile_note_success(SluiceDemandLoader *loader, struct slc_demand_image *image,
                           uint32_t page)
{
    struct slc_demand_texture *texture = &loader->textures[image->texture];
    bool tail = page == image->tail_page && image->state == SLC_IMAGE_OPEN;
    bool had_group = image->retry_group != 0;
    slc_retries_success(loader, &image->retry_group, page);
    bool well = (tail && texture->told) || (image->told && had_group && image->retry_group == 0);
    if (well)
        slc_log(&loader->vk.log, SLUICE_LOG_INFO, "%s: can be %s again.", slc_image_name(image),
                image->made ? "made" : "read");
    if (well)
        image->told = false;
    if (tail)
        texture->told = texture->told_tail = false;
}

void slc_tile_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result,
                       uint64_t size)
{
    struct slc_demand_image *image = job->image;
    loader->counts.bytesRead += size;
    loader->reading_count--;
    if (result == SLUICE_SUCCESS && !job->stale) {
        slc_tile_note_success(loader, image, job->page);
        slc_job_list_append(loader, &loader->arrived, job);
        return;
    }
    slc_tile_fail(loader, job, result, !job->stale && !slc_result_may_pass(result));
}

void slc_tile_fail(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result,
                   bool failed)
{
    struct slc_demand_image *image = job->image;
    uint32_t page = job->page;
    bool tail = page == image->tail_page;
    bool refuse = failed && (tail || slc_retries_add(loader, &image->retry_group, page));
    slc_residency_failed(loader->residency, page, refuse);
    if (failed)
        log_failure(loader, image, page, result);
    slc_job_free(loader, job);
    slc_image_release(loader, image);
    if (failed && tail && image->state == SLC_IMAGE_OPEN)
        slc_image_fail(loader, image);
}
