#include "vulkan/page_chunks.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "vulkan/format.h"
#include "vulkan/page_views.h"
#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#define MIN_LAYERS 64u    /* 4 MiB */
#define IDLE_TICKS 60u    /* ticks for which an empty chunk is kept */
#define REFUSED_TICKS 60u /* ticks until the device is asked for memory again */

uint64_t slc_page_chunks_capacity(uint32_t chunk_count, uint32_t max_image_array_layers)
{
    uint64_t most = slc_min_u32(SLC_PAGE_CHUNK_LAYERS, max_image_array_layers), count = 0;
    for (uint32_t i = 0; i < chunk_count; i++) {
        uint64_t layers = count > MIN_LAYERS ? count : MIN_LAYERS;
        count += slc_min_u64(layers, most);
    }
    return count;
}

SluiceResult slc_page_chunks_init(struct slc_page_chunks *chunks, const struct slc_vk *vk,
                                  const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                  uint32_t count)
{
    *chunks = (struct slc_page_chunks){
        .vk = vk,
        .caps = caps,
        .cb = cb,
        .max_layer_count = slc_min_u32(SLC_PAGE_CHUNK_LAYERS, caps->max_image_array_layers),
        .memory.purpose = SLUICE_DEVICE_MEMORY_PURPOSE_PAGES};
    chunks->at = slc_calloc(cb, count, sizeof *chunks->at);
    if (!chunks->at)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    chunks->count = count;
    return SLUICE_SUCCESS;
}

static void destroy_chunk(struct slc_page_chunks *chunks, struct slc_page_chunk *chunk)
{
    if (chunk->view)
        chunks->vk->DestroyImageView(chunks->vk->device, chunk->view, NULL);
    slc_plain_image_destroy(&chunk->image, &chunks->memory, chunks->vk, chunks->cb);
    slc_free(chunks->cb, chunk->layers, chunk->layer_count + 1, sizeof *chunk->layers);
    *chunk = (struct slc_page_chunk){0};
}

void slc_page_chunks_finish(struct slc_page_chunks *chunks)
{
    for (uint32_t i = 0; i < chunks->count; i++)
        destroy_chunk(chunks, &chunks->at[i]);
    slc_image_memory_finish(&chunks->memory, chunks->cb);
    slc_free(chunks->cb, chunks->at, chunks->count, sizeof *chunks->at);
    *chunks = (struct slc_page_chunks){0};
}

static SluiceResult create_chunk(struct slc_page_chunks *chunks, struct slc_page_chunk *chunk,
                                 SluiceFormat format, uint32_t layer_count)
{
    SluiceImageInfo info = {.structSize = sizeof info,
                            .mipLevelCount = 1,
                            .format = slc_page_texel_format(format),
                            .pName = "pages"};
    SluiceResult result = sluiceGetStandardTileShape(info.format, &info.width, &info.height);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_image_use use = {.produced = format & SLC_PAGE_PRODUCED};
    *chunk = (struct slc_page_chunk){.format = format, .layer_count = layer_count, .fresh = true};
    chunk->layers = slc_alloc(chunks->cb, layer_count + 1, sizeof *chunk->layers);
    if (!chunk->layers)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i <= layer_count; i++)
        chunk->layers[i] = (struct slc_page_layer){.previous = (uint16_t)(i ? i - 1 : layer_count),
                                                   .next = (uint16_t)(i < layer_count ? i + 1 : 0),
                                                   .owner = SLC_NO_OWNER};
    chunk->free_count = layer_count;
    result = slc_plain_image_create(&chunk->image, &chunks->memory, chunks->vk, chunks->caps,
                                    chunks->cb, &info, 0, layer_count, &use);
    if (result == SLUICE_SUCCESS)
        result = slc_create_array_view(chunks->vk, chunk->image.image, slc_vk_format(info.format),
                                       &chunk->view);
    return result;
}

bool slc_page_chunks_is_refused(const struct slc_page_chunks *chunks, uint64_t tick)
{
    return chunks->refused_tick && !chunks->has_freed &&
           tick < chunks->refused_tick + REFUSED_TICKS;
}

uint32_t slc_page_chunks_present(const struct slc_page_chunks *chunks)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SLC_PAGE_FORMATS; i++)
        count += chunks->page_count[i];
    return count;
}

/* Returns the layers that max_size allows. Counts whole blocks of memory, which small chunks share.
 */
static uint32_t layers_left(const struct slc_page_chunks *chunks)
{
    if (!chunks->max_size)
        return UINT32_MAX;
    uint64_t used = chunks->memory.total_size;
    uint64_t left = chunks->max_size > used ? (chunks->max_size - used) / SLC_TILE_SIZE : 0;
    return left < MIN_LAYERS ? 0 : (uint32_t)slc_min_u64(left, UINT32_MAX);
}

