/**
 * Threads and pages that the front ends of a context share. Made with the settings of the context
 * when a front end first needs them, and destroyed with the last front end that uses them.
 */
#ifndef SLC_VULKAN_SHARED_PARTS_H
#define SLC_VULKAN_SHARED_PARTS_H

#include "vulkan/page_pool.h"
#include "vulkan/staging.h"
#include "platform/thread.h"

#include <sluice/loader.h>
#include <sluice/vulkan_context.h>

struct slc_read_pool;

struct slc_shared_parts {
    const struct slc_vk *vk; ///< the context's, with the context as memory client
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    uint32_t thread_count;         ///< 0: the default of tile loaders
    SluiceJobSystem job_system;    ///< without a function: reads run on threads
    SluiceReadPool *read_pool;     ///< owner of the threads; NULL: the context has threads
    uint32_t max_reads_per_source; ///< 0: the default of tile loaders
    uint32_t max_page_chunks;      ///< images of pages
    uint64_t min_tile_memory;      ///< bytes that are allocated ahead
    SluiceTileRetryPolicy retry;   ///< policy for failed reads
    struct slc_mutex mutex;        ///< guards the next four fields
    struct slc_page_pool *pages;
    struct slc_read_pool *threads;
    uint32_t page_users, loader_count;
    struct slc_staging_group staging; ///< has its own mutex
};

/** Copies the settings. Makes no threads and pages yet. */
void slc_shared_parts_init(struct slc_shared_parts *shared, const struct slc_vk *vk,
                           const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                           const SluiceVulkanContextCreateInfo *info);
/** Makes a new context a member of its read pool, and ends the membership. */
void slc_shared_parts_join(struct slc_shared_parts *shared);
void slc_shared_parts_leave(struct slc_shared_parts *shared);
/** True if reads are jobs of the application. */
bool slc_shares_jobs(const struct slc_shared_parts *shared);
/** Finishes the parts. There must be no front ends. */
void slc_shared_parts_finish(struct slc_shared_parts *shared);

/** Returns the pages of the context; makes them for the first user. Errors: OUT_OF_HOST_MEMORY,
 * OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_use_pages(struct slc_shared_parts *shared, struct slc_page_pool **pool);
/** Ends what slc_use_pages began. NULL is allowed. */
void slc_drop_pages(struct slc_shared_parts *shared, struct slc_page_pool *pool);

/** Creates a tile loader on the context's threads. Uses requestCapacity, maxSourceCount and the
 * callbacks of `info`; all other settings are the context's. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_create_shared_loader(struct slc_shared_parts *shared,
                                      const SluiceTileLoaderCreateInfo *info,
                                      SluiceTileLoader **loader);
/** NULL is allowed. */
void slc_destroy_shared_loader(struct slc_shared_parts *shared, SluiceTileLoader *loader);

#endif /* SLC_VULKAN_SHARED_PARTS_H */
