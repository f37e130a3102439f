#include "demand/page_space.h"

#include "base/alloc.h"
#include "base/bits.h"
#include "base/checked.h"
#include "demand/section_runs.h"

#include <sluice/shared/demand.h>

#include <assert.h>
#include <string.h>

#define SECTION SLUICE_DEMAND_SECTION_PAGES
#define BLOCK SLUICE_DEMAND_BLOCK_PAGES
#define NONE UINT32_MAX

static_assert(SECTION / BLOCK == 32, "the blocks of a section are the bits of a word");

/* Section of ids. With free and used blocks, it is in the bin of its rank and longest free run. */
struct section {
    uint32_t free; /* one bit per free block; 0: all used, or all free and in `runs` */
    uint32_t previous, next;
};

struct freed {
    uint64_t launch;
    uint32_t first, count;
};

struct slc_page_space {
    SluiceAllocationCallbacks cb;
    uint64_t capacity, end, used;
    struct slc_section_runs runs;
    struct section *sections; /* owned, [runs.count] */
    uint8_t *ranks;           /* owned, [runs.count] */
    uint32_t bins[SLUICE_DEMAND_RANKS][32];
    uint32_t filled_bins[SLUICE_DEMAND_RANKS]; /* one bit per bin that is not empty */
    uint32_t changed_begin, changed_end;       /* sections whose rank has changed */
    struct freed *freed;                       /* owned ring, oldest first */
    uint32_t freed_capacity, freed_begin, freed_count;
    uint32_t range_count; /* allocated ranges; the ring has room to free them all */
};

