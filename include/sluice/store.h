/**
 * Tile stores: files that hold a texture as GPU tiles. Link `sluice-store`.
 *
 * Each tile is compressed and has a checksum of its own, so streaming reads exactly the tiles that
 * it shows. docs/store.md specifies the format. File names end in SLUICE_STORE_EXTENSION.
 *
 * Opening a file takes one read of 4 KiB. Each tile takes one positioned read, and sometimes
 * another read of 4 KiB for a part of the index. Memory use does not grow with the file, when
 * reading or writing.
 *
 * Contents: levels before `tailFirstLevel` are cut into tiles of the standard 64 KiB shape
 * (sluiceGetStandardTileShape). Tiles at the right and lower edge end with the level. Levels from
 * `tailFirstLevel` on form the mip tail, which is read as one piece. It begins at the first level
 * that fits into one tile without filling it, so it always has a level.
 *
 * Writing:
 *
 *     sluiceGetStoreLayout(width, height, format, &layout);
 *     sluiceCreateStoreWriter(&info, &writer);
 *     for each layer, level < layout.tailFirstLevel, y, x, in any order, on any threads:
 *         sluiceIsStoreTileWritten      to skip tiles of an interrupted run
 *         sluiceGetStoreTileRegion      gets the texels to produce
 *         sluiceWriteStoreTile
 *     for each layer:
 *         sluiceWriteStoreTail
 *     sluiceFinishStore                 gives the complete file its name
 *     sluiceDestroyStoreWriter
 */
#ifndef SLUICE_STORE_H
#define SLUICE_STORE_H

#include <sluice/image.h>
#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SLUICE_STORE_EXTENSION ".store"
/** Version of written files. Files of the same major version can be read. */
#define SLUICE_STORE_VERSION_MAJOR 1
#define SLUICE_STORE_VERSION_MINOR 1

/** Levels of the longest mip chain (2^20 texels). */
#define SLUICE_STORE_MAX_MIP_LEVELS 21
#define SLUICE_STORE_MAX_SIZE (1u << 20)
#define SLUICE_STORE_MAX_ARRAY_LAYERS (1u << 16)
/** Bytes, without the terminating zero. */
#define SLUICE_STORE_MAX_SOURCE_NAME 3900
#define SLUICE_STORE_MAX_COMPRESSION_LEVEL 22

/**
 * Color space of the channels. In formats other than _SRGB it describes the numbers as stored. It
 * is information for the application: Sluice does not convert.
 */
typedef enum SluiceStoreColorSpace {
    SLUICE_STORE_COLOR_SPACE_UNDEFINED = 0, ///< Not specified, or not a color.
    SLUICE_STORE_COLOR_SPACE_SRGB = 1, ///< sRGB primaries, sRGB-encoded; also for _SRGB formats.
    SLUICE_STORE_COLOR_SPACE_LINEAR_SRGB = 2,
    SLUICE_STORE_COLOR_SPACE_LINEAR_REC2020 = 3,
    SLUICE_STORE_COLOR_SPACE_ACESCG = 4 ///< Linear, AP1 primaries.
} SluiceStoreColorSpace;

/** Meaning of the channels. */
typedef enum SluiceStoreMeaning {
    SLUICE_STORE_MEANING_COLOR = 0,               ///< A fourth channel has no meaning.
    SLUICE_STORE_MEANING_COLOR_ALPHA = 1,         ///< Straight alpha.
    SLUICE_STORE_MEANING_COLOR_PREMULTIPLIED = 2, ///< Color is multiplied by alpha.
    SLUICE_STORE_MEANING_NORMAL =
        3,                        ///< Unit vectors; unsigned formats hold (n + 1) / 2. May omit z.
    SLUICE_STORE_MEANING_DATA = 4 ///< Anything else: roughness, masks, heights.
} SluiceStoreMeaning;

/** Address mode. Values as in VkSamplerAddressMode. */
typedef enum SluiceStoreAddressMode {
    SLUICE_STORE_ADDRESS_MODE_REPEAT = 0,
    SLUICE_STORE_ADDRESS_MODE_MIRRORED_REPEAT = 1,
    SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE = 2,
    SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_BORDER = 3
} SluiceStoreAddressMode;

/**
 * Division of a texture into tiles. Level l has max(1, width >> l) x max(1, height >> l) texels.
 * Never grows.
 */
