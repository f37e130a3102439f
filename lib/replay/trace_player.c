/* Player of a recording for programs: call by call, with checkpoints. */
#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "core/manager_snapshot.h"
#include "core/state.h"
#include "replay/demand_record.h"
#include "replay/hash.h"
#include "replay/recorder.h"
#include "replay/recording_steps.h"
#include "replay/snapshot.h"
#include "replay/trace_reader.h"

#include <string.h>

/** Magic number of checkpoints. A header of a recording and a snapshot follow. */
#define CHECKPOINT_MAGIC "SLUICECP"
#define CHECKPOINT_NUMBERS 8
#define CHECKPOINT_HEAD_SIZE (8u + 8u * CHECKPOINT_NUMBERS)

/** Session: a manager and its position. Restoring a checkpoint replaces the session. */
struct session {
    struct slc_replay replay;
    struct slc_recording_steps steps;
    SluiceReplayResult out;
    SluiceResult failed; ///< error of the call that cannot be read or played
};

struct SluiceTracePlayer {
    SluiceReplayInfo info; ///< info for all sessions
    SluiceAllocationCallbacks cb;
    uint32_t tile_event_capacity;
    uint32_t format_version, library_version;
    struct session *session; ///< owned
};

static void destroy_session(SluiceTracePlayer *player, struct session *session)
{
    if (!session)
        return;
    if (session->replay.playing)
        slc_player_finish(&session->replay.player);
    slc_free(&player->cb, session, 1, sizeof *session);
}

/* Begins a session without playing. `data`: a header, and a snapshot in versions with snapshot. */
static SluiceResult begin_session(SluiceTracePlayer *player, const void *data, size_t size,
                                  struct session **out)
{
    struct session *session = slc_calloc(&player->cb, 1, sizeof *session);
    if (!session)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    session->out = (SluiceReplayResult){.structSize = sizeof session->out};
    session->replay = (struct slc_replay){
        .info = &player->info, .out = &session->out, .cb = player->cb, .in = {data, 0, size, NULL}};
    SluiceResult result = slc_recording_begin(&session->replay, &session->steps);
    if (result == SLUICE_SUCCESS)
        result =
            sluiceSetTileEventCapacity(session->replay.player.manager, player->tile_event_capacity);
    if (result == SLUICE_SUCCESS)
        *out = session;
    else
        destroy_session(player, session);
    return result;
}

