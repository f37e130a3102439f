#include "image/convert.h"
#include "image/half.h"
#include "image/srgb.h"
#include "support/test.h"

#include <math.h>

static const SluiceFormat all_formats[] = {
    SLUICE_FORMAT_R8_UNORM,
    SLUICE_FORMAT_R8G8B8A8_UNORM,
    SLUICE_FORMAT_R8G8B8A8_SRGB,
    SLUICE_FORMAT_R16_SFLOAT,
    SLUICE_FORMAT_R16G16_SFLOAT,
    SLUICE_FORMAT_R16G16B16A16_SFLOAT,
    SLUICE_FORMAT_R32_SFLOAT,
    SLUICE_FORMAT_R32G32_SFLOAT,
    SLUICE_FORMAT_R32G32B32A32_SFLOAT,
    SLUICE_FORMAT_R8G8_UNORM,
    SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32,
    SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32,
    SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32,
    SLUICE_FORMAT_R16_UNORM,
    SLUICE_FORMAT_R16G16_UNORM,
    SLUICE_FORMAT_R16G16B16A16_UNORM,
    SLUICE_FORMAT_R8_SNORM,
    SLUICE_FORMAT_R8G8_SNORM,
    SLUICE_FORMAT_R8G8B8A8_SNORM,
    SLUICE_FORMAT_R16_SNORM,
    SLUICE_FORMAT_R16G16_SNORM,
    SLUICE_FORMAT_R16G16B16A16_SNORM,
};

static long double encode(long double x)
{
    return x <= 0.0031308L ? 12.92L * x : 1.055L * powl(x, 1 / 2.4L) - 0.055L;
}

static long double decode(long double c)
{
    return c <= 0.04045L ? c / 12.92L : powl((c + 0.055L) / 1.055L, 2.4L);
}

static void srgb_decodes_as_the_standard_says(void **state)
{
    (void)state;
    for (int i = 0; i < 256; i++)
        assert_true(slc_srgb_to_linear[i] == (float)decode(i / 255.0L));
}

static void every_srgb_value_survives_a_round_trip(void **state)
{
    (void)state;
    for (int i = 0; i < 256; i++)
        assert_int_equal(slc_srgb_from_linear(slc_srgb_to_linear[i]), i);
}

static void srgb_encodes_to_the_nearest_value(void **state)
{
    (void)state;
    uint32_t random = 7;
    for (int i = 0; i < 200000; i++) {
        random = random * 1664525u + 1013904223u;
        float x = (float)(random >> 8) * 0x1p-24f;
        if (i % 2)
            x *= x * x; /* more dark values */
        uint8_t result = slc_srgb_from_linear(x);
        assert_true(fabsl(encode(x) * 255 - result) <= 0.5L + 1e-12L);
    }
    assert_int_equal(slc_srgb_from_linear(NAN), 0);
    assert_int_equal(slc_srgb_from_linear(-INFINITY), 0);
    assert_int_equal(slc_srgb_from_linear(INFINITY), 255);
    assert_int_equal(slc_srgb_from_linear(1.0f), 255);
    assert_int_equal(slc_srgb_from_linear(0.0f), 0);
}

static void unorm_rounds_to_the_nearest_step_and_clamps(void **state)
{
    (void)state;
    for (int i = 0; i < 255; i++) {
        float middle = (i + 0.5f) / 255.0f;
        assert_int_equal(slc_unorm8_from_float(nextafterf(middle, 0.0f) - 1e-7f), i);
        assert_int_equal(slc_unorm8_from_float(nextafterf(middle, 1.0f) + 1e-7f), i + 1);
        assert_int_equal(slc_unorm8_from_float((float)i / 255.0f), i);
    }
    assert_int_equal(slc_unorm8_from_float(nextafterf(0.5f / 255.0f, 0.0f)), 0);
    assert_int_equal(slc_unorm8_from_float(NAN), 0);
    assert_int_equal(slc_unorm8_from_float(-1.0f), 0);
    assert_int_equal(slc_unorm8_from_float(INFINITY), 255);
}

