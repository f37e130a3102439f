#include "play_options.h"

#include "../common/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct play_options defaults = {
    .heap_tiles = 1024,
    .standby = 1000,
    .tiles_per_frame = 256,
    .latency = 2,
    .timeout = 1,
    .writers = 1,
    .probability = 1,
    .seed = 1,
    .rounds = 300,
};

#define FLAG 0 /* `unit` of an option without a value */

struct option {
    const char *name, *unit; ///< unit FLAG: `flag`; else one of the others
    const char *help;
    const char **text;
    uint32_t *number;
    double *real;
    bool *flag;
    double least, most;
};

#define OPTION_COUNT 22

static void list_options(struct play_options *o, struct option options[OPTION_COUNT])
{
    const double any = UINT32_MAX;
    const struct option all[OPTION_COUNT] = {
        {"output", "DIR", "write frames.csv there", .text = &o->output},
        {"heap-tiles", "N", "tiles per heap", .number = &o->heap_tiles, .least = 1,
         .most = 1 << 20},
        {"max-heaps", "N", "heaps at most; 0: any number", .number = &o->max_heaps, .most = any},
        {"budget", "MIB", "instead: memory for all heaps; 0: any amount", .number = &o->budget,
         .most = 1 << 24},
        {"standby", "N", "unrequested tiles kept in memory", .number = &o->standby, .most = any},
        {"prefetch-levels", "N", "coarsest levels loaded when nothing is requested",
         .number = &o->prefetch_levels, .most = 32},
        {"tiles-per-frame", "N", "loads answered per frame at most", .number = &o->tiles_per_frame,
         .least = 1, .most = 1 << 20},
        {"latency", "FRAMES", "from handed out to answered", .number = &o->latency, .most = 999},
        {"loads-in-flight", "N", "at most; 0: tiles-per-frame * (latency + 1)",
         .number = &o->loads_in_flight, .most = 1 << 30},
        {"timeout", "SECONDS", "how long a region stays requested after it was last seen",
         .real = &o->timeout, .least = 1e-6, .most = 1e9},
        {"misses-to-forget", "N", "maps that have to miss a region beside; 0: learned",
         .number = &o->misses_to_forget, .most = any},
        {"mip-bias", "LEVELS", "added to what maps ask for, a whole number", .real = &o->mip_bias,
         .least = -32, .most = 32},
        {"textures-per-frame", "N", "maps read per frame, in turns; 0: all that there are",
         .number = &o->textures_per_frame, .most = any},
        {"in-turns", FLAG, "a map shows one frame; else all since it was last read",
         .flag = &o->in_turns},
        {"probability", "P", "that a pixel writes feedback: 0.1 or 1/16", .real = &o->probability,
         .most = 1},
        {"writers", "N", "pixels that see a region", .number = &o->writers, .least = 1,
         .most = 1 << 24},
        {"drop-probability", "P", "instead: that a region is left out of a frame's map",
         .real = &o->drop, .most = 1},
        {"seed", "N", "of what is left out", .number = &o->seed, .most = any},
        {"clairvoyant", FLAG, "also what a policy that knows the whole trace does",
         .flag = &o->clairvoyant},
        {"rounds", "N", "of the search for its bound; 0: no bound", .number = &o->rounds,
         .most = 100000},
        {"json", FLAG, "a JSON object for each figure", .flag = &o->json},
        {"help", FLAG, "this text"},
    };
    memcpy(options, all, sizeof all);
}

static void print_help(void)
{
    struct play_options o = defaults;
    struct option options[OPTION_COUNT];
    list_options(&o, options);
    puts(
        "usage: sluice-tradeoff play TRACE [options]\n"
        "\n"
        "Plays a feedback trace (SLTRACE1, docs/replay.md) as an application would, and prints a\n"
        "line for each figure: tiles needed and loaded, how much too coarse what was sampled was,\n"
        "memory, time. Defaults are in brackets.\n");
    for (int i = 0; i < OPTION_COUNT; i++) {
        const struct option *option = &options[i];
        printf("  --%-18s %-8s %s", option->name, option->unit ? option->unit : "", option->help);
        if (option->number)
            printf(" (%u)", *option->number);
        else if (option->real)
            printf(" (%g)", *option->real);
        puts("");
    }
    puts("\nWhat is left out of maps and what they ask for is a simulation: quality is measured "
         "against\n"
         "the whole map and without the bias.\n"
         "Exit status: 0; 1 for a trace that cannot be played, or a file that cannot be written; 2 "
         "for\n"
         "wrong usage.");
}

