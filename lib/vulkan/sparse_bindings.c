#include "vulkan/sparse_bindings.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

static struct slc_bound_page *page_of(const struct slc_sparse_bindings *bindings, uint32_t heap_id,
                                      uint32_t slot)
{
    assert(slot < bindings->heap_page_count);
    return &bindings
                ->pages[bindings->pages[heap_id * bindings->heap_page_count + slot].page_of_slot];
}

SluiceResult slc_sparse_bindings_init(struct slc_sparse_bindings *bindings,
                                      const SluiceAllocationCallbacks *cb, uint32_t image_count)
{
    *bindings = (struct slc_sparse_bindings){.image_count = image_count};
    bindings->first_pages = slc_alloc(cb, image_count, sizeof *bindings->first_pages);
    if (!bindings->first_pages)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < image_count; i++)
        bindings->first_pages[i] = SLC_NO_BOUND_PAGE;
    return SLUICE_SUCCESS;
}

void slc_sparse_bindings_finish(struct slc_sparse_bindings *bindings,
                                const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, bindings->pages, bindings->page_count, sizeof *bindings->pages);
    slc_free(cb, bindings->first_pages, bindings->image_count, sizeof *bindings->first_pages);
    slc_map_finish(&bindings->places, cb);
    *bindings = (struct slc_sparse_bindings){0};
}

static SluiceResult grow(struct slc_sparse_bindings *bindings, const SluiceAllocationCallbacks *cb,
                         uint32_t page_count)
{
    struct slc_map places = {0};
    struct slc_bound_page *pages = slc_alloc(cb, page_count, sizeof *pages);
    SluiceResult result = pages ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        result = slc_map_init(&places, cb, page_count);
    if (result != SLUICE_SUCCESS) {
        slc_free(cb, pages, page_count, sizeof *pages);
        return result;
    }
    if (bindings->page_count)
        memcpy(pages, bindings->pages, bindings->page_count * sizeof *pages);
    for (uint32_t i = 0; i < bindings->page_count; i++)
        if (pages[i].image != SLC_NO_IMAGE)
            slc_map_add(&places, slc_place_key(pages[i].image, pages[i].place), i);
    for (uint32_t i = bindings->page_count; i < page_count; i++)
        pages[i] = (struct slc_bound_page){.image = SLC_NO_IMAGE, .slot = i, .page_of_slot = i};
    slc_free(cb, bindings->pages, bindings->page_count, sizeof *pages);
    slc_map_finish(&bindings->places, cb);
    bindings->pages = pages;
    bindings->places = places;
    bindings->page_count = page_count;
    return SLUICE_SUCCESS;
}

SluiceResult slc_sparse_bindings_add_heap(struct slc_sparse_bindings *bindings,
                                          const SluiceAllocationCallbacks *cb, uint32_t heap_id,
                                          uint32_t page_count)
{
    const uint64_t limit = (1u << 30) - 1; /* most entries of the hash map */
    if (bindings->heap_page_count == 0)
        bindings->heap_page_count = page_count;
    assert(page_count > 0 && page_count == bindings->heap_page_count);
    uint64_t needed = ((uint64_t)heap_id + 1) * page_count;
    if (needed <= bindings->page_count)
        return SLUICE_SUCCESS;
    if (needed > limit)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t doubled = 2 * (uint64_t)bindings->page_count;
    if (doubled > limit)
        doubled = limit;
    return grow(bindings, cb, (uint32_t)(needed > doubled ? needed : doubled));
}

static void forget(struct slc_sparse_bindings *bindings, struct slc_bound_page *page)
{
    uint32_t *from = page->previous == SLC_NO_BOUND_PAGE ? &bindings->first_pages[page->image]
                                                         : &bindings->pages[page->previous].next;
    *from = page->next;
    if (page->next != SLC_NO_BOUND_PAGE)
        bindings->pages[page->next].previous = page->previous;
    slc_map_remove(&bindings->places, slc_place_key(page->image, page->place));
    page->image = SLC_NO_IMAGE;
}

static void remember(struct slc_sparse_bindings *bindings, struct slc_bound_page *page,
                     uint32_t image, struct slc_tile_place place)
{
    uint32_t index = (uint32_t)(page - bindings->pages), first = bindings->first_pages[image];
    page->image = image;
    page->place = place;
    page->live = true;
    page->spoiled = false;
    page->previous = SLC_NO_BOUND_PAGE;
    page->next = first;
    if (first != SLC_NO_BOUND_PAGE)
        bindings->pages[first].previous = index;
    bindings->first_pages[image] = index;
    slc_map_add(&bindings->places, slc_place_key(image, place), index);
}

static void put_unbind(struct slc_sparse_bindings *bindings, struct slc_bind_list *list,
                       struct slc_bound_page *page)
{
    assert(!page->live);
    bool added = slc_bind_list_put(list, page->image, page->place, SLC_UNBIND, 0);
    assert(added);
    (void)added;
    bindings->unbind_count++;
    forget(bindings, page);
}

/* Unbinds evicted neighbors in the row, too: one run now instead of several later. */
static void put_unbinds_beside(struct slc_sparse_bindings *bindings, struct slc_bind_list *list,
                               uint32_t image, struct slc_tile_place place, int step)
{
    while (list->count < list->capacity / 2 && !(step < 0 && place.x == 0)) {
        place.x += (uint32_t)step;
        uint32_t page = slc_map_get(&bindings->places, slc_place_key(image, place));
        if (page == SLC_MAP_NONE || bindings->pages[page].live)
            return;
        put_unbind(bindings, list, &bindings->pages[page]);
    }
}

