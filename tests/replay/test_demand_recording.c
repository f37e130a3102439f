#include "damage.h"
#include "demand_app.h"
#include "lines.h"

#include "demand/page_observer.h"
#include "replay/demand_recorder.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static SluiceReplayInfo replay_info(const struct trace_buffer *trace)
{
    return (SluiceReplayInfo){
        .structSize = sizeof(SluiceReplayInfo), .pData = trace->data, .size = trace->size};
}

static void random_run_replays_to_the_same_decisions(void **state)
{
    (void)state;
    SluiceDemandReplayStatistics sum = {0};
    uint32_t out_of_memory = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct demand_app app;
        struct trace_buffer trace;
        struct slc_residency_counts counts;
        SluiceRecorder *recorder;
        SluiceReplayResult result = {.structSize = sizeof result};
        const SluiceRecordWriter writer = trace_buffer_writer(&trace);
        demand_app_init(&app, seed, true);
        CHECK_OK(slc_begin_demand_recording(app.residency, &writer, NULL, &recorder));
        demand_app_run(&app, 600);
        CHECK_OK(sluiceEndRecording(recorder));

        const SluiceReplayInfo info = replay_info(&trace);
        CHECK_OK(sluiceReplay(&info, &result));
        assert_int_equal(result.kind, SLUICE_TRACE_KIND_DEMAND_RECORDING);
        assert_int_equal(result.divergedEvent, 0);
        assert_true(result.decisionHash == result.recordedHash);
        uint64_t resident = 0, evicted = 0, restored = 0;
        for (uint32_t c = 0; c < DEMAND_APP_CLASSES; c++) {
            slc_residency_get_counts(app.residency, c, &counts);
            resident += counts.resident;
            evicted += counts.evicted;
            restored += counts.restored;
        }
        assert_true(result.demand.residentCount == resident);
        assert_true(result.demand.evictedCount == evicted);
        assert_true(result.demand.restoredCount == restored);
        sum.evictedCount += evicted;
        sum.restoredCount += restored;
        sum.refusalCount += result.demand.refusalCount;
        sum.failureCount += result.demand.failureCount;
        out_of_memory += app.out_of_memory_count;
        demand_app_finish(&app);
        trace_buffer_free(&trace);
    }
    /* Else the runs were too tame to show anything. */
    assert_true(sum.evictedCount > 1000 && sum.restoredCount > 100 && sum.refusalCount > 100);
    assert_true(sum.failureCount > 100 && out_of_memory > 10);
}

static void switches_of_a_running_residency_are_replayed(void **state)
{
    (void)state;
    struct demand_app app;
    struct trace_buffer trace;
    SluiceRecorder *recorder;
    SluiceReplayResult result = {.structSize = sizeof result};
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    demand_app_init(&app, 3, false);
    CHECK_OK(slc_begin_demand_recording(app.residency, &writer, NULL, &recorder));
    uint32_t without = 0;
    for (uint32_t i = 0; i < 64; i++) {
        struct slc_residency_counts before, after;
        slc_residency_set_switches(app.residency, i % 2, i % 4 >= 2);
        slc_residency_get_counts(app.residency, 0, &before);
        demand_app_run(&app, 40);
        slc_residency_get_counts(app.residency, 0, &after);
        without += after.evicted == before.evicted;
        if (i % 4)
            assert_true(slc_residency_lod_bias(app.residency) == 0);
    }
    assert_in_range(without, 1, 60); /* in some there are evictions */
    CHECK_OK(sluiceEndRecording(recorder));

    const SluiceReplayInfo info = replay_info(&trace);
    CHECK_OK(sluiceReplay(&info, &result));
    assert_int_equal(result.divergedEvent, 0);
    assert_true(result.decisionHash == result.recordedHash);
    demand_app_finish(&app);
    trace_buffer_free(&trace);
}

static void read_back(const char *path, struct trace_buffer *buffer)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    SluiceRecordWriter writer = trace_buffer_writer(buffer);
    char piece[4096];
    size_t size;
    while ((size = fread(piece, 1, sizeof piece, file)) > 0)
        CHECK_OK(writer.pfnWrite(writer.pUserData, piece, size));
    fclose(file);
}

