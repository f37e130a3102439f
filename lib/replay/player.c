#include "replay/player.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "replay/decisions.h"

static struct slc_heap_answer next_answer(struct slc_player *player)
{
    if (!player->scripted)
        return (struct slc_heap_answer){SLUICE_SUCCESS, player->next_heap_id++};
    if (player->answers_used < player->answer_count)
        return player->answers[player->answers_used++];
    player->answers_missing = true;
    return (struct slc_heap_answer){SLUICE_ERROR_OUT_OF_DEVICE_MEMORY, 0};
}

static void note_answer(struct slc_player *player, struct slc_heap_answer answer)
{
    struct slc_call call = {.kind = SLC_CALL_HEAP_ANSWER, .result = answer.result};
    if (answer.result >= SLUICE_SUCCESS)
        call.heap_id = answer.heap_id;
    player->hash = slc_hash_decisions(player->hash, player->manager, &call);
    slc_dump_decisions(&player->dump, player->manager, &call);
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)size;
    struct slc_player *player = user;
    struct slc_heap_answer answer = next_answer(player);
    note_answer(player, answer);
    if (answer.result == SLUICE_SUCCESS)
        *heap_id = answer.heap_id;
    return answer.result;
}

/* Does nothing: the manager tracks heaps. */
static void release_heap(void *user, uint32_t heap_id)
{
    (void)user;
    (void)heap_id;
}

SluiceResult slc_player_init(struct slc_player *player, const SluiceAllocationCallbacks *cb,
                             const SluiceStreamedTextureManagerCreateInfo *info, bool scripted)
{
    *player = (struct slc_player){.cb = *cb, .hash = SLC_HASH_EMPTY, .scripted = scripted};
    SluiceStreamedTextureManagerCreateInfo own = *info;
    own.pAllocator = &player->cb;
    own.heapAllocator = (SluiceHeapAllocator){player, allocate_heap, release_heap};
    return sluiceCreateStreamedTextureManager(&own, &player->manager);
}

void slc_player_finish(struct slc_player *player)
{
    sluiceDestroyStreamedTextureManager(player->manager);
    slc_free(&player->cb, player->answers, player->answer_capacity, sizeof *player->answers);
    slc_free(&player->cb, player->scratch, player->scratch_size, 1);
    *player = (struct slc_player){.cb = player->cb};
}

SluiceResult slc_player_add_answer(struct slc_player *player, SluiceResult result, uint32_t heap_id)
{
    if (player->answer_count == player->answer_capacity) {
        size_t capacity = player->answer_capacity ? 2 * player->answer_capacity : 16;
        struct slc_heap_answer *answers = slc_regrow(
            &player->cb, player->answers, player->answer_capacity, capacity, sizeof *answers);
        if (!answers)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        player->answers = answers;
        player->answer_capacity = capacity;
    }
    player->answers[player->answer_count++] = (struct slc_heap_answer){result, heap_id};
    return SLUICE_SUCCESS;
}

void *slc_player_scratch(struct slc_player *player, size_t count, size_t size)
{
    size_t need;
    if (!slc_mul_size(count ? count : 1, size, &need))
        return NULL;
    if (need <= player->scratch_size)
        return player->scratch;
    /* Contents are dropped. The size doubles, so that repeated growth stays cheap. */
    size_t twice;
    if (slc_mul_size(player->scratch_size, 2, &twice) && need < twice)
        need = twice;
    slc_free(&player->cb, player->scratch, player->scratch_size, 1);
    player->scratch = slc_alloc(&player->cb, need, 1);
    player->scratch_size = player->scratch ? need : 0;
    return player->scratch;
}

static uint64_t most_prefetched(const struct slc_player *player,
                                const SluiceStreamedTextureStatistics *s)
{
    const SluiceStreamedTextureManagerConfig *config = slc_manager_config(player->manager);
    uint64_t standby = config->prefetchLevels ? config->numExtraStandbyTiles : 0;
    return standby < s->tileCount ? standby : s->tileCount;
}

/* Returns the most entries of a list, as a limit for allocations. */
static uint64_t most_entries(const struct slc_player *player, enum slc_call_kind kind)
{
    SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
    if (sluiceGetStatistics(player->manager, &s) != SLUICE_SUCCESS)
        return 0;
    switch (kind) {
    case SLC_CALL_GET_TILES_TO_MAP: return s.requestedTileCount + most_prefetched(player, &s);
    case SLC_CALL_GET_TILES_TO_CANCEL: return s.canceledTileCount;
    case SLC_CALL_GET_TILES_TO_UNMAP: return s.standbyTileCount;
    case SLC_CALL_GET_GIVEN_UP: return s.failedTotal; /* upper bound: tiles may be retried */
    case SLC_CALL_GET_MINMIP_UPDATES: return s.textureCount;
    case SLC_CALL_DEFRAGMENT: /* each tile moves out of each heap at most once */
        return ((uint64_t)s.mappedTileCount + s.standbyTileCount) * s.heapCount;
    default: return 0;
    }
}

static size_t entry_size(enum slc_call_kind kind)
{
    return kind == SLC_CALL_DEFRAGMENT           ? sizeof(SluiceTileMove)
           : kind == SLC_CALL_GET_MINMIP_UPDATES ? sizeof(SluiceMinMipRect)
                                                 : sizeof(SluiceTile);
}

