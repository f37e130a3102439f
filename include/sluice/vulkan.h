/**
 * Streams textures on a Vulkan device. Link `sluice-vulkan`; the only header that includes Vulkan.
 *
 * The application owns instance, device, queues and command buffers, and draws. A streamer owns the
 * streamed images, the feedback, MinMip and texture table buffers, a manager (manager.h) and a tile
 * loader (loader.h). Shaders use the functions of shaders/include/sluice.
 *
 * A frame:
 *
 *     sluiceBeginStreamingFrame(streamer, commandBuffer, timeStamp, &frame);
 *     ... draw: shaders sample and write feedback ...
 *     sluiceEndStreamingFrame(streamer, commandBuffer);
 *     vkQueueSubmit: signal frame.semaphore with frame.signalValue
 *
 * The barriers for what the streamer owns are recorded here; the application's need not name it.
 * docs/frame-loop.md goes through it step by step, docs/examples/vulkan.c is a whole program.
 *
 * Nothing here waits for the GPU, but for sluiceDestroyVulkanStreamer and
 * sluiceWaitVulkanStreamerIdle. Thread safety: external on the streamer and, during
 * sluiceBeginStreamingFrame, on the sparse queue.
 */
#ifndef SLUICE_VULKAN_H
#define SLUICE_VULKAN_H

#include <sluice/image.h>
#include <sluice/loader.h>
#include <sluice/manager.h>
#include <sluice/replay.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceVulkanStreamer SluiceVulkanStreamer;

typedef enum SluiceResidencyMode {
    SLUICE_RESIDENCY_MODE_AUTO = 0,   ///< sparse where the device has it, else paged
    SLUICE_RESIDENCY_MODE_SPARSE = 1, ///< sparse residency images
    /** A page table that shaders read and tiles as layers of array images: see SluiceVulkanPages.
     *  A texture may be larger than images of the device. */
    SLUICE_RESIDENCY_MODE_PAGED = 2,
    /** Ordinary images that have all their memory from the start: what streams is the texels. */
    SLUICE_RESIDENCY_MODE_DENSE = 3
} SluiceResidencyMode;

/** What shaders write for each feedback region; their SLUICE_FEEDBACK_ENCODING must be the same. */
typedef enum SluiceFeedbackEncoding {
    SLUICE_FEEDBACK_ENCODING_LEVELS = 0, ///< a word with the finest level
    SLUICE_FEEDBACK_ENCODING_MASKS = 1   ///< half a word with a bit per level; half the memory
} SluiceFeedbackEncoding;

/** What a device can do for Sluice, and what is known to be odd about it. */
typedef struct SluiceVulkanDeviceCapabilities {
    bool sparse;                     ///< sparse residency 2D images and a queue that binds them
    bool shaderResourceResidency;    ///< residency codes exist
    bool shaderResourceMinLod;       ///< samplers take a LOD clamp: SLUICE_MIN_LOD in sample.glsl
    bool residencyNonResidentStrict; ///< reads of unbound texels are 0
    bool nonUniformIndexing;         ///< of arrays of images; else shaders define SLUICE_PAGE_LOOP
    /** The best that binds: without graphics if possible, perhaps useless for anything else. */
    uint32_t sparseQueueFamilyIndex;
    uint64_t sparseAddressSpaceSize; ///< bytes; also the limit per image
    char deviceName[256];
    char driverName[256], driverInfo[256];
    VkPhysicalDeviceType deviceType;
    uint32_t apiVersion;           ///< as VK_MAKE_API_VERSION
    bool timelineSemaphore;        ///< required
    bool fragmentStoresAndAtomics; ///< required
    bool textureCompressionBC;     ///< BC formats can be streamed
    bool samplerAnisotropy;
    bool sparseResidencyAliased; ///< a page may lie at several places
    bool standardTiles;          ///< sparse tiles have the shapes of sluiceGetStandardTileShape
    /** Residency codes exist and can be believed: not on software devices, whose codes are wrong
     *  for filters between levels. Sluice itself samples by MinMip maps alone. */
    bool residencyCodesExact;
    bool dedicatedSparseQueue; ///< of a family that neither draws nor computes
    uint32_t sparseQueueCount; ///< of sparseQueueFamilyIndex
    /** Different tiles that a process may bind in the life of their images; 0: as many as it likes.
     *  Software devices keep a memory map for each. */
    uint32_t maxTouchedTiles;
    uint32_t maxImageExtent, maxImageArrayLayers;
    uint32_t maxStorageBufferRange; ///< bytes
    float maxSamplerAnisotropy;
    float timestampPeriod;          ///< nanoseconds per tick; 0: no time stamps
    uint64_t deviceLocalMemorySize; ///< bytes of the largest such heap
} SluiceVulkanDeviceCapabilities;

