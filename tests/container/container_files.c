#define _XOPEN_SOURCE 700

#include "container/container_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/test.h"

#ifdef TEST_HAS_ZSTD
#include <zstd.h>
#endif

#define BLOCK(name, dxgi, vulkan, size)                                                            \
    {                                                                                              \
        SLUICE_FORMAT_##name##_BLOCK, dxgi, vulkan, size, 4, 0, 0                                  \
    }
#define TEXEL(name, dxgi, vulkan, size)                                                            \
    {                                                                                              \
        SLUICE_FORMAT_##name, dxgi, vulkan, size, 1, 0, 0                                          \
    }

const struct format_names format_names[] = {
    TEXEL(R8_UNORM, 61, 9, 1),
    TEXEL(R8G8_UNORM, 49, 16, 2),
    TEXEL(R8G8B8A8_UNORM, 28, 37, 4),
    TEXEL(R8G8B8A8_SRGB, 29, 43, 4),
    TEXEL(R16_SFLOAT, 54, 76, 2),
    TEXEL(R16G16_SFLOAT, 34, 83, 4),
    TEXEL(R16G16B16A16_SFLOAT, 10, 97, 8),
    TEXEL(R32_SFLOAT, 41, 100, 4),
    TEXEL(R32G32_SFLOAT, 16, 103, 8),
    TEXEL(R32G32B32A32_SFLOAT, 2, 109, 16),
    TEXEL(A2B10G10R10_UNORM_PACK32, 24, 64, 4),
    TEXEL(B10G11R11_UFLOAT_PACK32, 26, 122, 4),
    TEXEL(E5B9G9R9_UFLOAT_PACK32, 67, 123, 4),
    BLOCK(BC1_RGB_UNORM, 0, 131, 8),
    BLOCK(BC1_RGB_SRGB, 0, 132, 8),
    BLOCK(BC1_RGBA_UNORM, 71, 133, 8),
    BLOCK(BC1_RGBA_SRGB, 72, 134, 8),
    BLOCK(BC2_UNORM, 74, 135, 16),
    BLOCK(BC2_SRGB, 75, 136, 16),
    BLOCK(BC3_UNORM, 77, 137, 16),
    BLOCK(BC3_SRGB, 78, 138, 16),
    BLOCK(BC4_UNORM, 80, 139, 8),
    BLOCK(BC4_SNORM, 81, 140, 8),
    BLOCK(BC5_UNORM, 83, 141, 16),
    BLOCK(BC5_SNORM, 84, 142, 16),
    BLOCK(BC6H_UFLOAT, 95, 143, 16),
    BLOCK(BC6H_SFLOAT, 96, 144, 16),
    BLOCK(BC7_UNORM, 98, 145, 16),
    BLOCK(BC7_SRGB, 99, 146, 16),
    TEXEL(R16_UNORM, 56, 70, 2),
    TEXEL(R16G16_UNORM, 35, 77, 4),
    TEXEL(R16G16B16A16_UNORM, 11, 91, 8),
    BLOCK(ETC2_R8G8B8_UNORM, 0, 147, 8),
    BLOCK(ETC2_R8G8B8_SRGB, 0, 148, 8),
    BLOCK(ETC2_R8G8B8A1_UNORM, 0, 149, 8),
    BLOCK(ETC2_R8G8B8A1_SRGB, 0, 150, 8),
    BLOCK(ETC2_R8G8B8A8_UNORM, 0, 151, 16),
    BLOCK(ETC2_R8G8B8A8_SRGB, 0, 152, 16),
    BLOCK(EAC_R11_UNORM, 0, 153, 8),
    BLOCK(EAC_R11_SNORM, 0, 154, 8),
    BLOCK(EAC_R11G11_UNORM, 0, 155, 16),
    BLOCK(EAC_R11G11_SNORM, 0, 156, 16),
    BLOCK(ASTC_4x4_UNORM, 0, 157, 16),
    BLOCK(ASTC_4x4_SRGB, 0, 158, 16),
    {SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK, 0, 171, 16, 8, false, false},
    {SLUICE_FORMAT_ASTC_8x8_SRGB_BLOCK, 0, 172, 16, 8, false, false},
    TEXEL(R8_SNORM, 63, 10, 1),
    TEXEL(R8G8_SNORM, 51, 17, 2),
    TEXEL(R8G8B8A8_SNORM, 31, 38, 4),
    TEXEL(R16_SNORM, 58, 71, 2),
    TEXEL(R16G16_SNORM, 37, 78, 4),
    TEXEL(R16G16B16A16_SNORM, 13, 92, 8),
    TEXEL(R8_UINT, 62, 13, 1),
    TEXEL(R8G8_UINT, 50, 20, 2),
    TEXEL(R8G8B8A8_UINT, 30, 41, 4),
    TEXEL(R16_UINT, 57, 74, 2),
    TEXEL(R16G16_UINT, 36, 81, 4),
    TEXEL(R16G16B16A16_UINT, 12, 95, 8),
    TEXEL(R32_UINT, 42, 98, 4),
    TEXEL(R32G32_UINT, 17, 101, 8),
    TEXEL(R32G32B32A32_UINT, 3, 107, 16),
    TEXEL(R8_SINT, 64, 14, 1),
    TEXEL(R8G8_SINT, 52, 21, 2),
    TEXEL(R8G8B8A8_SINT, 32, 42, 4),
    TEXEL(R16_SINT, 59, 75, 2),
    TEXEL(R16G16_SINT, 38, 82, 4),
    TEXEL(R16G16B16A16_SINT, 14, 96, 8),
    TEXEL(R32_SINT, 43, 99, 4),
    TEXEL(R32G32_SINT, 18, 102, 8),
    TEXEL(R32G32B32A32_SINT, 4, 108, 16),
    {SLUICE_FORMAT_R8G8B8A8_UNORM, 87, 44, 4, 1, true, false},
    {SLUICE_FORMAT_R8G8B8A8_SRGB, 91, 50, 4, 1, true, false},
    {SLUICE_FORMAT_R8G8B8A8_UNORM, 88, 0, 4, 1, true, true},
    {SLUICE_FORMAT_R8G8B8A8_SRGB, 93, 0, 4, 1, true, true},
};

