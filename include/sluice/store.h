/**
 * The tile store: a file that holds a texture cut into the GPU's own tiles, each compressed and
 * checked by itself, so that streaming reads exactly what it shows. Link `sluice-store`. The bytes
 * of a file are described in docs/store.md; its name ends in SLUICE_STORE_EXTENSION.
 *
 * A file is opened with one read of 4 KiB; after that a tile is one positioned read, and another
 * one of 4 KiB now and then for a part of the index. Memory does not grow with the file, neither
 * for reading nor for writing.
 *
 * What is in a file: levels before `tailFirstLevel` are cut into tiles of the standard 64 KiB shape
 * (sluiceGetStandardTileShape), those at the right and lower edge are cut off at the level's end.
 * The levels from `tailFirstLevel` on are the tail: one piece that is read at once. It begins at
 * the first level that fits into one tile without filling it, so it always has a level.
 *
 * Writing:
 *
 *     sluiceGetStoreLayout(width, height, format, &layout);
 *     sluiceCreateStoreWriter(&info, &writer);
 *     for each layer, level < layout.tailFirstLevel, y, x, in any order, on any threads:
 *         sluiceIsStoreTileWritten      if it may have been written by an earlier run
 *         sluiceGetStoreTileRegion      the texels to make
 *         sluiceWriteStoreTile
 *     for each layer:
 *         sluiceWriteStoreTail
 *     sluiceFinishStore                 the file is there from now on, and complete
 *     sluiceDestroyStoreWriter
 */
#ifndef SLUICE_STORE_H
#define SLUICE_STORE_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SLUICE_STORE_EXTENSION ".store"
/** The version written. Files of the same major version are read, whatever their minor one is. */
#define SLUICE_STORE_VERSION_MAJOR 1
#define SLUICE_STORE_VERSION_MINOR 0

/** The longest mip chain (2^20 texels) has 21 levels. */
#define SLUICE_STORE_MAX_MIP_LEVELS 21
#define SLUICE_STORE_MAX_SIZE (1u << 20)
#define SLUICE_STORE_MAX_ARRAY_LAYERS (1u << 16)
/** Bytes, without the zero at the end. */
#define SLUICE_STORE_MAX_SOURCE_NAME 3900
#define SLUICE_STORE_MAX_COMPRESSION_LEVEL 22

/** What the numbers of colour channels stand for, where the format does not encode sRGB itself the
 *  numbers as stored. For the application; nothing here converts. */
typedef enum SluiceStoreColorSpace {
    SLUICE_STORE_COLOR_SPACE_UNDEFINED = 0, ///< not said, or not colour
    SLUICE_STORE_COLOR_SPACE_SRGB = 1,      ///< sRGB primaries, encoded, also in _SRGB formats
    SLUICE_STORE_COLOR_SPACE_LINEAR_SRGB = 2,
    SLUICE_STORE_COLOR_SPACE_LINEAR_REC2020 = 3,
    SLUICE_STORE_COLOR_SPACE_ACESCG = 4 ///< linear, AP1 primaries
} SluiceStoreColorSpace;

/** What the channels are. */
typedef enum SluiceStoreMeaning {
    SLUICE_STORE_MEANING_COLOR = 0,               ///< a fourth channel means nothing
    SLUICE_STORE_MEANING_COLOR_ALPHA = 1,         ///< straight alpha
    SLUICE_STORE_MEANING_COLOR_PREMULTIPLIED = 2, ///< colour is multiplied by alpha
    SLUICE_STORE_MEANING_NORMAL =
        3,                        ///< unit vectors, of unsigned formats 2 v - 1; z may be left out
    SLUICE_STORE_MEANING_DATA = 4 ///< anything else: roughness, masks, heights
} SluiceStoreMeaning;

/** Beyond the edge; the values are VkSamplerAddressMode's. */
typedef enum SluiceStoreAddressMode {
    SLUICE_STORE_ADDRESS_MODE_REPEAT = 0,
    SLUICE_STORE_ADDRESS_MODE_MIRRORED_REPEAT = 1,
    SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE = 2,
    SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_BORDER = 3
} SluiceStoreAddressMode;

