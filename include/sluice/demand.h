/**
 * Demand loading for ray tracers and everything else that launches, learns what is missing, loads
 * it, and launches again until nothing is. Part of `sluice-vulkan`.
 *
 * Textures are opened when they are first sampled and loaded tile by tile; resources are pages that
 * a callback of the application fills. Shaders (shaders/include/sluice/demand.glsl) look a page up,
 * or record that they miss it. A launch:
 *
 *     do {
 *         sluicePrepareDemandLaunch(loader, commandBuffer, &launch);
 *         ... trace rays, dispatch: samples say whether they are resident ...
 *         sluiceEndDemandLaunch(loader, commandBuffer);
 *         vkQueueSubmit: signal launch.semaphore with launch.signalValue
 *         sluiceProcessDemandRequests(loader, &launch, UINT64_MAX, &requests, &ticket);
 *         sluiceWaitDemandTicket(loader, ticket, UINT64_MAX, NULL);
 *     } while (requests.missingCount > 0);
 *
 * Interactive renderers launch on without waiting for the ticket, and take what is there.
 * docs/demand.md goes through it step by step.
 *
 * Thread safety: external on the loader, but for sluiceGetDemandTicketStatus,
 * sluiceWaitDemandTicket, sluiceCancelDemandTicket and sluiceAbortDemandLoader: any thread.
 * Ids are never reused for another thing: those of what was destroyed are refused.
 */
#ifndef SLUICE_DEMAND_H
#define SLUICE_DEMAND_H

#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceDemandLoader SluiceDemandLoader;

/** The low 32 bits are the index that shaders take; 0 is no texture's. */
typedef uint64_t SluiceDemandTextureId;
typedef uint64_t SluiceDemandResourceId;
/** Of the work that one call caused; 0 is none and always complete. */
typedef uint64_t SluiceDemandTicket;

#define SLUICE_NO_DEMAND_TEXTURE ((SluiceDemandTextureId)0)

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceDemandLoaderCreateInfo {
    VkInstance instance; ///< required, as all handles
    VkPhysicalDevice physicalDevice;
    VkDevice device; ///< Vulkan 1.2, with what sluiceRequireVulkanFeatures asks for PAGED
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr; ///< required
    uint32_t queueFamilyIndex; ///< of the queue that launches are submitted to: it must compute
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free
    SluiceLogCallback log;
    uint32_t launchesInFlight; ///< at most 16; 0: 2
    uint32_t maxTextureCount;  ///< variants and grids count, too; at most 2^24; 0: 2^17
    uint64_t pageCapacity;     ///< virtual pages, at most 2^31, rounded up to 1024; 0: 2^26
    /** Pages that a scan lists and one call serves; the others wait for the next. At most 2^20;
     *  0: 8192. Pages of resources that are refused, or not ready, are listed whenever they are
     *  missed: it should be larger than their number. */
    uint32_t maxRequestsPerLaunch;
    /** Device memory for tiles, bytes; a hard cap. At most 128 MiB for each of maxPageChunkCount
     * are used. 0: half of the device's. */
    uint64_t memoryBudget;
    /** Reads under way and texels not yet copied, in tiles of 64 KiB; at most 2^16; 0: 1024. Beside
     *  them as many openings and fills, those that wait for another attempt included. */
    uint32_t maxTilesInFlight;
    uint32_t loaderThreadCount;      ///< 0: as sluiceCreateTileLoader
    SluiceTileRetryPolicy readRetry; ///< also of resources that say NOT_READY
    /** At once; all openings together count as one source, and so do the fills of a resource. 0: as
     *  sluiceCreateTileLoader. */
    uint32_t maxReadsPerSource;
    uint32_t maxPageChunkCount; ///< as in SluiceVulkanStreamerCreateInfo; 0: 64
    /** Nothing is ever evicted, and shaders do not say what they use: a little faster. */
    bool noEviction;
    /** With a working set larger than the budget some tiles stay away, and samples there take
     *  coarser ones, instead of all of them becoming a little blurrier. */
    bool noLodBias;
    SluiceTileReadFailureCallback failure; ///< told of every read that fails, see loader.h
} SluiceDemandLoaderCreateInfo;

