#include "image/byte_order.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

struct expected {
    SluiceFormat format;
    const char *name;
    uint32_t bits_per_texel, tile_width, tile_height, channels;
};

#define EXPECT(name, bits, width, height, channels)                                                \
    {                                                                                              \
        SLUICE_FORMAT_##name, #name, bits, width, height, channels                                 \
    }

/* Tiles: Vulkan specification, "Standard Sparse Image Block Shapes (Single Sample)". */
static const struct expected all[] = {
    EXPECT(R8_UNORM, 8, 256, 256, 1),
    EXPECT(R8G8_UNORM, 16, 256, 128, 2),
    EXPECT(R8G8B8A8_UNORM, 32, 128, 128, 4),
    EXPECT(R8G8B8A8_SRGB, 32, 128, 128, 4),
    EXPECT(R16_SFLOAT, 16, 256, 128, 1),
    EXPECT(R16G16_SFLOAT, 32, 128, 128, 2),
    EXPECT(R16G16B16A16_SFLOAT, 64, 128, 64, 4),
    EXPECT(R32_SFLOAT, 32, 128, 128, 1),
    EXPECT(R32G32_SFLOAT, 64, 128, 64, 2),
    EXPECT(R32G32B32A32_SFLOAT, 128, 64, 64, 4),
    EXPECT(A2B10G10R10_UNORM_PACK32, 32, 128, 128, 4),
    EXPECT(B10G11R11_UFLOAT_PACK32, 32, 128, 128, 3),
    EXPECT(E5B9G9R9_UFLOAT_PACK32, 32, 128, 128, 3),
    EXPECT(BC1_RGB_UNORM_BLOCK, 4, 512, 256, 3),
    EXPECT(BC1_RGB_SRGB_BLOCK, 4, 512, 256, 3),
    EXPECT(BC1_RGBA_UNORM_BLOCK, 4, 512, 256, 4),
    EXPECT(BC1_RGBA_SRGB_BLOCK, 4, 512, 256, 4),
    EXPECT(BC2_UNORM_BLOCK, 8, 256, 256, 4),
    EXPECT(BC2_SRGB_BLOCK, 8, 256, 256, 4),
    EXPECT(BC3_UNORM_BLOCK, 8, 256, 256, 4),
    EXPECT(BC3_SRGB_BLOCK, 8, 256, 256, 4),
    EXPECT(BC4_UNORM_BLOCK, 4, 512, 256, 1),
    EXPECT(BC4_SNORM_BLOCK, 4, 512, 256, 1),
    EXPECT(BC5_UNORM_BLOCK, 8, 256, 256, 2),
    EXPECT(BC5_SNORM_BLOCK, 8, 256, 256, 2),
    EXPECT(BC6H_UFLOAT_BLOCK, 8, 256, 256, 3),
    EXPECT(BC6H_SFLOAT_BLOCK, 8, 256, 256, 3),
    EXPECT(BC7_UNORM_BLOCK, 8, 256, 256, 4),
    EXPECT(BC7_SRGB_BLOCK, 8, 256, 256, 4),
    EXPECT(R16_UNORM, 16, 256, 128, 1),
    EXPECT(R16G16_UNORM, 32, 128, 128, 2),
    EXPECT(R16G16B16A16_UNORM, 64, 128, 64, 4),
    EXPECT(ETC2_R8G8B8_UNORM_BLOCK, 4, 512, 256, 3),
    EXPECT(ETC2_R8G8B8_SRGB_BLOCK, 4, 512, 256, 3),
    EXPECT(ETC2_R8G8B8A1_UNORM_BLOCK, 4, 512, 256, 4),
    EXPECT(ETC2_R8G8B8A1_SRGB_BLOCK, 4, 512, 256, 4),
    EXPECT(ETC2_R8G8B8A8_UNORM_BLOCK, 8, 256, 256, 4),
    EXPECT(ETC2_R8G8B8A8_SRGB_BLOCK, 8, 256, 256, 4),
    EXPECT(EAC_R11_UNORM_BLOCK, 4, 512, 256, 1),
    EXPECT(EAC_R11_SNORM_BLOCK, 4, 512, 256, 1),
    EXPECT(EAC_R11G11_UNORM_BLOCK, 8, 256, 256, 2),
    EXPECT(EAC_R11G11_SNORM_BLOCK, 8, 256, 256, 2),
    EXPECT(ASTC_4x4_UNORM_BLOCK, 8, 256, 256, 4),
    EXPECT(ASTC_4x4_SRGB_BLOCK, 8, 256, 256, 4),
    EXPECT(ASTC_8x8_UNORM_BLOCK, 2, 512, 512, 4),
    EXPECT(ASTC_8x8_SRGB_BLOCK, 2, 512, 512, 4),
    EXPECT(R8_SNORM, 8, 256, 256, 1),
    EXPECT(R8G8_SNORM, 16, 256, 128, 2),
    EXPECT(R8G8B8A8_SNORM, 32, 128, 128, 4),
    EXPECT(R16_SNORM, 16, 256, 128, 1),
    EXPECT(R16G16_SNORM, 32, 128, 128, 2),
    EXPECT(R16G16B16A16_SNORM, 64, 128, 64, 4),
    EXPECT(R8_UINT, 8, 256, 256, 1),
    EXPECT(R8G8_UINT, 16, 256, 128, 2),
    EXPECT(R8G8B8A8_UINT, 32, 128, 128, 4),
    EXPECT(R16_UINT, 16, 256, 128, 1),
    EXPECT(R16G16_UINT, 32, 128, 128, 2),
    EXPECT(R16G16B16A16_UINT, 64, 128, 64, 4),
    EXPECT(R32_UINT, 32, 128, 128, 1),
    EXPECT(R32G32_UINT, 64, 128, 64, 2),
    EXPECT(R32G32B32A32_UINT, 128, 64, 64, 4),
    EXPECT(R8_SINT, 8, 256, 256, 1),
    EXPECT(R8G8_SINT, 16, 256, 128, 2),
    EXPECT(R8G8B8A8_SINT, 32, 128, 128, 4),
    EXPECT(R16_SINT, 16, 256, 128, 1),
    EXPECT(R16G16_SINT, 32, 128, 128, 2),
    EXPECT(R16G16B16A16_SINT, 64, 128, 64, 4),
    EXPECT(R32_SINT, 32, 128, 128, 1),
    EXPECT(R32G32_SINT, 64, 128, 64, 2),
    EXPECT(R32G32B32A32_SINT, 128, 64, 64, 4),
};
#define COUNT (sizeof all / sizeof all[0])

