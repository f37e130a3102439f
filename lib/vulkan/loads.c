/*
 * From tiles that the manager wants to texels in staging slots, and on to the residency.
 *
 * A tile is bound when its texels have arrived, not when its load begins: a load that fails or is
 * cancelled then never touches a page table
 * (docs/decisions/0020-tiles-are-bound-when-their-texels-arrive.md).
 */
#include "vulkan/streamer.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"

#include <assert.h>
#include <string.h>

#define BATCH 64u

void slc_unit_list_append(SluiceVulkanStreamer *s, struct slc_unit_list *list, uint32_t unit)
{
    s->units[unit].next = SLC_NONE;
    if (list->first == SLC_NONE)
        list->first = unit;
    else
        s->units[list->last].next = unit;
    list->last = unit;
}

uint32_t slc_unit_list_pop(SluiceVulkanStreamer *s, struct slc_unit_list *list)
{
    uint32_t unit = list->first;
    if (unit != SLC_NONE)
        list->first = s->units[unit].next;
    return unit;
}

static void push_free(SluiceVulkanStreamer *s, uint32_t unit)
{
    s->units[unit].next = s->free_units.first;
    s->free_units.first = unit;
}

/* The free ones that have memory come first; how many there are. */
static uint32_t sort_free(SluiceVulkanStreamer *s)
{
    const struct slc_unit_list empty = {SLC_NONE, SLC_NONE};
    struct slc_unit_list there = empty, others = empty;
    uint32_t count = 0;
    for (uint32_t unit; (unit = slc_unit_list_pop(s, &s->free_units)) != SLC_NONE;) {
        bool is_there = slc_staging_is_there(&s->staging, unit);
        slc_unit_list_append(s, is_there ? &there : &others, unit);
        count += is_there;
    }
    s->free_units = count ? there : others;
    if (count)
        s->units[there.last].next = others.first;
    return count;
}

/* True: so many units can be taken. Makes memory for them, and where there is none makes do with
 * those that have some. */
static bool units_are_ready(SluiceVulkanStreamer *s, uint32_t count)
{
    if (count > s->free_unit_count)
        return false;
    uint32_t unit = s->free_units.first;
    for (uint32_t i = 0; i < count; i++, unit = s->units[unit].next)
        if (!slc_staging_ensure(&s->staging, unit))
            return sort_free(s) >= count;
    return true;
}

/* One that is ready. */
static uint32_t unit_take(SluiceVulkanStreamer *s, uint32_t texture, uint32_t packed_unit)
{
    uint32_t unit = slc_unit_list_pop(s, &s->free_units);
    assert(unit != SLC_NONE && s->units[unit].state == SLC_UNIT_FREE);
    slc_staging_take(&s->staging, unit);
    s->free_unit_count--;
    s->units[unit] = (struct slc_unit){.texture = texture, .packed_unit = packed_unit};
    s->textures[texture].unit_count++;
    return unit;
}

void slc_unit_free(SluiceVulkanStreamer *s, uint32_t unit)
{
    s->textures[s->units[unit].texture].unit_count--;
    s->units[unit].state = SLC_UNIT_FREE;
    s->free_unit_count++;
    slc_staging_give(&s->staging, unit);
    push_free(s, unit);
}

SluiceResult slc_loads_init(SluiceVulkanStreamer *s)
{
    uint32_t count = s->info.maxLoadsInFlight;
    s->units = slc_calloc(&s->cb, count, sizeof *s->units);
    if (!s->units)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    const struct slc_unit_list empty = {SLC_NONE, SLC_NONE};
    s->free_units = s->arrived = s->binding = s->uploaded = empty;
    for (uint32_t i = 0; i < count; i++)
        slc_unit_list_append(s, &s->free_units, i);
    s->free_unit_count = count;
    SluiceResult result = slc_map_init(&s->tile_units, &s->cb, count);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_staging_init(&s->staging, &s->vk, &s->caps, &s->cb, count, s->info.minStagingSize);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceTileLoaderCreateInfo loader = {.threadCount = s->info.loaderThreadCount,
                                         .requestCapacity = count,
                                         .pAllocator = s->info.pAllocator,
                                         .retry = s->info.readRetry,
                                         .maxReadsPerSource = s->info.maxReadsPerSource,
                                         .maxSourceCount = s->info.maxTextureCount};
    return sluiceCreateTileLoader(&loader, &s->loader);
}

