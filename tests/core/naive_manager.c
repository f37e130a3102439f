#include "core/naive_manager.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *naive_alloc(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory)
        abort();
    return memory;
}

void naive_complain(struct naive_manager *n, const char *format, ...)
{
    if (n->complaint[0])
        return;
    va_list args;
    va_start(args, format);
    vsnprintf(n->complaint, sizeof n->complaint, format, args);
    va_end(args);
}

void naive_init(struct naive_manager *n, uint32_t capacity, bool always_packed)
{
    *n = (struct naive_manager){.capacity = capacity, .always_packed = always_packed};
}

void naive_free_texture(struct naive_texture *t)
{
    naive_forget_history(t);
    free(t->last_wishes);
    free(t->tiles);
    free(t->held);
    free(t->last_asked);
    free(t->minmip);
    free(t->changed);
    free(t);
}

void naive_finish(struct naive_manager *n)
{
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i])
            naive_free_texture(n->textures[i]);
    for (uint32_t i = 0; i < n->heap_count; i++)
        free(n->heaps[i].slots);
    free(n->textures);
    free(n->removed);
    free(n->heaps);
    free(n->given_up);
    *n = (struct naive_manager){0};
}

static bool was_removed(const struct naive_manager *n, SluiceTextureId id)
{
    for (uint32_t i = 0; i < n->removed_count; i++)
        if (n->removed[i] == id)
            return true;
    return false;
}

struct naive_texture *naive_find(struct naive_manager *n, SluiceTextureId id, SluiceResult *result)
{
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i] && n->textures[i]->id == id)
            return n->textures[i];
    *result = was_removed(n, id) ? SLUICE_ERROR_STALE_TEXTURE : SLUICE_ERROR_UNKNOWN_TEXTURE;
    return NULL;
}

struct naive_heap *naive_find_heap(struct naive_manager *n, uint32_t id)
{
    for (uint32_t i = 0; i < n->heap_count; i++)
        if (n->heaps[i].id == id)
            return &n->heaps[i];
    return NULL;
}

uint32_t naive_count_slots(const struct naive_manager *n, const struct naive_heap *heap,
                           enum naive_slot_use use)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < n->capacity; i++)
        count += heap->slots[i].use == use;
    return count;
}

uint32_t naive_count_all(const struct naive_manager *n, enum naive_slot_use use)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < n->heap_count; i++)
        count += naive_count_slots(n, &n->heaps[i], use);
    return count;
}

uint32_t naive_reserved(const struct naive_manager *n)
{
    const uint32_t sixteenth = n->heap_count * n->capacity / 16;
    return sixteenth < 64 ? sixteenth : 64;
}

uint32_t naive_surplus(const struct naive_manager *n)
{
    const uint32_t target = n->config.targetHeapCount;
    return target > 0 && n->heap_count > target ? (n->heap_count - target) * n->capacity : 0;
}

uint32_t naive_kept(const struct naive_manager *n)
{
    return naive_reserved(n) + naive_surplus(n);
}

void naive_statistics(const struct naive_manager *n, SluiceStreamedTextureStatistics *out)
{
    *out = n->totals;
    uint32_t *counts[] = {
        [SLUICE_TILE_STATE_REQUESTED] = &out->requestedTileCount,
        [SLUICE_TILE_STATE_ALLOCATED] = &out->allocatedTileCount,
        [SLUICE_TILE_STATE_MAPPED] = &out->mappedTileCount,
        [SLUICE_TILE_STATE_STANDBY] = &out->standbyTileCount,
        [SLUICE_TILE_STATE_CANCELED] = &out->canceledTileCount,
        [SLUICE_TILE_STATE_FAILED] = &out->failedTileCount,
        [SLUICE_TILE_STATE_GIVEN_UP] = &out->givenUpTileCount,
    };
    for (uint32_t i = 0; i < n->texture_room; i++) {
        const struct naive_texture *t = n->textures[i];
        if (!t)
            continue;
        out->textureCount++;
        out->tileCount += t->layout.tileCount;
        for (uint32_t k = 0; k < t->layout.tileCount; k++)
            if (t->tiles[k].state != SLUICE_TILE_STATE_FREE)
                ++*counts[t->tiles[k].state];
    }
    out->heapCount = n->heap_count;
    out->retiringSlotCount = naive_count_all(n, NAIVE_SLOT_RETIRING);
    out->freeSlotCount = naive_count_all(n, NAIVE_SLOT_FREE);
    out->reservedSlotCount = naive_reserved(n);
    out->globalMipBias = n->bias.value;
}

/* Checks a new id: lowest free index, and a generation never seen there. */
static void check_new_id(struct naive_manager *n, SluiceTextureId id)
{
    uint32_t lowest = 0;
    while (lowest < n->texture_room && n->textures[lowest])
        lowest++;
    if (id == SLUICE_NO_TEXTURE || (uint32_t)id != lowest)
        naive_complain(n, "id %#llx is not of index %u", (unsigned long long)id, lowest);
    else if (was_removed(n, id))
        naive_complain(n, "id %#llx was given before", (unsigned long long)id);
}

static struct naive_texture *make_texture(struct naive_manager *n,
                                          const SluiceStreamedTextureLayout *l, SluiceTextureId id)
{
    struct naive_texture *t = naive_alloc(1, sizeof *t);
    const size_t regions = (size_t)l->feedbackWidth * l->feedbackHeight;
    const size_t texels = (size_t)l->minMipWidth * l->minMipHeight;
    *t = (struct naive_texture){.id = id, .layout = *l, .minmip_stale = true};
    t->tiles = naive_alloc(l->tileCount, sizeof *t->tiles);
    t->held = memset(naive_alloc(regions, 1), SLUICE_MIP_UNTOUCHED, regions);
    t->last_wishes =
        memset(naive_alloc(l->regularTileCount, 1), SLUICE_MIP_UNTOUCHED, l->regularTileCount);
    t->minmip = memset(naive_alloc(texels, 1), SLUICE_MIP_UNTOUCHED, texels);
    t->changed = memset(naive_alloc(texels, 1), 1, texels);
    t->dirty_since = ++n->stamp;
    uint32_t i = 0;
    for (uint32_t level = 0; level < l->desc.regularMipCount; level++)
        for (uint32_t y = 0; y < l->levelHeightInTiles[level]; y++)
            for (uint32_t x = 0; x < l->levelWidthInTiles[level]; x++)
                t->tiles[i++] = (struct naive_tile){.level = level, .x = x, .y = y};
    for (uint32_t x = 0; x < l->desc.packedTileCount; x++) {
        t->tiles[i] = (struct naive_tile){.level = l->desc.regularMipCount,
                                          .x = x,
                                          .packed = true,
                                          .outside = l->desc.packedTilesOutside};
        if (n->always_packed)
            naive_become_wanted(n, &t->tiles[i], 0);
        i++;
    }
    return t;
}

SluiceResult naive_add_texture(struct naive_manager *n, const struct call *call,
                               const struct outcome *seen, struct outcome *out)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = naive_layout(&call->desc, &layout);
    if (result != SLUICE_SUCCESS || seen->result != SLUICE_SUCCESS)
        return result;
    check_new_id(n, seen->texture);
    if (n->complaint[0])
        return result;
    uint32_t index = (uint32_t)seen->texture;
    if (index == n->texture_room) {
        n->textures = realloc(n->textures, (n->texture_room + 1) * sizeof(void *));
        if (!n->textures)
            abort();
        n->texture_room++;
    }
    n->textures[index] = make_texture(n, &layout, seen->texture);
    out->texture = seen->texture;
    return SLUICE_SUCCESS;
}
