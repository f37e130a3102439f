/*
 * Frame loop that plays "SLTRACE1" traces, which have feedback but no answers. docs/replay.md
 * describes the loop, because decisions depend on it.
 */
#include "base/alloc.h"
#include "base/checked.h"
#include "replay/feedback_trace.h"
#include "replay/replay.h"
#include "replay/runs.h"

#include <string.h>

#define DEFAULT_TILES_PER_FRAME 256
#define DEFAULT_TIMEOUT 1000000
/* Entries per call when a whole list is read. */
#define LIST_ROOM 256

/* A pending load: a tile without answer. */
struct load {
    SluiceTextureId texture_id;
    uint32_t tile_index;
    uint64_t frame;
};

struct frame_loop {
    struct slc_replay *replay;
    struct slc_feedback_trace trace;
    SluiceTextureId *ids; ///< owned; indexed like the trace's textures
    struct load *loads;   ///< owned; oldest first
    size_t load_count, load_capacity;
    uint32_t *batch; ///< owned; [tiles_per_frame or LIST_ROOM] indices of one answer
    size_t batch_capacity;
    uint32_t tiles_per_frame;
    uint64_t frame; ///< counts from 1; also the retire value
    uint64_t time;
};

/* Makes a call of the loop. A refusal would be a bug of the loop, visible in the hash. */
static SluiceResult make_call(struct frame_loop *loop, struct slc_call *call)
{
    return slc_player_call(&loop->replay->player, call);
}

static SluiceResult add_textures(struct frame_loop *loop)
{
    const struct slc_feedback_trace *trace = &loop->trace;
    for (uint32_t i = 0; i < trace->texture_count; i++) {
        struct slc_call call = {.kind = SLC_CALL_ADD_TEXTURE, .desc = &trace->textures[i].desc};
        SluiceResult result = make_call(loop, &call);
        if (result == SLUICE_SUCCESS && call.result != SLUICE_SUCCESS)
            return slc_replay_corrupt(loop->replay, trace->textures[i].offset,
                                      "the manager refuses a texture");
        if (result != SLUICE_SUCCESS)
            return result;
        loop->ids[i] = call.texture_id;
    }
    for (uint32_t i = 0; i < trace->texture_count; i++) {
        struct slc_call call = {.kind = SLC_CALL_SET_PRIMARY,
                                .texture_id = loop->ids[i],
                                .primary_id = loop->ids[trace->textures[i].primary]};
        if (trace->textures[i].primary == i)
            continue;
        SluiceResult result = make_call(loop, &call);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return SLUICE_SUCCESS;
}

static SluiceResult start(struct frame_loop *loop)
{
    const SluiceReplayInfo *info = loop->replay->info;
    SluiceStreamedTextureManagerCreateInfo create = {
        .structSize = sizeof create,
        .heapTileCapacity =
            info->heapTileCapacity ? info->heapTileCapacity : SLUICE_DEFAULT_HEAP_TILE_CAPACITY,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = true,
    };
    SluiceResult result = slc_replay_start(loop->replay, &create, false);
    if (result == SLUICE_SUCCESS)
        result = slc_replay_record(loop->replay);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .numExtraStandbyTiles = info->numExtraStandbyTiles,
                                                 .maxHeapCount = info->maxHeapCount};
    struct slc_call call = {.kind = SLC_CALL_SET_CONFIG, .config = &config};
    result = make_call(loop, &call);
    return result == SLUICE_SUCCESS ? add_textures(loop) : result;
}

static SluiceResult give_feedback(struct frame_loop *loop)
{
    const SluiceReplayInfo *info = loop->replay->info;
    uint32_t index;
    struct slc_cursor runs = slc_next_map(&loop->trace, &index);
    if (runs.why)
        return slc_replay_check(loop->replay, &runs);
    const struct slc_trace_texture *texture = &loop->trace.textures[index];
    size_t size = (size_t)texture->feedback_width * texture->feedback_height;
    uint8_t *map = slc_player_scratch(&loop->replay->player, size, 1);
    if (!map)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    slc_get_run_pairs(&runs, map, size);
    if (runs.why)
        return slc_replay_check(loop->replay, &runs);
    SluiceFeedbackDesc feedback = {.structSize = sizeof feedback,
                                   .pMinMip = map,
                                   .width = texture->feedback_width,
                                   .height = texture->feedback_height};
    struct slc_call call = {.kind = SLC_CALL_UPDATE_FEEDBACK,
                            .texture_id = loop->ids[index],
                            .time_stamp = loop->time,
                            .timeout = info->timeoutMicros ? info->timeoutMicros : DEFAULT_TIMEOUT,
                            .feedback = &feedback};
    return make_call(loop, &call);
}

