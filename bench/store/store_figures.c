/*
 * Measures tiles per second from a store, compared with zstd only, reads only, and OpenEXR files of
 * the same picture. Uses one thread, with files in the page cache, so that the disk is not
 * measured.
 *
 *     store_figures [--json] [--quick] FOLDER PICTURE...
 *
 * FOLDER receives the written files. A PICTURE is a PPM or an OpenEXR file. All ratios compare
 * times of one run. Ways alternate: each reads all tiles once per round. The shortest time of each
 * tile and way counts.
 */
#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include "pictures.h"

#include "../../tools/common/shared_options.h"

#include <sluice/store.h>

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <zstd.h>

/* Texels go to as many positions in turn as a staging buffer has, so that they are not in the
 * cache. */
enum { TILE = 65536, PLACES = 256 };

static struct {
    bool json, quick;
    unsigned rounds;
    unsigned char *places;
} run;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static void figure(const char *name, double value, const char *unit)
{
    if (run.json)
        printf("{\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\"}\n", name, value, unit);
    else
        printf("%s %.6g %s\n", name, value, unit);
}

/* Tiles of a picture, without cut ones, and the ways to read them. */
struct picture {
    SluiceImageSource *store;
    SluiceImageSource *other; ///< NULL, OpenEXR, or the store with alwaysCheckRawTiles
    SluiceImageRegion *tiles;
    size_t tile_count;
    int file;              ///< file of the store
    unsigned char *frames; ///< the tiles, compressed by zstd only, one after the other
    size_t *frame_ends;
};

static unsigned char *place_of(size_t tile)
{
    return run.places + tile % PLACES * TILE;
}

static void fail(const char *what)
{
    fprintf(stderr, "%s failed\n", what);
    exit(1);
}

static void read_store(const struct picture *p, size_t i)
{
    if (sluiceReadImageRegion(p->store, &p->tiles[i], place_of(i),
                              (size_t)TILE / p->tiles[i].height))
        fail("reading the store");
}

static void read_other(const struct picture *p, size_t i)
{
    if (sluiceReadImageRegion(p->other, &p->tiles[i], place_of(i),
                              (size_t)TILE / p->tiles[i].height))
        fail("reading otherwise");
}

static void decompress(const struct picture *p, size_t i)
{
    size_t begin = i ? p->frame_ends[i - 1] : 0;
    if (ZSTD_decompress(place_of(i), TILE, p->frames + begin, p->frame_ends[i] - begin) != TILE)
        fail("decompressing");
}

/* Reads 64 KiB, from a tile's position in a file of tiles. */
static void read_block(const struct picture *p, size_t i)
{
    if (pread(p->file, place_of(i), TILE, (off_t)(8192 + i * TILE)) != TILE)
        fail("reading blocks");
}

typedef void way(const struct picture *picture, size_t tile);

/* Finds the shortest time of each way and tile over all rounds, and sums it over the tiles. */
static void race_picture(const struct picture *p, way *const *ways, unsigned way_count,
                         double *seconds)
{
    double *best = malloc(way_count * p->tile_count * sizeof *best);
    if (!best)
        fail("finding memory");
    for (unsigned round = 0; round < run.rounds; round++)
        for (unsigned w = 0; w < way_count; w++)
            for (size_t i = 0; i < p->tile_count; i++) {
                double start = now();
                ways[w](p, i);
                double taken = now() - start, *least = &best[w * p->tile_count + i];
                if (round == 0 || taken < *least)
                    *least = taken;
            }
    for (unsigned w = 0; w < way_count; w++)
        for (size_t i = 0; i < p->tile_count; i++)
            seconds[w] += best[w * p->tile_count + i];
    free(best);
}

/* Measures the time of each way for all tiles of all pictures. */
static void race(const struct picture *pictures, size_t count, way *const *ways, unsigned way_count,
                 double *seconds)
{
    for (unsigned w = 0; w < way_count; w++)
        seconds[w] = 0;
    for (size_t n = 0; n < count; n++)
        race_picture(&pictures[n], ways, way_count, seconds);
}

static void find_tiles(struct picture *p)
{
    SluiceStoreInfo info = {.structSize = sizeof info};
    if (sluiceGetStoreInfo(p->store, &info))
        fail("asking the store");
    p->tiles = calloc(info.layout.tileCount, sizeof *p->tiles);
    if (!p->tiles)
        fail("finding memory");
    for (uint32_t l = 0; l < info.layout.tailFirstLevel; l++)
        for (uint32_t y = 0; y < info.layout.levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < info.layout.levelWidthInTiles[l]; x++) {
                SluiceImageRegion *tile = &p->tiles[p->tile_count];
                if (sluiceGetStoreTileRegion(&info.layout, l, x, y, tile))
                    fail("finding a tile");
                p->tile_count +=
                    tile->width == info.layout.tileWidth && tile->height == info.layout.tileHeight;
            }
}

