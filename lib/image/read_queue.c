#include "image/read_queue.h"

#include "base/alloc.h"
#include "image/shared_reads.h"

#include <string.h>

/* Most bytes per texel or block of any format. */
#define LARGEST_BLOCK 16

static const struct slc_read *read_of(const struct slc_heap_node *node)
{
    return SLC_CONTAINER_OF(node, const struct slc_read, node);
}

static bool read_is_more_urgent(const struct slc_heap_node *a, const struct slc_heap_node *b)
{
    const struct slc_read *x = read_of(a), *y = read_of(b);
    return x->priority != y->priority ? x->priority > y->priority : x->order < y->order;
}

static bool read_is_due_before(const struct slc_heap_node *a, const struct slc_heap_node *b)
{
    const struct slc_read *x = read_of(a), *y = read_of(b);
    return x->due != y->due ? x->due < y->due : x->order < y->order;
}

static bool source_is_more_urgent(const struct slc_heap_node *a, const struct slc_heap_node *b)
{
    return read_is_more_urgent(
        SLC_CONTAINER_OF(a, const struct slc_read_source, node)->queued.root,
        SLC_CONTAINER_OF(b, const struct slc_read_source, node)->queued.root);
}

SluiceResult slc_read_queue_init(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb,
                                 const struct slc_read_queue_limits *limits)
{
    uint32_t capacity = limits->capacity;
    *queue = (struct slc_read_queue){
        .capacity = capacity,
        .own_load = {.max_running_per_source = limits->max_running_per_source,
                     .max_running_size = limits->max_running_size},
        .startable.is_before = source_is_more_urgent,
        .copies.is_before = read_is_more_urgent,
        .delayed.is_before = read_is_due_before};
    queue->load = &queue->own_load;
    queue->reads = slc_calloc(cb, capacity, sizeof *queue->reads);
    queue->free_slots = slc_alloc(cb, capacity, sizeof *queue->free_slots);
    queue->finished = slc_alloc(cb, capacity, sizeof *queue->finished);
    if (!queue->reads || !queue->free_slots || !queue->finished ||
        slc_read_sources_init(&queue->sources, cb, limits->source_count) != SLUICE_SUCCESS) {
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
    slc_read_sources_finish(&queue->sources, cb);
    slc_free(cb, queue->reads, queue->capacity, sizeof *queue->reads);
    slc_free(cb, queue->free_slots, queue->capacity, sizeof *queue->free_slots);
    slc_free(cb, queue->finished, queue->capacity, sizeof *queue->finished);
}

void slc_read_queue_share(struct slc_read_queue *queue, struct slc_read_load *load,
                          struct slc_read_queue *peer)
{
    queue->load = load;
    if (peer)
        slc_read_sources_share(&queue->sources, &peer->sources);
}

/* Makes a ticket of slot and generation, never 0. */
static uint64_t make_ticket(const struct slc_read_queue *queue, uint32_t slot)
{
    return queue->reads[slot].generation * queue->capacity + slot + 1;
}

/* Counts the running reads of a source, of all queues that share limits. */
static uint32_t running_count(const struct slc_read_source *source)
{
    uint32_t count = source->running_count;
    for (const struct slc_read_source *twin = source->twin; twin != source; twin = twin->twin)
        count += twin->running_count;
    return count;
}

/* Removes a source from `startable` before its queue changes. */
static void source_leave(struct slc_read_queue *queue, struct slc_read_source *source)
{
    if (slc_heap_node_is_in(&source->node))
        slc_pairing_heap_remove(&queue->startable, &source->node);
}

static void source_return(struct slc_read_queue *queue, struct slc_read_source *source)
{
    if (source->queued.root && running_count(source) < queue->load->max_running_per_source)
        slc_pairing_heap_add(&queue->startable, &source->node);
}

static struct slc_read_queue *queue_of(const struct slc_read_source *source)
{
    return SLC_CONTAINER_OF(source->sources, struct slc_read_queue, sources);
}

struct slc_read_queue *slc_read_queue_of(const struct slc_read *read)
{
    return queue_of(read->source);
}

/* Updates the source in other queues after its number of running reads has changed. */
static void update_twins(struct slc_read_source *source)
{
    for (struct slc_read_source *twin = source->twin; twin != source; twin = twin->twin) {
        source_leave(queue_of(twin), twin);
        source_return(queue_of(twin), twin);
    }
}

/* True if a read needs no source: the pool has remaining texels, or knows that the read has failed.
 */
static bool is_copy(const struct slc_read_queue *queue, const struct slc_read *read)
{
    bool copies = true;
    if (read->held || read->failed.result != SLUICE_SUCCESS)
        return true;
    for (uint32_t i = 0; copies && i < read->region_count; i++)
        copies = read->done >> i & 1 ||
                 (queue->shares &&
                  slc_shared_reads_keep(queue->shares, read->source->source, &read->regions[i]));
    return copies;
}

static void enqueue(struct slc_read_queue *queue, struct slc_read *read, bool copies)
{
    read->state = SLC_READ_QUEUED;
    read->is_copy = copies;
    queue->queued_count++;
    if (copies) {
        slc_pairing_heap_add(&queue->copies, &read->node);
        return;
    }
    source_leave(queue, read->source);
    slc_pairing_heap_add(&read->source->queued, &read->node);
    source_return(queue, read->source);
}

static void dequeue(struct slc_read_queue *queue, struct slc_read *read)
{
    queue->queued_count--;
    if (read->is_copy) {
        slc_pairing_heap_remove(&queue->copies, &read->node);
        return;
    }
    source_leave(queue, read->source);
    slc_pairing_heap_remove(&read->source->queued, &read->node);
    source_return(queue, read->source);
}

static void undelay(struct slc_read_queue *queue, struct slc_read *read)
{
    slc_pairing_heap_remove(&queue->delayed, &read->node);
    read->source->statistics.counts.delayedCount--;
    queue->statistics.counts.delayedCount--;
}

static void stop_running(struct slc_read_queue *queue, struct slc_read *read)
{
    queue->running_count--;
    if (read->is_copy)
        return;
    source_leave(queue, read->source);
    read->source->running_count -= read->holds_thread;
    read->holds_thread = false;
    queue->load->running_count--;
    queue->load->running_size -= read->running_size;
    source_return(queue, read->source);
    update_twins(read->source);
}

bool slc_read_queue_submit(struct slc_read_queue *queue, const SluiceTileRead *given,
                           uint64_t *ticket)
{
    if (queue->free_count == 0)
        return false;
    struct slc_read_source *source = slc_read_sources_add_read(&queue->sources, given->source);
    source->queued.is_before = read_is_more_urgent;
    uint32_t slot = queue->free_slots[--queue->free_count];
    struct slc_read *read = &queue->reads[slot];
    read->order = queue->submitted++;
    read->priority = given->priority;
    read->source = source;
    read->attempts = (struct slc_attempts){0};
    read->next_waiting = NULL;
    read->awaited = read->held = NULL;
    read->failed.result = SLUICE_SUCCESS;
    read->region_count = given->regionCount;
    read->done = 0;
    read->done_size = 0;
    atomic_store_explicit(&read->dropped, false, memory_order_relaxed);
    memcpy(read->regions, given->pRegions, given->regionCount * sizeof *read->regions);
    memcpy(read->texels, given->ppTexels, given->regionCount * sizeof *read->texels);
    *ticket = make_ticket(queue, slot);
    read->result = (SluiceTileReadResult){.ticket = *ticket, .userValue = given->userValue};
    source->statistics.counts.readCount++;
    queue->statistics.counts.readCount++;
    enqueue(queue, read, is_copy(queue, read));
    return true;
}

/* Returns the bytes of the remaining regions; an upper bound while the format is unknown. */
static uint64_t size_of(const struct slc_read *read)
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < read->region_count; i++) {
        if (read->done >> i & 1)
            continue;
        const SluiceImageRegion *region = &read->regions[i];
        uint64_t bytes =
            sluiceGetFormatRegionSize(read->source->format, region->width, region->height);
        if (read->source->format == SLUICE_FORMAT_UNDEFINED)
            bytes = (uint64_t)region->width * region->height;
        if (read->source->format == SLUICE_FORMAT_UNDEFINED)
            bytes = bytes > UINT64_MAX / LARGEST_BLOCK ? UINT64_MAX : bytes * LARGEST_BLOCK;
        size = bytes > UINT64_MAX - size ? UINT64_MAX : size + bytes;
    }
    return size;
}

