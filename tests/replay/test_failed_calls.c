/**
 * Calls that fail for lack of host memory leave nothing behind. One manager has every call refused
 * at its first allocation, then at its second, and so on until the call succeeds. A twin never sees
 * a refusal. Both must decide alike afterwards, and the recording of the first must play back.
 */
#include "core/call_sequence.h"
#include "core/check.h"
#include "random_app.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/replay.h>

#include <string.h>

enum { MAX_HEAPS = 1024 };

struct twin {
    SluiceStreamedTextureManager *manager;
    struct failing_allocator memory;
    struct outcome outcome;
};

static struct twins {
    struct call_sequence sequence;
    struct naive_manager naive; ///< source of the calls; follows the manager that never fails
    struct twin refused, spared;
    uint32_t heap_count;
    uint32_t heaps[MAX_HEAPS]; ///< heaps of the refused manager
    struct call call;
    struct outcome expected;
    uint64_t failures, cut_short;
} twins;

/* Heaps ------------------------------------------------------------------------------------- */

static bool heap_lives(uint32_t id)
{
    for (uint32_t i = 0; i < twins.heap_count; i++)
        if (twins.heaps[i] == id)
            return true;
    return false;
}

static SluiceResult give_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)user, (void)size;
    struct outcome *out = &twins.refused.outcome;
    struct heap_answer answer =
        call_sequence_heap_answer(&twins.sequence, twins.heaps, twins.heap_count);
    assert_true(out->answer_count < CALL_MAX_ROOM);
    out->answers[out->answer_count++] = answer;
    *heap_id = answer.id;
    if (answer.result == SLUICE_SUCCESS && !heap_lives(answer.id))
        twins.heaps[twins.heap_count++] = answer.id;
    return answer.result;
}

static void take_heap(void *user, uint32_t heap_id)
{
    (void)user;
    uint32_t i = 0;
    while (i < twins.heap_count && twins.heaps[i] != heap_id)
        i++;
    assert_true(i < twins.heap_count);
    twins.heaps[i] = twins.heaps[--twins.heap_count];
}

/* Returns the answer that the refused manager got. */
static SluiceResult give_same_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)user, (void)size;
    struct outcome *out = &twins.spared.outcome;
    assert_true(out->answer_count < twins.refused.outcome.answer_count);
    struct heap_answer answer = twins.refused.outcome.answers[out->answer_count];
    out->answers[out->answer_count++] = answer;
    *heap_id = answer.id;
    return answer.result;
}

static void forget_heap(void *user, uint32_t heap_id)
{
    (void)user, (void)heap_id;
}

/* Comparing --------------------------------------------------------------------------------- */

static void fail_with(uint64_t seed, uint32_t number, const char *what)
{
    fail_msg("seed %llu, call %u (%s): %s", (unsigned long long)seed, (unsigned)number,
             call_kind_name(twins.call.kind), what);
}

static bool same_lists(const struct outcome *a, const struct outcome *b)
{
    if (!call_is_list(twins.call.kind))
        return true;
    if (a->count != b->count)
        return false;
    if (twins.call.null == NULL_SECOND)
        return true;
    switch (twins.call.kind) {
    case CALL_DEFRAGMENT: return memcmp(a->moves, b->moves, a->count * sizeof *a->moves) == 0;
    case CALL_EMPTY_HEAPS: return memcmp(a->heaps, b->heaps, a->count * sizeof *a->heaps) == 0;
    case CALL_MINMIP_UPDATES: return memcmp(a->rects, b->rects, a->count * sizeof *a->rects) == 0;
    default: return memcmp(a->tiles, b->tiles, a->count * sizeof *a->tiles) == 0;
    }
}

static const char *difference(void)
{
    const struct outcome *a = &twins.refused.outcome, *b = &twins.spared.outcome;
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    if (a->result != b->result)
        return "another result than that of the twin that never failed";
    if (a->answer_count != b->answer_count)
        return "another number of heaps asked for";
    if (a->result >= 0 && !same_lists(a, b))
        return "another list";
    if (twins.call.kind == CALL_ADD_TEXTURE && a->result >= 0 && a->texture != b->texture)
        return "another id";
    CHECK_OK(sluiceGetStatistics(twins.spared.manager, &statistics));
    check_same_statistics(twins.refused.manager, &statistics);
    return slc_manager_check(twins.refused.manager);
}

/* Running ----------------------------------------------------------------------------------- */

