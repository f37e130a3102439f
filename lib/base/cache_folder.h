/**
 * Folders that keep files which can be made again. Processes share a folder and end at any time, so
 * the folder alone says how much it holds.
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
        SLC_CACHE_UNFINISHED, ///< removed to make room if nobody has written it for a day
        SLC_CACHE_TEMPORARY   ///< removed if nobody has written it for a day
    } kind;
    uint64_t device, inode, size;
    struct slc_file_time read, modified;
};

struct slc_cache_rules {
    uint64_t max_size;       ///< bytes from which on room is made
    uint64_t remaining_size; ///< bytes that are left then; at most max_size
    /** Sets `kind` from `name`. False if the cache does not make such names; the file stays. */
    bool (*find_kind)(struct slc_cache_entry *entry);
    /** NULL: no file is kept. */
    bool (*is_kept)(void *user, const struct slc_cache_entry *entry);
    /** Removes an unfinished file unless it is being written. NULL: as other files. */
    bool (*remove_unfinished)(const char *folder, const struct slc_cache_entry *entry,
                              const SluiceAllocationCallbacks *cb);
    void *user; ///< for is_kept
};

/** Makes the folder unless it is there. Errors: SLUICE_ERROR_IO, logged. */
SluiceResult slc_cache_folder_make(const char *folder, const SluiceLogCallback *log);

/**
 * Removes what was read longest ago where the folder holds too much, and what processes left
 * unfinished. Returns the bytes of the cache's files that stay in `*size`, which may be NULL. False
 * if the folder cannot be listed or there is no memory: nothing is removed, `*size` stays.
 */
bool slc_cache_folder_trim(const char *folder, const struct slc_cache_rules *rules,
                           const SluiceAllocationCallbacks *cb, uint64_t *size);

#endif /* SLC_BASE_CACHE_FOLDER_H */
