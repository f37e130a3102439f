/* Images of the OpenEXR project: the result of each, and all texels against a plain reader. */
#include <sluice/exr.h>

#include "base/checked.h"
#include "exr/exr_paths.h"
#include "exr/plain_exr.h"
#include "image/half.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct image {
    const char *name;
    uint32_t width, height;
    SluiceFormat format;
    bool has_levels;
};

#define RGBA16 SLUICE_FORMAT_R16G16B16A16_SFLOAT
static const struct image images[] = {
    {"MultiResolution/Bonita.exr", 550, 832, RGBA16, true},
    {"MultiResolution/ColorCodedLevels.exr", 512, 512, RGBA16, true},
    {"MultiResolution/KernerEnvCube.exr", 256, 1536, RGBA16, true},
    {"MultiResolution/KernerEnvLatLong.exr", 1024, 512, RGBA16, true},
    {"MultiResolution/MirrorPattern.exr", 512, 512, RGBA16, true},
    {"MultiResolution/OrientationCube.exr", 512, 3072, RGBA16, true},
    {"MultiResolution/OrientationLatLong.exr", 1024, 512, RGBA16, true},
    {"MultiResolution/PeriodicPattern.exr", 517, 517, RGBA16, true},
    {"MultiResolution/StageEnvCube.exr", 256, 1536, RGBA16, true},
    {"MultiResolution/StageEnvLatLong.exr", 1000, 500, RGBA16, true}, /* rounded up */
    {"MultiResolution/WavyLinesCube.exr", 256, 1536, RGBA16, true},
    {"MultiResolution/WavyLinesLatLong.exr", 1024, 512, RGBA16, true},
    {"MultiResolution/WavyLinesSphere.exr", 480, 480, RGBA16, false},
    {"ScanLines/Cannon.exr", 780, 566, RGBA16, false}, /* B44 */
    {"ScanLines/Desk.exr", 644, 874, RGBA16, false},
    {"ScanLines/StillLife.exr", 1240, 846, RGBA16, false},
    {"TestImages/AllHalfValues.exr", 256, 256, RGBA16, false},
    {"TestImages/BrightRings.exr", 800, 800, RGBA16, false},
    {"TestImages/BrightRingsNanInf.exr", 800, 800, RGBA16, false},
    {"TestImages/GammaChart.exr", 800, 800, RGBA16, false},
    {"TestImages/GrayRampsDiagonal.exr", 800, 800, SLUICE_FORMAT_R16_SFLOAT, false},
    {"TestImages/GrayRampsHorizontal.exr", 800, 800, SLUICE_FORMAT_R16_SFLOAT, false},
    {"TestImages/RgbRampsDiagonal.exr", 800, 800, RGBA16, false},
    {"TestImages/SquaresSwirls.exr", 1000, 1000, RGBA16, false},
    {"TestImages/WideColorGamut.exr", 800, 800, RGBA16, false},
    {"TestImages/WideFloatRange.exr", 500, 500, SLUICE_FORMAT_R32_SFLOAT, false}, /* G alone */
    {"TestImages/stripes.exr", 100, 50, RGBA16, false},
    {"Tiles/GoldenGate.exr", 1262, 860, RGBA16, false},
};
enum { IMAGE_COUNT = sizeof images / sizeof images[0] };

static SluiceImageSource *open_image(const char *name, SluiceFormat format, SluiceImageInfo *info)
{
    char path[1024];
    if (!find_image(name, path))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = path, .format = format};
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    info->structSize = sizeof *info;
    CHECK_OK(sluiceGetImageInfo(source, info));
    return source;
}

static void *read_region(SluiceImageSource *source, const SluiceImageInfo *info,
                         const SluiceImageRegion *region)
{
    size_t pitch = (size_t)region->width * sluiceGetFormatTexelSize(info->format);
    void *texels = malloc(pitch * region->height);
    CHECK_OK(sluiceReadImageRegion(source, region, texels, pitch));
    return texels;
}

static SluiceImageRegion whole_level(const SluiceImageInfo *info, uint32_t level)
{
    return (SluiceImageRegion){level, 0, 0, slc_mip_size(info->width, level),
                               slc_mip_size(info->height, level)};
}

