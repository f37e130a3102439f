#include "demand_vulkan/table_mirror.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

#define MAX_RUN 1024u /* most elements of vkCmdUpdateBuffer */
#define MAX_GAP 8u    /* most unchanged elements that are cheaper than another command */

void slc_table_mirror_init(struct slc_table_mirror *mirror, const SluiceAllocationCallbacks *cb,
                           VkBuffer buffer, uint64_t offset, uint32_t max_count)
{
    *mirror = (struct slc_table_mirror){.cb = cb,
                                        .buffer = buffer,
                                        .offset = offset,
                                        .max_count = max_count,
                                        .first_word = UINT32_MAX};
}

void slc_table_mirror_finish(struct slc_table_mirror *mirror)
{
    if (mirror->capacity) {
        slc_free(mirror->cb, mirror->elements, mirror->capacity, SLC_MIRROR_ELEMENT);
        slc_free(mirror->cb, mirror->changed, mirror->capacity / 64, sizeof *mirror->changed);
        slc_free(mirror->cb, mirror->recorded, mirror->capacity / 64, sizeof *mirror->recorded);
    }
    *mirror = (struct slc_table_mirror){0};
}

SluiceResult slc_table_mirror_reserve(struct slc_table_mirror *mirror, uint32_t count)
{
    if (count <= mirror->capacity)
        return SLUICE_SUCCESS;
    if (count > mirror->max_count)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    uint32_t old = mirror->capacity;
    uint32_t capacity = slc_max_u32(slc_max_u32(2 * old, 256), slc_div_up_u32(count, 64) * 64);
    struct slc_mirror_element *elements = slc_alloc(mirror->cb, capacity, sizeof *elements);
    uint64_t *changed = slc_calloc(mirror->cb, capacity / 64, sizeof *changed);
    uint64_t *recorded = slc_calloc(mirror->cb, capacity / 64, sizeof *recorded);
    if (!elements || !changed || !recorded) {
        slc_free(mirror->cb, elements, capacity, sizeof *elements);
        slc_free(mirror->cb, changed, capacity / 64, sizeof *changed);
        slc_free(mirror->cb, recorded, capacity / 64, sizeof *recorded);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    memset(elements + old, 0, (size_t)(capacity - old) * sizeof *elements);
    if (old) {
        memcpy(elements, mirror->elements, (size_t)old * sizeof *elements);
        memcpy(changed, mirror->changed, old / 64 * sizeof *changed);
        memcpy(recorded, mirror->recorded, old / 64 * sizeof *recorded);
        slc_free(mirror->cb, mirror->elements, old, sizeof *elements);
        slc_free(mirror->cb, mirror->changed, old / 64, sizeof *changed);
        slc_free(mirror->cb, mirror->recorded, old / 64, sizeof *recorded);
    }
    mirror->elements = elements;
    mirror->changed = changed;
    mirror->recorded = recorded;
    mirror->capacity = capacity;
    return SLUICE_SUCCESS;
}

void *slc_table_mirror_change(struct slc_table_mirror *mirror, uint32_t index)
{
    assert(index < mirror->capacity && index < mirror->max_count);
    mirror->changed[index / 64] |= (uint64_t)1 << index % 64;
    mirror->first_word = slc_min_u32(mirror->first_word, index / 64);
    mirror->end_word = slc_max_u32(mirror->end_word, index / 64 + 1);
    return &mirror->elements[index];
}

struct run {
    uint32_t first, end; ///< elements; equal: none
};

static void flush(const struct slc_table_mirror *mirror, const struct slc_vk *vk,
                  VkCommandBuffer commands, const struct run *run)
{
    if (run->first < run->end)
        vk->CmdUpdateBuffer(
            commands, mirror->buffer, mirror->offset + (uint64_t)run->first * SLC_MIRROR_ELEMENT,
            (uint64_t)(run->end - run->first) * SLC_MIRROR_ELEMENT, &mirror->elements[run->first]);
}

static void extend(const struct slc_table_mirror *mirror, const struct slc_vk *vk,
                   VkCommandBuffer commands, struct run *run, uint32_t index)
{
    bool near = run->first < run->end && index - run->end <= MAX_GAP;
    if (!near || index + 1 - run->first > MAX_RUN) {
        flush(mirror, vk, commands, run);
        run->first = index;
    }
    run->end = index + 1;
}

void slc_table_mirror_record(struct slc_table_mirror *mirror, const struct slc_vk *vk,
                             VkCommandBuffer commands, uint64_t launch)
{
    struct run run = {0};
    if (slc_table_mirror_has_changes(mirror))
        mirror->recorded_launch = launch;
    for (uint32_t word = mirror->first_word; word < mirror->end_word; word++) {
        uint64_t bits = mirror->changed[word];
        mirror->changed[word] = 0;
        mirror->recorded[word] |= bits;
        for (uint32_t bit = 0; bits >> bit; bit++) {
            if (bits >> bit & 1)
                extend(mirror, vk, commands, &run, word * 64 + bit);
            if (bit == 63)
                break;
        }
    }
    flush(mirror, vk, commands, &run);
    mirror->first_word = UINT32_MAX;
    mirror->end_word = 0;
}

void slc_table_mirror_complete(struct slc_table_mirror *mirror, uint64_t launch)
{
    if (mirror->recorded_launch == 0 || mirror->recorded_launch > launch)
        return;
    memset(mirror->recorded, 0, mirror->capacity / 64 * sizeof *mirror->recorded);
    mirror->recorded_launch = 0;
}

void slc_table_mirror_abandon(struct slc_table_mirror *mirror, uint64_t launch)
{
    if (mirror->recorded_launch < launch)
        return;
    for (uint32_t word = 0; word < mirror->capacity / 64; word++) {
        if (!mirror->recorded[word])
            continue;
        mirror->changed[word] |= mirror->recorded[word];
        mirror->first_word = slc_min_u32(mirror->first_word, word);
        mirror->end_word = slc_max_u32(mirror->end_word, word + 1);
    }
}
