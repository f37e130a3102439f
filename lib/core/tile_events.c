#include "core/tile_events.h"

#include "base/alloc.h"
#include "core/refusal.h"

void slc_tile_events_finish(struct slc_tile_events *events, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, events->ring, events->capacity, sizeof *events->ring);
    events->ring = NULL;
    events->capacity = 0;
}

void slc_tile_event_add(void *user, const struct slc_node *node, uint8_t from, uint8_t to)
{
    slc_manager *m = user;
    struct slc_tile_events *e = &m->events;
    e->ring[e->count++ % e->capacity] =
        (SluiceTileEvent){.textureId = slc_texture_id(slc_texture_at(m, node->owner)),
                          .timeStamp = m->time,
                          .mark = e->mark,
                          .tileIndex = node->tile,
                          .from = (SluiceTileState)from,
                          .to = (SluiceTileState)to,
                          .reason = e->reason};
}

SluiceResult sluiceSetTileEventCapacity(SluiceStreamedTextureManager *manager, uint32_t capacity)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_tile_events *e = &manager->events;
    SluiceTileEvent *ring = NULL;
    if (capacity > SLUICE_MAX_TILE_EVENTS)
        return slc_refuse(manager, __func__, "capacity %u is above %u", capacity,
                          SLUICE_MAX_TILE_EVENTS);
    if (capacity > 0) {
        ring = slc_alloc(&manager->cb, capacity, sizeof *ring);
        if (!ring)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    slc_tile_events_finish(e, &manager->cb);
    e->ring = ring;
    e->capacity = capacity;
    e->first = e->count;
    manager->residency.user.changed = ring ? slc_tile_event_add : NULL;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceMarkTileEvents(SluiceStreamedTextureManager *manager, uint64_t mark)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    manager->events.mark = mark;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReadTileEvents(const SluiceStreamedTextureManager *manager, uint64_t *pCursor,
                                  uint32_t *pEventCount, SluiceTileEvent *pEvents,
                                  uint64_t *pLostCount)
{
    if (!manager || !pCursor || !pEventCount || (*pEventCount && !pEvents))
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_tile_events *e = &manager->events;
    uint64_t oldest = e->count > e->capacity ? e->count - e->capacity : 0, at = *pCursor;
    oldest = e->first > oldest ? e->first : oldest;
    if (at > e->count)
        return slc_refuse(manager, __func__, "cursor %llu is above the number of events, %llu",
                          (unsigned long long)at, (unsigned long long)e->count);
    uint64_t lost = at < oldest ? oldest - at : 0;
    uint32_t room = *pEventCount, written = 0;
    for (at += lost; written < room && at < e->count; at++)
        pEvents[written++] = e->ring[at % e->capacity];
    *pCursor = at;
    *pEventCount = written;
    if (pLostCount)
        *pLostCount = lost;
    return at < e->count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}
