#include "core/sound.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { FRAMES = 400, TEXTURES = 4 };

static const uint64_t frame_time = 16667; /* microseconds */
static const uint64_t day = UINT64_C(86400) * 1000000;

/* Statistics after each frame, without host memory. */
struct record {
    SluiceStreamedTextureStatistics frames[FRAMES];
};

struct app {
    struct fixture f;
    SluiceTextureId ids[TEXTURES];
    uint64_t random;
    uint32_t loading;
    SluiceTile loads[256];
};

static void open_app(struct app *a, uint64_t start)
{
    memset(a, 0, sizeof *a);
    a->random = 31;
    fixture_open(&a->f, 8, false);
    a->f.heaps.limit = 10;
    fixture_configure(&a->f, 20, 0, 3, 3 * frame_time);
    SluiceStreamedTextureDesc desc = full_chain(1025, 700, 128, 128);
    SluiceStreamedTextureDesc half = full_chain(512, 350, 64, 64);
    for (uint32_t i = 0; i < TEXTURES; i++)
        a->ids[i] = fixture_add(&a->f, i == 2 ? &half : &desc);
    CHECK_OK(sluiceSetPrimaryTexture(a->f.manager, a->ids[2], a->ids[0]));
    /* A map that asks for nothing: the clock stands at `start`, and it was read. */
    sound_feed(&a->f, a->ids[3], SLUICE_MIP_UNTOUCHED, start, 0);
}

/* A visible spot moves, and sometimes jumps to and fro. All else is not sampled. */
static void feed(struct app *a, SluiceTextureId id, uint32_t frame, uint64_t time)
{
    SluiceStreamedTextureLayout layout = fixture_layout(&a->f, id);
    uint8_t map[128];
    uint32_t w = layout.feedbackWidth, h = layout.feedbackHeight, side = frame / 20 % 2 * 4;
    assert_true(w * h <= sizeof map);
    memset(map, SLUICE_MIP_UNTOUCHED, sizeof map);
    for (uint32_t i = 0; i < 5; i++) {
        uint32_t x = (frame / 15 + side + next_random(&a->random) % 3) % w;
        uint32_t y = (frame / 25 + next_random(&a->random) % 2) % h;
        map[y * w + x] = (uint8_t)(next_random(&a->random) % 4);
    }
    fixture_feed_map(&a->f, id, map, time, 6 * frame_time);
    CHECK_SOUND(&a->f);
}

/* Loads take a frame. Some fail; some canceled ones arrive anyway. */
static void answer(struct app *a, uint64_t time)
{
    for (uint32_t i = 0; i < a->loading; i++) {
        SluiceTextureId id = a->loads[i].textureId;
        uint32_t tile = a->loads[i].tileIndex, dice = next_random(&a->random) % 8;
        if (dice == 0)
            SOUND(&a->f, sluiceReportFailedTiles(a->f.manager, id, 1, &tile, time));
        else if (dice == 1)
            SOUND(&a->f, sluiceReportCanceledTiles(a->f.manager, id, 1, &tile, 0));
        else
            SOUND(&a->f, sluiceUpdateTilesMapping(a->f.manager, id, 1, &tile));
    }
}

static void run_frame(struct app *a, uint32_t frame, uint64_t time)
{
    feed(a, a->ids[frame % 2], frame, time);
    if (frame % 5 == 0)
        SOUND(&a->f,
              sluiceMatchPrimaryTexture(a->f.manager, a->ids[1], a->ids[3], time, 6 * frame_time));
    SOUND(&a->f, fixture_to_cancel(&a->f, SLUICE_ALL_TEXTURES));
    answer(a, time);
    SOUND(&a->f, sluiceCompleteRetireValue(a->f.manager, frame));
    SOUND(&a->f, fixture_to_unmap(&a->f, SLUICE_ALL_TEXTURES, frame + 2));
    assert_true(fixture_to_map_at_most(&a->f, SLUICE_ALL_TEXTURES, 12) >= 0);
    CHECK_SOUND(&a->f);
    a->loading = a->f.count;
    memcpy(a->loads, a->f.tiles, a->loading * sizeof *a->loads);
}

static void run_from(uint64_t start, struct record *out)
{
    static struct app a;
    open_app(&a, start);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        run_frame(&a, frame, start + frame * frame_time);
        out->frames[frame] = fixture_statistics(&a.f);
        out->frames[frame].hostMemorySize = 0;
    }
    fixture_close(&a.f);
}

