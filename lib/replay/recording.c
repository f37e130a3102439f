/* Player of "SLUICERT" recordings (docs/replay.md). */
#include "replay/recording_steps.h"

#include "base/checked.h"
#include "core/manager_snapshot.h"
#include "replay/decisions.h"
#include "replay/runs.h"
#include "replay/snapshot.h"
#include "replay/trace_reader.h"

#include <inttypes.h>
#include <string.h>

/* Decodes a map of the texture's size. The manager refuses other sizes before reading the map. */
static SluiceResult prepare_map(struct slc_replay *replay, struct slc_record *record)
{
    static const uint8_t never_read = SLUICE_MIP_UNTOUCHED;
    SluiceFeedbackDesc *feedback = &record->feedback;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (!record->call.feedback || record->contents == SLC_INPUT_NULL)
        return SLUICE_SUCCESS;
    feedback->pMinMip = &never_read;
    if (sluiceGetTextureLayout(replay->player.manager, record->call.texture_id, &layout) !=
            SLUICE_SUCCESS ||
        layout.feedbackWidth != feedback->width || layout.feedbackHeight != feedback->height)
        return SLUICE_SUCCESS;
    size_t size = (size_t)feedback->width * feedback->height;
    uint8_t *map = slc_player_scratch(&replay->player, size, 1);
    if (!map)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memset(map, SLUICE_MIP_UNTOUCHED, size);
    if (record->contents == SLC_INPUT_PRESENT)
        slc_get_runs(&record->encoded, map, size);
    feedback->pMinMip = map;
    return slc_replay_check(replay, &record->encoded);
}

static SluiceResult prepare_indices(struct slc_replay *replay, struct slc_record *record)
{
    static const uint32_t no_tile = UINT32_MAX;
    struct slc_call *call = &record->call;
    if (record->contents == SLC_INPUT_NULL)
        return SLUICE_SUCCESS;
    if (record->contents == SLC_INPUT_ABSENT) {
        /* The recorded call was refused for its texture, and the list may be read only if it exists
         * now. */
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        if (sluiceGetTextureLayout(replay->player.manager, call->texture_id, &layout) ==
            SLUICE_SUCCESS)
            call->count = slc_min_u32(call->count, 1);
        call->tile_indices = &no_tile;
        replay->player.dump.indices_absent = true;
        return SLUICE_SUCCESS;
    }
    uint32_t *indices = slc_player_scratch(&replay->player, call->count, sizeof *indices);
    if (!indices)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    slc_get_tile_indices(record, indices);
    call->tile_indices = indices;
    return SLUICE_SUCCESS;
}

SluiceResult slc_recording_play(struct slc_replay *replay, struct slc_recording_steps *steps)
{
    struct slc_player *player = &replay->player;
    struct slc_record *record = &steps->next;
    struct slc_call *call = &record->call;
    const struct slc_call recorded = *call;
    SluiceResult result = SLUICE_SUCCESS;
    steps->has_next = false;
    player->dump.indices_absent = false;
    if (player->answer_count > 0 && call->kind != SLC_CALL_GET_TILES_TO_MAP)
        return slc_replay_corrupt(replay, steps->offset, "a heap was answered outside of its call");
    if (slc_call_fields(call->kind) & SLC_FIELD_FEEDBACK)
        result = prepare_map(replay, record);
    if (slc_call_fields(call->kind) & SLC_FIELD_INDICES)
        result = prepare_indices(replay, record);
    if (result != SLUICE_SUCCESS)
        return result;

    result = slc_player_call(player, call);
    if (result != SLUICE_SUCCESS)
        return result;
    if (call->result != recorded.result || player->answers_missing ||
        player->answers_used != player->answer_count ||
        (call->kind == SLC_CALL_ADD_TEXTURE && call->result >= SLUICE_SUCCESS &&
         call->texture_id != recorded.texture_id) ||
        (slc_call_lists(call->kind) && player->hash != record->hash))
        slc_note_divergence(replay, player->event_count, steps->offset,
                            sluiceGetResultName(recorded.result),
                            sluiceGetResultName(call->result));
    player->answer_count = player->answers_used = 0;
    player->answers_missing = false;
    return SLUICE_SUCCESS;
}

static SluiceResult next_block(struct slc_replay *replay, struct slc_recording_steps *steps)
{
    const struct slc_trace_player player = {NULL, &replay->player.hash,
                                            &replay->player.event_count};
    if (replay->player.answer_count > 0)
        return slc_replay_corrupt(replay, steps->block_end,
                                  "a heap was answered outside of its call");
    return slc_read_next_block(replay, &steps->checksum, &player, &steps->block_end, &steps->ended);
}

