/**
 * Textures of a streamer, from files or from producers. Part of `sluice-vulkan`; included by
 * vulkan.h.
 *
 * Thread safety, unless a function says otherwise: external on the streamer.
 */
#ifndef SLUICE_VULKAN_TEXTURE_H
#define SLUICE_VULKAN_TEXTURE_H

#include <sluice/image.h>
#include <sluice/manager.h>
#include <sluice/vulkan_device.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Streams textures on a device (vulkan.h). */
typedef struct SluiceVulkanStreamer SluiceVulkanStreamer;

/** Texels that a producer writes: a tile, or a level of the mip tail. Never grows. */
typedef struct SluiceTileTarget {
    SluiceImageRegion region; ///< Texels of the texture: level, rectangle and array layer.
    uint32_t x, y;            ///< Where the rectangle begins in the level of the image.
    uint32_t layer;           ///< Array layer of the image.
} SluiceTileTarget;

/**
 * Tiles to be written by commands of the application. All lie in one level of one image. Pointers
 * are valid during the call.
 */
typedef struct SluiceTileBatch {
    uint32_t structSize;           ///< Set by Sluice. sizeof(SluiceTileBatch).
    SluiceTextureId textureId;     ///< Of a demand loader: SluiceDemandTextureId.
    VkCommandBuffer commandBuffer; ///< Of sluiceBeginStreamingFrame or sluiceBeginDemandLaunch.
    uint64_t frameIndex;           ///< SluiceStreamingFrame.frameIndex, or launchIndex.
    /** In VK_IMAGE_LAYOUT_GENERAL. In paged mode it holds pages of several textures. */
    VkImage image;
    /**
     * 2D array view: all layers of `mipLevel` only. For storage image descriptors. VK_NULL_HANDLE
     * if the device cannot store to images of the format (sRGB and compressed formats): use
     * transfers.
     */
    VkImageView imageView;
    uint32_t mipLevel; ///< Level of `image`. Not the level of the texture, which is in `region`.
    uint32_t tileCount;
    const SluiceTileTarget *pTiles;
    /** Texels of `mipLevel` of `image`. A copy of compressed blocks ends at a whole block, or
     * there.
     */
    uint32_t levelWidth, levelHeight;
} SluiceTileBatch;

/**
 * Fills tiles of a texture by commands on the GPU. Takes the place of an image source.
 *
 * docs/producers.md explains it with code.
 */
typedef struct SluiceTileProducer {
    uint32_t structSize; ///< sizeof(SluiceTileProducer).
    /**
     * Required. Describes the texture. A mipLevelCount of 0 means the full chain. Copied; pName
     * must outlive the texture.
     */
    const SluiceImageInfo *pImage;
    void *pUserData;
    /**
     * Required. Records commands that write every texel of the tiles of a batch.
     *
     * sluiceBeginStreamingFrame calls it, on its thread and outside a render pass, once per image
     * and level. All batches of a frame together hold at most tilesPerFrame tiles, and mip tails.
     * Barriers before and after are the streamer's: compute and transfer commands may write. Write
     * a batch by one dispatch, or by copies: the streamer orders batches, not commands of a batch.
     *
     * On entry `pResults` holds SLUICE_SUCCESS for each tile. Set another value for tiles that are
     * not recorded. The returned value counts for all tiles unless it is SLUICE_SUCCESS. Values:
     * - SLUICE_SUCCESS: the tile is shown when this frame is complete.
     * - SLUICE_NOT_READY: the tile is asked for again in later frames. It has failed after
     *   timeoutFrames, or when more than half of maxLoadsInFlight is in use.
     * - An error: the tile has failed. Coarser levels stay on screen, and the tile is retried like
     *   a failed read (manager.h).
     *
     * For tiles that are not recorded, no command may write to their target. The same tile can be
     * asked for again: after eviction, and if its frame was abandoned. The callback must not call
     * functions of the streamer or its manager. It is not called again for a texture after
     * sluiceRemoveVulkanTexture; commands that it recorded earlier may still be executing.
     */
    SluiceResult (*pfnRecordTiles)(void *pUserData, const SluiceTileBatch *pBatch,
                                   SluiceResult *pResults);
    /** Frames in which a tile may answer SLUICE_NOT_READY before it has failed. Default: 64. */
    uint32_t timeoutFrames;
} SluiceTileProducer;

/**
 * Filter within a level. Levels are always filtered linearly.
 *
 * Shaders must define SLUICE_CUBIC as true to sample with CUBIC and SMART_CUBIC
 * (shaders/include/sluice/sample.glsl); otherwise sluiceSample and sluiceSampleGrad sample with
 * LINEAR. Feedback marks the wider footprint in any case. docs/sampling.md compares the filters.
 */
