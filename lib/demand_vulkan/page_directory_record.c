/* Recording of page table changes, and readback of the pages that shaders used. */
#include "demand_vulkan/page_directory.h"

#include "base/bits.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

#define FIRST_UPLOAD 8192u /* initial room for patches */

/* True if the mask must be written. The device's mask of a fresh block is unknown. */
static bool mask_changed(const struct slc_page_block *block)
{
    return block->fresh || block->resident != block->device_resident;
}

static uint64_t count_patches(const struct slc_page_directory *d)
{
    const struct slc_page_blocks *pool = &d->pool;
    uint64_t count = d->entry_list_count;
    for (uint32_t i = 0; (i = slc_page_blocks_next_changed(pool, i)) < pool->room; i++) {
        const struct slc_page_block *block = &pool->table[i];
        if (!slc_page_blocks_is_free(pool, i))
            count += slc_count_ones(block->changed) + slc_count_ones(block->changed_wide) +
                     mask_changed(block) + block->fresh;
    }
    return count;
}

static SluiceResult reserve_upload(struct slc_page_directory *d, uint32_t slot, uint64_t count)
{
    struct slc_buffer *upload = &d->slots[slot].upload;
    uint64_t size = count * sizeof(struct SluiceDemandPatch), room = upload->size;
    if (size <= room && room)
        return SLUICE_SUCCESS;
    if (size > d->caps->max_storage_buffer_range)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    for (room = FIRST_UPLOAD * sizeof(struct SluiceDemandPatch); room < size;)
        room *= 2;
    room = room < d->caps->max_storage_buffer_range ? room : d->caps->max_storage_buffer_range;
    struct slc_buffer bigger;
    SluiceResult result = slc_buffer_init(&bigger, d->vk, d->caps, room,
                                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, SLC_BUFFER_TABLE);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_buffer_finish(upload, d->vk);
    *upload = bigger;
    const VkBuffer buffers[4] = {d->directory.buffer, d->blocks.buffer, d->masks.buffer,
                                 upload->buffer};
    slc_compute_set_buffers(&d->patch, d->vk, slot, buffers);
    return SLUICE_SUCCESS;
}

static struct SluiceDemandPatch *put(struct SluiceDemandPatch *at, uint32_t buffer, uint32_t word,
                                     uint32_t value)
{
    *at = (struct SluiceDemandPatch){word | buffer << SLUICE_PATCH_BUFFER_SHIFT, value};
    return at + 1;
}

static struct SluiceDemandPatch *put_words(struct SluiceDemandPatch *at, uint32_t first,
                                           const uint32_t *words, uint32_t bits)
{
    for (; bits; bits &= bits - 1) {
        uint32_t i = slc_lowest_bit(bits);
        at = put(at, SLUICE_PATCH_BLOCKS, first + i, words[i]);
    }
    return at;
}

/* Writes patches for all words of a block that the device does not have, and clears the marks. */
static struct SluiceDemandPatch *put_block(struct SluiceDemandPatch *at, uint32_t index,
                                           struct slc_page_block *block)
{
    const uint32_t pages = SLUICE_DEMAND_BLOCK_PAGES, first = index * SLUICE_DEMAND_BLOCK_WORDS;
    at = put_words(at, first, block->words, block->changed);
    at = put_words(at, first + pages, block->words + pages, block->changed_wide);
    if (mask_changed(block))
        at = put(at, SLUICE_PATCH_MASKS, 2 * index, block->resident);
    if (block->fresh) /* clears bits that launches of the last owner left */
        at = put(at, SLUICE_PATCH_MASKS, 2 * index + 1, 0);
    block->device_resident = block->resident;
    block->changed = block->changed_wide = 0;
    block->fresh = false;
    return at;
}

static struct SluiceDemandPatch *put_blocks(struct slc_page_directory *d,
                                            struct SluiceDemandPatch *at)
{
    struct slc_page_blocks *pool = &d->pool;
    for (uint32_t i = 0; (i = slc_page_blocks_next_changed(pool, i)) < pool->room; i++) {
        bool free = slc_page_blocks_is_free(pool, i);
        pool->owners[i] = free ? SLC_NO_ENTRY : pool->table[i].entry;
        if (!free)
            at = put_block(at, i, &pool->table[i]);
        if (!free && i >= d->recorded_end)
            d->recorded_end = i + 1;
    }
    while (d->recorded_end && pool->owners[d->recorded_end - 1] == SLC_NO_ENTRY)
        d->recorded_end--;
    return at;
}

static struct SluiceDemandPatch *put_entries(struct slc_page_directory *d,
                                             struct SluiceDemandPatch *at)
{
    for (uint32_t i = 0; i < d->entry_list_count; i++) {
        uint32_t entry = d->entry_list[i];
        at = put(at, SLUICE_PATCH_DIRECTORY, entry, d->entries[entry]);
        d->changed_entries[entry / 64] = 0; /* all set bits are in the list */
    }
    d->entry_list_count = 0;
    return at;
}

static void record_clear(struct slc_page_directory *d, VkCommandBuffer commands)
{
    const VkBuffer buffers[3] = {d->directory.buffer, d->blocks.buffer, d->masks.buffer};
    for (uint32_t i = 0; i < 3; i++)
        d->vk->CmdFillBuffer(commands, buffers[i], 0, VK_WHOLE_SIZE, 0);
    slc_compute_barrier(d->vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                            VK_ACCESS_TRANSFER_READ_BIT);
    d->cleared = true;
}

