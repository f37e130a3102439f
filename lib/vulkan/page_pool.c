#include "vulkan/page_pool.h"

#include "base/checked.h"
#include "base/struct_size.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

SluiceResult slc_page_pool_init(struct slc_page_pool *pool, const struct slc_vk *vk,
                                const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                uint32_t chunk_count)
{
    *pool = (struct slc_page_pool){.vk = *vk, .cb = cb, .has_mutex = true};
    if (vk->memory_client) {
        slc_memory_client_init(&pool->client, vk->memory_client->budget);
        pool->vk.memory_client = &pool->client;
    }
    pool->shared.free = SLC_NONE;
    pool->leaving = SLC_NONE;
    slc_mutex_init(&pool->mutex);
    SluiceResult result = slc_page_views_init(&pool->views, &pool->vk, caps, cb, chunk_count);
    if (result != SLUICE_SUCCESS)
        return result;
    return slc_page_chunks_init(&pool->chunks, &pool->vk, caps, cb, chunk_count);
}

void slc_page_pool_finish(struct slc_page_pool *pool)
{
    assert(pool->timelines.user_count == 0);
    if (!pool->has_mutex)
        return;
    slc_page_chunks_finish(&pool->chunks);
    slc_shared_tiles_finish(&pool->shared, pool->cb);
    slc_map_finish(&pool->generations, pool->cb);
    slc_page_views_finish(&pool->views, &pool->vk, pool->cb);
    slc_memory_client_finish(&pool->client);
    slc_mutex_finish(&pool->mutex);
    *pool = (struct slc_page_pool){0};
}

/* Sets the pool's limit to the sum of the users' limits, if all users have one. */
static void sum_limits(struct slc_page_pool *pool)
{
    bool unlimited = false;
    uint64_t sum = 0;
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        if (!pool->timelines.of[i].semaphore)
            continue;
        unlimited |= pool->users[i].max_size == 0;
        sum += pool->users[i].max_size;
    }
    pool->chunks.max_size = unlimited ? 0 : sum;
}

/* Sets the images that the user's next frame sees in its array. Only calls of the user change the
 * array: its thread may read it while other users record. */
static void show_chunks(struct slc_page_pool *pool, uint32_t user)
{
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks.at[i];
        bool is_shown = chunk->state == SLC_CHUNK_LIVE &&
                        slc_page_chunk_is_ready(chunk, &pool->timelines, user);
        slc_page_views_set(&pool->users[user].shown, i, is_shown ? chunk->view : VK_NULL_HANDLE);
    }
}

SluiceResult slc_page_pool_write_views(struct slc_page_pool *pool, uint32_t user,
                                       SluiceVulkanPages *out)
{
    const struct slc_struct *type = SLC_STRUCT(SluiceVulkanPages);
    SluiceResult result = slc_struct_check(type, out, &pool->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_page_views *shown = &pool->users[user].shown;
    slc_mutex_lock(&pool->mutex);
    for (uint32_t i = 0; i < pool->chunks.count; i++)
        if (pool->chunks.at[i].state != SLC_CHUNK_LIVE)
            slc_page_views_set(shown, i, VK_NULL_HANDLE);
    slc_mutex_unlock(&pool->mutex);
    const SluiceVulkanPages pages = {.structSize = sizeof pages,
                                     .sampler = shown->sampler,
                                     .viewCount = shown->count,
                                     .pViews = shown->views,
                                     .generation = shown->generation};
    slc_struct_write(type, out, &pages);
    return SLUICE_SUCCESS;
}

SluiceResult slc_page_pool_add_user(struct slc_page_pool *pool, VkSemaphore semaphore,
                                    uint64_t max_size, struct slc_memory_client *client,
                                    uint32_t *user)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t at = slc_page_timelines_free_place(&pool->timelines);
    SluiceResult result = SLUICE_ERROR_LIMIT_EXCEEDED;
    if (at < SLC_MAX_PAGE_USERS)
        result = slc_page_views_copy(&pool->users[at].shown, &pool->views, pool->cb);
    if (result == SLUICE_SUCCESS) {
        slc_page_timelines_add(&pool->timelines, at, semaphore);
        pool->users[at].max_size = max_size;
        pool->users[at].client = client;
        slc_memory_client_set_source(client, &pool->client);
        show_chunks(pool, at);
        sum_limits(pool);
    }
    slc_mutex_unlock(&pool->mutex);
    if (result == SLUICE_SUCCESS)
        *user = at;
    return result;
}

