/**
 * Streams textures on a Vulkan device. Link `sluice-vulkan`. Only headers whose names begin with
 * `vulkan`, demand.h, neural_compress.h and neural_paths.h include Vulkan. vulkan_control.h
 * controls single textures.
 *
 * The application owns instance, device, queues and command buffers, and draws. A streamer owns the
 * streamed images, the buffers for feedback, MinMip maps and the texture table, a manager
 * (manager.h) and a tile loader (loader.h). Shaders use the functions of shaders/include/sluice.
 *
 * A frame:
 *
 *     sluiceBeginStreamingFrame(streamer, commandBuffer, timeStamp, &frame);
 *     ... draw: shaders sample and write feedback ...
 *     sluiceEndStreamingFrame(streamer, commandBuffer);
 *     vkQueueSubmit: signal frame.semaphore with frame.signalValue
 *
 * Abandon a frame that you cannot submit with sluiceAbandonStreamingFrame. The streamer records the
 * barriers for its own images and buffers; you need none for them. docs/frame-loop.md explains each
 * step; docs/examples/vulkan.c is a program, with its plain Vulkan in docs/examples/gpu.c.
 *
 * Only sluiceDestroyVulkanStreamer and sluiceWaitVulkanStreamerIdle wait for the GPU. Both wait for
 * work of the streamer alone.
 *
 * Thread safety, unless a function says otherwise: external on the streamer; during
 * sluiceBeginStreamingFrame also on the sparse queue.
 */
#ifndef SLUICE_VULKAN_H
#define SLUICE_VULKAN_H

#include <sluice/image.h>
#include <sluice/loader.h>
#include <sluice/manager.h>
#include <sluice/replay.h>
#include <sluice/vulkan_context.h>
#include <sluice/vulkan_device.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceVulkanStreamer SluiceVulkanStreamer;

/** Encoding of feedback. Shaders must define SLUICE_FEEDBACK_ENCODING accordingly. */
typedef enum SluiceFeedbackEncoding {
    SLUICE_FEEDBACK_ENCODING_LEVELS = 0, ///< A word per region: the finest level.
    SLUICE_FEEDBACK_ENCODING_MASKS = 1   ///< Half a word per region: a bit per level.
} SluiceFeedbackEncoding;

/** Array of all textures in the descriptor sets of frames, for shaders that choose a texture by
 * number. */
typedef enum SluiceTextureArray {
    SLUICE_TEXTURE_ARRAY_NONE = 0,
    SLUICE_TEXTURE_ARRAY_COMBINED = 1, ///< Combined image samplers (sampler2D).
    /**
     * Images (texture2D), and one sampler per kind of texture. For devices with few samplers per
     * shader stage. At most 15 kinds (SLUICE_SAMPLER_COUNT).
     */
    SLUICE_TEXTURE_ARRAY_SEPARATE = 2
} SluiceTextureArray;

/** Switches for tests and measurements. Zero is normal use. */
typedef struct SluiceVulkanStreamerDebugInfo {
    uint32_t structSize; ///< sizeof(SluiceVulkanStreamerDebugInfo).
    /**
     * Every tile is always wanted. Makes the fully resident picture that streamed pictures are
     * compared with. Requires memory for all tiles, and reads no feedback back.
     */
    bool mapEverything;
    /**
     * Reads back whole feedback maps rather than what changed in them. Decisions are the same.
     * Shows what reading back changes saves.
     */
    bool wholeFeedbackMaps;
    /**
     * Format that sparse mode does not stream, as on a device that has no sparse images of it. For
     * streamers with pagedTextures. SLUICE_FORMAT_UNDEFINED: none.
     */
    SluiceFormat notSparse;
} SluiceVulkanStreamerDebugInfo;

