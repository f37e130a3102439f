/* Files that other programs wrote, of a picture that follows a formula (data/README.md). */
#include <sluice/dds.h>
#include <sluice/ktx2.h>

#include "container/container_files.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Five and six bits per end point, and what the filters for levels differ by. */
#define SMALL_ERROR 10

static SluiceImageSource *open_file(const char *name, struct log_tally *tally, char path[1024])
{
    const char *root = getenv("SLUICE_SOURCE_ROOT");
    snprintf(path, 1024, "%s/tests/container/data/%s", root ? root : ".", name);
    *tally = (struct log_tally){.path = path};
    SluiceDdsImageSourceCreateInfo dds = {
        .structSize = sizeof dds, .pPath = path, .log = log_to(tally)};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {
        .structSize = sizeof ktx2, .pPath = path, .log = log_to(tally)};
    SluiceImageSource *source = NULL;
    CHECK_OK(strstr(name, ".dds") ? sluiceCreateDdsImageSource(&dds, &source)
                                  : sluiceCreateKtx2ImageSource(&ktx2, &source));
    return source;
}

static void expand_565(unsigned packed, int rgb[3])
{
    rgb[0] = (int)((packed >> 11) * 255 / 31);
    rgb[1] = (int)((packed >> 5 & 63) * 255 / 63);
    rgb[2] = (int)((packed & 31) * 255 / 31);
}

/* The color of a texel of a BC1 block, or of the second half of a BC3 one. */
static void decode_color(const uint8_t *block, uint32_t x, uint32_t y, bool is_bc3, uint8_t rgba[4])
{
    int a[3], b[3];
    unsigned first = block[0] | (unsigned)block[1] << 8,
             second = block[2] | (unsigned)block[3] << 8;
    unsigned code = block[4 + y] >> (2 * x) & 3;
    static const int thirds[4] = {3, 0, 2, 1}, halves[4] = {2, 0, 1, 0};
    bool has_four = is_bc3 || first > second;
    expand_565(first, a);
    expand_565(second, b);
    for (int c = 0; c < 3; c++)
        rgba[c] = (uint8_t)(has_four    ? (thirds[code] * a[c] + (3 - thirds[code]) * b[c]) / 3
                            : code == 3 ? 0
                                        : (halves[code] * a[c] + (2 - halves[code]) * b[c]) / 2);
    rgba[3] = has_four || code < 3 ? 255 : 0;
}

static uint8_t decode_alpha(const uint8_t *block, uint32_t x, uint32_t y)
{
    int a = block[0], b = block[1];
    uint64_t codes = 0;
    for (int i = 5; i >= 0; i--)
        codes = codes << 8 | block[2 + i];
    int code = (int)(codes >> (3 * (4 * y + x)) & 7);
    if (code < 2)
        return (uint8_t)(code ? b : a);
    if (a > b)
        return (uint8_t)(((8 - code) * a + (code - 1) * b) / 7);
    if (code >= 6)
        return code == 6 ? 0 : 255;
    return (uint8_t)(((6 - code) * a + (code - 1) * b) / 5);
}

static void texel_of(SluiceFormat format, const uint8_t *texels, uint32_t width, uint32_t x,
                     uint32_t y, uint8_t rgba[4])
{
    uint32_t block = y / 4 * ((width + 3) / 4) + x / 4;
    if (sluiceGetFormatTexelSize(format) == 4) {
        memcpy(rgba, texels + 4 * ((size_t)y * width + x), 4);
    } else if (format == SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK) {
        decode_color(texels + 8 * (size_t)block, x % 4, y % 4, false, rgba);
    } else {
        decode_color(texels + 16 * (size_t)block + 8, x % 4, y % 4, true, rgba);
        rgba[3] = decode_alpha(texels + 16 * (size_t)block, x % 4, y % 4);
    }
}

static void check_level(SluiceImageSource *source, const SluiceImageInfo *info, uint32_t level)
{
    uint32_t width = info->width >> level ? info->width >> level : 1;
    uint32_t height = info->height >> level ? info->height >> level : 1;
    SluiceImageRegion region = {level, 0, 0, width, height};
    uint8_t *texels = malloc(sluiceGetFormatRegionSize(info->format, width, height));
    assert_non_null(texels);
    CHECK_OK(sluiceReadImageRegion(source, &region, texels,
                                   sluiceGetFormatRegionSize(info->format, width, 1)));
    /* A block has four colors on the line that its texels cover: a sixth of it is lost. */
    double covered = (8.0 / width + 4.0 / height) / 3;
    double limit = SMALL_ERROR, squares = 0;
    if (sluiceGetFormatTexelSize(info->format) == 0)
        limit += 255 * (covered < 1 ? covered : 1) / 6;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            double t = (2 * (x + 0.5) / width + (y + 0.5) / height) / 3;
            const double expected[4] = {255 * t, 255 * (1 - t), 64 + 128 * t, 255};
            uint8_t rgba[4];
            texel_of(info->format, texels, width, x, y, rgba);
            for (int c = 0; c < 4; c++)
                squares += (rgba[c] - expected[c]) * (rgba[c] - expected[c]);
        }
    if (squares > limit * limit * 4 * width * height)
        fail_msg("%s, level %u: squares of %.1f, limit %.1f", info->pName, level,
                 squares / (4.0 * width * height), limit * limit);
    free(texels);
}

