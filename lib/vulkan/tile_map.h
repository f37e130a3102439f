/** A fixed-size hash map from (texture, tile) to a number; open addressing, no allocation after
 * init. */
#ifndef SLC_VULKAN_TILE_MAP_H
#define SLC_VULKAN_TILE_MAP_H

#include <sluice/base.h>

#define SLC_TILE_MAP_NONE UINT32_MAX

struct slc_tile_map {
    uint64_t *keys;   ///< owned
    uint32_t *values; ///< owned; SLC_TILE_MAP_NONE: free place
    uint32_t place_count;
    uint32_t count, capacity;
};

SluiceResult slc_tile_map_init(struct slc_tile_map *map, const SluiceAllocationCallbacks *cb,
                               uint32_t capacity);
void slc_tile_map_finish(struct slc_tile_map *map, const SluiceAllocationCallbacks *cb);

static inline uint64_t slc_tile_key(uint32_t texture, uint32_t tile)
{
    return (uint64_t)texture << 32 | tile;
}

/** The key must not be there, the map not full, the value not SLC_TILE_MAP_NONE. */
void slc_tile_map_add(struct slc_tile_map *map, uint64_t key, uint32_t value);
/** SLC_TILE_MAP_NONE if it is not there. */
uint32_t slc_tile_map_get(const struct slc_tile_map *map, uint64_t key);
/** Nothing happens if it is not there. */
void slc_tile_map_remove(struct slc_tile_map *map, uint64_t key);

#endif /* SLC_VULKAN_TILE_MAP_H */
