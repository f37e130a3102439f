/* Blocks decode to something near what they were made from, at any size. */
#include "bake/baked.h"
#include "bake/squish_back.h"
#include "support/test.h"

#include <sluice/metrics.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct kind {
    int number;
    SluiceFormat format;
    uint32_t block_size, channels; /* compared */
    double least;                  /* dB of level 0 */
};

static const struct kind kinds[] = {
    {0, SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK, 8, 3, 36}, {1, SLUICE_FORMAT_BC3_SRGB_BLOCK, 16, 4, 36},
    {2, SLUICE_FORMAT_BC4_UNORM_BLOCK, 8, 1, 42},     {3, SLUICE_FORMAT_BC5_UNORM_BLOCK, 16, 2, 42},
    {0, SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, 8, 3, 36},
};

/* Smooth colors with some noise; opaque for BC1, because it knows one alpha only. */
static uint8_t *make_picture(uint32_t width, uint32_t height, bool opaque)
{
    uint8_t *rgba = malloc(4 * (size_t)width * height);
    uint32_t random = 3;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint8_t *texel = rgba + 4 * ((size_t)y * width + x);
            random = random * 1664525u + 1013904223u;
            texel[0] = (uint8_t)(127 + 100 * sin(x * 0.05) + (random >> 30));
            texel[1] = (uint8_t)(127 + 100 * sin(y * 0.04) + (random >> 30));
            texel[2] = (uint8_t)(127 + 100 * sin((x + y) * 0.03));
            texel[3] = opaque ? 255 : (uint8_t)(200 + 50 * sin(x * 0.02));
        }
    return rgba;
}

/* [height][width][channels] */
static uint8_t *decode(const struct kind *kind, const uint8_t *blocks, uint32_t width,
                       uint32_t height)
{
    uint8_t *out = malloc((size_t)width * height * kind->channels);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint8_t texels[64];
            size_t block = (size_t)(y / 4) * ((width + 3) / 4) + x / 4;
            squish_back(kind->number, blocks + block * kind->block_size, texels);
            memcpy(out + ((size_t)y * width + x) * kind->channels,
                   texels + 4 * (4 * (y % 4) + x % 4), kind->channels);
        }
    return out;
}

static double psnr(const uint8_t *decoded, const uint8_t *rgba, uint32_t count, uint32_t channels)
{
    uint8_t *wanted = malloc((size_t)count * channels);
    double value;
    for (uint32_t i = 0; i < count; i++)
        memcpy(wanted + (size_t)i * channels, rgba + 4 * (size_t)i, channels);
    CHECK_OK(sluiceComputePsnr8(decoded, wanted, count, 1, channels, &value));
    free(wanted);
    return value;
}

static void check(const struct kind *kind, uint32_t width, uint32_t height)
{
    struct bake_folder folder;
    struct plain_source source;
    char path[256];
    size_t size;
    uint8_t *rgba = make_picture(width, height, kind->number == 0);
    bool srgb = kind->format == SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK ||
                kind->format == SLUICE_FORMAT_BC3_SRGB_BLOCK;
    SluiceBakeSettings settings = {.structSize = sizeof settings, .format = kind->format};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "blocks.store", path);
    plain_source_init(&source, srgb ? SLUICE_FORMAT_R8G8B8A8_SRGB : SLUICE_FORMAT_R8G8B8A8_UNORM,
                      width, height, rgba);
    bake_source(&source.base, path, &settings);
    uint8_t *blocks = read_bytes(path, 0, &size);
    assert_int_equal(size, (size_t)((width + 3) / 4) * ((height + 3) / 4) * kind->block_size);
    uint8_t *decoded = decode(kind, blocks, width, height);
    double value = psnr(decoded, rgba, width * height, kind->channels);
    if (value < kind->least)
        fail_msg("%s %ux%u: %g dB", sluiceGetFormatName(kind->format), width, height, value);
    free(decoded);
    free(blocks);
    free(rgba);
    bake_folder_finish(&folder);
}

static void blocks_are_near_the_picture(void **state)
{
    (void)state;
    const uint32_t sizes[][2] = {{600, 300}, {257, 131}, {5, 3}, {1, 1}, {1, 70}, {514, 2}};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
        for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
            check(&kinds[k], sizes[s][0], sizes[s][1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(blocks_are_near_the_picture)};
    return RUN_TESTS(tests);
}
