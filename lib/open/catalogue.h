/** Catalogues of stores, which sluice-bake --merge writes: docs/cluster.md has the format. */
#ifndef SLC_OPEN_CATALOGUE_H
#define SLC_OPEN_CATALOGUE_H

#include <sluice/input.h>

#include "image/file_pool.h"

struct slc_catalogue_entry {
    char *store;   ///< owned; path or URL; NULL: no store
    uint64_t hash; ///< sluiceHashStore of the store
};

/** Place of a catalogue. */
struct slc_catalogue_place {
    const char *path;         ///< stores are relative to its folder
    const char *shown;        ///< in messages
    const SluiceInput *input; ///< NULL: the file
    SluiceFilePool *pool;     ///< pool for the file
    const SluiceAllocationCallbacks *allocator;
    const SluiceLogCallback *log;
};

/** Catalogue: sorted names and hashes. Constant. */
struct slc_catalogue;

/** Reads all rows. A damaged row makes the whole catalogue an error. Errors, logged: IO,
 *  CORRUPT_DATA, LIMIT_EXCEEDED; not logged: OUT_OF_HOST_MEMORY. */
SluiceResult slc_catalogue_read(const struct slc_catalogue_place *place,
                                struct slc_catalogue **catalogue);
/** NULL is allowed. */
void slc_catalogue_destroy(struct slc_catalogue *catalogue, const SluiceAllocationCallbacks *cb);

/**
 * Finds a store by `name`: the name of a picture or store, or its end behind a slash if no other
 * row has the same end. NULL: the first row. Time: logarithmic in the number of rows.
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
