/**
 * Streams textures on a Vulkan device. Link `sluice-vulkan`. Only headers whose names begin with
 * `vulkan` or `demand`, neural_compress.h and neural_paths.h include Vulkan.
 *
 * This header includes vulkan_texture.h: textures and producers. vulkan_control.h controls single
 * textures.
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
 * Only sluiceDestroyVulkanStreamer and sluiceWaitVulkanStreamerIdle wait for the GPU. Both wait
 * only for work of the streamer.
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
#include <sluice/vulkan_texture.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

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
     * Reads back whole feedback maps instead of their changes. Decisions are the same. For
     * measuring how much the readback of changes saves.
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
     * Forget unsampled textures when memory is short, least recently sampled first. Image, views,
     * tiles and mip tail are destroyed. Shaders then show SLUICE_FALLBACK_COLOR, and feedback loads
     * the texture again.
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
    uint32_t framesPerRound; ///< 0: only texturesPerFrame limits the maps read back per frame.
    /**
     * Requested tiles wait, mip tails of new textures too: frames start no load until the setting
     * is false again, except by sluiceStepVulkanLoads. Tiles whose loads have
     * started still become resident. Restoring a tile from standby counts as a load. For debugging
     * tools: waits for requests ask for frames without end meanwhile.
     */
    bool holdLoads;
    /** Feedback maps that must miss a region before it expires (manager.h). Default: 0, learned. An
     *  older struct without this field keeps both last fields. */
    uint32_t missesToExpire;
    uint32_t prefetchLevels; ///< Coarsest levels to load while nothing is requested (manager.h).
} SluiceVulkanStreamerSettings;

/**
 * Gets the settings that were last set, or else the initial ones. Set structSize first.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetVulkanStreamerSettings(const SluiceVulkanStreamer *streamer,
                                                        SluiceVulkanStreamerSettings *pSettings);

/**
 * Changes all settings. Get them, change fields, and set them. They take effect when the next frame
 * begins; the frame that is being recorded keeps its own. Recordings of the manager hold the
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
    /** Tiles whose source had no texels yet (SLUICE_NOT_READY) after repeated reads. They are
     *  retried later like failed tiles, but count in tilesFailed only if a producer said so. */
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
