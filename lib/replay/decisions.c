#include "replay/decisions.h"

#include "base/checked.h"
#include "replay/record.h"

#define PIECE 4096u

bool slc_call_lists(enum slc_call_kind kind)
{
    return slc_call_fields(kind) & SLC_FIELD_LIST;
}

bool slc_call_has_entries(const struct slc_call *call)
{
    return slc_call_lists(call->kind) && call->result >= SLUICE_SUCCESS && !call->query &&
           call->count > 0;
}

static uint64_t hash_tile(uint64_t hash, const SluiceTile *tile, bool has_slot)
{
    hash = slc_hash_u64(hash, tile->textureId);
    hash = slc_hash_u32(hash, tile->tileIndex);
    hash = slc_hash_u32(hash, tile->mipLevel);
    hash = slc_hash_u32(hash, tile->x);
    hash = slc_hash_u32(hash, tile->y);
    if (!has_slot)
        return hash;
    hash = slc_hash_u32(hash, tile->heapId);
    return slc_hash_u32(hash, tile->slot);
}

static void hash_texels(void *user, const uint8_t *texels, size_t count)
{
    uint64_t *hash = user;
    *hash = slc_hash_bytes(*hash, texels, count);
}

static uint64_t hash_rect(uint64_t hash, const SluiceStreamedTextureManager *manager,
                          const SluiceMinMipRect *rect)
{
    hash = slc_hash_u64(hash, rect->textureId);
    hash = slc_hash_u32(hash, rect->x);
    hash = slc_hash_u32(hash, rect->y);
    hash = slc_hash_u32(hash, rect->width);
    hash = slc_hash_u32(hash, rect->height);
    slc_visit_minmip(manager, rect, hash_texels, &hash);
    return hash;
}

static uint64_t hash_entry(uint64_t hash, const SluiceStreamedTextureManager *manager,
                           const struct slc_call *call, uint32_t i)
{
    if (call->kind == SLC_CALL_GET_MINMIP_UPDATES)
        return hash_rect(hash, manager, &call->rects[i]);
    if (call->kind != SLC_CALL_DEFRAGMENT)
        return hash_tile(hash, &call->tiles[i], call->kind != SLC_CALL_GET_GIVEN_UP);
    hash = hash_tile(hash, &call->moves[i].from, true);
    hash = slc_hash_u32(hash, call->moves[i].heapId);
    return slc_hash_u32(hash, call->moves[i].slot);
}

uint64_t slc_hash_decisions(uint64_t hash, const SluiceStreamedTextureManager *manager,
                            const struct slc_call *call)
{
    hash = slc_hash_u8(hash, (uint8_t)call->kind);
    hash = slc_hash_u32(hash, (uint32_t)call->result);
    if (call->result < SLUICE_SUCCESS)
        return hash;
    if (call->kind == SLC_CALL_ADD_TEXTURE)
        return slc_hash_u64(hash, call->texture_id);
    if (call->kind == SLC_CALL_HEAP_ANSWER)
        return slc_hash_u32(hash, call->heap_id);
    if (!slc_call_lists(call->kind))
        return hash;
    hash = slc_hash_u32(hash, call->count);
    for (uint32_t i = 0; slc_call_has_entries(call) && i < call->count; i++)
        hash = hash_entry(hash, manager, call, i);
    return hash;
}

SluiceResult slc_visit_minmip(const SluiceStreamedTextureManager *manager,
                              const SluiceMinMipRect *rect,
                              void (*visit)(void *user, const uint8_t *texels, size_t count),
                              void *user)
{
    uint8_t texels[PIECE];
    /* Visits several whole rows together, or a long row in pieces, always in row order. */
    uint32_t columns = slc_min_u32(rect->width, PIECE);
    uint32_t rows = columns ? PIECE / columns : 0;
    for (uint32_t y = 0; rows && y < rect->height; y += rows) {
        for (uint32_t x = 0; x < rect->width; x += columns) {
            SluiceMinMipRect piece = {rect->textureId, rect->x + x, rect->y + y,
                                      slc_min_u32(rect->width - x, columns),
                                      slc_min_u32(rect->height - y, rows)};
            size_t size = (size_t)piece.width * piece.height;
            SluiceResult result = sluiceWriteMinMipRect(manager, &piece, piece.width, size, texels);
            if (result != SLUICE_SUCCESS)
                return result;
            visit(user, texels, size);
        }
    }
    return SLUICE_SUCCESS;
}