const uint32_t format_names_count = sizeof format_names / sizeof format_names[0];

const struct format_names *format_names_of(SluiceFormat format)
{
    for (uint32_t i = 0; i < format_names_count; i++)
        if (format_names[i].format == format)
            return &format_names[i];
    fail_msg("no names for format %d", (int)format);
    return NULL;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static uint32_t blocks(const struct picture *p, uint32_t texels)
{
    return (texels + p->format->block_extent - 1) / p->format->block_extent;
}

static size_t image_size(const struct picture *p, uint32_t level)
{
    return (size_t)blocks(p, level_size(p->width, level)) *
           blocks(p, level_size(p->height, level)) * p->format->block_size;
}

uint32_t picture_level_count(const struct picture *p)
{
    uint32_t count = 1;
    while (p->width >> count || p->height >> count)
        count++;
    return p->level_count ? p->level_count : count;
}

uint32_t picture_layer_count(const struct picture *p)
{
    return (p->layer_count ? p->layer_count : 1) * (p->is_cube ? 6 : 1);
}

uint8_t picture_byte(uint32_t layer, uint32_t level, uint64_t index)
{
    uint64_t x = (index + 1) * 0x9E3779B97F4A7C15u + layer * 0xD1B54A32D192ED03u + level * 0xABCDu;
    x ^= x >> 29;
    return (uint8_t)(x * 0xBF58476D1CE4E5B9u >> 56);
}

static void put_u32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> 8 * i);
}

static void put_u64(uint8_t *at, uint64_t value)
{
    put_u32(at, (uint32_t)value);
    put_u32(at + 4, (uint32_t)(value >> 32));
}

static uint8_t *put_image(uint8_t *at, const struct picture *p, uint32_t layer, uint32_t level)
{
    size_t size = image_size(p, level);
    for (size_t i = 0; i < size; i++)
        at[i] = picture_byte(layer, level, i);
    return at + size;
}

static struct file_bytes dds_file(const struct picture *p, const uint32_t pixel_format[7],
                                  size_t header_size)
{
    size_t chain = 0;
    for (uint32_t level = 0; level < picture_level_count(p); level++)
        chain += image_size(p, level);
    struct file_bytes file = {NULL, header_size + chain * picture_layer_count(p), header_size};
    file.bytes = calloc(1, file.size);
    assert_non_null(file.bytes);
    memcpy(file.bytes, "DDS ", 4);
    put_u32(file.bytes + 4, 124);
    put_u32(file.bytes + 8, 0x21007); /* caps, height, width, pixel format, level count */
    put_u32(file.bytes + 12, p->height);
    put_u32(file.bytes + 16, p->width);
    put_u32(file.bytes + 28, picture_level_count(p));
    put_u32(file.bytes + 76, 32);
    for (int i = 0; i < 7; i++)
        put_u32(file.bytes + 80 + 4 * i, pixel_format[i]);
    put_u32(file.bytes + 108, 0x401008);
    put_u32(file.bytes + 112, p->is_cube ? 0xFE00 : 0);
    uint8_t *at = file.bytes + header_size;
    for (uint32_t layer = 0; layer < picture_layer_count(p); layer++)
        for (uint32_t level = 0; level < picture_level_count(p); level++)
            at = put_image(at, p, layer, level);
    return file;
}

