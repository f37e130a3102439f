/**
 * Memory of tiles: layers of array images as places of pages, within a budget of device memory.
 */
#ifndef SLC_DEMAND_VULKAN_TILE_MEMORY_H
#define SLC_DEMAND_VULKAN_TILE_MEMORY_H

#include "demand/page_residency.h"
#include "demand_vulkan/tail_pages.h"
#include "vulkan/page_sharing.h"

struct slc_tile_memory {
    struct slc_page_pool *pool;         ///< borrowed
    uint32_t user;                      ///< user of `pool`
    uint64_t page_limit;                ///< pages, computed by the last slc_tile_memory_limit
    uint64_t limit;                     ///< tiles that the budget and the chunks hold
    const struct slc_tile_key *offered; ///< key of an equal tile for the page being requested
    bool offer_taken;
    bool awaits;      ///< the page that was requested last waits for an equal tile
    uint32_t retaken; ///< the page that was given back last and taken again
    struct slc_tail_pages tails;
    const struct slc_tail_cut *tail; ///< the page that is requested is a tail; NULL: a tile
    SluiceFormat tail_format;        ///< its format
    bool short_of;                   ///< no place was free for a request since the last check
    uint32_t wanted;                 ///< format of that request
};

/** Initializes for `user` of the pool, added with `budget` bytes. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_tile_memory_init(struct slc_tile_memory *memory, struct slc_page_pool *pool,
                                  uint32_t user, uint64_t budget,
                                  const SluiceAllocationCallbacks *cb);
void slc_tile_memory_finish(struct slc_tile_memory *memory);

/** Sets the budget, in bytes. */
void slc_tile_memory_set_budget(struct slc_tile_memory *memory, uint64_t budget);

/** Returns the functions for slc_residency_set_class. The kind of a page is its format. */
struct slc_page_memory slc_tile_memory_interface(struct slc_tile_memory *memory);

/** Returns the tiles and tails that may be resident at once: tiles that the budget holds, less if
 *  images are larger than their tiles or the device lacks memory. Tails that share a page count
 * once per page, and a requested tail does not count if a page has a slot for it. */
uint64_t slc_tile_memory_limit(struct slc_tile_memory *memory);
/** Returns slc_tile_memory_limit for the pages of its last call and the present tails. No lock. */
uint64_t slc_tile_memory_limit_now(const struct slc_tile_memory *memory);

#endif /* SLC_DEMAND_VULKAN_TILE_MEMORY_H */