/**
 * Errors: NULL_POINTER; INVALID_ARGUMENT for values beyond their limits, a budget below 4 MiB, or a
 * queue family that does not compute;
 * UNSUPPORTED if the device cannot page; LIMIT_EXCEEDED if pageCapacity or maxTextureCount need a
 * storage buffer beyond the device's maxStorageBufferRange, or there are fewer pages than textures;
 * OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SLUICE_API SluiceResult sluiceCreateDemandLoader(const SluiceDemandLoaderCreateInfo *pCreateInfo,
                                                 SluiceDemandLoader **pLoader);

/** Cancels what has not begun, waits for reads under way and for the device, closes every image.
 *  NULL is allowed. */
SLUICE_API void sluiceDestroyDemandLoader(SluiceDemandLoader *loader);

typedef enum SluiceDemandFilter {
    SLUICE_DEMAND_FILTER_LINEAR = 0,
    SLUICE_DEMAND_FILTER_NEAREST = 1
} SluiceDemandFilter;

/** How a texture is sampled. Zero is a trilinear sampler that repeats. */
typedef struct SluiceDemandSampler {
    VkSamplerAddressMode addressModeU, addressModeV;
    SluiceDemandFilter filter, mipmapFilter;
    float maxAnisotropy; ///< at most 64; 0 and 1: none
    float lodBias;       ///< -16 to 16
    float borderColor[4];
} SluiceDemandSampler;

/** Where the texels come from: an image that is there, or one that is opened when it is needed. */
typedef struct SluiceDemandImage {
    /** Not NULL: asked for its info when first sampled; must outlive the texture. It is never
     *  closed. Calls that take it away wait for its reads that are under way. */
    SluiceImageSource *source;
    /** Of pfnOpen and pfnClose. Must stay as long as the texture, and where that is destroyed while
     *  it is being opened until pfnClose, at the latest until the loader is destroyed. */
    void *pUserData;
    /** Where `source` is NULL. On a worker thread, at most once at a time; again after NOT_READY,
     *  IO, OUT_OF_HOST_MEMORY and, once, CORRUPT_DATA, see readRetry. `*pSource` has one array
     *  layer. */
    SluiceResult (*pfnOpen)(void *pUserData, SluiceImageSource **pSource);
    /** Once for each image that pfnOpen opened; no read of it is under way. NULL:
     *  sluiceDestroyImageSource. On any thread that uses the loader. */
    void (*pfnClose)(void *pUserData, SluiceImageSource *source);
} SluiceDemandImage;

typedef struct SluiceDemandTextureCreateInfo {
    SluiceDemandImage image;
    SluiceDemandSampler sampler;
    /** What a texture looks like that cannot be opened or has no such tile; opaque magenta is a
     *  good choice where errors are to be seen. */
    float failureColor[4];
} SluiceDemandTextureCreateInfo;

/**
 * Nothing is opened. The format may be any that the device samples and filters, sizes up to 2^20.
 * Errors: NULL_POINTER; INVALID_ARGUMENT for unknown modes, an anisotropy or a bias beyond its
 * range; LIMIT_EXCEEDED beyond maxTextureCount; OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceCreateDemandTexture(SluiceDemandLoader *loader,
                                                  const SluiceDemandTextureCreateInfo *pCreateInfo,
                                                  SluiceDemandTextureId *pTextureId);

/** The same image and tiles with another sampler. It goes with its base, or before.
 *  Errors: also UNKNOWN_TEXTURE, STALE_TEXTURE; INVALID_ARGUMENT if `baseId` is a grid. */
