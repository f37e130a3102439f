#include "core/wants.h"

#include "base/checked.h"

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

/** Regions of the primary that overlap a region of the follower along one axis, inclusive. */
static void overlap(uint32_t region, uint32_t region_size, uint32_t size, uint32_t primary_region,
                    uint32_t primary_size, uint32_t primary_count, uint32_t *first, uint32_t *last)
{
    uint64_t begin = (uint64_t)region * region_size, end = begin + region_size;
    if (end > size)
        end = size;
    /* [begin, end) / size against [i * r, (i + 1) * r) / primary_size */
    uint64_t unit = (uint64_t)size * primary_region;
    *first = (uint32_t)(begin * primary_size / unit);
    *last = (uint32_t)((end * primary_size - 1) / unit);
    if (*first >= primary_count)
        *first = primary_count - 1;
    if (*last >= primary_count)
        *last = primary_count - 1;
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
    struct slc_tile_range r = {0, 1, 0, 0}; /* no range: y0 is behind y1 */
    for (uint32_t y = 0; y < f->feedback_height; y++) {
        uint8_t *row = map + (size_t)y * f->feedback_width;
        uint32_t y0, y1;
        overlap(y, fd->feedbackRegionHeight, fd->height, pd->feedbackRegionHeight, pd->height,
                p->feedback_height, &y0, &y1);
        if (y0 == r.y0 && y1 == r.y1) {
            memcpy(row, row - f->feedback_width, f->feedback_width);
            continue;
        }
        r = (struct slc_tile_range){1, y0, 0, y1};
        for (uint32_t x = 0; x < f->feedback_width; x++) {
            uint32_t x0, x1;
            overlap(x, fd->feedbackRegionWidth, fd->width, pd->feedbackRegionWidth, pd->width,
                    p->feedback_width, &x0, &x1);
            if (x0 == r.x0 && x1 == r.x1) {
                row[x] = row[x - 1];
                continue;
            }
            r.x0 = x0, r.x1 = x1;
            row[x] = follower_level(least_asked(asked, p->feedback_width, r), offset, last);
        }
    }
}

SluiceResult slc_wants_prepare_follower(slc_manager *m, const struct slc_texture *primary,
                                        bool prepared, struct slc_texture *follower,
                                        struct slc_wants_need *need)
{
    const struct slc_texture_state *ps = primary->state;
    if (!ps && !follower->state)
        return SLUICE_SUCCESS; /* an empty map onto nothing */
    SluiceResult result = slc_make_state(m, follower);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_texture_state *s = follower->state;
    if (ps)
        make_map(primary, prepared ? ps->next_asked : ps->asked, follower, s->next_asked);
    else
        memset(s->next_asked, SLUICE_MIP_UNTOUCHED,
               (size_t)follower->feedback_width * follower->feedback_height);
    slc_wants_add_need(follower, need);
    return SLUICE_SUCCESS;
}