static SluiceResult refuse_kind(const SluiceTracePlayer *player)
{
    const SluiceReplayInfo *info = &player->info;
    const char *kind = NULL;
    if (info->size >= 8 && memcmp(info->pData, SLC_DEMAND_TRACE_MAGIC, 8) == 0)
        kind = "a recording of demand loading: its pages have no tiles and no heaps";
    if (info->size >= 8 && memcmp(info->pData, "SLTRACE1", 8) == 0)
        kind = "a feedback trace without decisions: sluice-replay --record makes a recording of it";
    if (kind) {
        slc_log(&info->log, SLUICE_LOG_ERROR, "the trace is %s", kind);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (info->size >= 8 && memcmp(info->pData, SLC_TRACE_MAGIC, 8) == 0)
        return SLUICE_SUCCESS;
    slc_log(&info->log, SLUICE_LOG_ERROR, "trace is damaged at byte 0: it does not begin with %s",
            SLC_TRACE_MAGIC);
    return SLUICE_ERROR_CORRUPT_DATA;
}

static SluiceResult open_trace(SluiceTracePlayer *player)
{
    SluiceResult result = refuse_kind(player);
    if (result == SLUICE_SUCCESS)
        result = begin_session(player, player->info.pData, player->info.size, &player->session);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_cursor versions = {player->info.pData, 8, player->info.size, NULL};
    player->format_version = slc_get_u32(&versions);
    player->library_version = slc_get_u32(&versions);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCreateTracePlayer(const SluiceTracePlayerCreateInfo *pInfo,
                                     SluiceTracePlayer **pPlayer)
{
    if (pPlayer)
        *pPlayer = NULL;
    if (!pInfo || !pPlayer || !pInfo->pData)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceTracePlayerCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceTracePlayerCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(info.pAllocator))
        return slc_log_refusal(&info.log, "pAllocator lacks pfnAllocate or pfnFree");
    if (info.tileEventCapacity > SLUICE_MAX_TILE_EVENTS)
        return slc_log_refusal(&info.log, "tileEventCapacity is %u; at most %u",
                               info.tileEventCapacity, SLUICE_MAX_TILE_EVENTS);
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceTracePlayer *player = slc_calloc(&cb, 1, sizeof *player);
    if (!player)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    player->cb = cb;
    player->tile_event_capacity = info.tileEventCapacity;
    player->info = (SluiceReplayInfo){
        .structSize = sizeof player->info, .pData = info.pData, .size = info.size, .log = info.log};
    result = open_trace(player);
    if (result == SLUICE_SUCCESS)
        *pPlayer = player;
    else
        sluiceDestroyTracePlayer(player);
    return result;
}

void sluiceDestroyTracePlayer(SluiceTracePlayer *player)
{
    if (!player)
        return;
    SluiceAllocationCallbacks cb = player->cb;
    destroy_session(player, player->session);
    slc_free(&cb, player, 1, sizeof *player);
}

static SluiceResult read_next(struct session *session)
{
    if (session->failed == SLUICE_SUCCESS)
        session->failed = slc_recording_read(&session->replay, &session->steps);
    return session->failed;
}

static void describe(const struct session *session, SluiceTraceCall *to)
{
    const struct slc_call *call = &session->steps.next.call;
    const uint32_t fields = slc_call_fields(call->kind);
    const struct slc_player *player = &session->replay.player;
    to->kind = (SluiceTraceCallKind)call->kind;
    to->result = call->result;
    to->textureId = call->texture_id;
    to->primaryId = call->primary_id;
    to->hasTimeStamp = fields & SLC_FIELD_TIME;
    to->timeStamp = call->time_stamp;
    to->timeout = call->timeout;
    to->retireValue = call->retire_value;
    to->tileCount = call->count;
    if (call->feedback) {
        to->feedbackWidth = call->feedback->width;
        to->feedbackHeight = call->feedback->height;
    }
    for (size_t i = 0; i < player->answer_count; i++) {
        to->heapCount += player->answers[i].result == SLUICE_SUCCESS;
        to->refusedHeapCount += player->answers[i].result != SLUICE_SUCCESS;
    }
    to->offset = session->steps.offset;
}

SluiceResult sluiceGetNextTraceCall(SluiceTracePlayer *player, SluiceTraceCall *pCall)
{
    if (!player || !pCall)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceTraceCall), pCall, &player->info.log);
    if (result == SLUICE_SUCCESS)
        result = read_next(player->session);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceTraceCall call = {.structSize = sizeof call};
    if (player->session->steps.has_next)
        describe(player->session, &call);
    slc_struct_write(SLC_STRUCT(SluiceTraceCall), pCall, &call);
    return SLUICE_SUCCESS;
}

SluiceResult sluicePlayTraceCall(SluiceTracePlayer *player)
{
    if (!player)
        return SLUICE_ERROR_NULL_POINTER;
    struct session *session = player->session;
    if (read_next(session) == SLUICE_SUCCESS && session->steps.has_next)
        session->failed = slc_recording_play(&session->replay, &session->steps);
    return session->failed;
}

