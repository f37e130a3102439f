#include "base/part_file.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/system.h"
#include "platform/folder.h"

#include <stdio.h>
#include <string.h>

static SluiceResult fail(const struct slc_part_file *part, const char *path, const char *why)
{
    slc_log(&part->log, SLUICE_LOG_ERROR, "%s: %s", path, why);
    return SLUICE_ERROR_IO;
}

static SluiceResult fail_system(const struct slc_part_file *part, const char *what)
{
    slc_log(&part->log, SLUICE_LOG_ERROR, "%s: cannot %s: %s", part->path, what, strerror(errno));
    return SLUICE_ERROR_IO;
}

/* Fails like fail_system, with NOT_READY if opening may succeed later. */
static SluiceResult fail_open(const struct slc_part_file *part, const char *what)
{
    SluiceResult result = slc_system_result(errno);
    fail_system(part, what);
    return result;
}

static SluiceResult fail_write(const struct slc_part_file *part, uint64_t offset, const char *why)
{
    slc_log(&part->log, SLUICE_LOG_ERROR, "%s: at %llu: %s", part->path, (unsigned long long)offset,
            why);
    return SLUICE_ERROR_IO;
}

static void close_descriptor(struct slc_part_file *part)
{
    if (part->descriptor >= 0)
        slc_file_close(part->descriptor);
    part->descriptor = -1;
}

static bool is_still_there(const struct slc_part_file *part, const struct slc_file_status *status)
{
    struct slc_file_status named;
    return slc_path_get_link_status(part->path, &named) && named.device == status->device &&
           named.inode == status->inode;
}

static SluiceResult lock(const struct slc_part_file *part)
{
    if (slc_file_lock(part->descriptor))
        return SLUICE_SUCCESS;
    if (errno != EWOULDBLOCK)
        return fail_system(part, "lock");
    fail(part, part->target, "another writer is at work on this file");
    return SLUICE_ERROR_BUSY;
}

/* `*is_gone`: the writer of the opened file finished or removed it before it was locked here. */
static SluiceResult check_part(struct slc_part_file *part, bool *is_gone)
{
    struct slc_file_status status;
    if (!slc_file_get_status(part->descriptor, &status))
        return fail_system(part, "stat");
    if (status.kind != SLC_NODE_FILE)
        return fail(part, part->path, "is there already and is no regular file");
    *is_gone = !is_still_there(part, &status);
    if (*is_gone)
        return SLUICE_ERROR_IO;
    if (status.link_count != 1)
        return fail(part, part->path, "has hard links, whose contents would be lost; remove it");
    part->size = status.size;
    return SLUICE_SUCCESS;
}

/* Returns the permissions: those of the target, so that private files stay private while written.
 */
static uint32_t wanted_mode(const struct slc_part_file *part, uint32_t without_target)
{
    struct slc_file_status status;
    bool is_there = slc_path_get_link_status(part->target, &status) && status.kind == SLC_NODE_FILE;
    return is_there ? status.permissions : without_target;
}

/* Sets permissions. 0: those of the process's mask. */
static void set_mode(const struct slc_part_file *part, uint32_t mode)
{
    if (mode != 0)
        slc_file_set_permissions(part->descriptor, mode);
}

/* Keeps the descriptor only after a success, so that no file of another writer is used. */
static SluiceResult open_and_lock(struct slc_part_file *part, bool *is_gone)
{
    *is_gone = false;
    part->descriptor = slc_file_create(part->path, wanted_mode(part, 0666));
    if (part->descriptor < 0 && errno == ELOOP)
        return fail(part, part->path, "is a symbolic link, which is not followed; remove it");
    if (part->descriptor < 0)
        return fail_open(part, "create");
    SluiceResult result = lock(part);
    if (result == SLUICE_SUCCESS)
        result = check_part(part, is_gone);
    if (result != SLUICE_SUCCESS)
        close_descriptor(part);
    return result;
}

