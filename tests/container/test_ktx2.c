#include <sluice/ktx2.h>

#include "container/container_checks.h"
#include "support/test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#ifdef TEST_HAS_ZSTD
enum { SCHEME_COUNT = 2 };
#else
enum { SCHEME_COUNT = 1 };
#endif
static const uint32_t schemes[2] = {0, 2};

static SluiceImageSource *open_ktx2(const char *path, SluiceFormat format, struct log_tally *tally)
{
    SluiceKtx2ImageSourceCreateInfo info = {
        .structSize = sizeof info, .pPath = path, .format = format, .maxCacheSize = 1 << 23};
    if (tally) {
        *tally = (struct log_tally){.path = path};
        info.log = log_to(tally);
    }
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateKtx2ImageSource(&info, &source));
    return source;
}

static void every_format_is_delivered_as_it_is(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < format_names_count; i++)
        for (int k = 0; k < SCHEME_COUNT; k++) {
            struct picture picture = {&format_names[i], 37, 70};
            if (picture.format->vulkan)
                check_file(make_ktx2(&picture, schemes[k]), &picture, open_ktx2);
        }
}

static void every_size_and_array_is_delivered(void **state)
{
    (void)state;
    static const SluiceFormat formats[] = {SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK,
                                           SLUICE_FORMAT_BC6H_UFLOAT_BLOCK, SLUICE_FORMAT_R8_UNORM,
                                           SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    for (size_t i = 0; i < picture_shapes_count; i++)
        for (size_t k = 0; k < sizeof formats / sizeof formats[0]; k++)
            for (int s = 0; s < SCHEME_COUNT; s++) {
                struct picture picture = picture_shapes[i];
                picture.format = format_names_of(formats[k]);
                check_file(make_ktx2(&picture, schemes[s]), &picture, open_ktx2);
            }
}

/* The file says that the other levels are to be made by whoever reads it; there are none. */
static void no_levels_is_one_level(void **state)
{
    (void)state;
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC7_UNORM_BLOCK), 1, 1};
    struct file_bytes file = make_ktx2(&picture, 0);
    memset(file.bytes + 40, 0, 4);
    check_file(file, &picture, open_ktx2);
}

static void chains_that_lack_levels_are_delivered_as_they_are(void **state)
{
    (void)state;
    for (uint32_t count = 1; count < 6; count++) {
        struct picture picture = {format_names_of(SLUICE_FORMAT_R8G8B8A8_SRGB), 40, 20};
        picture.level_count = count;
        picture.layer_count = count;
        check_file(make_ktx2(&picture, 0), &picture, open_ktx2);
    }
}

static void a_format_of_the_same_bytes_can_be_asked_for(void **state)
{
    (void)state;
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC7_SRGB_BLOCK), 24, 24};
    check_renaming(make_ktx2(&picture, 0), &picture, open_ktx2, SLUICE_FORMAT_BC7_UNORM_BLOCK,
                   SLUICE_FORMAT_BC5_UNORM_BLOCK);
}

