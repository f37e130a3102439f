/** A hash map from 64-bit keys to numbers; open addressing, no allocation after init but in
 * reserve. */
#ifndef SLC_BASE_MAP_H
#define SLC_BASE_MAP_H

#include <sluice/base.h>

#define SLC_MAP_NONE UINT32_MAX

struct slc_map {
    uint64_t *keys;   ///< owned
    uint32_t *values; ///< owned; SLC_MAP_NONE: free place
    uint32_t place_count;
    uint32_t count, capacity;
};

/** 0 < `capacity` < 2^30, here and below. */
SluiceResult slc_map_init(struct slc_map *map, const SluiceAllocationCallbacks *cb,
                          uint32_t capacity);
void slc_map_finish(struct slc_map *map, const SluiceAllocationCallbacks *cb);

/** Room for `capacity` keys at least. OUT_OF_HOST_MEMORY: the map is as it was. */
SluiceResult slc_map_reserve(struct slc_map *map, const SluiceAllocationCallbacks *cb,
                             uint32_t capacity);

static inline uint64_t slc_pair_key(uint32_t a, uint32_t b)
{
    return (uint64_t)a << 32 | b;
}

/** The key must not be there, the map not full, the value not SLC_MAP_NONE. */
void slc_map_add(struct slc_map *map, uint64_t key, uint32_t value);
/** SLC_MAP_NONE if it is not there. */
uint32_t slc_map_get(const struct slc_map *map, uint64_t key);
/** Nothing happens if it is not there. */
void slc_map_remove(struct slc_map *map, uint64_t key);

#endif /* SLC_BASE_MAP_H */
