/* Files of a pool: a bounded number is open, all can be read, and another file is not mistaken. */
#define _XOPEN_SOURCE 700

#include "image/file_pool.h"

#include "base/alloc.h"
#include "image/input_file.h"
#include "support/failing_allocator.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILE_COUNT = 40, FILE_SIZE = 64 };

struct fixture {
    char folder[64];
    char paths[FILE_COUNT][96];
    SluiceFilePool *pool;
    struct slc_input_file files[FILE_COUNT];
    atomic_int errors;
    char last[1024];
};

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    if (severity != SLUICE_LOG_ERROR)
        return;
    f->errors++;
    snprintf(f->last, sizeof f->last, "%s", message);
}

/* Returns a byte that identifies the file and the offset. */
static uint8_t byte_at(uint32_t file, uint64_t offset)
{
    return (uint8_t)(file * 31 + offset * 7);
}

static void write_file(const char *path, uint32_t file, size_t size)
{
    uint8_t bytes[FILE_SIZE + 1];
    for (uint32_t i = 0; i < sizeof bytes; i++)
        bytes[i] = byte_at(file, i);
    int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, bytes, size), size);
    close(descriptor);
}

static void setup(struct fixture *f, uint32_t max_open)
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    SluiceLogCallback log = {f, on_log};
    SluiceFilePoolCreateInfo info = {.structSize = sizeof info, .maxOpenFileCount = max_open};
    memset(f, 0, sizeof *f);
    strcpy(f->folder, "/tmp/sluice-pool-XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    CHECK_OK(sluiceCreateFilePool(&info, &f->pool));
    for (uint32_t i = 0; i < FILE_COUNT; i++) {
        snprintf(f->paths[i], sizeof f->paths[i], "%s/%u", f->folder, i);
        write_file(f->paths[i], i, FILE_SIZE);
        struct slc_input_choice choice = {f->paths[i], NULL, f->pool};
        CHECK_OK(slc_input_file_init_choice(&f->files[i], &choice, &cb, &log));
    }
}

static void teardown(struct fixture *f)
{
    for (uint32_t i = 0; i < FILE_COUNT; i++) {
        slc_input_file_finish(&f->files[i]);
        unlink(f->paths[i]);
    }
    sluiceDestroyFilePool(f->pool);
    assert_int_equal(rmdir(f->folder), 0);
}

static SluiceFilePoolStatistics statistics_of(struct fixture *f)
{
    SluiceFilePoolStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetFilePoolStatistics(f->pool, &statistics));
    return statistics;
}

/* Reads a file, checks its bytes and returns the result. */
static SluiceResult read_file(struct fixture *f, uint32_t file)
{
    uint8_t bytes[8];
    SluiceResult result = slc_input_file_open(&f->files[file]);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_read(&f->files[file], 5, bytes, sizeof bytes);
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < sizeof bytes; i++)
        assert_int_equal(bytes[i], byte_at(file, 5 + i));
    return result;
}

static uint32_t count_descriptors(void)
{
    uint32_t count = 0;
    for (int i = 0; i < 1024; i++)
        count += fcntl(i, F_GETFD) >= 0;
    return count;
}

static void no_more_files_are_open_than_the_pool_allows(void **state)
{
    (void)state;
    struct fixture f;
    uint32_t before = count_descriptors();
    setup(&f, 3);
    for (uint32_t round = 0; round < 3; round++)
        for (uint32_t i = 0; i < FILE_COUNT; i++) {
            CHECK_OK(read_file(&f, i));
            assert_true(count_descriptors() <= before + 3);
        }
    SluiceFilePoolStatistics statistics = statistics_of(&f);
    assert_int_equal(statistics.maxOpenFileCount, 3);
    assert_int_equal(statistics.openFileCount, 3);
    assert_int_equal(statistics.openFilePeak, 3);
    assert_int_equal(statistics.openTotal, 3 * FILE_COUNT);
    assert_int_equal(statistics.closedTotal, 3 * FILE_COUNT - 3);
    teardown(&f);
    assert_int_equal(count_descriptors(), before);
}

static void the_file_read_longest_ago_is_closed_first(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 3);
    static const uint32_t reads[] = {0, 1, 2, 0, 3, 0, 2, 1};
    static const uint32_t opened[] = {1, 2, 3, 3, 4, 4, 4, 5}; /* 3 closes 1, which closes 3 */
    for (size_t i = 0; i < sizeof reads / sizeof reads[0]; i++) {
        CHECK_OK(read_file(&f, reads[i]));
        assert_int_equal(statistics_of(&f).openTotal, opened[i]);
    }
    teardown(&f);
}