static void every_format_is_in_the_table_once(void **state)
{
    (void)state;
    bool seen[SLUICE_FORMAT_COUNT] = {0};
    for (size_t i = 0; i < COUNT; i++) {
        assert_false(seen[all[i].format]);
        seen[all[i].format] = true;
    }
    assert_int_equal(COUNT, SLUICE_FORMAT_COUNT - 1);
}

static void formats_are_described_as_vulkan_does(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT; i++) {
        const struct expected *e = &all[i];
        bool compressed = strstr(e->name, "_BLOCK") != NULL;
        uint32_t extent = !compressed ? 1 : strstr(e->name, "8x8") ? 8 : 4;
        SluiceFormatInfo info = {.structSize = sizeof info};
        CHECK_OK(sluiceGetFormatInfo(e->format, &info));
        assert_string_equal(sluiceGetFormatName(e->format), e->name);
        assert_int_equal(info.blockWidth, extent);
        assert_int_equal(info.blockHeight, extent);
        assert_int_equal(info.blockSize * 8,
                         e->bits_per_texel * info.blockWidth * info.blockHeight);
        assert_int_equal(info.channelCount, e->channels);
        assert_int_equal(sluiceGetFormatTexelSize(e->format),
                         compressed ? 0 : e->bits_per_texel / 8);
        assert_int_equal(slc_format_channel_count(e->format), compressed ? 0 : e->channels);
    }
}

