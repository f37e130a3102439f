#include "played_parts.h"

#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_MEMORY                                                                                \
    (1ull << 30)              /* limit, since a few bytes of a trace can declare a billion tiles */
#define EVENT_CAPACITY 65536u /* events of one call, in the player */
#define PROGRESS_FRAMES 64u

static void *allocate(void *user, size_t size, size_t alignment)
{
    struct played *p = user;
    if (size > p->memory_left || size > SIZE_MAX - alignment)
        return NULL;
    void *memory = alignment <= _Alignof(max_align_t)
                       ? malloc(size)
                       : aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (memory)
        p->memory_left -= size;
    return memory;
}

static void release(void *user, void *memory, size_t size)
{
    struct played *p = user;
    if (memory)
        p->memory_left += size;
    free(memory);
}

static void note_message(void *user, SluiceLogSeverity severity, const char *message)
{
    struct played *p = user;
    if (severity >= SLUICE_LOG_WARNING && !p->message[0])
        snprintf(p->message, sizeof p->message, "%s", message);
}

static bool out_of_memory(const struct played *p)
{
    text_say("sluice-view: %s: out of memory; a recording may use %llu MiB", p->name,
             MOST_MEMORY >> 20);
    return false;
}

static bool create_player(struct played *p)
{
    const SluiceTracePlayerCreateInfo info = {.structSize = sizeof info,
                                              .pData = p->data,
                                              .size = p->size,
                                              .pAllocator = &p->callbacks,
                                              .log = {p, note_message},
                                              .tileEventCapacity = EVENT_CAPACITY};
    const SluiceResult result = sluiceCreateTracePlayer(&info, &p->player);
    p->begin = (SluiceTracePlayerState){.structSize = sizeof p->begin};
    if (result == SLUICE_SUCCESS &&
        sluiceGetTracePlayerManager(p->player, &p->manager) == SLUICE_SUCCESS &&
        sluiceGetTracePlayerState(p->player, &p->begin) == SLUICE_SUCCESS)
        return true;
    text_say("sluice-view: %s: %s", p->name,
             p->message[0] ? p->message : sluiceGetResultName(result));
    return false;
}

static bool add_texture(struct played *p, SluiceTextureId id)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    uint32_t known;
    if (played_find_texture(p, id, &known) ||
        sluiceGetTextureLayout(p->manager, id, &layout) != SLUICE_SUCCESS)
        return true;
    if (p->texture_count == p->texture_capacity) {
        const uint32_t capacity = 2 * p->texture_capacity + 64;
        struct played_texture *textures = realloc(p->textures, capacity * sizeof *textures);
        if (!textures)
            return false;
        p->textures = textures;
        p->texture_capacity = capacity;
    }
    /* The manager keeps no tiles of unused textures, but the log does. */
    const uint64_t log_size = layout.tileCount * (uint64_t)TILE_LOG_TILE_SIZE;
    if (log_size > p->memory_left || !tile_log_add(&p->log, id, layout.tileCount))
        return false;
    p->memory_left -= log_size;
    struct played_texture *t = &p->textures[p->texture_count++];
    *t = (struct played_texture){.id = id,
                                 .desc = layout.desc,
                                 .tile_count = layout.tileCount,
                                 .map_size = layout.minMipWidth * layout.minMipHeight,
                                 .primary = PLAYED_NO_TEXTURE};
    snprintf(t->name, sizeof t->name, "texture %u.%u", (unsigned)(id & UINT32_MAX),
             (unsigned)(id >> 32));
    return true;
}

/* Adds the textures of the snapshot that the recording begins with. */
static bool add_first_textures(struct played *p)
{
    uint32_t count = 0;
    if (sluiceGetTracePlayerTextures(p->player, &count, NULL) != SLUICE_SUCCESS)
        return false;
    SluiceTextureId *ids = malloc((count + 1u) * sizeof *ids);
    bool added = ids && sluiceGetTracePlayerTextures(p->player, &count, ids) == SLUICE_SUCCESS;
    for (uint32_t i = 0; added && i < count; i++)
        added = add_texture(p, ids[i]);
    free(ids);
    return added;
}

bool played_find_texture(const struct played *p, SluiceTextureId id, uint32_t *index)
{
    return tile_log_index(&p->log, id, index);
}

static struct played_frame *add_frame(struct played *p, uint64_t first_call)
{
    if (p->frame_count == p->frame_capacity) {
        const uint32_t capacity = 2 * p->frame_capacity + 1024;
        struct played_frame *frames =
            capacity > p->frame_capacity ? realloc(p->frames, capacity * sizeof *frames) : NULL;
        if (!frames)
            return NULL;
        p->frames = frames;
        p->frame_capacity = capacity;
    }
    const uint64_t time = p->frame_count > 0 ? p->frames[p->frame_count - 1].time : 0;
    p->frames[p->frame_count] = (struct played_frame){.first_call = first_call, .time = time};
    return &p->frames[p->frame_count++];
}

/* The first pass. A frame ends after sluiceGetMinMipUpdates, or before feedback with another time
 * stamp. */
