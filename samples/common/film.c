#include "film.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "one_time.h"

#define BLOCK 8u ///< neighboring pixels are near each other in the list
#define TILE 32u ///< width and height of a share's tiles in pixels

static VkDeviceSize pixel_count(const struct film *film)
{
    return (VkDeviceSize)film->width * film->height;
}

/** Returns whether the share includes the pixel's tile. */
static bool has_pixel(const struct film *film, uint32_t x, uint32_t y)
{
    const struct film_share *share = &film->share;
    return share->count < 2 || (x / TILE + y / TILE) % share->count == share->index;
}

static void list_block(struct film *film, uint32_t left, uint32_t top)
{
    for (uint32_t y = top; y < top + BLOCK && y < film->height; y++)
        for (uint32_t x = left; x < left + BLOCK && x < film->width; x++)
            film->all[film->pixel_count++] = y * film->width + x;
}

static bool list_all(struct film *film)
{
    film->all = malloc(pixel_count(film) * sizeof *film->all);
    if (!film->all) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    for (uint32_t top = 0; top < film->height; top += BLOCK)
        for (uint32_t left = 0; left < film->width; left += BLOCK)
            if (has_pixel(film, left, top))
                list_block(film, left, top);
    return true;
}

bool film_create(const struct gpu *gpu, uint32_t width, uint32_t height, struct film_share share,
                 struct film *film)
{
    const VkBufferUsageFlags usage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    *film = (struct film){.width = width, .height = height, .share = share};
    if (!list_all(film))
        return false;
    const VkDeviceSize count = pixel_count(film), size = count * 4 * sizeof(float);
    if (!gpu_create_buffer(gpu, size, usage, &film->sums) ||
        !gpu_create_buffer(gpu, size, usage, &film->latest) ||
        !gpu_create_buffer(gpu, 2 * count * sizeof(uint32_t), usage, &film->lists) ||
        !gpu_create_buffer(gpu, 2 * sizeof(uint32_t), usage, &film->counters) ||
        !gpu_create_buffer(gpu, 2 * size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, &film->readback))
        return false;
    film_clear(film);
    memset(film->latest.mapped, 0, size);
    return true;
}

void film_clear(struct film *film)
{
    memset(film->sums.mapped, 0, film->sums.size);
}

void film_destroy(const struct gpu *gpu, struct film *film)
{
    gpu_destroy_buffer(gpu, &film->sums);
    gpu_destroy_buffer(gpu, &film->latest);
    gpu_destroy_buffer(gpu, &film->lists);
    gpu_destroy_buffer(gpu, &film->counters);
    gpu_destroy_buffer(gpu, &film->readback);
    free(film->all);
    film->all = NULL;
}

/* Launches overwrite list 0 only after they have written list 1. */
void film_begin_sample(struct film *film)
{
    if (!film->has_list)
        memcpy(film->lists.mapped, film->all, film->pixel_count * sizeof *film->all);
    film->has_list = true;
    film->list_index = 0;
    film->missing_count = film->pixel_count;
}

void film_begin_launch(struct film *film)
{
    uint32_t *counters = film->counters.mapped;
    counters[1 - film->list_index] = 0;
    film->has_list = film->has_list && film->list_index == 0;
}

void film_end_launch(struct film *film)
{
    const uint32_t *counters = film->counters.mapped;
    film->list_index = 1 - film->list_index;
    film->missing_count = counters[film->list_index];
}

void film_record_end(VkCommandBuffer commands)
{
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask =
                                   VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &barrier, 0, NULL, 0, NULL);
}

static void record_readback(void *user_data, VkCommandBuffer commands)
{
    const struct film *film = user_data;
    const VkDeviceSize size = film->sums.size;
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdCopyBuffer(commands, film->sums.buffer, film->readback.buffer, 1,
                    &(VkBufferCopy){0, 0, size});
    vkCmdCopyBuffer(commands, film->latest.buffer, film->readback.buffer, 1,
                    &(VkBufferCopy){0, size, size});
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &barrier, 0, NULL, 0, NULL);
}

/** Reads `count` pixels from `first` on. */
static void read_pixels(const struct film *film, struct picture *picture, size_t first,
                        size_t count)
{
    const float(*sums)[4] = film->readback.mapped;
    const float(*latest)[4] = sums + pixel_count(film);
    for (size_t i = first; i < first + count; i++) {
        bool none = sums[i][3] == 0.0f; /* no complete sample yet: show the incomplete one */
        for (int c = 0; c < 3; c++)
            picture->rgba[i][c] = none ? latest[i][c] : sums[i][c] / sums[i][3];
        picture->rgba[i][3] = 1.0f;
        picture->missing[i] = latest[i][3] != 0.0f;
    }
}

bool film_read(const struct gpu *gpu, const struct film *film, struct picture *picture)
{
    if (!one_time_run(gpu, record_readback, (void *)film))
        return false;
    for (uint32_t y = 0; y < film->height; y++)
        for (uint32_t x = 0; x < film->width; x += TILE)
            if (has_pixel(film, x, y))
                read_pixels(film, picture, (size_t)y * film->width + x,
                            film->width - x < TILE ? film->width - x : TILE);
    return true;
}
