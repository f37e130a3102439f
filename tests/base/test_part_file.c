/* A failure leaves existing files unchanged, and files of others are never touched. */
#define _DEFAULT_SOURCE /* mknod */

#include "base/alloc.h"
#include "base/part_file.h"
#include "base/same_file.h"
#include "support/failing_allocator.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

/* A folder of the test's own, so that remaining files show. */
struct place {
    char folder[64], name[96], part[112], other[96];
    char told[512]; ///< last message
    SluiceAllocationCallbacks cb;
    SluiceLogCallback log;
};

static void take_message(void *user, SluiceLogSeverity severity, const char *message)
{
    struct place *place = user;
    (void)severity;
    snprintf(place->told, sizeof place->told, "%s", message);
}

static void place_init(struct place *place)
{
    memset(place, 0, sizeof *place);
    place->cb = slc_allocator(NULL);
    place->log = (SluiceLogCallback){place, take_message};
    strcpy(place->folder, "/tmp/sluice-part-XXXXXX");
    assert_non_null(mkdtemp(place->folder));
    snprintf(place->name, sizeof place->name, "%s/file", place->folder);
    snprintf(place->part, sizeof place->part, "%s.sluice-part", place->name);
    snprintf(place->other, sizeof place->other, "%s/other", place->folder);
}