struct pass {
    struct played_frame *frame; ///< frame that is being played; NULL: none yet
    bool fed;                   ///< a call of the frame gave feedback, with the frame's time
    SluiceTraceCallKind before;
    SluiceStreamedTextureStatistics totals; ///< at the begin of the frame
    uint64_t calls, stale;
};

static bool is_feedback(const SluiceTraceCall *call)
{
    return call->kind == SLUICE_TRACE_CALL_UPDATE_FEEDBACK ||
           call->kind == SLUICE_TRACE_CALL_MATCH_PRIMARY;
}

/* Returns true if a call begins a frame. Failed loads may be reported between frames, with the time
 * of the previous frame. */
static bool begins_frame(const struct pass *pass, const SluiceTraceCall *call)
{
    const bool updates = call->kind == SLUICE_TRACE_CALL_GET_MINMIP_UPDATES;
    return !pass->frame || (pass->before == SLUICE_TRACE_CALL_GET_MINMIP_UPDATES && !updates) ||
           (is_feedback(call) && pass->fed && call->timeStamp != pass->frame->time);
}

static uint32_t limit_of(uint32_t a, uint32_t b)
{
    return a == 0 || (b > 0 && b < a) ? b : a;
}

static void end_frame(struct played *p, struct pass *pass)
{
    SluiceStreamedTextureStatistics now = {.structSize = sizeof now};
    SluiceTracePlayerState state = {.structSize = sizeof state};
    struct played_frame *frame = pass->frame;
    if (!frame || sluiceGetStatistics(p->manager, &now) != SLUICE_SUCCESS ||
        sluiceGetTracePlayerState(p->player, &state) != SLUICE_SUCCESS)
        return;
    uint32_t *f = frame->figures;
    f[PLAYED_REQUESTED] = now.requestedTileCount;
    f[PLAYED_LOADING] = now.allocatedTileCount;
    f[PLAYED_RESIDENT] = now.mappedTileCount;
    f[PLAYED_STANDBY] = now.standbyTileCount;
    f[PLAYED_CANCELING] = now.canceledTileCount;
    f[PLAYED_FAILING] = now.failedTileCount;
    f[PLAYED_GIVEN_UP] = now.givenUpTileCount;
    f[PLAYED_HEAPS] = now.heapCount;
    f[PLAYED_FREE_SLOTS] = now.freeSlotCount;
    f[PLAYED_BUDGET] = limit_of(state.maxHeapCount, state.targetHeapCount);
    f[PLAYED_BIAS] = now.globalMipBias;
    f[PLAYED_LISTED] = (uint32_t)(now.handedOutTotal - pass->totals.handedOutTotal);
    f[PLAYED_LOADED] = (uint32_t)(now.mappedTotal - pass->totals.mappedTotal);
    f[PLAYED_EVICTED] = (uint32_t)(now.unmappedTotal - pass->totals.unmappedTotal);
    f[PLAYED_CANCELED] = (uint32_t)(now.canceledTotal - pass->totals.canceledTotal);
    f[PLAYED_FAILED] = (uint32_t)(now.failedTotal - pass->totals.failedTotal);
    f[PLAYED_RESTORED] = (uint32_t)(now.restoredTotal - pass->totals.restoredTotal);
    f[PLAYED_STALE] = (uint32_t)(p->log.stale - pass->stale);
    pass->totals = now;
    pass->stale = p->log.stale;
}

static void note_call(struct played *p, struct pass *pass, const SluiceTraceCall *call)
{
    uint32_t *f = pass->frame->figures;
    uint32_t texture, primary;
    if (is_feedback(call) || (call->hasTimeStamp && !pass->fed))
        pass->frame->time = call->timeStamp;
    pass->fed = pass->fed || is_feedback(call);
    f[PLAYED_REFUSED] += call->refusedHeapCount;
    if (call->kind == SLUICE_TRACE_CALL_UPDATE_FEEDBACK && call->result >= SLUICE_SUCCESS) {
        f[PLAYED_MAPS]++;
        f[PLAYED_TEXELS] += call->feedbackWidth * call->feedbackHeight;
    }
    const bool follows = call->kind == SLUICE_TRACE_CALL_SET_PRIMARY ||
                         call->kind == SLUICE_TRACE_CALL_MATCH_PRIMARY;
    if (follows && call->result >= SLUICE_SUCCESS &&
        played_find_texture(p, call->textureId, &texture))
        p->textures[texture].primary =
            played_find_texture(p, call->primaryId, &primary) ? primary : PLAYED_NO_TEXTURE;
}

static bool begin_frame(struct played *p, struct pass *pass)
{
    end_frame(p, pass);
    const bool kept = p->frame_count % p->stride != 0 || played_point_add(p, p->frame_count);
    pass->frame = kept ? add_frame(p, pass->calls) : NULL;
    pass->fed = false;
    p->frame = p->frame_count > 0 ? p->frame_count - 1 : 0;
    return pass->frame;
}

