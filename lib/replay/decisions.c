#include "replay/decisions.h"

#include "base/checked.h"
#include "replay/record.h"

#define FNV_PRIME UINT64_C(0x100000001B3)
#define PIECE 4096u

uint64_t slc_hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * FNV_PRIME;
    return hash;
}

static uint64_t hash_fixed(uint64_t hash, uint64_t value, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++)
        hash = (hash ^ (uint8_t)(value >> (8 * i))) * FNV_PRIME;
    return hash;
}

static uint64_t hash_u32(uint64_t hash, uint32_t value)
{
    return hash_fixed(hash, value, 4);
}

uint64_t slc_hash_u64(uint64_t hash, uint64_t value)
{
    return hash_fixed(hash, value, 8);
}

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
    hash = hash_u32(hash, tile->tileIndex);
    hash = hash_u32(hash, tile->mipLevel);
    hash = hash_u32(hash, tile->x);
    hash = hash_u32(hash, tile->y);
    if (!has_slot)
        return hash;
    hash = hash_u32(hash, tile->heapId);
    return hash_u32(hash, tile->slot);
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
    hash = hash_u32(hash, rect->x);
    hash = hash_u32(hash, rect->y);
    hash = hash_u32(hash, rect->width);
    hash = hash_u32(hash, rect->height);
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
    hash = hash_u32(hash, call->moves[i].heapId);
    return hash_u32(hash, call->moves[i].slot);
}

uint64_t slc_hash_decisions(uint64_t hash, const SluiceStreamedTextureManager *manager,
                            const struct slc_call *call)
{
    hash = hash_fixed(hash, (uint64_t)call->kind, 1);
    hash = hash_u32(hash, (uint32_t)call->result);
    if (call->result < SLUICE_SUCCESS)
        return hash;
    if (call->kind == SLC_CALL_ADD_TEXTURE)
        return slc_hash_u64(hash, call->texture_id);
    if (call->kind == SLC_CALL_HEAP_ANSWER)
        return hash_u32(hash, call->heap_id);
    if (!slc_call_lists(call->kind))
        return hash;
    hash = hash_u32(hash, call->count);
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
    /* Whole rows together where several fit, or a row in pieces: the order is the same. */
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
