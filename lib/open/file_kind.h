/** Kinds of files, found by the first bytes, and sources that read files in place. */
#ifndef SLC_OPEN_FILE_KIND_H
#define SLC_OPEN_FILE_KIND_H

#include <sluice/exr.h>
#include <sluice/open.h>
#include <sluice/store.h>

#include "image/file_pool.h"

/** Kind of catalogues. Opened images never have this kind, because a store of it is opened. */
#define SLC_IMAGE_FILE_KIND_CATALOGUE ((SluiceImageFileKind)1000)

/** Pools and budgets that all files of an opener share. NULL where the build lacks the kind. */
struct slc_shared_files {
    SluiceFilePool *pool;
    SluiceStoreReadPool *read_pool;
    SluiceExrMemoryBudget *exr_memory;
};

SluiceResult slc_shared_files_init(struct slc_shared_files *files, uint32_t max_open_file_count,
                                   const SluiceAllocationCallbacks *cb);
void slc_shared_files_finish(struct slc_shared_files *files);

/** Reads a file's first bytes and its identity. The file counts in the pool meanwhile. Errors,
 *  logged: IO, FILE_NOT_FOUND, OUT_OF_HOST_MEMORY; NOT_READY: no free descriptor. */
SluiceResult slc_file_kind_find(SluiceFilePool *pool, const char *path,
                                const SluiceLogCallback *log, SluiceImageFileKind *kind,
                                struct slc_file_identity *identity);

/** Finds the kind of an input by its first bytes. Errors, logged: errors of the input's reads. */
SluiceResult slc_input_kind_find(const SluiceInput *input, const char *path,
                                 const SluiceLogCallback *log, SluiceImageFileKind *kind);

/** Opens any kind except PICTURE and NEURAL. `input` NULL: opens the file. Errors, logged: the same
 *  as sluiceOpenImageSource. */
SluiceResult slc_file_kind_open(SluiceImageFileKind kind, const char *path,
                                const SluiceInput *input, const struct slc_shared_files *files,
                                const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                                SluiceImageSource **source);

#endif /* SLC_OPEN_FILE_KIND_H */