/* Counts the entries except . and ... */
static int count_entries(const struct place *place)
{
    DIR *directory = opendir(place->folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(directory);
    return count;
}

static void place_finish(struct place *place)
{
    unlink(place->name);
    unlink(place->part);
    unlink(place->other);
    rmdir(place->name);
    assert_int_equal(rmdir(place->folder), 0);
}

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void check_text(const char *path, const char *expected)
{
    char text[64] = {0};
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    (void)!fread(text, 1, sizeof text - 1, file);
    fclose(file);
    assert_string_equal(text, expected);
}

static SluiceResult open_part(struct place *place, uint32_t flags, struct slc_part_file *part)
{
    place->told[0] = '\0';
    return slc_part_file_open(part, place->name, flags, &place->cb, &place->log);
}

/* Writes a whole file. */
static SluiceResult write_text(struct place *place, uint32_t flags, const char *text)
{
    struct slc_part_file part;
    SluiceResult result = open_part(place, flags, &part);
    if (result == SLUICE_SUCCESS)
        result = slc_part_file_append(&part, text, strlen(text));
    SluiceResult finished = slc_part_file_finish(&part, result == SLUICE_SUCCESS);
    return result == SLUICE_SUCCESS ? finished : result;
}

/* Checks a refused open: it leaves no file, and the message names the file and the reason. */
static void check_refused(struct place *place, uint32_t flags, const char *path, const char *why)
{
    struct slc_part_file part;
    CHECK_RESULT(open_part(place, flags, &part), SLUICE_ERROR_IO);
    if (!strstr(place->told, path) || !strstr(place->told, why))
        fail_msg("\"%s\" does not say \"%s\" and \"%s\"", place->told, path, why);
    slc_part_file_remove(&part);
    slc_part_file_close(&part);
}

static void what_was_there_stays_until_the_new_file_is_whole(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file part;
    place_init(&place);
    put(place.name, "older");
    CHECK_OK(open_part(&place, 0, &part));
    CHECK_OK(slc_part_file_write(&part, 3, "er", 2));
    check_text(place.name, "older");
    CHECK_OK(slc_part_file_write(&part, 0, "new", 3));
    check_text(place.name, "older");
    CHECK_OK(slc_part_file_finish(&part, true));
    check_text(place.name, "newer");
    CHECK_OK(open_part(&place, 0, &part));
    CHECK_OK(slc_part_file_append(&part, "newest", 6));
    CHECK_OK(slc_part_file_finish(&part, false));
    check_text(place.name, "newer");
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

static void a_folder_stays(void **state)
{
    (void)state;
    struct place place;
    place_init(&place);
    assert_int_equal(mkdir(place.name, 0777), 0);
    for (uint32_t flags = 0; flags < 4; flags++)
        check_refused(&place, flags, place.name, "is a folder");
    assert_int_equal(count_entries(&place), 1);
    assert_int_equal(rmdir(place.name), 0);
    place_finish(&place);
}

static void a_read_only_file_stays(void **state)
{
    (void)state;
    struct place place;
    place_init(&place);
    put(place.name, "older");
    assert_int_equal(chmod(place.name, 0444), 0);
    for (uint32_t flags = 0; flags < 4; flags++)
        check_refused(&place, flags, place.name, "is read-only");
    check_text(place.name, "older");
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

static void a_link_is_neither_followed_nor_replaced(void **state)
{
    (void)state;
    struct place place;
    struct stat status;
    place_init(&place);
    put(place.other, "of someone else");
    assert_int_equal(symlink(place.other, place.name), 0);
    for (uint32_t flags = 0; flags < 4; flags++)
        check_refused(&place, flags, place.name, "symbolic link");
    assert_int_equal(unlink(place.other), 0); /* now it leads nowhere */
    check_refused(&place, SLC_PART_FILE_STREAM, place.name, "symbolic link");
    assert_int_equal(lstat(place.name, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

static void devices_stay_and_take_streams_alone(void **state)
{
    (void)state;
    struct place place;
    struct stat status;
    place_init(&place);
    if (mknod(place.name, S_IFCHR | 0600, makedev(1, 3)) != 0) /* the device number of /dev/null */
        assert_int_equal(symlink("/dev/null", place.name), 0);
    assert_int_equal(lstat(place.name, &status), 0);
    check_refused(&place, 0, place.name,
                  S_ISLNK(status.st_mode) ? "symbolic link" : "no regular file");
    int opened = open(place.name, O_WRONLY); /* some sandboxes make nodes that nobody may open */
    if (opened >= 0) {
        close(opened);
        CHECK_OK(write_text(&place, SLC_PART_FILE_STREAM, "text"));
    }
    struct stat after;
    assert_int_equal(lstat(place.name, &after), 0);
    assert_true(after.st_ino == status.st_ino && after.st_mode == status.st_mode);
    assert_int_equal(count_entries(&place), 1);
    unlink(place.name);
    if (mknod(place.name, S_IFBLK | 0600, makedev(7, 250)) == 0) /* a block device is no stream */
        check_refused(&place, SLC_PART_FILE_STREAM, place.name, "no regular file");
    place_finish(&place);
}

static void a_link_to_a_device_takes_a_stream_and_stays(void **state)
{
    (void)state;
    struct place place;
    struct stat status;
    place_init(&place);
    assert_int_equal(symlink("/dev/null", place.name), 0);
    CHECK_OK(write_text(&place, SLC_PART_FILE_STREAM, "text"));
    unlink(place.name);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(symlink("/dev/full", place.name), 0);
        CHECK_RESULT(write_text(&place, SLC_PART_FILE_STREAM, "text"), SLUICE_ERROR_IO);
        assert_non_null(strstr(place.told, place.name));
        assert_int_equal(lstat(place.name, &status), 0);
        assert_true(S_ISLNK(status.st_mode));
    }
    place_finish(&place);
}

static void a_pipe_takes_a_stream_and_stays(void **state)
{
    (void)state;
    struct place place;
    struct stat status;
    char text[8] = {0};
    place_init(&place);
    assert_int_equal(mkfifo(place.name, 0600), 0);
    int reader = open(place.name, O_RDWR); /* so that nobody waits for the other end */
    check_refused(&place, 0, place.name, "no regular file");
    CHECK_OK(write_text(&place, SLC_PART_FILE_STREAM, "text"));
    assert_int_equal(read(reader, text, sizeof text), 4);
    assert_string_equal(text, "text");
    struct slc_part_file part;
    CHECK_OK(open_part(&place, SLC_PART_FILE_STREAM, &part));
    CHECK_OK(slc_part_file_finish(&part, false)); /* an output that fails leaves the pipe, too */
    close(reader);
    assert_int_equal(lstat(place.name, &status), 0);
    assert_true(S_ISFIFO(status.st_mode));
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

static void what_is_planted_at_the_part_file_is_not_written_through(void **state)
{
    (void)state;
    struct place place;
    place_init(&place);
    put(place.other, "of someone else");
    assert_int_equal(symlink(place.other, place.part), 0);
    check_refused(&place, SLC_PART_FILE_STREAM, place.part, "symbolic link");
    assert_int_equal(unlink(place.part), 0);
    assert_int_equal(link(place.other, place.part), 0);
    check_refused(&place, SLC_PART_FILE_STREAM, place.part, "hard links");
    assert_int_equal(unlink(place.part), 0);
    assert_int_equal(mkfifo(place.part, 0600), 0);
    check_refused(&place, SLC_PART_FILE_STREAM, place.part, "no regular file");
    check_text(place.other, "of someone else");
    assert_int_equal(count_entries(&place), 2); /* the pipe is not ours to remove either */
    place_finish(&place);
}

static void a_part_file_of_a_killed_writer_is_taken_over(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file part;
    int status;
    place_init(&place);
    put(place.name, "older");
    for (int i = 0; i < 3; i++) {
        pid_t child = fork();
        if (child == 0) {
            if (open_part(&place, 0, &part) == SLUICE_SUCCESS &&
                slc_part_file_append(&part, "half of a file", 14) == SLUICE_SUCCESS)
                raise(SIGKILL);
            _exit(1);
        }
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status));
        assert_int_equal(count_entries(&place), 2); /* however often */
        check_text(place.name, "older");
    }
    CHECK_OK(open_part(&place, SLC_PART_FILE_RESUME, &part));
    assert_int_equal(part.size, 14);
    slc_part_file_close(&part);
    CHECK_OK(write_text(&place, 0, "whole"));
    check_text(place.name, "whole");
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

static void a_second_writer_is_told_so_and_the_first_file_is_whole(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file first, second;
    place_init(&place);
    CHECK_OK(open_part(&place, 0, &first));
    CHECK_OK(slc_part_file_append(&first, "fi", 2));
    for (uint32_t flags = 0; flags < 4; flags++) {
        CHECK_RESULT(open_part(&place, flags, &second), SLUICE_ERROR_BUSY);
        assert_non_null(strstr(place.told, place.name));
        assert_non_null(strstr(place.told, "another writer"));
        CHECK_OK(slc_part_file_finish(&second, false));
    }
    CHECK_OK(slc_part_file_append(&first, "rst", 3));
    CHECK_OK(slc_part_file_finish(&first, true));
    check_text(place.name, "first");
    CHECK_OK(write_text(&place, 0, "second"));
    check_text(place.name, "second");
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

/* A program may be started with its standard streams closed. Its output then goes to no file. */
static void what_a_program_prints_ends_in_no_file(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file part;
    int status;
    place_init(&place);
    pid_t child = fork();
    if (child == 0) {
        for (int i = STDIN_FILENO; i <= STDERR_FILENO; i++)
            close(i);
        bool done = open_part(&place, 0, &part) == SLUICE_SUCCESS;
        for (int i = STDIN_FILENO; i <= STDERR_FILENO; i++)
            done = write(i, "printed", 7) < 0 && done;
        done = done && slc_part_file_append(&part, "text", 4) == SLUICE_SUCCESS;
        _exit(slc_part_file_finish(&part, true) == SLUICE_SUCCESS && done ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    check_text(place.name, "text");
    place_finish(&place);
}

/* Another process removes NAME.sluice-part while a writer works, and another writer begins. */
static void a_writer_gives_no_name_to_the_part_file_of_another(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file first, second;
    place_init(&place);
    put(place.name, "older");
    CHECK_OK(open_part(&place, 0, &first));
    assert_int_equal(unlink(place.part), 0);
    CHECK_OK(open_part(&place, 0, &second));
    CHECK_OK(slc_part_file_append(&second, "sec", 3));
    CHECK_RESULT(slc_part_file_finish(&first, true), SLUICE_ERROR_IO);
    assert_non_null(strstr(place.told, "was removed or replaced"));
    check_text(place.name, "older");
    CHECK_OK(slc_part_file_append(&second, "ond", 3));
    CHECK_OK(slc_part_file_finish(&second, true));
    check_text(place.name, "second");
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

static void a_write_that_fails_leaves_what_was_there(void **state)
{
    (void)state;
    static char block[100000];
    struct place place;
    struct slc_part_file part;
    struct rlimit old, limit;
    place_init(&place);
    put(place.name, "older");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    limit = old;
    limit.rlim_cur = 65536;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    for (int at = 0; at < 2; at++) {
        CHECK_OK(open_part(&place, 0, &part));
        SluiceResult result = at ? slc_part_file_write(&part, 0, block, sizeof block)
                                 : slc_part_file_append(&part, block, sizeof block);
        CHECK_RESULT(result, SLUICE_ERROR_IO);
        assert_non_null(strstr(place.told, place.part));
        assert_non_null(strstr(place.told, "File too large"));
        CHECK_OK(slc_part_file_finish(&part, false));
    }
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
    signal(SIGXFSZ, SIG_DFL);
    check_text(place.name, "older");
    assert_int_equal(count_entries(&place), 1);
    place_finish(&place);
}

static void what_comes_to_the_name_meanwhile_stays(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file part;
    place_init(&place);
    CHECK_OK(open_part(&place, 0, &part));
    assert_int_equal(mkfifo(place.name, 0600), 0);
    CHECK_RESULT(slc_part_file_finish(&part, true), SLUICE_ERROR_IO);
    assert_non_null(strstr(place.told, "no regular file"));
    assert_int_equal(count_entries(&place), 1);
    assert_int_equal(unlink(place.name), 0);

    CHECK_OK(open_part(&place, 0, &part));
    assert_int_equal(unlink(place.part), 0);
    put(place.part, "of someone else");
    CHECK_OK(slc_part_file_finish(&part, false));
    check_text(place.part, "of someone else");
    place_finish(&place);
}

static struct {
    const char *name; ///< file that must be absent or unchanged at the first call
    int calls, fail_at;
} sync_watch;

int __real_fsync(int descriptor);
int __wrap_fsync(int descriptor);

int __wrap_fsync(int descriptor)
{
    if (++sync_watch.calls == 1 && sync_watch.name)
        check_text(sync_watch.name, "older");
    if (sync_watch.calls != sync_watch.fail_at)
        return __real_fsync(descriptor);
    errno = EIO;
    return -1;
}

static void a_file_is_on_the_disk_before_it_has_its_name(void **state)
{
    (void)state;
    struct place place;
    place_init(&place);
    put(place.name, "older");
    sync_watch.name = place.name;
    sync_watch.calls = 0;
    CHECK_OK(write_text(&place, 0, "newer"));
    assert_int_equal(sync_watch.calls, 2); /* the file and its folder */
    check_text(place.name, "newer");
    put(place.name, "older");
    sync_watch.calls = 0;
    sync_watch.fail_at = 1;
    CHECK_RESULT(write_text(&place, 0, "newer"), SLUICE_ERROR_IO);
    assert_non_null(strstr(place.told, "cannot sync: Input/output error"));
    check_text(place.name, "older");
    assert_int_equal(count_entries(&place), 1);
    sync_watch.name = NULL;
    sync_watch.calls = sync_watch.fail_at = 0;
    CHECK_OK(write_text(&place, SLC_PART_FILE_UNSYNCED, "quick"));
    assert_int_equal(sync_watch.calls, 0);
    check_text(place.name, "quick");
    place_finish(&place);
}

static void permissions_of_the_replaced_file_are_kept(void **state)
{
    (void)state;
    struct place place;
    struct stat status;
    place_init(&place);
    put(place.name, "older");
    assert_int_equal(chmod(place.name, 0640), 0);
    CHECK_OK(write_text(&place, 0, "newer"));
    assert_int_equal(stat(place.name, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
    place_finish(&place);
}

static void a_private_file_is_private_while_it_is_written(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file part;
    struct stat status;
    place_init(&place);
    put(place.name, "secret");
    put(place.part, "of a killed writer");
    assert_int_equal(chmod(place.name, 0600), 0);
    assert_int_equal(chmod(place.part, 0644), 0);
    for (int i = 0; i < 2; i++) { /* the second one makes its part file */
        CHECK_OK(open_part(&place, 0, &part));
        assert_int_equal(stat(place.part, &status), 0);
        assert_int_equal(status.st_mode & 0777, 0600);
        CHECK_OK(slc_part_file_finish(&part, true));
    }
    place_finish(&place);
}

static void a_missing_folder_is_told_from_other_failures(void **state)
{
    (void)state;
    struct place place;
    struct slc_part_file part;
    place_init(&place);
    snprintf(place.name, sizeof place.name, "%s/no/file", place.folder);
    CHECK_RESULT(open_part(&place, 0, &part), SLUICE_ERROR_FILE_NOT_FOUND);
    assert_non_null(strstr(place.told, place.name));
    assert_non_null(strstr(place.told, "/no: no such folder"));
    assert_null(strstr(place.told, ".sluice-part"));
    slc_part_file_close(&part);
    slc_part_file_close(&part); /* closed ones too */
    place_finish(&place);
}

static void want_of_descriptors_passes_and_leaves_nothing(void **state)
{
    (void)state;
    for (int left = 0; left < 2; left++) { /* for the folder, then for the file */
        struct place place;
        struct slc_part_file part;
        struct few_descriptors few;
        place_init(&place);
        few_descriptors_begin(&few, left);
        SluiceResult result = open_part(&place, 0, &part);
        slc_part_file_close(&part);
        few_descriptors_end(&few);
        CHECK_RESULT(result, SLUICE_NOT_READY);
        assert_int_not_equal(access(place.name, F_OK), 0);
        CHECK_OK(open_part(&place, 0, &part));
        slc_part_file_remove(&part);
        slc_part_file_close(&part);
        place_finish(&place);
    }
}

static void every_refused_allocation_is_a_result_and_leaves_nothing(void **state)
{
    (void)state;
    struct place place;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    place_init(&place);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator memory;
        failing_allocator_init(&memory, n);
        place.cb = memory.callbacks;
        assert_int_equal(count_entries(&place), 0);
        result = write_text(&place, 0, "text");
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(memory.live_bytes, 0);
        assert_true(n < 10);
    }
    check_text(place.name, "text");
    place_finish(&place);
}

static void one_file_is_known_by_all_its_names(void **state)
{
    (void)state;
    struct place place;
    char dotted[128];
    place_init(&place);
    put(place.name, "text");
    snprintf(dotted, sizeof dotted, "%s/./file", place.folder);
    assert_true(slc_is_same_file(place.name, place.name));
    assert_true(slc_is_same_file(place.name, dotted));
    assert_int_equal(symlink(place.name, place.other), 0);
    assert_true(slc_is_same_file(place.other, place.name));
    assert_int_equal(unlink(place.other), 0);
    assert_int_equal(link(place.name, place.other), 0);
    assert_true(slc_is_same_file(place.other, place.name));
    assert_int_equal(unlink(place.other), 0);
    assert_false(slc_is_same_file(place.other, place.name));
    put(place.other, "text");
    assert_false(slc_is_same_file(place.other, place.name));
    assert_false(slc_is_same_file("/dev/null", "/dev/null")); /* loses nothing */
    /* The .sluice-part file of an output is emptied first. */
    put(place.part, "text");
    assert_true(slc_output_replaces_input(place.name, place.part));
    assert_false(slc_output_replaces_input(place.part, place.name));
    assert_true(slc_output_replaces_input(dotted, place.name));
    place_finish(&place);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_there_stays_until_the_new_file_is_whole),
        cmocka_unit_test(a_folder_stays),
        cmocka_unit_test(a_read_only_file_stays),
        cmocka_unit_test(a_link_is_neither_followed_nor_replaced),
        cmocka_unit_test(devices_stay_and_take_streams_alone),
        cmocka_unit_test(a_link_to_a_device_takes_a_stream_and_stays),
        cmocka_unit_test(a_pipe_takes_a_stream_and_stays),
        cmocka_unit_test(what_is_planted_at_the_part_file_is_not_written_through),
        cmocka_unit_test(a_part_file_of_a_killed_writer_is_taken_over),
        cmocka_unit_test(a_second_writer_is_told_so_and_the_first_file_is_whole),
        cmocka_unit_test(what_a_program_prints_ends_in_no_file),
        cmocka_unit_test(a_writer_gives_no_name_to_the_part_file_of_another),
        cmocka_unit_test(a_write_that_fails_leaves_what_was_there),
        cmocka_unit_test(what_comes_to_the_name_meanwhile_stays),
        cmocka_unit_test(a_file_is_on_the_disk_before_it_has_its_name),
        cmocka_unit_test(permissions_of_the_replaced_file_are_kept),
        cmocka_unit_test(a_private_file_is_private_while_it_is_written),
        cmocka_unit_test(a_missing_folder_is_told_from_other_failures),
        cmocka_unit_test(every_refused_allocation_is_a_result_and_leaves_nothing),
        cmocka_unit_test(one_file_is_known_by_all_its_names),
        cmocka_unit_test(want_of_descriptors_passes_and_leaves_nothing),
    };
    return RUN_TESTS(tests);
}
