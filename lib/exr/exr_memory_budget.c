#include "exr/exr_memory_budget.h"

#include "base/alloc.h"

#include <assert.h>

SluiceResult sluiceCreateExrMemoryBudget(uint64_t maxSize,
                                         const SluiceAllocationCallbacks *pAllocator,
                                         SluiceExrMemoryBudget **pBudget)
{
    if (!pBudget || !slc_allocator_is_valid(pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    SluiceExrMemoryBudget *budget = slc_calloc(&cb, 1, sizeof *budget);
    if (!budget)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    budget->allocator = cb;
    budget->max_size = maxSize ? maxSize : SLUICE_EXR_DEFAULT_MEMORY_BUDGET;
    atomic_init(&budget->used_size, 0);
    *pBudget = budget;
    return SLUICE_SUCCESS;
}

void sluiceDestroyExrMemoryBudget(SluiceExrMemoryBudget *budget)
{
    if (!budget)
        return;
    assert(atomic_load(&budget->used_size) == 0);
    SluiceAllocationCallbacks cb = budget->allocator;
    slc_free(&cb, budget, 1, sizeof *budget);
}

bool slc_memory_budget_take(SluiceExrMemoryBudget *budget, uint64_t size)
{
    uint64_t used = atomic_load(&budget->used_size);
    do {
        if (size > budget->max_size - used)
            return false;
    } while (!atomic_compare_exchange_weak(&budget->used_size, &used, used + size));
    return true;
}

void slc_memory_budget_give_back(SluiceExrMemoryBudget *budget, uint64_t size)
{
    uint64_t used = atomic_fetch_sub(&budget->used_size, size);
    assert(used >= size);
    (void)used;
}
