/* Damaged files and failing systems give an error or the image, and nothing worse. */
#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include <sluice/dds.h>
#include <sluice/ktx2.h>
#include <sluice/loader.h>

#include "container/container_checks.h"
#include "support/failing_allocator.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The linker puts these in front of pread (--wrap), so that tests decide the system's answers. */
static struct {
    int fail_at;    ///< number, from 1, of the first read to fail; later reads fail too; 0: none
    int error;      ///< errno; 0: end of file
    int interrupts; ///< number of interrupted reads at first
    size_t most;    ///< most bytes per read; 0: all
    atomic_int count;
} disk;

ssize_t __real_pread(int descriptor, void *buffer, size_t size, off_t offset);
ssize_t __real_pread64(int descriptor, void *buffer, size_t size, off_t offset);
ssize_t __wrap_pread(int descriptor, void *buffer, size_t size, off_t offset);
ssize_t __wrap_pread64(int descriptor, void *buffer, size_t size, off_t offset);

/* Returns true if the test answers the read with `*answer`. Otherwise may reduce `*size`. */
static bool disk_answers(size_t *size, ssize_t *answer)
{
    disk.count++;
    if (disk.interrupts > 0) {
        disk.interrupts--;
        errno = EINTR;
        *answer = -1;
        return true;
    }
    if (disk.fail_at && disk.count >= disk.fail_at) {
        errno = disk.error;
        *answer = disk.error ? -1 : 0;
        return true;
    }
    if (disk.most && *size > disk.most)
        *size = disk.most;
    return false;
}

ssize_t __wrap_pread(int descriptor, void *buffer, size_t size, off_t offset)
{
    ssize_t answer;
    return disk_answers(&size, &answer) ? answer : __real_pread(descriptor, buffer, size, offset);
}

ssize_t __wrap_pread64(int descriptor, void *buffer, size_t size, off_t offset)
{
    ssize_t answer;
    return disk_answers(&size, &answer) ? answer : __real_pread64(descriptor, buffer, size, offset);
}

static SluiceResult create(const char *path, bool is_ktx2,
                           const SluiceAllocationCallbacks *allocator, struct log_tally *tally,
                           SluiceImageSource **source)
{
    *tally = (struct log_tally){.path = path};
    *source = NULL;
    SluiceDdsImageSourceCreateInfo dds = {
        .structSize = sizeof dds, .pPath = path, .pAllocator = allocator, .log = log_to(tally)};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {.structSize = sizeof ktx2,
                                            .pPath = path,
                                            .pAllocator = allocator,
                                            .log = log_to(tally),
                                            .maxCacheSize = 1 << 20};
    return is_ktx2 ? sluiceCreateKtx2ImageSource(&ktx2, source)
                   : sluiceCreateDdsImageSource(&dds, source);
}

/* Kinds of files. */
enum { DDS, DX10, KTX2, KTX2_ZSTD, KIND_COUNT };

static bool kind_is_built(int kind)
{
#ifdef TEST_HAS_ZSTD
    (void)kind;
    return true;
#else
    return kind != KTX2_ZSTD;
#endif
}

static struct file_bytes make_file(int kind, const struct picture *picture)
{
    static const uint32_t dxt5[7] = {0x4, 0x35545844};
    switch (kind) {
    case DDS: return make_old_dds(picture, dxt5);
    case DX10: return make_dds(picture);
    case KTX2: return make_ktx2(picture, 0);
    default: return make_ktx2(picture, 2);
    }
}

/* A small file of one kind. */
struct sample {
    struct picture picture;
    struct file_bytes file;
    struct scratch scratch;
};

/* Returns false if this build cannot make the file. */
static bool sample_init(struct sample *sample, int kind)
{
    const struct format_names *format = format_names_of(SLUICE_FORMAT_BC3_UNORM_BLOCK);
    if (!kind_is_built(kind))
        return false;
    sample->picture = (struct picture){format, 13, 9, kind == DDS ? 0 : 2};
    sample->file = make_file(kind, &sample->picture);
    scratch_init(&sample->scratch, &sample->file);
    return true;
}

static void sample_finish(struct sample *sample)
{
    scratch_finish(&sample->scratch);
    free(sample->file.bytes);
}

