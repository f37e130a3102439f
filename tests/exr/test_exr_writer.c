/* The writer stores the source's texels, or writes no file. */
#define _XOPEN_SOURCE 700

#include <sluice/exr.h>

#include "base/checked.h"
#include "exr/plain_exr.h"
#include "image/convert.h"
#include "image/half.h"
#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/test.h"

#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* A folder of the test's own, so that remaining files show. */
struct folder {
    char path[64];
    char file[96];
};

static void folder_init(struct folder *folder)
{
    strcpy(folder->path, "/tmp/sluice-writer-XXXXXX");
    assert_non_null(mkdtemp(folder->path));
    snprintf(folder->file, sizeof folder->file, "%s/written.exr", folder->path);
}

static int count_files(const struct folder *folder)
{
    DIR *directory = opendir(folder->path);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory));)
        count += entry->d_name[0] != '.';
    closedir(directory);
    return count;
}

static void folder_finish(struct folder *folder)
{
    unlink(folder->file);
    assert_int_equal(rmdir(folder->path), 0);
}

static void color(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user;
    uint32_t hash = (x * 73856093u) ^ (y * 19349663u) ^ (level * 83492791u) ^ (width + height);
    rgba[0] = (float)(hash % 1000) / 999.0f;
    rgba[1] = (float)x / (float)width;
    rgba[2] = (float)y / (float)height;
    rgba[3] = (float)(hash >> 16 & 255) / 255.0f;
}

static void wild_color(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                       uint32_t height, float rgba[4])
{
    static const float values[] = {1e30f, -1e30f, 65504.0f, -65519.0f, 1e-8f, -0.0f, 3.0f};
    (void)user, (void)level, (void)width, (void)height;
    for (uint32_t c = 0; c < 4; c++)
        rgba[c] = (x + y + c) % 8 == 7 ? NAN : values[(x + 2 * y + 3 * c) % 7];
}

static SluiceImageSource *create_source(uint32_t width, uint32_t height, SluiceFormat format,
                                        bool is_wild)
{
    SluiceProceduralImage image = {NULL, is_wild ? wild_color : color};
    SluiceImageInfo info = {sizeof info, width, height, 0, format, "writer test"};
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    return source;
}

/* Expected halves of one row of a level. */
static void expected_row(SluiceImageSource *source, const SluiceImageInfo *info, uint32_t level,
                         uint32_t y, uint16_t (*halves)[4], uint32_t width)
{
    SluiceImageRegion region = {level, 0, y, width, 1};
    size_t size = sluiceGetFormatTexelSize(info->format);
    char *texels = malloc(width * size);
    float(*rgba)[4] = malloc(width * sizeof *rgba);
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, width * size));
    slc_texels_to_rgba(info->format, texels, rgba[0], width);
    for (uint32_t x = 0; x < width; x++)
        for (int c = 0; c < 4; c++)
            halves[x][c] = slc_half_from_float(rgba[x][c]);
    free(texels);
    free(rgba);
}

static void check_file(const char *path, SluiceImageSource *source, const char *names)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    for (uint32_t level = 0; level < info.mipLevelCount; level++) {
        struct plain_level plain;
        assert_true(plain_exr_read(path, (int)level, &plain));
        assert_int_equal(plain.width, slc_mip_size(info.width, level));
        assert_int_equal(plain.height, slc_mip_size(info.height, level));
        assert_int_equal(plain.channel_count, strlen(names));
        uint16_t(*halves)[4] = malloc(plain.width * sizeof *halves);
        for (uint32_t y = 0; y < plain.height; y++) {
            expected_row(source, &info, level, y, halves, plain.width);
            for (const char *name = names; *name; name++) {
                const struct plain_channel *channel =
                    plain_exr_find(&plain, (char[2]){*name, '\0'});
                int component = *name == 'Y' ? 0 : (int)(strchr("RGBA", *name) - "RGBA");
                assert_non_null(channel);
                for (uint32_t x = 0; x < plain.width; x++)
                    assert_int_equal(((uint16_t *)channel->texels)[y * plain.width + x],
                                     halves[x][component]);
            }
        }
        free(halves);
        plain_exr_free(&plain);
    }
}

