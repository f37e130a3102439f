#include "vulkan/load_productions.h"

#include "base/checked.h"
#include "vulkan/load_arrivals.h"
#include "vulkan/load_deferred.h"
#include "vulkan/load_reads.h"
#include "vulkan/load_units.h"
#include "vulkan/producer_calls.h"
#include "vulkan/read_troubles.h"
#include "vulkan/tile_upload.h"
#include "vulkan/unit_copies.h"

#include <assert.h>

void slc_production_start(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    struct slc_residency *residency = slc_residency_of(s, texture);
    uint32_t unit = slc_unit_take_empty(s, texture, SLC_NONE);
    s->units[unit].tile = *tile;
    slc_map_add(&s->tile_units, slc_pair_key(texture, tile->tileIndex), unit);
    /* In paged and dense mode the tile has its page at once, so this frame can record it. */
    bool at_once = !residency->interface->going_size &&
                   residency->interface->map(residency, texture, tile) == SLUICE_SUCCESS;
    s->units[unit].state = at_once ? SLC_UNIT_BINDING : SLC_UNIT_ARRIVED;
    slc_unit_list_append(s, at_once ? &s->unproduced : &s->arrived, unit);
}

/* All levels are one unit: no staging slot limits its size. */
void slc_production_start_packed(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    assert(texture->packed.unit_count == 1);
    uint32_t unit = slc_unit_take_empty(s, index, 0);
    s->units[unit].state = SLC_UNIT_ARRIVED;
    s->units[unit].next = SLC_NONE;
    texture->packed_first_unit = unit;
    texture->packed_state = SLC_PACKED_MAPPING;
    texture->packed_done = 0;
    s->packed_queue[s->packed_queue_count++] = index;
}

static void discard(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    struct slc_residency *residency = slc_residency_of(s, texture);
    if (residency->interface->discard)
        residency->interface->discard(residency, texture, tile);
}

static SluiceResult give_back(SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_unit *unit = &s->units[index];
    discard(s, unit->texture, &unit->tile);
    SluiceResult result = slc_load_give_back(s, unit->texture, &unit->tile);
    slc_unit_forget_tile(s, unit);
    slc_unit_free(s, index);
    return result;
}

static SluiceResult fail_tile(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    const struct slc_unit *unit = &s->units[index];
    discard(s, unit->texture, &unit->tile);
    SluiceResult result = sluiceReportFailedTiles(s->manager, s->textures[unit->texture].id, 1,
                                                  &unit->tile.tileIndex, s->manager_time);
    slc_read_trouble_failed(s, unit->texture, unit->tile.tileIndex, 1, answer);
    slc_unit_forget_tile(s, unit);
    slc_unit_free(s, index);
    return slc_streamer_check(s, result, "sluiceReportFailedTiles");
}

static SluiceResult fail_packed(SluiceVulkanStreamer *s, uint32_t index)
{
    uint32_t at = s->units[index].texture;
    struct slc_texture *texture = &s->textures[at];
    for (uint32_t i = 0; i < texture->packed_collected; i++)
        discard(s, at, &texture->packed_tiles[i]);
    s->units[index].next = SLC_NONE;
    texture->packed_first_unit = index;
    return slc_packed_fail(s, at);
}

static bool is_removed(const SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_unit *unit = &s->units[index];
    return unit->dropped || s->textures[unit->texture].state == SLC_TEXTURE_REMOVED;
}

static void await_frame(SluiceVulkanStreamer *s, uint32_t index)
{
    s->units[index].state = SLC_UNIT_UPLOADED;
    s->units[index].value = s->frame;
    slc_unit_list_append(s, &s->produced, index);
}

/* Applies the producer's answer to a unit: recorded, to be asked again, or failed. A mip tail that
 * failed keeps its pages until the frame is complete, because finer levels may be recorded. */
static SluiceResult answered(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    struct slc_unit *unit = &s->units[index];
    uint32_t timeout = s->textures[unit->texture].producer.timeout_frames;
    if (is_removed(s, index))
        answer = SLUICE_SUCCESS;
    switch (
        slc_producer_effect(answer, &unit->asked_frame, s->frame, timeout, slc_loads_can_wait(s))) {
    case SLC_PRODUCER_WROTE: await_frame(s, index); return SLUICE_SUCCESS;
    case SLC_PRODUCER_WAITS: slc_unit_list_append(s, &s->unproduced, index); return SLUICE_SUCCESS;
    case SLC_PRODUCER_FAILED: break;
    }
    if (unit->packed_unit == SLC_NONE)
        return fail_tile(s, index, answer);
    s->textures[unit->texture].packed_result = answer;
    await_frame(s, index);
    return SLUICE_SUCCESS;
}

