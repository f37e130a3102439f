#include "demand_vulkan/tile_memory.h"

#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

SluiceResult slc_tile_memory_init(struct slc_tile_memory *memory, const struct slc_vk *vk,
                                  const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                  struct slc_page_views *views, uint64_t budget)
{
    uint64_t most = slc_page_chunks_capacity(views->count, caps->max_image_array_layers);
    uint64_t limit = budget / SLC_TILE_SIZE;
    *memory = (struct slc_tile_memory){.limit = limit < most ? limit : most};
    SluiceResult result = slc_page_cache_init(&memory->cache, vk, caps, cb, views);
    memory->cache.max_size = budget;
    return result;
}

void slc_tile_memory_finish(struct slc_tile_memory *memory)
{
    slc_page_cache_finish(&memory->cache);
    *memory = (struct slc_tile_memory){0};
}

static uint32_t take(void *user, uint32_t kind)
{
    struct slc_tile_memory *memory = user;
    uint32_t place = slc_page_cache_take(&memory->cache, (SluiceFormat)kind);
    if (place != SLUICE_PAGE_NONE)
        return place;
    memory->short_of = true;
    memory->wanted = kind;
    memory->cache.hurry = true; /* what is empty may go to another format */
    return SLC_NO_PLACE;
}

static void give(void *user, uint32_t place, uint32_t page)
{
    struct slc_tile_memory *memory = user;
    slc_page_cache_give(&memory->cache, place, page);
}

static bool retake(void *user, uint32_t place, uint32_t page)
{
    struct slc_tile_memory *memory = user;
    return slc_page_cache_retake(&memory->cache, place, page);
}

struct slc_page_memory slc_tile_memory_interface(struct slc_tile_memory *memory)
{
    return (struct slc_page_memory){memory, take, give, retake};
}

uint64_t slc_tile_memory_limit(const struct slc_tile_memory *memory)
{
    uint64_t there = slc_page_cache_layer_count(&memory->cache);
    uint64_t more = slc_page_cache_room(&memory->cache);
    return there + more < memory->limit ? there + more : memory->limit;
}
