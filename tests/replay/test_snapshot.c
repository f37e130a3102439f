/**
 * A recording that begins while the manager is in use. The manager that is recorded is the oracle:
 * a manager made from the snapshot must decide like it, to the last bit, for every call that
 * follows. Calls are made up by two generators that know nothing of snapshots.
 */
#include "core/call_sequence.h"
#include "core/check.h"
#include "random_app.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/replay.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static SluiceReplayInfo replay_info(const struct trace_buffer *trace)
{
    return (SluiceReplayInfo){
        .structSize = sizeof(SluiceReplayInfo), .pData = trace->data, .size = trace->size};
}

static void check_playback(const struct trace_buffer *trace,
                           const SluiceStreamedTextureManager *live, uint64_t seed)
{
    SluiceReplayInfo info = replay_info(trace);
    SluiceReplayResult played = {.structSize = sizeof played};
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    info.pStatistics = &statistics;
    SluiceResult result = sluiceReplay(&info, &played);
    if (result != SLUICE_SUCCESS || played.divergedEvent ||
        played.decisionHash != played.recordedHash)
        fail_msg("seed %llu: %s at byte %llu of %llu; diverged at event %llu",
                 (unsigned long long)seed, sluiceGetResultName(result),
                 (unsigned long long)played.errorOffset, (unsigned long long)trace->size,
                 (unsigned long long)played.divergedEvent);
    check_same_statistics(live, &statistics);
}

/* Random applications ----------------------------------------------------------------------- */

/* Calls that the random application does not make. */
static void extra_call(struct random_app *app)
{
    if (app->id_count == 0)
        return;
    SluiceTextureId id = app->ids[random_app_below(app, app->id_count)];
    const SluiceUvTransform uv = {.scaleU = (float)(1 + random_app_below(app, 3)),
                                  .scaleV = 0.5f,
                                  .offsetU = 0.25f * (float)random_app_below(app, 4),
                                  .wrapU = (SluiceUvWrap)random_app_below(app, 2)};
    switch (random_app_below(app, 10)) {
    case 0:
        sluiceSetTexturePriority(app->manager, id, (int32_t)random_app_below(app, 9) - 4);
        break;
    case 1: sluiceSetUvTransform(app->manager, id, random_app_below(app, 3) ? &uv : NULL); break;
    case 2: sluiceEvictStreamedTexture(app->manager, id, random_app_below(app, 3)); break;
    case 3:
        if (random_app_below(app, 4) == 0)
            sluiceForgetStreamedTexture(app->manager, id, app->retire);
        break;
    default: break;
    }
}

static void run_app(struct random_app *app, uint32_t steps)
{
    for (uint32_t i = 0; i < steps; i++) {
        random_app_run(app, 1);
        extra_call(app);
    }
}

/** Records `steps` steps after `before` steps. The application stays. */
static void record_later(struct random_app *app, struct trace_buffer *trace, uint32_t before,
                         uint32_t steps)
{
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(trace);
    run_app(app, before);
    CHECK_OK(sluiceBeginRecording(app->manager, &writer, NULL, &recorder));
    run_app(app, steps);
    CHECK_OK(sluiceEndRecording(recorder));
}

static void recording_from_any_call_replays_to_the_same_decisions(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct random_app app;
        random_app_init(&app, seed, seed % 2);
        for (uint32_t part = 0; part < 6; part++) {
            struct trace_buffer trace;
            record_later(&app, &trace, 1 + (uint32_t)(seed * 37 + part * 11) % 90, 120);
            check_playback(&trace, app.manager, seed);
            trace_buffer_free(&trace);
        }
        random_app_finish(&app);
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

/* So every field of the snapshot comes back as it was, those that no call has read yet, too. */
static void snapshot_of_a_restored_manager_is_the_same_bytes(void **state)
{
    (void)state;
    const char *path = "test_snapshot.trace";
    for (uint64_t seed = 200; seed < 230; seed++) {
        struct random_app app;
        struct trace_buffer trace, again;
        SluiceReplayResult result = {.structSize = sizeof result};
        random_app_init(&app, seed, false);
        record_later(&app, &trace, 40 + (uint32_t)seed, 30);
        SluiceReplayInfo info = replay_info(&trace);
        info.pRecordPath = path;
        CHECK_OK(sluiceReplay(&info, &result));
        read_back(path, &again);
        assert_int_equal(again.size, trace.size);
        assert_memory_equal(again.data, trace.data, trace.size);
        random_app_finish(&app);
        trace_buffer_free(&trace);
        trace_buffer_free(&again);
        remove(path);
    }
}

static void taking_a_snapshot_changes_no_decision(void **state)
{
    (void)state;
    struct random_app app;
    struct trace_buffer whole, part;
    SluiceRecorder *recorder;
    random_app_init(&app, 9, false);
    record_later(&app, &part, 150, 1); /* and once more below */
    run_app(&app, 150);
    SluiceStreamedTextureStatistics disturbed = {.structSize = sizeof disturbed};
    CHECK_OK(sluiceGetStatistics(app.manager, &disturbed));
    random_app_finish(&app);
    trace_buffer_free(&part);

    const SluiceRecordWriter writer = trace_buffer_writer(&whole);
    random_app_init(&app, 9, false);
    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    run_app(&app, 301);
    CHECK_OK(sluiceEndRecording(recorder));
    check_same_statistics(app.manager, &disturbed);
    random_app_finish(&app);
    trace_buffer_free(&whole);
}

static void recorder_without_memory_says_so_and_leaks_nothing(void **state)
{
    (void)state;
    struct random_app app;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    random_app_init(&app, 6, false);
    run_app(&app, 200);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct trace_buffer trace;
        struct failing_allocator memory;
        SluiceRecorder *recorder;
        const SluiceRecordWriter writer = trace_buffer_writer(&trace);
        failing_allocator_init(&memory, n);
        result = sluiceBeginRecording(app.manager, &writer, &memory.callbacks, &recorder);
        if (result == SLUICE_SUCCESS)
            CHECK_OK(sluiceEndRecording(recorder));
        else
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(memory.live_bytes, 0);
        assert_true(n < 10000);
        trace_buffer_free(&trace);
    }
    random_app_finish(&app);
}

