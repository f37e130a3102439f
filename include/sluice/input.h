/**
 * Bounds how many files are open (SluiceFilePool), and reads files from memory or through a
 * function of the application (SluiceInput).
 *
 * The create-infos of tile stores (store.h), DDS, KTX2 and OpenEXR files (dds.h, ktx2.h, exr.h)
 * take both. The baker (bake.h) takes a SluiceInput. Openers (open.h) have a pool of their own.
 */
#ifndef SLUICE_INPUT_H
#define SLUICE_INPUT_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Contents of an image file that lie elsewhere: an archive's entry, a buffer of a .glb, a download.
 *
 * Set `pBytes` or `pfnRead`; otherwise sources refuse it with SLUICE_ERROR_NULL_POINTER. Sluice
 * copies the struct, not the bytes.
 */
typedef struct SluiceInput {
    uint32_t structSize; ///< sizeof(SluiceInput).
    /** The bytes, at any alignment. Not owned: keep them unchanged until the source is destroyed,
     * or the bake returns. */
    const void *pBytes;
    uint64_t size; ///< Bytes. 1 to 2^63 - 1.
    /** Passed to pfnRead. Must live as long as the bytes. */
    void *pUserData;
    /**
     * Copies `size` bytes, at least 1, from `offset` on to `pBytes`. Bytes beyond SluiceInput::size
     * are never asked for. Used if SluiceInput::pBytes is NULL.
     *
     * Returns SLUICE_SUCCESS; SLUICE_NOT_READY to be asked again later;
     * SLUICE_ERROR_OUT_OF_HOST_MEMORY. Every other result counts as SLUICE_ERROR_IO.
     * Thread safety: any thread, several calls at the same time.
     */
    SluiceResult (*pfnRead)(void *pUserData, uint64_t offset, void *pBytes, size_t size);
} SluiceInput;

/**
 * Bounds how many files of its sources are open at the same time.
 *
 * A read opens its file if the file is closed. If the pool is full, the file that was read longest
 * ago is closed first. So 10 000 tile stores work under a limit of 256 file descriptors. Create one
 * pool per process and set `filePool` in the create-info of every source.
 *
 * A file that is opened again must be unchanged: same device, inode, size and time of the last
 * change of its contents. Otherwise reads return SLUICE_ERROR_IO, and the log says so once. Destroy
 * the source and create it again.
 */
typedef struct SluiceFilePool SluiceFilePool;

/** Settings of a pool. A field of zero selects its default. */
typedef struct SluiceFilePoolCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceFilePoolCreateInfo).
    /**
     * Most files that are open at the same time. At most 2^20. If more threads read, they wait for
     * one another. Default: a quarter of the soft limit RLIMIT_NOFILE at creation.
     */
    uint32_t maxOpenFileCount;
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
} SluiceFilePoolCreateInfo;

/**
 * Creates a pool. Opens nothing. `pInfo` may be NULL: every setting has its default.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if maxOpenFileCount is above
 *         2^20; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread. Sources may use the pool on any threads at the same time.
 */
SLUICE_API SluiceResult sluiceCreateFilePool(const SluiceFilePoolCreateInfo *pInfo,
                                             SluiceFilePool **pPool);

/**
 * Destroys a pool. Destroy every source that uses it first. NULL is allowed.
 * Thread safety: external on `pool`.
 */
SLUICE_API void sluiceDestroyFilePool(SluiceFilePool *pool);

/** Counts of a pool since its creation. */
typedef struct SluiceFilePoolStatistics {
    uint32_t structSize;       ///< sizeof(SluiceFilePoolStatistics).
    uint32_t maxOpenFileCount; ///< The limit.
    uint32_t openFileCount;    ///< Files that are open now.
    uint32_t openFilePeak;     ///< Most files that were open at the same time.
    uint64_t openTotal;        ///< Files opened, again or for the first time.
    uint64_t closedTotal;      ///< Files closed to make room for others.
    /** Times that the process or the system had no file descriptor left. The pool then closed
     *  another of its files; if there was none, the read returned SLUICE_NOT_READY. */
    uint64_t shortageTotal;
    uint64_t replacedTotal; ///< Reads refused because the file was changed or replaced.
} SluiceFilePoolStatistics;

/**
 * Gets the counts of a pool.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetFilePoolStatistics(SluiceFilePool *pool,
                                                    SluiceFilePoolStatistics *pStatistics);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_INPUT_H */
