/* ASTC decodes to something near the picture, the same with any number of threads. */
#include "bake/astc_back.h"
#include "bake/baked.h"
#include "support/test.h"

#include <sluice/metrics.h>

#include <stdlib.h>
#include <string.h>

static uint8_t *make_picture(uint32_t width, uint32_t height)
{
    uint8_t *rgba = malloc(4 * (size_t)width * height);
    uint32_t random = 3;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint8_t *texel = rgba + 4 * ((size_t)y * width + x);
            random = random * 1664525u + 1013904223u;
            texel[0] = (uint8_t)(x / 4 + (random >> 30));
            texel[1] = (uint8_t)(y / 3);
            texel[2] = (uint8_t)((x + y) / 5);
            texel[3] = (uint8_t)(255 - x / 8);
        }
    return rgba;
}

static void bake(uint32_t threads, SluiceImageSource *source, const char *path,
                 const SluiceBakeSettings *settings)
{
    SluiceBakerCreateInfo create = {.structSize = sizeof create, .threadCount = threads};
    SluiceBakeInfo info = {
        .structSize = sizeof info, .source = source, .pOutputPath = path, .pSettings = settings};
    SluiceBaker *baker;
    CHECK_OK(sluiceCreateBaker(&create, &baker));
    CHECK_OK(sluiceBakeFile(baker, &info, NULL));
    sluiceDestroyBaker(baker);
}

static void check(SluiceFormat format, SluiceBakeQuality quality, uint32_t width, uint32_t height,
                  double least)
{
    uint32_t extent = format == SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK ? 4 : 8;
    struct bake_folder folder;
    struct plain_source source;
    char path[256], other[256];
    size_t size, other_size, count = (size_t)width * height;
    uint8_t *rgba = make_picture(width, height), *back = malloc(4 * count);
    SluiceBakeSettings settings = {
        .structSize = sizeof settings, .format = format, .quality = quality};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "one.store", path);
    bake_folder_file(&folder, "four.store", other);
    plain_source_init(&source, SLUICE_FORMAT_R8G8B8A8_UNORM, width, height, rgba);
    bake(1, &source.base, path, &settings);
    bake(4, &source.base, other, &settings);
    uint8_t *blocks = read_bytes(path, 0, &size), *again = read_bytes(other, 0, &other_size);
    assert_int_equal(size, (size_t)((width + extent - 1) / extent) *
                               ((height + extent - 1) / extent) * 16);
    assert_int_equal(size, other_size);
    assert_memory_equal(blocks, again, size);
    assert_true(astc_back(extent, blocks, size, width, height, back));
    double value;
    CHECK_OK(sluiceComputePsnr8(back, rgba, (uint32_t)count, 1, 4, &value));
    if (value < least)
        fail_msg("%s %ux%u: %g dB", sluiceGetFormatName(format), width, height, value);
    free(again);
    free(blocks);
    free(back);
    free(rgba);
    bake_folder_finish(&folder);
}

static void pictures_of_any_size_are_near(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{600, 300}, {257, 131}, {5, 3}, {1, 1}, {1, 70}, {514, 2}};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (int q = 0; q < 3; q++) {
            check(SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK, (SluiceBakeQuality)q, sizes[s][0],
                  sizes[s][1], 44.0);
            check(SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK, (SluiceBakeQuality)q, sizes[s][0],
                  sizes[s][1], 38.0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures_of_any_size_are_near)};
    return RUN_TESTS(tests);
}
