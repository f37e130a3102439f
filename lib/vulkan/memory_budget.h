/**
 * Budget of a context, in bytes of device memory for tiles: heaps, pages, images that are resident
 * as a whole. All allocations are counted here, by purpose and by client.
 *
 * A client allocates memory: a streamer, a demand loader, or the context for memory that they
 * share. Refused allocations of a client, and a budget below the memory in use, are pressure on the
 * other clients. Each client reads its share when a frame or launch begins, and releases memory
 * that it does not need.
 */
#ifndef SLC_VULKAN_MEMORY_BUDGET_H
#define SLC_VULKAN_MEMORY_BUDGET_H

#include <sluice/vulkan_context.h>

#include "platform/thread.h"

#define SLC_MEMORY_PURPOSES 7u
#define SLC_NO_MEMORY_LIMIT UINT64_MAX

struct slc_memory_client;

struct slc_memory_budget {
    struct slc_mutex mutex;
    uint64_t limit, device_limit; ///< bytes of tile memory; the smaller one counts
    uint64_t used[SLC_MEMORY_PURPOSES];
    uint32_t block_count;
    uint64_t refused_count; ///< allocations beyond the limit
    struct slc_memory_client *clients;
};

/** Zeroed: counts nothing, and no allocation is refused. */
struct slc_memory_client {
    struct slc_memory_budget *budget; ///< borrowed
    struct slc_memory_client *previous, *next;
    uint64_t device, host;            ///< bytes; `host` is mapped memory, `device` all other
    uint64_t tiles;                   ///< bytes of tile memory, part of `device`
    struct slc_memory_client *source; ///< client whose tile memory this one also uses; NULL: none
    /** Bytes of the largest block of tile memory that was refused since the last begin, and between
     *  the two begins before. */
    uint64_t refused, refused_before;
};

/** True if memory of this purpose counts against the budget. */
bool slc_memory_is_for_tiles(SluiceDeviceMemoryPurpose purpose);

/** Makes a budget without a limit. Errors: OUT_OF_HOST_MEMORY; finish it only after success. */
SluiceResult slc_memory_budget_init(struct slc_memory_budget *budget);
/** Finishes the budget. All clients must be finished. */
void slc_memory_budget_finish(struct slc_memory_budget *budget);

/** Sets the limit: bytes or SLC_NO_MEMORY_LIMIT. Below the memory in use it only causes pressure.
 */
void slc_memory_budget_set_limit(struct slc_memory_budget *budget, uint64_t limit);
/** Sets the bytes that the device can spare at present. The application's limit holds, too. */
void slc_memory_budget_set_device_limit(struct slc_memory_budget *budget, uint64_t limit);
/** Returns the smaller one of both limits. */
uint64_t slc_memory_budget_limit(struct slc_memory_budget *budget);
/** Returns the bytes in use by tiles. */
uint64_t slc_memory_budget_tile_memory(struct slc_memory_budget *budget);
/** Writes all fields except structSize. */
void slc_memory_budget_get(struct slc_memory_budget *budget,
                           SluiceVulkanContextStatistics *statistics);

void slc_memory_client_init(struct slc_memory_client *client, struct slc_memory_budget *budget);
/** Finishes a client that has given back all memory. Does nothing for a zeroed one. */
void slc_memory_client_finish(struct slc_memory_client *client);

/** Counts memory that is about to be allocated. False: it is beyond the budget, and not counted. */
bool slc_memory_client_take(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                            bool mapped, uint64_t size);
/** Counts memory that was freed. */
void slc_memory_client_give(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                            bool mapped, uint64_t size);
/** Gives back memory that the device refused, and puts pressure on the other clients. */
void slc_memory_client_refuse(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                              bool mapped, uint64_t size);

/** Moves memory from the count of `from` to the count of `to`. */
void slc_memory_client_move(struct slc_memory_client *from, struct slc_memory_client *to,
                            SluiceDeviceMemoryPurpose purpose, bool mapped, uint64_t size);
/** Sets another client whose pages `client` uses, too; NULL: none. `client` may be NULL. */
void slc_memory_client_set_source(struct slc_memory_client *client,
                                  struct slc_memory_client *source);
/** Charges the last refusal of `source` to `client`, for which it had asked. NULL: no client,
 * because a smaller allocation sufficed. */
void slc_memory_client_blame(struct slc_memory_client *source, struct slc_memory_client *client);

/** Bytes of tile memory that a client should release; at most what it and its source have. */
struct slc_memory_pressure {
    uint64_t beyond;  ///< must be released: the client's share of the bytes beyond the limit
    uint64_t refused; ///< should be released if not needed: bytes lately refused to other clients
};

/** Returns the pressure on the client; zeros while everything fits. Call once per frame or launch.
 */
struct slc_memory_pressure slc_memory_client_begin(struct slc_memory_client *client);

/** Returns the bytes of tile memory that the client has. 0 without a budget. */
uint64_t slc_memory_client_tiles(struct slc_memory_client *client);
/** Writes the bytes that the client has. `device` and `host` may be NULL. 0 without a budget. */
void slc_memory_client_get(struct slc_memory_client *client, uint64_t *device, uint64_t *host);

#endif /* SLC_VULKAN_MEMORY_BUDGET_H */
