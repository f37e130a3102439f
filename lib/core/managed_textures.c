#include "core/managed_textures.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "core/clock.h"
#include "core/given_up_retry.h"
#include "core/history.h"
#include "core/layout.h"
#include "core/lookup.h"
#include "core/minmip.h"
#include "core/observer.h"
#include "core/priority.h"
#include "core/refusal.h"
#include "core/reports.h"
#include "core/sets.h"
#include "core/shape.h"
#include "core/texture_tiles.h"
#include "core/uv_transform.h"
#include "core/visits.h"
#include "residency/node.h"
#include "residency/nodes.h"

#include <inttypes.h>

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

/** Reserves memory for one more texture, and for the case that every index is free. */
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
        struct slc_managed_texture **chunks =
            slc_regrow(&m->cb, m->chunks, m->chunk_room, room, sizeof *chunks);
        if (!chunks)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        m->chunks = chunks;
        m->chunk_room = room;
    }
    m->chunks[m->chunk_count] =
        slc_calloc(&m->cb, SLC_TEXTURES_PER_CHUNK, sizeof(struct slc_managed_texture));
    if (!m->chunks[m->chunk_count])
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    m->chunk_count++;
    return SLUICE_SUCCESS;
}

static void destroy_texture_memory(slc_manager *m, struct slc_managed_texture *t)
{
    slc_state_destroy(m, t);
    slc_free(&m->cb, t->packed_nodes, t->shape->desc.packedTileCount, sizeof *t->packed_nodes);
    t->packed_nodes = NULL;
    slc_free(&m->cb, t->uv, 1, sizeof *t->uv);
    t->uv = NULL;
    slc_shape_give(m, t->shape);
    t->shape = NULL;
}

/** Makes the memory of a texture in `t`. After an error the caller frees what `t` owns. */
static SluiceResult reserve_for_add(slc_manager *m, const SluiceStreamedTextureDesc *desc,
                                    struct slc_managed_texture *t)
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
    if (m->info.alwaysMapPackedTiles && !slc_reserve_nodes(&m->residency, packed))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    t->packed_nodes = slc_calloc(&m->cb, packed, sizeof *t->packed_nodes);
    return t->packed_nodes ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/** Turns a reservation into a texture at an index. */
static struct slc_managed_texture *enter_texture(slc_manager *m, uint32_t index,
                                                 uint32_t generation,
                                                 const struct slc_managed_texture *reserved)
{
    struct slc_managed_texture *t = slc_texture_at(m, index);
    *t = *reserved;
    t->generation = generation;
    t->live = true;
    t->index = index;
    t->primary = SLC_NONE;
    t->first_follower = t->last_follower = SLC_NONE;
    t->prev_follower = t->next_follower = SLC_NONE;
    m->texture_count++;
    m->tile_count += t->shape->tile_count;
    return t;
}

SluiceResult slc_texture_restore(slc_manager *m, uint32_t generation,
                                 const SluiceStreamedTextureDesc *desc)
{
    struct slc_managed_texture reserved = {0};
    SluiceResult result = desc ? reserve_for_add(m, desc, &reserved) : reserve_texture(m);
    if (result != SLUICE_SUCCESS) {
        if (reserved.shape)
            slc_shape_give(m, reserved.shape);
        return result;
    }
    uint32_t index = m->texture_end++;
    slc_texture_at(m, index)->generation = generation;
    slc_texture_at(m, index)->index = index;
    if (desc)
        enter_texture(m, index, generation, &reserved);
    return SLUICE_SUCCESS;
}

void slc_textures_restored(slc_manager *m)
{
    for (uint32_t i = 0; i < m->texture_end; i++)
        if (!slc_texture_at(m, i)->live && slc_texture_at(m, i)->generation < UINT32_MAX)
            heap_push(m->free_indices, m->free_index_count++, i);
}

