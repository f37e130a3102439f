/**
 * Files of the operating system, by descriptors as open() returns them. Paths are UTF-8.
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

/** Since 1970. */
struct slc_file_time {
    int64_t seconds, nanoseconds;
};

struct slc_file_status {
    enum slc_node_kind kind;
    uint32_t permissions; ///< 0777, as chmod takes them
    uint64_t device, inode, link_count, size;
    struct slc_file_time read, modified, changed; ///< contents; contents; contents or name or mode
};

/** Opens for reading. Never waits for the writer of a pipe. Returns a descriptor or -1. */
int slc_file_open(const char *path);
/** Opens or creates for reading and writing. Follows no symbolic link (ELOOP) and waits for nobody.
 *  Never returns 0 to 2. */
int slc_file_create(const char *path, uint32_t permissions);
/** Opens a pipe or a character device for writing. Never returns 0 to 2. */
int slc_file_open_stream(const char *path);
void slc_file_close(int descriptor);
/** Descriptors that this process may have open. UINT64_MAX: no limit. */
uint64_t slc_get_descriptor_limit(void);

bool slc_file_get_status(int descriptor, struct slc_file_status *status);
/** Follows links to the file that they name. */
bool slc_path_get_status(const char *path, struct slc_file_status *status);
/** Describes the link itself. */
bool slc_path_get_link_status(const char *path, struct slc_file_status *status);

/** Reads 1 to `size` bytes at an offset, or returns 0 at the end. -1: EINTR, or an error. */
int64_t slc_file_read_at(int descriptor, uint64_t offset, void *bytes, size_t size);
/** Writes 1 to `size` bytes at an offset. -1: EINTR, or an error. Not with slc_file_append. */
int64_t slc_file_write_at(int descriptor, uint64_t offset, const void *bytes, size_t size);
/** Writes 1 to `size` bytes behind those of the last call. -1: EINTR, or an error. */
int64_t slc_file_append(int descriptor, const void *bytes, size_t size);

/** Locks the file against other descriptors until it is closed. EWOULDBLOCK: somebody has. */
bool slc_file_lock(int descriptor);
bool slc_file_set_size(int descriptor, uint64_t size);
/** Sets the size and takes room on the disk. EINVAL or EOPNOTSUPP: the file system promises none.
 */
bool slc_file_reserve(int descriptor, uint64_t size);
/** Waits until contents are on the disk. */
bool slc_file_sync(int descriptor);
/** File systems without permissions refuse, and need not. */
void slc_file_set_permissions(int descriptor, uint32_t permissions);

/** The part of a path behind its last separator, which Windows writes / or \. */
const char *slc_path_name(const char *path);
/** False if this process may not write to it. */
bool slc_path_is_writable(const char *path);
/** Gives a file another name, in one step, in place of a file that has the name, also of one that
 * is open. Windows before 10 refuses that (EACCES). */
bool slc_path_replace(const char *from, const char *to);
bool slc_path_remove(const char *path);
/** Notes that the file was read now. */
void slc_path_touch(const char *path);
/** The absolute path of what is there, without links, or NULL. Free it with free(). */
char *slc_path_resolve(const char *path);

/** A number that no other process has now. */
uint64_t slc_get_process_id(void);

#endif /* SLC_PLATFORM_FILE_H */
