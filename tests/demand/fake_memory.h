/** Places in chunks, as page caches have them: a chunk belongs to a kind while a place of it is
 * taken. Places that were given back longest ago are taken first. */
#ifndef TESTS_DEMAND_FAKE_MEMORY_H
#define TESTS_DEMAND_FAKE_MEMORY_H

#include "demand/page_residency.h"

enum { FAKE_PLACES = 8192 };

struct fake_memory {
    uint32_t place_count, chunk_size;
    uint32_t owners[FAKE_PLACES]; ///< of free places: who may retake; SLC_NO_PAGE: nobody
    uint64_t given[FAKE_PLACES];  ///< when it was given back; 0: never taken
    bool taken[FAKE_PLACES];
    uint32_t kinds[FAKE_PLACES]; ///< of chunks
    uint64_t clock, taken_count;
};

void fake_memory_init(struct fake_memory *memory, uint32_t place_count, uint32_t chunk_size);
struct slc_page_memory fake_page_memory(struct fake_memory *memory);

#endif /* TESTS_DEMAND_FAKE_MEMORY_H */
