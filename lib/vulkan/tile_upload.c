/* Copies texels from staging slots to bound tiles, and reports them to the manager. */
#include "vulkan/tile_upload.h"

#include "base/alloc.h"
#include "vulkan/early_uploads.h"
#include "vulkan/load_reads.h"
#include "vulkan/load_reloads.h"
#include "vulkan/load_stages.h"
#include "vulkan/load_units.h"
#include "vulkan/unit_copies.h"

#include <assert.h>

SluiceResult slc_packed_publish(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    for (uint32_t i = 0; i < texture->packed_collected; i++) {
        SluiceResult result = sluiceUpdateTilesMapping(s->manager, texture->id, 1,
                                                       &texture->packed_tiles[i].tileIndex);
        if (result < 0)
            return slc_streamer_check(s, result, "sluiceUpdateTilesMapping");
    }
    s->counts.tilesMapped += texture->packed_collected;
    texture->packed_mapped += texture->packed_collected;
    texture->packed_collected = 0;
    texture->packed_state = SLC_PACKED_COLLECTING;
    texture->packed_done = 0;
    return SLUICE_SUCCESS;
}

/* Publishes a unit: a tile at once, packed levels when their last unit is copied. */
static SluiceResult publish(SluiceVulkanStreamer *s, uint32_t index, uint32_t packed_units,
                            uint32_t tile_count)
{
    struct slc_texture *texture = &s->textures[index];
    SluiceResult result = SLUICE_SUCCESS;
    texture->packed_done += packed_units;
    if (packed_units && texture->packed_done == texture->packed.unit_count)
        result = slc_packed_publish(s, index);
    if (result < 0)
        return result;
    if (tile_count) {
        result = sluiceUpdateTilesMapping(s->manager, texture->id, tile_count, s->tile_indices);
        s->counts.tilesMapped += tile_count;
    }
    return slc_streamer_check(s, result, "sluiceUpdateTilesMapping");
}

/* Lists tiles to report to the manager in tile_indices, in the order of arrival. The order of
 * staging slots would depend on the timing of earlier reads. */
static void list_tiles(SluiceVulkanStreamer *s, const uint32_t *units, uint32_t count,
                       uint32_t *tile_count, uint32_t *packed_count)
{
    *tile_count = *packed_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct slc_unit *unit = &s->units[units[i]];
        if (unit->published)
            continue;
        if (unit->packed_unit == SLC_NONE)
            s->tile_indices[(*tile_count)++] = unit->tile.tileIndex;
        else
            (*packed_count)++;
    }
}

/* Records the copies of a group, and shows its tiles. */
static void upload_group(SluiceVulkanStreamer *s, VkCommandBuffer commands, const uint32_t *units,
                         uint32_t count)
{
    bool copied = s->units[units[0]].copied;
    slc_record_group(s, commands, units, count,
                     copied ? SLC_UPLOAD_SHOW : SLC_UPLOAD_COPY | SLC_UPLOAD_SHOW);
    for (uint32_t i = 0; i < count; i++) {
        struct slc_unit *unit = &s->units[units[i]];
        if (!copied)
            slc_load_stage_unit(s, unit, SLUICE_LOAD_STAGE_BIND);
        unit->state = SLC_UNIT_UPLOADED;
        unit->value = s->frame;
        slc_unit_list_append(s, &s->uploaded, units[i]);
    }
}

static uint64_t by_texture(const SluiceVulkanStreamer *s, uint32_t unit)
{
    return s->units[unit].texture;
}

static uint64_t by_texture_and_slot(const SluiceVulkanStreamer *s, uint32_t unit)
{
    return (uint64_t)s->units[unit].texture << 32 | unit;
}

/* Publishes units by texture, and per texture in the order of arrival. */
static SluiceResult publish_units(SluiceVulkanStreamer *s, const uint32_t *units, uint32_t count)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0, next; i < count && result >= 0; i = next) {
        uint32_t texture = s->units[units[i]].texture, tile_count, packed_count;
        for (next = i + 1; next < count; next++)
            if (s->units[units[next]].texture != texture)
                break;
        list_tiles(s, &units[i], next - i, &tile_count, &packed_count);
        result = publish(s, texture, packed_count, tile_count);
    }
    return result;
}

