#define _POSIX_C_SOURCE 200809L
#include "random_app.h"

#include "support/test.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool exists(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file)
        fclose(file);
    return file;
}

static void full_writer_ends_the_recording_and_the_manager_goes_on(void **state)
{
    (void)state;
    struct trace_buffer whole;
    record_random_run(&whole, 5, 400, false);
    for (size_t full_at = 0; full_at <= whole.size; full_at += 1 + whole.size / 40) {
        struct random_app app, alone;
        struct trace_buffer buffer;
        SluiceRecorder *recorder;
        const SluiceRecordWriter writer = trace_buffer_writer(&buffer);
        buffer.full_at = full_at;
        random_app_init(&app, 5, false);
        SluiceResult result = sluiceBeginRecording(app.manager, &writer, NULL, &recorder);
        if (full_at < 40) {
            CHECK_RESULT(result, SLUICE_ERROR_IO);
            assert_null(recorder);
        } else {
            CHECK_OK(result);
        }
        random_app_run(&app, 400);
        CHECK_RESULT(sluiceEndRecording(recorder),
                     full_at < 40 || full_at >= whole.size ? SLUICE_SUCCESS : SLUICE_ERROR_IO);

        random_app_init(&alone, 5, false);
        random_app_run(&alone, 400);
        SluiceStreamedTextureStatistics undisturbed = {.structSize = sizeof undisturbed};
        CHECK_OK(sluiceGetStatistics(alone.manager, &undisturbed));
        check_same_statistics(app.manager, &undisturbed);
        random_app_finish(&alone);
        random_app_finish(&app);
        trace_buffer_free(&buffer);
    }
    trace_buffer_free(&whole);
}

static void recorder_without_memory_says_so_and_leaks_nothing(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct random_app app;
        struct trace_buffer buffer;
        struct failing_allocator memory;
        SluiceRecorder *recorder;
        const SluiceRecordWriter writer = trace_buffer_writer(&buffer);
        failing_allocator_init(&memory, n);
        random_app_init(&app, 6, false);
        result = sluiceBeginRecording(app.manager, &writer, &memory.callbacks, &recorder);
        random_app_run(&app, 100);
        SluiceResult end = sluiceEndRecording(recorder);
        result = result == SLUICE_SUCCESS ? end : result;
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(memory.live_bytes, 0);
        random_app_finish(&app);
        trace_buffer_free(&buffer);
        assert_true(n < 1000);
    }
}

static void recording_begins_with_what_was_configured_before(void **state)
{
    (void)state;
    const SluiceStreamedTextureManagerConfig config = {
        .structSize = sizeof config, .numExtraStandbyTiles = 3, .maxHeapCount = 2};
    struct random_app app;
    struct trace_buffer buffer;
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(&buffer);
    random_app_init(&app, 8, false);
    CHECK_OK(sluiceSetConfig(app.manager, &config));
    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    random_app_run(&app, 400);
    CHECK_OK(sluiceEndRecording(recorder));

    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    const SluiceReplayInfo info = {.structSize = sizeof info,
                                   .pData = buffer.data,
                                   .size = buffer.size,
                                   .pStatistics = &statistics};
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    CHECK_OK(sluiceReplay(&info, &replayed));
    assert_int_equal(replayed.divergedEvent, 0);
    assert_true(replayed.decisionHash == replayed.recordedHash);
    check_same_statistics(app.manager, &statistics);
    random_app_finish(&app);
    trace_buffer_free(&buffer);
}

