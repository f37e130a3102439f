#include "support/thin_heaps.h"

#include "support/test.h"

#include <string.h>

#define HEAPS 9
/* The manager's first 256 records, without the used ones: THIN_HEAPS_TILES and index 0. */
#define WAITING 207

/* Adds a row of tiles, all wanted. */
static SluiceTextureId add_row(SluiceStreamedTextureManager *manager, uint32_t tile_count)
{
    const SluiceStreamedTextureDesc desc = {.width = 128 * tile_count,
                                            .height = 128,
                                            .mipLevelCount = 1,
                                            .regularMipCount = 1,
                                            .tileWidth = 128,
                                            .tileHeight = 128};
    uint8_t map[WAITING] = {0};
    const SluiceFeedbackDesc feedback = {
        .structSize = sizeof feedback, .pMinMip = map, .width = tile_count, .height = 1};
    SluiceTextureId id;
    CHECK_OK(sluiceAddStreamedTexture(manager, &desc, &id));
    CHECK_OK(sluiceUpdateWithSamplerFeedback(manager, id, &feedback, 0, 1));
    return id;
}

static void load_one(SluiceStreamedTextureManager *manager, SluiceTextureId id, uint32_t heap)
{
    uint32_t count = 1;
    SluiceTile tile;
    CHECK_OK(sluiceGetTilesToMap(manager, id, &count, &tile));
    assert_true(count == 1 && tile.heapId == heap);
    CHECK_OK(sluiceUpdateTilesMapping(manager, id, 1, &tile.tileIndex));
}

void thin_heaps_make(SluiceStreamedTextureManager *manager)
{
    SluiceTextureId ids[HEAPS][THIN_HEAPS_CAPACITY];
    for (uint32_t heap = 0; heap < HEAPS; heap++)
        for (uint32_t i = 0; i < THIN_HEAPS_CAPACITY; i++) {
            ids[heap][i] = add_row(manager, 1);
            load_one(manager, ids[heap][i], heap);
        }
    for (uint32_t heap = 0; heap < HEAPS; heap++) {
        bool retires = heap == 1 || heap == 2;
        for (uint32_t i = heap == 0 ? 4 : 1; i < THIN_HEAPS_CAPACITY; i++)
            CHECK_OK(sluiceRemoveStreamedTexture(manager, ids[heap][i], retires && i > 3 ? 5 : 0));
    }
    add_row(manager, WAITING);
}
