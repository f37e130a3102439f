#include "vulkan/page_pool.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "vulkan/format.h"
#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#define MIN_LAYERS 64u    /* 4 MiB */
#define IDLE_TICKS 60u    /* that an empty chunk is kept */
#define REFUSED_TICKS 60u /* until the device is asked for memory again */

uint64_t slc_page_chunks_capacity(uint32_t chunk_count, uint32_t max_image_array_layers)
{
    uint64_t most = slc_min_u32(SLC_PAGE_CHUNK_LAYERS, max_image_array_layers), count = 0;
    for (uint32_t i = 0; i < chunk_count; i++) {
        uint64_t layers = count > MIN_LAYERS ? count : MIN_LAYERS;
        count += layers < most ? layers : most;
    }
    return count;
}

SluiceResult slc_page_pool_init(struct slc_page_pool *pool, const struct slc_vk *vk,
                                const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                uint32_t chunk_count)
{
    *pool = (struct slc_page_pool){.vk = *vk, .caps = caps, .cb = cb, .has_mutex = true};
    pool->memory.purpose = SLUICE_DEVICE_MEMORY_PURPOSE_PAGES;
    if (vk->memory_client) {
        slc_memory_client_init(&pool->client, vk->memory_client->budget);
        pool->vk.memory_client = &pool->client;
    }
    pool->shared.free = SLC_NONE;
    pthread_mutex_init(&pool->mutex, NULL);
    pool->max_layer_count = slc_min_u32(SLC_PAGE_CHUNK_LAYERS, caps->max_image_array_layers);
    SluiceResult result = slc_page_views_init(&pool->views, &pool->vk, caps, cb, chunk_count);
    if (result != SLUICE_SUCCESS)
        return result;
    pool->chunks = slc_calloc(cb, chunk_count, sizeof *pool->chunks);
    return pool->chunks ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static void destroy_chunk(struct slc_page_pool *pool, struct slc_page_chunk *chunk)
{
    if (chunk->view)
        pool->vk.DestroyImageView(pool->vk.device, chunk->view, NULL);
    slc_plain_image_destroy(&chunk->image, &pool->memory, &pool->vk, pool->cb);
    slc_free(pool->cb, chunk->layers, chunk->layer_count + 1, sizeof *chunk->layers);
    *chunk = (struct slc_page_chunk){0};
}

void slc_page_pool_finish(struct slc_page_pool *pool)
{
    assert(pool->user_count == 0);
    for (uint32_t i = 0; pool->chunks && i < pool->views.count; i++)
        destroy_chunk(pool, &pool->chunks[i]);
    if (!pool->has_mutex)
        return;
    slc_shared_tiles_finish(&pool->shared, pool->cb);
    slc_image_memory_finish(&pool->memory, pool->cb);
    slc_free(pool->cb, pool->chunks, pool->views.count, sizeof *pool->chunks);
    slc_page_views_finish(&pool->views, &pool->vk, pool->cb);
    slc_memory_client_finish(&pool->client);
    pthread_mutex_destroy(&pool->mutex);
    *pool = (struct slc_page_pool){0};
}

/* The pool's limit is the sum of its users', if all of them have one. */
static void sum_limits(struct slc_page_pool *pool)
{
    bool unlimited = false;
    pool->max_size = 0;
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        unlimited |= pool->users[i].semaphore && pool->users[i].max_size == 0;
        pool->max_size += pool->users[i].semaphore ? pool->users[i].max_size : 0;
    }
    if (unlimited)
        pool->max_size = 0;
}

/* New chunks belong to their maker until its layout transition is over. */
static bool is_ready(const struct slc_page_pool *pool, const struct slc_page_chunk *chunk,
                     uint32_t user)
{
    if (chunk->maker == user)
        return true;
    if (chunk->maker == SLC_MAX_PAGE_USERS)
        return !chunk->fresh;
    return chunk->layout_frame && pool->users[chunk->maker].completed >= chunk->layout_frame;
}

/* Images that shaders of the user's next frame may find in its array. */
static void show_chunks(struct slc_page_pool *pool, uint32_t user)
{
    for (uint32_t i = 0; i < pool->views.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks[i];
        if (chunk->state == SLC_CHUNK_LIVE && is_ready(pool, chunk, user))
            slc_page_views_set(&pool->users[user].shown, i, chunk->view);
    }
}

