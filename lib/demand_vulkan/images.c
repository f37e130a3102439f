/* Images, from the request that opens them until no launch names their pages. */
#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "demand_vulkan/opening.h"
#include "demand_vulkan/pages.h"
#include "demand_vulkan/demand_strict.h"
#include "image/pooled_reads.h"

#include <sluice/shared/demand.h>

#include <assert.h>
#include <string.h>

#define OPENING_PRIORITY 16u /* above all ranks */

static SluiceResult grow(SluiceDemandLoader *loader)
{
    uint32_t old = loader->image_capacity, capacity = old ? 2 * old : 64;
    struct slc_demand_image **images =
        slc_regrow(&loader->cb, loader->images, old, capacity, sizeof(struct slc_demand_image *));
    if (!images)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    loader->images = images;
    loader->image_capacity = capacity;
    return SLUICE_SUCCESS;
}

static SluiceResult add_slot(SluiceDemandLoader *loader, struct slc_demand_image **image)
{
    uint32_t slot = loader->image_high;
    if (slot == loader->max_image_count)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    SluiceResult result = slot == loader->image_capacity ? grow(loader) : SLUICE_SUCCESS;
    uint32_t tail_page;
    if (result == SLUICE_SUCCESS)
        result = slc_table_mirror_reserve(&loader->levels, slot + 2);
    if (result == SLUICE_SUCCESS)
        result = slc_image_find_tail(loader, slot, &tail_page);
    if (result != SLUICE_SUCCESS)
        return result;
    *image = slc_calloc(&loader->cb, 1, sizeof **image);
    if (!*image)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    **image = (struct slc_demand_image){.slot = slot, .tail_page = tail_page};
    loader->images[slot] = *image;
    loader->image_high++;
    return SLUICE_SUCCESS;
}