typedef struct SluiceStoreLayout {
    uint32_t width, height;
    SluiceFormat format;
    uint32_t mipLevelCount;         ///< Full chain.
    uint32_t tileWidth, tileHeight; ///< Texels of a whole tile.
    uint32_t tailFirstLevel;        ///< Below mipLevelCount. 0: the mip tail is all.
    uint32_t tailSize;              ///< Bytes of all levels of a mip tail, below 2^17.
    uint64_t tileCount;             ///< Tiles of one layer; its mip tail counts as one.
    uint32_t levelWidthInTiles[SLUICE_STORE_MAX_MIP_LEVELS];  ///< 1 in the mip tail.
    uint32_t levelHeightInTiles[SLUICE_STORE_MAX_MIP_LEVELS]; ///< 1 in the mip tail.
} SluiceStoreLayout;

/**
 * Computes how a texture is cut into tiles.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED for unknown formats;
 *         SLUICE_ERROR_INVALID_ARGUMENT for sizes of 0 or above SLUICE_STORE_MAX_SIZE.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetStoreLayout(uint32_t width, uint32_t height, SluiceFormat format,
                                             SluiceStoreLayout *pLayout);

/**
 * Gets the texels of a tile, in layer 0. For a level of the mip tail, with x = y = 0: the whole
 * level.
 *
 * Reading exactly this region takes no extra copy. `pLayout` comes from sluiceGetStoreLayout.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the level or tile does not
 *         exist.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetStoreTileRegion(const SluiceStoreLayout *pLayout,
                                                 uint32_t mipLevel, uint32_t tileX, uint32_t tileY,
                                                 SluiceImageRegion *pRegion);

/** Flags of a writer. */
typedef enum SluiceStoreWriterFlags {
    /**
     * Continues the .sluice-part file of an earlier writer with the same path and create-info.
     * Keeps its own .sluice-part file if it is destroyed before sluiceFinishStore.
     */
    SLUICE_STORE_WRITER_RESUME = 1
} SluiceStoreWriterFlags;

/** Settings of a file to write. A field of zero selects its default. */
typedef struct SluiceStoreCreateInfo {
    uint32_t structSize;      ///< sizeof(SluiceStoreCreateInfo).
    const char *pPath;        ///< Required. Copied.
    uint32_t width, height;   ///< Required. 1 to SLUICE_STORE_MAX_SIZE.
    uint32_t mipLevelCount;   ///< Must be the full chain. Default: full chain.
    uint32_t arrayLayerCount; ///< At most SLUICE_STORE_MAX_ARRAY_LAYERS. Default: 1.
    SluiceFormat format;      ///< Required.
    SluiceStoreColorSpace colorSpace;
    SluiceStoreMeaning meaning;
    SluiceStoreAddressMode addressModeU, addressModeV;
    /**
     * Origin of the texels: lets a later run detect changes. The next four fields are stored and
     * not interpreted; a resumed writer must give the same values.
     */
    const char *pSourceName; ///< At most SLUICE_STORE_MAX_SOURCE_NAME bytes. Copied. Default: "".
    uint64_t sourceSize;     ///< Bytes.
    int64_t sourceModifiedTimeNs; ///< Nanoseconds since 1970, UTC.
    uint64_t settingsHash;        ///< Hash of everything else that determines the texels.
    /** Level of zstd, 1 (fast) to SLUICE_STORE_MAX_COMPRESSION_LEVEL (small). 0: uncompressed. */
    uint32_t compressionLevel;
    uint32_t flags; ///< Bits of SluiceStoreWriterFlags.
    /**
     * Default: malloc and free. Must outlive the writer. zstd uses it, too. Called from all threads
     * that write.
     */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< Failures with their position; what was resumed.
    /** The layers are faces of cube maps, as SluiceImageInfo.cube says: square, six for each cube.
     *  Default: false. */
    bool cube;
} SluiceStoreCreateInfo;

typedef struct SluiceStoreWriter SluiceStoreWriter;

