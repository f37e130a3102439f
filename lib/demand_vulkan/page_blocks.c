#include "demand_vulkan/page_blocks.h"

#include "base/alloc.h"
#include "base/bits.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

#define FIRST_ROOM 64u /* multiple of the bits of a word, like every room except the largest */

static uint32_t bit_words(uint32_t room)
{
    return slc_div_up_u32(room, 64);
}

static void set_bit(uint64_t *bits, uint32_t at)
{
    bits[at / 64] |= (uint64_t)1 << at % 64;
}

static void clear_bit(uint64_t *bits, uint32_t at)
{
    bits[at / 64] &= ~((uint64_t)1 << at % 64);
}

/* Returns the first set bit from `from` on, or `end`. */
static uint32_t next_bit(const uint64_t *bits, uint32_t from, uint32_t end)
{
    for (uint32_t word = from / 64; word < bit_words(end); word++) {
        uint64_t left = bits[word];
        if (word == from / 64)
            left &= ~(uint64_t)0 << from % 64;
        if (left)
            return word * 64 + slc_lowest_bit64(left);
    }
    return end;
}

void slc_page_blocks_init(struct slc_page_blocks *blocks, const SluiceAllocationCallbacks *cb,
                          uint32_t capacity, uint32_t slot_count)
{
    *blocks = (struct slc_page_blocks){
        .cb = *cb, .capacity = capacity, .slot_count = slot_count, .free_hint = 1};
}

void slc_page_blocks_finish(struct slc_page_blocks *blocks)
{
    struct slc_page_blocks *b = blocks;
    slc_free(&b->cb, b->table, b->room, sizeof *b->table);
    slc_free(&b->cb, b->free, bit_words(b->room), sizeof *b->free);
    slc_free(&b->cb, b->changed, bit_words(b->room), sizeof *b->changed);
    slc_free(&b->cb, b->owners, b->room, sizeof *b->owners);
    slc_free(&b->cb, b->used_owners, (size_t)b->room * b->slot_count, sizeof *b->used_owners);
    *b = (struct slc_page_blocks){0};
}

static bool allocate(struct slc_page_blocks *b)
{
    b->table = slc_alloc(&b->cb, b->room, sizeof *b->table);
    b->free = slc_calloc(&b->cb, bit_words(b->room), sizeof *b->free);
    b->changed = slc_calloc(&b->cb, bit_words(b->room), sizeof *b->changed);
    b->owners = slc_alloc(&b->cb, b->room, sizeof *b->owners);
    b->used_owners = slc_alloc(&b->cb, (size_t)b->room * b->slot_count, sizeof *b->used_owners);
    return b->table && b->free && b->changed && b->owners && b->used_owners;
}

/* Copies all blocks of `old` to the beginning of `b`. */
static void copy(struct slc_page_blocks *b, const struct slc_page_blocks *old)
{
    if (old->room) {
        memcpy(b->table, old->table, old->room * sizeof *b->table);
        memcpy(b->free, old->free, bit_words(old->room) * sizeof *b->free);
        memcpy(b->changed, old->changed, bit_words(old->room) * sizeof *b->changed);
        memcpy(b->owners, old->owners, old->room * sizeof *b->owners);
        for (uint32_t slot = 0; slot < b->slot_count; slot++)
            memcpy(b->used_owners + (size_t)slot * b->room,
                   old->used_owners + (size_t)slot * old->room, old->room * sizeof *b->owners);
    }
    for (uint32_t i = old->room; i < b->room; i++) {
        b->owners[i] = SLC_NO_ENTRY;
        if (i > 0)
            set_bit(b->free, i);
    }
}

static SluiceResult grow(struct slc_page_blocks *blocks)
{
    if (blocks->room == blocks->capacity)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    struct slc_page_blocks bigger = *blocks, old = *blocks;
    bigger.room = slc_min_u32(blocks->capacity, slc_max_u32(FIRST_ROOM, 2 * blocks->room));
    if (!allocate(&bigger)) {
        slc_page_blocks_finish(&bigger);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    copy(&bigger, blocks);
    *blocks = bigger;
    slc_page_blocks_finish(&old);
    return SLUICE_SUCCESS;
}

SluiceResult slc_page_blocks_take(struct slc_page_blocks *blocks, uint32_t entry, uint32_t *block)
{
    uint32_t found = next_bit(blocks->free, blocks->free_hint, blocks->room);
    if (found == blocks->room) {
        SluiceResult result = grow(blocks);
        if (result != SLUICE_SUCCESS)
            return result;
        found = next_bit(blocks->free, found, blocks->room);
    }
    struct slc_page_block *b = &blocks->table[found];
    b->entry = entry;
    b->resident = b->kept = b->device_resident = b->changed = b->changed_wide = 0;
    b->fresh = true;
    clear_bit(blocks->free, found);
    set_bit(blocks->changed, found);
    blocks->free_hint = found + 1;
    blocks->count++;
    *block = found;
    return SLUICE_SUCCESS;
}

void slc_page_blocks_give(struct slc_page_blocks *blocks, uint32_t block)
{
    assert(block > 0 && !slc_page_blocks_is_free(blocks, block));
    set_bit(blocks->free, block);
    set_bit(blocks->changed, block);
    blocks->free_hint = slc_min_u32(blocks->free_hint, block);
    blocks->count--;
}

void slc_page_blocks_mark(struct slc_page_blocks *blocks, uint32_t block)
{
    set_bit(blocks->changed, block);
}

bool slc_page_blocks_is_free(const struct slc_page_blocks *blocks, uint32_t block)
{
    return blocks->free[block / 64] >> block % 64 & 1;
}

uint32_t slc_page_blocks_next_changed(const struct slc_page_blocks *blocks, uint32_t from)
{
    return next_bit(blocks->changed, from, blocks->room);
}

void slc_page_blocks_unmark(struct slc_page_blocks *blocks)
{
    if (blocks->room)
        memset(blocks->changed, 0, bit_words(blocks->room) * sizeof *blocks->changed);
}