struct file_bytes make_old_dds(const struct picture *p, const uint32_t pixel_format[7])
{
    return dds_file(p, pixel_format, 128);
}

struct file_bytes make_dds(const struct picture *p)
{
    static const uint32_t dx10[7] = {0x4, 0x30315844};
    struct file_bytes file = dds_file(p, dx10, 148);
    put_u32(file.bytes + 128, p->format->dxgi);
    put_u32(file.bytes + 132, 3);
    put_u32(file.bytes + 136, p->is_cube ? 4 : 0);
    put_u32(file.bytes + 140, p->layer_count ? p->layer_count : 1);
    return file;
}

/* Compresses the bytes in place; the new size. */
static size_t compress_level(uint8_t *bytes, size_t size, size_t room)
{
#ifdef TEST_HAS_ZSTD
    void *copy = malloc(size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    size_t got = ZSTD_compress(bytes, room, copy, size, 3);
    assert_false(ZSTD_isError(got));
    free(copy);
    return got;
#else
    (void)bytes, (void)size, (void)room;
    fail_msg("this build has no Zstandard");
    return 0;
#endif
}

struct file_bytes make_ktx2(const struct picture *p, uint32_t scheme)
{
    static const uint8_t identifier[12] = {0xAB, 0x4B, 0x54, 0x58, 0x20, 0x32,
                                           0x30, 0xBB, 0x0D, 0x0A, 0x1A, 0x0A};
    uint32_t levels = picture_level_count(p), layers = picture_layer_count(p);
    size_t at = 80 + 24 * (size_t)levels, room = at + 4096;
    for (uint32_t level = 0; level < levels; level++)
        room += image_size(p, level) * layers + 4096;
    struct file_bytes file = {calloc(1, room), 0, 0};
    assert_non_null(file.bytes);
    const uint32_t header[9] = {p->format->vulkan,  1,      p->width, p->height, 0, p->layer_count,
                                p->is_cube ? 6 : 1, levels, scheme};
    memcpy(file.bytes, identifier, sizeof identifier);
    for (int i = 0; i < 9; i++)
        put_u32(file.bytes + 12 + 4 * i, header[i]);
    put_u32(file.bytes + 48, (uint32_t)at); /* a data format descriptor without samples */
    put_u32(file.bytes + 52, 28);
    put_u32(file.bytes + at, 28);
    put_u32(file.bytes + at + 8, 24u << 16 | 2);
    at += 28;
    for (uint32_t level = levels; level-- > 0;) { /* the smallest is first in the file */
        at += scheme ? 0 : (48 - at % 48) % 48;   /* a multiple of 4 and of every block size */
        if (file.header_size == 0)
            file.header_size = at;
        uint8_t *end = file.bytes + at;
        for (uint32_t layer = 0; layer < layers; layer++)
            end = put_image(end, p, layer, level);
        size_t size = (size_t)(end - file.bytes) - at, stored = size;
        if (scheme)
            stored = compress_level(file.bytes + at, size, room - at);
        put_u64(file.bytes + 80 + 24 * level, at);
        put_u64(file.bytes + 88 + 24 * level, stored);
        put_u64(file.bytes + 96 + 24 * level, size);
        at += stored;
    }
    file.size = at;
    return file;
}

void scratch_init(struct scratch *scratch, const struct file_bytes *file)
{
    strcpy(scratch->path, "/tmp/sluice-container-XXXXXX");
    scratch->descriptor = mkstemp(scratch->path);
    assert_true(scratch->descriptor >= 0);
    scratch_replace(scratch, file->bytes, file->size);
}

void scratch_replace(struct scratch *scratch, const void *bytes, size_t size)
{
    assert_int_equal(ftruncate(scratch->descriptor, 0), 0);
    assert_int_equal(pwrite(scratch->descriptor, bytes, size, 0), size);
}

void scratch_finish(struct scratch *scratch)
{
    close(scratch->descriptor);
    unlink(scratch->path);
}

/* In memory, words have the host's order; the name says how long they are. */
static uint64_t host_index(SluiceFormat format, uint64_t index)
{
    const uint16_t one = 1;
    const char *name = sluiceGetFormatName(format);
    uint64_t size = strstr(name, "_PACK32") ? 4 : strtoul(name + 1, NULL, 10) / 8;
    if (*(const uint8_t *)&one || strstr(name, "_BLOCK"))
        return index;
    return index - index % size + (size - 1 - index % size);
}

static uint8_t delivered_byte(const struct picture *p, uint32_t layer, uint32_t level,
                              uint64_t index)
{
    uint64_t channel = index % 4;
    if (p->format->is_opaque && channel == 3)
        return 255;
    if (p->format->is_bgra && channel != 3)
        index = index - channel + (2 - channel);
    return picture_byte(layer, level, host_index(p->format->format, index));
}

/* Reads a rectangle of blocks into rows that are `gap` bytes apart and looks at every byte. */
static void check_blocks(SluiceImageSource *source, const struct picture *p,
                         const uint32_t where[6], size_t gap)
{
    uint32_t layer = where[0], level = where[1], x = where[2], y = where[3];
    uint32_t extent = p->format->block_extent, size = p->format->block_size;
    uint32_t width = level_size(p->width, level), height = level_size(p->height, level);
    uint32_t right = (x + where[4]) * extent, bottom = (y + where[5]) * extent;
    SluiceImageRegion region = {level, x * extent, y * extent, 0, 0, layer};
    region.width = (right < width ? right : width) - region.x;
    region.height = (bottom < height ? bottom : height) - region.y;
    size_t row = (size_t)where[4] * size, pitch = row + gap;
    uint8_t *texels = malloc(pitch * where[5]);
    assert_non_null(texels);
    memset(texels, 0x5A, pitch * where[5]);
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, pitch));
    for (uint32_t j = 0; j < where[5]; j++)
        for (size_t i = 0; i < pitch; i++) {
            uint64_t index = ((uint64_t)(y + j) * blocks(p, width) + x) * size + i;
            uint8_t expected = i < row ? delivered_byte(p, layer, level, index) : 0x5A;
            if (texels[j * pitch + i] != expected)
                fail_msg("layer %u, level %u, block row %u, byte %zu: %02x, not %02x", layer, level,
                         y + j, i, texels[j * pitch + i], expected);
        }
    free(texels);
}