/** Settings of a streamer. A field of zero selects its default. */
typedef struct SluiceVulkanStreamerCreateInfo {
    uint32_t structSize;               ///< sizeof(SluiceVulkanStreamerCreateInfo).
    SluiceVulkanContext *context;      ///< Required. Must outlive the streamer.
    SluiceResidencyMode residencyMode; ///< Default: AUTO.
    uint32_t framesInFlight;           ///< 1 to 16. Default: 3.
    uint32_t maxTextureCount;          ///< 1 to 2^20. Default: 1024.
    uint32_t texturesPerFrame;         ///< Feedback maps read back per frame. Default: 10.
    /** Most tiles mapped, uploaded and produced per frame. 1 to 2^14. Default: 256. */
    uint32_t tilesPerFrame;
    uint32_t maxLoadsInFlight; ///< 1 to 2^16. Default: 4 * tilesPerFrame, at least 64.
    /** Tiles per heap, 1 to 2^20. Default: 256 (16 MiB). Made smaller, with a warning, if the
     *  device's limits or the context's memoryBudget allow no heap of that size. */
    uint32_t heapTileCapacity;
    uint32_t maxHeapCount; ///< Default: as many as fit into device memory.
    /**
     * Tiles that stay resident after they are no longer requested. They are evicted first when
     * memory is short. Default: 1024 (64 MiB). For none, set noStandbyTiles.
     */
    uint32_t numExtraStandbyTiles;
    /**
     * Time a region stays requested after a map last requested it. In time stamps
     * (ticksPerSecond). Default: 1 s. UINT64_MAX: forever. For no time, set
     * newestFeedbackMapOnly.
     */
    uint64_t feedbackTimeoutTicks;
    /**
     * Time from a tile's first failed load to the second try, in time stamps. Doubles each time
     * (manager.h). Default: 0.25 s. 1: as soon as possible.
     */
    uint64_t retryDelayTicks;
    uint32_t maxRegionCount; ///< Feedback regions (tiles of level 0), 4 to 2^28. Default: 2^20.
    /**
     * Bytes of resolved feedback read back per frame. A texture takes 4 bytes per region that
     * changed since its last turn, at most 1 byte per region of the texture. Textures that do not
     * fit keep their marks and come first in a later frame. Must hold the map of any one texture.
     * Default: maxRegionCount, at most 2^22; with maxRegionCount everything fits.
     */
    uint32_t feedbackReadbackSize;
    SluiceFeedbackEncoding feedbackEncoding;
    /**
     * Shaders that define SLUICE_FEEDBACK_TURN_WORD write feedback only for textures that are
     * resolved in the same frame. For other textures feedback costs one load and no arithmetic.
     *
     * The cost is latency. With N textures that are not in a set, a texture collects marks in one
     * frame of N / texturesPerFrame. Details that few pixels see are noticed later by that factor,
     * and feedbackTimeoutTicks must be longer by it. Best if every visible pixel writes. Avoid an
     * even N / texturesPerFrame: some corners of sluiceWriteQuadFeedback and some pixels of the
     * lattice then never have a turn (docs/trade-offs.md).
     */
    bool feedbackInTurns;
    /**
     * Most distinct tiles ever bound in existing images (SluiceVulkanDeviceCapabilities). Finer
     * tiles beyond it are not loaded. All streamers of a process share the device's limit. Default:
     * maxTouchedTiles of the device.
     */
    uint32_t maxTouchedTiles;
    /**
     * Time in which a region becomes one level sharper after finer tiles became resident. Avoids
     * popping; steps are 1/256 level. In time stamps, at most 2^40. Default: 0, at once. A tenth of
     * a second is hardly noticeable. Regions become coarser at once, because their tiles are
     * evicted; unless memory is short, such tiles were not in view.
     */
    uint64_t residencyFadeTicks;
    /**
     * Unit of time stamps and of all times in this struct. At most 10^12. Default: 10^9
     * (nanoseconds). If your time stamps count frames, set the frames per second; otherwise each
     * default time is millions of frames long (a warning is logged after 256 frames).
     */
    uint64_t ticksPerSecond;
    /**
     * Only a texture's newest map counts, so stochastic feedback evicts tiles that one map misses.
     * Requires feedbackTimeoutTicks 0.
     */
    bool newestFeedbackMapOnly;
    bool noStandbyTiles; ///< Evict unwanted tiles at once. Requires numExtraStandbyTiles 0.
    /**
     * Time until given-up tiles of a texture are tried again: a few first, and all when one loads
     * (manager.h). In time stamps. Default: 30 s. UINT64_MAX: never. If you know that a source
     * works again, call sluiceRetryVulkanSource.
     */
    uint64_t givenUpRetryDelayTicks;
    /**
     * Load packed levels when a map first requests their texture, and evict them like tiles when
     * nothing of it is wanted. Default: false, load them when the texture is added and keep them.
     *
     * Saves memory and reads for textures that are never seen: heaps in sparse mode, reads in all
     * modes (docs/frame-loop.md has figures). The cost: when a texture is first seen it shows its
     * fallback color for some frames (SLUICE_MIP_UNTOUCHED), as it does just after it was added.
     */
    bool packedLevelsOnDemand;
    /**
     * Whether the descriptor sets of frames have an array of all textures. It has maxTextureCount
     * elements; the index is SluiceVulkanTexture.tableIndex, also for layers of arrays. A second
     * array has the cube views of all cube maps (sample_cube.glsl), maxTextureCount / 6 rounded up.
     * Requires the features shaderSampledImageArrayNonUniformIndexing and runtimeDescriptorArray,
     * which sluiceRequireVulkanFeatures enables if available. Shaders define SLUICE_TEXTURE_ARRAY
     * (bindings.glsl). Default: none.
     */
    SluiceTextureArray textureArray;
    const SluiceVulkanStreamerDebugInfo *pDebug; ///< Copied. NULL in normal use: all off.
    /**
     * A sparse streamer also takes textures that only paged mode can stream, because the device has
     * no sparse images of their format or size. Paged and dense streamers ignore it.
     *
     * Shaders that sample such a streamer define SLUICE_PAGED and SLUICE_PAGED_PER_TEXTURE
     * (buffers.glsl). The cost without such textures: the page table, 8 bytes of device memory and
     * as much host memory per region of maxRegionCount. A tile of a paged texture takes a slot of a
     * heap, too, so memory for two tiles. Default: false, these textures are refused.
     */
    bool pagedTextures;
    /**
     * Forget textures that nothing samples, when memory is short: the one that was sampled longest
     * ago first. Image, views, tiles and mip tail go. Shaders then show SLUICE_FALLBACK_COLOR, and
     * feedback brings the texture back.
     *
     * Textures have no image before they are sampled for the first time, so more can be added than
     * fit into memory. Requires textureArray, whose elements follow: SluiceVulkanTexture.image and
     * imageView are VK_NULL_HANDLE. Turns packedLevelsOnDemand on. Default: false.
     *
     * Arrays, cube maps, textures with a producer or an integer format, and textures of sets stay.
     */
    bool forgetTextures;
    /**
     * Forget textures that no map has requested for so many frames, also while there is memory.
     * Requires forgetTextures. Default: 0, only when memory is short.
     */
    uint32_t forgetAfterFrames;
    /**
     * Most feedback maps that a frame can read back: the limit of texturesPerFrame, framesPerRound
     * and sluiceResolveAllVulkanTextures. Takes 56 bytes of memory per map and
     * frame in flight. Default: texturesPerFrame.
     */
    uint32_t maxTexturesPerFrame;
    /**
     * Read back more than texturesPerFrame maps per frame if otherwise some texture would not have
     * its turn in so many frames. maxTexturesPerFrame still limits them. Default: 0, never.
     */
    uint32_t framesPerRound;
    /**
     * The buffers of SluiceVulkanBuffers have VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT:
     * sluiceGetVulkanBuffers returns their addresses, for shaders that read by address and for
     * descriptor buffers. Requires the feature bufferDeviceAddress, enabled. Default: false.
     */
    bool bufferDeviceAddress;
} SluiceVulkanStreamerCreateInfo;

