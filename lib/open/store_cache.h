/** The folder that keeps stores of pictures: names in it, and how much it holds. */
#ifndef SLC_OPEN_STORE_CACHE_H
#define SLC_OPEN_STORE_CACHE_H

#include <sluice/base.h>

/** Makes the folder unless it is there. Errors: IO, logged. */
SluiceResult slc_store_cache_make(const char *folder, const SluiceLogCallback *log);

/** "FOLDER/HASH.store": the hash is that of the picture's path without links. Errors:
 *  OUT_OF_HOST_MEMORY. Free with slc_free(cb, s, strlen(s) + 1, 1). */
SluiceResult slc_store_cache_path(const char *folder, const char *picture,
                                  const SluiceAllocationCallbacks *cb, char **path);

/** Notes that a store was opened now. Its contents and their time stay as they are. */
void slc_store_cache_touch(const char *path);

/**
 * Deletes the stores that were touched longest ago until the others have at most `max_size` bytes.
 * Keeps what `is_kept` says, and what is being written. Without memory it does nothing.
 */
void slc_store_cache_trim(const char *folder, uint64_t max_size,
                          const SluiceAllocationCallbacks *cb,
                          bool (*is_kept)(void *user, const char *name), void *user);

#endif /* SLC_OPEN_STORE_CACHE_H */