struct slc_read *slc_read_queue_start_copy(struct slc_read_queue *queue, uint64_t now)
{
    while (slc_read_queue_next_due(queue) <= now && queue->delayed.root) {
        struct slc_read *due = SLC_CONTAINER_OF(queue->delayed.root, struct slc_read, node);
        undelay(queue, due);
        enqueue(queue, due, is_copy(queue, due));
    }
    if (!queue->copies.root)
        return NULL;
    struct slc_read *read = SLC_CONTAINER_OF(queue->copies.root, struct slc_read, node);
    dequeue(queue, read);
    read->state = SLC_READ_RUNNING;
    queue->running_count++;
    return read;
}

struct slc_read *slc_read_queue_start(struct slc_read_queue *queue, uint64_t now)
{
    struct slc_read *copy = slc_read_queue_start_copy(queue, now);
    if (copy)
        return copy;
    if (!queue->startable.root)
        return NULL;
    struct slc_read_source *source =
        SLC_CONTAINER_OF(queue->startable.root, struct slc_read_source, node);
    struct slc_read *read = SLC_CONTAINER_OF(source->queued.root, struct slc_read, node);
    uint64_t size = size_of(read);
    struct slc_read_load *load = queue->load;
    uint64_t room = load->max_running_size - load->running_size;
    if (load->running_count > 0 && (load->running_size > load->max_running_size || size > room))
        return NULL;
    source_leave(queue, source);
    slc_pairing_heap_remove(&source->queued, &read->node);
    queue->queued_count--;
    read->state = SLC_READ_RUNNING;
    read->running_size = size;
    source->running_count++;
    read->holds_thread = true;
    queue->running_count++;
    load->running_count++;
    load->running_size += size;
    source_return(queue, source);
    update_twins(source);
    return read;
}

