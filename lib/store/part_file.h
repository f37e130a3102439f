/**
 * The file that a writer has beside the name that it is to have: one writer at a time, and complete
 * before it takes the name.
 */
#ifndef SLC_STORE_PART_FILE_H
#define SLC_STORE_PART_FILE_H

#include "store/file.h"

struct slc_store_part {
    struct slc_store_file file; ///< its path ends in .part
    char *target;               ///< owned; the name it is to have
    int folder;                 ///< a descriptor of the folder, -1: none
};

/**
 * Opens or creates the .part file and locks it until it is closed. `file.size` is what is there.
 * Errors: FILE_NOT_FOUND, IO, logged; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_store_part_open(struct slc_store_part *part, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** Makes the file `size` bytes long. Errors: IO, logged. */
SluiceResult slc_store_part_cut(const struct slc_store_part *part, uint64_t size);
/** Makes an empty file `size` bytes of 0 and takes room on the disk for them. Errors: IO, logged.
 */
SluiceResult slc_store_part_reserve(const struct slc_store_part *part, uint64_t size);

/** Waits until all of it is on the disk, and gives it its name. Errors: IO, logged. */
SluiceResult slc_store_part_publish(struct slc_store_part *part);

/** Removes the file from its folder, before it is closed, if it is still the .part file. */
void slc_store_part_remove(const struct slc_store_part *part);
/** Also after a failed open. */
void slc_store_part_close(struct slc_store_part *part);

#endif /* SLC_STORE_PART_FILE_H */
