#include "demand_vulkan/page_directory.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

#include "demand_patch_comp.h"
#include "demand_take_used_comp.h"

#define FIRST_LIST 64u /* initial room for changed entries */

static uint32_t entry_count(const struct slc_page_directory *d)
{
    return (uint32_t)(d->page_capacity / SLUICE_DEMAND_BLOCK_PAGES);
}

/* Returns the bytes of all blocks, including the unused block 0. */
static uint64_t blocks_size(uint32_t block_capacity)
{
    return ((uint64_t)block_capacity + 1) * SLUICE_DEMAND_BLOCK_WORDS * 4;
}

static uint64_t masks_size(uint32_t block_capacity)
{
    return ((uint64_t)block_capacity + 1) * sizeof(struct SluiceDemandBlockMasks);
}

uint64_t slc_page_directory_device_size(const struct slc_page_directory_create_info *info)
{
    return info->page_capacity / SLUICE_DEMAND_BLOCK_PAGES * 4 + blocks_size(info->block_capacity) +
           masks_size(info->block_capacity);
}

static SluiceResult create_buffers(struct slc_page_directory *d)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const struct {
        struct slc_buffer *buffer;
        uint64_t size;
        enum slc_buffer_kind kind;
    } buffers[] = {
        {&d->directory, (uint64_t)entry_count(d) * 4, SLC_BUFFER_DEVICE},
        {&d->blocks, blocks_size(d->block_capacity), SLC_BUFFER_DEVICE},
        {&d->masks, masks_size(d->block_capacity), SLC_BUFFER_DEVICE},
        {&d->readback, (uint64_t)d->slot_count * d->pool.capacity * 4, SLC_BUFFER_READBACK}};
    SluiceResult result = SLUICE_SUCCESS;
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0] && result == SLUICE_SUCCESS; i++)
        result = buffers[i].size > d->caps->max_storage_buffer_range
                     ? SLUICE_ERROR_LIMIT_EXCEEDED
                     : slc_buffer_init(buffers[i].buffer, d->vk, d->caps, buffers[i].size, usage,
                                       buffers[i].kind);
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0] && result == SLUICE_SUCCESS; i++)
        slc_buffer_set_name(buffers[i].buffer, d->vk, "page table");
    return result;
}