/* Refuses the first allocation, then the second, and so on until the call succeeds. */
static void make_refused_call(uint64_t seed, uint32_t number)
{
    struct twin *t = &twins.refused;
    bool was_refused = false;
    for (uint64_t n = 0;; n++) {
        t->outcome.answer_count = 0;
        t->memory.refuse_from =
            twins.call.refuse_after == UINT64_MAX ? UINT64_MAX : t->memory.calls + n;
        call_make(t->manager, &twins.call, &t->outcome);
        was_refused = t->memory.calls > t->memory.refuse_from;
        t->memory.refuse_from = UINT64_MAX;
        if (t->outcome.result != SLUICE_ERROR_OUT_OF_HOST_MEMORY)
            break;
        if (!was_refused || t->outcome.answer_count > 0)
            fail_with(seed, number, "out of host memory without a refusal, or after a heap came");
        if (call_is_list(twins.call.kind) && t->outcome.count != twins.call.room)
            fail_with(seed, number, "the failed call changed the count");
        twins.failures++;
    }
    bool hands_out = twins.call.kind == CALL_TILES_TO_MAP || twins.call.kind == CALL_TILES_TO_UNMAP;
    if (!was_refused || !hands_out || t->outcome.count == 0 || twins.call.null != NULL_NONE)
        return;
    twins.call.room = t->outcome.count; /* after these, lack of memory acts like lack of room */
    twins.cut_short++;
}

static void step(uint64_t seed, uint32_t number)
{
    call_sequence_next(&twins.sequence, &twins.naive, &twins.call);
    twins.call.refuse_after = number % 3 ? 0 : UINT64_MAX;
    make_refused_call(seed, number);
    twins.spared.outcome.answer_count = 0;
    twins.spared.outcome.memory_refused = false;
    call_make(twins.spared.manager, &twins.call, &twins.spared.outcome);
    const char *what = difference();
    if (what)
        fail_with(seed, number, what);
    naive_call(&twins.naive, &twins.call, &twins.spared.outcome, &twins.expected);
    if (twins.naive.complaint[0])
        fail_with(seed, number, twins.naive.complaint);
}

static void open_twin(struct twin *t, SluiceHeapAllocator heaps)
{
    failing_allocator_init(&t->memory, UINT64_MAX);
    const SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = heaps,
        .pAllocator = &t->memory.callbacks,
        .heapTileCapacity = twins.sequence.capacity,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = twins.sequence.always_packed,
    };
    CHECK_OK(sluiceCreateStreamedTextureManager(&info, &t->manager));
}

static void check_playback(const struct trace_buffer *trace, uint64_t seed)
{
    const SluiceReplayInfo info = {
        .structSize = sizeof info, .pData = trace->data, .size = trace->size};
    SluiceReplayResult played = {.structSize = sizeof played};
    CHECK_OK(sluiceReplay(&info, &played));
    if (played.divergedEvent || played.decisionHash != played.recordedHash)
        fail_msg("seed %llu: the recording plays back otherwise from event %llu on",
                 (unsigned long long)seed, (unsigned long long)played.divergedEvent);
}

static void run(uint64_t seed, uint32_t calls)
{
    struct trace_buffer trace;
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    SluiceRecorder *recorder;
    call_sequence_start(&twins.sequence, (struct choice){.state = seed * 0xD1342543DE82EF95u + 1});
    naive_init(&twins.naive, twins.sequence.capacity, twins.sequence.always_packed);
    twins.heap_count = 0;
    open_twin(&twins.refused, (SluiceHeapAllocator){NULL, give_heap, take_heap});
    open_twin(&twins.spared, (SluiceHeapAllocator){NULL, give_same_heap, forget_heap});
    CHECK_OK(sluiceBeginRecording(twins.refused.manager, &writer, NULL, &recorder));
    for (uint32_t i = 0; i < calls; i++)
        step(seed, i);
    CHECK_OK(sluiceEndRecording(recorder));
    sluiceDestroyStreamedTextureManager(twins.refused.manager);
    sluiceDestroyStreamedTextureManager(twins.spared.manager);
    assert_int_equal(twins.refused.memory.live_bytes, 0);
    assert_int_equal(twins.spared.memory.live_bytes, 0);
    naive_finish(&twins.naive);
    check_playback(&trace, seed);
    trace_buffer_free(&trace);
}

static void calls_that_fail_for_lack_of_memory_leave_no_trace(void **state)
{
    (void)state;
    enum { SEQUENCES = 600, CALLS = 150 };
    for (uint64_t seed = 1; seed <= SEQUENCES; seed++)
        run(seed, CALLS);
    assert_true(twins.failures > SEQUENCES && twins.cut_short > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_that_fail_for_lack_of_memory_leave_no_trace),
    };
    return RUN_TESTS(tests);
}