/* Reads a whole file. An error must be logged exactly once, success not at all. */
static SluiceResult read_file(const char *path, int kind)
{
    struct log_tally tally;
    SluiceImageSource *source;
    CHECK_OK(create(path, kind >= KTX2, NULL, &tally, &source));
    SluiceResult result = read_everything(source);
    sluiceDestroyImageSource(source);
    assert_int_equal(tally.errors, result != SLUICE_SUCCESS);
    return result;
}

static void a_file_cut_at_any_byte_is_an_error(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        struct sample s;
        if (!sample_init(&s, kind))
            continue;
        CHECK_OK(read_file(s.scratch.path, kind));
        for (size_t size = s.file.size; size-- > 0;) {
            assert_int_equal(ftruncate(s.scratch.descriptor, (off_t)size), 0);
            SluiceResult result = read_file(s.scratch.path, kind);
            if (result != SLUICE_ERROR_CORRUPT_DATA)
                fail_msg("kind %d cut at %zu: %s", kind, size, sluiceGetResultName(result));
        }
        sample_finish(&s);
    }
}

/* Returns whether a header byte affects neither the position nor the encoding of texels. */
static bool is_ignored(int kind, size_t at)
{
    if (kind >= KTX2)
        return (at >= 16 && at < 20) || (at >= 48 && at < 80); /* typeSize; places of metadata */
    if (kind == DX10 && ((at >= 88 && at < 108) || (at >= 112 && at < 128) || at >= 144))
        return true; /* bits, masks, old caps; alpha mode */
    if (kind == DDS && at >= 88 && at < 108)
        return true;
    return (at >= 20 && at < 24) || (at >= 32 && at < 76) || (at >= 108 && at < 112) ||
           (at >= 116 && at < 128);
}

static void check_changed_byte(const struct scratch *scratch, int kind, size_t at, uint8_t byte,
                               const struct picture *picture)
{
    struct log_tally tally;
    SluiceImageSource *source;
    CHECK_OK(create(scratch->path, kind >= KTX2, NULL, &tally, &source));
    SluiceResult result = read_everything(source);
    bool is_expected = result == SLUICE_SUCCESS || result == SLUICE_ERROR_CORRUPT_DATA ||
                       result == SLUICE_ERROR_UNSUPPORTED;
    if (!is_expected || (is_ignored(kind, at) && result != SLUICE_SUCCESS))
        fail_msg("kind %d, %02x at %zu: %s", kind, byte, at, sluiceGetResultName(result));
    assert_int_equal(tally.errors, result != SLUICE_SUCCESS);
    if (is_ignored(kind, at))
        check_picture(source, picture);
    sluiceDestroyImageSource(source);
}

static void any_changed_byte_of_a_header_gives_an_error_or_an_image(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        struct sample s;
        if (!sample_init(&s, kind))
            continue;
        size_t end = kind == KTX2_ZSTD ? s.file.size : s.file.header_size;
        for (size_t at = 0; at < end; at++)
            for (int change = 0; change < 11; change++) {
                uint8_t old = s.file.bytes[at];
                uint8_t byte = change < 8    ? old ^ 1u << change
                               : change == 8 ? 0xFF
                               : change == 9 ? 0
                                             : old ^ 0x81;
                assert_int_equal(pwrite(s.scratch.descriptor, &byte, 1, (off_t)at), 1);
                check_changed_byte(&s.scratch, kind, at, byte, &s.picture);
                assert_int_equal(pwrite(s.scratch.descriptor, &old, 1, (off_t)at), 1);
            }
        sample_finish(&s);
    }
}

static void nothing_is_opened_before_it_is_asked_for(void **state)
{
    (void)state;
    for (int kind = DX10; kind <= KTX2; kind++) {
        struct sample s;
        assert_true(sample_init(&s, kind));
        struct log_tally tally;
        SluiceImageSource *source;
        unlink(s.scratch.path);
        disk.count = 0;
        CHECK_OK(create(s.scratch.path, kind == KTX2, NULL, &tally, &source));
        assert_int_equal(disk.count, 0);
        CHECK_RESULT(read_everything(source), SLUICE_ERROR_FILE_NOT_FOUND);
        CHECK_RESULT(read_everything(source), SLUICE_ERROR_FILE_NOT_FOUND);
        assert_int_equal(tally.errors, 1);         /* logged once */
        FILE *again = fopen(s.scratch.path, "wb"); /* files come and go */
        assert_int_equal(fwrite(s.file.bytes, 1, s.file.size, again), s.file.size);
        fclose(again);
        check_picture(source, &s.picture);
        unlink(s.scratch.path); /* an open file stays readable */
        check_picture(source, &s.picture);
        sluiceDestroyImageSource(source);
        sample_finish(&s);
    }
}

