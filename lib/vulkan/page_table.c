#include "vulkan/page_table.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

static struct slc_page *page_of(const struct slc_page_table *table, uint32_t heap_id, uint32_t slot)
{
    assert(slot < table->heap_page_count);
    return &table->pages[table->pages[heap_id * table->heap_page_count + slot].page_of_slot];
}

SluiceResult slc_page_table_init(struct slc_page_table *table, const SluiceAllocationCallbacks *cb,
                                 uint32_t image_count)
{
    *table = (struct slc_page_table){.image_count = image_count};
    table->first_pages = slc_alloc(cb, image_count, sizeof *table->first_pages);
    if (!table->first_pages)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < image_count; i++)
        table->first_pages[i] = SLC_NO_PAGE;
    return SLUICE_SUCCESS;
}

void slc_page_table_finish(struct slc_page_table *table, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, table->pages, table->page_count, sizeof *table->pages);
    slc_free(cb, table->first_pages, table->image_count, sizeof *table->first_pages);
    slc_map_finish(&table->places, cb);
    *table = (struct slc_page_table){0};
}

static SluiceResult grow(struct slc_page_table *table, const SluiceAllocationCallbacks *cb,
                         uint32_t page_count)
{
    struct slc_map places = {0};
    struct slc_page *pages = slc_alloc(cb, page_count, sizeof *pages);
    SluiceResult result = pages ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        result = slc_map_init(&places, cb, page_count);
    if (result != SLUICE_SUCCESS) {
        slc_free(cb, pages, page_count, sizeof *pages);
        return result;
    }
    if (table->page_count)
        memcpy(pages, table->pages, table->page_count * sizeof *pages);
    for (uint32_t i = 0; i < table->page_count; i++)
        if (pages[i].image != SLC_NO_IMAGE)
            slc_map_add(&places, slc_place_key(pages[i].image, pages[i].place), i);
    for (uint32_t i = table->page_count; i < page_count; i++)
        pages[i] = (struct slc_page){.image = SLC_NO_IMAGE, .slot = i, .page_of_slot = i};
    slc_free(cb, table->pages, table->page_count, sizeof *pages);
    slc_map_finish(&table->places, cb);
    table->pages = pages;
    table->places = places;
    table->page_count = page_count;
    return SLUICE_SUCCESS;
}

SluiceResult slc_page_table_add_heap(struct slc_page_table *table,
                                     const SluiceAllocationCallbacks *cb, uint32_t heap_id,
                                     uint32_t page_count)
{
    const uint64_t limit = (1u << 30) - 1; /* of the hash map */
    if (table->heap_page_count == 0)
        table->heap_page_count = page_count;
    if (page_count == 0 || page_count != table->heap_page_count)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    uint64_t needed = ((uint64_t)heap_id + 1) * page_count;
    if (needed <= table->page_count)
        return SLUICE_SUCCESS;
    if (needed > limit)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t doubled = 2 * (uint64_t)table->page_count;
    if (doubled > limit)
        doubled = limit;
    return grow(table, cb, (uint32_t)(needed > doubled ? needed : doubled));
}

static void forget(struct slc_page_table *table, struct slc_page *page)
{
    uint32_t *from = page->previous == SLC_NO_PAGE ? &table->first_pages[page->image]
                                                   : &table->pages[page->previous].next;
    *from = page->next;
    if (page->next != SLC_NO_PAGE)
        table->pages[page->next].previous = page->previous;
    slc_map_remove(&table->places, slc_place_key(page->image, page->place));
    page->image = SLC_NO_IMAGE;
}

static void remember(struct slc_page_table *table, struct slc_page *page, uint32_t image,
                     struct slc_tile_place place)
{
    uint32_t index = (uint32_t)(page - table->pages), first = table->first_pages[image];
    page->image = image;
    page->place = place;
    page->live = true;
    page->spoiled = false;
    page->previous = SLC_NO_PAGE;
    page->next = first;
    if (first != SLC_NO_PAGE)
        table->pages[first].previous = index;
    table->first_pages[image] = index;
    slc_map_add(&table->places, slc_place_key(image, place), index);
}

static void put_unbind(struct slc_page_table *table, struct slc_bind_list *list,
                       struct slc_page *page)
{
    assert(!page->live);
    bool added = slc_bind_list_put(list, page->image, page->place, SLC_UNBIND, 0);
    assert(added);
    (void)added;
    table->unbind_count++;
    forget(table, page);
}