static void what_changes_while_running_is_replayed(void **state)
{
    (void)state;
    struct random_app app;
    struct trace_buffer buffer;
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(&buffer);
    uint32_t forgotten = 0, evicted = 0;
    random_app_init(&app, 8, false);
    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    for (uint32_t i = 0; i < 60; i++) {
        SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                     .numExtraStandbyTiles = i % 20,
                                                     .targetHeapCount = i % 4,
                                                     .noEviction = i % 3 == 0,
                                                     .noMipBias = i % 5 == 0,
                                                     .separatePackedTiles = i % 7 == 0};
        random_app_run(&app, 50);
        CHECK_OK(sluiceSetConfig(app.manager, &config));
        CHECK_OK(sluiceEvacuateHeaps(app.manager, i));
        for (uint32_t k = 0; k < app.id_count; k++) /* 0 is complete, and never goes back */
            forgotten += sluiceForgetStreamedTexture(app.manager, app.ids[k], 0) == SLUICE_SUCCESS;
        for (uint32_t k = i % 4; k < app.id_count; k += 4) /* some are stale */
            evicted +=
                sluiceEvictStreamedTexture(app.manager, app.ids[k], i % 12) == SLUICE_SUCCESS;
    }
    assert_true(forgotten > 0 && evicted > 0);
    CHECK_OK(sluiceEndRecording(recorder));

    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    const SluiceReplayInfo info = {.structSize = sizeof info,
                                   .pData = buffer.data,
                                   .size = buffer.size,
                                   .pStatistics = &statistics};
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    CHECK_OK(sluiceReplay(&info, &replayed));
    assert_int_equal(replayed.divergedEvent, 0);
    assert_true(replayed.decisionHash == replayed.recordedHash);
    check_same_statistics(app.manager, &statistics);
    random_app_finish(&app);
    trace_buffer_free(&buffer);
}

static void file_appears_when_the_recording_ends(void **state)
{
    (void)state;
    const char *path = "test_recorder.trace";
    struct random_app app;
    SluiceRecorder *recorder;
    remove(path);
    random_app_init(&app, 8, false);
    CHECK_OK(sluiceBeginRecordingToFile(app.manager, path, NULL, &recorder));
    random_app_run(&app, 200);
    assert_false(exists(path));
    assert_true(exists("test_recorder.trace.sluice-part"));
    CHECK_OK(sluiceEndRecording(recorder));
    assert_true(exists(path));
    assert_false(exists("test_recorder.trace.sluice-part"));
    random_app_finish(&app);
    remove(path);
}

static void file_of_a_failed_recording_stays_away(void **state)
{
    (void)state;
    const char *path = "test_recorder_failed.trace";
    bool failed_late = false;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct random_app app;
        struct failing_allocator memory;
        SluiceRecorder *recorder;
        failing_allocator_init(&memory, n);
        remove(path);
        random_app_init(&app, 9, false);
        result = sluiceBeginRecordingToFile(app.manager, path, &memory.callbacks, &recorder);
        random_app_run(&app, 100);
        if (recorder) {
            result = sluiceEndRecording(recorder);
            failed_late |= result != SLUICE_SUCCESS;
        }
        assert_true(exists(path) == (result == SLUICE_SUCCESS));
        assert_false(exists("test_recorder_failed.trace.sluice-part"));
        assert_int_equal(memory.live_bytes, 0);
        random_app_finish(&app);
        assert_true(n < 1000);
    }
    assert_true(failed_late);
    remove(path);
}

static void second_recorder_is_refused_and_leaves_the_file_of_the_first(void **state)
{
    (void)state;
    const char *path = "test_recorder_twice.trace";
    struct random_app app;
    SluiceRecorder *first, *second;
    remove(path);
    random_app_init(&app, 8, false);
    CHECK_OK(sluiceBeginRecordingToFile(app.manager, path, NULL, &first));
    random_app_run(&app, 200);
    CHECK_RESULT(sluiceBeginRecordingToFile(app.manager, path, NULL, &second),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(second);
    random_app_run(&app, 200);
    CHECK_OK(sluiceEndRecording(first));
    assert_true(exists(path));
    random_app_finish(&app);
    remove(path);
}

static void take_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    snprintf(user, 256, "%s", message);
}

/* In SLUICERT all of it is there only with the end mark. */
static void check_plays(const char *path)
{
    static char data[1 << 20];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const SluiceReplayInfo info = {
        .structSize = sizeof info, .pData = data, .size = fread(data, 1, sizeof data, file)};
    fclose(file);
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    CHECK_OK(sluiceReplay(&info, &replayed));
    assert_int_equal(replayed.divergedEvent, 0);
}