void slc_loads_finish(SluiceVulkanStreamer *s)
{
    sluiceDestroyTileLoader(s->loader); /* first: its threads write into the staging slots */
    slc_staging_finish(&s->staging);
    slc_map_finish(&s->tile_units, &s->cb);
    slc_parked_tiles_finish(&s->parked, &s->cb);
    slc_free(&s->cb, s->units, s->info.maxLoadsInFlight, sizeof *s->units);
}

static uint8_t *unit_memory(SluiceVulkanStreamer *s, uint32_t unit)
{
    return slc_staging_memory(&s->staging, unit);
}

static SluiceImageRegion tile_region(const struct slc_texture *texture, const SluiceTile *tile)
{
    const SluiceStreamedTextureDesc *desc = &texture->image.desc;
    uint32_t x = tile->x * desc->tileWidth, y = tile->y * desc->tileHeight;
    return (SluiceImageRegion){
        tile->mipLevel,
        x,
        y,
        slc_min_u32(desc->tileWidth, slc_mip_size(desc->width, tile->mipLevel) - x),
        slc_min_u32(desc->tileHeight, slc_mip_size(desc->height, tile->mipLevel) - y),
        texture->layer};
}

/* Gives a unit to the loader; also again, for a source that was not ready. */
static SluiceResult submit_unit(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_unit *unit = &s->units[index];
    struct slc_texture *texture = &s->textures[unit->texture];
    SluiceImageRegion regions[SLUICE_MAX_READ_REGIONS];
    void *texels[SLUICE_MAX_READ_REGIONS];
    SluiceTileRead read = {.source = texture->source,
                           .regionCount = 1,
                           .pRegions = regions,
                           .ppTexels = texels,
                           .userValue = index};
    if (unit->packed_unit == SLC_NONE) {
        regions[0] = tile_region(texture, &unit->tile);
        texels[0] = unit_memory(s, index);
        read.priority = unit->tile.mipLevel; /* coarse first */
    } else {
        const struct slc_packed_unit *packed = &texture->packed.units[unit->packed_unit];
        assert(packed->rect_count <= SLUICE_MAX_READ_REGIONS);
        read.regionCount = packed->rect_count;
        read.priority = SLUICE_MAX_MIP_LEVELS;
        for (uint32_t i = 0; i < packed->rect_count; i++) {
            regions[i] = texture->packed.rects[packed->first_rect + i].region;
            regions[i].arrayLayer = texture->layer;
            texels[i] =
                unit_memory(s, index) + texture->packed.rects[packed->first_rect + i].offset;
        }
    }
    unit->state = SLC_UNIT_READING;
    return sluiceSubmitTileRead(s->loader, &read, &unit->ticket);
}

static bool is_packed(const SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    return tile->tileIndex >= s->textures[texture].layout.regularTileCount;
}

static void packed_restart(struct slc_texture *texture)
{
    texture->packed_collected = 0;
    texture->packed_state = SLC_PACKED_COLLECTING;
    texture->packed_done = 0;
    texture->packed_result = SLUICE_SUCCESS;
    texture->packed_first_unit = SLC_NONE;
}

/* All units are back and one of them failed: nothing was bound, the manager tries again later. */
static SluiceResult packed_fail(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    while (texture->packed_first_unit != SLC_NONE) {
        uint32_t unit = texture->packed_first_unit;
        texture->packed_first_unit = s->units[unit].next;
        slc_unit_free(s, unit);
    }
    uint32_t count = texture->packed_collected;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++)
        result = sluiceReportFailedTiles(s->manager, texture->id, 1,
                                         &texture->packed_tiles[i].tileIndex, s->manager_time);
    s->counts.tilesFailed += count;
    slc_read_trouble_failed(s, index, texture->packed_tiles[0].tileIndex, texture->packed_result);
    packed_restart(texture);
    return slc_streamer_check(s, result, "sluiceReportFailedTiles");
}

