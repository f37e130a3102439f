/**
 * Plays a trace of the feedback-replay harness with a policy that knows the whole of it, measured
 * as the harness measures a manager; run.sh builds it:
 *
 *     clairvoyant traces/t1000.slt maxHeaps=4
 *
 * tools/clairvoyant/clairvoyant.h says by what rules, what is exact ("Belady", "bound") and what is
 * heuristic ("deadline", "priced").
 *
 * A texture is on screen between its maps too, but the harness looks only when a map is read. With
 * hold=0 a schedule may use that: drop a tile after a map and bring it back just before the next.
 * "Brought back" counts these uploads. With hold=1 a tile that was dropped between two maps in
 * succession that both need it counts for the first of them alone.
 *
 * "Stale" is the harness's rule: the latest map of the set does not need the tile that has come.
 * That is true of whatever is fetched ahead, so here it is no fault; "never seen" is waste. A set
 * whose tiles are split between two frames by the budget counts as come with the last of them.
 *
 * "Reactive floor": levels too coarse of a manager with no limits that loads whatever was asked
 * for, keeps it for good and never guesses. It knows of a tile when it is too late for the first
 * map; "appears", "enters" and "finer" say what was new: the set, the region or the level.
 */
#include "../../tools/common/output_file.h"
#include "clairvoyant.h"

#include <stdlib.h>
#include <string.h>

struct options {
    const char *trace, *plan;
    uint32_t max_heaps, heap_tiles, budget, latency, rounds;
    bool hold, json;
};

static const char usage[] =
    "usage: clairvoyant [--json] TRACE [KEY=VALUE...]\n"
    "  maxHeaps=0      cap on the heaps; 0: none\n"
    "  heapTiles=1024  tiles per heap\n"
    "  budget=256      uploads per frame\n"
    "  latency=2       frames from handing out to mapped\n"
    "  hold=0          1: a tile dropped between two maps that both need it fails the second\n"
    "  rounds=300      steps in the search for the bound; 0: no bound, deadlines only\n"
    "  plan=FILE       write the schedule: frame, + or -, texture, tile, count\n"
    "  standby=N, timeout=N  as the harness has them; ignored\n";

static bool parse_number(const char *text, uint32_t *value)
{
    char *end;
    unsigned long number = strtoul(text, &end, 10);
    *value = (uint32_t)number;
    return *text >= '0' && *text <= '9' && *end == 0 && number <= 1000000000;
}

static bool parse_key(struct options *o, const char *argument)
{
    const char *value = strchr(argument, '=');
    size_t length = value ? (size_t)(value - argument) : 0;
    uint32_t hold = 0;
    const struct {
        const char *name;
        uint32_t *number;
    } keys[] = {{"maxHeaps", &o->max_heaps}, {"heapTiles", &o->heap_tiles}, {"budget", &o->budget},
                {"latency", &o->latency},    {"rounds", &o->rounds},        {"hold", &hold}};
    if (length == 4 && !strncmp(argument, "plan", length)) {
        o->plan = value + 1;
        return true;
    }
    if (length == 7 && (!strncmp(argument, "standby", 7) || !strncmp(argument, "timeout", 7)))
        return true;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (length && strlen(keys[i].name) == length && !strncmp(argument, keys[i].name, length)) {
            bool good = parse_number(value + 1, keys[i].number);
            o->hold |= hold != 0;
            return good;
        }
    return false;
}

static bool parse(struct options *o, int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--json"))
            o->json = true;
        else if (!o->trace && argv[i][0] != '-')
            o->trace = argv[i];
        else if (!parse_key(o, argv[i]))
            return false;
    }
    return o->trace && o->budget && o->heap_tiles && o->latency < 1000;
}

static void print(const struct options *o, const char *group, const char *name, double value,
                  const char *unit)
{
    if (o->json)
        printf("{\"name\": \"%s/%s\", \"value\": %.6g, \"unit\": \"%s\"}\n", group, name, value,
               unit);
    else
        printf("%-15s %-18s %12.10g %s\n", group, name, value, unit);
}

