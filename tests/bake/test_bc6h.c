/* BC6H blocks decode to something near the halves, the same bytes with every compiler. */
#include "bake/baked.h"
#include "bake/bc6h_encode.h"
#include "bake/blocks.h"
#include "support/bptc_decode.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COUNT 512
#define LARGEST 0x7bff

static const SluiceBakeQuality qualities[] = {SLUICE_BAKE_QUALITY_FAST, SLUICE_BAKE_QUALITY_NORMAL,
                                              SLUICE_BAKE_QUALITY_BEST};

static uint32_t next_random(uint32_t *random)
{
    *random = *random * 1664525u + 1013904223u;
    return *random >> 16;
}

/* Two colors, near or far from each other, with a gradient or an edge between them. */
static void make_block(uint32_t number, bool is_signed, uint16_t rgba[64])
{
    uint32_t random = number * 2654435761u + 777u, shape = next_random(&random);
    int range = 1 << (number % 14 + 1);
    int ends[2][3];
    for (int c = 0; c < 3; c++) {
        ends[0][c] = (int)(next_random(&random) % 0x7000u);
        ends[1][c] = ends[0][c] + (int)(next_random(&random) % (uint32_t)range) - range / 2;
        if (is_signed && (number & 1))
            ends[0][c] = -ends[0][c];
    }
    for (uint32_t i = 0; i < 16; i++) {
        bool second = number % 3 ? (i / 4 * 5 + i % 4 * 3 + shape) % 16 > 7 : 0;
        int t = (int)(shape & 1 ? i % 4 : i / 4);
        for (int c = 0; c < 3; c++) {
            int value = number % 3 ? ends[second][c] : (ends[0][c] * (3 - t) + ends[1][c] * t) / 3;
            value += (int)(next_random(&random) % (uint32_t)(1 + range / 16));
            bool negative = value < 0 && is_signed;
            value = value < 0 && !is_signed ? 0 : abs(value);
            value = value > LARGEST ? LARGEST : value;
            rgba[4 * i + (uint32_t)c] = (uint16_t)(negative ? 0x8000 | value : value);
        }
        rgba[4 * i + 3] = 0x3c00;
    }
}

static int steps_of(uint16_t half)
{
    return half & 0x8000 ? -(half & 0x7fff) : half;
}

