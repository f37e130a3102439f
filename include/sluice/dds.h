/**
 * DDS files as image sources: what is in the file is what is delivered. Link `sluice-container`.
 */
#ifndef SLUICE_DDS_H
#define SLUICE_DDS_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceDdsImageSourceCreateInfo {
    const char *pPath; ///< required; copied
    /**
     * UNDEFINED: the file's. Otherwise another name for the same bytes: UNORM for SRGB and the
     * reverse, since only files with a DX10 header tell them apart, or BC1_RGB for BC1_RGBA.
     */
    SluiceFormat format;
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free
    SluiceLogCallback log;                       ///< what is wrong with a file, and where
} SluiceDdsImageSourceCreateInfo;

/**
 * Names a file. It is opened at the first sluiceGetImageInfo or sluiceReadImageRegion and stays
 * open: a source that nobody asks costs no descriptor and no read.
 *
 * | in the file                                                      | delivered              |
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
 * BGRA is turned into RGBA as it is read, unused bits are an alpha of 1; all else is delivered as
 * it is. The pitch in the header is not looked at: rows are packed, as every writer has them.
 * Arrays come as layers, cube maps as six of them, in the order +X, -X, +Y, -Y, +Z, -Z. At most
 * 2^20 texels in a direction, 2^16 layers.
 *
 * The chain must be full, down to one texel, because coarse levels are what streaming falls back
 * to. A file that ends earlier is UNSUPPORTED: write it again with all levels (texconv -m 0,
 * nvcompress without -nomips).
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for unknown formats; OUT_OF_HOST_MEMORY.
 *         From the first query or read on: FILE_NOT_FOUND, IO; CORRUPT_DATA for headers that
 *         contradict themselves and files shorter than they say; UNSUPPORTED for other formats, a
 *         `format` of other bytes, incomplete chains and cube maps, volumes, 1D textures. Each is
 *         logged with the file's name and what to do; the next call tries again.
 * Thread safety: any thread.
 * Source: Microsoft, "Programming Guide for DDS".
 */
SLUICE_API SluiceResult sluiceCreateDdsImageSource(const SluiceDdsImageSourceCreateInfo *pInfo,
                                                   SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DDS_H */