typedef enum SluiceTextureFilter {
    SLUICE_TEXTURE_FILTER_LINEAR = 0,
    SLUICE_TEXTURE_FILTER_CUBIC = 1, ///< Bicubic B-spline in every level. Blurs slightly.
    /**
     * CUBIC where the texture is magnified to twice its size or more, LINEAR where it is not
     * magnified, and a blend of both between. Where fine levels are not resident yet, the level
     * that is shown counts as magnified.
     */
    SLUICE_TEXTURE_FILTER_SMART_CUBIC = 2
} SluiceTextureFilter;

/** Settings of a texture. A field of zero selects its default. */
typedef struct SluiceVulkanTextureCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceVulkanTextureCreateInfo).
    /**
     * Required, unless pProducer is set. Must outlive the texture, and reads in progress when the
     * texture is removed. sluiceWaitVulkanStreamerIdle and sluiceDestroyVulkanStreamer end those
     * reads.
     */
    SluiceImageSource *source;
    SluiceTextureId primaryId; ///< Texture whose feedback this one follows, or SLUICE_NO_TEXTURE.
    /**
     * Address modes of the samplers used with this texture; SluiceVulkanTexture returns them.
     * Default (0, VK_SAMPLER_ADDRESS_MODE_REPEAT): the modes that the source records, or REPEAT.
     * Modes that differ from the source's are used, and logged once per streamer.
     */
    VkSamplerAddressMode addressModeU, addressModeV;
    bool explicitAddressModes; ///< Use the address modes above even if they are 0.
    /**
     * Anisotropy of its sampler, at most 16. The device's maxSamplerAnisotropy is used if lower,
     * and 1 if the format has no linear filter; SluiceVulkanTexture returns the value used. Above 1
     * requires the feature samplerAnisotropy. Default: 1, none.
     */
    float maxAnisotropy;
    /** Fills the tiles in place of `source`, which must be NULL then. Copied. Default: none. */
    const SluiceTileProducer *pProducer;
    /**
     * The layers are faces of cube maps, as if SluiceImageInfo.cube of the image were set. Address
     * modes are ignored: samples cross the edges of faces. Default: as the image says.
     */
    bool cube;
    /**
     * Filter of its samples; the sampler is linear in any case. LINEAR is used if the format has no
     * linear filter; SluiceVulkanTexture returns the filter used. Cube maps must have LINEAR.
     * sample_array.glsl samples the layers of arrays with LINEAR. If a texture follows a primary,
     * give the primary a bicubic filter, too: its feedback counts. Default: LINEAR.
     */
    SluiceTextureFilter filter;
    /**
     * Mode of this texture. SluiceVulkanTexture returns the mode used. Shaders sample all of them
     * alike. Values:
     * - AUTO: the streamer's mode. If that was left to AUTO, too, textures whose level 0 fits into
     *   a tile of 64 KiB are dense: there is nothing to stream, and their images share memory. With
     *   pagedTextures, textures that sparse mode cannot stream are paged.
     * - DENSE: an ordinary image of all levels, in a streamer of any mode. In other streamers than
     *   dense ones it is loaded as a whole when it is added, and by maxLoadsInFlight reads of
     *   64 KiB at most.
     * - SPARSE, PAGED: that mode, which must be the streamer's. With pagedTextures a sparse
     * streamer has PAGED, too.
     *
     * Default: AUTO.
     */
    SluiceResidencyMode residencyMode;
    /** Transform of uv, as in sluiceSetVulkanUvTransform (vulkan_control.h). Copied. Default: none.
     */
    const SluiceUvTransform *pUvTransform;
    /**
     * The image has VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT: you may make views of other formats of
     * SluiceVulkanTexture.image, for example UNORM beside SRGB. The formats must be compatible with
     * the image's as in Vulkan. Destroy your views before you remove the texture.
     *
     * Not for textures in paged mode, whose texels lie in images of pages. Such textures are never
     * forgotten (forgetTextures). Default: false.
     */
    bool mutableFormat;
    /**
     * Formats of all views that you make (VkImageFormatListCreateInfo); some devices sample faster
     * if they know them. At most 16, and not the format of the image, which is added. Sets
     * mutableFormat. Default: none, any compatible format.
     */
    const VkFormat *pViewFormats;
    uint32_t viewFormatCount;
} SluiceVulkanTextureCreateInfo;

