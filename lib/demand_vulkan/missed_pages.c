#include "demand_vulkan/missed_pages.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

#define REMOVED UINT32_MAX
#define FIRST_CAPACITY 64u

void slc_missed_pages_finish(struct slc_missed_pages *missed, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, missed->pages, missed->capacity, sizeof *missed->pages);
    if (missed->index.keys)
        slc_map_finish(&missed->index, cb);
    *missed = (struct slc_missed_pages){0};
}

/* Leaves out removed pages. */
static void compact(struct slc_missed_pages *m)
{
    uint32_t count = 0, taken = 0;
    for (uint32_t i = 0; i < m->count; i++) {
        uint32_t page = m->pages[i];
        if (page == REMOVED)
            continue;
        taken += i < m->taken;
        slc_map_remove(&m->index, page);
        slc_map_add(&m->index, page, count);
        m->pages[count++] = page;
    }
    m->count = count;
    m->taken = taken;
}

bool slc_missed_pages_reserve(struct slc_missed_pages *missed, const SluiceAllocationCallbacks *cb)
{
    struct slc_missed_pages *m = missed;
    if (m->count < m->capacity)
        return true;
    if (m->capacity && m->index.count <= m->count / 2) {
        compact(m);
        return true;
    }
    uint32_t capacity = m->capacity ? 2 * m->capacity : FIRST_CAPACITY;
    SluiceResult result = m->index.keys ? slc_map_reserve(&m->index, cb, capacity)
                                        : slc_map_init(&m->index, cb, capacity);
    if (result != SLUICE_SUCCESS)
        return false;
    uint32_t *pages = slc_regrow(cb, m->pages, m->capacity, capacity, sizeof *pages);
    if (!pages)
        return false;
    m->pages = pages;
    m->capacity = capacity;
    return true;
}

void slc_missed_pages_add(struct slc_missed_pages *missed, uint32_t page)
{
    assert(missed->count < missed->capacity && page != REMOVED);
    slc_map_add(&missed->index, page, missed->count);
    missed->pages[missed->count++] = page;
}

bool slc_missed_pages_has(const struct slc_missed_pages *missed, uint32_t page)
{
    return missed->index.keys && slc_map_get(&missed->index, page) != SLC_MAP_NONE;
}

void slc_missed_pages_remove(struct slc_missed_pages *missed, uint32_t page)
{
    missed->pages[slc_map_get(&missed->index, page)] = REMOVED;
    slc_map_remove(&missed->index, page);
    if (missed->index.count == 0)
        missed->count = missed->taken = 0;
}

uint32_t slc_missed_pages_take(struct slc_missed_pages *missed, uint32_t *pages, uint32_t capacity)
{
    uint32_t count = 0;
    for (; missed->taken < missed->count && count < capacity; missed->taken++)
        if (missed->pages[missed->taken] != REMOVED)
            pages[count++] = missed->pages[missed->taken];
    return count;
}

bool slc_missed_pages_has_more(const struct slc_missed_pages *missed)
{
    for (uint32_t i = missed->taken; i < missed->count; i++)
        if (missed->pages[i] != REMOVED)
            return true;
    return false;
}

bool slc_missed_pages_remove_any(struct slc_missed_pages *missed, uint32_t first, uint32_t count,
                                 uint32_t *at, uint32_t *page)
{
    for (; *at < missed->count; (*at)++) {
        *page = missed->pages[*at];
        if (*page == REMOVED || *page < first || *page - first >= count)
            continue;
        slc_missed_pages_remove(missed, *page);
        return true;
    }
    return false;
}
