/** An open file: its header, the parts of its index that were used last, and chunks by number. */
#ifndef SLC_STORE_READER_H
#define SLC_STORE_READER_H

#include "image/input_file.h"
#include "store/equal_chunks.h"
#include "store/store_layout.h"
#include "store/store_read_pool.h"
#include "platform/thread.h"

/** Blocks of the index that are kept, each at a place of its own. */
#define SLC_STORE_KEPT_BLOCKS 64u

struct slc_store_reader {
    struct slc_input_file file;
    struct slc_store_header header;      ///< constant
    struct slc_store_equal_chunks equal; ///< constant
    unsigned char header_bytes[SLC_STORE_HEADER_SIZE];
    SluiceStoreReadPool *pool, *own_pool; ///< the second NULL where the first is the caller's
    bool checks_always;                   ///< raw chunks; else once while their block is kept
    bool has_mutex;
    struct slc_mutex mutex; ///< around what follows
    struct {
        uint64_t number;                                    ///< of the block
        unsigned char *bytes;                               ///< NULL: none; sound
        uint8_t checked[(SLC_STORE_BLOCK_ENTRIES + 7) / 8]; ///< bits: chunks that were right
    } kept[SLC_STORE_KEPT_BLOCKS];
};

/** Where a chunk is, and where to look if it cannot be read. */
struct slc_store_find {
    struct slc_store_place place;
    uint64_t number;
    struct slc_store_entry entry;
    uint64_t offset; ///< of its bytes, or of the part of the index that is wrong
    bool is_checked; ///< its checksum was right before
};

/** `info` without NULL where there may not be. Errors: as sluiceCreateStoreImageSource, logged. */
SluiceResult slc_store_reader_open(struct slc_store_reader *reader,
                                   const SluiceStoreImageSourceCreateInfo *info);
/** Also after a failed open. */
void slc_store_reader_close(struct slc_store_reader *reader);

/** Fills `find` for its place. Errors: IO, CORRUPT_DATA, logged. Any thread. */
SluiceResult slc_store_find_chunk(struct slc_store_reader *reader, struct slc_store_find *find);

/**
 * Reads the chunk at `place` into slc_store_chunk_size bytes, which may be bench->texels. `find` is
 * what is known then, also after an error. Errors: IO, CORRUPT_DATA, logged; OUT_OF_HOST_MEMORY.
 * Any thread.
 */
SluiceResult slc_store_read_chunk(struct slc_store_reader *reader,
                                  const struct slc_store_place *place,
                                  struct slc_store_read_bench *bench, void *texels,
                                  struct slc_store_find *find);

#endif /* SLC_STORE_READER_H */
