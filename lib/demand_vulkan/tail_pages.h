/**
 * Pages that mip tails share, and their free slots. A page has slots of one cut (see
 * demand/tail_place.h) for tails of one format. It is taken from the pool for the first tail, and
 * given back with the last one.
 */
#ifndef SLC_DEMAND_VULKAN_TAIL_PAGES_H
#define SLC_DEMAND_VULKAN_TAIL_PAGES_H

#include "base/map.h"
#include "demand/tail_place.h"
#include "vulkan/page_chunks.h"

#include <sluice/image.h>

#define SLC_TAIL_CUTS 8u /* cuts per format: 4 cell sizes, 2 or 3 slots per cell */

struct slc_tail_page;

struct slc_tail_pages {
    const SluiceAllocationCallbacks *cb; ///< borrowed
    struct slc_tail_page *pages;         ///< owned
    uint32_t capacity, high, free;
    struct slc_map index;                            ///< page -> element of `pages`
    uint32_t open[SLC_PAGE_FORMATS * SLC_TAIL_CUTS]; ///< first page with free slots
    uint32_t page_count, tail_count;
};

/** Finish it after an error, too. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_tail_pages_init(struct slc_tail_pages *tails, const SluiceAllocationCallbacks *cb);
void slc_tail_pages_finish(struct slc_tail_pages *tails);

/** Takes a slot in a page that has tails. Returns the word of its page, or SLUICE_PAGE_NONE. */
uint32_t slc_tail_pages_take(struct slc_tail_pages *tails, SluiceFormat format,
                             const struct slc_tail_cut *cut);
/** True if slc_tail_pages_take would find a slot. */
bool slc_tail_pages_has_room(const struct slc_tail_pages *tails, SluiceFormat format,
                             const struct slc_tail_cut *cut);
/** Makes room for slc_tail_pages_add. Returns false without host memory. */
bool slc_tail_pages_reserve(struct slc_tail_pages *tails);
/** Adds a page from the pool, whose slots are free. */
void slc_tail_pages_add(struct slc_tail_pages *tails, uint32_t page, SluiceFormat format,
                        const struct slc_tail_cut *cut);
/** Frees the slot of a word. Returns whether the page has no tails any more. It is removed then. */
bool slc_tail_pages_give(struct slc_tail_pages *tails, uint32_t word);

#endif /* SLC_DEMAND_VULKAN_TAIL_PAGES_H */
