#define _POSIX_C_SOURCE 200809L

#include "play_loop.h"

#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define LIST_ROOM 256u

static bool check(SluiceResult result, const char *call)
{
    if (result < 0)
        text_say("%s: %s", call, sluiceGetResultName(result));
    return result >= 0;
}

static uint64_t nanoseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

/** Calls a function of the manager and measures its time. Returns whether it succeeded. */
#define CORE(loop, function, ...)                                                                  \
    ((loop)->began_ns = nanoseconds(),                                                             \
     end_call(loop, function((loop)->manager, __VA_ARGS__), #function))

static bool end_call(struct play_loop *l, SluiceResult result, const char *name)
{
    l->core_ns += nanoseconds() - l->began_ns;
    return check(result, name);
}

/* Setting up -------------------------------------------------------------------------------- */

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap)
{
    struct play_loop *l = user;
    (void)size;
    *heap = l->next_heap++;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap)
{
    (void)user;
    (void)heap;
}

static bool create_manager(struct play_loop *l)
{
    const struct play_options *o = l->options;
    const SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {l, allocate_heap, release_heap},
        .heapTileCapacity = o->heap_tiles,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = true,
    };
    const SluiceStreamedTextureManagerConfig config = {
        .structSize = sizeof config,
        .numExtraStandbyTiles = o->standby,
        .maxHeapCount = o->max_heaps,
        .missesToExpire = o->misses_to_forget,
        .prefetchLevels = o->prefetch_levels,
    };
    return check(sluiceCreateStreamedTextureManager(&info, &l->manager), "the manager") &&
           check(sluiceSetConfig(l->manager, &config), "its configuration");
}

static bool add_textures(struct play_loop *l)
{
    const struct feedback_trace *t = l->trace;
    for (uint32_t i = 0; i < t->texture_count; i++)
        if (!check(sluiceAddStreamedTexture(l->manager, &t->textures[i].layout.desc, &l->ids[i]),
                   "a texture"))
            return false;
    for (uint32_t i = 0; i < t->texture_count; i++)
        if (t->textures[i].primary != i &&
            !check(sluiceSetPrimaryTexture(l->manager, l->ids[i], l->ids[t->textures[i].primary]),
                   "a follower"))
            return false;
    return true;
}

/** Limit of loads in flight. */
static uint32_t load_room(const struct play_options *o)
{
    return o->loads_in_flight ? o->loads_in_flight : o->tiles_per_frame * (o->latency + 1);
}

static bool allocate(struct play_loop *l)
{
    const uint32_t room = load_room(l->options) > LIST_ROOM ? load_room(l->options) : LIST_ROOM;
    l->load_room = load_room(l->options);
    l->ids = calloc((size_t)l->trace->texture_count + 1, sizeof *l->ids);
    l->loads = calloc(room, sizeof *l->loads);
    l->tiles = calloc(room, sizeof *l->tiles);
    l->batch = calloc(room, sizeof *l->batch);
    l->frames = calloc((size_t)l->trace->frame_count + 1, sizeof *l->frames);
    if (l->ids && l->loads && l->tiles && l->batch && l->frames)
        return true;
    fprintf(stderr, "out of memory\n");
    return false;
}

bool play_loop_init(struct play_loop *l, const struct play_options *options,
                    struct feedback_trace *trace)
{
    *l = (struct play_loop){.options = options, .trace = trace};
    return allocate(l) && view_init(&l->view, trace) &&
           play_feedback_init(&l->feedback, trace, options) && create_manager(l) && add_textures(l);
}

void play_loop_finish(struct play_loop *l)
{
    sluiceDestroyStreamedTextureManager(l->manager);
    view_finish(&l->view);
    play_feedback_finish(&l->feedback);
    free(l->ids);
    free(l->loads);
    free(l->tiles);
    free(l->batch);
    free(l->frames);
    *l = (struct play_loop){0};
}

/* A frame ----------------------------------------------------------------------------------- */

/** Records what is resident for all maps of the frame before any map is processed. */
static bool take_maps(struct play_loop *l, uint32_t frame)
{
    feedback_trace_next_frame(l->trace, &l->now.time, &l->now.map_count);
    view_begin_frame(&l->view);
    for (uint32_t i = 0; i < l->now.map_count; i++) {
        uint32_t index;
        const uint8_t *map = feedback_trace_next_map(l->trace, &index);
        if (!view_add_map(&l->view, l->manager, l->ids[index], index, map, frame) ||
            !play_feedback_add(&l->feedback, index, map, frame))
            return false;
    }
    l->now.view = l->view.now;
    return true;
}

static bool give_feedback(struct play_loop *l)
{
    const uint64_t timeout = (uint64_t)(l->options->timeout * 1e6 + 0.5);
    uint32_t index;
    SluiceFeedbackDesc feedback = {.structSize = sizeof feedback, .mipBias = l->options->mip_bias};
    play_feedback_begin_reading(&l->feedback);
    while (play_feedback_next(&l->feedback, &index, &feedback.pMinMip)) {
        feedback.width = l->trace->textures[index].layout.feedbackWidth;
        feedback.height = l->trace->textures[index].layout.feedbackHeight;
        if (!CORE(l, sluiceUpdateWithSamplerFeedback, l->ids[index], &feedback, l->now.time,
                  timeout))
            return false;
    }
    return true;
}

