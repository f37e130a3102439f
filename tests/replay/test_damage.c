#include "damage.h"
#include "random_app.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 240
/* A block and the longest record after which it may have ended. */
#define LONGEST_BLOCK (4096 + 1024)

/** The manager is in use, so the recording begins with a snapshot. */
static struct trace_buffer record_in_use(uint64_t seed, uint32_t before, uint32_t steps)
{
    struct trace_buffer trace;
    record_late_run(&trace, seed, before, steps);
    assert_int_equal(trace.data[8], 2);
    return trace;
}

static struct trace_buffer record_new(uint64_t seed, uint32_t steps)
{
    struct trace_buffer trace;
    record_random_run(&trace, seed, steps, false);
    assert_int_equal(trace.data[8], 1);
    return trace;
}

static void check_truncations(struct trace_buffer trace)
{
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

static void every_truncation_is_found_at_or_before_the_cut(void **state)
{
    (void)state;
    check_truncations(record_new(21, STEPS));
    check_truncations(record_in_use(21, STEPS, 10));
}

static void check_changed_bytes(struct trace_buffer trace)
{
    for (size_t at = 0; at < trace.size; at++) {
        const uint8_t was = trace.data[at];
        const uint8_t values[] = {was ^ 1, was ^ 0x80, (uint8_t)(was + 1)};
        for (size_t i = 0; i < sizeof values; i++) {
            SluiceReplayResult result = {.structSize = sizeof result};
            if (values[i] == was)
                continue;
            trace.data[at] = values[i];
            CHECK_RESULT(play_damaged(trace.data, trace.size, &result), SLUICE_ERROR_CORRUPT_DATA);
            assert_true(result.errorOffset <= at);
            assert_true(at - result.errorOffset < LONGEST_BLOCK);
        }
        trace.data[at] = was;
    }
    SluiceReplayResult result = {.structSize = sizeof result};
    CHECK_OK(play_damaged(trace.data, trace.size, &result));
    trace_buffer_free(&trace);
}

static void every_changed_byte_is_found_in_its_block(void **state)
{
    (void)state;
    struct trace_buffer trace = record_new(22, STEPS + STEPS / 2);
    assert_true(trace.size > 4500); /* more than one block */
    check_changed_bytes(trace);
    check_changed_bytes(record_in_use(22, STEPS, 10));
}

/* A trace made to do harm has right checksums. */
static void check_resealed(struct trace_buffer trace)
{
    uint8_t *copy = malloc(trace.size);
    assert_non_null(copy);
    uint32_t corrupt = 0, played = 0;
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
            if (status == SLUICE_ERROR_CORRUPT_DATA)
                assert_true(result.errorOffset <= trace.size);
            else if (status != SLUICE_SUCCESS && status != SLUICE_ERROR_UNSUPPORTED)
                CHECK_RESULT(status, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        }
    }
    assert_true(corrupt > 100 && played > 100);
    free(copy);
    trace_buffer_free(&trace);
}

static void changed_bytes_under_right_checksums_do_no_harm(void **state)
{
    (void)state;
    check_resealed(record_new(23, STEPS / 4));
    for (uint64_t seed = 30; seed < 32; seed++)
        check_resealed(record_in_use(seed, STEPS / 2, STEPS / 4));
}

static void newer_version_is_unsupported(void **state)
{
    (void)state;
    struct trace_buffer trace;
    SluiceReplayResult result = {.structSize = sizeof result};
    record_random_run(&trace, 24, 5, false);
    trace.data[8] = 3;
    reseal_trace(trace.data, trace.size);
    CHECK_RESULT(play_damaged(trace.data, trace.size, &result), SLUICE_ERROR_UNSUPPORTED);
    trace_buffer_free(&trace);
}

static void bytes_behind_the_end_mark_are_found(void **state)
{
    (void)state;
    struct trace_buffer trace;
    SluiceReplayResult result = {.structSize = sizeof result};
    record_random_run(&trace, 25, 20, false);
    size_t size = trace.size;
    trace.data = realloc(trace.data, size + 1);
    assert_non_null(trace.data);
    trace.data[size] = 0;
    CHECK_RESULT(play_damaged(trace.data, size + 1, &result), SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(result.errorOffset, size);
    assert_true(result.eventCount >= 20); /* played up to there */
    trace_buffer_free(&trace);
}

struct message {
    char text[256];
    int count;
};

static void keep_message(void *user, SluiceLogSeverity severity, const char *text)
{
    struct message *message = user;
    if (severity != SLUICE_LOG_ERROR)
        return;
    strncpy(message->text, text, sizeof message->text - 1);
    message->count++;
}

static void message_names_the_byte(void **state)
{
    (void)state;
    struct trace_buffer trace;
    struct message message = {.count = 0};
    SluiceReplayResult result = {.structSize = sizeof result};
    char offset[32];
    record_random_run(&trace, 26, 20, false);
    const SluiceReplayInfo info = {.structSize = sizeof info,
                                   .pData = trace.data,
                                   .size = trace.size - 1,
                                   .log = {&message, keep_message}};
    CHECK_RESULT(sluiceReplay(&info, &result), SLUICE_ERROR_CORRUPT_DATA);
    snprintf(offset, sizeof offset, "byte %llu:", (unsigned long long)result.errorOffset);
    assert_int_equal(message.count, 1);
    assert_non_null(strstr(message.text, offset));
    trace_buffer_free(&trace);
}

static void first_divergence_is_named(void **state)
{
    (void)state;
    const size_t first = 40 + 12; /* header, head of the block */
    struct random_app app;
    struct trace_buffer trace;
    SluiceRecorder *recorder;
    SluiceReplayResult result = {.structSize = sizeof result};
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    random_app_init(&app, 27, false);
    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    CHECK_OK(sluiceTrimStandbyTiles(app.manager, 7));
    CHECK_OK(sluiceTrimStandbyTiles(app.manager, 8));
    CHECK_OK(sluiceTrimStandbyTiles(app.manager, 9));
    CHECK_OK(sluiceEndRecording(recorder));
    random_app_finish(&app);
    CHECK_OK(play_damaged(trace.data, trace.size, &result));
    assert_int_equal(result.divergedEvent, 0);

    trace.data[first + 3 + 1] = 2 * SLUICE_BUDGET_REACHED; /* result of the second call */
    reseal_trace(trace.data, trace.size);
    CHECK_OK(play_damaged(trace.data, trace.size, &result));
    assert_int_equal(result.divergedEvent, 2);
    assert_int_equal(result.divergedOffset, first + 3);
    assert_int_equal(result.eventCount, 3);
    trace_buffer_free(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_truncation_is_found_at_or_before_the_cut),
        cmocka_unit_test(every_changed_byte_is_found_in_its_block),
        cmocka_unit_test(changed_bytes_under_right_checksums_do_no_harm),
        cmocka_unit_test(newer_version_is_unsupported),
        cmocka_unit_test(bytes_behind_the_end_mark_are_found),
        cmocka_unit_test(message_names_the_byte),
        cmocka_unit_test(first_divergence_is_named),
    };
    return RUN_TESTS(tests);
}
