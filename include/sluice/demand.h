/**
 * Demand loading for ray tracers and other programs that launch, learn what is missing, load it,
 * and launch again until nothing is missing. Part of `sluice-vulkan`.
 *
 * Textures are opened when first sampled, and loaded tile by tile. Resources are pages that a
 * callback of the application fills. Shaders (shaders/include/sluice/demand.glsl) look up a page,
 * or record a request for it. A launch:
 *
 *     do {
 *         sluiceBeginDemandLaunch(loader, commandBuffer, &launch);
 *         ... trace rays, dispatch: samples say whether they are resident ...
 *         sluiceEndDemandLaunch(loader, commandBuffer);
 *         vkQueueSubmit: signal launch.semaphore with launch.signalValue
 *         sluiceProcessDemandRequests(loader, &launch, UINT64_MAX, &requests, &ticket);
 *         sluiceWaitDemandTicket(loader, ticket, UINT64_MAX, NULL);
 *     } while (requests.missingCount > 0);
 *
 * Interactive renderers do not wait for the ticket; they show what is resident. docs/demand.md
 * explains each step.
 *
 * Ids are never reused. The id of a removed texture or resource is refused.
 *
 * Thread safety, unless a function says otherwise: external on the loader.
 */
#ifndef SLUICE_DEMAND_H
#define SLUICE_DEMAND_H

#include <sluice/replay.h>
#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceDemandLoader SluiceDemandLoader;

/** Id of a texture. Never 0. The low 32 bits are the index for shaders. */
typedef uint64_t SluiceDemandTextureId;
/** Id of a resource. Never 0. */
typedef uint64_t SluiceDemandResourceId;
/** Ticket of the work that one call started. 0: no work, always complete. */
typedef uint64_t SluiceDemandTicket;

/** No texture. Value of an id in a zeroed struct. */
#define SLUICE_NO_DEMAND_TEXTURE ((SluiceDemandTextureId)0)
/** All textures of a loader, in calls that say so. Never the id of a texture. */
#define SLUICE_ALL_DEMAND_TEXTURES ((SluiceDemandTextureId)UINT64_MAX)

