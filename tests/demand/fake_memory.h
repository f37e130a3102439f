/** Places in chunks, as in page caches: a chunk belongs to a kind while one of its places is taken.
 * Places that were given back first are taken first. */
#ifndef TESTS_DEMAND_FAKE_MEMORY_H
#define TESTS_DEMAND_FAKE_MEMORY_H

#include "demand/page_residency.h"

enum { FAKE_PLACES = 8192 };

struct fake_memory {
    uint32_t place_count, chunk_size;
    uint32_t owners[FAKE_PLACES]; ///< by free place: page that may restore its content;
                                  ///< SLC_NO_PAGE: none
    uint64_t given[FAKE_PLACES];  ///< time when it was given back; 0: never taken
    bool taken[FAKE_PLACES];
    uint32_t kinds[FAKE_PLACES]; ///< by chunk
    uint64_t clock, taken_count;
};

void fake_memory_init(struct fake_memory *memory, uint32_t place_count, uint32_t chunk_size);
struct slc_page_memory fake_page_memory(struct fake_memory *memory);

#endif /* TESTS_DEMAND_FAKE_MEMORY_H */
