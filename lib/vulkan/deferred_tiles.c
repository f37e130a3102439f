#include "vulkan/deferred_tiles.h"

#include "base/alloc.h"

#include <string.h>

void slc_deferred_tiles_finish(struct slc_deferred_tiles *deferred,
                               const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, deferred->tiles, deferred->room, sizeof *deferred->tiles);
    *deferred = (struct slc_deferred_tiles){0};
}

bool slc_deferred_tiles_add(struct slc_deferred_tiles *deferred,
                            const SluiceAllocationCallbacks *cb, uint32_t texture,
                            const SluiceTile *tile)
{
    if (deferred->count == deferred->room) {
        uint32_t room = deferred->room ? 2 * deferred->room : 64;
        struct slc_deferred_tile *tiles =
            slc_regrow(cb, deferred->tiles, deferred->room, room, sizeof *tiles);
        if (!tiles)
            return false;
        deferred->tiles = tiles;
        deferred->room = room;
    }
    deferred->tiles[deferred->count++] = (struct slc_deferred_tile){texture, *tile};
    return true;
}

void slc_deferred_tiles_remove_at(struct slc_deferred_tiles *deferred, uint32_t at)
{
    deferred->count--;
    memmove(&deferred->tiles[at], &deferred->tiles[at + 1],
            (deferred->count - at) * sizeof *deferred->tiles);
}

bool slc_deferred_tiles_remove(struct slc_deferred_tiles *deferred, uint32_t texture,
                               uint32_t tile_index)
{
    for (uint32_t i = 0; i < deferred->count; i++)
        if (deferred->tiles[i].texture == texture &&
            deferred->tiles[i].tile.tileIndex == tile_index) {
            slc_deferred_tiles_remove_at(deferred, i);
            return true;
        }
    return false;
}

void slc_deferred_tiles_drop(struct slc_deferred_tiles *deferred, uint32_t texture)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < deferred->count; i++)
        if (deferred->tiles[i].texture != texture)
            deferred->tiles[kept++] = deferred->tiles[i];
    deferred->count = kept;
}
