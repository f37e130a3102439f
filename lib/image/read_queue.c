#include "image/read_queue.h"

#include "base/alloc.h"

#include <string.h>

SluiceResult slc_read_queue_init(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb,
                                 uint32_t capacity)
{
    *queue = (struct slc_read_queue){.capacity = capacity};
    queue->reads = slc_calloc(cb, capacity, sizeof *queue->reads);
    queue->free_slots = slc_alloc(cb, capacity, sizeof *queue->free_slots);
    queue->heap = slc_alloc(cb, capacity, sizeof *queue->heap);
    queue->finished = slc_alloc(cb, capacity, sizeof *queue->finished);
    if (!queue->reads || !queue->free_slots || !queue->heap || !queue->finished) {
        slc_read_queue_finish(queue, cb);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    for (uint32_t i = 0; i < capacity; i++)
        queue->free_slots[i] = capacity - 1 - i;
    queue->free_count = capacity;
    return SLUICE_SUCCESS;
}

void slc_read_queue_finish(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, queue->reads, queue->capacity, sizeof *queue->reads);
    slc_free(cb, queue->free_slots, queue->capacity, sizeof *queue->free_slots);
    slc_free(cb, queue->heap, queue->capacity, sizeof *queue->heap);
    slc_free(cb, queue->finished, queue->capacity, sizeof *queue->finished);
}

static bool is_more_urgent(const struct slc_read *a, const struct slc_read *b)
{
    return a->priority != b->priority ? a->priority > b->priority : a->order < b->order;
}

static void heap_put(struct slc_read_queue *queue, uint32_t index, uint32_t slot)
{
    queue->heap[index] = slot;
    queue->reads[slot].heap_index = index;
}

/* Puts `slot` where it belongs, the place `index` being free. */
static void heap_settle(struct slc_read_queue *queue, uint32_t index, uint32_t slot)
{
    const struct slc_read *reads = queue->reads, *read = &reads[slot];
    while (index > 0 && is_more_urgent(read, &reads[queue->heap[(index - 1) / 2]])) {
        heap_put(queue, index, queue->heap[(index - 1) / 2]);
        index = (index - 1) / 2;
    }
    for (;;) {
        uint64_t child = 2 * (uint64_t)index + 1;
        if (child >= queue->heap_count)
            break;
        if (child + 1 < queue->heap_count &&
            is_more_urgent(&reads[queue->heap[child + 1]], &reads[queue->heap[child]]))
            child++;
        if (!is_more_urgent(&reads[queue->heap[child]], read))
            break;
        heap_put(queue, index, queue->heap[child]);
        index = (uint32_t)child;
    }
    heap_put(queue, index, slot);
}

static void heap_remove(struct slc_read_queue *queue, uint32_t index)
{
    uint32_t last = queue->heap[--queue->heap_count];
    if (index < queue->heap_count)
        heap_settle(queue, index, last);
}

/* Slot and generation in one number that is never 0. */
static uint64_t make_ticket(const struct slc_read_queue *queue, uint32_t slot)
{
    return queue->reads[slot].generation * queue->capacity + slot + 1;
}

bool slc_read_queue_submit(struct slc_read_queue *queue, const SluiceTileRead *given,
                           uint64_t *ticket)
{
    if (queue->free_count == 0)
        return false;
    uint32_t slot = queue->free_slots[--queue->free_count];
    struct slc_read *read = &queue->reads[slot];
    read->state = SLC_READ_QUEUED;
    read->order = queue->submitted++;
    read->priority = given->priority;
    read->source = given->source;
    read->region_count = given->regionCount;
    memcpy(read->regions, given->pRegions, given->regionCount * sizeof *read->regions);
    memcpy(read->texels, given->ppTexels, given->regionCount * sizeof *read->texels);
    *ticket = make_ticket(queue, slot);
    read->result = (SluiceTileReadResult){.ticket = *ticket, .userValue = given->userValue};
    heap_settle(queue, queue->heap_count++, slot);
    return true;
}

struct slc_read *slc_read_queue_start(struct slc_read_queue *queue)
{
    if (queue->heap_count == 0)
        return NULL;
    struct slc_read *read = &queue->reads[queue->heap[0]];
    heap_remove(queue, 0);
    read->state = SLC_READ_RUNNING;
    return read;
}

void slc_read_queue_end(struct slc_read_queue *queue, struct slc_read *read, SluiceResult result,
                        uint64_t size)
{
    if (read->state == SLC_READ_QUEUED)
        heap_remove(queue, read->heap_index);
    read->state = SLC_READ_FINISHED;
    read->result.result = result;
    read->result.size = size;
    uint64_t last = (uint64_t)queue->finished_first + queue->finished_count++;
    queue->finished[last % queue->capacity] = (uint32_t)(read - queue->reads);
}

struct slc_read *slc_read_queue_find(struct slc_read_queue *queue, uint64_t ticket)
{
    if (ticket == 0)
        return NULL;
    struct slc_read *read = &queue->reads[(ticket - 1) % queue->capacity];
    bool current = read->state != SLC_READ_FREE && read->result.ticket == ticket;
    return current ? read : NULL;
}

bool slc_read_queue_collect(struct slc_read_queue *queue, SluiceTileReadResult *result)
{
    if (queue->finished_count == 0)
        return false;
    uint32_t slot = queue->finished[queue->finished_first];
    queue->finished_first = (queue->finished_first + 1) % queue->capacity;
    queue->finished_count--;
    struct slc_read *read = &queue->reads[slot];
    *result = read->result;
    read->state = SLC_READ_FREE;
    read->generation++;
    queue->free_slots[queue->free_count++] = slot;
    return true;
}