static SluiceResult take_feedback(struct frame_loop *loop)
{
    size_t offset = loop->trace.in.pos;
    uint64_t time;
    uint32_t map_count;
    slc_next_frame(&loop->trace, &time, &map_count);
    if (loop->trace.in.why)
        return slc_replay_check(loop->replay, &loop->trace.in);
    if (time < loop->time)
        return slc_replay_corrupt(loop->replay, offset, "time goes backwards");
    loop->time = time;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < map_count; i++)
        result = give_feedback(loop);
    return result;
}

/* Drops a canceled load. Linear search is cheap, because few frames of loads are pending. */
static void drop_load(struct frame_loop *loop, SluiceTextureId texture_id, uint32_t tile_index)
{
    for (size_t i = 0; i < loop->load_count; i++) {
        if (loop->loads[i].texture_id != texture_id || loop->loads[i].tile_index != tile_index)
            continue;
        memmove(loop->loads + i, loop->loads + i + 1,
                (--loop->load_count - i) * sizeof *loop->loads);
        return;
    }
}

static SluiceResult report_canceled(struct frame_loop *loop, const SluiceTile *tiles,
                                    uint32_t count)
{
    for (uint32_t i = 0; i < count;) {
        struct slc_call call = {.kind = SLC_CALL_REPORT_CANCELED,
                                .texture_id = tiles[i].textureId,
                                .tile_indices = loop->batch};
        for (; i < count && tiles[i].textureId == call.texture_id; i++) {
            drop_load(loop, tiles[i].textureId, tiles[i].tileIndex);
            loop->batch[call.count++] = tiles[i].tileIndex;
        }
        SluiceResult result = make_call(loop, &call);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return SLUICE_SUCCESS;
}

/* Reads a list to its end. */
static SluiceResult take_list(struct frame_loop *loop, enum slc_call_kind kind)
{
    for (;;) {
        struct slc_call call = {.kind = kind,
                                .texture_id = SLUICE_ALL_TEXTURES,
                                .retire_value = loop->frame,
                                .room = LIST_ROOM};
        SluiceResult result = make_call(loop, &call);
        if (result == SLUICE_SUCCESS && kind == SLC_CALL_GET_TILES_TO_CANCEL)
            result = report_canceled(loop, call.tiles, call.count);
        if (result != SLUICE_SUCCESS || call.result != SLUICE_INCOMPLETE || call.count == 0)
            return result;
    }
}

static SluiceResult start_loads(struct frame_loop *loop)
{
    /* Limits pending loads to the answers within the latency; later requests may be better. */
    uint64_t room = (uint64_t)loop->tiles_per_frame * ((uint64_t)loop->replay->info->latency + 1);
    room = room > loop->load_count ? room - loop->load_count : 0;
    struct slc_call call = {.kind = SLC_CALL_GET_TILES_TO_MAP,
                            .texture_id = SLUICE_ALL_TEXTURES,
                            .room = room < UINT32_MAX ? (uint32_t)room : UINT32_MAX};
    SluiceResult result = make_call(loop, &call);
    if (result != SLUICE_SUCCESS || call.count == 0)
        return result;
    size_t need = loop->load_count + call.count;
    if (need > loop->load_capacity) {
        struct load *loads = slc_regrow(&loop->replay->cb, loop->loads, loop->load_capacity,
                                        2 * need, sizeof *loads);
        if (!loads)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        loop->loads = loads;
        loop->load_capacity = 2 * need;
    }
    for (uint32_t i = 0; i < call.count; i++)
        loop->loads[loop->load_count++] =
            (struct load){call.tiles[i].textureId, call.tiles[i].tileIndex, loop->frame};
    return SLUICE_SUCCESS;
}

/* Answers due loads, oldest first. One call answers consecutive loads of a texture. */
static SluiceResult answer_loads(struct frame_loop *loop)
{
    uint64_t latency = loop->replay->info->latency;
    size_t due = 0;
    while (due < loop->load_count && due < loop->tiles_per_frame &&
           loop->loads[due].frame + latency <= loop->frame)
        due++;
    for (size_t i = 0; i < due;) {
        struct slc_call call = {.kind = SLC_CALL_UPDATE_MAPPING,
                                .texture_id = loop->loads[i].texture_id,
                                .tile_indices = loop->batch};
        for (; i < due && call.count < loop->batch_capacity &&
               loop->loads[i].texture_id == call.texture_id;
             i++)
            loop->batch[call.count++] = loop->loads[i].tile_index;
        SluiceResult result = make_call(loop, &call);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    if (due > 0) {
        loop->load_count -= due;
        memmove(loop->loads, loop->loads + due, loop->load_count * sizeof *loop->loads);
    }
    return SLUICE_SUCCESS;
}

static SluiceResult play_frame(struct frame_loop *loop)
{
    uint64_t delay = (uint64_t)loop->replay->info->latency + 1;
    loop->frame++;
    SluiceResult result = SLUICE_SUCCESS;
    if (loop->frame > delay) {
        struct slc_call call = {.kind = SLC_CALL_COMPLETE_RETIRE,
                                .retire_value = loop->frame - delay};
        result = make_call(loop, &call);
    }
    if (result == SLUICE_SUCCESS)
        result = take_feedback(loop);
    if (result == SLUICE_SUCCESS)
        result = take_list(loop, SLC_CALL_GET_TILES_TO_CANCEL);
    if (result == SLUICE_SUCCESS)
        result = take_list(loop, SLC_CALL_GET_TILES_TO_UNMAP);
    if (result == SLUICE_SUCCESS)
        result = start_loads(loop);
    if (result == SLUICE_SUCCESS)
        result = answer_loads(loop);
    if (result == SLUICE_SUCCESS)
        result = take_list(loop, SLC_CALL_GET_MINMIP_UPDATES);
    return result;
}

static SluiceResult play(struct frame_loop *loop)
{
    const SluiceReplayInfo *info = loop->replay->info;
    const SluiceAllocationCallbacks *cb = &loop->replay->cb;
    loop->tiles_per_frame = info->tilesPerFrame ? info->tilesPerFrame : DEFAULT_TILES_PER_FRAME;
    loop->batch_capacity = LIST_ROOM;
    loop->batch = slc_alloc(cb, loop->batch_capacity, sizeof *loop->batch);
    loop->ids = slc_calloc(cb, (size_t)loop->trace.texture_count + 1, sizeof *loop->ids);
    if (!loop->batch || !loop->ids)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = start(loop);
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < loop->trace.frame_count; i++)
        result = play_frame(loop);
    if (result == SLUICE_SUCCESS && loop->trace.in.pos != loop->trace.in.end)
        result = slc_replay_corrupt(loop->replay, loop->trace.in.pos,
                                    "there is more behind the last frame");
    return result;
}

SluiceResult slc_play_feedback_trace(struct slc_replay *replay)
{
    struct frame_loop loop = {.replay = replay};
    const SluiceAllocationCallbacks *cb = &replay->cb;
    replay->out->kind = SLUICE_TRACE_KIND_FEEDBACK;
    SluiceResult result = slc_feedback_trace_open(&loop.trace, cb, replay->in);
    if (result == SLUICE_SUCCESS)
        result = slc_replay_check(replay, &loop.trace.in);
    if (result == SLUICE_SUCCESS)
        result = play(&loop);
    slc_free(cb, loop.batch, loop.batch_capacity, sizeof *loop.batch);
    slc_free(cb, loop.loads, loop.load_capacity, sizeof *loop.loads);
    slc_free(cb, loop.ids, (size_t)loop.trace.texture_count + 1, sizeof *loop.ids);
    slc_feedback_trace_close(&loop.trace, cb);
    return result;
}