/** Cancels a load before it arrives. Few loads are in flight, so a linear search is cheap. */
static void drop_load(struct play_loop *l, const SluiceTile *tile)
{
    for (uint32_t i = 0; i < l->load_count; i++) {
        if (l->loads[i].id != tile->textureId || l->loads[i].tile != tile->tileIndex)
            continue;
        memmove(l->loads + i, l->loads + i + 1, (--l->load_count - i) * sizeof *l->loads);
        return;
    }
}

static bool stop_loads(struct play_loop *l)
{
    uint32_t count;
    do {
        count = LIST_ROOM;
        if (!CORE(l, sluiceGetTilesToCancel, SLUICE_ALL_TEXTURES, &count, l->tiles))
            return false;
        for (uint32_t i = 0; i < count;) {
            const SluiceTextureId id = l->tiles[i].textureId;
            uint32_t batch = 0;
            for (; i < count && l->tiles[i].textureId == id; i++) {
                drop_load(l, &l->tiles[i]);
                l->batch[batch++] = l->tiles[i].tileIndex;
            }
            if (!CORE(l, sluiceReportCanceledTiles, id, batch, l->batch, 0))
                return false;
        }
        l->now.canceled_tiles += count;
    } while (count == LIST_ROOM);
    return true;
}

static bool unmap_tiles(struct play_loop *l, uint32_t frame)
{
    uint32_t count;
    do {
        count = LIST_ROOM;
        if (!CORE(l, sluiceGetTilesToUnmap, SLUICE_ALL_TEXTURES, frame + 1, &count, l->tiles))
            return false;
        l->now.unmapped_tiles += count;
    } while (count == LIST_ROOM);
    return true;
}

static bool start_loads(struct play_loop *l, uint32_t frame)
{
    uint32_t count = l->load_room - l->load_count;
    if (count == 0)
        return true;
    if (!CORE(l, sluiceGetTilesToMap, SLUICE_ALL_TEXTURES, &count, l->tiles))
        return false;
    for (uint32_t i = 0; i < count; i++)
        l->loads[l->load_count++] =
            (struct play_load){l->tiles[i].textureId, l->tiles[i].tileIndex, frame};
    return true;
}

/** Texture ids count up from 0, because no texture is removed. */
static uint32_t index_of(SluiceTextureId id)
{
    return (uint32_t)id;
}

/** Answers the loads that are due, oldest first. */
static bool answer_loads(struct play_loop *l, uint32_t frame)
{
    const struct play_options *o = l->options;
    uint32_t due = 0;
    while (due < l->load_count && due < o->tiles_per_frame &&
           (uint64_t)l->loads[due].frame + o->latency <= frame)
        due++;
    for (uint32_t i = 0; i < due;) {
        const SluiceTextureId id = l->loads[i].id;
        uint32_t batch = 0;
        for (; i < due && l->loads[i].id == id; i++) {
            l->batch[batch++] = l->loads[i].tile;
            l->now.stale_tiles += view_is_stale(&l->view, index_of(id), l->loads[i].tile);
        }
        if (!CORE(l, sluiceUpdateTilesMapping, id, batch, l->batch))
            return false;
    }
    l->now.loaded_tiles = due;
    l->load_count -= due;
    memmove(l->loads, l->loads + due, l->load_count * sizeof *l->loads);
    return true;
}

/** Publishes MinMip updates as an application does: copies each rectangle. */
static bool publish(struct play_loop *l)
{
    SluiceMinMipRect rects[LIST_ROOM];
    uint32_t count;
    do {
        count = LIST_ROOM;
        if (!CORE(l, sluiceGetMinMipUpdates, &count, rects))
            return false;
        for (uint32_t i = 0; i < count; i++)
            if (!CORE(l, sluiceWriteMinMipRect, &rects[i], rects[i].width,
                      (size_t)rects[i].width * rects[i].height, l->view.min_mip))
                return false;
    } while (count == LIST_ROOM);
    return true;
}

static bool end_frame(struct play_loop *l, uint32_t frame)
{
    SluiceStreamedTextureStatistics *s = &l->statistics;
    s->structSize = sizeof *s;
    if (!check(sluiceGetStatistics(l->manager, s), "sluiceGetStatistics"))
        return false;
    l->now.requested_tiles = s->requestedTileCount;
    l->now.tiles_in_flight = l->load_count;
    l->now.resident_tiles = s->mappedTileCount + s->standbyTileCount;
    l->now.heaps = s->heapCount;
    l->now.core_us = (double)l->core_ns / 1e3;
    l->frames[frame] = l->now;
    return true;
}

static bool play_frame(struct play_loop *l, uint32_t frame)
{
    const uint32_t delay = l->options->latency + 1;
    l->now = (struct play_frame){0};
    l->core_ns = 0;
    if (frame >= delay && !CORE(l, sluiceCompleteRetireValue, frame + 1 - delay))
        return false;
    return take_maps(l, frame) && give_feedback(l) && stop_loads(l) && unmap_tiles(l, frame) &&
           start_loads(l, frame) && answer_loads(l, frame) && publish(l) && end_frame(l, frame);
}

bool play_loop_run(struct play_loop *l)
{
    feedback_trace_rewind(l->trace);
    for (uint32_t frame = 0; frame < l->trace->frame_count; frame++)
        if (!play_frame(l, frame))
            return false;
    view_end_waits(&l->view);
    return true;
}