/* Expected bits of a component: from the file's channel, or a constant without one. */
static uint32_t expected_bits(const struct plain_level *level, uint32_t component_count, int c,
                              uint32_t x, uint32_t y)
{
    static const char *const names[4] = {"R", "G", "B", "A"};
    const struct plain_channel *channel = plain_exr_find(level, names[c]);
    if (!channel && c < 3)
        channel = plain_exr_find(level, "Y");
    if (component_count == 1 && level->channel_count == 1)
        channel = &level->channels[0];
    if (!channel)
        return c == 3 ? 0x3C00 : 0; /* all files that lack a channel are half */
    size_t at = (size_t)y * level->width + x;
    return channel->bytes == 2 ? ((const uint16_t *)channel->texels)[at]
                               : ((const uint32_t *)channel->texels)[at];
}

static void compare_region(const struct image *image, const SluiceImageRegion *region,
                           const void *texels, const struct plain_level *level)
{
    uint32_t size = image->format == SLUICE_FORMAT_R32_SFLOAT ? 4 : 2;
    uint32_t count = sluiceGetFormatTexelSize(image->format) / size;
    for (uint32_t y = 0; y < region->height; y++)
        for (uint32_t x = 0; x < region->width; x++)
            for (uint32_t c = 0; c < count; c++) {
                size_t at = ((size_t)y * region->width + x) * count + c;
                uint32_t bits =
                    size == 4 ? ((const uint32_t *)texels)[at] : ((const uint16_t *)texels)[at];
                uint32_t expected =
                    expected_bits(level, count, (int)c, region->x + x, region->y + y);
                if (bits != expected)
                    fail_msg("%s level %u (%u, %u) component %u: %x, not %x", image->name,
                             region->mipLevel, region->x + x, region->y + y, c, bits, expected);
            }
}

static SluiceImageRegion random_region(const SluiceImageInfo *info, uint32_t level,
                                       uint32_t *random)
{
    SluiceImageRegion whole = whole_level(info, level);
    uint32_t r[4];
    for (int i = 0; i < 4; i++) {
        *random = *random * 1664525u + 1013904223u;
        r[i] = *random >> 10;
    }
    SluiceImageRegion region = {level, r[0] % whole.width, r[1] % whole.height, 0, 0};
    region.width = 1 + r[2] % (whole.width - region.x);
    region.height = 1 + r[3] % (whole.height - region.y);
    return region;
}

static void every_image_opens_and_has_the_texels_a_plain_reader_finds(void **state)
{
    (void)state;
    uint32_t random = 5;
    for (int i = 0; i < IMAGE_COUNT; i++) {
        SluiceImageInfo info = {.structSize = sizeof info};
        SluiceImageSource *source = open_image(images[i].name, SLUICE_FORMAT_UNDEFINED, &info);
        assert_int_equal(info.width, images[i].width);
        assert_int_equal(info.height, images[i].height);
        assert_int_equal(info.format, images[i].format);
        char path[1024];
        find_image(images[i].name, path);
        for (uint32_t level = 0; level < (images[i].has_levels ? info.mipLevelCount : 1); level++) {
            struct plain_level plain;
            assert_true(plain_exr_read(path, (int)level, &plain));
            SluiceImageRegion region = whole_level(&info, level);
            for (int k = 0; k < 4; k++) {
                void *texels = read_region(source, &info, &region);
                compare_region(&images[i], &region, texels, &plain);
                free(texels);
                region = random_region(&info, level, &random);
            }
            plain_exr_free(&plain);
        }
        sluiceDestroyImageSource(source);
    }
}

/* IEC 61966-2-1: what a code from 0 to 255 stands for, and half codes between them. */
static long double decode(long double code)
{
    long double v = code / 255;
    return v <= 0.04045L ? v / 12.92L : powl((v + 0.055L) / 1.055L, 2.4L);
}

struct codes {
    long double middle[256], lowest[256], highest[256]; ///< values that round to a code
};

static const struct codes *srgb_codes(void)
{
    static struct codes codes;
    for (int i = 0; codes.highest[255] == 0 && i < 256; i++) {
        codes.middle[i] = decode(i);
        codes.lowest[i] = i ? decode(i - 0.5L) : -INFINITY;
        codes.highest[i] = i < 255 ? decode(i + 0.5L) : INFINITY;
    }
    return &codes;
}

/* Large levels are compared in every 13th row, which meets all phases of chunks and filters. */
static uint32_t row_step(const SluiceImageRegion *region)
{
    return region->height > 128 ? 13 : 1;
}