static void replay_recorded_again_is_the_same_trace(void **state)
{
    (void)state;
    const char *path = "test_demand_recording.trace";
    for (uint64_t seed = 100; seed < 104; seed++) {
        struct trace_buffer trace, again;
        struct lines lines = {0};
        SluiceReplayResult result = {.structSize = sizeof result};
        record_demand_run(&trace, seed, 400, seed % 2);
        SluiceReplayInfo info = replay_info(&trace);
        info.pRecordPath = path;
        info.pUserData = &lines;
        info.pfnLine = lines_take;
        CHECK_OK(sluiceReplay(&info, &result));
        assert_int_equal(result.divergedEvent, 0);
        read_back(path, &again);
        assert_int_equal(again.size, trace.size);
        assert_memory_equal(again.data, trace.data, trace.size);
        assert_non_null(strstr(lines.text, "\nhash "));
        lines_free(&lines);
        trace_buffer_free(&trace);
        trace_buffer_free(&again);
        remove(path);
    }
}

/* Two requests and no memory: every byte of the hash, from docs/replay.md. */
static void decision_hash_is_as_documented(void **state)
{
    (void)state;
    const uint8_t bytes[] = {
        4, /* set-class */
        5, /* begin */
        1,
        7,
        0,
        0,
        0,
        2,
        0,
        0,
        0, /* take: kind, place */
        7,
        0,
        0,
        0,
        0,
        SLC_REQUEST_LOAD, /* request: result, answer */
        1,
        7,
        0,
        0,
        0,
        255,
        255,
        255,
        255, /* take: there is no other place */
        7,
        0,
        0,
        0,
        0,
        SLC_REQUEST_POSTPONED, /* */
        11,                    /* loaded */
        15,
        40,
        0,
        0,
        0,
        0,
        SLC_SHOW_RESIDENT, /* take-changes: page, class, shown */
        2,
        0,
        0,
        0,
        0,
        0,
        0,
        0,
        1,
        0,
        0,
        0, /* value, and how many */
        13,
        0, /* retry */
    };
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (size_t i = 0; i < sizeof bytes; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001B3);

    struct fake_memory memory;
    struct trace_buffer trace;
    struct slc_demand_residency *residency;
    struct slc_page_change changes[4];
    SluiceRecorder *recorder;
    SluiceResult result;
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    fake_memory_init(&memory, 3, 3);
    memory.taken[0] = memory.taken[1] = true;
    memory.kinds[0] = 7;
    const struct slc_page_memory functions = fake_page_memory(&memory);
    const struct slc_page_residency_create_info info = {.class_count = 1};
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    CHECK_OK(slc_residency_create(&info, &residency));
    CHECK_OK(slc_residency_set_class(residency, 0, 9, &functions));
    CHECK_OK(slc_begin_demand_recording(residency, &writer, NULL, &recorder));
    slc_residency_begin(residency, 1);
    const struct slc_page_request first = {.page = 40, .kind = 7}, second = {.page = 41, .kind = 7};
    assert_int_equal(slc_residency_request(residency, &first, &result), SLC_REQUEST_LOAD);
    assert_int_equal(slc_residency_request(residency, &second, &result), SLC_REQUEST_POSTPONED);
    slc_residency_loaded(residency, 40, 0);
    assert_int_equal(slc_residency_take_changes(residency, changes, 4), 1);
    assert_false(slc_residency_retry(residency, 41));
    CHECK_OK(sluiceEndRecording(recorder));
    slc_residency_destroy(residency);

    const SluiceReplayInfo replay = replay_info(&trace);
    CHECK_OK(sluiceReplay(&replay, &replayed));
    assert_true(replayed.recordedHash == hash);
    assert_true(replayed.decisionHash == hash);
    assert_int_equal(replayed.eventCount, 7);
    trace_buffer_free(&trace);
}

static void a_residency_that_was_used_says_so(void **state)
{
    (void)state;
    struct slc_demand_residency *residency;
    struct trace_buffer trace;
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    const struct slc_page_residency_create_info info = {.class_count = 1};
    CHECK_OK(slc_residency_create(&info, &residency));
    CHECK_OK(slc_residency_set_class(residency, 0, 5, NULL));
    assert_false(slc_residency_is_used(residency));
    CHECK_OK(slc_begin_demand_recording(residency, &writer, NULL, &recorder));
    assert_false(slc_residency_is_used(residency));
    CHECK_OK(sluiceEndRecording(recorder));
    assert_false(slc_residency_is_used(residency));
    slc_residency_prepare(residency, 1);
    assert_true(slc_residency_is_used(residency));
    slc_residency_destroy(residency);
    trace_buffer_free(&trace);
}

