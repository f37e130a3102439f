#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include "open/store_cache.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/said.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Part files that nobody has written for so long were left behind. */
#define SECONDS_UNTIL_LEFT (24 * 3600)

SluiceResult slc_store_cache_make(const char *folder, const SluiceLogCallback *log)
{
    struct stat status;
    if (mkdir(folder, 0700) == 0 ||
        (errno == EEXIST && stat(folder, &status) == 0 && S_ISDIR(status.st_mode)))
        return SLUICE_SUCCESS;
    slc_log(log, SLUICE_LOG_ERROR, "%s: cannot make this folder: %s", folder, strerror(errno));
    return SLUICE_ERROR_IO;
}

SluiceResult slc_store_cache_path(const char *folder, const char *picture,
                                  const SluiceAllocationCallbacks *cb, char **path)
{
    char *real = realpath(picture, NULL);
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
    const struct timespec times[2] = {{.tv_nsec = UTIME_NOW}, {.tv_nsec = UTIME_OMIT}};
    (void)!utimensat(AT_FDCWD, path, times, 0);
}

struct cached_store {
    char name[64];
    uint64_t size;
    struct timespec touched;
};

struct cached_stores {
    struct cached_store *items;
    size_t count, capacity;
    uint64_t size; ///< bytes of all, those that are kept included
};

static bool has_suffix(const char *name, const char *suffix)
{
    size_t length = strlen(name), suffix_length = strlen(suffix);
    return length > suffix_length && strcmp(name + length - suffix_length, suffix) == 0;
}

/* Files of other names are not ours. */
static bool is_removable(const char *name, const struct stat *status)
{
    if (has_suffix(name, ".store"))
        return true;
    return has_suffix(name, ".sluice-part") && time(NULL) - status->st_mtime > SECONDS_UNTIL_LEFT;
}

static bool add(struct cached_stores *stores, const SluiceAllocationCallbacks *cb, const char *name,
                const struct stat *status)
{
    if (stores->count == stores->capacity) {
        size_t capacity = stores->capacity ? 2 * stores->capacity : 64;
        struct cached_store *grown =
            stores->items ? slc_regrow(cb, stores->items, stores->capacity, capacity, sizeof *grown)
                          : slc_alloc(cb, capacity, sizeof *grown);
        if (!grown)
            return false;
        stores->items = grown;
        stores->capacity = capacity;
    }
    struct cached_store *store = &stores->items[stores->count++];
    *store = (struct cached_store){.size = (uint64_t)status->st_size, .touched = status->st_atim};
    memcpy(store->name, name, strlen(name) + 1);
    return true;
}

static bool list_stores(DIR *folder, struct cached_stores *stores,
                        const SluiceAllocationCallbacks *cb)
{
    struct dirent *entry;
    while ((entry = readdir(folder))) {
        struct stat status;
        if (strlen(entry->d_name) >= sizeof stores->items->name ||
            fstatat(dirfd(folder), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISREG(status.st_mode))
            continue;
        if (!has_suffix(entry->d_name, ".store") && !has_suffix(entry->d_name, ".sluice-part"))
            continue;
        stores->size += (uint64_t)status.st_size;
        if (is_removable(entry->d_name, &status) && !add(stores, cb, entry->d_name, &status))
            return false;
    }
    return true;
}

static int compare_touched(const void *a, const void *b)
{
    const struct timespec *x = &((const struct cached_store *)a)->touched;
    const struct timespec *y = &((const struct cached_store *)b)->touched;
    if (x->tv_sec != y->tv_sec)
        return x->tv_sec < y->tv_sec ? -1 : 1;
    return (x->tv_nsec > y->tv_nsec) - (x->tv_nsec < y->tv_nsec);
}

void slc_store_cache_trim(const char *path, uint64_t max_size, const SluiceAllocationCallbacks *cb,
                          bool (*is_kept)(void *user, const char *name), void *user)
{
    struct cached_stores stores = {0};
    DIR *folder = opendir(path);
    if (!folder)
        return;
    bool is_complete = list_stores(folder, &stores, cb);
    if (is_complete && stores.count > 0)
        qsort(stores.items, stores.count, sizeof *stores.items, compare_touched);
    for (size_t i = 0; is_complete && i < stores.count && stores.size > max_size; i++)
        if (!is_kept(user, stores.items[i].name) &&
            unlinkat(dirfd(folder), stores.items[i].name, 0) == 0)
            stores.size -= stores.items[i].size;
    slc_free(cb, stores.items, stores.capacity, sizeof *stores.items);
    closedir(folder);
}
