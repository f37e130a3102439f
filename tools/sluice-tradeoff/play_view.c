#include "play_view.h"

#include "../common/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static bool count_members(struct view *v)
{
    for (uint32_t i = 0; i < v->trace->texture_count; i++) {
        const struct feedback_texture *t = &v->trace->textures[i];
        v->textures[t->primary].member_count++;
        if (feedback_trace_same_shape(&t->layout.desc, &v->trace->textures[t->primary].layout.desc))
            continue;
        fprintf(stderr, "texture %u is of another shape than texture %u, which it follows\n", i,
                t->primary);
        return false;
    }
    return true;
}

bool view_init(struct view *v, const struct feedback_trace *trace)
{
    size_t largest = 1;
    for (uint32_t i = 0; i < trace->texture_count; i++) {
        const SluiceStreamedTextureLayout *l = &trace->textures[i].layout;
        size_t size = (size_t)l->minMipWidth * l->minMipHeight;
        largest = size > largest ? size : largest;
    }
    *v = (struct view){.trace = trace};
    v->textures = calloc((size_t)trace->texture_count + 1, sizeof *v->textures);
    v->min_mip = malloc(largest);
    v->waits = calloc((size_t)trace->frame_count + 1, sizeof *v->waits);
    if (v->textures && v->min_mip && v->waits)
        return count_members(v);
    fprintf(stderr, "out of memory\n");
    return false;
}

void view_finish(struct view *v)
{
    for (uint32_t i = 0; v->textures && i < v->trace->texture_count; i++) {
        free(v->textures[i].asked);
        free(v->textures[i].had);
        free(v->textures[i].sharp_in);
        free(v->textures[i].needed);
    }
    free(v->textures);
    free(v->min_mip);
    free(v->waits);
    *v = (struct view){0};
}

void view_begin_frame(struct view *v)
{
    v->now = (struct view_counts){0};
}

static uint32_t region_count(const SluiceStreamedTextureLayout *l)
{
    return l->feedbackWidth * l->feedbackHeight;
}

static bool first_touch(struct view_texture *t, const SluiceStreamedTextureLayout *l)
{
    const size_t regions = region_count(l);
    if (t->asked)
        return true;
    t->had = calloc(regions, 1);
    t->sharp_in = calloc(regions, sizeof *t->sharp_in);
    t->needed = calloc((size_t)l->regularTileCount + 1, sizeof *t->needed);
    t->asked = t->had && t->sharp_in && t->needed ? malloc(regions) : NULL;
    if (t->asked)
        memset(t->asked, SLUICE_MIP_UNTOUCHED, regions);
    else
        fprintf(stderr, "out of memory\n");
    return t->asked != NULL;
}

/** Tiles of level 0 that a region lies in: the first and the last column and row. */
struct tiles {
    uint32_t left, top, right, bottom;
};

static struct tiles tiles_of_region(const SluiceStreamedTextureLayout *l, uint32_t x, uint32_t y)
{
    const SluiceStreamedTextureDesc *d = &l->desc;
    uint32_t left = x * d->feedbackRegionWidth, top = y * d->feedbackRegionHeight;
    return (struct tiles){
        .left = left / d->tileWidth,
        .top = top / d->tileHeight,
        .right = (least(left + d->feedbackRegionWidth, d->width) - 1) / d->tileWidth,
        .bottom = (least(top + d->feedbackRegionHeight, d->height) - 1) / d->tileHeight,
    };
}

static void need_tile(struct view *v, struct view_texture *t, uint32_t tile, uint32_t tile_count,
                      uint32_t frame)
{
    if (t->needed[tile] == frame + 1)
        return;
    v->now.needed_tiles += (uint64_t)tile_count * t->member_count;
    if (t->needed[tile] == 0)
        v->needed_tiles += (uint64_t)tile_count * t->member_count;
    t->needed[tile] = frame + 1;
}

/** Marks the tiles of a region as needed: all levels from the wanted one on, and the packed
 * ones. */
static void need_region(struct view *v, struct view_texture *t,
                        const SluiceStreamedTextureLayout *l, struct tiles tiles, uint32_t want,
                        uint32_t frame)
{
    for (uint32_t level = want; level < l->desc.regularMipCount; level++) {
        const uint32_t width = l->levelWidthInTiles[level], height = l->levelHeightInTiles[level];
        const uint32_t right = least(tiles.right >> level, width - 1);
        const uint32_t bottom = least(tiles.bottom >> level, height - 1);
        for (uint32_t y = least(tiles.top >> level, bottom); y <= bottom; y++)
            for (uint32_t x = least(tiles.left >> level, right); x <= right; x++)
                need_tile(v, t, l->levelFirstTile[level] + y * width + x, 1, frame);
    }
    need_tile(v, t, l->regularTileCount, l->desc.packedTileCount, frame);
}

/** Returns the finest level that is resident in all of a region. Like the harness, returns one more
 * than the packed levels' number if even they are missing. */
