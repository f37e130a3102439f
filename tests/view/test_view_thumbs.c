/* Small pictures of textures of formats that the device converts. */
#include "support/test.h"

#include "thumb_texels.h"

#include <stdlib.h>
#include <string.h>

static struct gpu gpu;
static bool has_device;

static int begin(void **state)
{
    bool unsupported = false;
    const struct gpu_request request = {
        .modes = {SLUICE_RESIDENCY_MODE_DENSE, SLUICE_RESIDENCY_MODE_DENSE}, .validation = true};
    (void)state;
    has_device = gpu_create(&request, &gpu, &unsupported);
    return has_device || unsupported ? 0 : 1;
}

static int end(void **state)
{
    (void)state;
    const unsigned messages = atomic_load(&gpu.validation_messages);
    if (has_device)
        gpu_destroy(&gpu);
    return messages > 0;
}

/* Converts one block, or texel, and compares the first pixel. */
static void check(SluiceFormat format, const void *bytes, const uint8_t expected[3])
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    uint8_t cell[THUMBS_CELL][THUMBS_CELL][4];
    CHECK_OK(sluiceGetFormatInfo(format, &info));
    struct thumb_texels texels = {format, info.blockWidth, info.blockHeight,
                                  malloc(info.blockSize)};
    assert_non_null(texels.bytes);
    memcpy(texels.bytes, bytes, info.blockSize);
    if (!thumb_texels_fit(&gpu, format))
        fail_msg("%s cannot be blitted", sluiceGetFormatName(format));
    assert_true(thumb_texels_convert(&gpu, &texels, cell));
    thumb_texels_finish(&texels);
    for (int i = 0; i < 3; i++)
        if (abs(cell[5][7][i] - expected[i]) > 1)
            fail_msg("%s: channel %d is %u, not %u", sluiceGetFormatName(format), i, cell[5][7][i],
                     expected[i]);
    assert_int_equal(cell[31][31][3], 255);
}

static void put_bits(uint8_t block[16], uint32_t *at, uint32_t value, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, ++*at)
        block[*at / 8] |= (uint8_t)((value >> i & 1) << *at % 8);
}

/* Mode 6 has both ends of a line of RGBA with 7 bits and a lowest bit each. */
static void make_bc7(uint8_t block[16], const uint8_t rgb[3])
{
    uint32_t at = 0;
    memset(block, 0, 16);
    put_bits(block, &at, 1u << 6, 7);
    for (int i = 0; i < 4; i++)
        for (int twice = 0; twice < 2; twice++)
            put_bits(block, &at, (i < 3 ? rgb[i] : 255u) >> 1, 7);
}

static void compressed_texels_become_colors(void **state)
{
    (void)state;
    if (!has_device)
        SKIP_TEST("no Vulkan device");
    static const uint8_t bc1[8] = {0x00, 0xF8, 0x00, 0xF8}, red[3] = {255, 0, 0};
    static const uint8_t bc3[16] = {255, 255, 0, 0, 0, 0, 0, 0, 0xE0, 0x07, 0xE0, 0x07};
    static const uint8_t green[3] = {0, 255, 0};
    static const uint8_t bc4[8] = {200, 200}, gray[3] = {200, 200, 200};
    static const uint8_t bc5[16] = {30, 30, 0, 0, 0, 0, 0, 0, 90, 90}, two[3] = {30, 90, 0};
    static const uint8_t color[3] = {20, 130, 240};
    uint8_t bc7[16];
    make_bc7(bc7, color);
    check(SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, bc1, red);
    check(SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK, bc1, red);
    check(SLUICE_FORMAT_BC3_SRGB_BLOCK, bc3, green);
    check(SLUICE_FORMAT_BC4_UNORM_BLOCK, bc4, gray);
    check(SLUICE_FORMAT_BC5_UNORM_BLOCK, bc5, two);
    check(SLUICE_FORMAT_BC7_UNORM_BLOCK, bc7, color);
    check(SLUICE_FORMAT_BC7_SRGB_BLOCK, bc7, color);
}

/* 0.5 is 188 in sRGB, 0.25 is 137, and 1 and more are white. */
static void linear_numbers_become_srgb(void **state)
{
    (void)state;
    if (!has_device)
        SKIP_TEST("no Vulkan device");
    static const float wide[4] = {0.5f, 0.25f, 7.0f, 1.0f};
    static const uint16_t half[4] = {0x3800, 0x3400, 0x4700, 0x3C00}, one[1] = {0x3800};
    static const uint8_t color[3] = {188, 137, 255}, gray[3] = {188, 188, 188};
    check(SLUICE_FORMAT_R32G32B32A32_SFLOAT, wide, color);
    check(SLUICE_FORMAT_R16G16B16A16_SFLOAT, half, color);
    check(SLUICE_FORMAT_R16_SFLOAT, one, gray);
}

static void cells_keep_the_proportions(void **state)
{
    (void)state;
    if (!has_device)
        SKIP_TEST("no Vulkan device");
    uint8_t cell[THUMBS_CELL][THUMBS_CELL][4];
    struct thumb_texels texels = {SLUICE_FORMAT_BC4_UNORM_BLOCK, 32, 8, calloc(1, 128)};
    assert_true(texels.bytes && thumb_texels_convert(&gpu, &texels, cell));
    thumb_texels_finish(&texels);
    assert_true(cell[7][31][3] == 255 && cell[8][0][3] == 0 && cell[31][31][3] == 0);
    assert_false(thumb_texels_fit(&gpu, SLUICE_FORMAT_R8_UINT));
    assert_false(thumb_texels_fit(&gpu, SLUICE_FORMAT_UNDEFINED));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(compressed_texels_become_colors),
                                       cmocka_unit_test(linear_numbers_become_srgb),
                                       cmocka_unit_test(cells_keep_the_proportions)};
    return cmocka_run_group_tests(tests, begin, end);
}
