#include "options.h"

#include "../common/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct options defaults = {
    .heap_tiles = 1024,
    .max_heaps = 0,
    .standby = 1000,
    .tiles_per_frame = 256,
    .latency = 2,
    .timeout_micros = 1000000,
    .memory_mib = 4096,
};

static bool parse_u32(const char *name, const char *text, uint32_t least, uint32_t most,
                      uint32_t *value)
{
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || errno || number > most || number < least) {
        text_say("sluice-replay: %s takes a whole number from %u to %u, not '%s'", name, least,
                 most, text);
        return false;
    }
    *value = (uint32_t)number;
    return true;
}

static bool parse_seconds(const char *name, const char *text, uint64_t *micros)
{
    char *end;
    double seconds = strtod(text, &end);
    if (end == text || *end || !(seconds >= 1e-6 && seconds <= 1e9)) {
        text_say("sluice-replay: %s takes seconds from 0.000001 to 1e9, not '%s'", name, text);
        return false;
    }
    *micros = (uint64_t)(seconds * 1e6 + 0.5);
    return true;
}

/* An option and its value. */
static bool parse_value(struct options *o, const char *name, const char *value)
{
    if (!value) {
        text_say("sluice-replay: %s needs a value", name);
        return false;
    }
    if (strcmp(name, "--expect") == 0)
        o->expect = value;
    else if (strcmp(name, "--record") == 0)
        o->record = value;
    else if (strcmp(name, "--heap-tiles") == 0)
        return parse_u32(name, value, 1, 1u << 20, &o->heap_tiles);
    else if (strcmp(name, "--max-heaps") == 0)
        return parse_u32(name, value, 0, UINT32_MAX, &o->max_heaps);
    else if (strcmp(name, "--standby") == 0)
        return parse_u32(name, value, 0, UINT32_MAX, &o->standby);
    else if (strcmp(name, "--tiles-per-frame") == 0)
        return parse_u32(name, value, 1, UINT32_MAX, &o->tiles_per_frame);
    else if (strcmp(name, "--latency") == 0)
        return parse_u32(name, value, 0, UINT32_MAX, &o->latency);
    else if (strcmp(name, "--timeout") == 0)
        return parse_seconds(name, value, &o->timeout_micros);
    else
        return parse_u32(name, value, 1, UINT32_MAX, &o->memory_mib);
    return true;
}

static bool takes_value(const char *name)
{
    static const char *const names[] = {"--expect",    "--record",  "--heap-tiles",
                                        "--max-heaps", "--standby", "--tiles-per-frame",
                                        "--latency",   "--timeout", "--memory"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

static bool take_trace(struct options *o, const char *name)
{
    if (o->trace)
        text_say("sluice-replay: one trace at a time, not also '%s'", name);
    bool first = !o->trace;
    o->trace = name;
    return first;
}

static bool refuse(const char *name)
{
    if (strcmp(name, "--budget") == 0) /* a size in MiB elsewhere */
        text_say("sluice-replay: --budget is called --tiles-per-frame");
    else
        text_say("sluice-replay: there is no option %s; --help says more", name);
    return false;
}

bool parse_options(struct options *o, int argc, char **argv)
{
    bool only_names = false;
    *o = defaults;
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i];
        if (only_names || name[0] != '-' || name[1] == '\0') {
            if (!take_trace(o, name))
                return false;
        } else if (strcmp(name, "--") == 0) {
            only_names = true;
        } else if (takes_value(name)) {
            i++;
            if (!parse_value(o, name, i < argc ? argv[i] : NULL))
                return false;
        } else if (strcmp(name, "--dump") == 0) {
            o->dump = true;
        } else if (strcmp(name, "--json") == 0) {
            o->json = true;
        } else if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
            o->help = true;
        } else {
            return refuse(name);
        }
    }
    if (!o->trace && !o->help)
        fprintf(stderr, "sluice-replay: a trace is needed; --help says more\n");
    if (o->dump && o->json)
        fprintf(stderr, "sluice-replay: --dump or --json, not both\n");
    return (o->trace || o->help) && !(o->dump && o->json);
}

void print_help(void)
{
    printf("usage: sluice-replay TRACE [options]\n"
           "\n"
           "Plays a trace of a texture manager and prints statistics and a hash over all of its\n"
           "decisions. TRACE is a recording (SLUICERT) or a feedback trace (SLTRACE1), - the\n"
           "standard input. Options end at --.\n"
           "\n"
           "  --dump              print every event and every decision instead\n"
           "  --json              print the statistics as one JSON object per line\n"
           "  --expect FILE       compare the dump, or if FILE begins with 'hash' just that line,\n"
           "                      and name the first line that differs\n"
           "  --record FILE       record what is played as SLUICERT\n"
           "  --memory MIB        host memory for trace, manager and --expect together (%u)\n"
           "  --help              this text\n"
           "\n"
           "For SLTRACE1, which has feedback but no frame loop (see docs/replay.md):\n"
           "  --heap-tiles N      tiles per heap (%u)\n"
           "  --max-heaps N       heaps at most, 0 for any number (%u)\n"
           "  --standby N         unrequested tiles kept in memory (%u)\n"
           "  --tiles-per-frame N tiles answered per frame at most (%u)\n"
           "  --latency N         frames from handed out to answered (%u)\n"
           "  --timeout SECONDS   how long a region stays requested after it was last seen (%g)\n"
           "\n"
           "Exit status: 0 all is well; 1 the trace is damaged, its decisions differ from those\n"
           "recorded or expected, or a file cannot be read or written; 2 wrong usage.\n",
           defaults.memory_mib, defaults.heap_tiles, defaults.max_heaps, defaults.standby,
           defaults.tiles_per_frame, defaults.latency, (double)defaults.timeout_micros / 1e6);
}