/* A resource of byte pages that is added while tiles are loaded already, in a class that a resource
 * of values had before. */
static void a_class_that_gets_memory_while_others_are_used_is_replayed(void **state)
{
    (void)state;
    struct slc_demand_residency *residency;
    struct trace_buffer trace;
    SluiceRecorder *recorder;
    SluiceResult failure;
    struct fake_memory memory[2];
    SluiceReplayResult result = {.structSize = sizeof result};
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    const struct slc_page_residency_create_info info = {.class_count = 2};
    const struct slc_page_request tile = {.page = 5, .class_index = 0};
    const struct slc_page_request bytes = {.page = 20, .class_index = 1};
    CHECK_OK(slc_residency_create(&info, &residency));
    for (uint32_t c = 0; c < 2; c++)
        fake_memory_init(&memory[c], 10, 3);
    const struct slc_page_memory first = fake_page_memory(&memory[0]);
    const struct slc_page_memory second = fake_page_memory(&memory[1]);
    CHECK_OK(slc_residency_set_class(residency, 0, 10, &first));
    CHECK_OK(slc_residency_set_class(residency, 1, 10, NULL));
    CHECK_OK(slc_begin_demand_recording(residency, &writer, NULL, &recorder));
    slc_residency_prepare(residency, 1);
    slc_residency_begin(residency, 1);
    slc_residency_request(residency, &tile, &failure);
    slc_residency_settle(residency, 1);
    CHECK_OK(slc_residency_set_class(residency, 1, 4, &second));
    slc_residency_request(residency, &bytes, &failure);
    CHECK_OK(sluiceEndRecording(recorder));

    const SluiceReplayInfo replay = replay_info(&trace);
    CHECK_OK(sluiceReplay(&replay, &result));
    assert_int_equal(result.divergedEvent, 0);
    assert_true(result.decisionHash == result.recordedHash);
    slc_residency_destroy(residency);
    trace_buffer_free(&trace);
}

static void recording_without_memory_says_so_and_leaks_nothing(void **state)
{
    (void)state;
    SluiceResult status = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; status != SLUICE_SUCCESS; n++) {
        struct demand_app app;
        struct failing_allocator allocator;
        struct trace_buffer trace;
        SluiceRecorder *recorder;
        const SluiceRecordWriter writer = trace_buffer_writer(&trace);
        failing_allocator_init(&allocator, n);
        demand_app_init(&app, 5, false);
        status =
            slc_begin_demand_recording(app.residency, &writer, &allocator.callbacks, &recorder);
        if (status == SLUICE_SUCCESS) {
            demand_app_run(&app, 50); /* goes on whatever becomes of the recording */
            status = sluiceEndRecording(recorder);
        }
        if (status != SLUICE_SUCCESS)
            CHECK_RESULT(status, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(allocator.live_count, 0);
        demand_app_finish(&app);
        trace_buffer_free(&trace);
    }
}

static void replay_without_memory_says_so_and_leaks_nothing(void **state)
{
    (void)state;
    struct trace_buffer trace;
    record_demand_run(&trace, 11, 80, false);
    SluiceReplayInfo info = replay_info(&trace);
    SluiceReplayResult result = {.structSize = sizeof result};
    SluiceResult status = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; status != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        info.pAllocator = &a.callbacks;
        status = sluiceReplay(&info, &result);
        if (status != SLUICE_SUCCESS)
            CHECK_RESULT(status, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(a.live_bytes, 0);
        assert_true(n < 10000);
    }
    assert_true(result.decisionHash == result.recordedHash);
    trace_buffer_free(&trace);
}

static void every_truncation_is_found_at_or_before_the_cut(void **state)
{
    (void)state;
    struct trace_buffer trace;
    record_demand_run(&trace, 21, 240, false);
    assert_true(trace.size > 4500); /* more than one block */
    for (size_t cut = 0; cut < trace.size; cut++) {
        uint8_t *copy = malloc(cut + 1); /* so that reading beyond it is seen */
        assert_non_null(copy);
        memcpy(copy, trace.data, cut);
        SluiceReplayResult result = {.structSize = sizeof result};
        CHECK_RESULT(play_damaged(copy, cut, &result), SLUICE_ERROR_CORRUPT_DATA);
        assert_true(result.errorOffset <= cut);
        free(copy);
    }
    trace_buffer_free(&trace);
}