SLUICE_API SluiceResult sluiceCreateDemandTextureVariant(SluiceDemandLoader *loader,
                                                         SluiceDemandTextureId baseId,
                                                         const SluiceDemandSampler *pSampler,
                                                         SluiceDemandTextureId *pTextureId);

/**
 * A grid of textures that is sampled as one: column floor(u), row floor(v), `columns` x `rows`,
 * row by row from v = 0. Beyond it, and where an id is SLUICE_NO_DEMAND_TEXTURE, samples are
 * `missingColor`. Filters do not reach from one texture into the next. Errors: NULL_POINTER;
 * UNKNOWN_TEXTURE, STALE_TEXTURE; INVALID_ARGUMENT for an empty grid, or grids in it;
 * LIMIT_EXCEEDED; OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceCreateDemandUdim(SluiceDemandLoader *loader,
                                               const SluiceDemandTextureId *pTextureIds,
                                               uint32_t columns, uint32_t rows,
                                               const float missingColor[4],
                                               SluiceDemandTextureId *pTextureId);

/** Shaders that still name it get its failureColor, grids their missingColor. Its pages and index
 *  are used again when the launches prepared so far are processed. Variants go with their base.
 *  Errors: NULL_POINTER, UNKNOWN_TEXTURE, STALE_TEXTURE. */
SLUICE_API SluiceResult sluiceDestroyDemandTexture(SluiceDemandLoader *loader,
                                                   SluiceDemandTextureId textureId);

/** Another image in a texture's place, from the next launch on; the old one is closed when its
 *  reads are over. Nothing of the new one is opened before it is sampled. Errors: as above;
 *  INVALID_ARGUMENT for grids and variants. */
SLUICE_API SluiceResult sluiceReplaceDemandImage(SluiceDemandLoader *loader,
                                                 SluiceDemandTextureId textureId,
                                                 const SluiceDemandImage *pImage);

/** The texels of the image have changed, not its size or format: its tiles are forgotten, and read
 *  anew when they are next sampled. One that could not be opened is tried again. Errors:
 *  NULL_POINTER, UNKNOWN_TEXTURE, STALE_TEXTURE; INVALID_ARGUMENT for grids. */
SLUICE_API SluiceResult sluiceInvalidateDemandTexture(SluiceDemandLoader *loader,
                                                      SluiceDemandTextureId textureId);

/**
 * Loads the levels from `finestLevel` on, coarse ones first; opens the image before. What finds no
 * room in memory is left out: nothing is evicted for it. Launches copy what came and begin what did
 * not fit into maxTilesInFlight, so until remainingCount is 0: wait for the ticket, launch.
 * `pTicket` may be NULL. Errors: as above; OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluicePreloadDemandTexture(SluiceDemandLoader *loader,
                                                   SluiceDemandTextureId textureId,
                                                   uint32_t finestLevel,
                                                   SluiceDemandTicket *pTicket);

/** Pages of the application's own: vertex data, acceleration structures, materials. */
typedef struct SluiceDemandResourceCreateInfo {
    uint32_t pageCount; ///< at least 1
    uint32_t rank;      ///< 0 to 15: lower ones are served first
    /** Resident at once at most; those not used for longest are evicted. 0: all. */
    uint32_t maxResidentPageCount;
    void *pUserData;
    /** Finds what shaders get for the page, 0 to pageCount - 1. NOT_READY: ask again later, see
     *  readRetry, and then when a shader next misses it. On a worker thread, several at once. */
    SluiceResult (*pfnFill)(void *pUserData, uint32_t page, uint64_t *pValue);
    /** No launch reads the value any more. May be NULL. On any thread that uses the loader. */
    void (*pfnEvict)(void *pUserData, uint32_t page, uint64_t value);
} SluiceDemandResourceCreateInfo;

