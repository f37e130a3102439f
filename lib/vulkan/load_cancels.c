#include "vulkan/load_cancels.h"

#include "base/checked.h"
#include "vulkan/load_deferred.h"
#include "vulkan/load_reloads.h"
#include "vulkan/load_units.h"

#define BATCH 64u

static void leave_packed_queue(SluiceVulkanStreamer *s, uint32_t index)
{
    for (uint32_t i = 0; i < s->packed_queue_count;) {
        if (s->packed_queue[i] == index)
            slc_packed_queue_remove(s, i);
        else
            i++;
    }
}

/* Ends the wait of a forgotten texture to be made again. */
static void wait_no_more(SluiceVulkanStreamer *s, uint32_t index)
{
    leave_packed_queue(s, index);
    s->textures[index].packed_state = SLC_PACKED_COLLECTING;
}

/* Gives a packed tile back while others are not handed out yet. Once all are, the load goes on, and
 * the tiles end on standby. */
static SluiceResult cancel_packed_tile(SluiceVulkanStreamer *s, uint32_t index,
                                       const SluiceTile *tile)
{
    struct slc_texture *texture = &s->textures[index];
    if (texture->packed_state == SLC_PACKED_READY && texture->presence != SLC_PRESENT)
        wait_no_more(s, index);
    if (texture->packed_state != SLC_PACKED_COLLECTING)
        return SLUICE_SUCCESS;
    uint32_t at = 0;
    while (at < texture->packed_collected && texture->packed_tiles[at].tileIndex != tile->tileIndex)
        at++;
    if (at == texture->packed_collected)
        return SLUICE_SUCCESS;
    texture->packed_tiles[at] = texture->packed_tiles[--texture->packed_collected];
    return slc_load_give_back(s, index, tile);
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
            if (slc_tile_is_packed(s, texture, &tiles[i])) {
                cancel_packed_tile(s, texture, &tiles[i]);
                continue;
            }
            uint32_t unit = slc_map_get(&s->tile_units, slc_pair_key(texture, tiles[i].tileIndex));
            if (slc_deferred_tiles_remove(&s->deferred, texture, tiles[i].tileIndex) ||
                slc_deferred_tiles_remove(&s->awaited, texture, tiles[i].tileIndex)) {
                slc_load_give_back(s, texture, &tiles[i]);
                continue;
            }
            /* Units whose texels have arrived go on to standby: their reads are done. */
            if (unit == SLC_MAP_NONE)
                continue;
            if (s->units[unit].produced)
                s->units[unit].canceled = s->units[unit].state != SLC_UNIT_UPLOADED;
            if (s->units[unit].state != SLC_UNIT_READING)
                continue;
            s->units[unit].canceled = true;
            sluiceCancelTileRead(s->loader, s->units[unit].ticket);
        }
        if (count < BATCH)
            return SLUICE_SUCCESS;
    }
}

void slc_loads_drop(SluiceVulkanStreamer *s, uint32_t index)
{
    slc_deferred_tiles_drop(&s->deferred, index);
    slc_deferred_tiles_drop(&s->awaited, index);
    slc_reloads_drop(s, index);
    struct slc_residency *residency = slc_residency_of(s, index);
    if (residency->interface->leave_source)
        residency->interface->leave_source(residency, index);
    struct slc_texture *texture = &s->textures[index];
    leave_packed_queue(s, index);
    while (texture->packed_first_unit != SLC_NONE) {
        uint32_t unit = texture->packed_first_unit;
        texture->packed_first_unit = s->units[unit].next;
        slc_unit_free(s, unit);
    }
    for (uint32_t i = 0; i < s->info.maxLoadsInFlight; i++) {
        struct slc_unit *unit = &s->units[i];
        if (unit->state == SLC_UNIT_FREE || unit->texture != index)
            continue;
        slc_unit_forget_tile(s, unit);
        unit->dropped = true;
        if (unit->state == SLC_UNIT_READING)
            sluiceCancelTileRead(s->loader, unit->ticket);
    }
}