/** How a texture is cut. Level l has max(1, width >> l) x max(1, height >> l) texels. */
typedef struct SluiceStoreLayout {
    uint32_t width, height;
    SluiceFormat format;
    uint32_t mipLevelCount;         ///< the full chain
    uint32_t tileWidth, tileHeight; ///< texels of a whole tile
    uint32_t tailFirstLevel;        ///< < mipLevelCount; 0: there is nothing but the tail
    uint32_t tailSize;              ///< bytes of all levels of a tail, less than 2^17
    uint64_t tileCount;             ///< of one layer, the tail counting as one
    uint32_t levelWidthInTiles[SLUICE_STORE_MAX_MIP_LEVELS];  ///< 1 for the levels of the tail
    uint32_t levelHeightInTiles[SLUICE_STORE_MAX_MIP_LEVELS]; ///< 1 for the levels of the tail
} SluiceStoreLayout;

/**
 * Errors: NULL_POINTER; UNSUPPORTED for unknown formats; INVALID_ARGUMENT for sizes of 0 or beyond
 * SLUICE_STORE_MAX_SIZE. Any thread.
 */
SLUICE_API SluiceResult sluiceGetStoreLayout(uint32_t width, uint32_t height, SluiceFormat format,
                                             SluiceStoreLayout *pLayout);

/**
 * The texels of a tile, in layer 0; of a level of the tail, with x = y = 0, the whole level. A tile
 * that is read by this region costs no copy. `pLayout` as sluiceGetStoreLayout made it. Errors:
 * NULL_POINTER; INVALID_ARGUMENT if there is no such level or tile. Any thread.
 */
SLUICE_API SluiceResult sluiceGetStoreTileRegion(const SluiceStoreLayout *pLayout,
                                                 uint32_t mipLevel, uint32_t tileX, uint32_t tileY,
                                                 SluiceImageRegion *pRegion);

