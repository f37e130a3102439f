/* Files that are read without libvips: OpenEXR in strips, DDS as it is. */
#include "bake/baked.h"

#include "exr/exr_paths.h"
#include "image/half.h"
#include "support/test.h"

#include <sluice/exr.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rule of bake.h for halves that are not finite. */
static uint16_t finite(uint16_t half)
{
    if ((half & 0x7C00) != 0x7C00)
        return half;
    return half & 0x3FF ? 0 : (half & 0x8000) | 0x7BFF;
}

/* Compares level 0 with the whole image, read by the source that builds a chain in memory. */
static void check_exr(const char *path)
{
    struct bake_folder folder;
    char store[256];
    size_t size;
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = path, .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    SluiceImageSource *source;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "out.store", store);
    bake_picture_file(path, store, &settings);
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    uint16_t *baked = read_bytes(store, 0, &size);
    uint16_t *whole = malloc(size);
    assert_int_equal(size, 8 * (size_t)info.width * info.height);
    SluiceImageRegion region = {0, 0, 0, info.width, info.height, 0};
    CHECK_OK(sluiceReadImageRegion(source, &region, whole, 8 * (size_t)info.width));
    for (size_t i = 0; i < size / 2; i++) {
        uint16_t expected = finite(whole[i]);
        if (baked[i] != expected && ((baked[i] | expected) & 0x7FFF) != 0)
            fail_msg("%s: texel %zu channel %zu is %04x, not %04x", path, i / 4, i % 4, baked[i],
                     expected);
    }
    sluiceDestroyImageSource(source);
    free(whole);
    free(baked);
    bake_folder_finish(&folder);
}

static void color(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)level;
    rgba[0] = (float)x / (float)width;
    rgba[1] = (float)y / (float)height * 100.0f;
    rgba[2] = (float)((x * 31 + y * 17) % 100);
    rgba[3] = 1.0f;
}

static void tiled_files_are_read_in_strips(void **state)
{
    (void)state;
    struct bake_folder folder;
    char path[256];
    SluiceProceduralImage image = {NULL, color};
    SluiceImageInfo info = {.structSize = sizeof info,
                            .width = 300,
                            .height = 517,
                            .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    SluiceImageSource *source;
    bake_folder_init(&folder);
    bake_folder_file(&folder, "in.exr", path);
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    SluiceExrWriteInfo write = {
        .structSize = sizeof write, .pPath = path, .tileWidth = 100, .tileHeight = 70};
    CHECK_OK(sluiceWriteExrFile(&write, source));
    sluiceDestroyImageSource(source);
    check_exr(path);
    bake_folder_finish(&folder);
}

/* Files with scanlines and with tiles, with and without levels, and one with all halves. */
static void files_from_elsewhere_are_read_in_strips(void **state)
{
    (void)state;
    const char *const names[] = {"TestImages/AllHalfValues.exr", "TestImages/BrightRingsNanInf.exr",
                                 "Tiles/GoldenGate.exr", "ScanLines/StillLife.exr",
                                 "MultiResolution/Bonita.exr"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char path[1024];
        if (!find_image(names[i], path))
            SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
        check_exr(path);
    }
}

static SluiceStoreColorSpace color_space_of(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceStoreInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &info));
    sluiceDestroyImageSource(source);
    return info.colorSpace;
}

/* Another test covers the conversion. This one shows that it is applied. */
static void colors_of_other_primaries_are_stored_as_those_of_rec709(void **state)
{
    (void)state;
    enum { TEXELS = 37 * 21 };
    static const struct {
        SluiceBakeSettings settings;
        bool keeps;
        SluiceStoreColorSpace space;
    } cases[] = {
        {{.structSize = sizeof(SluiceBakeSettings)}, false, SLUICE_STORE_COLOR_SPACE_LINEAR_SRGB},
        {{.structSize = sizeof(SluiceBakeSettings), .keepPrimaries = true},
         true,
         SLUICE_STORE_COLOR_SPACE_UNDEFINED},
        {{.structSize = sizeof(SluiceBakeSettings), .normalMap = true},
         true,
         SLUICE_STORE_COLOR_SPACE_UNDEFINED},
    };
    char path[1024], store[256];
    own_file("mip_aces.exr", path);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct bake_folder folder;
        uint32_t width, height;
        static float expected[TEXELS][4];
        bake_folder_init(&folder);
        bake_folder_file(&folder, "out.store", store);
        bake_picture_file(path, store, &cases[i].settings);
        assert_int_equal(color_space_of(store), cases[i].space);
        SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                                 .pPath = path,
                                                 .format = SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                                                 .keepPrimaries = cases[i].keeps};
        SluiceImageSource *source;
        SluiceImageRegion region = {.width = 37, .height = 21};
        CHECK_OK(sluiceCreateExrImageSource(&create, &source));
        CHECK_OK(sluiceReadImageRegion(source, &region, expected, 37 * 16));
        sluiceDestroyImageSource(source);
        float *baked = read_level(store, 0, &width, &height);
        for (uint32_t t = 0; t < TEXELS; t++) {
            float length = sqrtf(expected[t][0] * expected[t][0] + expected[t][1] * expected[t][1] +
                                 expected[t][2] * expected[t][2]);
            float scale = cases[i].settings.normalMap ? 1.0f / length : 1.0f;
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(baked[4 * t + c] - expected[t][c] * scale) <= 0x1p-9f);
        }
        free(baked);
        bake_folder_finish(&folder);
    }
}