/** Errors: NULL_POINTER, UNSUPPORTED if pfnGetInstanceProcAddr lacks a function. */
SLUICE_API SluiceResult
sluiceGetVulkanDeviceCapabilities(VkInstance instance, VkPhysicalDevice physicalDevice,
                                  PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                  SluiceVulkanDeviceCapabilities *pCapabilities);

/** What a device makes of one format, as a 2D image that is sampled and copied to. */
typedef struct SluiceVulkanFormatCapabilities {
    bool sampled;      ///< at all
    bool linearFilter; ///< by samplers that interpolate
    bool sparse;       ///< as a sparse residency image of 64 KiB tiles: what can be streamed
    /** Texels as the driver says it; 0 if it is not sparse at all. */
    uint32_t granularityWidth, granularityHeight;
    uint32_t tileWidth, tileHeight; ///< texels of a tile, where the driver counts blocks corrected
    /** Of sparse images, or of others where it is not sparse. */
    uint32_t maxWidth, maxHeight, maxMipLevelCount, maxArrayLayerCount;
    uint64_t maxImageSize; ///< bytes
} SluiceVulkanFormatCapabilities;

/** Errors: NULL_POINTER; UNSUPPORTED for unknown formats or if a function is missing. */
SLUICE_API SluiceResult sluiceGetVulkanFormatCapabilities(
    VkInstance instance, VkPhysicalDevice physicalDevice,
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr, SluiceFormat format,
    SluiceVulkanFormatCapabilities *pCapabilities);

/** How a device lays out one sparse image; found out by making it. */
typedef struct SluiceVulkanSparseImageLayout {
    uint32_t mipLevelCount;
    uint32_t tileWidth, tileHeight; ///< texels
    uint32_t regularMipCount;       ///< levels whose tiles come and go one by one
    uint32_t packedTileCount;       ///< pages of the others, together
    bool driverTail;                ///< the driver packs those; else each is a tile of its own
    uint64_t tailSize;              ///< bytes, 0 without driverTail
    uint64_t metadataSize;          ///< bytes, bound apart; 0: none
    uint64_t imageSize;             ///< bytes of address space
    uint64_t alignment;             ///< bytes
    uint32_t memoryTypeBits;
} SluiceVulkanSparseImageLayout;

/**
 * `device` was created with the features of sluiceRequireVulkanFeatures. Of `pImage` size and
 * format matter, mipLevelCount may be 0. Errors: NULL_POINTER; UNSUPPORTED, with a message to
 * `pLog` (may be NULL), if the image cannot be streamed; INVALID_ARGUMENT for a size of 0;
 * OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY.
 */
SLUICE_API SluiceResult sluiceGetVulkanSparseImageLayout(
    VkInstance instance, VkPhysicalDevice physicalDevice, VkDevice device,
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr, const SluiceLogCallback *pLog,
    const SluiceImageInfo *pImage, SluiceVulkanSparseImageLayout *pLayout);

