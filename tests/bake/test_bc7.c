/* BC7 blocks decode to something near the texels, the same bytes with every compiler. */
#include "bake/baked.h"
#include "bake/bc7_encode.h"
#include "bake/blocks.h"
#include "support/bptc_decode.h"
#include "support/test.h"

#include <sluice/metrics.h>

#include <stdlib.h>
#include <string.h>

#define COUNT 512

static const SluiceBakeQuality qualities[] = {SLUICE_BAKE_QUALITY_FAST, SLUICE_BAKE_QUALITY_NORMAL,
                                              SLUICE_BAKE_QUALITY_BEST};

static uint32_t next_random(uint32_t *random)
{
    *random = *random * 1664525u + 1013904223u;
    return *random >> 24;
}

/* Kinds of blocks: noise; gradients with noise; two colors; either with alpha. */
static void make_block(uint32_t number, uint8_t rgba[64])
{
    uint32_t random = number * 2654435761u + 12345u, kind = number % 6;
    uint8_t ends[2][4];
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 4; c++)
            ends[e][c] = (uint8_t)next_random(&random);
    uint32_t range = 1u + next_random(&random) % 16u, shape = next_random(&random);
    for (uint32_t i = 0; i < 16; i++)
        for (uint32_t c = 0; c < 4; c++) {
            uint32_t t = (shape & 1) ? i % 4 : i / 4, value;
            bool second = kind == 2 || kind == 5 ? (i * shape >> 3 & 1) : false;
            value = kind == 0   ? next_random(&random)
                    : second    ? ends[1][c]
                    : kind == 2 ? ends[0][c]
                                : (ends[0][c] * (3 - t) + ends[1][c] * t) / 3;
            if (kind != 0)
                value += next_random(&random) % range;
            if (kind < 4 && c == 3)
                value = 255;
            if (kind == 4 && c == 3)
                value = i % 5 * 63 + 3;
            rgba[4 * i + c] = (uint8_t)(value > 255 ? 255 : value);
        }
}

static double square_error(const uint8_t *a, const uint8_t *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
    return sum;
}

