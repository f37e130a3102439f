/** What the pages of a pool hold: for pictures of memory. */
#ifndef SLC_VULKAN_PAGE_SLOTS_H
#define SLC_VULKAN_PAGE_SLOTS_H

#include "vulkan/page_pool.h"

/** Pages of a live chunk. */
struct slc_page_chunk_slots {
    SluiceFormat format;
    uint32_t count;
    uint32_t held, others; ///< by the user, and by all others
};

/** Returns whether the chunk is live. */
bool slc_page_pool_count_slots(struct slc_page_pool *pool, uint32_t user, uint32_t chunk,
                               struct slc_page_chunk_slots *slots);

/** Visits pages that the user gave back, and that nobody has taken since, with the owner of their
 *  texels. The visitor calls nothing of the pool. */
void slc_page_pool_visit_left(struct slc_page_pool *pool, uint32_t user,
                              void (*visit)(void *user_data, uint32_t page, uint32_t owner),
                              void *user_data);

#endif /* SLC_VULKAN_PAGE_SLOTS_H */