static void what_cannot_be_delivered_is_refused_with_a_reason(void **state)
{
    (void)state;
    static const struct refusal refusals[] = {
        {0, 0x20534444, SLUICE_ERROR_CORRUPT_DATA, "not a KTX2 file"},
        {4, 0xBB313120, SLUICE_ERROR_CORRUPT_DATA, "not a KTX2 file"},
        {12, 0, SLUICE_ERROR_UNSUPPORTED, "Basis Universal"},
        {12, 185, SLUICE_ERROR_UNSUPPORTED, "VkFormat 185"},
        {12, 165, SLUICE_ERROR_UNSUPPORTED, "another size than 4x4 and 8x8"},
        {12, 145, SLUICE_ERROR_CORRUPT_DATA, "its texels need"},
        {44, 1, SLUICE_ERROR_UNSUPPORTED, "transcode"},
        {44, 3, SLUICE_ERROR_UNSUPPORTED, "scheme 3"},
        {20, 0, SLUICE_ERROR_CORRUPT_DATA, "0 x 32"},
        {24, 0, SLUICE_ERROR_UNSUPPORTED, "1D"},
        {28, 1, SLUICE_ERROR_UNSUPPORTED, "volume"},
        {20, 0x100001, SLUICE_ERROR_UNSUPPORTED, "at most"},
        {20, 36, SLUICE_ERROR_CORRUPT_DATA, "its texels need"},
        {32, 2, SLUICE_ERROR_CORRUPT_DATA, "its texels need"},
        {32, 0xFFFFFFFFu, SLUICE_ERROR_UNSUPPORTED, "layers"},
        {36, 0, SLUICE_ERROR_CORRUPT_DATA, "0 faces"},
        {36, 5, SLUICE_ERROR_CORRUPT_DATA, "5 faces"},
        {36, 6, SLUICE_ERROR_CORRUPT_DATA, "its texels need"},
        {36, 6, SLUICE_ERROR_CORRUPT_DATA, "16 x 32 texels; faces", 20, 16},
        {40, 7, SLUICE_ERROR_CORRUPT_DATA, "has 7 levels"},
        {40, 0xFFFFFFFFu, SLUICE_ERROR_CORRUPT_DATA, "levels"},
        {80, 0, SLUICE_ERROR_CORRUPT_DATA, "lies outside"},
        {80, 0xFFFFFFF0u, SLUICE_ERROR_CORRUPT_DATA, "lies outside"},
        {84, 0x80000000u, SLUICE_ERROR_CORRUPT_DATA, "lies outside"},
        {84, 0xFFFFFFFFu, SLUICE_ERROR_CORRUPT_DATA, "lies outside"},
        {88, 8, SLUICE_ERROR_CORRUPT_DATA, "stored as 8"},
        {96, 8, SLUICE_ERROR_CORRUPT_DATA, "level 0 has 8 bytes"},
        {100, 1, SLUICE_ERROR_CORRUPT_DATA, "level 0 has"},
    };
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK), 32, 32};
    check_refusals(make_ktx2(&picture, 0), open_ktx2, refusals,
                   sizeof refusals / sizeof refusals[0]);
}

#ifdef TEST_HAS_ZSTD
static void compressed_levels_that_make_no_sense_are_refused(void **state)
{
    (void)state;
    static const struct refusal refusals[] = {
        {88, 0, SLUICE_ERROR_CORRUPT_DATA, "lies outside"},
        {88, 0xFFFFFF, SLUICE_ERROR_CORRUPT_DATA, "lies outside"},
        {92, 0x10000, SLUICE_ERROR_CORRUPT_DATA, "lies outside"},
        {88, 5, SLUICE_ERROR_CORRUPT_DATA, "level 0, 5 bytes"},
        {80, 80 + 24 * 6, SLUICE_ERROR_CORRUPT_DATA, "level 0"},
    };
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK), 32, 32};
    check_refusals(make_ktx2(&picture, 2), open_ktx2, refusals,
                   sizeof refusals / sizeof refusals[0]);
}

/* 2^22 bytes, which 60 cannot hold. */
static void a_bomb_is_refused_before_memory_is_asked_for(void **state)
{
    (void)state;
    struct picture picture = {format_names_of(SLUICE_FORMAT_R8_UNORM), 2048, 2048};
    struct file_bytes file = make_ktx2(&picture, 2);
    struct scratch scratch;
    struct log_tally tally;
    memcpy(file.bytes + 88, (uint8_t[8]){60}, 8);
    scratch_init(&scratch, &file);
    SluiceImageSource *source = open_ktx2(scratch.path, SLUICE_FORMAT_UNDEFINED, &tally);
    CHECK_RESULT(read_everything(source), SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(tally.last, "cannot have"));
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
    free(file.bytes);
}

/* Counts what is held; the most of it is what the bound speaks of. */
struct meter {
    pthread_mutex_t mutex;
    uint64_t live, most;
};

static void *meter_allocate(void *user, size_t size, size_t alignment)
{
    struct meter *meter = user;
    (void)alignment;
    pthread_mutex_lock(&meter->mutex);
    meter->live += size;
    meter->most = meter->live > meter->most ? meter->live : meter->most;
    pthread_mutex_unlock(&meter->mutex);
    return malloc(size);
}

