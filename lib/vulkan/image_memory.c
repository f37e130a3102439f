#include "vulkan/image_memory.h"

#include "base/alloc.h"
#include "base/log.h"
#include "vulkan/memory.h"

#include <string.h>

#define UNIT 256u
#define FIRST_UNITS 256u   /* 64 KiB: first block of a pool */
#define BLOCK_UNITS 32768u /* 8 MiB: largest block */
#define SMALL_UNITS 8192u
#define BLOCK_ALIGNMENT 4096u
#define FIRST_RANGES 15u
/* Alignment of ranges in bytes. Offsets of images with a larger alignment are rounded up. */
#define RANGE_ALIGNMENT (UNIT * SLC_REGION_ALIGNMENT)

static SluiceResult allocate(const struct slc_image_memory *pool, const struct slc_vk *vk,
                             uint64_t size, uint64_t alignment, uint32_t type,
                             struct slc_memory *memory)
{
    const struct slc_memory_request request = {.size = size,
                                               .alignment = alignment,
                                               .type = type,
                                               .purpose = pool->purpose,
                                               .images = true,
                                               .name = "images"};
    VkResult result = slc_memory_allocate(vk, &request, memory);
    if (result != VK_ERROR_OUT_OF_DEVICE_MEMORY)
        return slc_vk_result(vk, result, "vkAllocateMemory for an image");
    if (!pool->quiet && !memory->is_beyond_budget)
        slc_log(&vk->log, SLUICE_LOG_ERROR, "the device has no memory for %llu KiB of %s",
                (unsigned long long)size >> 10,
                pool->purpose == SLUICE_DEVICE_MEMORY_PURPOSE_PAGES ? "pages: textures stay coarser"
                                                                    : "images");
    return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
}

static SluiceResult grow(struct slc_image_memory *pool, const SluiceAllocationCallbacks *cb)
{
    uint32_t capacity = pool->block_capacity ? 2 * pool->block_capacity : 8;
    struct slc_image_block *blocks = slc_calloc(cb, capacity, sizeof *blocks);
    if (!blocks)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (pool->block_capacity)
        memcpy(blocks, pool->blocks, pool->block_capacity * sizeof *blocks);
    slc_free(cb, pool->blocks, pool->block_capacity, sizeof *blocks);
    pool->blocks = blocks;
    pool->block_capacity = capacity;
    return SLUICE_SUCCESS;
}

/* Doubles the pool with each block: few images take little memory, many take few allocations. */
static uint32_t next_block_units(const struct slc_image_memory *pool, uint32_t needed)
{
    uint32_t units = FIRST_UNITS;
    while (units < BLOCK_UNITS && (units < needed || (uint64_t)units * UNIT < pool->total_size))
        units *= 2;
    return units;
}

static SluiceResult add_block(struct slc_image_memory *pool, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb, uint32_t type, uint32_t needed,
                              uint32_t *index)
{
    uint32_t at = 0;
    while (at < pool->block_capacity && pool->blocks[at].memory.memory)
        at++;
    SluiceResult result = at == pool->block_capacity ? grow(pool, cb) : SLUICE_SUCCESS;
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_image_block *block = &pool->blocks[at];
    uint32_t units = next_block_units(pool, needed);
    result = slc_region_arena_init(&block->arena, cb, units, FIRST_RANGES);
    if (result == SLUICE_SUCCESS)
        result = allocate(pool, vk, (uint64_t)units * UNIT, BLOCK_ALIGNMENT, type, &block->memory);
    if (result != SLUICE_SUCCESS) {
        slc_region_arena_finish(&block->arena, cb);
        return result;
    }
    block->type = type;
    pool->total_size += block->memory.size;
    *index = at;
    return SLUICE_SUCCESS;
}

