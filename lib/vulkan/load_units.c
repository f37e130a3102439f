#include "vulkan/load_units.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/shared_parts.h"

#include <assert.h>
#include <string.h>

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

/* Moves free units with memory to the front. Returns their number. */
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

/* Without device memory, units that have memory already are used. */
bool slc_units_are_ready(SluiceVulkanStreamer *s, uint32_t count)
{
    if (count > s->free_unit_count)
        return false;
    uint32_t unit = s->free_units.first;
    for (uint32_t i = 0; i < count; i++, unit = s->units[unit].next)
        if (!slc_staging_ensure(&s->staging, unit))
            return sort_free(s) >= count;
    return true;
}

uint32_t slc_unit_take_empty(SluiceVulkanStreamer *s, uint32_t texture, uint32_t packed_unit)
{
    uint32_t unit = slc_unit_list_pop(s, &s->free_units);
    assert(unit != SLC_NONE && s->units[unit].state == SLC_UNIT_FREE);
    s->free_unit_count--;
    s->units[unit] = (struct slc_unit){.texture = texture,
                                       .packed_unit = packed_unit,
                                       .stage_frame = s->frame,
                                       .requested_frame = UINT64_MAX,
                                       .produced = true};
    s->textures[texture].unit_count++;
    return unit;
}

uint32_t slc_unit_take(SluiceVulkanStreamer *s, uint32_t texture, uint32_t packed_unit)
{
    uint32_t unit = slc_unit_take_empty(s, texture, packed_unit);
    s->units[unit].produced = false;
    slc_staging_take(&s->staging, unit);
    return unit;
}

void slc_unit_free(SluiceVulkanStreamer *s, uint32_t unit)
{
    s->textures[s->units[unit].texture].unit_count--;
    s->units[unit].state = SLC_UNIT_FREE;
    s->reload_unit_count -= s->units[unit].reload;
    s->free_unit_count++;
    if (!s->units[unit].produced)
        slc_staging_give(&s->staging, unit);
    push_free(s, unit);
}

void slc_unit_forget_tile(SluiceVulkanStreamer *s, const struct slc_unit *unit)
{
    if (unit->packed_unit == SLC_NONE && !unit->dropped)
        slc_map_remove(&s->tile_units, slc_pair_key(unit->texture, unit->tile.tileIndex));
}

void slc_packed_queue_remove(SluiceVulkanStreamer *s, uint32_t at)
{
    s->packed_queue_count--;
    memmove(&s->packed_queue[at], &s->packed_queue[at + 1],
            (s->packed_queue_count - at) * sizeof *s->packed_queue);
}

SluiceResult slc_loads_init(SluiceVulkanStreamer *s)
{
    uint32_t count = s->info.maxLoadsInFlight;
    s->units = slc_calloc(&s->cb, count, sizeof *s->units);
    if (!s->units)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    const struct slc_unit_list empty = {SLC_NONE, SLC_NONE};
    s->free_units = s->arrived = s->binding = s->copying = s->uploaded = empty;
    s->unproduced = s->produced = empty;
    for (uint32_t i = 0; i < count; i++)
        slc_unit_list_append(s, &s->free_units, i);
    s->free_unit_count = count;
    SluiceResult result = slc_map_init(&s->tile_units, &s->cb, count);
    if (result == SLUICE_SUCCESS)
        result = slc_reload_lists_init(&s->reloads, &s->cb, s->info.maxTextureCount, count);
    if (result != SLUICE_SUCCESS)
        return result;
    result =
        slc_staging_init(&s->staging, &s->context->shared.staging, &s->vk, &s->caps, &s->cb, count);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceTileLoaderCreateInfo loader = {.structSize = sizeof loader,
                                         .requestCapacity = count,
                                         .maxSourceCount = s->info.maxTextureCount};
    return slc_create_shared_loader(&s->context->shared, &loader, &s->loader);
}

void slc_loads_finish(SluiceVulkanStreamer *s)
{
    slc_destroy_shared_loader(&s->context->shared,
                              s->loader); /* first, because its threads write into staging slots */
    slc_staging_finish(&s->staging);
    slc_map_finish(&s->tile_units, &s->cb);
    slc_reload_lists_finish(&s->reloads);
    slc_deferred_tiles_finish(&s->deferred, &s->cb);
    slc_deferred_tiles_finish(&s->awaited, &s->cb);
    slc_free(&s->cb, s->units, s->info.maxLoadsInFlight, sizeof *s->units);
}
