#include "vulkan/load_starts.h"

#include "base/checked.h"
#include "vulkan/load_arrivals.h"
#include "vulkan/load_deferred.h"
#include "vulkan/load_productions.h"
#include "vulkan/load_reads.h"
#include "vulkan/load_stages.h"
#include "vulkan/load_units.h"
#include "vulkan/read_batch.h"
#include "vulkan/texture_forgetting.h"

/* Fails a tile that can never be bound, before it is read. */
static SluiceResult refuse_tile(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    s->counts.tilesFailed++;
    return slc_streamer_check(s,
                              sluiceReportFailedTiles(s->manager, s->textures[texture].id, 1,
                                                      &tile->tileIndex, s->manager_time),
                              "sluiceReportFailedTiles");
}

/* Tries to share a page. READY: the tile is mapped. WAIT: it waits or was given back (`*result`).
 */
static enum slc_share share_tile(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile,
                                 SluiceResult *result)
{
    struct slc_residency *residency = slc_residency_of(s, texture);
    const struct slc_residency_interface *interface = residency->interface;
    enum slc_share share =
        interface->share ? interface->share(residency, texture, tile) : SLC_SHARE_NONE;
    if (share == SLC_SHARE_WAIT)
        *result = slc_load_await(s, texture, tile);
    if (share != SLC_SHARE_READY)
        return share;
    s->counts.tilesMapped++;
    s->counts.tilesShared++;
    *result = slc_streamer_check(
        s, sluiceUpdateTilesMapping(s->manager, s->textures[texture].id, 1, &tile->tileIndex),
        "sluiceUpdateTilesMapping");
    return share;
}

/* Tiles that a producer fills need no staging memory. */
static bool units_are_ready(SluiceVulkanStreamer *s, uint32_t texture, uint32_t count)
{
    return s->textures[texture].producer.pfn ? s->free_unit_count >= count
                                             : slc_units_are_ready(s, count);
}

static SluiceResult start_tile(SluiceVulkanStreamer *s, struct slc_read_batch *batch,
                               uint32_t texture, const SluiceTile *tile)
{
    struct slc_residency *residency = slc_residency_of(s, texture);
    const struct slc_residency_interface *interface = residency->interface;
    SluiceResult result = SLUICE_SUCCESS;
    bool produced = s->textures[texture].producer.pfn;
    if (s->textures[texture].presence != SLC_PRESENT) /* loading its mip tail makes it again */
        return slc_load_defer(s, texture, tile);
    if (!produced && share_tile(s, texture, tile, &result) != SLC_SHARE_NONE)
        return result;
    if (interface->revive && interface->revive(residency, texture, tile)) {
        s->counts.tilesMapped++;
        s->counts.tilesRestored++;
        return slc_streamer_check(
            s, sluiceUpdateTilesMapping(s->manager, s->textures[texture].id, 1, &tile->tileIndex),
            "sluiceUpdateTilesMapping");
    }
    if (interface->reserve && !interface->reserve(residency, texture, tile))
        return refuse_tile(s, texture, tile);
    uint32_t left = slc_pages_left(s, texture);
    if (left == 0 || !units_are_ready(s, texture, 1))
        return slc_load_defer(s, texture, tile);
    if (left != SLC_NONE)
        s->pages_left[slc_texture_page_format(&s->textures[texture])]--;
    if (produced) {
        slc_production_start(s, texture, tile);
        return SLUICE_SUCCESS;
    }
    uint32_t unit = slc_unit_take(s, texture, SLC_NONE);
    s->units[unit].tile = *tile;
    slc_load_stage_taken(s, &s->units[unit], tile);
    slc_map_add(&s->tile_units, slc_pair_key(texture, tile->tileIndex), unit);
    if (interface->announce)
        interface->announce(residency, texture, tile);
    return slc_read_batch_add(s, batch, unit);
}

/* Shares the page of an equal tile while pages or units are short. Returns false if the tile keeps
 * waiting. */
static bool share_deferred(SluiceVulkanStreamer *s, const struct slc_deferred_tile *deferred,
                           SluiceResult *result)
{
    return !s->textures[deferred->texture].producer.pfn &&
           share_tile(s, deferred->texture, &deferred->tile, result) != SLC_SHARE_NONE;
}

/* Starts deferred tiles that can have a page now, coarse tiles first. At most maxLoadsInFlight per
 * call: shared tiles take no unit, so units do not bound their number. */
static SluiceResult start_deferred(SluiceVulkanStreamer *s, struct slc_read_batch *batch)
{
    SluiceResult result = SLUICE_SUCCESS;
    uint32_t left = s->info.maxLoadsInFlight;
    for (uint32_t level = SLUICE_MAX_MIP_LEVELS; s->deferred.count > 0 && level-- > 0;)
        for (uint32_t i = 0;
             i < s->deferred.count && left > 0 && s->free_unit_count > 0 && result >= 0;) {
            struct slc_deferred_tile deferred = s->deferred.tiles[i];
            if (s->textures[deferred.texture].presence != SLC_PRESENT) {
                i++;
                continue;
            }
            bool can_start = deferred.tile.mipLevel == level &&
                             slc_pages_left(s, deferred.texture) > 0 &&
                             units_are_ready(s, deferred.texture, 1);
            if (deferred.tile.mipLevel != level ||
                (!can_start && !share_deferred(s, &deferred, &result))) {
                i++;
                continue;
            }
            slc_deferred_tiles_remove_at(&s->deferred, i);
            left--;
            if (can_start)
                result = start_tile(s, batch, deferred.texture, &deferred.tile);
        }
    return result;
}

