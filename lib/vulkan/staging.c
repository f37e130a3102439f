#include "vulkan/staging.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/sparse_layout.h"

#include <assert.h>

#define IDLE_TICKS 120u

uint32_t slc_staging_block(uint32_t slot)
{
    return slot / SLC_STAGING_BLOCK_SLOTS;
}

uint64_t slc_staging_offset(uint32_t slot)
{
    return (uint64_t)(slot % SLC_STAGING_BLOCK_SLOTS) * SLC_TILE_SIZE;
}

static SluiceResult make_block(struct slc_staging *s, uint32_t index)
{
    uint32_t first = index * SLC_STAGING_BLOCK_SLOTS;
    uint32_t slots = slc_min_u32(SLC_STAGING_BLOCK_SLOTS, s->slot_count - first);
    struct slc_staging_block *block = &s->blocks[index];
    block->idle_since = s->tick;
    return slc_buffer_init(&block->buffer, s->vk, s->caps, (uint64_t)slots * SLC_TILE_SIZE,
                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT, SLC_BUFFER_UPLOAD);
}

SluiceResult slc_staging_init(struct slc_staging *staging, const struct slc_vk *vk,
                              const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                              uint32_t slot_count, uint64_t kept_size)
{
    const uint64_t block_size = (uint64_t)SLC_STAGING_BLOCK_SLOTS * SLC_TILE_SIZE;
    uint64_t kept = kept_size / block_size + (kept_size % block_size != 0);
    *staging =
        (struct slc_staging){.vk = vk,
                             .caps = caps,
                             .cb = cb,
                             .block_count = slc_div_up_u32(slot_count, SLC_STAGING_BLOCK_SLOTS),
                             .slot_count = slot_count};
    staging->kept_count = kept < 1                      ? 1
                          : kept < staging->block_count ? (uint32_t)kept
                                                        : staging->block_count;
    staging->blocks = slc_calloc(cb, staging->block_count, sizeof *staging->blocks);
    SluiceResult result = staging->blocks ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < staging->kept_count; i++)
        result = make_block(staging, i);
    return result;
}

void slc_staging_finish(struct slc_staging *staging)
{
    if (!staging->blocks)
        return;
    for (uint32_t i = 0; i < staging->block_count; i++)
        slc_buffer_finish(&staging->blocks[i].buffer, staging->vk);
    slc_free(staging->cb, staging->blocks, staging->block_count, sizeof *staging->blocks);
    *staging = (struct slc_staging){0};
}

bool slc_staging_is_there(const struct slc_staging *staging, uint32_t slot)
{
    return staging->blocks[slc_staging_block(slot)].buffer.buffer;
}

bool slc_staging_ensure(struct slc_staging *staging, uint32_t slot)
{
    assert(slot < staging->slot_count);
    if (slc_staging_is_there(staging, slot))
        return true;
    if (!staging->refused)
        staging->refused = make_block(staging, slc_staging_block(slot)) != SLUICE_SUCCESS;
    return slc_staging_is_there(staging, slot);
}

void slc_staging_take(struct slc_staging *staging, uint32_t slot)
{
    assert(slc_staging_is_there(staging, slot));
    staging->blocks[slc_staging_block(slot)].used_count++;
}

void slc_staging_give(struct slc_staging *staging, uint32_t slot)
{
    struct slc_staging_block *block = &staging->blocks[slc_staging_block(slot)];
    assert(block->used_count > 0);
    if (--block->used_count == 0)
        block->idle_since = staging->tick;
}

void slc_staging_trim(struct slc_staging *staging)
{
    staging->tick++;
    staging->refused = false;
    for (uint32_t i = staging->kept_count; i < staging->block_count; i++) {
        struct slc_staging_block *block = &staging->blocks[i];
        if (block->buffer.buffer && block->used_count == 0 &&
            staging->tick - block->idle_since > IDLE_TICKS)
            slc_buffer_finish(&block->buffer, staging->vk);
    }
}

uint8_t *slc_staging_memory(const struct slc_staging *staging, uint32_t slot)
{
    assert(slc_staging_is_there(staging, slot));
    uint8_t *mapped = staging->blocks[slc_staging_block(slot)].buffer.mapped;
    return mapped + slc_staging_offset(slot);
}

VkBuffer slc_staging_buffer(const struct slc_staging *staging, uint32_t slot)
{
    return staging->blocks[slc_staging_block(slot)].buffer.buffer;
}
