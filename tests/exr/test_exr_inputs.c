/* OpenEXR files that share a pool of open files, and such files that are in no file. */
#include <sluice/exr.h>

#include "base/checked.h"
#include "exr/exr_paths.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"mip_zip.exr", "scan_mixed.exr", "rip_down.exr"};

enum { NAME_COUNT = sizeof names / sizeof names[0] };

static uint8_t *read_bytes(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static SluiceResult open_exr(const char *path, const SluiceInput *input, SluiceFilePool *pool,
                             SluiceImageSource **source)
{
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = path, .pInput = input, .filePool = pool};
    return sluiceCreateExrImageSource(&create, source);
}

/* All levels, one after the other, from malloc. */
static uint8_t *read_levels(SluiceImageSource *source, size_t *size)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    uint8_t *texels = NULL;
    *size = 0;
    CHECK_OK(sluiceGetImageInfo(source, &info));
    for (uint32_t level = 0; level < info.mipLevelCount; level++) {
        SluiceImageRegion region = {level, 0, 0, slc_mip_size(info.width, level),
                                    slc_mip_size(info.height, level)};
        size_t pitch = region.width * sluiceGetFormatTexelSize(info.format);
        texels = realloc(texels, *size + pitch * region.height);
        assert_non_null(texels);
        CHECK_OK(sluiceReadImageRegion(source, &region, texels + *size, pitch));
        *size += pitch * region.height;
    }
    return texels;
}

static void check_like_file(SluiceImageSource *source, const char *path)
{
    SluiceImageSource *plain;
    size_t size, plain_size;
    CHECK_OK(open_exr(path, NULL, NULL, &plain));
    uint8_t *texels = read_levels(source, &size), *expected = read_levels(plain, &plain_size);
    assert_int_equal(size, plain_size);
    assert_memory_equal(texels, expected, size);
    free(texels);
    free(expected);
    sluiceDestroyImageSource(plain);
}

static void bytes_in_memory_are_read_like_a_file(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < NAME_COUNT; i++) {
        char path[1024];
        size_t size;
        SluiceImageSource *source;
        uint8_t *bytes = read_bytes(own_file(names[i], path), &size);
        SluiceInput input = {.structSize = sizeof input, .pBytes = bytes, .size = size};
        CHECK_OK(open_exr(NULL, &input, NULL, &source));
        check_like_file(source, path);
        sluiceDestroyImageSource(source);
        free(bytes);
    }
}

static void bytes_that_are_cut_are_refused_or_end_in_a_read(void **state)
{
    (void)state;
    char path[1024];
    size_t whole;
    uint8_t *bytes = read_bytes(own_file(names[0], path), &whole);
    for (size_t size = 1; size < whole; size += whole / 50 + 1) {
        uint8_t *cut = malloc(size);
        memcpy(cut, bytes, size);
        SluiceInput input = {.structSize = sizeof input, .pBytes = cut, .size = size};
        SluiceImageSource *source = NULL;
        SluiceResult result = open_exr("cut", &input, NULL, &source);
        SluiceImageInfo info = {.structSize = sizeof info};
        if (result == SLUICE_SUCCESS) {
            CHECK_OK(sluiceGetImageInfo(source, &info));
            for (uint32_t l = 0; l < info.mipLevelCount && result == SLUICE_SUCCESS; l++) {
                SluiceImageRegion region = {l, 0, 0, slc_mip_size(info.width, l),
                                            slc_mip_size(info.height, l)};
                size_t pitch = region.width * sluiceGetFormatTexelSize(info.format);
                void *texels = malloc(pitch * region.height);
                result = sluiceReadImageRegion(source, &region, texels, pitch);
                free(texels);
            }
        }
        CHECK_RESULT(result, SLUICE_ERROR_CORRUPT_DATA);
        sluiceDestroyImageSource(source);
        free(cut);
    }
    free(bytes);
}

struct bytes {
    const uint8_t *bytes;
    SluiceResult result;
};

static SluiceResult read_some(void *user, uint64_t offset, void *bytes, size_t size)
{
    const struct bytes *from = user;
    memcpy(bytes, from->bytes + offset, size);
    return from->result;
}

/* The file is not blamed for what its reader says. */
static void a_callback_that_is_not_ready_is_asked_again(void **state)
{
    (void)state;
    char path[1024];
    size_t size;
    uint8_t *bytes = read_bytes(own_file(names[0], path), &size);
    struct bytes from = {bytes, SLUICE_NOT_READY};
    SluiceInput input = {
        .structSize = sizeof input, .size = size, .pUserData = &from, .pfnRead = read_some};
    SluiceImageSource *source = NULL;
    CHECK_RESULT(open_exr("later", &input, NULL, &source), SLUICE_NOT_READY);
    from.result = SLUICE_SUCCESS;
    CHECK_OK(open_exr("later", &input, NULL, &source));
    check_like_file(source, path);
    uint8_t texel[16];
    SluiceImageRegion region = {0, 0, 0, 1, 1, 0};
    from.result = SLUICE_NOT_READY;
    CHECK_RESULT(sluiceReadImageRegion(source, &region, texel, sizeof texel), SLUICE_NOT_READY);
    from.result = SLUICE_ERROR_CANCELED;
    CHECK_RESULT(sluiceReadImageRegion(source, &region, texel, sizeof texel), SLUICE_ERROR_IO);
    sluiceDestroyImageSource(source);
    free(bytes);
}

static void files_of_a_pool_take_turns(void **state)
{
    (void)state;
    SluiceFilePoolCreateInfo info = {.structSize = sizeof info, .maxOpenFileCount = 1};
    SluiceFilePool *pool;
    SluiceImageSource *sources[NAME_COUNT];
    char paths[NAME_COUNT][1024];
    CHECK_OK(sluiceCreateFilePool(&info, &pool));
    for (uint32_t i = 0; i < NAME_COUNT; i++)
        CHECK_OK(open_exr(own_file(names[i], paths[i]), NULL, pool, &sources[i]));
    for (uint32_t i = 0; i < 2 * NAME_COUNT; i++)
        check_like_file(sources[i % NAME_COUNT], paths[i % NAME_COUNT]);
    for (uint32_t i = 0; i < NAME_COUNT; i++)
        sluiceDestroyImageSource(sources[i]);
    SluiceFilePoolStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetFilePoolStatistics(pool, &statistics));
    assert_int_equal(statistics.openFilePeak, 1);
    assert_true(statistics.openTotal > NAME_COUNT);
    sluiceDestroyFilePool(pool);
}

static void inputs_without_bytes_are_refused(void **state)
{
    (void)state;
    SluiceImageSource *source = NULL;
    SluiceInput input = {.structSize = sizeof input, .size = 1};
    CHECK_RESULT(open_exr(NULL, NULL, NULL, &source), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(open_exr("x", &input, NULL, &source), SLUICE_ERROR_NULL_POINTER);
    input.pBytes = &input;
    input.size = 0;
    CHECK_RESULT(open_exr("x", &input, NULL, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_in_memory_are_read_like_a_file),
        cmocka_unit_test(bytes_that_are_cut_are_refused_or_end_in_a_read),
        cmocka_unit_test(a_callback_that_is_not_ready_is_asked_again),
        cmocka_unit_test(files_of_a_pool_take_turns),
        cmocka_unit_test(inputs_without_bytes_are_refused),
    };
    return RUN_TESTS(tests);
}
