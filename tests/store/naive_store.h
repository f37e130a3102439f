/**
 * An independent reader of .store files: docs/store.md in plain C, with everything in memory.
 * Shares no code and no constant with lib/store.
 */
#ifndef TESTS_STORE_NAIVE_STORE_H
#define TESTS_STORE_NAIVE_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct naive_store {
    uint8_t *bytes; ///< bytes of the whole file
    size_t size;
    uint32_t width, height, levels, layers, format, tile_width, tile_height, tail;
    uint32_t color_space, meaning, address_u, address_v, compression;
    char name[3901];
    uint64_t source_size, settings, chunks, data;
    int64_t source_time;
    uint64_t identity;
    uint32_t block_size, block_extent; ///< bytes; texels per axis
};

/** A chunk's entry in the index. */
struct naive_chunk {
    uint64_t entry; ///< offset of the entry in the file
    uint64_t offset, checksum;
    uint32_t size, texel_size;
};

/** Takes the allocated bytes. Returns NULL, or a description of the header's error. */
const char *naive_store_init(struct naive_store *store, uint8_t *bytes, size_t size);
/** Reads a file. Returns NULL or a description of the error. */
const char *naive_store_load(struct naive_store *store, const char *path);
void naive_store_finish(struct naive_store *store);

/** Returns the index entry of a chunk in a loaded file. */
struct naive_chunk naive_store_chunk(const struct naive_store *store, uint64_t number);

/** Returns the bytes of a level with tight rows of blocks. */
size_t naive_store_level_size(const struct naive_store *store, uint32_t level);

/** Assembles a level from its chunks, and checks them all. Returns NULL or a description of the
 * error. */
const char *naive_store_level(const struct naive_store *store, uint32_t layer, uint32_t level,
                              uint8_t *out);

/**
 * Corrects the checksums of header, index and chunks, as far as they are in the file, so that tests
 * reach the code behind the checks. Accepts any bytes.
 */
void naive_store_reseal(uint8_t *bytes, size_t size);

#endif /* TESTS_STORE_NAIVE_STORE_H */
