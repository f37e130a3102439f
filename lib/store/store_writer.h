/** Writer of a store: parts that creation, writing and finishing share. */
#ifndef SLC_STORE_STORE_WRITER_H
#define SLC_STORE_STORE_WRITER_H

#include "base/part_file.h"
#include "store/codec.h"
#include "store/repeats.h"
#include "store/store_file.h"
#include "store/store_layout.h"
#include "platform/thread.h"

/** Buffers of one call that makes a chunk. One per concurrent call. */
struct slc_store_bench {
    struct slc_store_bench *next;
    uint64_t turn; ///< turn while the chunk waits
    struct slc_store_place place;
    const void *bytes; ///< stored bytes of the chunk: in `texels` or `stored`
    size_t size;
    struct slc_store_compressor *compressor; ///< NULL: nothing is compressed
    unsigned char texels[SLC_STORE_MAX_CHUNK_SIZE];
    unsigned char stored[SLC_STORE_MAX_CHUNK_SIZE];
};

enum slc_store_state {
    SLC_STORE_WRITING,
    SLC_STORE_BROKEN,  ///< contents unknown after an error; must be resumed
    SLC_STORE_FINISHED ///< complete, with its final name
};

struct SluiceStoreWriter {
    SluiceAllocationCallbacks allocator;
    struct slc_part_file part;
    struct slc_store_file file; ///< Borrowed from `part`, for reading and writing its bytes.
    struct slc_store_header header;
    unsigned char header_bytes[SLC_STORE_HEADER_SIZE];
    bool may_resume;
    bool has_mutex;         ///< mutex and condition exist
    struct slc_mutex mutex; ///< guards the fields below
    enum slc_store_state state;
    uint64_t end; ///< offset of the next compressed chunk
    uint64_t written_count;
    struct slc_store_bench *idle;
    uint64_t turn;                   ///< earliest turn that has not ended
    struct slc_store_bench *waiting; ///< chunks of later turns, by turn
    uint32_t waiting_count;
    struct slc_condition turn_changed;
    struct slc_store_repeats *repeats; ///< owned; NULL before the first chunk
};

/** Finds the chunk of a tile, or of a level of the tail. Errors, logged: INVALID_ARGUMENT. */
SluiceResult slc_store_writer_find(const SluiceStoreWriter *writer, uint32_t layer, uint32_t level,
                                   uint32_t x, uint32_t y, struct slc_store_place *place);

/** Reads the present entry of a chunk from the file. Errors: IO, logged. */
SluiceResult slc_store_writer_entry(const SluiceStoreWriter *writer, uint64_t number,
                                    struct slc_store_entry *entry);

/** True if a chunk is written. Entries of missing chunks have size 0. */
static inline bool slc_store_entry_is_written(const struct slc_store_entry *entry)
{
    return entry->size > 0;
}

/** Takes a bench that an earlier call gave back, or makes one. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_store_writer_take_bench(SluiceStoreWriter *writer, struct slc_store_bench **bench);
void slc_store_writer_give_bench(SluiceStoreWriter *writer, struct slc_store_bench *bench);

/** Finds a tile's chunk and checks that it can be written. Errors: as sluiceWriteStoreTile. */
SluiceResult slc_store_writer_check_tile(SluiceStoreWriter *writer, uint32_t layer, uint32_t level,
                                         uint32_t x, uint32_t y, size_t row_pitch,
                                         struct slc_store_place *place);
/** Compresses a tile to place, bytes and size of the bench. `bytes` may point to `texels`. */
SluiceResult slc_store_writer_compress(SluiceStoreWriter *writer,
                                       const struct slc_store_place *place, const void *texels,
                                       size_t row_pitch, struct slc_store_bench *bench);
/** Writes the chunk of a bench and its entry. Errors: IO, logged. */
SluiceResult slc_store_writer_write(SluiceStoreWriter *writer, const struct slc_store_bench *bench);

/** Gives back what sluiceWriteStoreTile keeps between calls. */
void slc_store_writer_free_benches(SluiceStoreWriter *writer);

/** Seals a block if all of its entries are written. `missing`: the first chunk that is not written,
 *  else the number of chunks. Errors: IO, logged. */
SluiceResult slc_store_writer_seal(const SluiceStoreWriter *writer, uint64_t block,
                                   uint64_t *missing);

#endif /* SLC_STORE_STORE_WRITER_H */