void slc_page_pool_set_max_size(struct slc_page_pool *pool, uint32_t user, uint64_t max_size)
{
    slc_mutex_lock(&pool->mutex);
    pool->users[user].max_size = max_size;
    sum_limits(pool);
    slc_mutex_unlock(&pool->mutex);
}

bool slc_page_pool_is_refused(struct slc_page_pool *pool)
{
    slc_mutex_lock(&pool->mutex);
    bool refused = slc_page_chunks_is_refused(&pool->chunks, pool->timelines.tick);
    slc_mutex_unlock(&pool->mutex);
    return refused;
}

bool slc_page_pool_was_refused(struct slc_page_pool *pool)
{
    slc_mutex_lock(&pool->mutex);
    bool refused = pool->chunks.refused_tick > 0;
    slc_mutex_unlock(&pool->mutex);
    return refused;
}

/* Returns the pages that only other users hold. */
static uint32_t held_by_others(const struct slc_page_pool *pool, uint32_t user)
{
    return pool->held_count - pool->users[user].held_count;
}

uint32_t slc_page_pool_present(struct slc_page_pool *pool, uint32_t user)
{
    slc_mutex_lock(&pool->mutex);
    uint32_t count = slc_page_chunks_present(&pool->chunks), others = held_by_others(pool, user);
    count += pool->users[user].equal_count;
    slc_mutex_unlock(&pool->mutex);
    return count > others ? count - others : 0;
}

uint64_t slc_page_pool_capacity(struct slc_page_pool *pool, uint32_t user)
{
    slc_mutex_lock(&pool->mutex);
    uint64_t count = (uint64_t)slc_page_chunks_present(&pool->chunks) +
                     slc_page_chunks_room(&pool->chunks, pool->timelines.tick);
    uint64_t others = held_by_others(pool, user);
    slc_mutex_unlock(&pool->mutex);
    return count > others ? count - others : 0;
}

uint32_t slc_page_pool_free_count(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    uint32_t count = UINT32_MAX;
    const struct slc_page_chunks *chunks = &pool->chunks;
    slc_mutex_lock(&pool->mutex);
    uint64_t tick = pool->timelines.tick;
    if (chunks->refused_tick || chunks->max_size) {
        count = chunks->max_size ? slc_page_chunks_room(chunks, tick)
                                 : !slc_page_chunks_is_refused(chunks, tick);
        count += slc_page_chunks_free_count(chunks, &pool->timelines, user, format);
    }
    slc_mutex_unlock(&pool->mutex);
    return count;
}

static bool grow(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    uint64_t tick = pool->timelines.tick;
    if (!slc_page_chunks_can_grow(&pool->chunks, tick))
        return false;
    bool grown = slc_page_chunks_grow(&pool->chunks, tick, user, format);
    /* a smaller chunk than asked for counts as success */
    slc_memory_client_blame(&pool->client, grown ? NULL : pool->users[user].client);
    return grown;
}

void slc_page_pool_hold_locked(struct slc_page_pool *pool, uint32_t user, uint32_t page)
{
    slc_page_chunks_take(&pool->chunks, page, user);
    pool->held_count++;
    pool->users[user].held_count++;
}

uint32_t slc_page_pool_take(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    assert((uint32_t)format < SLC_PAGE_FORMATS);
    slc_mutex_lock(&pool->mutex);
    uint32_t page = slc_page_chunks_find(&pool->chunks, &pool->timelines, user, format);
    if (page == SLUICE_PAGE_NONE && grow(pool, user, format))
        page = slc_page_chunks_find(&pool->chunks, &pool->timelines, user, format);
    if (page != SLUICE_PAGE_NONE)
        slc_page_pool_hold_locked(pool, user, page);
    slc_mutex_unlock(&pool->mutex);
    return page;
}

/* Refused pages ahead of need are charged to no client. */
void slc_page_pool_prepare(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    slc_mutex_lock(&pool->mutex);
    slc_page_chunks_prepare(&pool->chunks, pool->timelines.tick, user, format);
    slc_memory_client_blame(&pool->client, NULL);
    slc_mutex_unlock(&pool->mutex);
}

static void free_page(struct slc_page_pool *pool, uint32_t page, uint32_t user, uint64_t value,
                      uint32_t owner)
{
    slc_page_chunks_free(&pool->chunks, page, user, value, owner);
    pool->held_count--;
}

/* Frees a shared page that no user holds and no frame of other users reads. */
static void end_shared(struct slc_page_pool *pool, uint32_t index, uint32_t owner)
{
    uint32_t page = pool->shared.entries[index].page, user = pool->shared.entries[index].last_user;
    bool is_there = user < SLC_MAX_PAGE_USERS;
    slc_shared_tiles_remove(&pool->shared, index);
    free_page(pool, page, is_there ? user : 0, is_there ? pool->timelines.of[user].recorded : 0,
              owner);
}