/* Words as names have them: R16 is of 16 bits, PACK32 of 32, a block of bytes. */
static void words_have_the_bits_that_the_name_says(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT; i++) {
        const char *name = all[i].name;
        uint32_t bits = strstr(name, "_BLOCK")    ? 8
                        : strstr(name, "_PACK32") ? 32
                                                  : (uint32_t)strtoul(name + 1, NULL, 10);
        assert_int_equal(slc_format_word_size(all[i].format), bits / 8);
    }
    assert_int_equal(slc_format_word_size(SLUICE_FORMAT_UNDEFINED), 1);
}

static void each_word_is_reversed_by_itself(void **state)
{
    (void)state;
    char bytes[] = "abcdefgh";
    slc_reverse_words(bytes, 8, 1);
    assert_string_equal(bytes, "abcdefgh");
    slc_reverse_words(bytes, 8, 2);
    assert_string_equal(bytes, "badcfehg");
    slc_reverse_words(bytes + 1, 4, 4);
    assert_string_equal(bytes, "bfcdaehg");
}

static void standard_tiles_are_64_kib(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT; i++) {
        uint32_t width, height;
        CHECK_OK(sluiceGetStandardTileShape(all[i].format, &width, &height));
        assert_int_equal(width, all[i].tile_width);
        assert_int_equal(height, all[i].tile_height);
        assert_int_equal(sluiceGetFormatRegionSize(all[i].format, width, height), 65536);
    }
}

static void cut_blocks_count_as_whole_ones(void **state)
{
    (void)state;
    const SluiceFormat bc1 = SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, bc7 = SLUICE_FORMAT_BC7_UNORM_BLOCK;
    assert_int_equal(sluiceGetFormatRegionSize(bc1, 1, 1), 8);
    assert_int_equal(sluiceGetFormatRegionSize(bc1, 4, 4), 8);
    assert_int_equal(sluiceGetFormatRegionSize(bc1, 5, 4), 16);
    assert_int_equal(sluiceGetFormatRegionSize(bc7, 5, 9), 2 * 3 * 16);
    assert_int_equal(sluiceGetFormatRegionSize(bc7, 0, 9), 0);
    assert_int_equal(sluiceGetFormatRegionSize(SLUICE_FORMAT_R8G8_UNORM, 5, 3), 30);
    assert_true(sluiceGetFormatRegionSize(SLUICE_FORMAT_R32G32B32A32_SFLOAT, UINT32_MAX,
                                          UINT32_MAX) == UINT64_MAX);
    assert_true(sluiceGetFormatRegionSize(bc1, UINT32_MAX, UINT32_MAX) == (uint64_t)1 << 63);
}

static void unknown_formats_are_refused(void **state)
{
    (void)state;
    const SluiceFormat unknown[] = {SLUICE_FORMAT_UNDEFINED, (SluiceFormat)SLUICE_FORMAT_COUNT,
                                    (SluiceFormat)99, (SluiceFormat)-1};
    for (size_t i = 0; i < sizeof unknown / sizeof unknown[0]; i++) {
        SluiceFormatInfo info = {.structSize = sizeof info};
        uint32_t width, height;
        CHECK_RESULT(sluiceGetFormatInfo(unknown[i], &info), SLUICE_ERROR_UNSUPPORTED);
        CHECK_RESULT(sluiceGetStandardTileShape(unknown[i], &width, &height),
                     SLUICE_ERROR_UNSUPPORTED);
        assert_int_equal(sluiceGetFormatTexelSize(unknown[i]), 0);
        assert_int_equal(sluiceGetFormatRegionSize(unknown[i], 4, 4), 0);
        assert_string_equal(sluiceGetFormatName(unknown[i]), "UNDEFINED");
    }
    CHECK_RESULT(sluiceGetFormatInfo(SLUICE_FORMAT_R8_UNORM, NULL), SLUICE_ERROR_NULL_POINTER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_in_the_table_once),
        cmocka_unit_test(formats_are_described_as_vulkan_does),
        cmocka_unit_test(words_have_the_bits_that_the_name_says),
        cmocka_unit_test(each_word_is_reversed_by_itself),
        cmocka_unit_test(standard_tiles_are_64_kib),
        cmocka_unit_test(cut_blocks_count_as_whole_ones),
        cmocka_unit_test(unknown_formats_are_refused),
    };
    return RUN_TESTS(tests);
}