static void files_hold_every_level_of_the_source(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height, tile_width, tile_height, threads;
        SluiceFormat format;
        bool uncompressed, opaque;
        const char *names;
    } cases[] = {
        {300, 133, 0, 0, 1, SLUICE_FORMAT_R16G16B16A16_SFLOAT, false, false, "RGBA"},
        {300, 133, 0, 0, 3, SLUICE_FORMAT_R16G16B16A16_SFLOAT, true, true, "RGB"},
        {257, 67, 32, 16, 4, SLUICE_FORMAT_R8G8B8A8_SRGB, false, false, "RGBA"},
        {61, 200, 17, 29, 2, SLUICE_FORMAT_R8G8B8A8_UNORM, true, true, "RGB"},
        {129, 127, 64, 64, 2, SLUICE_FORMAT_R32G32B32A32_SFLOAT, false, true, "RGB"},
        {100, 1, 7, 3, 3, SLUICE_FORMAT_R16_SFLOAT, false, false, "Y"},
        {1, 90, 128, 128, 1, SLUICE_FORMAT_R32_SFLOAT, true, false, "Y"},
        {33, 47, 16, 16, 2, SLUICE_FORMAT_R32G32_SFLOAT, false, true, "RG"},
        {19, 3, 8, 8, 2, SLUICE_FORMAT_R16G16_SFLOAT, true, false, "RG"},
        {64, 64, 64, 64, 2, SLUICE_FORMAT_R8_UNORM, false, false, "Y"},
        {1, 1, 0, 0, 2, SLUICE_FORMAT_R16G16B16A16_SFLOAT, false, false, "RGBA"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct folder folder;
        folder_init(&folder);
        SluiceImageSource *source =
            create_source(cases[i].width, cases[i].height, cases[i].format, false);
        SluiceExrWriteInfo info = {.structSize = sizeof info,
                                   .pPath = folder.file,
                                   .tileWidth = cases[i].tile_width,
                                   .tileHeight = cases[i].tile_height,
                                   .threadCount = cases[i].threads,
                                   .uncompressed = cases[i].uncompressed,
                                   .opaque = cases[i].opaque};
        CHECK_OK(sluiceWriteExrFile(&info, source));
        assert_int_equal(count_files(&folder), 1);
        check_file(folder.file, source, cases[i].names);
        sluiceDestroyImageSource(source);
        folder_finish(&folder);
    }
}

static void our_own_reader_gives_back_the_same_texels(void **state)
{
    (void)state;
    struct folder folder;
    folder_init(&folder);
    SluiceImageSource *source = create_source(211, 99, SLUICE_FORMAT_R16G16B16A16_SFLOAT, false),
                      *read;
    SluiceExrWriteInfo info = {
        .structSize = sizeof info, .pPath = folder.file, .tileWidth = 32, .tileHeight = 64};
    CHECK_OK(sluiceWriteExrFile(&info, source));
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = folder.file};
    CHECK_OK(sluiceCreateExrImageSource(&create, &read));
    for (uint32_t level = 0; level < 8; level++) {
        SluiceImageRegion region = {level, 0, 0, slc_mip_size(211, level), slc_mip_size(99, level)};
        static char a[211 * 99 * 8], b[211 * 99 * 8];
        CHECK_OK(sluiceReadImageRegion(source, &region, a, region.width * 8));
        CHECK_OK(sluiceReadImageRegion(read, &region, b, region.width * 8));
        assert_memory_equal(a, b, (size_t)region.width * region.height * 8);
    }
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(read);
    folder_finish(&folder);
}