/**
 * Creates a streamer. Errors are logged to the context.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER without a context, or in sparse mode if the context has no
 *         sparseQueue; SLUICE_ERROR_INVALID_ARGUMENT for values out of range, and for
 *         a setting together with the one that turns it off; SLUICE_ERROR_UNSUPPORTED if the device
 *         does not support the requested mode, or has no bufferDeviceAddress that is asked for;
 *         SLUICE_ERROR_LIMIT_EXCEEDED if maxTextureCount,
 *         maxRegionCount, maxTexturesPerFrame or feedbackReadbackSize require a storage buffer
 * above the device's maxStorageBufferRange, or if textureArray needs more images or samplers per
 *         shader stage than the device has; SLUICE_ERROR_OUT_OF_HOST_MEMORY;
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateVulkanStreamer(
    const SluiceVulkanStreamerCreateInfo *pCreateInfo, SluiceVulkanStreamer **pStreamer);

/**
 * Waits for its own frames, sparse binds and reads, then destroys the streamer and everything it
 * owns. Does not wait for other work of the device. NULL is allowed.
 *
 * Frames that were not ended, or were abandoned, are not waited for. Submit or abandon every frame
 * that you ended: otherwise destruction logs a warning after 5 seconds without progress, and calls
 * vkDeviceWaitIdle.
 *
 * Thread safety: external on `streamer`. On all queues of the device if an ended frame was neither
 * submitted nor abandoned.
 */