void slc_read_queue_release_thread(struct slc_read_queue *queue, struct slc_read *read)
{
    source_leave(queue, read->source);
    read->source->running_count--;
    read->holds_thread = false;
    source_return(queue, read->source);
    update_twins(read->source);
}

uint64_t slc_read_queue_next_due(const struct slc_read_queue *queue)
{
    return queue->delayed.root ? read_of(queue->delayed.root)->due : UINT64_MAX;
}

void slc_read_queue_add_attempt(struct slc_read_queue *queue, struct slc_read *read,
                                SluiceResult result, uint64_t offset, uint64_t latency)
{
    slc_read_statistics_add_attempt(&read->source->statistics, result, offset, latency);
    slc_read_statistics_add_attempt(&queue->statistics, result, offset, latency);
}

void slc_read_queue_delay(struct slc_read_queue *queue, struct slc_read *read, uint64_t due)
{
    stop_running(queue, read);
    read->state = SLC_READ_DELAYED;
    read->due = due;
    slc_pairing_heap_add(&queue->delayed, &read->node);
    read->source->statistics.counts.delayedCount++;
    queue->statistics.counts.delayedCount++;
    read->source->statistics.counts.retriedCount++;
    queue->statistics.counts.retriedCount++;
}

void slc_read_queue_wait(struct slc_read_queue *queue, struct slc_read *read)
{
    stop_running(queue, read);
    read->state = SLC_READ_WAITING;
    queue->waiting_count++;
}

void slc_read_queue_resume(struct slc_read_queue *queue, struct slc_read *read)
{
    bool has_failed = read->state == SLC_READ_RUNNING && read->is_copy; /* texels were evicted */
    if (read->state == SLC_READ_WAITING)
        queue->waiting_count--;
    else
        stop_running(queue, read);
    enqueue(queue, read, !has_failed && is_copy(queue, read));
}

void slc_read_queue_end(struct slc_read_queue *queue, struct slc_read *read, SluiceResult result)
{
    if (read->state == SLC_READ_QUEUED)
        dequeue(queue, read);
    else if (read->state == SLC_READ_DELAYED)
        undelay(queue, read);
    else if (read->state == SLC_READ_WAITING)
        queue->waiting_count--;
    else
        stop_running(queue, read);
    read->state = SLC_READ_FINISHED;
    read->result.result = result;
    read->result.size = result == SLUICE_SUCCESS ? read->done_size : 0;
    slc_read_statistics_add_end(&read->source->statistics, result, read->result.size);
    slc_read_statistics_add_end(&queue->statistics, result, read->result.size);
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
    slc_read_sources_remove_read(&queue->sources, read->source);
    queue->free_slots[queue->free_count++] = slot;
    return true;
}

bool slc_read_queue_is_idle(const struct slc_read_queue *queue)
{
    return queue->queued_count == 0 && queue->running_count == 0 && queue->waiting_count == 0 &&
           !queue->delayed.root;
}

SluiceResult slc_read_queue_forget(struct slc_read_queue *queue, const SluiceImageSource *source)
{
    struct slc_read_source *known = slc_read_sources_find(&queue->sources, source);
    if (known && known->read_count > 0)
        return SLUICE_NOT_READY;
    if (known)
        slc_read_sources_forget(&queue->sources, known);
    return SLUICE_SUCCESS;
}

void slc_read_queue_write_statistics(const struct slc_read_queue *queue,
                                     const SluiceImageSource *source,
                                     SluiceTileLoaderStatistics *statistics)
{
    const struct slc_read_source *known =
        source ? slc_read_sources_find(&queue->sources, source) : NULL;
    *statistics = (SluiceTileLoaderStatistics){.structSize = sizeof(SluiceTileLoaderStatistics)};
    if (!source || known)
        slc_read_statistics_write(known ? &known->statistics : &queue->statistics, statistics);
}
