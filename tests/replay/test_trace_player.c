/**
 * Recordings played call by call. The oracle is sluiceReplay: of a trace that is cut, it gives the
 * state behind the calls before the cut, and its text dump names every call.
 */
#include "damage.h"
#include "random_app.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/replay.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 500

static SluiceTracePlayer *open_player(const struct trace_buffer *trace)
{
    const SluiceTracePlayerCreateInfo info = {.structSize = sizeof info,
                                              .pData = trace->data,
                                              .size = trace->size,
                                              .tileEventCapacity = 64};
    SluiceTracePlayer *player = NULL;
    CHECK_OK(sluiceCreateTracePlayer(&info, &player));
    return player;
}

static SluiceTracePlayerState state_of(const SluiceTracePlayer *player)
{
    SluiceTracePlayerState state = {.structSize = sizeof state};
    CHECK_OK(sluiceGetTracePlayerState(player, &state));
    return state;
}

/* Field by field: padding is undefined. */
static void check_same_state(const SluiceTracePlayerState *a, const SluiceTracePlayerState *b)
{
    assert_int_equal(a->formatVersion, b->formatVersion);
    assert_int_equal(a->libraryVersion, b->libraryVersion);
    assert_int_equal(a->heapTileCapacity, b->heapTileCapacity);
    assert_int_equal(a->tileSize, b->tileSize);
    assert_int_equal(a->alwaysMapPackedTiles, b->alwaysMapPackedTiles);
    assert_int_equal(a->offset, b->offset);
    assert_int_equal(a->eventCount, b->eventCount);
    assert_true(a->decisionHash == b->decisionHash && a->recordedHash == b->recordedHash);
    assert_int_equal(a->divergedEvent, b->divergedEvent);
    assert_int_equal(a->divergedOffset, b->divergedOffset);
    assert_int_equal(a->errorOffset, b->errorOffset);
    assert_int_equal(a->maxHeapCount, b->maxHeapCount);
    assert_int_equal(a->targetHeapCount, b->targetHeapCount);
    assert_int_equal(a->numExtraStandbyTiles, b->numExtraStandbyTiles);
}

static SluiceTraceCall next_of(SluiceTracePlayer *player)
{
    SluiceTraceCall call = {.structSize = sizeof call};
    CHECK_OK(sluiceGetNextTraceCall(player, &call));
    return call;
}

static void play_to(SluiceTracePlayer *player, uint64_t event)
{
    while (state_of(player).eventCount < event)
        CHECK_OK(sluicePlayTraceCall(player));
}

static const SluiceStreamedTextureManager *manager_of(SluiceTracePlayer *player)
{
    SluiceStreamedTextureManager *manager = NULL;
    CHECK_OK(sluiceGetTracePlayerManager(player, &manager));
    return manager;
}

static struct trace_buffer checkpoint_of(SluiceTracePlayer *player)
{
    struct trace_buffer buffer;
    const SluiceRecordWriter writer = trace_buffer_writer(&buffer);
    CHECK_OK(sluiceWriteTraceCheckpoint(player, &writer));
    return buffer;
}

/* Half of the recordings begin with a snapshot. */
static struct trace_buffer record_steps(uint64_t seed, uint32_t steps)
{
    struct trace_buffer trace;
    if (seed % 2)
        record_late_run(&trace, seed, 40, steps);
    else
        record_random_run(&trace, seed, steps, seed % 3 == 0);
    return trace;
}

static struct trace_buffer record_run(uint64_t seed)
{
    return record_steps(seed, STEPS);
}

