/**
 * The budget of a context, in bytes of device memory for tiles: heaps, pages, images that are
 * resident as a whole. Everything allocated is counted here, by purpose and by client.
 *
 * A client is whoever allocates: a streamer, a demand loader, or the context for what they share.
 * Refused allocations of one client, and a budget below what is in use, are pressure on the others:
 * each reads its share when a frame or launch begins, and releases what it does not need.
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

/** Zeroed: counts nothing and is refused nothing. */
struct slc_memory_client {
    struct slc_memory_budget *budget; ///< borrowed
    struct slc_memory_client *previous, *next;
    uint64_t device, host;            ///< bytes; `host` is mapped memory, `device` all other
    uint64_t tiles;                   ///< bytes of tile memory, part of `device`
    struct slc_memory_client *source; ///< whose tile memory it uses besides its own; NULL: none
    /** The largest block of tile memory, in bytes, that was refused since its last begin, and
     *  between the two before. */
    uint64_t refused, refused_before;
};

/** Whether memory of this purpose counts against the budget. */
bool slc_memory_is_for_tiles(SluiceDeviceMemoryPurpose purpose);

/** Without a limit. Errors: OUT_OF_HOST_MEMORY; finish it only after success. */
SluiceResult slc_memory_budget_init(struct slc_memory_budget *budget);
/** All clients are finished. */
void slc_memory_budget_finish(struct slc_memory_budget *budget);

/** Bytes, or SLC_NO_MEMORY_LIMIT. A limit below what is used is pressure; nothing is taken away. */
void slc_memory_budget_set_limit(struct slc_memory_budget *budget, uint64_t limit);
/** What the device can spare at present, beside the limit that the application has set. */
void slc_memory_budget_set_device_limit(struct slc_memory_budget *budget, uint64_t limit);
/** The smaller one of the two limits. */
uint64_t slc_memory_budget_limit(struct slc_memory_budget *budget);
/** Bytes in use by tiles. */
uint64_t slc_memory_budget_tile_memory(struct slc_memory_budget *budget);
/** All fields but structSize. */
void slc_memory_budget_get(struct slc_memory_budget *budget,
                           SluiceVulkanContextStatistics *statistics);

void slc_memory_client_init(struct slc_memory_client *client, struct slc_memory_budget *budget);
/** All of its memory is given back. A zeroed client is finished with nothing to do. */
void slc_memory_client_finish(struct slc_memory_client *client);

/** Counts memory that is about to be allocated. False: it is beyond the budget, and not counted. */
bool slc_memory_client_take(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                            bool mapped, uint64_t size);
/** It was freed. */
void slc_memory_client_give(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                            bool mapped, uint64_t size);
/** The device refused it: given back, and pressure on others. */
void slc_memory_client_refuse(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                              bool mapped, uint64_t size);

/** Memory that `from` counts is counted by `to` from now on. */
void slc_memory_client_move(struct slc_memory_client *from, struct slc_memory_client *to,
                            SluiceDeviceMemoryPurpose purpose, bool mapped, uint64_t size);
/** The client uses pages of `source` as well; NULL: no more. A NULL client is allowed. */
void slc_memory_client_set_source(struct slc_memory_client *client,
                                  struct slc_memory_client *source);
/** What `source` was refused just now, it had asked for on behalf of `client`; NULL: it got less,
 *  and that is enough. */
void slc_memory_client_blame(struct slc_memory_client *source, struct slc_memory_client *client);

/** Bytes of tile memory that a client should release; at most what it and its source have. */
struct slc_memory_pressure {
    uint64_t beyond;  ///< must go: the client's share of the bytes beyond the limit
    uint64_t refused; ///< should go if the client does not need it: others were refused it lately
};

/** Once per frame or launch. Returns the pressure on this client; zeros while everything fits. */
struct slc_memory_pressure slc_memory_client_begin(struct slc_memory_client *client);

/** Bytes of tile memory that the client has now. 0 without a budget. */
uint64_t slc_memory_client_tiles(struct slc_memory_client *client);
/** Bytes that the client has now. Either may be NULL. 0 without a budget. */
void slc_memory_client_get(struct slc_memory_client *client, uint64_t *device, uint64_t *host);

#endif /* SLC_VULKAN_MEMORY_BUDGET_H */
