/* Promises of lib/platform on every operating system. Uses no other system interface. */
#define _POSIX_C_SOURCE 200809L /* for the type in rw_lock.h */
#include "base/alloc.h"
#include "base/part_file.h"
#include "platform/folder.h"
#include "platform/host_memory.h"
#include "platform/rw_lock.h"
#include "platform/thread.h"
#include "platform/time_now.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct meeting {
    struct slc_mutex mutex;
    struct slc_condition changed;
    uint32_t count;
    bool is_open;
};

static void *attend(void *user)
{
    struct meeting *meeting = user;
    slc_mutex_lock(&meeting->mutex);
    while (!meeting->is_open)
        slc_condition_wait(&meeting->changed, &meeting->mutex);
    meeting->count++;
    slc_mutex_unlock(&meeting->mutex);
    return NULL;
}

static void threads_wait_for_a_condition_and_are_joined(void **state)
{
    (void)state;
    struct meeting meeting = {.count = 0};
    struct slc_thread threads[4];
    assert_true(slc_mutex_init_spinning(&meeting.mutex));
    assert_true(slc_condition_init(&meeting.changed));
    for (int i = 0; i < 4; i++)
        assert_true(slc_thread_start(&threads[i], attend, &meeting));
    slc_mutex_lock(&meeting.mutex);
    assert_int_equal(meeting.count, 0);
    meeting.is_open = true;
    slc_condition_broadcast(&meeting.changed);
    slc_mutex_unlock(&meeting.mutex);
    for (int i = 0; i < 4; i++)
        slc_thread_join(&threads[i]);
    assert_int_equal(meeting.count, 4);
    slc_condition_finish(&meeting.changed);
    slc_mutex_finish(&meeting.mutex);
}

/* A condition on another clock would return at once. */
static void a_wait_ends_at_its_time_and_not_before(void **state)
{
    (void)state;
    struct slc_mutex mutex;
    struct slc_condition condition;
    assert_true(slc_mutex_init(&mutex));
    assert_true(slc_condition_init(&condition));
    uint64_t until = slc_monotonic_time() + 30000000;
    slc_mutex_lock(&mutex);
    while (slc_condition_wait_until(&condition, &mutex, until))
        assert_true(slc_monotonic_time() < until);
    slc_mutex_unlock(&mutex);
    assert_true(slc_monotonic_time() >= until);
    slc_condition_finish(&condition);
    slc_mutex_finish(&mutex);
}

static void a_lock_has_several_readers(void **state)
{
    (void)state;
    struct slc_rw_lock lock;
    assert_true(slc_rw_lock_init(&lock));
    slc_rw_lock_read(&lock);
    slc_rw_lock_read(&lock);
    slc_rw_lock_end_read(&lock);
    slc_rw_lock_end_read(&lock);
    slc_rw_lock_write(&lock);
    slc_rw_lock_end_write(&lock);
    slc_rw_lock_finish(&lock);
}

static void memory_has_its_alignment(void **state)
{
    (void)state;
    for (size_t alignment = 1; alignment <= 4096; alignment *= 2) {
        char *memory = slc_host_allocate(alignment + 3, alignment);
        assert_non_null(memory);
        assert_int_equal((uintptr_t)memory % alignment, 0);
        memset(memory, 1, alignment + 3);
        slc_host_free(memory);
    }
}

/* A name with a letter of two bytes in UTF-8. */
#define NAME "sluice-platform-\xC3\xA4.test"
#define OTHER "sluice-platform-other.test"

static void bytes_are_where_they_were_written(void **state)
{
    (void)state;
    char bytes[8] = {0};
    struct slc_file_status status, named;
    int file = slc_file_create(NAME, 0666);
    assert_true(file >= 0);
    assert_true(slc_file_set_size(file, 0));
    assert_int_equal(slc_file_write_at(file, 6, "later", 5), 5);
    assert_int_equal(slc_file_write_at(file, 0, "first\n", 6), 6);
    assert_int_equal(slc_file_read_at(file, 6, bytes, sizeof bytes), 5);
    assert_string_equal(bytes, "later");
    assert_int_equal(slc_file_read_at(file, 11, bytes, sizeof bytes), 0);
    assert_true(slc_file_sync(file));
    assert_true(slc_file_get_status(file, &status));
    assert_true(slc_path_get_status(NAME, &named));
    assert_int_equal(status.kind, SLC_NODE_FILE);
    assert_int_equal(status.size, 11);
    assert_int_equal(status.link_count, 1);
    assert_int_equal(status.inode, named.inode);
    assert_int_equal(status.device, named.device);
    assert_int_equal(status.modified.seconds, named.modified.seconds);
    slc_file_close(file);
    assert_true(slc_path_remove(NAME));
    assert_false(slc_path_get_status(NAME, &named));
    assert_int_equal(errno, ENOENT);
}

static void a_file_is_locked_once(void **state)
{
    (void)state;
    int first = slc_file_create(NAME, 0666), second = slc_file_create(NAME, 0666);
    assert_true(first >= 0 && second >= 0);
    assert_true(slc_file_lock(first));
    assert_false(slc_file_lock(second));
    assert_true(errno == EWOULDBLOCK || errno == EAGAIN);
    slc_file_close(first);
    assert_true(slc_file_lock(second));
    slc_file_close(second);
    assert_true(slc_path_remove(NAME));
}

