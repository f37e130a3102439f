#include "damage.h"
#include "feedback_scene.h"
#include "lines.h"
#include "random_app.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEADER 64
#define TEXTURE 40

static SluiceReplayInfo replay_info(const struct trace_buffer *trace)
{
    return (SluiceReplayInfo){.structSize = sizeof(SluiceReplayInfo),
                              .pData = trace->data,
                              .size = trace->size,
                              .noStandbyTiles = true,
                              .latency = 2,
                              .timeoutMicros = 300000,
                              .tilesPerFrame = 40};
}

static void feedback_that_stands_still_ends_with_what_it_wants(void **state)
{
    (void)state;
    struct trace_buffer trace;
    SluiceReplayResult result = {.structSize = sizeof result};
    make_feedback_scene(&trace);
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    SluiceReplayInfo info = replay_info(&trace);
    info.pStatistics = &statistics;
    CHECK_OK(sluiceReplay(&info, &result));
    const SluiceStreamedTextureStatistics *s = &statistics;
    assert_int_equal(s->textureCount, 3);
    assert_int_equal(s->tileCount, 16 + 4 + 1 + 1 + 64 + 16 + 4 + 1 + 1 + 4 + 1 + 1);
    assert_int_equal(s->requestedTileCount + s->allocatedTileCount + s->canceledTileCount, 0);
    /* The bottom row of 0: 4 + 2 + 1 + packed. Its follower is twice as large, so level 0 asks for
     * the follower's level 1: 4 + 2 + 1 + packed. Of 2 only the packed tile is left. */
    assert_int_equal(s->mappedTileCount, 8 + 8 + 1);
    assert_int_equal(s->standbyTileCount, 0);
    assert_true(s->unmappedTotal > 0);
    assert_int_equal(result.recordedHash, 0);
    trace_buffer_free(&trace);
}

static void cap_and_latency_change_the_decisions(void **state)
{
    (void)state;
    struct trace_buffer trace;
    SluiceReplayResult plain = {.structSize = sizeof plain}, capped = {.structSize = sizeof capped},
                       late = {.structSize = sizeof late}, again = {.structSize = sizeof again};
    make_feedback_scene(&trace);
    SluiceReplayInfo info = replay_info(&trace);
    CHECK_OK(sluiceReplay(&info, &plain));
    CHECK_OK(sluiceReplay(&info, &again));
    info.latency = 3;
    CHECK_OK(sluiceReplay(&info, &late));
    info = replay_info(&trace);
    info.heapTileCapacity = 4;
    info.maxHeapCount = 2;
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    info.pStatistics = &statistics;
    CHECK_OK(sluiceReplay(&info, &capped));
    assert_true(plain.decisionHash == again.decisionHash);
    assert_true(plain.decisionHash != late.decisionHash);
    assert_true(plain.decisionHash != capped.decisionHash);
    assert_int_equal(statistics.heapCount, 2);
    assert_true(statistics.mappedTileCount <= 8);
    trace_buffer_free(&trace);
}

static void heaps_have_the_recommended_size_by_default(void **state)
{
    (void)state;
    struct trace_buffer trace;
    struct lines lines = {0};
    SluiceReplayResult result = {.structSize = sizeof result};
    make_feedback_scene(&trace);
    SluiceReplayInfo info = replay_info(&trace);
    info.pUserData = &lines;
    info.pfnLine = lines_take;
    CHECK_OK(sluiceReplay(&info, &result));
    assert_int_equal(strncmp(lines.text, "manager heap-tiles=256 ", 23), 0);
    lines_free(&lines);
    trace_buffer_free(&trace);
}

static void read_file(const char *path, struct trace_buffer *buffer)
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

static void recorded_run_has_the_same_decisions(void **state)
{
    (void)state;
    const char *path = "test_frame_loop.trace";
    struct trace_buffer trace, recorded;
    struct lines first = {0}, second = {0};
    SluiceReplayResult a = {.structSize = sizeof a}, b = {.structSize = sizeof b};
    make_feedback_scene(&trace);
    SluiceReplayInfo info = replay_info(&trace);
    info.pRecordPath = path;
    info.pUserData = &first;
    info.pfnLine = lines_take;
    CHECK_OK(sluiceReplay(&info, &a));
    read_file(path, &recorded);
    const SluiceReplayInfo other = {.structSize = sizeof other,
                                    .pData = recorded.data,
                                    .size = recorded.size,
                                    .pUserData = &second,
                                    .pfnLine = lines_take};
    CHECK_OK(sluiceReplay(&other, &b));
    assert_true(a.decisionHash == b.decisionHash && a.decisionHash == b.recordedHash);
    assert_string_equal(first.text, second.text);
    lines_free(&first);
    lines_free(&second);
    trace_buffer_free(&trace);
    trace_buffer_free(&recorded);
    remove(path);
}

