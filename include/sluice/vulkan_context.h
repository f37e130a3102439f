/**
 * Context: what streamers (vulkan.h) and demand loaders (demand.h) of one Vulkan device share. Part
 * of `sluice-vulkan`.
 *
 * Create one context per VkDevice, then create streamers and demand loaders from it. The
 * application keeps ownership of instance, device and queues. Destroy streamers and demand loaders
 * first, then the context, then the device.
 *
 * Streamers and demand loaders are the front ends of a context. They share loader threads, staging
 * memory and the images of pages. These are made with the settings of the context when a front end
 * first needs them, and destroyed with the last front end. A streamer in paged mode and a demand
 * loader that have the same SluiceImageSource read each tile once and keep it on one page.
 *
 * Submit frames and launches of a context to queues of one family. Queues of other families may
 * sample (pSamplingQueueFamilies), and the library may upload on one of its own (uploadQueue).
 *
 * Front ends of a context may be used on different threads at the same time: a render thread and a
 * thread that traces paths need no lock for Sluice. Use one front end on one thread at a time.
 * Vulkan's rules stay: lock a queue that several threads submit to. pQueueLock gives Sluice the
 * lock for its own calls.
 */
#ifndef SLUICE_VULKAN_CONTEXT_H
#define SLUICE_VULKAN_CONTEXT_H

#include <sluice/loader.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceVulkanContext SluiceVulkanContext;

/** Purpose of a block of device memory. */
typedef enum SluiceDeviceMemoryPurpose {
    /** Images whose memory is resident as a whole: dense mode, packed levels, metadata. */
    SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE = 0,
    /** Heaps of tiles, bound to sparse images. Offsets are multiples of 64 KiB. */
    SLUICE_DEVICE_MEMORY_PURPOSE_HEAP = 1,
    /** Array images whose layers hold tiles: paged mode and demand loading. */
    SLUICE_DEVICE_MEMORY_PURPOSE_PAGES = 2,
    /** Buffers that shaders read and write, and other small things. */
    SLUICE_DEVICE_MEMORY_PURPOSE_TABLE = 3,
    /** Mapped buffers that the host writes and the GPU reads. */
    SLUICE_DEVICE_MEMORY_PURPOSE_STAGING = 4,
    /** Mapped buffers that the GPU writes and the host reads. */
    SLUICE_DEVICE_MEMORY_PURPOSE_READBACK = 5,
    /** Buffers whose slots hold byte pages: demand loading. */
    SLUICE_DEVICE_MEMORY_PURPOSE_BYTES = 6
} SluiceDeviceMemoryPurpose;

/** Block of device memory that is requested from the application. */
typedef struct SluiceDeviceMemoryRequest {
    uint32_t structSize; ///< sizeof(SluiceDeviceMemoryRequest) of the library.
    SluiceDeviceMemoryPurpose purpose;
    uint64_t size;            ///< Bytes.
    uint64_t alignment;       ///< Bytes. Alignment of the offset, a power of two.
    uint32_t memoryTypeIndex; ///< Memory type to allocate from.
    bool mapped;              ///< Map it until it is freed. Its type is host-visible and coherent.
    bool images; ///< For images of VK_IMAGE_TILING_OPTIMAL, else for a buffer or for sparse binds.
    const char *pName; ///< For debuggers. Valid during the call.
    /** Allocate with VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT: shaders get the address of the buffer.
     *  Only for streamers and loaders with bufferDeviceAddress. */
    bool deviceAddress;
} SluiceDeviceMemoryRequest;

/** Block of device memory. Never grows. */
typedef struct SluiceDeviceMemory {
    VkDeviceMemory memory;
    uint64_t offset;   ///< Bytes from the start of `memory`.
    void *pMapped;     ///< The byte at `offset`, if the memory is mapped.
    void *pAllocation; ///< For the application: pfnFree gets it back.
} SluiceDeviceMemory;

/**
 * Functions that allocate and free device memory, for applications with an allocator of their own,
 * such as VMA. Never grows.
 *
 * Called on the threads that use the context's streamers and demand loaders; on several at the same
 * time if these run on several threads. Must not call functions of Sluice.
 */