/** Settings of a demand loader. A field of zero selects its default. */
typedef struct SluiceDemandLoaderCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceDemandLoaderCreateInfo).
    /** Required. Must outlive the loader. Its device needs the features that
     *  sluiceRequireVulkanFeatures enables for SLUICE_RESIDENCY_MODE_PAGED. */
    SluiceVulkanContext *context;
    uint32_t launchesInFlight; ///< 1 to 16. Default: 2.
    uint32_t maxTextureCount;  ///< Including variants and grids. At most 2^24. Default: 2^17.
    uint64_t pageCapacity; ///< Virtual pages, at most 2^31. Made a multiple of 1024. Default: 2^26.
    /**
     * Most pages that one scan lists and one call serves. Other pages wait for the next scan. At
     * most 2^20. Default: 8192. Choose more than the number of resource pages that are refused or
     * not ready: these are listed each time they are missed.
     */
    uint32_t maxRequestsPerLaunch;
    /**
     * Bytes of device memory for tiles and byte pages. Hard limit. At most the tiles that the
     * context's maxPageChunkCount images hold are used: 7.4 GiB for 64 images of one format. At
     * least 4 MiB; with less, creation fails with SLUICE_ERROR_INVALID_ARGUMENT. Default: half of
     * the device's memory.
     */
    uint64_t memoryBudget;
    /**
     * Most tiles of 64 KiB and byte pages of at most 64 KiB being read or waiting to be copied. At
     * most 2^16. Default: 1024. In addition to these, as many openings and fills are allowed,
     * including those that wait for a retry, and a sixteenth as many larger byte pages, at least 4.
     */
    uint32_t maxTilesInFlight;
    /**
     * Bytes of memoryBudget for byte pages, used in units of 2 MiB. Hard limit. 2 MiB to
     * memoryBudget. Default: a quarter of memoryBudget.
     *
     * While there are byte pages, tiles get the rest. Leave them 4 MiB or more. Creation does not
     * check this: with less, tiles may find no memory, and samples of them stay not resident.
     *
     * Tiles may fill memoryBudget when the first such resource is added. The next launches then
     * evict tiles and free their images (with noEviction: only images that run empty). Until then
     * tiles and byte pages together may exceed memoryBudget.
     */
    uint64_t byteMemoryBudget;
    /**
     * The device has the feature bufferDeviceAddress enabled. Values of byte pages are then
     * addresses.
     */
    bool bufferDeviceAddress;
    /** Never evict, and do not track which pages shaders use. Slightly faster. */
    bool noEviction;
    /**
     * Do not blur textures when the working set exceeds the budget. Some tiles then stay missing,
     * and samples there use coarser ones. Default: a LOD bias for all textures.
     */
    bool noLodBias;
    /** Receives every failed read of this loader (loader.h). userValue is the id of the texture or
     *  resource. */
    SluiceTileReadFailureCallback failure;
    /**
     * Nanoseconds until failed work may be tried again: a texture that could not be opened, or four
     * tiles of a texture or pages of a resource. When one of the four loads, all others of the
     * texture or resource may be tried again. Work begins when shaders next request it. Default:
     * 30 s. UINT64_MAX: never.
     */
    uint64_t failureRetryDelayNs;
    /**
     * Launches without a sample of a texture after which the texture is forgotten. Its tiles and
     * its mip tail are evicted, and an image that a callback opened is closed. Shaders that sample
     * the texture again open it again; its id stays valid. Samples of only the last level's color
     * count as samples. A texture is kept while a preload of it runs, and while tiles that failed
     * wait for their retry. A value above 0 makes shaders report what they use in every launch,
     * which costs 13 to 21 ns per page on the host (docs/decisions/0067). Default: 0, textures are
     * forgotten only when memory is short, least recently used first. With noEviction no texture is
     * forgotten.
     */
    uint32_t forgetAfterLaunches;
} SluiceDemandLoaderCreateInfo;

/**
 * Creates a demand loader. Errors are logged to the context.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for values out of range or a
 *         budget below 4 MiB; SLUICE_ERROR_UNSUPPORTED if the device does not support paged mode,
 *         or bufferDeviceAddress is set and the device has no such feature;
 *         SLUICE_ERROR_LIMIT_EXCEEDED if pageCapacity or maxTextureCount require a storage buffer
 *         above the device's maxStorageBufferRange, or if there are fewer pages than textures;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateDemandLoader(const SluiceDemandLoaderCreateInfo *pCreateInfo,
                                                 SluiceDemandLoader **pLoader);

/**
 * Destroys a loader: cancels work that has not begun, waits for reads in progress and for its own
 * launches, and closes every image. Does not wait for other work of the device. NULL is allowed.
 *
 * Launches that were processed, abandoned or not ended are not waited for. Submit or abandon every
 * launch that you ended: otherwise destruction logs a warning after 5 seconds without progress, and
 * calls vkDeviceWaitIdle. Process launches that may run for longer than that.
 *
 * Thread safety: external on `loader`. On all queues of the device if an ended launch was neither
 * submitted nor abandoned, or runs for more than 5 seconds.
 */
SLUICE_API void sluiceDestroyDemandLoader(SluiceDemandLoader *loader);

/**
 * Settings of a demand loader that can change while it runs. They mean what the fields of the
 * create-info mean, but zero is a value here, and never selects a default.
 */
typedef struct SluiceDemandLoaderSettings {
    uint32_t structSize;           ///< Required. sizeof(SluiceDemandLoaderSettings).
    uint32_t maxRequestsPerLaunch; ///< 1 to the create-info's value.
    uint64_t failureRetryDelayNs;  ///< Nanoseconds. 0: at once. UINT64_MAX: never.
    bool noEviction;               ///< The LOD bias becomes 0, too.
    bool noLodBias;                ///< The LOD bias becomes 0 with the next launch.
    uint32_t forgetAfterLaunches;  ///< 0: only when memory is short.
} SluiceDemandLoaderSettings;