/* Returns whether a byte encodes a value; NaN is 0. The library's thresholds are floats. */
static bool is_code(long double value, uint8_t byte, bool is_alpha)
{
    const struct codes *codes = srgb_codes();
    if (isnan(value))
        return byte == 0;
    if (is_alpha)
        return fabsl(fminl(fmaxl(value, 0), 1) * 255 - byte) <= 0.5001L;
    return value >= codes->lowest[byte] - fabsl(codes->lowest[byte]) * 1e-6L &&
           value <= codes->highest[byte] * (1 + 1e-6L);
}

static long double channel_value(const struct plain_channel *channel, size_t at)
{
    float value;
    if (channel->bytes == 2)
        return (long double)slc_float_from_half(((const uint16_t *)channel->texels)[at]);
    memcpy(&value, (const char *)channel->texels + 4 * at, 4);
    return (long double)value;
}

/* Compares a level in the file. */
static void compare_bytes(const struct image *image, const SluiceImageRegion *region,
                          const uint8_t *texels, const struct plain_level *level)
{
    static const char *const names[4] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++) {
        const struct plain_channel *channel = plain_exr_find(level, names[c]);
        if (!channel && c < 3)
            channel = plain_exr_find(level, "Y");
        for (uint32_t i = 0; i < region->width * region->height; i++) {
            if (i / region->width % row_step(region) != 0)
                continue;
            size_t at = (size_t)(i / region->width) * level->width + i % region->width;
            long double value = channel ? channel_value(channel, at) : c == 3;
            if (!is_code(value, texels[4 * (size_t)i + (size_t)c], c == 3))
                fail_msg("%s level %u texel %u component %d: %u for %Lg", image->name,
                         region->mipLevel, i, c, texels[4 * (size_t)i + (size_t)c], value);
        }
    }
}

/* A level in memory, as numbers. */
struct numbers {
    SluiceFormat format;
    SluiceImageRegion region;
    void *texels;
};

/* Returns a number; NaN is 0. */
static long double number_at(const struct numbers *n, uint32_t count, uint32_t x, uint32_t y,
                             uint32_t c)
{
    size_t at = ((size_t)y * n->region.width + x) * count + c;
    float value;
    if (n->format == SLUICE_FORMAT_R8G8B8A8_SRGB) {
        uint8_t byte = ((const uint8_t *)n->texels)[at];
        return c == 3 ? byte / 255.0L : srgb_codes()->middle[byte];
    }
    if (n->format == SLUICE_FORMAT_R32_SFLOAT)
        memcpy(&value, (const char *)n->texels + 4 * at, 4);
    else
        value = slc_float_from_half(((const uint16_t *)n->texels)[at]);
    return isnan(value) ? 0 : (long double)value;
}

/* Finds the texels, at most three, that one texel below covers along an axis, with their shares. */
static uint32_t find_cover(uint32_t size, uint32_t i, long double weights[3])
{
    uint32_t below = size > 1 ? size / 2 : 1;
    long double scale = (long double)size / below, first = i * scale, end = (i + 1) * scale;
    uint32_t begin = (uint32_t)(first + 1e-9L);
    for (uint32_t k = 0; k < 3; k++)
        weights[k] = fmaxl(0, fminl(end, begin + k + 1) - fmaxl(first, begin + k)) / scale;
    return begin;
}

/* Returns a mean. `*size`: mean of the magnitudes, which bounds the error of doubles. */
static long double mean_of(const struct numbers *above, uint32_t count, uint32_t x, uint32_t y,
                           uint32_t c, long double *size)
{
    long double wx[3], wy[3], sum = 0;
    *size = 0;
    uint32_t first_x = find_cover(above->region.width, x, wx);
    uint32_t first_y = find_cover(above->region.height, y, wy);
    for (uint32_t j = 0; j < 3; j++)
        for (uint32_t i = 0; i < 3; i++) {
            if (wx[i] * wy[j] <= 1e-12L)
                continue;
            long double value = number_at(above, count, first_x + i, first_y + j, c);
            sum += wx[i] * wy[j] * value;
            *size += wx[i] * wy[j] * fabsl(value);
        }
    return sum;
}

