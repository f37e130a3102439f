/**
 * Files of the operating system, with descriptors like those of open(). Paths are UTF-8.
 *
 * Functions that return false, -1 or NULL set errno. Any thread.
 */
#ifndef SLC_PLATFORM_FILE_H
#define SLC_PLATFORM_FILE_H

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef ESTALE /* "another file has taken its place", for which Windows has no word */
#define ESTALE 0x5EA1
#endif

enum slc_node_kind {
    SLC_NODE_FILE, ///< regular
    SLC_NODE_FOLDER,
    SLC_NODE_LINK,   ///< symbolic
    SLC_NODE_STREAM, ///< a pipe or a character device
    SLC_NODE_OTHER
};

/** Time since 1970. */
struct slc_file_time {
    int64_t seconds, nanoseconds;
};

struct slc_file_status {
    enum slc_node_kind kind;
    uint32_t permissions; ///< bits 0777, the argument of chmod
    uint64_t device, inode, link_count, size;
    struct slc_file_time read, modified, changed; ///< changed: contents, name or mode
};

/** Opens a file for reading. Does not wait for the writer of a pipe. Returns a descriptor or -1. */
int slc_file_open(const char *path);
/** Opens or creates a file for reading and writing. Fails for symbolic links (ELOOP). Does not
 * wait. Never returns 0 to 2. */
int slc_file_create(const char *path, uint32_t permissions);
/** Opens a pipe or a character device for writing. Never returns 0 to 2. */
int slc_file_open_stream(const char *path);
void slc_file_close(int descriptor);
/** Returns the process's limit of open descriptors. UINT64_MAX: no limit. */
uint64_t slc_get_descriptor_limit(void);

bool slc_file_get_status(int descriptor, struct slc_file_status *status);
/** Describes a file. Follows links. */
bool slc_path_get_status(const char *path, struct slc_file_status *status);
/** Describes the link itself. */
bool slc_path_get_link_status(const char *path, struct slc_file_status *status);

/** Reads 1 to `size` bytes at an offset, or returns 0 at the end. -1: EINTR, or an error. */
int64_t slc_file_read_at(int descriptor, uint64_t offset, void *bytes, size_t size);
/** Writes 1 to `size` bytes at an offset. -1: EINTR, or an error. Not with slc_file_append. */
int64_t slc_file_write_at(int descriptor, uint64_t offset, const void *bytes, size_t size);
/** Writes 1 to `size` bytes behind those of the last call. -1: EINTR, or an error. */
int64_t slc_file_append(int descriptor, const void *bytes, size_t size);

/** Locks the file against other descriptors until closed. EWOULDBLOCK: locked already. */
bool slc_file_lock(int descriptor);
bool slc_file_set_size(int descriptor, uint64_t size);
/** Sets the size and reserves room on the disk. EINVAL or EOPNOTSUPP: not supported by the file
 * system. */
bool slc_file_reserve(int descriptor, uint64_t size);
/** Waits until contents are on the disk. */
bool slc_file_sync(int descriptor);
/** Sets permissions. Ignores errors, because some file systems have no permissions. */
void slc_file_set_permissions(int descriptor, uint32_t permissions);

/** Returns the part of a path behind the last separator (Windows: / or \). */
const char *slc_path_name(const char *path);
/** Tells whether this process may write to a path. */
bool slc_path_is_writable(const char *path);
/** Renames a file atomically. Replaces an existing file, even if open; Windows before 10 fails for
 * an open file (EACCES). */
bool slc_path_replace(const char *from, const char *to);
bool slc_path_remove(const char *path);
/** Sets the time of reading to now. */
void slc_path_touch(const char *path);
/** Returns the absolute path of an existing file, without links, or NULL. Free with free(). */
char *slc_path_resolve(const char *path);

/** Returns a number, unique among running processes. */
uint64_t slc_get_process_id(void);

#endif /* SLC_PLATFORM_FILE_H */