static void print(const char *name, const SluiceStreamedTextureStatistics *s)
{
    print_error("%s: %u requested, %u allocated, %u mapped, %u standby, %u canceled, %u failed, "
                "%u given up, %u retiring, %u free, %" PRIu64 " handed out\n",
                name, (unsigned)s->requestedTileCount, (unsigned)s->allocatedTileCount,
                (unsigned)s->mappedTileCount, (unsigned)s->standbyTileCount,
                (unsigned)s->canceledTileCount, (unsigned)s->failedTileCount,
                (unsigned)s->givenUpTileCount, (unsigned)s->retiringSlotCount,
                (unsigned)s->freeSlotCount, s->handedOutTotal);
}

static bool same_counts(const SluiceStreamedTextureStatistics *a,
                        const SluiceStreamedTextureStatistics *b)
{
    return a->textureCount == b->textureCount && a->tileCount == b->tileCount &&
           a->requestedTileCount == b->requestedTileCount &&
           a->allocatedTileCount == b->allocatedTileCount &&
           a->mappedTileCount == b->mappedTileCount && a->standbyTileCount == b->standbyTileCount &&
           a->canceledTileCount == b->canceledTileCount &&
           a->failedTileCount == b->failedTileCount && a->givenUpTileCount == b->givenUpTileCount &&
           a->retiringSlotCount == b->retiringSlotCount && a->heapCount == b->heapCount &&
           a->freeSlotCount == b->freeSlotCount && a->handedOutTotal == b->handedOutTotal &&
           a->mappedTotal == b->mappedTotal && a->unmappedTotal == b->unmappedTotal &&
           a->canceledTotal == b->canceledTotal && a->failedTotal == b->failedTotal &&
           a->restoredTotal == b->restoredTotal && a->movedTotal == b->movedTotal;
}

/* Compares the records of two start times, frame by frame. */
static void check_start(uint64_t start, const struct record *expected)
{
    static struct record seen;
    run_from(start, &seen);
    for (uint32_t i = 0; i < FRAMES; i++) {
        if (same_counts(&seen.frames[i], &expected->frames[i]))
            continue;
        print("from 0", &expected->frames[i]);
        print("here  ", &seen.frames[i]);
        fail_msg("frame %u from %" PRIu64 " on differs", (unsigned)i, start);
    }
}

static const struct record *from_zero(void)
{
    static struct record record;
    run_from(0, &record);
    const SluiceStreamedTextureStatistics *last = &record.frames[FRAMES - 1];
    /* Otherwise the comparison would mean little. */
    assert_true(last->failedTotal > 20 && last->canceledTotal > 20 && last->restoredTotal > 2 &&
                last->unmappedTotal > 100 && last->mappedTotal > 200);
    return &record;
}

static void days_of_uptime_change_no_count_of_any_frame(void **state)
{
    (void)state;
    static const uint64_t days[] = {1, 100, 10000};
    const struct record *expected = from_zero();
    for (size_t i = 0; i < sizeof days / sizeof *days; i++) {
        check_start(days[i] * day, expected);
        check_start(days[i] * day + 1, expected);
    }
}

static void a_wrap_of_the_time_stamp_changes_no_count_of_any_frame(void **state)
{
    (void)state;
    const struct record *expected = from_zero();
    const uint64_t half = FRAMES / 2 * frame_time;
    check_start(UINT64_MAX - half, expected);     /* between two frames */
    check_start(0 - half, expected);              /* a frame at exactly 0 */
    check_start(UINT64_MAX - half + 1, expected); /* one tick later */
    check_start(UINT64_MAX, expected);            /* after the first frame */
    check_start(0 - (FRAMES - 1) * frame_time, expected);
}

/* Times at which clocks of other types would overflow: narrower, signed or floating point. */
static void no_power_of_two_on_the_way_changes_a_count(void **state)
{
    (void)state;
    static const uint32_t bits[] = {24, 31, 32, 53, 62, 63};
    const struct record *expected = from_zero();
    for (size_t i = 0; i < sizeof bits / sizeof *bits; i++)
        check_start((UINT64_C(1) << bits[i]) - FRAMES / 2 * frame_time, expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(days_of_uptime_change_no_count_of_any_frame),
        cmocka_unit_test(a_wrap_of_the_time_stamp_changes_no_count_of_any_frame),
        cmocka_unit_test(no_power_of_two_on_the_way_changes_a_count),
    };
    return RUN_TESTS(tests);
}
