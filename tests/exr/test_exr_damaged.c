/* Damaged files give an error or an image, and nothing worse. */
#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include <sluice/exr.h>

#include "base/checked.h"
#include "exr/exr_paths.h"
#include "support/test.h"

#include <openexr.h>

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file that the tests change, removed at the end. */
struct scratch {
    char path[64];
    int descriptor;
    unsigned char *bytes; ///< original bytes
    size_t size;
};

static void scratch_init(struct scratch *scratch, const char *name)
{
    char path[1024];
    FILE *file = fopen(own_file(name, path), "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    scratch->size = (size_t)ftell(file);
    rewind(file);
    scratch->bytes = malloc(scratch->size);
    assert_int_equal(fread(scratch->bytes, 1, scratch->size, file), scratch->size);
    fclose(file);
    strcpy(scratch->path, "/tmp/sluice-damaged-XXXXXX");
    scratch->descriptor = mkstemp(scratch->path);
    assert_true(scratch->descriptor >= 0);
    assert_int_equal(pwrite(scratch->descriptor, scratch->bytes, scratch->size, 0), scratch->size);
}

static void scratch_finish(struct scratch *scratch)
{
    close(scratch->descriptor);
    unlink(scratch->path);
    free(scratch->bytes);
}

static SluiceResult read_level(SluiceImageSource *source, const SluiceImageInfo *info,
                               uint32_t level)
{
    enum { STRIP = 128 };
    uint32_t width = slc_mip_size(info->width, level), height = slc_mip_size(info->height, level);
    size_t pitch = (size_t)width * sluiceGetFormatTexelSize(info->format);
    char *texels = malloc(pitch * STRIP);
    assert_non_null(texels);
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t y = 0; result == SLUICE_SUCCESS && y < height; y += STRIP) {
        SluiceImageRegion region = {level, 0, y, width, slc_min_u32(STRIP, height - y)};
        result = sluiceReadImageRegion(source, &region, texels, pitch);
    }
    free(texels);
    return result;
}

/* Opens a file and reads all of all levels; the first error, of which the log must tell. */
struct tally {
    int errors;
};

static void count_errors(void *user, SluiceLogSeverity severity, const char *text)
{
    struct tally *tally = user;
    tally->errors += severity == SLUICE_LOG_ERROR;
    for (; *text; text++)
        assert_true(*text != '\n' && *text != '\r');
}

static SluiceResult read_all(const char *path, SluiceFormat format)
{
    struct tally tally = {0};
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = path,
                                             .format = format,
                                             .log = {&tally, count_errors}};
    SluiceImageSource *source = NULL;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceCreateExrImageSource(&create, &source);
    if (result == SLUICE_SUCCESS) {
        CHECK_OK(sluiceGetImageInfo(source, &info));
        for (uint32_t l = 0; l < info.mipLevelCount && result == SLUICE_SUCCESS; l++)
            result = read_level(source, &info, l);
        sluiceDestroyImageSource(source);
    }
    assert_int_equal(result != SLUICE_SUCCESS, tally.errors > 0);
    return result;
}

static bool is_answer_to_damage(SluiceResult result)
{
    return result == SLUICE_SUCCESS || result == SLUICE_ERROR_CORRUPT_DATA ||
           result == SLUICE_ERROR_UNSUPPORTED;
}

/* Intact files in the collection of a kind that is not supported. */
static const char *const unsupported[] = {
    "asan_heap-oob_7f178ac80539_109_519f88e9ededfff61f535d6c9eb25a85_exr",      /* its channels */
    "asan_stack-oob_433d4f_436_bb29e6f88ad5f5b2f5f9b68a3655b1d8_exr",           /* DWA */
    "memory_DOS_2.1",                                                           /* 2^26.6 x 1 */
    "openexr_2.2.0_memory_allocation_error_3_exr",                              /* 2^29.9 x 1 */
    "poc-c9457552c1c04ea0f98154bc433a5f5d0421a7e705e6f396aba4339568473435_min", /* Y, RY, BY */
};

