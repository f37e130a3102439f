/** The folder that keeps stores of pictures: names in it, and how much it holds. */
#ifndef SLC_OPEN_STORE_CACHE_H
#define SLC_OPEN_STORE_CACHE_H

#include <sluice/base.h>

#include "base/cache_folder.h"

/** "FOLDER/HASH.store": the hash is that of the picture's path without links, exclusive or that of
 *  the settings, which is 0 for default ones. Errors: OUT_OF_HOST_MEMORY. Free with slc_free(cb, s,
 *  strlen(s) + 1, 1). */
SluiceResult slc_store_cache_path(const char *folder, const char *picture, uint64_t settings_hash,
                                  const SluiceAllocationCallbacks *cb, char **path);

/** Notes that a store was opened now. Its contents and their time stay as they are. */
void slc_store_cache_touch(const char *path);

/** Writes "FOLDER/HASH-PROCESS-ID.preview" for the picture of that store; no other process uses it.
 *  `id` is the stream's. False if it does not fit. */
bool slc_store_cache_preview_path(const char *store_path, const void *id, char *path, size_t size);

/** Whether somebody writes the store now. */
bool slc_store_cache_is_busy(const char *store_path, const SluiceAllocationCallbacks *cb);

/**
 * Deletes the stores that were touched longest ago until the others have at most `max_size` bytes.
 * Keeps the stores that `is_kept` says, stores that are being written, and files whose names
 * slc_store_cache_path did not make. Deletes previews that were left behind. Without memory it does
 * nothing.
 */
void slc_store_cache_trim(const char *folder, uint64_t max_size,
                          const SluiceAllocationCallbacks *cb,
                          bool (*is_kept)(void *user, const struct slc_cache_entry *store),
                          void *user);

#endif /* SLC_OPEN_STORE_CACHE_H */
