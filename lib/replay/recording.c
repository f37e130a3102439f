/* Plays "SLUICERT" recordings; docs/replay.md has the format. */
#include "base/checked.h"
#include "base/log.h"
#include "replay/decisions.h"
#include "replay/record.h"
#include "replay/replay.h"
#include "replay/runs.h"

#include <inttypes.h>
#include <string.h>

/* The header, whose first 40 bytes are the same in all versions. */
static SluiceResult read_header(struct slc_replay *replay, uint64_t *checksum,
                                SluiceStreamedTextureManagerCreateInfo *info)
{
    struct slc_cursor *in = &replay->in;
    slc_get_bytes(in, 8);
    uint32_t version = slc_get_u32(in);
    uint32_t library = slc_get_u32(in);
    info->heapTileCapacity = slc_get_u32(in);
    info->tileSize = slc_get_u32(in);
    uint32_t flags = slc_get_u32(in);
    uint32_t reserved = slc_get_u32(in);
    size_t checksum_pos = in->pos;
    *checksum = slc_hash_bytes(SLC_HASH_EMPTY, in->data, in->pos);
    uint64_t stored = slc_get_u64(in);
    info->alwaysMapPackedTiles = flags & SLC_TRACE_FLAG_PACKED;
    if (!in->why && stored != *checksum)
        slc_cursor_fail(in, 0, "the header's checksum is wrong");
    if (in->why)
        return slc_replay_check(replay, in);
    if (version != SLC_TRACE_VERSION) {
        slc_log(&replay->info->log, SLUICE_LOG_ERROR,
                "trace has version %" PRIu32 " of the format, this library reads version %u",
                version, SLC_TRACE_VERSION);
        replay->out->errorOffset = 8;
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (flags > SLC_TRACE_FLAG_PACKED || reserved != 0)
        return slc_replay_corrupt(replay, checksum_pos - 8, "unknown flags");
    slc_log(&replay->info->log, SLUICE_LOG_INFO,
            "trace was recorded with Sluice %" PRIu32 ".%" PRIu32 ".%" PRIu32, library >> 22,
            library >> 12 & 1023, library & 4095);
    return SLUICE_SUCCESS;
}

/* Only a size that the texture has is trusted; any other will be refused before the map is read. */
static SluiceResult prepare_map(struct slc_replay *replay, struct slc_record *record)
{
    static const uint8_t never_read = SLUICE_MIP_UNTOUCHED;
    SluiceFeedbackDesc *feedback = &record->feedback;
    SluiceStreamedTextureLayout layout;
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
        /* Refused for its texture, so nobody reads the list; unless that texture lives by now. */
        SluiceStreamedTextureLayout layout;
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

/* Reports only the first; what follows from it may differ all over. */
static void note_divergence(struct slc_replay *replay, size_t offset, const char *recorded,
                            const char *got)
{
    if (replay->out->divergedEvent)
        return;
    replay->out->divergedEvent = replay->player.event_count;
    replay->out->divergedOffset = offset;
    slc_log(&replay->info->log, SLUICE_LOG_WARNING,
            "decisions differ from event %" PRIu64 " at byte %zu on: recorded %s, got %s",
            replay->player.event_count, offset, recorded, got);
}

static SluiceResult play_call(struct slc_replay *replay, struct slc_record *record, size_t offset)
{
    struct slc_player *player = &replay->player;
    struct slc_call *call = &record->call;
    const struct slc_call recorded = *call;
    SluiceResult result = SLUICE_SUCCESS;
    player->dump.indices_absent = false;
    if (player->answer_count > 0 && call->kind != SLC_CALL_GET_TILES_TO_MAP)
        return slc_replay_corrupt(replay, offset, "a heap was answered outside of its call");
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
        note_divergence(replay, offset, sluiceResultString(recorded.result),
                        sluiceResultString(call->result));
    player->answer_count = player->answers_used = 0;
    player->answers_missing = false;
    return SLUICE_SUCCESS;
}

static SluiceResult play_block(struct slc_replay *replay, size_t end)
{
    struct slc_cursor in = {replay->in.data, replay->in.pos, end, NULL};
    while (in.pos < end) {
        struct slc_record record;
        size_t offset = in.pos;
        slc_get_record(&in, &record);
        SluiceResult result = slc_replay_check(replay, &in);
        if (result == SLUICE_SUCCESS && record.call.kind == SLC_CALL_HEAP_ANSWER)
            result =
                slc_player_add_answer(&replay->player, record.call.result, record.call.heap_id);
        else if (result == SLUICE_SUCCESS)
            result = play_call(replay, &record, offset);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    if (replay->player.answer_count > 0)
        return slc_replay_corrupt(replay, end, "a heap was answered outside of its call");
    replay->in.pos = end;
    return SLUICE_SUCCESS;
}

static SluiceResult read_end(struct slc_replay *replay, size_t start, uint64_t checksum)
{
    struct slc_cursor *in = &replay->in;
    uint64_t event_count = slc_get_u64(in);
    uint64_t hash = slc_get_u64(in);
    checksum = slc_hash_bytes(checksum, in->data + start, in->pos - start);
    uint64_t stored = slc_get_u64(in);
    if (!in->why && stored != checksum)
        slc_cursor_fail(in, start, "the end mark's checksum is wrong");
    if (!in->why && event_count != replay->player.event_count)
        slc_cursor_fail(in, start, "the end mark counts other events than there are");
    if (!in->why && in->pos != in->end)
        slc_cursor_fail(in, in->pos, "there is more behind the end mark");
    if (in->why)
        return slc_replay_check(replay, in);
    replay->out->recordedHash = hash;
    if (hash != replay->player.hash)
        note_divergence(replay, start, "another hash", "this one");
    return SLUICE_SUCCESS;
}

SluiceResult slc_play_recording(struct slc_replay *replay)
{
    struct slc_cursor *in = &replay->in;
    SluiceStreamedTextureManagerCreateInfo info = {0};
    uint64_t checksum;
    SluiceResult result = read_header(replay, &checksum, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_replay_start(replay, &info, true);
    if (result == SLUICE_ERROR_ZERO_HEAP_CAPACITY || result == SLUICE_ERROR_INVALID_ARGUMENT)
        return slc_replay_corrupt(replay, 16, "no manager has such heaps");
    while (result == SLUICE_SUCCESS) {
        size_t start = in->pos;
        uint32_t size = slc_get_u32(in);
        if (!in->why && size == 0)
            return read_end(replay, start, checksum);
        checksum = slc_hash_bytes(checksum, in->data + start, in->pos - start);
        uint64_t stored = slc_get_u64(in);
        size_t payload = in->pos;
        if (!in->why && size > in->end - payload)
            slc_cursor_fail(in, start, "the block that begins here is cut off");
        if (!in->why) {
            checksum = slc_hash_bytes(checksum, in->data + payload, size);
            if (stored != checksum)
                slc_cursor_fail(in, start, "the checksum of the block that begins here is wrong");
        }
        result = slc_replay_check(replay, in);
        if (result != SLUICE_SUCCESS)
            return result;
        in->pos = payload;
        result = play_block(replay, payload + size);
    }
    return result;
}