static SluiceResult take_from(struct slc_image_memory *pool, const SluiceAllocationCallbacks *cb,
                              uint32_t block, struct slc_image_place *place)
{
    struct slc_region_arena *arena = &pool->blocks[block].arena;
    if (slc_region_arena_reserve(arena, cb, pool->blocks[block].used + 1) != SLUICE_SUCCESS)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (!slc_region_arena_take(arena, place->count, &place->first))
        return SLUICE_NOT_READY;
    place->block = pool->last = block;
    return SLUICE_SUCCESS;
}

/* Takes a range. Begins with the block that had room last: blocks before it are usually full. */
static SluiceResult take(struct slc_image_memory *pool, const struct slc_vk *vk,
                         const SluiceAllocationCallbacks *cb, uint32_t type,
                         struct slc_image_place *place)
{
    SluiceResult result = SLUICE_NOT_READY;
    for (uint32_t i = 0; i < pool->block_capacity && result == SLUICE_NOT_READY; i++) {
        uint32_t at = (pool->last + i) % pool->block_capacity;
        if (pool->blocks[at].memory.memory && pool->blocks[at].type == type)
            result = take_from(pool, cb, at, place);
    }
    uint32_t block;
    if (result == SLUICE_NOT_READY) {
        result = add_block(pool, vk, cb, type, place->count, &block);
        if (result == SLUICE_SUCCESS)
            result = take_from(pool, cb, block, place);
    }
    return result;
}

SluiceResult slc_image_memory_bind(struct slc_image_memory *pool, const struct slc_vk *vk,
                                   const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                   VkImage image, struct slc_image_place *place)
{
    VkMemoryRequirements memory;
    vk->GetImageMemoryRequirements(vk->device, image, &memory);
    uint32_t type = slc_find_memory_type(&caps->memory, memory.memoryTypeBits, 0,
                                         VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (type == UINT32_MAX || memory.size > slc_device_memory_size(caps))
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    uint64_t size = memory.size;
    if (memory.alignment > RANGE_ALIGNMENT) /* leaves room to round the offset up */
        size += memory.alignment - RANGE_ALIGNMENT;
    *place = (struct slc_image_place){0};
    SluiceResult result;
    VkDeviceSize offset = 0;
    if (size > (uint64_t)SMALL_UNITS * UNIT) {
        result = allocate(pool, vk, memory.size, memory.alignment, type, &place->own);
        if (result != SLUICE_SUCCESS)
            return result;
        pool->total_size += memory.size;
        offset = place->own.offset;
    } else {
        place->count = (uint32_t)((size + UNIT - 1) / UNIT);
        result = take(pool, vk, cb, type, place);
        if (result != SLUICE_SUCCESS) {
            place->count = 0;
            return result;
        }
        pool->blocks[place->block].used++;
        VkDeviceSize first =
            pool->blocks[place->block].memory.offset + (VkDeviceSize)place->first * UNIT;
        offset = (first + memory.alignment - 1) / memory.alignment * memory.alignment;
    }
    VkDeviceMemory from =
        place->own.memory ? place->own.memory : pool->blocks[place->block].memory.memory;
    result = slc_vk_result(vk, vk->BindImageMemory(vk->device, image, from, offset),
                           "vkBindImageMemory");
    if (result != SLUICE_SUCCESS)
        slc_image_memory_release(pool, vk, cb, place);
    return result;
}

void slc_image_memory_release(struct slc_image_memory *pool, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb, struct slc_image_place *place)
{
    pool->total_size -= place->own.size;
    slc_memory_free(vk, &place->own);
    if (place->count) {
        struct slc_image_block *block = &pool->blocks[place->block];
        slc_region_arena_give(&block->arena, place->first, place->count);
        if (--block->used == 0) {
            pool->total_size -= block->memory.size;
            slc_memory_free(vk, &block->memory);
            slc_region_arena_finish(&block->arena, cb);
            *block = (struct slc_image_block){0};
        }
    }
    *place = (struct slc_image_place){0};
}

void slc_image_memory_finish(struct slc_image_memory *pool, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, pool->blocks, pool->block_capacity, sizeof *pool->blocks);
    *pool = (struct slc_image_memory){0};
}