SluiceResult slc_page_pool_add_user(struct slc_page_pool *pool, VkSemaphore semaphore,
                                    uint64_t max_size, struct slc_memory_client *client,
                                    uint32_t *user)
{
    uint32_t at = 0;
    pthread_mutex_lock(&pool->mutex);
    while (at < SLC_MAX_PAGE_USERS && pool->users[at].semaphore)
        at++;
    SluiceResult result = SLUICE_ERROR_LIMIT_EXCEEDED;
    if (at < SLC_MAX_PAGE_USERS)
        result = slc_page_views_copy(&pool->users[at].shown, &pool->views, pool->cb);
    if (result == SLUICE_SUCCESS) {
        pool->users[at].semaphore = semaphore;
        pool->users[at].max_size = max_size;
        pool->users[at].client = client;
        for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) /* of the last one in this place */
            pool->users[i].seen[at] = pool->users[i].still[at] = 0;
        slc_memory_client_set_source(client, &pool->client);
        pool->user_count++;
        show_chunks(pool, at);
        sum_limits(pool);
    }
    pthread_mutex_unlock(&pool->mutex);
    if (result == SLUICE_SUCCESS)
        *user = at;
    return result;
}

static SluiceResult create_chunk(struct slc_page_pool *pool, struct slc_page_chunk *chunk,
                                 SluiceFormat format, uint32_t layer_count)
{
    SluiceImageInfo info = {
        .structSize = sizeof info, .mipLevelCount = 1, .format = format, .pName = "pages"};
    SluiceResult result = sluiceGetStandardTileShape(format, &info.width, &info.height);
    if (result != SLUICE_SUCCESS)
        return result;
    *chunk = (struct slc_page_chunk){.format = format, .layer_count = layer_count, .fresh = true};
    chunk->layers = slc_alloc(pool->cb, layer_count + 1, sizeof *chunk->layers);
    if (!chunk->layers)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i <= layer_count; i++)
        chunk->layers[i] = (struct slc_page_layer){.previous = (uint16_t)(i ? i - 1 : layer_count),
                                                   .next = (uint16_t)(i < layer_count ? i + 1 : 0),
                                                   .owner = SLC_NO_OWNER};
    chunk->free_count = layer_count;
    result = slc_plain_image_create(&chunk->image, &pool->memory, &pool->vk, pool->caps, pool->cb,
                                    &info, 0, layer_count);
    if (result == SLUICE_SUCCESS)
        result = slc_create_array_view(&pool->vk, chunk->image.image, slc_vk_format(format),
                                       &chunk->view);
    return result;
}

static bool is_refused(const struct slc_page_pool *pool)
{
    return pool->refused_tick && !pool->has_freed &&
           pool->tick < pool->refused_tick + REFUSED_TICKS;
}

bool slc_page_pool_is_refused(struct slc_page_pool *pool)
{
    pthread_mutex_lock(&pool->mutex);
    bool refused = is_refused(pool);
    pthread_mutex_unlock(&pool->mutex);
    return refused;
}

bool slc_page_pool_was_refused(struct slc_page_pool *pool)
{
    pthread_mutex_lock(&pool->mutex);
    bool refused = pool->refused_tick > 0;
    pthread_mutex_unlock(&pool->mutex);
    return refused;
}

static uint32_t present(const struct slc_page_pool *pool)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SLC_PAGE_FORMATS; i++)
        count += pool->page_count[i];
    return count;
}

/* Pages that the user does not hold, and others do. */
static uint32_t held_by_others(const struct slc_page_pool *pool, uint32_t user)
{
    return pool->held_count - pool->users[user].held_count;
}

uint32_t slc_page_pool_present(struct slc_page_pool *pool, uint32_t user)
{
    pthread_mutex_lock(&pool->mutex);
    uint32_t count = present(pool), others = held_by_others(pool, user);
    pthread_mutex_unlock(&pool->mutex);
    return count > others ? count - others : 0;
}

static uint32_t find_free_chunk(const struct slc_page_pool *pool)
{
    uint32_t at = 0;
    while (at < pool->views.count && pool->chunks[at].state != SLC_CHUNK_FREE)
        at++;
    return at;
}

