/** Resuming of an unfinished store: keeps valid chunks, and drops all others. */
#ifndef SLC_STORE_RESUME_H
#define SLC_STORE_RESUME_H

#include "store/repeats.h"
#include "store/store_file.h"
#include "store/store_layout.h"

struct slc_store_resumed {
    uint64_t chunk_count;
    uint64_t end; ///< end of the last chunk, at least data_offset
    /** Recently written chunks of the earlier writer, so that the resumed file has the bytes of one
     *  written in one go. Owned by the caller. NULL if nothing is compressed. */
    struct slc_store_repeats *repeats;
};

/**
 * Reads every chunk in the index of a .sluice-part file, and clears entries whose checksum is
 * wrong. The header must match, and the file must have at least header and index. Errors: IO,
 * logged; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_store_resume(const struct slc_store_file *file,
                              const struct slc_store_header *header,
                              struct slc_store_resumed *resumed);

#endif /* SLC_STORE_RESUME_H */
