/* Coarse levels alone, made fast, and what a bake would make. */
#define _XOPEN_SOURCE 700

#include "bake/baked.h"

#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <vips/vips.h>

enum { WIDTH = 1203, HEIGHT = 700, LEVELS = 11 };

struct fixture {
    struct bake_folder folder;
    char png[256], jpeg[256], whole[256], preview[256];
    SluiceBaker *baker;
};

/* Slow waves, so that filters differ little. */
static void write_pictures(const struct fixture *f)
{
    uint8_t *samples = malloc(WIDTH * HEIGHT * 3);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++)
            for (uint32_t c = 0; c < 3; c++)
                samples[(y * WIDTH + x) * 3 + c] =
                    (uint8_t)(128 + 100 * sin(x * 0.02 * (c + 1)) * cos(y * 0.015));
    write_png(f->png, samples, WIDTH, HEIGHT, 3, false);
    VipsImage *image = vips_image_new_from_file(f->png, NULL);
    assert_non_null(image);
    assert_int_equal(vips_jpegsave(image, f->jpeg, "Q", 95, NULL), 0);
    g_object_unref(image);
    free(samples);
}

static void setup(struct fixture *f)
{
    SluiceBakerCreateInfo create = {.structSize = sizeof create, .threadCount = 1};
    bake_folder_init(&f->folder);
    bake_folder_file(&f->folder, "a.png", f->png);
    bake_folder_file(&f->folder, "a.jpeg", f->jpeg);
    bake_folder_file(&f->folder, "whole.store", f->whole);
    bake_folder_file(&f->folder, "preview.store", f->preview);
    CHECK_OK(sluiceCreateBaker(&create, &f->baker));
    write_pictures(f);
}

static void teardown(struct fixture *f)
{
    sluiceDestroyBaker(f->baker);
    bake_folder_finish(&f->folder);
}

static double mean_difference(const char *a, uint32_t level_a, const char *b, uint32_t level_b)
{
    uint32_t width_a, height_a, width_b, height_b;
    float *texels_a = read_level(a, level_a, &width_a, &height_a);
    float *texels_b = read_level(b, level_b, &width_b, &height_b);
    double sum = 0;
    assert_int_equal(width_a, width_b);
    assert_int_equal(height_a, height_b);
    size_t count = (size_t)width_a * height_a * 4;
    for (size_t i = 0; i < count; i++)
        sum += fabs((double)texels_a[i] - (double)texels_b[i]);
    free(texels_a);
    free(texels_b);
    return sum / (double)count;
}

static void a_preview_looks_like_the_levels_of_the_whole_chain(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    for (int is_jpeg = 0; is_jpeg < 2; is_jpeg++) {
        SluiceBakeInfo info = {.structSize = sizeof info,
                               .pInputPath = is_jpeg ? f.jpeg : f.png,
                               .pOutputPath = f.whole};
        SluiceBakeReport report = {.structSize = sizeof report};
        CHECK_OK(sluiceBakeFile(f.baker, &info, NULL));
        info.pOutputPath = f.preview;
        for (info.firstLevel = 1; info.firstLevel < LEVELS; info.firstLevel += 2) {
            CHECK_OK(sluiceBakeFile(f.baker, &info, &report));
            assert_int_equal(report.mipLevelCount, LEVELS - info.firstLevel);
            assert_false(report.skipped);
            assert_true(mean_difference(f.whole, info.firstLevel, f.preview, 0) <
                        (info.firstLevel < 4 ? 0.02 : 0.06));
        }
    }
    teardown(&f);
}

static void a_preview_is_never_taken_for_the_whole_store(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    SluiceBakeInfo info = {
        .structSize = sizeof info, .pInputPath = f.png, .pOutputPath = f.whole, .firstLevel = 2};
    SluiceBakeReport report = {.structSize = sizeof report};
    CHECK_OK(sluiceBakeFile(f.baker, &info, &report));
    info.firstLevel = 0;
    CHECK_OK(sluiceBakeFile(f.baker, &info, &report));
    assert_false(report.skipped);
    assert_int_equal(report.width, WIDTH);
    teardown(&f);
}

static void what_would_be_baked_is_what_is_baked(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    for (uint32_t first = 0; first < 4; first++) {
        SluiceBakeInfo info = {
            .structSize = sizeof info, .pInputPath = f.jpeg, .firstLevel = first};
        SluiceBakeReport said = {.structSize = sizeof said}, done = {.structSize = sizeof done};
        CHECK_OK(sluiceDescribeBake(f.baker, &info, &said));
        assert_int_equal(access(f.preview, F_OK), -1);
        info.pOutputPath = f.preview;
        CHECK_OK(sluiceBakeFile(f.baker, &info, &done));
        assert_int_equal(said.width, slc_mip_size(WIDTH, first));
        assert_int_equal(said.width, done.width);
        assert_int_equal(said.height, done.height);
        assert_int_equal(said.mipLevelCount, done.mipLevelCount);
        assert_int_equal(said.format, done.format);
        assert_int_equal(said.inputSize, done.inputSize);
        unlink(f.preview);
    }
    teardown(&f);
}