/* Neighbours in a row that were given up, too: one run now instead of more runs later. */
static void put_unbinds_beside(struct slc_page_table *table, struct slc_bind_list *list,
                               uint32_t image, struct slc_tile_place place, int step)
{
    while (list->count < list->capacity / 2 && !(step < 0 && place.x == 0)) {
        place.x += (uint32_t)step;
        uint32_t page = slc_map_get(&table->places, slc_place_key(image, place));
        if (page == SLC_MAP_NONE || table->pages[page].live)
            return;
        put_unbind(table, list, &table->pages[page]);
    }
}

static void put_unbind_run(struct slc_page_table *table, struct slc_bind_list *list,
                           struct slc_page *page)
{
    uint32_t image = page->image;
    struct slc_tile_place place = page->place;
    put_unbind(table, list, page);
    if (place.level == SLC_TAIL_LEVEL) /* pages of a tail stay single */
        return;
    put_unbinds_beside(table, list, image, place, -1);
    put_unbinds_beside(table, list, image, place, 1);
}

bool slc_page_table_revive(struct slc_page_table *table, uint32_t image,
                           struct slc_tile_place place, uint32_t heap_id, uint32_t slot)
{
    struct slc_page *pages = table->pages;
    uint32_t old = slc_map_get(&table->places, slc_place_key(image, place));
    if (old == SLC_MAP_NONE || pages[old].live || old / table->heap_page_count != heap_id)
        return false;
    uint32_t page = (uint32_t)(page_of(table, heap_id, slot) - pages);
    assert(pages[page].image == SLC_NO_IMAGE || !pages[page].live);
    uint32_t other = pages[old].slot, given = pages[page].slot;
    pages[other].page_of_slot = page; /* nothing changes where both are one */
    pages[page].slot = other;
    pages[given].page_of_slot = old;
    pages[old].slot = given;
    pages[old].live = true;
    table->unbinds_saved++;
    return true;
}

bool slc_page_table_bind(struct slc_page_table *table, struct slc_bind_list *list, uint32_t image,
                         struct slc_tile_place place, uint32_t heap_id, uint32_t slot,
                         uint32_t *displaced)
{
    *displaced = SLC_NO_IMAGE;
    if (list->capacity - list->count < 2)
        return false;
    if (slc_page_table_revive(table, image, place, heap_id, slot)) {
        table->pages[slc_map_get(&table->places, slc_place_key(image, place))].spoiled = false;
        return true;
    }
    struct slc_page *page = page_of(table, heap_id, slot);
    uint32_t there = slc_map_get(&table->places, slc_place_key(image, place));
    if (there != SLC_MAP_NONE) { /* in another heap; its unbind merges with the bind */
        assert(!table->pages[there].live);
        table->unbinds_saved++;
        forget(table, &table->pages[there]);
    }
    if (page->image != SLC_NO_IMAGE) {
        *displaced = page->image;
        put_unbind_run(table, list, page);
    }
    slc_bind_list_put(list, image, place, heap_id,
                      (uint32_t)(page - table->pages) % table->heap_page_count);
    remember(table, page, image, place);
    return true;
}

void slc_page_table_give_up(struct slc_page_table *table, uint32_t image,
                            struct slc_tile_place place)
{
    uint32_t page = slc_map_get(&table->places, slc_place_key(image, place));
    assert(page != SLC_MAP_NONE && table->pages[page].live);
    table->pages[page].live = false;
}

void slc_page_table_spoil(struct slc_page_table *table, uint32_t image, struct slc_tile_place place)
{
    uint32_t page = slc_map_get(&table->places, slc_place_key(image, place));
    assert(page != SLC_MAP_NONE);
    table->pages[page].spoiled = true;
}

bool slc_page_table_is_spoiled(const struct slc_page_table *table, uint32_t image,
                               struct slc_tile_place place)
{
    uint32_t page = slc_map_get(&table->places, slc_place_key(image, place));
    return page != SLC_MAP_NONE && table->pages[page].spoiled;
}

bool slc_page_table_unbind(struct slc_page_table *table, struct slc_bind_list *list,
                           uint32_t heap_id, uint32_t slot, uint32_t *image)
{
    struct slc_page *page = page_of(table, heap_id, slot);
    *image = page->image;
    if (page->image == SLC_NO_IMAGE)
        return true;
    if (list->count == list->capacity)
        return false;
    put_unbind_run(table, list, page);
    return true;
}

void slc_page_table_drop_image(struct slc_page_table *table, uint32_t image)
{
    while (table->first_pages[image] != SLC_NO_PAGE) {
        struct slc_page *page = &table->pages[table->first_pages[image]];
        table->unbinds_saved += !page->live;
        forget(table, page);
    }
}
