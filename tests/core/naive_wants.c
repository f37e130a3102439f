/* Computes wanted tiles from the levels of regions: "What is wanted", "Order within one feedback
 * call". */
#include "core/naive_manager.h"

#include <stdlib.h>

#define NOTHING SLUICE_MIP_UNTOUCHED

static uint64_t min_u64(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* Returns whether piece number `a` of one size and piece number `b` of another share a texel. */
static bool overlap(uint64_t a, uint32_t a_size, uint64_t b, uint32_t b_size, uint32_t texels)
{
    return a * a_size < min_u64((b + 1) * b_size, texels) &&
           b * b_size < min_u64((a + 1) * a_size, texels);
}

static uint8_t finest_of_tile(const SluiceStreamedTextureLayout *l, const struct naive_tile *tile,
                              const uint8_t *levels)
{
    const SluiceStreamedTextureDesc *d = &l->desc;
    uint8_t finest = NOTHING;
    for (uint32_t ry = 0; ry < l->feedbackHeight; ry++) {
        if (!overlap(tile->y, d->tileHeight, ry, d->feedbackRegionHeight, d->height))
            continue;
        for (uint32_t rx = 0; rx < l->feedbackWidth; rx++)
            if (overlap(tile->x, d->tileWidth, rx, d->feedbackRegionWidth, d->width) &&
                levels[ry * l->feedbackWidth + rx] < finest)
                finest = levels[ry * l->feedbackWidth + rx];
    }
    return finest;
}

static uint32_t parent_of(const SluiceStreamedTextureLayout *l, const struct naive_tile *tile)
{
    const uint32_t level = tile->level + 1;
    const uint64_t x = min_u64(tile->x / 2, l->levelWidthInTiles[level] - 1);
    const uint64_t y = min_u64(tile->y / 2, l->levelHeightInTiles[level] - 1);
    return (uint32_t)(l->levelFirstTile[level] + y * l->levelWidthInTiles[level] + x);
}

void naive_wishes(const struct naive_texture *t, const uint8_t *levels, uint8_t *wishes)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    for (uint32_t i = 0; i < l->regularTileCount; i++)
        wishes[i] = t->tiles[i].level == 0 ? finest_of_tile(l, &t->tiles[i], levels) : NOTHING;
    for (uint32_t i = 0; i < l->regularTileCount; i++) { /* finer levels come first */
        if (t->tiles[i].level + 1 == l->desc.regularMipCount)
            break;
        const uint32_t parent = parent_of(l, &t->tiles[i]);
        wishes[parent] = (uint8_t)min_u64(wishes[parent], wishes[i]);
    }
}

static uint32_t need_of(const struct naive_texture *t, uint32_t index, const uint8_t *wishes)
{
    const uint32_t level = t->tiles[index].level;
    uint32_t count = 0, need = 0;
    for (uint32_t i = 0; i < t->layout.regularTileCount && t->tiles[i].level == 0; i++) {
        uint32_t over = i;
        for (uint32_t k = 0; k < level; k++)
            over = parent_of(&t->layout, &t->tiles[over]);
        count += over == index && wishes[i] <= level;
    }
    while (count >> (need + 1))
        need++;
    return need;
}

static void apply_to_packed(struct naive_manager *n, struct naive_texture *t, bool wanted)
{
    for (uint32_t i = t->layout.regularTileCount; i < t->layout.tileCount; i++)
        if (wanted && !t->tiles[i].wanted)
            naive_become_wanted(n, &t->tiles[i], 0);
        else if (!wanted && t->tiles[i].wanted)
            naive_become_unwanted(n, &t->tiles[i]);
}

void naive_apply_held(struct naive_manager *n, struct naive_texture *t)
{
    const bool packed = n->always_packed || naive_holds_anything(t);
    uint8_t *wishes = naive_alloc(t->layout.regularTileCount, 1);
    naive_wishes(t, t->held, wishes);
    if (packed)
        apply_to_packed(n, t, true);
    for (uint32_t i = 0; i < t->layout.regularTileCount; i++) {
        struct naive_tile *tile = &t->tiles[i];
        const bool wanted = wishes[i] <= tile->level;
        if (wanted && !tile->wanted)
            naive_become_wanted(n, tile, need_of(t, i, wishes));
        else if (!wanted && tile->wanted)
            naive_become_unwanted(n, tile);
    }
    if (!packed)
        apply_to_packed(n, t, false);
    free(wishes);
}