SLUICE_API void sluiceDestroyVulkanStreamer(SluiceVulkanStreamer *streamer);

/**
 * Settings of a streamer that can change while it runs. They mean what the fields of the
 * create-info mean, but zero is a value here, and never selects a default.
 */
typedef struct SluiceVulkanStreamerSettings {
    uint32_t structSize;             ///< Required. sizeof(SluiceVulkanStreamerSettings).
    uint32_t texturesPerFrame;       ///< 1 to maxTexturesPerFrame of the create-info.
    uint32_t tilesPerFrame;          ///< 1 to 2^14. Changing it allocates host memory.
    uint32_t numExtraStandbyTiles;   ///< 0: evict unwanted tiles at once.
    uint32_t maxHeapCount;           ///< 0: as many as fit into memory.
    uint64_t feedbackTimeoutTicks;   ///< 0: only a texture's newest map counts.
    uint64_t residencyFadeTicks;     ///< 0 to 2^40.
    uint64_t retryDelayTicks;        ///< 0: as soon as possible.
    uint64_t givenUpRetryDelayTicks; ///< 0: 120 times retryDelayTicks. UINT64_MAX: never.
    bool noEviction; ///< Requests wait for free memory instead of evicting resident tiles.
    bool noMipBias;  ///< Never request coarser levels because more is wanted than memory holds.
    uint32_t framesPerRound; ///< 0: texturesPerFrame alone says how many maps are read back.
    /**
     * Requested tiles wait, mip tails of new textures too: frames start no load until the setting
     * is false again, except those that sluiceStepVulkanLoads asks for. Tiles whose loads have
     * started still become resident. Restoring a tile from standby counts as a load. For debugging
     * tools: waits for requests ask for frames without end meanwhile.
     */
    bool holdLoads;
} SluiceVulkanStreamerSettings;

/**
 * Gets the settings in use, or those last set. Set structSize first.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetVulkanStreamerSettings(const SluiceVulkanStreamer *streamer,
                                                        SluiceVulkanStreamerSettings *pSettings);

/**
 * Changes all settings. Get them, change fields, and set them. They take effect when the next frame
 * begins; the frame that is being recorded keeps its own. Recordings of the manager hold what
 * changes of its configuration.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a value
 *         out of range or a wrong structSize; SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed
 *         after an error.
 */
SLUICE_API SluiceResult sluiceSetVulkanStreamerSettings(
    SluiceVulkanStreamer *streamer, const SluiceVulkanStreamerSettings *pSettings);

