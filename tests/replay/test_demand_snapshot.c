/**
 * Recordings of demand loading that begin during use. The recorded residency is the oracle: one
 * made from the snapshot must decide every later call alike.
 */
#include "damage.h"
#include "demand_app.h"

#include "demand/page_observer.h"
#include "replay/demand_recorder.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void record_later(struct demand_app *app, struct trace_buffer *trace, uint32_t before,
                         uint32_t steps)
{
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(trace);
    demand_app_run(app, before);
    CHECK_OK(slc_begin_demand_recording(app->residency, &writer, NULL, &recorder));
    demand_app_run(app, steps);
    CHECK_OK(sluiceEndRecording(recorder));
}

/** Records a new application, which is then destroyed. */
static struct trace_buffer record_late_run_of(uint64_t seed, uint32_t before, uint32_t steps)
{
    struct demand_app app;
    struct trace_buffer trace;
    demand_app_init(&app, seed, false);
    record_later(&app, &trace, before, steps);
    demand_app_finish(&app);
    assert_int_equal(trace.data[8], 2);
    return trace;
}

static void check_counts(const struct demand_app *app, const SluiceReplayResult *result)
{
    uint64_t resident = 0, loading = 0, evicted = 0, restored = 0;
    for (uint32_t c = 0; c < DEMAND_APP_CLASSES; c++) {
        struct slc_residency_counts counts;
        slc_residency_get_counts(app->residency, c, &counts);
        resident += counts.resident;
        loading += counts.loading;
        evicted += counts.evicted;
        restored += counts.restored;
    }
    assert_true(result->demand.residentCount == resident && result->demand.loadingCount == loading);
    assert_true(result->demand.evictedCount == evicted && result->demand.restoredCount == restored);
}

static void recording_from_any_call_replays_to_the_same_decisions(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct demand_app app;
        demand_app_init(&app, seed, seed % 2);
        demand_app_run(&app, 20); /* it is in use then */
        for (uint32_t part = 0; part < 8; part++) {
            struct trace_buffer trace;
            SluiceReplayResult result = {.structSize = sizeof result};
            if (part == 4)
                slc_residency_set_switches(app.residency, seed % 4 == 1, seed % 4 == 2);
            record_later(&app, &trace, (uint32_t)(seed * 37 + part * 11) % 90, 120);
            const SluiceReplayInfo info = {
                .structSize = sizeof info, .pData = trace.data, .size = trace.size};
            CHECK_OK(sluiceReplay(&info, &result));
            assert_int_equal(trace.data[8], 2);
            assert_int_equal(result.divergedEvent, 0);
            assert_true(result.decisionHash == result.recordedHash);
            check_counts(&app, &result);
            trace_buffer_free(&trace);
        }
        demand_app_finish(&app);
    }
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

static void snapshot_of_restored_demand_loading_is_the_same_bytes(void **state)
{
    (void)state;
    const char *path = "test_demand_snapshot.trace";
    for (uint64_t seed = 200; seed < 230; seed++) {
        struct trace_buffer trace = record_late_run_of(seed, 40 + (uint32_t)seed, 30), again;
        SluiceReplayResult result = {.structSize = sizeof result};
        const SluiceReplayInfo info = {.structSize = sizeof info,
                                       .pData = trace.data,
                                       .size = trace.size,
                                       .pRecordPath = path};
        CHECK_OK(sluiceReplay(&info, &result));
        read_back(path, &again);
        assert_int_equal(again.size, trace.size);
        assert_memory_equal(again.data, trace.data, trace.size);
        trace_buffer_free(&trace);
        trace_buffer_free(&again);
        remove(path);
    }
}

static void refused_memory_is_said_and_nothing_leaks(void **state)
{
    (void)state;
    struct demand_app app;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    demand_app_init(&app, 6, false);
    demand_app_run(&app, 300);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct trace_buffer trace;
        struct failing_allocator memory;
        SluiceRecorder *recorder;
        const SluiceRecordWriter writer = trace_buffer_writer(&trace);
        failing_allocator_init(&memory, n);
        result = slc_begin_demand_recording(app.residency, &writer, &memory.callbacks, &recorder);
        if (result == SLUICE_SUCCESS)
            CHECK_OK(sluiceEndRecording(recorder));
        else
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(memory.live_bytes, 0);
        trace_buffer_free(&trace);
    }
    demand_app_finish(&app);

    struct trace_buffer trace = record_late_run_of(11, 300, 10);
    result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator memory;
        SluiceReplayResult replayed = {.structSize = sizeof replayed};
        failing_allocator_init(&memory, n);
        const SluiceReplayInfo info = {.structSize = sizeof info,
                                       .pData = trace.data,
                                       .size = trace.size,
                                       .pAllocator = &memory.callbacks};
        result = sluiceReplay(&info, &replayed);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(memory.live_bytes, 0);
    }
    trace_buffer_free(&trace);
}

static void every_truncation_is_found_at_or_before_the_cut(void **state)
{
    (void)state;
    struct trace_buffer trace = record_late_run_of(21, 240, 10);
    for (size_t cut = 0; cut < trace.size; cut++) {
        uint8_t *copy =
            malloc(cut + 1); /* exactly sized, so that sanitizers see a read beyond the end */
        assert_non_null(copy);
        memcpy(copy, trace.data, cut);
        SluiceReplayResult result = {.structSize = sizeof result};
        CHECK_RESULT(play_damaged(copy, cut, &result), SLUICE_ERROR_CORRUPT_DATA);
        assert_true(result.errorOffset <= cut);
        free(copy);
    }
    trace_buffer_free(&trace);
}

static void changed_bytes_under_right_checksums_do_no_harm(void **state)
{
    (void)state;
    uint32_t corrupt = 0, played = 0;
    for (uint64_t seed = 23; seed < 24; seed++) {
        struct trace_buffer trace = record_late_run_of(seed, 240, 40);
        uint8_t *copy = malloc(trace.size);
        assert_non_null(copy);
        for (size_t at = 8; at < trace.size; at++) {
            const uint8_t was = trace.data[at];
            const uint8_t values[] = {was ^ 1, was ^ 0x80, (uint8_t)(was - 1), 0xFF};
            for (size_t i = 0; i < sizeof values; i++) {
                SluiceReplayResult result = {.structSize = sizeof result};
                memcpy(copy, trace.data, trace.size);
                copy[at] = values[i];
                reseal_trace(copy, trace.size);
                SluiceResult status = play_damaged(copy, trace.size, &result);
                corrupt += status == SLUICE_ERROR_CORRUPT_DATA;
                played += status == SLUICE_SUCCESS;
                if (status != SLUICE_SUCCESS && status != SLUICE_ERROR_UNSUPPORTED &&
                    status != SLUICE_ERROR_CORRUPT_DATA)
                    CHECK_RESULT(status, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            }
        }
        free(copy);
        trace_buffer_free(&trace);
    }
    assert_true(corrupt > 100 && played > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recording_from_any_call_replays_to_the_same_decisions),
        cmocka_unit_test(snapshot_of_restored_demand_loading_is_the_same_bytes),
        cmocka_unit_test(refused_memory_is_said_and_nothing_leaks),
        cmocka_unit_test(every_truncation_is_found_at_or_before_the_cut),
        cmocka_unit_test(changed_bytes_under_right_checksums_do_no_harm),
    };
    return RUN_TESTS(tests);
}
