#include "base/cache_folder.h"

#include "base/alloc.h"
#include "base/log.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#define SECONDS_UNTIL_LEFT (24 * 3600) /* age from which on unfinished files are abandoned */

struct entries {
    struct slc_cache_entry *items;
    size_t count, capacity;
    uint64_t size;
};

SluiceResult slc_cache_folder_make(const char *folder, const SluiceLogCallback *log)
{
    struct slc_file_status status;
    if (slc_folder_make(folder) ||
        (errno == EEXIST && slc_path_get_status(folder, &status) && status.kind == SLC_NODE_FOLDER))
        return SLUICE_SUCCESS;
    slc_log(log, SLUICE_LOG_ERROR, "%s: cannot make this folder: %s", folder, strerror(errno));
    return SLUICE_ERROR_IO;
}

static bool add_entry(struct entries *entries, const SluiceAllocationCallbacks *cb,
                      const struct slc_cache_entry *entry)
{
    if (entries->count == entries->capacity) {
        size_t capacity = entries->capacity ? 2 * entries->capacity : 64;
        struct slc_cache_entry *grown =
            entries->items
                ? slc_regrow(cb, entries->items, entries->capacity, capacity, sizeof *grown)
                : slc_alloc(cb, capacity, sizeof *grown);
        if (!grown)
            return false;
        entries->items = grown;
        entries->capacity = capacity;
    }
    entries->items[entries->count++] = *entry;
    entries->size += entry->size;
    return true;
}

static bool list_entries(struct slc_folder *folder, const struct slc_cache_rules *rules,
                         const SluiceAllocationCallbacks *cb, struct entries *entries)
{
    const char *name;
    while ((name = slc_folder_next(folder))) {
        struct slc_cache_entry entry;
        struct slc_file_status status;
        size_t length = strlen(name);
        if (length >= sizeof entry.name)
            continue;
        memcpy(entry.name, name, length + 1);
        if (!rules->find_kind(&entry) || !slc_folder_get_status(folder, name, true, &status) ||
            status.kind != SLC_NODE_FILE)
            continue;
        entry.device = status.device;
        entry.inode = status.inode;
        entry.size = status.size;
        entry.read = status.read;
        entry.modified = status.modified;
        if (!add_entry(entries, cb, &entry))
            return false;
    }
    return true;
}

static int compare_read(const void *a, const void *b)
{
    const struct slc_file_time *x = &((const struct slc_cache_entry *)a)->read;
    const struct slc_file_time *y = &((const struct slc_cache_entry *)b)->read;
    if (x->seconds != y->seconds)
        return x->seconds < y->seconds ? -1 : 1;
    return (x->nanoseconds > y->nanoseconds) - (x->nanoseconds < y->nanoseconds);
}

static bool remove_entry(const char *path, struct slc_folder *folder,
                         const struct slc_cache_rules *rules, const struct slc_cache_entry *entry,
                         const SluiceAllocationCallbacks *cb)
{
    if (entry->kind == SLC_CACHE_UNFINISHED && rules->remove_unfinished)
        return rules->remove_unfinished(path, entry, cb);
    return slc_folder_remove(folder, entry->name);
}

/* Removes files until enough room is free, least recently read first. */
static void remove_entries(const char *path, struct slc_folder *folder,
                           const struct slc_cache_rules *rules, struct entries *entries,
                           const SluiceAllocationCallbacks *cb)
{
    int64_t now = (int64_t)time(NULL);
    uint64_t most = entries->size > rules->max_size ? rules->remaining_size : UINT64_MAX;
    if (entries->count > 0)
        qsort(entries->items, entries->count, sizeof *entries->items, compare_read);
    for (size_t i = 0; i < entries->count; i++) {
        const struct slc_cache_entry *entry = &entries->items[i];
        bool was_left = now - entry->modified.seconds > SECONDS_UNTIL_LEFT;
        bool is_removable = entry->kind == SLC_CACHE_COMPLETE || was_left;
        bool is_wanted = entry->kind == SLC_CACHE_TEMPORARY || entries->size > most;
        if (is_removable && is_wanted && !(rules->is_kept && rules->is_kept(rules->user, entry)) &&
            remove_entry(path, folder, rules, entry, cb))
            entries->size -= entry->size;
    }
}

bool slc_cache_folder_trim(const char *path, const struct slc_cache_rules *rules,
                           const SluiceAllocationCallbacks *cb, uint64_t *size)
{
    struct entries entries = {0};
    struct slc_folder *folder = slc_folder_begin(path);
    bool is_listed = folder && list_entries(folder, rules, cb, &entries);
    if (is_listed)
        remove_entries(path, folder, rules, &entries, cb);
    if (is_listed && size)
        *size = entries.size;
    slc_free(cb, entries.items, entries.capacity, sizeof *entries.items);
    slc_folder_end(folder);
    return is_listed;
}