/**
 * Lets `tileCount` requested tiles start to load although loads are held (holdLoads), in the usual
 * order, at most tilesPerFrame per frame. Calls add up, at most to UINT32_MAX, and count for tiles
 * that are requested later, too. Setting holdLoads to false forgets the rest. Does nothing while
 * loads are not held.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceStepVulkanLoads(SluiceVulkanStreamer *streamer, uint32_t tileCount);

/**
 * Moves at most `maxTileCount` tiles together, so that memory can be freed. Writes the number of
 * moved tiles to `*pTileCount`; 0 means that nothing is left to do.
 *
 * Call it between frames, for example before each frame while the view stands still. The heap
 * or image with the fewest tiles is emptied, if there is room for its tiles elsewhere. Equal tiles
 * that share a page move together and count once.
 *
 * - Sparse mode: a heap. Its standby tiles are evicted. Its wanted tiles are read again; until then
 *   shaders see a coarser level. Heaps with packed tiles stay.
 * - Paged mode: an image of pages. The next frame copies the tiles on the GPU, at most 64, and
 *   shaders see no difference. Tiles that frames under way copy move later. Images stay if another
 *   front end shows any of their pages.
 * - Dense mode: nothing moves.
 *
 * Empty heaps and images are freed in later frames, when the GPU has finished with them. While
 * more memory is in use than the budget allows (sluiceSetVulkanMemoryBudget), frames move tiles and
 * free memory by themselves.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceCompactVulkanStreamer(SluiceVulkanStreamer *streamer,
                                                    uint32_t maxTileCount, uint32_t *pTileCount);

/**
 * Reads back the feedback of all textures as soon as possible: call it before the first frame after
 * a camera cut.
 *
 * Frames that begin later read back up to maxTexturesPerFrame maps each, until every texture had
 * its turn once. If maxTexturesPerFrame is at least the number of textures that do not follow
 * another one, one frame does. Bytes are limited by feedbackReadbackSize as always: maps that do
 * not fit come first in a later frame.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceResolveAllVulkanTextures(SluiceVulkanStreamer *streamer);

/**
 * Waits until no read is in progress, and all submitted bindings and uploads are complete. Does not
 * wait for frames.
 *
 * For tests, offline rendering and shutdown: the next frame then maps everything that was
 * requested.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_OUT_OF_HOST_MEMORY,
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY, SLUICE_ERROR_VULKAN, SLUICE_ERROR_DEVICE_LOST.
 */
SLUICE_API SluiceResult sluiceWaitVulkanStreamerIdle(SluiceVulkanStreamer *streamer);

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
     * 2D array, all layers of `mipLevel` alone. For storage image descriptors. VK_NULL_HANDLE if
     * the device cannot store to images of the format (sRGB and compressed formats): use transfers.
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
    /** As sluiceSetVulkanUvTransform (vulkan_control.h). Copied. Default: none. */
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
 * Adds a texture: creates the image of a source or producer and starts to stream it. The format
 * is that of the source, or of SluiceTileProducer.pImage.
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

/**
 * Storage buffers for shaders. The handles never change during the streamer's life.
 *
 * You may copy from all but the page table, between sluiceBeginStreamingFrame and the submission.
 * Record a barrier first: sluiceBeginStreamingFrame writes the buffers by transfers, and
 * sluiceEndStreamingFrame writes feedback in compute shaders.
 */
typedef struct SluiceVulkanBuffers {
    uint32_t structSize;    ///< sizeof(SluiceVulkanBuffers).
    VkBuffer textureTable;  ///< SluiceTextureEntry[maxTextureCount], read.
    VkBuffer feedback;      ///< uint[], read and written.
    VkBuffer minMip;        ///< uint[], two texels each, read.
    VkBuffer feedbackTurns; ///< uint[], read. All bits are set without feedbackInTurns.
    VkBuffer pageTable;     ///< uint[], read only in paged mode; else any valid buffer.
    /** Device addresses, as constant as the handles. 0 without
     *  SluiceVulkanStreamerCreateInfo.bufferDeviceAddress. */
    VkDeviceAddress textureTableAddress, feedbackAddress, minMipAddress, feedbackTurnsAddress,
        pageTableAddress;
    /** Bytes of the buffers: `range` of VkDescriptorAddressInfoEXT. */
    uint64_t textureTableSize, feedbackSize, minMipSize, feedbackTurnsSize, pageTableSize;
} SluiceVulkanBuffers;

