#include "core/requested_levels.h"

#include "base/checked.h"
#include "core/history.h"
#include "core/lookup.h"

#include <string.h>

/** First and last region that cell `i` touches along one axis. */
static void regions_of(uint64_t i, uint32_t cell, uint32_t region, uint32_t count, uint32_t *first,
                       uint32_t *last)
{
    uint64_t begin = i * cell / region, end = ((i + 1) * cell - 1) / region;
    *first = begin < count ? (uint32_t)begin : count - 1;
    *last = end < count ? (uint32_t)end : count - 1;
}

static uint8_t least_asked(const struct slc_managed_texture *t, uint32_t x, uint32_t y)
{
    const struct slc_shape *s = t->shape;
    uint32_t x0 = 0, y0 = 0, x1 = s->feedback_width - 1, y1 = s->feedback_height - 1;
    uint8_t least = SLUICE_MIP_UNTOUCHED;
    if (s->regular_tile_count > 0) {
        regions_of(x, s->desc.tileWidth, s->desc.feedbackRegionWidth, s->feedback_width, &x0, &x1);
        regions_of(y, s->desc.tileHeight, s->desc.feedbackRegionHeight, s->feedback_height, &y0,
                   &y1);
    }
    for (uint32_t j = y0; j <= y1; j++)
        for (uint32_t i = x0; i <= x1; i++) {
            uint8_t level = t->history->least[(size_t)j * s->feedback_width + i];
            least = level < least ? level : least;
        }
    return least;
}

struct slc_requested_level slc_requested_level(const SluiceStreamedTextureManager *manager,
                                               SluiceTextureId id, uint32_t x, uint32_t y)
{
    const struct slc_managed_texture *t = slc_texture_at(manager, (uint32_t)id);
    assert(x < t->shape->min_mip_width && y < t->shape->min_mip_height);
    if (!t->history)
        return (struct slc_requested_level){SLUICE_MIP_UNTOUCHED, SLUICE_MIP_UNTOUCHED};
    uint8_t asked = least_asked(t, x, y), held = asked;
    if (t->shape->regular_tile_count > 0)
        held = t->history->under[(size_t)y * t->shape->levels[0].width + x];
    return (struct slc_requested_level){held, asked};
}

bool slc_manager_lacks_slots(const SluiceStreamedTextureManager *manager)
{
    return manager->starved;
}

static void write_row(const struct slc_managed_texture *t, uint32_t y, uint8_t *out)
{
    uint32_t width = t->shape->min_mip_width;
    if (!t->history)
        memset(out, SLUICE_MIP_UNTOUCHED, width);
    else if (t->shape->regular_tile_count > 0)
        memcpy(out, t->history->under + (size_t)y * t->shape->levels[0].width, width);
    else
        out[0] = least_asked(t, 0, 0);
}

SluiceResult sluiceWriteRequestedLevels(const SluiceStreamedTextureManager *manager,
                                        SluiceTextureId textureId, size_t rowPitch, size_t size,
                                        uint8_t *pLevels)
{
    if (!manager || !pLevels)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(manager, textureId, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    size_t rows, needed, width = t->shape->min_mip_width, height = t->shape->min_mip_height;
    if (rowPitch < width || !slc_mul_size(height - 1, rowPitch, &rows) ||
        !slc_add_size(rows, width, &needed) || size < needed)
        return SLUICE_ERROR_SIZE_MISMATCH;
    for (uint32_t y = 0; y < height; y++)
        write_row(t, y, pLevels + y * rowPitch);
    return SLUICE_SUCCESS;
}
