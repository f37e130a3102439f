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

/* Counts the tiles on the chunk's pages; SLC_NONE if another user holds any of them. */
static uint32_t count_own(const struct slc_page_pool *pool, const struct slc_page_chunk *chunk,
                          uint32_t user)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < chunk->layer_count; i++) {
        const struct slc_page_layer *layer = &chunk->layers[i];
        if (!layer->held)
            continue;
        uint32_t tiles = count_tiles(pool, layer, user);
        if (tiles == 0)
            return SLC_NONE;
        count += tiles;
    }
    return count;
}

/* Cost of emptying a chunk, and memory that it frees, in pages. */
struct candidate {
    uint32_t index;
    uint32_t held;    ///< pages whose tiles move
    uint32_t lacking; ///< tiles that must be evicted, because others of the format have no room
    uint32_t useful;  ///< pages of memory that are freed, up to the number required
};

/* Prefers few evictions for much memory. Among equal candidates the larger chunk is first: emptying
 * small ones first would leave a large one that exceeds the limit. */
static bool is_better(const struct candidate *a, const struct candidate *b)
{
    int64_t cost_a = (int64_t)a->lacking - a->useful, cost_b = (int64_t)b->lacking - b->useful;
    if (cost_a != cost_b)
        return cost_a < cost_b;
    return a->useful != b->useful ? a->useful > b->useful : a->held < b->held;
}

static bool can_leave(const struct slc_page_pool *pool, const struct slc_page_chunk *chunk,
                      uint32_t user)
{
    return chunk->state == SLC_CHUNK_LIVE && !chunk->fresh &&
           chunk->free_count < chunk->layer_count &&
           slc_page_chunk_is_ready(chunk, &pool->timelines, user) &&
           count_own(pool, chunk, user) != SLC_NONE;
}

/* Finds the best chunk among those that only this user holds. `needed`: pages of memory to free. */
static uint32_t find_leaving(const struct slc_page_pool *pool, uint32_t user, uint64_t needed)
{
    uint32_t free_of[SLC_PAGE_FORMATS] = {0};
    struct candidate best = {.index = SLC_NONE};
    for (uint32_t i = 0; i < pool->chunks.count; i++)
        if (pool->chunks.at[i].state == SLC_CHUNK_LIVE)
            free_of[pool->chunks.at[i].format] +=
                slc_page_chunk_free_count(&pool->chunks.at[i], &pool->timelines, user);
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[i];
        if (!can_leave(pool, chunk, user))
            continue;
        uint32_t room =
            free_of[chunk->format] - slc_page_chunk_free_count(chunk, &pool->timelines, user);
        struct candidate c = {.index = i,
                              .held = chunk->layer_count - chunk->free_count,
                              .useful = (uint32_t)slc_min_u64(needed, chunk->layer_count)};
        c.lacking = c.held > room ? c.held - room : 0;
        if (best.index == SLC_NONE || is_better(&c, &best))
            best = c;
    }
    return best.index;
}

void slc_page_pool_stay(struct slc_page_pool *pool, uint32_t user)
{
    slc_mutex_lock(&pool->mutex);
    if (pool->leaving_user == user)
        slc_page_pool_stay_locked(pool);
    slc_mutex_unlock(&pool->mutex);
}

uint32_t slc_page_pool_leaving(struct slc_page_pool *pool, uint32_t user)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t leaving = pool->leaving_user == user ? pool->leaving : SLC_NONE;
    slc_mutex_unlock(&pool->mutex);
    return leaving;
}

uint32_t slc_page_pool_held_in(struct slc_page_pool *pool, uint32_t user, uint32_t chunk)
{
    slc_mutex_lock(&pool->mutex);
    const struct slc_page_chunk *c = &pool->chunks.at[chunk];
    uint32_t held = c->state == SLC_CHUNK_LIVE ? count_own(pool, c, user) : 0;
    slc_mutex_unlock(&pool->mutex);
    return held;
}

/* Only one front end at a time empties a chunk. */
static void choose_leaving(struct slc_page_pool *pool, uint32_t user, uint64_t size)
{
    if (pool->leaving != SLC_NONE && pool->leaving_user == user &&
        count_own(pool, &pool->chunks.at[pool->leaving], user) == SLC_NONE)
        slc_page_pool_stay_locked(pool);
    if (pool->leaving != SLC_NONE)
        return;
    pool->leaving = find_leaving(pool, user, size / SLC_TILE_SIZE + (size % SLC_TILE_SIZE > 0));
    pool->leaving_user = user;
    if (pool->leaving != SLC_NONE)
        pool->chunks.at[pool->leaving].leaving = true;
}

uint32_t slc_page_pool_choose_leaving(struct slc_page_pool *pool, uint32_t user, uint64_t size,
                                      uint32_t *held)
{
    uint32_t lacking = SLC_NONE;
    *held = 0;
    slc_mutex_lock(&pool->mutex);
    choose_leaving(pool, user, size);
    if (pool->leaving != SLC_NONE && pool->leaving_user == user) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[pool->leaving];
        uint32_t room =
            slc_page_chunks_free_count(&pool->chunks, &pool->timelines, user, chunk->format);
        *held = chunk->layer_count - chunk->free_count;
        lacking = *held > room ? *held - room : 0;
    }
    slc_mutex_unlock(&pool->mutex);
    return lacking;
}

