#include "open/file_kind.h"

#include "base/log.h"
#include "base/system.h"
#include "image/file_signature.h"

#include <string.h>

#ifdef SLC_HAVE_CONTAINER
#include <sluice/dds.h>
#include <sluice/ktx2.h>
#endif

SluiceResult slc_shared_files_init(struct slc_shared_files *files, uint32_t max_open_file_count,
                                   const SluiceAllocationCallbacks *cb)
{
    SluiceFilePoolCreateInfo info = {
        .structSize = sizeof info, .maxOpenFileCount = max_open_file_count, .pAllocator = cb};
    SluiceResult result = sluiceCreateFilePool(&info, &files->pool);
#ifdef SLC_HAVE_STORE
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateStoreReadPool(cb, &files->read_pool);
#endif
#ifdef SLC_HAVE_EXR
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateExrMemoryBudget(0, cb, &files->exr_memory);
#endif
    return result;
}

void slc_shared_files_finish(struct slc_shared_files *files)
{
#ifdef SLC_HAVE_EXR
    sluiceDestroyExrMemoryBudget(files->exr_memory);
#endif
#ifdef SLC_HAVE_STORE
    sluiceDestroyStoreReadPool(files->read_pool);
#endif
    sluiceDestroyFilePool(files->pool);
}

static SluiceImageFileKind kind_of(const char bytes[SLC_SIGNATURE_SIZE])
{
    switch (slc_file_signature(bytes)) {
    case SLC_SIGNATURE_STORE: return SLUICE_IMAGE_FILE_KIND_STORE;
    case SLC_SIGNATURE_EXR: return SLUICE_IMAGE_FILE_KIND_EXR;
    case SLC_SIGNATURE_DDS: return SLUICE_IMAGE_FILE_KIND_DDS;
    case SLC_SIGNATURE_KTX2: return SLUICE_IMAGE_FILE_KIND_KTX2;
    case SLC_SIGNATURE_NEURAL: return SLUICE_IMAGE_FILE_KIND_NEURAL;
    case SLC_SIGNATURE_CATALOGUE: return SLC_IMAGE_FILE_KIND_CATALOGUE;
    case SLC_SIGNATURE_OTHER: break;
    }
    return SLUICE_IMAGE_FILE_KIND_PICTURE;
}

/* Reads the first bytes and the identity. Returns 0, or errno; EINVAL: not a regular file. */
static int look_at(int descriptor, char bytes[SLC_SIGNATURE_SIZE],
                   struct slc_file_identity *identity)
{
    struct slc_file_status status;
    if (!slc_file_get_status(descriptor, &status))
        return errno;
    if (status.kind != SLC_NODE_FILE)
        return EINVAL;
    *identity = slc_file_identity(&status);
    int64_t got;
    do
        got = slc_file_read_at(descriptor, 0, bytes, SLC_SIGNATURE_SIZE);
    while (got < 0 && errno == EINTR);
    return got < 0 ? errno : 0;
}

SluiceResult slc_file_kind_find(SluiceFilePool *pool, const char *path,
                                const SluiceLogCallback *log, SluiceImageFileKind *kind,
                                struct slc_file_identity *identity)
{
    char bytes[SLC_SIGNATURE_SIZE] = {0};
    struct slc_pooled_file file = SLC_POOLED_FILE_CLOSED;
    int descriptor = slc_file_pool_acquire(pool, &file, path);
    int error = descriptor < 0 ? errno : look_at(descriptor, bytes, identity);
    if (descriptor >= 0) {
        slc_file_pool_release(pool, &file);
        slc_file_pool_remove(pool, &file);
    }
    if (error == 0) {
        *kind = kind_of(bytes);
        return SLUICE_SUCCESS;
    }
    slc_log(log, SLUICE_LOG_ERROR, "%s: cannot open: %s", path,
            error == EINVAL ? "is not a regular file" : strerror(error));
    return slc_system_result(error);
}

