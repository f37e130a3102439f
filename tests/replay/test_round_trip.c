#include "lines.h"
#include "random_app.h"

#include "core/observer.h"
#include "support/test.h"
#include "support/thin_heaps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 600
#define RUNS 60

static SluiceReplayInfo replay_info(const struct trace_buffer *trace)
{
    return (SluiceReplayInfo){
        .structSize = sizeof(SluiceReplayInfo), .pData = trace->data, .size = trace->size};
}

static void random_run_replays_to_the_same_decisions(void **state)
{
    (void)state;
    uint64_t kinds_made = 0, kinds_good = 0;
    uint32_t out_of_memory = 0, refused_heaps = 0;
    for (uint64_t seed = 0; seed < RUNS; seed++) {
        struct random_app app;
        struct trace_buffer trace;
        SluiceRecorder *recorder;
        const SluiceRecordWriter writer = trace_buffer_writer(&trace);
        random_app_init(&app, seed, true);
        CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
        random_app_run(&app, STEPS);
        CHECK_OK(sluiceEndRecording(recorder));

        SluiceReplayResult result = {.structSize = sizeof result};
        SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
        SluiceReplayInfo info = replay_info(&trace);
        info.pStatistics = &statistics;
        CHECK_OK(sluiceReplay(&info, &result));
        assert_int_equal(result.divergedEvent, 0);
        assert_true(result.decisionHash == result.recordedHash);
        assert_true(result.eventCount >= STEPS);
        check_same_statistics(app.manager, &statistics);

        kinds_made |= app.kinds_made;
        kinds_good |= app.kinds_good;
        out_of_memory += app.out_of_memory_count;
        refused_heaps += app.refused_heap_count;
        random_app_finish(&app);
        trace_buffer_free(&trace);
    }
    /* Else the runs were too tame to show anything. */
    assert_true(kinds_made == (UINT64_C(1) << SLC_CALL_HEAP_ANSWER) - 2);
    assert_true(kinds_good == kinds_made);
    assert_true(out_of_memory > 10);
    assert_true(refused_heaps > 10);
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

static void replay_recorded_again_is_the_same_trace_with_the_same_dump(void **state)
{
    (void)state;
    const char *path = "test_round_trip.trace";
    for (uint64_t seed = 100; seed < 110; seed++) {
        struct trace_buffer trace, again;
        struct lines first = {0}, second = {0};
        SluiceReplayResult result = {.structSize = sizeof result},
                           result_again = {.structSize = sizeof result_again};
        record_random_run(&trace, seed, STEPS, false);
        SluiceReplayInfo info = replay_info(&trace);
        info.pUserData = &first;
        info.pfnLine = lines_take;
        info.pRecordPath = path;
        CHECK_OK(sluiceReplay(&info, &result));
        read_back(path, &again);
        assert_int_equal(again.size, trace.size);
        assert_memory_equal(again.data, trace.data, trace.size);

        info = replay_info(&again);
        info.pUserData = &second;
        info.pfnLine = lines_take;
        CHECK_OK(sluiceReplay(&info, &result_again));
        assert_true(result.decisionHash == result_again.decisionHash);
        assert_string_equal(first.text, second.text);
        assert_non_null(strstr(first.text, "\nhash "));
        lines_free(&first);
        lines_free(&second);
        trace_buffer_free(&trace);
        trace_buffer_free(&again);
        remove(path);
    }
}

static void dump_does_not_change_the_hash(void **state)
{
    (void)state;
    struct trace_buffer trace;
    struct lines lines = {0};
    SluiceReplayResult with = {.structSize = sizeof with}, without = {.structSize = sizeof without};
    record_random_run(&trace, 7, STEPS, true);
    SluiceReplayInfo info = replay_info(&trace);
    CHECK_OK(sluiceReplay(&info, &without));
    info.pfnLine = lines_take;
    info.pUserData = &lines;
    CHECK_OK(sluiceReplay(&info, &with));
    assert_true(with.decisionHash == without.decisionHash);
    assert_int_equal(with.eventCount, without.eventCount);
    lines_free(&lines);
    trace_buffer_free(&trace);
}

static void replay_without_memory_says_so_and_leaks_nothing(void **state)
{
    (void)state;
    struct trace_buffer trace;
    record_random_run(&trace, 11, 150, false);
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
        assert_true(n < 100000);
    }
    assert_true(result.decisionHash == result.recordedHash);
    trace_buffer_free(&trace);
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    SluiceReplayInfo info = {.structSize = sizeof info, .size = 0};
    SluiceReplayResult result = {.structSize = sizeof result};
    CHECK_RESULT(sluiceReplay(NULL, &result), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceReplay(&info, &result), SLUICE_ERROR_NULL_POINTER);
    info.pData = "";
    CHECK_RESULT(sluiceReplay(&info, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceReplay(&info, &result), SLUICE_ERROR_CORRUPT_DATA);
    const SluiceAllocationCallbacks half = {NULL, NULL, NULL};
    info.pAllocator = &half;
    CHECK_RESULT(sluiceReplay(&info, &result), SLUICE_ERROR_INVALID_ARGUMENT);
}

static SluiceResult next_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)size;
    *heap_id = (*(uint32_t *)user)++;
    return SLUICE_SUCCESS;
}

static void ignore_heap(void *user, uint32_t heap_id)
{
    (void)user;
    (void)heap_id;
}

static void more_moves_than_tiles_replay(void **state)
{
    (void)state;
    uint32_t heap_count = 0;
    const SluiceStreamedTextureManagerCreateInfo create = {
        .structSize = sizeof create,
        .heapAllocator = {&heap_count, next_heap, ignore_heap},
        .heapTileCapacity = THIN_HEAPS_CAPACITY,
        .tileSize = 1,
    };
    SluiceStreamedTextureManager *manager;
    SluiceRecorder *recorder;
    struct trace_buffer trace;
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    CHECK_OK(sluiceCreateStreamedTextureManager(&create, &manager));
    CHECK_OK(sluiceBeginRecording(manager, &writer, NULL, &recorder));
    thin_heaps_make(manager);
    SluiceTileMove moves[64];
    uint32_t count = 64;
    CHECK_OK(sluiceDefragmentTiles(manager, 7, &count, moves));
    assert_int_equal(count, THIN_HEAPS_MOVES);
    CHECK_OK(sluiceEndRecording(recorder));
    sluiceDestroyStreamedTextureManager(manager);

    SluiceReplayResult result = {.structSize = sizeof result};
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    SluiceReplayInfo info = replay_info(&trace);
    info.pStatistics = &statistics;
    CHECK_OK(sluiceReplay(&info, &result));
    assert_int_equal(result.divergedEvent, 0);
    assert_true(statistics.movedTotal == THIN_HEAPS_MOVES);
    trace_buffer_free(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_run_replays_to_the_same_decisions),
        cmocka_unit_test(replay_recorded_again_is_the_same_trace_with_the_same_dump),
        cmocka_unit_test(dump_does_not_change_the_hash),
        cmocka_unit_test(replay_without_memory_says_so_and_leaks_nothing),
        cmocka_unit_test(more_moves_than_tiles_replay),
        cmocka_unit_test(null_pointers_are_refused),
    };
    return RUN_TESTS(tests);
}