/* Records a round. Round n has the nth command of each texture that needs barriers; round 0 also
 * has all other commands. So there is at most one barrier per staging buffer. False if none is
 * left. */
static bool record_round(SluiceVulkanStreamer *s, VkCommandBuffer commands, const uint32_t *units,
                         uint32_t count, uint32_t round)
{
    bool any = false;
    uint32_t turn = 0;
    for (uint32_t i = 0, next; i < count; i = next) {
        uint32_t texture = s->units[units[i]].texture;
        next = i + slc_unit_group(s, units + i, count - i);
        bool continues = i > 0 && s->units[units[i - 1]].texture == texture;
        turn = continues && slc_copies_need_barriers(s, texture) ? turn + 1 : 0;
        if (turn != round)
            continue;
        if (round > 0 && !any)
            slc_record_transfer_barrier(&s->vk, commands);
        upload_group(s, commands, &units[i], next - i);
        any = true;
    }
    return any;
}

/* Records frame_units[0..count). The manager may know them already, from an abandoned frame. */
static SluiceResult record_units(SluiceVulkanStreamer *s, VkCommandBuffer commands, uint32_t count)
{
    uint32_t round = 0;
    slc_sort_units(s, s->frame_units, count, by_texture);
    SluiceResult result = publish_units(s, s->frame_units, count);
    slc_sort_units(s, s->frame_units, count, by_texture_and_slot);
    while (record_round(s, commands, s->frame_units, count, round))
        round++;
    return result;
}

/* Collects units that the upload queue has copied into frame_units. */
static uint32_t take_early(SluiceVulkanStreamer *s, uint32_t *left)
{
    uint32_t count = 0, unit;
    while (count < s->info.tilesPerFrame && *left != 0 &&
           (unit = slc_early_uploads_next(s)) != SLC_NONE) {
        slc_unit_list_pop(s, &s->copying);
        if (s->units[unit].dropped ||
            s->textures[s->units[unit].texture].state == SLC_TEXTURE_REMOVED) {
            slc_unit_free(s, unit);
            continue;
        }
        s->frame_units[count++] = unit;
        --*left;
    }
    return count;
}

/* Collects bound units into frame_units: all that the manager knows, and at most `*left` others. */
static uint32_t take_units(SluiceVulkanStreamer *s, uint32_t *left)
{
    uint64_t completed = s->residency->interface->completed_value(s->residency);
    struct slc_unit_list later = {SLC_NONE, SLC_NONE};
    uint32_t count = take_early(s, left);
    while (count < s->info.tilesPerFrame && s->binding.first != SLC_NONE) {
        const struct slc_unit *unit = &s->units[s->binding.first];
        if (unit->value > completed || (!unit->published && *left == 0))
            break;
        bool useless = unit->dropped || s->textures[unit->texture].state == SLC_TEXTURE_REMOVED;
        bool early = !useless && slc_upload_is_early(s, unit);
        *left -= !unit->published && !useless && !unit->produced && !early;
        uint32_t taken = slc_unit_list_pop(s, &s->binding);
        if (early)
            slc_unit_list_append(s, &later, taken);
        else if (useless)
            slc_unit_free(s, taken);
        else if (!slc_reload_has_place(s, unit))
            slc_unit_list_append(s, &later, taken);
        else if (unit->produced)
            slc_unit_list_append(s, &s->unproduced, taken);
        else
            s->frame_units[count++] = taken;
    }
    for (uint32_t unit; (unit = slc_unit_list_pop(s, &later)) != SLC_NONE;)
        slc_unit_list_append(s, &s->binding, unit);
    return count;
}

SluiceResult slc_tile_uploads_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    uint32_t left = s->info.tilesPerFrame, count;
    SluiceResult result = slc_upload_queue_poll(&s->uploads, &s->vk);
    if (result == SLUICE_SUCCESS)
        result = slc_early_uploads_start(s);
    if (s->reload_unit_count) /* moves of this frame may have written the same pages */
        slc_record_transfer_barrier(&s->vk, commands);
    for (bool first = true; result >= 0 && (count = take_units(s, &left)) > 0; first = false) {
        if (!first && (s->residency->interface->ordinary_images || s->plain))
            slc_record_transfer_barrier(&s->vk, commands); /* see slc_copies_need_barriers */
        result = record_units(s, commands, count);
    }
    return result;
}