static bool is_unsupported(const char *name)
{
    for (size_t i = 0; i < sizeof unsupported / sizeof unsupported[0]; i++)
        if (strcmp(unsupported[i], name) == 0)
            return true;
    return false;
}

/* Newer versions of OpenEXRCore read DWA, and repair files that 3.1 calls damaged. */
static bool is_core_3_1(void)
{
    int major, minor, patch;
    const char *extra;
    exr_get_library_version(&major, &minor, &patch, &extra);
    return major == 3 && minor == 1;
}

static void every_damaged_file_is_refused_for_what_it_is(void **state)
{
    (void)state;
    char folder[1024], path[2048];
    if (!find_image("Damaged", folder))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", folder);
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory));) {
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        SluiceResult result = read_all(path, SLUICE_FORMAT_UNDEFINED);
        SluiceResult expected =
            is_unsupported(entry->d_name) ? SLUICE_ERROR_UNSUPPORTED : SLUICE_ERROR_CORRUPT_DATA;
        if (is_core_3_1() ? result != expected : !is_answer_to_damage(result))
            fail_msg("%s: %s", entry->d_name, sluiceGetResultName(result));
        count++;
    }
    closedir(directory);
    assert_true(count > 80);
}

static void a_file_cut_at_any_byte_is_an_error(void **state)
{
    (void)state;
    static const char *const names[] = {"scan_zip.exr", "mip_zip.exr",   "scan_piz.exr",
                                        "rip_wide.exr", "one_level.exr", "mip_one_texel.exr"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct scratch scratch;
        scratch_init(&scratch, names[i]);
        CHECK_OK(read_all(scratch.path, SLUICE_FORMAT_UNDEFINED));
        for (size_t size = scratch.size; size-- > 0;) {
            assert_int_equal(ftruncate(scratch.descriptor, (off_t)size), 0);
            SluiceResult result = read_all(scratch.path, SLUICE_FORMAT_UNDEFINED);
            if (result != SLUICE_ERROR_CORRUPT_DATA)
                fail_msg("%s cut at %zu: %s", names[i], size, sluiceGetResultName(result));
        }
        scratch_finish(&scratch);
    }
}

static void any_changed_byte_gives_an_error_or_an_image(void **state)
{
    (void)state;
    static const char *const names[] = {"scan_zip.exr",   "scan_pxr24.exr", "mip_one_texel.exr",
                                        "scan_piz.exr",   "mip_b44.exr",    "scan_rle.exr",
                                        "rip_wide.exr",   "mip_mixed.exr",  "multi_part.exr",
                                        "scan_depth.exr", "deep.exr"};
    enum { LIMIT = 1200 }; /* the header, the table and the first chunks */
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct scratch scratch;
        scratch_init(&scratch, names[i]);
        for (size_t at = 0; at < scratch.size && at < LIMIT; at++)
            for (int kind = 0; kind < 3; kind++) {
                unsigned char byte = kind == 0 ? 0xFF : kind == 1 ? 0 : scratch.bytes[at] ^ 0x81;
                assert_int_equal(pwrite(scratch.descriptor, &byte, 1, (off_t)at), 1);
                SluiceResult result = read_all(scratch.path, SLUICE_FORMAT_UNDEFINED);
                if (!is_answer_to_damage(result))
                    fail_msg("%s with %02x at %zu: %s", names[i], byte, at,
                             sluiceGetResultName(result));
                assert_int_equal(pwrite(scratch.descriptor, &scratch.bytes[at], 1, (off_t)at), 1);
            }
        scratch_finish(&scratch);
    }
}

static void a_file_that_shrinks_while_it_is_open_is_an_error(void **state)
{
    (void)state;
    static const char *const names[] = {"scan_none.exr", "mip_zip.exr", "rip_down.exr"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct scratch scratch;
        SluiceImageSource *source;
        scratch_init(&scratch, names[i]);
        SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                                 .pPath = scratch.path};
        CHECK_OK(sluiceCreateExrImageSource(&create, &source));
        assert_int_equal(ftruncate(scratch.descriptor, (off_t)scratch.size / 2), 0);
        SluiceImageInfo info = {.structSize = sizeof info};
        CHECK_OK(sluiceGetImageInfo(source, &info));
        SluiceResult result = SLUICE_SUCCESS;
        for (uint32_t level = 0; level < info.mipLevelCount && result == SLUICE_SUCCESS; level++)
            result = read_level(source, &info, level);
        assert_true(result == SLUICE_ERROR_CORRUPT_DATA || result == SLUICE_ERROR_IO);
        sluiceDestroyImageSource(source);
        scratch_finish(&scratch);
    }
}

