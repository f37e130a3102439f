#include "vulkan/parked_tiles.h"

#include "base/alloc.h"

#include <string.h>

void slc_parked_tiles_finish(struct slc_parked_tiles *parked, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, parked->tiles, parked->room, sizeof *parked->tiles);
    *parked = (struct slc_parked_tiles){0};
}

bool slc_parked_tiles_add(struct slc_parked_tiles *parked, const SluiceAllocationCallbacks *cb,
                          uint32_t texture, const SluiceTile *tile)
{
    if (parked->count == parked->room) {
        uint32_t room = parked->room ? 2 * parked->room : 64;
        struct slc_parked_tile *tiles =
            slc_regrow(cb, parked->tiles, parked->room, room, sizeof *tiles);
        if (!tiles)
            return false;
        parked->tiles = tiles;
        parked->room = room;
    }
    parked->tiles[parked->count++] = (struct slc_parked_tile){texture, *tile};
    return true;
}

void slc_parked_tiles_remove_at(struct slc_parked_tiles *parked, uint32_t at)
{
    parked->count--;
    memmove(&parked->tiles[at], &parked->tiles[at + 1],
            (parked->count - at) * sizeof *parked->tiles);
}

bool slc_parked_tiles_remove(struct slc_parked_tiles *parked, uint32_t texture, uint32_t tile_index)
{
    for (uint32_t i = 0; i < parked->count; i++)
        if (parked->tiles[i].texture == texture && parked->tiles[i].tile.tileIndex == tile_index) {
            slc_parked_tiles_remove_at(parked, i);
            return true;
        }
    return false;
}

void slc_parked_tiles_drop(struct slc_parked_tiles *parked, uint32_t texture)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < parked->count; i++)
        if (parked->tiles[i].texture != texture)
            parked->tiles[kept++] = parked->tiles[i];
    parked->count = kept;
}
