#include "replay/replay.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "replay/decisions.h"
#include "replay/demand_record.h"
#include "replay/record.h"

#include <inttypes.h>
#include <string.h>

#define DEFAULT_STANDBY_TILES 1024 /* the default of streamers */
#define DEFAULT_LATENCY 2

SluiceResult slc_replay_start(struct slc_replay *replay,
                              const SluiceStreamedTextureManagerCreateInfo *info, bool scripted)
{
    SluiceResult result = slc_player_init(&replay->player, &replay->cb, info, scripted);
    if (result != SLUICE_SUCCESS)
        return result;
    replay->playing = true;
    replay->player.dump.user = replay->info->pUserData;
    replay->player.dump.line = replay->info->pfnLine;
    slc_dump_line(&replay->player.dump, "manager heap-tiles=%" PRIu32 " tile-size=%" PRIu32 "%s",
                  info->heapTileCapacity, info->tileSize,
                  info->alwaysMapPackedTiles ? " always-map-packed" : "");
    return SLUICE_SUCCESS;
}

SluiceResult slc_replay_record(struct slc_replay *replay)
{
    if (!replay->info->pRecordPath)
        return SLUICE_SUCCESS;
    const SluiceFileRecordingInfo recording = {.structSize = sizeof recording,
                                               .pPath = replay->info->pRecordPath,
                                               .pAllocator = replay->info->pAllocator,
                                               .log = replay->info->log};
    return sluiceBeginFileRecording(replay->player.manager, &recording, &replay->recorder);
}

SluiceResult slc_replay_corrupt(struct slc_replay *replay, uint64_t offset, const char *why)
{
    replay->out->errorOffset = offset;
    slc_log(&replay->info->log, SLUICE_LOG_ERROR, "trace is damaged at byte %" PRIu64 ": %s",
            offset, why);
    return SLUICE_ERROR_CORRUPT_DATA;
}

SluiceResult slc_replay_check(struct slc_replay *replay, const struct slc_cursor *cursor)
{
    return cursor->why ? slc_replay_corrupt(replay, cursor->pos, cursor->why) : SLUICE_SUCCESS;
}

static SluiceResult play(struct slc_replay *replay)
{
    const SluiceReplayInfo *info = replay->info;
    if (info->size >= 8 && memcmp(info->pData, SLC_TRACE_MAGIC, 8) == 0)
        return slc_play_recording(replay);
    if (info->size >= 8 && memcmp(info->pData, SLC_DEMAND_TRACE_MAGIC, 8) == 0)
        return slc_play_demand_recording(replay);
    if (info->size >= 8 && memcmp(info->pData, "SLTRACE1", 8) == 0)
        return slc_play_feedback_trace(replay);
    return slc_replay_corrupt(replay, 0, "it begins with none of SLUICERT, SLUICEDR, SLTRACE1");
}

static SluiceResult finish_demand(struct slc_replay *replay, SluiceResult result)
{
    struct slc_demand_player *player = &replay->demand;
    SluiceResult recorded = sluiceEndRecording(replay->recorder);
    replay->out->decisionHash = player->hash;
    replay->out->eventCount = player->event_count;
    slc_demand_player_statistics(player, &replay->out->demand);
    if (result == SLUICE_SUCCESS)
        slc_dump_line(&player->dump, "hash %016" PRIx64 " events %" PRIu64, player->hash,
                      player->event_count);
    slc_demand_player_finish(player);
    return result == SLUICE_SUCCESS ? recorded : result;
}

/* Finishes the result, also after an error: decisions and recording up to the error are useful. */
static SluiceResult finish(struct slc_replay *replay, SluiceResult result)
{
    struct slc_player *player = &replay->player;
    if (replay->playing_demand)
        return finish_demand(replay, result);
    if (!replay->playing)
        return result;
    SluiceResult recorded = sluiceEndRecording(replay->recorder);
    replay->out->decisionHash = player->hash;
    replay->out->eventCount = player->event_count;
    if (replay->info->pStatistics)
        sluiceGetStatistics(player->manager, replay->info->pStatistics);
    if (result == SLUICE_SUCCESS)
        slc_dump_line(&player->dump, "hash %016" PRIx64 " events %" PRIu64, player->hash,
                      player->event_count);
    slc_player_finish(player);
    return result == SLUICE_SUCCESS ? recorded : result;
}

/* Fills in defaults for settings of feedback traces. */
static SluiceResult fill_in(SluiceReplayInfo *info)
{
    if (info->noStandbyTiles && info->numExtraStandbyTiles)
        return slc_log_refusal(&info->log,
                               "numExtraStandbyTiles is %u; with noStandbyTiles it must be 0",
                               info->numExtraStandbyTiles);
    if (info->noLatency && info->latency)
        return slc_log_refusal(&info->log, "latency is %u; with noLatency it must be 0",
                               info->latency);
    if (!info->noStandbyTiles && info->numExtraStandbyTiles == 0)
        info->numExtraStandbyTiles = DEFAULT_STANDBY_TILES;
    if (!info->noLatency && info->latency == 0)
        info->latency = DEFAULT_LATENCY;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReplay(const SluiceReplayInfo *pInfo, SluiceReplayResult *pResult)
{
    if (!pInfo || !pResult || !pInfo->pData)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceReplayInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceReplayInfo), &info, pInfo, &pInfo->log);
    if (result == SLUICE_SUCCESS)
        result = slc_struct_check(SLC_STRUCT(SluiceReplayResult), pResult, &info.log);
    if (result == SLUICE_SUCCESS && info.pStatistics)
        result = slc_struct_check(SLC_STRUCT(SluiceStreamedTextureStatistics), info.pStatistics,
                                  &info.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(info.pAllocator))
        return slc_log_refusal(&info.log, "pAllocator lacks pfnAllocate or pfnFree");
    result = fill_in(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceStreamedTextureStatistics none = {.structSize = sizeof none};
    if (info.pStatistics)
        slc_struct_write(SLC_STRUCT(SluiceStreamedTextureStatistics), info.pStatistics, &none);
    SluiceReplayResult out = {.structSize = sizeof out, .decisionHash = SLC_HASH_EMPTY};
    struct slc_replay replay = {
        .info = &info,
        .out = &out,
        .cb = slc_allocator(info.pAllocator),
        .in = {info.pData, 0, info.size, NULL},
    };
    result = finish(&replay, play(&replay));
    slc_struct_write(SLC_STRUCT(SluiceReplayResult), pResult, &out);
    return result;
}
