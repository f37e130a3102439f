#include "played_facts.h"

#include <stdio.h>
#include <stdlib.h>

#define MB 1e6

_Static_assert(PLAYED_EVENTS == FACTS_EVENTS, "events are borrowed");

bool played_facts_create(const struct stage *stage, struct view_facts *f)
{
    const struct played *p = stage_played(stage);
    f->borrows = true;
    f->played_frame = UINT32_MAX;
    f->textures = calloc(f->texture_count + 1u, sizeof *f->textures);
    for (uint32_t i = 0; i < p->texture_count; i++) {
        f->map_size = p->textures[i].map_size > f->map_size ? p->textures[i].map_size : f->map_size;
        f->all_size += stage_texture(stage, i)->size;
        f->tails_size += (uint64_t)p->textures[i].desc.packedTileCount * p->begin.tileSize;
    }
    f->maps = malloc(2 * f->map_size + 1);
    return f->textures && f->maps && history_create(SERIES_COUNT, &f->history);
}

/* Writes figures of a frame into the fields of the streamer's figures. */
static void name_statistics(const struct played *p, struct view_facts *f)
{
    SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
    SluiceVulkanStreamerStatistics *now = &f->now;
    *now = (SluiceVulkanStreamerStatistics){.structSize = sizeof *now};
    if (sluiceGetStatistics(p->manager, &s) != SLUICE_SUCCESS)
        return;
    now->requestedTileCount = s.requestedTileCount;
    now->standbyTileCount = s.standbyTileCount;
    now->failedTileCount = s.failedTileCount;
    now->givenUpTileCount = s.givenUpTileCount;
    now->heapCount = s.heapCount;
    now->globalMipBias = s.globalMipBias;
    now->loadsInFlight = s.allocatedTileCount + s.canceledTileCount;
    now->tilesMapped = s.mappedTotal;
    now->tilesUnmapped = s.unmappedTotal;
    now->tilesCanceled = s.canceledTotal;
    now->tilesFailed = s.failedTotal;
    now->tilesRestored = s.restoredTotal;
    f->standby_size = (uint64_t)s.standbyTileCount * p->begin.tileSize;
    f->memory_size = (uint64_t)s.heapCount * p->begin.heapTileCapacity * p->begin.tileSize;
}

static void name_series(const struct played *p, struct view_facts *f)
{
    const uint32_t *figures = p->frames[p->frame].figures;
    const double values[SERIES_COUNT] = {[SERIES_RESIDENT] = (double)f->resident_size / MB,
                                         [SERIES_WANTED] = (double)f->wanted_size / MB,
                                         [SERIES_STANDBY] = (double)f->standby_size / MB,
                                         [SERIES_BUDGET] = (double)f->budget / MB,
                                         [SERIES_MAPPED] = figures[PLAYED_LOADED],
                                         [SERIES_UNMAPPED] = figures[PLAYED_EVICTED],
                                         [SERIES_CANCELED] = figures[PLAYED_CANCELED],
                                         [SERIES_FAILED] = figures[PLAYED_FAILED],
                                         [SERIES_SHARP] = 100.0 * f->sharp,
                                         [SERIES_BIAS] = figures[PLAYED_BIAS] / 16.0,
                                         [SERIES_FRAME] = figures[PLAYED_MICROSECONDS] / 1e3,
                                         [SERIES_STALE] = figures[PLAYED_STALE],
                                         [SERIES_RESTORED] = figures[PLAYED_RESTORED],
                                         [SERIES_MISSING] = 100.0 - 100.0 * f->sharp};
    for (int i = 0; i < SERIES_COUNT; i++)
        if (i != SERIES_HOST && i != SERIES_GPU)
            f->latest[i] = (float)values[i];
}

void played_facts_update(const struct stage *stage, struct view_facts *f)
{
    const struct played *p = stage_played(stage);
    f->latest[SERIES_HOST] = (float)(1e3 * f->host_seconds);
    f->latest[SERIES_GPU] = (float)(1e3 * f->gpu_seconds);
    if (f->played_frame == p->frame)
        return;
    const uint64_t heap_size = (uint64_t)p->begin.heapTileCapacity * p->begin.tileSize;
    f->played_frame = p->frame;
    f->log = p->log;
    f->events = p->events;
    f->event_count = p->event_count;
    f->event_next = p->event_next;
    f->budget = p->frames[p->frame].figures[PLAYED_BUDGET] * heap_size;
    name_statistics(p, f);
    facts_look_at_all(f, stage);
    name_series(p, f);
}

static void print(const char *name, double value, const char *unit)
{
    printf("{\"name\": \"%s\", \"value\": %.10g, \"unit\": \"%s\"}\n", name, value, unit);
}

void played_print_json(const struct stage *stage, const struct view_facts *f)
{
    const struct played *p = stage_played(stage);
    const struct played_frame *frame = &p->frames[p->frame];
    SluiceTracePlayerState state = {.structSize = sizeof state};
    sluiceGetTracePlayerState(p->player, &state);
    print("frame", p->frame, "");
    print("frames", p->frame_count, "");
    print("events", (double)state.eventCount, "calls");
    print("time", (double)frame->time, "ticks");
    for (int i = 0; i < PLAYED_FIGURES; i++)
        print(played_figure_name((enum played_figure)i), frame->figures[i], "");
    print("tiles_wanted", played_wanted(frame), "tiles");
    print("textures", f->texture_count, "textures");
    print("mapped_total", (double)f->now.tilesMapped, "tiles");
    print("unmapped_total", (double)f->now.tilesUnmapped, "tiles");
    print("canceled_total", (double)f->now.tilesCanceled, "tiles");
    print("failed_total", (double)f->now.tilesFailed, "tiles");
    print("restored_total", (double)f->now.tilesRestored, "tiles");
    print("resident", (double)f->resident_size, "B");
    print("sharp", f->sharp, "");
    printf("{\"name\": \"hash\", \"value\": \"%016llx\", \"unit\": \"fnv1a64\"}\n",
           (unsigned long long)state.decisionHash);
}