static SluiceResult packed_unit_back(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    struct slc_unit *unit = &s->units[index];
    struct slc_texture *texture = &s->textures[unit->texture];
    if (answer != SLUICE_SUCCESS)
        texture->packed_result = answer;
    unit->state = SLC_UNIT_ARRIVED;
    unit->next = texture->packed_first_unit;
    texture->packed_first_unit = index;
    if (++texture->packed_done < texture->packed.unit_count)
        return SLUICE_SUCCESS;
    if (texture->packed_result != SLUICE_SUCCESS)
        return packed_fail(s, unit->texture);
    slc_read_trouble_delivered(s, unit->texture, texture->packed_tiles[0].tileIndex);
    texture->packed_state = SLC_PACKED_MAPPING;
    texture->packed_done = 0;
    s->packed_queue[s->packed_queue_count++] = unit->texture;
    return SLUICE_SUCCESS;
}

static void forget_tile(SluiceVulkanStreamer *s, const struct slc_unit *unit)
{
    if (unit->packed_unit == SLC_NONE && !unit->dropped)
        slc_map_remove(&s->tile_units, slc_pair_key(unit->texture, unit->tile.tileIndex));
}

static SluiceResult tile_back(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    struct slc_unit *unit = &s->units[index];
    struct slc_texture *texture = &s->textures[unit->texture];
    SluiceResult result;
    if (unit->cancelled) {
        result = sluiceReportCancelledTiles(s->manager, texture->id, 1, &unit->tile.tileIndex, 0);
        slc_streamer_check(s, result, "sluiceReportCancelledTiles");
        s->counts.tilesCancelled++;
    } else if (answer != SLUICE_SUCCESS) {
        result = sluiceReportFailedTiles(s->manager, texture->id, 1, &unit->tile.tileIndex,
                                         s->manager_time);
        slc_streamer_check(s, result, "sluiceReportFailedTiles");
        s->counts.tilesFailed++;
        slc_read_trouble_failed(s, unit->texture, unit->tile.tileIndex, answer);
    } else {
        slc_read_trouble_delivered(s, unit->texture, unit->tile.tileIndex);
        unit->state = SLC_UNIT_ARRIVED;
        slc_unit_list_append(s, &s->arrived, index);
        return SLUICE_SUCCESS;
    }
    forget_tile(s, unit);
    slc_unit_free(s, index);
    return result;
}

/* Sources that are not ready may hold half of the staging slots. The others are for sources that
 * are: what is not ready then fails, and the manager asks again later. */
static bool can_wait(const SluiceVulkanStreamer *s)
{
    return s->free_unit_count >= s->info.maxLoadsInFlight / 2;
}

static SluiceResult unit_back(SluiceVulkanStreamer *s, const SluiceTileReadResult *read)
{
    uint32_t index = (uint32_t)read->userValue;
    struct slc_unit *unit = &s->units[index];
    assert(unit->state == SLC_UNIT_READING);
    s->counts.bytesRead += read->size;
    if (s->textures[unit->texture].state == SLC_TEXTURE_REMOVED) {
        slc_unit_free(s, index);
        return SLUICE_SUCCESS;
    }
    SluiceResult answer = read->result;
    if (answer == SLUICE_NOT_READY && !unit->cancelled && can_wait(s)) {
        answer = submit_unit(s, index);
        if (answer == SLUICE_SUCCESS)
            return SLUICE_SUCCESS;
    }
    return unit->packed_unit != SLC_NONE ? packed_unit_back(s, index, answer)
                                         : tile_back(s, index, answer);
}

SluiceResult slc_loads_collect(SluiceVulkanStreamer *s)
{
    SluiceTileReadResult reads[BATCH];
    /* A source that is never ready is asked again at once; without a limit that would not end. */
    for (uint32_t left = s->info.maxLoadsInFlight; left > 0;) {
        uint32_t count = slc_min_u32(BATCH, left);
        SluiceResult result = sluiceCollectTileReads(s->loader, &count, reads);
        if (result < 0)
            return result;
        for (uint32_t i = 0; i < count; i++) {
            result = unit_back(s, &reads[i]);
            if (result < 0)
                return result;
        }
        if (count == 0)
            break;
        left -= count;
    }
    return SLUICE_SUCCESS;
}

static SluiceResult give_back(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    s->counts.tilesCancelled++;
    return slc_streamer_check(
        s, sluiceReportCancelledTiles(s->manager, s->textures[texture].id, 1, &tile->tileIndex, 0),
        "sluiceReportCancelledTiles");
}

