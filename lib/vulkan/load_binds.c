#include "vulkan/load_binds.h"

#include "vulkan/load_arrivals.h"
#include "vulkan/load_deferred.h"
#include "vulkan/load_productions.h"
#include "vulkan/load_reloads.h"
#include "vulkan/load_stages.h"
#include "vulkan/load_units.h"

/* Maps packed tiles while the residency has room. Units move on when the batch has its value. */
static void bind_packed(SluiceVulkanStreamer *s)
{
    for (uint32_t i = 0; i < s->packed_queue_count; i++) {
        uint32_t index = s->packed_queue[i];
        struct slc_texture *texture = &s->textures[index];
        uint32_t count = texture->packed_collected;
        if (texture->packed_state != SLC_PACKED_MAPPING)
            continue;
        while (texture->packed_done < count &&
               texture->residency->interface->map(texture->residency, index,
                                                  &texture->packed_tiles[texture->packed_done]) ==
                   SLUICE_SUCCESS)
            texture->packed_done++;
    }
}

/* Fails a unit for which there is no memory. It is read again later. Until then other units use its
 * staging slot. */
static void refuse_unit(SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_unit *unit = &s->units[index];
    struct slc_residency *residency = slc_residency_of(s, unit->texture);
    if (residency->interface->withdraw)
        residency->interface->withdraw(residency, unit->texture, &unit->tile);
    slc_load_defer(s, unit->texture, &unit->tile);
    slc_unit_forget_tile(s, unit);
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
        if (u->canceled) { /* the producer has not written the tile yet, so nothing is lost */
            slc_load_give_back(s, u->texture, &u->tile);
            slc_unit_forget_tile(s, u);
            slc_unit_free(s, unit);
            continue;
        }
        SluiceResult answer;
        if (u->stale) {
            if (!slc_unit_read_again(s, unit, &answer))
                slc_tile_back(s, unit, answer);
            continue;
        }
        struct slc_residency *residency = slc_residency_of(s, u->texture);
        SluiceResult result = residency->interface->map(residency, u->texture, &u->tile);
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
        slc_packed_queue_remove(s, i);
    }
    for (uint32_t unit = s->binding.first; unit != SLC_NONE; unit = s->units[unit].next)
        if (s->units[unit].value == UINT64_MAX) {
            s->units[unit].value = value;
            s->units[unit].bound_frame = s->frame;
        }
}

void slc_loads_recycle(SluiceVulkanStreamer *s)
{
    while (s->uploaded.first != SLC_NONE &&
           s->units[s->uploaded.first].value <= s->completed_frame) {
        uint32_t unit = slc_unit_list_pop(s, &s->uploaded);
        slc_load_stage_unit(s, &s->units[unit], SLUICE_LOAD_STAGE_COPY);
        s->counts.tilesReloaded += s->units[unit].reload;
        slc_unit_forget_tile(s, &s->units[unit]);
        slc_unit_free(s, unit);
    }
    slc_staging_trim(&s->staging);
}

bool slc_loads_unmap(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    if (slc_tile_is_packed(s, texture, tile)) {
        s->textures[texture].packed_mapped--;
        slc_reloads_drop_tail(s, texture);
        return true;
    }
    uint32_t unit = slc_map_get(&s->tile_units, slc_pair_key(texture, tile->tileIndex));
    if (unit == SLC_MAP_NONE)
        return !slc_reload_is_due(s, texture, tile->tileIndex);
    slc_unit_forget_tile(s, &s->units[unit]);
    s->units[unit].dropped = true;
    if (s->units[unit].state == SLC_UNIT_READING)
        sluiceCancelTileRead(s->loader, s->units[unit].ticket);
    return false;
}

/* Repeats come before all other copies, because MinMip maps are about to show their tiles. */
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
        u->value = 0; /* its bind is complete */
        u->published = true;
        slc_unit_list_append(s, &again, unit);
    }
    s->uploaded = kept;
    for (uint32_t unit; (unit = slc_unit_list_pop(s, &s->binding)) != SLC_NONE;)
        slc_unit_list_append(s, &again, unit);
    s->binding = again;
    slc_productions_abandon(s, frame);
}