static bool lists(const char *wanted)
{
    struct slc_folder *folder = slc_folder_begin(".");
    struct slc_file_status status;
    bool is_there = false;
    assert_non_null(folder);
    for (const char *name; (name = slc_folder_next(folder));)
        is_there |= strcmp(name, wanted) == 0 &&
                    slc_folder_get_status(folder, name, true, &status) &&
                    status.kind == SLC_NODE_FILE;
    slc_folder_end(folder);
    return is_there;
}

static void a_part_file_takes_its_name_when_it_is_whole(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    SluiceLogCallback log = {0};
    struct slc_part_file part, twin;
    for (int round = 0; round < 2; round++) { /* the second one replaces the first one's file */
        CHECK_OK(slc_part_file_open(&part, OTHER, 0, &cb, &log));
        assert_int_equal(lists(OTHER), round == 1);
        CHECK_RESULT(slc_part_file_open(&twin, OTHER, 0, &cb, &log), SLUICE_ERROR_BUSY);
        slc_part_file_close(&twin);
        CHECK_OK(slc_part_file_reserve(&part, 100));
        CHECK_OK(slc_part_file_write(&part, 10, "bytes", 5));
        CHECK_OK(slc_part_file_finish(&part, true));
        assert_true(lists(OTHER));
        assert_false(lists(OTHER ".sluice-part"));
    }
    CHECK_OK(slc_part_file_open(&part, OTHER, 0, &cb, &log));
    CHECK_OK(slc_part_file_finish(&part, false));
    assert_false(lists(OTHER ".sluice-part"));
    assert_true(slc_path_remove(OTHER));
}

static int create_with(const char *name, const char *bytes)
{
    int file = slc_file_create(name, 0666);
    assert_true(file >= 0 && slc_file_set_size(file, 0));
    assert_int_equal(slc_file_write_at(file, 0, bytes, strlen(bytes)), strlen(bytes));
    return file;
}

/* A store is replaced like this when it is baked again while it streams. */
static void an_open_file_is_replaced_and_stays_readable(void **state)
{
    (void)state;
    char bytes[8] = {0};
    slc_file_close(create_with(OTHER, "old"));
    int old = slc_file_open(OTHER), new = create_with(NAME, "new");
    bool is_done = slc_path_replace(NAME, OTHER);
    int error = errno;
    if (is_done) {
        assert_int_equal(slc_file_read_at(old, 0, bytes, sizeof bytes), 3);
        assert_string_equal(bytes, "old");
        assert_int_equal(slc_file_read_at(new, 0, bytes, sizeof bytes), 3);
        assert_string_equal(bytes, "new");
    }
    slc_file_close(old);
    slc_file_close(new);
    assert_true(is_done || slc_path_remove(NAME));
    assert_true(slc_path_remove(OTHER));
#ifdef _WIN32
    if (!is_done && error == EACCES)
        SKIP_TEST("this Windows does not replace files that are open");
#endif
    assert_true(is_done || error == 0);
}

static void a_path_is_resolved_if_something_is_there(void **state)
{
    (void)state;
    slc_file_close(create_with(OTHER, ""));
    char *direct = slc_path_resolve(OTHER), *roundabout = slc_path_resolve("./././" OTHER);
    assert_non_null(direct);
    assert_non_null(roundabout);
    assert_string_equal(direct, roundabout);
    assert_string_equal(slc_path_name(direct), OTHER);
    assert_true(direct != slc_path_name(direct));
    free(direct);
    free(roundabout);
    assert_true(slc_path_remove(OTHER));
    assert_null(slc_path_resolve(OTHER));
    assert_int_equal(errno, ENOENT);
    assert_null(slc_path_resolve(""));
    assert_int_equal(errno, ENOENT);
}

static void failures_have_their_number(void **state)
{
    (void)state;
    struct slc_file_status status;
    char name[300];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_int_equal(slc_file_create("there is no such folder/file", 0666), -1);
    assert_int_equal(errno, ENOENT);
    assert_false(slc_path_get_status(name, &status));
    assert_true(errno == ENAMETOOLONG || errno == ENOENT);
    assert_false(slc_folder_make("."));
    assert_int_equal(errno, EEXIST);
    assert_false(slc_path_replace("there is no such file", OTHER));
    assert_int_equal(errno, ENOENT);
    assert_false(slc_path_remove("."));
    assert_true(errno == EACCES || errno == EISDIR || errno == EPERM);
}

static void a_path_ends_with_its_name(void **state)
{
    (void)state;
    assert_string_equal(slc_path_name("a/b"), "b");
    assert_string_equal(slc_path_name("a"), "a");
    assert_string_equal(slc_path_name("a/"), "");
    assert_true(slc_get_processor_count() > 0);
    assert_true(slc_get_descriptor_limit() > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_wait_for_a_condition_and_are_joined),
        cmocka_unit_test(a_wait_ends_at_its_time_and_not_before),
        cmocka_unit_test(a_lock_has_several_readers),
        cmocka_unit_test(memory_has_its_alignment),
        cmocka_unit_test(bytes_are_where_they_were_written),
        cmocka_unit_test(a_file_is_locked_once),
        cmocka_unit_test(a_part_file_takes_its_name_when_it_is_whole),
        cmocka_unit_test(an_open_file_is_replaced_and_stays_readable),
        cmocka_unit_test(a_path_is_resolved_if_something_is_there),
        cmocka_unit_test(failures_have_their_number),
        cmocka_unit_test(a_path_ends_with_its_name),
    };
    return RUN_TESTS(tests);
}
