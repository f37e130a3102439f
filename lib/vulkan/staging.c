#include "vulkan/staging.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/memory.h"
#include "vulkan/sparse_layout.h"

#include <assert.h>

#define IDLE_TICKS 120u

void slc_staging_group_init(struct slc_staging_group *group, uint64_t kept_size)
{
    *group = (struct slc_staging_group){.kept_size = kept_size};
    slc_mutex_init(&group->mutex);
}

void slc_staging_group_finish(struct slc_staging_group *group)
{
    assert(!group->first && group->size == 0);
    slc_mutex_finish(&group->mutex);
}

uint32_t slc_staging_block(uint32_t slot)
{
    return slot / SLC_STAGING_BLOCK_SLOTS;
}

uint64_t slc_staging_offset(uint32_t slot)
{
    return (uint64_t)(slot % SLC_STAGING_BLOCK_SLOTS) * SLC_TILE_SIZE;
}

static uint64_t block_size(const struct slc_staging *s, uint32_t index)
{
    uint32_t first = index * SLC_STAGING_BLOCK_SLOTS;
    return (uint64_t)slc_min_u32(SLC_STAGING_BLOCK_SLOTS, s->slot_count - first) * SLC_TILE_SIZE;
}

/* Moves an idle buffer of another member to the block, and counts it there. */
static bool take_idle(struct slc_staging *s, uint32_t index)
{
    struct slc_buffer *to = &s->blocks[index].buffer;
    for (struct slc_staging *other = s->group->first; other; other = other->next)
        for (uint32_t i = 1; other != s && i < other->block_count; i++) {
            struct slc_buffer *from = &other->blocks[i].buffer;
            if (!from->buffer || other->blocks[i].used_count || from->size != block_size(s, index))
                continue;
            slc_memory_move(other->vk, s->vk, &from->memory);
            *to = *from;
            *from = (struct slc_buffer){0};
            s->blocks[index].idle_since = s->tick;
            return true;
        }
    return false;
}

static SluiceResult make_block(struct slc_staging *s, uint32_t index)
{
    s->blocks[index].idle_since = s->tick;
    SluiceResult result =
        slc_buffer_init(&s->blocks[index].buffer, s->vk, s->caps, block_size(s, index),
                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT, SLC_BUFFER_STAGING);
    if (result == SLUICE_SUCCESS)
        s->group->size += block_size(s, index);
    return result;
}

static void free_block(struct slc_staging *s, uint32_t index)
{
    struct slc_buffer *buffer = &s->blocks[index].buffer;
    if (buffer->buffer)
        s->group->size -= block_size(s, index);
    slc_buffer_finish(buffer, s->vk);
}

SluiceResult slc_staging_init(struct slc_staging *staging, struct slc_staging_group *group,
                              const struct slc_vk *vk, const struct slc_caps *caps,
                              const SluiceAllocationCallbacks *cb, uint32_t slot_count)
{
    *staging =
        (struct slc_staging){.group = group,
                             .vk = vk,
                             .caps = caps,
                             .cb = cb,
                             .block_count = slc_div_up_u32(slot_count, SLC_STAGING_BLOCK_SLOTS),
                             .slot_count = slot_count};
    staging->blocks = slc_calloc(cb, staging->block_count, sizeof *staging->blocks);
    if (!staging->blocks)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = SLUICE_SUCCESS;
    slc_mutex_lock(&group->mutex);
    staging->next = group->first;
    group->first = staging;
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < staging->block_count &&
                         (i == 0 || group->size < group->kept_size);
         i++)
        result = make_block(staging, i);
    slc_mutex_unlock(&group->mutex);
    return result;
}

void slc_staging_finish(struct slc_staging *staging)
{
    if (!staging->blocks)
        return;
    struct slc_staging **link = &staging->group->first;
    slc_mutex_lock(&staging->group->mutex);
    while (*link != staging)
        link = &(*link)->next;
    *link = staging->next;
    for (uint32_t i = 0; i < staging->block_count; i++)
        free_block(staging, i);
    slc_mutex_unlock(&staging->group->mutex);
    slc_free(staging->cb, staging->blocks, staging->block_count, sizeof *staging->blocks);
    *staging = (struct slc_staging){0};
}

static bool is_there(const struct slc_staging *staging, uint32_t slot)
{
    return staging->blocks[slc_staging_block(slot)].buffer.buffer;
}

bool slc_staging_is_there(const struct slc_staging *staging, uint32_t slot)
{
    slc_mutex_lock(&staging->group->mutex);
    bool there = is_there(staging, slot);
    slc_mutex_unlock(&staging->group->mutex);
    return there;
}

bool slc_staging_ensure(struct slc_staging *staging, uint32_t slot)
{
    assert(slot < staging->slot_count);
    slc_mutex_lock(&staging->group->mutex);
    uint32_t block = slc_staging_block(slot);
    if (!is_there(staging, slot) && !take_idle(staging, block) && !staging->refused)
        staging->refused = make_block(staging, block) != SLUICE_SUCCESS;
    bool there = is_there(staging, slot);
    slc_mutex_unlock(&staging->group->mutex);
    return there;
}

void slc_staging_take(struct slc_staging *staging, uint32_t slot)
{
    slc_mutex_lock(&staging->group->mutex);
    assert(is_there(staging, slot));
    staging->blocks[slc_staging_block(slot)].used_count++;
    slc_mutex_unlock(&staging->group->mutex);
}

void slc_staging_give(struct slc_staging *staging, uint32_t slot)
{
    struct slc_staging_block *block = &staging->blocks[slc_staging_block(slot)];
    slc_mutex_lock(&staging->group->mutex);
    assert(block->used_count > 0);
    if (--block->used_count == 0)
        block->idle_since = staging->tick;
    slc_mutex_unlock(&staging->group->mutex);
}

void slc_staging_trim(struct slc_staging *staging)
{
    staging->tick++;
    staging->refused = false;
    slc_mutex_lock(&staging->group->mutex);
    for (uint32_t i = 1; i < staging->block_count; i++) {
        const struct slc_staging_block *block = &staging->blocks[i];
        if (block->buffer.buffer && block->used_count == 0 &&
            staging->tick - block->idle_since > IDLE_TICKS &&
            staging->group->size - block->buffer.size >= staging->group->kept_size)
            free_block(staging, i);
    }
    slc_mutex_unlock(&staging->group->mutex);
}

uint8_t *slc_staging_memory(const struct slc_staging *staging, uint32_t slot)
{
    assert(is_there(staging, slot));
    uint8_t *mapped = staging->blocks[slc_staging_block(slot)].buffer.mapped;
    return mapped + slc_staging_offset(slot);
}

VkBuffer slc_staging_buffer(const struct slc_staging *staging, uint32_t slot)
{
    return staging->blocks[slc_staging_block(slot)].buffer.buffer;
}