/* Allows half of the distance between two halves, and a little for rounding in double. */
static bool is_nearest_half(long double mean, long double value)
{
    mean = isnan(mean) ? 0 : fminl(fmaxl(mean, -65504), 65504);
    int exponent = fabsl(mean) > 0x1p-14L ? ilogbl(mean) : -14;
    return fabsl(value - mean) <= 0.501L * ldexpl(1, exponent - 10);
}

/* Compares a built level: each texel is a mean of the level above. */
static void compare_mean(const struct image *image, const struct numbers *above,
                         const struct numbers *level)
{
    bool is_float = level->format == SLUICE_FORMAT_R32_SFLOAT;
    uint32_t count =
        level->format == RGBA16 || level->format == SLUICE_FORMAT_R8G8B8A8_SRGB ? 4 : 1;
    for (uint32_t y = 0; y < level->region.height; y += row_step(&level->region))
        for (uint32_t x = 0; x < level->region.width; x++)
            for (uint32_t c = 0; c < count; c++) {
                long double size, mean = mean_of(above, count, x, y, c, &size);
                long double value = number_at(level, count, x, y, c);
                size_t at = ((size_t)y * level->region.width + x) * count + c;
                bool is_right = level->format == SLUICE_FORMAT_R8G8B8A8_SRGB
                                    ? is_code(mean, ((const uint8_t *)level->texels)[at], c == 3)
                                : is_float ? fabsl(value - mean) <= size * 1e-6L
                                           : is_nearest_half(mean, value);
                if (!is_right)
                    fail_msg("%s as %s, level %u (%u, %u) component %u: %Lg, not %Lg", image->name,
                             sluiceGetFormatName(level->format), level->region.mipLevel, x, y, c,
                             value, mean);
            }
}

static void compare_built_levels(const struct image *image, SluiceImageSource *source,
                                 const SluiceImageInfo *info)
{
    struct numbers above = {info->format, whole_level(info, 0), NULL};
    above.texels = read_region(source, info, &above.region);
    for (uint32_t l = 1; l < info->mipLevelCount; l++) {
        struct numbers level = {info->format, whole_level(info, l), NULL};
        level.texels = read_region(source, info, &level.region);
        compare_mean(image, &above, &level);
        free(above.texels);
        above = level;
    }
    free(above.texels);
}

static void levels_that_are_built_are_means_of_the_level_above(void **state)
{
    (void)state;
    for (int i = 0; i < IMAGE_COUNT; i++) {
        SluiceImageInfo info = {.structSize = sizeof info};
        if (images[i].has_levels)
            continue;
        SluiceImageSource *source = open_image(images[i].name, SLUICE_FORMAT_UNDEFINED, &info);
        compare_built_levels(&images[i], source, &info);
        sluiceDestroyImageSource(source);
    }
}

static void all_levels_of_all_images_are_right_as_bytes(void **state)
{
    (void)state;
    for (int i = 0; i < IMAGE_COUNT; i++) {
        SluiceImageInfo info = {.structSize = sizeof info};
        char path[1024];
        SluiceImageSource *source = open_image(images[i].name, SLUICE_FORMAT_R8G8B8A8_SRGB, &info);
        find_image(images[i].name, path);
        for (uint32_t level = 0; level < (images[i].has_levels ? info.mipLevelCount : 1); level++) {
            struct plain_level plain;
            SluiceImageRegion region = whole_level(&info, level);
            uint8_t *texels = read_region(source, &info, &region);
            assert_true(plain_exr_read(path, (int)level, &plain));
            compare_bytes(&images[i], &region, texels, &plain);
            plain_exr_free(&plain);
            free(texels);
        }
        if (!images[i].has_levels)
            compare_built_levels(&images[i], source, &info);
        sluiceDestroyImageSource(source);
    }
}

static void all_half_values_keep_their_bits(void **state)
{
    (void)state;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageSource *source =
        open_image("TestImages/AllHalfValues.exr", SLUICE_FORMAT_UNDEFINED, &info);
    SluiceImageRegion region = whole_level(&info, 0);
    uint16_t(*texels)[4] = read_region(source, &info, &region);
    static unsigned char seen[65536];
    for (uint32_t i = 0; i < 65536; i++)
        seen[texels[i][0]]++;
    for (uint32_t i = 0; i < 65536; i++)
        assert_int_equal(seen[i], 1);
    free(texels);
    sluiceDestroyImageSource(source);
}

