/**
 * Pages of one resource that shaders missed and that the application is to answer, in the order in
 * which they were missed. Each is listed once. Knows nothing of the loader.
 */
#ifndef SLC_DEMAND_VULKAN_MISSED_PAGES_H
#define SLC_DEMAND_VULKAN_MISSED_PAGES_H

#include "base/map.h"

/** Zeroed: empty. */
struct slc_missed_pages {
    uint32_t *pages; ///< owned; [0, taken) were listed; SLC_MISSED_NONE: removed since
    uint32_t count, capacity, taken;
    struct slc_map index; ///< of those that were not removed; before the first: zeroed
};

void slc_missed_pages_finish(struct slc_missed_pages *missed, const SluiceAllocationCallbacks *cb);
/** Room for one more. False without memory, with nothing changed. */
bool slc_missed_pages_reserve(struct slc_missed_pages *missed, const SluiceAllocationCallbacks *cb);
/** There is room, and it is not in there. */
void slc_missed_pages_add(struct slc_missed_pages *missed, uint32_t page);
bool slc_missed_pages_has(const struct slc_missed_pages *missed, uint32_t page);
/** It is in there. */
void slc_missed_pages_remove(struct slc_missed_pages *missed, uint32_t page);
/** Up to `capacity` pages that were not listed yet; how many. */
uint32_t slc_missed_pages_take(struct slc_missed_pages *missed, uint32_t *pages, uint32_t capacity);
/** There are pages that were not listed yet. */
bool slc_missed_pages_has_more(const struct slc_missed_pages *missed);
/** Removes one page of [first, first + count), the one that was missed first. False: there is none.
 *  `*at`: 0 at first, and then as it was left. */
bool slc_missed_pages_remove_any(struct slc_missed_pages *missed, uint32_t first, uint32_t count,
                                 uint32_t *at, uint32_t *page);

#endif /* SLC_DEMAND_VULKAN_MISSED_PAGES_H */
