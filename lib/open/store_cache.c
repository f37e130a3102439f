#include "open/store_cache.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/part_file.h"
#include "base/said.h"
#include "platform/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Part files and previews that nobody has written for so long were left behind. */
#define SECONDS_UNTIL_LEFT (24 * 3600)

SluiceResult slc_store_cache_make(const char *folder, const SluiceLogCallback *log)
{
    struct slc_file_status status;
    if (slc_folder_make(folder) ||
        (errno == EEXIST && slc_path_get_status(folder, &status) && status.kind == SLC_NODE_FOLDER))
        return SLUICE_SUCCESS;
    slc_log(log, SLUICE_LOG_ERROR, "%s: cannot make this folder: %s", folder, strerror(errno));
    return SLUICE_ERROR_IO;
}

SluiceResult slc_store_cache_path(const char *folder, const char *picture,
                                  const SluiceAllocationCallbacks *cb, char **path)
{
    char *real = slc_path_resolve(picture);
    const char *name = real ? real : picture;
    uint64_t hash = slc_said_key(name), length = strlen(name);
    free(real);
    size_t size = strlen(folder) + 1 + 16 + 8 + 8;
    char *made = slc_alloc(cb, size, 1);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    snprintf(made, size, "%s/%016llx-%llx.store", folder, (unsigned long long)hash,
             (unsigned long long)(length & 0xFFFF));
    *path = slc_strdup(cb, made);
    slc_free(cb, made, size, 1);
    return *path ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_store_cache_touch(const char *path)
{
    slc_path_touch(path);
}

#define STORE_SUFFIX ".store"
#define PREVIEW_SUFFIX ".preview"
#define PART_SUFFIX ".sluice-part"

bool slc_store_cache_preview_path(const char *store_path, const void *id, char *path, size_t size)
{
    int stem = (int)(strlen(store_path) - strlen(STORE_SUFFIX));
    int length =
        snprintf(path, size, "%.*s-%llx-%llx" PREVIEW_SUFFIX, stem, store_path,
                 (unsigned long long)slc_get_process_id(), (unsigned long long)(uintptr_t)id);
    return length > 0 && (size_t)length < size;
}

bool slc_store_cache_is_busy(const char *store_path, const SluiceAllocationCallbacks *cb)
{
    static const SluiceLogCallback silent;
    struct slc_part_file part;
    SluiceResult result = slc_part_file_open(&part, store_path, SLC_PART_FILE_RESUME, cb, &silent);
    if (result == SLUICE_SUCCESS && part.size == 0) /* it was not there */
        slc_part_file_remove(&part);
    slc_part_file_close(&part);
    return result == SLUICE_ERROR_BUSY;
}

struct cached_stores {
    struct slc_cached_store *items;
    size_t count, capacity;
    uint64_t size; ///< bytes of all, those that are kept included
};

/* Goes behind 1 to `max` hexadecimal digits as printf writes them. False: there are none. */
static bool skip_digits(const char **text, size_t max)
{
    size_t count = strspn(*text, "0123456789abcdef");
    *text += count;
    return count > 0 && count <= max;
}

static bool skip_text(const char **text, const char *expected)
{
    size_t length = strlen(expected);
    if (strncmp(*text, expected, length) != 0)
        return false;
    *text += length;
    return true;
}

/* False: the name is none that this file makes. */
static bool find_kind(const char *name, struct slc_cached_store *store)
{
    bool is_ours = strspn(name, "0123456789abcdef") == 16 && skip_digits(&name, 16) &&
                   skip_text(&name, "-") && skip_digits(&name, 4);
    if (!is_ours)
        return false;
    store->kind = SLC_CACHED_STORE;
    if (!skip_text(&name, STORE_SUFFIX)) {
        store->kind = SLC_CACHED_PREVIEW;
        if (!skip_text(&name, "-") || !skip_digits(&name, 16) || !skip_text(&name, "-") ||
            !skip_digits(&name, 16) || !skip_text(&name, PREVIEW_SUFFIX))
            return false;
    }
    if (skip_text(&name, PART_SUFFIX) && store->kind == SLC_CACHED_STORE)
        store->kind = SLC_CACHED_PART;
    return *name == '\0';
}

/* Others may be written now. */
static bool is_removable(const struct slc_cached_store *store, const struct slc_file_status *status)
{
    return store->kind == SLC_CACHED_STORE ||
           (int64_t)time(NULL) - status->modified.seconds > SECONDS_UNTIL_LEFT;
}

static bool add(struct cached_stores *stores, const SluiceAllocationCallbacks *cb,
                const struct slc_cached_store *store)
{
    if (stores->count == stores->capacity) {
        size_t capacity = stores->capacity ? 2 * stores->capacity : 64;
        struct slc_cached_store *grown =
            stores->items ? slc_regrow(cb, stores->items, stores->capacity, capacity, sizeof *grown)
                          : slc_alloc(cb, capacity, sizeof *grown);
        if (!grown)
            return false;
        stores->items = grown;
        stores->capacity = capacity;
    }
    stores->items[stores->count++] = *store;
    return true;
}

static bool list_stores(struct slc_folder *folder, struct cached_stores *stores,
                        const SluiceAllocationCallbacks *cb)
{
    const char *name;
    while ((name = slc_folder_next(folder))) {
        struct slc_file_status status;
        struct slc_cached_store store;
        if (strlen(name) >= sizeof store.name || !find_kind(name, &store) ||
            !slc_folder_get_status(folder, name, true, &status) || status.kind != SLC_NODE_FILE)
            continue;
        memcpy(store.name, name, strlen(name) + 1);
        store.device = status.device;
        store.inode = status.inode;
        store.size = status.size;
        store.touched = status.read;
        stores->size += store.size;
        if (is_removable(&store, &status) && !add(stores, cb, &store))
            return false;
    }
    return true;
}

static int compare_touched(const void *a, const void *b)
{
    const struct slc_file_time *x = &((const struct slc_cached_store *)a)->touched;
    const struct slc_file_time *y = &((const struct slc_cached_store *)b)->touched;
    if (x->seconds != y->seconds)
        return x->seconds < y->seconds ? -1 : 1;
    return (x->nanoseconds > y->nanoseconds) - (x->nanoseconds < y->nanoseconds);
}

/* Under its lock: a bake may have begun to continue it. */
static bool remove_part(const char *folder, const struct slc_cached_store *part,
                        const SluiceAllocationCallbacks *cb)
{
    static const SluiceLogCallback silent;
    char target[4096];
    struct slc_part_file file;
    int stem = (int)(strlen(part->name) - strlen(PART_SUFFIX));
    int length = snprintf(target, sizeof target, "%s/%.*s", folder, stem, part->name);
    if (length < 0 || (size_t)length >= sizeof target)
        return false;
    SluiceResult result = slc_part_file_open(&file, target, SLC_PART_FILE_RESUME, cb, &silent);
    if (result == SLUICE_SUCCESS)
        slc_part_file_remove(&file);
    slc_part_file_close(&file);
    return result == SLUICE_SUCCESS;
}

static bool remove_file(const char *path, struct slc_folder *folder,
                        const struct slc_cached_store *store, const SluiceAllocationCallbacks *cb)
{
    return store->kind == SLC_CACHED_PART ? remove_part(path, store, cb)
                                          : slc_folder_remove(folder, store->name);
}

void slc_store_cache_trim(const char *path, uint64_t max_size, const SluiceAllocationCallbacks *cb,
                          bool (*is_kept)(void *user, const struct slc_cached_store *store),
                          void *user)
{
    struct cached_stores stores = {0};
    struct slc_folder *folder = slc_folder_begin(path);
    if (!folder)
        return;
    bool is_complete = list_stores(folder, &stores, cb);
    if (is_complete && stores.count > 0)
        qsort(stores.items, stores.count, sizeof *stores.items, compare_touched);
    for (size_t i = 0; is_complete && i < stores.count; i++) {
        const struct slc_cached_store *store = &stores.items[i];
        bool is_wanted = store->kind == SLC_CACHED_PREVIEW || stores.size > max_size;
        if (is_wanted && !is_kept(user, store) && remove_file(path, folder, store, cb))
            stores.size -= store->size;
    }
    slc_free(cb, stores.items, stores.capacity, sizeof *stores.items);
    slc_folder_end(folder);
}
