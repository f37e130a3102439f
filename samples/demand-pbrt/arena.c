#include "arena.h"

#include <stdio.h>
#include <stdlib.h>

#include "../common/ray_table.h"

#define ALIGNMENT ((VkDeviceSize)256)
#define CHUNK_SIZE ((VkDeviceSize)16 << 20)

/** Free range. Ranges are sorted, and no two touch. */
struct hole {
    struct hole *next;
    VkDeviceSize offset, size;
};

struct arena_chunk {
    struct arena_chunk *next;
    struct gpu_buffer buffer;
    VkDeviceAddress address;
    struct hole *holes;
};

static struct hole *new_hole(VkDeviceSize offset, VkDeviceSize size, struct hole *next)
{
    struct hole *hole = malloc(sizeof *hole);
    if (hole)
        *hole = (struct hole){next, offset, size};
    return hole;
}

static void free_chunk(const struct gpu *gpu, struct arena_chunk *chunk)
{
    gpu_destroy_buffer(gpu, &chunk->buffer);
    for (struct hole *hole = chunk->holes; hole;) {
        struct hole *next = hole->next;
        free(hole);
        hole = next;
    }
    free(chunk);
}

static struct arena_chunk *add_chunk(const struct gpu *gpu, struct arena *arena, VkDeviceSize least)
{
    const VkDeviceSize size = least > CHUNK_SIZE ? least : CHUNK_SIZE;
    struct arena_chunk *chunk = calloc(1, sizeof *chunk);
    if (!chunk)
        return NULL;
    chunk->holes = new_hole(0, size, NULL);
    if (!chunk->holes ||
        !(arena->mapped ? gpu_create_buffer(gpu, size, arena->usage, &chunk->buffer)
                        : gpu_create_device_buffer(gpu, size, arena->usage, &chunk->buffer))) {
        free_chunk(gpu, chunk);
        return NULL;
    }
    chunk->address = ray_buffer_address(gpu, chunk->buffer.buffer);
    chunk->next = arena->chunks;
    arena->chunks = chunk;
    arena->size += size;
    return chunk;
}

/* Takes a part of a hole. Offsets are multiples of ALIGNMENT, and so are addresses, because devices
 * align buffers to more. */
static bool take_hole(struct arena_chunk *chunk, VkDeviceSize size, struct arena_part *part)
{
    for (struct hole **at = &chunk->holes; *at; at = &(*at)->next) {
        struct hole *hole = *at;
        if (hole->size < size)
            continue;
        *part = (struct arena_part){.chunk = chunk,
                                    .buffer = chunk->buffer.buffer,
                                    .offset = hole->offset,
                                    .size = size,
                                    .address = chunk->address + hole->offset};
        if (chunk->buffer.mapped)
            part->mapped = (char *)chunk->buffer.mapped + hole->offset;
        hole->offset += size;
        hole->size -= size;
        if (hole->size == 0) {
            *at = hole->next;
            free(hole);
        }
        return true;
    }
    return false;
}

bool arena_take(const struct gpu *gpu, struct arena *arena, VkDeviceSize size,
                struct arena_part *part)
{
    size = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    struct arena_chunk *chunk = arena->chunks;
    while (chunk && !take_hole(chunk, size, part))
        chunk = chunk->next;
    if (!chunk) {
        chunk = add_chunk(gpu, arena, size);
        if (!chunk || !take_hole(chunk, size, part)) {
            fprintf(stderr, "out of memory for meshes\n");
            return false;
        }
    }
    arena->used += size;
    return true;
}

static void remove_if_empty(const struct gpu *gpu, struct arena *arena, struct arena_chunk *chunk)
{
    if (!chunk->holes || chunk->holes->size != chunk->buffer.size)
        return;
    struct arena_chunk **at = &arena->chunks;
    while (*at != chunk)
        at = &(*at)->next;
    *at = chunk->next;
    arena->size -= chunk->buffer.size;
    free_chunk(gpu, chunk);
}

static void join_with_next(struct hole *hole)
{
    struct hole *next = hole->next;
    if (!next || hole->offset + hole->size != next->offset)
        return;
    hole->size += next->size;
    hole->next = next->next;
    free(next);
}

void arena_give(const struct gpu *gpu, struct arena *arena, struct arena_part *part)
{
    struct arena_chunk *chunk = part->chunk;
    if (!chunk)
        return;
    struct hole **at = &chunk->holes, *before = NULL;
    while (*at && (*at)->offset < part->offset) {
        before = *at;
        at = &before->next;
    }
    struct hole *hole = new_hole(part->offset, part->size, *at);
    arena->used -= part->size;
    *part = (struct arena_part){0};
    if (!hole)
        return; /* without memory for the hole, the range is lost until the arena ends */
    *at = hole;
    join_with_next(hole);
    if (before)
        join_with_next(before);
    remove_if_empty(gpu, arena, chunk);
}

void arena_finish(const struct gpu *gpu, struct arena *arena)
{
    while (arena->chunks) {
        struct arena_chunk *chunk = arena->chunks;
        arena->chunks = chunk->next;
        free_chunk(gpu, chunk);
    }
    *arena = (struct arena){0};
}
