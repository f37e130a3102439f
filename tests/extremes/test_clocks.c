/* Ten thousand days in every unit, runs within one instant, and delays beyond any clock. */
#include "core/sound.h"
#include "extremes/note.h"

#include "core/check.h"

#include <stdlib.h>

static bool is_long_run;

enum { DAYS = 10000, TEXTURES = 4 };

/* Limit of memory growth after the first tenth of a run. */
static const double GROWTH = 1.125;

static uint64_t mix(uint64_t h, uint64_t value)
{
    h = (h ^ value) * 0x9E3779B97F4A7C15u;
    return h ^ h >> 29;
}

static uint64_t mix_list(uint64_t h, const struct fixture *f)
{
    for (uint32_t i = 0; i < f->count; i++)
        h = mix(h, f->tiles[i].textureId ^ (uint64_t)f->tiles[i].tileIndex << 20 ^
                       (uint64_t)f->tiles[i].heapId << 10 ^ f->tiles[i].slot);
    return mix(h, f->count);
}

struct app {
    struct fixture f;
    SluiceTextureId ids[TEXTURES];
    uint64_t random, hash, retire;
    uint64_t peak, early_peak; ///< bytes of the manager: over the run, and in its first part
};

static void open_app(struct app *a, uint64_t delay)
{
    *a = (struct app){.random = 77};
    fixture_open(&a->f, 8, false);
    a->f.heaps.limit = 6;
    fixture_configure(&a->f, 12, 0, 3, delay);
    SluiceStreamedTextureDesc large = full_chain(900, 700, 128, 128);
    SluiceStreamedTextureDesc small = full_chain(300, 256, 64, 64);
    for (uint32_t i = 0; i < TEXTURES; i++)
        a->ids[i] = fixture_add(&a->f, i % 2 ? &small : &large);
    CHECK_OK(sluiceSetPrimaryTexture(a->f.manager, a->ids[3], a->ids[0]));
}

static void feed(struct app *a, uint32_t step, uint64_t time, uint64_t timeout)
{
    uint8_t map[64];
    SluiceTextureId id = a->ids[step % 3];
    SluiceStreamedTextureLayout layout = fixture_layout(&a->f, id);
    memset(map, SLUICE_MIP_UNTOUCHED, sizeof map);
    for (uint32_t i = 0; i < 6; i++)
        map[(step / 9 + next_random(&a->random) % 4) %
            (layout.feedbackWidth * layout.feedbackHeight)] =
            (uint8_t)(next_random(&a->random) % 4);
    fixture_feed_map(&a->f, id, map, time, timeout);
}

static void answer(struct app *a, uint64_t time)
{
    for (uint32_t i = 0; i < a->f.count; i++) {
        SluiceTextureId id = a->f.tiles[i].textureId;
        uint32_t tile = a->f.tiles[i].tileIndex;
        if (next_random(&a->random) % 6 == 0)
            CHECK_OK(sluiceReportFailedTiles(a->f.manager, id, 1, &tile, time));
        else
            CHECK_OK(sluiceUpdateTilesMapping(a->f.manager, id, 1, &tile));
    }
}

/* Maps and unmaps tiles; some loads fail. Hashes all results. */
static void step_app(struct app *a, uint32_t step, uint64_t time, uint64_t timeout)
{
    feed(a, step, time, timeout);
    CHECK_OK(fixture_to_cancel(&a->f, SLUICE_ALL_TEXTURES));
    assert_int_equal(a->f.count, 0); /* all loads are answered at once */
    CHECK_OK(sluiceCompleteRetireValue(a->f.manager, a->retire));
    CHECK_OK(fixture_to_unmap(&a->f, SLUICE_ALL_TEXTURES, ++a->retire));
    a->hash = mix_list(a->hash, &a->f);
    assert_true(fixture_to_map(&a->f, SLUICE_ALL_TEXTURES) >= 0);
    a->hash = mix_list(a->hash, &a->f);
    answer(a, time);
    if (step % 512 == 0)
        assert_null(slc_manager_check(a->f.manager));
    a->peak = a->f.memory.live_bytes > a->peak ? a->f.memory.live_bytes : a->peak;
}

/* Runs DAYS days from `start` on, with `ticks` per day and a few steps each day. */
static uint64_t live(uint64_t start, uint64_t ticks, uint32_t steps_per_day)
{
    static struct app a;
    const uint64_t step = ticks / steps_per_day;
    open_app(&a, 2 * step);
    for (uint32_t i = 0; i < DAYS * steps_per_day; i++) {
        step_app(&a, i, start + i * step, 9 * step);
        if (i == DAYS / 10 * steps_per_day)
            a.early_peak = a.peak;
    }
    assert_true((double)a.peak <= GROWTH * (double)a.early_peak);
    SluiceStreamedTextureStatistics s = fixture_statistics(&a.f);
    assert_true(s.failedTotal > 1000 && s.unmappedTotal > 1000 && s.mappedTotal > 1000);
    fixture_close(&a.f);
    return a.hash;
}