static void state_is_that_of_a_replay_that_is_cut_there(void **state)
{
    (void)state;
    uint32_t places = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        struct trace_buffer trace = record_steps(seed, 4000);
        SluiceTracePlayer *player = open_player(&trace);
        for (size_t cut = 0; cut < trace.size; cut += 4000) {
            SluiceReplayResult result = {.structSize = sizeof result};
            SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
            const SluiceReplayInfo info = {.structSize = sizeof info,
                                           .pData = trace.data,
                                           .size = cut,
                                           .pStatistics = &statistics};
            CHECK_RESULT(sluiceReplay(&info, &result), SLUICE_ERROR_CORRUPT_DATA);
            if (result.eventCount == 0)
                continue;
            play_to(player, result.eventCount);
            assert_true(state_of(player).decisionHash == result.decisionHash);
            check_same_statistics(manager_of(player), &statistics);
            places++;
        }
        sluiceDestroyTracePlayer(player);
        trace_buffer_free(&trace);
    }
    assert_true(places > 50);
}

/* The dump has a line "12 get-tiles-to-map ..." for each call, in front of what came of it. */
struct dumped {
    SluiceTracePlayer *player;
    uint32_t calls, named;
};

static const char *name_of(SluiceTraceCallKind kind)
{
    switch (kind) {
    case SLUICE_TRACE_CALL_UPDATE_FEEDBACK: return "update-feedback";
    case SLUICE_TRACE_CALL_GET_TILES_TO_MAP: return "get-tiles-to-map";
    case SLUICE_TRACE_CALL_UPDATE_MAPPING: return "update-mapping";
    case SLUICE_TRACE_CALL_COMPLETE_RETIRE: return "complete-retire";
    case SLUICE_TRACE_CALL_GET_TILES_TO_UNMAP: return "get-tiles-to-unmap";
    case SLUICE_TRACE_CALL_GET_MINMIP_UPDATES: return "get-minmip-updates";
    default: return NULL;
    }
}

static void compare_line(void *user, const char *line)
{
    struct dumped *dumped = user;
    uint64_t event, value;
    char word[64] = "";
    if (sscanf(line, "%" SCNu64 " %63s", &event, word) != 2 ||
        event != state_of(dumped->player).eventCount + 1)
        return;
    const SluiceTraceCall call = next_of(dumped->player);
    const char *name = name_of(call.kind), *at;
    dumped->calls++;
    if (name) {
        assert_string_equal(word, name);
        dumped->named++;
    }
    if ((at = strstr(line, " retire=")) && sscanf(at, " retire=%" SCNu64, &value) == 1)
        assert_true(call.retireValue == value);
    if ((at = strstr(line, " time=")) && sscanf(at, " time=%" SCNu64, &value) == 1)
        assert_true(call.hasTimeStamp && call.timeStamp == value);
    CHECK_OK(sluicePlayTraceCall(dumped->player));
}

static void calls_are_those_of_the_dump(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        struct trace_buffer trace = record_run(seed);
        struct dumped dumped = {.player = open_player(&trace)};
        SluiceReplayResult result = {.structSize = sizeof result};
        const SluiceReplayInfo info = {.structSize = sizeof info,
                                       .pData = trace.data,
                                       .size = trace.size,
                                       .pUserData = &dumped,
                                       .pfnLine = compare_line};
        CHECK_OK(sluiceReplay(&info, &result));
        assert_int_equal(dumped.calls, result.eventCount);
        assert_true(dumped.named > dumped.calls / 4);
        assert_int_equal(next_of(dumped.player).kind, SLUICE_TRACE_CALL_NONE);
        CHECK_OK(sluicePlayTraceCall(dumped.player)); /* nothing is left to play */
        const SluiceTracePlayerState end = state_of(dumped.player);
        assert_int_equal(end.eventCount, result.eventCount);
        assert_true(end.recordedHash == result.recordedHash);
        assert_true(end.decisionHash == result.decisionHash && end.divergedEvent == 0);
        sluiceDestroyTracePlayer(dumped.player);
        trace_buffer_free(&trace);
    }
}

