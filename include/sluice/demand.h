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

#include <sluice/demand_resource.h>
#include <sluice/demand_texture.h>
#include <sluice/replay.h>
#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

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
 * Gets the settings that were last set, or else the initial ones. Set structSize first.
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
 * After sluiceBeginDemandLaunch the call returns the buffers of that launch. A buffer is destroyed
 * only after all launches that had it are processed. The descriptor sets of launches hold the
 * buffers as SLUICE_DEMAND_BINDING_BYTES, except on devices with fewer than 39 storage buffers per
 * shader stage.
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
     * Reads and fills by time from request to end. Bucket i counts 2^(i - 1) us to below 2^i us;
     * bucket 0 everything below 1 us, the last bucket all longer times.
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
    uint64_t remadeCount;           ///< Tiles and pages of producedCount that were resident before.
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