/**
 * Gets the settings in use, or those last set. Set structSize first.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetDemandLoaderSettings(const SluiceDemandLoader *loader,
                                                      SluiceDemandLoaderSettings *pSettings);

/**
 * Changes all settings. Get them, change fields, and set them. They take effect when the next
 * launch begins. Recordings of the loader hold the changes.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a value
 *         out of range or a wrong structSize. Nothing has changed after an error.
 */
SLUICE_API SluiceResult sluiceSetDemandLoaderSettings(SluiceDemandLoader *loader,
                                                      const SluiceDemandLoaderSettings *pSettings);

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

/** How a texture is sampled. All zero: trilinear, with the source's address modes. */
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
 * the texture is open; otherwise it is logged and loads nothing. All else is as
 * sluicePreloadDemandTexture does it: nothing is evicted, and what could not be read is not tried
 * again. sluiceWaitDemandRegion (demand_query.h) waits for the rectangle.
 *
 * Errors: as sluicePreloadDemandTexture; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for an
 *         empty rectangle.
 */
SLUICE_API SluiceResult sluicePreloadDemandRegion(SluiceDemandLoader *loader,
                                                  SluiceDemandTextureId textureId,
                                                  const SluiceImageRegion *pRegion,
                                                  SluiceDemandTicket *pTicket);

/** Byte page that commands write. Never grows. */
typedef struct SluiceBytePageTarget {
    uint32_t page;           ///< Page of the resource.
    uint64_t offset;         ///< Byte in the buffer where the page begins, a multiple of 16.
    VkDeviceAddress address; ///< Its address. 0 without bufferDeviceAddress.
} SluiceBytePageTarget;

/** Byte pages to be written by commands of the application. All lie in one buffer. Pointers are
 *  valid during the call. */
typedef struct SluiceBytePageBatch {
    uint32_t structSize; ///< Set by Sluice. sizeof(SluiceBytePageBatch).
    SluiceDemandResourceId resourceId;
    VkCommandBuffer commandBuffer; ///< That of sluiceBeginDemandLaunch.
    uint64_t launchIndex;          ///< As SluiceDemandLaunch.launchIndex.
    VkBuffer buffer;               ///< Storage buffer and target of transfers.
    uint32_t pageSize;             ///< Bytes of each page.
    uint32_t pageCount;
    const SluiceBytePageTarget *pPages;
} SluiceBytePageBatch;

/**
 * Resource: pages with data of the application, such as vertices, acceleration structures,
 * materials. A page is a value of 64 bits that pfnFill computes, or pageSize bytes in GPU memory
 * that pfnRead writes (a byte page).
 */
