#include "core/internal.h"
#include "core/wants.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <string.h>

/* Memory ------------------------------------------------------------------------------------ */

static void *count_allocate(void *user, size_t size, size_t alignment)
{
    slc_manager *m = user;
    void *memory = m->given.pfnAllocate(m->given.pUserData, size, alignment);
    if (memory)
        m->host_memory_size += size;
    return memory;
}

static void count_free(void *user, void *memory, size_t size)
{
    slc_manager *m = user;
    m->host_memory_size -= size;
    m->given.pfnFree(m->given.pUserData, memory, size);
}

/* Creation ---------------------------------------------------------------------------------- */

static SluiceResult check_create_info(const SluiceStreamedTextureManagerCreateInfo *info)
{
    if (!info->heapAllocator.pfnAllocateHeap || !info->heapAllocator.pfnReleaseHeap)
        return SLUICE_ERROR_NULL_POINTER;
    if (info->heapTileCapacity == 0 || info->tileSize == 0)
        return SLUICE_ERROR_ZERO_HEAP_CAPACITY;
    if (info->heapTileCapacity > 1u << 20 || !slc_allocator_is_valid(info->pAllocator))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    return SLUICE_SUCCESS;
}

SluiceResult
sluiceCreateStreamedTextureManager(const SluiceStreamedTextureManagerCreateInfo *pCreateInfo,
                                   SluiceStreamedTextureManager **pManager)
{
    if (pManager)
        *pManager = NULL;
    if (!pCreateInfo || !pManager)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = check_create_info(pCreateInfo);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(pCreateInfo->pAllocator);
    slc_manager *m = slc_calloc(&cb, 1, sizeof *m);
    if (!m)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    m->info = *pCreateInfo;
    m->given = cb;
    m->info.pAllocator = pCreateInfo->pAllocator ? &m->given : NULL;
    m->cb = (SluiceAllocationCallbacks){m, count_allocate, count_free};
    m->host_memory_size = sizeof *m;
    m->dirty_first = m->dirty_last = m->visit_first = m->visit_last = SLC_NONE;
    result = slc_tile_heaps_init(&m->heaps, &m->cb, &pCreateInfo->heapAllocator,
                                 pCreateInfo->heapTileCapacity, pCreateInfo->tileSize);
    if (result != SLUICE_SUCCESS)
        goto fail;
    /* Index 0 stands for none. */
    if (!slc_reserve_nodes(m, 1)) {
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        goto fail;
    }
    m->node_end = 1;
    *pManager = m;
    return SLUICE_SUCCESS;

fail:
    sluiceDestroyStreamedTextureManager(m);
    return result;
}

static void destroy_texture_memory(slc_manager *m, struct slc_texture *t)
{
    slc_state_destroy(m, t);
    slc_free(&m->cb, t->packed_nodes, t->shape->desc.packedTileCount, sizeof *t->packed_nodes);
    t->packed_nodes = NULL;
    slc_shape_give(m, t->shape);
    t->shape = NULL;
}

void sluiceDestroyStreamedTextureManager(SluiceStreamedTextureManager *manager)
{
    slc_manager *m = manager;
    if (!m)
        return;
    slc_tile_heaps_finish(&m->heaps);
    for (uint32_t i = 0; i < m->texture_end; i++)
        if (slc_texture_at(m, i)->live)
            destroy_texture_memory(m, slc_texture_at(m, i));
    for (uint32_t i = 0; i < m->chunk_count; i++)
        slc_free(&m->cb, m->chunks[i], SLC_TEXTURES_PER_CHUNK, sizeof(struct slc_texture));
    slc_free(&m->cb, m->chunks, m->chunk_room, sizeof *m->chunks);
    slc_free(&m->cb, m->free_indices, m->free_index_room, sizeof *m->free_indices);
    for (uint32_t i = 0; i < m->node_chunk_count; i++)
        slc_free(&m->cb, m->node_chunks[i], SLC_NODES_PER_CHUNK, sizeof(struct slc_node));
    slc_free(&m->cb, m->node_chunks, m->node_chunk_room, sizeof *m->node_chunks);
    slc_free(&m->cb, m->scratch, m->scratch_room, 1);
    slc_free(&m->cb, m->given_up_reports, m->report_room, sizeof *m->given_up_reports);
    slc_map_finish(&m->reported, &m->cb);
    SluiceAllocationCallbacks given = m->given;
    slc_free(&given, m, 1, sizeof *m);
}

