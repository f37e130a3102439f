#define _XOPEN_SOURCE 700

#include "store/stores.h"

#include "base/checked.h"
#include "support/test.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void scratch_init(struct scratch *scratch)
{
    strcpy(scratch->folder, "/tmp/sluice-store-XXXXXX");
    assert_non_null(mkdtemp(scratch->folder));
    snprintf(scratch->path, sizeof scratch->path, "%s/a.store", scratch->folder);
    snprintf(scratch->part_path, sizeof scratch->part_path, "%s.sluice-part", scratch->path);
}

void scratch_finish(struct scratch *scratch)
{
    DIR *folder = opendir(scratch->folder);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", scratch->folder, entry->d_name);
        unlink(path); /* . and .. stay */
    }
    closedir(folder);
    assert_int_equal(rmdir(scratch->folder), 0);
}

static void keep_message(void *user, SluiceLogSeverity severity, const char *text)
{
    struct messages *messages = user;
    assert_null(strpbrk(text, "\r\n"));
    if (severity != SLUICE_LOG_ERROR) {
        messages->others++;
        return;
    }
    messages->errors++;
    snprintf(messages->last, sizeof messages->last, "%s", text);
}

SluiceLogCallback messages_log(struct messages *messages)
{
    *messages = (struct messages){0};
    return (SluiceLogCallback){messages, keep_message};
}

static uint32_t mix(uint32_t a, uint32_t b)
{
    a = (a ^ b) * 0x9E3779B1u;
    a ^= a >> 15;
    a *= 0x85EBCA77u;
    return a ^ a >> 13;
}

static unsigned char byte_of(enum picture picture, const SluiceImageRegion *region, uint32_t x,
                             uint32_t y, uint32_t i)
{
    uint32_t place = mix(region->arrayLayer * 32 + region->mipLevel, 77);
    bool is_smooth = picture == PICTURE_SMOOTH ||
                     (picture == PICTURE_MIXED && mix(mix(place, x / 64), y / 64) % 2 == 0);
    if (is_smooth)
        return (unsigned char)(place + x / 8 + y / 16 + i);
    return (unsigned char)mix(mix(mix(place, x), y), i);
}

/* Calls for each row of blocks; the callee makes or compares it. */
typedef bool row_function(unsigned char *row, const unsigned char *painted, size_t size);

static bool for_rows(enum picture picture, SluiceFormat format, const SluiceImageRegion *region,
                     unsigned char *texels, size_t pitch, row_function *function)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetFormatInfo(format, &info));
    uint32_t columns = slc_div_up_u32(region->width, info.blockWidth);
    uint32_t rows = slc_div_up_u32(region->height, info.blockHeight);
    unsigned char *painted = malloc((size_t)columns * info.blockSize);
    bool result = true;
    for (uint32_t y = 0; y < rows; y++) {
        for (uint32_t x = 0; x < columns; x++)
            for (uint32_t i = 0; i < info.blockSize; i++)
                painted[x * info.blockSize + i] =
                    byte_of(picture, region, region->x / info.blockWidth + x,
                            region->y / info.blockHeight + y, i);
        result &= function(texels + y * pitch, painted, (size_t)columns * info.blockSize);
    }
    free(painted);
    return result;
}

static bool copy_row(unsigned char *row, const unsigned char *painted, size_t size)
{
    memcpy(row, painted, size);
    return true;
}

static bool compare_row(unsigned char *row, const unsigned char *painted, size_t size)
{
    return memcmp(row, painted, size) == 0;
}

void paint(enum picture picture, SluiceFormat format, const SluiceImageRegion *region, void *texels,
           size_t pitch)
{
    for_rows(picture, format, region, texels, pitch, copy_row);
}

bool is_painted(enum picture picture, SluiceFormat format, const SluiceImageRegion *region,
                const void *texels, size_t pitch)
{
    return for_rows(picture, format, region, (unsigned char *)texels, pitch, compare_row);
}

