/** Hash map from 64-bit keys to numbers. Open addressing; only init and reserve allocate. */
#ifndef SLC_BASE_MAP_H
#define SLC_BASE_MAP_H

#include <sluice/base.h>

#define SLC_MAP_NONE UINT32_MAX

struct slc_map {
    uint64_t *keys;   ///< owned
    uint32_t *values; ///< owned; SLC_MAP_NONE: free
    uint32_t place_count;
    uint32_t count, capacity;
};

/** Makes a map for `capacity` keys. 0 < `capacity` < 2^30, also in slc_map_reserve. */
SluiceResult slc_map_init(struct slc_map *map, const SluiceAllocationCallbacks *cb,
                          uint32_t capacity);
void slc_map_finish(struct slc_map *map, const SluiceAllocationCallbacks *cb);

/** Reserves room for `capacity` keys. OUT_OF_HOST_MEMORY, with the map unchanged. */
SluiceResult slc_map_reserve(struct slc_map *map, const SluiceAllocationCallbacks *cb,
                             uint32_t capacity);

static inline uint64_t slc_pair_key(uint32_t a, uint32_t b)
{
    return (uint64_t)a << 32 | b;
}

/** Adds a key that is not in the map. The map must not be full, the value not SLC_MAP_NONE. */
void slc_map_add(struct slc_map *map, uint64_t key, uint32_t value);
/** Returns the value of a key, or SLC_MAP_NONE. */
uint32_t slc_map_get(const struct slc_map *map, uint64_t key);
/** Removes a key, if it is in the map. */
void slc_map_remove(struct slc_map *map, uint64_t key);

#endif /* SLC_BASE_MAP_H */