/** Texture as the application draws with it. Never grows. */
typedef struct SluiceVulkanTexture {
    SluiceTextureId textureId;
    /**
     * Image, in VK_IMAGE_LAYOUT_GENERAL from the next frame on: some parts are copied to while
     * others are sampled. Validation layers may warn that this is slow. In paged mode it holds only
     * the packed levels, so textureSize() is not the texture's size.
     */
    VkImage image;
    VkImageView imageView; ///< 2D, all levels of `image`, layer `arrayLayer` only.
    VkFormat format;
    uint32_t width, height, mipLevelCount;
    uint32_t tableIndex;   ///< Index in the texture table, for the shader functions.
    uint32_t arrayLayer;   ///< Layer of `image`.
    VkImageView arrayView; ///< 2D_ARRAY, all layers and levels. VK_NULL_HANDLE if not an array.
    VkSamplerAddressMode addressModeU, addressModeV; ///< Modes of its sampler.
    float maxAnisotropy; ///< Of its sampler, 1 to 16. Pass it to the shader functions.
    /**
     * CUBE, all levels of the six faces of its cube. The faces of a cube have the same one.
     * VK_NULL_HANDLE if it is not a face.
     */
    VkImageView cubeView;
    /**
     * CUBE_ARRAY, all cubes and levels. VK_NULL_HANDLE for a single cube, or if the device lacks
     * the feature imageCubeArray.
     */
    VkImageView cubeArrayView;
    SluiceTextureFilter filter; ///< Filter of its samples.
    /** SPARSE, PAGED or DENSE. DENSE, in a streamer of any mode, for images that have all levels.
     *  PAGED, in a sparse streamer, for textures beside its own (pagedTextures). */
    SluiceResidencyMode residencyMode;
} SluiceVulkanTexture;

/**
 * Adds a texture: creates the image of a source or producer and starts to stream it. The source, or
 * SluiceTileProducer.pImage, determines the format.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for both a source and a
 *         producer, an unknown address mode or filter, a primary that follows another texture, or
 * an image whose info is out of range (image.h), for example without a level that fits into a tile;
 *         SLUICE_ERROR_UNKNOWN_TEXTURE and SLUICE_ERROR_STALE_TEXTURE for the primary;
 *         SLUICE_ERROR_UNSUPPORTED if the device cannot stream the format or size, for a
 *         residencyMode that the streamer does not have, or for mutableFormat in paged mode;
 *         SLUICE_ERROR_LIMIT_EXCEEDED above maxTextureCount, maxRegionCount or
 *         feedbackReadbackSize; errors of the source; SLUICE_ERROR_OUT_OF_HOST_MEMORY;
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN.
 */
SLUICE_API SluiceResult sluiceAddVulkanTexture(SluiceVulkanStreamer *streamer,
                                               const SluiceVulkanTextureCreateInfo *pCreateInfo,
                                               SluiceVulkanTexture *pTexture);

/**
 * Adds a source or producer with `layerCount` array layers. `pLayers` receives one texture per
 * layer.
 *
 * Each layer is a streamed texture with its own id, feedback and MinMip map. Their table indices
 * are consecutive, and all are layers of one image. Removing one of them removes all.
 *
 * Cube maps (SluiceImageInfo.cube, SluiceVulkanTextureCreateInfo.cube) have six layers each, the
 * faces. shaders/include/sluice/sample_cube.glsl samples cubeView and cubeArrayView. If the device
 * has the feature imageCubeArray, enable it for more than one cube. sluiceRequireVulkanFeatures
 * does. Devices without it have no cubeArrayView.
 *
 * shaders/include/sluice/sample_array.glsl samples arrayView. In paged mode the image and arrayView
 * hold only the packed levels of all layers; the tiles of each layer are pages of its own.
 *
 * Errors: as sluiceAddVulkanTexture; SLUICE_ERROR_INVALID_ARGUMENT if the source has another number
 *         of layers, or for cube maps whose faces are not square or whose layers are no multiple of
 *         6; SLUICE_ERROR_UNSUPPORTED if the device does not support arrays of so many layers or,
 *         in sparse mode, binds all layers of such a small array at once, or for cube maps in
 *         sparse mode without SluiceVulkanDeviceCapabilities.sparseCubes.
 */
SLUICE_API SluiceResult sluiceAddVulkanTextureArray(
    SluiceVulkanStreamer *streamer, const SluiceVulkanTextureCreateInfo *pCreateInfo,
    uint32_t layerCount, SluiceVulkanTexture *pLayers);

/**
 * Removes a texture. Do not draw with it again. The image is destroyed when the frames begun so far
 * have completed; until then it counts towards maxTextureCount.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_UNKNOWN_TEXTURE, SLUICE_ERROR_STALE_TEXTURE.
 */
SLUICE_API SluiceResult sluiceRemoveVulkanTexture(SluiceVulkanStreamer *streamer,
                                                  SluiceTextureId textureId);

/**
 * Gets a sampler for a texture: trilinear, without LOD bias, all levels, with the texture's address
 * modes and maxAnisotropy. Border: transparent black. Formats that the device does not filter
 * linearly (SluiceVulkanFormatCapabilities) get a sampler of NEAREST texels and NEAREST levels.
 *
 * Textures of one kind share a sampler. The streamer owns it; it lives as long as the streamer.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN.
 */
SLUICE_API SluiceResult sluiceGetVulkanSampler(SluiceVulkanStreamer *streamer,
                                               SluiceTextureId textureId, VkSampler *pSampler);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_TEXTURE_H */
