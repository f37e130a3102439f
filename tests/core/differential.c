#include "core/differential.h"

#include "core/check.h"
#include "core/same_desc.h"
#include "support/failing_allocator.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define MAX_HEAPS 1024

/* An application's copy of a MinMip map, updated by rectangles. */
struct published {
    SluiceTextureId id;
    uint8_t *texels;
};

struct differential {
    SluiceStreamedTextureManager *manager;
    struct naive_manager naive;
    struct call_sequence sequence;
    struct failing_allocator allocator;
    struct call call;
    struct outcome seen, expected;
    uint32_t call_number;
    uint32_t heap_count;
    uint32_t heaps[MAX_HEAPS];
    struct published published[64];
    uint64_t coverage[CALL_KIND_COUNT][64]; ///< by result + 32
    uint64_t entries[CALL_KIND_COUNT];      ///< number of list entries by kind of call
    uint64_t restored, textures, tiles, calls;
    uint64_t events[NAIVE_EVENT_COUNT];
    bool failed;
    char message[512];
};

static void fail(struct differential *d, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Keeps the first message only. */
static void fail(struct differential *d, const char *format, ...)
{
    if (d->failed)
        return;
    d->failed = true;
    int used = snprintf(d->message, sizeof d->message, "call %" PRIu32 " (%s): ", d->call_number,
                        call_kind_name(d->call.kind));
    va_list args;
    va_start(args, format);
    vsnprintf(d->message + used, sizeof d->message - (size_t)used, format, args);
    va_end(args);
}

static bool heap_lives(const struct differential *d, uint32_t id)
{
    for (uint32_t i = 0; i < d->heap_count; i++)
        if (d->heaps[i] == id)
            return true;
    return false;
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    struct differential *d = user;
    if (size != (uint64_t)d->sequence.capacity * SLUICE_DEFAULT_TILE_SIZE)
        fail(d, "a heap of %" PRIu64 " bytes was asked for", size);
    struct heap_answer answer = call_sequence_heap_answer(&d->sequence, d->heaps, d->heap_count);
    if (d->seen.answer_count < CALL_MAX_ROOM)
        d->seen.answers[d->seen.answer_count++] = answer;
    if (answer.result != SLUICE_SUCCESS)
        return answer.result;
    *heap_id = answer.id;
    if (!heap_lives(d, answer.id))
        d->heaps[d->heap_count++] = answer.id;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap_id)
{
    struct differential *d = user;
    uint32_t i = 0;
    while (i < d->heap_count && d->heaps[i] != heap_id)
        i++;
    if (i == d->heap_count)
        fail(d, "heap %" PRIu32 " was released, but does not live", heap_id);
    else
        d->heaps[i] = d->heaps[--d->heap_count];
}

struct differential *differential_create(void)
{
    return naive_alloc(1, sizeof(struct differential));
}

void differential_destroy(struct differential *d)
{
    free(d);
}

static bool same_tile(const SluiceTile *a, const SluiceTile *b, bool with_slot)
{
    return a->textureId == b->textureId && a->tileIndex == b->tileIndex &&
           a->mipLevel == b->mipLevel && a->x == b->x && a->y == b->y &&
           (!with_slot || (a->heapId == b->heapId && a->slot == b->slot));
}

static void fail_tile(struct differential *d, const char *what, uint32_t at, const SluiceTile *a,
                      const SluiceTile *b)
{
    fail(d,
         "%s %" PRIu32 " is tile %" PRIu32 " of %" PRIx64 ", level %" PRIu32 " (%" PRIu32
         ", %" PRIu32 "), heap %" PRIu32 " slot %" PRIu32 "; expected tile %" PRIu32 " of %" PRIx64
         ", level %" PRIu32 " (%" PRIu32 ", %" PRIu32 "), heap %" PRIu32 " slot %" PRIu32,
         what, at, a->tileIndex, a->textureId, a->mipLevel, a->x, a->y, a->heapId, a->slot,
         b->tileIndex, b->textureId, b->mipLevel, b->x, b->y, b->heapId, b->slot);
}

static void compare_lists(struct differential *d)
{
    const struct outcome *a = &d->seen, *b = &d->expected;
    const enum call_kind kind = d->call.kind;
    if (a->count != b->count)
        fail(d, "the count is %" PRIu32 ", expected %" PRIu32, a->count, b->count);
    for (uint32_t i = 0; i < a->count && d->call.null != NULL_SECOND && !d->failed; i++) {
        switch (kind) {
        case CALL_TILES_TO_MAP:
        case CALL_TILES_TO_CANCEL:
        case CALL_TILES_TO_UNMAP:
        case CALL_GIVEN_UP:
            if (!same_tile(&a->tiles[i], &b->tiles[i], kind != CALL_GIVEN_UP))
                fail_tile(d, "entry", i, &a->tiles[i], &b->tiles[i]);
            break;
        case CALL_DEFRAGMENT:
            if (!same_tile(&a->moves[i].from, &b->moves[i].from, true))
                fail_tile(d, "move", i, &a->moves[i].from, &b->moves[i].from);
            break;
        case CALL_MINMIP_UPDATES:
            if (a->rects[i].textureId != b->rects[i].textureId)
                fail(d, "rectangle %" PRIu32 " is of %" PRIx64 ", expected %" PRIx64, i,
                     a->rects[i].textureId, b->rects[i].textureId);
            break;
        case CALL_EMPTY_HEAPS:
            if (a->heaps[i] != b->heaps[i])
                fail(d, "heap %" PRIu32 " is %" PRIu32 ", expected %" PRIu32, i, a->heaps[i],
                     b->heaps[i]);
            break;
        default: break;
        }
    }
}

static void compare_layouts(struct differential *d, const SluiceStreamedTextureLayout *a,
                            const SluiceStreamedTextureLayout *b)
{
    bool same = same_desc(&a->desc, &b->desc) && a->regularTileCount == b->regularTileCount &&
                a->tileCount == b->tileCount && a->feedbackWidth == b->feedbackWidth &&
                a->feedbackHeight == b->feedbackHeight && a->minMipWidth == b->minMipWidth &&
                a->minMipHeight == b->minMipHeight;
    for (uint32_t i = 0; i < b->desc.regularMipCount && same; i++)
        same = a->levelWidthInTiles[i] == b->levelWidthInTiles[i] &&
               a->levelHeightInTiles[i] == b->levelHeightInTiles[i] &&
               a->levelFirstTile[i] == b->levelFirstTile[i];
    if (!same)
        fail(d, "the layouts differ");
}

static void compare_statistics(struct differential *d, const SluiceStreamedTextureStatistics *a,
                               const SluiceStreamedTextureStatistics *b)
{
#define COMPARE(field)                                                                             \
    if (a->field != b->field)                                                                      \
    fail(d, "statistics: " #field " is %" PRIu64 ", expected %" PRIu64, (uint64_t)a->field,        \
         (uint64_t)b->field)
    COMPARE(textureCount);
    COMPARE(tileCount);
    COMPARE(requestedTileCount);
    COMPARE(allocatedTileCount);
    COMPARE(mappedTileCount);
    COMPARE(standbyTileCount);
    COMPARE(canceledTileCount);
    COMPARE(failedTileCount);
    COMPARE(givenUpTileCount);
    COMPARE(retiringSlotCount);
    COMPARE(heapCount);
    COMPARE(freeSlotCount);
    COMPARE(reservedSlotCount);
    COMPARE(globalMipBias);
    COMPARE(handedOutTotal);
    COMPARE(mappedTotal);
    COMPARE(unmappedTotal);
    COMPARE(canceledTotal);
    COMPARE(failedTotal);
    COMPARE(restoredTotal);
    COMPARE(movedTotal);
    COMPARE(givenUpRetriedTotal);
#undef COMPARE
    if (a->hostMemorySize != d->allocator.live_bytes)
        fail(d, "statistics: hostMemorySize is %" PRIu64 ", expected %" PRIu64, a->hostMemorySize,
             d->allocator.live_bytes);
}

/* Number of compared bytes in calls that write rows, gaps included. */
static size_t row_bytes(const struct call *c)
{
    return c->kind == CALL_WRITE_MINMIP || c->kind == CALL_WRITE_RECT ? CALL_MAX_MAP : 0;
}

static void compare_outcomes(struct differential *d)
{
    const struct outcome *a = &d->seen, *b = &d->expected;
    if (d->call.null != NULL_SECOND && a->result >= 0)
        d->entries[d->call.kind] += a->count + d->call.count;
    if (a->result != b->result)
        fail(d, "the result is %s, expected %s", sluiceGetResultName(a->result),
             sluiceGetResultName(b->result));
    if (d->naive.complaint[0])
        fail(d, "%s", d->naive.complaint);
    if (a->answer_count != b->answer_count)
        fail(d, "the heap allocator was asked %" PRIu32 " times, expected %" PRIu32,
             a->answer_count, b->answer_count);
    if (memcmp(a->bytes, b->bytes, row_bytes(&d->call)) != 0)
        fail(d, "the bytes written differ");
    if (b->result < 0 || d->failed)
        return;
    switch (d->call.kind) {
    case CALL_TILES_TO_MAP:
    case CALL_GIVEN_UP:
    case CALL_TILES_TO_CANCEL:
    case CALL_TILES_TO_UNMAP:
    case CALL_DEFRAGMENT:
    case CALL_EMPTY_HEAPS:
    case CALL_MINMIP_UPDATES: compare_lists(d); break;
    case CALL_LAYOUT:
    case CALL_TEXTURE_LAYOUT: compare_layouts(d, &a->layout, &b->layout); break;
    case CALL_STATISTICS: compare_statistics(d, &a->statistics, &b->statistics); break;
    default: break;
    }
}

static const char *state_name(SluiceTileState state)
{
    static const char *const names[] = {"FREE",    "REQUESTED", "ALLOCATED", "MAPPED",
                                        "STANDBY", "CANCELED",  "FAILED",    "GIVEN_UP"};
    return (unsigned)state < 8 ? names[state] : "unknown";
}

static void compare_tiles(struct differential *d, const struct naive_texture *t)
{
    for (uint32_t i = 0; i < t->layout.tileCount && !d->failed; i++) {
        SluiceTileState state;
        SluiceTile tile, expected = naive_tile_info(t, i);
        SluiceResult result = sluiceGetTileState(d->manager, t->id, i, &state, &tile);
        if (result != SLUICE_SUCCESS)
            fail(d, "sluiceGetTileState says %s", sluiceGetResultName(result));
        else if (state != t->tiles[i].state)
            fail(d, "tile %" PRIu32 " of %" PRIx64 " is %s, expected %s", i, t->id,
                 state_name(state), state_name(t->tiles[i].state));
        else if (!same_tile(&tile, &expected, naive_has_slot(&t->tiles[i])))
            fail_tile(d, "tile", i, &tile, &expected);
    }
}

static void compare_minmip(struct differential *d, const struct naive_texture *t)
{
    const size_t size = (size_t)t->layout.minMipWidth * t->layout.minMipHeight;
    uint8_t *texels = d->seen.bytes;
    SluiceResult result =
        sluiceWriteMinMipData(d->manager, t->id, t->layout.minMipWidth, size, texels);
    if (result != SLUICE_SUCCESS)
        fail(d, "sluiceWriteMinMipData says %s", sluiceGetResultName(result));
    for (size_t i = 0; i < size && !d->failed; i++)
        if (texels[i] != t->minmip[i])
            fail(d, "MinMip texel %zu of %" PRIx64 " is %u, expected %u", i, t->id, texels[i],
                 t->minmip[i]);
}

static void compare_states(struct differential *d)
{
    SluiceStreamedTextureStatistics a = {.structSize = sizeof a}, b = {.structSize = sizeof b};
    for (uint32_t i = 0; i < d->naive.texture_room && !d->failed; i++) {
        const struct naive_texture *t = d->naive.textures[i];
        if (!t)
            continue;
        compare_tiles(d, t);
        compare_minmip(d, t);
    }
    naive_statistics(&d->naive, &b);
    d->calls++;
    d->textures += b.textureCount;
    d->tiles += b.tileCount;
    if (sluiceGetStatistics(d->manager, &a) != SLUICE_SUCCESS)
        fail(d, "sluiceGetStatistics failed");
    compare_statistics(d, &a, &b);
    if (d->heap_count != d->naive.heap_count)
        fail(d, "%" PRIu32 " heaps live, expected %" PRIu32, d->heap_count, d->naive.heap_count);
    for (uint32_t i = 0; i < d->heap_count && !d->failed; i++)
        if (!naive_find_heap(&d->naive, d->heaps[i]))
            fail(d, "heap %" PRIu32 " should not live", d->heaps[i]);
    const char *fault = slc_manager_check(d->manager);
    if (fault)
        fail(d, "invariant: %s", fault);
}

static struct published *published_copy(struct differential *d, const struct naive_texture *t)
{
    struct published *p = &d->published[(uint32_t)t->id];
    const size_t size = (size_t)t->layout.minMipWidth * t->layout.minMipHeight;
    if (p->id == t->id)
        return p;
    free(p->texels);
    *p = (struct published){t->id, naive_alloc(size, 1)};
    memset(p->texels, 0xEE, size); /* no level */
    return p;
}

/* Updates the published copies. Compares copies without pending updates. */
static void publish(struct differential *d)
{
    struct naive_manager *n = &d->naive;
    SluiceResult ignored;
    for (uint32_t i = 0; i < d->seen.count && !d->failed; i++) {
        const SluiceMinMipRect *r = &d->seen.rects[i];
        const struct naive_texture *t = naive_find(n, r->textureId, &ignored);
        const size_t w = t->layout.minMipWidth, h = t->layout.minMipHeight;
        const size_t at = r->y * w + r->x;
        SluiceResult result =
            sluiceWriteMinMipRect(d->manager, r, w, w * h - at, published_copy(d, t)->texels + at);
        if (result != SLUICE_SUCCESS)
            fail(d, "sluiceWriteMinMipRect says %s", sluiceGetResultName(result));
    }
    for (uint32_t i = 0; i < n->texture_room && !d->failed; i++) {
        const struct naive_texture *t = n->textures[i];
        if (!t || t->dirty_since)
            continue;
        const size_t size = (size_t)t->layout.minMipWidth * t->layout.minMipHeight;
        if (memcmp(published_copy(d, t)->texels, t->minmip, size) != 0)
            fail(d, "the published MinMip map of %" PRIx64 " is out of date", t->id);
    }
}

/* A failing list call must not change the count. */
static void check_count_is_kept(struct differential *d)
{
    if (call_is_list(d->call.kind) && d->call.null != NULL_FIRST && d->call.null != NULL_MANAGER &&
        d->seen.count != d->call.room)
        fail(d, "the failed call changed the count to %" PRIu32, d->seen.count);
}

/* Returns the entry behind the end of the list, which must not be written. */
static void *entry_behind(struct differential *d, size_t *size)
{
    struct outcome *out = &d->seen;
    const uint32_t room = d->call.room;
    *size = 0;
    if (!call_is_list(d->call.kind) || room >= CALL_MAX_ROOM)
        return NULL;
    switch (d->call.kind) {
    case CALL_DEFRAGMENT: *size = sizeof out->moves[0]; return &out->moves[room];
    case CALL_EMPTY_HEAPS: *size = sizeof out->heaps[0]; return &out->heaps[room];
    case CALL_MINMIP_UPDATES: *size = sizeof out->rects[0]; return &out->rects[room];
    default: *size = sizeof out->tiles[0]; return &out->tiles[room];
    }
}

static void check_behind(struct differential *d)
{
    size_t size;
    const uint8_t *bytes = entry_behind(d, &size);
    for (size_t i = 0; i < size; i++)
        if (bytes[i] != 0xEE)
            fail(d, "more was written than there was room for");
}

/* Makes d->call on the manager. Returns whether memory was refused. */
static bool make_call(struct differential *d)
{
    const struct call *call = &d->call;
    size_t size;
    void *behind = entry_behind(d, &size);
    if (behind)
        memset(behind, 0xEE, size);
    memset(d->seen.bytes, 0xEE, row_bytes(call));
    if (call->refuse_after != UINT64_MAX)
        d->allocator.refuse_from = d->allocator.calls + call->refuse_after;
    call_make(d->manager, call, &d->seen);
    const bool refused = d->allocator.calls > d->allocator.refuse_from;
    d->seen.memory_refused = refused;
    d->allocator.refuse_from = UINT64_MAX;
    d->coverage[call->kind][(d->seen.result + 32) & 63]++;
    if (d->seen.result < 0)
        check_count_is_kept(d);
    check_behind(d);
    return refused;
}

/* Makes d->call on both and compares. Repeats it with one more allocation each time until it
 * succeeds. */
static void step(struct differential *d)
{
    struct call *call = &d->call;
    d->call_number++;
    bool refused = make_call(d);
    while (d->seen.result == SLUICE_ERROR_OUT_OF_HOST_MEMORY && !d->failed) {
        if (!refused)
            fail(d, "out of host memory, although no allocation was refused");
        compare_states(d);
        call->refuse_after++;
        refused = make_call(d);
    }
    if (d->failed)
        return;
    if (refused && (call->kind == CALL_TILES_TO_MAP || call->kind == CALL_TILES_TO_UNMAP) &&
        d->seen.result == SLUICE_INCOMPLETE && d->seen.count > 0 && call->null == NULL_NONE)
        call->room = d->seen.count; /* after these, lack of host memory acts like lack of room */
    memset(d->expected.bytes, 0xEE, row_bytes(call));
    naive_call(&d->naive, call, &d->seen, &d->expected);
    compare_outcomes(d);
    if (!d->failed && call->kind == CALL_MINMIP_UPDATES && d->seen.result >= 0 &&
        call->null != NULL_SECOND)
        publish(d);
    if (!d->failed)
        compare_states(d);
}

static void start(struct differential *d, struct choice choice)
{
    call_sequence_start(&d->sequence, choice);
    naive_init(&d->naive, d->sequence.capacity, d->sequence.always_packed);
    failing_allocator_init(&d->allocator, UINT64_MAX);
    d->heap_count = 0;
    d->call_number = 0;
    d->failed = false;
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {d, allocate_heap, release_heap},
        .pAllocator = &d->allocator.callbacks,
        .heapTileCapacity = d->sequence.capacity,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = d->sequence.always_packed,
    };
    SluiceResult result = sluiceCreateStreamedTextureManager(&info, &d->manager);
    if (result != SLUICE_SUCCESS)
        fail(d, "sluiceCreateStreamedTextureManager says %s", sluiceGetResultName(result));
}