static uint32_t level_of_region(const struct view *v, const SluiceStreamedTextureLayout *l,
                                struct tiles tiles)
{
    uint32_t level = 0, nothing = l->desc.regularMipCount + (l->desc.packedTileCount > 0);
    if (l->desc.regularMipCount == 0)
        tiles = (struct tiles){0, 0, 0, 0};
    for (uint32_t y = tiles.top; y <= tiles.bottom; y++)
        for (uint32_t x = tiles.left; x <= tiles.right; x++) {
            uint32_t here = v->min_mip[y * l->minMipWidth + x];
            here = here == SLUICE_MIP_UNTOUCHED ? nothing : here;
            level = here > level ? here : level;
        }
    return level;
}

static void end_wait(struct view *v, struct view_texture *t, uint32_t region, uint32_t frame)
{
    if (t->sharp_in[region] == 0)
        return;
    v->waits[frame + 1 - t->sharp_in[region]]++;
    v->wait_count++;
    t->sharp_in[region] = 0;
}

/** Notes that a region in view wants level `want` and has level `have`. */
static void see_region(struct view *v, struct view_texture *t, uint32_t region, uint32_t want,
                       uint32_t have, uint32_t frame)
{
    const uint32_t before = t->asked[region];
    const bool is_new = before == SLUICE_MIP_UNTOUCHED;
    const bool was_sharp = !is_new && t->had[region] <= before;
    v->now.wrong_evictions += was_sharp && have > (want > before ? want : before);
    v->now.touched_regions++;
    v->now.missing_regions += have > want;
    v->now.missing_levels += have > want ? have - want : 0;
    if ((is_new || want < before) && t->sharp_in[region] == 0)
        t->sharp_in[region] = frame + 1;
    if (have <= want)
        end_wait(v, t, region, frame);
    t->asked[region] = (uint8_t)want;
    t->had[region] = (uint8_t)have;
}

static void see_map(struct view *v, struct view_texture *t, const SluiceStreamedTextureLayout *l,
                    const uint8_t *map, uint32_t frame)
{
    const uint32_t last = l->desc.regularMipCount - (l->desc.packedTileCount == 0);
    for (uint32_t y = 0; y < l->feedbackHeight; y++)
        for (uint32_t x = 0; x < l->feedbackWidth; x++) {
            const uint32_t region = y * l->feedbackWidth + x;
            if (map[region] == SLUICE_MIP_UNTOUCHED) {
                end_wait(v, t, region, frame);
                t->asked[region] = SLUICE_MIP_UNTOUCHED;
                continue;
            }
            const struct tiles tiles = tiles_of_region(l, x, y);
            const uint32_t want = least(map[region], last);
            need_region(v, t, l, tiles, want, frame);
            see_region(v, t, region, want, level_of_region(v, l, tiles), frame);
        }
}

static bool is_touched(const uint8_t *map, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (map[i] != SLUICE_MIP_UNTOUCHED)
            return true;
    return false;
}

bool view_add_map(struct view *v, const SluiceStreamedTextureManager *manager, SluiceTextureId id,
                  uint32_t index, const uint8_t *map, uint32_t frame)
{
    struct view_texture *t = &v->textures[index];
    const SluiceStreamedTextureLayout *l = &v->trace->textures[index].layout;
    t->last_map = frame + 1;
    if (!t->asked && !is_touched(map, region_count(l)))
        return true;
    if (!first_touch(t, l))
        return false;
    const size_t pitch = l->minMipWidth, size = pitch * l->minMipHeight;
    SluiceResult result = sluiceWriteMinMipData(manager, id, pitch, size, v->min_mip);
    if (result != SLUICE_SUCCESS)
        text_say("sluiceWriteMinMipData: %s", sluiceGetResultName(result));
    else
        see_map(v, t, l, map, frame);
    return result == SLUICE_SUCCESS;
}

bool view_is_stale(const struct view *v, uint32_t index, uint32_t tile)
{
    const struct feedback_texture *texture = &v->trace->textures[index];
    const struct view_texture *t = &v->textures[texture->primary];
    if (tile >= texture->layout.regularTileCount || t->last_map == 0)
        return false;
    return !t->needed || t->needed[tile] != t->last_map;
}

void view_end_waits(struct view *v)
{
    for (uint32_t i = 0; i < v->trace->texture_count; i++)
        for (uint32_t r = 0;
             v->textures[i].asked && r < region_count(&v->trace->textures[i].layout); r++)
            end_wait(v, &v->textures[i], r, v->trace->frame_count - 1);
}

double view_wait(const struct view *v, double share)
{
    uint64_t sum = 0;
    for (uint32_t frames = 0; frames <= v->trace->frame_count; frames++) {
        sum += v->waits[frames];
        if (sum > 0 && (double)sum >= share * (double)v->wait_count)
            return frames;
    }
    return NAN;
}
