#include "vulkan/page_cache.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "vulkan/format.h"
#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#define MIN_LAYERS 64u     /* 4 MiB */
#define IDLE_FRAMES 60u    /* that an empty chunk is kept */
#define REFUSED_FRAMES 60u /* until the device is asked for memory again */

uint64_t slc_page_chunks_capacity(uint32_t chunk_count, uint32_t max_image_array_layers)
{
    uint64_t most = slc_min_u32(SLC_PAGE_CHUNK_LAYERS, max_image_array_layers), count = 0;
    for (uint32_t i = 0; i < chunk_count; i++) {
        uint64_t layers = count > MIN_LAYERS ? count : MIN_LAYERS;
        count += layers < most ? layers : most;
    }
    return count;
}

SluiceResult slc_page_cache_init(struct slc_page_cache *cache, const struct slc_vk *vk,
                                 const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                 struct slc_page_views *views)
{
    *cache = (struct slc_page_cache){.vk = vk, .caps = caps, .cb = cb, .views = views};
    cache->max_layer_count = slc_min_u32(SLC_PAGE_CHUNK_LAYERS, caps->max_image_array_layers);
    cache->chunks = slc_calloc(cb, views->count, sizeof *cache->chunks);
    return cache->chunks ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static void destroy_chunk(struct slc_page_cache *cache, struct slc_page_chunk *chunk)
{
    if (chunk->view)
        cache->vk->DestroyImageView(cache->vk->device, chunk->view, NULL);
    slc_plain_image_destroy(&chunk->image, &cache->memory, cache->vk, cache->cb);
    slc_free(cache->cb, chunk->layers, chunk->layer_count + 1, sizeof *chunk->layers);
    *chunk = (struct slc_page_chunk){0};
}

void slc_page_cache_finish(struct slc_page_cache *cache)
{
    if (!cache->chunks)
        return;
    for (uint32_t i = 0; i < cache->views->count; i++)
        destroy_chunk(cache, &cache->chunks[i]);
    slc_image_memory_finish(&cache->memory, cache->cb);
    slc_free(cache->cb, cache->chunks, cache->views->count, sizeof *cache->chunks);
    *cache = (struct slc_page_cache){0};
}

static SluiceResult create_chunk(struct slc_page_cache *cache, struct slc_page_chunk *chunk,
                                 SluiceFormat format, uint32_t layer_count)
{
    SluiceImageInfo info = {.mipLevelCount = 1, .format = format, .pName = "pages"};
    SluiceResult result = sluiceGetStandardTileShape(format, &info.width, &info.height);
    if (result != SLUICE_SUCCESS)
        return result;
    *chunk = (struct slc_page_chunk){.format = format, .layer_count = layer_count, .fresh = true};
    chunk->layers = slc_alloc(cache->cb, layer_count + 1, sizeof *chunk->layers);
    if (!chunk->layers)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i <= layer_count; i++)
        chunk->layers[i] =
            (struct slc_page_layer){(uint16_t)(i ? i - 1 : layer_count),
                                    (uint16_t)(i < layer_count ? i + 1 : 0), SLC_NO_OWNER};
    chunk->free_count = layer_count;
    result = slc_plain_image_create(&chunk->image, &cache->memory, cache->vk, cache->caps,
                                    cache->cb, &info, 0, layer_count);
    if (result == SLUICE_SUCCESS)
        result = slc_create_array_view(cache->vk, chunk->image.image, slc_vk_format(format),
                                       &chunk->view);
    return result;
}

bool slc_page_cache_is_refused(const struct slc_page_cache *cache)
{
    return cache->refused_frame && !cache->has_freed &&
           cache->frame < cache->refused_frame + REFUSED_FRAMES;
}

uint32_t slc_page_cache_layer_count(const struct slc_page_cache *cache)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SLC_PAGE_FORMATS; i++)
        count += cache->page_count[i];
    return count;
}

static uint32_t find_free_chunk(const struct slc_page_cache *cache)
{
    uint32_t at = 0;
    while (at < cache->views->count && cache->chunks[at].state != SLC_CHUNK_FREE)
        at++;
    return at;
}

