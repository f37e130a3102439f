/** Reader of an open store: header, cached blocks of the index, and chunks by number. */
#ifndef SLC_STORE_READER_H
#define SLC_STORE_READER_H

#include "image/input_file.h"
#include "store/equal_chunks.h"
#include "store/store_layout.h"
#include "store/store_read_pool.h"
#include "platform/thread.h"

/** Blocks of the index that are cached; block n at n modulo this. */
#define SLC_STORE_KEPT_BLOCKS 64u

struct slc_store_reader {
    struct slc_input_file file;
    struct slc_store_header header;      ///< constant
    struct slc_store_equal_chunks equal; ///< constant
    unsigned char header_bytes[SLC_STORE_HEADER_SIZE];
    SluiceStoreReadPool *pool, *own_pool; ///< own_pool: NULL if `pool` is the caller's
    bool checks_always;                   ///< checks raw chunks always, not once per cached block
    bool has_mutex;
    struct slc_mutex mutex; ///< guards the fields below
    struct {
        uint64_t number;                                    ///< number of the block
        unsigned char *bytes;                               ///< undamaged block; NULL: none
        uint8_t checked[(SLC_STORE_BLOCK_ENTRIES + 7) / 8]; ///< bits: chunks that passed the check
    } kept[SLC_STORE_KEPT_BLOCKS];
};

/** Location of a chunk, or of the fault if it cannot be read. */
struct slc_store_find {
    struct slc_store_place place;
    uint64_t number;
    struct slc_store_entry entry;
    uint64_t offset; ///< offset of the bytes, or of the damaged part of the index
    bool is_checked; ///< the checksum was verified before
};

/** Opens a store. Required pointers of `info` must be set. Errors: as sluiceCreateStoreImageSource,
 * logged. */
SluiceResult slc_store_reader_open(struct slc_store_reader *reader,
                                   const SluiceStoreImageSourceCreateInfo *info);
/** Closes the store, also after a failed open. */
void slc_store_reader_close(struct slc_store_reader *reader);

/** Fills in `find` for find->place. Errors: IO, CORRUPT_DATA, logged. Any thread. */
SluiceResult slc_store_find_chunk(struct slc_store_reader *reader, struct slc_store_find *find);

/**
 * Reads the chunk at `place` into slc_store_chunk_size bytes, which may be bench->texels. Fills in
 * `find`, also after an error. Errors: IO, CORRUPT_DATA, logged; OUT_OF_HOST_MEMORY.
 * Any thread.
 */
SluiceResult slc_store_read_chunk(struct slc_store_reader *reader,
                                  const struct slc_store_place *place,
                                  struct slc_store_read_bench *bench, void *texels,
                                  struct slc_store_find *find);

#endif /* SLC_STORE_READER_H */
