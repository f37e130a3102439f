/**
 * Recently written chunks of a compressed store, by their stored bytes. A chunk with equal bytes is
 * not written again: both entries of the index name one place. The usual case is constant and
 * repeated tiles. Not thread-safe: the writer locks.
 */
#ifndef SLC_STORE_REPEATS_H
#define SLC_STORE_REPEATS_H

#include "store/store_file.h"

#include <stdbool.h>

#define SLC_STORE_REPEATS 4096u /* table entries; a newer chunk replaces an older one */

struct slc_store_repeat {
    uint64_t hash, offset;
    uint32_t size; ///< 0: empty
};

struct slc_store_repeats {
    struct slc_store_repeat at[SLC_STORE_REPEATS];
};

uint64_t slc_store_repeat_hash(const void *bytes, size_t size);
/** Returns a chunk that may have equal bytes; NULL: there is none. */
const struct slc_store_repeat *slc_store_repeats_find(const struct slc_store_repeats *repeats,
                                                      uint64_t hash, size_t size);
/** Adds a chunk whose bytes are in the file. */
void slc_store_repeats_add(struct slc_store_repeats *repeats,
                           const struct slc_store_repeat *repeat);
/** True if the file has these bytes at the chunk's place. False if it cannot be read. */
bool slc_store_repeat_is_equal(const struct slc_store_file *file,
                               const struct slc_store_repeat *repeat, const void *bytes);

#endif /* SLC_STORE_REPEATS_H */
