/**
 * Ids of pages. A range has one rank; sections of SLUICE_DEMAND_SECTION_PAGES ids have one rank, so
 * that the scan of requests can serve coarse pages of all textures before fine ones.
 *
 * Ranges begin at multiples of SLUICE_DEMAND_BLOCK_PAGES; those of a section or more begin with
 * one, smaller ones lie within one. What is freed is used again, by any rank where a section is
 * free as a whole, once the launches that may still name it are over. Ranges are found in
 * logarithmic time; memory is 40 bytes per section at most, and 16 per range. Knows nothing of
 * textures, devices or time. Externally synchronized.
 */
#ifndef SLC_DEMAND_PAGE_SPACE_H
#define SLC_DEMAND_PAGE_SPACE_H

#include <sluice/base.h>

struct slc_page_space;

/** Ids from 0 on; `capacity` is a multiple of the section size, at most 2^31. `cb` may be NULL:
 * malloc and free. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_space_create(const SluiceAllocationCallbacks *cb, uint64_t capacity,
                                   struct slc_page_space **space);
void slc_page_space_destroy(struct slc_page_space *space);

/** `rank` < SLUICE_DEMAND_RANKS, `count` > 0. Errors, with nothing changed: LIMIT_EXCEEDED if no
 * range of that size is left; OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_space_allocate(struct slc_page_space *space, uint32_t rank, uint64_t count,
                                     uint32_t *first);
/** A range exactly as it was allocated; no launch after `launch` names it. Never fails: room was
 * kept for it. What was freed with a later launch before it is waited for, too. */
void slc_page_space_free(struct slc_page_space *space, uint32_t first, uint64_t count,
                         uint64_t launch);
/** All launches up to this one are over. */
void slc_page_space_complete(struct slc_page_space *space, uint64_t launch);

/** One rank per section, `capacity` / SLUICE_DEMAND_SECTION_PAGES of them, 0 at first; a free
 * section has the rank of its last use. */
const uint8_t *slc_page_space_ranks(const struct slc_page_space *space);
/** Which ranks have changed since the last call: false if none, else the span of sections [*first,
 *  *first + *count) with all of them. */
bool slc_page_space_take_changes(struct slc_page_space *space, uint32_t *first, uint32_t *count);

/** The ranks of these sections count as changed again. */
void slc_page_space_change_again(struct slc_page_space *space, uint32_t first, uint32_t count);

/** One past the last id ever given: nothing beyond is requested. */
uint64_t slc_page_space_end(const struct slc_page_space *space);
uint64_t slc_page_space_used(const struct slc_page_space *space); ///< ids of ranges that exist

#endif /* SLC_DEMAND_PAGE_SPACE_H */