/* From every checkpoint, in an order of jumps that goes both ways. */
static void a_checkpoint_goes_on_as_the_first_pass_did(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 10; seed++) {
        enum { COUNT = 12 };
        struct trace_buffer trace = record_run(seed), kept[COUNT];
        SluiceTracePlayer *player = open_player(&trace);
        uint64_t hashes[COUNT];
        for (uint64_t i = 0; i < COUNT; i++) {
            play_to(player, 35 * i);
            if (i % 2)
                (void)next_of(player); /* a call that was looked at is not lost */
            hashes[i] = state_of(player).decisionHash;
            kept[i] = checkpoint_of(player);
        }
        for (uint32_t jump = 0; jump < 2 * COUNT; jump++) {
            const uint32_t i = jump * 7 % COUNT;
            CHECK_OK(sluiceReadTraceCheckpoint(player, kept[i].data, kept[i].size));
            assert_int_equal(state_of(player).eventCount, 35 * i);
            assert_true(state_of(player).decisionHash == hashes[i]);
            struct trace_buffer again = checkpoint_of(player);
            assert_int_equal(again.size, kept[i].size);
            assert_memory_equal(again.data, kept[i].data, again.size);
            trace_buffer_free(&again);
            while (next_of(player).kind != SLUICE_TRACE_CALL_NONE)
                CHECK_OK(sluicePlayTraceCall(player));
            assert_int_equal(state_of(player).divergedEvent, 0);
            assert_true(state_of(player).decisionHash == state_of(player).recordedHash);
        }
        for (uint32_t i = 0; i < COUNT; i++)
            trace_buffer_free(&kept[i]);
        sluiceDestroyTracePlayer(player);
        trace_buffer_free(&trace);
    }
}

static void a_checkpoint_of_the_end_leads_back_to_the_end(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 4; seed++) {
        struct trace_buffer trace = record_run(seed);
        SluiceTracePlayer *player = open_player(&trace);
        while (next_of(player).kind != SLUICE_TRACE_CALL_NONE)
            CHECK_OK(sluicePlayTraceCall(player));
        const SluiceTracePlayerState end = state_of(player);
        struct trace_buffer kept = checkpoint_of(player);
        assert_int_equal(next_of(player).kind, SLUICE_TRACE_CALL_NONE);
        CHECK_OK(sluiceReadTraceCheckpoint(player, kept.data, kept.size));
        assert_int_equal(next_of(player).kind, SLUICE_TRACE_CALL_NONE);
        CHECK_OK(sluicePlayTraceCall(player));
        const SluiceTracePlayerState again = state_of(player);
        check_same_state(&again, &end);
        trace_buffer_free(&kept);
        sluiceDestroyTracePlayer(player);
        trace_buffer_free(&trace);
    }
}

static void check_textures(SluiceTracePlayer *player)
{
    SluiceStreamedTextureStatistics now = {.structSize = sizeof now};
    SluiceTextureId ids[RANDOM_APP_TEXTURES];
    uint32_t count = 0, room = RANDOM_APP_TEXTURES;
    CHECK_OK(sluiceGetStatistics(manager_of(player), &now));
    CHECK_OK(sluiceGetTracePlayerTextures(player, &count, NULL));
    assert_int_equal(count, now.textureCount);
    CHECK_OK(sluiceGetTracePlayerTextures(player, &room, ids));
    assert_int_equal(room, count);
    for (uint32_t i = 0; i < count; i++) {
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        CHECK_OK(sluiceGetTextureLayout(manager_of(player), ids[i], &layout));
        assert_true(i == 0 || (uint32_t)ids[i] > (uint32_t)ids[i - 1]);
    }
    room = count - 1;
    if (count > 0)
        CHECK_RESULT(sluiceGetTracePlayerTextures(player, &room, ids), SLUICE_INCOMPLETE);
}

static void textures_are_listed_while_they_live(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(3);
    SluiceTracePlayer *player = open_player(&trace);
    while (next_of(player).kind != SLUICE_TRACE_CALL_NONE) {
        CHECK_OK(sluicePlayTraceCall(player));
        check_textures(player);
    }
    sluiceDestroyTracePlayer(player);
    trace_buffer_free(&trace);
}