static void all_half_values_convert_as_documented(void **state)
{
    (void)state;
    SluiceImageInfo half_info = {.structSize = sizeof half_info},
                    float_info = {.structSize = sizeof float_info},
                    byte_info = {.structSize = sizeof byte_info};
    const char *name = "TestImages/AllHalfValues.exr";
    SluiceImageSource *halves = open_image(name, RGBA16, &half_info);
    SluiceImageSource *floats = open_image(name, SLUICE_FORMAT_R32G32B32A32_SFLOAT, &float_info);
    SluiceImageSource *bytes = open_image(name, SLUICE_FORMAT_R8G8B8A8_UNORM, &byte_info);
    SluiceImageRegion region = whole_level(&half_info, 0);
    uint16_t(*h)[4] = read_region(halves, &half_info, &region);
    float(*f)[4] = read_region(floats, &float_info, &region);
    uint8_t(*b)[4] = read_region(bytes, &byte_info, &region);
    for (uint32_t i = 0; i < 65536; i++) {
        float value = slc_float_from_half(h[i][0]);
        if (isnan(value))
            assert_true(isnan(f[i][0]));
        else
            assert_true(f[i][0] == value && signbit(f[i][0]) == signbit(value));
        double clamped = isnan(value) || value < 0 ? 0 : value > 1 ? 1 : (double)value;
        assert_true(fabs(clamped * 255 - b[i][0]) <= 0.5);
        assert_int_equal(b[i][3], 255);
    }
    free(h);
    free(f);
    free(b);
    sluiceDestroyImageSource(halves);
    sluiceDestroyImageSource(floats);
    sluiceDestroyImageSource(bytes);
}

static void nan_and_infinities_stay_in_level_0_and_nowhere_else(void **state)
{
    (void)state;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageSource *source =
        open_image("TestImages/BrightRingsNanInf.exr", SLUICE_FORMAT_UNDEFINED, &info);
    for (uint32_t level = 0; level < info.mipLevelCount; level++) {
        SluiceImageRegion region = whole_level(&info, level);
        uint16_t *values = read_region(source, &info, &region);
        uint32_t nan_count = 0, infinity_count = 0;
        for (size_t i = 0; i < (size_t)region.width * region.height * 4; i++) {
            nan_count += (values[i] & 0x7FFF) > 0x7C00;
            infinity_count += (values[i] & 0x7FFF) == 0x7C00;
        }
        assert_int_equal(nan_count > 0, level == 0);
        assert_int_equal(infinity_count > 0, level == 0);
        free(values);
    }
    sluiceDestroyImageSource(source);
}

static void a_wide_float_range_saturates_as_half(void **state)
{
    (void)state;
    SluiceImageInfo float_info = {.structSize = sizeof float_info},
                    half_info = {.structSize = sizeof half_info};
    const char *name = "TestImages/WideFloatRange.exr";
    SluiceImageSource *floats = open_image(name, SLUICE_FORMAT_R32_SFLOAT, &float_info);
    SluiceImageSource *halves = open_image(name, SLUICE_FORMAT_R16_SFLOAT, &half_info);
    SluiceImageRegion region = whole_level(&float_info, 0);
    float *f = read_region(floats, &float_info, &region);
    uint16_t *h = read_region(halves, &half_info, &region);
    uint32_t saturated = 0;
    for (size_t i = 0; i < (size_t)region.width * region.height; i++) {
        assert_int_equal(h[i], slc_half_from_float(f[i])); /* tested elsewhere */
        saturated += fabsf(f[i]) > 65520.0f && (h[i] & 0x7FFF) == 0x7BFF;
    }
    assert_true(saturated > 0);
    free(f);
    free(h);
    sluiceDestroyImageSource(floats);
    sluiceDestroyImageSource(halves);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_image_opens_and_has_the_texels_a_plain_reader_finds),
        cmocka_unit_test(levels_that_are_built_are_means_of_the_level_above),
        cmocka_unit_test(all_levels_of_all_images_are_right_as_bytes),
        cmocka_unit_test(all_half_values_keep_their_bits),
        cmocka_unit_test(all_half_values_convert_as_documented),
        cmocka_unit_test(nan_and_infinities_stay_in_level_0_and_nowhere_else),
        cmocka_unit_test(a_wide_float_range_saturates_as_half),
    };
    return RUN_TESTS(tests);
}
