#include "image/read_sources.h"

#include "base/alloc.h"

#include <assert.h>

static void unlink_idle(struct slc_read_source *source)
{
    source->previous->next = source->next;
    source->next->previous = source->previous;
    source->previous = source->next = NULL;
}

static void link_after(struct slc_read_source *where, struct slc_read_source *source)
{
    source->previous = where;
    source->next = where->next;
    where->next->previous = source;
    where->next = source;
}

SluiceResult slc_read_sources_init(struct slc_read_sources *sources,
                                   const SluiceAllocationCallbacks *cb, uint32_t count)
{
    assert(count > 0 && count < 1u << 30);
    *sources = (struct slc_read_sources){.count = count, .place_count = 4};
    while (sources->place_count < 2 * count)
        sources->place_count *= 2;
    sources->records = slc_calloc(cb, count, sizeof *sources->records);
    sources->places = slc_calloc(cb, sources->place_count, sizeof *sources->places);
    if (!sources->records || !sources->places) {
        slc_read_sources_finish(sources, cb);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    sources->peer = sources;
    sources->idle.previous = sources->idle.next = &sources->idle;
    for (uint32_t i = 0; i < count; i++)
        link_after(&sources->idle, &sources->records[i]);
    return SLUICE_SUCCESS;
}

/* Finds a source's place, or the free place where it would be. */
static uint32_t place_of(const struct slc_read_sources *sources, const SluiceImageSource *source)
{
    uint64_t hash = (uint64_t)(uintptr_t)source * 0x9E3779B97F4A7C15u >> 32;
    uint32_t at = (uint32_t)hash & (sources->place_count - 1);
    while (sources->places[at] && sources->places[at]->source != source)
        at = (at + 1) & (sources->place_count - 1);
    return at;
}

struct slc_read_source *slc_read_sources_find(const struct slc_read_sources *sources,
                                              const SluiceImageSource *source)
{
    return sources->places[place_of(sources, source)];
}

static void remove_place(struct slc_read_sources *sources, const struct slc_read_source *source)
{
    uint32_t mask = sources->place_count - 1, at = place_of(sources, source->source);
    assert(sources->places[at] == source);
    sources->places[at] = NULL;
    /* Moves later records back whose preferred place is at or before the gap. */
    for (at = (at + 1) & mask; sources->places[at]; at = (at + 1) & mask) {
        struct slc_read_source *moved = sources->places[at];
        sources->places[at] = NULL;
        sources->places[place_of(sources, moved->source)] = moved;
    }
}

static void link_twin(struct slc_read_sources *sources, struct slc_read_source *record)
{
    record->twin = record;
    for (const struct slc_read_sources *peer = sources->peer; peer != sources; peer = peer->peer) {
        struct slc_read_source *twin = slc_read_sources_find(peer, record->source);
        if (!twin)
            continue;
        record->twin = twin->twin;
        twin->twin = record;
        return;
    }
}

static void unlink_twin(struct slc_read_source *record)
{
    struct slc_read_source *before = record;
    while (before->twin != record)
        before = before->twin;
    before->twin = record->twin;
    record->twin = record;
}

void slc_read_sources_share(struct slc_read_sources *sources, struct slc_read_sources *peer)
{
    sources->peer = peer->peer;
    peer->peer = sources;
}

static void leave_peers(struct slc_read_sources *sources)
{
    struct slc_read_sources *before = sources;
    for (uint32_t i = 0; i < sources->count; i++)
        if (sources->records[i].source)
            unlink_twin(&sources->records[i]);
    while (before->peer != sources)
        before = before->peer;
    before->peer = sources->peer;
}

void slc_read_sources_finish(struct slc_read_sources *sources, const SluiceAllocationCallbacks *cb)
{
    if (sources->peer)
        leave_peers(sources);
    slc_free(cb, sources->records, sources->count, sizeof *sources->records);
    slc_free(cb, sources->places, sources->place_count, sizeof *sources->places);
    *sources = (struct slc_read_sources){0};
}

static void forget(struct slc_read_sources *sources, struct slc_read_source *record)
{
    unlink_twin(record);
    remove_place(sources, record);
}

/* Reuses the record of an idle source, which is forgotten. */
static struct slc_read_source *recycle(struct slc_read_sources *sources, SluiceImageSource *source)
{
    struct slc_read_source *record = sources->idle.next;
    assert(record != &sources->idle);
    unlink_idle(record);
    sources->has_recycled |= record->source != NULL;
    if (record->source)
        forget(sources, record);
    *record = (struct slc_read_source){.source = source, .sources = sources};
    sources->places[place_of(sources, source)] = record;
    link_twin(sources, record);
    return record;
}

struct slc_read_source *slc_read_sources_add_read(struct slc_read_sources *sources,
                                                  SluiceImageSource *source)
{
    struct slc_read_source *record = slc_read_sources_find(sources, source);
    if (!record)
        record = recycle(sources, source);
    else if (record->read_count == 0)
        unlink_idle(record);
    record->read_count++;
    return record;
}

void slc_read_sources_remove_read(struct slc_read_sources *sources, struct slc_read_source *source)
{
    if (--source->read_count == 0)
        link_after(sources->idle.previous, source);
}

void slc_read_sources_forget(struct slc_read_sources *sources, struct slc_read_source *source)
{
    assert(source->source && source->read_count == 0);
    forget(sources, source);
    unlink_idle(source);
    *source = (struct slc_read_source){0};
    link_after(&sources->idle, source);
}
