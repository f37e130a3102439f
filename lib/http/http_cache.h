/**
 * Ranges of files that were read before, in a folder. One file per range, complete before it has
 * its name, so that processes may share the folder and end at any time.
 */
#ifndef SLC_HTTP_HTTP_CACHE_H
#define SLC_HTTP_HTTP_CACHE_H

#include "platform/thread.h"

#include <sluice/base.h>

#include <stdatomic.h>

/** Names a range of a version of a file. */
struct slc_http_key {
    uint64_t low, high;         ///< hash of all
    const char *name, *version; ///< borrowed; written beside the bytes and compared
};

struct slc_http_cache {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *folder;
    uint64_t max_size;
    _Atomic uint64_t size, hits; ///< bytes in the folder, as far as this process knows
    _Atomic uint64_t turn;       ///< numbers the files that are being written
    atomic_bool has_failed;      ///< a write did, and the log was told
    struct slc_mutex trimming;
};

/** Makes the folder unless it is there, and counts what it holds. Errors: IO, logged;
 *  OUT_OF_HOST_MEMORY. Destroy it also after an error. */
SluiceResult slc_http_cache_init(struct slc_http_cache *cache, const char *folder,
                                 uint64_t max_size, const SluiceAllocationCallbacks *cb,
                                 const SluiceLogCallback *log);
/** A zeroed struct is allowed. */
void slc_http_cache_finish(struct slc_http_cache *cache);

/** `name`: `url` without user, password and query, which are not written. `version`: ETag, date and
 *  size. */
struct slc_http_key slc_http_cache_key(const char *url, const char *name, const char *version,
                                       uint64_t offset, uint64_t size);

/** False: it is not there, or is damaged and was removed. Any thread. */
bool slc_http_cache_read(struct slc_http_cache *cache, struct slc_http_key key, void *bytes,
                         size_t size);
/** Keeps a range, and removes those that were read longest ago where it becomes too much. Failures
 *  are logged once. Any thread. */
void slc_http_cache_write(struct slc_http_cache *cache, struct slc_http_key key, const void *bytes,
                          size_t size);

#endif /* SLC_HTTP_HTTP_CACHE_H */