/* By the cap alone; small chunks share blocks of memory that are larger than they are. */
static uint32_t layers_left(const struct slc_page_pool *pool)
{
    if (!pool->max_size)
        return UINT32_MAX;
    uint64_t used = pool->memory.total_size;
    uint64_t left = pool->max_size > used ? (pool->max_size - used) / SLC_TILE_SIZE : 0;
    return left < MIN_LAYERS ? 0 : (uint32_t)(left < UINT32_MAX ? left : UINT32_MAX);
}

/* Pages that chunks could still be made for, by max_size and the number of views. */
static uint32_t room(const struct slc_page_pool *pool)
{
    uint64_t most = 0;
    for (uint32_t i = 0; i < pool->views.count; i++)
        most += pool->chunks[i].state == SLC_CHUNK_FREE ? pool->max_layer_count : 0;
    uint32_t left = is_refused(pool) ? 0 : layers_left(pool);
    return most < left ? (uint32_t)most : left;
}

uint64_t slc_page_pool_capacity(struct slc_page_pool *pool, uint32_t user)
{
    pthread_mutex_lock(&pool->mutex);
    uint64_t count = (uint64_t)present(pool) + room(pool), others = held_by_others(pool, user);
    pthread_mutex_unlock(&pool->mutex);
    return count > others ? count - others : 0;
}

/* The one that was given back longest ago, of those that the user may write to; layer_count if
 * there is none. */
static uint32_t find_layer(const struct slc_page_pool *pool, const struct slc_page_chunk *chunk,
                           uint32_t user)
{
    uint32_t head = chunk->layer_count, at = head;
    if (chunk->free_count == 0 || !is_ready(pool, chunk, user))
        return head;
    while ((at = chunk->layers[at].next) != head) {
        const struct slc_page_layer *layer = &chunk->layers[at];
        if (layer->user == user || layer->value <= pool->users[layer->user].completed)
            return at;
    }
    return head;
}

static uint32_t count_layers(const struct slc_page_pool *pool, const struct slc_page_chunk *chunk,
                             uint32_t user)
{
    uint32_t head = chunk->layer_count, count = 0;
    if (pool->user_count <= 1)
        return chunk->free_count;
    if (!is_ready(pool, chunk, user))
        return 0;
    for (uint32_t at = chunk->layers[head].next; at != head; at = chunk->layers[at].next)
        count += chunk->layers[at].user == user ||
                 chunk->layers[at].value <= pool->users[chunk->layers[at].user].completed;
    return count;
}

uint32_t slc_page_pool_free_count(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    uint32_t count = UINT32_MAX;
    pthread_mutex_lock(&pool->mutex);
    if (pool->refused_tick || pool->max_size) {
        count = pool->max_size ? room(pool) : !is_refused(pool);
        for (uint32_t i = 0; i < pool->views.count; i++) {
            const struct slc_page_chunk *chunk = &pool->chunks[i];
            if (chunk->state == SLC_CHUNK_LIVE && chunk->format == format)
                count += count_layers(pool, chunk, user);
        }
    }
    pthread_mutex_unlock(&pool->mutex);
    return count;
}

/* Drivers may ask for more than the texels need. */
static bool is_beyond_cap(const struct slc_page_pool *pool)
{
    return pool->max_size && pool->memory.total_size > pool->max_size;
}

static void tell_of_shortage(struct slc_page_pool *pool, SluiceFormat format)
{
    if (pool->shortages++ == 0)
        slc_log(&pool->vk.log, SLUICE_LOG_WARNING,
                "all maxPageChunkCount %u images of pages are in use: no more than %u tiles of %s, "
                "finer ones will not be loaded",
                pool->views.count, pool->page_count[format], sluiceFormatString(format));
}