uint32_t slc_page_chunks_room(const struct slc_page_chunks *chunks, uint64_t tick)
{
    uint64_t most = 0;
    for (uint32_t i = 0; i < chunks->count; i++)
        most += chunks->at[i].state == SLC_CHUNK_FREE ? chunks->max_layer_count : 0;
    uint32_t left = slc_page_chunks_is_refused(chunks, tick) ? 0 : layers_left(chunks);
    return (uint32_t)slc_min_u64(most, left);
}

bool slc_page_chunks_can_grow(const struct slc_page_chunks *chunks, uint64_t tick)
{
    return !slc_page_chunks_is_refused(chunks, tick) && layers_left(chunks) > 0;
}

static uint32_t find_free_chunk(const struct slc_page_chunks *chunks)
{
    uint32_t at = 0;
    while (at < chunks->count && chunks->at[at].state != SLC_CHUNK_FREE)
        at++;
    return at;
}

/* True if chunks exceed max_size. Drivers may require more memory than the texels take. */
static bool is_beyond_cap(const struct slc_page_chunks *chunks)
{
    return chunks->max_size && chunks->memory.total_size > chunks->max_size;
}

static void log_shortage(struct slc_page_chunks *chunks, SluiceFormat format)
{
    if (chunks->shortages++ == 0)
        slc_log(&chunks->vk->log, SLUICE_LOG_WARNING,
                "all maxPageChunkCount %u images of pages are in use: no more than %u tiles of %s, "
                "finer ones will not be loaded",
                chunks->count, chunks->page_count[format],
                sluiceGetFormatName(slc_page_texel_format(format)));
}

/* Tries fewer and fewer layers until the device has memory and max_size holds. Returns the number
 * of layers; 0: none. */
static uint32_t create_largest(struct slc_page_chunks *chunks, struct slc_page_chunk *chunk,
                               SluiceFormat format, uint32_t layers)
{
    bool capped = false;
    for (; layers > 0; layers -= capped ? 1 + layers / MIN_LAYERS : (layers + 1) / 2) {
        bool created = create_chunk(chunks, chunk, format, layers) == SLUICE_SUCCESS;
        capped = created && is_beyond_cap(chunks);
        if (created && !capped)
            return layers;
        destroy_chunk(chunks, chunk);
        if (capped && layers <= MIN_LAYERS / 2)
            break;
    }
    return 0;
}

/* Makes a chunk of `wanted` layers or fewer. */
static bool make_chunk(struct slc_page_chunks *chunks, uint64_t tick, uint32_t user,
                       SluiceFormat format, uint32_t wanted)
{
    uint32_t at = find_free_chunk(chunks), layers = 0;
    if (at == chunks->count) {
        log_shortage(chunks, format);
    } else {
        layers = slc_min_u32(wanted, slc_min_u32(layers_left(chunks), chunks->max_layer_count));
        layers = create_largest(chunks, &chunks->at[at], format, layers);
    }
    if (layers == 0) {
        chunks->refused_tick = tick + 1;
        chunks->has_freed = false;
        return false;
    }
    chunks->at[at].state = SLC_CHUNK_LIVE;
    chunks->at[at].maker = (uint8_t)user;
    chunks->image_count++;
    chunks->page_count[format] += layers;
    chunks->last[format] = at;
    chunks->refused_tick = 0;
    return true;
}

bool slc_page_chunks_grow(struct slc_page_chunks *chunks, uint64_t tick, uint32_t user,
                          SluiceFormat format)
{
    return make_chunk(chunks, tick, user, format,
                      slc_max_u32(MIN_LAYERS, chunks->page_count[format]));
}

/* A failure here leaves no user without a page, so `refused_tick` is restored. */
void slc_page_chunks_prepare(struct slc_page_chunks *chunks, uint64_t tick, uint32_t user,
                             SluiceFormat format)
{
    uint64_t refused_tick = chunks->refused_tick;
    uint32_t layers = 0, made = 0;
    if (slc_page_chunks_is_refused(chunks, tick) || tick < chunks->next_prepare_tick)
        return;
    while (made == layers && chunks->memory.total_size < chunks->kept_size &&
           find_free_chunk(chunks) < chunks->count && slc_page_chunks_can_grow(chunks, tick)) {
        uint64_t left = (chunks->kept_size - chunks->memory.total_size) / SLC_TILE_SIZE;
        layers = (uint32_t)slc_min_u64(left, chunks->max_layer_count);
        layers = slc_min_u32(slc_max_u32(layers, MIN_LAYERS), layers_left(chunks));
        made = make_chunk(chunks, tick, user, format, layers)
                   ? chunks->at[chunks->last[format]].layer_count
                   : 0;
    }
    if (layers > 0 && made == 0)
        chunks->next_prepare_tick = tick + REFUSED_TICKS;
    chunks->refused_tick = refused_tick;
}