static void print_outcome(const struct options *o, const struct workload *w, const char *group,
                          const struct outcome *r)
{
    double regions = w->regions ? (double)w->regions : 1;
    double uploads = r->uploads ? (double)r->uploads : 1;
    print(o, group, "uploads", (double)r->uploads, "tiles");
    print(o, group, "mean_too_coarse", (double)r->deficit / regions, "levels");
    print(o, group, "too_coarse", 100 * (double)r->too_coarse / regions, "percent of regions");
    print(o, group, "stale", 100 * (double)r->stale / uploads, "percent of uploads");
    print(o, group, "never_seen", (double)r->unused, "tiles");
    print(o, group, "brought_back", (double)r->returned, "tiles");
    print(o, group, "peak_resident", (double)r->peak, "tiles");
}

static void print_workload(const struct options *o, const struct workload *w,
                           const struct belady *belady)
{
    double regions = w->regions ? (double)w->regions : 1;
    const struct reactive_floor *floor = &w->reactive;
    print(o, "trace", "touched_regions", (double)w->regions, "regions");
    print(o, "trace", "needed_tiles", (double)belady->distinct, "tiles");
    print(o, "trace", "largest_instant", (double)belady->largest_instant, "tiles");
    print(o, "reactive_floor", "appears", (double)floor->appears / regions, "levels");
    print(o, "reactive_floor", "enters", (double)floor->enters / regions, "levels");
    print(o, "reactive_floor", "finer", (double)floor->finer / regions, "levels");
    print(o, "reactive_floor", "too_coarse", 100 * (double)floor->regions / regions,
          "percent of regions");
    print(o, "Belady", "uploads", (double)belady->uploads, "tiles");
    print(o, "Belady", "frames_over_cap", belady->frames_over_cap, "frames");
    print(o, "Belady", "unserved", (double)belady->unserved, "tiles");
}

static bool write_plan(const struct options *o, const struct workload *w,
                       const struct limits *limits, const struct prices *prices)
{
    if (!o->plan)
        return true;
    struct output_file *file = output_file_begin(o->plan);
    if (file)
        clv_schedule(w, limits, prices, output_file_stream(file));
    return output_file_end(file, true);
}

static bool play(const struct options *o, const struct workload *w)
{
    struct limits limits = {UINT64_MAX, o->budget, o->latency, o->hold};
    uint64_t slots = (uint64_t)o->max_heaps * o->heap_tiles;
    if (o->max_heaps && slots < w->packed_tiles) {
        fprintf(stderr, "the packed tiles alone need %llu slots\n",
                (unsigned long long)w->packed_tiles);
        return false;
    }
    if (o->max_heaps)
        limits.cap = slots - w->packed_tiles;
    struct belady belady = clv_belady(w, limits.cap);
    print_workload(o, w, &belady);
    struct outcome outcome = clv_schedule(w, &limits, NULL, NULL);
    print_outcome(o, w, "deadline", &outcome);
    if (!o->rounds)
        return write_plan(o, w, &limits, NULL);
    struct prices prices;
    outcome = clv_schedule_best(w, &limits, outcome.deficit, o->rounds, &prices);
    print(o, "bound", "mean_too_coarse", prices.bound / (w->regions ? (double)w->regions : 1),
          "levels");
    print_outcome(o, w, "priced", &outcome);
    bool planned = write_plan(o, w, &limits, &prices);
    clv_prices_finish(&prices);
    return planned;
}

int main(int argc, char **argv)
{
    struct options options = {.heap_tiles = 1024, .budget = 256, .latency = 2, .rounds = 300};
    struct workload workload;
    if (argc == 2 && !strcmp(argv[1], "--help")) {
        fputs(usage, stdout);
        return 0;
    }
    if (!parse(&options, argc, argv)) {
        fputs(usage, stderr);
        return 2;
    }
    struct feedback_trace trace;
    if (!output_add_input(options.trace) || !feedback_trace_open(&trace, options.trace))
        return 1;
    bool good = clv_workload_read(&workload, &trace, options.latency);
    feedback_trace_close(&trace);
    if (!good)
        return 1;
    good = play(&options, &workload);
    clv_workload_finish(&workload);
    return good ? 0 : 1;
}
