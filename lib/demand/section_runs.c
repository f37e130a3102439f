#include "demand/section_runs.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

static uint32_t length_at(const struct slc_section_runs *runs, uint32_t first)
{
    return runs->longest[runs->leaf_count + first];
}

static void set_length(struct slc_section_runs *runs, uint32_t first, uint32_t length)
{
    uint32_t *longest = runs->longest;
    uint32_t at = runs->leaf_count + first;
    longest[at] = length;
    for (at /= 2; at > 0; at /= 2)
        longest[at] = slc_max_u32(longest[2 * at], longest[2 * at + 1]);
}

static void add_run(struct slc_section_runs *runs, uint32_t first, uint32_t length)
{
    set_length(runs, first, length);
    runs->begin[first + length - 1] = first;
}

SluiceResult slc_section_runs_init(struct slc_section_runs *runs,
                                   const SluiceAllocationCallbacks *cb, uint32_t count)
{
    assert(count > 0 && count <= 1u << 30);
    *runs = (struct slc_section_runs){.count = count, .leaf_count = 1};
    while (runs->leaf_count < count)
        runs->leaf_count *= 2;
    runs->longest = slc_calloc(cb, 2 * (size_t)runs->leaf_count, sizeof *runs->longest);
    runs->begin = slc_calloc(cb, count, sizeof *runs->begin);
    if (!runs->longest || !runs->begin) {
        slc_section_runs_finish(runs, cb);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    add_run(runs, 0, count);
    return SLUICE_SUCCESS;
}

void slc_section_runs_finish(struct slc_section_runs *runs, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, runs->longest, 2 * (size_t)runs->leaf_count, sizeof *runs->longest);
    slc_free(cb, runs->begin, runs->count, sizeof *runs->begin);
    *runs = (struct slc_section_runs){0};
}

bool slc_section_runs_take(struct slc_section_runs *runs, uint32_t count, uint32_t *first)
{
    assert(count > 0);
    if (runs->longest[1] < count)
        return false;
    uint32_t at = 1;
    while (at < runs->leaf_count)
        at = runs->longest[2 * at] >= count ? 2 * at : 2 * at + 1;
    *first = at - runs->leaf_count;
    uint32_t length = runs->longest[at];
    set_length(runs, *first, 0);
    if (length > count)
        add_run(runs, *first + count, length - count);
    return true;
}

void slc_section_runs_give(struct slc_section_runs *runs, uint32_t first, uint32_t count)
{
    uint32_t end = first + count;
    assert(count > 0 && end <= runs->count && length_at(runs, first) == 0);
    if (end < runs->count && length_at(runs, end) > 0) {
        uint32_t length = length_at(runs, end);
        set_length(runs, end, 0);
        count += length;
    }
    if (first > 0) {
        /* The note is current only if a run begins there and reaches to here. */
        uint32_t before = runs->begin[first - 1];
        if (length_at(runs, before) == first - before) {
            count += first - before;
            first = before;
        }
    }
    add_run(runs, first, count);
}