static void a_quarter_of_the_limit_is_the_default(void **state)
{
    (void)state;
    struct few_descriptors few;
    SluiceFilePool *pool;
    SluiceFilePoolStatistics statistics = {.structSize = sizeof statistics};
    few_descriptors_begin(&few, 4);
    SluiceResult result = sluiceCreateFilePool(NULL, &pool);
    few_descriptors_end(&few);
    CHECK_OK(result);
    CHECK_OK(sluiceGetFilePoolStatistics(pool, &statistics));
    assert_int_equal(statistics.maxOpenFileCount, FEW_DESCRIPTORS_LIMIT / 4);
    sluiceDestroyFilePool(pool);
    SluiceFilePoolCreateInfo info = {.structSize = sizeof info, .maxOpenFileCount = (1u << 20) + 1};
    CHECK_RESULT(sluiceCreateFilePool(&info, &pool), SLUICE_ERROR_INVALID_ARGUMENT);
}

/* The pool may have 30 files open, but the process has descriptors for fewer. */
static void without_descriptors_other_files_are_closed(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 30);
    for (uint32_t i = 0; i < 2; i++)
        CHECK_OK(read_file(&f, i));
    struct few_descriptors few;
    few_descriptors_begin(&few, 0);
    SluiceResult worst = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < FILE_COUNT; i++) {
        SluiceResult result = read_file(&f, i);
        worst = result != SLUICE_SUCCESS ? result : worst;
    }
    few_descriptors_end(&few);
    CHECK_OK(worst);
    assert_true(statistics_of(&f).shortageTotal > 0);
    assert_true(statistics_of(&f).openFileCount <= 2);
    assert_int_equal(f.errors, 0);
    teardown(&f);
}

static void without_any_descriptor_a_file_is_read_later(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 30);
    struct few_descriptors few;
    few_descriptors_begin(&few, 0);
    SluiceResult result = read_file(&f, 0);
    few_descriptors_end(&few);
    CHECK_RESULT(result, SLUICE_NOT_READY);
    CHECK_OK(read_file(&f, 0));
    teardown(&f);
}

static void close_all_others(struct fixture *f, uint32_t file)
{
    for (uint32_t i = 0; i < FILE_COUNT; i++)
        if (i != file)
            CHECK_OK(read_file(f, i));
}

static void set_time(const char *path, long seconds, long nanoseconds)
{
    struct timespec times[2] = {{seconds, nanoseconds}, {seconds, nanoseconds}};
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

/* A file is replaced by rename, or written in place. Its size stays, and its time if possible. */
static void another_file_is_not_mistaken_for_the_first(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 3);
    char other[128];
    snprintf(other, sizeof other, "%s.other", f.paths[0]);
    for (uint32_t i = 0; i < 4; i++) {
        set_time(f.paths[i], 1000, 5);
        CHECK_OK(read_file(&f, i));
    }
    close_all_others(&f, 0);
    write_file(other, 9, FILE_SIZE); /* another inode */
    set_time(other, 1000, 5);
    assert_int_equal(rename(other, f.paths[0]), 0);
    write_file(f.paths[1], 9, FILE_SIZE); /* another time */
    set_time(f.paths[1], 1000, 6);
    write_file(f.paths[2], 9, FILE_SIZE + 1); /* another size */
    set_time(f.paths[2], 1000, 5);
    unlink(f.paths[3]);
    for (uint32_t again = 0; again < 2; again++)
        for (uint32_t i = 0; i < 3; i++) {
            CHECK_RESULT(read_file(&f, i), SLUICE_ERROR_IO);
            assert_non_null(strstr(f.last, f.paths[again == 0 ? i : 2]));
            assert_non_null(strstr(f.last, "another file has taken its place"));
        }
    CHECK_RESULT(read_file(&f, 3), SLUICE_ERROR_FILE_NOT_FOUND);
    assert_int_equal(statistics_of(&f).replacedTotal, 6);
    assert_int_equal(f.errors, 4); /* each once */
    teardown(&f);
}