/* Reading address 0 of /proc/self/mem is an I/O error, if that file exists. */
static void an_error_of_the_system_is_told_from_damage(void **state)
{
    (void)state;
    if (access("/proc/self/mem", R_OK) != 0)
        SKIP_TEST("there is no /proc/self/mem to make reading fail");
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = "/proc/self/mem"};
    SluiceImageSource *source;
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_IO);
}

/* The first tile decodes the whole file. An error must not be kept for good. */
static void a_file_that_is_mended_is_decoded_again(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch, "scan_zip.exr");
    size_t half = scratch.size / 2;
    char *zeros = calloc(1, half);
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = scratch.path};
    SluiceImageSource *source;
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_int_equal(pwrite(scratch.descriptor, zeros, half, (off_t)half), half);
    CHECK_RESULT(read_level(source, &info, 0), SLUICE_ERROR_CORRUPT_DATA);
    CHECK_RESULT(read_level(source, &info, 0), SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(pwrite(scratch.descriptor, scratch.bytes + half, half, (off_t)half), half);
    const struct timespec later[2] = {{2000000000, 0}, {2000000000, 0}}; /* a later clock tick */
    assert_int_equal(futimens(scratch.descriptor, later), 0);
    CHECK_OK(read_level(source, &info, 0));
    sluiceDestroyImageSource(source);
    free(zeros);
    scratch_finish(&scratch);
}

/* A header that promises more than its file can hold. */
static void absurd_sizes_are_refused_before_anything_is_allocated(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch, "scan_zip.exr");
    const char name[] = "dataWindow\0box2i";
    size_t at = 0;
    while (memcmp(scratch.bytes + at, name, sizeof name) != 0)
        at++;
    at += sizeof name + 4;
    static const int32_t windows[][4] = {
        {0, 0, 1 << 19, 1 << 19},         /* more than the file can hold */
        {0, 0, 1 << 20, 3},               /* wider than any texture */
        {-2147483647, -5, 2147483647, 5}, /* a width beyond 32 bits */
        {5, 5, 4, 9},                     /* nothing */
        {1000000000, 0, 1000000001, 20},  /* small, but far away: only the chunks are wrong */
    };
    for (size_t i = 0; i < sizeof windows / sizeof windows[0]; i++) {
        assert_int_equal(pwrite(scratch.descriptor, windows[i], 16, (off_t)at), 16);
        SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                                 .pPath = scratch.path};
        SluiceImageSource *source;
        SluiceResult result = sluiceCreateExrImageSource(&create, &source);
        if (i < 4) {
            assert_true(result == SLUICE_ERROR_CORRUPT_DATA || result == SLUICE_ERROR_UNSUPPORTED);
        } else if (result == SLUICE_SUCCESS) {
            sluiceDestroyImageSource(source);
            CHECK_RESULT(read_all(scratch.path, SLUICE_FORMAT_UNDEFINED),
                         SLUICE_ERROR_CORRUPT_DATA);
        }
    }
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_damaged_file_is_refused_for_what_it_is),
        cmocka_unit_test(a_file_cut_at_any_byte_is_an_error),
        cmocka_unit_test(any_changed_byte_gives_an_error_or_an_image),
        cmocka_unit_test(a_file_that_shrinks_while_it_is_open_is_an_error),
        cmocka_unit_test(an_error_of_the_system_is_told_from_damage),
        cmocka_unit_test(absurd_sizes_are_refused_before_anything_is_allocated),
        cmocka_unit_test(a_file_that_is_mended_is_decoded_again),
    };
    return RUN_TESTS(tests);
}
