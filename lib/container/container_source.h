/**
 * An image source over a file whose header says where the images are. Opened at the first question.
 */
#ifndef SLC_CONTAINER_CONTAINER_SOURCE_H
#define SLC_CONTAINER_CONTAINER_SOURCE_H

#include "container/container_layout.h"

struct slc_container_create_info {
    struct slc_input_choice choice;
    SluiceFormat format; ///< asked for; UNDEFINED: the file's
    const SluiceAllocationCallbacks *allocator;
    const SluiceLogCallback *log;
    uint64_t max_cache_size;
    /** Reads and checks the header of an open file. Errors: IO, CORRUPT_DATA, UNSUPPORTED; logged.
     */
    SluiceResult (*read_header)(const struct slc_input_file *file,
                                struct slc_container_layout *layout);
};

/** Errors as sluiceCreateDdsImageSource has them. */
SluiceResult slc_container_source_create(const struct slc_container_create_info *info,
                                         SluiceImageSource **source);

#endif /* SLC_CONTAINER_CONTAINER_SOURCE_H */
