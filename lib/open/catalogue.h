/** Catalogues of stores, which sluice-bake --merge writes: docs/cluster.md has the format. */
#ifndef SLC_OPEN_CATALOGUE_H
#define SLC_OPEN_CATALOGUE_H

#include <sluice/input.h>

#include "image/file_pool.h"

struct slc_catalogue_entry {
    char *store;   ///< owned; path or URL; NULL: none
    uint64_t hash; ///< sluiceHashStore of the store
};

struct slc_catalogue_query {
    const char *path;  ///< of the catalogue; stores are relative to its folder
    const char *shown; ///< in messages
    const char *name;  ///< picture or store, or the end of one that no other has; NULL: first
    const SluiceInput *input; ///< NULL: the file
    SluiceFilePool *pool;     ///< of the file
    const SluiceAllocationCallbacks *allocator;
    const SluiceLogCallback *log;
};

/** Finds a store. Errors: IO, CORRUPT_DATA, LIMIT_EXCEEDED, INVALID_ARGUMENT if there is none of
 *  that name, OUT_OF_HOST_MEMORY; logged. */
SluiceResult slc_catalogue_find(const struct slc_catalogue_query *query,
                                struct slc_catalogue_entry *entry);
void slc_catalogue_entry_finish(struct slc_catalogue_entry *entry,
                                const SluiceAllocationCallbacks *cb);

#endif /* SLC_OPEN_CATALOGUE_H */