/* Observer ---------------------------------------------------------------------------------- */

void slc_manager_set_observer(SluiceStreamedTextureManager *manager, struct slc_observer observer)
{
    manager->observer = observer;
}

bool slc_manager_is_used(const SluiceStreamedTextureManager *manager)
{
    return manager->used || manager->observer.notify;
}

const SluiceStreamedTextureManagerCreateInfo *
slc_manager_create_info(const SluiceStreamedTextureManager *manager)
{
    return &manager->info;
}

const SluiceStreamedTextureManagerConfig *
slc_manager_config(const SluiceStreamedTextureManager *manager)
{
    return &manager->config;
}

void slc_notify(slc_manager *m, const struct slc_call *call)
{
    /* The configuration can be asked for at any time, so it alone hides nothing from a recorder. */
    m->used |= call->kind != SLC_CALL_SET_CONFIG;
    if (m->observer.notify)
        m->observer.notify(m->observer.user, m, call);
}

/* Time -------------------------------------------------------------------------------------- */

bool slc_time_is_backwards(const slc_manager *m, uint64_t time)
{
    return m->has_time && (int64_t)(time - m->time) < 0;
}

bool slc_retire_is_backwards(const slc_manager *m, uint64_t retire_value)
{
    return retire_value != 0 && retire_value < m->last_retire;
}

void slc_advance_time(slc_manager *m, uint64_t time)
{
    m->has_time = true;
    m->time = time;
    while (m->failed.head && (int64_t)(time - slc_node_at(m, m->failed.head)->order) >= 0)
        slc_node_request_again(m, m->failed.head);
}

/* Looking up -------------------------------------------------------------------------------- */

SluiceResult slc_find_texture(const slc_manager *m, SluiceTextureId id, struct slc_texture **out)
{
    uint32_t index = (uint32_t)id, generation = (uint32_t)(id >> 32);
    if (index >= m->texture_end || generation == 0)
        return SLUICE_ERROR_UNKNOWN_TEXTURE;
    struct slc_texture *t = slc_texture_at(m, index);
    if (generation > t->generation)
        return SLUICE_ERROR_UNKNOWN_TEXTURE;
    if (generation < t->generation || !t->live)
        return SLUICE_ERROR_STALE_TEXTURE;
    *out = t;
    return SLUICE_SUCCESS;
}

SluiceResult slc_find_scope(const slc_manager *m, SluiceTextureId id, struct slc_texture **out)
{
    *out = NULL;
    return id == SLUICE_ALL_TEXTURES ? SLUICE_SUCCESS : slc_find_texture(m, id, out);
}