/**
 * Gets the buffers that shaders read and write.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetVulkanBuffers(const SluiceVulkanStreamer *streamer,
                                               SluiceVulkanBuffers *pBuffers);

/**
 * Array of combined image samplers (sampler2DArray in GLSL) in which shaders find pages. All use
 * one sampler.
 *
 * Only paged mode samples the views, but they are valid in every mode: one pipeline layout and one
 * shader source serve all modes (SLUICE_PAGED in buffers.glsl).
 *
 * The array changes only inside sluiceBeginStreamingFrame, and rarely; `generation` then grows.
 * Keep one descriptor set per frame in flight. After sluiceBeginStreamingFrame, rewrite the frame's
 * set if it holds another generation: no earlier frame uses it any more. A view that left the array
 * lives until all frames begun before are complete.
 */
typedef struct SluiceVulkanPages {
    uint32_t structSize; ///< sizeof(SluiceVulkanPages).
    VkSampler sampler;   ///< Never changes.
    uint32_t viewCount;  ///< maxPageChunkCount. Never changes.
    /** 2D arrays, VK_IMAGE_LAYOUT_GENERAL. Get them after begin and use them for that frame or
     *  launch: later ones may have other views. */
    const VkImageView *pViews;
    uint64_t generation; ///< Counts from 1.
} SluiceVulkanPages;

/**
 * Gets the array of pages.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetVulkanPages(const SluiceVulkanStreamer *streamer,
                                             SluiceVulkanPages *pPages);

/**
 * Gets the layout of the descriptor sets of frames (SluiceStreamingFrame). The streamer owns the
 * layout; it never changes.
 *
 * shaders/include/sluice/bindings.glsl declares what such a set holds: the buffers above, the array
 * of pages, and the arrays of textures and cube maps if there are any (textureArray). Use the
 * layout in your pipeline layouts, at the set number that your shaders define as SLUICE_SET. All
 * shader stages may read the set. In paged mode the array of pages has maxPageChunkCount elements,
 * in other modes one.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED, with a log message, if the device
 *         supports fewer samplers per shader stage than maxPageChunkCount. Frames then have no
 *         descriptor set. Set a smaller maxPageChunkCount, or write your own sets.
 */
SLUICE_API SluiceResult sluiceGetVulkanDescriptorSetLayout(const SluiceVulkanStreamer *streamer,
                                                           VkDescriptorSetLayout *pLayout);

/** Frame that was begun. */
typedef struct SluiceStreamingFrame {
    uint32_t structSize;   ///< sizeof(SluiceStreamingFrame).
    uint64_t frameIndex;   ///< Counts from 1.
    VkSemaphore semaphore; ///< Timeline semaphore. Your submission must signal it.
    uint64_t signalValue;  ///< Value to signal.
    /**
     * Holds all that shaders read and write (sluiceGetVulkanDescriptorSetLayout). Bind it only in
     * commands of this frame: later frames write it again. The streamer owns it.
     */
    VkDescriptorSet descriptorSet;
    /**
     * Timeline semaphore of SluiceVulkanContextCreateInfo.uploadQueue. Your submission must wait
     * until it is at uploadValue, at all stages that sample. It is there when the frame begins, so
     * the GPU never waits; the wait makes the copied texels visible to the frame's queue.
     * VK_NULL_HANDLE without such a queue.
     */
    VkSemaphore uploadSemaphore;
    uint64_t uploadValue; ///< 0: nothing was copied there yet.
} SluiceStreamingFrame;

/**
 * Begins a frame: collects finished work, submits sparse binds, and records uploads and MinMip
 * maps.
 *
 * Call once per frame, outside a render pass, before the first draw that samples streamed textures.
 * Submit `commandBuffer` to one queue of queueFamilyIndex, before the command buffer of the next
 * frame, and signal `pFrame->semaphore` with `pFrame->signalValue` when all that samples in the
 * frame is complete. If other queues sample (pSamplingQueueFamilies), the submission must also wait
 * until the frame before is complete. If you cannot submit, call
 * sluiceAbandonStreamingFrame. End or abandon every frame before you begin the next one.
 *
 * Returns SLUICE_NOT_READY, with nothing recorded, while framesInFlight frames are incomplete,
 * after waiting for the oldest one up to 5 ms. Wait until `semaphore` reaches the signalValue of an
 * earlier frame, and call again. A fence of the same submission may be signaled a little earlier
 * than the semaphore; the 5 ms are for that.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the last
 *         frame was neither ended nor abandoned; SLUICE_ERROR_TIME_BACKWARDS if `timeStamp` is
 *         below the last frame's. Nothing has changed after these. SLUICE_ERROR_OUT_OF_HOST_MEMORY,
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY, SLUICE_ERROR_VULKAN, SLUICE_ERROR_DEVICE_LOST: destroy
 *         the streamer.
 * Thread safety: external on `streamer` and on the sparse queue.
 */