/** `*pFirstPage` is what shaders add to. Errors: NULL_POINTER, INVALID_ARGUMENT, LIMIT_EXCEEDED
 *  beyond pageCapacity or 254 resources with a limit of their own, OUT_OF_HOST_MEMORY. */
SLUICE_API SluiceResult sluiceCreateDemandResource(
    SluiceDemandLoader *loader, const SluiceDemandResourceCreateInfo *pCreateInfo,
    SluiceDemandResourceId *pResourceId, uint32_t *pFirstPage);
/** Waits for fills that are under way. Its values are evicted when the launches prepared so far are
 *  processed, at the latest when the loader is destroyed; until then pUserData must stay. */
SLUICE_API SluiceResult sluiceDestroyDemandResource(SluiceDemandLoader *loader,
                                                    SluiceDemandResourceId resourceId);
/** Forgets what `count` pages from `firstPage` (of the resource) are; they are filled anew when
 *  missed. Errors: INVALID_ARGUMENT beyond pageCount. */
SLUICE_API SluiceResult sluiceInvalidateDemandPages(SluiceDemandLoader *loader,
                                                    SluiceDemandResourceId resourceId,
                                                    uint32_t firstPage, uint32_t count);

/** Storage buffers for shaders, the same for the loader's whole life. */
typedef struct SluiceDemandBuffers {
    VkBuffer textures;  ///< SluiceDemandTexture[], read
    VkBuffer levels;    ///< uint[], read
    VkBuffer directory; ///< uint[], read
    VkBuffer blocks;    ///< uint[], read
    VkBuffer masks;     ///< SluiceDemandBlockMasks[], read and written
    VkBuffer requests;  ///< uint[], read and written
    VkBuffer sections;  ///< uint[], read and written
} SluiceDemandBuffers;

SLUICE_API void sluiceGetDemandBuffers(const SluiceDemandLoader *loader,
                                       SluiceDemandBuffers *pBuffers);
/** The array of combined image samplers that tiles are layers of, as sluiceGetVulkanPages. What a
 *  launch samples is there after sluicePrepareDemandLaunch; other calls may add to it. */
SLUICE_API void sluiceGetDemandPages(const SluiceDemandLoader *loader, SluiceVulkanPages *pPages);

typedef struct SluiceDemandLaunch {
    uint64_t launchIndex;  ///< from 1 on
    VkSemaphore semaphore; ///< timeline; the submission of the command buffer must
    uint64_t signalValue;  ///< signal it with this value
    uint32_t tileCount;    ///< tiles that this launch sees for the first time
} SluiceDemandLaunch;

/**
 * Records, outside a render pass, copies of what was loaded and the page table that shows it.
 * Everything between this call and sluiceEndDemandLaunch sees that; barriers are recorded here for
 * all stages. NOT_READY, with nothing recorded, while launchesInFlight are not processed. It must
 * be submitted, and in the order of the calls, but after an error, when nothing was recorded that
 * counts. Errors: NULL_POINTER; INVALID_ARGUMENT if the last launch was not ended;
 * OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN, DEVICE_LOST; CANCELLED after
 * sluiceAbortDemandLoader.
 */
SLUICE_API SluiceResult sluicePrepareDemandLaunch(SluiceDemandLoader *loader,
                                                  VkCommandBuffer commandBuffer,
                                                  SluiceDemandLaunch *pLaunch);

/** Records the scan of the requests. Binds a compute pipeline and its descriptor set 0.
 *  Errors: NULL_POINTER; INVALID_ARGUMENT if no launch was prepared. */
SLUICE_API SluiceResult sluiceEndDemandLaunch(SluiceDemandLoader *loader,
                                              VkCommandBuffer commandBuffer);