/* By the cap alone; small chunks share blocks of memory that are larger than they are. */
static uint32_t layers_left(const struct slc_page_cache *cache)
{
    if (!cache->max_size)
        return UINT32_MAX;
    uint64_t used = cache->memory.total_size;
    uint64_t left = cache->max_size > used ? (cache->max_size - used) / SLC_TILE_SIZE : 0;
    return left < MIN_LAYERS ? 0 : (uint32_t)(left < UINT32_MAX ? left : UINT32_MAX);
}

uint32_t slc_page_cache_room(const struct slc_page_cache *cache)
{
    uint64_t most = 0;
    for (uint32_t i = 0; i < cache->views->count; i++)
        most += cache->chunks[i].state == SLC_CHUNK_FREE ? cache->max_layer_count : 0;
    uint32_t left = slc_page_cache_is_refused(cache) ? 0 : layers_left(cache);
    return most < left ? (uint32_t)most : left;
}

uint32_t slc_page_cache_free_count(const struct slc_page_cache *cache, SluiceFormat format)
{
    if (!cache->refused_frame)
        return UINT32_MAX;
    uint32_t count = !slc_page_cache_is_refused(cache);
    for (uint32_t i = 0; i < cache->views->count; i++) {
        const struct slc_page_chunk *chunk = &cache->chunks[i];
        if (chunk->state == SLC_CHUNK_LIVE && chunk->format == format)
            count += chunk->free_count;
    }
    return count;
}

/* Drivers may ask for more than the texels need. */
static bool is_beyond_cap(const struct slc_page_cache *cache)
{
    return cache->max_size && cache->memory.total_size > cache->max_size;
}

static void tell_of_shortage(struct slc_page_cache *cache, SluiceFormat format)
{
    if (cache->shortages++ == 0)
        slc_log(&cache->vk->log, SLUICE_LOG_WARNING,
                "all maxPageChunkCount %u images of pages are in use: no more than %u tiles of %s, "
                "finer ones will not be loaded",
                cache->views->count, cache->page_count[format], sluiceFormatString(format));
}

/* As many pages again as the format has; fewer where the device has no memory for them. */
static bool add_chunk(struct slc_page_cache *cache, SluiceFormat format)
{
    uint32_t at = find_free_chunk(cache), left = layers_left(cache);
    if (slc_page_cache_is_refused(cache) || left == 0)
        return false;
    if (at == cache->views->count)
        tell_of_shortage(cache, format);
    uint32_t layers = slc_max_u32(MIN_LAYERS, cache->page_count[format]);
    layers = slc_min_u32(layers, slc_min_u32(left, cache->max_layer_count));
    if (at == cache->views->count)
        layers = 0;
    bool capped = false;
    for (; layers > 0; layers -= capped ? 1 + layers / MIN_LAYERS : (layers + 1) / 2) {
        struct slc_page_chunk *chunk = &cache->chunks[at];
        bool created = create_chunk(cache, chunk, format, layers) == SLUICE_SUCCESS;
        capped = created && is_beyond_cap(cache);
        if (created && !capped) {
            chunk->state = SLC_CHUNK_LIVE;
            cache->chunk_count++;
            cache->page_count[format] += layers;
            cache->last_chunk[format] = at;
            cache->refused_frame = 0;
            slc_page_views_set(cache->views, at, chunk->view);
            return true;
        }
        destroy_chunk(cache, chunk);
        if (capped && layers <= MIN_LAYERS / 2)
            break;
    }
    cache->refused_frame = cache->frame + 1;
    cache->has_freed = false;
    return false;
}

/* The fullest with a free page, so that others run empty. */
static bool find_chunk(struct slc_page_cache *cache, SluiceFormat format)
{
    uint32_t best = UINT32_MAX;
    for (uint32_t i = 0; i < cache->views->count; i++) {
        const struct slc_page_chunk *chunk = &cache->chunks[i];
        if (chunk->state == SLC_CHUNK_LIVE && chunk->format == format && chunk->free_count &&
            (best == UINT32_MAX || chunk->free_count < cache->chunks[best].free_count))
            best = i;
    }
    if (best == UINT32_MAX)
        return false;
    cache->last_chunk[format] = best;
    return true;
}

