/**
 * Allocator of page ids. A range has one rank. Sections of SLUICE_DEMAND_SECTION_PAGES ids have one
 * rank, so that the scan of requests can serve coarse pages of all textures before fine ones.
 *
 * Ranges begin at multiples of SLUICE_DEMAND_BLOCK_PAGES. Ranges of a section or more begin at a
 * section; smaller ones are within one section. Freed ids are used again once the launches that may
 * still name them are complete; a section that is free as a whole can get any rank. Ranges are
 * found in logarithmic time. Memory: at most 40 bytes per section, and 16 per range. Knows nothing
 * of textures, devices or time. Externally synchronized.
 */
#ifndef SLC_DEMAND_PAGE_SPACE_H
#define SLC_DEMAND_PAGE_SPACE_H

#include <sluice/base.h>

struct slc_page_space;

/** Creates a space of ids [0, capacity). `capacity`: multiple of the section size, at most 2^31.
 * `cb` may be NULL: malloc and free. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_space_create(const SluiceAllocationCallbacks *cb, uint64_t capacity,
                                   struct slc_page_space **space);
void slc_page_space_destroy(struct slc_page_space *space);

/** Allocates a range. `rank` < SLUICE_DEMAND_RANKS, `count` > 0. Errors, with nothing changed:
 * LIMIT_EXCEEDED if no range of that size is left; OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_space_allocate(struct slc_page_space *space, uint32_t rank, uint64_t count,
                                     uint32_t *first);
/** Frees a range exactly as it was allocated. No launch after `launch` may name it. Never fails:
 * room was reserved. Ranges are reused in the order in which they were freed, whatever their
 * launches. */
void slc_page_space_free(struct slc_page_space *space, uint32_t first, uint64_t count,
                         uint64_t launch);
/** Reuses ranges freed with launches up to this one, which are complete. */
void slc_page_space_complete(struct slc_page_space *space, uint64_t launch);

/** Returns the ranks of all `capacity` / SLUICE_DEMAND_SECTION_PAGES sections, 0 at first. A free
 * section has the rank of its last use. */
const uint8_t *slc_page_space_ranks(const struct slc_page_space *space);
/** Takes the range of sections, [*first, *first + *count), with all ranks that changed since the
 * last call. False if none changed. */
bool slc_page_space_take_changes(struct slc_page_space *space, uint32_t *first, uint32_t *count);

/** Marks the ranks of sections as changed again. */
void slc_page_space_change_again(struct slc_page_space *space, uint32_t first, uint32_t count);

/** Returns one past the last id ever allocated. Ids beyond are never requested. */
uint64_t slc_page_space_end(const struct slc_page_space *space);
uint64_t slc_page_space_used(const struct slc_page_space *space); ///< ids of ranges that exist

#endif /* SLC_DEMAND_PAGE_SPACE_H */
