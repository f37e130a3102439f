#include "vulkan/around.h"

#include <string.h>

/* Loops without branches, so that compilers vectorize them. */

static void take_max(uint16_t *row, const uint16_t *other, uint32_t count)
{
    for (uint32_t x = 0; x < count; x++)
        row[x] = row[x] > other[x] ? row[x] : other[x];
}

/* Finds the largest texel of the rows around, column by column. */
static void reduce_rows(const struct slc_around *a, uint32_t y, uint16_t *row)
{
    memcpy(row, a->texels + (uint64_t)y * a->width, a->width * sizeof *row);
    for (uint32_t d = 1; d <= a->radius; d++) {
        if (a->wraps_y || y >= d)
            take_max(row, a->texels + (uint64_t)((y + a->height * d - d) % a->height) * a->width,
                     a->width);
        if (a->wraps_y || y + d < a->height)
            take_max(row, a->texels + (uint64_t)((y + d) % a->height) * a->width, a->width);
    }
}

void slc_around_row(const struct slc_around *a, uint32_t y, uint16_t *scratch, uint32_t *words)
{
    const uint16_t *own = a->texels + (uint64_t)y * a->width;
    uint16_t *row = scratch + a->radius;
    reduce_rows(a, y, row);
    for (uint32_t d = 1; d <= a->radius; d++) {
        /* maps may be narrower than the radius */
        scratch[a->radius - d] = a->wraps_x ? row[(a->width * d - d) % a->width] : 0;
        row[a->width - 1 + d] = a->wraps_x ? row[(d - 1) % a->width] : 0;
    }
    uint16_t *most = scratch + a->width + 2 * a->radius;
    memcpy(most, scratch, a->width * sizeof *most);
    for (uint32_t d = 1; d <= 2 * a->radius; d++)
        take_max(most, scratch + d, a->width);
    for (uint32_t x = 0; x < a->width; x++) /* mapped memory may be slow to read */
        words[x] = own[x] | (uint32_t)most[x] << 16;
}