static void ask(SluiceVulkanStreamer *s, struct slc_producer_calls *calls, uint32_t index,
                SluiceTileBatch *batch, SluiceResult *results)
{
    const struct slc_texture *texture = &s->textures[index];
    batch->structSize = sizeof *batch;
    batch->textureId = texture->id;
    batch->commandBuffer = calls->commands;
    batch->frameIndex = s->frame;
    slc_producer_answers_init(results, batch->tileCount);
    slc_producer_calls_order(calls, index, (uint64_t)batch->image, batch->mipLevel);
    s->manager_locked = true;
    SluiceResult result = texture->producer.pfn(texture->producer.user, batch, results);
    s->manager_locked = false;
    slc_producer_answers_end(results, batch->tileCount, result);
}

/* Sets the target of texels that are in the texture's own image. */
static void place_in_image(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                           const SluiceImageRegion *region, SluiceTileBatch *batch,
                           SluiceTileTarget *target)
{
    const VkImageView *views = s->textures[texture->first].level_views;
    batch->image = texture->image.image;
    batch->mipLevel = region->mipLevel - texture->image.first_level;
    batch->imageView = views ? views[batch->mipLevel] : VK_NULL_HANDLE;
    batch->levelWidth = slc_mip_size(texture->info.width, region->mipLevel);
    batch->levelHeight = slc_mip_size(texture->info.height, region->mipLevel);
    *target = (SluiceTileTarget){*region, region->x, region->y, texture->layer};
    target->region.arrayLayer = texture->layer;
}

static void place(const SluiceVulkanStreamer *s, const struct slc_unit *unit,
                  SluiceTileBatch *batch, SluiceTileTarget *target)
{
    const struct slc_texture *texture = &s->textures[unit->texture];
    const SluiceImageRegion region = slc_tile_region(texture, &unit->tile);
    if (!texture->residency->interface->find_page) {
        place_in_image(s, texture, &region, batch, target);
        return;
    }
    struct slc_tile_page page =
        texture->residency->interface->find_page(texture->residency, unit->texture, &unit->tile);
    batch->image = page.image;
    batch->imageView = page.view;
    batch->mipLevel = 0;
    batch->levelWidth = texture->image.desc.tileWidth;
    batch->levelHeight = texture->image.desc.tileHeight;
    *target = (SluiceTileTarget){.region = region, .layer = page.layer};
}

/* Sorts by texture, then by image or level: units with equal keys make a batch. */
static uint64_t batch_key(const SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_unit *unit = &s->units[index];
    const struct slc_residency *residency = slc_residency_of(s, unit->texture);
    uint32_t part = SLC_NONE;
    if (unit->packed_unit == SLC_NONE && residency->interface->find_page)
        part = residency->interface->find_page(residency, unit->texture, &unit->tile).image_index;
    else if (unit->packed_unit == SLC_NONE)
        part = unit->tile.mipLevel;
    return (uint64_t)unit->texture << 32 | part;
}

/* Returns the first error of two results. */
static SluiceResult first_error(SluiceResult a, SluiceResult b)
{
    return a < 0 ? a : b;
}

/* Records units of one key in one batch. Reports failures to the manager. */
static SluiceResult record_tiles(SluiceVulkanStreamer *s, struct slc_producer_calls *calls,
                                 const uint32_t *units, uint32_t count)
{
    SluiceTileTarget targets[SLC_PRODUCER_BATCH];
    SluiceResult results[SLC_PRODUCER_BATCH], result = SLUICE_SUCCESS;
    SluiceTileBatch batch = {.tileCount = count, .pTiles = targets};
    assert(count <= SLC_PRODUCER_BATCH);
    for (uint32_t i = 0; i < count; i++)
        place(s, &s->units[units[i]], &batch, &targets[i]);
    ask(s, calls, s->units[units[0]].texture, &batch, results);
    for (uint32_t i = 0; i < count; i++)
        result = first_error(result, answered(s, units[i], results[i]));
    return result;
}

/* Records the mip tail level by level. Stops at the first answer that is not SLUICE_SUCCESS. */
static SluiceResult record_packed(SluiceVulkanStreamer *s, struct slc_producer_calls *calls,
                                  uint32_t index)
{
    uint32_t at = s->units[index].texture;
    const struct slc_texture *texture = &s->textures[at];
    const struct slc_packed_rect *rects = texture->packed.rects;
    SluiceTileTarget targets[SLC_PRODUCER_BATCH];
    SluiceResult results[SLC_PRODUCER_BATCH], answer = SLUICE_SUCCESS;
    s->textures[at].packed_result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < texture->packed.rect_count && answer == SLUICE_SUCCESS &&
                         texture->state == SLC_TEXTURE_LIVE;) {
        SluiceTileBatch batch = {.pTiles = targets};
        uint32_t level = rects[i].region.mipLevel;
        for (; i < texture->packed.rect_count && rects[i].region.mipLevel == level &&
               batch.tileCount < SLC_PRODUCER_BATCH;
             i++)
            place_in_image(s, texture, &rects[i].region, &batch, &targets[batch.tileCount++]);
        ask(s, calls, at, &batch, results);
        for (uint32_t k = 0; k < batch.tileCount && answer == SLUICE_SUCCESS; k++)
            answer = results[k];
    }
    return answered(s, index, answer);
}