typedef struct SluiceDemandResourceCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceDemandResourceCreateInfo).
    uint32_t pageCount;  ///< At least 1.
    uint32_t rank;       ///< Priority, 0 to 15. Lower ranks are served first.
    /**
     * Most resident pages. The least recently used ones are evicted. Default: all pages. Byte pages
     * are also evicted when byteMemoryBudget is exhausted, by pages of all resources that have no
     * limit of their own.
     */
    uint32_t maxResidentPageCount;
    void *pUserData;
    /**
     * Computes the value that shaders get for a page, 0 to pageCount - 1. Must be NULL if pageSize
     * is not 0. NULL: you answer pages that were missed (sluiceGetMissedDemandPages). Called on
     * worker threads, several at the same time. SLUICE_NOT_READY: called again at once (readRetry),
     * and later when a shader next misses the page. Other failures: called again after
     * failureRetryDelayNs.
     */
    SluiceResult (*pfnFill)(void *pUserData, uint32_t page, uint64_t *pValue);
    /**
     * Releases a value that no launch reads any more. May be NULL. Called on any thread that uses
     * the loader. NULL if pageSize is not 0.
     */
    void (*pfnEvict)(void *pUserData, uint32_t page, uint64_t value);
    /**
     * Bytes of a page, at most 2^20. 0: pages are values. Pages begin at multiples of 16 bytes in
     * memory. Pages above 64 KiB occupy 1 MiB of staging memory each while they are read.
     */
    uint32_t pageSize;
    /**
     * Shaders get the place of a byte page as offset and buffer even if the loader has
     * bufferDeviceAddress: the low 32 bits of the value are the byte offset, the high 32 bits the
     * index of the buffer (sluiceGetDemandByteBuffers). Without bufferDeviceAddress they always do.
     */
    bool byteOffsets;
    /**
     * Writes all `size` bytes of a page, pageSize of them, into staging memory. Must be NULL if
     * pageSize is 0. NULL: you answer pages that were missed. Threads and errors as for pfnFill.
     * The memory is write-only: reading it back is slow.
     */
    SluiceResult (*pfnRead)(void *pUserData, uint32_t page, uint32_t size, void *pBytes);
    /**
     * Records commands that write all bytes of the pages of a batch, in place of pfnRead. Must be
     * NULL if pageSize is 0 or pfnRead is set. sluiceBeginDemandLaunch calls it on its thread.
     * Answers, barriers and rules are those of SluiceTileProducer.pfnRecordTiles (vulkan.h): a page
     * is shown when the launch that wrote it was processed, a page that failed is asked for again
     * after failureRetryDelayNs, and shaders see it as missing until then.
     */
    SluiceResult (*pfnRecordPages)(void *pUserData, const SluiceBytePageBatch *pBatch,
                                   SluiceResult *pResults);
    /** Launches in which a page may answer SLUICE_NOT_READY before it has failed. Default: 64. */
    uint32_t timeoutLaunches;
} SluiceDemandResourceCreateInfo;

/**
 * Adds a resource. Shaders address its pages as `*pFirstPage` + page, with the functions of
 * shaders/include/sluice/demand_pages.glsl and demand_bytes.glsl.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for values
 *         out of range or a callback of the other kind of page; SLUICE_ERROR_LIMIT_EXCEEDED above
 *         pageCapacity, for more than 253 resources with maxResidentPageCount, or for more than
 *         256 sizes of pages in the life of a loader, rounded up to 16 bytes;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. For a pageSize above 64 KiB also
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY and SLUICE_ERROR_VULKAN.
 */
SLUICE_API SluiceResult sluiceAddDemandResource(SluiceDemandLoader *loader,
                                                const SluiceDemandResourceCreateInfo *pCreateInfo,
                                                SluiceDemandResourceId *pResourceId,
                                                uint32_t *pFirstPage);
/**
 * Removes a resource. Waits for its fills in progress.
 *
 * Its values are evicted when the launches begun so far are processed, at the latest when the
 * loader is destroyed. Keep pUserData until then.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE or SLUICE_ERROR_STALE_TEXTURE for
 *         an unknown or removed resource.
 */
SLUICE_API SluiceResult sluiceRemoveDemandResource(SluiceDemandLoader *loader,
                                                   SluiceDemandResourceId resourceId);
/**
 * Drops the values of `count` pages of a resource, from `firstPage` on. They are filled again when
 * next missed.
 *
 * Errors: as sluiceRemoveDemandResource; SLUICE_ERROR_INVALID_ARGUMENT beyond pageCount.
 */
SLUICE_API SluiceResult sluiceInvalidateDemandPages(SluiceDemandLoader *loader,
                                                    SluiceDemandResourceId resourceId,
                                                    uint32_t firstPage, uint32_t count);

