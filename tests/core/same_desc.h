/** Comparison of texture descriptions, member by member: the bytes between members say nothing. */
#ifndef TESTS_CORE_SAME_DESC_H
#define TESTS_CORE_SAME_DESC_H

#include <sluice/manager.h>

static inline bool same_desc(const SluiceStreamedTextureDesc *a, const SluiceStreamedTextureDesc *b)
{
    return a->width == b->width && a->height == b->height && a->mipLevelCount == b->mipLevelCount &&
           a->regularMipCount == b->regularMipCount && a->packedTileCount == b->packedTileCount &&
           a->tileWidth == b->tileWidth && a->tileHeight == b->tileHeight &&
           a->feedbackRegionWidth == b->feedbackRegionWidth &&
           a->feedbackRegionHeight == b->feedbackRegionHeight &&
           a->packedTilesOutside == b->packedTilesOutside;
}

#endif /* TESTS_CORE_SAME_DESC_H */