static void what_is_no_file_is_an_error_of_the_system(void **state)
{
    (void)state;
    char folder[] = "/tmp/sluice-folder-XXXXXX", pipe_name[64];
    assert_non_null(mkdtemp(folder));
    snprintf(pipe_name, sizeof pipe_name, "%s/pipe", folder);
    assert_int_equal(mkfifo(pipe_name, 0600), 0);
    for (int kind = DX10; kind <= KTX2; kind++) {
        CHECK_RESULT(read_file(folder, kind), SLUICE_ERROR_IO);
        CHECK_RESULT(read_file(pipe_name, kind), SLUICE_ERROR_IO); /* and does not hang */
        char below[128];
        snprintf(below, sizeof below, "%s/x", pipe_name);
        CHECK_RESULT(read_file(below, kind), SLUICE_ERROR_FILE_NOT_FOUND);
    }
    unlink(pipe_name);
    rmdir(folder);
}

static void a_file_that_shrinks_while_it_is_open_is_an_error(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        struct sample s;
        if (!sample_init(&s, kind))
            continue;
        struct log_tally tally;
        SluiceImageSource *source;
        SluiceImageInfo info = {.structSize = sizeof info};
        CHECK_OK(create(s.scratch.path, kind >= KTX2, NULL, &tally, &source));
        CHECK_OK(sluiceGetImageInfo(source, &info));
        assert_int_equal(ftruncate(s.scratch.descriptor, (off_t)s.file.size - 1), 0);
        CHECK_RESULT(read_everything(source), SLUICE_ERROR_IO);
        assert_non_null(strstr(tally.last, "shorter"));
        scratch_replace(&s.scratch, s.file.bytes, s.file.size);
        check_picture(source, &s.picture);
        sluiceDestroyImageSource(source);
        sample_finish(&s);
    }
}

/* Fails read 1, 2, ... in turn, until the file needs fewer reads. */
static void every_failing_read_is_told_from_damage(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        struct sample s;
        if (!sample_init(&s, kind))
            continue;
        SluiceResult result = SLUICE_ERROR_IO;
        int n = 0;
        for (; result == SLUICE_ERROR_IO; n++) {
            disk.count = 0;
            disk.fail_at = n + 1;
            disk.error = n % 2 ? EIO : ESTALE;
            result = read_file(s.scratch.path, kind);
        }
        disk.fail_at = 0;
        CHECK_OK(result);
        assert_true(n > 5);
        sample_finish(&s);
    }
}

static void what_passes_by_itself_is_no_failure_of_the_file(void **state)
{
    (void)state;
    static const struct {
        int error;
        SluiceResult result;
    } cases[] = {{ENOMEM, SLUICE_ERROR_OUT_OF_HOST_MEMORY}, {EAGAIN, SLUICE_NOT_READY}};
    for (int i = 0; i < 2; i++) {
        struct sample s;
        assert_true(sample_init(&s, DX10));
        disk.count = 0;
        disk.fail_at = 1;
        disk.error = cases[i].error;
        CHECK_RESULT(read_file(s.scratch.path, DX10), cases[i].result);
        disk.fail_at = 0;
        sample_finish(&s);
    }
}

/* Reads all sources through a loader. Returns how many succeeded. */
static uint32_t load_all(SluiceTileLoader *loader, SluiceImageSource *const *sources,
                         uint32_t count)
{
    static uint8_t texels[64][256];
    const SluiceImageRegion last = {3, 0, 0, 1, 1, 0};
    uint32_t delivered = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint64_t ticket;
        void *to = texels[i];
        SluiceTileRead read = {
            .source = sources[i], .regionCount = 1, .pRegions = &last, .ppTexels = &to};
        CHECK_OK(sluiceSubmitTileRead(loader, &read, &ticket));
    }
    sluiceWaitTileLoaderIdle(loader);
    for (uint32_t i = 0; i < count; i++) {
        SluiceTileReadResult result;
        uint32_t one = 1;
        assert_true(sluiceCollectTileReads(loader, &one, &result) >= 0 && one == 1);
        delivered += result.result == SLUICE_SUCCESS;
        if (result.result != SLUICE_SUCCESS)
            CHECK_RESULT(result.result, SLUICE_NOT_READY); /* no error is permanent */
    }
    return delivered;
}