#ifdef HAVE_CONTAINER
static SluiceFormat format_of(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    sluiceDestroyImageSource(source);
    return info.format;
}
#endif

static void block_compressed_levels_are_kept(void **state)
{
    (void)state;
#ifndef HAVE_CONTAINER
    SKIP_TEST("this build reads no DDS files");
#else
    struct bake_folder folder;
    char in[512], out[256];
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    snprintf(in, sizeof in, "%s/tests/container/data/nvtt_bc1.dds", getenv("SLUICE_SOURCE_ROOT"));
    bake_folder_init(&folder);
    bake_folder_file(&folder, "out.store", out);
    bake_picture_file(in, out, &settings);
    FILE *file = fopen(in, "rb"); /* 128 bytes of header, then all levels, finest first */
    assert_non_null(file);
    assert_int_equal(fseek(file, 128, SEEK_SET), 0);
    for (uint32_t level = 0; level < 6; level++) {
        size_t size;
        char *baked = read_bytes(out, level, &size), *given = malloc(size);
        assert_int_equal(fread(given, 1, size, file), size);
        assert_memory_equal(baked, given, size);
        free(given);
        free(baked);
    }
    assert_int_equal(fgetc(file), EOF);
    fclose(file);
    assert_int_equal(format_of(out), SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK);
    settings.transfer = SLUICE_BAKE_TRANSFER_SRGB;
    bake_picture_file(in, out, &settings);
    assert_int_equal(format_of(out), SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK);
    bake_folder_finish(&folder);
#endif
}

struct liar {
    SluiceImageSource base;
    SluiceImageInfo info;
};

static SluiceResult lie(SluiceImageSource *source, SluiceImageInfo *info)
{
    *info = ((struct liar *)source)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_nothing(SluiceImageSource *source, const SluiceImageRegion *region,
                                 void *texels, size_t row_pitch)
{
    (void)source, (void)region, (void)texels, (void)row_pitch;
    return SLUICE_SUCCESS;
}

static void sources_whose_info_no_image_has_are_refused(void **state)
{
    (void)state;
    static const SluiceImageSourceInterface interface = {sizeof interface, lie, read_nothing, NULL,
                                                         NULL};
    static const SluiceImageInfo infos[] = {
        {sizeof(SluiceImageInfo), 0, 16, 5, SLUICE_FORMAT_R8_UNORM, "no width"},
        {sizeof(SluiceImageInfo), 16, (1u << 20) + 1, 21, SLUICE_FORMAT_R8_UNORM, "too high"},
        {sizeof(SluiceImageInfo), 16, 16, 0, SLUICE_FORMAT_R8_UNORM, "no levels"},
        {sizeof(SluiceImageInfo), 16, 16, 6, SLUICE_FORMAT_R8_UNORM, "too many levels"},
        {sizeof(SluiceImageInfo), 16, 16, 0, SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK,
         "no levels of blocks"},
        {sizeof(SluiceImageInfo), 16, 16, 1, SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK,
         "level 0 of blocks alone"},
        {sizeof(SluiceImageInfo), 16, 16, 5, (SluiceFormat)99, "unknown format"},
        {sizeof(SluiceImageInfo), 16, 16, 5, SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, "layers",
         UINT32_MAX},
    };
    struct bake_folder folder;
    char store[256];
    SluiceBaker *baker;
    bake_folder_init(&folder);
    bake_folder_file(&folder, "out.store", store);
    CHECK_OK(sluiceCreateBaker(
        &(SluiceBakerCreateInfo){.structSize = sizeof(SluiceBakerCreateInfo), .threadCount = 1},
        &baker));
    for (size_t i = 0; i < sizeof infos / sizeof infos[0]; i++) {
        struct liar liar = {{&interface}, infos[i]};
        SluiceBakeInfo bake = {
            .structSize = sizeof bake, .source = &liar.base, .pOutputPath = store};
        CHECK_RESULT(sluiceBakeFile(baker, &bake, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    sluiceDestroyBaker(baker);
    bake_folder_finish(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sources_whose_info_no_image_has_are_refused),
        cmocka_unit_test(tiled_files_are_read_in_strips),
        cmocka_unit_test(files_from_elsewhere_are_read_in_strips),
        cmocka_unit_test(colors_of_other_primaries_are_stored_as_those_of_rec709),
        cmocka_unit_test(block_compressed_levels_are_kept),
    };
    return RUN_TESTS(tests);
}
