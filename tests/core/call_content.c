/* Content of random calls: texture descriptions and feedback maps. */
#include "core/call_sequence.h"

#include <string.h>

static uint32_t random_size(struct choice *c, uint32_t tile)
{
    static const uint32_t primes[] = {2, 3, 5, 7, 11, 13, 31, 61, 97, 127, 211, 257, 331};
    switch (choice_below(c, 6)) {
    case 0: return 1;
    case 1: return 1u << choice_below(c, 9);
    case 2: return primes[choice_below(c, sizeof primes / sizeof primes[0])];
    case 3: return tile * choice_range(c, 1, 9);
    case 4: return tile * choice_range(c, 1, 9) + 1;
    default: return choice_range(c, 1, 300);
    }
}

static uint32_t random_tile(struct choice *c)
{
    return choice_once_in(c, 2) ? 1u << choice_below(c, 5) : choice_range(c, 1, 16);
}

static uint32_t random_region(struct choice *c, uint32_t tile)
{
    switch (choice_below(c, 9)) {
    case 0: return tile > 1 ? tile / 2 : 1;
    case 8: return tile > 3 ? tile / 4 : 1;
    case 1: return tile * 2;
    case 2: return choice_range(c, 1, 40);
    case 3: return tile + 1;
    case 4: return choice_once_in(c, 4) ? UINT32_MAX : tile * 3 + 1;
    default: return 0;
    }
}

static uint32_t full_chain(uint32_t width, uint32_t height)
{
    uint32_t levels = 1;
    while ((uint64_t)(width | height) >> levels)
        levels++;
    return levels;
}

static SluiceStreamedTextureDesc random_desc(struct choice *c)
{
    SluiceStreamedTextureDesc d = {.tileWidth = random_tile(c)};
    d.tileHeight = choice_once_in(c, 2) ? d.tileWidth : random_tile(c);
    d.width = random_size(c, d.tileWidth);
    d.height = choice_once_in(c, 2) ? d.width : random_size(c, d.tileHeight);
    d.mipLevelCount = full_chain(d.width, d.height);
    if (choice_once_in(c, 3))
        d.mipLevelCount = choice_range(c, 1, d.mipLevelCount);
    d.regularMipCount = d.mipLevelCount;
    if (!choice_once_in(c, 4)) { /* packed levels, most often those that are less than a tile */
        d.regularMipCount = 0;
        while (d.regularMipCount + 1 < d.mipLevelCount &&
               (d.width >> d.regularMipCount >= d.tileWidth ||
                d.height >> d.regularMipCount >= d.tileHeight))
            d.regularMipCount++;
        if (choice_once_in(c, 3))
            d.regularMipCount = choice_below(c, d.mipLevelCount);
        d.packedTileCount = choice_range(c, 1, 3);
        d.packedTilesOutside = choice_once_in(c, 3);
    }
    d.feedbackRegionWidth = random_region(c, d.tileWidth);
    d.feedbackRegionHeight =
        choice_once_in(c, 3) ? random_region(c, d.tileHeight) : d.feedbackRegionWidth;
    return d;
}

void call_sequence_desc(struct call_sequence *s, SluiceStreamedTextureDesc *desc)
{
    const uint32_t most = choice_once_in(&s->choice, 12) ? 400 : s->max_tiles;
    const uint32_t least = choice_once_in(&s->choice, 3) ? 1 : most / 4;
    for (int i = 0; i < 16; i++) {
        SluiceStreamedTextureLayout l = {.structSize = sizeof l};
        *desc = random_desc(&s->choice);
        if (naive_layout(desc, &l) == SLUICE_SUCCESS && l.tileCount >= least &&
            l.tileCount <= most && l.feedbackWidth * l.feedbackHeight <= (most < 400 ? 400 : 1000))
            return;
    }
    *desc = (SluiceStreamedTextureDesc){8, 8, 2, 2, 0, 4, 4, 0, 0};
}