SluiceResult sluiceGetTextureLayout(const SluiceStreamedTextureManager *manager,
                                    SluiceTextureId textureId, SluiceStreamedTextureLayout *pLayout)
{
    if (!manager || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture *t;
    SluiceResult result = slc_find_texture(manager, textureId, &t);
    if (result == SLUICE_SUCCESS)
        slc_write_layout(t->shape, pLayout);
    return result;
}

SluiceResult sluiceGetTileState(const SluiceStreamedTextureManager *manager,
                                SluiceTextureId textureId, uint32_t tileIndex,
                                SluiceTileState *pState, SluiceTile *pTile)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture *t;
    SluiceResult result = slc_find_texture(manager, textureId, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (tileIndex >= t->shape->tile_count)
        return SLUICE_ERROR_UNKNOWN_TILE;
    uint32_t node = slc_find_node(t, tileIndex);
    if (pState)
        *pState =
            node ? (SluiceTileState)slc_node_at(manager, node)->state : SLUICE_TILE_STATE_FREE;
    if (pTile && node) {
        *pTile = slc_node_tile(manager, node);
    } else if (pTile) {
        struct slc_place p = slc_tile_place(t, tileIndex);
        *pTile = (SluiceTile){textureId, tileIndex, p.level, p.x, p.y, 0, 0};
    }
    return SLUICE_SUCCESS;
}

/* Textures ---------------------------------------------------------------------------------- */

static void heap_push(uint32_t *heap, uint32_t count, uint32_t value)
{
    uint32_t i = count;
    for (; i > 0 && heap[(i - 1) / 2] > value; i = (i - 1) / 2)
        heap[i] = heap[(i - 1) / 2];
    heap[i] = value;
}

/** Takes the least of `count` values. */
static uint32_t heap_pop(uint32_t *heap, uint32_t count)
{
    uint32_t least = heap[0], value = heap[count - 1], i = 0;
    count--;
    for (uint32_t child; (child = 2 * i + 1) < count; i = child) {
        if (child + 1 < count && heap[child + 1] < heap[child])
            child++;
        if (heap[child] >= value)
            break;
        heap[i] = heap[child];
    }
    heap[i] = value;
    return least;
}

/** Room for one more texture, and for every index to be free at a time. */
static SluiceResult reserve_texture(slc_manager *m)
{
    if (m->free_index_count > 0 || m->texture_end < m->chunk_count * SLC_TEXTURES_PER_CHUNK)
        return SLUICE_SUCCESS;
    if (m->texture_end > UINT32_MAX - 2 * SLC_TEXTURES_PER_CHUNK)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    uint32_t needed = m->texture_end + SLC_TEXTURES_PER_CHUNK;
    if (m->free_index_room < needed) {
        uint32_t room = slc_max_u32(needed, m->free_index_room * 2);
        uint32_t *indices =
            slc_regrow(&m->cb, m->free_indices, m->free_index_room, room, sizeof *indices);
        if (!indices)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        m->free_indices = indices;
        m->free_index_room = room;
    }
    if (m->chunk_count == m->chunk_room) {
        uint32_t room = m->chunk_room ? m->chunk_room * 2 : 16;
        struct slc_texture **chunks =
            slc_regrow(&m->cb, m->chunks, m->chunk_room, room, sizeof *chunks);
        if (!chunks)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        m->chunks = chunks;
        m->chunk_room = room;
    }
    m->chunks[m->chunk_count] =
        slc_calloc(&m->cb, SLC_TEXTURES_PER_CHUNK, sizeof(struct slc_texture));
    if (!m->chunks[m->chunk_count])
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    m->chunk_count++;
    return SLUICE_SUCCESS;
}

/** On an error everything that it made is in `t`. */
static SluiceResult reserve_for_add(slc_manager *m, const SluiceStreamedTextureDesc *desc,
                                    struct slc_texture *t)
{
    SluiceResult result = slc_shape_take(m, desc, &t->shape);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t packed = t->shape->desc.packedTileCount;
    if (m->texture_count == UINT32_MAX - 1)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    result = reserve_texture(m);
    if (result != SLUICE_SUCCESS || packed == 0)
        return result;
    if (m->info.alwaysMapPackedTiles && !slc_reserve_nodes(m, packed))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    t->packed_nodes = slc_calloc(&m->cb, packed, sizeof *t->packed_nodes);
    return t->packed_nodes ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static SluiceResult add_texture(slc_manager *m, const SluiceStreamedTextureDesc *desc,
                                SluiceTextureId *id)
{
    struct slc_texture new_texture = {0};
    SluiceResult result = reserve_for_add(m, desc, &new_texture);
    if (result != SLUICE_SUCCESS) {
        if (new_texture.shape)
            slc_shape_give(m, new_texture.shape);
        return result;
    }
    uint32_t index = m->texture_end;
    if (m->free_index_count > 0)
        index = heap_pop(m->free_indices, m->free_index_count--);
    else
        m->texture_end++;
    struct slc_texture *t = slc_texture_at(m, index);
    new_texture.generation = t->generation + 1;
    new_texture.live = true;
    new_texture.index = index;
    new_texture.primary = SLC_NONE;
    new_texture.first_follower = new_texture.last_follower = new_texture.next_follower = SLC_NONE;
    *t = new_texture;
    m->texture_count++;
    m->tile_count += t->shape->tile_count;
    slc_min_mip_dirty_all(m, t);
    if (m->info.alwaysMapPackedTiles)
        for (uint32_t i = 0; i < desc->packedTileCount; i++)
            slc_tile_wanted(m, t, &t->packed_nodes[i], t->shape->regular_tile_count + i,
                            desc->regularMipCount);
    *id = slc_texture_id(t);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceAddStreamedTexture(SluiceStreamedTextureManager *manager,
                                      const SluiceStreamedTextureDesc *pDesc,
                                      SluiceTextureId *pTextureId)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_ADD_TEXTURE, .desc = pDesc};
    if (!pDesc || !pTextureId)
        call.result = SLUICE_ERROR_NULL_POINTER;
    else
        call.result = add_texture(manager, pDesc, pTextureId);
    if (call.result == SLUICE_SUCCESS)
        call.texture_id = *pTextureId;
    slc_notify(manager, &call);
    return call.result;
}

static void forget_reports(slc_manager *m, SluiceTextureId id)
{
    uint32_t kept = m->report_first;
    for (uint32_t i = m->report_first; i < m->report_end; i++) {
        const struct slc_given_up *report = &m->given_up_reports[i];
        if (report->texture_id == id)
            slc_map_remove(&m->reported, slc_pair_key((uint32_t)id, report->tile));
        else
            m->given_up_reports[kept++] = *report;
    }
    m->report_end = kept;
}

static void unfollow(slc_manager *m, struct slc_texture *t)
{
    if (t->primary == SLC_NONE)
        return;
    struct slc_texture *p = slc_texture_at(m, t->primary);
    uint32_t before = SLC_NONE, at = p->first_follower;
    while (at != t->index) {
        before = at;
        at = slc_texture_at(m, at)->next_follower;
    }
    if (before == SLC_NONE)
        p->first_follower = t->next_follower;
    else
        slc_texture_at(m, before)->next_follower = t->next_follower;
    if (p->last_follower == t->index)
        p->last_follower = before;
    t->primary = t->next_follower = SLC_NONE;
}

static SluiceResult remove_texture(slc_manager *m, SluiceTextureId id, uint64_t retire_value)
{
    struct slc_texture *t;
    SluiceResult result = slc_find_texture(m, id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_retire_is_backwards(m, retire_value))
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (retire_value)
        m->last_retire = retire_value;
    unfollow(m, t);
    while (t->first_follower != SLC_NONE)
        unfollow(m, slc_texture_at(m, t->first_follower));
    for (uint32_t tile = t->nodes ? 0 : t->shape->regular_tile_count; tile < t->shape->tile_count;
         tile++)
        if (slc_find_node(t, tile))
            slc_node_retire(m, slc_find_node(t, tile), retire_value);
    forget_reports(m, id);
    slc_visit(m, t, false);
    slc_min_mip_forget(m, t);
    m->tile_count -= t->shape->tile_count;
    destroy_texture_memory(m, t);
    m->texture_count--;
    t->live = false;
    /* An index whose generations are used up is never handed out again. */
    if (t->generation < UINT32_MAX)
        heap_push(m->free_indices, m->free_index_count++, t->index);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceRemoveStreamedTexture(SluiceStreamedTextureManager *manager,
                                         SluiceTextureId textureId, uint64_t retireValue)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_REMOVE_TEXTURE,
                            .texture_id = textureId,
                            .retire_value = retireValue,
                            .result = remove_texture(manager, textureId, retireValue)};
    slc_notify(manager, &call);
    return call.result;
}