/* Queues the packed levels once all packed tiles are mapped or handed out: they are read together.
 */
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

/* Tries the tiles that wait for the read of an equal or shared tile. They wait again while that
 * read goes on. */
static SluiceResult start_awaited(SluiceVulkanStreamer *s, struct slc_read_batch *batch)
{
    SluiceResult result = SLUICE_SUCCESS;
    uint32_t left =
        slc_min_u32(s->awaited.count, slc_min_u32(s->info.tilesPerFrame, s->info.maxLoadsInFlight));
    for (; left > 0 && result >= 0; left--) {
        struct slc_deferred_tile awaited = s->awaited.tiles[0];
        slc_deferred_tiles_remove_at(&s->awaited, 0);
        result = start_tile(s, batch, awaited.texture, &awaited.tile);
    }
    return result;
}

/* Collects a packed tile. One handed out while the others load was evicted: it is loaded later. */
static SluiceResult collect_packed_tile(SluiceVulkanStreamer *s, uint32_t index,
                                        const SluiceTile *tile)
{
    struct slc_texture *texture = &s->textures[index];
    if (texture->packed_state != SLC_PACKED_COLLECTING)
        return slc_load_give_back(s, index, tile);
    texture->packed_tiles[texture->packed_collected++] = *tile;
    check_packed(s, index);
    return SLUICE_SUCCESS;
}

static SluiceResult start_packed(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    uint32_t count = texture->packed.unit_count;
    if (texture->producer.pfn) {
        slc_production_start_packed(s, index);
        return SLUICE_SUCCESS;
    }
    texture->packed_state = SLC_PACKED_READING;
    texture->packed_done = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t unit = slc_unit_take(s, index, i);
        if (texture->packed_collected > 0)
            slc_load_stage_taken(s, &s->units[unit], &texture->packed_tiles[0]);
        SluiceResult result = slc_unit_submit(s, unit);
        if (result != SLUICE_SUCCESS)
            result = slc_packed_unit_back(s, unit, result);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}

/* `*waits`: a texture waits for staging slots, which tiles must not take. */
static SluiceResult start_packed_queue(SluiceVulkanStreamer *s, bool *waits)
{
    *waits = false;
    for (uint32_t i = 0; i < s->packed_queue_count;) {
        uint32_t index = s->packed_queue[i];
        struct slc_texture *texture = &s->textures[index];
        if (texture->packed_state != SLC_PACKED_READY || !slc_forgetting_wake(s, index)) {
            i++;
            continue;
        }
        if (!units_are_ready(s, index, texture->packed.unit_count)) {
            *waits = true;
            return SLUICE_SUCCESS;
        }
        slc_packed_queue_remove(s, i);
        SluiceResult result = start_packed(s, index);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}

static SluiceResult start_loads(SluiceVulkanStreamer *s, struct slc_read_batch *batch)
{
    bool waits;
    SluiceResult result = start_packed_queue(s, &waits);
    slc_pages_left_forget(s);
    if (result >= 0 && !waits)
        result = start_deferred(s, batch);
    if (result >= 0 && !waits)
        result = start_awaited(s, batch);
    uint32_t count = slc_min_u32(s->info.tilesPerFrame, s->free_unit_count);
    if (s->hold_loads)
        count = slc_min_u32(count, s->load_steps);
    if (result < 0 || waits || count == 0)
        return result;
    result = sluiceGetTilesToMap(s->manager, SLUICE_ALL_TEXTURES, &count, s->tiles);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return SLUICE_SUCCESS; /* the tiles stay requested */
    if (result < 0)
        return slc_streamer_check(s, result, "sluiceGetTilesToMap");
    s->strict.budget_reached = result == SLUICE_BUDGET_REACHED;
    s->load_steps -= s->hold_loads ? count : 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t index = s->by_manager_index[(uint32_t)s->tiles[i].textureId];
        result = SLUICE_SUCCESS;
        slc_load_stage_handed_out(s, &s->tiles[i]);
        if (slc_tile_is_packed(s, index, &s->tiles[i]))
            result = collect_packed_tile(s, index, &s->tiles[i]);
        else
            result = start_tile(s, batch, index, &s->tiles[i]);
        if (result < 0)
            return result;
    }
    return start_packed_queue(s, &waits);
}

SluiceResult slc_loads_start(SluiceVulkanStreamer *s)
{
    struct slc_read_batch batch;
    batch.count = 0;
    SluiceResult result = start_loads(s, &batch);
    SluiceResult submitted = slc_read_batch_submit(s, &batch); /* also after an error */
    return result < 0 ? result : submitted;
}
