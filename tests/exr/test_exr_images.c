/* The OpenEXR project's images: the outcome of each, and every texel against a plain reader. */
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
    SluiceExrImageSourceCreateInfo create = {.pPath = path, .format = format};
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    CHECK_OK(sluiceGetImageInfo(source, info));
    return source;
}

static void *read_region(SluiceImageSource *source, const SluiceImageInfo *info,
                         const SluiceImageRegion *region)
{
    size_t pitch = (size_t)region->width * sluiceFormatTexelSize(info->format);
    void *texels = malloc(pitch * region->height);
    CHECK_OK(sluiceReadImageRegion(source, region, texels, pitch));
    return texels;
}

static SluiceImageRegion whole_level(const SluiceImageInfo *info, uint32_t level)
{
    return (SluiceImageRegion){level, 0, 0, slc_mip_size(info->width, level),
                               slc_mip_size(info->height, level)};
}

/* The bits that a component must have: those of the file's channel, or the constant for none. */
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
    uint32_t count = sluiceFormatTexelSize(image->format) / size;
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
        SluiceImageInfo info;
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

static void all_levels_of_all_images_can_be_read_as_bytes(void **state)
{
    (void)state;
    for (int i = 0; i < IMAGE_COUNT; i++) {
        SluiceImageInfo info;
        SluiceImageSource *source = open_image(images[i].name, SLUICE_FORMAT_R8G8B8A8_SRGB, &info);
        for (uint32_t level = 0; level < info.mipLevelCount; level++) {
            SluiceImageRegion region = whole_level(&info, level);
            free(read_region(source, &info, &region));
        }
        sluiceDestroyImageSource(source);
    }
}

static void all_half_values_keep_their_bits(void **state)
{
    (void)state;
    SluiceImageInfo info;
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
    SluiceImageInfo half_info, float_info, byte_info;
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
    SluiceImageInfo info;
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
    SluiceImageInfo float_info, half_info;
    const char *name = "TestImages/WideFloatRange.exr";
    SluiceImageSource *floats = open_image(name, SLUICE_FORMAT_R32_SFLOAT, &float_info);
    SluiceImageSource *halves = open_image(name, SLUICE_FORMAT_R16_SFLOAT, &half_info);
    SluiceImageRegion region = whole_level(&float_info, 0);
    float *f = read_region(floats, &float_info, &region);
    uint16_t *h = read_region(halves, &half_info, &region);
    uint32_t saturated = 0;
    for (size_t i = 0; i < (size_t)region.width * region.height; i++) {
        assert_int_equal(h[i], slc_half_from_float(f[i])); /* which has a test of its own */
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
        cmocka_unit_test(all_levels_of_all_images_can_be_read_as_bytes),
        cmocka_unit_test(all_half_values_keep_their_bits),
        cmocka_unit_test(all_half_values_convert_as_documented),
        cmocka_unit_test(nan_and_infinities_stay_in_level_0_and_nowhere_else),
        cmocka_unit_test(a_wide_float_range_saturates_as_half),
    };
    return RUN_TESTS(tests);
}