static void zero_selects_the_documented_defaults(void **state)
{
    (void)state;
    struct trace_buffer trace;
    make_feedback_scene(&trace);
    SluiceReplayInfo info = {.structSize = sizeof info, .pData = trace.data, .size = trace.size};
    SluiceReplayInfo written = info;
    written.heapTileCapacity = 256;
    written.numExtraStandbyTiles = 1024;
    written.tilesPerFrame = 256;
    written.latency = 2;
    written.timeoutMicros = 1000000;
    SluiceReplayResult plain = {.structSize = sizeof plain}, full = {.structSize = sizeof full};
    CHECK_OK(sluiceReplay(&info, &plain));
    CHECK_OK(sluiceReplay(&written, &full));
    assert_true(plain.decisionHash == full.decisionHash);
    written.latency = 0;
    written.noLatency = true;
    CHECK_OK(sluiceReplay(&written, &full));
    assert_true(plain.decisionHash != full.decisionHash);
    written.latency = 1;
    CHECK_RESULT(sluiceReplay(&written, &full), SLUICE_ERROR_INVALID_ARGUMENT);
    info.timeoutMicros = 300000; /* within the trace */
    CHECK_OK(sluiceReplay(&info, &plain));
    info.noStandbyTiles = true;
    CHECK_OK(sluiceReplay(&info, &full));
    assert_true(plain.decisionHash != full.decisionHash);
    info.numExtraStandbyTiles = 1;
    CHECK_RESULT(sluiceReplay(&info, &full), SLUICE_ERROR_INVALID_ARGUMENT);
    trace_buffer_free(&trace);
}

static void every_truncation_is_found_at_or_before_the_cut(void **state)
{
    (void)state;
    struct trace_buffer trace;
    make_feedback_scene(&trace);
    for (size_t cut = 0; cut < trace.size; cut++) {
        uint8_t *copy = malloc(cut + 1);
        assert_non_null(copy);
        memcpy(copy, trace.data, cut);
        SluiceReplayResult result = {.structSize = sizeof result};
        CHECK_RESULT(play_damaged(copy, cut, &result), SLUICE_ERROR_CORRUPT_DATA);
        assert_true(result.errorOffset <= cut);
        free(copy);
    }
    trace_buffer_free(&trace);
}

static void changed_bytes_are_found_or_played(void **state)
{
    (void)state;
    struct trace_buffer trace;
    uint32_t corrupt = 0, played = 0;
    make_feedback_scene(&trace);
    for (size_t at = 0; at < trace.size; at++) {
        const uint8_t was = trace.data[at];
        for (uint32_t value = 0; value < 256; value += at % 3 + 24) {
            SluiceReplayResult result = {.structSize = sizeof result};
            trace.data[at] = (uint8_t)value;
            SluiceResult status = play_damaged(trace.data, trace.size, &result);
            corrupt += status == SLUICE_ERROR_CORRUPT_DATA;
            played += status == SLUICE_SUCCESS;
            if (status == SLUICE_ERROR_CORRUPT_DATA)
                assert_true(result.errorOffset <= trace.size);
            else if (status != SLUICE_SUCCESS)
                CHECK_RESULT(status, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        }
        trace.data[at] = was;
    }
    assert_true(corrupt > 500 && played > 500);
    trace_buffer_free(&trace);
}

static void contradictions_are_named_at_their_record(void **state)
{
    (void)state;
    static const struct {
        size_t offset;
        uint8_t value;
        size_t expected;
    } cases[] = {
        {8, 200, 8},                             /* more textures than fit */
        {15, 1, 12},                             /* more frames than fit */
        {HEADER + 12, 9, HEADER},                /* levels */
        {HEADER + 16, 3, HEADER},                /* a primary that does not exist */
        {HEADER + 16, 1, HEADER},                /* a primary that follows */
        {HEADER + 24, 5, HEADER},                /* size of the map */
        {HEADER + 28, 1, HEADER},                /* bytes of a tile */
        {HEADER + TEXTURE + 32, 1, HEADER + 40}, /* number of tiles */
        {HEADER + 3 * TEXTURE + 8, 255, HEADER + 3 * TEXTURE + 8},          /* maps */
        {HEADER + 3 * TEXTURE + 12, 3, HEADER + 3 * TEXTURE + 12},          /* texture of a map */
        {HEADER + 3 * TEXTURE + 7, 1, HEADER + 3 * TEXTURE + 12 + 14 + 10}, /* time of a frame */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct trace_buffer trace;
        SluiceReplayResult result = {.structSize = sizeof result};
        make_feedback_scene(&trace);
        trace.data[cases[i].offset] = cases[i].value;
        CHECK_RESULT(play_damaged(trace.data, trace.size, &result), SLUICE_ERROR_CORRUPT_DATA);
        assert_int_equal(result.errorOffset, cases[i].expected);
        trace_buffer_free(&trace);
    }
}

static void replay_without_memory_says_so_and_leaks_nothing(void **state)
{
    (void)state;
    struct trace_buffer trace;
    SluiceReplayResult result = {.structSize = sizeof result};
    make_feedback_scene(&trace);
    SluiceReplayInfo info = replay_info(&trace);
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
    trace_buffer_free(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feedback_that_stands_still_ends_with_what_it_wants),
        cmocka_unit_test(cap_and_latency_change_the_decisions),
        cmocka_unit_test(heaps_have_the_recommended_size_by_default),
        cmocka_unit_test(recorded_run_has_the_same_decisions),
        cmocka_unit_test(zero_selects_the_documented_defaults),
        cmocka_unit_test(every_truncation_is_found_at_or_before_the_cut),
        cmocka_unit_test(changed_bytes_are_found_or_played),
        cmocka_unit_test(contradictions_are_named_at_their_record),
        cmocka_unit_test(replay_without_memory_says_so_and_leaks_nothing),
    };
    return RUN_TESTS(tests);
}