static SluiceResult add_texture(slc_manager *m, const SluiceStreamedTextureDesc *desc,
                                SluiceTextureId *id)
{
    struct slc_managed_texture reserved = {0};
    SluiceResult result = reserve_for_add(m, desc, &reserved);
    if (result != SLUICE_SUCCESS) {
        if (reserved.shape)
            slc_shape_give(m, reserved.shape);
        return result;
    }
    uint32_t index = m->texture_end;
    if (m->free_index_count > 0)
        index = heap_pop(m->free_indices, m->free_index_count--);
    else
        m->texture_end++;
    struct slc_managed_texture *t =
        enter_texture(m, index, slc_texture_at(m, index)->generation + 1, &reserved);
    slc_min_mip_dirty_all(m, t);
    m->events.reason = SLUICE_TILE_EVENT_ADDED;
    if (m->info.alwaysMapPackedTiles)
        slc_packed_tiles_wanted(m, t);
    *id = slc_texture_id(t);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceAddStreamedTexture(SluiceStreamedTextureManager *manager,
                                      const SluiceStreamedTextureDesc *pDesc,
                                      SluiceTextureId *pTextureId)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_ADD_TEXTURE, .desc = pDesc};
    if (!pDesc || !pTextureId)
        call.result = SLUICE_ERROR_NULL_POINTER;
    else
        call.result = add_texture(manager, pDesc, pTextureId);
    if (call.result == SLUICE_ERROR_INVALID_ARGUMENT)
        slc_refuse(manager, __func__,
                   "%" PRIu32 "x%" PRIu32 " texels, %" PRIu32
                   " levels: at most %u texels, and the full mip chain",
                   pDesc->width, pDesc->height, pDesc->mipLevelCount, SLUICE_MAX_TEXTURE_SIZE);
    if (call.result == SLUICE_SUCCESS)
        call.texture_id = *pTextureId;
    slc_notify(manager, &call);
    return call.result;
}

static SluiceResult remove_texture(slc_manager *m, SluiceTextureId id, uint64_t retire_value)
{
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(m, id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_retire_is_backwards(m, retire_value))
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (retire_value)
        m->last_retire = retire_value;
    m->events.reason = SLUICE_TILE_EVENT_REMOVED;
    slc_unfollow(m, t);
    while (t->first_follower != SLC_NONE) {
        struct slc_managed_texture *follower = slc_texture_at(m, t->first_follower);
        slc_unfollow(m, follower);
        slc_priority_changed(m, follower, t->priority);
    }
    for (uint32_t tile = t->nodes ? 0 : t->shape->regular_tile_count; tile < t->shape->tile_count;
         tile++)
        if (slc_find_node(t, tile))
            slc_node_retire(&m->residency, slc_find_node(t, tile), retire_value);
    slc_reports_drop(m, t);
    slc_trouble_move(m, t, SLC_TROUBLE_NONE);
    slc_visit(m, t, false);
    slc_min_mip_drop_update(m, t);
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
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_REMOVE_TEXTURE,
                            .texture_id = textureId,
                            .retire_value = retireValue,
                            .result = remove_texture(manager, textureId, retireValue)};
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceGetTextureLayout(const SluiceStreamedTextureManager *manager,
                                    SluiceTextureId textureId, SluiceStreamedTextureLayout *pLayout)
{
    if (!manager || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(manager, textureId, &t);
    return result == SLUICE_SUCCESS ? slc_write_layout(t->shape, &manager->info.log, pLayout)
                                    : result;
}

SluiceResult sluiceGetTileState(const SluiceStreamedTextureManager *manager,
                                SluiceTextureId textureId, uint32_t tileIndex,
                                SluiceTileState *pState, SluiceTile *pTile)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(manager, textureId, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (tileIndex >= t->shape->tile_count)
        return SLUICE_ERROR_UNKNOWN_TILE;
    uint32_t node = slc_find_node(t, tileIndex);
    if (pState)
        *pState = node ? (SluiceTileState)slc_node_at(&manager->residency, node)->state
                       : SLUICE_TILE_STATE_FREE;
    if (pTile && node) {
        *pTile = slc_node_tile(manager, node);
    } else if (pTile) {
        struct slc_place p = slc_tile_place(t, tileIndex);
        *pTile = (SluiceTile){textureId, tileIndex, p.level, p.x, p.y, 0, 0};
    }
    return SLUICE_SUCCESS;
}

void slc_textures_finish(slc_manager *m)
{
    for (uint32_t i = 0; i < m->texture_end; i++)
        if (slc_texture_at(m, i)->live)
            destroy_texture_memory(m, slc_texture_at(m, i));
    for (uint32_t i = 0; i < m->chunk_count; i++)
        slc_free(&m->cb, m->chunks[i], SLC_TEXTURES_PER_CHUNK, sizeof(struct slc_managed_texture));
    slc_free(&m->cb, m->chunks, m->chunk_room, sizeof *m->chunks);
    slc_free(&m->cb, m->free_indices, m->free_index_room, sizeof *m->free_indices);
}