static SluiceResult open_folder(struct slc_part_file *part)
{
    char *name = part->target + (slc_path_name(part->target) - part->target), first = *name;
    *name = '\0';
    const char *path = name > part->target ? part->target : ".";
    SluiceResult result = SLUICE_SUCCESS;
    part->folder = slc_folder_open(path);
    if (part->folder < 0) {
        const int error = errno;
        const size_t end = strlen(path) - (path == part->target && path[1] != '\0');
        result = slc_system_result(error);
        *name = first;
        slc_log(&part->log, SLUICE_LOG_ERROR, "%s: cannot be written: %.*s: %s", part->target,
                (int)end, path, error == ENOENT ? "no such folder" : strerror(error));
    }
    *name = first;
    return result;
}

/* True if the mode forbids writing, which root could do all the same. */
static bool is_read_only(const char *path, const struct slc_file_status *status)
{
    return (status->permissions & 0222) == 0 || (!slc_path_is_writable(path) && errno == EACCES);
}

/* Checks the target: a regular file may be replaced, anything else is refused. */
static SluiceResult check_target(const struct slc_part_file *part)
{
    struct slc_file_status status;
    if (!slc_path_get_link_status(part->target, &status))
        return SLUICE_SUCCESS;
    if (status.kind == SLC_NODE_LINK)
        return fail(part, part->target,
                    "is a symbolic link, which is neither followed nor replaced; name the file "
                    "that it stands for");
    if (status.kind == SLC_NODE_FOLDER)
        return fail(part, part->target, "is there already and is a folder");
    if (status.kind != SLC_NODE_FILE)
        return fail(part, part->target, "is there already and is no regular file");
    if (is_read_only(part->target, &status))
        return fail(part, part->target, "is there already and is read-only");
    return SLUICE_SUCCESS;
}

static bool find_stream(const struct slc_part_file *part)
{
    struct slc_file_status status;
    return slc_path_get_status(part->target, &status) && status.kind == SLC_NODE_STREAM;
}

/* Opens a stream. Neither creates nor truncates: the path may name another file by now. */
static SluiceResult open_direct(struct slc_part_file *part)
{
    struct slc_file_status status;
    part->is_direct = true;
    part->path[strlen(part->target)] = '\0';
    part->descriptor = slc_file_open_stream(part->target);
    if (part->descriptor < 0)
        return fail_open(part, "open");
    if (slc_file_get_status(part->descriptor, &status) && status.kind == SLC_NODE_STREAM)
        return SLUICE_SUCCESS;
    close_descriptor(part);
    return fail(part, part->target, "is no pipe and no character device any more");
}

static SluiceResult open_beside(struct slc_part_file *part, bool resume)
{
    enum { MAX_ATTEMPTS = 1000 };
    SluiceResult result = check_target(part);
    if (result == SLUICE_SUCCESS)
        result = open_folder(part);
    if (result != SLUICE_SUCCESS)
        return result;
    bool is_gone = true;
    for (int attempt = 0; is_gone && attempt < MAX_ATTEMPTS; attempt++)
        result = open_and_lock(part, &is_gone);
    if (is_gone)
        return fail(part, part->path, "others keep removing it");
    uint32_t mode = wanted_mode(part, 0);
    if (result == SLUICE_SUCCESS && mode != 0) /* permissions with which later writers can open */
        set_mode(part, mode | 0600);
    if (result == SLUICE_SUCCESS && !resume && part->size > 0) {
        part->size = 0;
        result = slc_part_file_cut(part, 0);
    }
    return result;
}

SluiceResult slc_part_file_open(struct slc_part_file *part, const char *name, uint32_t flags,
                                const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    *part = (struct slc_part_file){.allocator = *cb,
                                   .log = *log,
                                   .path_size = strlen(name) + sizeof ".sluice-part",
                                   .descriptor = -1,
                                   .folder = -1,
                                   .is_open = true,
                                   .is_unsynced = (flags & SLC_PART_FILE_UNSYNCED) != 0};
    part->target = slc_strdup(cb, name);
    part->path = slc_alloc(cb, part->path_size, 1);
    if (!part->target || !part->path)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    snprintf(part->path, part->path_size, "%s.sluice-part", name);
    if ((flags & SLC_PART_FILE_STREAM) && find_stream(part))
        return open_direct(part);
    return open_beside(part, (flags & SLC_PART_FILE_RESUME) != 0);
}