static uint64_t hash_of(const uint8_t *bytes, size_t count)
{
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

/* Returns the mean over blocks of the error, relative to the range of the block. Both in steps. */
static double relative_error(const uint16_t texels[64], const uint16_t rgb[48])
{
    double sum = 0, range = 1;
    for (int c = 0; c < 3; c++) {
        int low = 1 << 20, high = -low;
        for (int i = 0; i < 16; i++) {
            int steps = steps_of(texels[4 * i + c]), off = steps - steps_of(rgb[3 * i + c]);
            low = steps < low ? steps : low;
            high = steps > high ? steps : high;
            sum += (double)off * off;
        }
        range = high - low > range ? high - low : range;
    }
    return sqrt(sum / 48) / range;
}

/* Hashes hold for gcc and clang, -O0 and -O3. */
static void blocks_of_all_kinds_are_near_and_the_same_everywhere(void **state)
{
    (void)state;
    static const uint64_t hashes[2][3] = {
        {0x625bf6db93d1099d, 0xd556e66260d94d21, 0xa5abcd02842c80c4},
        {0x2185283f9d1cc003, 0x9c90e3fcef8a8a19, 0x29f169fb612ac17d}};
    static uint16_t texels[COUNT][64];
    static uint8_t blocks[COUNT][16];
    int modes[15] = {0};
    for (int s = 0; s < 2; s++) {
        for (uint32_t b = 0; b < COUNT; b++)
            make_block(b, s, texels[b]);
        for (size_t q = 0; q < 3; q++) {
            double sum = 0;
            slc_encode_bc6h(s, qualities[q], (const uint16_t(*)[64])texels, COUNT, blocks[0]);
            for (uint32_t b = 0; b < COUNT; b++) {
                uint16_t back[48];
                int mode;
                assert_true(bc6h_decode(s, blocks[b], back, &mode));
                modes[mode]++;
                sum += relative_error(texels[b], back);
            }
            print_message("signed %d, quality %d: %g, 0x%llx\n", s, qualities[q], sum / COUNT,
                          (unsigned long long)hash_of(blocks[0], sizeof blocks));
            assert_true(sum / COUNT < 0.1);
            assert_int_equal(hash_of(blocks[0], sizeof blocks), hashes[s][q]);
        }
    }
    for (int m = 1; m < 15; m++)
        if (modes[m] == 0)
            fail_msg("mode %d was never used", m);
}

/* The baker may use wider vectors than the functions that are tested here. */
static void the_baker_writes_the_same_bytes(void **state)
{
    (void)state;
    static uint16_t texels[COUNT][64];
    static uint8_t blocks[COUNT][16], baked[COUNT][16];
    for (uint32_t b = 0; b < COUNT; b++)
        make_block(b, false, texels[b]);
    for (size_t q = 0; q < 3; q++) {
        const struct slc_block_encoder encoder = {SLUICE_FORMAT_BC6H_UFLOAT_BLOCK, qualities[q],
                                                  NULL};
        slc_encode_bc6h(false, qualities[q], (const uint16_t(*)[64])texels, COUNT, blocks[0]);
        CHECK_OK(slc_encode_blocks(&encoder, texels, 32, 4, 4 * COUNT, baked));
        assert_memory_equal(blocks, baked, sizeof blocks);
    }
}

static void neighbors_do_not_matter(void **state)
{
    (void)state;
    static uint16_t texels[COUNT][64];
    static uint8_t blocks[COUNT][16];
    uint8_t alone[16];
    for (uint32_t b = 0; b < COUNT; b++)
        make_block(b, false, texels[b]);
    for (size_t q = 0; q < 3; q++) {
        slc_encode_bc6h(false, qualities[q], (const uint16_t(*)[64])texels, COUNT, blocks[0]);
        for (uint32_t b = 0; b < COUNT; b++) {
            slc_encode_bc6h(false, qualities[q], (const uint16_t(*)[64])texels + b, 1, alone);
            assert_memory_equal(alone, blocks[b], 16);
        }
    }
}

/* 0, denormals, 1, 65504 and everything between; infinities are 65504, NaN and, where there are
 * no signs, negative numbers are 0. */
static void blocks_of_one_half_are_exact(void **state)
{
    (void)state;
    uint16_t texels[64], back[48];
    uint8_t block[16];
    int mode;
    for (int s = 0; s < 2; s++)
        for (uint32_t half = 0; half < 65536; half += half < 0x7b00 || half > 0x8100 ? 7 : 1) {
            int magnitude = half & 0x7fff, wanted = magnitude > 0x7c00 ? 0 : magnitude;
            wanted = wanted > LARGEST ? LARGEST : wanted;
            wanted = half & 0x8000 ? s ? -wanted : 0 : wanted;
            for (int i = 0; i < 64; i++)
                texels[i] = (uint16_t)half;
            slc_encode_bc6h(s, qualities[half % 3], (const uint16_t(*)[64])texels, 1, block);
            assert_true(bc6h_decode(s, block, back, &mode));
            for (int i = 0; i < 48; i++)
                assert_int_equal(steps_of(back[i]), wanted);
        }
}

/* Any bits at all are encoded, and each half decodes to a finite one. */
static void random_halves_become_finite_ones(void **state)
{
    (void)state;
    uint32_t random = 5;
    for (int b = 0; b < 3000; b++) {
        uint16_t texels[64], back[48];
        uint8_t block[16];
        int mode;
        for (int i = 0; i < 64; i++)
            texels[i] = (uint16_t)next_random(&random);
        slc_encode_bc6h(b & 1, qualities[b % 3], (const uint16_t(*)[64])texels, 1, block);
        assert_true(bc6h_decode(b & 1, block, back, &mode));
        for (int i = 0; i < 48; i++)
            assert_true((back[i] & 0x7fff) <= LARGEST && ((b & 1) || back[i] <= LARGEST));
    }
}

/* A whole picture through the baker, at sizes that blocks do not divide. */
static void pictures_of_any_size_are_near(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{300, 270}, {257, 131}, {5, 3}, {1, 1}, {1, 70}};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        struct bake_folder folder;
        struct plain_source source;
        char path[256];
        uint32_t width = sizes[k][0], height = sizes[k][1];
        size_t size, count = (size_t)width * height;
        uint16_t *rgba = malloc(8 * count);
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < 4; c++)
                rgba[4 * i + c] = (uint16_t)(0x3000 + (i % width) * 8 + (i / width) * (c + 3));
        SluiceBakeSettings settings = {.structSize = sizeof settings,
                                       .format = SLUICE_FORMAT_BC6H_UFLOAT_BLOCK};
        bake_folder_init(&folder);
        bake_folder_file(&folder, "bc6h.store", path);
        plain_source_init(&source, SLUICE_FORMAT_R16G16B16A16_SFLOAT, width, height, rgba);
        bake_source(&source.base, path, &settings);
        uint8_t *blocks = read_bytes(path, 0, &size);
        assert_int_equal(size, (size_t)((width + 3) / 4) * ((height + 3) / 4) * 16);
        for (size_t i = 0; i < count; i++) {
            uint16_t back[48];
            int mode;
            size_t x = i % width, y = i / width, block = y / 4 * ((width + 3) / 4) + x / 4;
            assert_true(bc6h_decode(false, blocks + 16 * block, back, &mode));
            for (size_t c = 0; c < 3; c++)
                assert_in_range(back[3 * (4 * (y % 4) + x % 4) + c] + 16 - rgba[4 * i + c], 0, 32);
        }
        free(blocks);
        free(rgba);
        bake_folder_finish(&folder);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_of_all_kinds_are_near_and_the_same_everywhere),
        cmocka_unit_test(the_baker_writes_the_same_bytes),
        cmocka_unit_test(neighbors_do_not_matter),
        cmocka_unit_test(blocks_of_one_half_are_exact),
        cmocka_unit_test(random_halves_become_finite_ones),
        cmocka_unit_test(pictures_of_any_size_are_near),
    };
    return RUN_TESTS(tests);
}