typedef struct SluiceDeviceMemoryCallbacks {
    void *pUserData;
    /**
     * Allocates a block: a VkDeviceMemory of its own, or a part of one. Fills in `*pMemory` and
     * returns VK_SUCCESS, or returns an error. VK_ERROR_OUT_OF_DEVICE_MEMORY means that Sluice must
     * do with less: tiles stay unloaded, textures coarser.
     */
    VkResult (*pfnAllocate)(void *pUserData, const SluiceDeviceMemoryRequest *pRequest,
                            SluiceDeviceMemory *pMemory);
    /** Frees a block. The GPU does not use it any more, and nothing is bound to it. */
    void (*pfnFree)(void *pUserData, const SluiceDeviceMemory *pMemory);
} SluiceDeviceMemoryCallbacks;

/**
 * Functions that lock queues, for applications that submit on several threads. Never grows.
 *
 * Sluice records into command buffers of the application. It calls vkQueueBindSparse on
 * sparseQueue, in sparse mode, and vkQueueSubmit on uploadQueue, if there is one, both in
 * sluiceBeginStreamingFrame. It calls vkDeviceWaitIdle when a streamer or demand loader waits for
 * work that does not end (vulkan.h, demand.h). All calls are made between pfnLock and pfnUnlock, on
 * the thread that called Sluice.
 *
 * pfnLock may wait. Neither function may call Sluice. A thread that holds a lock which pfnLock
 * takes must not call sluiceBeginStreamingFrame or destroy a streamer or demand loader, unless that
 * lock is recursive.
 */
typedef struct SluiceVulkanQueueLockCallbacks {
    void *pUserData;
    /** Waits until no other thread uses `queue`, and keeps others away from it. VK_NULL_HANDLE
     *  stands for all queues of the device. */
    void (*pfnLock)(void *pUserData, VkQueue queue);
    /** Ends pfnLock with the same `queue`. */
    void (*pfnUnlock)(void *pUserData, VkQueue queue);
} SluiceVulkanQueueLockCallbacks;

