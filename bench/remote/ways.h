/** Ways to read the tiles of a store on a server: with sluice-http, and with libcurl alone. */
#ifndef BENCH_REMOTE_WAYS_H
#define BENCH_REMOTE_WAYS_H

#include <sluice/http.h>
#include <sluice/store.h>

#include <stdbool.h>
#include <stddef.h>

enum { TILE_SIZE = 65536, MAX_READERS = 128 };

/** A tile of the store, and where its bytes lie in the file. */
struct tile {
    SluiceImageRegion region;
    uint64_t offset, size;
};

struct tiles {
    struct tile *items;
    size_t count;
};

/** Reads all whole tiles of a store once, and notes which bytes that takes. Ends the program on
 *  errors, as all functions here do. */
struct tiles find_tiles(const char *path);

/** Writes a store of edge x edge texels, RGBA8, uncompressed. */
void make_store(const char *path, uint32_t edge);

/** Reads tiles on `reader_count` threads at once. */
struct way {
    /** `reader` tells threads apart. Blocks until the tile is in `texels`. */
    bool (*read)(struct way *way, uint32_t reader, const struct tile *tile, unsigned char *texels);
    void (*finish)(struct way *way);
    void *state;
};

/** curl_easy_perform alone. */
struct way open_plain(const char *url, uint32_t reader_count);
/** An input of sluice-http, read at the tiles' ranges. */
struct way open_input(const char *url, uint32_t reader_count);
/** A source of a store over such an input, which checks each tile. */
struct way open_source(const char *url, uint32_t reader_count);

/** Counts of a way that open_input or open_source made. */
SluiceHttpStatistics get_statistics(const struct way *way);

void fail(const char *what);

#endif /* BENCH_REMOTE_WAYS_H */
