#include "image/mip.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/convert.h"

#include <math.h>
#include <string.h>

/* Everything but the memory. False if it is more than a size_t holds. */
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

/* The source texels that one texel covers along one axis, and how much of it each fills. */
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

/* Rows of the level above, [width][4], and one row of the level that is made. */
struct row_buffers {
    float *source;
    double *sum;
    float *result;
};

static void add_row(const float *source, double weight, double *sum, size_t value_count)
{
    for (size_t i = 0; i < value_count; i++)
        if (!isnan(source[i]))
            sum[i] += weight * source[i];
}

static void filter_along_row(const double *sum, uint32_t source_width, float *result,
                             uint32_t width)
{
    for (uint32_t x = 0; x < width; x++, result += 4) {
        struct taps taps = find_taps(source_width, x);
        const double *texel = sum + 4 * (size_t)taps.first;
        double mean[4] = {0};
        for (uint32_t t = 0; t < taps.count; t++)
            for (uint32_t c = 0; c < 4; c++)
                mean[c] += taps.weights[t] * texel[4 * t + c];
        for (uint32_t c = 0; c < 4; c++) /* opposite infinities make a NaN */
            result[c] = isnan(mean[c]) ? 0.0f : (float)mean[c];
    }
}

static void build_level(struct slc_mip_chain *chain, uint32_t level,
                        const struct row_buffers *buffers)
{
    uint32_t source_width = slc_mip_size(chain->width, level - 1);
    uint32_t source_height = slc_mip_size(chain->height, level - 1);
    uint32_t width = slc_mip_size(chain->width, level);
    uint32_t height = slc_mip_size(chain->height, level);
    size_t texel_size = sluiceGetFormatTexelSize(chain->format);
    const char *source = slc_mip_chain_level(chain, level - 1);
    char *result = slc_mip_chain_level(chain, level);
    for (uint32_t y = 0; y < height; y++) {
        struct taps taps = find_taps(source_height, y);
        memset(buffers->sum, 0, 4 * (size_t)source_width * sizeof *buffers->sum);
        for (uint32_t t = 0; t < taps.count; t++) {
            const char *row = source + (size_t)(taps.first + t) * source_width * texel_size;
            slc_texels_to_rgba(chain->format, row, buffers->source, source_width);
            add_row(buffers->source, taps.weights[t], buffers->sum, 4 * (size_t)source_width);
        }
        filter_along_row(buffers->sum, source_width, buffers->result, width);
        slc_texels_from_rgba(chain->format, buffers->result, result + y * width * texel_size,
                             width);
    }
}

uint64_t slc_mip_chain_build_size(uint32_t width)
{
    const struct row_buffers *buffers = NULL;
    return 4 * (uint64_t)width *
           (sizeof *buffers->source + sizeof *buffers->sum + sizeof *buffers->result);
}

SluiceResult slc_mip_chain_build(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb)
{
    size_t values = 4 * (size_t)chain->width;
    struct row_buffers buffers = {
        .source = slc_alloc(cb, values, sizeof *buffers.source),
        .sum = slc_alloc(cb, values, sizeof *buffers.sum),
        .result = slc_alloc(cb, values, sizeof *buffers.result),
    };
    bool complete = buffers.source && buffers.sum && buffers.result;
    if (complete)
        for (uint32_t level = 1; level < chain->level_count; level++)
            build_level(chain, level, &buffers);
    slc_free(cb, buffers.source, values, sizeof *buffers.source);
    slc_free(cb, buffers.sum, values, sizeof *buffers.sum);
    slc_free(cb, buffers.result, values, sizeof *buffers.result);
    return complete ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
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
