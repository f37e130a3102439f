/* Textures of neural sets are opened by name, and refused by name; texels are those of the decoder.
 */
#define _XOPEN_SOURCE 700

#include <sluice/open.h>

#include "bake/baked.h"
#include "neural/decoded.h"
#include "neural/made_file.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 97, HEIGHT = 61 };

struct fixture {
    struct bake_folder folder;
    char path[256];
    struct made_file file;
    SluiceImageOpener *opener;
    char error[1024], information[1024];
};

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    if (severity == SLUICE_LOG_ERROR || severity == SLUICE_LOG_INFO)
        snprintf(severity == SLUICE_LOG_ERROR ? f->error : f->information, sizeof f->error, "%s",
                 message);
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* A set with the textures "albedo", of halves, and "height", of one byte. */
static void setup(struct fixture *f)
{
    struct made_parts parts;
    memset(f, 0, sizeof *f);
    make_parts(&parts, &made_shapes[7], 11);
    parts.textures[0].pName = "albedo";
    parts.textures[1].pName = "height";
    CHECK_OK(write_made_file(&parts, &f->file));
    free_made_parts(&parts);
    bake_folder_init(&f->folder);
    bake_folder_file(&f->folder, "set.png", f->path);
    write_bytes(f->path, f->file.bytes, f->file.size);
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .log = {f, on_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f->opener));
}

static void teardown(struct fixture *f)
{
    sluiceDestroyImageOpener(f->opener);
    bake_folder_finish(&f->folder);
    free(f->file.bytes);
}

static SluiceImageInfo info_of(SluiceImageSource *source)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    return info;
}

static void texels_of_a_named_texture_are_those_of_the_decoder(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    SluiceImageSource *source;
    SluiceNeuralSet *set;
    static uint8_t texels[HEIGHT][WIDTH];
    const SluiceNeuralSetCreateInfo open = {.structSize = sizeof open, .pPath = f.path};
    CHECK_OK(sluiceOpenNamedImageSource(f.opener, f.path, "height", &source));
    CHECK_OK(sluiceOpenNeuralSet(&open, &set));
    SluiceImageInfo image = info_of(source);
    assert_int_equal(image.format, SLUICE_FORMAT_R8_UNORM);
    assert_int_equal(image.width, WIDTH);
    for (uint32_t mip = 0; mip < image.mipLevelCount; mip++) {
        uint32_t width = WIDTH >> mip ? WIDTH >> mip : 1,
                 height = HEIGHT >> mip ? HEIGHT >> mip : 1;
        const SluiceImageRegion all = {mip, 0, 0, width, height, 0};
        float *decoded = decode_mip(set, SLUICE_NEURAL_WEIGHTS_INT8, mip);
        CHECK_OK(sluiceReadImageRegion(source, &all, texels, WIDTH));
        for (uint32_t i = 0; i < width * height; i++) {
            float value = fminf(fmaxf(decoded[(size_t)i * 6 + 4], 0.0f), 1.0f);
            assert_int_equal(texels[i / width][i % width], (int)(value * 255.0f + 0.5f));
        }
        free(decoded);
    }
    sluiceDestroyNeuralSet(set);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

static void without_a_name_the_first_texture_is_opened_and_all_are_named(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    SluiceImageSource *source, *again, *other;
    SluiceOpenedImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceOpenImageSource(f.opener, f.path, &source));
    assert_string_equal(info_of(source).pName, "albedo");
    assert_int_equal(info_of(source).format, SLUICE_FORMAT_R16G16B16A16_SFLOAT);
    assert_non_null(strstr(f.information, "albedo, height"));
    CHECK_OK(sluiceGetOpenedImageInfo(source, &info));
    assert_int_equal(info.kind, SLUICE_IMAGE_FILE_KIND_NEURAL);
    assert_true(info.ready && info.source);
    CHECK_OK(sluiceOpenNamedImageSource(f.opener, f.path, "height", &other));
    CHECK_OK(sluiceOpenNamedImageSource(f.opener, f.path, "height", &again));
    assert_ptr_equal(other, again);
    assert_ptr_not_equal(other, source);
    assert_string_equal(f.error, "");
    sluiceDestroyImageSource(again);
    sluiceDestroyImageSource(other);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

static void names_that_are_not_there_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    char store[256];
    setup(&f);
    SluiceImageSource *source = NULL;
    CHECK_RESULT(sluiceOpenNamedImageSource(f.opener, f.path, "normal", &source),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(f.error, f.path));
    assert_non_null(strstr(f.error, "'normal'; it has albedo, height"));
    bake_folder_file(&f.folder, "a.dds", store);
    write_bytes(store, "DDS ", 4);
    CHECK_RESULT(sluiceOpenNamedImageSource(f.opener, store, "albedo", &source),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(f.error, "is no neural set"));
    assert_non_null(strstr(f.error, "sluiceOpenImageSource"));
    assert_null(source);
    teardown(&f);
}

/* Cut off anywhere in its description, and behind it. */
static void damaged_sets_are_refused_with_their_path(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    SluiceImageSource *source = NULL;
    for (size_t size = 4; size + 1 < f.file.size; size += size < 64 ? 1 : f.file.size / 40) {
        write_bytes(f.path, f.file.bytes, size);
        f.error[0] = '\0';
        CHECK_RESULT(sluiceOpenImageSource(f.opener, f.path, &source), SLUICE_ERROR_CORRUPT_DATA);
        assert_non_null(strstr(f.error, f.path));
    }
    assert_null(source);
    teardown(&f);
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        SluiceImageOpener *opener = NULL;
        SluiceImageSource *source = NULL;
        failing_allocator_init(&a, n);
        SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .pAllocator = &a.callbacks};
        result = sluiceCreateImageOpener(&info, &opener);
        if (result == SLUICE_SUCCESS)
            result = sluiceOpenNamedImageSource(opener, f.path, "height", &source);
        sluiceDestroyImageSource(source);
        sluiceDestroyImageOpener(opener);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(a.live_bytes, 0);
    }
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_of_a_named_texture_are_those_of_the_decoder),
        cmocka_unit_test(without_a_name_the_first_texture_is_opened_and_all_are_named),
        cmocka_unit_test(names_that_are_not_there_are_refused),
        cmocka_unit_test(damaged_sets_are_refused_with_their_path),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