static void wide_values_saturate_and_nan_becomes_zero(void **state)
{
    (void)state;
    struct folder folder;
    folder_init(&folder);
    SluiceImageSource *source = create_source(40, 24, SLUICE_FORMAT_R32G32B32A32_SFLOAT, true);
    SluiceExrWriteInfo info = {.structSize = sizeof info, .pPath = folder.file};
    CHECK_OK(sluiceWriteExrFile(&info, source));
    check_file(folder.file, source, "RGBA"); /* expects slc_half_from_float of each */
    sluiceDestroyImageSource(source);
    folder_finish(&folder);
}

static void half_sources_keep_their_bits(void **state)
{
    (void)state;
    struct folder folder;
    static uint16_t halves[65536];
    folder_init(&folder);
    for (uint32_t i = 0; i < 65536; i++)
        halves[i] = (uint16_t)i;
    SluiceImageInfo image = {sizeof image, 256, 256, 0, SLUICE_FORMAT_R16_SFLOAT, "all halves"};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateMemoryImageSource(halves, &image, NULL, &source));
    SluiceExrWriteInfo info = {.structSize = sizeof info, .pPath = folder.file, .threadCount = 2};
    CHECK_OK(sluiceWriteExrFile(&info, source));
    struct plain_level plain;
    assert_true(plain_exr_read(folder.file, 0, &plain));
    assert_memory_equal(plain.channels[0].texels, halves, sizeof halves);
    plain_exr_free(&plain);
    sluiceDestroyImageSource(source);
    folder_finish(&folder);
}

struct progress {
    uint64_t last, total, stop_at;
    int calls;
};

static bool on_progress(void *user, uint64_t done, uint64_t total)
{
    struct progress *progress = user;
    assert_true(done > progress->last && done <= total);
    progress->last = done;
    progress->total = total;
    progress->calls++;
    return !progress->stop_at || done < progress->stop_at;
}

static void progress_rises_to_the_total(void **state)
{
    (void)state;
    struct folder folder;
    struct progress progress = {0};
    folder_init(&folder);
    SluiceImageSource *source = create_source(100, 100, SLUICE_FORMAT_R8_UNORM, false);
    SluiceExrWriteInfo info = {.structSize = sizeof info,
                               .pPath = folder.file,
                               .tileWidth = 16,
                               .tileHeight = 16,
                               .threadCount = 3,
                               .pUserData = &progress,
                               .pfnProgress = on_progress};
    CHECK_OK(sluiceWriteExrFile(&info, source));
    assert_int_equal(progress.total, 10000 + 2500 + 625 + 144 + 36 + 9 + 1);
    assert_int_equal(progress.last, progress.total);
    sluiceDestroyImageSource(source);
    folder_finish(&folder);
}

static void stopping_leaves_what_was_there_before(void **state)
{
    (void)state;
    struct folder folder;
    folder_init(&folder);
    FILE *file = fopen(folder.file, "w");
    fputs("older", file);
    fclose(file);
    SluiceImageSource *source = create_source(300, 300, SLUICE_FORMAT_R8_UNORM, false);
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        struct progress progress = {.stop_at = 50000};
        SluiceExrWriteInfo info = {.structSize = sizeof info,
                                   .pPath = folder.file,
                                   .threadCount = threads,
                                   .pUserData = &progress,
                                   .pfnProgress = on_progress};
        CHECK_RESULT(sluiceWriteExrFile(&info, source), SLUICE_ERROR_CANCELED);
        assert_int_equal(count_files(&folder), 1);
    }
    char text[8] = {0};
    file = fopen(folder.file, "r");
    assert_non_null(fgets(text, sizeof text, file));
    fclose(file);
    assert_string_equal(text, "older");
    SluiceExrWriteInfo info = {.structSize = sizeof info, .pPath = folder.file};
    CHECK_OK(sluiceWriteExrFile(&info, source));
    check_file(folder.file, source, "Y");
    sluiceDestroyImageSource(source);
    folder_finish(&folder);
}

