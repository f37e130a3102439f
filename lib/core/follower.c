#include "core/follower.h"

#include "base/bytes.h"
#include "core/history.h"
#include "core/overlap.h"
#include "core/uv_transform.h"

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

static struct slc_grid region_grid(const struct slc_managed_texture *t)
{
    return (struct slc_grid){t->shape->desc.width,
                             t->shape->desc.height,
                             t->shape->desc.feedbackRegionWidth,
                             t->shape->desc.feedbackRegionHeight,
                             t->shape->feedback_width,
                             t->shape->feedback_height};
}

/** True if the regions of both textures are equal. */
static bool has_same_regions(const struct slc_managed_texture *p,
                             const struct slc_managed_texture *f)
{
    const SluiceStreamedTextureDesc *a = &p->shape->desc, *b = &f->shape->desc;
    return a->width == b->width && a->height == b->height &&
           a->feedbackRegionWidth == b->feedbackRegionWidth &&
           a->feedbackRegionHeight == b->feedbackRegionHeight;
}

bool slc_have_same_shape(const struct slc_managed_texture *a, const struct slc_managed_texture *b)
{
    const SluiceStreamedTextureDesc *c = &a->shape->desc, *d = &b->shape->desc;
    return has_same_regions(a, b) && c->tileWidth == d->tileWidth &&
           c->tileHeight == d->tileHeight && c->mipLevelCount == d->mipLevelCount &&
           c->regularMipCount == d->regularMipCount && c->packedTileCount == d->packedTileCount;
}

uint64_t slc_follower_scratch(const struct slc_managed_texture *primary,
                              const struct slc_managed_texture *follower)
{
    uint64_t work = 0;
    if (follower->uv)
        work = (uint64_t)primary->shape->feedback_height * follower->shape->feedback_width;
    return work + SLC_BLOCK + slc_padded(slc_region_count(follower));
}

/* Writes the follower's map in levels of the primary; `*offset` converts them to its own levels. */
static void match_regions(slc_manager *m, const struct slc_managed_texture *primary,
                          const uint8_t *asked, const struct slc_managed_texture *follower,
                          uint8_t *map, int *offset, struct slc_wants_need *need)
{
    const struct slc_grid from = region_grid(primary), to = region_grid(follower);
    const SluiceStreamedTextureDesc *p = &primary->shape->desc, *f = &follower->shape->desc;
    if (!follower->uv) {
        slc_least_overlapped(&from, asked, &to, map);
        *offset = level_offset(p, f);
        return;
    }
    uint8_t *work = slc_wants_take_scratch(m, (size_t)from.rows * to.columns, need);
    slc_least_transformed(follower->uv, &from, asked, &to, work, map);
    *offset = slc_uv_level_offset(follower->uv, p, f);
}

SluiceResult slc_wants_prepare_follower(slc_manager *m, const struct slc_managed_texture *primary,
                                        const uint8_t *asked, struct slc_managed_texture *follower,
                                        struct slc_wants_need *need)
{
    if (!follower->nodes &&
        (!asked || slc_bytes_are(asked, slc_region_count(primary), SLUICE_MIP_UNTOUCHED)))
        return SLUICE_SUCCESS; /* an empty map for a texture without a state */
    SluiceResult result = slc_history_make(m, follower, 1);
    if (result != SLUICE_SUCCESS)
        return result;
    uint8_t *map = slc_wants_take_map(m, follower, need);
    struct slc_levels levels = {.coarsest = (uint8_t)(primary->shape->desc.mipLevelCount - 1),
                                .last = (uint8_t)(follower->shape->desc.mipLevelCount - 1)};
    const uint8_t *values = map;
    if (!asked) {
        memset(map, SLUICE_MIP_UNTOUCHED, slc_region_count(follower));
    } else if (!follower->uv && has_same_regions(primary, follower)) {
        values = asked;
    } else {
        int offset;
        match_regions(m, primary, asked, follower, map, &offset, need);
        levels.up = (uint8_t)(offset > 0 ? offset : 0);
        levels.down = (uint8_t)(offset < 0 ? -offset : 0);
    }
    slc_wants_set_map(m, follower, values, &levels, map, need);
    return SLUICE_SUCCESS;
}