typedef enum SluiceStoreWriterFlags {
    /**
     * Goes on with what an earlier writer of the same path and the same create-info left behind,
     * and leaves behind what this one has written if it does not get to sluiceFinishStore.
     */
    SLUICE_STORE_WRITER_RESUME = 1
} SluiceStoreWriterFlags;

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceStoreCreateInfo {
    const char *pPath;        ///< required; copied
    uint32_t width, height;   ///< required; 1 to SLUICE_STORE_MAX_SIZE
    uint32_t mipLevelCount;   ///< 0 or the full chain's
    uint32_t arrayLayerCount; ///< 0: 1; at most SLUICE_STORE_MAX_ARRAY_LAYERS
    SluiceFormat format;      ///< required
    SluiceStoreColorSpace colorSpace;
    SluiceStoreMeaning meaning;
    SluiceStoreAddressMode addressModeU, addressModeV;
    /**
     * What the texels were made from, so that a later run can tell whether anything changed. All of
     * it is kept as given and nothing is done with it, but that resuming wants it the same.
     */
    const char *pSourceName;    ///< NULL: ""; at most SLUICE_STORE_MAX_SOURCE_NAME bytes; copied
    uint64_t sourceSize;        ///< bytes
    int64_t sourceModifiedTime; ///< nanoseconds since 1970, UTC
    uint64_t settingsHash;      ///< of whatever else decides what the texels are
    /** zstd's, 1 to SLUICE_STORE_MAX_COMPRESSION_LEVEL, fast to small; 0: nothing is compressed. */
    uint32_t compressionLevel;
    uint32_t flags; ///< of SluiceStoreWriterFlags
    /** NULL: malloc and free; outlives the writer. Also zstd takes its memory from here. Called
     *  from all threads that write. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< what fails and where; what was resumed
} SluiceStoreCreateInfo;

typedef struct SluiceStoreWriter SluiceStoreWriter;

/**
 * Begins to write a file. It is written as `pPath` with ".part" added and takes its name in
 * sluiceFinishStore, so that under its name it is complete or absent; what was under the name
 * stays until then. No two writers can have the same path at a time, also of different processes.
 *
 * With SLUICE_STORE_WRITER_RESUME every tile of the .part file is read and its checksum compared;
 * those that are right count as written. If it is of another version, or of another create-info
 * (but for path, flags, allocator and log), it is begun anew. Time: that of reading the .part file.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for values outside their ranges; UNSUPPORTED for unknown
 *         formats; FILE_NOT_FOUND if the folder is not there; IO, also if another writer is at
 *         work, or what is under the name is no regular file; OUT_OF_HOST_MEMORY. Thread safety:
 * any thread.
 */
SLUICE_API SluiceResult sluiceCreateStoreWriter(const SluiceStoreCreateInfo *pInfo,
                                                SluiceStoreWriter **pWriter);

/** How the writer cuts its texture. Errors: NULL_POINTER. Any thread. */
SLUICE_API SluiceResult sluiceGetStoreWriterLayout(const SluiceStoreWriter *writer,
                                                   SluiceStoreLayout *pLayout);

/** Tiles written, found ones included, and tiles altogether; tails count as one each. Errors:
 *  NULL_POINTER. Any thread, also beside writes. */
SLUICE_API SluiceResult sluiceGetStoreProgress(SluiceStoreWriter *writer,
                                               uint64_t *pWrittenTileCount, uint64_t *pTileCount);

/**
 * Whether a tile is there; for levels of the tail (tileX = tileY = 0), whether the tail is. Errors:
 * NULL_POINTER; INVALID_ARGUMENT if there is no such layer, level or tile; IO. Any thread, also
 * beside writes.
 */
SLUICE_API SluiceResult sluiceIsStoreTileWritten(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                                 uint32_t mipLevel, uint32_t tileX, uint32_t tileY,
                                                 bool *pWritten);

/**
 * Writes one tile: the texels of its region (sluiceGetStoreTileRegion), `rowPitch` bytes from one
 * row of texels, or of blocks, to the next. Compresses on the caller's thread. Where tiles lie in a
 * compressed file follows the order in which writes come to their end, so on one thread the same
 * calls give the same bytes; an uncompressed file is the same in any order. What an interrupted
 * writer and a resuming one have written together follows the same rule.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT if there is no such layer or tile, the level belongs to
 *         the tail or rowPitch is below a row's size; INVALID_TILE_STATE if the tile is written
 *         already, or the file finished; OUT_OF_HOST_MEMORY; IO, a full disk among it. The tile
 *         is not written then, and may be tried again. Where that cannot be, because the disk has
 *         refused a piece of the index that it had room for, every later write is answered IO.
 * Thread safety: any thread, several at once, but not the same tile.
 */
SLUICE_API SluiceResult sluiceWriteStoreTile(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                             uint32_t mipLevel, uint32_t tileX, uint32_t tileY,
                                             const void *pTexels, size_t rowPitch);

/**
 * Writes the tail of a layer: `ppLevels` are its mipLevelCount - tailFirstLevel levels, finest
 * first, `pRowPitches` the bytes from one row of texels or blocks to the next in each; NULL: rows
 * are tightly packed. Otherwise as sluiceWriteStoreTile.
 */
SLUICE_API SluiceResult sluiceWriteStoreTail(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                             const void *const *ppLevels,
                                             const size_t *pRowPitches);

/**
 * Seals the file, waits until it is on the disk, and gives it its name. After success the writer
 * can only be asked and destroyed.
 *
 * Errors: NULL_POINTER; INVALID_TILE_STATE if tiles are missing (the log names the first; write
 *         them and call again), or it is finished already; IO. Under the name is what was there
 *         before, then, but for the last step, when the folder could not be written to the disk.
 *         After IO the writer can only be destroyed; another one may resume.
 * Thread safety: external on the writer.
 */
SLUICE_API SluiceResult sluiceFinishStore(SluiceStoreWriter *writer);

/** Unless it is finished or may be resumed, nothing is left of the file. NULL is allowed. Thread
 *  safety: external on the writer. */
SLUICE_API void sluiceDestroyStoreWriter(SluiceStoreWriter *writer);

/**
 * Memory that reads need for their time: 256 KiB and about 160 KiB of zstd's for each read that is
 * under way at the same time, kept for those to come. Many sources can share one.
 */
typedef struct SluiceStoreReadPool SluiceStoreReadPool;

/** `pAllocator` NULL: malloc and free. Errors: NULL_POINTER, OUT_OF_HOST_MEMORY. Any thread; what
 *  uses the pool may do so on any threads at once. */
SLUICE_API SluiceResult sluiceCreateStoreReadPool(const SluiceAllocationCallbacks *pAllocator,
                                                  SluiceStoreReadPool **pPool);

/** Every source that uses it is gone. NULL is allowed. */
SLUICE_API void sluiceDestroyStoreReadPool(SluiceStoreReadPool *pool);

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceStoreImageSourceCreateInfo {
    const char *pPath;                           ///< required; copied
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free
    SluiceLogCallback log;                       ///< what is wrong with a file, and at which offset
    /**
     * NULL: the source has one of its own, with the same allocator. Outlives the source. For
     * programs with many sources: as large as they need for the reads at one time, of all, and the
     * first read of a source is quicker: on virtual machines zstd takes 25 us to make a context.
     */
    SluiceStoreReadPool *readPool;
    /**
     * Compare the checksum of a tile that is not compressed each time it is read, not the first
     * time alone. It takes a third as long as reading 64 KiB that the system has in memory does,
     * and finds what happens to the bytes after this source has read them first: another program
     * writes into the file, or a disk delivers something else the next time. Compressed tiles are
     * always checked.
     */
    bool alwaysCheckRawTiles;
} SluiceStoreImageSourceCreateInfo;

/**
 * Opens a file: one read. The source delivers the file's format, any rectangle of any level; it
 * fits every GPU, whatever that packs. A rectangle that is one tile (sluiceGetStoreTileRegion)
 * with tightly packed rows is decompressed, or read, right into the caller's memory; any other is
 * copied together from all tiles it touches. Holds parts of the index, at most 256 KiB, and one bit
 * for each tile in them, at most 1.7 KiB: whether it was found right.
 *
 * Nothing that a file says is believed unchecked (alwaysCheckRawTiles says how often): reads answer
 * CORRUPT_DATA if a checksum is wrong or something does not fit together, IO if the system cannot
 * read or the file was cut off while it was open, OUT_OF_HOST_MEMORY; the log gets file, offset and
 * what was wrong. Later reads are not affected. A file that is replaced by another under its name
 * stays the old one for this source.
 *
 * Errors: NULL_POINTER; FILE_NOT_FOUND; IO; CORRUPT_DATA for other files, damaged, cut-off and
 *         unfinished ones; UNSUPPORTED for files of a newer major version or an unknown format;
 *         OUT_OF_HOST_MEMORY.
 * Thread safety: any thread; the source as image.h has it.
 */
SLUICE_API SluiceResult sluiceCreateStoreImageSource(const SluiceStoreImageSourceCreateInfo *pInfo,
                                                     SluiceImageSource **pSource);

/** What a file says of itself. The enumerations hold values that are listed above: what a newer
 *  minor version may add reads as UNDEFINED, DATA or CLAMP_TO_EDGE. */
typedef struct SluiceStoreInfo {
    uint32_t versionMajor, versionMinor;
    SluiceStoreLayout layout;
    uint32_t arrayLayerCount;
    SluiceStoreColorSpace colorSpace;
    SluiceStoreMeaning meaning;
    SluiceStoreAddressMode addressModeU, addressModeV;
    const char *pSourceName; ///< never NULL; lives as long as the source
    uint64_t sourceSize;
    int64_t sourceModifiedTime;
    uint64_t settingsHash;
    uint32_t compressionLevel;
    uint64_t fileSize; ///< bytes
} SluiceStoreInfo;

/** `source` from sluiceCreateStoreImageSource. Errors: NULL_POINTER; INVALID_ARGUMENT for other
 *  sources. Any thread. */
SLUICE_API SluiceResult sluiceGetStoreInfo(SluiceImageSource *source, SluiceStoreInfo *pInfo);

/** One tile that cannot be read. */
typedef struct SluiceStoreDefect {
    uint32_t arrayLayer, mipLevel, tileX, tileY; ///< of a tail its first level, 0 and 0
    uint64_t offset; ///< where in the file: of its bytes, or of the part of the index that is wrong
    SluiceResult result; ///< CORRUPT_DATA or IO
} SluiceStoreDefect;

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceStoreVerifyInfo {
    const char *pPath; ///< required
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log;
    void *pUserData;
    /** NULL, or called for every tile that cannot be read. */
    void (*pfnDefect)(void *pUserData, const SluiceStoreDefect *pDefect);
    /** NULL, or called now and then; false stops: CANCELLED. */
    bool (*pfnProgress)(void *pUserData, uint64_t doneTiles, uint64_t totalTiles);
} SluiceStoreVerifyInfo;

/** What sluiceVerifyStore saw, up to where it came. */
typedef struct SluiceStoreReport {
    uint64_t tileCount;    ///< looked at, tails among them
    uint64_t defectCount;  ///< of these, cannot be read
    uint64_t storedSize;   ///< bytes of the good ones in the file
    uint64_t texelSize;    ///< and decompressed
    uint64_t rawTileCount; ///< of the good ones, those stored as they are
} SluiceStoreReport;

/**
 * Reads all of a file: header, index, and every tile, which is decompressed. Goes on after tiles
 * that cannot be read. `pReport` may be NULL. On the caller's thread.
 *
 * Errors: NULL_POINTER; what sluiceCreateStoreImageSource says; CORRUPT_DATA, or IO, of the first
 *         defect; CANCELLED. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceVerifyStore(const SluiceStoreVerifyInfo *pInfo,
                                          SluiceStoreReport *pReport);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_STORE_H */
