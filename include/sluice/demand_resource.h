/**
 * Resources of a demand loader: pages with values or bytes of the application. Part of
 * `sluice-vulkan`; included by demand.h.
 *
 * Thread safety, unless a function says otherwise: external on the loader.
 */
#ifndef SLUICE_DEMAND_RESOURCE_H
#define SLUICE_DEMAND_RESOURCE_H

#include <sluice/demand_types.h>
#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

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
     * Answers, barriers and rules: see SluiceTileProducer.pfnRecordTiles (vulkan.h). A page is
     * shown when the launch that wrote it was processed. A page that failed is recorded again after
     * failureRetryDelayNs; shaders see it as missing until then.
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
 * launches come first; pages of one launch ascend.
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

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DEMAND_RESOURCE_H */