/* As many pages again as the format has; fewer where the device has no memory for them. */
static bool add_chunk(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    uint32_t at = find_free_chunk(pool), left = layers_left(pool);
    if (is_refused(pool) || left == 0)
        return false;
    if (at == pool->views.count)
        tell_of_shortage(pool, format);
    uint32_t layers = slc_max_u32(MIN_LAYERS, pool->page_count[format]);
    layers = slc_min_u32(layers, slc_min_u32(left, pool->max_layer_count));
    if (at == pool->views.count)
        layers = 0;
    bool capped = false;
    for (; layers > 0; layers -= capped ? 1 + layers / MIN_LAYERS : (layers + 1) / 2) {
        struct slc_page_chunk *chunk = &pool->chunks[at];
        bool created = create_chunk(pool, chunk, format, layers) == SLUICE_SUCCESS;
        capped = created && is_beyond_cap(pool);
        if (created && !capped) {
            chunk->state = SLC_CHUNK_LIVE;
            chunk->maker = (uint8_t)user;
            pool->chunk_count++;
            pool->page_count[format] += layers;
            pool->last_chunk[format] = at;
            pool->refused_tick = 0;
            slc_memory_client_blame(&pool->client, NULL); /* a smaller one will do */
            return true;
        }
        destroy_chunk(pool, chunk);
        if (capped && layers <= MIN_LAYERS / 2)
            break;
    }
    slc_memory_client_blame(&pool->client, pool->users[user].client);
    pool->refused_tick = pool->tick + 1;
    pool->has_freed = false;
    return false;
}

/* The fullest with a page for the user, so that others run empty. */
static bool find_chunk(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    uint32_t best = UINT32_MAX;
    for (uint32_t i = 0; i < pool->views.count; i++) {
        const struct slc_page_chunk *chunk = &pool->chunks[i];
        if (chunk->state == SLC_CHUNK_LIVE && chunk->format == format && chunk->free_count &&
            (best == UINT32_MAX || chunk->free_count < pool->chunks[best].free_count) &&
            find_layer(pool, chunk, user) < chunk->layer_count)
            best = i;
    }
    if (best == UINT32_MAX)
        return false;
    pool->last_chunk[format] = best;
    return true;
}

static void take_layer(struct slc_page_pool *pool, struct slc_page_chunk *chunk, uint32_t user,
                       uint32_t layer)
{
    struct slc_page_layer *taken = &chunk->layers[layer];
    chunk->layers[taken->previous].next = taken->next;
    chunk->layers[taken->next].previous = taken->previous;
    taken->owner = SLC_NO_OWNER; /* nobody can take it again */
    taken->user = (uint8_t)user;
    taken->held = true;
    taken->shared = 0;
    chunk->free_count--;
    pool->held_count++;
    pool->users[user].held_count++;
}

static uint32_t take(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    const struct slc_page_chunk *last = &pool->chunks[pool->last_chunk[format]];
    bool there = last->state == SLC_CHUNK_LIVE && last->format == format &&
                 find_layer(pool, last, user) < last->layer_count;
    if (!there && !find_chunk(pool, user, format) && !add_chunk(pool, user, format))
        return SLUICE_PAGE_NONE;
    uint32_t index = pool->last_chunk[format];
    struct slc_page_chunk *chunk = &pool->chunks[index];
    uint32_t layer = find_layer(pool, chunk, user);
    take_layer(pool, chunk, user, layer);
    return index << 16 | layer;
}

uint32_t slc_page_pool_take(struct slc_page_pool *pool, uint32_t user, SluiceFormat format)
{
    assert((uint32_t)format < SLC_PAGE_FORMATS);
    pthread_mutex_lock(&pool->mutex);
    uint32_t page = take(pool, user, format);
    pthread_mutex_unlock(&pool->mutex);
    return page;
}

/* `value`: the last frame of `user` that may read it. */
static void free_layer(struct slc_page_pool *pool, uint32_t page, uint32_t user, uint64_t value,
                       uint32_t owner)
{
    struct slc_page_chunk *chunk = &pool->chunks[page >> 16];
    assert(chunk->state == SLC_CHUNK_LIVE && chunk->free_count < chunk->layer_count);
    uint16_t layer = (uint16_t)(page & 0xFFFFu), head = (uint16_t)chunk->layer_count;
    struct slc_page_layer *layers = chunk->layers;
    layers[layer] = (struct slc_page_layer){.previous = layers[head].previous,
                                            .next = head,
                                            .owner = owner,
                                            .value = value,
                                            .user = (uint8_t)user};
    layers[layers[head].previous].next = layer;
    layers[head].previous = layer;
    chunk->free_count++;
    pool->held_count--;
}

/* Nobody holds the page and no frame of others reads it. */
static void end_shared(struct slc_page_pool *pool, uint32_t index, uint32_t owner)
{
    uint32_t page = pool->shared.entries[index].page, user = pool->shared.entries[index].last_user;
    bool is_there = user < SLC_MAX_PAGE_USERS;
    slc_shared_tiles_remove(&pool->shared, index);
    free_layer(pool, page, is_there ? user : 0, is_there ? pool->users[user].recorded : 0, owner);
}

