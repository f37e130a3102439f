#include "vulkan/remakes.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

#define FIRST_KEYS 16u

SluiceResult slc_remakes_init(struct slc_remakes *remakes, const SluiceAllocationCallbacks *cb,
                              uint32_t spare)
{
    *remakes = (struct slc_remakes){.cb = cb, .spare = spare};
    return slc_map_init(&remakes->keys, cb, FIRST_KEYS);
}

void slc_remakes_finish(struct slc_remakes *remakes)
{
    if (!remakes->cb)
        return;
    slc_map_finish(&remakes->keys, remakes->cb);
    slc_free(remakes->cb, remakes->queue, remakes->capacity, sizeof *remakes->queue);
    *remakes = (struct slc_remakes){0};
}

SluiceResult slc_remakes_reserve(struct slc_remakes *remakes, uint32_t count)
{
    uint32_t old = remakes->capacity, most = remakes->count + count + remakes->spare;
    SluiceResult result = slc_map_reserve(&remakes->keys, remakes->cb, most);
    if (result != SLUICE_SUCCESS || most <= old)
        return result;
    uint32_t capacity = slc_max_u32(most, 2 * old);
    uint64_t *queue = slc_alloc(remakes->cb, capacity, sizeof *queue);
    if (!queue)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < remakes->count; i++)
        queue[i] = remakes->queue[(remakes->first + i) % old];
    slc_free(remakes->cb, remakes->queue, old, sizeof *queue);
    remakes->queue = queue;
    remakes->capacity = capacity;
    remakes->first = 0;
    return SLUICE_SUCCESS;
}

void slc_remakes_put_back(struct slc_remakes *remakes, uint64_t key)
{
    assert(remakes->count < remakes->capacity);
    remakes->queue[(remakes->first + remakes->count++) % remakes->capacity] = key;
}

bool slc_remakes_retake(struct slc_remakes *remakes, uint64_t key)
{
    if (slc_map_get(&remakes->keys, key) != SLC_MAP_NONE)
        return false;
    slc_map_add(&remakes->keys, key, 0);
    return true;
}

void slc_remakes_add(struct slc_remakes *remakes, uint64_t key)
{
    if (slc_remakes_retake(remakes, key))
        slc_remakes_put_back(remakes, key);
}

uint64_t slc_remakes_take(struct slc_remakes *remakes)
{
    assert(remakes->count > 0);
    uint64_t key = remakes->queue[remakes->first];
    remakes->first = (remakes->first + 1) % remakes->capacity;
    remakes->count--;
    return key;
}

void slc_remakes_end(struct slc_remakes *remakes, uint64_t key)
{
    slc_map_remove(&remakes->keys, key);
}

void slc_remakes_drop(struct slc_remakes *remakes, bool (*drop)(void *user, uint64_t key),
                      void *user)
{
    for (uint32_t left = remakes->count; left > 0; left--) {
        uint64_t key = slc_remakes_take(remakes);
        if (drop(user, key))
            slc_remakes_end(remakes, key);
        else
            slc_remakes_put_back(remakes, key);
    }
}

SluiceResult slc_remake_area_read(struct slc_remake_area *area, const SluiceImageInfo *info,
                                  const SluiceImageRegion *region, uint32_t level_count,
                                  const char *name, const SluiceLogCallback *log)
{
    const SluiceImageRegion all = {.width = info->width, .height = info->height};
    const SluiceImageRegion *r = region ? region : &all;
    uint32_t width = slc_mip_size(info->width, r->mipLevel);
    uint32_t height = slc_mip_size(info->height, r->mipLevel);
    if (r->mipLevel >= info->mipLevelCount || r->x > width || r->width > width - r->x ||
        r->y > height || r->height > height - r->y)
        return slc_log_refusal(
            log,
            "%s: level %u, %u x %u texels from (%u, %u) on: the level has %u x %u, and the "
            "texture has %u levels",
            name, r->mipLevel, r->width, r->height, r->x, r->y, width, height, info->mipLevelCount);
    uint32_t left = info->mipLevelCount - r->mipLevel;
    *area = (struct slc_remake_area){.width = info->width,
                                     .height = info->height,
                                     .region = *r,
                                     .end_level = r->mipLevel + slc_min_u32(level_count, left)};
    if (r->width == 0 || r->height == 0)
        area->end_level = r->mipLevel;
    return SLUICE_SUCCESS;
}

/* Maps texels [begin, end) of `from` to tiles of `to`. `to` need not be half of `from`. */
static void scale(uint32_t begin, uint32_t end, uint32_t from, uint32_t to, uint32_t tile,
                  uint32_t *first, uint32_t *last)
{
    uint64_t low = (uint64_t)begin * to / from;
    uint64_t high = ((uint64_t)end * to + from - 1) / from;
    *first = (uint32_t)(low / tile);
    *last = (uint32_t)((high + tile - 1) / tile);
}

struct slc_remake_tiles slc_remake_tiles(const struct slc_remake_area *area, uint32_t level,
                                         uint32_t tile_width, uint32_t tile_height)
{
    const SluiceImageRegion *r = &area->region;
    struct slc_remake_tiles tiles = {0};
    if (level < r->mipLevel || level >= area->end_level)
        return tiles;
    scale(r->x, r->x + r->width, slc_mip_size(area->width, r->mipLevel),
          slc_mip_size(area->width, level), tile_width, &tiles.x, &tiles.end_x);
    scale(r->y, r->y + r->height, slc_mip_size(area->height, r->mipLevel),
          slc_mip_size(area->height, level), tile_height, &tiles.y, &tiles.end_y);
    return tiles;
}

bool slc_remake_meets_tail(const struct slc_remake_area *area, uint32_t first)
{
    return area->end_level > area->region.mipLevel && area->end_level > first;
}

uint64_t slc_remake_count(const struct slc_remake_area *area, uint32_t regular_count,
                          uint32_t tile_width, uint32_t tile_height)
{
    uint64_t count = slc_remake_meets_tail(area, regular_count);
    for (uint32_t level = 0; level < regular_count; level++) {
        struct slc_remake_tiles t = slc_remake_tiles(area, level, tile_width, tile_height);
        count += (uint64_t)(t.end_x - t.x) * (t.end_y - t.y);
    }
    return count;
}
