#include "vulkan/load_deferred.h"

#include "core/observer.h"
#include "vulkan/load_units.h"

/* Adds a tile to a list of waiting tiles, unless the manager has canceled it. */
static SluiceResult wait_in(SluiceVulkanStreamer *s, struct slc_deferred_tiles *list,
                            uint32_t texture, const SluiceTile *tile)
{
    SluiceTileState state = SLUICE_TILE_STATE_CANCELED;
    sluiceGetTileState(s->manager, s->textures[texture].id, tile->tileIndex, &state, NULL);
    if (state == SLUICE_TILE_STATE_CANCELED || !slc_deferred_tiles_add(list, &s->cb, texture, tile))
        return slc_load_give_back(s, texture, tile);
    return SLUICE_SUCCESS;
}

SluiceResult slc_load_defer(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    return wait_in(s, &s->deferred, texture, tile);
}

SluiceResult slc_load_await(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    return wait_in(s, &s->awaited, texture, tile);
}

/* Counts the loads that will take a page of the format. */
static uint32_t count_loads(const SluiceVulkanStreamer *s, SluiceFormat format)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->info.maxLoadsInFlight; i++) {
        const struct slc_unit *unit = &s->units[i];
        bool is_coming = unit->state == SLC_UNIT_READING || unit->state == SLC_UNIT_ARRIVED;
        count += is_coming && !unit->reload && unit->packed_unit == SLC_NONE &&
                 slc_residency_of(s, unit->texture)->interface->page_room &&
                 slc_texture_page_format(&s->textures[unit->texture]) == format;
    }
    return count;
}

/* Pages are counted once per frame and format. */
uint32_t slc_pages_left(SluiceVulkanStreamer *s, uint32_t texture)
{
    struct slc_residency *residency = slc_residency_of(s, texture);
    SluiceFormat format = slc_texture_page_format(&s->textures[texture]);
    uint32_t *left = &s->pages_left[format];
    if (!residency->interface->page_room)
        return SLC_NONE;
    if (*left == SLC_NONE) {
        uint32_t room = residency->interface->page_room(residency, texture);
        uint32_t loads = room == UINT32_MAX ? 0 : count_loads(s, format);
        *left = room == UINT32_MAX ? SLC_NONE : room > loads ? room - loads : 0;
    }
    return *left;
}

void slc_pages_left_forget(SluiceVulkanStreamer *s)
{
    for (uint32_t i = 0; i < SLC_PAGE_FORMATS; i++)
        s->pages_left[i] = SLC_NONE;
}

/* Counts the deferred tiles beyond the pages that are free now. */
static uint32_t count_without_page(SluiceVulkanStreamer *s)
{
    uint32_t count = 0;
    slc_pages_left_forget(s);
    for (uint32_t i = 0; i < s->deferred.count; i++) {
        uint32_t texture = s->deferred.tiles[i].texture;
        if (s->textures[texture].presence != SLC_PRESENT)
            continue;
        uint32_t left = slc_pages_left(s, texture);
        count += left == 0;
        if (left > 0 && left != SLC_NONE)
            s->pages_left[slc_texture_page_format(&s->textures[texture])]--;
    }
    return count;
}

SluiceResult slc_loads_make_room(SluiceVulkanStreamer *s)
{
    uint32_t count = s->deferred.count ? count_without_page(s) : 0;
    s->lacking_pages = count;
    if (count == 0)
        return SLUICE_SUCCESS;
    SluiceStreamedTextureStatistics stats = slc_manager_slot_statistics(s->manager);
    if (stats.standbyTileCount == 0)
        return SLUICE_SUCCESS;
    uint32_t kept = stats.standbyTileCount > count ? (uint32_t)stats.standbyTileCount - count : 0;
    return slc_streamer_check(s, sluiceTrimStandbyTiles(s->manager, kept),
                              "sluiceTrimStandbyTiles");
}

SluiceResult slc_load_give_back(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile)
{
    s->counts.tilesCanceled++;
    return slc_streamer_check(
        s, sluiceReportCanceledTiles(s->manager, s->textures[texture].id, 1, &tile->tileIndex, 0),
        "sluiceReportCanceledTiles");
}
