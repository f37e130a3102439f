/** Memory budget for generated levels, shared by several sources. */
#ifndef SLC_EXR_EXR_MEMORY_BUDGET_H
#define SLC_EXR_EXR_MEMORY_BUDGET_H

#include <sluice/exr.h>

#include <stdatomic.h>

struct SluiceExrMemoryBudget {
    SluiceAllocationCallbacks allocator;
    uint64_t max_size;
    _Atomic uint64_t used_size;
};

/** Reserves `size` bytes; false, without effect, if the rest is smaller. Any thread. */
bool slc_memory_budget_take(SluiceExrMemoryBudget *budget, uint64_t size);

/** Returns `size` reserved bytes to the budget. Any thread. */
void slc_memory_budget_give_back(SluiceExrMemoryBudget *budget, uint64_t size);

#endif /* SLC_EXR_EXR_MEMORY_BUDGET_H */
