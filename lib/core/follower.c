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

static void make_map(const struct slc_texture *p, const uint8_t *asked, const struct slc_texture *f,
                     uint8_t *map)
{
    const SluiceStreamedTextureDesc *pd = &p->desc, *fd = &f->desc;
    int offset = level_offset(pd, fd);
    for (uint32_t y = 0; y < f->feedback_height; y++) {
        struct slc_tile_range r;
        overlap(y, fd->feedbackRegionHeight, fd->height, pd->feedbackRegionHeight, pd->height,
                p->feedback_height, &r.y0, &r.y1);
        for (uint32_t x = 0; x < f->feedback_width; x++) {
            overlap(x, fd->feedbackRegionWidth, fd->width, pd->feedbackRegionWidth, pd->width,
                    p->feedback_width, &r.x0, &r.x1);
            uint8_t least = least_asked(asked, p->feedback_width, r);
            if (least != SLUICE_MIP_UNTOUCHED) {
                int level = least + offset, last = (int)fd->mipLevelCount - 1;
                level = level < 0 ? 0 : level;
                least = (uint8_t)(level > last ? last : level);
            }
            map[(size_t)y * f->feedback_width + x] = least;
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