SLUICE_API SluiceResult sluiceBeginStreamingFrame(SluiceVulkanStreamer *streamer,
                                                  VkCommandBuffer commandBuffer, uint64_t timeStamp,
                                                  SluiceStreamingFrame *pFrame);

/**
 * Ends a frame: records the resolve and readback of the feedback maps whose turn it is.
 *
 * Call outside a render pass. Binds a compute pipeline and its descriptor set 0.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if no frame was begun since the
 *         last call, or if it was abandoned.
 */
SLUICE_API SluiceResult sluiceEndStreamingFrame(SluiceVulkanStreamer *streamer,
                                                VkCommandBuffer commandBuffer);

/**
 * Abandons a frame that will never be submitted, and all frames begun after it. Allowed after
 * sluiceBeginStreamingFrame and after sluiceEndStreamingFrame.
 *
 * Use it after an error while recording, or if the swapchain is out of date. Do not submit the
 * command buffers. Do not wait for the signalValue of an abandoned frame: the semaphore skips it.
 * Abandoned frames do not count towards framesInFlight.
 *
 * The next frame records again what the abandoned frames recorded, as far as it is still valid:
 * texels, MinMip maps, page table, texture table, image layouts. Nothing is lost, and nothing is
 * read from disk again.
 *
 * After an error nothing has changed.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the frame is complete, was
 *         abandoned or never begun; SLUICE_ERROR_OUT_OF_HOST_MEMORY;
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN; SLUICE_ERROR_DEVICE_LOST.
 * Thread safety: external on `streamer`.
 */
SLUICE_API SluiceResult sluiceAbandonStreamingFrame(SluiceVulkanStreamer *streamer,
                                                    const SluiceStreamingFrame *pFrame);

/**
 * Statistics of a streamer. Counts are totals since creation, unless they describe a present state.
 */