/**
 * Makes `count` byte pages of a resource with pfnRecordPages again, from `firstPage` on, because
 * their content has changed. As sluiceRemakeDemandTiles: resident pages are written in place, and
 * launches see the old content until then.
 *
 * Errors: as sluiceRemoveDemandResource; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, beyond
 *         pageCount or without pfnRecordPages; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceRemakeDemandPages(SluiceDemandLoader *loader,
                                                SluiceDemandResourceId resourceId,
                                                uint32_t firstPage, uint32_t count);

/**
 * Lists pages that launches missed, of a resource without pfnFill and pfnRead. Pages of earlier
 * launches come first, and those of one launch ascend.
 *
 * A page is listed once, and not again until you answer it and it is missed anew. Answer with
 * sluiceSetDemandPageValue or sluiceSetDemandPageBytes, whenever you like. Until then
 * SluiceDemandRequests.missingCount includes it. To leave a page without an answer, call
 * sluiceInvalidateDemandPages: it is listed again when it is missed again. That call also takes an
 * answer back.
 *
 * Set `*pPageCount` to the capacity of `pPages`. The call sets it to the number of pages written.
 * Pages count from 0 within the resource. Returns SLUICE_INCOMPLETE if there are more.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE or SLUICE_ERROR_STALE_TEXTURE for
 *         an unknown or removed resource.
 */
SLUICE_API SluiceResult sluiceGetMissedDemandPages(SluiceDemandLoader *loader,
                                                   SluiceDemandResourceId resourceId,
                                                   uint32_t *pPageCount, uint32_t *pPages);
/**
 * Sets the value of a page of a resource with values. Shaders see it from the next launch on. The
 * page need not have been missed, and the resource may have a pfnFill. A value that the page had is
 * released (pfnEvict) when no launch reads it any more, and so is this one later.
 *
 * The page is evicted like others, and then missed again. `pinned`: it is never evicted, until it
 * is set again or invalidated. Pinned pages count against maxResidentPageCount.
 *
 * Returns SLUICE_NOT_READY, with nothing changed, if the page is being filled. Also returns it if
 * all maxResidentPageCount pages are pinned, awaited or used by the last launch: the page is then
 * missing.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, beyond pageCount or for a resource
 *         with bytes; SLUICE_ERROR_OUT_OF_HOST_MEMORY: the page may then have no value.
 */
SLUICE_API SluiceResult sluiceSetDemandPageValue(SluiceDemandLoader *loader,
                                                 SluiceDemandResourceId resourceId, uint32_t page,
                                                 uint64_t value, bool pinned);
/**
 * Sets the bytes of a page of a resource with bytes: copies pageSize bytes into staging memory. The
 * next launch copies them into GPU memory, and shows them. Otherwise as sluiceSetDemandPageValue.
 * Pinned pages count against byteMemoryBudget.
 *
 * Returns SLUICE_NOT_READY, with nothing changed, if the page is being read or was set a moment
 * ago, or if no staging memory is free: begin a launch, and call again. Also returns it if no slot
 * is free: the page is then missing.
 *
 * Errors: as sluiceSetDemandPageValue; SLUICE_ERROR_INVALID_ARGUMENT for a resource with values.
 */
SLUICE_API SluiceResult sluiceSetDemandPageBytes(SluiceDemandLoader *loader,
                                                 SluiceDemandResourceId resourceId, uint32_t page,
                                                 const void *pBytes, bool pinned);

/** Storage buffers for shaders. The handles never change during the loader's life. */
typedef struct SluiceDemandBuffers {
    uint32_t structSize; ///< sizeof(SluiceDemandBuffers).
    VkBuffer textures;   ///< SluiceDemandTexture[], read.
    VkBuffer levels;     ///< uint[], read.
    VkBuffer directory;  ///< uint[], read.
    VkBuffer blocks;     ///< uint[], read.
    VkBuffer masks;      ///< SluiceDemandBlockMasks[], read and written.
    VkBuffer requests;   ///< uint[], read and written.
    VkBuffer sections;   ///< uint[], read and written.
} SluiceDemandBuffers;

/**
 * Gets the buffers that shaders read and write.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetDemandBuffers(const SluiceDemandLoader *loader,
                                               SluiceDemandBuffers *pBuffers);
/**
 * Gets the array of combined image samplers whose layers are tiles, as sluiceGetVulkanPages does.
 *
 * After sluiceBeginDemandLaunch it holds everything that the launch samples. Other calls may add
 * to it.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetDemandPages(const SluiceDemandLoader *loader,
                                             SluiceVulkanPages *pPages);

/** Buffers that hold byte pages. */
typedef struct SluiceDemandByteBuffers {
    uint32_t structSize;      ///< sizeof(SluiceDemandByteBuffers).
    uint32_t bufferCount;     ///< SLUICE_DEMAND_BYTE_CHUNKS (shared/bindings.h): 16.
    const VkBuffer *pBuffers; ///< Owned by the loader. Valid during its life; elements change.
    uint64_t generation;      ///< Differs after elements have changed.
} SluiceDemandByteBuffers;

