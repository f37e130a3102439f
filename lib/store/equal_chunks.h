/**
 * Chunks of a compressed store that share stored bytes, found once in the index. Constant after
 * slc_store_equal_chunks_find: any thread may look up chunks.
 */
#ifndef SLC_STORE_EQUAL_CHUNKS_H
#define SLC_STORE_EQUAL_CHUNKS_H

#include "image/input_file.h"
#include "store/store_layout.h"

/** Larger indices are not read: 4 MiB, 208 896 chunks, 13 GB of texels. */
#define SLC_STORE_MAX_COMPARED_BLOCKS 1024u

struct slc_store_equal_chunk {
    uint64_t offset; ///< offset of the bytes in the file
    uint32_t size;   ///< bytes
    uint32_t number; ///< number of the chunk
};

struct slc_store_equal_chunks {
    struct slc_store_equal_chunk *at; ///< owned; ascending numbers
    uint32_t count, capacity;
};

/** Reads the index. Finds nothing if there is no memory for it or any part of it cannot be read,
 *  and nothing in damaged blocks. */
void slc_store_equal_chunks_find(struct slc_store_equal_chunks *chunks,
                                 const struct slc_input_file *file,
                                 const struct slc_store_header *header);
void slc_store_equal_chunks_finish(struct slc_store_equal_chunks *chunks,
                                   const SluiceAllocationCallbacks *cb);

/** Returns the offset of the chunk's bytes if other chunks share them, else 0. */
uint64_t slc_store_equal_chunks_get(const struct slc_store_equal_chunks *chunks, uint64_t number);

#endif /* SLC_STORE_EQUAL_CHUNKS_H */