static SluiceResult play_next(struct played *p, struct pass *pass, bool *ended)
{
    SluiceTraceCall call = {.structSize = sizeof call};
    SluiceResult result = sluiceGetNextTraceCall(p->player, &call);
    *ended = result == SLUICE_SUCCESS && call.kind == SLUICE_TRACE_CALL_NONE;
    if (result != SLUICE_SUCCESS || *ended)
        return result;
    if (begins_frame(pass, &call) && !begin_frame(p, pass))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    result = sluicePlayTraceCall(p->player);
    if (result != SLUICE_SUCCESS)
        return result;
    pass->calls++;
    if (call.kind == SLUICE_TRACE_CALL_ADD_TEXTURE && call.result >= SLUICE_SUCCESS &&
        !add_texture(p, call.textureId))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    note_call(p, pass, &call);
    pass->before = call.kind;
    pass->frame->figures[PLAYED_LOST] += played_take_events(p, &call);
    return SLUICE_SUCCESS;
}

/* Measures the duration of each frame but the last, whose duration is unknown. */
static void measure_times(struct played *p)
{
    for (uint32_t i = 0; i + 1 < p->frame_count; i++) {
        const uint64_t took = p->frames[i + 1].time > p->frames[i].time
                                  ? p->frames[i + 1].time - p->frames[i].time
                                  : 0;
        p->frames[i].figures[PLAYED_MICROSECONDS] = took < UINT32_MAX ? (uint32_t)took : UINT32_MAX;
    }
}

static bool find_peaks(struct played *p)
{
    p->peaks =
        calloc((size_t)(p->frame_count / PLAYED_BLOCK + 1) * PLAYED_FIGURES, sizeof *p->peaks);
    for (uint32_t i = 0; p->peaks && i < p->frame_count; i++)
        for (uint32_t k = 0; k < PLAYED_FIGURES; k++) {
            uint32_t *peak = &p->peaks[(size_t)(i / PLAYED_BLOCK) * PLAYED_FIGURES + k];
            *peak = p->frames[i].figures[k] > *peak ? p->frames[i].figures[k] : *peak;
        }
    return p->peaks;
}

static bool play_all(struct played *p, played_progress *progress, void *user)
{
    struct pass pass = {.totals = {.structSize = sizeof pass.totals}};
    SluiceResult result = SLUICE_SUCCESS;
    uint32_t told = 0;
    bool ended = false;
    sluiceGetStatistics(p->manager, &pass.totals);
    while (result == SLUICE_SUCCESS && !ended) {
        result = play_next(p, &pass, &ended);
        if (!progress || p->frame_count < told + PROGRESS_FRAMES)
            continue;
        told = p->frame_count;
        p->end = (SluiceTracePlayerState){.structSize = sizeof p->end};
        sluiceGetTracePlayerState(p->player, &p->end);
        if (!progress(user, (double)p->end.offset / (double)p->size))
            return false;
    }
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return out_of_memory(p);
    end_frame(p, &pass);
    measure_times(p);
    if (!find_peaks(p))
        return out_of_memory(p);
    p->end = (SluiceTracePlayerState){.structSize = sizeof p->end};
    sluiceGetTracePlayerState(p->player, &p->end);
    p->damaged = result != SLUICE_SUCCESS;
    if (p->damaged || p->end.divergedEvent > 0 || p->frame_count == 0)
        text_say("sluice-view: %s: %s%s", p->name,
                 p->message[0]         ? p->message
                 : p->frame_count == 0 ? "the recording has no call"
                                       : sluiceGetResultName(result),
                 p->damaged && p->frame_count > 0 ? "; frames before that are shown" : "");
    return p->frame_count > 0;
}

struct played *played_open_bytes(const char *name, char *data, size_t size, size_t most_point_size,
                                 played_progress *progress, void *user)
{
    struct played *p = calloc(1, sizeof *p);
    if (!p) {
        free(data);
        text_say("sluice-view: %s: out of memory", name);
        return NULL;
    }
    p->data = data;
    p->size = size;
    p->memory_left = MOST_MEMORY;
    p->callbacks = (SluiceAllocationCallbacks){p, allocate, release};
    p->stride = PLAYED_FIRST_STRIDE;
    p->most_point_size = most_point_size ? most_point_size : PLAYED_MOST_POINT_SIZE;
    snprintf(p->name, sizeof p->name, "%s", name);
    if (!create_player(p)) {
        played_close(p);
        return NULL;
    }
    p->events = calloc(PLAYED_EVENTS, sizeof *p->events);
    const bool ready =
        (p->events && tile_log_keep_stages(&p->log) && add_first_textures(p)) || out_of_memory(p);
    if (ready && play_all(p, progress, user) && (played_go(p, 0) || out_of_memory(p)))
        return p;
    played_close(p);
    return NULL;
}

void played_close(struct played *p)
{
    if (!p)
        return;
    played_points_finish(p);
    sluiceDestroyTracePlayer(p->player);
    tile_log_destroy(&p->log);
    free(p->events);
    free(p->frames);
    free(p->peaks);
    free(p->textures);
    free(p->data);
    free(p);
}
