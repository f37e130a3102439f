#include "play.h"

#include "../common/input.h"
#include "../common/output_file.h"
#include "../common/text.h"
#include "play_figures.h"

#include <clairvoyant.h>

#include <errno.h>
#include <stdio.h>
#include <string.h>

/** Prints the figures of a clairvoyant policy, and bounds for all policies. */
static void print_clairvoyant(const struct play_printer *p, const struct play_options *o,
                              const struct workload *w, const struct limits *limits)
{
    const double regions = w->regions ? (double)w->regions : 1;
    const struct reactive_floor *floor = &w->reactive;
    struct outcome outcome = clv_schedule(w, limits, NULL, NULL);
    if (o->rounds > 0) {
        struct prices prices;
        struct outcome priced = clv_schedule_best(w, limits, outcome.deficit, o->rounds, &prices);
        play_print_figure(p, "bound_levels_too_coarse", prices.bound / regions, "levels");
        clv_prices_finish(&prices);
        outcome = priced.deficit < outcome.deficit ? priced : outcome;
    }
    play_print_figure(p, "clairvoyant_tiles", (double)outcome.uploads, "tiles");
    play_print_figure(p, "clairvoyant_levels_too_coarse", (double)outcome.deficit / regions,
                      "levels");
    play_print_figure(p, "clairvoyant_regions_too_coarse_percent",
                      100 * (double)outcome.too_coarse / regions, "%");
    play_print_figure(p, "reactive_levels_too_coarse",
                      (double)(floor->appears + floor->enters + floor->finer) / regions, "levels");
}

static bool look_ahead(const struct play_printer *p, const struct play_options *o,
                       struct feedback_trace *trace)
{
    struct workload w;
    if (!clv_workload_read(&w, trace, o->latency))
        return false;
    const uint64_t slots = (uint64_t)o->max_heaps * o->heap_tiles;
    const bool fits = o->max_heaps == 0 || slots >= w.packed_tiles;
    const struct limits limits = {.cap = o->max_heaps ? slots - w.packed_tiles : UINT64_MAX,
                                  .budget = o->tiles_per_frame,
                                  .latency = o->latency,
                                  .hold = true};
    if (fits)
        print_clairvoyant(p, o, &w, &limits);
    else
        fprintf(stderr, "the packed tiles alone need %llu slots\n",
                (unsigned long long)w.packed_tiles);
    clv_workload_finish(&w);
    return fits;
}

static bool play(const struct play_printer *p, const struct play_options *o,
                 struct feedback_trace *trace)
{
    struct play_loop loop;
    bool done = play_loop_init(&loop, o, trace) && play_loop_run(&loop) &&
                play_print_figures(p, &loop) && (!o->output || play_write_frames(&loop, o->output));
    play_loop_finish(&loop);
    return done && (!o->clairvoyant || look_ahead(p, o, trace));
}

int play_print(int argc, char **argv, FILE *out)
{
    struct play_options options;
    struct feedback_trace trace;
    switch (play_options_parse(&options, argc, argv)) {
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    case OPTIONS_RUN: break;
    }
    if (!output_add_input(input_stream_path(options.trace)) ||
        !feedback_trace_open(&trace, options.trace))
        return 1;
    const struct play_printer printer = {out, options.json};
    bool done = play(&printer, &options, &trace);
    feedback_trace_close(&trace);
    if (fflush(out) != 0) {
        text_say("play: cannot write: %s", strerror(errno));
        done = false;
    }
    return done ? 0 : 1;
}

int play_main(int argc, char **argv)
{
    return play_print(argc, argv, stdout);
}
