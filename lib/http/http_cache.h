/**
 * Cache folder of ranges. Each range has a file. A file gets its name when complete, so processes
 * may share the folder and end at any time.
 */
#ifndef SLC_HTTP_HTTP_CACHE_H
#define SLC_HTTP_HTTP_CACHE_H

#include "platform/thread.h"

#include <sluice/base.h>

#include <stdatomic.h>

/** Key of a range of a version of a file. */
struct slc_http_key {
    uint64_t low, high;         ///< hash of URL, version and range
    const char *name, *version; ///< borrowed; written beside the bytes and compared
};

struct slc_http_cache {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *folder;
    uint64_t max_size;
    _Atomic uint64_t size, hits; ///< bytes in the folder as known to this process, and hits
    _Atomic uint64_t turn;       ///< counter for names of part files
    atomic_bool has_failed;      ///< a write failed and was logged
    struct slc_mutex trimming;
};

/** Creates the folder if missing, and counts its bytes. Errors: IO, logged; OUT_OF_HOST_MEMORY.
 *  Call slc_http_cache_finish also after an error. */
SluiceResult slc_http_cache_init(struct slc_http_cache *cache, const char *folder,
                                 uint64_t max_size, const SluiceAllocationCallbacks *cb,
                                 const SluiceLogCallback *log);
/** Frees the cache's memory; files stay. A zeroed struct is allowed. */
void slc_http_cache_finish(struct slc_http_cache *cache);

/** Makes a key. `name`: `url` without user, password and query, which are never written. `version`:
 *  ETag, date and size. */
struct slc_http_key slc_http_cache_key(const char *url, const char *name, const char *version,
                                       uint64_t offset, uint64_t size);

/** Reads a range. False: missing, or damaged and therefore removed. Any thread. */
bool slc_http_cache_read(struct slc_http_cache *cache, struct slc_http_key key, void *bytes,
                         size_t size);
/** Writes a range. Removes the least recently read ranges if the folder exceeds its limit. Logs
 * only the first failure. Any thread. */
void slc_http_cache_write(struct slc_http_cache *cache, struct slc_http_key key, const void *bytes,
                          size_t size);

#endif /* SLC_HTTP_HTTP_CACHE_H */