/* A trace made to do harm has right checksums. */
static void changed_bytes_under_right_checksums_do_no_harm(void **state)
{
    (void)state;
    uint32_t corrupt = 0, played = 0;
    for (uint64_t seed = 23; seed < 26; seed++) {
        struct trace_buffer trace;
        record_demand_run(&trace, seed, 60, false);
        uint8_t *copy = malloc(trace.size);
        assert_non_null(copy);
        for (size_t at = 8; at < trace.size; at++) {
            const uint8_t was = trace.data[at];
            const uint8_t values[] = {was ^ 1, was ^ 2, was ^ 0x80, (uint8_t)(was - 1), 0xFF};
            for (size_t i = 0; i < sizeof values; i++) {
                SluiceReplayResult result = {.structSize = sizeof result};
                memcpy(copy, trace.data, trace.size);
                copy[at] = values[i];
                reseal_trace(copy, trace.size);
                SluiceResult status = play_damaged(copy, trace.size, &result);
                corrupt += status == SLUICE_ERROR_CORRUPT_DATA;
                played += status == SLUICE_SUCCESS;
                if (status == SLUICE_ERROR_CORRUPT_DATA)
                    assert_true(result.errorOffset <= trace.size);
                else if (status != SLUICE_SUCCESS && status != SLUICE_ERROR_UNSUPPORTED)
                    CHECK_RESULT(status, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            }
        }
        free(copy);
        trace_buffer_free(&trace);
    }
    assert_true(corrupt > 100 && played > 100);
}

static void first_divergence_is_named(void **state)
{
    (void)state;
    const size_t first = 40 + 12; /* header, head of the block */
    struct slc_demand_residency *residency;
    struct trace_buffer trace;
    SluiceRecorder *recorder;
    SluiceReplayResult result = {.structSize = sizeof result};
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    const struct slc_page_residency_create_info info = {.class_count = 1};
    CHECK_OK(slc_residency_create(&info, &residency));
    CHECK_OK(slc_begin_demand_recording(residency, &writer, NULL, &recorder));
    for (uint32_t page = 0; page < 3; page++)
        slc_residency_retry(residency, page);
    CHECK_OK(sluiceEndRecording(recorder));
    slc_residency_destroy(residency);
    CHECK_OK(play_damaged(trace.data, trace.size, &result));
    assert_int_equal(result.divergedEvent, 0);

    trace.data[first + 3 + 2] = 1; /* kind, page and answer of the second call */
    reseal_trace(trace.data, trace.size);
    CHECK_OK(play_damaged(trace.data, trace.size, &result));
    assert_int_equal(result.divergedEvent, 2);
    assert_int_equal(result.divergedOffset, first + 3);
    assert_int_equal(result.eventCount, 3);
    trace_buffer_free(&trace);
}

static void newer_version_is_unsupported(void **state)
{
    (void)state;
    struct trace_buffer trace;
    SluiceReplayResult result = {.structSize = sizeof result};
    record_demand_run(&trace, 24, 5, false);
    trace.data[8] = 3;
    reseal_trace(trace.data, trace.size);
    CHECK_RESULT(play_damaged(trace.data, trace.size, &result), SLUICE_ERROR_UNSUPPORTED);
    trace_buffer_free(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_run_replays_to_the_same_decisions),
        cmocka_unit_test(switches_of_a_running_residency_are_replayed),
        cmocka_unit_test(replay_recorded_again_is_the_same_trace),
        cmocka_unit_test(decision_hash_is_as_documented),
        cmocka_unit_test(a_residency_that_was_used_says_so),
        cmocka_unit_test(a_class_that_gets_memory_while_others_are_used_is_replayed),
        cmocka_unit_test(recording_without_memory_says_so_and_leaks_nothing),
        cmocka_unit_test(replay_without_memory_says_so_and_leaks_nothing),
        cmocka_unit_test(every_truncation_is_found_at_or_before_the_cut),
        cmocka_unit_test(changed_bytes_under_right_checksums_do_no_harm),
        cmocka_unit_test(first_divergence_is_named),
        cmocka_unit_test(newer_version_is_unsupported),
    };
    return RUN_TESTS(tests);
}