static void compress_alone(struct picture *p, int level)
{
    size_t bound = ZSTD_compressBound(TILE), end = 0;
    p->frames = malloc(p->tile_count * bound);
    p->frame_ends = malloc(p->tile_count * sizeof *p->frame_ends);
    if (!p->frames || !p->frame_ends)
        fail("finding memory");
    for (size_t i = 0; i < p->tile_count; i++) {
        read_store(p, i);
        end += ZSTD_compress(p->frames + end, bound, place_of(i), TILE, level);
        p->frame_ends[i] = end;
    }
}

static void open_tiles(struct picture *p, const char *path)
{
    *p = (struct picture){.store = open_store(path, NULL, false), .file = open(path, O_RDONLY)};
    find_tiles(p);
}

static void close_tiles(struct picture *p)
{
    sluiceDestroyImageSource(p->store);
    sluiceDestroyImageSource(p->other);
    close(p->file);
    free(p->tiles);
    free(p->frames);
    free(p->frame_ends);
}

static size_t count_tiles(const struct picture *pictures, size_t count)
{
    size_t sum = 0;
    for (size_t n = 0; n < count; n++)
        sum += pictures[n].tile_count;
    return sum;
}

static void name_file(char path[4096], const char *folder, const char *kind, size_t n)
{
    snprintf(path, 4096, "%s/%zu.%s", folder, n, kind);
}

static double size_of(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 ? (double)status.st_size : 0;
}

/* Measures compression at level 3, and the time of writing. */
static void measure_compressed(const char *folder, SluiceImageSource **sources, size_t count)
{
    struct picture *pictures = calloc(count, sizeof *pictures);
    double seconds[2], write_seconds = 0, size = 0;
    char path[4096];
    for (size_t n = 0; n < count; n++) {
        name_file(path, folder, "zstd.store", n);
        double start = now();
        write_store(path, sources[n], 3);
        write_seconds += now() - start;
        size += size_of(path);
        open_tiles(&pictures[n], path);
        compress_alone(&pictures[n], 3);
    }
    race(pictures, count, (way *const[]){read_store, decompress}, 2, seconds);
    double tiles = (double)count_tiles(pictures, count);
    figure("rgba8.zstd3.tiles", tiles / seconds[0], "tiles/s");
    figure("rgba8.zstd3.zstd_alone", tiles / seconds[1], "tiles/s");
    figure("rgba8.zstd3.of_zstd_alone", seconds[1] / seconds[0], "ratio");
    figure("rgba8.zstd3.written", tiles / write_seconds, "tiles/s");
    figure("rgba8.zstd3.size", size / (tiles * TILE), "of the texels");
    for (size_t n = 0; n < count; n++)
        close_tiles(&pictures[n]);
    free(pictures);
}

static void measure_uncompressed(const char *folder, SluiceImageSource **sources, size_t count)
{
    struct picture *pictures = calloc(count, sizeof *pictures);
    double seconds[3];
    char path[4096];
    for (size_t n = 0; n < count; n++) {
        name_file(path, folder, "raw.store", n);
        write_store(path, sources[n], 0);
        open_tiles(&pictures[n], path);
        pictures[n].other = open_store(path, NULL, true);
    }
    race(pictures, count, (way *const[]){read_store, read_block, read_other}, 3, seconds);
    double tiles = (double)count_tiles(pictures, count);
    figure("rgba8.raw.tiles", tiles / seconds[0], "tiles/s");
    figure("rgba8.raw.pread_alone", tiles / seconds[1], "tiles/s");
    figure("rgba8.raw.of_pread_alone", seconds[1] / seconds[0], "ratio");
    figure("rgba8.raw.checked_always.tiles", tiles / seconds[2], "tiles/s");
    figure("rgba8.raw.checked_always.of_pread_alone", seconds[1] / seconds[2], "ratio");
    for (size_t n = 0; n < count; n++)
        close_tiles(&pictures[n]);
    free(pictures);
}