static bool others_are_idle(const struct slc_page_pool *pool, const struct slc_shared_tile *tile)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        if (tile->readers & 1u << i && i != tile->last_user &&
            pool->users[i].completed < pool->users[i].recorded)
            return false;
    return true;
}

static void release_shared(struct slc_page_pool *pool, uint32_t user, uint32_t index,
                           uint32_t owner)
{
    struct slc_shared_tile *tile = &pool->shared.entries[index];
    assert(tile->users & 1u << user);
    tile->users &= ~(1u << user);
    if (tile->users) { /* who took it after the writer saw its copy complete */
        if (tile->writer == user)
            tile->writer = SLC_MAX_PAGE_USERS;
        slc_page_layer(pool, tile->page)->user = (uint8_t)slc_log2_u32(tile->users);
        return;
    }
    tile->last_user = (uint8_t)user;
    slc_shared_tiles_unlist(&pool->shared, index);
    if (others_are_idle(pool, tile)) {
        end_shared(pool, index, owner);
    } else {
        tile->going = true;
        tile->value = pool->tick;
        pool->shared.going_count++;
    }
}

static void give(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner)
{
    uint32_t shared = slc_page_layer(pool, page)->shared;
    pool->users[user].held_count--;
    if (shared)
        release_shared(pool, user, shared - 1, owner);
    else
        free_layer(pool, page, user, pool->users[user].recorded, owner);
}

static bool has_gone(const struct slc_page_pool *pool, const struct slc_shared_tile *tile)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        if (tile->readers & 1u << i && i != tile->last_user &&
            pool->users[i].safe_tick < tile->value)
            return false;
    return true;
}

static void end_going(struct slc_page_pool *pool)
{
    for (uint32_t i = 0; pool->shared.going_count && i < pool->shared.high; i++)
        if (pool->shared.entries[i].going && has_gone(pool, &pool->shared.entries[i]))
            end_shared(pool, i, SLC_NO_OWNER);
}

void slc_page_pool_give(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner)
{
    pthread_mutex_lock(&pool->mutex);
    give(pool, user, page, owner);
    pthread_mutex_unlock(&pool->mutex);
}

/* Its place may be another's next: no value of its timeline may stay. */
static void forget_user(struct slc_page_pool *pool, uint32_t index, uint32_t user)
{
    struct slc_page_chunk *chunk = &pool->chunks[index];
    chunk->retire_values[user] = 0;
    if (chunk->maker == user) {
        chunk->maker = SLC_MAX_PAGE_USERS;
        chunk->layout_frame = 0;
    }
    for (uint32_t i = 0; i < chunk->layer_count; i++)
        if (chunk->layers[i].user == user) {
            if (chunk->layers[i].held && !chunk->layers[i].shared)
                give(pool, user, index << 16 | i, SLC_NO_OWNER);
            chunk->layers[i].value = 0;
            chunk->layers[i].owner = SLC_NO_OWNER;
        }
}

/* Tiles that others show from a page that the user copied stay. */
static void leave_shared(struct slc_page_pool *pool, uint32_t user)
{
    for (uint32_t i = 0; i < pool->shared.high; i++) {
        struct slc_shared_tile *tile = &pool->shared.entries[i];
        if (tile->listed && tile->page == SLC_NONE && tile->writer == user)
            slc_shared_tiles_remove(&pool->shared, i);
        if (tile->users & 1u << user) {
            pool->users[user].held_count--;
            release_shared(pool, user, i, SLC_NO_OWNER);
        }
        if (tile->writer == user)
            tile->writer = SLC_MAX_PAGE_USERS;
        if (tile->going && tile->last_user == user)
            tile->last_user = SLC_MAX_PAGE_USERS;
        tile->readers &= ~(1u << user);
    }
}

void slc_page_pool_remove_user(struct slc_page_pool *pool, uint32_t user)
{
    pthread_mutex_lock(&pool->mutex);
    leave_shared(pool, user);
    for (uint32_t i = 0; i < pool->views.count; i++)
        forget_user(pool, i, user);
    pool->empty_is_ready |= pool->users[user].empty_frame > 0;
    assert(pool->users[user].held_count == 0);
    slc_memory_client_set_source(pool->users[user].client, NULL);
    slc_page_views_finish_copy(&pool->users[user].shown, pool->cb);
    pool->users[user] = (struct slc_page_user){0};
    pool->user_count--;
    sum_limits(pool);
    pthread_mutex_unlock(&pool->mutex);
}