/* FNV-1a. Equal hashes stand for equal bytes. */
static uint64_t hash_of(const uint8_t *bytes, size_t count)
{
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

/* Bounds are twice what was measured; hashes hold for gcc and clang, -O0 and -O3. */
static void blocks_of_all_kinds_are_near_and_the_same_everywhere(void **state)
{
    (void)state;
    static const uint64_t hashes[] = {0x2857d7e27200ee28, 0x237ec3501d74c20c, 0x97311dc67514d9e5};
    static const double most[] = {17.4, 17.1, 16.4}; /* mean square error, noise left out */
    static uint8_t texels[COUNT][64], blocks[COUNT][16];
    for (uint32_t b = 0; b < COUNT; b++)
        make_block(b, texels[b]);
    for (size_t q = 0; q < 3; q++) {
        double sum = 0, noise = 0;
        int modes[8] = {0};
        slc_encode_bc7(qualities[q], (const uint8_t(*)[64])texels, COUNT, blocks[0]);
        for (uint32_t b = 0; b < COUNT; b++) {
            uint8_t back[64];
            int mode;
            assert_true(bc7_decode(blocks[b], back, &mode));
            modes[mode]++;
            *(b % 6 == 0 ? &noise : &sum) += square_error(back, texels[b], 64);
            for (int i = 3; i < 64 && b % 6 < 4; i += 4)
                assert_int_equal(back[i], 255);
        }
        print_message("quality %d: %g, noise %g, modes %d %d %d %d, 0x%llx\n", qualities[q],
                      sum / (COUNT * 64.0), noise / (COUNT * 64.0 / 6), modes[1], modes[4],
                      modes[5], modes[6], (unsigned long long)hash_of(blocks[0], sizeof blocks));
        assert_true(modes[1] > 0 && modes[4] > 0 && modes[5] > 0 && modes[6] > 0);
        assert_true(sum / (COUNT * 64.0) < most[q]);
        assert_int_equal(hash_of(blocks[0], sizeof blocks), hashes[q]);
    }
}

/* The baker may use wider vectors than the functions that are tested here. */
static void the_baker_writes_the_same_bytes(void **state)
{
    (void)state;
    static uint8_t texels[COUNT][64];
    static uint8_t blocks[COUNT][16], baked[COUNT][16];
    for (uint32_t b = 0; b < COUNT; b++)
        make_block(b, texels[b]);
    for (size_t q = 0; q < 3; q++) {
        const struct slc_block_encoder encoder = {SLUICE_FORMAT_BC7_UNORM_BLOCK, qualities[q],
                                                  NULL};
        slc_encode_bc7(qualities[q], (const uint8_t(*)[64])texels, COUNT, blocks[0]);
        CHECK_OK(slc_encode_blocks(&encoder, texels, 16, 4, 4 * COUNT, baked));
        assert_memory_equal(blocks, baked, sizeof blocks);
    }
}

static void neighbors_do_not_matter(void **state)
{
    (void)state;
    static uint8_t texels[COUNT][64], blocks[COUNT][16];
    uint8_t alone[16];
    for (uint32_t b = 0; b < COUNT; b++)
        make_block(b, texels[b]);
    for (size_t q = 0; q < 3; q++) {
        slc_encode_bc7(qualities[q], (const uint8_t(*)[64])texels, COUNT, blocks[0]);
        for (uint32_t b = 0; b < COUNT; b++) {
            slc_encode_bc7(qualities[q], (const uint8_t(*)[64])texels + b, 1, alone);
            assert_memory_equal(alone, blocks[b], 16);
        }
    }
}

/* Black, white and everything between, with any alpha. */
static void blocks_of_one_color_are_exact(void **state)
{
    (void)state;
    uint8_t texels[64], block[16], back[64];
    int mode;
    for (int value = 0; value < 256; value++)
        for (int alpha = 0; alpha < 256; alpha += 51) {
            for (int i = 0; i < 16; i++) {
                const uint8_t color[] = {(uint8_t)value, (uint8_t)(255 - value),
                                         (uint8_t)(value * 7), (uint8_t)alpha};
                memcpy(texels + 4 * i, color, 4);
            }
            slc_encode_bc7(qualities[value % 3], (const uint8_t(*)[64])texels, 1, block);
            assert_true(bc7_decode(block, back, &mode));
            assert_memory_equal(back, texels, 64);
        }
}

/* Black beside white, and alpha 0 beside 255, stay so. */
static void extremes_of_two_kinds_are_exact(void **state)
{
    (void)state;
    uint8_t texels[64], block[16], back[64];
    int mode;
    for (uint32_t pattern = 1; pattern < 65535; pattern += 97)
        for (int which = 0; which < 3; which++) {
            for (int i = 0; i < 16; i++) {
                uint8_t on = pattern >> i & 1 ? 255 : 0;
                memset(texels + 4 * i, which == 1 ? 255 : on, 3);
                texels[4 * i + 3] = which == 0 ? 255 : on;
            }
            slc_encode_bc7(qualities[pattern % 3], (const uint8_t(*)[64])texels, 1, block);
            assert_true(bc7_decode(block, back, &mode));
            assert_memory_equal(back, texels, 64);
        }
}

/* A whole picture through the baker, at sizes that blocks do not divide. */
static void check_picture(uint32_t width, uint32_t height, bool opaque, double least)
{
    struct bake_folder folder;
    struct plain_source source;
    char path[256];
    size_t size, count = (size_t)width * height;
    uint32_t random = 3;
    uint8_t *rgba = malloc(4 * count), *back = malloc(4 * count);
    for (size_t i = 0; i < count; i++) {
        uint32_t x = (uint32_t)(i % width), y = (uint32_t)(i / width);
        rgba[4 * i] = (uint8_t)(x / 4 + next_random(&random) / 32);
        rgba[4 * i + 1] = (uint8_t)(y / 2);
        rgba[4 * i + 2] = (uint8_t)((x + y) / 5);
        rgba[4 * i + 3] = opaque ? 255 : (uint8_t)(200 + next_random(&random) / 16);
    }
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .format = SLUICE_FORMAT_BC7_UNORM_BLOCK};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "bc7.store", path);
    plain_source_init(&source, SLUICE_FORMAT_R8G8B8A8_UNORM, width, height, rgba);
    bake_source(&source.base, path, &settings);
    uint8_t *blocks = read_bytes(path, 0, &size);
    assert_int_equal(size, (size_t)((width + 3) / 4) * ((height + 3) / 4) * 16);
    for (size_t i = 0; i < count; i++) {
        uint8_t texels[64];
        int mode;
        size_t x = i % width, y = i / width, block = y / 4 * ((width + 3) / 4) + x / 4;
        assert_true(bc7_decode(blocks + 16 * block, texels, &mode));
        memcpy(back + 4 * i, texels + 4 * (4 * (y % 4) + x % 4), 4);
    }
    double value;
    CHECK_OK(sluiceComputePsnr8(back, rgba, (uint32_t)count, 1, 4, &value));
    if (value < least)
        fail_msg("%ux%u: %g dB", width, height, value);
    free(blocks);
    free(back);
    free(rgba);
    bake_folder_finish(&folder);
}

static void pictures_of_any_size_are_near(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{600, 300}, {257, 131}, {5, 3}, {1, 1}, {1, 70}, {514, 2}};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        check_picture(sizes[s][0], sizes[s][1], true, 40.0);
        check_picture(sizes[s][0], sizes[s][1], false, 36.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_of_all_kinds_are_near_and_the_same_everywhere),
        cmocka_unit_test(the_baker_writes_the_same_bytes),
        cmocka_unit_test(neighbors_do_not_matter),
        cmocka_unit_test(blocks_of_one_color_are_exact),
        cmocka_unit_test(extremes_of_two_kinds_are_exact),
        cmocka_unit_test(pictures_of_any_size_are_near),
    };
    return RUN_TESTS(tests);
}
