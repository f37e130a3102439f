/**
 * An independent reader of .store files: docs/store.md in the plainest C, everything in memory.
 * Shares no code and no constant with lib/store.
 */
#ifndef TESTS_STORE_NAIVE_STORE_H
#define TESTS_STORE_NAIVE_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct naive_store {
    uint8_t *bytes; ///< of the whole file
    size_t size;
    uint32_t width, height, levels, layers, format, tile_width, tile_height, tail;
    uint32_t color_space, meaning, address_u, address_v, compression;
    char name[3901];
    uint64_t source_size, settings, chunks, data;
    int64_t source_time;
    uint64_t identity;
    uint32_t block_size, block_extent; ///< bytes; texels in either direction
};

/** A chunk as the index has it. */
struct naive_chunk {
    uint64_t entry; ///< where its entry is in the file
    uint64_t offset, checksum;
    uint32_t size, texel_size;
};

/** NULL, or what is wrong with the header. Takes the bytes, which are from malloc. */
const char *naive_store_init(struct naive_store *store, uint8_t *bytes, size_t size);
/** Reads a file. NULL, or what is wrong. */
const char *naive_store_load(struct naive_store *store, const char *path);
void naive_store_finish(struct naive_store *store);

/** What the index says of a chunk; inside a file that was loaded. */
struct naive_chunk naive_store_chunk(const struct naive_store *store, uint64_t number);

/** Bytes of a level, rows of blocks tight. */
size_t naive_store_level_size(const struct naive_store *store, uint32_t level);

/** Puts a level together from its chunks, all of which are checked. NULL, or what is wrong. */
const char *naive_store_level(const struct naive_store *store, uint32_t layer, uint32_t level,
                              uint8_t *out);

/**
 * Makes the checksums of header, index and chunks right again, as far as they lie in the file, so
 * that what they protect is reached. Any bytes.
 */
void naive_store_reseal(uint8_t *bytes, size_t size);

#endif /* TESTS_STORE_NAIVE_STORE_H */