/**
 * Gets the buffers that hold byte pages, for applications that write their own descriptors. Unused
 * elements are another buffer of the loader.
 *
 * After sluiceBeginDemandLaunch they are those of the launch. A buffer is destroyed only after all
 * launches that had it are processed. The descriptor sets of launches hold them as
 * SLUICE_DEMAND_BINDING_BYTES, except on devices with fewer than 39 storage buffers per shader
 * stage.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetDemandByteBuffers(const SluiceDemandLoader *loader,
                                                   SluiceDemandByteBuffers *pBuffers);

/**
 * Gets the layout of the descriptor sets of launches (SluiceDemandLaunch). The loader owns the
 * layout; it never changes.
 *
 * shaders/include/sluice/demand_bindings.glsl declares what such a set holds: the buffers above and
 * the array of pages. Use the layout in your pipeline layouts, at the set number that your shaders
 * define as SLUICE_DEMAND_SET. All shader stages may use the set.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED, with a log message, if the device
 *         supports fewer samplers per shader stage than maxPageChunkCount. Launches then have no
 *         descriptor set. Set a smaller maxPageChunkCount, or write your own sets.
 */
SLUICE_API SluiceResult sluiceGetDemandDescriptorSetLayout(const SluiceDemandLoader *loader,
                                                           VkDescriptorSetLayout *pLayout);

/** Launch that was begun. */
typedef struct SluiceDemandLaunch {
    uint32_t structSize;   ///< sizeof(SluiceDemandLaunch).
    uint64_t launchIndex;  ///< Counts from 1.
    VkSemaphore semaphore; ///< Timeline semaphore. Your submission must signal it.
    uint64_t signalValue;  ///< Value to signal.
    uint32_t tileCount;    ///< Tiles and byte pages that become resident with this launch.
    /**
     * Holds all that shaders read and write (sluiceGetDemandDescriptorSetLayout). Bind it only in
     * commands of this launch: later launches write it again. The loader owns it.
     */
    VkDescriptorSet descriptorSet;
} SluiceDemandLaunch;

/**
 * Begins a launch: records copies of loaded tiles and updates of the page table.
 *
 * Call outside a render pass. All commands between this call and sluiceEndDemandLaunch see the new
 * tiles; barriers for all stages are recorded. Submit the command buffers in the order of the
 * calls. If launches are on different queues, each must wait until the one before is complete. If
 * you cannot submit, call sluiceAbandonDemandLaunch. After an error, recorded commands
 * have no effect.
 *
 * Returns SLUICE_NOT_READY, with nothing recorded, while launchesInFlight launches are not
 * processed.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the last
 *         launch was neither ended nor abandoned; SLUICE_ERROR_OUT_OF_HOST_MEMORY;
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN; SLUICE_ERROR_DEVICE_LOST;
 *         SLUICE_ERROR_CANCELED after sluiceAbortDemandLoader.
 */
SLUICE_API SluiceResult sluiceBeginDemandLaunch(SluiceDemandLoader *loader,
                                                VkCommandBuffer commandBuffer,
                                                SluiceDemandLaunch *pLaunch);

/**
 * Ends a launch: records the scan of the requests. Binds a compute pipeline and its descriptor set
 * 0.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if no launch was begun.
 */
SLUICE_API SluiceResult sluiceEndDemandLaunch(SluiceDemandLoader *loader,
                                              VkCommandBuffer commandBuffer);

