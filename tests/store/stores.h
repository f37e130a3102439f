/** Stores for tests: texels by formula, files that remove themselves, messages that are kept. */
#ifndef TESTS_STORE_STORES_H
#define TESTS_STORE_STORES_H

#include <sluice/store.h>

#include <stdio.h>

/** A folder of its own, and a path in it. */
struct scratch {
    char folder[64];
    char path[96];       ///< in it, .store
    char part_path[112]; ///< .store.sluice-part
};

void scratch_init(struct scratch *scratch);
/** Removes the folder with its contents. */
void scratch_finish(struct scratch *scratch);

/** Counts logged messages and keeps the last error. */
struct messages {
    int errors, others;
    char last[1200];
};
SluiceLogCallback messages_log(struct messages *messages);

enum picture {
    PICTURE_SMOOTH, ///< zstd shrinks every tile, but those of few bytes
    PICTURE_NOISE,  ///< it shrinks none
    PICTURE_MIXED   ///< some
};

/**
 * Writes the bytes of a rectangle by formula: whole blocks, in rows `pitch` bytes apart. Bytes
 * between rows stay unchanged.
 */
void paint(enum picture picture, SluiceFormat format, const SluiceImageRegion *region, void *texels,
           size_t pitch);

/** Returns whether the bytes are those of paint. */
bool is_painted(enum picture picture, SluiceFormat format, const SluiceImageRegion *region,
                const void *texels, size_t pitch);

/** Writes the tiles that are missing, in order, up to `limit` of them, then, if none is missing,
 *  finishes. The first error. */
SluiceResult write_tiles(SluiceStoreWriter *writer, const SluiceStoreCreateInfo *info,
                         enum picture picture, uint64_t limit);

/** A whole file. */
SluiceResult write_store(const SluiceStoreCreateInfo *info, enum picture picture);

/** Writes one tile. With level = tailFirstLevel, writes a tail. */
SluiceResult write_one(SluiceStoreWriter *writer, const SluiceStoreLayout *layout,
                       enum picture picture, uint32_t layer, uint32_t level, uint32_t x,
                       uint32_t y);

/** Opens and reads all of all levels of all layers; if it can be read, it has to be this picture.
 *  The first error. */
SluiceResult read_store(const char *path, enum picture picture, struct messages *messages);

/** Reads a whole file. Free the result, which has *size bytes. */
unsigned char *read_bytes(const char *path, size_t *size);
void write_bytes(const char *path, const void *bytes, size_t size);
bool exists(const char *path);

#endif /* TESTS_STORE_STORES_H */