/* chmod and a hard link change the inode's time, but no byte that is read. */
static void the_first_file_with_other_permissions_is_read_on(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 3);
    char other[128];
    snprintf(other, sizeof other, "%s.other", f.paths[0]);
    CHECK_OK(read_file(&f, 0));
    close_all_others(&f, 0);
    assert_int_equal(chmod(f.paths[0], 0400), 0);
    assert_int_equal(link(f.paths[0], other), 0);
    CHECK_OK(read_file(&f, 0));
    unlink(other);
    teardown(&f);
}

/* A closed file may become another one: its size and kind are taken when it is opened again. */
static void a_closed_file_forgets_what_it_was(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 3);
    CHECK_OK(read_file(&f, 0));
    slc_input_file_close(&f.files[0]);
    assert_int_equal(statistics_of(&f).openFileCount, 0);
    write_file(f.paths[0], 0, FILE_SIZE - 1);
    CHECK_OK(read_file(&f, 0));
    assert_int_equal(f.files[0].size, FILE_SIZE - 1);
    unlink(f.paths[1]);
    assert_int_equal(mkfifo(f.paths[1], 0600), 0);
    CHECK_RESULT(read_file(&f, 1), SLUICE_ERROR_IO);
    assert_non_null(strstr(f.last, "is not a regular file"));
    unlink(f.paths[1]);
    write_file(f.paths[1], 1, FILE_SIZE);
    CHECK_OK(read_file(&f, 1));
    teardown(&f);
}

struct reader {
    struct fixture *f;
    uint32_t first;
};

static void *read_many(void *argument)
{
    struct reader *reader = argument;
    for (uint32_t i = 0; i < 2000; i++) {
        uint32_t file = (reader->first + i * i) % FILE_COUNT;
        uint8_t byte = 0;
        if (slc_input_file_read(&reader->f->files[file], 7, &byte, 1) != SLUICE_SUCCESS ||
            byte != byte_at(file, 7))
            return reader;
    }
    return NULL;
}

static void threads_share_fewer_files_than_there_are_threads(void **state)
{
    (void)state;
    for (uint32_t max = 1; max <= 3; max += 2) {
        enum { THREADS = 8 };
        struct fixture f;
        pthread_t threads[THREADS];
        struct reader readers[THREADS];
        setup(&f, max);
        for (uint32_t i = 0; i < FILE_COUNT; i++)
            CHECK_OK(slc_input_file_open(&f.files[i]));
        for (uint32_t i = 0; i < THREADS; i++) {
            readers[i] = (struct reader){&f, i * 5};
            assert_int_equal(pthread_create(&threads[i], NULL, read_many, &readers[i]), 0);
        }
        for (uint32_t i = 0; i < THREADS; i++) {
            void *failed;
            pthread_join(threads[i], &failed);
            assert_null(failed);
        }
        assert_int_equal(statistics_of(&f).openFilePeak, max);
        assert_int_equal(f.errors, 0);
        teardown(&f);
    }
}

static void creation_survives_every_refused_allocation(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceLogCallback log = {0};
    uint64_t n = 0;
    for (; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        struct slc_input_file file = {0};
        SluiceFilePool *pool = NULL;
        failing_allocator_init(&a, n);
        SluiceFilePoolCreateInfo info = {.structSize = sizeof info, .pAllocator = &a.callbacks};
        result = sluiceCreateFilePool(&info, &pool);
        struct slc_input_choice choice = {"x", NULL, pool};
        if (result == SLUICE_SUCCESS)
            result = slc_input_file_init_choice(&file, &choice, &a.callbacks, &log);
        assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        slc_input_file_finish(&file);
        sluiceDestroyFilePool(pool);
        assert_int_equal(a.live_bytes, 0);
    }
    assert_int_equal(n, 5); /* the pool; path, messages and entry of the file; none */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_more_files_are_open_than_the_pool_allows),
        cmocka_unit_test(the_file_read_longest_ago_is_closed_first),
        cmocka_unit_test(a_quarter_of_the_limit_is_the_default),
        cmocka_unit_test(without_descriptors_other_files_are_closed),
        cmocka_unit_test(without_any_descriptor_a_file_is_read_later),
        cmocka_unit_test(another_file_is_not_mistaken_for_the_first),
        cmocka_unit_test(the_first_file_with_other_permissions_is_read_on),
        cmocka_unit_test(a_closed_file_forgets_what_it_was),
        cmocka_unit_test(threads_share_fewer_files_than_there_are_threads),
        cmocka_unit_test(creation_survives_every_refused_allocation),
    };
    return RUN_TESTS(tests);
}
