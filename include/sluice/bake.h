/**
 * Turns pictures into tile stores (store.h): any file that libvips or OpenEXR reads, larger than
 * memory too, with mip levels as they should be. Link `sluice-bake`.
 *
 * A picture is read once from top to bottom. Each level keeps the rows of a tile or two and those
 * that the filter reaches over, so memory grows with the picture's width alone.
 *
 * Levels are filtered where numbers add up as light does: sRGB decoded, colours weighted by alpha,
 * normals as vectors. Each texel is made from the level above at full precision; sizes are rounded
 * down, and where that is not half, weights follow the area that a texel covers.
 */
#ifndef SLUICE_BAKE_H
#define SLUICE_BAKE_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/** zstd's level where none is given. */
#define SLUICE_BAKE_DEFAULT_COMPRESSION 10u

/** How much of the level above makes a texel. */
typedef enum SluiceBakeFilter {
    SLUICE_BAKE_FILTER_BOX = 0,   ///< the mean of the area that it covers
    SLUICE_BAKE_FILTER_KAISER = 1 ///< sharper: a sinc 6 texels wide, windowed (alpha 4); may ring
} SluiceBakeFilter;

/** What lies beyond an edge, for filters that reach there; a box does not. */
typedef enum SluiceBakeWrap {
    SLUICE_BAKE_WRAP_CLAMP = 0,
    SLUICE_BAKE_WRAP_REPEAT = 1,
    SLUICE_BAKE_WRAP_MIRROR = 2
} SluiceBakeWrap;

/** What the numbers of R, G and B in the picture mean. */
typedef enum SluiceBakeTransfer {
    /** sRGB for integers of two channels or more, unless it is a normal map; else LINEAR. */
    SLUICE_BAKE_TRANSFER_AUTO = 0,
    SLUICE_BAKE_TRANSFER_SRGB = 1,
    SLUICE_BAKE_TRANSFER_LINEAR = 2
} SluiceBakeTransfer;

/** What the picture's alpha means; what is stored means the same. */
typedef enum SluiceBakeAlpha {
    SLUICE_BAKE_ALPHA_AUTO = 0, ///< PREMULTIPLIED for OpenEXR files and sources, else STRAIGHT
    /**
     * Coverage, clamped to [0, 1], that colours are weighted by. Where it is 0 colours count a
     * little (2^-24), so that a texel that nothing covers is the mean of its colours. Filters with
     * negative lobes let colours fade to black instead where less than 1/1024 is left of alpha.
     */
    SLUICE_BAKE_ALPHA_STRAIGHT = 1,
    /** Colours hold it already, or it is no coverage at all: channels are filtered one by one. */
    SLUICE_BAKE_ALPHA_PREMULTIPLIED = 2
} SluiceBakeAlpha;