static void put_unbind_run(struct slc_sparse_bindings *bindings, struct slc_bind_list *list,
                           struct slc_bound_page *page)
{
    uint32_t image = page->image;
    struct slc_tile_place place = page->place;
    put_unbind(bindings, list, page);
    if (place.level == SLC_TAIL_LEVEL) /* pages of a tail stay single */
        return;
    put_unbinds_beside(bindings, list, image, place, -1);
    put_unbinds_beside(bindings, list, image, place, 1);
}

bool slc_sparse_bindings_restore(struct slc_sparse_bindings *bindings, uint32_t image,
                                 struct slc_tile_place place, uint32_t heap_id, uint32_t slot)
{
    struct slc_bound_page *pages = bindings->pages;
    uint32_t old = slc_map_get(&bindings->places, slc_place_key(image, place));
    if (old == SLC_MAP_NONE || pages[old].live || old / bindings->heap_page_count != heap_id)
        return false;
    uint32_t page = (uint32_t)(page_of(bindings, heap_id, slot) - pages);
    assert(pages[page].image == SLC_NO_IMAGE || !pages[page].live);
    uint32_t other = pages[old].slot, given = pages[page].slot;
    pages[other].page_of_slot = page; /* a swap; no change if both are the same slot */
    pages[page].slot = other;
    pages[given].page_of_slot = old;
    pages[old].slot = given;
    pages[old].live = true;
    bindings->unbinds_saved++;
    return true;
}

bool slc_sparse_bindings_bind(struct slc_sparse_bindings *bindings, struct slc_bind_list *list,
                              uint32_t image, struct slc_tile_place place, uint32_t heap_id,
                              uint32_t slot, uint32_t *unbound)
{
    *unbound = SLC_NO_IMAGE;
    if (list->capacity - list->count < 2)
        return false;
    if (slc_sparse_bindings_restore(bindings, image, place, heap_id, slot)) {
        bindings->pages[slc_map_get(&bindings->places, slc_place_key(image, place))].spoiled =
            false;
        return true;
    }
    struct slc_bound_page *page = page_of(bindings, heap_id, slot);
    uint32_t there = slc_map_get(&bindings->places, slc_place_key(image, place));
    if (there != SLC_MAP_NONE) { /* in another heap; its unbind merges with the bind */
        assert(!bindings->pages[there].live);
        bindings->unbinds_saved++;
        forget(bindings, &bindings->pages[there]);
    }
    if (page->image != SLC_NO_IMAGE) {
        *unbound = page->image;
        put_unbind_run(bindings, list, page);
    }
    slc_bind_list_put(list, image, place, heap_id,
                      (uint32_t)(page - bindings->pages) % bindings->heap_page_count);
    remember(bindings, page, image, place);
    return true;
}

void slc_sparse_bindings_evict(struct slc_sparse_bindings *bindings, uint32_t image,
                               struct slc_tile_place place)
{
    uint32_t page = slc_map_get(&bindings->places, slc_place_key(image, place));
    assert(page != SLC_MAP_NONE && bindings->pages[page].live);
    bindings->pages[page].live = false;
}

void slc_sparse_bindings_spoil(struct slc_sparse_bindings *bindings, uint32_t image,
                               struct slc_tile_place place)
{
    uint32_t page = slc_map_get(&bindings->places, slc_place_key(image, place));
    assert(page != SLC_MAP_NONE);
    bindings->pages[page].spoiled = true;
}

void slc_sparse_bindings_spoil_evicted(struct slc_sparse_bindings *bindings, uint32_t image,
                                       struct slc_tile_place place)
{
    if (bindings->places.count == 0)
        return; /* before the first heap there is no map */
    uint32_t page = slc_map_get(&bindings->places, slc_place_key(image, place));
    if (page != SLC_MAP_NONE)
        bindings->pages[page].spoiled = true;
}

bool slc_sparse_bindings_is_spoiled(const struct slc_sparse_bindings *bindings, uint32_t image,
                                    struct slc_tile_place place)
{
    uint32_t page = slc_map_get(&bindings->places, slc_place_key(image, place));
    return page != SLC_MAP_NONE && bindings->pages[page].spoiled;
}

bool slc_sparse_bindings_unbind(struct slc_sparse_bindings *bindings, struct slc_bind_list *list,
                                uint32_t heap_id, uint32_t slot, uint32_t *image)
{
    struct slc_bound_page *page = page_of(bindings, heap_id, slot);
    *image = page->image;
    if (page->image == SLC_NO_IMAGE)
        return true;
    if (list->count == list->capacity)
        return false;
    put_unbind_run(bindings, list, page);
    return true;
}

void slc_sparse_bindings_drop_image(struct slc_sparse_bindings *bindings, uint32_t image)
{
    while (bindings->first_pages[image] != SLC_NO_BOUND_PAGE) {
        struct slc_bound_page *page = &bindings->pages[bindings->first_pages[image]];
        bindings->unbinds_saved += !page->live;
        forget(bindings, page);
    }
}
