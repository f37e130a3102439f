#include "open/store_cache.h"

#include "base/alloc.h"
#include "base/part_file.h"
#include "base/said.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

SluiceResult slc_store_cache_path(const char *folder, const char *picture, uint64_t settings_hash,
                                  const SluiceAllocationCallbacks *cb, char **path)
{
    char *real = slc_path_resolve(picture);
    const char *name = real ? real : picture;
    uint64_t hash = slc_said_key(name) ^ settings_hash, length = strlen(name);
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
    if (result == SLUICE_SUCCESS && part.size == 0) /* the part file did not exist before */
        slc_part_file_remove(&part);
    slc_part_file_close(&part);
    return result == SLUICE_ERROR_BUSY;
}

/* Skips 1 to `max` lower-case hexadecimal digits. False: no digits. */
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

/* Finds the kind of a folder entry. False: the name does not belong to the cache. */
static bool find_kind(struct slc_cache_entry *entry)
{
    const char *name = entry->name;
    bool is_ours = strspn(name, "0123456789abcdef") == 16 && skip_digits(&name, 16) &&
                   skip_text(&name, "-") && skip_digits(&name, 4);
    if (!is_ours)
        return false;
    entry->kind = SLC_CACHE_COMPLETE;
    if (!skip_text(&name, STORE_SUFFIX)) {
        entry->kind = SLC_CACHE_TEMPORARY;
        if (!skip_text(&name, "-") || !skip_digits(&name, 16) || !skip_text(&name, "-") ||
            !skip_digits(&name, 16) || !skip_text(&name, PREVIEW_SUFFIX))
            return false;
    }
    if (skip_text(&name, PART_SUFFIX) && entry->kind == SLC_CACHE_COMPLETE)
        entry->kind = SLC_CACHE_UNFINISHED;
    return *name == '\0';
}

/* Deletes a part file under its lock. False: a bake holds the lock. */
static bool remove_part(const char *folder, const struct slc_cache_entry *part,
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

void slc_store_cache_trim(const char *folder, uint64_t max_size,
                          const SluiceAllocationCallbacks *cb,
                          bool (*is_kept)(void *user, const struct slc_cache_entry *store),
                          void *user)
{
    const struct slc_cache_rules rules = {.max_size = max_size,
                                          .remaining_size = max_size,
                                          .find_kind = find_kind,
                                          .is_kept = is_kept,
                                          .remove_unfinished = remove_part,
                                          .user = user};
    slc_cache_folder_trim(folder, &rules, cb, NULL);
}