/* Repeats DefragmentTiles until it makes no move. */
static void defragment_to_the_end(struct differential *d, FILE *log)
{
    uint64_t left = (uint64_t)d->naive.heap_count * d->naive.capacity + 1;
    uint32_t room = choice_range(&d->sequence.choice, 1, 8);
    uint64_t retire = choice_once_in(&d->sequence.choice, 2) ? 0 : d->naive.last_retire;
    do {
        memset(&d->call, 0, offsetof(struct call, map));
        d->call.kind = CALL_DEFRAGMENT;
        d->call.refuse_after = UINT64_MAX;
        d->call.retire = retire;
        d->call.room = room;
        if (log)
            call_print(log, &d->call);
        step(d);
    } while (!d->failed && d->seen.count > 0 && left-- > 0);
    if (d->seen.count > 0)
        fail(d, "defragmentation does not end");
}

static void finish(struct differential *d)
{
    d->restored += d->naive.totals.restoredTotal;
    for (int i = 0; i < NAIVE_EVENT_COUNT; i++)
        d->events[i] += d->naive.events[i];
    sluiceDestroyStreamedTextureManager(d->manager);
    d->manager = NULL;
    if (d->heap_count)
        fail(d, "%" PRIu32 " heaps were not released at the end", d->heap_count);
    if (d->allocator.live_count || d->allocator.live_bytes)
        fail(d, "%" PRIu64 " bytes of host memory are left at the end", d->allocator.live_bytes);
    naive_finish(&d->naive);
    for (size_t i = 0; i < sizeof d->published / sizeof d->published[0]; i++) {
        free(d->published[i].texels);
        d->published[i] = (struct published){0};
    }
}

