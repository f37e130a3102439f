#include "vulkan/page_leaving.h"

#include "base/checked.h"
#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>


/* Counts the user's tiles on the page; 0 if another user holds it. */
static uint32_t count_tiles(const struct slc_page_pool *pool, const struct slc_page_layer *layer,
                            uint32_t user)
{
    if (!layer->shared)
        return layer->user == user;
    const struct slc_shared_tile *tile = &pool->shared.entries[layer->shared - 1];
    return tile->users == 1u << user ? tile->holds[user] : 0;
}

/* Number of tiles on the pages of the chunk; SLC_NONE if another user holds any of them, or if a
 * page has more than `most` tiles. */
static uint32_t count_own(const struct slc_page_pool *pool, const struct slc_page_chunk *chunk,
                          uint32_t user, uint32_t most)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < chunk->layer_count; i++) {
        const struct slc_page_layer *layer = &chunk->layers[i];
        if (!layer->held)
            continue;
        uint32_t tiles = count_tiles(pool, layer, user);
        if (tiles == 0 || tiles > most)
            return SLC_NONE;
        count += tiles;
    }
    return count;
}

/* The chunk with the fewest pages of those that the user alone holds, with at most `most` tiles on
 * each page. */
static uint32_t find_leaving(const struct slc_page_pool *pool, uint32_t user, uint32_t most)
{
    uint32_t best = SLC_NONE, fewest = SLC_NONE;
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[i];
        uint32_t held = chunk->layer_count - chunk->free_count;
        if (chunk->state != SLC_CHUNK_LIVE || chunk->fresh || held == 0 || held >= fewest ||
            !slc_page_chunk_is_ready(chunk, &pool->timelines, user) ||
            count_own(pool, chunk, user, most) == SLC_NONE)
            continue;
        best = i;
        fewest = held;
    }
    return best;
}

void slc_page_pool_stay(struct slc_page_pool *pool, uint32_t user)
{
    pthread_mutex_lock(&pool->mutex);
    if (pool->leaving_user == user)
        slc_page_pool_stay_locked(pool);
    pthread_mutex_unlock(&pool->mutex);
}

uint32_t slc_page_pool_leaving(struct slc_page_pool *pool, uint32_t user)
{
    pthread_mutex_lock(&pool->mutex);
    uint32_t leaving = pool->leaving_user == user ? pool->leaving : SLC_NONE;
    pthread_mutex_unlock(&pool->mutex);
    return leaving;
}

uint32_t slc_page_pool_held_in(struct slc_page_pool *pool, uint32_t user, uint32_t chunk)
{
    pthread_mutex_lock(&pool->mutex);
    const struct slc_page_chunk *c = &pool->chunks.at[chunk];
    uint32_t held = c->state == SLC_CHUNK_LIVE ? count_own(pool, c, user, UINT32_MAX) : 0;
    pthread_mutex_unlock(&pool->mutex);
    return held;
}

/* One front end at a time empties a chunk. */
static void choose_leaving(struct slc_page_pool *pool, uint32_t user)
{
    if (pool->leaving != SLC_NONE && pool->leaving_user == user &&
        count_own(pool, &pool->chunks.at[pool->leaving], user, 1) == SLC_NONE)
        slc_page_pool_stay_locked(pool);
    if (pool->leaving != SLC_NONE)
        return;
    pool->leaving = find_leaving(pool, user, 1);
    pool->leaving_user = user;
    if (pool->leaving != SLC_NONE)
        pool->chunks.at[pool->leaving].leaving = true;
}

uint32_t slc_page_pool_choose_leaving(struct slc_page_pool *pool, uint32_t user, uint32_t *held)
{
    uint32_t lacking = SLC_NONE;
    *held = 0;
    pthread_mutex_lock(&pool->mutex);
    choose_leaving(pool, user);
    if (pool->leaving != SLC_NONE && pool->leaving_user == user) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[pool->leaving];
        uint32_t room =
            slc_page_chunks_free_count(&pool->chunks, &pool->timelines, user, chunk->format);
        *held = chunk->layer_count - chunk->free_count;
        lacking = *held > room ? *held - room : 0;
    }
    pthread_mutex_unlock(&pool->mutex);
    return lacking;
}

bool slc_page_pool_has_unmovable(struct slc_page_pool *pool, uint32_t user)
{
    pthread_mutex_lock(&pool->mutex);
    bool has = pool->leaving == SLC_NONE && find_leaving(pool, user, UINT32_MAX) != SLC_NONE;
    pthread_mutex_unlock(&pool->mutex);
    return has;
}

