/**
 * Where the bytes of an image come from: files, of which a pool keeps a bounded number open;
 * memory; and functions of the application.
 *
 * The create-infos of tile stores (store.h), DDS, KTX2 and OpenEXR files (dds.h, ktx2.h, exr.h)
 * take a SluiceFilePool and a SluiceInput.
 */
#ifndef SLUICE_INPUT_H
#define SLUICE_INPUT_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Bytes of a file that are not in a file: an archive's entry, a buffer of a .glb, a download.
 *
 * Set `pBytes`, or `pfnRead`. Sluice copies the struct, not the bytes.
 */
typedef struct SluiceInput {
    uint32_t structSize; ///< sizeof(SluiceInput).
    /** The bytes. Not owned: keep them unchanged until the source is destroyed. */
    const void *pBytes;
    uint64_t size; ///< Bytes. At least 1.
    /** Passed to pfnRead. Must outlive the source. */
    void *pUserData;
    /**
     * Copies `size` > 0 bytes from `offset` on to `pBytes`. All of them lie below
     * SluiceInput::size. Used if SluiceInput::pBytes is NULL.
     *
     * Returns SLUICE_SUCCESS; SLUICE_NOT_READY to be asked again later;
     * SLUICE_ERROR_OUT_OF_HOST_MEMORY. Every other result counts as SLUICE_ERROR_IO.
     * Thread safety: any thread, several calls at the same time.
     */
    SluiceResult (*pfnRead)(void *pUserData, uint64_t offset, void *pBytes, size_t size);
} SluiceInput;

/**
 * Files of many sources, of which a bounded number is open at a time.
 *
 * A read opens its file if the file is closed. If the pool is full, the file that was read longest
 * ago is closed first. So 10 000 tile stores work under a limit of 256 file descriptors.
 *
 * A file that is opened again must still be the file that was opened first: same device, inode,
 * size and time of the last change of its contents. If another file has taken its place, reads
 * return SLUICE_ERROR_IO, and the log says so once. Destroy the source and create it again.
 */
typedef struct SluiceFilePool SluiceFilePool;

/** Settings of a pool. A field of zero selects its default. */
typedef struct SluiceFilePoolCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceFilePoolCreateInfo).
    /**
     * Most files that are open at the same time. More threads than that wait for one another.
     * Default: a quarter of the soft limit RLIMIT_NOFILE at creation, 1 to 2^20.
     */
    uint32_t maxOpenFileCount;
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
} SluiceFilePoolCreateInfo;

/**
 * Creates a pool. `pInfo` may be NULL: every setting has its default.
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
    /** Times that the process or the system had no file descriptor left. Another file of the pool
     *  was closed and the file opened then, or the read returned SLUICE_NOT_READY. */
    uint64_t shortageTotal;
    uint64_t replacedTotal; ///< Reads refused because another file has the name now.
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