static void meter_free(void *user, void *memory, size_t size)
{
    struct meter *meter = user;
    pthread_mutex_lock(&meter->mutex);
    meter->live -= size;
    pthread_mutex_unlock(&meter->mutex);
    free(memory);
}

/* Room for level 0 and little else, while every thread walks through all levels. */
static void decompressed_levels_stay_within_their_bound(void **state)
{
    (void)state;
    enum { THREADS = 4, LEVEL_0 = 256 * 256, BOUND = LEVEL_0 + LEVEL_0 / 8 };
    struct picture picture = {format_names_of(SLUICE_FORMAT_R8_UNORM), 256, 256};
    struct file_bytes file = make_ktx2(&picture, 2);
    struct meter meter = {PTHREAD_MUTEX_INITIALIZER};
    SluiceAllocationCallbacks callbacks = {&meter, meter_allocate, meter_free};
    struct scratch scratch;
    scratch_init(&scratch, &file);
    SluiceKtx2ImageSourceCreateInfo info = {.structSize = sizeof info,
                                            .pPath = scratch.path,
                                            .pAllocator = &callbacks,
                                            .maxCacheSize = BOUND};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateKtx2ImageSource(&info, &source));
    check_on_threads(source, &picture, THREADS);
    /* levels, and the compressed bytes of those on their way: random ones, as large */
    assert_true(meter.most <= 2 * BOUND + 8192);
    assert_true(meter.live <= BOUND + 8192);
    sluiceDestroyImageSource(source);
    assert_int_equal(meter.live, 0);
    info.maxCacheSize = LEVEL_0 - 1;
    struct log_tally tally = {.path = scratch.path};
    info.log = log_to(&tally);
    CHECK_OK(sluiceCreateKtx2ImageSource(&info, &source));
    CHECK_RESULT(read_everything(source), SLUICE_ERROR_UNSUPPORTED);
    assert_non_null(strstr(tally.last, "maxCacheSize is 65535"));
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
    free(file.bytes);
}
#else
static void compressed_files_are_refused_without_zstandard(void **state)
{
    (void)state;
    static const struct refusal refusal = {44, 2, SLUICE_ERROR_UNSUPPORTED, "does not have"};
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK), 32, 32};
    check_refusals(make_ktx2(&picture, 0), open_ktx2, &refusal, 1);
}
#endif

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    SluiceImageSource *source = NULL;
    SluiceKtx2ImageSourceCreateInfo info = {.structSize = sizeof info, .pPath = "x"};
    CHECK_RESULT(sluiceCreateKtx2ImageSource(NULL, &source), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCreateKtx2ImageSource(&info, NULL), SLUICE_ERROR_NULL_POINTER);
    info.format = SLUICE_FORMAT_COUNT;
    CHECK_RESULT(sluiceCreateKtx2ImageSource(&info, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    info = (SluiceKtx2ImageSourceCreateInfo){.structSize = sizeof(SluiceKtx2ImageSourceCreateInfo)};
    CHECK_RESULT(sluiceCreateKtx2ImageSource(&info, &source), SLUICE_ERROR_NULL_POINTER);
    assert_null(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_delivered_as_it_is),
        cmocka_unit_test(every_size_and_array_is_delivered),
        cmocka_unit_test(no_levels_is_one_level),
        cmocka_unit_test(chains_that_lack_levels_are_delivered_as_they_are),
        cmocka_unit_test(a_format_of_the_same_bytes_can_be_asked_for),
        cmocka_unit_test(what_cannot_be_delivered_is_refused_with_a_reason),
#ifdef TEST_HAS_ZSTD
        cmocka_unit_test(compressed_levels_that_make_no_sense_are_refused),
        cmocka_unit_test(a_bomb_is_refused_before_memory_is_asked_for),
        cmocka_unit_test(decompressed_levels_stay_within_their_bound),
#else
        cmocka_unit_test(compressed_files_are_refused_without_zstandard),
#endif
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