int differential_run(struct differential *d, struct choice choice, uint32_t call_count, FILE *log,
                     const char **message)
{
    start(d, choice);
    if (log)
        fprintf(log, "heaps of %" PRIu32 " slots, packed tiles %s\n", d->sequence.capacity,
                d->sequence.always_packed ? "always" : "as wanted");
    for (uint32_t i = 0; i < call_count && !d->failed && choice_goes_on(&d->sequence.choice); i++) {
        call_sequence_next(&d->sequence, &d->naive, &d->call);
        if (log) {
            fprintf(log, "%5" PRIu32 ": ", d->call_number + 1);
            call_print(log, &d->call);
        }
        step(d);
        if (log)
            fprintf(log, "       -> %s, %" PRIu32 "\n", sluiceGetResultName(d->seen.result),
                    d->seen.count);
    }
    if (!d->failed)
        defragment_to_the_end(d, log);
    finish(d);
    *message = d->message;
    return d->failed ? -1 : (int)d->call_number;
}

static const char *const event_names[NAIVE_EVENT_COUNT] = {
    [NAIVE_BIAS_ABOVE_0] = "hand-outs with a global bias",
    [NAIVE_BIAS_LOWERED] = "global bias lowered",
    [NAIVE_BIAS_WAITED] = "looks at the global bias that waited for maps",
    [NAIVE_BIAS_TRIED_AGAIN] = "a global bias that failed tried again",
    [NAIVE_BIAS_FAILED_AGAIN] = "failed again",
    [NAIVE_STARVED] = "became starved",
    [NAIVE_PASSED_OVER] = "requests passed over",
    [NAIVE_FORGOTTEN] = "textures forgotten",
    [NAIVE_PREFETCHED] = "tiles prefetched",
    [NAIVE_SPAN_THINNED] = "spans thinned",
    [NAIVE_SPANS_FULL] = "maps that met six spans",
    [NAIVE_SEPARATED] = "heaps that became heaps for packed tiles",
    [NAIVE_MIXED] = "tiles in a heap of the other kind",
    [NAIVE_RESERVE_KEPT] = "free slots kept for packed tiles",
    [NAIVE_SLOT_OWED] = "free slots left to coarser requests of other textures",
    [NAIVE_RETURNS] = "maps with returns that were learned from",
    [NAIVE_EVICTED] = "evicted",
    [NAIVE_UNSEEN_EVICTED] = "evicted as no longer seen",
    [NAIVE_SEEN_EVICTED] = "evicted although seen",
    [NAIVE_LONG_WAITED] = "evicted for a request of the next level that waited long",
    [NAIVE_EVICTED_UNMAPPED] = "evicted and requested again",
    [NAIVE_EVICTED_UNWANTED] = "evicted and no longer wanted",
    [NAIVE_PROBED] = "textures probed for the tiles that they gave up",
    [NAIVE_PROBED_EARLY] = "textures to be probed because another tile came",
    [NAIVE_EVACUATED] = "tiles evacuated",
    [NAIVE_TEXTURE_FORGOTTEN] = "tiles of textures forgotten",
    [NAIVE_TEXTURE_EVICTED] = "textures evicted",
    [NAIVE_TEXTURE_LISTED] = "tiles of textures listed",
    [NAIVE_FOLLOWER_EVICTED] = "followers evicted",
    [NAIVE_RETRIED_ALL] = "textures whose given-up tiles were all tried again",
};

void differential_print_coverage(const struct differential *d, FILE *file)
{
    for (int kind = 0; kind < CALL_KIND_COUNT; kind++) {
        fprintf(file, "# %s:", call_kind_name((enum call_kind)kind));
        if (d->entries[kind])
            fprintf(file, " %" PRIu64 " entries,", d->entries[kind]);
        for (int r = 0; r < 64; r++)
            if (d->coverage[kind][r])
                fprintf(file, " %s %" PRIu64, sluiceGetResultName((SluiceResult)(r - 32)),
                        d->coverage[kind][r]);
        fprintf(file, "\n");
    }
    const double calls = d->calls ? (double)d->calls : 1;
    fprintf(file, "# %" PRIu64 " tiles restored; on average %.1f textures, %.1f tiles\n",
            d->restored, (double)d->textures / calls, (double)d->tiles / calls);
    for (int i = 0; i < NAIVE_EVENT_COUNT; i++)
        fprintf(file, "# %s: %" PRIu64 "\n", event_names[i], d->events[i]);
}

const char *differential_missing_event(const struct differential *d)
{
    for (int i = 0; i < NAIVE_EVENT_COUNT; i++)
        if (d->events[i] == 0)
            return event_names[i];
    return NULL;
}
