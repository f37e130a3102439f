#include "play_options.h"

#include "../common/shared_options.h"

#include <math.h>
#include <stdio.h>

#define TILE_SIZE 65536u

static const char usage[] =
    "usage: sluice-tradeoff play TRACE [options]\n"
    "\n"
    "Plays a feedback trace (SLTRACE1, docs/replay.md) as an application would, and prints a\n"
    "line for each figure: tiles needed and loaded, how much too coarse what was sampled was,\n"
    "memory, time. Options end at --.\n";

static const char notes[] =
    "What is left out of maps and what they ask for is a simulation: quality is measured against\n"
    "the whole map and without the bias.\n"
    "Exit status: 0; 1 for a trace that cannot be played, or a file that cannot be written; 2 for\n"
    "wrong usage.\n";

/** Refuses conflicting settings, and derives settings from others. */
static bool settle(const struct option_table *table, struct play_options *o)
{
    if (o->drop > 0 && o->probability < 1)
        return options_refuse(table, "--drop-probability or --probability, not both");
    if (o->budget && o->max_heaps)
        return options_refuse(table, "--budget or --max-heaps, not both");
    if (o->budget && o->budget < TILE_SIZE)
        return options_refuse(table, "--budget: wants 64K at least, for one tile, or 0");
    if (o->budget) {
        const uint64_t tiles = o->budget / TILE_SIZE;
        o->heap_tiles = o->heap_tiles < tiles ? o->heap_tiles : (uint32_t)tiles;
        o->max_heaps = (uint32_t)(tiles / o->heap_tiles);
    }
    if (o->probability < 1)
        o->drop = pow(1 - o->probability, o->writers);
    return true;
}

enum option_outcome play_options_parse(struct play_options *o, int argc, char **argv)
{
    const double any = UINT32_MAX;
    *o = (struct play_options){0};
    const struct option options[] = {
        {OPTION_WORD, .operand = "TRACE", .value = &o->trace, .help = "a trace", .minimum = 1},
        {OPTION_SECTION, .help = "Memory"},
        option_budget(&o->budget, "memory for all heaps, instead of --max-heaps; 0: no limit"),
        option_heap_tiles(&o->heap_tiles),
        option_max_heaps(&o->max_heaps),
        option_standby(&o->standby),
        {OPTION_UINT, "prefetch-levels", "N", "0", &o->prefetch_levels,
         "coarsest levels loaded when nothing is requested", 0, 32},
        {OPTION_SECTION, .help = "Loads"},
        option_tiles_per_frame(&o->tiles_per_frame, 1 << 20),
        option_latency(&o->latency),
        {OPTION_UINT, "loads-in-flight", "N", "0", &o->loads_in_flight,
         "most loads at a time; 0: tiles-per-frame * (latency + 1)", 0, 1 << 30},
        {OPTION_SECTION, .help = "Feedback"},
        option_timeout(&o->timeout),
        {OPTION_UINT, "misses-to-forget", "N", "0", &o->misses_to_forget,
         "maps that have to miss a region beside; 0: learned", 0, any},
        {OPTION_INT, "mip-bias", "LEVELS", "0", &o->mip_bias, "added to what maps ask for", -32,
         32},
        {OPTION_UINT, "textures-per-frame", "N", "0", &o->textures_per_frame,
         "maps read per frame, in turns; 0: all that there are", 0, any},
        {OPTION_FLAG, "in-turns", .value = &o->in_turns,
         .help = "a map shows one frame; else all since it was last read"},
        {OPTION_REAL, "probability", "P", "1", &o->probability,
         "probability that a pixel writes feedback, such as 1/16", 0, 1},
        {OPTION_UINT, "writers", "N", "1", &o->writers, "pixels that see a region", 1, 1 << 24},
        {OPTION_REAL, "drop-probability", "P", "0", &o->drop,
         "probability that a region is left out of a frame's map, instead of --probability", 0, 1},
        option_seed(&o->seed),
        {OPTION_SECTION, .help = "Output"},
        {OPTION_TEXT, "output", "DIR", "(none)", &o->output, "folder for frames.csv"},
        {OPTION_FLAG, "clairvoyant", .value = &o->clairvoyant,
         .help = "also what a policy that knows the whole trace does"},
        {OPTION_UINT, "rounds", "N", "300", &o->rounds, "of the search for its bound; 0: no bound",
         0, 100000},
        option_json(&o->json),
    };
    const struct option_table table = {"sluice-tradeoff play", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    return outcome != OPTIONS_RUN || settle(&table, o) ? outcome : OPTIONS_ERROR;
}