static VipsImage *read_png(const struct fixture *f)
{
    VipsImage *image = vips_image_new_from_file(f->png, NULL),
              *copy = vips_image_copy_memory(image);
    assert_non_null(copy);
    g_object_unref(image);
    return copy;
}

static uint64_t memory_of(const struct fixture *f, const char *path, uint32_t first)
{
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .pInputPath = path,
                           .pOutputPath = f->preview,
                           .force = true,
                           .firstLevel = first};
    SluiceBakeReport report = {.structSize = sizeof report};
    CHECK_OK(sluiceBakeFile(f->baker, &info, &report));
    return report.memorySize;
}

/* The first of the two files is read from top to bottom. */
static void check_more_memory(const struct fixture *f, const char *rows, const char *whole,
                              uint32_t times)
{
    for (uint32_t first = 0; first < LEVELS; first += 2)
        assert_int_equal(memory_of(f, whole, first) - memory_of(f, rows, first),
                         times * (WIDTH * HEIGHT * 3));
}

static void a_preview_of_a_file_that_is_unpacked_whole_counts_all_of_it(void **state)
{
    (void)state;
    struct fixture f;
    char interlaced[256], progressive[256], webp[256], upright[256], turned[256];
    setup(&f);
    VipsImage *image = read_png(&f);
    bake_folder_file(&f.folder, "interlaced.png", interlaced);
    assert_int_equal(vips_pngsave(image, interlaced, "interlace", TRUE, NULL), 0);
    check_more_memory(&f, f.png, interlaced, 1);
    bake_folder_file(&f.folder, "progressive.jpeg", progressive);
    assert_int_equal(vips_jpegsave(image, progressive, "interlace", TRUE, NULL), 0);
    check_more_memory(&f, f.jpeg, progressive, 2);
    bake_folder_file(&f.folder, "a.webp", webp);
    if (vips_type_find("VipsOperation", "webpsave")) {
        assert_int_equal(vips_webpsave(image, webp, NULL), 0);
        check_more_memory(&f, f.png, webp, 3);
    }
    bake_folder_file(&f.folder, "upright.tiff", upright);
    bake_folder_file(&f.folder, "turned.tiff", turned);
    assert_int_equal(vips_tiffsave(image, upright, NULL), 0);
    vips_image_set_int(image, VIPS_META_ORIENTATION, 3);
    assert_int_equal(vips_tiffsave(image, turned, NULL), 0);
    check_more_memory(&f, upright, turned, 1);
    g_object_unref(image);
    teardown(&f);
}

static void levels_and_files_that_are_not_there_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .pInputPath = f.png,
                           .pOutputPath = f.preview,
                           .firstLevel = LEVELS};
    SluiceBakeReport report = {.structSize = sizeof report};
    CHECK_RESULT(sluiceBakeFile(f.baker, &info, NULL), SLUICE_ERROR_UNSUPPORTED);
    info.firstLevel = UINT32_MAX;
    CHECK_RESULT(sluiceDescribeBake(f.baker, &info, &report), SLUICE_ERROR_UNSUPPORTED);
    struct plain_source source;
    uint8_t texels[16 * 16] = {0};
    plain_source_init(&source, SLUICE_FORMAT_R8_UNORM, 16, 16, texels);
    info.pInputPath = NULL;
    info.source = &source.base;
    info.firstLevel = 1;
    CHECK_RESULT(sluiceBakeFile(f.baker, &info, NULL), SLUICE_ERROR_UNSUPPORTED);
    unlink(f.png);
    info.pInputPath = f.png;
    CHECK_RESULT(sluiceDescribeBake(f.baker, &info, &report), SLUICE_ERROR_FILE_NOT_FOUND);
    teardown(&f);
}

static void describing_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        SluiceBaker *baker = NULL;
        failing_allocator_init(&a, n);
        SluiceBakerCreateInfo create = {
            .structSize = sizeof create, .threadCount = 1, .pAllocator = &a.callbacks};
        SluiceBakeInfo info = {.structSize = sizeof info, .pInputPath = f.jpeg, .firstLevel = 1};
        SluiceBakeReport report = {.structSize = sizeof report};
        result = sluiceCreateBaker(&create, &baker);
        if (result == SLUICE_SUCCESS)
            result = sluiceDescribeBake(baker, &info, &report);
        sluiceDestroyBaker(baker);
        assert_int_equal(a.live_bytes, 0);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_preview_looks_like_the_levels_of_the_whole_chain),
        cmocka_unit_test(a_preview_is_never_taken_for_the_whole_store),
        cmocka_unit_test(what_would_be_baked_is_what_is_baked),
        cmocka_unit_test(a_preview_of_a_file_that_is_unpacked_whole_counts_all_of_it),
        cmocka_unit_test(levels_and_files_that_are_not_there_are_refused),
        cmocka_unit_test(describing_survives_every_refused_allocation),
    };
    return RUN_TESTS(tests);
}
