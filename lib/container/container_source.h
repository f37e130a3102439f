/**
 * Image source over a DDS or KTX2 file. The first use opens the file.
 */
#ifndef SLC_CONTAINER_CONTAINER_SOURCE_H
#define SLC_CONTAINER_CONTAINER_SOURCE_H

#include "container/container_layout.h"

struct slc_container_create_info {
    struct slc_input_choice choice;
    SluiceFormat format; ///< requested; UNDEFINED: the file's
    const SluiceAllocationCallbacks *allocator;
    const SluiceLogCallback *log;
    uint64_t max_cache_size;
    /** Reads and checks the header of an open file. Errors: IO, CORRUPT_DATA, UNSUPPORTED; logged.
     */
    SluiceResult (*read_header)(const struct slc_input_file *file,
                                struct slc_container_layout *layout);
};

/** Creates a source. Errors: the same as sluiceCreateDdsImageSource. */
SluiceResult slc_container_source_create(const struct slc_container_create_info *info,
                                         SluiceImageSource **source);

#endif /* SLC_CONTAINER_CONTAINER_SOURCE_H */
