#include "vulkan/page_slots.h"

bool slc_page_pool_count_slots(struct slc_page_pool *pool, uint32_t user, uint32_t chunk,
                               struct slc_page_chunk_slots *slots)
{
    *slots = (struct slc_page_chunk_slots){0};
    slc_mutex_lock(&pool->mutex);
    const struct slc_page_chunk *c = &pool->chunks.at[chunk];
    const bool live = c->state == SLC_CHUNK_LIVE;
    if (live)
        *slots = (struct slc_page_chunk_slots){.format = slc_page_texel_format(c->format),
                                               .count = c->layer_count};
    for (uint32_t i = 0; i < slots->count; i++) {
        slots->held += c->layers[i].held && c->layers[i].user == user;
        slots->others += c->layers[i].held && c->layers[i].user != user;
    }
    slc_mutex_unlock(&pool->mutex);
    return live;
}

void slc_page_pool_visit_left(struct slc_page_pool *pool, uint32_t user,
                              void (*visit)(void *user_data, uint32_t page, uint32_t owner),
                              void *user_data)
{
    const struct slc_page_chunks *chunks = &pool->chunks;
    slc_mutex_lock(&pool->mutex);
    for (uint32_t i = 0; i < chunks->count; i++) {
        const struct slc_page_chunk *c = &chunks->at[i];
        for (uint32_t k = 0; c->state == SLC_CHUNK_LIVE && k < c->layer_count; k++) {
            const struct slc_page_layer *layer = &c->layers[k];
            if (layer->owner != SLC_NO_OWNER &&
                slc_page_chunks_is_left(chunks, i << 16 | k, user, layer->owner))
                visit(user_data, i << 16 | k, layer->owner);
        }
    }
    slc_mutex_unlock(&pool->mutex);
}