/**
 * Sets in `*pFeatures`, `*pVulkan12` what a streamer of that mode needs of the device: pass both to
 * vkCreateDevice (VkPhysicalDeviceFeatures2 chain). The caller has zeroed both, but for the sType
 * and for what else he needs, which stays set. No extension is needed. textureCompressionBC is set
 * where the device has it, for the BC formats. `pLog` may be NULL.
 *
 * All modes need timelineSemaphore and fragmentStoresAndAtomics; sparse also sparseBinding,
 * sparseResidencyImage2D and a queue family with SPARSE_BINDING; paged also
 * shaderSampledImageArrayDynamicIndexing, and it takes shaderSampledImageArrayNonUniformIndexing
 * where that is there. AUTO needs what the mode needs that it stands for.
 * Errors: NULL_POINTER; INVALID_ARGUMENT for an unknown mode; UNSUPPORTED if the device lacks a
 *         feature; the log callback says which.
 */
SLUICE_API SluiceResult sluiceRequireVulkanFeatures(
    VkInstance instance, VkPhysicalDevice physicalDevice,
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr, SluiceResidencyMode mode,
    const SluiceLogCallback *pLog, VkPhysicalDeviceFeatures *pFeatures,
    VkPhysicalDeviceVulkan12Features *pVulkan12);

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceVulkanStreamerCreateInfo {
    VkInstance instance; ///< required, as all handles down to device; of Vulkan 1.2
    VkPhysicalDevice physicalDevice;
    VkDevice device; ///< Vulkan 1.2, with the features of sluiceRequireVulkanFeatures
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr; ///< required
    VkQueue sparseQueue; ///< of a family with SPARSE_BINDING; may be the drawing queue; required in
                         ///< sparse mode alone
    uint32_t sparseQueueFamilyIndex;
    uint32_t queueFamilyIndex; ///< of the queue that frames are submitted to: it must compute
    SluiceResidencyMode residencyMode;
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free
    SluiceLogCallback log;
    uint32_t framesInFlight;       ///< at most 16; 0: 3
    uint32_t maxTextureCount;      ///< at most 2^20; 0: 1024
    uint32_t texturesPerFrame;     ///< feedback maps read back per frame; 0: 10
    uint32_t tilesPerFrame;        ///< mapped and uploaded per frame at most, to 2^14; 0: 256
    uint32_t maxLoadsInFlight;     ///< at most 2^16; 0: 4 * tilesPerFrame, at least 64
    uint32_t loaderThreadCount;    ///< 0: as sluiceCreateTileLoader
    uint32_t heapTileCapacity;     ///< 0: 256
    uint32_t maxHeapCount;         ///< 0: as many as the device has memory for
    uint32_t numExtraStandbyTiles; ///< kept although unwanted
    /**
     * In the unit of the time stamps: a region that no map asked for that long is no longer wanted.
     * 0: only a texture's newest map counts, which no stochastic feedback should be used with.
     */
    uint64_t feedbackTimeout;
    uint64_t retryDelay;     ///< in the same unit, see manager.h
    bool mapEverything;      ///< every tile is wanted always: the fully resident truth
    uint32_t maxRegionCount; ///< feedback regions (tiles of level 0), at most 2^28; 0: 2^20
    /**
     * Bytes of resolved feedback that a frame can bring to the host: 4 per region that changed
     * since its texture's turn before, at most 1 per region of a texture. Textures for which there
     * is no room keep their marks and come first in a later frame. Must hold the map of any one
     * texture. 0: maxRegionCount, with which there always is room, at most 2^22.
     */
    uint32_t feedbackReadbackSize;
    /** Bring all of each map to the host instead of what changed. The decisions are the same; to
     *  measure and to test with. */
    bool wholeFeedbackMaps;
    SluiceFeedbackEncoding feedbackEncoding;
    /**
     * Shaders that define SLUICE_FEEDBACK_TURN_WORD write feedback only for the textures that are
     * resolved at the end of the same frame: for the others that is one load and no arithmetic.
     * What it costs: with N textures not in a set a texture collects marks in one frame of
     * N / texturesPerFrame, not in all, so what few pixels see is noticed that many times later,
     * and feedbackTimeout must be as much longer. Best where every visible pixel writes. Where
     * N / texturesPerFrame is even, some corners of sluiceWriteQuadFeedback and some pixels of the
     * lattice never have their turn (docs/trade-offs.md).
     */
    bool feedbackInTurns;
    /** Different tiles bound in the life of their images, see SluiceVulkanDeviceCapabilities; the
     *  streamers of a process share what the device bears. Finer tiles beyond it are not loaded.
     *  0: maxTouchedTiles of the device. */
    uint32_t maxTouchedTiles;
    /** Paged: array images that hold pages, at most 2^10, of up to 2048 tiles (128 MiB) and one
     *  texel format each; 0: 64. Also SluiceVulkanPages.viewCount: mind the device's limits on
     *  samplers and sampled images per stage. */
    uint32_t maxPageChunkCount;
    /**
     * In the unit of the time stamps, at most 2^40: how long a region takes to become one level
     * sharper once finer tiles are there, in steps of 1/256 level, so that nothing pops. 0: at
     * once. A tenth of a second is hardly noticed. Coarser regions always become so at once: their
     * tiles are gone, which nobody looked at unless there is too little memory.
     */
    uint64_t residencyFadeTime;
    /** How reads that fail are tried again at once, see loader.h; what they give up the manager
     * asks for again after retryDelay. */
    SluiceTileRetryPolicy readRetry;
    uint32_t maxReadsPerSource; ///< at once; 0: as sluiceCreateTileLoader
} SluiceVulkanStreamerCreateInfo;

