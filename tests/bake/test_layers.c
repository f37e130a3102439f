/* Several pictures, or the layers of a source, in one store: each layer is as if baked alone. */
#define _XOPEN_SOURCE 700

#include "bake/baked.h"

#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#define FACES 6u
#define EDGE 150u ///< 2 x 2 tiles of RGBA bytes, and a tail

struct pictures {
    struct bake_folder folder;
    char paths[FACES][256], out[256], alone[256];
    const char *list[FACES];
    uint8_t *samples[FACES];
    char said[1024]; ///< last error
    SluiceBakeInfo info;
    SluiceBakeSettings settings;
};

static uint8_t *random_bytes(size_t count, uint32_t random)
{
    uint8_t *bytes = malloc(count);
    for (size_t i = 0; i < count; i++) {
        random = random * 1664525u + 1013904223u;
        bytes[i] = (uint8_t)(random >> 24);
    }
    return bytes;
}

static void pictures_init(struct pictures *p, uint32_t width, uint32_t height, uint32_t channels)
{
    *p = (struct pictures){.settings = {.structSize = sizeof p->settings}};
    bake_folder_init(&p->folder);
    bake_folder_file(&p->folder, "out.store", p->out);
    bake_folder_file(&p->folder, "alone.store", p->alone);
    for (uint32_t i = 0; i < FACES; i++) {
        char name[16];
        snprintf(name, sizeof name, "face%u.png", i);
        p->list[i] = bake_folder_file(&p->folder, name, p->paths[i]);
        p->samples[i] = random_bytes((size_t)width * height * channels, i + 1);
        write_png(p->paths[i], p->samples[i], width, height, channels, false);
    }
    p->info = (SluiceBakeInfo){.structSize = sizeof p->info,
                               .pOutputPath = p->out,
                               .pSettings = &p->settings,
                               .ppLayerPaths = p->list,
                               .layerPathCount = FACES,
                               .cube = true};
}

static void pictures_finish(struct pictures *p)
{
    for (uint32_t i = 0; i < FACES; i++)
        free(p->samples[i]);
    bake_folder_finish(&p->folder);
}

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct pictures *p = user;
    if (severity == SLUICE_LOG_ERROR)
        snprintf(p->said, sizeof p->said, "%s", message);
}

static SluiceResult bake(struct pictures *p, uint32_t threads, SluiceBakeReport *report)
{
    SluiceBakerCreateInfo create = {
        .structSize = sizeof create, .threadCount = threads, .log = {p, on_log}};
    SluiceBaker *baker;
    CHECK_OK(sluiceCreateBaker(&create, &baker));
    p->said[0] = '\0';
    SluiceResult result = sluiceBakeFile(baker, &p->info, report);
    sluiceDestroyBaker(baker);
    return result;
}

static SluiceImageSource *open_store(const char *path, SluiceImageInfo *info)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    info->structSize = sizeof *info;
    CHECK_OK(sluiceGetImageInfo(source, info));
    return source;
}

/* All levels of a layer of a store are those of layer 0 of another. */
static void check_layer(const char *path, uint32_t layer, const char *alone)
{
    SluiceImageInfo info, other;
    SluiceImageSource *source = open_store(path, &info), *expected = open_store(alone, &other);
    assert_int_equal(info.format, other.format);
    assert_int_equal(info.mipLevelCount, other.mipLevelCount);
    for (uint32_t level = 0; level < info.mipLevelCount; level++) {
        SluiceImageRegion region = {
            level, 0, 0, slc_mip_size(info.width, level), slc_mip_size(info.height, level), 0};
        size_t row = sluiceGetFormatRegionSize(info.format, region.width, 1);
        size_t size = sluiceGetFormatRegionSize(info.format, region.width, region.height);
        void *a = malloc(size), *b = malloc(size);
        CHECK_OK(sluiceReadImageRegion(expected, &region, b, row));
        region.arrayLayer = layer;
        CHECK_OK(sluiceReadImageRegion(source, &region, a, row));
        assert_memory_equal(a, b, size);
        free(a);
        free(b);
    }
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(expected);
}

static void check_pictures(struct pictures *p)
{
    SluiceImageInfo info;
    sluiceDestroyImageSource(open_store(p->out, &info));
    assert_int_equal(info.arrayLayerCount, FACES);
    assert_int_equal(info.cube, p->info.cube);
    for (uint32_t i = 0; i < FACES; i++) {
        unlink(p->alone); /* files of one size and time */
        bake_picture_file(p->paths[i], p->alone, &p->settings);
        check_layer(p->out, i, p->alone);
    }
}

static void six_pictures_become_the_faces_of_a_cube(void **state)
{
    (void)state;
    struct pictures p;
    SluiceBakeReport report = {.structSize = sizeof report};
    pictures_init(&p, EDGE, EDGE, 4);
    CHECK_OK(bake(&p, 3, &report));
    assert_int_equal(report.arrayLayerCount, FACES);
    check_pictures(&p);
    uint64_t size = 0;
    for (uint32_t i = 0; i < FACES; i++) {
        struct stat status;
        assert_int_equal(stat(p.paths[i], &status), 0);
        size += (uint64_t)status.st_size;
    }
    assert_int_equal(report.inputSize, size);
    p.settings.cutout = 0.25f; /* counted for each face */
    CHECK_OK(bake(&p, 1, &report));
    check_pictures(&p);
    pictures_finish(&p);
}