static void tile_events_are_kept_behind_a_checkpoint_too(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(2);
    SluiceTracePlayer *player = open_player(&trace);
    struct trace_buffer begin = checkpoint_of(player);
    uint64_t totals[2];
    for (int pass = 0; pass < 2; pass++) {
        uint64_t cursor = 0, lost = 0;
        uint32_t none = 0;
        play_to(player, 300);
        (void)sluiceReadTileEvents(manager_of(player), &cursor, &none, NULL, &lost);
        SluiceTileEvent events[64];
        uint32_t count = 64;
        CHECK_OK(sluiceReadTileEvents(manager_of(player), &cursor, &count, events, NULL));
        totals[pass] = cursor;
        assert_true(count > 0);
        CHECK_OK(sluiceReadTraceCheckpoint(player, begin.data, begin.size));
    }
    assert_int_equal(totals[0], totals[1]);
    trace_buffer_free(&begin);
    sluiceDestroyTracePlayer(player);
    trace_buffer_free(&trace);
}

static void note_message(void *user, SluiceLogSeverity severity, const char *message)
{
    if (severity >= SLUICE_LOG_WARNING)
        snprintf(user, 200, "%s", message);
}

static void check_refused(const void *data, size_t size, SluiceResult result, const char *words)
{
    char message[200] = "";
    const SluiceTracePlayerCreateInfo info = {
        .structSize = sizeof info, .pData = data, .size = size, .log = {message, note_message}};
    SluiceTracePlayer *player = (void *)message;
    CHECK_RESULT(sluiceCreateTracePlayer(&info, &player), result);
    assert_null(player);
    if (!strstr(message, words))
        fail_msg("\"%s\" lacks \"%s\"", message, words);
}

static void what_is_no_recording_of_a_manager_is_refused_by_name(void **state)
{
    (void)state;
    check_refused("", 0, SLUICE_ERROR_CORRUPT_DATA, "byte 0");
    check_refused("SLUICER", 7, SLUICE_ERROR_CORRUPT_DATA, "byte 0");
    check_refused("SLUICERT", 8, SLUICE_ERROR_CORRUPT_DATA, "byte 8");
    check_refused("SLUICEDR    ", 12, SLUICE_ERROR_UNSUPPORTED, "demand loading");
    check_refused("SLTRACE1    ", 12, SLUICE_ERROR_UNSUPPORTED, "feedback trace");
}

static void a_cut_recording_plays_up_to_the_cut(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(4);
    for (size_t cut = 40; cut < trace.size; cut += 997) {
        SluiceReplayResult result = {.structSize = sizeof result};
        const SluiceReplayInfo info = {.structSize = sizeof info, .pData = trace.data, .size = cut};
        CHECK_RESULT(sluiceReplay(&info, &result), SLUICE_ERROR_CORRUPT_DATA);
        const struct trace_buffer part = {.data = trace.data, .size = cut};
        SluiceTracePlayer *player = open_player(&part);
        SluiceResult played = SLUICE_SUCCESS;
        for (uint32_t i = 0; i < 100000 && played == SLUICE_SUCCESS; i++)
            played = sluicePlayTraceCall(player);
        CHECK_RESULT(played, SLUICE_ERROR_CORRUPT_DATA);
        CHECK_RESULT(sluicePlayTraceCall(player), SLUICE_ERROR_CORRUPT_DATA);
        assert_int_equal(state_of(player).eventCount, result.eventCount);
        assert_int_equal(state_of(player).errorOffset, result.errorOffset);
        assert_true(state_of(player).decisionHash == result.decisionHash);
        sluiceDestroyTracePlayer(player);
    }
    trace_buffer_free(&trace);
}