SluiceResult slc_part_file_write(const struct slc_part_file *part, uint64_t offset,
                                 const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        int64_t put = slc_file_write_at(part->descriptor, offset + done, (const char *)bytes + done,
                                        size - done);
        if (put > 0)
            done += (size_t)put;
        else if (put == 0 || errno != EINTR)
            return fail_write(part, offset + done, put ? strerror(errno) : "nothing is written");
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_part_file_append(const struct slc_part_file *part, const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        int64_t put = slc_file_append(part->descriptor, (const char *)bytes + done, size - done);
        if (put > 0)
            done += (size_t)put;
        else if (put < 0 && errno != EINTR)
            return fail_system(part, "write");
        else if (put == 0)
            return fail(part, part->path, "cannot write: nothing is taken");
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_part_file_cut(const struct slc_part_file *part, uint64_t size)
{
    if (!slc_file_set_size(part->descriptor, size))
        return fail_system(part, "set the length");
    return SLUICE_SUCCESS;
}

SluiceResult slc_part_file_reserve(const struct slc_part_file *part, uint64_t size)
{
    if (slc_file_reserve(part->descriptor, size))
        return SLUICE_SUCCESS;
    if (errno == EOPNOTSUPP || errno == EINVAL) /* the file system cannot reserve room */
        return slc_part_file_cut(part, size);
    return fail_system(part, "make room for the index");
}

/* Syncs the folder, so that the new name survives a crash of the system. */
static SluiceResult sync_folder(const struct slc_part_file *part)
{
    return slc_folder_sync(part->folder) ? SLUICE_SUCCESS : fail_system(part, "sync the folder");
}

/* Checks that NAME.sluice-part is still this file: after a removal the next writer may have made
 * one. */
static SluiceResult check_ours(const struct slc_part_file *part)
{
    struct slc_file_status status;
    if (slc_file_get_status(part->descriptor, &status) && is_still_there(part, &status))
        return SLUICE_SUCCESS;
    return fail(part, part->path, "was removed or replaced while it was written");
}

SluiceResult slc_part_file_publish(struct slc_part_file *part)
{
    if (part->is_direct)
        return SLUICE_SUCCESS;
    set_mode(part, wanted_mode(part, 0));
    if (!part->is_unsynced && !slc_file_sync(part->descriptor)) {
        SluiceResult result = fail_system(part, "sync");
        /* the next sync may succeed without the lost data, so the file must not be resumed */
        (void)!slc_file_set_size(part->descriptor, 0);
        return result;
    }
    /* Checked again, so that a device made since the start is not replaced. */
    SluiceResult result = check_target(part);
    if (result == SLUICE_SUCCESS)
        result = check_ours(part);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_path_replace(part->path, part->target))
        return fail_system(part, "rename to its name");
    return part->is_unsynced ? SLUICE_SUCCESS : sync_folder(part);
}

void slc_part_file_remove(const struct slc_part_file *part)
{
    struct slc_file_status status;
    if (part->is_open && !part->is_direct && part->descriptor >= 0 &&
        slc_file_get_status(part->descriptor, &status) && is_still_there(part, &status))
        slc_path_remove(part->path);
}

void slc_part_file_close(struct slc_part_file *part)
{
    const SluiceAllocationCallbacks *cb = &part->allocator;
    if (!part->is_open)
        return;
    slc_free(cb, part->path, part->path_size, 1);
    if (part->target)
        slc_free(cb, part->target, strlen(part->target) + 1, 1);
    if (part->folder >= 0)
        slc_file_close(part->folder);
    close_descriptor(part);
    *part = (struct slc_part_file){.descriptor = -1, .folder = -1};
}

SluiceResult slc_part_file_finish(struct slc_part_file *part, bool keep)
{
    SluiceResult result = keep ? slc_part_file_publish(part) : SLUICE_SUCCESS;
    if (!keep || result != SLUICE_SUCCESS)
        slc_part_file_remove(part);
    slc_part_file_close(part);
    return result;
}