/* Ends the use of a shared page by a user that has no tile on it any more. */
static void release_shared(struct slc_page_pool *pool, uint32_t user, uint32_t index,
                           uint32_t owner)
{
    struct slc_shared_tile *tile = &pool->shared.entries[index];
    assert(tile->users & 1u << user);
    pool->users[user].held_count--;
    tile->holds[user] = 0;
    tile->users &= ~(1u << user);
    if (tile->users) { /* users that took it after the writer's copy was complete */
        if (tile->writer == user)
            tile->writer = SLC_MAX_PAGE_USERS;
        struct slc_page_layer *layer = slc_page_layer(&pool->chunks, tile->page);
        layer->user = (uint8_t)slc_log2_u32(tile->users);
        layer->value = 0;
        return;
    }
    tile->last_user = (uint8_t)user;
    slc_shared_tiles_unlist(&pool->shared, index);
    if (slc_page_timelines_are_idle(&pool->timelines, tile->readers, user)) {
        end_shared(pool, index, owner);
    } else {
        tile->going = true;
        tile->value = pool->timelines.tick;
        pool->shared.going_count++;
    }
}

void slc_page_pool_give_locked(struct slc_page_pool *pool, uint32_t user, uint32_t page,
                               uint32_t owner)
{
    uint32_t shared = slc_page_layer(&pool->chunks, page)->shared;
    if (shared && --pool->shared.entries[shared - 1].holds[user] > 0) {
        pool->users[user].equal_count--; /* other tiles of the user are on the page */
        return;
    }
    if (shared) {
        release_shared(pool, user, shared - 1, owner);
        return;
    }
    pool->users[user].held_count--;
    free_page(pool, page, user, pool->timelines.of[user].recorded, owner);
}

static void end_going(struct slc_page_pool *pool)
{
    for (uint32_t i = 0; pool->shared.going_count && i < pool->shared.high; i++) {
        const struct slc_shared_tile *tile = &pool->shared.entries[i];
        if (tile->going && slc_page_timelines_passed(&pool->timelines, tile->readers,
                                                     tile->last_user, tile->value))
            end_shared(pool, i, SLC_NO_OWNER);
    }
}

void slc_page_pool_give(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner)
{
    slc_mutex_lock(&pool->mutex);
    slc_page_pool_give_locked(pool, user, page, owner);
    slc_mutex_unlock(&pool->mutex);
}

/* Gives back all pages of the user except shared ones, which leave_shared gives back. */
static void give_all(struct slc_page_pool *pool, uint32_t user)
{
    for (uint32_t i = 0; i < pool->chunks.count; i++)
        for (uint32_t j = 0; j < pool->chunks.at[i].layer_count; j++) {
            const struct slc_page_layer *layer = &pool->chunks.at[i].layers[j];
            if (layer->user == user && layer->held && !layer->shared)
                slc_page_pool_give_locked(pool, user, i << 16 | j, SLC_NO_OWNER);
        }
}

/* Leaves shared pages. Pages that the user copied stay if other users show tiles from them. */
static void leave_shared(struct slc_page_pool *pool, uint32_t user)
{
    for (uint32_t i = 0; i < pool->shared.high; i++) {
        struct slc_shared_tile *tile = &pool->shared.entries[i];
        if (tile->listed && tile->page == SLC_NONE && tile->writer == user)
            slc_shared_tiles_remove(&pool->shared, i);
        if (tile->users & 1u << user)
            release_shared(pool, user, i, SLC_NO_OWNER);
        if (tile->writer == user)
            tile->writer = SLC_MAX_PAGE_USERS;
        if (tile->going && tile->last_user == user)
            tile->last_user = SLC_MAX_PAGE_USERS;
        tile->readers &= ~(1u << user);
    }
}

void slc_page_pool_stay_locked(struct slc_page_pool *pool)
{
    if (pool->leaving != SLC_NONE)
        pool->chunks.at[pool->leaving].leaving = false;
    pool->leaving = SLC_NONE;
}

void slc_page_pool_remove_user(struct slc_page_pool *pool, uint32_t user)
{
    slc_mutex_lock(&pool->mutex);
    leave_shared(pool, user);
    give_all(pool, user);
    slc_page_chunks_drop_user(&pool->chunks, user);
    pool->empty_is_ready |= pool->users[user].empty_frame > 0;
    assert(pool->users[user].held_count == 0);
    if (pool->leaving_user == user)
        slc_page_pool_stay_locked(pool);
    slc_memory_client_set_source(pool->users[user].client, NULL);
    slc_page_views_finish_copy(&pool->users[user].shown, pool->cb);
    pool->users[user] = (struct slc_page_user){0};
    slc_page_timelines_remove(&pool->timelines, user);
    sum_limits(pool);
    slc_mutex_unlock(&pool->mutex);
}

