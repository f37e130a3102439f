#include "vulkan/feedback_map.h"

#include <sluice/shared/texture_table.h>

#include <string.h>

uint32_t slc_resolve_weight(uint32_t region)
{
    uint32_t x = region * 0x9E3779B1u;
    x = (x ^ x >> 15) * 0x85EBCA77u;
    return (x ^ x >> 13) | 1u;
}

void slc_feedback_map_init(struct slc_feedback_map *map, uint8_t *levels, uint32_t region_count)
{
    *map = (struct slc_feedback_map){.levels = levels, .region_count = region_count};
    memset(levels, SLUICE_MIP_UNTOUCHED, region_count);
}

static void set_level(struct slc_feedback_map *map, uint32_t region, uint8_t level)
{
    map->checksum += slc_resolve_weight(region) * ((uint32_t)map->levels[region] - level);
    map->levels[region] = level;
}

static bool take_changes(struct slc_feedback_map *map, uint32_t count, const uint32_t *data)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t region = data[i] >> 8;
        if (region >= map->region_count)
            return false;
        set_level(map, region, (uint8_t)data[i]);
    }
    return true;
}

/* Applies a whole map. Skips equal words, because whole maps are also read where little changes. */
static bool take_map(struct slc_feedback_map *map, uint32_t count, const uint32_t *data)
{
    if (count != (map->region_count + 3) / 4)
        return false;
    for (uint32_t word = 0; word < count; word++) {
        uint32_t end = 4 * word + 4 < map->region_count ? 4 * word + 4 : map->region_count;
        for (uint32_t region = 4 * word; region < end; region++) {
            uint8_t level = (uint8_t)(data[word] >> 8 * (region - 4 * word));
            if (level != map->levels[region])
                set_level(map, region, level);
        }
    }
    return true;
}

bool slc_feedback_map_update(struct slc_feedback_map *map, const struct SluiceResolveResult *result,
                             const uint32_t *data)
{
    bool fits = result->state == SLUICE_RESOLVED_MAP ? take_map(map, result->count, data)
                                                     : take_changes(map, result->count, data);
    return fits && map->checksum == result->checksum;
}