/**
 * Errors: NULL_POINTER; INVALID_ARGUMENT, also for a value beyond framesInFlight 16,
 *         maxTextureCount 2^20, tilesPerFrame 2^14, maxLoadsInFlight 2^16, heapTileCapacity 2^20,
 *         maxRegionCount 2^28, maxPageChunkCount 2^10 or residencyFadeTime 2^40; UNSUPPORTED if the
 * device has no mode that was asked for; LIMIT_EXCEEDED if maxTextureCount, maxRegionCount,
 * texturesPerFrame or feedbackReadbackSize need a storage buffer beyond the device's
 * maxStorageBufferRange; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SLUICE_API SluiceResult sluiceCreateVulkanStreamer(
    const SluiceVulkanStreamerCreateInfo *pCreateInfo, SluiceVulkanStreamer **pStreamer);

/**
 * Waits for the device (vkDeviceWaitIdle) and for the reads under way, then releases everything.
 * NULL is allowed. Thread safety: external on the streamer and on all queues of the device.
 */
SLUICE_API void sluiceDestroyVulkanStreamer(SluiceVulkanStreamer *streamer);

/**
 * Waits until no read is under way and every binding submitted so far is over; frames are not
 * waited for. For tests, offline rendering and shutdown: the next frame then sees all that was
 * asked for.
 *
 * Errors: NULL_POINTER, OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN, DEVICE_LOST.
 */
SLUICE_API SluiceResult sluiceWaitVulkanStreamerIdle(SluiceVulkanStreamer *streamer);

typedef struct SluiceVulkanTextureCreateInfo {
    /** Required; must outlive the texture and, when that is removed, the reads of it that are still
     *  under way: sluiceWaitVulkanStreamerIdle or sluiceDestroyVulkanStreamer end them. */
    SluiceImageSource *source;
    SluiceTextureId primaryId; ///< SLUICE_NO_TEXTURE, or the texture whose feedback drives this one
    /** Of the samplers that it is sampled with; zero is VK_SAMPLER_ADDRESS_MODE_REPEAT. */
    VkSamplerAddressMode addressModeU, addressModeV;
} SluiceVulkanTextureCreateInfo;

typedef struct SluiceVulkanTexture {
    SluiceTextureId textureId;
    /** In VK_IMAGE_LAYOUT_GENERAL once a frame was begun after adding it, and for good: one part is
     *  copied to while another is sampled. Validation layers may call that slow. */
    VkImage image; ///< paged: of the packed levels alone, so textureSize() is not the texture's
    VkImageView imageView; ///< 2D, all levels of the image
    VkFormat format;
    uint32_t width, height, mipLevelCount;
    uint32_t tableIndex;   ///< place in the texture table, for the shader functions
    uint32_t arrayLayer;   ///< of `image`; `imageView` shows this layer alone
    VkImageView arrayView; ///< 2D_ARRAY, all layers and levels; VK_NULL_HANDLE if not of an array
} SluiceVulkanTexture;

