#include "budget_need.h"

#include <sluice/manager.h>

static uint8_t least(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* Halves the map: 2 x 2 texels become the finest of them. SLUICE_MIP_UNTOUCHED is the largest
 * value. */
static void reduce(uint8_t *map, uint32_t *width, uint32_t *height)
{
    const uint32_t columns = (*width + 1) / 2, rows = (*height + 1) / 2;
    for (uint32_t y = 0; y < rows; y++)
        for (uint32_t x = 0; x < columns; x++) {
            uint8_t finest = SLUICE_MIP_UNTOUCHED;
            for (uint32_t v = 2 * y; v < 2 * y + 2 && v < *height; v++)
                for (uint32_t u = 2 * x; u < 2 * x + 2 && u < *width; u++)
                    finest = least(finest, map[(uint64_t)v * *width + u]);
            map[(uint64_t)y * columns + x] = finest;
        }
    *width = columns;
    *height = rows;
}

/* Counts the tiles of a level that stay requested when levels are added to the requests. */
static void count_level(struct budget_need *need, const uint8_t *map, uint64_t count,
                        uint32_t level)
{
    for (uint64_t i = 0; i < count; i++)
        for (uint32_t added = 0; map[i] + added <= level && added < BUDGET_NEED_LEVELS; added++)
            need->tiles[added]++;
}

void budget_need_add(struct budget_need *need, uint8_t *map, uint32_t width, uint32_t height,
                     uint32_t level_count, uint32_t tail_tiles)
{
    need->tails += tail_tiles;
    for (uint32_t level = 0; level < level_count; level++) {
        if (level > 0)
            reduce(map, &width, &height);
        count_level(need, map, (uint64_t)width * height, level);
    }
}

uint64_t budget_need_bytes(const struct budget_need *need, uint32_t levels)
{
    return (need->tails + need->tiles[levels]) * SLUICE_DEFAULT_TILE_SIZE;
}

double budget_need_levels(const struct budget_need *need, uint64_t budget)
{
    uint64_t before = budget_need_bytes(need, 0);
    if (before <= budget)
        return 0;
    for (uint32_t levels = 1; levels < BUDGET_NEED_LEVELS; levels++) {
        const uint64_t bytes = budget_need_bytes(need, levels);
        if (bytes <= budget)
            return levels - (double)(budget - bytes) / (double)(before - bytes);
        before = bytes;
    }
    return BUDGET_NEED_LEVELS - 1;
}