/**
 * Abandons a launch that will never be submitted, and all launches begun after it. Allowed after
 * sluiceBeginDemandLaunch and after sluiceEndDemandLaunch.
 *
 * Do not submit the command buffers. Do not process the launches. Do not wait for their signalValue
 * before the next launch is submitted: the next launch reuses the launchIndex of the first
 * abandoned one.
 *
 * The next launch records again whatever the abandoned launches recorded and is still valid.
 * Nothing is lost, and nothing is read from disk again. After an error the launch is not abandoned.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the
 *         launch is complete, was abandoned or never begun; SLUICE_ERROR_OUT_OF_HOST_MEMORY;
 *         SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN; SLUICE_ERROR_DEVICE_LOST.
 */
SLUICE_API SluiceResult sluiceAbandonDemandLaunch(SluiceDemandLoader *loader,
                                                  const SluiceDemandLaunch *pLaunch);

/** Requests of a launch, in pages. A page counts once, however many samples missed it. */
typedef struct SluiceDemandRequests {
    uint32_t structSize; ///< sizeof(SluiceDemandRequests).
    /**
     * All requested pages, listed or not, except refused pages of resources. 0: every sample was
     * resident, or is as sharp as memory allows.
     */
    uint32_t missingCount;
    uint32_t servedCount;    ///< Reads and fills that begin now, and pages that you are to answer.
    uint32_t pendingCount;   ///< Reads and fills already in progress, and pages that are awaited.
    uint32_t restoredCount;  ///< Evicted pages restored without a read.
    uint32_t postponedCount; ///< Did not fit into the list, or too much is in flight.
    uint32_t refusedCount;   ///< No memory, or unreadable. Coarser levels are used for now.
    float lodBias;           ///< LOD bias of the next launch, in levels; see noLodBias.
} SluiceDemandRequests;

/**
 * Waits until a launch is complete, and starts to load the pages that it missed, coarse pages
 * first.
 *
 * Process each launch once, in order. Processing a launch also processes the launches before it.
 * Returns SLUICE_NOT_READY, with nothing changed, if the launch is not complete after `timeoutNs`
 * nanoseconds. 0: does not wait. UINT64_MAX: waits without limit. `pTicket` may be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a launch that was not ended
 *         or was processed before; SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_VULKAN;
 *         SLUICE_ERROR_DEVICE_LOST; SLUICE_ERROR_CANCELED after sluiceAbortDemandLoader.
 */
SLUICE_API SluiceResult sluiceProcessDemandRequests(SluiceDemandLoader *loader,
                                                    const SluiceDemandLaunch *pLaunch,
                                                    uint64_t timeoutNs,
                                                    SluiceDemandRequests *pRequests,
                                                    SluiceDemandTicket *pTicket);

/** State of a ticket, in tasks: all, not yet ended, failed. */
typedef struct SluiceDemandTicketStatus {
    uint32_t structSize; ///< sizeof(SluiceDemandTicketStatus).
    uint32_t taskCount, remainingCount, failedCount;
} SluiceDemandTicketStatus;

/**
 * Gets the state of a ticket. Zeros for tickets that completed before the last thousand.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for tickets that never existed.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetDemandTicketStatus(SluiceDemandLoader *loader,
                                                    SluiceDemandTicket ticket,
                                                    SluiceDemandTicketStatus *pStatus);
/**
 * Waits until all tasks of a ticket that have begun have ended, successfully or not. Except for
 * preloads these are all tasks. `pStatus` may be NULL.
 *
 * Returns SLUICE_NOT_READY after `timeoutNs` nanoseconds. UINT64_MAX: waits without limit.
 *
 * Errors: as sluiceGetDemandTicketStatus; SLUICE_ERROR_CANCELED after sluiceAbortDemandLoader.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceWaitDemandTicket(SluiceDemandLoader *loader,
                                               SluiceDemandTicket ticket, uint64_t timeoutNs,
                                               SluiceDemandTicketStatus *pStatus);
/**
 * Cancels the tasks of a ticket that have not begun. Shaders may request them again.
 *
 * Errors: as sluiceGetDemandTicketStatus.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCancelDemandTicket(SluiceDemandLoader *loader,
                                                 SluiceDemandTicket ticket);
/**
 * Cancels all tasks that have not begun, and wakes all waiting threads. From then on launches
 * return SLUICE_ERROR_CANCELED. The loader can only be destroyed.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceAbortDemandLoader(SluiceDemandLoader *loader);

/**
 * Statistics of a demand loader. Counts are totals since creation, unless they describe a present
 * state.
 */