static void take_layer(struct slc_page_chunk *chunk, uint32_t layer)
{
    struct slc_page_layer *taken = &chunk->layers[layer];
    chunk->layers[taken->previous].next = taken->next;
    chunk->layers[taken->next].previous = taken->previous;
    taken->owner = SLC_NO_OWNER; /* nobody can take it again */
    chunk->free_count--;
}

uint32_t slc_page_cache_take(struct slc_page_cache *cache, SluiceFormat format)
{
    assert((uint32_t)format < SLC_PAGE_FORMATS);
    const struct slc_page_chunk *last = &cache->chunks[cache->last_chunk[format]];
    bool there = last->state == SLC_CHUNK_LIVE && last->format == format && last->free_count;
    if (!there && !find_chunk(cache, format) && !add_chunk(cache, format))
        return SLUICE_PAGE_NONE;
    uint32_t index = cache->last_chunk[format];
    struct slc_page_chunk *chunk = &cache->chunks[index];
    uint32_t layer = chunk->layers[chunk->layer_count].next; /* was given back longest ago */
    take_layer(chunk, layer);
    return index << 16 | layer;
}

void slc_page_cache_give(struct slc_page_cache *cache, uint32_t page, uint32_t owner)
{
    struct slc_page_chunk *chunk = &cache->chunks[page >> 16];
    assert(chunk->state == SLC_CHUNK_LIVE && chunk->free_count < chunk->layer_count);
    uint16_t layer = (uint16_t)(page & 0xFFFFu), head = (uint16_t)chunk->layer_count;
    struct slc_page_layer *layers = chunk->layers;
    layers[layer] = (struct slc_page_layer){layers[head].previous, head, owner};
    layers[layers[head].previous].next = layer;
    layers[head].previous = layer;
    chunk->free_count++;
}

bool slc_page_cache_retake(struct slc_page_cache *cache, uint32_t page, uint32_t owner)
{
    struct slc_page_chunk *chunk = &cache->chunks[page >> 16];
    uint32_t layer = page & 0xFFFFu;
    /* another chunk may be there by now, and smaller */
    if (chunk->state != SLC_CHUNK_LIVE || layer >= chunk->layer_count ||
        chunk->layers[layer].owner != owner)
        return false;
    take_layer(chunk, layer);
    return true;
}

static void retire(struct slc_page_cache *cache, uint32_t index)
{
    struct slc_page_chunk *chunk = &cache->chunks[index];
    if (chunk->free_count < chunk->layer_count)
        chunk->frame = cache->frame;
    if (chunk->frame == 0)
        chunk->frame = cache->frame; /* new, and empty after all */
    if (cache->frame - chunk->frame < (cache->hurry ? 1 : IDLE_FRAMES))
        return;
    chunk->state = SLC_CHUNK_RETIRING;
    chunk->frame = cache->frame;
    cache->page_count[chunk->format] -= chunk->layer_count;
    slc_page_views_set(cache->views, index, VK_NULL_HANDLE);
}

void slc_page_cache_record(struct slc_page_cache *cache, uint64_t frame, uint64_t completed_frame,
                           VkCommandBuffer commands)
{
    cache->frame = frame;
    for (uint32_t i = 0; i < cache->views->count; i++) {
        struct slc_page_chunk *chunk = &cache->chunks[i];
        if (chunk->state == SLC_CHUNK_LIVE)
            retire(cache, i);
        else if (chunk->state == SLC_CHUNK_RETIRING && chunk->frame <= completed_frame + 1) {
            destroy_chunk(cache, chunk);
            cache->chunk_count--;
            cache->has_freed = true;
        }
        if (chunk->state == SLC_CHUNK_LIVE && chunk->fresh) {
            slc_record_general_layout(cache->vk, commands, chunk->image.image);
            chunk->layout_frame = frame;
        }
        chunk->fresh = false;
    }
    cache->hurry = false;
}

void slc_page_cache_abandon(struct slc_page_cache *cache, uint64_t frame)
{
    for (uint32_t i = 0; i < cache->views->count; i++) {
        struct slc_page_chunk *chunk = &cache->chunks[i];
        chunk->fresh |= chunk->state == SLC_CHUNK_LIVE && chunk->layout_frame >= frame;
    }
}
