/* Checkpoints of a recording, and jumps to frames. */
#include "played_parts.h"

#include <stdlib.h>
#include <string.h>

#define EVENTS_AT_ONCE 256u

static void point_finish(struct played *p, struct played_point *point)
{
    p->point_size -= point->capacity + point->log.size + point->event_count * sizeof *point->events;
    free(point->bytes);
    free(point->events);
    tile_log_kept_finish(&point->log);
    *point = (struct played_point){0};
}

void played_points_finish(struct played *p)
{
    for (uint32_t i = 0; i < p->point_count; i++)
        point_finish(p, &p->points[i]);
    free(p->points);
    p->points = NULL;
    p->point_count = 0;
}

static SluiceResult append(void *user, const void *data, size_t size)
{
    struct played_point *point = user;
    if (size > point->capacity - point->size) {
        const size_t capacity = 2 * point->capacity + size + 1024;
        void *bytes = realloc(point->bytes, capacity);
        if (!bytes)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        point->bytes = bytes;
        point->capacity = capacity;
    }
    memcpy((char *)point->bytes + point->size, data, size);
    point->size += size;
    return SLUICE_SUCCESS;
}

static void shrink(struct played_point *point)
{
    void *bytes = realloc(point->bytes, point->size);
    if (!bytes)
        return;
    point->bytes = bytes;
    point->capacity = point->size;
}

static bool keep_events(const struct played *p, struct played_point *point)
{
    point->events = malloc((p->event_count + 1u) * sizeof *point->events);
    if (!point->events)
        return false;
    for (uint32_t i = 0; i < p->event_count; i++)
        point->events[i] =
            p->events[(p->event_next + PLAYED_EVENTS - p->event_count + i) % PLAYED_EVENTS];
    point->event_count = p->event_count;
    point->lost_events = p->lost_events;
    point->timeout = p->timeout;
    return true;
}

static bool make_point(struct played *p, uint32_t frame, struct played_point *point)
{
    const SluiceRecordWriter writer = {point, append};
    *point = (struct played_point){.frame = frame};
    const bool made = sluiceWriteTraceCheckpoint(p->player, &writer) == SLUICE_SUCCESS &&
                      tile_log_keep(&p->log, &point->log) && keep_events(p, point);
    if (made)
        shrink(point);
    p->point_size += point->capacity + point->log.size + point->event_count * sizeof *point->events;
    if (!made)
        point_finish(p, point);
    return made;
}

/* The first checkpoint stays, since none is before it. */
static void thin_out(struct played *p)
{
    uint32_t kept = 0;
    p->stride *= 2;
    for (uint32_t i = 0; i < p->point_count; i++)
        if (p->points[i].frame % p->stride == 0)
            p->points[kept++] = p->points[i];
        else
            point_finish(p, &p->points[i]);
    p->point_count = kept;
}

bool played_point_add(struct played *p, uint32_t frame)
{
    struct played_point *points = realloc(p->points, (p->point_count + 1u) * sizeof *points);
    if (!points)
        return false;
    p->points = points;
    if (!make_point(p, frame, &points[p->point_count]))
        return false;
    p->point_count++;
    while (p->point_size > p->most_point_size && p->point_count > 1)
        thin_out(p);
    return true;
}

static bool is_loss(const SluiceTileEvent *event)
{
    return event->from == SLUICE_TILE_STATE_MAPPED && (event->reason == SLUICE_TILE_EVENT_EVICTED ||
                                                       event->reason == SLUICE_TILE_EVENT_CALLED);
}

uint32_t played_take_events(struct played *p, const SluiceTraceCall *call)
{
    SluiceTileEvent events[EVENTS_AT_ONCE];
    SluiceResult result;
    uint32_t lost_tiles = 0;
    if (call->kind == SLUICE_TRACE_CALL_UPDATE_FEEDBACK)
        p->timeout = call->timeout;
    do {
        uint32_t count = EVENTS_AT_ONCE;
        uint64_t lost = 0;
        result = sluiceReadTileEvents(p->manager, &p->event_cursor, &count, events, &lost);
        p->lost_events += lost;
        for (uint32_t i = 0; result >= SLUICE_SUCCESS && i < count; i++) {
            events[i].mark = p->frame;
            lost_tiles += is_loss(&events[i]);
            tile_log_take(&p->log, &events[i], p->timeout);
            p->events[p->event_next] = events[i];
            p->event_next = (p->event_next + 1) % PLAYED_EVENTS;
            p->event_count += p->event_count < PLAYED_EVENTS;
        }
    } while (result == SLUICE_INCOMPLETE);
    return lost_tiles;
}

static bool restore(struct played *p, const struct played_point *point)
{
    if (sluiceReadTraceCheckpoint(p->player, point->bytes, point->size) != SLUICE_SUCCESS ||
        sluiceGetTracePlayerManager(p->player, &p->manager) != SLUICE_SUCCESS)
        return false;
    p->event_cursor = 0;
    tile_log_restore(&p->log, &point->log);
    memcpy(p->events, point->events, point->event_count * sizeof *p->events);
    p->event_count = point->event_count;
    p->event_next = point->event_count % PLAYED_EVENTS;
    p->lost_events = point->lost_events;
    p->timeout = point->timeout;
    p->frame = point->frame;
    return true;
}

/* Plays from the first call of a frame up to the first call of the next frame. */
static bool play_frame(struct played *p, uint64_t *calls)
{
    const uint64_t end =
        p->frame + 1 < p->frame_count ? p->frames[p->frame + 1].first_call : p->end.eventCount;
    for (; *calls < end; ++*calls) {
        SluiceTraceCall call = {.structSize = sizeof call};
        if (sluiceGetNextTraceCall(p->player, &call) != SLUICE_SUCCESS ||
            sluicePlayTraceCall(p->player) != SLUICE_SUCCESS)
            return false;
        played_take_events(p, &call);
    }
    return true;
}

static const struct played_point *point_before(const struct played *p, uint32_t frame)
{
    const struct played_point *found = NULL;
    for (uint32_t i = 0; i < p->point_count && p->points[i].frame <= frame; i++)
        found = &p->points[i];
    return found;
}

bool played_go(struct played *p, uint32_t frame)
{
    SluiceTracePlayerState state = {.structSize = sizeof state};
    if (frame >= p->frame_count)
        frame = p->frame_count - 1;
    const struct played_point *point = point_before(p, frame);
    const bool back = frame < p->frame || p->is_partial;
    if (back || (point && point->frame > p->frame + 1)) {
        if (!point || !restore(p, point))
            return false;
    } else if (frame == p->frame) {
        return true;
    } else {
        p->frame++;
    }
    if (sluiceGetTracePlayerState(p->player, &state) != SLUICE_SUCCESS)
        return false;
    for (;; p->frame++) {
        p->is_partial = !play_frame(p, &state.eventCount);
        if (p->is_partial)
            return false;
        if (p->frame == frame)
            return true;
    }
}
