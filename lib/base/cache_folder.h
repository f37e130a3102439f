/**
 * Cache folders of files that can be made again. Processes share a folder and end at any time, so
 * its size is known only from the folder itself.
 */
#ifndef SLC_BASE_CACHE_FOLDER_H
#define SLC_BASE_CACHE_FOLDER_H

#include <sluice/base.h>

#include "platform/folder.h"

/** A file of the folder. */
struct slc_cache_entry {
    char name[112];
    enum {
        SLC_CACHE_COMPLETE,   ///< removed to make room
        SLC_CACHE_UNFINISHED, ///< removed to make room if not written for a day
        SLC_CACHE_TEMPORARY   ///< removed if not written for a day
    } kind;
    uint64_t device, inode, size;
    struct slc_file_time read, modified;
};

struct slc_cache_rules {
    uint64_t max_size;       ///< bytes beyond which files are removed
    uint64_t remaining_size; ///< bytes that are left after a removal; at most max_size
    /** Sets `kind` from `name`. False if the cache does not make such names; the file stays. */
    bool (*find_kind)(struct slc_cache_entry *entry);
    /** True if a file must be kept. NULL: no file is. */
    bool (*is_kept)(void *user, const struct slc_cache_entry *entry);
    /** Removes an unfinished file unless it is being written. NULL: as other files. */
    bool (*remove_unfinished)(const char *folder, const struct slc_cache_entry *entry,
                              const SluiceAllocationCallbacks *cb);
    void *user; ///< for is_kept
};

/** Makes the folder unless it exists. Errors: SLUICE_ERROR_IO, logged. */
SluiceResult slc_cache_folder_make(const char *folder, const SluiceLogCallback *log);

/**
 * Removes the least recently read files if the folder is too large, and files that processes left
 * unfinished. `*size` becomes the bytes of the remaining files; it may be NULL. False, with nothing
 * removed and `*size` unchanged, if the folder cannot be listed or there is no memory.
 */
bool slc_cache_folder_trim(const char *folder, const struct slc_cache_rules *rules,
                           const SluiceAllocationCallbacks *cb, uint64_t *size);

#endif /* SLC_BASE_CACHE_FOLDER_H */
