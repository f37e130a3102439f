/*
 * Any bytes as a tile store: an error or an image, all of which can be asked for; and what can be
 * opened, as a file that was left behind and is resumed. The first byte's bits say whether
 * checksums are made right first, so that what they protect is reached too, and whether what was
 * resumed is finished, which takes the disk's time; the rest is the file. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/store/fuzz_store_libfuzzer
 *     BUILD/tests/store/fuzz_store_libfuzzer -max_len=40000 tests/fuzz/corpus/store
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#define _XOPEN_SOURCE 700

#include "store/naive_store.h"

#include <sluice/store.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Reads a tile, then a region from its middle on, which includes its neighbors. */
static void read_tile(SluiceImageSource *source, const SluiceStoreInfo *info,
                      const SluiceImageRegion *tile)
{
    SluiceFormat format = info->layout.format;
    size_t row = sluiceGetFormatRegionSize(format, tile->width, 1);
    size_t size = sluiceGetFormatRegionSize(format, tile->width, tile->height);
    void *texels = malloc(size); /* exactly sized, so that sanitizers see a write beyond the end */
    if (!texels)
        return;
    if (sluiceReadImageRegion(source, tile, texels, row) == SLUICE_ERROR_INVALID_ARGUMENT)
        abort();
    SluiceImageRegion part = *tile;
    part.x += tile->width / 8 * 4;
    part.y += tile->height / 8 * 4;
    uint32_t width = info->layout.width >> tile->mipLevel;
    uint32_t height = info->layout.height >> tile->mipLevel;
    if (part.x + part.width > width || part.y + part.height > height) {
        part.width -= part.x - tile->x;
        part.height -= part.y - tile->y;
    }
    if (sluiceReadImageRegion(source, &part, texels, row) == SLUICE_ERROR_INVALID_ARGUMENT)
        abort();
    free(texels);
}

static void read_tiles(SluiceImageSource *source, const SluiceStoreInfo *info)
{
    const SluiceStoreLayout *layout = &info->layout;
    for (uint32_t layer = 0; layer < info->arrayLayerCount; layer++)
        for (uint32_t l = 0; l < layout->mipLevelCount; l++)
            for (uint32_t y = 0; y < layout->levelHeightInTiles[l]; y++)
                for (uint32_t x = 0; x < layout->levelWidthInTiles[l]; x++) {
                    SluiceImageRegion tile;
                    if (sluiceGetStoreTileRegion(layout, l, x, y, &tile) != SLUICE_SUCCESS)
                        abort();
                    tile.arrayLayer = layer;
                    read_tile(source, info, &tile);
                }
}

/* The number of found tiles must not exceed their total. */
static void resume(const char *path, const SluiceStoreInfo *info, bool finishes)
{
    SluiceStoreCreateInfo create = {
        .structSize = sizeof create,
        .pPath = path,
        .width = info->layout.width,
        .height = info->layout.height,
        .arrayLayerCount = info->arrayLayerCount,
        .format = info->layout.format,
        .colorSpace = info->colorSpace,
        .meaning = info->meaning,
        .addressModeU = info->addressModeU,
        .addressModeV = info->addressModeV,
        .pSourceName = info->pSourceName,
        .sourceSize = info->sourceSize,
        .sourceModifiedTimeNs = info->sourceModifiedTimeNs,
        .settingsHash = info->settingsHash,
        .compressionLevel = info->compressionLevel,
        .flags = SLUICE_STORE_WRITER_RESUME,
        .cube = info->cube,
    };
    SluiceStoreWriter *writer;
    uint64_t written, count;
    if (sluiceCreateStoreWriter(&create, &writer) != SLUICE_SUCCESS)
        return;
    if (sluiceGetStoreProgress(writer, &written, &count) != SLUICE_SUCCESS || written > count)
        abort();
    if (finishes && (sluiceFinishStore(writer) == SLUICE_SUCCESS) != (written == count))
        abort();
    sluiceDestroyStoreWriter(writer);
}

static void read_file(const char *path, const char *part_path, bool finishes)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceStoreInfo info = {.structSize = sizeof info};
    if (sluiceCreateStoreImageSource(&create, &source) != SLUICE_SUCCESS)
        return;
    if (sluiceGetStoreInfo(source, &info) != SLUICE_SUCCESS)
        abort();
    if (info.cube && (info.layout.width != info.layout.height || info.arrayLayerCount % 6))
        abort();
    SluiceStoreVerifyInfo verify = {.structSize = sizeof verify, .pPath = path};
    sluiceVerifyStore(&verify, NULL);
    read_tiles(source, &info);
    if (rename(path, part_path) == 0)
        resume(path, &info, finishes);
    sluiceDestroyImageSource(source);
}

/* The bytes are exactly sized, so that sanitizers see a read beyond the end. */
static void read_memory(const uint8_t *bytes, size_t size)
{
    SluiceInput input = {.structSize = sizeof input, .pBytes = bytes, .size = size};
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pInput = &input};
    SluiceImageSource *source;
    SluiceStoreInfo info = {.structSize = sizeof info};
    if (sluiceCreateStoreImageSource(&create, &source) != SLUICE_SUCCESS)
        return;
    if (sluiceGetStoreInfo(source, &info) != SLUICE_SUCCESS)
        abort();
    read_tiles(source, &info);
    sluiceDestroyImageSource(source);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[] = "/tmp/fuzz-store-XXXXXX", part_path[sizeof path + sizeof ".sluice-part"];
    if (size < 1)
        return 0;
    uint8_t *copy = malloc(size > 1 ? size - 1 : 1);
    int descriptor = mkstemp(path);
    if (copy && descriptor >= 0) {
        snprintf(part_path, sizeof part_path, "%s.sluice-part", path);
        memcpy(copy, data + 1, size - 1);
        if (data[0] & 1)
            naive_store_reseal(copy, size - 1);
        if (write(descriptor, copy, size - 1) == (ssize_t)(size - 1))
            read_file(path, part_path, data[0] & 2);
        read_memory(copy, size - 1);
        close(descriptor);
        unlink(path);
        unlink(part_path);
    }
    free(copy);
    return 0;
}
