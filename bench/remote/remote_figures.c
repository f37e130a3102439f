/*
 * How fast tiles of a store come from a server, beside libcurl alone with the same ranges.
 *
 *     remote_figures --make FILE [--edge N]
 *     remote_figures [options] FILE URL
 *
 * FILE is the store that URL names. Tiles of level 0 are read at random by as many threads as
 * requests are to be in flight, by sluice-http and a store's source, which checks them, and by a
 * loop around curl_easy_perform. Both ways take turns, on connections that are open and warm.
 * run.sh starts server and line.
 */
#define _XOPEN_SOURCE 700

#include "ways.h"

#include "../../tools/common/clock.h"
#include "../../tools/common/shared_options.h"

#include <curl/curl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static struct {
    bool json, quick, make, overhead;
    uint32_t edge;
    double round_trip; ///< milliseconds
    const char *file, *url, *requests, *name;
    struct tiles tiles;
} run = {.name = ""};

static void figure(const char *name, double value, const char *unit)
{
    if (run.json)
        printf("{\"name\": \"%s%s\", \"value\": %.6g, \"unit\": \"%s\"}\n", run.name, name, value,
               unit);
    else
        printf("%s%-40s %12.6g %s\n", run.name, name, value, unit);
    fflush(stdout);
}

/* Threads that read until they are told to stop. */

struct phase {
    struct way *way;
    atomic_bool is_counting, is_over, has_failed;
};

struct reader {
    struct phase *phase;
    uint32_t number;
    uint64_t count;     ///< tiles after the first one that counts
    double first, last; ///< when those came
    pthread_t thread;
    unsigned char *texels;
};

static void note_tile(struct reader *reader)
{
    double now = clock_seconds();
    if (reader->first == 0)
        reader->first = now;
    else
        reader->count++;
    reader->last = now;
}

static void *read_tiles(void *user)
{
    struct reader *reader = user;
    struct phase *phase = reader->phase;
    uint64_t seed = reader->number * 0x9e3779b97f4a7c15u + 1;
    while (!atomic_load(&phase->is_over)) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        const struct tile *tile = &run.tiles.items[(seed >> 33) % run.tiles.count];
        if (!phase->way->read(phase->way, reader->number, tile, reader->texels)) {
            atomic_store(&phase->has_failed, true);
            break;
        }
        if (atomic_load(&phase->is_counting))
            note_tile(reader);
    }
    return NULL;
}

static void start_readers(struct phase *phase, struct reader *readers, uint32_t count)
{
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, (size_t)256 << 10);
    for (uint32_t i = 0; i < count; i++) {
        readers[i] = (struct reader){.phase = phase, .number = i, .texels = malloc(TILE_SIZE)};
        if (!readers[i].texels ||
            pthread_create(&readers[i].thread, &attributes, read_tiles, &readers[i]) != 0)
            fail("starting threads");
    }
    pthread_attr_destroy(&attributes);
}

/* Includes all threads of the process. */
static double processor_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

struct rate {
    double tiles;     ///< per second
    double processor; ///< seconds per tile
};

/* Measures from each reader's first tile to its last, so that a slow line does not round the
 * figure. */
static struct rate measure_way(struct way *way, uint32_t count)
{
    static struct reader readers[MAX_READERS];
    struct phase phase = {.way = way};
    struct rate rate = {0, 0};
    uint64_t tiles = 0;
    double trip = run.round_trip * 1e-3;
    double warm = (run.quick ? 0.05 : 0.3) + 6 * trip;
    double long_enough = run.quick ? 0.1 + 3 * trip : 0.8 + 12 * trip;
    start_readers(&phase, readers, count);
    clock_sleep_until(clock_seconds() + warm);
    double processor = processor_seconds();
    atomic_store(&phase.is_counting, true);
    clock_sleep_until(clock_seconds() + long_enough);
    atomic_store(&phase.is_over, true);
    for (uint32_t i = 0; i < count; i++) {
        pthread_join(readers[i].thread, NULL);
        free(readers[i].texels);
        tiles += readers[i].count + (readers[i].first > 0);
        if (readers[i].count > 0)
            rate.tiles += (double)readers[i].count / (readers[i].last - readers[i].first);
    }
    if (atomic_load(&phase.has_failed))
        fail("reading tiles");
    rate.processor = (processor_seconds() - processor) / (double)(tiles ? tiles : 1);
    return rate;
}

/* Other load of the machine makes all ways slower, and none faster. */
static void keep_best(struct rate *best, const struct rate *rate)
{
    if (rate->tiles > best->tiles)
        best->tiles = rate->tiles;
    if (best->processor == 0 || rate->processor < best->processor)
        best->processor = rate->processor;
}