static bool kill_after_some(void *user, uint64_t done, uint64_t total)
{
    (void)user;
    (void)total;
    if (done > 50000)
        raise(SIGKILL);
    return true;
}

static void killed_writers_leave_one_part_file_that_the_next_takes_over(void **state)
{
    (void)state;
    struct folder folder;
    folder_init(&folder);
    SluiceImageSource *source = create_source(300, 300, SLUICE_FORMAT_R8_UNORM, false);
    SluiceExrWriteInfo info = {.structSize = sizeof info, .pPath = folder.file};
    for (int i = 0; i < 3; i++) {
        int status;
        pid_t child = fork();
        if (child == 0) {
            info.pfnProgress = kill_after_some;
            sluiceWriteExrFile(&info, source);
            _exit(1);
        }
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status));
        assert_int_equal(count_files(&folder), 1);
    }
    CHECK_OK(sluiceWriteExrFile(&info, source));
    assert_int_equal(count_files(&folder), 1);
    check_file(folder.file, source, "Y");
    sluiceDestroyImageSource(source);
    folder_finish(&folder);
}

static void failures_of_the_source_are_passed_on_and_leave_no_file(void **state)
{
    (void)state;
    struct folder folder;
    folder_init(&folder);
    SluiceImageSource *inner = create_source(200, 200, SLUICE_FORMAT_R8_UNORM, false);
    for (uint32_t threads = 1; threads <= 3; threads++)
        for (uint64_t n = 1; n <= 12; n++) { /* there are 4 + 1 * 7 tiles */
            struct fault_source source;
            fault_source_init(&source, inner);
            source.fail_at = n;
            source.failure = n == 2 ? SLUICE_NOT_READY : SLUICE_ERROR_DEVICE_LOST;
            source.is_short = true;
            SluiceExrWriteInfo info = {
                .structSize = sizeof info, .pPath = folder.file, .threadCount = threads};
            SluiceResult expected = n > 11 ? SLUICE_SUCCESS : source.failure;
            CHECK_RESULT(sluiceWriteExrFile(&info, &source.base), expected);
            assert_int_equal(count_files(&folder), n > 11);
            unlink(folder.file);
            fault_source_finish(&source);
        }
    sluiceDestroyImageSource(inner);
    folder_finish(&folder);
}

static void a_full_disk_is_an_io_error_and_leaves_no_file(void **state)
{
    (void)state;
    struct folder folder;
    struct rlimit old, low;
    folder_init(&folder);
    SluiceImageSource *source = create_source(200, 200, SLUICE_FORMAT_R16G16B16A16_SFLOAT, false);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    signal(SIGXFSZ, SIG_IGN);
    static const rlim_t limits[] = {0, 100, 400, 5000, 150000, 300000};
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++) {
        SluiceExrWriteInfo info = {.structSize = sizeof info,
                                   .pPath = folder.file,
                                   .uncompressed = true,
                                   .threadCount = 2};
        low = old;
        low.rlim_cur = limits[i];
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &low), 0);
        SluiceResult result = sluiceWriteExrFile(&info, source);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        CHECK_RESULT(result, SLUICE_ERROR_IO);
        assert_int_equal(count_files(&folder), 0);
    }
    signal(SIGXFSZ, SIG_DFL);
    sluiceDestroyImageSource(source);
    folder_finish(&folder);
}

static void every_refused_allocation_is_a_result_and_leaves_nothing(void **state)
{
    (void)state;
    struct folder folder;
    folder_init(&folder);
    SluiceImageSource *source = create_source(50, 50, SLUICE_FORMAT_R8_UNORM, false);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        assert_true(n < 100);
        failing_allocator_init(&allocator, n);
        SluiceExrWriteInfo info = {
            .structSize = sizeof info, .pPath = folder.file, .pAllocator = &allocator.callbacks};
        result = sluiceWriteExrFile(&info, source);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(count_files(&folder), result == SLUICE_SUCCESS);
        assert_int_equal(allocator.live_bytes, 0);
    }
    sluiceDestroyImageSource(source);
    folder_finish(&folder);
}

