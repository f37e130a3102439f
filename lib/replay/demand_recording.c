/* Plays "SLUICEDR" recordings of demand loading; docs/replay.md has the format. */
#include "base/checked.h"
#include "replay/demand_player.h"
#include "replay/demand_record.h"
#include "replay/demand_recorder.h"
#include "replay/snapshot.h"
#include "replay/trace_reader.h"

#include <inttypes.h>

static SluiceResult start(struct slc_replay *replay, const uint32_t words[SLC_TRACE_WORDS])
{
    const struct slc_page_residency_create_info info = {
        .class_count = words[0],
        .no_eviction = words[1] & SLC_DEMAND_FLAG_NO_EVICTION,
        .no_lod_bias = words[1] & SLC_DEMAND_FLAG_NO_LOD_BIAS,
    };
    struct slc_demand_player *player = &replay->demand;
    SluiceResult result = slc_demand_player_init(player, &replay->cb, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    replay->playing_demand = true;
    player->dump.user = replay->info->pUserData;
    player->dump.line = replay->info->pfnLine;
    slc_dump_line(&player->dump, "demand classes=%" PRIu32 "%s%s", info.class_count,
                  info.no_eviction ? " no-eviction" : "", info.no_lod_bias ? " no-lod-bias" : "");
    return SLUICE_SUCCESS;
}

static SluiceResult record(struct slc_replay *replay)
{
    SluiceResult result = SLUICE_SUCCESS;
    struct slc_demand_player *player = &replay->demand;
    if (replay->info->pRecordPath) {
        const SluiceFileRecordingInfo recording = {.structSize = sizeof recording,
                                                   .pPath = replay->info->pRecordPath,
                                                   .pAllocator = replay->info->pAllocator,
                                                   .log = replay->info->log};
        result = slc_begin_demand_file_recording(player->residency, &recording, &replay->recorder);
    }
    slc_demand_player_begin(player);
    return result;
}

static bool differs(const struct slc_demand_player *player, const struct slc_demand_record *record,
                    const struct slc_page_call *made)
{
    const struct slc_page_call *recorded = &record->call;
    return player->answers_differ || player->answers_used != player->answer_count ||
           made->result != recorded->result || made->request_answer != recorded->request_answer ||
           made->answer != recorded->answer || made->count != recorded->count ||
           (slc_page_call_has_hash(recorded->kind) && player->hash != record->hash);
}

static SluiceResult play_call(struct slc_replay *replay, const struct slc_demand_record *record,
                              size_t offset)
{
    struct slc_demand_player *player = &replay->demand;
    struct slc_page_call call = record->call;
    const char *why;
    if (player->answer_count > 0 && call.kind != SLC_PAGE_CALL_REQUEST)
        return slc_replay_corrupt(replay, offset, "memory answered outside of a request");
    SluiceResult result = slc_demand_player_call(player, &call, &why);
    if (result == SLUICE_ERROR_CORRUPT_DATA)
        return slc_replay_corrupt(replay, offset, why);
    if (result != SLUICE_SUCCESS)
        return result;
    if (differs(player, record, &call))
        slc_note_divergence(replay, player->event_count, offset, "other decisions", "these");
    player->answer_count = player->answers_used = 0;
    player->answers_differ = false;
    return SLUICE_SUCCESS;
}

static SluiceResult play_block(struct slc_replay *replay, size_t end)
{
    struct slc_cursor in = {replay->in.data, replay->in.pos, end, NULL};
    while (in.pos < end) {
        struct slc_demand_record record;
        size_t offset = in.pos;
        slc_get_demand_record(&in, &record, &replay->last_page);
        SluiceResult result = slc_replay_check(replay, &in);
        if (result == SLUICE_SUCCESS && slc_page_call_is_answer(record.call.kind))
            result = slc_demand_player_add_answer(&replay->demand, &record.call);
        else if (result == SLUICE_SUCCESS)
            result = play_call(replay, &record, offset);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    if (replay->demand.answer_count > 0)
        return slc_replay_corrupt(replay, end, "memory answered outside of a request");
    replay->in.pos = end;
    return SLUICE_SUCCESS;
}

SluiceResult slc_play_demand_recording(struct slc_replay *replay)
{
    uint32_t words[SLC_TRACE_WORDS];
    uint32_t version;
    uint64_t checksum;
    SluiceResult result = slc_read_trace_header(replay, SLC_DEMAND_TRACE_VERSION_SNAPSHOT, &version,
                                                &checksum, words);
    if (result != SLUICE_SUCCESS)
        return result;
    replay->out->kind = SLUICE_TRACE_KIND_DEMAND_RECORDING;
    if (words[0] == 0 || words[0] > UINT8_MAX + 1u)
        return slc_replay_corrupt(replay, 16, "there are no classes, or more than 256");
    if (words[1] > SLC_DEMAND_FLAGS || words[2] != 0 || words[3] != 0)
        return slc_replay_corrupt(replay, 20, "unknown flags");
    result = start(replay, words);
    if (result == SLUICE_SUCCESS && version == SLC_DEMAND_TRACE_VERSION_SNAPSHOT)
        result = slc_read_snapshot(replay, &checksum, slc_demand_player_restore, &replay->demand);
    if (result == SLUICE_SUCCESS)
        result = record(replay);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_trace_player player = {play_block, &replay->demand.hash,
                                            &replay->demand.event_count};
    return slc_play_blocks(replay, checksum, &player);
}
