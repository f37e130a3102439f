#include "demand_vulkan/pages.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <sluice/shared/demand.h>

#include <string.h>

#define OWNER_SHIFT 29u /* bit position of the kind; the index is below */
#define OWNER_INDEX ((1u << OWNER_SHIFT) - 1)

static uint32_t block_count(uint64_t page_count)
{
    return (uint32_t)((page_count + SLUICE_DEMAND_BLOCK_PAGES - 1) / SLUICE_DEMAND_BLOCK_PAGES);
}

static SluiceResult reserve(SluiceDemandLoader *loader, uint32_t count)
{
    uint32_t old = loader->owner_capacity;
    if (count <= old)
        return SLUICE_SUCCESS;
    uint32_t capacity = slc_max_u32(slc_max_u32(1024, 2 * old), count);
    uint32_t *owners =
        slc_regrow(&loader->cb, loader->owners, old, capacity, sizeof *loader->owners);
    if (!owners)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memset(owners + old, 0, (size_t)(capacity - old) * sizeof *owners);
    loader->owners = owners;
    loader->owner_capacity = capacity;
    return SLUICE_SUCCESS;
}

SluiceResult slc_pages_take(SluiceDemandLoader *loader, uint32_t rank, uint64_t count,
                            enum slc_page_owner owner, uint32_t index, uint32_t *first)
{
    SluiceResult result = slc_page_space_allocate(loader->space, rank, count, first);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t block = *first / SLUICE_DEMAND_BLOCK_PAGES;
    result = reserve(loader, block + block_count(count));
    if (result != SLUICE_SUCCESS) {
        slc_page_space_free(loader->space, *first, count, loader->processed);
        return result;
    }
    loader->space_changed = true; /* sections of the range may have another rank now */
    for (uint32_t i = 0; i < block_count(count); i++)
        loader->owners[block + i] = (uint32_t)owner << OWNER_SHIFT | index;
    return SLUICE_SUCCESS;
}

void slc_pages_give(SluiceDemandLoader *loader, uint32_t first, uint64_t count)
{
    uint32_t block = first / SLUICE_DEMAND_BLOCK_PAGES;
    memset(loader->owners + block, 0, block_count(count) * sizeof *loader->owners);
    slc_page_space_free(loader->space, first, count, loader->launch);
}

enum slc_page_owner slc_pages_find(const SluiceDemandLoader *loader, uint32_t page, uint32_t *index)
{
    uint32_t block = page / SLUICE_DEMAND_BLOCK_PAGES;
    *index = page;
    if (page < loader->texture_page_count)
        return SLC_OWNER_OPENING;
    if (block >= loader->owner_capacity)
        return SLC_OWNER_NOBODY;
    *index = loader->owners[block] & OWNER_INDEX;
    return (enum slc_page_owner)(loader->owners[block] >> OWNER_SHIFT);
}

void slc_pages_forget_requests(SluiceDemandLoader *loader, uint32_t first, uint64_t count)
{
    if (loader->forgotten_count == loader->forgotten_capacity) {
        uint32_t capacity = loader->forgotten_capacity ? 2 * loader->forgotten_capacity : 64;
        struct slc_page_run *runs = slc_regrow(&loader->cb, loader->forgotten,
                                               loader->forgotten_capacity, capacity, sizeof *runs);
        if (!runs)
            return; /* at worst an unnecessary page is loaded */
        loader->forgotten = runs;
        loader->forgotten_capacity = capacity;
    }
    loader->forgotten[loader->forgotten_count++] = (struct slc_page_run){first, count, 0};
}
