/** Contents of a pool's pages, for pictures of memory. */
#ifndef SLC_VULKAN_PAGE_SLOTS_H
#define SLC_VULKAN_PAGE_SLOTS_H

#include "vulkan/page_pool.h"

/** Pages of a live chunk. */
struct slc_page_chunk_slots {
    SluiceFormat format;
    uint32_t count;
    uint32_t held, others; ///< pages held by the user, and by all other users
};

/** Counts the pages of a chunk. Returns whether the chunk is live. */
bool slc_page_pool_count_slots(struct slc_page_pool *pool, uint32_t user, uint32_t chunk,
                               struct slc_page_chunk_slots *slots);

/** Visits pages that the user gave back and that were not taken since, with the owner of their
 *  texels. The visitor must not call the pool. */
void slc_page_pool_visit_left(struct slc_page_pool *pool, uint32_t user,
                              void (*visit)(void *user_data, uint32_t page, uint32_t owner),
                              void *user_data);

#endif /* SLC_VULKAN_PAGE_SLOTS_H */