/** What a launch missed. Pages, each counted once, whatever how many samples missed it. */
typedef struct SluiceDemandRequests {
    /** All that shaders asked for, listed or not, but for pages of resources that are refused: 0
     *  means that every sample was resident, or is as sharp as memory allows. */
    uint32_t missingCount;
    uint32_t servedCount;    ///< reads and fills that begin now
    uint32_t pendingCount;   ///< under way already
    uint32_t restoredCount;  ///< evicted, but not yet overwritten: back without a read
    uint32_t postponedCount; ///< did not fit into the list, or too much is in flight
    uint32_t refusedCount;   ///< no memory, or unreadable: coarser levels from now on
    float lodBias;           ///< of the next launch, see noLodBias
} SluiceDemandRequests;

/**
 * Waits, up to `timeout` ns, until the launch is over, and begins to load what it missed, coarse
 * pages first. Each launch is processed once, in order; a later one processes those before, too.
 * NOT_READY, with nothing changed, if it was not over in time. `pTicket` may be NULL.
 * Errors: NULL_POINTER; INVALID_ARGUMENT for a launch that was not ended or was processed;
 * OUT_OF_HOST_MEMORY, VULKAN, DEVICE_LOST, CANCELLED.
 */
SLUICE_API SluiceResult sluiceProcessDemandRequests(SluiceDemandLoader *loader,
                                                    const SluiceDemandLaunch *pLaunch,
                                                    uint64_t timeout,
                                                    SluiceDemandRequests *pRequests,
                                                    SluiceDemandTicket *pTicket);

typedef struct SluiceDemandTicketStatus {
    uint32_t taskCount, remainingCount, failedCount;
} SluiceDemandTicketStatus;

/** Zeros for tickets that were over before the last thousand. Errors: NULL_POINTER;
 *  INVALID_ARGUMENT for tickets that were never given. Any thread. */
SLUICE_API SluiceResult sluiceGetDemandTicketStatus(SluiceDemandLoader *loader,
                                                    SluiceDemandTicket ticket,
                                                    SluiceDemandTicketStatus *pStatus);
/** Until all its tasks that have begun are over, successfully or not: all that there are, but for
 *  preloads. NOT_READY after `timeout` ns. `pStatus` may be NULL. CANCELLED once the loader is
 *  aborted. Any thread. */
SLUICE_API SluiceResult sluiceWaitDemandTicket(SluiceDemandLoader *loader,
                                               SluiceDemandTicket ticket, uint64_t timeout,
                                               SluiceDemandTicketStatus *pStatus);
/** Tasks that have not begun are dropped; shaders may ask again. Any thread. */
SLUICE_API SluiceResult sluiceCancelDemandTicket(SluiceDemandLoader *loader,
                                                 SluiceDemandTicket ticket);
/** Drops all that has not begun and wakes all who wait; from then on launches answer CANCELLED, and
 *  the loader can only be destroyed. Any thread. */
SLUICE_API SluiceResult sluiceAbortDemandLoader(SluiceDemandLoader *loader);

typedef struct SluiceDemandStatistics {
    uint64_t launchCount;
    uint64_t requestCount, pendingCount, servedCount, restoredCount, refusedCount, postponedCount;
    uint64_t evictedCount, failedCount, cancelledCount;
    uint64_t texturesCreated, texturesOpened, texturesFailed;
    uint64_t bytesRead, bytesUploaded;
    uint64_t virtualPageCount;  ///< that have an id
    uint64_t residentTileCount; ///< tails are tiles, too
    uint64_t residentResourcePageCount;
    uint64_t tileMemorySize;   ///< bytes of device memory that hold tiles: within the budget
    uint64_t deviceMemorySize; ///< all of it, with buffers, but those in the host's memory
    float lodBias;
    /** Reads and fills by the time from request to end: bucket i counts those of less than 2^i us,
     *  the last one all others. */
    uint64_t latencyHistogram[24];
} SluiceDemandStatistics;

SLUICE_API SluiceResult sluiceGetDemandStatistics(SluiceDemandLoader *loader,
                                                  SluiceDemandStatistics *pStatistics);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DEMAND_H */
