/**
 * Layers of array images as places of pages, within a budget of device memory.
 */
#ifndef SLC_DEMAND_VULKAN_TILE_MEMORY_H
#define SLC_DEMAND_VULKAN_TILE_MEMORY_H

#include "demand/page_residency.h"
#include "demand_vulkan/tail_pages.h"
#include "vulkan/page_sharing.h"

struct slc_tile_memory {
    struct slc_page_pool *pool;         ///< borrowed
    uint32_t user;                      ///< of the pool
    uint64_t page_limit;                ///< pages, as of the last slc_tile_memory_limit
    uint64_t limit;                     ///< tiles that the budget and the chunks hold
    const struct slc_tile_key *offered; ///< the page that is requested has this page to share
    bool offer_taken;
    bool awaits;      ///< the page that was requested last waits for an equal tile
    uint32_t retaken; ///< the page that was given back last and taken again
    struct slc_tail_pages tails;
    const struct slc_tail_cut *tail; ///< the page that is requested is a tail; NULL: a tile
    SluiceFormat tail_format;        ///< its format
    bool short_of;                   ///< a place was asked for and not there since the last look
    uint32_t wanted;                 ///< the format it was asked for
};

/** `user` of the pool was added with `budget`, bytes. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_tile_memory_init(struct slc_tile_memory *memory, struct slc_page_pool *pool,
                                  uint32_t user, uint64_t budget,
                                  const SluiceAllocationCallbacks *cb);
void slc_tile_memory_finish(struct slc_tile_memory *memory);

/** Sets the budget, in bytes. */
void slc_tile_memory_set_budget(struct slc_tile_memory *memory, uint64_t budget);

/** For slc_residency_set_class: the kind of a page is its format. */
struct slc_page_memory slc_tile_memory_interface(struct slc_tile_memory *memory);

/** Tiles and tails that may be resident at once: fewer tiles than the budget holds where images are
 *  larger than their tiles, or the device has no memory. More, by the tails that share pages: all
 *  but one of each page, and the tail that is requested if a page has a slot for it. */
uint64_t slc_tile_memory_limit(struct slc_tile_memory *memory);
/** slc_tile_memory_limit with the pages of its last call, and the tails of now. Takes no lock. */
uint64_t slc_tile_memory_limit_now(const struct slc_tile_memory *memory);

#endif /* SLC_DEMAND_VULKAN_TILE_MEMORY_H */