/** What is made of a picture. Zero in any field asks for the default written beside it. */
typedef struct SluiceBakeSettings {
    /**
     * Any format but BC2, BC6H, BC7 and the signed BC4 and BC5. Of those with an sRGB twin the twin
     * is taken that the transfer asks for, whichever is named; formats without one hold linear
     * light. UNDEFINED: what fits the picture. Bytes of one channel R8, of two that are no grey and
     * alpha R8G8, else R8G8B8A8; 16-bit integers R32 for one channel, half RGBA for more; floats
     * of 16 or 32 bits as they are, one channel or four.
     * For normal maps of bytes R8G8B8A8 UNORM.
     */
    SluiceFormat format;
    SluiceBakeTransfer transfer; ///< AUTO
    SluiceBakeAlpha alpha;       ///< AUTO
    SluiceBakeFilter filter;     ///< BOX
    SluiceBakeWrap wrapX, wrapY; ///< CLAMP; also recorded as the address modes
    /** R, G and B are unit vectors, integers holding (n + 1) / 2: every level's length is 1 again.
     *  Where vectors cancel each other, (0, 0, 1). Pictures of two channels: z >= 0 is found. */
    bool normalMap;
    /** 0, or an alpha above 0 and at most 1: a cut-out's. Each level's alpha is scaled so that as
     *  many of its texels reach it as in the picture itself. Reads the picture twice. */
    float cutout;
    uint32_t compressionLevel; ///< zstd's, 1 to 22; 0: SLUICE_BAKE_DEFAULT_COMPRESSION
    bool uncompressed;
} SluiceBakeSettings;

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceBakerCreateInfo {
    uint32_t threadCount; ///< that make tiles, callers among them; 0: one per processor
    /**
     * Bytes for all pictures that are baked at a time; 0: 2^30. A picture waits until others have
     * given back enough. What the reading of a file takes is estimated, because libvips has memory
     * of its own.
     */
    uint64_t maxMemory;
    /** NULL: malloc and free. From all threads. What libvips, OpenEXRCore and libsquish need is
     *  from malloc. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< what is wrong with a file; names it
} SluiceBakerCreateInfo;

/** Threads and memory that bakes share. */
typedef struct SluiceBaker SluiceBaker;

/**
 * Starts the threads. Initialises libvips for the process and turns its cache of operations off.
 * Errors: NULL_POINTER; UNSUPPORTED if libvips does not start; OUT_OF_HOST_MEMORY, also for
 * threads. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateBaker(const SluiceBakerCreateInfo *pInfo, SluiceBaker **pBaker);

/** NULL is allowed. No call may be under way. */
SLUICE_API void sluiceDestroyBaker(SluiceBaker *baker);

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceBakeInfo {
    /** The picture; or NULL, and it is `source`. */
    const char *pInputPath;
    /** Level 0 is read, or all levels if they are block-compressed, as they are. Not owned. */
    SluiceImageSource *source;
    const char *pOutputPath; ///< required
    SluiceBakeSettings settings;
    /** Bake although a file is there that was made from this input with these settings. */
    bool force;
    void *pUserData;
    /** NULL, or called now and then on the caller's thread; false stops: CANCELLED. */
    bool (*pfnProgress)(void *pUserData, uint64_t doneTexels, uint64_t totalTexels);
} SluiceBakeInfo;

/** What became of a picture. */
typedef struct SluiceBakeReport {
    bool skipped; ///< the file was there: size, time and settings hash of its input are the same
    uint32_t width, height, mipLevelCount, arrayLayerCount;
    SluiceFormat format;
    uint64_t inputSize, outputSize; ///< bytes of the files; 0 for a source
    uint64_t replacedTexelCount;    ///< of the picture, that held a NaN, infinity or too much
    uint64_t resumedTileCount;      ///< found from an interrupted bake
    uint64_t memorySize;            ///< bytes that were set aside
} SluiceBakeReport;

/**
 * Bakes one picture into one store.
 *
 * Numbers that are none: NaN becomes 0; infinities, and what lies beyond, become +-65504, or
 * +-2^120 where 32-bit floats are stored. Level 0 is stored byte for byte where the format holds
 * the picture's samples. Pictures whose data are block-compressed (DDS, KTX2) keep all their
 * levels and need the full chain; of the settings, a transfer renames their format to its sRGB twin
 * or back, and normalMap, wraps and compression apply.
 * ICC profiles and orientation tags are not applied; CMYK, Lab and the like become sRGB.
 *
 * The file is complete under its name or not there. What an interrupted bake leaves behind, beside
 * it with ".part" added, the next one goes on with.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for values outside their ranges, and if the output is the
 *         input; FILE_NOT_FOUND, IO;
 *         CORRUPT_DATA for files that no reader can make sense of, or that are cut off;
 *         UNSUPPORTED for pictures of more than four channels or of complex numbers, formats that
 *         cannot be encoded here; LIMIT_EXCEEDED if maxMemory does not do for the picture's width;
 *         CANCELLED; OUT_OF_HOST_MEMORY. `pReport` may be NULL.
 * Thread safety: any thread, several at once, but not to the same output.
 */
SLUICE_API SluiceResult sluiceBakeFile(SluiceBaker *baker, const SluiceBakeInfo *pInfo,
                                       SluiceBakeReport *pReport);

/** What decides what the texels are, as stores record it. Any thread. */
SLUICE_API uint64_t sluiceHashBakeSettings(const SluiceBakeSettings *pSettings);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_BAKE_H */
