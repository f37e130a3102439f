#include "vulkan/texture_explain.h"

#include "base/checked.h"
#include "base/struct_size.h"
#include "vulkan/texture_requests.h"

#include <assert.h>
#include <string.h>

#define NO_LEVEL SLUICE_MIP_UNTOUCHED

static uint8_t finer_of(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* Requested levels ---------------------------------------------------------------------------- */

/* Returns the offset of levels: level m of the primary is level m + offset of the texture. */
static int32_t level_offset(const struct slc_coarse_place *p)
{
    const SluiceStreamedTextureDesc *to = &p->texture->layout.desc, *from;
    from = &p->primary->layout.desc;
    int32_t offset = 0;
    while (offset < SLUICE_MAX_MIP_LEVELS && to->width >> (offset + 1) >= from->width &&
           to->height >> (offset + 1) >= from->height)
        offset++;
    while (offset > -SLUICE_MAX_MIP_LEVELS && ((uint64_t)to->width << -offset < from->width ||
                                               (uint64_t)to->height << -offset < from->height))
        offset--;
    return offset;
}

static uint8_t own_level(const struct slc_coarse_place *p, uint8_t level)
{
    if (level == NO_LEVEL)
        return level;
    int32_t last = (int32_t)p->primary->layout.desc.mipLevelCount - 1;
    int32_t own = (level < last ? level : last) + level_offset(p);
    int32_t own_last = (int32_t)p->texture->layout.desc.mipLevelCount - 1;
    return (uint8_t)(own < 0 ? 0 : own < own_last ? own : own_last);
}

/* Finds the regions of the primary that texels [first, end) of `size` touch along one axis. */
static void regions_of(uint64_t first, uint64_t end, uint32_t size, uint32_t primary_size,
                       uint32_t region, uint32_t count, uint32_t *begin, uint32_t *stop)
{
    uint64_t a = first * primary_size / size / region;
    uint64_t b = (slc_min_u64(end, size) * primary_size - 1) / size / region;
    *begin = (uint32_t)slc_min_u64(a, count - 1);
    *stop = (uint32_t)slc_min_u64(b, count - 1) + 1;
}

static uint8_t marked_level(const SluiceVulkanStreamer *s, const struct slc_coarse_place *p)
{
    const struct slc_texture *primary = p->primary;
    const SluiceStreamedTextureLayout *own = &p->texture->layout, *from = &primary->layout;
    struct slc_tile_rect r;
    uint8_t level = NO_LEVEL;
    regions_of((uint64_t)p->x * own->desc.tileWidth, (uint64_t)(p->x + 1) * own->desc.tileWidth,
               own->desc.width, from->desc.width, from->desc.feedbackRegionWidth,
               from->feedbackWidth, &r.x0, &r.x1);
    regions_of((uint64_t)p->y * own->desc.tileHeight, (uint64_t)(p->y + 1) * own->desc.tileHeight,
               own->desc.height, from->desc.height, from->desc.feedbackRegionHeight,
               from->feedbackHeight, &r.y0, &r.y1);
    for (uint32_t y = r.y0; y < r.y1; y++)
        for (uint32_t x = r.x0; x < r.x1; x++)
            level = finer_of(level, primary->feedback.levels[y * from->feedbackWidth + x]);
    for (uint32_t i = primary->first_request; i; i = s->requests.list[i - 1].next) {
        const struct slc_texture_request *q = &s->requests.list[i - 1];
        if (q->regions.x0 < r.x1 && r.x0 < q->regions.x1 && q->regions.y0 < r.y1 &&
            r.y0 < q->regions.y1)
            level = finer_of(level, q->level);
    }
    return own_level(p, level);
}

static uint8_t wanted_level(const struct slc_coarse_place *p)
{
    return finer_of(p->marked, p->requested.asked);
}

/* The place ------------------------------------------------------------------------------------ */

static void look_at(const SluiceVulkanStreamer *s, struct slc_coarse_place *p, uint32_t x,
                    uint32_t y)
{
    uint32_t at = p->texture->region_first + y * p->texture->layout.minMipWidth + x;
    bool shown = p->texture->shown_frame && p->texture->presence == SLC_PRESENT;
    p->x = x;
    p->y = y;
    p->resident = shown ? s->min_mip_levels[at] : NO_LEVEL;
    p->fades = p->resident != NO_LEVEL && s->min_mip_texels[at] > slc_settled_texel(p->resident);
    p->requested = slc_requested_level(s->manager, p->texture->id, x, y);
    p->marked = marked_level(s, p);
}

/* Returns how much a tile explains about the coarse rectangle. Higher is more. */
static uint32_t weight(const struct slc_coarse_place *p)
{
    uint32_t kind = p->requested.held < p->resident ? 4
                    : wanted_level(p) < p->resident ? 3
                    : p->resident == 0              ? 0
                    : wanted_level(p) != NO_LEVEL   ? 2
                                                    : 1;
    return 2 * (kind << 8 | p->resident) + p->fades;
}

static struct slc_coarse_place find_place(const SluiceVulkanStreamer *s,
                                          const struct slc_texture *texture,
                                          const struct slc_tile_rect *rect)
{
    struct slc_coarse_place here = {.texture = texture, .primary = texture, .missing = NO_LEVEL};
    if (texture->primary_id != SLUICE_NO_TEXTURE)
        here.primary = &s->textures[s->by_manager_index[(uint32_t)texture->primary_id]];
    here.limit = own_level(&here, here.primary->finest_level);
    struct slc_coarse_place found = here;
    for (uint32_t y = rect->y0; y < rect->y1; y++)
        for (uint32_t x = rect->x0; x < rect->x1; x++) {
            look_at(s, &here, x, y);
            if ((x == rect->x0 && y == rect->y0) || weight(&here) > weight(&found))
                found = here;
        }
    return found;
}

/* Reasons -------------------------------------------------------------------------------------- */

static SluiceTileState state_of(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                uint32_t tile)
{
    SluiceTileState state;
    SluiceResult result = sluiceGetTileState(s->manager, texture->id, tile, &state, NULL);
    assert(result == SLUICE_SUCCESS);
    (void)result;
    return state;
}

static bool is_resident(SluiceTileState state)
{
    return state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
}

/* Finds the coarsest hidden tile over the place. Finer tiles are shown only together with it. */
static uint32_t find_missing(const SluiceVulkanStreamer *s, struct slc_coarse_place *p)
{
    const SluiceStreamedTextureLayout *layout = &p->texture->layout;
    uint32_t tile = layout->regularTileCount;
    if (p->resident == NO_LEVEL && layout->desc.packedTileCount > 0) {
        p->missing = layout->desc.regularMipCount;
        while (tile + 1 < layout->tileCount && is_resident(state_of(s, p->texture, tile)))
            tile++;
    } else {
        uint32_t finest = slc_min_u32(p->resident, layout->desc.regularMipCount);
        uint32_t level = p->missing = finest - 1;
        uint32_t width = layout->levelWidthInTiles[level];
        uint32_t x = slc_min_u32(p->x >> level, width - 1);
        uint32_t y = slc_min_u32(p->y >> level, layout->levelHeightInTiles[level] - 1);
        tile = layout->levelFirstTile[level] + y * width + x;
    }
    p->state = state_of(s, p->texture, tile);
    return tile;
}

static SluiceCoarseReason why_queued(const SluiceVulkanStreamer *s)
{
    if (slc_manager_lacks_slots(s->manager))
        return SLUICE_COARSE_BUDGET;
    return s->free_unit_count ? SLUICE_COARSE_QUEUED : SLUICE_COARSE_BANDWIDTH;
}

static bool is_deferred(const SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile)
{
    for (uint32_t i = 0; i < s->deferred.count; i++)
        if (s->deferred.tiles[i].texture == texture && s->deferred.tiles[i].tile.tileIndex == tile)
            return true;
    return false;
}

static SluiceCoarseReason why_packed_not_loaded(const SluiceVulkanStreamer *s,
                                                const struct slc_texture *texture)
{
    switch (texture->packed_state) {
    case SLC_PACKED_READY:
        if (texture->presence != SLC_PRESENT)
            return SLUICE_COARSE_BUDGET;
        return s->free_unit_count < texture->packed.unit_count ? SLUICE_COARSE_BANDWIDTH
                                                               : SLUICE_COARSE_QUEUED;
    case SLC_PACKED_READING: return SLUICE_COARSE_READING;
    case SLC_PACKED_MAPPING:
    case SLC_PACKED_UPLOADING: return SLUICE_COARSE_UPLOADING;
    default: return SLUICE_COARSE_QUEUED;
    }
}

/* Explains why a tile that was handed out is not loaded yet. */
static SluiceCoarseReason why_not_loaded(const SluiceVulkanStreamer *s,
                                         const struct slc_texture *texture, uint32_t tile)
{
    uint32_t index = (uint32_t)(texture - s->textures);
    if (tile >= texture->layout.regularTileCount)
        return why_packed_not_loaded(s, texture);
    uint32_t unit = slc_map_get(&s->tile_units, slc_pair_key(index, tile));
    if (unit != SLC_MAP_NONE && s->units[unit].state != SLC_UNIT_READING)
        return s->units[unit].produced ? SLUICE_COARSE_READING : SLUICE_COARSE_UPLOADING;
    if (unit != SLC_MAP_NONE ||
        !is_deferred(s, index, tile)) /* read here or by another front end */
        return SLUICE_COARSE_READING;
    return s->free_unit_count ? SLUICE_COARSE_BUDGET : SLUICE_COARSE_BANDWIDTH;
}

static bool may_be_bound(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                         uint32_t tile)
{
    const uint32_t index = (uint32_t)(texture - s->textures);
    const struct slc_residency *residency = slc_residency_of(s, index);
    return texture->presence != SLC_PRESENT || !residency->interface->may_reserve ||
           residency->interface->may_reserve(residency, index, tile);
}

/* Explains why a tile failed: its read failed, or the tile was refused before. */
static SluiceCoarseReason why_failed(const SluiceVulkanStreamer *s, struct slc_coarse_place *p,
                                     uint32_t tile)
{
    p->is_limit_of_tiles = !may_be_bound(s, p->texture, tile);
    return p->is_limit_of_tiles ? SLUICE_COARSE_BUDGET : SLUICE_COARSE_FAILED;
}

static SluiceCoarseReason why_missing(const SluiceVulkanStreamer *s, struct slc_coarse_place *p)
{
    uint32_t tile = find_missing(s, p);
    switch (p->state) {
    case SLUICE_TILE_STATE_FREE:
    case SLUICE_TILE_STATE_REQUESTED: return why_queued(s);
    case SLUICE_TILE_STATE_ALLOCATED:
    case SLUICE_TILE_STATE_CANCELED: return why_not_loaded(s, p->texture, tile);
    case SLUICE_TILE_STATE_MAPPED:
    case SLUICE_TILE_STATE_STANDBY: return SLUICE_COARSE_UPLOADING;
    case SLUICE_TILE_STATE_FAILED:
    case SLUICE_TILE_STATE_GIVEN_UP: break;
    }
    return why_failed(s, p, tile);
}

static SluiceCoarseReason why_not_requested(const struct slc_coarse_place *p)
{
    uint8_t wanted = wanted_level(p);
    if (p->primary->hidden && !p->primary->first_request)
        return SLUICE_COARSE_HIDDEN;
    if (wanted == NO_LEVEL)
        return SLUICE_COARSE_NOT_SEEN;
    if (wanted >= p->resident)
        return SLUICE_COARSE_ENOUGH;
    if (p->requested.asked < p->resident)
        return SLUICE_COARSE_BUDGET;
    if (wanted < p->limit && p->limit >= p->resident)
        return SLUICE_COARSE_LIMIT;
    return p->primary->mip_bias > 0 ? SLUICE_COARSE_MIP_BIAS
           : p->primary->hidden     ? SLUICE_COARSE_HIDDEN
                                    : SLUICE_COARSE_QUEUED; /* the map is not read back yet */
}

/* Mip tails are wanted from the start, unless packedLevelsOnDemand is set. */
static SluiceCoarseReason explain(const SluiceVulkanStreamer *s, struct slc_coarse_place *p)
{
    bool lacks_tail = p->resident == NO_LEVEL && !s->info.packedLevelsOnDemand;
    if (p->requested.held < p->resident || lacks_tail)
        return why_missing(s, p);
    if (p->fades)
        return SLUICE_COARSE_FADING;
    return p->resident == 0 ? SLUICE_COARSE_FINEST : why_not_requested(p);
}

static SluiceTextureRect rect_of(const struct slc_coarse_place *p)
{
    const SluiceStreamedTextureDesc *d = &p->texture->layout.desc;
    uint32_t x = p->x * d->tileWidth, y = p->y * d->tileHeight;
    return (SluiceTextureRect){x, y, slc_min_u32(d->tileWidth, d->width - x),
                               slc_min_u32(d->tileHeight, d->height - y)};
}

SluiceResult sluiceExplainVulkanTexture(const SluiceVulkanStreamer *streamer,
                                        SluiceTextureId textureId, const SluiceTextureRect *pRect,
                                        SluiceVulkanExplanation *pExplanation)
{
    const SluiceVulkanStreamer *s = streamer;
    if (!s || !pExplanation)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceVulkanExplanation);
    struct slc_texture *texture = NULL;
    struct slc_tile_rect rect = {0};
    SluiceResult result = slc_struct_check(type, pExplanation, &s->vk.log);
    if (result == SLUICE_SUCCESS)
        result = slc_streamer_find(s, textureId, &texture);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_cells cells = slc_min_mip_cells(&texture->layout);
    result = slc_texture_rect_cells(s, texture, pRect, &cells, &rect);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_coarse_place place = find_place(s, texture, &rect);
    SluiceVulkanExplanation out = {.structSize = sizeof out, .reason = explain(s, &place)};
    out.rect = rect_of(&place);
    out.residentLevel = place.resident;
    out.requestedLevel = wanted_level(&place);
    out.missingLevel = place.missing;
    slc_explain_in_words(s, &place, out.reason, out.sentence);
    slc_struct_write(type, pExplanation, &out);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceWriteVulkanFeedback(const SluiceVulkanStreamer *streamer,
                                       SluiceTextureId textureId, size_t rowPitch, size_t size,
                                       uint8_t *pLevels)
{
    if (!streamer || !pLevels)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture *texture;
    SluiceResult result = slc_streamer_find(streamer, textureId, &texture);
    if (result != SLUICE_SUCCESS)
        return result;
    size_t rows, needed, width = texture->layout.feedbackWidth;
    size_t height = texture->layout.feedbackHeight;
    if (rowPitch < width || !slc_mul_size(height - 1, rowPitch, &rows) ||
        !slc_add_size(rows, width, &needed) || size < needed)
        return SLUICE_ERROR_SIZE_MISMATCH;
    for (size_t y = 0; y < height; y++)
        memcpy(pLevels + y * rowPitch, texture->feedback.levels + y * width, width);
    return SLUICE_SUCCESS;
}