/**
 * Begins to write a file.
 *
 * The file is written as `pPath` + ".sluice-part". sluiceFinishStore renames it, so a file at
 * `pPath` is complete or absent. An older file at `pPath` is kept until then. Two writers cannot
 * use the same path at the same time, even in different processes.
 *
 * With SLUICE_STORE_WRITER_RESUME every tile of the .sluice-part file is read, and its checksum is
 * compared. Correct tiles count as written. If the .sluice-part file has another version or was
 * made with another create-info (path, flags, allocator and log excepted), the writer starts over.
 * This takes as long as reading the .sluice-part file.
 *
 * Returns SLUICE_NOT_READY, without a writer, if no file descriptor is free. Close files and call
 * again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for values out of range and
 *         for cube maps whose faces are not square or whose layers are no multiple of 6;
 *         SLUICE_ERROR_UNSUPPORTED for unknown formats; SLUICE_ERROR_FILE_NOT_FOUND if the folder
 *         does not exist; SLUICE_ERROR_BUSY if another writer has the file open; SLUICE_ERROR_IO,
 *         also if `pPath` is a link, a read-only file or not a regular file (it is kept);
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateStoreWriter(const SluiceStoreCreateInfo *pInfo,
                                                SluiceStoreWriter **pWriter);

/**
 * Gets how the writer cuts its texture into tiles.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetStoreWriterLayout(const SluiceStoreWriter *writer,
                                                   SluiceStoreLayout *pLayout);

/**
 * Counts the tiles written, including resumed ones, and all tiles. Each mip tail counts as one
 * tile.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread, also during writes.
 */
SLUICE_API SluiceResult sluiceGetStoreProgress(SluiceStoreWriter *writer,
                                               uint64_t *pWrittenTileCount, uint64_t *pTileCount);

/**
 * Tells whether a tile is written. For a level of the mip tail (tileX = tileY = 0): whether the
 * tail is.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the layer, level or tile does
 *         not exist; SLUICE_ERROR_IO.
 * Thread safety: any thread, also during writes.
 */
SLUICE_API SluiceResult sluiceIsStoreTileWritten(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                                 uint32_t mipLevel, uint32_t tileX, uint32_t tileY,
                                                 bool *pWritten);

/**
 * Writes one tile: the texels of sluiceGetStoreTileRegion. `rowPitch` is the distance in bytes
 * between rows of texels, or of blocks. Compresses on the caller's thread.
 *
 * In a compressed file tiles are placed in the order in which writes finish, so on one thread the
 * same calls give the same bytes. An uncompressed file is the same for any order. Both hold for a
 * file written by an interrupted and a resumed writer together. sluiceWriteStoreTileInTurn gives
 * the same bytes on several threads.
 *
 * After an error the tile is not written and can be written again. Exception: if the disk refuses a
 * part of the index that had space reserved, every later write returns SLUICE_ERROR_IO.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the layer or tile does not
 *         exist, the level belongs to the mip tail, or `rowPitch` is smaller than a row;
 *         SLUICE_ERROR_INVALID_TILE_STATE if the tile is already written or the file finished;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_IO, also if the disk is full.
 * Thread safety: any thread, several calls at the same time, but only one per tile.
 */
SLUICE_API SluiceResult sluiceWriteStoreTile(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                             uint32_t mipLevel, uint32_t tileX, uint32_t tileY,
                                             const void *pTexels, size_t rowPitch);

/**
 * Writes one tile in its turn, so that several threads write the same bytes as one. The turns of a
 * writer are 0, 1, 2 and so on. Each is ended by one call, on any thread, and the tile is placed
 * behind those of all earlier turns. `pTexels` NULL ends a turn without a tile, for tiles that are
 * written already or could not be made.
 *
 * Compresses on the caller's thread. If an earlier turn has not ended, the compressed tile waits in
 * memory, and the call that ends the earlier turn writes both. When 16 tiles wait, calls block, but
 * not that of the earliest turn: give turns to threads in ascending order.
 *
 * The turn ends whatever is returned. A failure to write makes this writer return SLUICE_ERROR_IO
 * from then on, also from sluiceFinishStore; the file can be resumed.
 *
 * Errors: as sluiceWriteStoreTile, but for NULL texels; SLUICE_ERROR_INVALID_ARGUMENT also if the
 *         turn has ended before.
 * Thread safety: any thread, several calls at the same time, but only one per turn and per tile.
 */
SLUICE_API SluiceResult sluiceWriteStoreTileInTurn(SluiceStoreWriter *writer, uint64_t turn,
                                                   uint32_t arrayLayer, uint32_t mipLevel,
                                                   uint32_t tileX, uint32_t tileY,
                                                   const void *pTexels, size_t rowPitch);

/**
 * Writes the mip tail of a layer. `ppLevels` are its mipLevelCount - tailFirstLevel levels, finest
 * first.
 *
 * `pRowPitches` holds the bytes between rows of texels, or of blocks, of each level. NULL means
 * tightly packed rows.
 *
 * Errors, thread safety: as sluiceWriteStoreTile.
 */
SLUICE_API SluiceResult sluiceWriteStoreTail(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                             const void *const *ppLevels,
                                             const size_t *pRowPitches);