static void check_level(SluiceImageSource *source, const struct picture *p, uint32_t layer,
                        uint32_t level)
{
    uint32_t width = blocks(p, level_size(p->width, level));
    uint32_t height = blocks(p, level_size(p->height, level));
    check_blocks(source, p, (uint32_t[]){layer, level, 0, 0, width, height}, 0);
    check_blocks(source, p, (uint32_t[]){layer, level, 0, 0, width, height}, 5);
    uint32_t state = layer * 31 + level;
    for (int i = 0; i < 8; i++) {
        uint32_t numbers[4];
        for (int k = 0; k < 4; k++)
            numbers[k] = (state = state * 1664525 + 1013904223) >> 8;
        uint32_t x = numbers[0] % width, y = numbers[1] % height;
        uint32_t where[6] = {
            layer, level, x, y, 1 + numbers[2] % (width - x), 1 + numbers[3] % (height - y)};
        check_blocks(source, p, where, i % 3);
    }
}

void check_picture(SluiceImageSource *source, const struct picture *p)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_int_equal(info.width, p->width);
    assert_int_equal(info.height, p->height);
    assert_int_equal(info.mipLevelCount, picture_level_count(p));
    assert_int_equal(info.format, p->format->format);
    assert_int_equal(info.arrayLayerCount, picture_layer_count(p));
    assert_int_equal(info.cube, p->is_cube);
    for (uint32_t layer = 0; layer < info.arrayLayerCount; layer++)
        for (uint32_t level = 0; level < info.mipLevelCount; level++)
            check_level(source, p, layer, level);
}

SluiceResult read_everything(SluiceImageSource *source)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetImageInfo(source, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t layer = 0; layer < info.arrayLayerCount; layer++)
        for (uint32_t level = 0; level < info.mipLevelCount; level++) {
            SluiceImageRegion region = {
                level, 0, 0, level_size(info.width, level), level_size(info.height, level), layer};
            uint64_t row = sluiceGetFormatRegionSize(info.format, region.width, 1);
            void *texels =
                malloc(sluiceGetFormatRegionSize(info.format, region.width, region.height));
            assert_non_null(texels);
            result = sluiceReadImageRegion(source, &region, texels, row);
            free(texels);
            if (result != SLUICE_SUCCESS)
                return result;
        }
    return result;
}

static void on_log(void *user, SluiceLogSeverity severity, const char *text)
{
    struct log_tally *tally = user;
    tally->errors += severity == SLUICE_LOG_ERROR;
    snprintf(tally->last, sizeof tally->last, "%s", text);
    assert_non_null(strstr(text, tally->path));
    for (; *text; text++)
        assert_true(*text >= ' ' && *text <= '~');
}

SluiceLogCallback log_to(struct log_tally *tally)
{
    return (SluiceLogCallback){tally, on_log};
}
