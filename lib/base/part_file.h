/**
 * Part file: the file that a writer fills beside its final name. It has one writer at a time, and
 * gets the name when complete. All files that Sluice's libraries and programs write use it.
 *
 * The file is written as NAME.sluice-part, locked with flock, and renamed when it is complete and
 * on the disk. Until then, and after a failure, NAME is unchanged. An unlocked NAME.sluice-part was
 * left by a killed writer, and is taken over.
 *
 * Refused, with a message, and left as they are: a folder, a block device or a socket at NAME, a
 * symbolic link at NAME (neither followed nor replaced), a read-only file at NAME, and a
 * NAME.sluice-part that is a link, no regular file, or has hard links.
 */
#ifndef SLC_BASE_PART_FILE_H
#define SLC_BASE_PART_FILE_H

#include <sluice/base.h>

enum slc_part_file_flags {
    SLC_PART_FILE_RESUME =
        1, ///< Keep the bytes of a NAME.sluice-part that is there. Otherwise it is emptied.
    /** Written front to back, so that NAME may be a pipe or a character device, also through a link
     *  such as /dev/stdout. These are written to as they stand, never renamed, never removed. */
    SLC_PART_FILE_STREAM = 2,
    /** Does not wait for the disk, which takes tens of milliseconds: after a power cut NAME may be
     *  empty. For many files that are made again at will, as pictures of frames. */
    SLC_PART_FILE_UNSYNCED = 4
};

/** Zeroed: closed. Close it also after a failed open. */
struct slc_part_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *target; ///< Owned. NAME.
    char *path;   ///< Owned. NAME.sluice-part, or NAME if `is_direct`.
    size_t path_size;
    int descriptor; ///< -1: none
    int folder;     ///< A descriptor of the folder. -1: none.
    uint64_t size;  ///< Bytes that were there at opening.
    bool is_open;
    bool is_direct; ///< A pipe or a character device.
    bool is_unsynced;
};

/**
 * Opens or creates NAME.sluice-part and locks it until it is closed.
 * Returns SLUICE_NOT_READY, logged, for want of file descriptors: close the part file and open it
 * again later. Errors, logged: SLUICE_ERROR_FILE_NOT_FOUND if the folder does not exist;
 * SLUICE_ERROR_BUSY if another writer is at work; SLUICE_ERROR_IO. Not logged:
 * SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_part_file_open(struct slc_part_file *part, const char *name, uint32_t flags,
                                const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** Writes all bytes at an offset. Not for streams. Errors: SLUICE_ERROR_IO, logged. Any thread. */
SluiceResult slc_part_file_write(const struct slc_part_file *part, uint64_t offset,
                                 const void *bytes, size_t size);
/** Writes all bytes behind those of the last call. Errors: SLUICE_ERROR_IO, logged. */
SluiceResult slc_part_file_append(const struct slc_part_file *part, const void *bytes, size_t size);

/** Makes the file `size` bytes long. Errors: SLUICE_ERROR_IO, logged. */
SluiceResult slc_part_file_cut(const struct slc_part_file *part, uint64_t size);
/** Makes an empty file `size` bytes of 0 and takes room on the disk for them. Errors:
 *  SLUICE_ERROR_IO, logged. */
SluiceResult slc_part_file_reserve(const struct slc_part_file *part, uint64_t size);

/** Waits until the whole file is on the disk (but for UNSYNCED), and gives it its name. Keeps the
 * permissions of a file that had the name. Errors, logged: SLUICE_ERROR_IO, also if somebody
 * removed or replaced NAME.sluice-part meanwhile. */
SluiceResult slc_part_file_publish(struct slc_part_file *part);
/** Removes NAME.sluice-part if it is still the file that was opened. Call before closing. */
void slc_part_file_remove(const struct slc_part_file *part);
/** Keeps NAME.sluice-part, for a writer that resumes. */
void slc_part_file_close(struct slc_part_file *part);

/** Publishes the file if `keep`, removes it otherwise and on errors, and closes it. */
SluiceResult slc_part_file_finish(struct slc_part_file *part, bool keep);

#endif /* SLC_BASE_PART_FILE_H */