/**
 * Completes the file, syncs it to disk and renames it to `pPath`. After success the writer can only
 * be queried and destroyed.
 *
 * After an error the file at `pPath` is unchanged, unless the last step failed: syncing the folder
 * to disk. After SLUICE_ERROR_IO the writer can only be destroyed; another writer may resume.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_TILE_STATE if the file is finished
 *         already, or if tiles are missing (the log names the first; write them and call again);
 *         SLUICE_ERROR_IO.
 * Thread safety: external on `writer`.
 */
SLUICE_API SluiceResult sluiceFinishStore(SluiceStoreWriter *writer);

/**
 * Destroys a writer. Deletes an unfinished file, unless SLUICE_STORE_WRITER_RESUME keeps it. NULL
 * is allowed.
 * Thread safety: external on `writer`.
 */
SLUICE_API void sluiceDestroyStoreWriter(SluiceStoreWriter *writer);

/**
 * Temporary memory for reads. Several sources can share one pool.
 *
 * It holds 256 KiB and about 160 KiB of zstd per concurrent read, and keeps them for later reads.
 */
typedef struct SluiceStoreReadPool SluiceStoreReadPool;

/**
 * Creates a pool. A NULL `pAllocator` means malloc and free.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread. Sources may use the pool on any threads at the same time.
 */
SLUICE_API SluiceResult sluiceCreateStoreReadPool(const SluiceAllocationCallbacks *pAllocator,
                                                  SluiceStoreReadPool **pPool);

/**
 * Destroys a pool. Destroy every source that uses it first. NULL is allowed.
 * Thread safety: external on `pool`.
 */
SLUICE_API void sluiceDestroyStoreReadPool(SluiceStoreReadPool *pool);

/** Settings of a source. A field of zero selects its default. */
typedef struct SluiceStoreImageSourceCreateInfo {
    uint32_t structSize;                         ///< sizeof(SluiceStoreImageSourceCreateInfo).
    const char *pPath;                           ///< Required without pInput. Copied.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;                       ///< Problems of the file, with the byte offset.
    /**
     * Pool to share with other sources. Must outlive the source. Default: a pool of its own, with
     * the same allocator. A shared pool is only as large as all concurrent reads require. It also
     * makes the first read of a source faster: on virtual machines zstd takes 25 us to create a
     * context.
     */
    SluiceStoreReadPool *readPool;
    /**
     * Verify the checksum of an uncompressed tile at every read, not only at the first one. This
     * takes a third of the time of reading 64 KiB from the page cache. It detects changes after the
     * first read: another program writes to the file, or the disk returns different bytes.
     * Compressed tiles are always verified.
     */
    bool alwaysCheckRawTiles;
    /** Reads these bytes instead of the file (input.h). Copied, but not the bytes. pPath is then a
     *  name for messages and may be NULL. Default: NULL, the file. */
    const SluiceInput *pInput;
    /** Pool that opens and closes the file as it is read (input.h). Must outlive the source. Not
     *  used with pInput. Default: NULL, the file stays open. */
    SluiceFilePool *filePool;
} SluiceStoreImageSourceCreateInfo;

/**
 * Opens a file with one read.
 *
 * The source returns the file's format and any rectangle of any level, for every GPU and any
 * packing. A rectangle of exactly one tile (sluiceGetStoreTileRegion) with tightly packed rows is
 * decompressed, or read, directly into the caller's memory. Any other rectangle is copied together
 * from the tiles that it touches. The source holds at most 256 KiB of the index, and one bit per
 * tile in it for verified checksums, at most 1.7 KiB.
 *
 * All file contents are verified (alwaysCheckRawTiles says how often). Reads return
 * SLUICE_ERROR_CORRUPT_DATA if a checksum is wrong or the data is inconsistent, SLUICE_ERROR_IO if
 * the system cannot read or the file was truncated, and SLUICE_ERROR_OUT_OF_HOST_MEMORY. The log
 * names file, offset and cause: each fault once, at most 16 per file. Later reads are not affected.
 * If another file takes this file's name, a source without filePool continues with the old file.
 * With a filePool, reads return SLUICE_ERROR_IO once the old file was closed.
 *
 * Returns SLUICE_NOT_READY, without a source, while the process has too few file descriptors.
 * Sluice leaves the last 16 below the soft limit to others. Close files and call again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO;
 *         SLUICE_ERROR_CORRUPT_DATA for other, damaged, truncated and unfinished files;
 *         SLUICE_ERROR_UNSUPPORTED for a newer major version or an unknown format;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread. The source may be used on any thread, as image.h says.
 */