static SluiceResult write_tail(SluiceStoreWriter *writer, const SluiceStoreLayout *layout,
                               enum picture picture, uint32_t layer)
{
    unsigned char *memory = malloc(layout->tailSize), *next = memory;
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    for (uint32_t l = layout->tailFirstLevel; l < layout->mipLevelCount; l++) {
        SluiceImageRegion region;
        CHECK_OK(sluiceGetStoreTileRegion(layout, l, 0, 0, &region));
        region.arrayLayer = layer;
        paint(picture, layout->format, &region, next,
              sluiceGetFormatRegionSize(layout->format, region.width, 1));
        levels[l - layout->tailFirstLevel] = next;
        next += sluiceGetFormatRegionSize(layout->format, region.width, region.height);
    }
    assert_int_equal(next - memory, layout->tailSize);
    SluiceResult result = sluiceWriteStoreTail(writer, layer, levels, NULL);
    free(memory);
    return result;
}

SluiceResult write_one(SluiceStoreWriter *writer, const SluiceStoreLayout *layout,
                       enum picture picture, uint32_t layer, uint32_t level, uint32_t x, uint32_t y)
{
    if (level == layout->tailFirstLevel)
        return write_tail(writer, layout, picture, layer);
    SluiceImageRegion region;
    CHECK_OK(sluiceGetStoreTileRegion(layout, level, x, y, &region));
    region.arrayLayer = layer;
    /* Every other tile with rows that are not tight. */
    size_t pitch = sluiceGetFormatRegionSize(layout->format, region.width, 1) + (x + y) % 2 * 24;
    unsigned char *texels = calloc(region.height, pitch);
    paint(picture, layout->format, &region, texels, pitch);
    SluiceResult result = sluiceWriteStoreTile(writer, layer, level, x, y, texels, pitch);
    free(texels);
    return result;
}

SluiceResult write_tiles(SluiceStoreWriter *writer, const SluiceStoreCreateInfo *info,
                         enum picture picture, uint64_t limit)
{
    SluiceStoreLayout layout;
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    for (uint32_t layer = 0; layer < slc_max_u32(1, info->arrayLayerCount); layer++)
        for (uint32_t level = 0; level <= layout.tailFirstLevel; level++)
            for (uint32_t y = 0; y < layout.levelHeightInTiles[level]; y++)
                for (uint32_t x = 0; x < layout.levelWidthInTiles[level]; x++) {
                    bool is_written = false;
                    SluiceResult result =
                        sluiceIsStoreTileWritten(writer, layer, level, x, y, &is_written);
                    if (result == SLUICE_SUCCESS && is_written)
                        continue;
                    if (limit-- == 0)
                        return SLUICE_SUCCESS;
                    if (result == SLUICE_SUCCESS)
                        result = write_one(writer, &layout, picture, layer, level, x, y);
                    if (result != SLUICE_SUCCESS)
                        return result;
                }
    return sluiceFinishStore(writer);
}

SluiceResult write_store(const SluiceStoreCreateInfo *info, enum picture picture)
{
    SluiceStoreWriter *writer = NULL;
    SluiceResult result = sluiceCreateStoreWriter(info, &writer);
    if (result == SLUICE_SUCCESS)
        result = write_tiles(writer, info, picture, UINT64_MAX);
    sluiceDestroyStoreWriter(writer);
    return result;
}

static SluiceResult read_level(SluiceImageSource *source, const SluiceImageInfo *info,
                               uint32_t layer, uint32_t level, enum picture picture)
{
    SluiceImageRegion region = {
        level, 0, 0, slc_mip_size(info->width, level), slc_mip_size(info->height, level), layer};
    size_t pitch = sluiceGetFormatRegionSize(info->format, region.width, 1);
    void *texels = malloc(sluiceGetFormatRegionSize(info->format, region.width, region.height));
    SluiceResult result = sluiceReadImageRegion(source, &region, texels, pitch);
    if (result == SLUICE_SUCCESS)
        assert_true(is_painted(picture, info->format, &region, texels, pitch));
    free(texels);
    return result;
}

SluiceResult read_store(const char *path, enum picture picture, struct messages *messages)
{
    struct messages own;
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = path,
                                               .log = messages_log(messages ? messages : &own)};
    SluiceImageSource *source = NULL;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceCreateStoreImageSource(&create, &source);
    if (result != SLUICE_SUCCESS)
        return result;
    CHECK_OK(sluiceGetImageInfo(source, &info));
    for (uint32_t layer = 0; layer < info.arrayLayerCount; layer++)
        for (uint32_t l = 0; l < info.mipLevelCount && result == SLUICE_SUCCESS; l++)
            result = read_level(source, &info, layer, l, picture);
    sluiceDestroyImageSource(source);
    return result;
}

unsigned char *read_bytes(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

bool exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}