/** Settings of a context. A field of zero selects its default. */
typedef struct SluiceVulkanContextCreateInfo {
    uint32_t structSize;             ///< sizeof(SluiceVulkanContextCreateInfo).
    uint32_t queueFamilyIndex;       ///< Family of the queue for frames and launches. Must support
                                     ///< compute.
    VkInstance instance;             ///< Required. Vulkan 1.2.
    VkPhysicalDevice physicalDevice; ///< Required.
    VkDevice device; ///< Required. Vulkan 1.2, with the features of sluiceRequireVulkanFeatures.
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr; ///< Required.
    /** Queue of a family with SPARSE_BINDING; may be the drawing queue. Required for streamers in
     *  sparse mode. */
    VkQueue sparseQueue;
    uint32_t sparseQueueFamilyIndex; ///< Family of sparseQueue. Ignored if sparseQueue is NULL.
    const SluiceAllocationCallbacks *pAllocator; ///< Copied. Default: malloc and free.
    /** Receives the messages of the context and of everything created from it. */
    SluiceLogCallback log;
    /** Allocates every block of device memory. Copied. Default: vkAllocateMemory. */
    const SluiceDeviceMemoryCallbacks *pDeviceMemory;
    /**
     * Bytes of device memory for the tiles of all streamers and demand loaders together: the
     * purposes IMAGE, HEAP, PAGES and BYTES of SluiceDeviceMemoryPurpose. Hard limit, at least
     * 4 MiB. Allocations that exceed it fail as on a device without memory. Default: no limit but
     * those of the streamers and demand loaders (maxHeapCount,
     * SluiceDemandLoaderCreateInfo.memoryBudget).
     */
    uint64_t memoryBudget;
    /**
     * Ignores VK_EXT_memory_budget. Default: false. If the device has the extension, which need not
     * be enabled, every 256th frame or launch asks how much the largest local heap can spare. The
     * answer limits tile memory as memoryBudget does.
     *
     * 1/64 of the heap, at most 128 MiB, is left to others. Smaller changes are ignored. Without
     * the extension the device is not asked.
     */
    bool noDeviceBudget;
    /** Cache for the compute pipelines of the library, so that the application can store it. Must
     *  outlive the context. Default: the context makes one of its own. */
    VkPipelineCache pipelineCache;
    /** Threads that read for all streamers and demand loaders. At most 2^10. Default: one less than
     *  there are processors, at least 2. */
    uint32_t loaderThreadCount;
    /**
     * Most concurrent reads of one source, and so most threads that a stalled source occupies. For
     * a demand loader all openings together count as one source, and so do the fills of one
     * resource. Default: loaderThreadCount - 1, at least 1.
     */
    uint32_t maxReadsPerSource;
    /**
     * Immediate retries of failed reads (loader.h), also of resources that return SLUICE_NOT_READY.
     * After they are used up, a streamer requests the tile again after its retryDelayTicks, and a
     * demand loader after its failureRetryDelayNs.
     */
    SluiceTileRetryPolicy readRetry;
    /**
     * Paged mode and demand loading: most array images for pages. Each holds pages of one texel
     * format. At most 2^10. Default: 64. When all are in use, finer tiles find no page
     * (pageChunkShortages in the statistics). This is also SluiceVulkanPages.viewCount: mind the
     * device's per-stage limits on samplers and sampled images.
     *
     * Sizes: the images of a format have 64, 64, 128, 256, 512, 1024, then 2048 tiles each (4 to
     * 128 MiB). They are smaller if the device lacks memory or supports fewer layers. 64 images
     * hold 120 832 tiles (7.4 GiB) of one format, or 49 152 tiles (3 GiB) of eight formats: the
     * first 2048 tiles of a format take six images.
     */
    uint32_t maxPageChunkCount;
    /**
     * Bytes of staging memory that are kept while idle. A streamer or demand loader makes them at
     * its creation if the context has fewer: at least 4 MiB, at most 64 KiB times its
     * maxLoadsInFlight or maxTilesInFlight. Reads that need more get it in blocks of 4 MiB: an idle
     * block of another front end, or a new one that is freed after 120 idle frames or launches.
     *
     * Staging memory is device memory if the host sees all of it (resizable BAR), else host memory.
     * Making a block takes 0.3 ms on an H200, and about 2 ms in host memory. UINT64_MAX makes all
     * staging memory of each front end at its creation. Default: 4 MiB.
     */
    uint64_t minStagingSize;
    /**
     * Bytes of device memory for tiles that are made before tiles need them, and kept while empty.
     *
     * Images of pages are made when a streamer in paged mode gets its first texture, or a demand
     * loader opens its first one, for the texel format of that texture. Heaps are made when a
     * streamer in sparse mode is created. Dense images need no memory later. A budget or device
     * with less memory gets less. Memory beyond the budget is freed, empty or not.
     *
     * A frame that makes memory takes 32 us per MiB longer on an H200. Leave memory for everything
     * else: images and buffers of the application are not counted. Default: 0.
     */
    uint64_t minTileMemorySize;
    /** Locks queues around the library's use of them. Copied. Default: none; then no other thread
     *  may use sparseQueue while a streamer in sparse mode begins a frame. */
    const SluiceVulkanQueueLockCallbacks *pQueueLock;
    /**
     * Most regions (VkSparseImageMemoryBind and VkSparseMemoryBind) of one vkQueueBindSparse. A
     * frame with more binds makes several calls; each waits for the one before it by a semaphore.
     * Some drivers fail on calls with many regions. Default: 512.
     */
    uint32_t maxBindsPerCall;
    /**
     * Reads in jobs of the application: the context starts no threads. Copied. Default: none.
     *
     * loaderThreadCount is then the most jobs that read at the same time. A job reads once, submits
     * its successor if reads are left, and returns. Jobs are submitted on threads that begin frames
     * and launches, and inside jobs. A thread that waits for reads reads itself while no job runs.
     * Delayed retries begin with frames and launches.
     *
     * Destroying the last streamer or demand loader waits for all submitted jobs: run them on
     * another thread.
     */
    const SluiceJobSystem *pJobSystem;
    /**
     * Queue on which streamers copy the texels of new tiles, for example of a family with
     * VK_QUEUE_TRANSFER_BIT alone. The library submits to it. Drawing does not wait for copies:
     * a tile is shown by the first frame that begins when its copy is complete.
     *
     * Frames still copy some texels themselves: the first levels of new textures, texels that
     * changed (vulkan_control.h), tiles of producers, and rectangles that the granularity of the
     * family (minImageTransferGranularity) forbids. Demand loaders do not use the queue.
     *
     * Images and buffers have VK_SHARING_MODE_CONCURRENT if the family is not queueFamilyIndex.
     * Default: none, frames copy everything.
     */
    VkQueue uploadQueue;
    uint32_t uploadQueueFamilyIndex; ///< Family of uploadQueue. Ignored if uploadQueue is NULL.
    /**
     * Families of further queues that sample textures or use the buffers, for example of async
     * compute. Copied. Images and buffers have VK_SHARING_MODE_CONCURRENT for these families and
     * queueFamilyIndex. At most 6; docs/integrating.md has the order of submissions.
     */
    const uint32_t *pSamplingQueueFamilies;
    uint32_t samplingQueueFamilyCount;
    /**
     * Reads on the threads, or in the jobs, of a pool that contexts of several devices share, and
     * reads each tile once for all of them (loader.h). loaderThreadCount, maxReadsPerSource and
     * pJobSystem must be 0: the pool has these settings. Must outlive the context. Default: the
     * context has threads of its own.
     */
    SluiceReadPool *readPool;
} SluiceVulkanContextCreateInfo;