SLUICE_API SluiceResult sluiceCreateStoreImageSource(const SluiceStoreImageSourceCreateInfo *pInfo,
                                                     SluiceImageSource **pSource);

/**
 * Properties that a file records. Enumerations hold only values listed above: values of newer minor
 * versions read as UNDEFINED, DATA or CLAMP_TO_EDGE.
 */
typedef struct SluiceStoreInfo {
    uint32_t structSize; ///< sizeof(SluiceStoreInfo).
    uint32_t versionMajor, versionMinor;
    SluiceStoreLayout layout;
    uint32_t arrayLayerCount;
    SluiceStoreColorSpace colorSpace;
    SluiceStoreMeaning meaning;
    SluiceStoreAddressMode addressModeU, addressModeV;
    const char *pSourceName; ///< Never NULL. Lives as long as the source.
    uint64_t sourceSize;
    int64_t sourceModifiedTimeNs;
    uint64_t settingsHash;
    uint32_t compressionLevel;
    uint64_t fileSize; ///< Bytes.
    bool cube;         ///< The layers are faces of cube maps. False for files before version 1.1.
} SluiceStoreInfo;

/**
 * Gets the properties of a file. `source` is from sluiceCreateStoreImageSource.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for other sources.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetStoreInfo(SluiceImageSource *source, SluiceStoreInfo *pInfo);

/**
 * Hashes a file by its index, without reading texels: h = XXH3-64(h, checksum), little endian, for
 * all tiles in the order of their numbers (docs/store.md), from h = 0. Files with equal hashes have
 * the same properties and texels, wherever tiles lie. Reads 4 KiB per 204 tiles. `source` is from
 * sluiceCreateStoreImageSource.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for other sources;
 *         SLUICE_ERROR_CORRUPT_DATA; SLUICE_ERROR_IO; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread, also during reads.
 */
SLUICE_API SluiceResult sluiceHashStore(SluiceImageSource *source, uint64_t *pHash);

/** Tile that cannot be read. */
typedef struct SluiceStoreDefect {
    uint32_t structSize;                         ///< Set by Sluice. sizeof(SluiceStoreDefect).
    uint32_t arrayLayer, mipLevel, tileX, tileY; ///< For a mip tail: its first level, 0 and 0.
    uint64_t offset;     ///< Byte offset of the tile, or of the defective part of the index.
    SluiceResult result; ///< SLUICE_ERROR_CORRUPT_DATA or SLUICE_ERROR_IO.
} SluiceStoreDefect;

/** Settings of sluiceVerifyStore. A field of zero selects its default. */
typedef struct SluiceStoreVerifyInfo {
    uint32_t structSize; ///< sizeof(SluiceStoreVerifyInfo).
    const char *pPath;   ///< Required, unless pInput is set.
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log;
    void *pUserData;
    /** Called for every tile that cannot be read. May be NULL. */
    void (*pfnDefect)(void *pUserData, const SluiceStoreDefect *pDefect);
    /** Reports progress. Return false to stop with SLUICE_ERROR_CANCELED. May be NULL. */
    bool (*pfnProgress)(void *pUserData, uint64_t doneTiles, uint64_t totalTiles);
    /** Reads these bytes instead of the file (input.h). pPath is then a name for messages and may
     *  be NULL. Default: NULL, the file. */
    const SluiceInput *pInput;
} SluiceStoreVerifyInfo;

/** Findings of sluiceVerifyStore up to its end or the point where it stopped. */
typedef struct SluiceStoreReport {
    uint32_t structSize;   ///< sizeof(SluiceStoreReport).
    uint64_t tileCount;    ///< Tiles checked, mip tails included.
    uint64_t defectCount;  ///< Tiles that cannot be read.
    uint64_t storedSize;   ///< Bytes of the good tiles as stored. Equal tiles count once each.
    uint64_t texelSize;    ///< Bytes of the good tiles, decompressed.
    uint64_t rawTileCount; ///< Good tiles that are stored uncompressed.
} SluiceStoreReport;

/**
 * Reads a whole file on the caller's thread: header, index and every tile, which it decompresses.
 *
 * Continues after tiles that cannot be read. `pReport` may be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; errors of sluiceCreateStoreImageSource;
 *         SLUICE_ERROR_CORRUPT_DATA or SLUICE_ERROR_IO of the first defect; SLUICE_ERROR_CANCELED.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceVerifyStore(const SluiceStoreVerifyInfo *pInfo,
                                          SluiceStoreReport *pReport);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_STORE_H */