/* All packed tiles are there or handed out: then the levels are read, as one. */
static void check_packed(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    uint32_t count = texture->packed_collected + texture->packed_mapped;
    if (texture->packed_state != SLC_PACKED_COLLECTING || texture->packed_collected == 0 ||
        count < texture->layout.desc.packedTileCount)
        return;
    texture->packed_state = SLC_PACKED_READY;
    s->packed_queue[s->packed_queue_count++] = index;
}

/* Given back while others are not even handed out; later it goes on and ends on standby. */
static SluiceResult cancel_packed_tile(SluiceVulkanStreamer *s, uint32_t index,
                                       const SluiceTile *tile)
{
    struct slc_texture *texture = &s->textures[index];
    if (texture->packed_state != SLC_PACKED_COLLECTING)
        return SLUICE_SUCCESS;
    uint32_t at = 0;
    while (at < texture->packed_collected && texture->packed_tiles[at].tileIndex != tile->tileIndex)
        at++;
    if (at == texture->packed_collected)
        return SLUICE_SUCCESS;
    texture->packed_tiles[at] = texture->packed_tiles[--texture->packed_collected];
    return give_back(s, index, tile);
}

SluiceResult slc_loads_cancel(SluiceVulkanStreamer *s)
{
    SluiceTile tiles[BATCH];
    for (;;) {
        uint32_t count = BATCH;
        SluiceResult result =
            sluiceGetTilesToCancel(s->manager, SLUICE_ALL_TEXTURES, &count, tiles);
        if (result < 0)
            return slc_streamer_check(s, result, "sluiceGetTilesToCancel");
        for (uint32_t i = 0; i < count; i++) {
            uint32_t texture = s->by_manager_index[(uint32_t)tiles[i].textureId];
            if (is_packed(s, texture, &tiles[i])) {
                cancel_packed_tile(s, texture, &tiles[i]);
                continue;
            }
            uint32_t unit = slc_map_get(&s->tile_units, slc_pair_key(texture, tiles[i].tileIndex));
            if (slc_parked_tiles_remove(&s->parked, texture, tiles[i].tileIndex)) {
                give_back(s, texture, &tiles[i]);
                continue;
            }
            /* What has arrived goes on to standby: its read is paid for already. */
            if (unit == SLC_MAP_NONE || s->units[unit].state != SLC_UNIT_READING)
                continue;
            s->units[unit].cancelled = true;
            sluiceCancelTileRead(s->loader, s->units[unit].ticket);
        }
        if (count < BATCH)
            return SLUICE_SUCCESS;
    }
}

/* Before anything is read for it: the tile cannot ever be bound. */
static SluiceResult refuse_tile(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    s->counts.tilesFailed++;
    return slc_streamer_check(s,
                              sluiceReportFailedTiles(s->manager, s->textures[texture].id, 1,
                                                      &tile->tileIndex, s->manager_time),
                              "sluiceReportFailedTiles");
}

/* There is no page for it. One that was asked to stop is not waited for. */
static SluiceResult park_tile(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    SluiceTileState state = SLUICE_TILE_STATE_CANCELLED;
    sluiceGetTileState(s->manager, s->textures[texture].id, tile->tileIndex, &state, NULL);
    if (state == SLUICE_TILE_STATE_CANCELLED ||
        !slc_parked_tiles_add(&s->parked, &s->cb, texture, tile))
        return give_back(s, texture, tile);
    return SLUICE_SUCCESS;
}

/* Tiles that are going to ask for a page of the format. */
static uint32_t count_loads(const SluiceVulkanStreamer *s, SluiceFormat format)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->info.maxLoadsInFlight; i++) {
        const struct slc_unit *unit = &s->units[i];
        bool is_coming = unit->state == SLC_UNIT_READING || unit->state == SLC_UNIT_ARRIVED;
        count += is_coming && unit->packed_unit == SLC_NONE &&
                 s->textures[unit->texture].info.format == format;
    }
    return count;
}

/* For further loads of the texture's format; UINT32_MAX: nobody knows of an end. Counted once a
 * frame. */
