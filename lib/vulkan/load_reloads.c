#include "vulkan/load_reloads.h"

#include "base/checked.h"
#include "vulkan/load_reads.h"
#include "vulkan/load_units.h"
#include "vulkan/read_troubles.h"
#include "vulkan/source_uses.h"

SluiceResult slc_reloads_reserve(SluiceVulkanStreamer *s, uint32_t tile_count)
{
    return slc_reload_lists_reserve(&s->reloads, tile_count);
}

bool slc_reload_is_due(const SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile)
{
    return slc_reload_lists_has(&s->reloads, texture, tile);
}

/* Changes ------------------------------------------------------------------------------------ */

static bool is_resident(const SluiceVulkanStreamer *s, uint32_t texture, uint32_t index,
                        SluiceTile *tile)
{
    SluiceTileState state = SLUICE_TILE_STATE_FREE;
    sluiceGetTileState(s->manager, s->textures[texture].id, index, &state, tile);
    return state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
}

void slc_reload_tile(SluiceVulkanStreamer *s, uint32_t texture, uint32_t index)
{
    struct slc_residency *residency = slc_residency_of(s, texture);
    uint64_t key = slc_pair_key(texture, index);
    uint32_t unit = slc_map_get(&s->tile_units, key);
    SluiceTile tile = {0};
    if (unit != SLC_MAP_NONE && s->units[unit].state <= SLC_UNIT_ARRIVED) {
        s->units[unit].stale = true;
        if (s->units[unit].state == SLC_UNIT_READING)
            sluiceCancelTileRead(s->loader, s->units[unit].ticket);
    } else if (unit != SLC_MAP_NONE || is_resident(s, texture, index, &tile)) {
        slc_reload_lists_add(&s->reloads, texture, index);
    } else if (residency->interface->spoil && s->textures[texture].presence == SLC_PRESENT) {
        is_resident(s, texture, index, &tile);
        residency->interface->spoil(residency, texture, &tile);
    }
}

void slc_reload_tail(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    bool started = texture->packed_state > SLC_PACKED_READY;
    if (texture->image.desc.packedTileCount == 0 || (!started && texture->packed_mapped == 0))
        return;
    slc_reloads_drop_tail(s, index); /* older reads must not end after the new ones */
    texture->reload_next = 0;
    slc_reload_lists_add(&s->reloads, index, texture->layout.regularTileCount);
}

uint32_t slc_reload_count(const SluiceVulkanStreamer *s, uint32_t texture)
{
    /* The packed levels have the index of the first packed tile. */
    uint32_t tail = s->textures[texture].layout.regularTileCount;
    uint32_t count = slc_reload_lists_count(&s->reloads, texture);
    bool has_tail = slc_reload_is_due(s, texture, tail);
    for (uint32_t i = 0; s->reload_unit_count && i < s->info.maxLoadsInFlight; i++) {
        const struct slc_unit *unit = &s->units[i];
        if (unit->state == SLC_UNIT_FREE || unit->state == SLC_UNIT_UPLOADED || !unit->reload ||
            unit->dropped || unit->texture != texture)
            continue;
        if (unit->packed_unit != SLC_NONE)
            count += !has_tail, has_tail = true;
        else
            count += !slc_reload_is_due(s, texture, unit->tile.tileIndex);
    }
    return count;
}

/* Reads -------------------------------------------------------------------------------------- */

static bool may_start(SluiceVulkanStreamer *s, uint32_t started)
{
    uint32_t most = slc_max_u32(1, s->info.maxLoadsInFlight / 4);
    return s->reload_unit_count < most && started < s->info.tilesPerFrame &&
           slc_units_are_ready(s, 1);
}

static void start_unit(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile,
                       uint32_t packed_unit)
{
    uint32_t unit = slc_unit_take(s, texture, packed_unit);
    struct slc_unit *u = &s->units[unit];
    u->reload = u->published = true;
    u->tile = *tile;
    s->reload_unit_count++;
    if (packed_unit == SLC_NONE)
        slc_map_add(&s->tile_units, slc_pair_key(texture, tile->tileIndex), unit);
    SluiceResult result = slc_unit_submit(s, unit);
    if (result != SLUICE_SUCCESS)
        slc_reload_back(s, unit, result);
}

/* Starts a reload of a mip tail. Returns true if the key can be removed. */
static bool start_tail(SluiceVulkanStreamer *s, uint32_t index, uint32_t *started)
{
    struct slc_texture *texture = &s->textures[index];
    const SluiceTile tile = {.tileIndex = texture->layout.regularTileCount};
    if (texture->packed_state != SLC_PACKED_COLLECTING || texture->packed_collected)
        return false; /* the load in progress ends first */
    if (texture->packed_mapped < texture->image.desc.packedTileCount)
        return true; /* a later load will read the whole tail */
    while (texture->reload_next < texture->packed.unit_count) {
        if (!may_start(s, *started))
            return false;
        ++*started;
        start_unit(s, index, &tile, texture->reload_next++);
        if (texture->reload_next == 0)
            return false; /* the loader refused: all units are read again later */
    }
    return true;
}