/* Textures by their last map ---------------------------------------------------------------- */

static void visit_append(slc_manager *m, struct slc_texture *t)
{
    t->visited = true;
    t->visit_prev = m->visit_last;
    t->visit_next = SLC_NONE;
    if (m->visit_last != SLC_NONE)
        slc_texture_at(m, m->visit_last)->visit_next = t->index;
    else
        m->visit_first = t->index;
    m->visit_last = t->index;
    m->visited_count++;
}

static void visit_remove(slc_manager *m, struct slc_texture *t)
{
    t->visited = false;
    if (t->visit_prev != SLC_NONE)
        slc_texture_at(m, t->visit_prev)->visit_next = t->visit_next;
    else
        m->visit_first = t->visit_next;
    if (t->visit_next != SLC_NONE)
        slc_texture_at(m, t->visit_next)->visit_prev = t->visit_prev;
    else
        m->visit_last = t->visit_prev;
    m->visited_count--;
}

void slc_visit(slc_manager *m, struct slc_texture *t, bool holds)
{
    if (t->visited)
        visit_remove(m, t);
    if (holds)
        visit_append(m, t);
}

/* Sets -------------------------------------------------------------------------------------- */

static SluiceResult set_primary(slc_manager *m, SluiceTextureId follower_id,
                                SluiceTextureId primary_id)
{
    struct slc_texture *t, *p = NULL;
    SluiceResult result = slc_find_texture(m, follower_id, &t);
    if (result == SLUICE_SUCCESS && primary_id != SLUICE_NO_TEXTURE)
        result = slc_find_texture(m, primary_id, &p);
    if (result != SLUICE_SUCCESS)
        return result;
    if (p && (p == t || p->primary != SLC_NONE || t->first_follower != SLC_NONE))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (p && t->primary == p->index)
        return SLUICE_SUCCESS;
    unfollow(m, t);
    if (!p)
        return SLUICE_SUCCESS;
    t->primary = p->index;
    if (p->last_follower == SLC_NONE)
        p->first_follower = t->index;
    else
        slc_texture_at(m, p->last_follower)->next_follower = t->index;
    p->last_follower = t->index;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceSetPrimaryTexture(SluiceStreamedTextureManager *manager,
                                     SluiceTextureId followerId, SluiceTextureId primaryId)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_SET_PRIMARY,
                            .texture_id = followerId,
                            .primary_id = primaryId,
                            .result = set_primary(manager, followerId, primaryId)};
    slc_notify(manager, &call);
    return call.result;
}