static void pictures_become_the_layers_of_an_array(void **state)
{
    (void)state;
    struct pictures p;
    pictures_init(&p, 300, 17, 1);
    p.info.cube = false;
    CHECK_OK(bake(&p, 2, NULL));
    check_pictures(&p);
    pictures_finish(&p);
}

static void blocks_are_made_of_every_picture(void **state)
{
    (void)state;
    struct pictures p;
    pictures_init(&p, EDGE, EDGE, 3);
    p.settings.format = SLUICE_FORMAT_BC7_UNORM_BLOCK;
    p.settings.quality = SLUICE_BAKE_QUALITY_FAST;
    CHECK_OK(bake(&p, 2, NULL));
    check_pictures(&p);
    /* The faces of blocks stay faces, copied from one store or from several. */
    SluiceImageInfo info;
    SluiceImageSource *blocks = open_store(p.out, &info);
    char copy[256];
    p.info = (SluiceBakeInfo){.structSize = sizeof p.info,
                              .source = blocks,
                              .pOutputPath = bake_folder_file(&p.folder, "copy.store", copy)};
    CHECK_OK(bake(&p, 2, NULL));
    sluiceDestroyImageSource(blocks);
    sluiceDestroyImageSource(open_store(copy, &info));
    assert_true(info.cube);
    for (uint32_t i = 0; i < FACES; i++) {
        unlink(p.alone);
        bake_picture_file(p.paths[i], p.alone, &p.settings);
        check_layer(copy, i, p.alone);
    }
    pictures_finish(&p);
}

/* The layers of a source, of which the baker reads level 0 alone. */
static void all_layers_of_a_source_are_baked(void **state)
{
    (void)state;
    struct pictures p;
    struct plain_source sources[FACES];
    SluiceImageSource *members[FACES], *array;
    pictures_init(&p, EDGE, EDGE, 4);
    for (uint32_t i = 0; i < FACES; i++) {
        plain_source_init(&sources[i], SLUICE_FORMAT_R8G8B8A8_UNORM, EDGE, EDGE, p.samples[i]);
        members[i] = &sources[i].base;
    }
    CHECK_OK(sluiceCreateArrayImageSource(members, FACES, NULL, &array));
    p.settings.cutout = 0.25f;
    p.info.ppLayerPaths = NULL;
    p.info.layerPathCount = 0;
    p.info.source = array;
    CHECK_OK(bake(&p, 2, NULL));
    for (uint32_t i = 0; i < FACES; i++) {
        unlink(p.alone);
        bake_source(members[i], p.alone, &p.settings);
        check_layer(p.out, i, p.alone);
    }
    SluiceImageInfo info;
    sluiceDestroyImageSource(open_store(p.out, &info));
    assert_true(info.cube);
    sluiceDestroyImageSource(array);
    pictures_finish(&p);
}

