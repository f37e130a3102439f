/* Streams one texture without a GPU: what a frame asks of the manager, and what it gets. */
#include <sluice/manager.h>

#include <stdio.h>
#include <string.h>

static SluiceResult allocate_heap(void *pUserData, uint64_t size, uint32_t *pHeapId)
{
    uint32_t *pHeapCount = pUserData;
    (void)size; /* bytes; a renderer allocates GPU memory here, or refuses */
    *pHeapId = (*pHeapCount)++;
    return SLUICE_SUCCESS;
}

static void release_heap(void *pUserData, uint32_t heapId)
{
    (void)pUserData, (void)heapId;
}

int main(void)
{
    uint32_t heapCount = 0;
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {&heapCount, allocate_heap, release_heap},
        .heapTileCapacity = SLUICE_DEFAULT_HEAP_TILE_CAPACITY,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = true,
    };
    SluiceStreamedTextureManager *manager = NULL;
    if (sluiceCreateStreamedTextureManager(&info, &manager) != SLUICE_SUCCESS)
        return 1;

    /* 4096 x 4096 texels in tiles of 128 x 128; the seven smallest levels share one packed tile */
    SluiceStreamedTextureDesc desc = {.width = 4096,
                                      .height = 4096,
                                      .mipLevelCount = 13,
                                      .regularMipCount = 6,
                                      .packedTileCount = 1,
                                      .tileWidth = 128,
                                      .tileHeight = 128};
    SluiceTextureId texture = SLUICE_NO_TEXTURE;
    if (sluiceAddStreamedTexture(manager, &desc, &texture) != SLUICE_SUCCESS)
        return 1;

    /* Feedback as shaders write it: level 0 in the top left corner, nothing elsewhere. */
    static uint8_t map[32 * 32];
    memset(map, SLUICE_MIP_UNTOUCHED, sizeof map);
    map[0] = 0;
    SluiceFeedbackDesc feedback = {
        .structSize = sizeof feedback, .pMinMip = map, .width = 32, .height = 32};

    for (uint64_t frame = 1; frame <= 3; frame++) {
        SluiceTile tiles[4]; /* at most so many loads per frame */
        uint32_t count = 4;
        sluiceUpdateWithSamplerFeedback(manager, texture, &feedback, frame, 10);
        sluiceGetTilesToMap(manager, SLUICE_ALL_TEXTURES, &count, tiles);
        for (uint32_t i = 0; i < count; i++) {
            /* load the texels, copy them to the slot, then say that they are there */
            printf("frame %u: level %u, tile %u %u\n", (unsigned)frame, tiles[i].mipLevel,
                   tiles[i].x, tiles[i].y);
            sluiceUpdateTilesMapping(manager, texture, 1, &tiles[i].tileIndex);
        }
    }

    /* Shaders clamp to level 0 in that corner, to level 5 in the farthest one. */
    sluiceWriteMinMipData(manager, texture, 32, sizeof map, map);
    printf("finest levels: %u and %u\n", map[0], map[32 * 32 - 1]);
    sluiceDestroyStreamedTextureManager(manager);
    return 0;
}