/* Makes one mistake in a valid description. */
static void spoil_desc(struct choice *c, SluiceStreamedTextureDesc *d)
{
    const bool across = choice_once_in(c, 2);
    switch (choice_below(c, 11)) {
    case 0: *(across ? &d->width : &d->height) = 0; break;
    case 1: *(across ? &d->tileWidth : &d->tileHeight) = 0; break;
    case 2: d->mipLevelCount = 0; break;
    case 3: d->regularMipCount = d->mipLevelCount + choice_range(c, 1, 3); break;
    case 4: d->packedTileCount = d->packedTileCount ? 0 : 1; break;
    case 5:
        d->regularMipCount = choice_range(c, 0, d->mipLevelCount);
        d->packedTileCount = choice_below(c, 2);
        break;
    case 6:
        *(across ? &d->width : &d->height) =
            choice_once_in(c, 2) ? SLUICE_MAX_TEXTURE_SIZE + 1 : UINT32_MAX;
        break;
    case 7: /* levels beyond the chain, packed */
        d->mipLevelCount = full_chain(d->width, d->height) + choice_range(c, 1, 3);
        d->packedTileCount = 1;
        break;
    case 8: /* too many tiles */
        *d = (SluiceStreamedTextureDesc){1u << 20, 1u << 20, 1, 1, 0, 1, 1, 1u << 10, 1u << 10};
        d->tileWidth = across ? 1 : 1u << 9;
        break;
    case 9: d->packedTileCount = UINT32_MAX; break;
    default: /* too many regions */
        *d = (SluiceStreamedTextureDesc){1u << 20, 1u << 20, 1, 1, 0, 1u << 19, 1u << 19, 1, 1};
        break;
    }
}

void call_sequence_bad_desc(struct call_sequence *s, SluiceStreamedTextureDesc *d)
{
    call_sequence_desc(s, d);
    spoil_desc(&s->choice, d);
    if (choice_once_in(&s->choice, 3)) /* a second mistake shows the order of the checks */
        spoil_desc(&s->choice, d);
}

static uint8_t random_texel(struct choice *c, uint32_t levels, uint32_t untouched)
{
    if (untouched && !choice_once_in(c, untouched))
        return SLUICE_MIP_UNTOUCHED;
    if (choice_once_in(c, 32))
        return (uint8_t)choice_below(c, 256);
    return (uint8_t)choice_below(c, levels + 1);
}

static void fill_map(struct call_sequence *s, uint32_t regions, uint32_t levels, uint8_t *map)
{
    struct choice *c = &s->choice;
    uint32_t kind = choice_below(c, 8);
    if (kind < 3 && s->last_map_size == regions) { /* the last map, with random gaps */
        memcpy(map, s->last_map, regions);
        for (uint32_t i = choice_below(c, 4); i > 0; i--)
            map[choice_below(c, regions)] = random_texel(c, levels, choice_below(c, 3));
        return;
    }
    if (kind == 3 || kind == 4) {
        uint8_t all = kind == 3 ? SLUICE_MIP_UNTOUCHED : random_texel(c, levels, 0);
        memset(map, all, regions);
        return;
    }
    uint32_t untouched = kind == 5 ? 8 : choice_below(c, 3);
    for (uint32_t i = 0; i < regions; i++)
        map[i] = kind == 6 ? (uint8_t)choice_below(c, 256) : random_texel(c, levels, untouched);
}

/* Writes the feedback of a resting camera. Each visible region is sampled with some probability. */
static void look(struct call_sequence *s, const SluiceStreamedTextureLayout *l, uint64_t texture,
                 uint8_t *map)
{
    struct choice view = {.state = s->camera * 0x9E3779B97F4A7C15u + texture};
    const uint32_t w = l->feedbackWidth, h = l->feedbackHeight;
    const uint32_t x0 = choice_below(&view, w), y0 = choice_below(&view, h);
    const uint32_t x1 = choice_range(&view, x0 + 1, w), y1 = choice_range(&view, y0 + 1, h);
    const uint32_t level = choice_below(&view, l->desc.mipLevelCount);
    for (uint32_t i = 0; i < w * h; i++) {
        const uint32_t x = i % w, y = i / w;
        const uint32_t coarser = choice_below(&view, 8) == 0;
        map[i] = SLUICE_MIP_UNTOUCHED;
        if (x >= x0 && x < x1 && y >= y0 && y < y1 && choice_below(&s->choice, 16) < s->visibility)
            map[i] = (uint8_t)(level + coarser);
    }
}

void call_sequence_map(struct call_sequence *s, const SluiceStreamedTextureLayout *l,
                       struct call *call)
{
    struct choice *c = &s->choice;
    call->map_width = l->feedbackWidth;
    call->map_height = l->feedbackHeight;
    if (choice_once_in(c, 2))
        look(s, l, call->texture, call->map);
    else
        fill_map(s, l->feedbackWidth * l->feedbackHeight, l->desc.mipLevelCount, call->map);
    s->last_map_size = l->feedbackWidth * l->feedbackHeight;
    memcpy(s->last_map, call->map, s->last_map_size);
    if (choice_once_in(c, 8))
        call->bias = (int32_t)choice_below(c, 9) - 4;
    else if (choice_once_in(c, 24))
        call->bias = choice_once_in(c, 2) ? INT32_MIN : INT32_MAX;
    if (choice_once_in(c, 8))
        call->streamed_levels = choice_range(c, 1, 4);
    else if (choice_once_in(c, 64))
        call->streamed_levels = UINT32_MAX;
}
