/**
 * Opens image files of all kinds by their contents. Link `sluice-open`.
 *
 * Tile stores, OpenEXR, DDS and KTX2 files are read in place. Textures of neural sets (neural.h)
 * are decoded when they are read. Pictures without tiles (JPEG, PNG,
 * TIFF, WebP and whatever else libvips reads) can be streamed at once, too. Their coarse levels
 * come first, from a fast preview. The other levels come when a bake in the background has ended.
 * The bake writes a tile store, which is kept in a cache folder for the next time.
 *
 * An opener takes paths and uses defaults. Create sources by store.h, exr.h, dds.h, ktx2.h and
 * neural_source.h for bytes in memory (input.h) and for other settings, such as another format.
 */
#ifndef SLUICE_OPEN_H
#define SLUICE_OPEN_H

#include <sluice/image.h>
#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Default limit of the cache folder: 16 GiB. */
#define SLUICE_OPEN_DEFAULT_CACHE_SIZE ((uint64_t)1 << 34)

struct SluiceBakeSettings;

/** Opens files. Its sources share a file pool, memory limits and the cache folder. */
typedef struct SluiceImageOpener SluiceImageOpener;

/** Opens paths that name no file of the system, such as URLs. */
typedef struct SluicePathOpener {
    void *pUserData; ///< Passed to both functions. Must outlive the opener.
    /**
     * Opens a path and fills `pInput`, whose structSize is set, and `*ppOpened`, which pfnClosePath
     * gets. Returns any result; an error is the result of sluiceOpenImageSource.
     */
    SluiceResult (*pfnOpenPath)(void *pUserData, const char *path, SluiceInput *pInput,
                                void **ppOpened);
    /** Ends the use of an input. Its reads have ended. */
    void (*pfnClosePath)(void *pUserData, void *pOpened);
} SluicePathOpener;

/** Settings of an opener. A field of zero selects its default. */
typedef struct SluiceImageOpenerCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceImageOpenerCreateInfo).
    /**
     * Most files that are open at the same time. At most 2^20. Default: a quarter of the soft limit
     * RLIMIT_NOFILE at creation.
     */
    uint32_t maxOpenFileCount;
    /**
     * Folder for stores of pictures without tiles. The usual one is $XDG_CACHE_HOME/sluice; Sluice
     * reads no environment variables. Copied. Created with the first such picture, if its parent
     * folder exists. Several processes may use it. The folder belongs to Sluice: files in it with
     * names such as "0123456789abcdef-2a.store" are replaced and deleted. Sluice does not touch
     * files with other names. Default: NULL, such pictures return SLUICE_ERROR_UNSUPPORTED.
     */
    const char *pCacheFolder;
    /**
     * Most bytes of the stores in the cache folder. After each bake the stores that were opened
     * longest ago are deleted until the others fit. Stores of this opener's sources are kept, even
     * beyond the limit. Default: SLUICE_OPEN_DEFAULT_CACHE_SIZE.
     */
    uint64_t maxCacheSize;
    uint32_t bakeThreadCount; ///< Threads of bakes. Default: one per processor.
    uint64_t maxBakeMemory;   ///< Most bytes for bakes. Default: 2^30 (SluiceBakerCreateInfo).
    /** Default: malloc and free. Called from all threads that use the sources and from bakes. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< Problems of files, with their names. Called from any thread.
    /**
     * Opens paths that contain "://", on any threads: set both functions, or none.
     * sluiceOpenHttpPath and sluiceCloseHttpPath (http.h) open URLs. Supports tile stores, OpenEXR,
     * DDS and KTX2 files, and neural sets. Pictures without tiles return SLUICE_ERROR_UNSUPPORTED.
     * Default: NULL, such paths are files.
     */
    SluicePathOpener pathOpener;
    /**
     * Checks whether a path of pathOpener still has the contents of its opening. Returns
     * SLUICE_SUCCESS for the same contents, SLUICE_ERROR_UNSUPPORTED if unknown, and any other
     * result for changed contents. Gets SluicePathOpener::pUserData. For URLs, set
     * sluiceCheckHttpPath (http.h).
     *
     * Catalogues of pathOpener stay in memory. They are checked with this function at most once a
     * second, and before a name or store is reported missing or wrong. A changed catalogue is read
     * again. With an unknown result, a catalogue is read again when a name or store is missing or
     * wrong. Default: NULL, the result is always unknown.
     */
    SluiceResult (*pfnCheckPath)(void *pUserData, void *pOpened);
} SluiceImageOpenerCreateInfo;