static bool start_tile(SluiceVulkanStreamer *s, uint32_t texture, uint32_t index, uint32_t *started)
{
    SluiceTile tile;
    if (slc_map_get(&s->tile_units, slc_pair_key(texture, index)) != SLC_MAP_NONE)
        return false;
    if (!is_resident(s, texture, index, &tile))
        return true; /* a later load will read the new texels */
    ++*started;
    start_unit(s, texture, &tile, SLC_NONE);
    return true;
}

/* Tries each tile once. A read that fails at once queues its tile again, and the texture waits. */
static void start_texture(SluiceVulkanStreamer *s, uint32_t index, uint32_t *started)
{
    struct slc_reload_lists *r = &s->reloads;
    const struct slc_texture *texture = &s->textures[index];
    for (uint32_t left = slc_reload_lists_count(r, index);
         left > 0 && may_start(s, *started) && !r->lists[index].waits; left--) {
        uint32_t tile = slc_reload_lists_take(r, index);
        bool done = true;
        if (texture->presence != SLC_PRESENT)
            continue;
        if (tile == texture->layout.regularTileCount)
            done = start_tail(s, index, started);
        else
            done = start_tile(s, index, tile, started);
        if (!done)
            slc_reload_lists_add(r, index, tile);
    }
}

SluiceResult slc_reloads_start(SluiceVulkanStreamer *s)
{
    uint32_t started = 0;
    slc_reload_lists_wake(&s->reloads, s->time_stamp);
    for (uint32_t left = s->reloads.ready.count; left > 0 && may_start(s, started); left--) {
        uint32_t texture = slc_reload_lists_begin(&s->reloads);
        start_texture(s, texture, &started);
        slc_reload_lists_end(&s->reloads, texture);
    }
    return SLUICE_SUCCESS;
}

bool slc_unit_read_again(SluiceVulkanStreamer *s, uint32_t index, SluiceResult *answer)
{
    struct slc_unit *unit = &s->units[index];
    const SluiceImageSource *before = unit->source;
    unit->stale = false;
    *answer = slc_unit_submit(s, index);
    if (before != unit->source)
        slc_source_left(s, before);
    return *answer == SLUICE_SUCCESS;
}

static void fail(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    struct slc_unit *unit = &s->units[index];
    struct slc_texture *texture = &s->textures[unit->texture];
    slc_read_trouble_failed(s, unit->texture, unit->tile.tileIndex, 1, answer);
    if (unit->packed_unit != SLC_NONE)
        texture->reload_next = 0;
    slc_reload_lists_add(&s->reloads, unit->texture, unit->tile.tileIndex);
    slc_reload_lists_wait(&s->reloads, unit->texture, s->time_stamp + s->info.retryDelayTicks);
    slc_unit_forget_tile(s, unit);
    slc_unit_free(s, index);
}

void slc_reload_back(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    struct slc_unit *unit = &s->units[index];
    if (unit->dropped) {
        slc_unit_free(s, index);
    } else if (answer != SLUICE_SUCCESS) {
        fail(s, index, answer);
    } else {
        slc_read_trouble_delivered(s, unit->texture, unit->tile.tileIndex);
        unit->state = SLC_UNIT_BINDING;
        unit->value = 0; /* nothing has to be bound */
        slc_unit_list_append(s, &s->binding, index);
    }
}

bool slc_reload_has_place(SluiceVulkanStreamer *s, const struct slc_unit *unit)
{
    struct slc_residency *residency = slc_residency_of(s, unit->texture);
    return !unit->reload || unit->packed_unit != SLC_NONE || !residency->interface->renew ||
           residency->interface->renew(residency, unit->texture, &unit->tile);
}

/* Ends --------------------------------------------------------------------------------------- */

void slc_reloads_drop_tail(SluiceVulkanStreamer *s, uint32_t texture)
{
    for (uint32_t i = 0; s->reload_unit_count && i < s->info.maxLoadsInFlight; i++) {
        struct slc_unit *unit = &s->units[i];
        if (unit->state == SLC_UNIT_FREE || !unit->reload || unit->texture != texture ||
            unit->packed_unit == SLC_NONE)
            continue;
        unit->dropped = true;
        if (unit->state == SLC_UNIT_READING)
            sluiceCancelTileRead(s->loader, unit->ticket);
    }
}

void slc_reloads_drop(SluiceVulkanStreamer *s, uint32_t texture)
{
    slc_reload_lists_drop(&s->reloads, texture);
}
