/* getpid */
#define _XOPEN_SOURCE 700
#include "cache.h"

#include "../../tools/common/files.h"
#include "../../tools/common/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define MAX_FETCHED_SIZE ((uint64_t)1 << 30)
#define PIECE ((size_t)1 << 20)

bool cache_path(const char *cache, const char *name, char *path, size_t size)
{
    const char *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length;
    if (cache)
        length = snprintf(path, size, "%s/%s", cache, name);
    else if (xdg && *xdg)
        length = snprintf(path, size, "%s/sluice/%s", xdg, name);
    else
        length = snprintf(path, size, "%s/.cache/sluice/%s", home ? home : ".", name);
    return length > 0 && (size_t)length < size;
}

/* FNV-1a. */
static uint64_t hash(const uint8_t *bytes, size_t size)
{
    uint64_t value = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++)
        value = (value ^ bytes[i]) * 0x100000001b3u;
    return value;
}

static bool write_whole(const char *path, const void *bytes, size_t size)
{
    char part[4200];
    snprintf(part, sizeof part, "%s.%ld.part", path, (long)getpid());
    FILE *file = fopen(part, "wb");
    bool written = file && fwrite(bytes, 1, size, file) == size;
    written = file && fclose(file) == 0 && written && rename(part, path) == 0;
    if (!written)
        remove(part);
    return written;
}

bool cache_keep(const char *cache, const char *folder, const char *name, const void *bytes,
                size_t size, char *path, size_t path_size)
{
    char file[512];
    snprintf(file, sizeof file, "%s/%016" PRIx64 "-%zx%s%.255s", folder, hash(bytes, size), size,
             *name ? "-" : "", name);
    if (!cache_path(cache, file, path, path_size) || !files_make_folders_of(path)) {
        text_say("cannot make the folder of %s", path);
        return false;
    }
    if (files_size(path) == size || write_whole(path, bytes, size))
        return true;
    text_say("%s: cannot be written", path);
    return false;
}

bool cache_keep_input(const char *cache, const char *name, const SluiceInput *input, char *path,
                      size_t path_size)
{
    if (input->size > MAX_FETCHED_SIZE) {
        text_say("%s: is larger than 1 GiB; make a tile store of it", name);
        return false;
    }
    size_t size = (size_t)input->size;
    uint8_t *bytes = malloc(size);
    bool read = bytes != NULL;
    for (size_t at = 0; read && at < size; at += PIECE)
        read = input->pfnRead(input->pUserData, at, bytes + at,
                              size - at < PIECE ? size - at : PIECE) == SLUICE_SUCCESS;
    bool kept = read && cache_keep(cache, "fetched", name, bytes, size, path, path_size);
    free(bytes);
    return kept;
}