static void measure(uint32_t count)
{
    struct way ways[] = {open_plain(run.url, count), open_input(run.url, count),
                         open_source(run.url, count)};
    static const char *const names[] = {"plain", "ranges", "tiles"};
    enum { WAYS = sizeof ways / sizeof *ways };
    struct rate rates[WAYS] = {0};
    unsigned rounds = run.quick ? 1 : run.round_trip > 0 ? 2 : 5;
    char name[64];
    for (unsigned i = 0; i < rounds; i++)
        for (unsigned w = 0; w < WAYS; w++) {
            struct rate rate = measure_way(&ways[w], count);
            keep_best(&rates[w], &rate);
        }
    for (unsigned w = 0; w < WAYS; w++) {
        snprintf(name, sizeof name, "at_once_%u.%s", count, names[w]);
        figure(name, rates[w].tiles, "tiles/s");
        snprintf(name, sizeof name, "at_once_%u.%s.processor", count, names[w]);
        figure(name, rates[w].processor * 1e6, "us/tile");
    }
    for (unsigned w = 1; w < WAYS; w++) {
        snprintf(name, sizeof name, "at_once_%u.%s.of_plain", count, names[w]);
        figure(name, rates[w].tiles / rates[0].tiles, "");
    }
    for (unsigned w = 0; w < WAYS; w++)
        ways[w].finish(&ways[w]);
}

/* Opens, reads each tile once, one after the other, and says what came beside them. */
static void measure_overhead(void)
{
    static unsigned char texels[TILE_SIZE];
    struct way way = open_source(run.url, 1);
    SluiceHttpStatistics before = get_statistics(&way);
    size_t count = run.tiles.count < 100 ? run.tiles.count : 100;
    figure("opening.requests", (double)before.requestTotal, "");
    figure("opening.bytes", (double)(before.bodyBytes + before.headerBytes), "B");
    for (size_t i = 0; i < count; i++)
        if (!way.read(&way, 0, &run.tiles.items[run.tiles.count - count + i], texels))
            fail("reading tiles");
    SluiceHttpStatistics after = get_statistics(&way);
    double reads = (double)(after.requestTotal - before.requestTotal);
    figure("tile.bytes", (double)(after.bodyBytes - before.bodyBytes) / reads, "B");
    figure("tile.answer_header", (double)(after.headerBytes - before.headerBytes) / reads, "B");
    way.finish(&way);
}

static void measure_all(void)
{
    const char *text = run.requests;
    while (*text) {
        char *end;
        unsigned long count = strtoul(text, &end, 10);
        if (end == text || count < 1 || count > MAX_READERS) {
            fprintf(stderr, "remote_figures: --requests takes numbers from 1 to %d\n", MAX_READERS);
            exit(2);
        }
        measure((uint32_t)count);
        text = *end == ',' ? end + 1 : end;
    }
}

int main(int argc, char **argv)
{
    const struct option rows[] = {
        {OPTION_WORD, .operand = "FILE", .value = &run.file, .minimum = 1, .help = "a store"},
        {OPTION_WORD, .operand = "URL", .value = &run.url, .help = "a URL"},
        option_json(&run.json),
        {OPTION_FLAG, "make", .value = &run.make, .help = "write FILE"},
        {OPTION_UINT, "edge", "N", "4096", &run.edge, "texels along an edge of FILE", 256, 32768},
        {OPTION_FLAG, "quick", .value = &run.quick, .help = "measure for a moment"},
        {OPTION_MILLISECONDS, "round-trip", "TIME", "0", &run.round_trip,
         "of the line: how long is measured follows it", 0, 10000},
        {OPTION_TEXT, "requests", "LIST", "1,8,32,128", &run.requests, "requests in flight"},
        {OPTION_FLAG, "overhead", .value = &run.overhead,
         .help = "count bytes that come beside tiles instead"},
        {OPTION_TEXT, "name", "TEXT", "(none)", &run.name, "begins the names of figures"},
    };
    const struct option_table table = {"remote_figures",
                                       "usage: remote_figures [options] FILE [URL]\n", NULL, rows,
                                       sizeof rows / sizeof *rows};
    switch (options_parse(&table, argc, argv)) {
    case OPTIONS_RUN: break;
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    }
    if (run.make) {
        make_store(run.file, run.edge);
        return 0;
    }
    if (!run.url) {
        fprintf(stderr, "remote_figures: give a URL, too\n");
        return 2;
    }
    curl_global_init(CURL_GLOBAL_DEFAULT);
    run.tiles = find_tiles(run.file);
    if (run.overhead)
        measure_overhead();
    else
        measure_all();
    free(run.tiles.items);
    curl_global_cleanup();
    return 0;
}