SluiceResult sluiceGetTracePlayerManager(SluiceTracePlayer *player,
                                         SluiceStreamedTextureManager **pManager)
{
    if (!player || !pManager)
        return SLUICE_ERROR_NULL_POINTER;
    *pManager = player->session->replay.player.manager;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetTracePlayerState(const SluiceTracePlayer *player,
                                       SluiceTracePlayerState *pState)
{
    if (!player || !pState)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceTracePlayerState), pState, &player->info.log);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct session *session = player->session;
    const struct slc_player *p = &session->replay.player;
    const SluiceStreamedTextureManagerCreateInfo *made = slc_manager_create_info(p->manager);
    const SluiceStreamedTextureManagerConfig *config = slc_manager_config(p->manager);
    const SluiceTracePlayerState state = {.structSize = sizeof state,
                                          .formatVersion = player->format_version,
                                          .libraryVersion = player->library_version,
                                          .heapTileCapacity = made->heapTileCapacity,
                                          .tileSize = made->tileSize,
                                          .alwaysMapPackedTiles = made->alwaysMapPackedTiles,
                                          .offset = session->replay.in.pos,
                                          .eventCount = p->event_count,
                                          .decisionHash = p->hash,
                                          .recordedHash = session->out.recordedHash,
                                          .divergedEvent = session->out.divergedEvent,
                                          .divergedOffset = session->out.divergedOffset,
                                          .errorOffset = session->out.errorOffset,
                                          .maxHeapCount = config->maxHeapCount,
                                          .targetHeapCount = config->targetHeapCount,
                                          .numExtraStandbyTiles = config->numExtraStandbyTiles};
    slc_struct_write(SLC_STRUCT(SluiceTracePlayerState), pState, &state);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetTracePlayerTextures(const SluiceTracePlayer *player, uint32_t *pIdCount,
                                          SluiceTextureId *pIds)
{
    if (!player || !pIdCount)
        return SLUICE_ERROR_NULL_POINTER;
    const slc_manager *m = player->session->replay.player.manager;
    const uint32_t room = *pIdCount;
    uint32_t found = 0;
    for (uint32_t i = 0; i < m->texture_end; i++) {
        const struct slc_managed_texture *t = slc_texture_at(m, i);
        if (!t->live)
            continue;
        if (pIds && found < room)
            pIds[found] = slc_texture_id(t);
        found++;
    }
    *pIdCount = pIds && found > room ? room : found;
    return pIds && found > room ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

/* Checkpoints ------------------------------------------------------------------------------- */

static void get_numbers(const struct session *session, uint64_t numbers[CHECKPOINT_NUMBERS])
{
    const uint64_t now[CHECKPOINT_NUMBERS] = {session->replay.in.pos,
                                              session->steps.block_end,
                                              session->steps.checksum,
                                              session->replay.player.hash,
                                              session->replay.player.event_count,
                                              session->out.divergedEvent,
                                              session->out.divergedOffset,
                                              session->replay.in.end};
    memcpy(numbers, now, sizeof now);
}

static void write_state(const void *manager, struct slc_snapshot_io *io)
{
    slc_snapshot_write(manager, io);
}

static void keep_observer(void *manager)
{
    (void)manager;
}

static void write_checkpoint(SluiceRecorder *recorder, const struct session *session)
{
    uint64_t numbers[CHECKPOINT_NUMBERS];
    const SluiceStreamedTextureManager *manager = session->replay.player.manager;
    const SluiceStreamedTextureManagerCreateInfo *info = slc_manager_create_info(manager);
    const uint32_t words[SLC_TRACE_WORDS] = {info->heapTileCapacity, info->tileSize,
                                             info->alwaysMapPackedTiles ? SLC_TRACE_FLAG_PACKED : 0,
                                             0};
    struct slc_bytes *head = &recorder->head;
    get_numbers(session, numbers);
    slc_put_bytes(head, CHECKPOINT_MAGIC, 8);
    for (int i = 0; i < CHECKPOINT_NUMBERS; i++)
        slc_put_u64(head, numbers[i]);
    if (!head->failed)
        slc_put_u64(head, slc_hash_bytes(SLC_HASH_EMPTY, head->data, head->size));
    if (head->failed) {
        recorder->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        return;
    }
    recorder->result =
        recorder->writer.pfnWrite(recorder->writer.pUserData, head->data, head->size);
    head->size = 0;
    slc_recorder_write_header(recorder, SLC_TRACE_MAGIC, SLC_TRACE_VERSION_SNAPSHOT, words);
    slc_write_snapshot(recorder, write_state, manager);
}

/* Returns the position to read a pending call or the end mark again. A call begins with its first
 * answer. */
static size_t unread(const struct session *session)
{
    const struct slc_recording_steps *steps = &session->steps;
    if (steps->ended)
        return steps->block_end; /* the end mark follows the last block */
    return steps->has_next || session->replay.player.answer_count > 0 ? steps->first_offset
                                                                      : session->replay.in.pos;
}

SluiceResult sluiceWriteTraceCheckpoint(SluiceTracePlayer *player,
                                        const SluiceRecordWriter *pWriter)
{
    if (!player || !pWriter || !pWriter->pfnWrite)
        return SLUICE_ERROR_NULL_POINTER;
    struct session *session = player->session;
    if (session->failed != SLUICE_SUCCESS)
        return session->failed;
    session->replay.in.pos = unread(session);
    session->replay.player.answer_count = 0;
    session->steps.has_next = session->steps.ended = false;
    SluiceRecorder *recorder =
        slc_recorder_create(&player->cb, session->replay.player.manager, keep_observer);
    if (!recorder)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    recorder->writer = *pWriter;
    write_checkpoint(recorder, session);
    return slc_recorder_end(recorder);
}

static bool is_position_of(const SluiceTracePlayer *player,
                           const uint64_t numbers[CHECKPOINT_NUMBERS])
{
    return numbers[7] == player->info.size && numbers[1] <= numbers[7] && numbers[0] <= numbers[1];
}

static SluiceResult read_numbers(const SluiceTracePlayer *player, const void *data, size_t size,
                                 uint64_t numbers[CHECKPOINT_NUMBERS])
{
    struct slc_cursor in = {data, 0, size, NULL};
    const uint8_t *magic = slc_get_bytes(&in, 8);
    bool good = magic && memcmp(magic, CHECKPOINT_MAGIC, 8) == 0;
    for (int i = 0; i < CHECKPOINT_NUMBERS; i++)
        numbers[i] = slc_get_u64(&in);
    const uint64_t stored = slc_get_u64(&in);
    if (good && !in.why && stored == slc_hash_bytes(SLC_HASH_EMPTY, data, CHECKPOINT_HEAD_SIZE) &&
        is_position_of(player, numbers))
        return SLUICE_SUCCESS;
    slc_log(&player->info.log, SLUICE_LOG_ERROR,
            "the checkpoint was not written by a player of this recording");
    return SLUICE_ERROR_CORRUPT_DATA;
}

SluiceResult sluiceReadTraceCheckpoint(SluiceTracePlayer *player, const void *pData, size_t size)
{
    if (!player || !pData)
        return SLUICE_ERROR_NULL_POINTER;
    uint64_t numbers[CHECKPOINT_NUMBERS];
    struct session *session = NULL;
    SluiceResult result = read_numbers(player, pData, size, numbers);
    if (result == SLUICE_SUCCESS)
        result =
            begin_session(player, (const uint8_t *)pData + CHECKPOINT_HEAD_SIZE + sizeof(uint64_t),
                          size - CHECKPOINT_HEAD_SIZE - sizeof(uint64_t), &session);
    if (result != SLUICE_SUCCESS)
        return result == SLUICE_ERROR_UNSUPPORTED ? SLUICE_ERROR_CORRUPT_DATA : result;
    session->replay.in =
        (struct slc_cursor){player->info.pData, (size_t)numbers[0], (size_t)numbers[7], NULL};
    session->steps.block_end = (size_t)numbers[1];
    session->steps.checksum = numbers[2];
    session->replay.player.hash = numbers[3];
    session->replay.player.event_count = numbers[4];
    session->out.divergedEvent = numbers[5];
    session->out.divergedOffset = numbers[6];
    destroy_session(player, player->session);
    player->session = session;
    return SLUICE_SUCCESS;
}
