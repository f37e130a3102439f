/*
 * Textures of one description share a shape: all values derived from the description. Descriptions
 * are few, so shapes are nearly always in the cache, and a texture itself is small.
 */
#include "core/shape.h"

#include "base/alloc.h"
#include "base/bytes.h"
#include "core/layout.h"

#include <string.h>

/* Most shapes of a bucket that are searched. Beyond, a texture gets a shape of its own. */
enum { MAX_SEARCHED = 8 };

static uint32_t hash_of(const SluiceStreamedTextureDesc *d)
{
    const uint32_t words[] = {d->width,
                              d->height,
                              d->mipLevelCount,
                              d->regularMipCount,
                              d->packedTileCount,
                              d->tileWidth,
                              d->tileHeight,
                              d->feedbackRegionWidth,
                              d->feedbackRegionHeight,
                              d->packedTilesOutside};
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        hash = (hash ^ words[i]) * 0x9E3779B1u;
    return hash ^ hash >> 15;
}

static bool are_equal(const SluiceStreamedTextureDesc *a, const SluiceStreamedTextureDesc *b)
{
    return a->width == b->width && a->height == b->height && a->mipLevelCount == b->mipLevelCount &&
           a->regularMipCount == b->regularMipCount && a->packedTileCount == b->packedTileCount &&
           a->tileWidth == b->tileWidth && a->tileHeight == b->tileHeight &&
           a->feedbackRegionWidth == b->feedbackRegionWidth &&
           a->feedbackRegionHeight == b->feedbackRegionHeight &&
           a->packedTilesOutside == b->packedTilesOutside;
}

size_t slc_shape_rows_size(const struct slc_shape *s)
{
    return 2 * (slc_padded(s->levels[0].width) + SLC_BLOCK);
}

/** Bytes of scratch for merging a map of the shape. */
static size_t work_size(const struct slc_shape *s)
{
    if (s->desc.regularMipCount == 0)
        return 0;
    /* rows, levels of the regions, levels of the tiles of level 0; blocks are read over the end */
    size_t tiles = (size_t)s->levels[0].width * s->levels[0].height + SLC_BLOCK;
    size_t regions = slc_padded(s->region_count) + SLC_BLOCK;
    return slc_shape_rows_size(s) + regions + (slc_regions_are_tiles(s) ? 0 : tiles);
}

SluiceResult slc_shape_take(slc_manager *m, const SluiceStreamedTextureDesc *desc,
                            struct slc_shape **shape)
{
    struct slc_shape layout = {.users = 1};
    SluiceResult result = slc_layout_texture(desc, &layout);
    if (result != SLUICE_SUCCESS)
        return result;
    layout.hash = hash_of(&layout.desc);
    layout.work_size = work_size(&layout);
    struct slc_shape **bucket = &m->shapes[layout.hash % SLC_SHAPE_BUCKETS], *s = *bucket;
    for (uint32_t i = 0; s && i < MAX_SEARCHED; i++, s = s->next)
        if (s->hash == layout.hash && are_equal(&s->desc, &layout.desc)) {
            s->users++;
            *shape = s;
            return SLUICE_SUCCESS;
        }
    s = slc_alloc(&m->cb, 1, sizeof *s);
    if (!s)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *s = layout;
    s->next = *bucket;
    s->link = bucket;
    if (s->next)
        s->next->link = &s->next;
    *bucket = *shape = s;
    return SLUICE_SUCCESS;
}

void slc_shape_give(slc_manager *m, struct slc_shape *shape)
{
    if (--shape->users > 0)
        return;
    *shape->link = shape->next; /* unlinks without a search: a bucket may be long */
    if (shape->next)
        shape->next->link = shape->link;
    slc_free(&m->cb, shape, 1, sizeof *shape);
}