static void files_beyond_the_limit_of_descriptors_are_read_later(void **state)
{
    (void)state;
    enum { COUNT = 30, ROOM = 5 };
    struct sample s;
    struct log_tally tallies[COUNT]; /* one each: two threads log at once */
    struct few_descriptors few;
    SluiceImageSource *sources[COUNT];
    SluiceTileLoader *loader;
    const SluiceTileLoaderCreateInfo info = {
        .structSize = sizeof info, .threadCount = 2, .retry = {2, 1, 1}};
    assert_true(sample_init(&s, DX10));
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(create(s.scratch.path, false, NULL, &tallies[i], &sources[i]));
    CHECK_OK(sluiceCreateTileLoader(&info, &loader));
    few_descriptors_begin(&few, FEW_DESCRIPTORS_LIMIT / 4 + ROOM);
    uint32_t first = load_all(loader, sources, COUNT);
    uint32_t again = load_all(loader, sources, COUNT); /* open files stay open */
    int output = dup(STDERR_FILENO);                   /* other files find descriptors */
    few_descriptors_end(&few);
    assert_int_equal(first, ROOM);
    assert_int_equal(again, ROOM);
    assert_true(output >= 0);
    close(output);
    assert_int_equal(load_all(loader, sources, COUNT), COUNT);
    sluiceDestroyTileLoader(loader);
    for (uint32_t i = 0; i < COUNT; i++)
        sluiceDestroyImageSource(sources[i]);
    sample_finish(&s);
}

static void short_and_interrupted_reads_are_continued(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        struct sample s;
        if (!sample_init(&s, kind))
            continue;
        struct log_tally tally;
        SluiceImageSource *source;
        CHECK_OK(create(s.scratch.path, kind >= KTX2, NULL, &tally, &source));
        disk.most = 7;
        disk.interrupts = 20;
        check_picture(source, &s.picture);
        disk.most = 0;
        sluiceDestroyImageSource(source);
        sample_finish(&s);
    }
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        struct sample s;
        if (!sample_init(&s, kind))
            continue;
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        uint64_t n = 0;
        for (; result != SLUICE_SUCCESS; n++) {
            struct failing_allocator a;
            struct log_tally tally;
            SluiceImageSource *source;
            failing_allocator_init(&a, n);
            result = create(s.scratch.path, kind >= KTX2, &a.callbacks, &tally, &source);
            if (result == SLUICE_SUCCESS)
                result = read_everything(source);
            if (result != SLUICE_SUCCESS)
                CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            if (source && result != SLUICE_SUCCESS) { /* later there is memory again */
                a.refuse_from = UINT64_MAX;
                check_picture(source, &s.picture);
            }
            sluiceDestroyImageSource(source);
            assert_int_equal(a.live_bytes, 0);
            assert_true(n < 100);
        }
        assert_true(n > (kind == KTX2_ZSTD ? 4 : 2));
        sample_finish(&s);
    }
}

static void any_number_of_threads_may_open_and_read(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        if (!kind_is_built(kind))
            continue;
        struct picture picture = {format_names_of(SLUICE_FORMAT_BC3_UNORM_BLOCK), 130, 99};
        struct file_bytes file = make_file(kind, &picture);
        struct scratch scratch;
        struct log_tally tally;
        SluiceImageSource *source;
        scratch_init(&scratch, &file);
        CHECK_OK(create(scratch.path, kind >= KTX2, NULL, &tally, &source));
        check_on_threads(source, &picture, 6);
        sluiceDestroyImageSource(source);
        scratch_finish(&scratch);
        free(file.bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_cut_at_any_byte_is_an_error),
        cmocka_unit_test(any_changed_byte_of_a_header_gives_an_error_or_an_image),
        cmocka_unit_test(nothing_is_opened_before_it_is_asked_for),
        cmocka_unit_test(what_is_no_file_is_an_error_of_the_system),
        cmocka_unit_test(a_file_that_shrinks_while_it_is_open_is_an_error),
        cmocka_unit_test(every_failing_read_is_told_from_damage),
        cmocka_unit_test(short_and_interrupted_reads_are_continued),
        cmocka_unit_test(every_refused_allocation_is_survived),
        cmocka_unit_test(any_number_of_threads_may_open_and_read),
        cmocka_unit_test(what_passes_by_itself_is_no_failure_of_the_file),
        cmocka_unit_test(files_beyond_the_limit_of_descriptors_are_read_later),
    };
    return RUN_TESTS(tests);
}
