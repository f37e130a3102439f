/* Files that are not read through libvips: OpenEXR in strips, DDS as it is. */
#include "bake/baked.h"

#include "exr/exr_paths.h"
#include "image/half.h"
#include "support/test.h"

#include <sluice/exr.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What bake.h says of halves that are no finite numbers. */
static uint16_t finite(uint16_t half)
{
    if ((half & 0x7C00) != 0x7C00)
        return half;
    return half & 0x3FF ? 0 : (half & 0x8000) | 0x7BFF;
}

/* Level 0 against the whole image, as the source reads it that builds a chain in memory. */
static void check_exr(const char *path)
{
    struct bake_folder folder;
    char store[256];
    size_t size;
    SluiceExrImageSourceCreateInfo create = {.pPath = path,
                                             .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    SluiceImageSource *source;
    SluiceImageInfo info;
    SluiceBakeSettings settings = {.format = SLUICE_FORMAT_R16G16B16A16_SFLOAT};
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

static void colour(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
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
    SluiceProceduralImage image = {NULL, colour};
    SluiceImageInfo info = {
        .width = 300, .height = 517, .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    SluiceImageSource *source;
    bake_folder_init(&folder);
    bake_folder_file(&folder, "in.exr", path);
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    SluiceExrWriteInfo write = {.pPath = path, .tileWidth = 100, .tileHeight = 70};
    CHECK_OK(sluiceWriteExrFile(&write, source));
    sluiceDestroyImageSource(source);
    check_exr(path);
    bake_folder_finish(&folder);
}

/* Of lines and of tiles, with levels and without, with all halves there are. */
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

#ifdef HAVE_CONTAINER
static SluiceFormat format_of(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.pPath = path};
    SluiceImageSource *source;
    SluiceImageInfo info;
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
    SluiceBakeSettings settings = {0};
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiled_files_are_read_in_strips),
        cmocka_unit_test(files_from_elsewhere_are_read_in_strips),
        cmocka_unit_test(block_compressed_levels_are_kept),
    };
    return RUN_TESTS(tests);
}
