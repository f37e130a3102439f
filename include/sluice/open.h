/**
 * Opens image files of all kinds by their contents. Link `sluice-open`.
 *
 * Files that can be streamed are opened in place: tile stores, OpenEXR, DDS and KTX2. Pictures
 * without tiles (JPEG, PNG, TIFF, WebP and whatever else libvips reads) stream at once, too: their
 * coarse levels come first, of a fast preview, and the others when a bake in the background has
 * ended. Its store is kept in a cache folder for the next time.
 */
#ifndef SLUICE_OPEN_H
#define SLUICE_OPEN_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Default limit of the cache folder: 16 GiB. */
#define SLUICE_OPEN_DEFAULT_CACHE_SIZE ((uint64_t)1 << 34)

/** Opens files and shares what is open. */
typedef struct SluiceImageOpener SluiceImageOpener;

/** Settings of an opener. A field of zero selects its default. */
typedef struct SluiceImageOpenerCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceImageOpenerCreateInfo).
    /** Most files that are open at the same time, as in SluiceFilePoolCreateInfo. */
    uint32_t maxOpenFileCount;
    /**
     * Folder for stores of pictures without tiles, such as "$XDG_CACHE_HOME/sluice"; Sluice reads
     * no environment variables. Copied. Created if the folder above it exists. Several processes
     * may use it. NULL: such pictures are refused with SLUICE_ERROR_UNSUPPORTED.
     */
    const char *pCacheFolder;
    /**
     * Bytes of the stores in the cache folder. After each bake the stores that were opened longest
     * ago are deleted, until the others fit. Stores of this opener's sources are kept. Default:
     * SLUICE_OPEN_DEFAULT_CACHE_SIZE.
     */
    uint64_t maxCacheSize;
    uint32_t bakeThreadCount; ///< Threads of bakes. Default: one per processor.
    uint64_t maxBakeMemory;   ///< As SluiceBakerCreateInfo::maxMemory.
    /** Default: malloc and free. Called from all threads that use the sources and from bakes. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< Problems of files, with their names. Called from any thread.
} SluiceImageOpenerCreateInfo;

/**
 * Creates an opener. Starts threads and libvips with the first picture without tiles.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if maxOpenFileCount is above
 *         2^20; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateImageOpener(const SluiceImageOpenerCreateInfo *pInfo,
                                                SluiceImageOpener **pOpener);

/**
 * Destroys an opener. Destroy all of its sources first. NULL is allowed.
 * Thread safety: external on `opener`.
 */
SLUICE_API void sluiceDestroyImageOpener(SluiceImageOpener *opener);

/**
 * Opens an image file by its first bytes. Destroy the source with sluiceDestroyImageSource.
 *
 * The same path, while the file has the same size, inode and time of the last change, gives the
 * same source: as many times as it is opened, it must be destroyed, on any threads. A file that was
 * changed gives a new source; older sources stay as they are.
 *
 * A DDS or KTX2 file of an uncompressed format that lacks levels gets them as by
 * sluiceCreateCompleteChainSource with its defaults: the first read of such a level builds them,
 * and they take up to a third of level 0 in memory, at most 512 MiB. A file of a compressed format
 * is delivered with the levels that it has.
 *
 * A picture without tiles gets its final size, format and levels at once. Until its bake has ended,
 * reads of levels of more than 512 texels return SLUICE_NOT_READY, and so do all reads until the
 * preview is there: loaders read again later. Texels of the preview differ slightly from those of
 * the store. If the bake fails, reads of the levels that are missing return its error. Destroying
 * the source cancels the bake; the next one of the same picture goes on where it ended.
 *
 * A store in the cache folder is used if it was made of a file with this path, size and time. A
 * store that is damaged or vanishes is baked again, at most twice for one source.
 *
 * Returns SLUICE_NOT_READY, without a source, for want of file descriptors.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO, also for what is
 *         no regular file and for a cache folder that cannot be created; SLUICE_ERROR_CORRUPT_DATA;
 *         SLUICE_ERROR_UNSUPPORTED for kinds that this build does not read (the log names the
 *         missing part); SLUICE_ERROR_LIMIT_EXCEEDED; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceOpenImageSource(SluiceImageOpener *opener, const char *path,
                                              SluiceImageSource **pSource);

/** Kind of an opened file. */
typedef enum SluiceImageFileKind {
    SLUICE_IMAGE_FILE_KIND_STORE = 0,
    SLUICE_IMAGE_FILE_KIND_EXR = 1,
    SLUICE_IMAGE_FILE_KIND_DDS = 2,
    SLUICE_IMAGE_FILE_KIND_KTX2 = 3,
    SLUICE_IMAGE_FILE_KIND_PICTURE = 4 ///< Without tiles; baked in the background.
} SluiceImageFileKind;

/** State of an opened file. */
typedef struct SluiceOpenedImageInfo {
    uint32_t structSize; ///< sizeof(SluiceOpenedImageInfo).
    SluiceImageFileKind kind;
    /** Source of the file itself, with the levels of the file, for sluiceGetStoreInfo and
     *  sluiceGetExrInfo. NULL for PICTURE. Do not destroy it. */
    SluiceImageSource *source;
    bool previewReady;    ///< PICTURE: coarse levels can be read. Else true.
    bool ready;           ///< All levels can be read. Always true but for PICTURE.
    SluiceResult failure; ///< Error of the bake. SLUICE_SUCCESS: none.
    uint32_t openCount;   ///< Times that the source must be destroyed.
    uint64_t doneTexels;  ///< Progress of the bake.
    uint64_t totalTexels; ///< 0: the bake has not begun.
} SluiceOpenedImageInfo;

/**
 * Gets the state of a source that sluiceOpenImageSource opened.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for other sources.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetOpenedImageInfo(SluiceImageSource *source,
                                                 SluiceOpenedImageInfo *pInfo);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_OPEN_H */
