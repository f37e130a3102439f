/*
 * Measures how many tile stores can be open under a limit of file descriptors, and how fast they
 * are read, with and without a pool of open files.
 *
 *     file_figures [--json] [--quick] [--stores N] [--limit N] [--rows N] [--picture FILE] FOLDER
 *
 * FOLDER receives copies of a store of 64 x 64 texels, which are removed at the end. The files are
 * in the page cache. Uses one thread. --picture: also measures the time from opening a picture that
 * is no tile store to its preview and to its store. --rows: rows of a catalogue, which all name the
 * first store.
 */
#define _XOPEN_SOURCE 700

#include "../../tools/common/clock.h"
#include "../../tools/common/shared_options.h"

#include <sluice/open.h>
#include <sluice/store.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum { SIZE = 64 };

static struct {
    bool json, quick;
    uint32_t store_count, limit;
    uint32_t rows;
    const char *folder, *picture;
    SluiceStoreReadPool *read_pool;
    SluiceImageSource **sources;
} run;

static void figure(const char *name, double value, const char *unit)
{
    if (run.json)
        printf("{\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\"}\n", name, value, unit);
    else
        printf("%-40s %12.6g %s\n", name, value, unit);
}

static void fail(const char *what)
{
    fprintf(stderr, "file_figures: %s failed\n", what);
    exit(1);
}

static void path_of(uint32_t i, char path[512])
{
    snprintf(path, 512, "%s/%u" SLUICE_STORE_EXTENSION, run.folder, i);
}

static void write_first(void)
{
    static unsigned char texels[SIZE * SIZE * 4];
    const void *levels[7];
    char path[512];
    SluiceStoreWriter *writer;
    path_of(0, path);
    for (uint32_t i = 0; i < sizeof texels; i++)
        texels[i] = (unsigned char)(i * 7);
    for (uint32_t l = 0; l < 7; l++)
        levels[l] = texels;
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = path,
                                  .width = SIZE,
                                  .height = SIZE,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    if (sluiceCreateStoreWriter(&info, &writer) || sluiceWriteStoreTail(writer, 0, levels, NULL) ||
        sluiceFinishStore(writer))
        fail("writing a store");
    sluiceDestroyStoreWriter(writer);
}

/* Copies files directly: the library's writer waits for the disk each time. */
static void copy_stores(void)
{
    static char bytes[1 << 18];
    char path[512];
    path_of(0, path);
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
    if (size == 0 || size == sizeof bytes)
        fail("reading a store");
    fclose(file);
    for (uint32_t i = 1; i < run.store_count; i++) {
        path_of(i, path);
        file = fopen(path, "wb");
        if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
            fail("copying a store");
    }
}

static void remove_stores(void)
{
    char path[512];
    for (uint32_t i = 0; i < run.store_count; i++) {
        path_of(i, path);
        unlink(path);
    }
}

static void set_limit(uint64_t limit)
{
    struct rlimit now;
    if (getrlimit(RLIMIT_NOFILE, &now) != 0)
        fail("getrlimit");
    now.rlim_cur = limit < now.rlim_max ? limit : now.rlim_max;
    if (setrlimit(RLIMIT_NOFILE, &now) != 0)
        fail("setrlimit");
}

/* Returns the number of opened stores. */
static uint32_t open_stores(SluiceFilePool *pool)
{
    uint32_t count = 0;
    for (; count < run.store_count; count++) {
        char path[512];
        path_of(count, path);
        SluiceStoreImageSourceCreateInfo info = {
            .structSize = sizeof info, .pPath = path, .readPool = run.read_pool, .filePool = pool};
        SluiceResult result = sluiceCreateStoreImageSource(&info, &run.sources[count]);
        if (result == SLUICE_NOT_READY)
            break;
        if (result != SLUICE_SUCCESS)
            fail("opening a store");
    }
    return count;
}

static void close_stores(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        sluiceDestroyImageSource(run.sources[i]);
}

