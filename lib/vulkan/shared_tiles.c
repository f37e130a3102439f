#include "vulkan/shared_tiles.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/identity.h"

#include <assert.h>

void slc_shared_tiles_finish(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb)
{
    slc_map_finish(&tiles->by_hash, cb);
    slc_map_finish(&tiles->by_source, cb);
    slc_free(cb, tiles->entries, tiles->capacity, sizeof *tiles->entries);
    *tiles = (struct slc_shared_tiles){.free = SLC_NONE};
}

#define KEY_IDENTITY UINT32_MAX /* layer in keys by identity; no source has it */

struct slc_tile_key slc_tile_key(SluiceImageSource *source, const SluiceImageRegion *region,
                                 uint32_t generation)
{
    uint64_t identity = 0;
    if (!source || !slc_identify_region(source, region, &identity))
        return (struct slc_tile_key){source,    region->arrayLayer, region->mipLevel,
                                     region->x, region->y,          generation};
    return (struct slc_tile_key){source,
                                 KEY_IDENTITY,
                                 region->width << 16 | region->height,
                                 (uint32_t)(identity >> 32),
                                 (uint32_t)identity,
                                 generation};
}

static uint64_t hash_of(const struct slc_tile_key *key)
{
    const uint64_t parts[] = {(uint64_t)(uintptr_t)key->source,
                              (uint64_t)key->layer << 32 | key->level,
                              (uint64_t)key->x << 32 | key->y, key->generation};
    uint64_t hash = 0x243F6A8885A308D3u;
    for (int i = 0; i < 4; i++) {
        hash = (hash ^ parts[i]) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 32;
    }
    return hash;
}

static bool is_equal(const struct slc_tile_key *a, const struct slc_tile_key *b)
{
    return a->source == b->source && a->layer == b->layer && a->level == b->level && a->x == b->x &&
           a->y == b->y && a->generation == b->generation;
}

uint32_t slc_shared_tiles_find(const struct slc_shared_tiles *tiles, const struct slc_tile_key *key)
{
    if (tiles->by_hash.count == 0)
        return SLC_NONE;
    uint32_t at = slc_map_get(&tiles->by_hash, hash_of(key));
    while (at != SLC_NONE && !is_equal(&tiles->entries[at].key, key))
        at = tiles->entries[at].next;
    return at;
}

static uint64_t source_key(const SluiceImageSource *source)
{
    return (uint64_t)(uintptr_t)source;
}

uint32_t slc_shared_tiles_first_of(const struct slc_shared_tiles *tiles,
                                   const SluiceImageSource *source)
{
    return tiles->by_source.count ? slc_map_get(&tiles->by_source, source_key(source)) : SLC_NONE;
}

static void set_first_of(struct slc_shared_tiles *tiles, const SluiceImageSource *source,
                         uint32_t first)
{
    slc_map_remove(&tiles->by_source, source_key(source));
    if (first != SLC_NONE)
        slc_map_add(&tiles->by_source, source_key(source), first);
}

static void join_source(struct slc_shared_tiles *tiles, uint32_t index)
{
    struct slc_shared_tile *entry = &tiles->entries[index];
    entry->before = SLC_NONE;
    entry->after = slc_shared_tiles_first_of(tiles, entry->key.source);
    if (entry->after != SLC_NONE)
        tiles->entries[entry->after].before = index;
    set_first_of(tiles, entry->key.source, index);
}

static void leave_source(struct slc_shared_tiles *tiles, uint32_t index)
{
    const struct slc_shared_tile *entry = &tiles->entries[index];
    if (entry->after != SLC_NONE)
        tiles->entries[entry->after].before = entry->before;
    if (entry->before != SLC_NONE)
        tiles->entries[entry->before].after = entry->after;
    else
        set_first_of(tiles, entry->key.source, entry->after);
}

static SluiceResult grow_maps(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb,
                              uint32_t capacity)
{
    struct slc_map *maps[] = {&tiles->by_hash, &tiles->by_source};
    SluiceResult result = SLUICE_SUCCESS;
    for (int i = 0; i < 2 && result == SLUICE_SUCCESS; i++)
        result = maps[i]->place_count ? slc_map_reserve(maps[i], cb, capacity)
                                      : slc_map_init(maps[i], cb, capacity);
    return result;
}

static bool grow(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb)
{
    uint32_t old = tiles->capacity, capacity = slc_max_u32(64, 2 * old);
    if (grow_maps(tiles, cb, capacity) != SLUICE_SUCCESS)
        return false;
    struct slc_shared_tile *entries =
        slc_regrow(cb, tiles->entries, old, capacity, sizeof *entries);
    if (!entries)
        return false;
    tiles->entries = entries;
    tiles->capacity = capacity;
    return true;
}

uint32_t slc_shared_tiles_add(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb,
                              const struct slc_tile_key *key)
{
    uint32_t index = tiles->free;
    if (index == SLC_NONE && tiles->high == tiles->capacity && !grow(tiles, cb))
        return SLC_NONE;
    if (index == SLC_NONE)
        index = tiles->high++;
    else
        tiles->free = tiles->entries[index].next;
    uint64_t hash = hash_of(key);
    uint32_t first = slc_map_get(&tiles->by_hash, hash);
    slc_map_remove(&tiles->by_hash, hash);
    slc_map_add(&tiles->by_hash, hash, index);
    tiles->entries[index] =
        (struct slc_shared_tile){.key = *key, .page = SLC_NONE, .next = first, .listed = true};
    join_source(tiles, index);
    return index;
}

void slc_shared_tiles_unlist(struct slc_shared_tiles *tiles, uint32_t index)
{
    struct slc_shared_tile *entry = &tiles->entries[index];
    if (!entry->listed)
        return;
    uint64_t hash = hash_of(&entry->key);
    uint32_t first = slc_map_get(&tiles->by_hash, hash);
    if (first == index) {
        slc_map_remove(&tiles->by_hash, hash);
        if (entry->next != SLC_NONE)
            slc_map_add(&tiles->by_hash, hash, entry->next);
    } else {
        while (tiles->entries[first].next != index)
            first = tiles->entries[first].next;
        tiles->entries[first].next = entry->next;
    }
    leave_source(tiles, index);
    entry->listed = false;
}

void slc_shared_tiles_remove(struct slc_shared_tiles *tiles, uint32_t index)
{
    slc_shared_tiles_unlist(tiles, index);
    tiles->going_count -= tiles->entries[index].going;
    tiles->entries[index] =
        (struct slc_shared_tile){.key = {0}, .page = SLC_NONE, .next = tiles->free};
    tiles->free = index;
}