static void words_of_16_bits_come_back_exactly(void **state)
{
    (void)state;
    for (uint32_t word = 0; word < 65536; word++) {
        uint16_t given[4] = {(uint16_t)word, 0, 65535, (uint16_t)(65535 - word)}, back[4];
        float rgba[4];
        slc_texels_to_rgba(SLUICE_FORMAT_R16G16B16A16_UNORM, given, rgba, 1);
        assert_true(fabs((double)rgba[0] - word / 65535.0) < 1e-7);
        slc_texels_from_rgba(SLUICE_FORMAT_R16G16B16A16_UNORM, rgba, back, 1);
        assert_memory_equal(given, back, sizeof given);
    }
}

/* Vulkan specification, "Conversion from Normalized Fixed-Point to Floating-Point". */
static void signed_words_come_back_exactly(void **state)
{
    (void)state;
    for (int word = -32768; word <= 32767; word++) {
        int16_t given[4] = {(int16_t)word, 32767, -32768, 0}, back[4];
        float rgba[4];
        slc_texels_to_rgba(SLUICE_FORMAT_R16G16B16A16_SNORM, given, rgba, 1);
        assert_true(fabs((double)rgba[0] - fmax(word / 32767.0, -1)) < 1e-7);
        assert_true(rgba[1] == 1 && rgba[2] == -1 && rgba[3] == 0);
        slc_texels_from_rgba(SLUICE_FORMAT_R16G16B16A16_SNORM, rgba, back, 1);
        assert_int_equal(back[0], word == -32768 ? -32767 : word);
    }
    for (int byte = -128; byte <= 127; byte++) {
        int8_t given[2] = {(int8_t)byte, -128}, back[2];
        float rgba[4];
        slc_texels_to_rgba(SLUICE_FORMAT_R8G8_SNORM, given, rgba, 1);
        assert_true(fabs((double)rgba[0] - fmax(byte / 127.0, -1)) < 1e-7);
        assert_true(rgba[1] == -1 && rgba[2] == 0 && rgba[3] == 1);
        slc_texels_from_rgba(SLUICE_FORMAT_R8G8_SNORM, rgba, back, 1);
        assert_int_equal(back[0], byte == -128 ? -127 : byte);
    }
}

static void snorm_rounds_to_the_nearest_step_and_clamps(void **state)
{
    (void)state;
    const float given[][4] = {{NAN, INFINITY, -INFINITY, -0.0f},
                              {1.5f, -1.5f, 0.499f / 127, 0.501f / 127},
                              {-0.499f / 127, -0.501f / 127, 1, -1}};
    const int8_t expected[][4] = {{0, 127, -127, 0}, {127, -127, 0, 1}, {0, -1, 127, -127}};
    int8_t bytes[3][4];
    slc_texels_from_rgba(SLUICE_FORMAT_R8G8B8A8_SNORM, given[0], bytes, 3);
    assert_memory_equal(bytes, expected, sizeof expected);
}

/* Representable values survive. Channels that a format lacks become 0; a lacking alpha becomes
 * 1. */
static void texels_survive_a_round_trip_in_every_format(void **state)
{
    (void)state;
    /* alphas that two bits can hold */
    const float given[2][4] = {{0.0f, 1.0f, 0.2f, 1 / 3.0f}, {1.0f, 0.4f, 0.0f, 2 / 3.0f}};
    for (size_t f = 0; f < sizeof all_formats / sizeof all_formats[0]; f++) {
        SluiceFormat format = all_formats[f];
        unsigned char texels[2 * 16 + 1];
        texels[2 * sluiceGetFormatTexelSize(format)] = 0xA5;
        slc_texels_from_rgba(format, given[0], texels, 2);
        assert_int_equal(texels[2 * sluiceGetFormatTexelSize(format)], 0xA5);
        float back[2][4];
        slc_texels_to_rgba(format, texels, back[0], 2);
        for (uint32_t i = 0; i < 2; i++)
            for (uint32_t c = 0; c < 4; c++) {
                float expected = given[i][c];
                if (c >= slc_format_channel_count(format))
                    expected = c == 3 ? 1.0f : 0.0f;
                assert_true(fabsf(back[i][c] - expected) <= 0.005f);
            }
    }
}