/**
 * Creates an opener. Starts threads and libvips with the first picture without tiles.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for pfnCheckPath without pathOpener;
 *         SLUICE_ERROR_INVALID_ARGUMENT if maxOpenFileCount is above 2^20;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
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
 * Opens an image file. The first bytes tell its kind, not its name. Blocks while the header is
 * read, or while another thread opens the same file; other calls do not wait for it.
 *
 * Destroy the source with sluiceDestroyImageSource. If the same path is opened again, and the file
 * has the same device, inode, size and time of the last change of its contents, the same source is
 * returned. Destroy it as many times as it was opened, on any threads. A file that was changed
 * gives a new source. Reads of older sources may then return SLUICE_ERROR_IO (SluiceFilePool).
 *
 * A path of the pathOpener is opened once until it was destroyed as many times as it was opened.
 *
 * A DDS or KTX2 file of an uncompressed format that lacks levels gets them as by
 * sluiceCreateCompleteChainSource with its defaults: the first read of such a level builds them,
 * and they take up to a third of level 0 in memory, at most 512 MiB. A file of a compressed format
 * is delivered with the levels that it has.
 *
 * A neural set is opened as its first texture, decoded with INT8 weights; if it has several, a
 * message at SLUICE_LOG_INFO names them. sluiceOpenNamedImageSource opens the others.
 *
 * A picture without tiles has its final size, format and levels at once. It is baked with default
 * settings (SluiceBakeSettings). Until the preview is ready, all reads return SLUICE_NOT_READY.
 * Until the bake has ended, reads of levels wider or higher than 512 texels do. Streamers and
 * demand loaders read again later, streamers at intervals that double. Call sluiceRetryVulkanSource
 * when the bake has ended to read at once. Texels of the preview differ slightly from those of the
 * store. If the bake fails, reads of missing levels return its error. Destroying the source cancels
 * the bake. The next bake of the same picture continues where the canceled bake ended.
 *
 * A store in the cache folder is used if it was made from a file with this path, size and time. If
 * another opener or process replaces the store, its store is opened. A store that is damaged is
 * baked again, at most twice per source. A store that is deleted is baked again, at most twice
 * until a read succeeds.
 *
 * Returns SLUICE_NOT_READY, without a source, while the process has too few file descriptors. Close
 * files and call again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO, also if path is
 *         no regular file or the cache folder cannot be created; SLUICE_ERROR_CORRUPT_DATA;
 *         SLUICE_ERROR_UNSUPPORTED for kinds that this build does not read (the log names the
 *         missing part); SLUICE_ERROR_LIMIT_EXCEEDED; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceOpenImageSource(SluiceImageOpener *opener, const char *path,
                                              SluiceImageSource **pSource);

/**
 * Opens a texture of a neural set (neural.h) by its name. Otherwise as sluiceOpenImageSource. Each
 * texture has its own source, which keeps the description and the weights of the set.
 *
 * Also opens a store that a catalogue names, which sluice-bake --merge writes (docs/cluster.md).
 * `texture` is then the path of the picture or of its store in the catalogue, or the end of such a
 * path behind a slash, if only one row has this end. sluiceOpenImageSource opens the first store.
 * Paths of stores are relative to the catalogue's folder. The source equals a source for the
 * store's path, so SluiceOpenedImageInfo::kind is STORE. Returns SLUICE_ERROR_CORRUPT_DATA if the
 * store's hash differs from the catalogue's, SLUICE_ERROR_LIMIT_EXCEEDED for catalogues above 256
 * MiB.
 *
 * The opener reads a catalogue once and keeps the last eight in memory: 56 bytes per row and the
 * names. A file whose size, time or inode changed is read again; pfnCheckPath
 * notices changes elsewhere.
 *
 * Errors: as sluiceOpenImageSource; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the set
 *         has no texture `texture` (the message lists its textures), the catalogue has no such row
 *         or several, or the file is neither a neural set nor a catalogue.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceOpenNamedImageSource(SluiceImageOpener *opener, const char *path,
                                                   const char *texture,
                                                   SluiceImageSource **pSource);

/**
 * Opens an image file as sluiceOpenImageSource does, and bakes a picture without tiles with
 * `pSettings` (bake.h): as a normal map, with the address modes of its sampler, or
 * block-compressed. The preview has these settings, too. Files of other kinds do not depend on
 * them.
 *
 * Each combination of a picture and settings has its own source and its own store in the cache
 * folder. Default settings are those of sluiceOpenImageSource. `pSettings` is copied.
 *
 * Errors: as sluiceOpenImageSource; SLUICE_ERROR_NULL_POINTER also for `pSettings`;
 *         SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize, and for settings that
 * sluiceBakeFile refuses. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceOpenBakedImageSource(SluiceImageOpener *opener, const char *path,
                                                   const struct SluiceBakeSettings *pSettings,
                                                   SluiceImageSource **pSource);

/** Kind of an opened file. */
typedef enum SluiceImageFileKind {
    SLUICE_IMAGE_FILE_KIND_STORE = 0,
    SLUICE_IMAGE_FILE_KIND_EXR = 1,
    SLUICE_IMAGE_FILE_KIND_DDS = 2,
    SLUICE_IMAGE_FILE_KIND_KTX2 = 3,
    SLUICE_IMAGE_FILE_KIND_PICTURE = 4, ///< Without tiles; baked in the background.
    SLUICE_IMAGE_FILE_KIND_NEURAL = 5   ///< A texture of a neural set.
} SluiceImageFileKind;

/** State of an opened file at the time of the call. */
typedef struct SluiceOpenedImageInfo {
    uint32_t structSize; ///< sizeof(SluiceOpenedImageInfo).
    SluiceImageFileKind kind;
    /** Source of the file itself, with the levels of the file, for sluiceGetStoreInfo and
     *  sluiceGetExrInfo. NULL for PICTURE. Do not destroy it. */
    SluiceImageSource *source;
    bool previewReady;    ///< Levels of at most 512 x 512 texels can be read. True unless PICTURE.
    bool ready;           ///< All levels can be read. True unless PICTURE.
    SluiceResult failure; ///< Error of the bake. SLUICE_SUCCESS: none so far.
    uint32_t openCount;   ///< Times that the source must still be destroyed.
    uint64_t doneTexels;  ///< Texels that the bake has done.
    uint64_t totalTexels; ///< Texels that the bake has to do. 0: the bake has not begun.
} SluiceOpenedImageInfo;

/**
 * Gets the state of a source that sluiceOpenImageSource opened.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for other sources and a wrong
 *         structSize.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetOpenedImageInfo(SluiceImageSource *source,
                                                 SluiceOpenedImageInfo *pInfo);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_OPEN_H */