/* Reads level 0 of `count` stores in rounds over all stores. Returns reads per second. */
static double reads_per_second(uint32_t count)
{
    static unsigned char texels[SIZE * SIZE * 4];
    SluiceImageRegion region = {0, 0, 0, SIZE, SIZE, 0};
    uint64_t reads = 0, most = run.quick ? 2000 : 100000;
    for (uint32_t i = 0; i < count; i++) /* reads the index once */
        if (sluiceReadImageRegion(run.sources[i], &region, texels, 4 * SIZE))
            fail("reading a store");
    double start = clock_seconds();
    for (uint32_t at = 0; reads < most; reads++, at = (at + 1) % count)
        if (sluiceReadImageRegion(run.sources[at], &region, texels, 4 * SIZE))
            fail("reading a store");
    return (double)reads / (clock_seconds() - start);
}

static void measure_with_pool(void)
{
    SluiceFilePool *pool;
    SluiceFilePoolStatistics statistics = {.structSize = sizeof statistics};
    set_limit(run.limit);
    if (sluiceCreateFilePool(NULL, &pool))
        fail("creating a pool");
    double start = clock_seconds();
    uint32_t count = open_stores(pool);
    figure("pool.stores", count, "stores");
    figure("pool.opening", 1e6 * (clock_seconds() - start) / count, "us/store");
    figure("pool.reads.all", reads_per_second(count), "reads/s");
    if (sluiceGetFilePoolStatistics(pool, &statistics))
        fail("asking the pool");
    uint32_t hot = statistics.maxOpenFileCount < count ? statistics.maxOpenFileCount : count;
    figure("pool.reads.open", reads_per_second(hot), "reads/s");
    figure("pool.open_files", statistics.openFilePeak, "files");
    close_stores(count);
    sluiceDestroyFilePool(pool);
}

static void measure_without_pool(void)
{
    set_limit(run.limit);
    uint32_t count = open_stores(NULL);
    figure("no_pool.stores", count, "stores");
    close_stores(count);
    set_limit((uint64_t)run.store_count + 64);
    count = open_stores(NULL);
    figure("no_pool.unlimited.stores", count, "stores");
    figure("no_pool.reads.all", reads_per_second(count), "reads/s");
    figure("no_pool.reads.open", reads_per_second(count < 64 ? count : 64), "reads/s");
    close_stores(count);
}

/* Counts allocated bytes. One thread only. */
static void *count_allocation(void *user, size_t size, size_t alignment)
{
    (void)alignment;
    *(uint64_t *)user += size;
    return malloc(size);
}

static void count_free(void *user, void *memory, size_t size)
{
    *(uint64_t *)user -= size;
    free(memory);
}

static uint64_t hash_of_first(void)
{
    char path[512];
    uint64_t hash = 0;
    SluiceImageSource *source;
    path_of(0, path);
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info, .pPath = path};
    if (sluiceCreateStoreImageSource(&info, &source) || sluiceHashStore(source, &hash))
        fail("opening a store");
    sluiceDestroyImageSource(source);
    return hash;
}

/* Writes a catalogue as in docs/cluster.md. */
static void write_catalogue(const char *path)
{
    FILE *file = fopen(path, "wb");
    unsigned long long hash = hash_of_first();
    if (!file)
        fail("writing a catalogue");
    fputs("sluice catalogue 1\nhash\tformat\twidth\theight\tlayers\tbytes\tpicture\tstore\n", file);
    for (uint32_t i = 0; i < run.rows; i++)
        fprintf(
            file,
            "%016llx\tR8G8B8A8_UNORM\t64\t64\t1\t20000\t/shared/pictures/scene-%03u/wall-%06u.jpg"
            "\t0" SLUICE_STORE_EXTENSION "\n",
            hash, i % 300, i);
    if (fclose(file) != 0)
        fail("writing a catalogue");
}

static void open_row(SluiceImageOpener *opener, const char *catalogue, uint32_t row)
{
    char name[64];
    SluiceImageSource *source;
    snprintf(name, sizeof name, "wall-%06u.jpg", row);
    if (sluiceOpenNamedImageSource(opener, catalogue, name, &source))
        fail("opening a row");
    sluiceDestroyImageSource(source);
}