bool slc_page_chunk_is_ready(const struct slc_page_chunk *chunk,
                             const struct slc_page_timelines *timelines, uint32_t user)
{
    if (chunk->maker == user)
        return true;
    if (chunk->maker == SLC_MAX_PAGE_USERS)
        return !chunk->fresh;
    return chunk->layout_frame &&
           slc_page_timelines_reached(timelines, chunk->maker, chunk->layout_frame);
}

static bool may_write(const struct slc_page_layer *layer,
                      const struct slc_page_timelines *timelines, uint32_t user)
{
    return layer->user == user || slc_page_timelines_reached(timelines, layer->user, layer->value);
}

/* Finds the layer that was freed longest ago among those that the user may write to. Returns
 * layer_count if there is none. */
static uint32_t find_layer(const struct slc_page_chunk *chunk,
                           const struct slc_page_timelines *timelines, uint32_t user)
{
    uint32_t head = chunk->layer_count, at = head;
    if (chunk->free_count == 0 || !slc_page_chunk_is_ready(chunk, timelines, user))
        return head;
    while ((at = chunk->layers[at].next) != head)
        if (may_write(&chunk->layers[at], timelines, user))
            return at;
    return head;
}

uint32_t slc_page_chunk_free_count(const struct slc_page_chunk *chunk,
                                   const struct slc_page_timelines *timelines, uint32_t user)
{
    uint32_t head = chunk->layer_count, count = 0;
    if (timelines->user_count <= 1)
        return chunk->free_count;
    if (!slc_page_chunk_is_ready(chunk, timelines, user))
        return 0;
    for (uint32_t at = chunk->layers[head].next; at != head; at = chunk->layers[at].next)
        count += may_write(&chunk->layers[at], timelines, user);
    return count;
}

static bool has_format(const struct slc_page_chunk *chunk, SluiceFormat format)
{
    return chunk->state == SLC_CHUNK_LIVE && chunk->format == format && !chunk->leaving;
}

uint32_t slc_page_chunks_free_count(const struct slc_page_chunks *chunks,
                                    const struct slc_page_timelines *timelines, uint32_t user,
                                    SluiceFormat format)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < chunks->count; i++)
        if (has_format(&chunks->at[i], format))
            count += slc_page_chunk_free_count(&chunks->at[i], timelines, user);
    return count;
}

static bool has_layer(const struct slc_page_chunk *chunk,
                      const struct slc_page_timelines *timelines, uint32_t user)
{
    return find_layer(chunk, timelines, user) < chunk->layer_count;
}

/* Takes pages from the fullest chunk with a page for the user, so that other chunks run empty. */
static bool find_fullest(struct slc_page_chunks *chunks, const struct slc_page_timelines *timelines,
                         uint32_t user, SluiceFormat format)
{
    uint32_t best = UINT32_MAX;
    for (uint32_t i = 0; i < chunks->count; i++) {
        const struct slc_page_chunk *chunk = &chunks->at[i];
        if (has_format(chunk, format) && chunk->free_count &&
            (best == UINT32_MAX || chunk->free_count < chunks->at[best].free_count) &&
            has_layer(chunk, timelines, user))
            best = i;
    }
    if (best == UINT32_MAX)
        return false;
    chunks->last[format] = best;
    return true;
}

uint32_t slc_page_chunks_find(struct slc_page_chunks *chunks,
                              const struct slc_page_timelines *timelines, uint32_t user,
                              SluiceFormat format)
{
    const struct slc_page_chunk *last = &chunks->at[chunks->last[format]];
    bool there = has_format(last, format) && has_layer(last, timelines, user);
    if (!there && !find_fullest(chunks, timelines, user, format))
        return SLUICE_PAGE_NONE;
    uint32_t index = chunks->last[format];
    return index << 16 | find_layer(&chunks->at[index], timelines, user);
}

void slc_page_chunks_take(struct slc_page_chunks *chunks, uint32_t page, uint32_t user)
{
    struct slc_page_chunk *chunk = &chunks->at[page >> 16];
    struct slc_page_layer *taken = slc_page_layer(chunks, page);
    chunk->layers[taken->previous].next = taken->next;
    chunk->layers[taken->next].previous = taken->previous;
    *taken = (struct slc_page_layer){.owner = SLC_NO_OWNER, .user = (uint8_t)user, .held = true};
    chunk->free_count--;
}

bool slc_page_chunks_is_left(const struct slc_page_chunks *chunks, uint32_t page, uint32_t user,
                             uint32_t owner)
{
    const struct slc_page_chunk *chunk = &chunks->at[page >> 16];
    /* the index may belong to another, smaller chunk by now */
    if (chunk->state != SLC_CHUNK_LIVE || chunk->leaving || (page & 0xFFFFu) >= chunk->layer_count)
        return false;
    const struct slc_page_layer *layer = slc_page_layer(chunks, page);
    return layer->owner == owner && layer->user == user && !layer->held;
}

