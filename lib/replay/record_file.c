#define _POSIX_C_SOURCE 200809L
#include "replay/record_file.h"

#include "base/alloc.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

struct slc_record_file {
    SluiceAllocationCallbacks cb;
    FILE *stream;
    char *path;      ///< owned
    char *temporary; ///< owned; written until the end, as `path` if that is a device or a pipe
    size_t temporary_size;
};

static void release(struct slc_record_file *file)
{
    SluiceAllocationCallbacks cb = file->cb;
    slc_free(&cb, file->temporary, file->temporary_size, 1);
    if (file->path)
        slc_free(&cb, file->path, strlen(file->path) + 1, 1);
    slc_free(&cb, file, 1, sizeof *file);
}

SluiceResult slc_record_file_open(const SluiceAllocationCallbacks *cb, const char *path,
                                  struct slc_record_file **out)
{
    static const char suffix[] = ".partial";
    struct slc_record_file *file = slc_calloc(cb, 1, sizeof *file);
    if (!file)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    file->cb = *cb;
    file->temporary_size = strlen(path) + sizeof suffix;
    file->path = slc_strdup(cb, path);
    file->temporary = slc_alloc(cb, file->temporary_size, 1);
    if (!file->path || !file->temporary) {
        release(file);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    strcpy(file->temporary, path);
    struct stat status;
    if (stat(path, &status) != 0 || S_ISREG(status.st_mode))
        strcat(file->temporary, suffix);
    file->stream = fopen(file->temporary, "wb");
    if (!file->stream) {
        release(file);
        return SLUICE_ERROR_IO;
    }
    *out = file;
    return SLUICE_SUCCESS;
}

SluiceResult slc_record_file_write(void *user, const void *data, size_t size)
{
    struct slc_record_file *file = user;
    return fwrite(data, 1, size, file->stream) == size ? SLUICE_SUCCESS : SLUICE_ERROR_IO;
}

SluiceResult slc_record_file_close(struct slc_record_file *file, bool keep)
{
    if (!file)
        return SLUICE_SUCCESS;
    bool written = fclose(file->stream) == 0;
    bool direct = strcmp(file->temporary, file->path) == 0;
    bool named = keep && written && (direct || rename(file->temporary, file->path) == 0);
    if (!named && !direct)
        remove(file->temporary);
    release(file);
    return named || !keep ? SLUICE_SUCCESS : SLUICE_ERROR_IO;
}