/**
 * Creates a context.
 *
 * If the instance has VK_EXT_debug_utils, objects of the library have names that begin with
 * "sluice: ".
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a memoryBudget below 4 MiB,
 *         a loaderThreadCount or maxPageChunkCount above its limit, a setting of the read pool
 *         given with one, or a queue family that does not exist or lacks a capability;
 *         SLUICE_ERROR_UNSUPPORTED if instance or device were created for less than Vulkan 1.2;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_OUT_OF_DEVICE_MEMORY; SLUICE_ERROR_VULKAN.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateVulkanContext(const SluiceVulkanContextCreateInfo *pCreateInfo,
                                                  SluiceVulkanContext **pContext);

/**
 * Destroys a context. NULL is allowed.
 *
 * Destroy its streamers and demand loaders first. While one of them exists, this function logs an
 * error and does nothing; the context stays valid, and can be destroyed later.
 *
 * Thread safety: external on `context`.
 */
SLUICE_API void sluiceDestroyVulkanContext(SluiceVulkanContext *context);

/**
 * Sets the memory budget (SluiceVulkanContextCreateInfo.memoryBudget), in bytes. 0: no limit.
 *
 * If more is in use, this call frees nothing, but the next frames and launches do, until the budget
 * holds. Each front end frees its share: tiles that are not wanted first, then wanted ones, finest
 * first, so that the picture becomes coarser. Wanted tiles move together: in sparse mode they are
 * read again, in paged mode they are copied on the GPU, for launches they are read again. Memory is
 * freed when the GPU has finished with it. No memory for tiles is allocated meanwhile.
 *
 * These stay, whatever the budget: images of dense mode, packed levels, heaps with packed tiles,
 * one heap of each streamer in sparse mode and up to as many pages in paged mode, pages that two
 * front ends share, page images with the tail of a texture of a demand loader. Front ends that
 * begin no frames or launches free nothing. A streamer logs one warning when more is in use than
 * the budget and nothing was freed for many frames. The warning names the bytes beyond the budget
 * and their users.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, below
 *         4 MiB.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceSetVulkanMemoryBudget(SluiceVulkanContext *context,
                                                    uint64_t memoryBudget);

/** Device memory of a context: what its streamers and demand loaders have allocated, in bytes. */
typedef struct SluiceVulkanContextStatistics {
    uint32_t structSize;         ///< sizeof(SluiceVulkanContextStatistics).
    uint32_t memoryBlockCount;   ///< Blocks allocated at present.
    uint64_t memoryBudget;       ///< Limit in use of tileMemorySize, in bytes. UINT64_MAX: none.
    uint64_t tileMemorySize;     ///< Sum of the next three and byteMemorySize.
    uint64_t imageMemorySize;    ///< SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE
    uint64_t heapMemorySize;     ///< SLUICE_DEVICE_MEMORY_PURPOSE_HEAP
    uint64_t pageMemorySize;     ///< SLUICE_DEVICE_MEMORY_PURPOSE_PAGES
    uint64_t tableMemorySize;    ///< SLUICE_DEVICE_MEMORY_PURPOSE_TABLE
    uint64_t stagingMemorySize;  ///< SLUICE_DEVICE_MEMORY_PURPOSE_STAGING
    uint64_t readbackMemorySize; ///< SLUICE_DEVICE_MEMORY_PURPOSE_READBACK
    uint64_t refusedBlockCount;  ///< Blocks that did not fit into the budget, since creation.
    uint64_t byteMemorySize;     ///< SLUICE_DEVICE_MEMORY_PURPOSE_BYTES. Part of tileMemorySize.
    /** Bytes of tile memory that the device can spare (noDeviceBudget). UINT64_MAX: unknown.
     *  memoryBudget is not above it. */
    uint64_t deviceMemoryBudget;
} SluiceVulkanContextStatistics;

/**
 * Gets the statistics of a context.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetVulkanContextStatistics(
    SluiceVulkanContext *context, SluiceVulkanContextStatistics *pStatistics);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_CONTEXT_H */