static bool retake(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner)
{
    struct slc_page_chunk *chunk = &pool->chunks[page >> 16];
    uint32_t layer = page & 0xFFFFu;
    /* another chunk may be there by now, and smaller */
    if (chunk->state != SLC_CHUNK_LIVE || layer >= chunk->layer_count ||
        chunk->layers[layer].owner != owner || chunk->layers[layer].user != user ||
        chunk->layers[layer].held)
        return false;
    take_layer(pool, chunk, user, layer);
    return true;
}

bool slc_page_pool_retake(struct slc_page_pool *pool, uint32_t user, uint32_t page, uint32_t owner)
{
    pthread_mutex_lock(&pool->mutex);
    bool there = retake(pool, user, page, owner);
    pthread_mutex_unlock(&pool->mutex);
    return there;
}

void slc_page_pool_hurry(struct slc_page_pool *pool)
{
    pthread_mutex_lock(&pool->mutex);
    pool->hurry = true;
    pthread_mutex_unlock(&pool->mutex);
}

static void retire(struct slc_page_pool *pool, uint32_t index)
{
    struct slc_page_chunk *chunk = &pool->chunks[index];
    if (chunk->free_count < chunk->layer_count || chunk->tick == 0) /* 0: new, and still empty */
        chunk->tick = pool->tick;
    if (pool->tick - chunk->tick < (pool->hurry ? 1 : IDLE_TICKS))
        return;
    chunk->state = SLC_CHUNK_RETIRING;
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        chunk->retire_values[i] = pool->users[i].recorded;
    pool->page_count[chunk->format] -= chunk->layer_count;
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        if (pool->users[i].semaphore)
            slc_page_views_set(&pool->users[i].shown, index, VK_NULL_HANDLE);
}

static bool is_over(const struct slc_page_pool *pool, const struct slc_page_chunk *chunk)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        if (chunk->retire_values[i] > pool->users[i].completed)
            return false;
    return true;
}

/* What the other users' frames have finished: their pages can be taken, their chunks destroyed. */
static void poll_others(struct slc_page_pool *pool, uint32_t user)
{
    for (uint32_t i = 0; pool->user_count > 1 && i < SLC_MAX_PAGE_USERS; i++) {
        uint64_t value = 0;
        struct slc_page_user *other = &pool->users[i];
        if (i != user && other->semaphore &&
            pool->vk.GetSemaphoreCounterValue(pool->vk.device, other->semaphore, &value) ==
                VK_SUCCESS &&
            value > other->completed)
            other->completed = value;
    }
}

/* After polling: up to which tick each user's frames are complete. */
static void advance_safe_ticks(struct slc_page_pool *pool)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        struct slc_page_user *user = &pool->users[i];
        if (user->completed >= user->recorded) {
            user->safe_tick = pool->tick;
            user->mark_frame = 0;
        } else if (user->mark_frame && user->completed >= user->mark_frame) {
            user->safe_tick = user->mark_tick;
            user->mark_frame = 0;
        }
        if (user->completed < user->recorded && user->mark_frame == 0) {
            user->mark_frame = user->recorded;
            user->mark_tick = pool->tick;
        }
    }
}

/* Whether the others go on, as the user sees it. */
static void look_at_others(struct slc_page_pool *pool, struct slc_page_user *self)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        uint64_t progress = pool->users[i].recorded + pool->users[i].completed;
        self->still[i] = progress == self->seen[i] ? self->still[i] + 1 : 0;
        self->seen[i] = progress;
    }
}

static void record_layout(struct slc_page_pool *pool, struct slc_page_chunk *chunk, uint32_t user,
                          VkCommandBuffer commands)
{
    if (chunk->maker == SLC_MAX_PAGE_USERS)
        chunk->maker = (uint8_t)user;
    if (chunk->maker != user)
        return;
    slc_record_general_layout(&pool->vk, commands, chunk->image.image);
    chunk->layout_frame = pool->users[user].recorded;
    chunk->fresh = false;
}

