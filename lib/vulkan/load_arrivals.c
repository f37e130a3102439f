#include "vulkan/load_arrivals.h"

#include "base/checked.h"
#include "image/pooled_reads.h"
#include "vulkan/load_reads.h"
#include "vulkan/load_reloads.h"
#include "vulkan/load_stages.h"
#include "vulkan/load_units.h"
#include "vulkan/read_troubles.h"

#include <assert.h>

#define BATCH 64u

static void packed_restart(struct slc_texture *texture)
{
    texture->packed_collected = 0;
    texture->packed_state = SLC_PACKED_COLLECTING;
    texture->packed_done = 0;
    texture->packed_result = SLUICE_SUCCESS;
    texture->packed_first_unit = SLC_NONE;
}

SluiceResult slc_packed_fail(SluiceVulkanStreamer *s, uint32_t index)
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
    slc_read_trouble_failed(s, index, texture->packed_tiles[0].tileIndex, count,
                            texture->packed_result);
    packed_restart(texture);
    return slc_streamer_check(s, result, "sluiceReportFailedTiles");
}

SluiceResult slc_packed_unit_back(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    struct slc_unit *unit = &s->units[index];
    struct slc_texture *texture = &s->textures[unit->texture];
    if (answer != SLUICE_SUCCESS)
        texture->packed_result = answer;
    else
        slc_load_stage_unit(s, unit, SLUICE_LOAD_STAGE_READ);
    unit->state = SLC_UNIT_ARRIVED;
    unit->next = texture->packed_first_unit;
    texture->packed_first_unit = index;
    if (++texture->packed_done < texture->packed.unit_count)
        return SLUICE_SUCCESS;
    if (texture->packed_result != SLUICE_SUCCESS)
        return slc_packed_fail(s, unit->texture);
    slc_read_trouble_delivered(s, unit->texture, texture->packed_tiles[0].tileIndex);
    texture->packed_state = SLC_PACKED_MAPPING;
    texture->packed_done = 0;
    s->packed_queue[s->packed_queue_count++] = unit->texture;
    return SLUICE_SUCCESS;
}

SluiceResult slc_tile_back(SluiceVulkanStreamer *s, uint32_t index, SluiceResult answer)
{
    struct slc_unit *unit = &s->units[index];
    struct slc_texture *texture = &s->textures[unit->texture];
    SluiceResult result;
    if (unit->canceled) {
        result = sluiceReportCanceledTiles(s->manager, texture->id, 1, &unit->tile.tileIndex, 0);
        slc_streamer_check(s, result, "sluiceReportCanceledTiles");
        s->counts.tilesCanceled++;
    } else if (answer != SLUICE_SUCCESS) {
        result = sluiceReportFailedTiles(s->manager, texture->id, 1, &unit->tile.tileIndex,
                                         s->manager_time);
        slc_streamer_check(s, result, "sluiceReportFailedTiles");
        slc_read_trouble_failed(s, unit->texture, unit->tile.tileIndex, 1, answer);
    } else {
        slc_read_trouble_delivered(s, unit->texture, unit->tile.tileIndex);
        slc_load_stage_unit(s, unit, SLUICE_LOAD_STAGE_READ);
        unit->state = SLC_UNIT_ARRIVED;
        slc_unit_list_append(s, &s->arrived, index);
        return SLUICE_SUCCESS;
    }
    struct slc_residency *residency = slc_residency_of(s, unit->texture);
    if (residency->interface->withdraw)
        residency->interface->withdraw(residency, unit->texture, &unit->tile);
    slc_unit_forget_tile(s, unit);
    slc_unit_free(s, index);
    return result;
}

bool slc_loads_can_wait(const SluiceVulkanStreamer *s)
{
    return s->free_unit_count >= s->info.maxLoadsInFlight / 2;
}

static SluiceResult unit_back(SluiceVulkanStreamer *s, const SluiceTileReadResult *read)
{
    uint32_t index = (uint32_t)read->userValue;
    struct slc_unit *unit = &s->units[index];
    assert(unit->state == SLC_UNIT_READING);
    s->counts.bytesRead += read->size;
    if (unit->source != s->textures[unit->texture].source) /* the application may destroy it next */
        slc_loader_drop_texels(s->loader, unit->source);
    if (s->textures[unit->texture].state == SLC_TEXTURE_REMOVED) {
        slc_unit_free(s, index);
        return SLUICE_SUCCESS;
    }
    SluiceResult answer = read->result;
    if (unit->stale && !unit->canceled && !unit->dropped && slc_unit_read_again(s, index, &answer))
        return SLUICE_SUCCESS;
    if (answer == SLUICE_NOT_READY && !unit->canceled && !unit->dropped && slc_loads_can_wait(s)) {
        answer = slc_unit_submit(s, index);
        if (answer == SLUICE_SUCCESS)
            return SLUICE_SUCCESS;
    }
    if (unit->reload) {
        slc_reload_back(s, index, answer);
        return SLUICE_SUCCESS;
    }
    return unit->packed_unit != SLC_NONE ? slc_packed_unit_back(s, index, answer)
                                         : slc_tile_back(s, index, answer);
}

SluiceResult slc_loads_collect(SluiceVulkanStreamer *s)
{
    SluiceTileReadResult reads[BATCH];
    /* A source that is not ready is read again at once. The limit ends the loop if it never is. */
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