bool slc_page_pool_retake(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner)
{
    slc_mutex_lock(&pool->mutex);
    bool there = slc_page_chunks_is_left(&pool->chunks, page, user, owner);
    if (there) {
        struct slc_page_layer *layer = slc_page_layer(&pool->chunks, page);
        const struct slc_page_layer left = *layer;
        slc_page_pool_hold_locked(pool, user, page);
        layer->value = left.value; /* the texels stay */
        layer->moved = left.moved;
    }
    slc_mutex_unlock(&pool->mutex);
    return there;
}

void slc_page_pool_hurry(struct slc_page_pool *pool)
{
    slc_mutex_lock(&pool->mutex);
    pool->hurry = true;
    slc_mutex_unlock(&pool->mutex);
}

void slc_page_pool_ask_again(struct slc_page_pool *pool)
{
    slc_mutex_lock(&pool->mutex);
    pool->chunks.has_freed = true;
    slc_mutex_unlock(&pool->mutex);
}

void slc_page_pool_record(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                          uint64_t completed_frame, VkCommandBuffer commands)
{
    struct slc_page_chunks *chunks = &pool->chunks;
    slc_mutex_lock(&pool->mutex);
    slc_page_timelines_advance(&pool->timelines, &pool->vk, user, completed_frame);
    end_going(pool);
    for (uint32_t i = 0; i < chunks->count; i++) {
        slc_page_chunks_end_retired(chunks, i, &pool->timelines);
        slc_page_chunks_retire(chunks, i, &pool->timelines, pool->hurry);
    }
    if (pool->leaving != SLC_NONE && chunks->at[pool->leaving].state != SLC_CHUNK_LIVE)
        slc_page_pool_stay_locked(pool); /* the chunk is empty */
    slc_page_timelines_record(&pool->timelines, user, frame);
    for (uint32_t i = 0; i < chunks->count; i++)
        slc_page_chunks_record(chunks, i, &pool->timelines, user, commands);
    show_chunks(pool, user);
    pool->hurry = false;
    slc_mutex_unlock(&pool->mutex);
}

void slc_page_pool_record_empty(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                                VkCommandBuffer commands)
{
    slc_mutex_lock(&pool->mutex);
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        uint64_t empty_frame = pool->users[i].empty_frame;
        pool->empty_is_ready |=
            empty_frame && slc_page_timelines_reached(&pool->timelines, i, empty_frame);
    }
    if (!pool->empty_is_ready) {
        slc_page_views_record(&pool->views, &pool->vk, commands);
        pool->users[user].empty_frame = frame;
    }
    slc_mutex_unlock(&pool->mutex);
}

static void abandon_shared(struct slc_page_pool *pool, uint32_t user, uint64_t frame, uint64_t last)
{
    for (uint32_t i = 0; i < pool->shared.high; i++) {
        struct slc_shared_tile *tile = &pool->shared.entries[i];
        if (tile->writer != user || tile->going || tile->value < frame)
            continue;
        if (tile->adopted)
            tile->value = last;
        else
            tile->written = false; /* the user copies it again, or gives it back */
    }
}

void slc_page_pool_abandon(struct slc_page_pool *pool, uint32_t user, uint64_t frame)
{
    slc_mutex_lock(&pool->mutex);
    if (pool->users[user].empty_frame >= frame)
        pool->users[user].empty_frame = 0;
    slc_page_timelines_abandon(&pool->timelines, user, frame);
    uint64_t last = pool->timelines.of[user].recorded;
    slc_page_chunks_abandon(&pool->chunks, user, frame, last);
    abandon_shared(pool, user, frame, last);
    slc_mutex_unlock(&pool->mutex);
}

struct slc_page_pool_counts slc_page_pool_get_counts(struct slc_page_pool *pool)
{
    slc_mutex_lock(&pool->mutex);
    struct slc_page_pool_counts counts = {.tile_memory_size =
                                              slc_memory_client_tiles(&pool->client),
                                          .chunk_count = pool->chunks.image_count,
                                          .shortages = pool->chunks.shortages};
    slc_memory_client_get(&pool->client, &counts.device_memory_size, NULL);
    slc_mutex_unlock(&pool->mutex);
    return counts;
}
