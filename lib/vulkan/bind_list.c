#include "vulkan/bind_list.h"

#include "base/alloc.h"

#include <assert.h>
#include <stdlib.h>

SluiceResult slc_bind_list_init(struct slc_bind_list *list, const SluiceAllocationCallbacks *cb,
                                uint32_t capacity)
{
    *list = (struct slc_bind_list){.capacity = capacity};
    list->binds = slc_alloc(cb, capacity, sizeof *list->binds);
    list->runs = slc_alloc(cb, capacity, sizeof *list->runs);
    if (list->binds && list->runs)
        return SLUICE_SUCCESS;
    slc_bind_list_finish(list, cb);
    return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_bind_list_finish(struct slc_bind_list *list, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, list->binds, list->capacity, sizeof *list->binds);
    slc_free(cb, list->runs, list->capacity, sizeof *list->runs);
    *list = (struct slc_bind_list){0};
}

bool slc_bind_list_put(struct slc_bind_list *list, uint32_t image, struct slc_tile_place place,
                       uint32_t heap_id, uint32_t slot)
{
    if (list->count == list->capacity)
        return false;
    list->binds[list->count] = (struct slc_bind){image, place, heap_id, slot, list->count};
    list->count++;
    return true;
}

static int compare_u32(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

static int compare_places(const struct slc_bind *a, const struct slc_bind *b)
{
    int order = compare_u32(a->image, b->image);
    if (!order)
        order = compare_u32(a->place.level, b->place.level);
    if (!order)
        order = compare_u32(a->place.y, b->place.y);
    if (!order)
        order = compare_u32(a->place.x, b->place.x);
    return order;
}

static int compare_binds(const void *left, const void *right)
{
    const struct slc_bind *a = left, *b = right;
    int order = compare_places(a, b);
    return order ? order : compare_u32(a->sequence, b->sequence);
}

static bool slots_follow(const struct slc_bind_run *run, uint32_t slot)
{
    return run->heap_id == SLC_UNBIND || run->slot + run->column_count * run->row_count == slot;
}

static bool extends_row(const struct slc_bind_run *row, const struct slc_bind *bind)
{
    return row->image == bind->image && row->place.level == bind->place.level &&
           row->place.level != SLC_TAIL_LEVEL && row->place.y == bind->place.y &&
           row->place.x + row->column_count == bind->place.x && row->heap_id == bind->heap_id &&
           slots_follow(row, bind->slot);
}

static bool is_next_row(const struct slc_bind_run *run, const struct slc_bind_run *row)
{
    return run->image == row->image && run->place.level == row->place.level &&
           row->place.level != SLC_TAIL_LEVEL && run->place.x == row->place.x &&
           run->column_count == row->column_count &&
           run->place.y + run->row_count == row->place.y && run->heap_id == row->heap_id &&
           slots_follow(run, row->slot);
}

/* Joins the last run, which is a whole row, to the run before it if it is the next row. */
static void end_row(struct slc_bind_list *list)
{
    if (list->run_count < 2)
        return;
    struct slc_bind_run *run = &list->runs[list->run_count - 2];
    if (!is_next_row(run, run + 1))
        return;
    run->row_count += run[1].row_count;
    list->run_count--;
}

void slc_bind_list_build_runs(struct slc_bind_list *list)
{
    qsort(list->binds, list->count, sizeof *list->binds, compare_binds);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        if (i + 1 < list->count && compare_places(&list->binds[i], &list->binds[i + 1]) == 0)
            continue; /* a later state of the tile follows */
        list->binds[kept++] = list->binds[i];
    }
    list->count = kept;
    list->run_count = 0;
    for (uint32_t i = 0; i < kept; i++) {
        const struct slc_bind *bind = &list->binds[i];
        assert(i == 0 || compare_places(bind - 1, bind) < 0);
        struct slc_bind_run *row = list->run_count ? &list->runs[list->run_count - 1] : NULL;
        if (row && row->row_count == 1 && extends_row(row, bind)) {
            row->column_count++;
            continue;
        }
        end_row(list);
        list->runs[list->run_count++] =
            (struct slc_bind_run){bind->image, bind->place, 1, 1, bind->heap_id, bind->slot};
    }
    end_row(list);
}

void slc_bind_list_clear(struct slc_bind_list *list)
{
    list->count = list->run_count = 0;
}
