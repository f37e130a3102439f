#include "options.h"

#include "../common/shared_options.h"

static const char usage[] =
    "usage: sluice-replay TRACE [options]\n"
    "\n"
    "Plays a trace and prints statistics and a hash over all decisions. TRACE is a\n"
    "recording of a texture manager (SLUICERT), of demand loading (SLUICEDR), or a\n"
    "feedback trace (SLTRACE1); - is the standard input. Options end at --.\n";

static const char notes[] =
    "Exit status: 0 all is well; 1 the trace is damaged, its decisions differ from those\n"
    "recorded or expected, or a file cannot be read or written; 2 wrong usage.\n";

enum option_outcome parse_options(struct options *o, int argc, char **argv)
{
    *o = (struct options){0};
    const struct option options[] = {
        {OPTION_WORD, .operand = "TRACE", .value = &o->trace, .help = "a trace", .minimum = 1},
        {OPTION_FLAG, "dump", .value = &o->dump,
         .help = "print every event and every decision instead"},
        option_json(&o->json),
        {OPTION_TEXT, "expect", "FILE", "(none)", &o->expect,
         "compare the dump, or if FILE begins with 'hash' just that line, and name the first line "
         "that differs"},
        {OPTION_TEXT, "record", "FILE", "(none)", &o->record, "record what is played"},
        option_memory(&o->memory, "host memory for trace, manager and --expect together"),
        {OPTION_SECTION,
         .help = "For SLTRACE1, which has feedback but no frame loop (see docs/replay.md)"},
        option_heap_tiles(&o->heap_tiles),
        option_max_heaps(&o->max_heaps),
        option_standby(&o->standby),
        option_tiles_per_frame(&o->tiles_per_frame, UINT32_MAX),
        {OPTION_RENAMED, "budget", "tiles-per-frame"}, /* this name is a size in other programs */
        option_latency(&o->latency),
        option_timeout(&o->timeout),
    };
    const struct option_table table = {"sluice-replay", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    if (outcome == OPTIONS_RUN && o->dump && o->json) {
        options_refuse(&table, "--dump or --json, not both");
        outcome = OPTIONS_ERROR;
    }
    return outcome;
}