/** "0.25" or "1/4". */
static bool parse_number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text)
        return false;
    if (*end == '/') {
        const char *below = end + 1;
        double divisor = strtod(below, &end);
        if (end == below || divisor == 0)
            return false;
        *value /= divisor;
    }
    return *end == '\0' && isfinite(*value);
}

static bool parse_value(const struct option *option, const char *text)
{
    double value = 0;
    if (option->text) {
        *option->text = text;
        return true;
    }
    bool whole = option->number != NULL || strcmp(option->name, "mip-bias") == 0;
    if (!parse_number(text, &value) || value < option->least || value > option->most ||
        (whole && value != floor(value))) {
        text_say("play: --%s takes a%s number from %.10g to %.10g, not '%s'", option->name,
                 whole ? " whole" : "", option->least, option->most, text);
        return false;
    }
    if (option->number)
        *option->number = (uint32_t)value;
    else
        *option->real = value;
    return true;
}

static const struct option *find_option(const struct option *options, const char *argument)
{
    for (int i = 0; strncmp(argument, "--", 2) == 0 && i < OPTION_COUNT; i++)
        if (strcmp(options[i].name, argument + 2) == 0)
            return &options[i];
    text_say("play: there is no option %s", argument);
    return NULL;
}

static bool parse_all(struct play_options *o, int argc, char **argv, bool *help)
{
    struct option options[OPTION_COUNT];
    list_options(o, options);
    bool only_names = false;
    for (int i = 1; i < argc; i++) {
        if (!only_names && strcmp(argv[i], "--") == 0) {
            only_names = true;
            continue;
        }
        if (only_names || argv[i][0] != '-' || argv[i][1] == '\0') {
            if (o->trace)
                text_say("play: one trace at a time, not also '%s'", argv[i]);
            if (o->trace)
                return false;
            o->trace = argv[i];
            continue;
        }
        const struct option *option = find_option(options, argv[i]);
        if (!option)
            return false;
        if (option->unit && ++i == argc)
            text_say("play: --%s needs a value", option->name);
        if (option->unit && (i == argc || !parse_value(option, argv[i])))
            return false;
        if (option->flag)
            *option->flag = true;
        else if (!option->unit)
            *help = true;
    }
    return true;
}

/** Settings that say the same thing twice, and what follows from one of them. */
static bool settle(struct play_options *o)
{
    if (o->drop > 0 && o->probability < 1)
        fprintf(stderr, "play: --drop-probability or --probability, not both\n");
    else if (o->budget && o->max_heaps)
        fprintf(stderr, "play: --budget or --max-heaps, not both\n");
    else if (!o->trace)
        fprintf(stderr, "play: a trace is needed; --help says more\n");
    if ((o->drop > 0 && o->probability < 1) || (o->budget && o->max_heaps) || !o->trace)
        return false;
    const uint32_t tiles = o->budget * 16; /* of 64 KiB */
    if (o->budget) {
        o->heap_tiles = o->heap_tiles < tiles ? o->heap_tiles : tiles;
        o->max_heaps = tiles / o->heap_tiles;
    }
    if (o->probability < 1)
        o->drop = pow(1 - o->probability, o->writers);
    return true;
}

enum play_usage play_options_parse(struct play_options *o, int argc, char **argv)
{
    bool help = false;
    *o = defaults;
    if (!parse_all(o, argc, argv, &help))
        return PLAY_WRONG;
    if (help)
        print_help();
    if (help)
        return PLAY_HELP;
    return settle(o) ? PLAY_RUN : PLAY_WRONG;
}