/* The store is already open, so a name costs only the catalogue and a check of both files. */
static void measure_catalogue(void)
{
    char path[512], store[512];
    uint64_t bytes = 0, before;
    const uint32_t count = run.quick ? 100 : 10000;
    SluiceAllocationCallbacks callbacks = {&bytes, count_allocation, count_free};
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .pAllocator = &callbacks};
    SluiceImageOpener *opener;
    SluiceImageSource *source;
    snprintf(path, sizeof path, "%s/catalogue.tsv", run.folder);
    write_catalogue(path);
    path_of(0, store);
    if (sluiceCreateImageOpener(&info, &opener) || sluiceOpenImageSource(opener, store, &source))
        fail("opening a store");
    before = bytes;
    double start = clock_seconds();
    open_row(opener, path, 0);
    figure("catalogue.rows", run.rows, "rows");
    figure("catalogue.first", 1e3 * (clock_seconds() - start), "ms");
    figure("catalogue.memory", (double)(bytes - before), "bytes");
    start = clock_seconds();
    for (uint32_t i = 0; i < count; i++)
        open_row(opener, path, (uint32_t)((uint64_t)i * 7919 % run.rows));
    figure("catalogue.name", 1e6 * (clock_seconds() - start) / count, "us");
    sluiceDestroyImageSource(source);
    sluiceDestroyImageOpener(opener);
    unlink(path);
}

static void wait_for(SluiceImageSource *source, bool preview)
{
    const struct timespec step = {0, 1000000};
    SluiceOpenedImageInfo info = {.structSize = sizeof info};
    do {
        nanosleep(&step, NULL);
        if (sluiceGetOpenedImageInfo(source, &info) || info.failure != SLUICE_SUCCESS)
            fail("baking the picture");
    } while (!(preview ? info.previewReady : info.ready));
}

/* Begins with an empty cache, which is removed at the end. */
static void measure_picture(void)
{
    SluiceImageOpener *opener;
    SluiceImageSource *source, *again;
    char cache[512], command[600];
    snprintf(cache, sizeof cache, "%s/cache", run.folder);
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .pCacheFolder = cache};
    if (sluiceCreateImageOpener(&info, &opener))
        fail("creating an opener");
    double start = clock_seconds();
    if (sluiceOpenImageSource(opener, run.picture, &source))
        fail("opening the picture");
    figure("picture.open", 1e3 * (clock_seconds() - start), "ms");
    wait_for(source, true);
    figure("picture.preview", 1e3 * (clock_seconds() - start), "ms");
    wait_for(source, false);
    figure("picture.store", 1e3 * (clock_seconds() - start), "ms");
    sluiceDestroyImageSource(source);
    start = clock_seconds();
    if (sluiceOpenImageSource(opener, run.picture, &again))
        fail("opening the picture again");
    figure("picture.open_again", 1e3 * (clock_seconds() - start), "ms");
    sluiceDestroyImageSource(again);
    sluiceDestroyImageOpener(opener);
    snprintf(command, sizeof command, "rm -rf '%s'", cache);
    if (system(command) != 0)
        fail("removing the cache");
}

int main(int argc, char **argv)
{
    const struct option rows[] = {
        {OPTION_WORD, .operand = "FOLDER", .value = &run.folder, .minimum = 1, .help = "a folder"},
        option_json(&run.json),
        {OPTION_FLAG, "quick", .value = &run.quick, .help = "300 stores, few reads"},
        {OPTION_UINT, "stores", "N", "10000", &run.store_count, "stores in use", 1, 1 << 20},
        {OPTION_UINT, "rows", "N", "100000", &run.rows, "rows of a catalogue", 1, 1 << 20},
        {OPTION_TEXT, "picture", "FILE", "(none)", &run.picture, "a picture that libvips reads"},
        {OPTION_UINT, "limit", "N", "256", &run.limit, "file descriptors of the process", 64,
         1 << 20},
    };
    const struct option_table table = {"file_figures", "usage: file_figures [options] FOLDER\n",
                                       NULL, rows, sizeof rows / sizeof *rows};
    switch (options_parse(&table, argc, argv)) {
    case OPTIONS_RUN: break;
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    }
    if (run.quick && run.store_count > 300)
        run.store_count = 300;
    if (run.quick && run.rows > 1000)
        run.rows = 1000;
    run.sources = calloc(run.store_count, sizeof(SluiceImageSource *));
    if (!run.sources || sluiceCreateStoreReadPool(NULL, &run.read_pool))
        fail("finding memory");
    write_first();
    copy_stores();
    measure_with_pool();
    measure_without_pool();
    measure_catalogue();
    remove_stores();
    if (run.picture)
        measure_picture();
    sluiceDestroyStoreReadPool(run.read_pool);
    free(run.sources);
    return 0;
}