static void record_dispatch(const struct slc_page_directory *d, const struct slc_compute *compute,
                            VkCommandBuffer commands, uint32_t set,
                            const struct SluiceDemandPatchParams *params)
{
    const VkAccessFlags shaders = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    uint32_t groups = slc_div_up_u32(params->count, SLUICE_PATCH_GROUP_SIZE);
    slc_compute_barrier(d->vk, commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, shaders);
    slc_compute_bind(compute, d->vk, commands, set, params);
    slc_compute_dispatch(compute, d->vk, commands, 0, slc_min_u32(groups, SLUICE_PATCH_ROW),
                         slc_div_up_u32(groups, SLUICE_PATCH_ROW));
    slc_compute_barrier(d->vk, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                        shaders | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_HOST_READ_BIT);
}

SluiceResult slc_page_directory_record(struct slc_page_directory *dir, VkCommandBuffer commands,
                                       uint32_t slot)
{
    assert(slot < dir->slot_count);
    if (dir->changed) {
        SluiceResult result = reserve_upload(dir, slot, count_patches(dir));
        if (result != SLUICE_SUCCESS)
            return result;
    }
    dir->slots[slot].patch_count = 0;
    dir->slots[slot].cleared = !dir->cleared;
    if (!dir->cleared)
        record_clear(dir, commands);
    if (!dir->changed)
        return SLUICE_SUCCESS;
    struct SluiceDemandPatch *first = dir->slots[slot].upload.mapped, *end;
    end = put_entries(dir, put_blocks(dir, first));
    slc_page_blocks_unmark(&dir->pool);
    dir->changed = false;
    const struct SluiceDemandPatchParams params = {(uint32_t)(end - first), 0};
    dir->slots[slot].patch_count = params.count;
    if (params.count)
        record_dispatch(dir, &dir->patch, commands, slot, &params);
    return SLUICE_SUCCESS;
}

/* Marks a word that the device may not have as changed, if its block is in use. Words of free
 * blocks do not matter: the next owner writes all words that count. */
static void change_again(struct slc_page_directory *d, uint32_t buffer, uint32_t word)
{
    const uint32_t pages = SLUICE_DEMAND_BLOCK_PAGES;
    bool mask = buffer == SLUICE_PATCH_MASKS;
    uint32_t index = word / (mask ? 2 : SLUICE_DEMAND_BLOCK_WORDS);
    uint32_t at = word % (mask ? 2 : SLUICE_DEMAND_BLOCK_WORDS);
    if (slc_page_blocks_is_free(&d->pool, index))
        return;
    struct slc_page_block *block = &d->pool.table[index];
    if (mask && at == 0)
        block->device_resident = ~block->resident;
    else if (mask)
        block->fresh = true;
    else if (at < pages)
        block->changed |= block->resident & 1u << at;
    else
        block->changed_wide |= block->resident & 1u << (at - pages);
    slc_page_blocks_mark(&d->pool, index);
}

SluiceResult slc_page_directory_abandon(struct slc_page_directory *dir, uint32_t slot)
{
    const struct slc_page_directory_slot *s = &dir->slots[slot];
    const struct SluiceDemandPatch *patches = s->upload.mapped;
    const uint32_t mask = (1u << SLUICE_PATCH_BUFFER_SHIFT) - 1;
    if (!slc_page_directory_reserve_entries(dir, s->patch_count))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    dir->cleared &= !s->cleared;
    for (uint32_t i = 0; i < s->patch_count; i++) {
        uint32_t buffer = patches[i].target >> SLUICE_PATCH_BUFFER_SHIFT;
        uint32_t word = patches[i].target & mask;
        if (buffer == SLUICE_PATCH_DIRECTORY)
            slc_page_directory_change_entry(dir, word);
        else
            change_again(dir, buffer, word);
    }
    dir->changed |= s->patch_count > 0;
    return SLUICE_SUCCESS;
}

void slc_page_directory_record_used(struct slc_page_directory *dir, VkCommandBuffer commands,
                                    uint32_t slot)
{
    assert(slot < dir->slot_count);
    const struct slc_page_blocks *pool = &dir->pool;
    dir->slots[slot].used_end = dir->recorded_end;
    if (!dir->recorded_end)
        return;
    memcpy(pool->used_owners + (size_t)slot * pool->room, pool->owners,
           dir->recorded_end * sizeof *pool->owners);
    const struct SluiceDemandPatchParams params = {dir->recorded_end, slot * pool->capacity};
    record_dispatch(dir, &dir->take_used, commands, 0, &params);
}

bool slc_page_directory_next_used(const struct slc_page_directory *dir, uint32_t slot,
                                  struct slc_page_used_iterator *iterator, uint32_t *page)
{
    const uint32_t *words = dir->readback.mapped;
    const size_t first =
        (size_t)slot * dir->pool.room; /* there is no table before the first page */
    while (!iterator->bits) {
        if (iterator->block + 1 >= dir->slots[slot].used_end)
            return false;
        uint32_t block = ++iterator->block;
        if (dir->pool.used_owners[first + block] != SLC_NO_ENTRY)
            iterator->bits = words[(size_t)slot * dir->pool.capacity + block];
    }
    *page = dir->pool.used_owners[first + iterator->block] * SLUICE_DEMAND_BLOCK_PAGES +
            slc_lowest_bit(iterator->bits);
    iterator->bits &= iterator->bits - 1;
    return true;
}