SluiceResult slc_input_kind_find(const SluiceInput *input, const char *path,
                                 const SluiceLogCallback *log, SluiceImageFileKind *kind)
{
    char bytes[SLC_SIGNATURE_SIZE] = {0};
    size_t size = input->size < sizeof bytes ? (size_t)input->size : sizeof bytes;
    SluiceResult result = SLUICE_SUCCESS;
    if (size == 0 || (!input->pBytes && !input->pfnRead))
        result = SLUICE_ERROR_IO;
    else if (input->pBytes)
        memcpy(bytes, input->pBytes, size);
    else
        result = input->pfnRead(input->pUserData, 0, bytes, size);
    if (result == SLUICE_SUCCESS)
        *kind = kind_of(bytes);
    else
        slc_log(log, SLUICE_LOG_ERROR, "%s: cannot read the first %u bytes", path, (unsigned)size);
    return result;
}

#if !defined(SLC_HAVE_STORE) || !defined(SLC_HAVE_EXR) || !defined(SLC_HAVE_CONTAINER)
static SluiceResult refuse(const char *path, const SluiceLogCallback *log, const char *kind,
                           const char *library)
{
    slc_log(log, SLUICE_LOG_ERROR, "%s: is %s; this build of Sluice was made without %s", path,
            kind, library);
    return SLUICE_ERROR_UNSUPPORTED;
}
#endif

static SluiceResult open_store(const char *path, const SluiceInput *input,
                               const struct slc_shared_files *files,
                               const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                               SluiceImageSource **source)
{
#ifdef SLC_HAVE_STORE
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info,
                                             .pPath = path,
                                             .pInput = input,
                                             .pAllocator = cb,
                                             .log = *log,
                                             .readPool = files->read_pool,
                                             .filePool = files->pool};
    return sluiceCreateStoreImageSource(&info, source);
#else
    (void)input, (void)files, (void)cb, (void)source;
    return refuse(path, log, "a tile store", "sluice-store");
#endif
}

static SluiceResult open_exr(const char *path, const SluiceInput *input,
                             const struct slc_shared_files *files,
                             const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                             SluiceImageSource **source)
{
#ifdef SLC_HAVE_EXR
    SluiceExrImageSourceCreateInfo info = {.structSize = sizeof info,
                                           .pPath = path,
                                           .pInput = input,
                                           .pAllocator = cb,
                                           .log = *log,
                                           .memoryBudget = files->exr_memory,
                                           .filePool = files->pool};
    return sluiceCreateExrImageSource(&info, source);
#else
    (void)input, (void)files, (void)cb, (void)source;
    return refuse(path, log, "an OpenEXR file", "sluice-exr");
#endif
}

static SluiceResult open_container(const char *path, const SluiceInput *input, bool is_dds,
                                   const struct slc_shared_files *files,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceLogCallback *log, SluiceImageSource **source)
{
#ifdef SLC_HAVE_CONTAINER
    SluiceDdsImageSourceCreateInfo dds = {.structSize = sizeof dds,
                                          .pPath = path,
                                          .pInput = input,
                                          .pAllocator = cb,
                                          .log = *log,
                                          .filePool = files->pool};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {.structSize = sizeof ktx2,
                                            .pPath = path,
                                            .pInput = input,
                                            .pAllocator = cb,
                                            .log = *log,
                                            .filePool = files->pool};
    return is_dds ? sluiceCreateDdsImageSource(&dds, source)
                  : sluiceCreateKtx2ImageSource(&ktx2, source);
#else
    (void)input, (void)files, (void)cb, (void)source;
    return refuse(path, log, is_dds ? "a DDS file" : "a KTX2 file", "sluice-container");
#endif
}

SluiceResult slc_file_kind_open(SluiceImageFileKind kind, const char *path,
                                const SluiceInput *input, const struct slc_shared_files *files,
                                const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                                SluiceImageSource **source)
{
    SluiceImageInfo image = {.structSize = sizeof image};
    SluiceResult result;
    *source = NULL;
    if (kind == SLUICE_IMAGE_FILE_KIND_STORE)
        result = open_store(path, input, files, cb, log, source);
    else if (kind == SLUICE_IMAGE_FILE_KIND_EXR)
        result = open_exr(path, input, files, cb, log, source);
    else
        result =
            open_container(path, input, kind == SLUICE_IMAGE_FILE_KIND_DDS, files, cb, log, source);
    if (result == SLUICE_SUCCESS) /* some sources open their file now */
        result = sluiceGetImageInfo(*source, &image);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyImageSource(*source);
        *source = NULL;
    }
    return result;
}