static SluiceResult take_slot(SluiceDemandLoader *loader, uint32_t texture,
                              struct slc_demand_image **image)
{
    if (loader->free_image != SLC_NONE) {
        *image = loader->images[loader->free_image];
        loader->free_image = (*image)->next;
    } else {
        SluiceResult result = add_slot(loader, image);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    struct slc_demand_image *taken = *image;
    *taken = (struct slc_demand_image){.state = SLC_IMAGE_OPENING,
                                       .slot = taken->slot,
                                       .texture = texture,
                                       .next = SLC_NONE,
                                       .origin = loader->textures[texture].source,
                                       .loader = loader,
                                       .made = loader->textures[texture].made,
                                       .source = loader->textures[texture].source.source,
                                       .tail_page = taken->tail_page};
    loader->textures[texture].image = taken->slot;
    return SLUICE_SUCCESS;
}

static void free_slot(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    image->state = SLC_IMAGE_FREE;
    image->next = loader->free_image;
    loader->free_image = image->slot;
}

/* Reads the base color, and before that opens the image if it is not open. */
static SluiceResult submit_opening(SluiceDemandLoader *loader, struct slc_demand_image *image,
                                   SluiceDemandTicket ticket)
{
    struct slc_demand_job *job = slc_job_take(loader, SLC_JOB_OPEN);
    if (!job)
        return SLUICE_NOT_READY;
    const SluiceImageRegion region = {.width = 1, .height = 1};
    void *texels = image->read_color;
    job->page = image->texture;
    job->owner = image->slot;
    job->image = image;
    job->id = slc_texture_id(loader, image->texture);
    SluiceTileRead read = {.source = &loader->opener,
                           .regionCount = 1,
                           .pRegions = &region,
                           .ppTexels = &texels,
                           .priority = OPENING_PRIORITY};
    SluiceResult result = slc_job_submit(loader, job, &read, ticket);
    if (result == SLUICE_SUCCESS)
        image->job_count++;
    else
        slc_job_free(loader, job);
    return result;
}

static void note_opened(SluiceDemandLoader *loader, const struct slc_demand_image *image)
{
    struct slc_demand_texture *texture = &loader->textures[image->texture];
    if (!texture->told || texture->told_tail)
        return;
    texture->told = false;
    slc_retries_note_opened(loader);
    slc_log(&loader->vk.log, SLUICE_LOG_INFO, "%s: can be opened again.", slc_image_name(image));
}

/* Takes pages for an image, and fills in the words for shaders. */
static SluiceResult lay_out(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    SluiceResult result = sluiceGetFormatInfo(image->info.format, &format);
    if (result == SLUICE_SUCCESS)
        result =
            sluiceGetStandardTileShape(image->info.format, &image->tile_width, &image->tile_height);
    image->blocks = format.blockWidth > 1;
    if (result == SLUICE_SUCCESS)
        result = slc_image_take_levels(loader, image);
    if (result == SLUICE_ERROR_LIMIT_EXCEEDED)
        slc_demand_strict_no_ids(loader, slc_image_name(image));
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t *words =
        ((struct slc_mirror_element *)slc_table_mirror_change(&loader->levels, 1 + image->slot))
            ->words;
    memcpy(words, image->first_pages, sizeof image->first_pages);
    memcpy(image->base_color, image->read_color, sizeof image->base_color);
    image->state = SLC_IMAGE_OPEN;
    image->generation = slc_page_share_generation(loader->pages, image->source);
    slc_page_pool_prepare(loader->pages, loader->page_user,
                          slc_page_format(image->info.format, image->made));
    slc_image_enter_order(loader, image);
    slc_texture_show_image(loader, image);
    loader->counts.texturesOpened++;
    note_opened(loader, image);
    return SLUICE_SUCCESS;
}

/* Closes the source of an image without reads in progress. */
static void close_source(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    if (!image->source)
        return;
    sluiceDropTileLoaderStatistics(loader->reader, image->source);
    if (image->origin.source)
        image->source = NULL; /* the application's own */
    else if (image->origin.pfnClose)
        image->origin.pfnClose(image->origin.pUserData, image->source);
    else
        sluiceDestroyImageSource(image->source);
    image->source = NULL;
}

static void fail(SluiceDemandLoader *loader, struct slc_demand_image *image, SluiceResult result)
{
    struct slc_demand_texture *texture = &loader->textures[image->texture];
    char retrying[48];
    if (!texture->told)
        slc_log(&loader->vk.log, SLUICE_LOG_ERROR,
                "%s cannot be used as a texture (index %u): %s%s%s; %s.", slc_image_name(image),
                image->texture, sluiceGetResultName(result), image->trouble ? ": " : "",
                image->trouble ? image->trouble : "",
                slc_retries_words(loader, retrying, sizeof retrying));
    texture->told = true;
    texture->failed = slc_retries_add_opening(loader, image->texture);
    if (!texture->failed)
        return; /* the texture stays unknown, so shaders request it again */
    loader->counts.texturesFailed++;
    slc_texture_show_failed(loader, image->texture);
}

/* Gives up an image that cannot be opened or used. Only the failure of its texture remains. */
static void give_up(SluiceDemandLoader *loader, struct slc_demand_image *image, SluiceResult result)
{
    if (!slc_result_may_pass(result))
        fail(loader, image, result);
    loader->textures[image->texture].image = SLC_NONE;
    close_source(loader, image);
    free_slot(loader, image);
}

/* Opens a produced image. All facts are known, so no read is necessary. */
static enum slc_request_answer open_made(SluiceDemandLoader *loader, uint32_t texture,
                                         SluiceResult *result)
{
    struct slc_demand_image *image;
    *result = take_slot(loader, texture, &image);
    if (*result == SLUICE_SUCCESS) {
        image->info = image->made->info;
        memcpy(image->read_color, image->made->last_color, sizeof image->read_color);
        *result = lay_out(loader, image);
        if (*result == SLUICE_SUCCESS)
            return SLC_REQUEST_LOAD;
        image->trouble = "pageCapacity is too small for its tiles";
        give_up(loader, image, *result);
    }
    if (*result == SLUICE_ERROR_LIMIT_EXCEEDED)
        *result = SLUICE_SUCCESS;
    return SLC_REQUEST_POSTPONED;
}

enum slc_request_answer slc_image_request(SluiceDemandLoader *loader, uint32_t texture,
                                          SluiceDemandTicket ticket, SluiceResult *result)
{
    *result = SLUICE_SUCCESS;
    if (texture >= loader->texture_high)
        return SLC_REQUEST_RESIDENT;
    if (loader->textures[texture].kind == SLC_TEXTURE_VARIANT)
        texture = loader->textures[texture].base;
    struct slc_demand_texture *t = &loader->textures[texture];
    if (t->kind != SLC_TEXTURE_IMAGE || t->failed)
        return SLC_REQUEST_RESIDENT;
    if (t->image != SLC_NONE)
        return loader->images[t->image]->state == SLC_IMAGE_OPENING ? SLC_REQUEST_PENDING
                                                                    : SLC_REQUEST_RESIDENT;
    struct slc_demand_image *image;
    if (t->made)
        return open_made(loader, texture, result);
    if (loader->free_other_count == 0)
        return SLC_REQUEST_POSTPONED;
    *result = take_slot(loader, texture, &image);
    if (*result == SLUICE_SUCCESS)
        *result = submit_opening(loader, image, ticket);
    if (*result == SLUICE_SUCCESS)
        return SLC_REQUEST_LOAD;
    if (loader->textures[texture].image != SLC_NONE) {
        loader->textures[texture].image = SLC_NONE;
        free_slot(loader, image);
    }
    if (*result == SLUICE_NOT_READY || *result == SLUICE_ERROR_LIMIT_EXCEEDED)
        *result = SLUICE_SUCCESS;
    return SLC_REQUEST_POSTPONED;
}

void slc_image_job_back(SluiceDemandLoader *loader, struct slc_demand_image *image,
                        const struct slc_demand_job *job, SluiceResult result)
{
    bool opening = image->state == SLC_IMAGE_OPENING;
    slc_image_end_opening(image, result == SLUICE_SUCCESS);
    if (image->state == SLC_IMAGE_OPEN && result == SLUICE_SUCCESS && !job->stale) {
        memcpy(image->base_color, image->read_color, sizeof image->base_color);
        slc_texture_show_image(loader, image);
    }
    if (opening && result == SLUICE_SUCCESS)
        result = lay_out(loader, image);
    if (opening && result != SLUICE_SUCCESS) {
        if (result == SLUICE_ERROR_LIMIT_EXCEEDED && !image->trouble)
            image->trouble = "pageCapacity is too small for its tiles";
        image->job_count--;
        give_up(loader, image, result);
        return;
    }
    slc_image_release(loader, image);
}

static void retire(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    close_source(loader, image);
    slc_image_give_levels(loader, image);
    image->state = SLC_IMAGE_RETIRED;
    image->launch = loader->launch;
    image->next = SLC_NONE;
    if (loader->first_retired_image == SLC_NONE)
        loader->first_retired_image = image->slot;
    else
        loader->images[loader->last_retired_image]->next = image->slot;
    loader->last_retired_image = image->slot;
}

void slc_image_release(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    assert(image->job_count > 0);
    if (--image->job_count == 0 && image->state == SLC_IMAGE_DETACHED)
        retire(loader, image);
}

static void drop_jobs(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    if (image->job_count == 0 && loader->copied.first == SLC_NONE)
        return; /* copied jobs count: an abandoned launch repeats them */
    slc_jobs_drop(loader, slc_tile_job_kind(image), image->slot, 0, UINT64_MAX);
    slc_jobs_drop(loader, SLC_JOB_OPEN, image->slot, 0, UINT64_MAX);
}

static void leave_refresh_list(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    if (!image->refresh)
        return;
    image->refresh = false;
    if (loader->first_refresh == image->slot) {
        loader->first_refresh = image->next;
        return;
    }
    uint32_t at = loader->first_refresh;
    while (loader->images[at]->next != image->slot)
        at = loader->images[at]->next;
    loader->images[at]->next = image->next;
}

/* Ends the use of an image that has no texture and no pages any more. */
static void end_use(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    slc_image_forget(loader, image);
    if (image->state == SLC_IMAGE_OPEN)
        slc_image_leave_order(loader, image);
    loader->textures[image->texture].image = SLC_NONE;
}

void slc_image_detach(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    leave_refresh_list(loader, image);
    if (image->source)
        slc_page_share_leave(loader->pages, loader->page_user, image->source);
    slc_retries_all(loader, &image->retry_group);
    slc_preloads_detach(loader, image->texture);
    drop_jobs(loader, image);
    if (image->origin.source &&
        image->job_count) { /* the application may destroy the source next */
        slc_jobs_wait(loader, SLC_JOB_TILE, image->slot);
        slc_jobs_wait(loader, SLC_JOB_OPEN, image->slot);
    }
    slc_loader_drop_texels(loader->reader, image->origin.source);
    slc_image_forget_requests(loader, image);
    end_use(loader, image);
    image->state = SLC_IMAGE_DETACHED;
    if (image->job_count == 0)
        retire(loader, image);
}

bool slc_image_is_idle(const SluiceDemandLoader *loader, const struct slc_demand_image *image)
{
    return image->state == SLC_IMAGE_OPEN && image->job_count == 0 && !image->refresh &&
           image->last_use < loader->processed;
}

/* No copy of the image's tiles is in progress, because last_use is the launch of the last copy or
 * later. Requests that shaders left behind load an unnecessary page at worst. */
void slc_image_forget_texture(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    assert(slc_image_is_idle(loader, image));
    if (image->source)
        slc_page_share_leave(loader->pages, loader->page_user, image->source);
    slc_retries_all(loader, &image->retry_group);
    slc_preloads_detach(loader, image->texture);
    slc_texture_show_unknown(loader, image->texture);
    end_use(loader, image);
    retire(loader, image);
    loader->counts.texturesForgotten++;
}

void slc_image_fail(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    uint32_t texture = image->texture;
    bool failed = slc_retries_add_opening(loader, texture);
    loader->textures[texture].failed = failed;
    loader->counts.texturesFailed++;
    slc_image_detach(loader, image);
    if (failed)
        slc_texture_show_failed(loader, texture);
    else
        slc_texture_show_unknown(loader, texture); /* shaders request it again */
}

void slc_image_invalidate(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    if (image->state != SLC_IMAGE_OPEN)
        return; /* the read in progress delivers the new texels */
    drop_jobs(loader, image);
    slc_loader_drop_texels(loader->reader, image->source);
    if (image->source)
        image->generation = slc_page_share_drop(loader->pages, image->source);
    slc_retries_all(loader, &image->retry_group);
    slc_image_forget(loader, image);
    if (image->refresh || image->made)
        return;
    image->refresh = true;
    image->next = loader->first_refresh;
    loader->first_refresh = image->slot;
}

void slc_images_refresh(SluiceDemandLoader *loader)
{
    uint32_t next, waiting = SLC_NONE;
    for (uint32_t slot = loader->first_refresh; slot != SLC_NONE; slot = next) {
        struct slc_demand_image *image = loader->images[slot];
        next = image->next;
        /* One job at a time writes the color. */
        image->refresh = image->job_count || submit_opening(loader, image, 0) != SLUICE_SUCCESS;
        if (!image->refresh)
            continue;
        image->next = waiting;
        waiting = slot;
    }
    loader->first_refresh = waiting;
}

void slc_images_end_retired(SluiceDemandLoader *loader)
{
    while (loader->first_retired_image != SLC_NONE) {
        struct slc_demand_image *image = loader->images[loader->first_retired_image];
        if (image->launch > loader->processed)
            return;
        loader->first_retired_image = image->next;
        free_slot(loader, image);
    }
}

void slc_images_finish(SluiceDemandLoader *loader)
{
    for (uint32_t i = 0; i < loader->image_high; i++) {
        close_source(loader, loader->images[i]);
        slc_free(&loader->cb, loader->images[i], 1, sizeof *loader->images[i]);
    }
    slc_free(&loader->cb, loader->images, loader->image_capacity,
             sizeof(struct slc_demand_image *));
    slc_free(&loader->cb, loader->tail_blocks, loader->tail_block_capacity,
             sizeof *loader->tail_blocks);
    loader->images = NULL;
}