static void ten_thousand_days_are_the_same_in_every_unit(void **state)
{
    (void)state;
    const uint32_t steps = is_long_run ? 240 : 4;
    /* Ticks per day. Whole days could not separate steps, so the coarsest unit is a step. */
    const uint64_t day = UINT64_C(86400);
    const uint64_t units[] = {steps, day, day * 1000, day * 1000000, day * 1000000000};
    const uint64_t all = DAYS * units[4];
    uint64_t expected = live(0, units[0], steps);
    uint32_t wrong = 0, cases = 0;
    for (uint32_t u = 1; u < 5; u++) {
        wrong += live(0, units[u], steps) != expected;
        wrong += live(0 - all / 2, units[u], steps) !=
                 expected; /* across the wrap of the clock in the last unit */
        cases += 2;
    }
    wrong += live(UINT64_MAX - DAYS * units[2] / 3, units[2], steps) != expected;
    wrong += live((UINT64_C(1) << 63) - 5, units[3], steps) != expected;
    note("10 000 days: units and starts that decide otherwise", cases + 2, wrong, 0);
    assert_int_equal(wrong, 0);
}

/* If time stands still, only timeout 0 expires tiles, and nothing is retried. Runs as long as
 * allowed. */
static void everything_in_one_instant_stays_sound_and_takes_no_more_memory(void **state)
{
    (void)state;
    static const uint64_t instants[] = {0, 1, UINT64_C(1) << 63, UINT64_MAX};
    const uint32_t steps = is_long_run ? 1000000 : 10000;
    double worst = 0;
    for (uint32_t i = 0; i < 8; i++) {
        static struct app a;
        uint64_t time = instants[i / 2], early = 0;
        open_app(&a, 1);
        for (uint32_t step = 0; step < steps; step++) {
            step_app(&a, step, time, i % 2 ? 1 : 0);
            if (step == steps / 10)
                early = a.peak;
        }
        double growth = (double)a.peak / (double)early;
        worst = growth > worst ? growth : worst;
        SluiceStreamedTextureStatistics s = fixture_statistics(&a.f);
        assert_true(s.mappedTotal > 20);
        if (i % 2) { /* nothing has expired: failed tiles wait for the clock */
            assert_true(s.failedTotal == s.failedTileCount + s.givenUpTileCount);
            step_app(&a, 0, time + 1, 1000);
            assert_true(fixture_statistics(&a.f).failedTileCount < s.failedTileCount ||
                        s.failedTileCount == 0);
        }
        fixture_close(&a.f);
    }
    note("one instant: growth of the manager's memory", 8 * (uint64_t)steps, worst, GROWTH);
    assert_true(worst <= GROWTH);
}

/* A doubling delay never exceeds half of the clock's range, beyond which later would be earlier. */
static void the_longest_retry_delay_comes_due_and_not_before(void **state)
{
    (void)state;
    static const uint64_t delays[] = {UINT64_C(1) << 61, UINT64_C(1) << 62, UINT64_C(1) << 63,
                                      UINT64_MAX};
    const uint64_t longest = UINT64_C(1) << 62;
    uint32_t cases = 0, wrong = 0;
    for (uint32_t d = 0; d < 4; d++) {
        struct fixture f;
        fixture_open(&f, 16, false);
        fixture_configure(&f, 0, 0, UINT32_MAX, delays[d]);
        SluiceTextureId id = fixture_add_small(&f);
        uint64_t time = UINT64_MAX - 5;
        const uint32_t packed = 5;
        sound_feed(&f, id, 0, time, UINT64_MAX);
        for (uint32_t failure = 0; failure < 70; failure++, cases++) {
            assert_true(fixture_to_map_at_most(&f, id, 1) >= 0);
            assert_true(LISTED(&f, id, packed));
            SOUND(&f, sluiceReportFailedTiles(f.manager, id, 1, &packed, time));
            uint64_t delay = failure == 0 && delays[d] < longest ? delays[d] : longest;
            sound_feed(&f, id, 0, time + delay - 1, UINT64_MAX);
            wrong += fixture_state(&f, id, packed) != SLUICE_TILE_STATE_FAILED;
            sound_feed(&f, id, 0, time += delay, UINT64_MAX);
            wrong += fixture_state(&f, id, packed) != SLUICE_TILE_STATE_REQUESTED;
        }
        fixture_close(&f);
    }
    note("the longest retry delay: tries at another time", cases, wrong, 0);
    assert_int_equal(wrong, 0);
}

int main(int argc, char **argv)
{
    is_long_run = is_long(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_thousand_days_are_the_same_in_every_unit),
        cmocka_unit_test(everything_in_one_instant_stays_sound_and_takes_no_more_memory),
        cmocka_unit_test(the_longest_retry_delay_comes_due_and_not_before),
    };
    return RUN_TESTS(tests);
}