/**
 * Creates the image of a source and starts to stream it. The format is the source's.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for an unknown address mode or a primary that follows
 *         another one; UNKNOWN_TEXTURE and STALE_TEXTURE for the primary; UNSUPPORTED if the device
 * cannot stream that format or size; LIMIT_EXCEEDED beyond maxTextureCount, maxRegionCount or
 * feedbackReadbackSize; what the source says; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SLUICE_API SluiceResult sluiceAddVulkanTexture(SluiceVulkanStreamer *streamer,
                                               const SluiceVulkanTextureCreateInfo *pCreateInfo,
                                               SluiceVulkanTexture *pTexture);

/**
 * As sluiceAddVulkanTexture, of a source with `layerCount` array layers. Each is a streamed texture
 * of its own, with its own id, feedback and MinMip map; their places in the texture table follow
 * each other, and all are layers of one image. They are removed together, with any of their ids.
 *
 * In paged mode the image, and so arrayView, has the packed levels of all layers; every layer's
 * tiles are pages of its own. shaders/include/sluice/sample_array.glsl samples arrayView.
 *
 * Errors: also INVALID_ARGUMENT if the source has another number of layers, UNSUPPORTED if the
 * device has no arrays of so many layers, or, in sparse mode, if it binds all layers of so small an
 * array as one.
 */
SLUICE_API SluiceResult sluiceAddVulkanTextureArray(
    SluiceVulkanStreamer *streamer, const SluiceVulkanTextureCreateInfo *pCreateInfo,
    uint32_t layerCount, SluiceVulkanTexture *pLayers);

/**
 * The image is destroyed when the frames begun so far have completed; do not draw with it again.
 * Until then its place counts towards maxTextureCount. Errors: NULL_POINTER, UNKNOWN_TEXTURE,
 * STALE_TEXTURE.
 */
SLUICE_API SluiceResult sluiceRemoveVulkanTexture(SluiceVulkanStreamer *streamer,
                                                  SluiceTextureId textureId);

/**
 * The buffers that shaders need, as storage buffers; the same for the streamer's whole life. All
 * but the page table may be copied from, between sluiceBeginStreamingFrame and submission, behind a
 * barrier: what the former wrote there are transfers; sluiceEndStreamingFrame also writes feedback,
 * in compute shaders.
 */
typedef struct SluiceVulkanBuffers {
    VkBuffer textureTable;  ///< SluiceTextureEntry[maxTextureCount], read
    VkBuffer feedback;      ///< uint[], read and written
    VkBuffer minMip;        ///< uint[], two texels each, read
    VkBuffer feedbackTurns; ///< uint[], read; all bits are set without feedbackInTurns
    VkBuffer pageTable;     ///< uint[], read in paged mode alone; in others any valid buffer
} SluiceVulkanBuffers;

SLUICE_API void sluiceGetVulkanBuffers(const SluiceVulkanStreamer *streamer,
                                       SluiceVulkanBuffers *pBuffers);

/**
 * Where shaders find pages: an array of combined image samplers, all with the same sampler, of
 * sampler2DArray in GLSL. Only paged mode samples them, but the views are valid in every mode, so
 * one pipeline layout and one shader source do for all (SLUICE_PAGED in buffers.glsl).
 *
 * The array changes inside sluiceBeginStreamingFrame alone, and seldom: `generation` tells. Keep a
 * descriptor set per frame in flight, and where it holds another generation write it anew after
 * that call, before it is bound: no frame uses it any more then. A view that left the array lives
 * until the frames begun before are over.
 */
typedef struct SluiceVulkanPages {
    VkSampler sampler;         ///< the same for the streamer's whole life
    uint32_t viewCount;        ///< maxPageChunkCount; the same, too
    const VkImageView *pViews; ///< 2D array, VK_IMAGE_LAYOUT_GENERAL; until the next begin
    uint64_t generation;       ///< from 1 on
} SluiceVulkanPages;