static SluiceResult make_list_call(struct slc_player *player, struct slc_call *call)
{
    SluiceStreamedTextureManager *m = player->manager;
    uint64_t most = most_entries(player, call->kind);
    uint32_t count = call->room;
    /* NULL_POINTER was recorded for a NULL count, because the array is never NULL. */
    uint32_t *room = call->result == SLUICE_ERROR_NULL_POINTER ? NULL : &count;
    void *entries = NULL;
    if (!call->query) {
        entries =
            slc_player_scratch(player, count < most ? count : (size_t)most, entry_size(call->kind));
        if (!entries)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    switch (call->kind) {
    case SLC_CALL_GET_TILES_TO_MAP:
        call->result = sluiceGetTilesToMap(m, call->texture_id, room, entries);
        break;
    case SLC_CALL_GET_TILES_TO_CANCEL:
        call->result = sluiceGetTilesToCancel(m, call->texture_id, room, entries);
        break;
    case SLC_CALL_GET_TILES_TO_UNMAP:
        call->result =
            sluiceGetTilesToUnmap(m, call->texture_id, call->retire_value, room, entries);
        break;
    case SLC_CALL_GET_GIVEN_UP: call->result = sluiceGetGivenUpTiles(m, room, entries); break;
    case SLC_CALL_DEFRAGMENT:
        call->result = sluiceDefragmentTiles(m, call->retire_value, room, entries);
        break;
    default: call->result = sluiceGetMinMipUpdates(m, room, entries); break;
    }
    call->count = call->result >= SLUICE_SUCCESS ? count : 0;
    call->tiles = entries;
    call->moves = entries;
    call->rects = entries;
    return SLUICE_SUCCESS;
}

static SluiceResult make_simple_call(struct slc_player *player, struct slc_call *call)
{
    SluiceStreamedTextureManager *m = player->manager;
    SluiceTextureId id = call->texture_id;
    switch (call->kind) {
    case SLC_CALL_SET_CONFIG: return sluiceSetConfig(m, call->config);
    case SLC_CALL_ADD_TEXTURE:
        return sluiceAddStreamedTexture(
            m, call->desc,
            call->desc && call->result == SLUICE_ERROR_NULL_POINTER ? NULL : &call->texture_id);
    case SLC_CALL_REMOVE_TEXTURE: return sluiceRemoveStreamedTexture(m, id, call->retire_value);
    case SLC_CALL_FORGET_TEXTURE: return sluiceForgetStreamedTexture(m, id, call->retire_value);
    case SLC_CALL_EVICT_TEXTURE: return sluiceEvictStreamedTexture(m, id, call->keep_count);
    case SLC_CALL_UPDATE_FEEDBACK:
        return sluiceUpdateWithSamplerFeedback(m, id, call->feedback, call->time_stamp,
                                               call->timeout);
    case SLC_CALL_MATCH_PRIMARY:
        return sluiceMatchPrimaryTexture(m, call->primary_id, id, call->time_stamp, call->timeout);
    case SLC_CALL_SET_PRIMARY: return sluiceSetPrimaryTexture(m, id, call->primary_id);
    case SLC_CALL_SET_UV: return sluiceSetUvTransform(m, id, call->uv);
    case SLC_CALL_SET_PRIORITY: return sluiceSetTexturePriority(m, id, call->priority);
    case SLC_CALL_UPDATE_MAPPING:
        return sluiceUpdateTilesMapping(m, id, call->count, call->tile_indices);
    case SLC_CALL_REPORT_FAILED:
        return sluiceReportFailedTiles(m, id, call->count, call->tile_indices, call->time_stamp);
    case SLC_CALL_REPORT_CANCELED:
        return sluiceReportCanceledTiles(m, id, call->count, call->tile_indices,
                                         call->retire_value);
    case SLC_CALL_RETRY_FAILED: return sluiceRetryFailedTiles(m, id);
    case SLC_CALL_COMPLETE_RETIRE: return sluiceCompleteRetireValue(m, call->retire_value);
    case SLC_CALL_EVACUATE_HEAPS: return sluiceEvacuateHeaps(m, call->keep_count);
    case SLC_CALL_TRIM_STANDBY: return sluiceTrimStandbyTiles(m, call->keep_count);
    case SLC_CALL_RELEASE_HEAP: return sluiceReleaseHeap(m, call->heap_id);
    default: return SLUICE_ERROR_INVALID_ARGUMENT;
    }
}

SluiceResult slc_player_call(struct slc_player *player, struct slc_call *call)
{
    SluiceResult result = SLUICE_SUCCESS;
    bool skipped = call->result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    player->dump.event = ++player->event_count;
    slc_dump_inputs(&player->dump, call);
    if (skipped) {
        call->count = 0;
        for (; player->answers_used < player->answer_count; player->answers_used++)
            note_answer(player, player->answers[player->answers_used]);
    } else if (slc_call_lists(call->kind)) {
        result = make_list_call(player, call);
    } else {
        call->result = make_simple_call(player, call);
    }
    if (result != SLUICE_SUCCESS)
        return result;
    if (call->result == SLUICE_ERROR_OUT_OF_HOST_MEMORY && !skipped)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    player->hash = slc_hash_decisions(player->hash, player->manager, call);
    slc_dump_decisions(&player->dump, player->manager, call);
    return SLUICE_SUCCESS;
}
