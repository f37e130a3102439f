#include "demand_vulkan/tile_memory.h"

#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

SluiceResult slc_tile_memory_init(struct slc_tile_memory *memory, struct slc_page_pool *pool,
                                  uint32_t user, uint64_t budget,
                                  const SluiceAllocationCallbacks *cb)
{
    *memory = (struct slc_tile_memory){.pool = pool, .user = user};
    slc_tile_memory_set_budget(memory, budget);
    return slc_tail_pages_init(&memory->tails, cb);
}

void slc_tile_memory_finish(struct slc_tile_memory *memory)
{
    slc_tail_pages_finish(&memory->tails);
}

void slc_tile_memory_set_budget(struct slc_tile_memory *memory, uint64_t budget)
{
    const struct slc_page_chunks *chunks = &memory->pool->chunks;
    uint64_t most = slc_page_chunks_capacity(chunks->count, chunks->caps->max_image_array_layers);
    uint64_t limit = budget / SLC_TILE_SIZE;
    memory->limit = limit < most ? limit : most;
}

static uint32_t take_page(struct slc_tile_memory *memory, uint32_t kind)
{
    uint32_t place = slc_page_pool_take(memory->pool, memory->user, (SluiceFormat)kind);
    if (place != SLUICE_PAGE_NONE)
        return place;
    memory->short_of = true;
    memory->wanted = kind;
    slc_page_pool_hurry(memory->pool); /* other formats may have the memory of empty chunks */
    return SLC_NO_PLACE;
}

static uint32_t take_tail(struct slc_tile_memory *memory, uint32_t kind)
{
    struct slc_tail_pages *tails = &memory->tails;
    uint32_t word = slc_tail_pages_take(tails, (SluiceFormat)kind, memory->tail);
    if (word != SLUICE_PAGE_NONE)
        return word;
    if (!slc_tail_pages_reserve(tails))
        return SLC_NO_PLACE;
    uint32_t page = take_page(memory, kind);
    if (page == SLC_NO_PLACE)
        return SLC_NO_PLACE;
    slc_tail_pages_add(tails, page, (SluiceFormat)kind, memory->tail);
    return slc_tail_pages_take(tails, (SluiceFormat)kind, memory->tail);
}

static uint32_t take(void *user, uint32_t kind)
{
    struct slc_tile_memory *memory = user;
    uint32_t place = SLUICE_PAGE_NONE;
    if (memory->tail)
        return take_tail(memory, kind);
    if (memory->offered)
        place = slc_page_share_take(memory->pool, memory->user, memory->offered);
    memory->offer_taken = place != SLUICE_PAGE_NONE;
    return memory->offer_taken ? place : take_page(memory, kind);
}

static void give(void *user, uint32_t place, uint32_t page)
{
    struct slc_tile_memory *memory = user;
    if (!slc_is_tail_word(place))
        slc_page_pool_give(memory->pool, memory->user, place, page);
    else if (slc_tail_pages_give(&memory->tails, place))
        slc_page_pool_give(memory->pool, memory->user, place & SLUICE_DEMAND_PLACE_MASK,
                           SLC_NO_OWNER);
}

static bool retake(void *user, uint32_t place, uint32_t page)
{
    struct slc_tile_memory *memory = user;
    if (memory->offered || slc_is_tail_word(place))
        return false; /* an equal tile is resident, or a tail, whose slots are not kept */
    if (!slc_page_pool_retake(memory->pool, memory->user, place, page))
        return false;
    memory->retaken = place;
    return true;
}

struct slc_page_memory slc_tile_memory_interface(struct slc_tile_memory *memory)
{
    return (struct slc_page_memory){memory, take, give, retake};
}

uint64_t slc_tile_memory_limit(struct slc_tile_memory *memory)
{
    uint64_t capacity = slc_page_pool_capacity(memory->pool, memory->user);
    memory->page_limit = capacity < memory->limit ? capacity : memory->limit;
    return slc_tile_memory_limit_now(memory);
}

uint64_t slc_tile_memory_limit_now(const struct slc_tile_memory *memory)
{
    const struct slc_tail_pages *tails = &memory->tails;
    bool has_room =
        memory->tail && slc_tail_pages_has_room(tails, memory->tail_format, memory->tail);
    return memory->page_limit + tails->tail_count - tails->page_count + has_room;
}