/* Configuration and statistics -------------------------------------------------------------- */

SluiceResult sluiceSetConfig(SluiceStreamedTextureManager *manager,
                             const SluiceStreamedTextureManagerConfig *pConfig)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_SET_CONFIG, .config = pConfig};
    if (!pConfig) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        manager->config = *pConfig;
        slc_list_standby(manager, pConfig->numExtraStandbyTiles);
    }
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceGetStatistics(const SluiceStreamedTextureManager *manager,
                                 SluiceStreamedTextureStatistics *pStatistics)
{
    if (!manager || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    const slc_manager *m = manager;
    *pStatistics = (SluiceStreamedTextureStatistics){
        .textureCount = m->texture_count,
        .tileCount = m->tile_count,
        .requestedTileCount = m->state_counts[SLUICE_TILE_STATE_REQUESTED],
        .allocatedTileCount = m->state_counts[SLUICE_TILE_STATE_ALLOCATED],
        .mappedTileCount = m->state_counts[SLUICE_TILE_STATE_MAPPED],
        .standbyTileCount = m->state_counts[SLUICE_TILE_STATE_STANDBY],
        .cancelledTileCount = m->state_counts[SLUICE_TILE_STATE_CANCELLED],
        .failedTileCount = m->state_counts[SLUICE_TILE_STATE_FAILED],
        .givenUpTileCount = m->state_counts[SLUICE_TILE_STATE_GIVEN_UP],
        .retiringSlotCount = m->retiring.count,
        .heapCount = m->heaps.live_count,
        .freeSlotCount =
            m->heaps.free_total < UINT32_MAX ? (uint32_t)m->heaps.free_total : UINT32_MAX,
        .reservedSlotCount = slc_reserved_slots(m),
        .globalMipBias = m->bias.value,
        .handedOutTotal = m->handed_out_total,
        .mappedTotal = m->mapped_total,
        .unmappedTotal = m->unmapped_total,
        .cancelledTotal = m->cancelled_total,
        .failedTotal = m->failed_total,
        .restoredTotal = m->restored_total,
        .movedTotal = m->moved_total,
        .hostMemorySize = m->host_memory_size,
    };
    return SLUICE_SUCCESS;
}