static void replay_without_memory_says_so_and_leaks_nothing(void **state)
{
    (void)state;
    struct random_app app;
    struct trace_buffer trace;
    SluiceReplayResult result = {.structSize = sizeof result};
    SluiceResult status = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    random_app_init(&app, 11, false);
    record_later(&app, &trace, 250, 10);
    random_app_finish(&app);
    SluiceReplayInfo info = replay_info(&trace);
    for (uint64_t n = 0; status != SLUICE_SUCCESS; n++) {
        struct failing_allocator memory;
        failing_allocator_init(&memory, n);
        info.pAllocator = &memory.callbacks;
        status = sluiceReplay(&info, &result);
        if (status != SLUICE_SUCCESS)
            CHECK_RESULT(status, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(memory.live_bytes, 0);
        assert_true(n < 100000);
    }
    assert_true(result.decisionHash == result.recordedHash);
    trace_buffer_free(&trace);
}

/* Sequences that are compared with the naive manager elsewhere ------------------------------- */

enum { MAX_HEAPS = 1024 };

static struct run {
    struct call_sequence sequence;
    struct naive_manager naive;
    SluiceStreamedTextureManager *manager;
    struct failing_allocator memory;
    struct call call;
    struct outcome outcome, expected;
    uint32_t heaps[MAX_HEAPS], heap_count;
} run;

static SluiceResult give_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)user, (void)size;
    struct heap_answer answer = call_sequence_heap_answer(&run.sequence, run.heaps, run.heap_count);
    assert_true(run.outcome.answer_count < CALL_MAX_ROOM);
    run.outcome.answers[run.outcome.answer_count++] = answer;
    *heap_id = answer.id;
    for (uint32_t i = 0; i < run.heap_count; i++)
        if (run.heaps[i] == answer.id)
            return answer.result;
    assert_true(run.heap_count < MAX_HEAPS);
    if (answer.result == SLUICE_SUCCESS)
        run.heaps[run.heap_count++] = answer.id;
    return answer.result;
}

static void take_heap(void *user, uint32_t heap_id)
{
    (void)user;
    for (uint32_t i = 0; i < run.heap_count; i++)
        if (run.heaps[i] == heap_id)
            run.heaps[i--] = run.heaps[--run.heap_count];
}

static void make_calls(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        call_sequence_next(&run.sequence, &run.naive, &run.call);
        run.call.refuse_after = UINT64_MAX;
        run.outcome.answer_count = 0;
        run.outcome.memory_refused = false;
        call_make(run.manager, &run.call, &run.outcome);
        naive_call(&run.naive, &run.call, &run.outcome, &run.expected);
    }
}

static void sequence_recorded_from_any_call_plays_back(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 250; seed++) {
        struct trace_buffer trace;
        const SluiceRecordWriter writer = trace_buffer_writer(&trace);
        SluiceRecorder *recorder;
        call_sequence_start(&run.sequence,
                            (struct choice){.state = seed * 0xD1342543DE82EF95u + 1});
        naive_init(&run.naive, run.sequence.capacity, run.sequence.always_packed);
        run.heap_count = 0;
        failing_allocator_init(&run.memory, UINT64_MAX);
        const SluiceStreamedTextureManagerCreateInfo info = {
            .structSize = sizeof info,
            .heapAllocator = {NULL, give_heap, take_heap},
            .pAllocator = &run.memory.callbacks,
            .heapTileCapacity = run.sequence.capacity,
            .tileSize = SLUICE_DEFAULT_TILE_SIZE,
            .alwaysMapPackedTiles = run.sequence.always_packed,
        };
        CHECK_OK(sluiceCreateStreamedTextureManager(&info, &run.manager));
        make_calls(1 + (uint32_t)(seed * 7919) % 250);
        CHECK_OK(sluiceBeginRecording(run.manager, &writer, NULL, &recorder));
        make_calls(150);
        CHECK_OK(sluiceEndRecording(recorder));
        check_playback(&trace, run.manager, seed);
        sluiceDestroyStreamedTextureManager(run.manager);
        naive_finish(&run.naive);
        trace_buffer_free(&trace);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recording_from_any_call_replays_to_the_same_decisions),
        cmocka_unit_test(sequence_recorded_from_any_call_plays_back),
        cmocka_unit_test(snapshot_of_a_restored_manager_is_the_same_bytes),
        cmocka_unit_test(taking_a_snapshot_changes_no_decision),
        cmocka_unit_test(recorder_without_memory_says_so_and_leaks_nothing),
        cmocka_unit_test(replay_without_memory_says_so_and_leaks_nothing),
    };
    return RUN_TESTS(tests);
}
