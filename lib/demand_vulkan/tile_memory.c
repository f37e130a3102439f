#include "demand_vulkan/tile_memory.h"

#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

void slc_tile_memory_init(struct slc_tile_memory *memory, struct slc_page_pool *pool, uint32_t user,
                          uint64_t budget)
{
    *memory = (struct slc_tile_memory){.pool = pool, .user = user};
    slc_tile_memory_set_budget(memory, budget);
}

void slc_tile_memory_set_budget(struct slc_tile_memory *memory, uint64_t budget)
{
    const struct slc_page_chunks *chunks = &memory->pool->chunks;
    uint64_t most = slc_page_chunks_capacity(chunks->count, chunks->caps->max_image_array_layers);
    uint64_t limit = budget / SLC_TILE_SIZE;
    memory->limit = limit < most ? limit : most;
}

static uint32_t take(void *user, uint32_t kind)
{
    struct slc_tile_memory *memory = user;
    uint32_t place = SLUICE_PAGE_NONE;
    if (memory->offered)
        place = slc_page_share_take(memory->pool, memory->user, memory->offered);
    memory->offer_taken = place != SLUICE_PAGE_NONE;
    if (memory->offer_taken)
        return place;
    place = slc_page_pool_take(memory->pool, memory->user, (SluiceFormat)kind);
    if (place != SLUICE_PAGE_NONE)
        return place;
    memory->short_of = true;
    memory->wanted = kind;
    slc_page_pool_hurry(memory->pool); /* what is empty may go to another format */
    return SLC_NO_PLACE;
}

static void give(void *user, uint32_t place, uint32_t page)
{
    struct slc_tile_memory *memory = user;
    slc_page_pool_give(memory->pool, memory->user, place, page);
}

static bool retake(void *user, uint32_t place, uint32_t page)
{
    struct slc_tile_memory *memory = user;
    if (memory->offered)
        return false; /* one copy of a tile is enough */
    if (!slc_page_pool_retake(memory->pool, memory->user, place, page))
        return false;
    memory->retaken = place;
    return true;
}

struct slc_page_memory slc_tile_memory_interface(struct slc_tile_memory *memory)
{
    return (struct slc_page_memory){memory, take, give, retake};
}

uint64_t slc_tile_memory_limit(const struct slc_tile_memory *memory)
{
    uint64_t capacity = slc_page_pool_capacity(memory->pool, memory->user);
    return capacity < memory->limit ? capacity : memory->limit;
}