static void a_damaged_checkpoint_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(1);
    SluiceTracePlayer *player = open_player(&trace);
    play_to(player, 200);
    struct trace_buffer kept = checkpoint_of(player);
    play_to(player, 220);
    const SluiceTracePlayerState before = state_of(player);
    for (size_t at = 0; at + 28 < kept.size; at++) { /* its end mark is not read */
        kept.data[at] ^= 1;
        CHECK_RESULT(sluiceReadTraceCheckpoint(player, kept.data, kept.size),
                     SLUICE_ERROR_CORRUPT_DATA);
        kept.data[at] ^= 1;
    }
    for (size_t cut = 0; cut + 28 < kept.size; cut++)
        CHECK_RESULT(sluiceReadTraceCheckpoint(player, kept.data, cut), SLUICE_ERROR_CORRUPT_DATA);
    const SluiceTracePlayerState after = state_of(player);
    check_same_state(&before, &after);
    while (next_of(player).kind != SLUICE_TRACE_CALL_NONE)
        CHECK_OK(sluicePlayTraceCall(player));
    assert_true(state_of(player).decisionHash == state_of(player).recordedHash);
    trace_buffer_free(&kept);
    sluiceDestroyTracePlayer(player);
    trace_buffer_free(&trace);
}

static SluiceResult try_all(const struct trace_buffer *trace, struct failing_allocator *memory)
{
    const SluiceTracePlayerCreateInfo info = {.structSize = sizeof info,
                                              .pData = trace->data,
                                              .size = trace->size,
                                              .pAllocator = &memory->callbacks,
                                              .tileEventCapacity = 16};
    SluiceTraceCall call = {.structSize = sizeof call};
    struct trace_buffer kept;
    const SluiceRecordWriter writer = trace_buffer_writer(&kept);
    SluiceTracePlayer *player;
    SluiceResult result = sluiceCreateTracePlayer(&info, &player);
    for (uint32_t i = 0; i < 60 && result == SLUICE_SUCCESS; i++)
        result = sluicePlayTraceCall(player);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetNextTraceCall(player, &call);
    if (result == SLUICE_SUCCESS)
        result = sluiceWriteTraceCheckpoint(player, &writer);
    if (result == SLUICE_SUCCESS)
        result = sluiceReadTraceCheckpoint(player, kept.data, kept.size);
    sluiceDestroyTracePlayer(player);
    trace_buffer_free(&kept);
    return result;
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(5);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t refused = 0;
    for (; result == SLUICE_ERROR_OUT_OF_HOST_MEMORY; refused++) {
        struct failing_allocator memory;
        failing_allocator_init(&memory, refused);
        result = try_all(&trace, &memory);
        assert_int_equal(memory.live_count, 0);
    }
    CHECK_OK(result);
    assert_true(refused > 20);
    trace_buffer_free(&trace);
}

static void questions_take_no_memory(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(7);
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    const SluiceTracePlayerCreateInfo info = {.structSize = sizeof info,
                                              .pData = trace.data,
                                              .size = trace.size,
                                              .pAllocator = &memory.callbacks};
    SluiceStreamedTextureManager *manager;
    SluiceTracePlayer *player;
    SluiceTextureId ids[RANDOM_APP_TEXTURES];
    uint32_t count = RANDOM_APP_TEXTURES;
    CHECK_OK(sluiceCreateTracePlayer(&info, &player));
    play_to(player, 100);
    const uint64_t calls = memory.calls;
    CHECK_OK(sluiceGetTracePlayerManager(player, &manager));
    CHECK_OK(sluiceGetTracePlayerTextures(player, &count, ids));
    assert_int_equal(state_of(player).eventCount, 100);
    assert_int_equal(memory.calls, calls);
    sluiceDestroyTracePlayer(player);
    assert_int_equal(memory.live_count, 0);
    trace_buffer_free(&trace);
}

