/** Catalogues of stores, which sluice-bake --merge writes: docs/cluster.md has the format. */
#ifndef SLC_OPEN_CATALOGUE_H
#define SLC_OPEN_CATALOGUE_H

#include <sluice/input.h>

#include "image/file_pool.h"

struct slc_catalogue_entry {
    char *store;   ///< owned; path or URL; NULL: none
    uint64_t hash; ///< sluiceHashStore of the store
};

/** Place of a catalogue. */
struct slc_catalogue_place {
    const char *path;         ///< stores are relative to its folder
    const char *shown;        ///< in messages
    const SluiceInput *input; ///< NULL: the file
    SluiceFilePool *pool;     ///< of the file
    const SluiceAllocationCallbacks *allocator;
    const SluiceLogCallback *log;
};

/** Names and hashes of a catalogue, sorted to be found. Constant. */
struct slc_catalogue;

/** Reads all rows; a damaged one refuses the catalogue. Errors: IO, CORRUPT_DATA, LIMIT_EXCEEDED,
 *  OUT_OF_HOST_MEMORY; all but the last are logged. */
SluiceResult slc_catalogue_read(const struct slc_catalogue_place *place,
                                struct slc_catalogue **catalogue);
/** NULL is allowed. */
void slc_catalogue_destroy(struct slc_catalogue *catalogue, const SluiceAllocationCallbacks *cb);

/**
 * Finds a store by `name`: a picture's or store's, or the end of one behind a slash that no other
 * row has. NULL: the first row. Takes time that grows with the logarithm of the rows.
 *
 * Errors: INVALID_ARGUMENT if no row or several rows have the name, CORRUPT_DATA if a server's
 * catalogue names a file of this machine; both are logged if `log` is set. OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_catalogue_find(const struct slc_catalogue *catalogue,
                                const struct slc_catalogue_place *place, const char *name,
                                struct slc_catalogue_entry *entry);
void slc_catalogue_entry_finish(struct slc_catalogue_entry *entry,
                                const SluiceAllocationCallbacks *cb);

#endif /* SLC_OPEN_CATALOGUE_H */