typedef struct SluiceVulkanStreamerStatistics {
    uint32_t structSize; ///< sizeof(SluiceVulkanStreamerStatistics).
    /** Present counts of the manager. sluiceGetStatistics has the rest. */
    uint32_t textureCount;
    uint64_t tileCount; ///< All tiles of all textures, resident or not.
    uint32_t requestedTileCount, allocatedTileCount, mappedTileCount, standbyTileCount;
    uint32_t canceledTileCount, failedTileCount, givenUpTileCount;
    uint32_t retiringSlotCount, heapCount;
    uint32_t globalMipBias; ///< Sixteenths of a level.
    uint64_t bytesRead;     ///< Bytes of texels read from sources.
    uint64_t bytesUploaded; ///< Bytes of texels copied to images.
    uint64_t tilesMapped, tilesUnmapped, tilesCanceled, tilesFailed;
    uint64_t bindCalls;    ///< Calls of vkQueueBindSparse.
    uint64_t bindRuns;     ///< Rectangles of tiles with consecutive pages, bound in them.
    uint64_t unbinds;      ///< Tiles whose memory was unbound.
    uint64_t unbindsSaved; ///< Unmapped tiles bound again, or removed, before their unbind.
    uint64_t feedbackMaps; ///< Maps resolved and passed to the manager.
    /** Uncollected reads, uploads not yet recorded, and tiles with producers not yet shown. */
    uint32_t loadsInFlight;
    uint64_t deviceMemorySize;  ///< Bytes of all device memory that is not host-mapped.
    uint64_t feedbackWords;     ///< Words of 4 bytes of feedback read back.
    uint64_t feedbackPostponed; ///< Maps that had to wait; see feedbackReadbackSize.
    uint32_t fadingTextures;    ///< Textures that are fading in; see residencyFadeTicks.
    uint64_t
        tilesRestored; ///< Tiles mapped again without a read: their texels were still resident.
    /**
     * Bytes of deviceMemorySize that count against the memory budget: heaps, pages, and images that
     * are resident as a whole. As in SluiceVulkanContextStatistics, but only of this streamer, and
     * of all pages of the context.
     */
    uint64_t tileMemorySize;
    /**
     * Bytes of all mapped memory: staging and readback. Grows with the loads in flight and shrinks
     * again. deviceMemorySize + hostVisibleMemorySize is all device memory of the streamer.
     */
    uint64_t hostVisibleMemorySize;
    uint32_t pageChunkCount; ///< Paged: array images that hold pages now; see maxPageChunkCount.
    /**
     * Paged: times that tiles found no page because all maxPageChunkCount images were in use;
     * counted at most once in 60 frames. The first is logged. Such tiles show coarser levels.
     */
    uint64_t pageChunkShortages;
    /** Paged: tiles mapped without a read, because another front end of the context had them or an
     *  equal tile was resident. */
    uint64_t tilesShared;
    uint64_t tilesProduced;      ///< Tiles that producers wrote, without those of mip tails.
    uint64_t texturesForgotten;  ///< Times that a texture was forgotten; see forgetTextures.
    uint32_t absentTextureCount; ///< Textures without an image: forgotten, or not sampled yet.
    /** Resident tiles, and 64 KiB of mip tails, that were read again because their texels changed
     *  (vulkan_control.h). */
    uint64_t tilesReloaded;
    uint64_t uploadQueueCopies; ///< Tiles, and parts of mip tails, copied on uploadQueue.
    /** Tiles whose source had no texels yet (SLUICE_NOT_READY), again and again. They are asked for
     *  later like failed ones, but count in tilesFailed only if a producer said so. */
    uint64_t tilesNotReady;
} SluiceVulkanStreamerStatistics;

/**
 * Gets the statistics of a streamer.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetVulkanStreamerStatistics(
    const SluiceVulkanStreamer *streamer, SluiceVulkanStreamerStatistics *pStatistics);

/**
 * Gets the read statistics of a source (loader.h), or of all sources if `source` is NULL.
 * Statistics of a source are dropped when its last texture is destroyed.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetVulkanReadStatistics(SluiceVulkanStreamer *streamer,
                                                      const SluiceImageSource *source,
                                                      SluiceTileLoaderStatistics *pStatistics);

/**
 * Retries at once all failed and given-up tiles of a source, or of all sources if `source` is NULL.
 * Call it when you learn that the source can be read again: a server answers, a disk was mounted, a
 * file was replaced.
 *
 * Does nothing if no texture uses the source. Without this call given-up tiles are tried again
 * after givenUpRetryDelayTicks.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: external on `streamer`.
 */
SLUICE_API SluiceResult sluiceRetryVulkanSource(SluiceVulkanStreamer *streamer,
                                                const SluiceImageSource *source);

/**
 * Gets the mode in use: AUTO is resolved.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetVulkanResidencyMode(const SluiceVulkanStreamer *streamer,
                                                     SluiceResidencyMode *pMode);

/**
 * Gets the streamer's manager. The manager is destroyed with the streamer.
 *
 * You may call between any two calls of the streamer, on the thread that uses it:
 * - functions that take a const manager
 * - sluiceGetGivenUpTiles, sluiceRetryFailedTiles
 * - sluiceSetConfig, sluiceTrimStandbyTiles, sluiceReleaseHeap. In sparse mode, frames evacuate and
 *   release heaps beyond targetHeapCount by themselves
 * - sluiceBeginRecording, sluiceBeginFileRecording and sluiceEndRecording
 *
 * The streamer makes all other calls itself, sluiceEvacuateHeaps among them
 * (sluiceCompactVulkanStreamer). They return SLUICE_ERROR_INVALID_ARGUMENT and change
 * nothing, and sluiceDestroyStreamedTextureManager does nothing (manager.h, pLocked).
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetVulkanStreamerManager(SluiceVulkanStreamer *streamer,
                                                       SluiceStreamedTextureManager **pManager);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_H */