static void files_of_other_programs_show_their_picture(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        SluiceFormat format;
        uint32_t width, height;
    } files[] = {
        {"nvtt_bc1.dds", SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK, 44, 20},
        {"nvtt_bc3.dds", SLUICE_FORMAT_BC3_UNORM_BLOCK, 44, 20},
        {"nvtt_rgb.dds", SLUICE_FORMAT_R8G8B8A8_UNORM, 44, 20},
        {"magick_dxt5.dds", SLUICE_FORMAT_BC3_UNORM_BLOCK, 32, 16},
        {"magick_rgba.dds", SLUICE_FORMAT_R8G8B8A8_UNORM, 32, 16},
        {"parse_bc1.ktx2", SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK, 44, 20},
#ifdef TEST_HAS_ZSTD
        {"parse_bc1_zstd.ktx2", SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK, 44, 20},
#endif
        {"parse_rgba.ktx2", SLUICE_FORMAT_R8G8B8A8_SRGB, 44, 20},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[1024];
        struct log_tally tally;
        SluiceImageInfo info = {.structSize = sizeof info};
        SluiceImageSource *source = open_file(files[i].name, &tally, path);
        CHECK_OK(sluiceGetImageInfo(source, &info));
        assert_string_equal(info.pName, path);
        assert_int_equal(info.format, files[i].format);
        assert_int_equal(info.width, files[i].width);
        assert_int_equal(info.height, files[i].height);
        assert_int_equal(info.mipLevelCount, 6);
        for (uint32_t level = 0; level < 6; level++)
            check_level(source, &info, level);
        sluiceDestroyImageSource(source);
    }
}

static void a_file_without_its_levels_has_one(void **state)
{
    (void)state;
    char path[1024];
    struct log_tally tally;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageSource *source = open_file("magick_one_level.dds", &tally, path);
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_int_equal(info.mipLevelCount, 1);
    sluiceDestroyImageSource(source);
}

/* Its texels have to be decoded first. */
static void basis_universal_is_refused_with_a_way_out(void **state)
{
    (void)state;
    char path[1024];
    struct log_tally tally;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageSource *source = open_file("basisu_etc1s.ktx2", &tally, path);
    CHECK_RESULT(sluiceGetImageInfo(source, &info), SLUICE_ERROR_UNSUPPORTED);
    assert_non_null(strstr(tally.last, "Basis Universal"));
    assert_non_null(strstr(tally.last, "transcode"));
    sluiceDestroyImageSource(source);
}

static void the_same_blocks_in_a_dds_and_a_ktx2_file_are_the_same(void **state)
{
    (void)state;
    char path[1024];
    struct log_tally tally;
    SluiceImageSource *dds = open_file("nvtt_bc1.dds", &tally, path);
    SluiceImageSource *ktx2 = open_file("parse_bc1.ktx2", &tally, path);
    for (uint32_t level = 0; level < 6; level++) {
        uint8_t a[11 * 5 * 8] = {0}, b[11 * 5 * 8] = {1};
        uint32_t width = 44 >> level ? 44 >> level : 1, height = 20 >> level ? 20 >> level : 1;
        SluiceImageRegion region = {level, 0, 0, width, height};
        size_t row = (width + 3) / 4 * 8;
        CHECK_OK(sluiceReadImageRegion(dds, &region, a, row));
        CHECK_OK(sluiceReadImageRegion(ktx2, &region, b, row));
        assert_memory_equal(a, b, row * ((height + 3) / 4));
    }
    sluiceDestroyImageSource(dds);
    sluiceDestroyImageSource(ktx2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_of_other_programs_show_their_picture),
        cmocka_unit_test(a_file_without_its_levels_has_one),
        cmocka_unit_test(basis_universal_is_refused_with_a_way_out),
        cmocka_unit_test(the_same_blocks_in_a_dds_and_a_ktx2_file_are_the_same),
    };
    return RUN_TESTS(tests);
}