static uint32_t pages_left(SluiceVulkanStreamer *s, uint32_t texture)
{
    const struct slc_residency_interface *interface = s->residency->interface;
    SluiceFormat format = s->textures[texture].info.format;
    uint32_t *left = &s->pages_left[format];
    if (*left == SLC_NONE && interface->page_room) {
        uint32_t room = interface->page_room(s->residency, texture);
        uint32_t loads = room == UINT32_MAX ? 0 : count_loads(s, format);
        *left = room == UINT32_MAX ? SLC_NONE : room > loads ? room - loads : 0;
    }
    return *left;
}

static void forget_pages_left(SluiceVulkanStreamer *s)
{
    for (uint32_t i = 0; i < SLC_PAGE_FORMATS; i++)
        s->pages_left[i] = SLC_NONE;
}

/* Parked tiles that even pages which are free now do not suffice for. */
static uint32_t count_without_page(SluiceVulkanStreamer *s)
{
    uint32_t count = 0;
    forget_pages_left(s);
    for (uint32_t i = 0; i < s->parked.count; i++) {
        uint32_t texture = s->parked.tiles[i].texture, left = pages_left(s, texture);
        count += left == 0;
        if (left > 0 && left != SLC_NONE)
            s->pages_left[s->textures[texture].info.format]--;
    }
    return count;
}

SluiceResult slc_loads_make_room(SluiceVulkanStreamer *s)
{
    uint32_t count = s->parked.count ? count_without_page(s) : 0;
    if (count == 0)
        return SLUICE_SUCCESS;
    SluiceStreamedTextureStatistics stats;
    sluiceGetStatistics(s->manager, &stats);
    if (stats.standbyTileCount == 0)
        return SLUICE_SUCCESS;
    uint32_t kept = stats.standbyTileCount > count ? (uint32_t)stats.standbyTileCount - count : 0;
    return slc_streamer_check(s, sluiceTrimStandbyTiles(s->manager, kept),
                              "sluiceTrimStandbyTiles");
}

static SluiceResult start_tile(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    const struct slc_residency_interface *interface = s->residency->interface;
    if (interface->revive && interface->revive(s->residency, texture, tile)) {
        s->counts.tilesMapped++;
        s->counts.tilesRevived++;
        return slc_streamer_check(
            s, sluiceUpdateTilesMapping(s->manager, s->textures[texture].id, 1, &tile->tileIndex),
            "sluiceUpdateTilesMapping");
    }
    if (interface->reserve && !interface->reserve(s->residency, texture, tile))
        return refuse_tile(s, texture, tile);
    uint32_t left = pages_left(s, texture);
    if (left == 0 || !units_are_ready(s, 1))
        return park_tile(s, texture, tile);
    if (left != SLC_NONE)
        s->pages_left[s->textures[texture].info.format]--;
    uint32_t unit = unit_take(s, texture, SLC_NONE);
    s->units[unit].tile = *tile;
    slc_map_add(&s->tile_units, slc_pair_key(texture, tile->tileIndex), unit);
    SluiceResult result = submit_unit(s, unit);
    return result == SLUICE_SUCCESS ? result : tile_back(s, unit, result);
}

/* Those for which there is a page now, coarse ones first. */
static SluiceResult start_parked(SluiceVulkanStreamer *s)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t level = SLUICE_MAX_MIP_LEVELS; s->parked.count > 0 && level-- > 0;)
        for (uint32_t i = 0; i < s->parked.count && units_are_ready(s, 1) && result >= 0;) {
            struct slc_parked_tile parked = s->parked.tiles[i];
            if (parked.tile.mipLevel != level || pages_left(s, parked.texture) == 0) {
                i++;
                continue;
            }
            slc_parked_tiles_remove_at(&s->parked, i);
            result = start_tile(s, parked.texture, &parked.tile);
        }
    return result;
}

/* One that comes while the others are on their way was evicted meanwhile. Its turn is later. */
static SluiceResult collect_packed_tile(SluiceVulkanStreamer *s, uint32_t index,
                                        const SluiceTile *tile)
{
    struct slc_texture *texture = &s->textures[index];
    if (texture->packed_state != SLC_PACKED_COLLECTING)
        return give_back(s, index, tile);
    texture->packed_tiles[texture->packed_collected++] = *tile;
    check_packed(s, index);
    return SLUICE_SUCCESS;
}

