/**
 * Textures, variants and grids of a demand loader. Part of `sluice-vulkan`; included by demand.h.
 *
 * Thread safety, unless a function says otherwise: external on the loader.
 */
#ifndef SLUICE_DEMAND_TEXTURE_H
#define SLUICE_DEMAND_TEXTURE_H

#include <sluice/demand_types.h>
#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Filter between texels or between mip levels. Between levels only LINEAR and NEAREST.
 *
 * Shaders must define SLUICE_DEMAND_CUBIC as true to sample with CUBIC and SMART_CUBIC
 * (shaders/include/sluice/demand.glsl); otherwise sluiceDemandGrad and sluiceDemandLod sample with
 * LINEAR. docs/sampling.md compares the filters.
 */
typedef enum SluiceDemandFilter {
    SLUICE_DEMAND_FILTER_LINEAR = 0,
    SLUICE_DEMAND_FILTER_NEAREST = 1,
    SLUICE_DEMAND_FILTER_CUBIC = 2, ///< Bicubic B-spline in every level. Blurs slightly.
    /**
     * CUBIC where the texture is magnified to twice its size or more, LINEAR where it is not
     * magnified, and a blend of both between. A coarser level that stands in for a missing one
     * counts as magnified.
     */
    SLUICE_DEMAND_FILTER_SMART_CUBIC = 3
} SluiceDemandFilter;

/** Sampler of a texture. All zero: trilinear, with the source's address modes. */
typedef struct SluiceDemandSampler {
    uint32_t structSize; ///< sizeof(SluiceDemandSampler).
    /**
     * Default (0, VK_SAMPLER_ADDRESS_MODE_REPEAT): the modes that the source records, or REPEAT.
     * Modes that differ from the source's are used, and logged once per loader.
     */
    VkSamplerAddressMode addressModeU, addressModeV;
    SluiceDemandFilter filter, mipmapFilter;
    float maxAnisotropy; ///< At most 64. 0 and 1: no anisotropy.
    float lodBias;       ///< -16 to 16.
    float borderColor[4];
    bool explicitAddressModes; ///< Use the address modes above even if they are 0.
} SluiceDemandSampler;

/** Image of a texture: an existing source, or functions that open one when it is first sampled.
 * Never grows. */
typedef struct SluiceDemandImage {
    /**
     * Existing source; never closed. Its info is queried when it is first sampled. Must outlive the
     * texture. Calls that remove it wait for its reads in progress. NULL: use pfnOpen.
     */
    SluiceImageSource *source;
    /**
     * User data of pfnOpen and pfnClose. Must outlive the texture. If the texture is destroyed
     * while opening, keep it until pfnClose or loader destruction.
     */
    void *pUserData;
    /**
     * Opens the image. Called on a worker thread, never twice at the same time. Retried after
     * SLUICE_NOT_READY, SLUICE_ERROR_IO, SLUICE_ERROR_OUT_OF_HOST_MEMORY and, once,
     * SLUICE_ERROR_CORRUPT_DATA (readRetry); after any failure, when failureRetryDelayNs has
     * passed.
     * Ignored if `source` is set.
     */
    SluiceResult (*pfnOpen)(void *pUserData, SluiceImageSource **pSource);
    /**
     * Closes an image that pfnOpen opened. Called once per image, when no read of it is in
     * progress, on any thread that uses the loader. Default: sluiceDestroyImageSource.
     */
    void (*pfnClose)(void *pUserData, SluiceImageSource *source);
    /**
     * Name for messages, such as a path. Must live as long as pUserData. Default: the name in the
     * image's info, once it is open.
     */
    const char *pName;
    /**
     * Layer of the image that the texture shows. Default: 0. An image with fewer layers cannot be
     * opened. For an array add one texture per layer, and a grid of layerCount x 1 textures
     * (sluiceAddDemandGrid); they may share `source`.
     */
    uint32_t arrayLayer;
} SluiceDemandImage;