static void two_recordings_to_one_path_are_one_whole_file_and_a_refusal(void **state)
{
    (void)state;
    const char *path = "test_recorder_busy.trace";
    char told[256] = "";
    const SluiceFileRecordingInfo info = {
        .structSize = sizeof info, .pPath = path, .log = {told, take_message}};
    struct random_app app, other;
    SluiceRecorder *first, *second;
    remove(path);
    random_app_init(&app, 8, false);
    random_app_init(&other, 9, false);
    CHECK_OK(sluiceBeginFileRecording(app.manager, &info, &first));
    random_app_run(&app, 200);
    CHECK_RESULT(sluiceBeginFileRecording(other.manager, &info, &second), SLUICE_ERROR_BUSY);
    assert_null(second);
    assert_non_null(strstr(told, path));
    assert_non_null(strstr(told, "another writer"));
    random_app_run(&other, 200);
    random_app_run(&app, 200);
    CHECK_OK(sluiceEndRecording(first));
    check_plays(path);
    random_app_finish(&app);
    random_app_finish(&other);
    assert_false(exists("test_recorder_busy.trace.sluice-part"));
    remove(path);
}

static void link_planted_at_the_part_file_is_not_written_through(void **state)
{
    (void)state;
    const char *path = "test_recorder_planted.trace",
               *part = "test_recorder_planted.trace.sluice-part";
    const char *victim = "test_recorder_planted.victim";
    char told[256] = "", text[8] = {0};
    const SluiceFileRecordingInfo info = {
        .structSize = sizeof info, .pPath = path, .log = {told, take_message}};
    struct random_app app;
    SluiceRecorder *recorder;
    remove(part);
    FILE *file = fopen(victim, "wb");
    fputs("older", file);
    fclose(file);
    assert_int_equal(symlink(victim, part), 0);
    random_app_init(&app, 8, false);
    CHECK_RESULT(sluiceBeginFileRecording(app.manager, &info, &recorder), SLUICE_ERROR_IO);
    assert_non_null(strstr(told, part));
    assert_false(exists(path));
    assert_true(exists(part));
    file = fopen(victim, "rb");
    (void)!fread(text, 1, 7, file);
    fclose(file);
    assert_string_equal(text, "older");
    random_app_finish(&app);
    remove(part);
    remove(victim);
}

static void failed_recording_names_its_file_and_the_reason(void **state)
{
    (void)state;
    char told[256] = "";
    SluiceFileRecordingInfo info = {
        .structSize = sizeof info, .pPath = "no/such/folder/x.trace", .log = {told, take_message}};
    struct random_app app;
    SluiceRecorder *recorder;
    random_app_init(&app, 1, false);
    CHECK_RESULT(sluiceBeginFileRecording(app.manager, &info, &recorder), SLUICE_ERROR_IO);
    assert_null(recorder);
    assert_non_null(strstr(told, info.pPath));
    assert_non_null(strstr(told, "no such folder"));
    info.pPath = "."; /* a folder */
    CHECK_RESULT(sluiceBeginFileRecording(app.manager, &info, &recorder), SLUICE_ERROR_IO);
    assert_non_null(strstr(told, "is a folder"));
    if (access("/dev/full", W_OK) == 0) {
        info.pPath = "test_recorder.full"; /* a link, so that the machine's own is never at risk */
        remove(info.pPath);
        assert_int_equal(symlink("/dev/full", info.pPath), 0);
        CHECK_RESULT(sluiceBeginFileRecording(app.manager, &info, &recorder), SLUICE_ERROR_IO);
        assert_non_null(strstr(told, info.pPath));
        assert_non_null(strstr(told, "No space left"));
        assert_int_equal(remove(info.pPath), 0);
    }
    random_app_finish(&app);
}

