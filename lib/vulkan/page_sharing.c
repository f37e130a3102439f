#include "vulkan/page_sharing.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#define FIRST_GENERATIONS 16u
#define STALLED_FRAMES 8u /* frames that a user waits for another one that begins no frame */

/* Finds the entry of an equal tile, and whether its texels are complete. SLC_NONE: there is none.
 */
static uint32_t find(const struct slc_page_pool *pool, const struct slc_tile_key *key, bool *ready)
{
    uint32_t index = slc_shared_tiles_find(&pool->shared, key);
    if (index == SLC_NONE)
        return SLC_NONE;
    const struct slc_shared_tile *tile = &pool->shared.entries[index];
    *ready =
        tile->written && (tile->writer == SLC_MAX_PAGE_USERS ||
                          slc_page_timelines_reached(&pool->timelines, tile->writer, tile->value));
    return index;
}

static bool is_stalled(const struct slc_page_pool *pool, uint32_t user, uint32_t writer)
{
    return writer != user && pool->timelines.of[user].still[writer] >= STALLED_FRAMES;
}

enum slc_share slc_page_share_look(struct slc_page_pool *pool, uint32_t user,
                                   const struct slc_tile_key *key)
{
    bool ready = false;
    slc_mutex_lock(&pool->mutex);
    uint32_t index = find(pool, key, &ready);
    enum slc_share share = index == SLC_NONE ? SLC_SHARE_NONE
                           : ready           ? SLC_SHARE_READY
                                             : SLC_SHARE_WAIT;
    if (share == SLC_SHARE_WAIT && is_stalled(pool, user, pool->shared.entries[index].writer))
        share = SLC_SHARE_NONE;
    slc_mutex_unlock(&pool->mutex);
    return share;
}

uint32_t slc_page_share_take(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key)
{
    bool ready = false;
    uint32_t page = SLUICE_PAGE_NONE;
    slc_mutex_lock(&pool->mutex);
    uint32_t index = find(pool, key, &ready);
    if (ready) {
        struct slc_shared_tile *tile = &pool->shared.entries[index];
        bool is_first = tile->holds[user]++ == 0;
        pool->users[user].held_count += is_first;
        pool->users[user].equal_count += !is_first;
        tile->users |= 1u << user;
        tile->readers |= 1u << user;
        page = tile->page;
    }
    slc_mutex_unlock(&pool->mutex);
    return page;
}

static uint32_t announce(struct slc_page_pool *pool, uint32_t user, const struct slc_tile_key *key)
{
    if (slc_shared_tiles_find(&pool->shared, key) != SLC_NONE)
        return SLC_NONE;
    uint32_t index = slc_shared_tiles_add(&pool->shared, pool->cb, key);
    if (index != SLC_NONE)
        pool->shared.entries[index].writer = (uint8_t)user;
    pool->generation_is_named = true;
    return index;
}

static void place(struct slc_page_pool *pool, uint32_t user, uint32_t index, uint32_t page)
{
    struct slc_shared_tile *tile = &pool->shared.entries[index];
    tile->page = page;
    tile->users = tile->readers = 1u << user;
    tile->holds[user] = 1;
    slc_page_layer(&pool->chunks, page)->shared = index + 1;
}

/* Finds the entry of a tile that the user reads and that has no page yet. */
static uint32_t find_own(const struct slc_page_pool *pool, uint32_t user,
                         const struct slc_tile_key *key)
{
    uint32_t index = slc_shared_tiles_find(&pool->shared, key);
    if (index == SLC_NONE || pool->shared.entries[index].writer != user ||
        pool->shared.entries[index].page != SLC_NONE)
        return SLC_NONE;
    return index;
}

void slc_page_share_announce(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key)
{
    slc_mutex_lock(&pool->mutex);
    announce(pool, user, key);
    slc_mutex_unlock(&pool->mutex);
}

void slc_page_share_withdraw(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t index = find_own(pool, user, key);
    if (index != SLC_NONE)
        slc_shared_tiles_remove(&pool->shared, index);
    slc_mutex_unlock(&pool->mutex);
}

void slc_page_share_place(struct slc_page_pool *pool, uint32_t user, const struct slc_tile_key *key,
                          uint32_t page)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t index = find_own(pool, user, key);
    if (index != SLC_NONE)
        place(pool, user, index, page);
    slc_mutex_unlock(&pool->mutex);
}