static SluiceResult start_packed(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    uint32_t count = texture->packed.unit_count;
    texture->packed_state = SLC_PACKED_READING;
    texture->packed_done = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t unit = unit_take(s, index, i);
        SluiceResult result = submit_unit(s, unit);
        if (result != SLUICE_SUCCESS)
            result = packed_unit_back(s, unit, result);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}

static void packed_queue_remove(SluiceVulkanStreamer *s, uint32_t at)
{
    s->packed_queue_count--;
    memmove(&s->packed_queue[at], &s->packed_queue[at + 1],
            (s->packed_queue_count - at) * sizeof *s->packed_queue);
}

/* True if one waits for staging slots: then tiles must not take them away. */
static SluiceResult start_packed_queue(SluiceVulkanStreamer *s, bool *waits)
{
    *waits = false;
    for (uint32_t i = 0; i < s->packed_queue_count;) {
        uint32_t index = s->packed_queue[i];
        struct slc_texture *texture = &s->textures[index];
        if (texture->packed_state != SLC_PACKED_READY) {
            i++;
            continue;
        }
        if (!units_are_ready(s, texture->packed.unit_count)) {
            *waits = true;
            return SLUICE_SUCCESS;
        }
        packed_queue_remove(s, i);
        SluiceResult result = start_packed(s, index);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_loads_start(SluiceVulkanStreamer *s)
{
    bool waits;
    SluiceResult result = start_packed_queue(s, &waits);
    forget_pages_left(s);
    if (result >= 0 && !waits)
        result = start_parked(s);
    uint32_t count = slc_min_u32(s->info.tilesPerFrame, s->free_unit_count);
    if (result < 0 || waits || count == 0)
        return result;
    result = sluiceGetTilesToMap(s->manager, SLUICE_ALL_TEXTURES, &count, s->tiles);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return SLUICE_SUCCESS; /* they stay requested */
    if (result < 0)
        return slc_streamer_check(s, result, "sluiceGetTilesToMap");
    for (uint32_t i = 0; i < count; i++) {
        uint32_t index = s->by_manager_index[(uint32_t)s->tiles[i].textureId];
        result = SLUICE_SUCCESS;
        if (is_packed(s, index, &s->tiles[i]))
            result = collect_packed_tile(s, index, &s->tiles[i]);
        else
            result = start_tile(s, index, &s->tiles[i]);
        if (result < 0)
            return result;
    }
    return start_packed_queue(s, &waits);
}

/* Gives what the residency has room for; the units move on when the batch has its number. */
static void bind_packed(SluiceVulkanStreamer *s)
{
    for (uint32_t i = 0; i < s->packed_queue_count; i++) {
        uint32_t index = s->packed_queue[i];
        struct slc_texture *texture = &s->textures[index];
        uint32_t count = texture->packed_collected;
        if (texture->packed_state != SLC_PACKED_MAPPING)
            continue;
        while (texture->packed_done < count &&
               s->residency->interface->map(s->residency, index,
                                            &texture->packed_tiles[texture->packed_done]) ==
                   SLUICE_SUCCESS)
            texture->packed_done++;
    }
}

/* There is no memory for it. Later it is read again, and its staging slot serves others till then.
 */
static void refuse_unit(SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_unit *unit = &s->units[index];
    park_tile(s, unit->texture, &unit->tile);
    forget_tile(s, unit);
    slc_unit_free(s, index);
}

void slc_loads_bind(SluiceVulkanStreamer *s)
{
    bind_packed(s);
    struct slc_unit_list later = {SLC_NONE, SLC_NONE};
    struct slc_unit_list bound = {SLC_NONE, SLC_NONE};
    for (uint32_t unit; (unit = slc_unit_list_pop(s, &s->arrived)) != SLC_NONE;) {
        struct slc_unit *u = &s->units[unit];
        if (s->textures[u->texture].state == SLC_TEXTURE_REMOVED) {
            slc_unit_free(s, unit);
            continue;
        }
        SluiceResult result = s->residency->interface->map(s->residency, u->texture, &u->tile);
        if (result < 0)
            refuse_unit(s, unit);
        else
            slc_unit_list_append(s, result == SLUICE_SUCCESS ? &bound : &later, unit);
    }
    s->arrived = later;
    for (uint32_t unit; (unit = slc_unit_list_pop(s, &bound)) != SLC_NONE;) {
        s->units[unit].state = SLC_UNIT_BINDING;
        s->units[unit].value = UINT64_MAX;
        slc_unit_list_append(s, &s->binding, unit);
    }
}

void slc_loads_bound(SluiceVulkanStreamer *s, uint64_t value)
{
    for (uint32_t i = 0; i < s->packed_queue_count;) {
        struct slc_texture *texture = &s->textures[s->packed_queue[i]];
        if (texture->packed_state != SLC_PACKED_MAPPING ||
            texture->packed_done < texture->packed_collected) {
            i++;
            continue;
        }
        while (texture->packed_first_unit != SLC_NONE) {
            uint32_t unit = texture->packed_first_unit;
            texture->packed_first_unit = s->units[unit].next;
            s->units[unit].state = SLC_UNIT_BINDING;
            s->units[unit].value = UINT64_MAX;
            slc_unit_list_append(s, &s->binding, unit);
        }
        texture->packed_state = SLC_PACKED_UPLOADING;
        texture->packed_done = 0;
        packed_queue_remove(s, i);
    }
    for (uint32_t unit = s->binding.first; unit != SLC_NONE; unit = s->units[unit].next)
        if (s->units[unit].value == UINT64_MAX)
            s->units[unit].value = value;
}

void slc_loads_recycle(SluiceVulkanStreamer *s)
{
    while (s->uploaded.first != SLC_NONE &&
           s->units[s->uploaded.first].value <= s->completed_frame) {
        uint32_t unit = slc_unit_list_pop(s, &s->uploaded);
        forget_tile(s, &s->units[unit]);
        slc_unit_free(s, unit);
    }
    slc_staging_trim(&s->staging);
}

bool slc_loads_unmap(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    if (is_packed(s, texture, tile)) {
        s->textures[texture].packed_mapped--;
        return true;
    }
    uint32_t unit = slc_map_get(&s->tile_units, slc_pair_key(texture, tile->tileIndex));
    if (unit == SLC_MAP_NONE)
        return true;
    forget_tile(s, &s->units[unit]);
    s->units[unit].dropped = true;
    return false;
}

/* They come before all others: MinMip maps are about to show them. */
void slc_loads_abandon(SluiceVulkanStreamer *s, uint64_t frame)
{
    struct slc_unit_list kept = {SLC_NONE, SLC_NONE}, again = kept;
    for (uint32_t unit; (unit = slc_unit_list_pop(s, &s->uploaded)) != SLC_NONE;) {
        struct slc_unit *u = &s->units[unit];
        if (u->value < frame) {
            slc_unit_list_append(s, &kept, unit);
            continue;
        }
        u->state = SLC_UNIT_BINDING;
        u->value = 0; /* its bind is over */
        u->published = true;
        slc_unit_list_append(s, &again, unit);
    }
    s->uploaded = kept;
    for (uint32_t unit; (unit = slc_unit_list_pop(s, &s->binding)) != SLC_NONE;)
        slc_unit_list_append(s, &again, unit);
    s->binding = again;
}

void slc_loads_drop(SluiceVulkanStreamer *s, uint32_t index)
{
    slc_parked_tiles_drop(&s->parked, index);
    struct slc_texture *texture = &s->textures[index];
    for (uint32_t i = 0; i < s->packed_queue_count;) {
        if (s->packed_queue[i] == index)
            packed_queue_remove(s, i);
        else
            i++;
    }
    while (texture->packed_first_unit != SLC_NONE) {
        uint32_t unit = texture->packed_first_unit;
        texture->packed_first_unit = s->units[unit].next;
        slc_unit_free(s, unit);
    }
    for (uint32_t i = 0; i < s->info.maxLoadsInFlight; i++) {
        struct slc_unit *unit = &s->units[i];
        if (unit->state == SLC_UNIT_FREE || unit->texture != index)
            continue;
        forget_tile(s, unit);
        unit->dropped = true;
        if (unit->state == SLC_UNIT_READING)
            sluiceCancelTileRead(s->loader, unit->ticket);
    }
}