static void failed_allocation_loses_the_recording_and_says_which(void **state)
{
    (void)state;
    const char *path = "test_recorder_told.trace";
    bool failed_late = false;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        char told[256] = "";
        struct random_app app;
        struct failing_allocator memory;
        SluiceRecorder *recorder;
        failing_allocator_init(&memory, n);
        const SluiceFileRecordingInfo info = {
            sizeof info, path, &memory.callbacks, {told, take_message}};
        random_app_init(&app, 9, false);
        result = sluiceBeginFileRecording(app.manager, &info, &recorder);
        random_app_run(&app, 100);
        if (recorder && (result = sluiceEndRecording(recorder)) != SLUICE_SUCCESS) {
            failed_late = true;
            assert_non_null(strstr(told, path));
            assert_non_null(strstr(told, "OUT_OF_HOST_MEMORY"));
        }
        random_app_finish(&app);
        assert_true(n < 1000);
    }
    assert_true(failed_late);
    remove(path);
}

static void path_that_cannot_be_written_is_an_error(void **state)
{
    (void)state;
    struct random_app app;
    SluiceRecorder *recorder;
    random_app_init(&app, 1, false);
    CHECK_RESULT(sluiceBeginRecordingToFile(app.manager, "no/such/folder/x.trace", NULL, &recorder),
                 SLUICE_ERROR_IO);
    assert_null(recorder);
    random_app_finish(&app);
}

static void pipe_is_written_to_and_not_replaced(void **state)
{
    (void)state;
    const char *path = "test_recorder.pipe";
    remove(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    int reader = open(path, O_RDWR); /* so that nobody waits for the other end */
    assert_true(reader >= 0);
    struct random_app app;
    SluiceRecorder *recorder;
    random_app_init(&app, 8, false);
    CHECK_OK(sluiceBeginRecordingToFile(app.manager, path, NULL, &recorder));
    random_app_run(&app, 3);
    CHECK_OK(sluiceEndRecording(recorder));
    random_app_finish(&app);
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    assert_true(S_ISFIFO(status.st_mode));
    char magic[4] = {0};
    assert_int_equal(read(reader, magic, 4), 4);
    close(reader);
    assert_int_equal(remove(path), 0);
    assert_false(exists("test_recorder.pipe.sluice-part"));
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    struct random_app app;
    struct trace_buffer buffer;
    SluiceRecorder *recorder, *second;
    SluiceRecordWriter writer = trace_buffer_writer(&buffer);
    const SluiceRecordWriter none = {NULL, NULL};
    const SluiceAllocationCallbacks half = {NULL, NULL, NULL};
    random_app_init(&app, 1, false);
    CHECK_RESULT(sluiceBeginRecording(NULL, &writer, NULL, &recorder), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceBeginRecording(app.manager, NULL, NULL, &recorder),
                 SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceBeginRecording(app.manager, &none, NULL, &recorder),
                 SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceBeginRecording(app.manager, &writer, NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceBeginRecording(app.manager, &writer, &half, &recorder),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceBeginRecordingToFile(app.manager, NULL, NULL, &recorder),
                 SLUICE_ERROR_NULL_POINTER);
    CHECK_OK(sluiceEndRecording(NULL));

    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    CHECK_RESULT(sluiceBeginRecording(app.manager, &writer, NULL, &second),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceEndRecording(recorder));
    random_app_finish(&app);
    trace_buffer_free(&buffer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_writer_ends_the_recording_and_the_manager_goes_on),
        cmocka_unit_test(recorder_without_memory_says_so_and_leaks_nothing),
        cmocka_unit_test(recording_begins_with_what_was_configured_before),
        cmocka_unit_test(what_changes_while_running_is_replayed),
        cmocka_unit_test(file_appears_when_the_recording_ends),
        cmocka_unit_test(file_of_a_failed_recording_stays_away),
        cmocka_unit_test(second_recorder_is_refused_and_leaves_the_file_of_the_first),
        cmocka_unit_test(two_recordings_to_one_path_are_one_whole_file_and_a_refusal),
        cmocka_unit_test(link_planted_at_the_part_file_is_not_written_through),
        cmocka_unit_test(failed_recording_names_its_file_and_the_reason),
        cmocka_unit_test(failed_allocation_loses_the_recording_and_says_which),
        cmocka_unit_test(path_that_cannot_be_written_is_an_error),
        cmocka_unit_test(pipe_is_written_to_and_not_replaced),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