SluiceResult slc_page_space_create(const SluiceAllocationCallbacks *cb, uint64_t capacity,
                                   struct slc_page_space **space)
{
    assert(capacity > 0 && capacity <= UINT64_C(1) << 31 && capacity % SECTION == 0);
    SluiceAllocationCallbacks allocator = slc_allocator(cb);
    struct slc_page_space *s = slc_calloc(&allocator, 1, sizeof *s);
    if (!s)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    s->cb = allocator;
    s->capacity = capacity;
    memset(s->bins, 0xFF, sizeof s->bins);
    SluiceResult result = slc_section_runs_init(&s->runs, &s->cb, (uint32_t)(capacity / SECTION));
    if (result == SLUICE_SUCCESS) {
        s->sections = slc_calloc(&s->cb, s->runs.count, sizeof *s->sections);
        s->ranks = slc_calloc(&s->cb, s->runs.count, sizeof *s->ranks);
        if (!s->sections || !s->ranks)
            result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    if (result != SLUICE_SUCCESS) {
        slc_page_space_destroy(s);
        return result;
    }
    *space = s;
    return SLUICE_SUCCESS;
}

void slc_page_space_destroy(struct slc_page_space *space)
{
    if (!space)
        return;
    SluiceAllocationCallbacks cb = space->cb;
    slc_free(&cb, space->sections, space->runs.count, sizeof *space->sections);
    slc_free(&cb, space->ranks, space->runs.count, sizeof *space->ranks);
    slc_free(&cb, space->freed, space->freed_capacity, sizeof *space->freed);
    slc_section_runs_finish(&space->runs, &cb);
    slc_free(&cb, space, 1, sizeof *space);
}

static uint32_t longest_run(uint32_t bits)
{
    uint32_t length = 0;
    for (; bits; bits &= bits << 1)
        length++;
    return length;
}

/* Returns the first of `length` consecutive set bits, which must exist. */
static uint32_t first_run(uint32_t bits, uint32_t length)
{
    for (uint32_t i = 1; i < length; i++)
        bits &= bits >> 1;
    return slc_lowest_bit(bits);
}

static uint32_t block_mask(uint32_t first, uint32_t count)
{
    assert(count > 0 && count < 32 && first + count <= 32);
    return ((1u << count) - 1) << first;
}

static void link_section(struct slc_page_space *s, uint32_t index)
{
    struct section *section = &s->sections[index];
    uint32_t rank = s->ranks[index], bin = longest_run(section->free);
    section->previous = NONE;
    section->next = s->bins[rank][bin];
    if (section->next != NONE)
        s->sections[section->next].previous = index;
    s->bins[rank][bin] = index;
    s->filled_bins[rank] |= 1u << bin;
}

static void unlink_section(struct slc_page_space *s, uint32_t index)
{
    const struct section *section = &s->sections[index];
    uint32_t rank = s->ranks[index], bin = longest_run(section->free);
    if (section->next != NONE)
        s->sections[section->next].previous = section->previous;
    if (section->previous != NONE)
        s->sections[section->previous].next = section->next;
    else
        s->bins[rank][bin] = section->next;
    if (s->bins[rank][bin] == NONE)
        s->filled_bins[rank] &= ~(1u << bin);
}

static void note_changes(struct slc_page_space *s, uint32_t first, uint32_t end)
{
    bool none = s->changed_begin == s->changed_end;
    s->changed_begin = none ? first : slc_min_u32(s->changed_begin, first);
    s->changed_end = none ? end : slc_max_u32(s->changed_end, end);
}

static void set_ranks(struct slc_page_space *s, uint32_t first, uint32_t count, uint32_t rank)
{
    uint32_t end = first + count;
    while (first < end && s->ranks[first] == rank)
        first++;
    while (end > first && s->ranks[end - 1] == rank)
        end--;
    if (first == end)
        return;
    memset(s->ranks + first, (int)rank, end - first);
    note_changes(s, first, end);
}

/* Takes whole sections. Blocks of the last one beyond the range are free for ranges of its rank. */
static bool take_sections(struct slc_page_space *s, uint32_t rank, uint32_t blocks, uint32_t *block)
{
    uint32_t count = slc_div_up_u32(blocks, 32), rest = blocks % 32, first;
    if (!slc_section_runs_take(&s->runs, count, &first))
        return false;
    set_ranks(s, first, count, rank);
    if (rest > 0) {
        s->sections[first + count - 1].free = ~block_mask(0, rest);
        link_section(s, first + count - 1);
    }
    *block = first * 32;
    return true;
}

/* Takes fewer blocks than a section has, from the section where they fit best. */
static bool take_blocks(struct slc_page_space *s, uint32_t rank, uint32_t blocks, uint32_t *block)
{
    uint32_t fits = s->filled_bins[rank] >> blocks;
    if (!fits)
        return false;
    uint32_t index = s->bins[rank][blocks + slc_lowest_bit(fits)];
    struct section *section = &s->sections[index];
    uint32_t at = first_run(section->free, blocks);
    unlink_section(s, index);
    section->free &= ~block_mask(at, blocks);
    if (section->free)
        link_section(s, index);
    *block = index * 32 + at;
    return true;
}

/* Reserves room in the ring to free one more range. */
static bool reserve_freed(struct slc_page_space *s)
{
    uint32_t needed = s->range_count + s->freed_count + 1, capacity = s->freed_capacity;
    if (needed <= capacity)
        return true;
    uint32_t larger = slc_max_u32(64, 2 * capacity);
    struct freed *freed = slc_alloc(&s->cb, larger, sizeof *freed);
    if (!freed)
        return false;
    for (uint32_t i = 0; i < s->freed_count; i++)
        freed[i] = s->freed[(s->freed_begin + i) % capacity];
    slc_free(&s->cb, s->freed, capacity, sizeof *freed);
    s->freed = freed;
    s->freed_capacity = larger;
    s->freed_begin = 0;
    return true;
}

SluiceResult slc_page_space_allocate(struct slc_page_space *space, uint32_t rank, uint64_t count,
                                     uint32_t *first)
{
    assert(rank < SLUICE_DEMAND_RANKS && count > 0);
    if (count > space->capacity)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    if (!reserve_freed(space))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint32_t blocks = (uint32_t)((count + BLOCK - 1) / BLOCK), block;
    if ((blocks >= 32 || !take_blocks(space, rank, blocks, &block)) &&
        !take_sections(space, rank, blocks, &block))
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    *first = block * BLOCK;
    space->range_count++;
    space->used += count;
    if (space->end < *first + count)
        space->end = *first + count;
    return SLUICE_SUCCESS;
}

void slc_page_space_free(struct slc_page_space *space, uint32_t first, uint64_t count,
                         uint64_t launch)
{
    assert(first % BLOCK == 0 && count > 0 && first + count <= space->end);
    assert(space->range_count > 0 && space->freed_count < space->freed_capacity);
    uint32_t last = (space->freed_begin + space->freed_count - 1) % space->freed_capacity;
    if (space->freed_count > 0 && launch < space->freed[last].launch)
        launch = space->freed[last].launch;
    last = (space->freed_begin + space->freed_count) % space->freed_capacity;
    space->freed[last] = (struct freed){launch, first, (uint32_t)count};
    space->freed_count++;
    space->range_count--;
    space->used -= count;
}

static void give_blocks(struct slc_page_space *s, uint32_t index, uint32_t first, uint32_t count)
{
    struct section *section = &s->sections[index];
    uint32_t mask = block_mask(first, count);
    assert((section->free & mask) == 0);
    if (section->free)
        unlink_section(s, index);
    section->free |= mask;
    if (section->free != UINT32_MAX) {
        link_section(s, index);
        return;
    }
    section->free = 0;
    slc_section_runs_give(&s->runs, index, 1);
}

static void release(struct slc_page_space *s, const struct freed *range)
{
    uint32_t block = range->first / BLOCK, blocks = slc_div_up_u32(range->count, BLOCK);
    uint32_t section = block / 32;
    if (blocks >= 32)
        slc_section_runs_give(&s->runs, section, blocks / 32);
    if (blocks % 32)
        give_blocks(s, section + blocks / 32, block % 32, blocks % 32);
}

void slc_page_space_complete(struct slc_page_space *space, uint64_t launch)
{
    while (space->freed_count > 0 && space->freed[space->freed_begin].launch <= launch) {
        release(space, &space->freed[space->freed_begin]);
        space->freed_begin = (space->freed_begin + 1) % space->freed_capacity;
        space->freed_count--;
    }
}

const uint8_t *slc_page_space_ranks(const struct slc_page_space *space)
{
    return space->ranks;
}

bool slc_page_space_take_changes(struct slc_page_space *space, uint32_t *first, uint32_t *count)
{
    *first = space->changed_begin;
    *count = space->changed_end - space->changed_begin;
    space->changed_begin = space->changed_end = 0;
    return *count > 0;
}

void slc_page_space_change_again(struct slc_page_space *space, uint32_t first, uint32_t count)
{
    note_changes(space, first, first + count);
}

uint64_t slc_page_space_end(const struct slc_page_space *space)
{
    return space->end;
}

uint64_t slc_page_space_used(const struct slc_page_space *space)
{
    return space->used;
}
