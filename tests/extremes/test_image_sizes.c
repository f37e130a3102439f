/* Very thin, long and odd images. Levels are means, and stores return what was written. */
#include "extremes/note.h"
#include "store/stores.h"

#include <math.h>
#include <stdlib.h>

static bool is_long_run;

static uint32_t mip(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

/* Reads a level of a one-channel float source. Free the result. */
static float *read_level(SluiceImageSource *source, const SluiceImageInfo *info, uint32_t level)
{
    SluiceImageRegion region = {level, 0, 0, mip(info->width, level), mip(info->height, level), 0};
    float *texels = malloc((size_t)region.width * region.height * sizeof *texels);
    assert_non_null(texels);
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, region.width * sizeof *texels));
    return texels;
}

/* The weight of texel `from` of `fine` in texel `to` of `coarse`: the area they share. */
static double share(uint32_t from, uint32_t fine, uint32_t to, uint32_t coarse)
{
    double scale = (double)fine / coarse, left = to * scale, right = left + scale;
    double begin = from > left ? from : left, end = from + 1 < right ? from + 1 : right;
    return end > begin ? (end - begin) / scale : 0;
}

/* Computes a texel by definition: the mean of the area in the level above. */
static double mean(const float *fine, uint32_t fw, uint32_t fh, uint32_t x, uint32_t y, uint32_t cw,
                   uint32_t ch)
{
    double sum = 0;
    uint32_t x0 = (uint32_t)((uint64_t)x * fw / cw), y0 = (uint32_t)((uint64_t)y * fh / ch);
    for (uint32_t v = y0; v < fh && v <= y0 + 3; v++)
        for (uint32_t u = x0; u < fw && u <= x0 + 3; u++)
            sum += fine[(size_t)v * fw + u] * share(u, fw, x, cw) * share(v, fh, y, ch);
    return sum;
}

/* The largest difference from the definition over all levels below 0. */
static double check_chain(uint32_t width, uint32_t height)
{
    size_t count = (size_t)width * height;
    float *texels = malloc(count * sizeof *texels);
    assert_non_null(texels);
    for (size_t i = 0; i < count; i++)
        texels[i] = (float)((uint32_t)(i * 2654435761u) >> 20) / 4096;
    SluiceImageInfo info = {sizeof info, width, height, 0, SLUICE_FORMAT_R32_SFLOAT, "long", 1};
    SluiceImageSource *source;
    double worst = 0;
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, NULL, &source));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    float *fine = read_level(source, &info, 0);
    assert_memory_equal(fine, texels, count * sizeof *texels);
    for (uint32_t level = 1; level < info.mipLevelCount; level++) {
        float *coarse = read_level(source, &info, level);
        uint32_t w = mip(width, level), h = mip(height, level);
        for (uint32_t i = 0; i < w * h; i++) {
            double expected =
                mean(fine, mip(width, level - 1), mip(height, level - 1), i % w, i / w, w, h);
            worst = fmax(worst, fabs(expected - coarse[i]));
        }
        free(fine);
        fine = coarse;
    }
    free(fine);
    free(texels);
    sluiceDestroyImageSource(source);
    return worst;
}

static const uint32_t sizes[][2] = {
    {1, 1},        {1, 2},       {3, 1},     {1, 127},     {131, 1},    {1, 16381}, {16384, 1},
    {1, 32749},    {32768, 1},   {32749, 3}, {5, 32768},   {20011, 2},  {7, 20011}, {1, 1u << 20},
    {1u << 20, 1}, {1048573, 1}, {251, 257}, {1021, 1019}, {16384, 16}, {13, 16381}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

static void every_level_of_any_size_is_the_mean_of_the_one_above(void **state)
{
    (void)state;
    double worst = 0;
    for (uint32_t i = 0; i < SIZES; i++)
        worst = fmax(worst, check_chain(sizes[i][0], sizes[i][1]));
    note("levels of images of any size: difference from the mean", SIZES, worst, 1e-6);
    assert_true(worst <= 1e-6);
}

static void place(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)width, (void)height;
    rgba[0] = (float)x;
    rgba[1] = (float)y;
    rgba[2] = (float)level;
    rgba[3] = 1;
}

/* 2^40 texels, of which the corners of every level are read. */
static void the_largest_image_has_the_right_texel_in_every_corner(void **state)
{
    (void)state;
    static const uint32_t large[][2] = {
        {1u << 20, 1u << 20}, {1048573, 1u << 20}, {1048575, 32749}};
    SluiceProceduralImage image = {NULL, place};
    uint32_t cases = 0, wrong = 0;
    for (uint32_t i = 0; i < 3; i++) {
        SluiceImageInfo info = {sizeof info,
                                large[i][0],
                                large[i][1],
                                0,
                                SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                                "large",
                                1};
        SluiceImageSource *source;
        CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
        CHECK_OK(sluiceGetImageInfo(source, &info));
        assert_int_equal(info.mipLevelCount, info.width == 1u << 20 || i == 1 ? 21 : 20);
        for (uint32_t level = 0; level < info.mipLevelCount; level++)
            for (uint32_t corner = 0; corner < 4; corner++, cases++) {
                uint32_t x = corner % 2 ? mip(info.width, level) - 1 : 0;
                uint32_t y = corner / 2 ? mip(info.height, level) - 1 : 0;
                SluiceImageRegion region = {level, x, y, 1, 1, 0};
                float texel[4];
                CHECK_OK(sluiceReadImageRegion(source, &region, texel, sizeof texel));
                wrong += texel[0] != (float)x || texel[1] != (float)y || texel[2] != (float)level;
                region.x = mip(info.width, level);
                CHECK_RESULT(sluiceReadImageRegion(source, &region, texel, sizeof texel),
                             SLUICE_ERROR_INVALID_ARGUMENT);
            }
        sluiceDestroyImageSource(source);
    }
    note("corners of the largest images: wrong texels", cases, wrong, 0);
    assert_int_equal(wrong, 0);
}

static void stores_of_any_size_give_back_what_was_written(void **state)
{
    (void)state;
    static const SluiceFormat formats[] = {SLUICE_FORMAT_R8_UNORM, SLUICE_FORMAT_BC4_UNORM_BLOCK,
                                           SLUICE_FORMAT_R32G32B32A32_SFLOAT};
    uint32_t cases = 0;
    for (uint32_t i = 0; i < SIZES; i++)
        for (uint32_t f = 0; f < (is_long_run ? 3u : 2u); f++, cases++) {
            struct scratch scratch;
            struct messages messages = {0};
            scratch_init(&scratch);
            SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                          .pPath = scratch.path,
                                          .width = sizes[i][0],
                                          .height = sizes[i][1],
                                          .format = formats[f],
                                          .compressionLevel = 1};
            CHECK_OK(write_store(&info, PICTURE_MIXED));
            CHECK_OK(read_store(scratch.path, PICTURE_MIXED, &messages));
            assert_int_equal(messages.errors, 0);
            scratch_finish(&scratch);
        }
    note("stores of any size: written and read back", cases, cases, cases);
}

int main(int argc, char **argv)
{
    is_long_run = is_long(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_of_any_size_is_the_mean_of_the_one_above),
        cmocka_unit_test(the_largest_image_has_the_right_texel_in_every_corner),
        cmocka_unit_test(stores_of_any_size_give_back_what_was_written),
    };
    return RUN_TESTS(tests);
}