/** Settings of a texture. A field of zero selects its default. */
typedef struct SluiceDemandTextureCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceDemandTextureCreateInfo).
    SluiceDemandImage image;
    const SluiceDemandSampler *pSampler; ///< Default: trilinear, with the source's address modes.
    /**
     * Color of samples if the texture cannot be opened or a tile cannot be read. Opaque magenta
     * makes errors visible.
     */
    float failureColor[4];
    /**
     * Fills the tiles by commands in place of `image`, whose `source` and `pfnOpen` must be NULL
     * then. sluiceBeginDemandLaunch calls it (docs/producers.md). Copied. Nothing is opened or read
     * for the texture. Default: none.
     */
    const SluiceTileProducer *pProducer;
    /** Color of the last level of a produced texture, in linear light. Shaders see it where the
     *  texture covers less than a texel of that level. The producer writes the level, too. */
    float lastLevelColor[4];
} SluiceDemandTextureCreateInfo;

/**
 * Adds a texture without opening its image.
 *
 * Any format that the device samples with linear filters is allowed, if its blocks have at most 4x4
 * texels. An image of another format, without the layer, or whose info is out of range (image.h)
 * shows its failureColor once it was opened. A producer of such an image is refused at once.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for unknown modes, an
 *         anisotropy or LOD bias out of range, both an image and a producer, or a producer's image
 *         whose info is out of range; SLUICE_ERROR_UNSUPPORTED for a producer's image that the
 *         device cannot sample; SLUICE_ERROR_LIMIT_EXCEEDED above maxTextureCount;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceAddDemandTexture(SluiceDemandLoader *loader,
                                               const SluiceDemandTextureCreateInfo *pCreateInfo,
                                               SluiceDemandTextureId *pTextureId);

/**
 * Adds a texture that shares image and tiles of `baseId` and has another sampler. It is removed
 * with its base texture, or earlier.
 *
 * Errors: as sluiceAddDemandTexture; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT if `baseId` is a grid.
 */
SLUICE_API SluiceResult sluiceAddDemandTextureVariant(SluiceDemandLoader *loader,
                                                      SluiceDemandTextureId baseId,
                                                      const SluiceDemandSampler *pSampler,
                                                      SluiceDemandTextureId *pTextureId);

/** Settings of a grid: textures with one id, such as a UDIM set or the layers of an array. */
typedef struct SluiceDemandGridCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceDemandGridCreateInfo).
    uint32_t columnCount, rowCount;
    /**
     * columnCount * rowCount ids, row by row from v = 0. Read before the call returns.
     * SLUICE_NO_DEMAND_TEXTURE: an empty cell.
     */
    const SluiceDemandTextureId *pTextureIds;
    float missingColor[4]; ///< Color of samples in empty cells and outside the grid.
    /**
     * Texture of all cells together, such as a UDIM set scaled to one small image.
     * sluiceDemandUdimGrad shows it in empty cells, and wherever it is sharp enough: no cell is
     * opened or read there. Default: none.
     */
    SluiceDemandTextureId baseId;
} SluiceDemandGridCreateInfo;

/**
 * Adds a grid of textures that is sampled as one texture: column floor(u), row floor(v).
 *
 * Cells may differ in size and format. sluiceDemandUdimGrad (demand_grids.glsl) filters across the
 * edges of cells; sluiceDemandGrad and sluiceDemandLod do not. The grid does not own its textures:
 * remove them after it, or earlier, which leaves empty cells.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT for an empty grid, grids within it, or a wrong structSize;
 *         SLUICE_ERROR_LIMIT_EXCEEDED; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceAddDemandGrid(SluiceDemandLoader *loader,
                                            const SluiceDemandGridCreateInfo *pCreateInfo,
                                            SluiceDemandTextureId *pTextureId);

/**
 * Removes a texture and its variants.
 *
 * Shaders that still use it get its failureColor; in grids, the grid's missingColor. Its pages and
 * index are reused after the launches begun so far are processed.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE.
 */
SLUICE_API SluiceResult sluiceRemoveDemandTexture(SluiceDemandLoader *loader,
                                                  SluiceDemandTextureId textureId);