void slc_page_pool_record(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                          uint64_t completed_frame, VkCommandBuffer commands)
{
    pthread_mutex_lock(&pool->mutex);
    struct slc_page_user *self = &pool->users[user];
    self->completed = completed_frame > self->completed ? completed_frame : self->completed;
    poll_others(pool, user);
    advance_safe_ticks(pool);
    look_at_others(pool, self);
    end_going(pool);
    pool->tick++;
    for (uint32_t i = 0; i < pool->views.count; i++) {
        struct slc_page_chunk *chunk = &pool->chunks[i];
        if (chunk->state == SLC_CHUNK_LIVE) {
            retire(pool, i);
        } else if (chunk->state == SLC_CHUNK_RETIRING && is_over(pool, chunk)) {
            destroy_chunk(pool, chunk);
            pool->chunk_count--;
            pool->has_freed = true;
        }
    }
    self->recorded = self->frames[self->frame_count++ % SLC_PAGE_FRAMES] = frame;
    for (uint32_t i = 0; i < pool->views.count; i++)
        if (pool->chunks[i].state == SLC_CHUNK_LIVE && pool->chunks[i].fresh)
            record_layout(pool, &pool->chunks[i], user, commands);
    show_chunks(pool, user);
    pool->hurry = false;
    pthread_mutex_unlock(&pool->mutex);
}

void slc_page_pool_record_empty(struct slc_page_pool *pool, uint32_t user, uint64_t frame,
                                VkCommandBuffer commands)
{
    pthread_mutex_lock(&pool->mutex);
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        const struct slc_page_user *other = &pool->users[i];
        pool->empty_is_ready |= other->empty_frame && other->empty_frame <= other->completed;
    }
    if (!pool->empty_is_ready) {
        slc_page_views_record(&pool->views, &pool->vk, commands);
        pool->users[user].empty_frame = frame;
    }
    pthread_mutex_unlock(&pool->mutex);
}

/* They will never be complete: nothing may wait for them. */
static void forget_frames(struct slc_page_pool *pool, uint32_t index, uint64_t frame)
{
    struct slc_page_user *user = &pool->users[index];
    while (user->frame_count && user->frames[(user->frame_count - 1) % SLC_PAGE_FRAMES] >= frame)
        user->frame_count--;
    uint64_t last = user->frame_count ? user->frames[(user->frame_count - 1) % SLC_PAGE_FRAMES] : 0;
    user->recorded = last;
    user->mark_frame = 0;
    for (uint32_t i = 0; i < pool->views.count; i++) {
        struct slc_page_chunk *chunk = &pool->chunks[i];
        if (chunk->retire_values[index] > last)
            chunk->retire_values[index] = last;
        for (uint32_t j = 0; j < chunk->layer_count; j++)
            if (chunk->layers[j].user == index && chunk->layers[j].value > last)
                chunk->layers[j].value = last;
    }
}

void slc_page_pool_abandon(struct slc_page_pool *pool, uint32_t user, uint64_t frame)
{
    pthread_mutex_lock(&pool->mutex);
    if (pool->users[user].empty_frame >= frame)
        pool->users[user].empty_frame = 0;
    forget_frames(pool, user, frame);
    for (uint32_t i = 0; i < pool->views.count; i++) {
        struct slc_page_chunk *chunk = &pool->chunks[i];
        if (chunk->state != SLC_CHUNK_LIVE || chunk->maker != user || chunk->layout_frame < frame)
            continue;
        chunk->fresh = true;
        chunk->layout_frame = 0;
    }
    for (uint32_t i = 0; i < pool->shared.high; i++) {
        struct slc_shared_tile *tile = &pool->shared.entries[i];
        if (tile->writer != user || tile->going || tile->value < frame)
            continue;
        if (tile->adopted)
            tile->value = pool->users[user].recorded;
        else
            tile->written = false; /* copied again, or given back */
    }
    pthread_mutex_unlock(&pool->mutex);
}

struct slc_page_pool_counts slc_page_pool_get_counts(struct slc_page_pool *pool)
{
    pthread_mutex_lock(&pool->mutex);
    struct slc_page_pool_counts counts = {.tile_memory_size = pool->memory.total_size,
                                          .chunk_count = pool->chunk_count,
                                          .shortages = pool->shortages};
    slc_memory_client_get(&pool->client, &counts.device_memory_size, NULL);
    pthread_mutex_unlock(&pool->mutex);
    return counts;
}