void slc_page_share_written(struct slc_page_pool *pool, uint32_t user, uint32_t page,
                            uint64_t frame)
{
    slc_mutex_lock(&pool->mutex);
    struct slc_page_layer *layer = slc_page_layer(&pool->chunks, page);
    uint32_t shared = layer->shared;
    layer->value = frame;
    if (shared && pool->shared.entries[shared - 1].writer == user) {
        pool->shared.entries[shared - 1].written = true;
        pool->shared.entries[shared - 1].adopted = false;
        pool->shared.entries[shared - 1].value = frame;
    }
    slc_mutex_unlock(&pool->mutex);
}

void slc_page_share_adopt(struct slc_page_pool *pool, uint32_t user, const struct slc_tile_key *key,
                          uint32_t page)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t index = announce(pool, user, key);
    if (index != SLC_NONE) {
        place(pool, user, index, page);
        pool->shared.entries[index].written = pool->shared.entries[index].adopted = true;
        /* this frame comes at or after the copy, because only copied texels can be taken back */
        pool->shared.entries[index].value = slc_page_layer(&pool->chunks, page)->value;
    }
    slc_mutex_unlock(&pool->mutex);
}

bool slc_page_is_shared(struct slc_page_pool *pool, uint32_t user, uint32_t page)
{
    bool shared = false;
    slc_mutex_lock(&pool->mutex);
    uint32_t index = slc_page_layer(&pool->chunks, page)->shared;
    if (index) {
        const struct slc_shared_tile *tile = &pool->shared.entries[index - 1];
        shared = tile->holds[user] > 1 || (tile->users | tile->readers) & ~(1u << user);
    }
    slc_mutex_unlock(&pool->mutex);
    return shared;
}

/* Unlists an entry. Removes it if the tile has no page. */
static void unlist(struct slc_page_pool *pool, uint32_t index)
{
    if (pool->shared.entries[index].page == SLC_NONE)
        slc_shared_tiles_remove(&pool->shared, index);
    else
        slc_shared_tiles_unlist(&pool->shared, index);
}

void slc_page_share_leave(struct slc_page_pool *pool, uint32_t user,
                          const SluiceImageSource *source)
{
    slc_mutex_lock(&pool->mutex);
    for (uint32_t next, i = slc_shared_tiles_first_of(&pool->shared, source); i != SLC_NONE;
         i = next) {
        const struct slc_shared_tile *tile = &pool->shared.entries[i];
        bool own = tile->page == SLC_NONE ? tile->writer == user : !(tile->users & ~(1u << user));
        next = tile->after;
        if (own)
            unlist(pool, i);
    }
    slc_mutex_unlock(&pool->mutex);
}

/* Sets the generation of a source. Without host memory all sources get it, and share no old pages.
 */
static void set_generation(struct slc_page_pool *pool, const SluiceImageSource *source)
{
    struct slc_map *map = &pool->generations;
    uint64_t key = (uint64_t)(uintptr_t)source;
    SluiceResult result = map->place_count ? slc_map_reserve(map, pool->cb, map->count + 1)
                                           : slc_map_init(map, pool->cb, FIRST_GENERATIONS);
    if (result != SLUICE_SUCCESS) {
        pool->least_generation = pool->generation;
        return;
    }
    slc_map_remove(map, key);
    slc_map_add(map, key, pool->generation);
}

uint32_t slc_page_share_drop(struct slc_page_pool *pool, const SluiceImageSource *source)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t first;
    while ((first = slc_shared_tiles_first_of(&pool->shared, source)) != SLC_NONE)
        unlist(pool, first);
    pool->generation += pool->generation == 0 || pool->generation_is_named;
    pool->generation_is_named = false;
    set_generation(pool, source);
    uint32_t generation = pool->generation;
    slc_mutex_unlock(&pool->mutex);
    return generation;
}

uint32_t slc_page_share_generation(struct slc_page_pool *pool, const SluiceImageSource *source)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t generation = SLC_MAP_NONE;
    if (pool->generations.count)
        generation = slc_map_get(&pool->generations, (uint64_t)(uintptr_t)source);
    if (generation == SLC_MAP_NONE || generation < pool->least_generation)
        generation = pool->least_generation;
    slc_mutex_unlock(&pool->mutex);
    return generation;
}
