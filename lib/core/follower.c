#include "core/wants.h"

#include "base/bytes.h"
#include "core/history.h"

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

/*
 * [begin, end) of region i, over `size`, against [j * r, (j + 1) * r), over `primary_size`: the
 * quotients that give the first and the last j grow by the same step from region to region, so one
 * division per axis serves them all.
 */
struct axis {
    uint64_t unit; ///< size * r
    uint64_t step, remainder_step;
    uint64_t quotient, remainder; ///< of begin * primary_size / unit
    uint64_t end;                 ///< size * primary_size - 1: the last region may be cut off
    uint32_t primary_count;
};

static struct axis make_axis(uint32_t region_size, uint32_t size, uint32_t primary_region,
                             uint32_t primary_size, uint32_t primary_count)
{
    struct axis a = {.unit = (uint64_t)size * primary_region,
                     .end = (uint64_t)size * primary_size - 1,
                     .primary_count = primary_count};
    uint64_t advance = (uint64_t)region_size * primary_size;
    a.step = advance / a.unit;
    a.remainder_step = advance % a.unit;
    return a;
}

/** Regions of the primary that overlap the next region of the follower, inclusive. */
static void next_overlap(struct axis *a, uint32_t *first, uint32_t *last)
{
    *first = (uint32_t)a->quotient;
    a->quotient += a->step;
    a->remainder += a->remainder_step;
    if (a->remainder >= a->unit) {
        a->remainder -= a->unit;
        a->quotient++;
    }
    /* (end * primary_size - 1) / unit, where the next begin is this end */
    *last = (uint32_t)(a->remainder > 0 ? a->quotient : a->quotient - 1);
    if (*last >= a->primary_count) /* the follower's last region reaches beyond the texture */
        *last = a->primary_count - 1;
}

static uint8_t least_asked(const uint8_t *asked, uint32_t pitch, struct slc_tile_range r)
{
    uint8_t least = SLUICE_MIP_UNTOUCHED;
    for (uint32_t y = r.y0; y <= r.y1; y++)
        for (uint32_t x = r.x0; x <= r.x1; x++) {
            uint8_t a = asked[(size_t)y * pitch + x];
            least = a < least ? a : least;
        }
    return least;
}

/** What a follower region wants of the least level asked for in what it overlaps. */
static uint8_t follower_level(uint8_t least, int offset, int last)
{
    if (least == SLUICE_MIP_UNTOUCHED)
        return least;
    int level = least + offset;
    level = level < 0 ? 0 : level;
    return (uint8_t)(level > last ? last : level);
}

/*
 * Neighbours that overlap the same regions of the primary share one answer. Without that, thin
 * regions of one texture under thick ones of the other would cost the product of their counts.
 */
static void make_map(const struct slc_texture *p, const uint8_t *asked, const struct slc_texture *f,
                     uint8_t *map)
{
    const SluiceStreamedTextureDesc *pd = &p->desc, *fd = &f->desc;
    int offset = level_offset(pd, fd), last = (int)fd->mipLevelCount - 1;
    struct axis down = make_axis(fd->feedbackRegionHeight, fd->height, pd->feedbackRegionHeight,
                                 pd->height, p->feedback_height);
    const struct axis along = make_axis(fd->feedbackRegionWidth, fd->width, pd->feedbackRegionWidth,
                                        pd->width, p->feedback_width);
    struct slc_tile_range r = {0, 1, 0, 0}; /* no range: y0 is behind y1 */
    for (uint32_t y = 0; y < f->feedback_height; y++) {
        uint8_t *row = map + (size_t)y * f->feedback_width;
        uint32_t y0, y1;
        next_overlap(&down, &y0, &y1);
        if (y0 == r.y0 && y1 == r.y1) {
            memcpy(row, row - f->feedback_width, f->feedback_width);
            continue;
        }
        r = (struct slc_tile_range){1, y0, 0, y1};
        struct axis across = along;
        for (uint32_t x = 0; x < f->feedback_width; x++) {
            uint32_t x0, x1;
            next_overlap(&across, &x0, &x1);
            if (x0 == r.x0 && x1 == r.x1) {
                row[x] = row[x - 1];
                continue;
            }
            r.x0 = x0, r.x1 = x1;
            row[x] = follower_level(least_asked(asked, p->feedback_width, r), offset, last);
        }
    }
}

/** Regions lie on regions, levels on levels. */
static bool has_same_regions(const struct slc_texture *p, const struct slc_texture *f)
{
    const SluiceStreamedTextureDesc *a = &p->desc, *b = &f->desc;
    return a->width == b->width && a->height == b->height &&
           a->feedbackRegionWidth == b->feedbackRegionWidth &&
           a->feedbackRegionHeight == b->feedbackRegionHeight;
}

static void copy_map(const uint8_t *asked, const struct slc_texture *f, uint8_t *map)
{
    slc_block last = slc_block_of((uint8_t)(f->desc.mipLevelCount - 1));
    slc_block untouched = slc_block_of(SLUICE_MIP_UNTOUCHED);
    for (size_t i = 0; i < slc_padded(slc_region_count(f)); i += SLC_BLOCK) {
        slc_block a = slc_load_block(asked + i);
        slc_store_block(map + i, slc_min_block(a, last) | slc_equal_block(a, untouched));
    }
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
    if (!asked)
        memset(map, SLUICE_MIP_UNTOUCHED, slc_region_count(follower));
    else if (has_same_regions(primary, follower))
        copy_map(asked, follower, map);
    else
        make_map(primary, asked, follower, map);
    slc_wants_add_need(m, follower, map, need);
    return SLUICE_SUCCESS;
}
