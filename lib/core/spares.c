/*
 * Textures that come into view and leave it take and give back equal amounts of memory. Blocks that
 * are given back are kept for other textures, of any shape: block sizes have classes, four per
 * power of two. So a moving camera soon allocates no more. A class holds at most an eighth more
 * blocks than were in use at one time. Its memory is freed when no block is in use.
 */
#include "core/spares.h"

#include "base/alloc.h"

#include <stdalign.h>
#include <stddef.h>
#include <string.h>

enum { SMALLEST_LOG2 = 6 };

/** Returns the class of a size, and rounds the size up to the class, by at most a quarter. */
static uint32_t class_of(size_t *size)
{
    if (*size <= (size_t)1 << SMALLEST_LOG2) {
        *size = (size_t)1 << SMALLEST_LOG2;
        return 0;
    }
    uint32_t log2 = SMALLEST_LOG2;
    while ((*size - 1) >> log2 > 1)
        log2++;
    size_t quarters = (*size - 1) >> (log2 - 2); /* 4 to 7 whole quarters of the power of two */
    *size = (quarters + 1) << (log2 - 2);
    return (log2 - SMALLEST_LOG2) * 4 + (uint32_t)quarters - 3;
}

/* Header of one allocation. Its blocks follow. */
struct chunk {
    alignas(max_align_t) struct chunk *next;
    size_t block_count;
};

static size_t chunk_size(size_t block_count, size_t size)
{
    return sizeof(struct chunk) + block_count * size;
}

static void push(struct slc_spares *spares, void *block)
{
    memcpy(block, &spares->first, sizeof spares->first);
    spares->first = block;
}

static bool add_chunk(slc_manager *m, struct slc_spares *spares, size_t block_count, size_t size)
{
    if (block_count > (SIZE_MAX - sizeof(struct chunk)) / size)
        return false;
    struct chunk *chunk = slc_alloc(&m->cb, 1, chunk_size(block_count, size));
    if (!chunk)
        return false;
    *chunk = (struct chunk){spares->chunks, block_count};
    spares->chunks = chunk;
    for (size_t i = block_count; i-- > 0;)
        push(spares, (uint8_t *)(chunk + 1) + i * size);
    return true;
}

/* Adds an eighth of the blocks in use, so that a scene of any size takes few allocations. */
static bool grow(slc_manager *m, struct slc_spares *spares, size_t size)
{
    uint32_t more = spares->used / 8;
    return (more > 1 && add_chunk(m, spares, more, size)) || add_chunk(m, spares, 1, size);
}

void *slc_spares_take(slc_manager *m, size_t size)
{
    uint32_t index = class_of(&size);
    assert(index < SLC_SPARE_CLASSES);
    struct slc_spares *spares = &m->spares[index];
    if (!spares->first && !grow(m, spares, size))
        return NULL;
    void *block = spares->first;
    memcpy(&spares->first, block, sizeof spares->first);
    spares->used++;
    return block;
}

void slc_spares_give(slc_manager *m, void *memory, size_t size)
{
    if (!memory)
        return;
    struct slc_spares *spares = &m->spares[class_of(&size)];
    push(spares, memory);
    if (--spares->used > 0)
        return;
    while (spares->chunks) {
        struct chunk *chunk = spares->chunks;
        spares->chunks = chunk->next;
        slc_free(&m->cb, chunk, 1, chunk_size(chunk->block_count, size));
    }
    spares->first = NULL;
}