/* Returns the bytes beyond the user's limit, of chunks in which no other user has pages. */
static uint64_t own_excess(const struct slc_page_pool *pool, uint32_t user)
{
    uint64_t size = 0, limit = pool->users[user].max_size;
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[i];
        uint32_t own = chunk->state == SLC_CHUNK_LIVE ? count_own(pool, chunk, user) : 0;
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
    slc_mutex_lock(&pool->mutex);
    uint64_t limit = pool->chunks.max_size, size = pool->chunks.memory.total_size;
    uint64_t excess = limit && size > limit ? share_excess(pool, user, size - limit) : 0;
    slc_mutex_unlock(&pool->mutex);
    return excess;
}

uint64_t slc_page_pool_going_size(struct slc_page_pool *pool)
{
    uint64_t pages = 0;
    slc_mutex_lock(&pool->mutex);
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[i];
        bool goes = chunk->state == SLC_CHUNK_RETIRING ||
                    (chunk->state == SLC_CHUNK_LIVE && chunk->free_count == chunk->layer_count &&
                     !chunk->fresh);
        pages += goes ? chunk->layer_count : 0;
    }
    slc_mutex_unlock(&pool->mutex);
    return pages * SLC_TILE_SIZE;
}

uint32_t slc_page_pool_tiles_on(struct slc_page_pool *pool, uint32_t user, uint32_t page)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t count = count_tiles(pool, slc_page_layer(&pool->chunks, page), user);
    slc_mutex_unlock(&pool->mutex);
    return count;
}

/* Moves the tiles' entry in the directory to the new page. */
static void move_entry(struct slc_page_pool *pool, uint32_t from, uint32_t to)
{
    struct slc_page_layer *old = slc_page_layer(&pool->chunks, from);
    slc_page_layer(&pool->chunks, to)->shared = old->shared;
    if (old->shared)
        pool->shared.entries[old->shared - 1].page = to;
    old->shared = 0;
}

static struct slc_shared_tile *entry_of(struct slc_page_pool *pool, uint32_t page)
{
    uint32_t shared = slc_page_layer(&pool->chunks, page)->shared;
    return shared ? &pool->shared.entries[shared - 1] : NULL;
}

/* True if only this user holds the page, and the copy of its texels is complete. If a frame with a
 * pending copy were abandoned, the copy would be repeated to the old page. */
static bool can_move(const struct slc_page_pool *pool, uint32_t user, uint32_t page,
                     const struct slc_shared_tile *tile)
{
    const struct slc_page_layer *layer = slc_page_layer(&pool->chunks, page);
    return slc_page_timelines_reached(&pool->timelines, user, layer->value) &&
           (!tile || (tile->users == 1u << user && tile->written));
}

/* Finds a page in an image that the user's array of views already has: another thread may have made
 * an image ready since the array was filled. */
static uint32_t find_target(struct slc_page_pool *pool, uint32_t user, uint32_t from)
{
    uint32_t to = slc_page_chunks_find(&pool->chunks, &pool->timelines, user,
                                       pool->chunks.at[from >> 16].format);
    bool shown = to != SLUICE_PAGE_NONE && slc_page_views_has(&pool->users[user].shown, to >> 16);
    return shown ? to : SLUICE_PAGE_NONE;
}

bool slc_page_pool_move(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint64_t frame,
                        uint32_t *to, struct slc_page_readers *readers)
{
    slc_mutex_lock(&pool->mutex);
    struct slc_shared_tile *tile = entry_of(pool, from);
    *readers = (struct slc_page_readers){tile ? tile->readers : 0, pool->timelines.tick};
    *to = can_move(pool, user, from, tile) ? find_target(pool, user, from) : SLUICE_PAGE_NONE;
    if (*to != SLUICE_PAGE_NONE) {
        slc_page_pool_hold_locked(pool, user, *to);
        move_entry(pool, from, *to);
        slc_page_layer(&pool->chunks, *to)->value = frame;
        slc_page_layer(&pool->chunks, *to)->moved = true;
        if (tile) { /* other users can take it when the copy is complete */
            tile->writer = (uint8_t)user;
            tile->adopted = false;
            tile->value = frame;
        }
    }
    slc_mutex_unlock(&pool->mutex);
    return *to != SLUICE_PAGE_NONE;
}

bool slc_page_pool_end_move(struct slc_page_pool *pool, uint32_t user, uint32_t from,
                            const struct slc_page_readers *readers)
{
    slc_mutex_lock(&pool->mutex);
    bool over = slc_page_timelines_passed(&pool->timelines, readers->users, user, readers->tick);
    if (over)
        slc_page_pool_give_locked(pool, user, from, SLC_NO_OWNER);
    slc_mutex_unlock(&pool->mutex);
    return over;
}

/* True if the page still has tiles that a move put there. */
static bool has_moved(const struct slc_page_pool *pool, uint32_t user, uint32_t page,
                      const struct slc_shared_tile *tile)
{
    const struct slc_page_layer *layer = slc_page_layer(&pool->chunks, page);
    return layer->moved && layer->held && layer->user == user &&
           (!tile || tile->users & 1u << user);
}

bool slc_page_pool_move_back(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint32_t to)
{
    slc_mutex_lock(&pool->mutex);
    struct slc_shared_tile *tile = entry_of(pool, to);
    struct slc_page_layer *layer = slc_page_layer(&pool->chunks, to);
    bool there = has_moved(pool, user, to, tile);
    if (there) {
        move_entry(pool, to, from);
        if (tile) {
            tile->written = tile->adopted = true;
            tile->value = pool->timelines.of[user].recorded;
        }
    } else if (layer->moved && !layer->held) {
        layer->owner = SLC_NO_OWNER; /* its texels were never copied */
    }
    slc_page_pool_give_locked(pool, user, there ? to : from, SLC_NO_OWNER);
    slc_mutex_unlock(&pool->mutex);
    return there;
}
