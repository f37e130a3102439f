/**
 * DDS files as image sources. Texels are returned as stored. Link `sluice-container`.
 */
#ifndef SLUICE_DDS_H
#define SLUICE_DDS_H

#include <sluice/image.h>
#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Settings of a source. A field of zero selects its default. */
typedef struct SluiceDdsImageSourceCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceDdsImageSourceCreateInfo).
    const char *pPath;   ///< Required without pInput. Copied.
    /**
     * Format to return. Default: the file's. Another value must name the same bytes: UNORM for SRGB
     * or the reverse (only DX10 headers distinguish them), or BC1_RGB for BC1_RGBA.
     */
    SluiceFormat format;
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;                       ///< Problems of a file, with their position.
    /** Reads these bytes instead of the file (input.h). Copied, but not the bytes. pPath is then a
     *  name for messages and may be NULL. Default: NULL, the file. */
    const SluiceInput *pInput;
    /** Pool that opens and closes the file as it is read (input.h). Must outlive the source. Not
     *  used with pInput. Default: NULL, the file stays open. */
    SluiceFilePool *filePool;
} SluiceDdsImageSourceCreateInfo;

/**
 * Creates a source for a file, without opening it. The first sluiceGetImageInfo or
 * sluiceReadImageRegion opens the file; it stays open, unless it has a filePool. An unused source
 * costs no file descriptor.
 *
 * | in the file                                                      | returned               |
 * |------------------------------------------------------------------|------------------------|
 * | DXT1                                                             | BC1_RGBA_UNORM         |
 * | DXT2, DXT3; DXT4, DXT5 (2 and 4: premultiplied, and left so)     | BC2_UNORM; BC3_UNORM   |
 * | ATI1, BC4U, BC4S; ATI2, BC5U, BC5S                               | BC4, BC5, UNORM, SNORM |
 * | D3D's number of a 16- or 32-bit float format of 1, 2, 4 channels | that                   |
 * | masks of 8 bits: R; R and G; RGBA, BGRA; RGB, BGR with 8 unused  | R8, R8G8, R8G8B8A8     |
 * | luminance of 8 bits; with alpha                                  | R8; R8G8               |
 * | DX10 header with DXGI's name of any SluiceFormat                 | that                   |
 * | the same with B8G8R8A8 or B8G8R8X8                               | R8G8B8A8               |
 *
 * BGRA is converted to RGBA when read, and unused bits become an alpha of 1. Everything else is
 * returned as stored. The pitch in the header is ignored: rows are packed, as every writer does.
 * Arrays become layers. Cube maps become six layers, and set SluiceImageInfo.cube. At most 2^20
 * texels in width and height, and 2^16 layers.
 *
 * A file may have any number of levels; mipLevelCount says how many. SluiceImageInfo says how many
 * streaming requires. sluiceCreateCompleteChainSource adds missing levels of uncompressed formats.
 * Write files of BC formats with all levels (texconv -m 0, nvcompress without -nomips).
 *
 * Queries and reads return SLUICE_NOT_READY while the process has too few file descriptors to open
 * the file. Sluice leaves the last 16 below the soft limit to others.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for an unknown format and a
 *         pInput whose size is out of range; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Errors of queries and reads: SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO;
 *         SLUICE_ERROR_CORRUPT_DATA for contradictory headers and truncated files;
 *         SLUICE_ERROR_UNSUPPORTED for other formats, a `format` of different bytes, incomplete
 *         cube maps, volumes, 1D textures. Each error is logged once, at most 16 per file, with the
 *         file's name and a remedy. The next call tries again.
 * Thread safety: any thread.
 * Source: Microsoft, "Programming Guide for DDS".
 */
SLUICE_API SluiceResult sluiceCreateDdsImageSource(const SluiceDdsImageSourceCreateInfo *pInfo,
                                                   SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DDS_H */