struct wrong_source {
    SluiceImageSource base;
    uint32_t number;
};

static SluiceResult get_wrong_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    static const SluiceImageInfo wrong[] = {
        {sizeof(SluiceImageInfo), 0, 4, 3, SLUICE_FORMAT_R8_UNORM, "empty"},
        {sizeof(SluiceImageInfo), 4, 4, 1, SLUICE_FORMAT_R8_UNORM, "few levels"},
        {sizeof(SluiceImageInfo), 4, 4, 3, SLUICE_FORMAT_UNDEFINED, "no format"}};
    *info = wrong[((struct wrong_source *)source)->number];
    return SLUICE_SUCCESS;
}

static void sources_without_a_full_chain_are_refused(void **state)
{
    (void)state;
    static const SluiceImageSourceInterface interface = {sizeof interface, get_wrong_info, NULL,
                                                         NULL};
    struct wrong_source source = {{&interface}, 0};
    SluiceExrWriteInfo info = {.structSize = sizeof info, .pPath = "/no such folder/x.exr"};
    for (; source.number < 3; source.number++)
        CHECK_RESULT(sluiceWriteExrFile(&info, &source.base), SLUICE_ERROR_INVALID_ARGUMENT);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    SluiceImageSource *source = create_source(5, 5, SLUICE_FORMAT_R8_UNORM, false);
    SluiceExrWriteInfo info = {.structSize = sizeof info, .pPath = "/no such folder/x.exr"};
    CHECK_RESULT(sluiceWriteExrFile(&info, source), SLUICE_ERROR_IO);
    CHECK_RESULT(sluiceWriteExrFile(NULL, source), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceWriteExrFile(&info, NULL), SLUICE_ERROR_NULL_POINTER);
    info.tileWidth = 1 << 20;
    CHECK_RESULT(sluiceWriteExrFile(&info, source), SLUICE_ERROR_INVALID_ARGUMENT);
    info.pPath = NULL;
    CHECK_RESULT(sluiceWriteExrFile(&info, source), SLUICE_ERROR_NULL_POINTER);
    sluiceDestroyImageSource(source);
    info = (SluiceExrWriteInfo){.structSize = sizeof(SluiceExrWriteInfo),
                                .pPath = "/no such folder/x.exr",
                                .tileWidth = 1,
                                .tileHeight = 1};
    source = create_source(1 << 20, 1 << 13, SLUICE_FORMAT_R8_UNORM, false);
    CHECK_RESULT(sluiceWriteExrFile(&info, source), SLUICE_ERROR_LIMIT_EXCEEDED);
    sluiceDestroyImageSource(source);
    source = create_source((1 << 20) + 1, 1, SLUICE_FORMAT_R8_UNORM, false);
    CHECK_RESULT(sluiceWriteExrFile(&info, source), SLUICE_ERROR_UNSUPPORTED);
    sluiceDestroyImageSource(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_hold_every_level_of_the_source),
        cmocka_unit_test(our_own_reader_gives_back_the_same_texels),
        cmocka_unit_test(wide_values_saturate_and_nan_becomes_zero),
        cmocka_unit_test(half_sources_keep_their_bits),
        cmocka_unit_test(progress_rises_to_the_total),
        cmocka_unit_test(stopping_leaves_what_was_there_before),
        cmocka_unit_test(killed_writers_leave_one_part_file_that_the_next_takes_over),
        cmocka_unit_test(failures_of_the_source_are_passed_on_and_leave_no_file),
        cmocka_unit_test(a_full_disk_is_an_io_error_and_leaves_no_file),
        cmocka_unit_test(every_refused_allocation_is_a_result_and_leaves_nothing),
        cmocka_unit_test(sources_without_a_full_chain_are_refused),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