void slc_page_chunks_free(struct slc_page_chunks *chunks, uint32_t page, uint32_t user,
                          uint64_t value, uint32_t owner)
{
    struct slc_page_chunk *chunk = &chunks->at[page >> 16];
    assert(chunk->state == SLC_CHUNK_LIVE && chunk->free_count < chunk->layer_count);
    uint16_t layer = (uint16_t)(page & 0xFFFFu), head = (uint16_t)chunk->layer_count;
    struct slc_page_layer *layers = chunk->layers;
    layers[layer] = (struct slc_page_layer){.previous = layers[head].previous,
                                            .next = head,
                                            .owner = owner,
                                            .value = value,
                                            .user = (uint8_t)user,
                                            .moved = layers[layer].moved};
    layers[layers[head].previous].next = layer;
    layers[head].previous = layer;
    chunk->free_count++;
}

void slc_page_chunks_retire(struct slc_page_chunks *chunks, uint32_t index,
                            const struct slc_page_timelines *timelines, bool hurry)
{
    struct slc_page_chunk *chunk = &chunks->at[index];
    if (chunk->state != SLC_CHUNK_LIVE)
        return;
    if (chunk->free_count < chunk->layer_count || chunk->tick == 0) /* 0: new, and still empty */
        chunk->tick = timelines->tick;
    uint64_t size = (uint64_t)chunk->layer_count * SLC_TILE_SIZE;
    bool kept =
        chunks->memory.total_size < size || chunks->memory.total_size - size < chunks->kept_size;
    if (timelines->tick - chunk->tick < (hurry ? 1 : IDLE_TICKS) || (kept && !hurry))
        return;
    chunk->state = SLC_CHUNK_RETIRING;
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        chunk->retire_values[i] = timelines->of[i].recorded;
    chunks->page_count[chunk->format] -= chunk->layer_count;
}

void slc_page_chunks_end_retired(struct slc_page_chunks *chunks, uint32_t index,
                                 const struct slc_page_timelines *timelines)
{
    struct slc_page_chunk *chunk = &chunks->at[index];
    if (chunk->state != SLC_CHUNK_RETIRING)
        return;
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        if (!slc_page_timelines_reached(timelines, i, chunk->retire_values[i]))
            return;
    destroy_chunk(chunks, chunk);
    chunks->image_count--;
    chunks->has_freed = true;
}

void slc_page_chunks_record(struct slc_page_chunks *chunks, uint32_t index,
                            const struct slc_page_timelines *timelines, uint32_t user,
                            VkCommandBuffer commands)
{
    struct slc_page_chunk *chunk = &chunks->at[index];
    if (chunk->state != SLC_CHUNK_LIVE || !chunk->fresh)
        return;
    if (chunk->maker == SLC_MAX_PAGE_USERS)
        chunk->maker = (uint8_t)user;
    if (chunk->maker != user)
        return;
    slc_record_general_layout(chunks->vk, commands, chunk->image.image);
    chunk->layout_frame = timelines->of[user].recorded;
    chunk->fresh = false;
}

static void abandon_chunk(struct slc_page_chunk *chunk, uint32_t user, uint64_t frame,
                          uint64_t last)
{
    if (chunk->retire_values[user] > last)
        chunk->retire_values[user] = last;
    for (uint32_t i = 0; i < chunk->layer_count; i++)
        if (!chunk->layers[i].held && chunk->layers[i].user == user &&
            chunk->layers[i].value > last)
            chunk->layers[i].value = last;
    if (chunk->state == SLC_CHUNK_LIVE && chunk->maker == user && chunk->layout_frame >= frame) {
        chunk->fresh = true;
        chunk->layout_frame = 0;
    }
}

void slc_page_chunks_abandon(struct slc_page_chunks *chunks, uint32_t user, uint64_t frame,
                             uint64_t last)
{
    for (uint32_t i = 0; i < chunks->count; i++)
        abandon_chunk(&chunks->at[i], user, frame, last);
}

void slc_page_chunks_drop_user(struct slc_page_chunks *chunks, uint32_t user)
{
    for (uint32_t i = 0; i < chunks->count; i++) {
        struct slc_page_chunk *chunk = &chunks->at[i];
        chunk->retire_values[user] = 0;
        if (chunk->maker == user) {
            chunk->maker = SLC_MAX_PAGE_USERS;
            chunk->layout_frame = 0;
        }
        for (uint32_t j = 0; j < chunk->layer_count; j++)
            if (chunk->layers[j].user == user) {
                chunk->layers[j].value = 0;
                chunk->layers[j].owner = SLC_NO_OWNER;
            }
    }
}
