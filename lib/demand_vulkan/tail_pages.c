#include "demand_vulkan/tail_pages.h"

#include "base/alloc.h"
#include "base/none.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#define FIRST_PAGES 16u
#define MASK_BITS 64u
#define MASKS 2u /* 128 bits, for at most 32 cells of 3 slots */

struct slc_tail_page {
    uint64_t free[MASKS]; ///< one bit per free slot
    struct slc_tail_cut cut;
    uint32_t page, list;
    uint32_t previous, next; ///< in the list, while slots are free; free elements by next
};

SluiceResult slc_tail_pages_init(struct slc_tail_pages *tails, const SluiceAllocationCallbacks *cb)
{
    *tails = (struct slc_tail_pages){.cb = cb, .free = SLC_NONE};
    for (uint32_t i = 0; i < SLC_PAGE_FORMATS * SLC_TAIL_CUTS; i++)
        tails->open[i] = SLC_NONE;
    return slc_map_init(&tails->index, cb, FIRST_PAGES);
}

void slc_tail_pages_finish(struct slc_tail_pages *tails)
{
    if (!tails->cb)
        return;
    slc_map_finish(&tails->index, tails->cb);
    slc_free(tails->cb, tails->pages, tails->capacity, sizeof *tails->pages);
    *tails = (struct slc_tail_pages){0};
}

static uint32_t list_of(SluiceFormat format, const struct slc_tail_cut *cut)
{
    assert((uint32_t)format < SLC_PAGE_FORMATS);
    return (uint32_t)format * SLC_TAIL_CUTS + cut->cell * 2 + cut->slots - 2;
}

static bool has_free(const struct slc_tail_page *page)
{
    return (page->free[0] | page->free[1]) != 0;
}

static void link_page(struct slc_tail_pages *tails, uint32_t index)
{
    struct slc_tail_page *page = &tails->pages[index];
    page->previous = SLC_NONE;
    page->next = tails->open[page->list];
    if (page->next != SLC_NONE)
        tails->pages[page->next].previous = index;
    tails->open[page->list] = index;
}

static void unlink_page(struct slc_tail_pages *tails, uint32_t index)
{
    const struct slc_tail_page *page = &tails->pages[index];
    if (page->previous == SLC_NONE)
        tails->open[page->list] = page->next;
    else
        tails->pages[page->previous].next = page->next;
    if (page->next != SLC_NONE)
        tails->pages[page->next].previous = page->previous;
}

bool slc_tail_pages_has_room(const struct slc_tail_pages *tails, SluiceFormat format,
                             const struct slc_tail_cut *cut)
{
    return tails->open[list_of(format, cut)] != SLC_NONE;
}

uint32_t slc_tail_pages_take(struct slc_tail_pages *tails, SluiceFormat format,
                             const struct slc_tail_cut *cut)
{
    uint32_t index = tails->open[list_of(format, cut)], slot = 0;
    if (index == SLC_NONE)
        return SLUICE_PAGE_NONE;
    struct slc_tail_page *page = &tails->pages[index];
    while (!(page->free[slot / MASK_BITS] >> slot % MASK_BITS & 1))
        slot++;
    page->free[slot / MASK_BITS] &= ~((uint64_t)1 << slot % MASK_BITS);
    if (!has_free(page))
        unlink_page(tails, index);
    tails->tail_count++;
    return page->page | slc_tail_slot_bits(cut, slot);
}

bool slc_tail_pages_reserve(struct slc_tail_pages *tails)
{
    if (slc_map_reserve(&tails->index, tails->cb, tails->page_count + 1) != SLUICE_SUCCESS)
        return false;
    if (tails->free != SLC_NONE || tails->high < tails->capacity)
        return true;
    uint32_t capacity = tails->capacity ? 2 * tails->capacity : FIRST_PAGES;
    struct slc_tail_page *pages =
        slc_regrow(tails->cb, tails->pages, tails->capacity, capacity, sizeof *pages);
    if (!pages)
        return false;
    tails->pages = pages;
    tails->capacity = capacity;
    return true;
}

void slc_tail_pages_add(struct slc_tail_pages *tails, uint32_t page, SluiceFormat format,
                        const struct slc_tail_cut *cut)
{
    uint32_t index = tails->free;
    if (index != SLC_NONE)
        tails->free = tails->pages[index].next;
    else
        index = tails->high++;
    assert(index < tails->capacity);
    tails->pages[index] =
        (struct slc_tail_page){.cut = *cut, .page = page, .list = list_of(format, cut)};
    uint32_t count = slc_tail_slot_count(cut);
    assert(count <= MASKS * MASK_BITS);
    for (uint32_t i = 0; i < count; i++)
        tails->pages[index].free[i / MASK_BITS] |= (uint64_t)1 << i % MASK_BITS;
    slc_map_add(&tails->index, page, index);
    link_page(tails, index);
    tails->page_count++;
}

static bool is_empty(const struct slc_tail_page *page)
{
    uint32_t count = slc_tail_slot_count(&page->cut), free = 0;
    for (uint32_t i = 0; i < count; i++)
        free += page->free[i / MASK_BITS] >> i % MASK_BITS & 1;
    return free == count;
}

bool slc_tail_pages_give(struct slc_tail_pages *tails, uint32_t word)
{
    uint32_t index = slc_map_get(&tails->index, word & SLUICE_DEMAND_PLACE_MASK);
    assert(index != SLC_MAP_NONE);
    struct slc_tail_page *page = &tails->pages[index];
    uint32_t slot = slc_tail_slot_of(&page->cut, word);
    assert(!(page->free[slot / MASK_BITS] >> slot % MASK_BITS & 1));
    if (!has_free(page))
        link_page(tails, index);
    page->free[slot / MASK_BITS] |= (uint64_t)1 << slot % MASK_BITS;
    tails->tail_count--;
    if (!is_empty(page))
        return false;
    unlink_page(tails, index);
    slc_map_remove(&tails->index, page->page);
    page->next = tails->free;
    tails->free = index;
    tails->page_count--;
    return true;
}
