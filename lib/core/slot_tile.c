/* Queries: the tile in a slot of a heap, and the sequence numbers of requests. */
#include "core/observer.h"
#include "core/refusal.h"
#include "core/texture_tiles.h"

SluiceResult sluiceGetSlotTile(const SluiceStreamedTextureManager *manager, uint32_t heapId,
                               uint32_t slot, SluiceTile *pTile)
{
    if (!manager || !pTile)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_tile_heaps *heaps = &manager->residency.heaps;
    uint32_t heap = slc_tile_heaps_find(heaps, heapId);
    if (heap == UINT32_MAX)
        return SLUICE_ERROR_UNKNOWN_HEAP;
    if (slot >= heaps->capacity)
        return slc_refuse(manager, __func__, "slot %u is above %u, the last one of a heap", slot,
                          heaps->capacity - 1);
    uint32_t node = heaps->heaps[heap].nodes[slot];
    bool is_used = node && slc_node_at(&manager->residency, node)->owner != SLC_NONE;
    *pTile = is_used ? slc_node_tile(manager, node)
                     : (SluiceTile){.textureId = SLUICE_NO_TEXTURE, .heapId = heapId, .slot = slot};
    return SLUICE_SUCCESS;
}

uint64_t slc_manager_next_request(const SluiceStreamedTextureManager *manager)
{
    return manager->residency.requests.next_sequence;
}

uint64_t slc_manager_request_of(const SluiceStreamedTextureManager *manager, const SluiceTile *tile)
{
    const struct slc_managed_texture *t = slc_texture_at(manager, (uint32_t)tile->textureId);
    const struct slc_node *n = slc_node_at(&manager->residency, slc_find_node(t, tile->tileIndex));
    return n->state == SLUICE_TILE_STATE_ALLOCATED ? n->order : UINT64_MAX;
}