/* Takes at most tilesPerFrame units into frame_units. The other units go on waiting. */
static SluiceResult take(SluiceVulkanStreamer *s, uint32_t *count)
{
    struct slc_unit_list later = {SLC_NONE, SLC_NONE};
    SluiceResult result = SLUICE_SUCCESS;
    *count = 0;
    for (uint32_t at; (at = slc_unit_list_pop(s, &s->unproduced)) != SLC_NONE;) {
        if (is_removed(s, at))
            slc_unit_free(s, at);
        else if (s->units[at].canceled)
            result = first_error(result, give_back(s, at));
        else if (*count < s->info.tilesPerFrame)
            s->frame_units[(*count)++] = at;
        else
            slc_unit_list_append(s, &later, at);
    }
    s->unproduced = later;
    return result;
}

SluiceResult slc_productions_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    struct slc_producer_calls calls = {.vk = &s->vk, .commands = commands};
    const uint32_t *units = s->frame_units;
    uint32_t count;
    SluiceResult result = take(s, &count);
    slc_sort_units(s, s->frame_units, count, batch_key);
    for (uint32_t i = 0, next; i < count; i = next) {
        next = i + 1;
        if (is_removed(s, units[i])) { /* a callback of this frame removed the texture */
            slc_unit_free(s, units[i]);
            continue;
        }
        if (s->units[units[i]].packed_unit != SLC_NONE) {
            result = first_error(result, record_packed(s, &calls, units[i]));
            continue;
        }
        uint64_t key = batch_key(s, units[i]);
        while (next < count && next - i < SLC_PRODUCER_BATCH && batch_key(s, units[next]) == key)
            next++;
        result = first_error(result, record_tiles(s, &calls, &units[i], next - i));
    }
    slc_producer_calls_end(&calls);
    return result;
}

static SluiceResult publish_tile(SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_unit *unit = &s->units[index];
    struct slc_residency *residency = slc_residency_of(s, unit->texture);
    if (residency->interface->show)
        residency->interface->show(residency, unit->texture, &unit->tile);
    s->counts.tilesMapped++;
    s->counts.tilesProduced++;
    slc_read_trouble_delivered(s, unit->texture, unit->tile.tileIndex);
    SluiceResult result = sluiceUpdateTilesMapping(s->manager, s->textures[unit->texture].id, 1,
                                                   &unit->tile.tileIndex);
    slc_unit_forget_tile(s, unit);
    slc_unit_free(s, index);
    return slc_streamer_check(s, result, "sluiceUpdateTilesMapping");
}

static SluiceResult publish_packed(SluiceVulkanStreamer *s, uint32_t index)
{
    uint32_t at = s->units[index].texture;
    if (s->textures[at].packed_result != SLUICE_SUCCESS)
        return fail_packed(s, index);
    slc_unit_free(s, index);
    slc_read_trouble_delivered(s, at, s->textures[at].packed_tiles[0].tileIndex);
    return slc_packed_publish(s, at);
}

SluiceResult slc_productions_publish(SluiceVulkanStreamer *s)
{
    SluiceResult result = SLUICE_SUCCESS;
    while (s->produced.first != SLC_NONE &&
           s->units[s->produced.first].value <= s->completed_frame && result >= 0) {
        uint32_t at = slc_unit_list_pop(s, &s->produced);
        if (is_removed(s, at))
            slc_unit_free(s, at);
        else
            result =
                s->units[at].packed_unit == SLC_NONE ? publish_tile(s, at) : publish_packed(s, at);
    }
    return result;
}

void slc_productions_abandon(SluiceVulkanStreamer *s, uint64_t frame)
{
    struct slc_unit_list kept = {SLC_NONE, SLC_NONE}, again = kept;
    for (uint32_t at; (at = slc_unit_list_pop(s, &s->produced)) != SLC_NONE;) {
        bool stays = s->units[at].value < frame;
        if (!stays)
            s->units[at].state = SLC_UNIT_BINDING;
        slc_unit_list_append(s, stays ? &kept : &again, at);
    }
    for (uint32_t at; (at = slc_unit_list_pop(s, &s->unproduced)) != SLC_NONE;)
        slc_unit_list_append(s, &again, at);
    s->produced = kept;
    s->unproduced = again;
}
