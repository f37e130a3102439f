/**
 * Pages of one resource that shaders missed and the application answers, in the order of the
 * misses. Each page is listed once. Knows nothing of the loader.
 */
#ifndef SLC_DEMAND_VULKAN_MISSED_PAGES_H
#define SLC_DEMAND_VULKAN_MISSED_PAGES_H

#include "base/map.h"

/** Zeroed: empty. */
struct slc_missed_pages {
    uint32_t *pages; ///< owned; [0, taken) were listed; UINT32_MAX: removed
    uint32_t count, capacity, taken;
    struct slc_map index; ///< page -> index in `pages`; zeroed until the first page
};

void slc_missed_pages_finish(struct slc_missed_pages *missed, const SluiceAllocationCallbacks *cb);
/** Makes room for one more page. Returns false, with nothing changed, without memory. */
bool slc_missed_pages_reserve(struct slc_missed_pages *missed, const SluiceAllocationCallbacks *cb);
/** Adds a page that is not in the list. Requires room. */
void slc_missed_pages_add(struct slc_missed_pages *missed, uint32_t page);
bool slc_missed_pages_has(const struct slc_missed_pages *missed, uint32_t page);
/** Removes a page that is in the list. */
void slc_missed_pages_remove(struct slc_missed_pages *missed, uint32_t page);
/** Lists up to `capacity` pages that were not listed yet. Returns how many. */
uint32_t slc_missed_pages_take(struct slc_missed_pages *missed, uint32_t *pages, uint32_t capacity);
/** True if some pages were not listed yet. */
bool slc_missed_pages_has_more(const struct slc_missed_pages *missed);
/** Removes the page of [first, first + count) that was missed first. Returns false if there is
 * none.
 *  `*at`: 0 in the first call; leave it to later calls. */
bool slc_missed_pages_remove_any(struct slc_missed_pages *missed, uint32_t first, uint32_t count,
                                 uint32_t *at, uint32_t *page);

#endif /* SLC_DEMAND_VULKAN_MISSED_PAGES_H */