static void check_create_refused(SluiceTracePlayerCreateInfo info)
{
    char message[200] = "";
    SluiceTracePlayer *player = (void *)message;
    info.log = (SluiceLogCallback){message, note_message};
    CHECK_RESULT(sluiceCreateTracePlayer(&info, &player), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(player);
    assert_true(message[0]);
}

static void wrong_sizes_and_settings_are_refused_and_change_nothing(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(6);
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    SluiceAllocationCallbacks half = memory.callbacks;
    half.pfnFree = NULL;
    const SluiceTracePlayerCreateInfo good = {
        .structSize = sizeof good, .pData = trace.data, .size = trace.size};
    SluiceTracePlayerCreateInfo info = good;
    info.structSize = 0;
    check_create_refused(info);
    info = good;
    info.tileEventCapacity = SLUICE_MAX_TILE_EVENTS + 1;
    check_create_refused(info);
    info = good;
    info.pAllocator = &half;
    check_create_refused(info);
    assert_int_equal(memory.live_count, 0);

    SluiceTracePlayer *player = open_player(&trace);
    play_to(player, 50);
    const SluiceTracePlayerState before = state_of(player);
    SluiceTraceCall call = {.structSize = sizeof call - 1};
    SluiceTracePlayerState wrong = {.structSize = 1};
    CHECK_RESULT(sluiceGetNextTraceCall(player, &call), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetTracePlayerState(player, &wrong), SLUICE_ERROR_INVALID_ARGUMENT);
    const SluiceTracePlayerState after = state_of(player);
    check_same_state(&before, &after);
    sluiceDestroyTracePlayer(player);
    trace_buffer_free(&trace);
}

struct one_failure {
    uint32_t calls, failing; /* number of the write that fails */
};

static SluiceResult fail_once(void *user, const void *data, size_t size)
{
    struct one_failure *failure = user;
    (void)data, (void)size;
    return failure->calls++ == failure->failing ? SLUICE_ERROR_IO : SLUICE_SUCCESS;
}

static void an_error_of_the_writer_of_a_checkpoint_is_returned_and_the_player_goes_on(void **state)
{
    (void)state;
    struct trace_buffer trace = record_run(3);
    SluiceTracePlayer *player = open_player(&trace);
    play_to(player, 100);
    struct one_failure failure = {0};
    const SluiceRecordWriter writer = {&failure, fail_once};
    uint32_t failures = 0;
    while (sluiceWriteTraceCheckpoint(player, &writer) == SLUICE_ERROR_IO) {
        assert_int_equal(state_of(player).eventCount, 100);
        failure = (struct one_failure){.failing = ++failures};
    }
    assert_true(failure.calls == failures && failures >= 3);
    while (next_of(player).kind != SLUICE_TRACE_CALL_NONE)
        CHECK_OK(sluicePlayTraceCall(player));
    assert_true(state_of(player).decisionHash == state_of(player).recordedHash);
    sluiceDestroyTracePlayer(player);
    trace_buffer_free(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(state_is_that_of_a_replay_that_is_cut_there),
        cmocka_unit_test(calls_are_those_of_the_dump),
        cmocka_unit_test(a_checkpoint_goes_on_as_the_first_pass_did),
        cmocka_unit_test(a_checkpoint_of_the_end_leads_back_to_the_end),
        cmocka_unit_test(textures_are_listed_while_they_live),
        cmocka_unit_test(tile_events_are_kept_behind_a_checkpoint_too),
        cmocka_unit_test(what_is_no_recording_of_a_manager_is_refused_by_name),
        cmocka_unit_test(a_cut_recording_plays_up_to_the_cut),
        cmocka_unit_test(a_damaged_checkpoint_is_refused_and_changes_nothing),
        cmocka_unit_test(every_refused_allocation_is_survived),
        cmocka_unit_test(questions_take_no_memory),
        cmocka_unit_test(wrong_sizes_and_settings_are_refused_and_change_nothing),
        cmocka_unit_test(an_error_of_the_writer_of_a_checkpoint_is_returned_and_the_player_goes_on),
    };
    return RUN_TESTS(tests);
}