typedef struct SluiceDemandStatistics {
    uint32_t structSize; ///< sizeof(SluiceDemandStatistics).
    uint64_t launchCount;
    uint64_t requestCount, pendingCount, servedCount, restoredCount, refusedCount, postponedCount;
    uint64_t evictedCount, failedCount, canceledCount;
    uint64_t texturesCreated, texturesOpened, texturesFailed;
    uint64_t bytesRead;                 ///< Bytes read from sources and resources.
    uint64_t bytesUploaded;             ///< Bytes copied to pages.
    uint64_t virtualPageCount;          ///< Virtual pages that have an id.
    uint64_t residentTileCount;         ///< Mip tails count as tiles.
    uint64_t residentResourcePageCount; ///< Pages with values.
    uint64_t tileMemorySize;            ///< Bytes of device memory for tiles. At most the budget.
    uint64_t deviceMemorySize;          ///< Bytes of all device memory that is not host-mapped.
    float lodBias;                      ///< LOD bias of all textures, in levels.
    /**
     * Reads and fills by time from request to end. Bucket i counts those of less than 2^i us that
     * bucket i - 1 does not; the last bucket counts all others.
     */
    uint64_t latencyHistogram[24];
    uint64_t retriedCount; ///< Failed pages and openings that may be requested again.
    /**
     * Bytes of all mapped memory: staging, tables that the host writes, readback. Grows with the
     * tiles in flight and shrinks again.
     */
    uint64_t hostVisibleMemorySize;
    uint32_t pageChunkCount;     ///< As in SluiceVulkanStreamerStatistics.
    uint64_t pageChunkShortages; ///< As in SluiceVulkanStreamerStatistics.
    /** Tiles resident without a read: another front end of the context had them, or an equal tile
     *  was resident. */
    uint64_t sharedCount;
    uint64_t residentBytePageCount; ///< Byte pages; not part of residentResourcePageCount.
    uint64_t byteMemorySize;        ///< Bytes of device memory for byte pages.
    uint32_t byteChunkCount;        ///< Buffers that hold byte pages.
    uint64_t tailPageCount;         ///< Pages of 64 KiB that resident mip tails share.
    uint64_t texturesForgotten;     ///< See forgetAfterLaunches. They count as opened again later.
    uint64_t producedCount;         ///< Tiles, mip tails and byte pages that commands made.
    uint64_t remadeCount;           ///< Those of them that were resident before.
} SluiceDemandStatistics;

/**
 * Gets the statistics of a loader.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceGetDemandStatistics(SluiceDemandLoader *loader,
                                                  SluiceDemandStatistics *pStatistics);

/**
 * Starts to record a loader into a file that sluice-replay plays without a GPU. docs/replay.md has
 * the format: which pages launches used and requested, when reads ended, and which pages got
 * memory. Neither texels nor shaders nor file names are in it.
 *
 * Call it at any time. If the loader was used before, the state of its pages is written first:
 * about 25 bytes per page of which something is kept. End the recording with sluiceEndRecording,
 * before you destroy the loader. The file is written as by sluiceBeginFileRecording.
 *
 * Returns SLUICE_NOT_READY, with nothing recorded, if no file descriptor is free.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the loader is being recorded;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_BUSY if another writer
 *         has the file open; SLUICE_ERROR_IO.
 * Thread safety: external on `loader`.
 */
SLUICE_API SluiceResult sluiceBeginDemandRecording(SluiceDemandLoader *loader,
                                                   const SluiceFileRecordingInfo *pInfo,
                                                   SluiceRecorder **pRecorder);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DEMAND_H */
