#include "base/map.h"

#include "base/alloc.h"

#include <assert.h>
#include <string.h>

SluiceResult slc_map_init(struct slc_map *map, const SluiceAllocationCallbacks *cb,
                          uint32_t capacity)
{
    assert(capacity > 0 && capacity < 1u << 30);
    *map = (struct slc_map){.capacity = capacity, .place_count = 4};
    while (map->place_count < 2 * capacity)
        map->place_count *= 2;
    map->keys = slc_alloc(cb, map->place_count, sizeof *map->keys);
    map->values = slc_alloc(cb, map->place_count, sizeof *map->values);
    if (!map->keys || !map->values) {
        slc_map_finish(map, cb);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    memset(map->values, 0xFF, map->place_count * sizeof *map->values);
    return SLUICE_SUCCESS;
}

void slc_map_finish(struct slc_map *map, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, map->keys, map->place_count, sizeof *map->keys);
    slc_free(cb, map->values, map->place_count, sizeof *map->values);
    *map = (struct slc_map){0};
}

static uint32_t home(const struct slc_map *map, uint64_t key)
{
    return (uint32_t)(key * 0x9E3779B97F4A7C15u >> 32) & (map->place_count - 1);
}

static uint32_t find(const struct slc_map *map, uint64_t key)
{
    uint32_t at = home(map, key);
    while (map->values[at] != SLC_MAP_NONE && map->keys[at] != key)
        at = (at + 1) & (map->place_count - 1);
    return at;
}

SluiceResult slc_map_reserve(struct slc_map *map, const SluiceAllocationCallbacks *cb,
                             uint32_t capacity)
{
    if (capacity <= map->capacity)
        return SLUICE_SUCCESS;
    struct slc_map larger;
    SluiceResult result = slc_map_init(&larger, cb, capacity);
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t i = 0; i < map->place_count; i++)
        if (map->values[i] != SLC_MAP_NONE)
            slc_map_add(&larger, map->keys[i], map->values[i]);
    slc_map_finish(map, cb);
    *map = larger;
    return SLUICE_SUCCESS;
}

void slc_map_add(struct slc_map *map, uint64_t key, uint32_t value)
{
    assert(map->count < map->capacity && value != SLC_MAP_NONE);
    uint32_t at = find(map, key);
    assert(map->values[at] == SLC_MAP_NONE);
    map->keys[at] = key;
    map->values[at] = value;
    map->count++;
}

uint32_t slc_map_get(const struct slc_map *map, uint64_t key)
{
    return map->values[find(map, key)];
}

void slc_map_remove(struct slc_map *map, uint64_t key)
{
    uint32_t hole = find(map, key), mask = map->place_count - 1;
    if (map->values[hole] == SLC_MAP_NONE)
        return;
    map->count--;
    /* Close the gap: move back keys that would not be found behind it. */
    for (uint32_t at = (hole + 1) & mask; map->values[at] != SLC_MAP_NONE; at = (at + 1) & mask) {
        uint32_t distance = (at - home(map, map->keys[at])) & mask;
        if (distance >= ((at - hole) & mask)) {
            map->keys[hole] = map->keys[at];
            map->values[hole] = map->values[at];
            hole = at;
        }
    }
    map->values[hole] = SLC_MAP_NONE;
}
