#include "image/mip.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/convert.h"
#include "image/format_size.h"

#include <math.h>
#include <string.h>

/* Computes everything but the memory. False if the size exceeds size_t. */
static bool plan(struct slc_mip_chain *chain, SluiceFormat format, uint32_t width, uint32_t height)
{
    *chain = (struct slc_mip_chain){.format = format, .width = width, .height = height};
    chain->level_count = slc_mip_count(slc_max_u32(width, height));
    size_t texel_size = sluiceGetFormatTexelSize(format);
    for (uint32_t level = 0; level < chain->level_count; level++) {
        size_t size;
        chain->offsets[level] = chain->size;
        if (!slc_mul_size(slc_mip_size(width, level), slc_mip_size(height, level), &size) ||
            !slc_mul_size(size, texel_size, &size) ||
            !slc_add_size(chain->size, size, &chain->size))
            return false;
    }
    return true;
}

uint64_t slc_mip_chain_size(SluiceFormat format, uint32_t width, uint32_t height)
{
    struct slc_mip_chain chain;
    return plan(&chain, format, width, height) ? chain.size : UINT64_MAX;
}

SluiceResult slc_mip_chain_init(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb,
                                SluiceFormat format, uint32_t width, uint32_t height)
{
    if (plan(chain, format, width, height))
        chain->texels = slc_alloc(cb, chain->size, 1);
    return chain->texels ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_mip_chain_finish(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, chain->texels, chain->size, 1);
    chain->texels = NULL;
}

/* Source texels that one texel covers along one axis, and their weights. */
struct taps {
    uint32_t first, count;
    double weights[3];
};

/* `size` is the source's; the level below has max(1, size / 2) texels. */
static struct taps find_taps(uint32_t size, uint32_t i)
{
    if (size == 1)
        return (struct taps){0, 1, {1.0}};
    if (size % 2 == 0)
        return (struct taps){2 * i, 2, {0.5, 0.5}};
    /* 2n + 1 texels on n: each covers 2 + 1/n of them, beginning i/n after texel 2i */
    double n = size / 2, total = size;
    return (struct taps){2 * i, 3, {(n - i) / total, n / total, (i + 1) / total}};
}

static void add_row(const float *source, double weight, double *sum, size_t value_count)
{
    for (size_t i = 0; i < value_count; i++)
        if (!isnan(source[i]))
            sum[i] += weight * source[i];
}

/* `sum` begins with texel `first` of the level above, which is `source_width` texels wide. */
static void filter_along_row(const double *sum, uint32_t first, uint32_t source_width,
                             float *result, uint32_t x, uint32_t width)
{
    for (uint32_t end = x + width; x < end; x++, result += 4) {
        struct taps taps = find_taps(source_width, x);
        const double *texel = sum + 4 * (size_t)(taps.first - first);
        double mean[4] = {0};
        for (uint32_t t = 0; t < taps.count; t++)
            for (uint32_t c = 0; c < 4; c++)
                mean[c] += taps.weights[t] * texel[4 * t + c];
        for (uint32_t c = 0; c < 4; c++) /* opposite infinities make a NaN */
            result[c] = isnan(mean[c]) ? 0.0f : (float)mean[c];
    }
}

static void cover(uint32_t size, uint32_t first, uint32_t count, uint32_t *covered,
                  uint32_t *covered_count)
{
    struct taps low = find_taps(size, first), high = find_taps(size, first + count - 1);
    *covered = low.first;
    *covered_count = high.first + high.count - low.first;
}

void slc_mip_part_cover(const struct slc_mip_part *coarse, struct slc_mip_part *fine)
{
    cover(fine->level_width, coarse->x, coarse->width, &fine->x, &fine->width);
    cover(fine->level_height, coarse->y, coarse->height, &fine->y, &fine->height);
}

uint64_t slc_mip_rows_size(uint32_t width)
{
    const struct slc_mip_rows *rows = NULL;
    return 4 * (uint64_t)width * (sizeof *rows->source + sizeof *rows->sum + sizeof *rows->result);
}