static void refuse(struct pictures *p, const char *said, const char *also)
{
    CHECK_RESULT(bake(p, 1, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(p->said, said));
    assert_non_null(strstr(p->said, also));
    assert_int_equal(access(p->out, F_OK), -1);
}

static void layers_that_are_not_alike_are_refused_with_both_names(void **state)
{
    (void)state;
    struct pictures p;
    pictures_init(&p, EDGE, EDGE, 4);
    write_png(p.paths[4], p.samples[4], EDGE, EDGE - 1, 4, false);
    refuse(&p, "face4.png: is 150 x 149 texels", "face0.png is 150 x 150 texels");
    write_png(p.paths[4], p.samples[4], EDGE, EDGE, 1, false);
    refuse(&p, "face4.png: is 150 x 150 texels, R8_UNORM", "texels, R8G8B8A8_SRGB");
    p.settings.format = SLUICE_FORMAT_R8G8B8A8_UNORM;
    p.settings.transfer = SLUICE_BAKE_TRANSFER_LINEAR;
    CHECK_OK(bake(&p, 1, NULL));
    pictures_finish(&p);
}

static void faces_that_make_no_cube_are_refused_with_their_values(void **state)
{
    (void)state;
    struct pictures p;
    pictures_init(&p, EDGE, EDGE - 1, 3);
    refuse(&p, "face0.png: is 150 x 149 texels", "square");
    pictures_finish(&p);
    pictures_init(&p, EDGE, EDGE, 3);
    p.info.layerPathCount = 5;
    refuse(&p, "face0.png: 5 layers", "6 faces each");
    p.info.layerPathCount = 6;
    p.info.pInputPath = p.paths[0];
    refuse(&p, "layerPathCount is 6", "pInputPath");
    p.info.pInputPath = NULL;
    p.list[3] = NULL;
    CHECK_RESULT(bake(&p, 1, NULL), SLUICE_ERROR_NULL_POINTER);
    p.list[3] = p.info.pOutputPath = p.paths[3];
    CHECK_RESULT(bake(&p, 1, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(p.said, "face3.png"));
    p.list[3] = "absent.png";
    p.info.pOutputPath = p.out;
    CHECK_RESULT(bake(&p, 1, NULL), SLUICE_ERROR_FILE_NOT_FOUND);
    pictures_finish(&p);
}

static void a_cube_is_skipped_until_one_face_changes(void **state)
{
    (void)state;
    struct pictures p;
    SluiceBakeReport report = {.structSize = sizeof report};
    pictures_init(&p, 16, 16, 3);
    CHECK_OK(bake(&p, 1, &report));
    assert_false(report.skipped);
    CHECK_OK(bake(&p, 1, &report));
    assert_true(report.skipped);
    assert_int_equal(report.arrayLayerCount, FACES);
    const struct timespec times[] = {{1, 0}, {1, 0}}; /* older than all others */
    assert_int_equal(utimensat(AT_FDCWD, p.paths[2], times, 0), 0);
    CHECK_OK(bake(&p, 1, &report));
    assert_false(report.skipped);
    p.list[2] = p.paths[3];
    p.list[3] = p.paths[2];
    CHECK_OK(bake(&p, 1, &report));
    assert_false(report.skipped);
    p.info.cube = false;
    CHECK_OK(bake(&p, 1, &report));
    assert_false(report.skipped);
    pictures_finish(&p);
}

static bool stop_in_the_last_face(void *user, uint64_t done, uint64_t total)
{
    (void)user;
    return done < total / 6 * 5 + total / 12;
}

static void a_cube_that_was_interrupted_is_gone_on_with(void **state)
{
    (void)state;
    struct pictures p;
    SluiceBakeReport report = {.structSize = sizeof report};
    pictures_init(&p, 256, 256, 4);
    p.info.pfnProgress = stop_in_the_last_face;
    CHECK_RESULT(bake(&p, 1, NULL), SLUICE_ERROR_CANCELED);
    assert_int_equal(access(p.out, F_OK), -1);
    p.info.pfnProgress = NULL;
    CHECK_OK(bake(&p, 1, &report));
    assert_true(report.resumedTileCount >= 5 * 5);
    check_pictures(&p);
    pictures_finish(&p);
}

/* The process may open no more files after half of the faces. */
static bool take_descriptors(void *user, uint64_t done, uint64_t total)
{
    struct rlimit *before = user, few;
    if (2 * done >= total && before->rlim_cur == 0) {
        assert_int_equal(getrlimit(RLIMIT_NOFILE, before), 0);
        few = (struct rlimit){5, before->rlim_max};
        assert_int_equal(setrlimit(RLIMIT_NOFILE, &few), 0);
    }
    return true;
}

static void finished_faces_outlast_a_want_of_descriptors(void **state)
{
    (void)state;
    struct pictures p;
    struct rlimit before = {0};
    SluiceBakeReport report = {.structSize = sizeof report};
    pictures_init(&p, 256, 256, 4);
    p.info.pfnProgress = take_descriptors;
    p.info.pUserData = &before;
    SluiceResult result = bake(&p, 1, NULL);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &before), 0);
    CHECK_RESULT(result, SLUICE_NOT_READY);
    assert_int_equal(access(p.out, F_OK), -1);
    p.info.pfnProgress = NULL;
    CHECK_OK(bake(&p, 1, &report));
    assert_true(report.resumedTileCount >= 2 * 5);
    check_pictures(&p);
    pictures_finish(&p);
}

static void no_memory_is_an_ordinary_result(void **state)
{
    (void)state;
    struct pictures p;
    pictures_init(&p, 16, 16, 3);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, n);
        SluiceBakerCreateInfo create = {
            .structSize = sizeof create, .threadCount = 1, .pAllocator = &allocator.callbacks};
        SluiceBaker *baker = NULL;
        result = sluiceCreateBaker(&create, &baker);
        if (result == SLUICE_SUCCESS)
            result = sluiceBakeFile(baker, &p.info, NULL);
        sluiceDestroyBaker(baker);
        if (result != SLUICE_SUCCESS) {
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(access(p.out, F_OK), -1);
        }
        assert_int_equal(allocator.live_count, 0);
    }
    check_pictures(&p);
    pictures_finish(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(six_pictures_become_the_faces_of_a_cube),
        cmocka_unit_test(pictures_become_the_layers_of_an_array),
        cmocka_unit_test(blocks_are_made_of_every_picture),
        cmocka_unit_test(all_layers_of_a_source_are_baked),
        cmocka_unit_test(layers_that_are_not_alike_are_refused_with_both_names),
        cmocka_unit_test(faces_that_make_no_cube_are_refused_with_their_values),
        cmocka_unit_test(a_cube_is_skipped_until_one_face_changes),
        cmocka_unit_test(a_cube_that_was_interrupted_is_gone_on_with),
        cmocka_unit_test(finished_faces_outlast_a_want_of_descriptors),
        cmocka_unit_test(no_memory_is_an_ordinary_result),
    };
    return RUN_TESTS(tests);
}