static void infinities_and_nan_follow_the_header(void **state)
{
    (void)state;
    const float given[4] = {NAN, INFINITY, -INFINITY, 70000.0f};
    uint16_t half[4];
    slc_texels_from_rgba(SLUICE_FORMAT_R16G16B16A16_SFLOAT, given, half, 1);
    assert_int_equal(half[0], 0);
    assert_int_equal(half[1], 0x7BFF);
    assert_int_equal(half[2], 0xFBFF);
    assert_int_equal(half[3], 0x7BFF);
    uint8_t bytes[4];
    slc_texels_from_rgba(SLUICE_FORMAT_R8G8B8A8_SRGB, given, bytes, 1);
    assert_memory_equal(bytes, ((uint8_t[4]){0, 255, 0, 255}), 4);
    float wide[4];
    slc_texels_from_rgba(SLUICE_FORMAT_R32G32B32A32_SFLOAT, given, wide, 1);
    assert_memory_equal(wide, given, sizeof given);
}

static void integers_are_rounded_and_clamped_to_their_range(void **state)
{
    (void)state;
    const float given[2][4] = {{0.5f, 254.6f, NAN, 300.0f}, {-0.6f, -127.6f, 1e30f, -INFINITY}};
    uint8_t bytes[8];
    slc_texels_from_rgba(SLUICE_FORMAT_R8G8B8A8_UINT, given[0], bytes, 2);
    assert_memory_equal(bytes, ((uint8_t[8]){1, 255, 0, 255, 0, 0, 255, 0}), 8);
    int8_t chars[8];
    slc_texels_from_rgba(SLUICE_FORMAT_R8G8B8A8_SINT, given[0], chars, 2);
    assert_memory_equal(chars, ((int8_t[8]){1, 127, 0, 127, -1, -128, 127, -128}), 8);
    int32_t words[8];
    slc_texels_from_rgba(SLUICE_FORMAT_R32G32B32A32_SINT, given[0], words, 2);
    assert_memory_equal(words, ((int32_t[8]){1, 255, 0, 300, -1, -128, INT32_MAX, INT32_MIN}),
                        sizeof words);
}

static void integers_up_to_24_bits_survive_a_round_trip(void **state)
{
    (void)state;
    static const int32_t numbers[] = {0, 1, -1, 100, -128, 127, -32768, 32767, 16777216, -16777216};
    for (uint32_t f = SLUICE_FORMAT_R8_UINT; f <= SLUICE_FORMAT_R32G32B32A32_SINT; f++) {
        size_t size = sluiceGetFormatTexelSize((SluiceFormat)f);
        size_t channels = slc_format_channel_count((SluiceFormat)f);
        for (size_t n = 0; n < sizeof numbers / sizeof numbers[0]; n++) {
            char given[16] = {0}, back[16] = {0};
            float rgba[4];
            for (size_t c = 0; c < channels; c++) /* unsigned: at most 24 bits of it */
                memcpy(given + c * (size / channels),
                       &(int32_t){numbers[n] & (f < SLUICE_FORMAT_R8_SINT ? 0x1FFFFFF : -1)},
                       size / channels);
            slc_texels_to_rgba((SluiceFormat)f, given, rgba, 1);
            slc_texels_from_rgba((SluiceFormat)f, rgba, back, 1);
            if (numbers[n] >= 0 || f >= SLUICE_FORMAT_R8_SINT)
                assert_memory_equal(given, back, size);
            assert_true(channels == 4 || rgba[3] == 1.0f);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_decodes_as_the_standard_says),
        cmocka_unit_test(every_srgb_value_survives_a_round_trip),
        cmocka_unit_test(srgb_encodes_to_the_nearest_value),
        cmocka_unit_test(unorm_rounds_to_the_nearest_step_and_clamps),
        cmocka_unit_test(words_of_16_bits_come_back_exactly),
        cmocka_unit_test(signed_words_come_back_exactly),
        cmocka_unit_test(snorm_rounds_to_the_nearest_step_and_clamps),
        cmocka_unit_test(texels_survive_a_round_trip_in_every_format),
        cmocka_unit_test(infinities_and_nan_follow_the_header),
        cmocka_unit_test(integers_are_rounded_and_clamped_to_their_range),
        cmocka_unit_test(integers_up_to_24_bits_survive_a_round_trip),
    };
    return RUN_TESTS(tests);
}