/* Bytes beyond the user's own limit, of chunks that nobody else has pages in. */
static uint64_t own_excess(const struct slc_page_pool *pool, uint32_t user)
{
    uint64_t size = 0, limit = pool->users[user].max_size;
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[i];
        uint32_t own =
            chunk->state == SLC_CHUNK_LIVE ? count_own(pool, chunk, user, UINT32_MAX) : 0;
        if (own != 0 && own != SLC_NONE)
            size += (uint64_t)chunk->layer_count * SLC_TILE_SIZE;
    }
    return limit && size > limit ? size - limit : 0;
}

static uint64_t share_excess(const struct slc_page_pool *pool, uint32_t user, uint64_t excess)
{
    uint64_t all = 0, own = own_excess(pool, user);
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        all += own_excess(pool, i);
    return slc_min_u64(excess, own + (excess > all ? excess - all : 0));
}

uint64_t slc_page_pool_excess(struct slc_page_pool *pool, uint32_t user)
{
    pthread_mutex_lock(&pool->mutex);
    uint64_t limit = pool->chunks.max_size, size = pool->chunks.memory.total_size;
    uint64_t excess = limit && size > limit ? share_excess(pool, user, size - limit) : 0;
    pthread_mutex_unlock(&pool->mutex);
    return excess;
}

uint64_t slc_page_pool_going_size(struct slc_page_pool *pool)
{
    uint64_t pages = 0;
    pthread_mutex_lock(&pool->mutex);
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[i];
        bool goes = chunk->state == SLC_CHUNK_RETIRING ||
                    (chunk->state == SLC_CHUNK_LIVE && chunk->free_count == chunk->layer_count &&
                     !chunk->fresh);
        pages += goes ? chunk->layer_count : 0;
    }
    pthread_mutex_unlock(&pool->mutex);
    return pages * SLC_TILE_SIZE;
}

/* Moves the tile's entry in the directory to the new page. */
static void move_entry(struct slc_page_pool *pool, uint32_t from, uint32_t to)
{
    struct slc_page_layer *old = slc_page_layer(&pool->chunks, from);
    slc_page_layer(&pool->chunks, to)->shared = old->shared;
    if (old->shared)
        pool->shared.entries[old->shared - 1].page = to;
    old->shared = 0;
}

bool slc_page_pool_move(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint64_t frame,
                        uint32_t *to, struct slc_page_readers *readers)
{
    pthread_mutex_lock(&pool->mutex);
    uint32_t shared = slc_page_layer(&pool->chunks, from)->shared;
    struct slc_shared_tile *tile = shared ? &pool->shared.entries[shared - 1] : NULL;
    *to = SLUICE_PAGE_NONE;
    *readers = (struct slc_page_readers){tile ? tile->readers : 0, pool->timelines.tick};
    if (!tile || (tile->users == 1u << user && tile->holds[user] == 1))
        *to = slc_page_chunks_find(&pool->chunks, &pool->timelines, user,
                                   pool->chunks.at[from >> 16].format);
    /* Another thread may have made the image ready since this frame's array of views was filled. */
    if (*to != SLUICE_PAGE_NONE && !slc_page_views_has(&pool->users[user].shown, *to >> 16))
        *to = SLUICE_PAGE_NONE;
    if (*to != SLUICE_PAGE_NONE) {
        slc_page_pool_hold_locked(pool, user, *to);
        move_entry(pool, from, *to);
        if (tile) { /* others can take it when the copy is complete */
            tile->writer = (uint8_t)user;
            tile->written = true;
            tile->adopted = false;
            tile->value = frame;
        }
    }
    pthread_mutex_unlock(&pool->mutex);
    return *to != SLUICE_PAGE_NONE;
}

bool slc_page_pool_end_move(struct slc_page_pool *pool, uint32_t user, uint32_t from,
                            const struct slc_page_readers *readers)
{
    pthread_mutex_lock(&pool->mutex);
    bool over = slc_page_timelines_passed(&pool->timelines, readers->users, user, readers->tick);
    if (over)
        slc_page_pool_give_locked(pool, user, from, SLC_NO_OWNER);
    pthread_mutex_unlock(&pool->mutex);
    return over;
}

void slc_page_pool_move_back(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint32_t to)
{
    pthread_mutex_lock(&pool->mutex);
    uint32_t shared = slc_page_layer(&pool->chunks, to)->shared;
    move_entry(pool, to, from);
    if (shared) {
        struct slc_shared_tile *tile = &pool->shared.entries[shared - 1];
        tile->written = tile->adopted = true;
        tile->value = pool->timelines.of[user].recorded;
    }
    slc_page_pool_give_locked(pool, user, to, SLC_NO_OWNER);
    pthread_mutex_unlock(&pool->mutex);
}