/* Compares equal half texels in both kinds of file, with tiles of one shape. */
static void measure_half(const char *folder, SluiceImageSource **sources, size_t count)
{
    struct picture *pictures = calloc(count, sizeof *pictures);
    double seconds[2], size = 0, other_size = 0;
    char path[4096], exr_path[4096];
    for (size_t n = 0; n < count; n++) {
        name_file(exr_path, folder, "exr", n);
        write_exr(exr_path, sources[n]);
        SluiceImageSource *other = open_exr(exr_path, SLUICE_FORMAT_R16G16B16A16_SFLOAT);
        name_file(path, folder, "half.store", n);
        write_store(path, other, 3);
        open_tiles(&pictures[n], path);
        pictures[n].other = other;
        size += size_of(path);
        other_size += size_of(exr_path);
    }
    race(pictures, count, (way *const[]){read_store, read_other}, 2, seconds);
    double tiles = (double)count_tiles(pictures, count);
    figure("rgba16f.zstd3.tiles", tiles / seconds[0], "tiles/s");
    figure("rgba16f.zstd3.openexr_zip", tiles / seconds[1], "tiles/s");
    figure("rgba16f.zstd3.of_openexr_zip", seconds[1] / seconds[0], "ratio");
    figure("rgba16f.zstd3.size_of_openexr_zip", size / other_size, "ratio");
    for (size_t n = 0; n < count; n++)
        close_tiles(&pictures[n]);
    free(pictures);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

enum { OPENINGS = 501 };

static size_t tile_of_opening(const struct picture *p, size_t i)
{
    return i * 7919 % p->tile_count;
}

static void figure_of_times(double times[OPENINGS], const char *name)
{
    char whole[128];
    qsort(times, OPENINGS, sizeof times[0], by_size);
    snprintf(whole, sizeof whole, "%s.median", name);
    figure(whole, times[OPENINGS / 2], "us");
    snprintf(whole, sizeof whole, "%s.least", name);
    figure(whole, times[0], "us");
}

/* Measures the time from opening to the texels of a tile. */
static void time_opening(const struct picture *p, const char *path, SluiceStoreReadPool *pool,
                         const char *name)
{
    static double times[OPENINGS];
    for (size_t i = 0; i < OPENINGS; i++) {
        struct picture fresh = *p;
        double start = now();
        fresh.store = open_store(path, pool, false);
        read_store(&fresh, tile_of_opening(p, i));
        times[i] = (now() - start) * 1e6;
        sluiceDestroyImageSource(fresh.store);
    }
    figure_of_times(times, name);
}

/* Decompresses the tiles from memory: zstd's part, including a new context each time. */
static void time_zstd_alone(const struct picture *p)
{
    static double times[OPENINGS];
    for (size_t i = 0; i < OPENINGS; i++) {
        double start = now();
        decompress(p, tile_of_opening(p, i));
        times[i] = (now() - start) * 1e6;
    }
    figure_of_times(times, "open_and_first_tile.zstd_alone");
}

static void measure_opening(const char *folder)
{
    char path[4096];
    struct picture p;
    SluiceStoreReadPool *pool;
    name_file(path, folder, "zstd.store", 0);
    open_tiles(&p, path);
    compress_alone(&p, 3);
    if (sluiceCreateStoreReadPool(NULL, &pool))
        fail("making a pool");
    time_opening(&p, path, NULL, "open_and_first_tile");
    time_opening(&p, path, pool, "open_and_first_tile.shared_pool");
    time_zstd_alone(&p);
    sluiceDestroyStoreReadPool(pool);
    close_tiles(&p);
}

int main(int argc, char **argv)
{
    const char *folder = NULL;
    struct option_list pictures = {0};
    const struct option rows[] = {
        {OPTION_WORD, .operand = "FOLDER", .value = &folder, .minimum = 1, .help = "a folder"},
        {OPTION_WORDS, .operand = "PICTURE", .value = &pictures, .minimum = 1, .help = "a picture"},
        option_json(&run.json),
        {OPTION_FLAG, "quick", .value = &run.quick, .help = "one picture, few rounds"},
    };
    const struct option_table table = {"store_figures",
                                       "usage: store_figures [options] FOLDER PICTURE...\n", NULL,
                                       rows, sizeof rows / sizeof *rows};
    switch (options_parse(&table, argc, argv)) {
    case OPTIONS_RUN: break;
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    }
    run.rounds = run.quick ? 3 : 9;
    run.places = calloc(PLACES, TILE);
    SluiceImageSource **sources = calloc(pictures.count, sizeof(SluiceImageSource *));
    size_t count = 0;
    for (size_t i = 0; i < pictures.count && !(run.quick && count == 1); i++)
        if ((sources[count] = open_picture(pictures.items[i])))
            count++;
    if (!run.places || count == 0)
        fail("reading any picture");
    measure_compressed(folder, sources, count);
    measure_uncompressed(folder, sources, count);
    measure_half(folder, sources, count);
    measure_opening(folder);
    for (size_t n = 0; n < count; n++)
        sluiceDestroyImageSource(sources[n]);
    free(sources);
    free(run.places);
    return 0;
}