/**
 * Replaces the image of a texture from the next launch on.
 *
 * The old image is closed when its reads have ended. The new image is opened when it is first
 * sampled.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT for grids and variants.
 */
SLUICE_API SluiceResult sluiceReplaceDemandImage(SluiceDemandLoader *loader,
                                                 SluiceDemandTextureId textureId,
                                                 const SluiceDemandImage *pImage);

/**
 * Drops all tiles of a texture, because the texels of its image have changed. They are read again
 * when next sampled. Size and format must be unchanged. A texture that could not be opened is tried
 * again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT for grids.
 */
SLUICE_API SluiceResult sluiceInvalidateDemandTexture(SluiceDemandLoader *loader,
                                                      SluiceDemandTextureId textureId);

/**
 * Makes tiles of a produced texture again, because their content has changed.
 *
 * `pRegion` is a rectangle of a level, its array layer is ignored. NULL: all texels of level 0.
 * `mipLevelCount` levels from that level on have changed: 1 for that level alone, UINT32_MAX for
 * all coarser ones, which change where the rectangle covers them. Enlarge the rectangle if your
 * filter is wider. A mip tail is made as a whole.
 *
 * The producer is asked for resident tiles by the next launches, a quarter of maxTilesInFlight at a
 * time, and writes them in place. Launches see the old content until then, and the new one from the
 * launch on whose commands write it. If the producer answers with an error or is not ready for
 * timeoutFrames, a warning is logged and the old content stays until you call again or the tile is
 * evicted. Tiles that are being made are made again. Evicted ones are made when next sampled.
 * sluiceInvalidateDemandTexture drops the old content at once.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a texture without a producer or a
 *         rectangle beyond its level; SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed then.
 */
SLUICE_API SluiceResult sluiceRemakeDemandTiles(SluiceDemandLoader *loader,
                                                SluiceDemandTextureId textureId,
                                                const SluiceImageRegion *pRegion,
                                                uint32_t mipLevelCount);

/**
 * Allows failed work of a texture to be tried again at once: its opening, or tiles that could not
 * be read. Call it when you learn that its file can be read again.
 *
 * SLUICE_ALL_DEMAND_TEXTURES means all textures and resources. Resident tiles stay. Shaders request
 * the others in the next launches.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT for grids and SLUICE_NO_DEMAND_TEXTURE.
 */
SLUICE_API SluiceResult sluiceRetryDemandTexture(SluiceDemandLoader *loader,
                                                 SluiceDemandTextureId textureId);

/**
 * Opens a texture and loads its levels from `finestLevel` on, coarse levels first.
 *
 * Nothing is evicted for it: tiles for which memory has no room are skipped. Launches copy loaded
 * tiles, and start those that did not fit into maxTilesInFlight. So repeat "wait for the ticket,
 * launch" until remainingCount is 0. `pTicket` may be NULL.
 *
 * Errors: as sluiceInvalidateDemandTexture; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluicePreloadDemandTexture(SluiceDemandLoader *loader,
                                                   SluiceDemandTextureId textureId,
                                                   uint32_t finestLevel,
                                                   SluiceDemandTicket *pTicket);

/**
 * Opens a texture and loads the tiles that a rectangle of a level covers, of that level and of all
 * coarser ones, coarse levels first. The region's array layer is ignored.
 *
 * Enlarge the rectangle if your filter is wider. A rectangle that leaves its level is refused if
 * the texture is open; otherwise it is logged and loads nothing. Like sluicePreloadDemandTexture,
 * the call evicts nothing, and tiles that cannot be read are not tried again.
 * sluiceWaitDemandRegion (demand_query.h) waits for the rectangle.
 *
 * Errors: as sluicePreloadDemandTexture; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for an
 *         empty rectangle.
 */
SLUICE_API SluiceResult sluicePreloadDemandRegion(SluiceDemandLoader *loader,
                                                  SluiceDemandTextureId textureId,
                                                  const SluiceImageRegion *pRegion,
                                                  SluiceDemandTicket *pTicket);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DEMAND_TEXTURE_H */
