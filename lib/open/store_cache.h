/** Cache folder for stores of pictures: names and size. */
#ifndef SLC_OPEN_STORE_CACHE_H
#define SLC_OPEN_STORE_CACHE_H

#include <sluice/base.h>

#include "base/cache_folder.h"

/** Makes "FOLDER/HASH.store". HASH: hash of the picture's path without links, XOR the hash of the
 *  settings (0: default). Errors: OUT_OF_HOST_MEMORY. Free with slc_free(cb, s, strlen(s) + 1, 1).
 */
SluiceResult slc_store_cache_path(const char *folder, const char *picture, uint64_t settings_hash,
                                  const SluiceAllocationCallbacks *cb, char **path);

/** Records the time of use of a store. Contents and modification time stay unchanged. */
void slc_store_cache_touch(const char *path);

/** Writes "FOLDER/HASH-PROCESS-ID.preview" for the store's picture. The name is unique to process
 * and stream; `id` is the stream's. False: too long. */
bool slc_store_cache_preview_path(const char *store_path, const void *id, char *path, size_t size);

/** Tells whether a process is writing the store. */
bool slc_store_cache_is_busy(const char *store_path, const SluiceAllocationCallbacks *cb);

/**
 * Deletes least recently used stores until the others have at most `max_size` bytes. Keeps stores
 * for which `is_kept` is true, stores in writing, and files with names of other programs. Deletes
 * abandoned previews. Does nothing if out of memory.
 */
void slc_store_cache_trim(const char *folder, uint64_t max_size,
                          const SluiceAllocationCallbacks *cb,
                          bool (*is_kept)(void *user, const struct slc_cache_entry *store),
                          void *user);

#endif /* SLC_OPEN_STORE_CACHE_H */