SLUICE_API void sluiceGetVulkanPages(const SluiceVulkanStreamer *streamer,
                                     SluiceVulkanPages *pPages);

typedef struct SluiceStreamingFrame {
    uint64_t frameIndex;   ///< from 1 on
    VkSemaphore semaphore; ///< timeline; the submission of the command buffer must
    uint64_t signalValue;  ///< signal it with this value
} SluiceStreamingFrame;

/**
 * Polls what has completed, feeds the manager, submits bindings, and records into `commandBuffer`,
 * outside a render pass: uploads of texels that arrived, and then the MinMip maps that show them.
 *
 * The command buffer must be submitted, before that of the next frame, to the same queue of
 * queueFamilyIndex. Returns SLUICE_NOT_READY, with nothing recorded, while framesInFlight frames
 * are not complete: wait for `semaphore` to reach `signalValue` of an earlier frame.
 *
 * Errors: NULL_POINTER; TIME_BACKWARDS if `timeStamp` is below the last frame's; then nothing has
 *         changed. OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN, DEVICE_LOST: the streamer can
 *         only be destroyed.
 */
SLUICE_API SluiceResult sluiceBeginStreamingFrame(SluiceVulkanStreamer *streamer,
                                                  VkCommandBuffer commandBuffer, uint64_t timeStamp,
                                                  SluiceStreamingFrame *pFrame);

/**
 * Records the resolve and readback of this frame's share of the feedback maps, outside a pass.
 * Binds a compute pipeline and its descriptor set 0. Errors: NULL_POINTER; INVALID_ARGUMENT if no
 * frame was begun since the last call.
 */
SLUICE_API SluiceResult sluiceEndStreamingFrame(SluiceVulkanStreamer *streamer,
                                                VkCommandBuffer commandBuffer);

typedef struct SluiceVulkanStreamerStatistics {
    SluiceStreamedTextureStatistics manager;
    uint64_t bytesRead;     ///< texels delivered by sources
    uint64_t bytesUploaded; ///< texels copied to images
    uint64_t tilesMapped, tilesUnmapped, tilesCancelled, tilesFailed;
    uint64_t bindCalls, bindRuns;
    uint64_t unbinds;       ///< tiles whose page was taken away
    uint64_t unbindsSaved;  ///< unmapped tiles that were bound again, or gone, before that
    uint64_t feedbackMaps;  ///< resolved and given to the manager
    uint32_t loadsInFlight; ///< reads not collected, and uploads not recorded
    /** Bytes of heaps; dense: of images; paged: of pages, packed levels and the page table. */
    uint64_t deviceMemorySize;
    uint64_t feedbackWords;     ///< 4 bytes each, that resolves brought to the host
    uint64_t feedbackPostponed; ///< maps that had to wait, see feedbackReadbackSize
    uint32_t fadingTextures;    ///< that still get sharper, see residencyFadeTime
    uint64_t tilesRevived;      ///< mapped again without being read: their texels were still there
} SluiceVulkanStreamerStatistics;

SLUICE_API void sluiceGetVulkanStreamerStatistics(const SluiceVulkanStreamer *streamer,
                                                  SluiceVulkanStreamerStatistics *pStatistics);

/**
 * What became of the reads of a source, or of all (NULL), see loader.h. A source is forgotten when
 * its last texture is gone. Errors: NULL_POINTER. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetVulkanReadStatistics(SluiceVulkanStreamer *streamer,
                                                      const SluiceImageSource *source,
                                                      SluiceTileLoaderStatistics *pStatistics);

/** What AUTO turned out to be, or the mode that was asked for; AUTO if `streamer` is NULL. */
SLUICE_API SluiceResidencyMode sluiceGetVulkanResidencyMode(const SluiceVulkanStreamer *streamer);

/** The manager, to read from; to record it, begin before the first texture is added. */
SLUICE_API SluiceStreamedTextureManager *
sluiceGetVulkanStreamerManager(SluiceVulkanStreamer *streamer);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_H */
