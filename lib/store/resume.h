/** What an earlier writer left behind: what of it is right is kept, the rest forgotten. */
#ifndef SLC_STORE_RESUME_H
#define SLC_STORE_RESUME_H

#include "store/repeats.h"
#include "store/store_file.h"
#include "store/store_layout.h"

struct slc_store_resumed {
    uint64_t chunk_count;
    uint64_t end; ///< of the last chunk, at least data_offset
    /** The chunks that the earlier writer remembered, so that both together write the bytes of one.
     *  Owned by the caller. NULL if nothing is compressed. */
    struct slc_store_repeats *repeats;
};

/**
 * Reads every chunk that the index of a .sluice-part file has, and clears the entries of those
 * whose checksum is not right. The header has been found to match; the file is as long as header
 * and index at least. Errors: IO, logged; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_store_resume(const struct slc_store_file *file,
                              const struct slc_store_header *header,
                              struct slc_store_resumed *resumed);

#endif /* SLC_STORE_RESUME_H */