/* Reads a record. Answers for heaps precede their call. */
static SluiceResult read_record(struct slc_replay *replay, struct slc_recording_steps *steps)
{
    struct slc_cursor in = {replay->in.data, replay->in.pos, steps->block_end, NULL};
    struct slc_record *record = &steps->next;
    steps->offset = in.pos;
    if (replay->player.answer_count == 0)
        steps->first_offset = in.pos;
    slc_get_record(&in, record);
    SluiceResult result = slc_replay_check(replay, &in);
    if (result != SLUICE_SUCCESS)
        return result;
    replay->in.pos = in.pos;
    steps->has_next = record->call.kind != SLC_CALL_HEAP_ANSWER;
    return steps->has_next
               ? SLUICE_SUCCESS
               : slc_player_add_answer(&replay->player, record->call.result, record->call.heap_id);
}

SluiceResult slc_recording_read(struct slc_replay *replay, struct slc_recording_steps *steps)
{
    SluiceResult result = SLUICE_SUCCESS;
    while (result == SLUICE_SUCCESS && !steps->has_next && !steps->ended)
        result = replay->in.pos == steps->block_end ? next_block(replay, steps)
                                                    : read_record(replay, steps);
    return result;
}

static void read_state(void *manager, struct slc_snapshot_io *io)
{
    slc_snapshot_read(manager, io);
}

static void dump_snapshot(struct slc_player *player)
{
    SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
    sluiceGetStatistics(player->manager, &s);
    slc_dump_line(&player->dump,
                  "snapshot textures=%" PRIu32 " heaps=%" PRIu32 " requested=%" PRIu32
                  " allocated=%" PRIu32 " mapped=%" PRIu32 " standby=%" PRIu32,
                  s.textureCount, s.heapCount, s.requestedTileCount, s.allocatedTileCount,
                  s.mappedTileCount, s.standbyTileCount);
}

static SluiceResult read_snapshot(struct slc_replay *replay, uint64_t *checksum)
{
    SluiceResult result = slc_read_snapshot(replay, checksum, read_state, replay->player.manager);
    if (result == SLUICE_SUCCESS)
        dump_snapshot(&replay->player);
    return result;
}

SluiceResult slc_recording_begin(struct slc_replay *replay, struct slc_recording_steps *steps)
{
    uint32_t words[SLC_TRACE_WORDS];
    uint32_t version;
    *steps = (struct slc_recording_steps){.checksum = 0};
    SluiceResult result = slc_read_trace_header(replay, SLC_TRACE_VERSION_SNAPSHOT, &version,
                                                &steps->checksum, words);
    if (result != SLUICE_SUCCESS)
        return result;
    replay->out->kind = SLUICE_TRACE_KIND_RECORDING;
    if (words[2] > SLC_TRACE_FLAG_PACKED || words[3] != 0)
        return slc_replay_corrupt(replay, 24, "unknown flags");
    const SluiceStreamedTextureManagerCreateInfo info = {.structSize = sizeof info,
                                                         .heapTileCapacity = words[0],
                                                         .tileSize = words[1],
                                                         .alwaysMapPackedTiles =
                                                             words[2] & SLC_TRACE_FLAG_PACKED};
    result = slc_replay_start(replay, &info, true);
    if (result == SLUICE_ERROR_ZERO_HEAP_CAPACITY || result == SLUICE_ERROR_INVALID_ARGUMENT)
        return slc_replay_corrupt(replay, 16, "no manager has such heaps");
    steps->begins_in_use = version == SLC_TRACE_VERSION_SNAPSHOT;
    if (result == SLUICE_SUCCESS && steps->begins_in_use)
        result = read_snapshot(replay, &steps->checksum);
    steps->block_end = replay->in.pos;
    return result;
}

SluiceResult slc_play_recording(struct slc_replay *replay)
{
    struct slc_recording_steps steps;
    SluiceResult result = slc_recording_begin(replay, &steps);
    if (result == SLUICE_SUCCESS)
        result = slc_replay_record(replay);
    while (result == SLUICE_SUCCESS) {
        result = slc_recording_read(replay, &steps);
        if (result != SLUICE_SUCCESS || steps.ended)
            break;
        result = slc_recording_play(replay, &steps);
    }
    return result;
}