SluiceResult slc_mip_rows_init(struct slc_mip_rows *rows, const SluiceAllocationCallbacks *cb,
                               uint32_t width)
{
    size_t values = 4 * (size_t)width;
    *rows = (struct slc_mip_rows){.source = slc_alloc(cb, values, sizeof *rows->source),
                                  .sum = slc_alloc(cb, values, sizeof *rows->sum),
                                  .result = slc_alloc(cb, values, sizeof *rows->result),
                                  .width = width};
    if (rows->source && rows->sum && rows->result)
        return SLUICE_SUCCESS;
    slc_mip_rows_finish(rows, cb);
    return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_mip_rows_finish(struct slc_mip_rows *rows, const SluiceAllocationCallbacks *cb)
{
    size_t values = 4 * (size_t)rows->width;
    slc_free(cb, rows->source, values, sizeof *rows->source);
    slc_free(cb, rows->sum, values, sizeof *rows->sum);
    slc_free(cb, rows->result, values, sizeof *rows->result);
    *rows = (struct slc_mip_rows){0};
}

/* Returns the fine texel at the center of coarse texel `i`. A size of 2n + 1 has one, 2i + 1. A
 * size of 2n has two, and levels take the right one and the left one in turns. Always the same one
 * would end in a corner, half a texel off. */
static uint32_t find_center(uint32_t size, uint32_t i)
{
    if (size == 1)
        return 0;
    return 2 * i + (size % 2 == 1 || slc_mip_count(size) % 2 == 0);
}

/* Integers are picked, not averaged: the mean of two ids would be another id. */
static void pick_texels(size_t texel_size, const struct slc_mip_part *fine,
                        const struct slc_mip_part *coarse)
{
    for (uint32_t y = 0; y < coarse->height; y++) {
        uint32_t row = find_center(fine->level_height, coarse->y + y) - fine->y;
        char *to = coarse->texels + y * coarse->pitch;
        for (uint32_t x = 0; x < coarse->width; x++) {
            uint32_t column = find_center(fine->level_width, coarse->x + x) - fine->x;
            memcpy(to + x * texel_size, fine->texels + row * fine->pitch + column * texel_size,
                   texel_size);
        }
    }
}

void slc_mip_filter(SluiceFormat format, const struct slc_mip_part *fine,
                    const struct slc_mip_part *coarse, const struct slc_mip_rows *rows)
{
    if (slc_format_is_integer(format)) {
        pick_texels(sluiceGetFormatTexelSize(format), fine, coarse);
        return;
    }
    for (uint32_t y = 0; y < coarse->height; y++) {
        struct taps taps = find_taps(fine->level_height, coarse->y + y);
        memset(rows->sum, 0, 4 * (size_t)fine->width * sizeof *rows->sum);
        for (uint32_t t = 0; t < taps.count; t++) {
            slc_texels_to_rgba(format, fine->texels + (taps.first + t - fine->y) * fine->pitch,
                               rows->source, fine->width);
            add_row(rows->source, taps.weights[t], rows->sum, 4 * (size_t)fine->width);
        }
        filter_along_row(rows->sum, fine->x, fine->level_width, rows->result, coarse->x,
                         coarse->width);
        slc_texels_from_rgba(format, rows->result, coarse->texels + y * coarse->pitch,
                             coarse->width);
    }
}

static struct slc_mip_part whole_level(const struct slc_mip_chain *chain, uint32_t level)
{
    uint32_t width = slc_mip_size(chain->width, level), height = slc_mip_size(chain->height, level);
    return (struct slc_mip_part){.level_width = width,
                                 .level_height = height,
                                 .width = width,
                                 .height = height,
                                 .texels = slc_mip_chain_level(chain, level),
                                 .pitch = width * (size_t)sluiceGetFormatTexelSize(chain->format)};
}

SluiceResult slc_mip_chain_build(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb)
{
    struct slc_mip_rows rows;
    SluiceResult result = slc_mip_rows_init(&rows, cb, chain->width);
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t level = 1; level < chain->level_count; level++) {
        struct slc_mip_part fine = whole_level(chain, level - 1);
        struct slc_mip_part coarse = whole_level(chain, level);
        slc_mip_filter(chain->format, &fine, &coarse, &rows);
    }
    slc_mip_rows_finish(&rows, cb);
    return SLUICE_SUCCESS;
}

void slc_mip_chain_read(const struct slc_mip_chain *chain, const SluiceImageRegion *region,
                        void *texels, size_t row_pitch)
{
    size_t texel_size = sluiceGetFormatTexelSize(chain->format);
    size_t pitch = slc_mip_size(chain->width, region->mipLevel) * texel_size;
    const char *source =
        slc_mip_chain_level(chain, region->mipLevel) + region->y * pitch + region->x * texel_size;
    for (uint32_t y = 0; y < region->height; y++)
        memcpy((char *)texels + y * row_pitch, source + y * pitch, region->width * texel_size);
}
