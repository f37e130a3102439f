/* Regions that are always visible, with stochastic feedback: the number of evictions follows
 * sluicePredictFeedbackMiss. */
#define _POSIX_C_SOURCE 200809L

#include "play/trace_file.h"
#include "support/test.h"

#include <play_loop.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { TILES = 32, REGIONS = TILES * TILES, FRAMES = 150 };

/** Writes a trace whose regions are tiles, all requested at level 0 in every frame. */
static void write_still_view(uint32_t texture_count, char *path)
{
    const SluiceStreamedTextureDesc desc = {.width = TILES * 128,
                                            .height = TILES * 128,
                                            .mipLevelCount = 13,
                                            .regularMipCount = 6,
                                            .packedTileCount = 1,
                                            .tileWidth = 128,
                                            .tileHeight = 128};
    uint8_t map[REGIONS] = {0};
    struct trace_file file = {0};
    trace_file_begin(&file, texture_count, FRAMES);
    for (uint32_t i = 0; i < texture_count; i++)
        trace_file_add_texture(&file, &desc, i);
    for (uint32_t f = 0; f < FRAMES; f++) {
        trace_file_add_frame(&file, f * 10000u, texture_count);
        for (uint32_t i = 0; i < texture_count; i++)
            trace_file_add_map(&file, i, map, REGIONS);
    }
    trace_file_write(&file, file.size, path);
    trace_file_finish(&file);
}

struct observed {
    double evicted; ///< number of evictions of regions
    double miss;    ///< predicted chance for one timeout
};

/** Plays with immediate loads, so that every eviction is seen, and checks that nothing else is
 * wrong. */
static struct observed play(uint32_t texture_count, const char *probability, const char *timeout,
                            bool in_turns)
{
    char path[64];
    const char *argv[] = {"play",
                          path,
                          "--probability",
                          probability,
                          "--timeout",
                          timeout,
                          "--writers",
                          "8",
                          "--latency",
                          "0",
                          "--misses-to-forget",
                          "1",
                          "--standby",
                          "0",
                          "--tiles-per-frame",
                          "65536",
                          in_turns ? "--textures-per-frame" : NULL,
                          "1"};
    struct play_options options;
    struct feedback_trace trace;
    struct play_loop loop;
    write_still_view(texture_count, path);
    assert_int_equal(play_options_parse(&options, in_turns ? 18 : 16, (char **)argv), OPTIONS_RUN);
    assert_true(feedback_trace_open(&trace, path));
    unlink(path);
    assert_true(play_loop_init(&loop, &options, &trace) && play_loop_run(&loop));
    struct observed o = {.miss = play_feedback_predict_miss(&loop.feedback, 100)};
    for (uint32_t f = 0; f < FRAMES; f++)
        o.evicted += (double)loop.frames[f].view.wrong_evictions;
    play_loop_finish(&loop);
    feedback_trace_close(&trace);
    return o;
}

/**
 * Checks the number of evictions. A region is evicted if a map shows it and all maps of the next
 * timeout miss it. Two such events of a region cannot happen within a timeout, so their count
 * varies less than independent draws. Six standard deviations of those suffice.
 */
static void check_count(double evicted, double chance, double least_trials, double most_trials)
{
    const double least = chance * least_trials, most = chance * most_trials;
    if (evicted < least - 6 * sqrt(least) - 1 || evicted > most + 6 * sqrt(most) + 1)
        fail_msg("%g evictions, not %g to %g", evicted, least, most);
}

static const char *const probabilities[] = {"0.02", "1/16", "0.1", "0.2", "0.35"};
static const double values[] = {0.02, 1.0 / 16, 0.1, 0.2, 0.35};
enum { PROBABILITIES = sizeof values / sizeof *values };

static void evictions_are_as_many_as_predicted(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < PROBABILITIES; i++) {
        const struct observed o = play(1, probabilities[i], "0.03", false);
        const double shown = 1 - pow(1 - values[i], 8);
        assert_true(fabs(o.miss - pow(1 - values[i], 3 * 8)) < 1e-9);
        const double trials = REGIONS * (FRAMES - 1.0 - 3); /* a map, and three that miss */
        check_count(o.evicted, shown * o.miss, trials, trials);
    }
}

static void evictions_in_turns_are_as_many_as_predicted(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < PROBABILITIES; i++) {
        /* each of four textures is read in every fourth frame: a timeout has two of its maps */
        const struct observed o = play(4, probabilities[i], "0.08", true);
        const double shown = 1 - pow(1 - values[i], 4 * 8);
        assert_true(fabs(o.miss - pow(1 - values[i], 8 * 8)) < 1e-9);
        const double maps = FRAMES / 4 - 3; /* the first may show less than four frames */
        check_count(o.evicted, shown * o.miss, 4 * REGIONS * (maps - 1), 4 * REGIONS * (maps + 1));
    }
}

/** Maps close to each other expire together, so regions are held longer than the timeout. */
static void evictions_are_no_more_than_predicted(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < PROBABILITIES; i++) {
        const struct observed o = play(1, probabilities[i], "0.12", false);
        const double shown = 1 - pow(1 - values[i], 8);
        check_count(o.evicted, shown * o.miss, 0, REGIONS * (FRAMES - 1.0 - 12));
    }
}

static void nothing_is_evicted_where_every_pixel_writes(void **state)
{
    (void)state;
    const struct observed o = play(1, "1", "0.01", false);
    assert_true(o.evicted == 0 && isnan(o.miss));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(evictions_are_as_many_as_predicted),
        cmocka_unit_test(evictions_in_turns_are_as_many_as_predicted),
        cmocka_unit_test(evictions_are_no_more_than_predicted),
        cmocka_unit_test(nothing_is_evicted_where_every_pixel_writes),
    };
    return RUN_TESTS(tests);
}
