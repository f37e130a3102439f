#include "core/wants.h"

#include "base/bytes.h"
#include "core/history.h"
#include "core/overlap.h"

#include <string.h>

/** The greatest d with w >= W * 2^d and h >= H * 2^d; lower case is the follower. */
static int level_offset(const SluiceStreamedTextureDesc *primary,
                        const SluiceStreamedTextureDesc *follower)
{
    int d = -(int)SLUICE_MAX_MIP_LEVELS;
    for (int next = d + 1; next < (int)SLUICE_MAX_MIP_LEVELS; next++) {
        uint64_t w = follower->width, h = follower->height;
        uint64_t W = primary->width, H = primary->height;
        if (next < 0)
            w <<= -next, h <<= -next;
        else
            W <<= next, H <<= next;
        if (w < W || h < H)
            break;
        d = next;
    }
    return d;
}

/** Adds the offset to what is asked for; `values` and `map` may be the same. */
static void shift_levels(const uint8_t *values, size_t padded, int offset, uint32_t last,
                         uint8_t *map)
{
    slc_block up = slc_block_of((uint8_t)(offset > 0 ? offset : 0));
    slc_block down = slc_block_of((uint8_t)(offset < 0 ? -offset : 0));
    slc_block coarsest = slc_block_of((uint8_t)last);
    slc_block untouched = slc_block_of(SLUICE_MIP_UNTOUCHED);
    for (size_t i = 0; i < padded; i += SLC_BLOCK) {
        slc_block v = slc_load_block(values + i);
        /* values are at most 20 and offsets at most 21 away from 0, or the value is untouched */
        slc_block level = slc_max_block(v + up, down) - down;
        slc_store_block(map + i, slc_min_block(level, coarsest) | slc_equal_block(v, untouched));
    }
}

static struct slc_grid region_grid(const struct slc_texture *t)
{
    return (struct slc_grid){t->desc.width,
                             t->desc.height,
                             t->desc.feedbackRegionWidth,
                             t->desc.feedbackRegionHeight,
                             t->feedback_width,
                             t->feedback_height};
}

/** Regions lie on regions. */
static bool has_same_regions(const struct slc_texture *p, const struct slc_texture *f)
{
    const SluiceStreamedTextureDesc *a = &p->desc, *b = &f->desc;
    return a->width == b->width && a->height == b->height &&
           a->feedbackRegionWidth == b->feedbackRegionWidth &&
           a->feedbackRegionHeight == b->feedbackRegionHeight;
}

static void make_map(const struct slc_texture *p, const uint8_t *asked, const struct slc_texture *f,
                     uint8_t *map)
{
    size_t padded = slc_padded(slc_region_count(f));
    uint32_t last = f->desc.mipLevelCount - 1;
    if (has_same_regions(p, f)) {
        shift_levels(asked, padded, 0, last, map);
        return;
    }
    struct slc_grid from = region_grid(p), to = region_grid(f);
    slc_least_overlapped(&from, asked, &to, map);
    shift_levels(map, padded, level_offset(&p->desc, &f->desc), last, map);
}

SluiceResult slc_wants_prepare_follower(slc_manager *m, const struct slc_texture *primary,
                                        const uint8_t *asked, struct slc_texture *follower,
                                        struct slc_wants_need *need)
{
    if (!asked && !follower->state)
        return SLUICE_SUCCESS; /* an empty map onto nothing */
    SluiceResult result = slc_state_make(m, follower);
    if (result != SLUICE_SUCCESS)
        return result;
    uint8_t *map = slc_wants_take_map(m, follower, need);
    if (asked)
        make_map(primary, asked, follower, map);
    else
        memset(map, SLUICE_MIP_UNTOUCHED, slc_region_count(follower));
    slc_wants_add_need(m, follower, map, need);
    return SLUICE_SUCCESS;
}