static SluiceResult create_passes(struct slc_page_directory *d)
{
    const struct slc_compute_pass patch = {
        slc_demand_patch_comp, sizeof slc_demand_patch_comp, {0}};
    const struct slc_compute_pass take = {
        slc_demand_take_used_comp, sizeof slc_demand_take_used_comp, {0}};
    struct slc_compute_create_info info = {.binding_count = 4,
                                           .push_size = sizeof(struct SluiceDemandPatchParams),
                                           .set_count = d->slot_count,
                                           .passes = &patch,
                                           .pass_count = 1};
    SluiceResult result = slc_compute_init(&d->patch, d->vk, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    info.binding_count = 2;
    info.set_count = 1;
    info.passes = &take;
    result = slc_compute_init(&d->take_used, d->vk, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    const VkBuffer buffers[2] = {d->masks.buffer, d->readback.buffer};
    slc_compute_set_buffers(&d->take_used, d->vk, 0, buffers);
    return SLUICE_SUCCESS;
}

SluiceResult slc_page_directory_init(struct slc_page_directory *dir, const struct slc_vk *vk,
                                     const struct slc_caps *caps,
                                     const SluiceAllocationCallbacks *cb,
                                     const struct slc_page_directory_create_info *info)
{
    assert(info->page_capacity > 0 && info->page_capacity <= (uint64_t)1 << 31);
    assert(info->page_capacity % SLUICE_DEMAND_BLOCK_PAGES == 0);
    assert(info->block_capacity > 0 && info->block_capacity <= SLC_PAGE_BLOCKS_MAX);
    assert(info->slot_count > 0 && info->slot_count <= SLC_COMPUTE_SETS);
    *dir = (struct slc_page_directory){.vk = vk,
                                       .caps = caps,
                                       .cb = *cb,
                                       .page_capacity = info->page_capacity,
                                       .block_capacity = info->block_capacity,
                                       .slot_count = info->slot_count};
    slc_page_blocks_init(&dir->pool, cb, info->block_capacity + 1, info->slot_count);
    dir->entries = slc_calloc(cb, entry_count(dir), sizeof *dir->entries);
    dir->changed_entries =
        slc_calloc(cb, slc_div_up_u32(entry_count(dir), 64), sizeof *dir->changed_entries);
    SluiceResult result =
        dir->entries && dir->changed_entries ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        result = create_buffers(dir);
    if (result == SLUICE_SUCCESS)
        result = create_passes(dir);
    if (result != SLUICE_SUCCESS)
        slc_page_directory_finish(dir);
    return result;
}

void slc_page_directory_finish(struct slc_page_directory *dir)
{
    if (!dir->vk)
        return;
    for (uint32_t i = 0; i < dir->slot_count; i++)
        slc_buffer_finish(&dir->slots[i].upload, dir->vk);
    slc_compute_finish(&dir->take_used, dir->vk);
    slc_compute_finish(&dir->patch, dir->vk);
    slc_buffer_finish(&dir->readback, dir->vk);
    slc_buffer_finish(&dir->masks, dir->vk);
    slc_buffer_finish(&dir->blocks, dir->vk);
    slc_buffer_finish(&dir->directory, dir->vk);
    slc_page_blocks_finish(&dir->pool);
    slc_free(&dir->cb, dir->entry_list, dir->entry_list_capacity, sizeof *dir->entry_list);
    slc_free(&dir->cb, dir->changed_entries, slc_div_up_u32(entry_count(dir), 64),
             sizeof *dir->changed_entries);
    slc_free(&dir->cb, dir->entries, entry_count(dir), sizeof *dir->entries);
    *dir = (struct slc_page_directory){0};
}

bool slc_page_directory_reserve_entries(struct slc_page_directory *dir, uint32_t count)
{
    struct slc_page_directory *d = dir;
    uint32_t needed = d->entry_list_count + d->pool.count + count;
    if (needed <= d->entry_list_capacity)
        return true;
    uint32_t capacity = slc_max_u32(slc_max_u32(FIRST_LIST, needed), 2 * d->entry_list_capacity);
    uint32_t *list =
        slc_regrow(&d->cb, d->entry_list, d->entry_list_capacity, capacity, sizeof *d->entry_list);
    if (!list)
        return false;
    d->entry_list = list;
    d->entry_list_capacity = capacity;
    return true;
}

static void set_entry(struct slc_page_directory *d, uint32_t entry, uint32_t block)
{
    uint64_t *word = &d->changed_entries[entry / 64], bit = (uint64_t)1 << entry % 64;
    d->entries[entry] = block;
    if (*word & bit)
        return;
    assert(d->entry_list_count < d->entry_list_capacity);
    *word |= bit;
    d->entry_list[d->entry_list_count++] = entry;
}

void slc_page_directory_change_entry(struct slc_page_directory *dir, uint32_t entry)
{
    set_entry(dir, entry, dir->entries[entry]);
}

static SluiceResult find_block(struct slc_page_directory *d, uint32_t entry, uint32_t *block)
{
    *block = d->entries[entry];
    if (*block != SLUICE_DEMAND_NO_BLOCK)
        return SLUICE_SUCCESS;
    if (!slc_page_directory_reserve_entries(d, 1))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = slc_page_blocks_take(&d->pool, entry, block);
    if (result == SLUICE_SUCCESS)
        set_entry(d, entry, *block);
    return result;
}

SluiceResult slc_page_directory_show(struct slc_page_directory *dir, uint32_t page, uint64_t value,
                                     bool wide)
{
    assert(page < dir->page_capacity);
    const uint32_t at = page % SLUICE_DEMAND_BLOCK_PAGES, bit = 1u << at;
    uint32_t index;
    SluiceResult result = find_block(dir, page / SLUICE_DEMAND_BLOCK_PAGES, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_page_block *block = &dir->pool.table[index];
    block->resident |= bit;
    block->changed |= bit;
    block->changed_wide = wide ? block->changed_wide | bit : block->changed_wide & ~bit;
    block->words[at] = (uint32_t)value;
    if (wide)
        block->words[SLUICE_DEMAND_BLOCK_PAGES + at] = (uint32_t)(value >> 32);
    slc_page_blocks_mark(&dir->pool, index);
    dir->changed = true;
    return SLUICE_SUCCESS;
}

SluiceResult slc_page_directory_refuse(struct slc_page_directory *dir, uint32_t page)
{
    return slc_page_directory_show(dir, page, SLUICE_DEMAND_PAGE_REFUSED, false);
}

bool slc_page_directory_has(const struct slc_page_directory *dir, uint32_t page)
{
    assert(page < dir->page_capacity);
    uint32_t block = dir->entries[page / SLUICE_DEMAND_BLOCK_PAGES];
    return block != SLUICE_DEMAND_NO_BLOCK &&
           dir->pool.table[block].resident >> page % SLUICE_DEMAND_BLOCK_PAGES & 1;
}

bool slc_page_directory_shows(const struct slc_page_directory *dir, uint32_t page, uint32_t value)
{
    uint32_t block = dir->entries[page / SLUICE_DEMAND_BLOCK_PAGES];
    return slc_page_directory_has(dir, page) &&
           dir->pool.table[block].words[page % SLUICE_DEMAND_BLOCK_PAGES] == value;
}

bool slc_page_directory_shows_wide(const struct slc_page_directory *dir, uint32_t page,
                                   uint64_t value)
{
    uint32_t block = dir->entries[page / SLUICE_DEMAND_BLOCK_PAGES];
    return slc_page_directory_shows(dir, page, (uint32_t)value) &&
           dir->pool.table[block]
                   .words[SLUICE_DEMAND_BLOCK_PAGES + page % SLUICE_DEMAND_BLOCK_PAGES] ==
               (uint32_t)(value >> 32);
}

/* Gives the block of an entry back if it has no shown, refused or kept pages. */
static void give_if_empty(struct slc_page_directory *d, uint32_t entry)
{
    uint32_t index = d->entries[entry];
    if (d->pool.table[index].resident | d->pool.table[index].kept)
        return;
    slc_page_blocks_give(&d->pool, index);
    set_entry(d, entry, SLUICE_DEMAND_NO_BLOCK);
    d->changed = true;
}

SluiceResult slc_page_directory_keep(struct slc_page_directory *dir, uint32_t page)
{
    assert(page < dir->page_capacity);
    uint32_t index;
    SluiceResult result = find_block(dir, page / SLUICE_DEMAND_BLOCK_PAGES, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_page_block *block = &dir->pool.table[index];
    block->kept |= 1u << page % SLUICE_DEMAND_BLOCK_PAGES;
    dir->changed |= block->fresh;
    return SLUICE_SUCCESS;
}

void slc_page_directory_unkeep(struct slc_page_directory *dir, uint32_t page)
{
    assert(page < dir->page_capacity);
    const uint32_t entry = page / SLUICE_DEMAND_BLOCK_PAGES, index = dir->entries[entry];
    const uint32_t bit = 1u << page % SLUICE_DEMAND_BLOCK_PAGES;
    if (index == SLUICE_DEMAND_NO_BLOCK || !(dir->pool.table[index].kept & bit))
        return;
    dir->pool.table[index].kept &= ~bit;
    give_if_empty(dir, entry);
}

void slc_page_directory_hide(struct slc_page_directory *dir, uint32_t page)
{
    if (!slc_page_directory_has(dir, page))
        return;
    const uint32_t entry = page / SLUICE_DEMAND_BLOCK_PAGES, index = dir->entries[entry];
    const uint32_t bit = 1u << page % SLUICE_DEMAND_BLOCK_PAGES;
    struct slc_page_block *block = &dir->pool.table[index];
    block->resident &= ~bit;
    block->changed &= ~bit;
    block->changed_wide &= ~bit;
    slc_page_blocks_mark(&dir->pool, index);
    dir->changed = true;
    give_if_empty(dir, entry);
}
