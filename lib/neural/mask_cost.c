#include "neural/mask_cost.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "neural/slices.h"

#include <assert.h>
#include <string.h>

#define EXCESS 4.0 /* cost of an excess of 1, added to the penalty */

struct slc_neural_mip_view slc_mask_view(const struct slc_mask_repair *r, uint32_t mip)
{
    struct slc_neural_mip_view view = {.constants = &r->constants,
                                       .mip = mip,
                                       .width = slc_mip_size(r->constants.width, mip),
                                       .height = slc_mip_size(r->constants.height, mip)};
    for (uint32_t g = 0; g < 2; g++) {
        view.slices[g] = r->constants.slices[r->constants.mips[mip].firstSlice + g];
        view.codes[g] = (const uint8_t *)r->info->pLatents + view.slices[g].dataOffset;
    }
    return view;
}

static void decode(const struct slc_mask_repair *r, const struct slc_neural_mip_view *view,
                   const struct slc_mask_run *x, const struct slc_mask_run *y, float *texels)
{
    const uint32_t channels = r->info->channelCount;
    r->way(&(struct slc_neural_job){.view = view,
                                    .shape = &r->shape,
                                    .kind = SLUICE_NEURAL_WEIGHTS_INT8,
                                    .weights = r->info->pInt8Weights,
                                    .fast = r->fast,
                                    .x = x->first,
                                    .y = y->first,
                                    .width = x->count,
                                    .height = y->count,
                                    .channel_count = channels,
                                    .texels = texels,
                                    .pitch = (uint64_t)x->count * channels});
}

static struct slc_mask_texel measure(const SluiceNeuralMaskInfo *info, const float *decoded,
                                     const float *wanted)
{
    struct slc_mask_texel texel = {0.0f, 0.0f};
    for (uint32_t c = 0; c < info->channelCount; c++) {
        const bool is_mask = info->maskChannels >> c & 1;
        const bool is_clamped = is_mask || info->clampedChannels >> c & 1;
        float value = decoded[c];
        if (is_mask && wanted[c] <= 0.0f)
            texel.excess += fmaxf(value, 0.0f);
        if (is_mask && wanted[c] >= 1.0f)
            texel.excess += fmaxf(1.0f - value, 0.0f);
        if (is_clamped)
            value = fmaxf(fminf(value, 1.0f), 0.0f);
        const float error = value - wanted[c];
        texel.squares += error * error * (info->pLossWeights ? info->pLossWeights[c] : 1.0f);
    }
    return texel;
}

static double cost_of(const struct slc_mask_repair *r, struct slc_mask_texel texel)
{
    double cost = (double)texel.squares;
    return texel.excess > 0.0f ? cost + r->penalty * (1.0 + EXCESS * (double)texel.excess) : cost;
}

static SluiceResult decode_mip(struct slc_mask_repair *r, uint32_t mip)
{
    const SluiceNeuralMaskInfo *info = r->info;
    const uint32_t width = slc_mip_size(r->constants.width, mip);
    const uint32_t height = slc_mip_size(r->constants.height, mip), channels = info->channelCount;
    SluiceNeuralDecodeInfo row = {.structSize = sizeof row,
                                  .pConstants = &r->constants,
                                  .pLatents = info->pLatents,
                                  .latentSize = info->latentSize,
                                  .pWeights = info->pInt8Weights,
                                  .weightSize = info->weightSize,
                                  .weightKind = SLUICE_NEURAL_WEIGHTS_INT8,
                                  .mip = mip,
                                  .width = width,
                                  .height = 1,
                                  .channelCount = channels,
                                  .pTexels = r->decoded,
                                  .log = info->log};
    SluiceResult result = SLUICE_SUCCESS;
    for (; row.y < height && result == SLUICE_SUCCESS; row.y++) {
        result = sluiceDecodeNeuralTexels(&row);
        for (uint32_t x = 0; x < width && result == SLUICE_SUCCESS; x++) {
            const size_t at = (size_t)row.y * width + x;
            r->texels[mip][at] =
                measure(info, r->decoded + (size_t)x * channels, info->ppMips[mip] + at * channels);
        }
    }
    return result;
}

static SluiceResult allocate(struct slc_mask_repair *r, const SluiceAllocationCallbacks *cb)
{
    r->decoded_count = (size_t)r->constants.width * SLUICE_NEURAL_MAX_CHANNELS;
    r->decoded = slc_alloc(cb, r->decoded_count, sizeof *r->decoded);
    r->fast = slc_alloc(cb, 1, sizeof *r->fast);
    r->best_latents = slc_alloc(cb, (size_t)r->info->latentSize, 1);
    bool has_all = r->decoded && r->fast && r->best_latents;
    for (uint32_t m = 0; m < r->constants.mipCount && has_all; m++) {
        size_t count =
            (size_t)slc_mip_size(r->constants.width, m) * slc_mip_size(r->constants.height, m);
        r->texels[m] = slc_alloc(cb, count, sizeof *r->texels[m]);
        has_all = r->texels[m] != NULL;
    }
    return has_all ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

SluiceResult slc_mask_init(struct slc_mask_repair *repair, const SluiceNeuralMaskInfo *info)
{
    struct slc_mask_repair *r = repair;
    SluiceAllocationCallbacks cb = slc_allocator(info->pAllocator);
    *r = (struct slc_mask_repair){
        .info = info, .constants = *info->pConstants, .way = slc_neural_fastest_way()};
    SluiceResult result = allocate(r, &cb);
    for (uint32_t m = 0; m < r->constants.mipCount && result == SLUICE_SUCCESS; m++)
        result = decode_mip(r, m); /* checks constants, latents and weights, too */
    if (result != SLUICE_SUCCESS)
        return result;
    r->shape = slc_neural_shape_of(
        r->constants.schema == 3 ? SLUICE_NEURAL_NETWORK_SCHEMA3
                                 : (SluiceNeuralNetwork)(r->constants.networkFeatures / 4 - 1));
    slc_neural_fast_init(r->fast, &r->shape, SLUICE_NEURAL_WEIGHTS_INT8, info->pInt8Weights);
    return SLUICE_SUCCESS;
}

void slc_mask_finish(struct slc_mask_repair *repair)
{
    struct slc_mask_repair *r = repair;
    SluiceAllocationCallbacks cb = slc_allocator(r->info->pAllocator);
    slc_free(&cb, r->runs, r->run_count, sizeof *r->runs);
    slc_free(&cb, r->decoded, r->decoded_count, sizeof *r->decoded);
    slc_free(&cb, r->fast, 1, sizeof *r->fast);
    slc_free(&cb, r->best_latents, (size_t)r->info->latentSize, 1);
    for (uint32_t m = 0; m < r->constants.mipCount; m++) {
        size_t count =
            (size_t)slc_mip_size(r->constants.width, m) * slc_mip_size(r->constants.height, m);
        slc_free(&cb, r->texels[m], count, sizeof *r->texels[m]);
    }
}

/* Counts the runs of one mip: both grids, columns and rows. */
static size_t runs_per_mip(const struct slc_mask_group *group)
{
    return 2 * ((size_t)group->grid_size[0][0] + group->grid_size[0][1] + group->grid_size[1][0] +
                group->grid_size[1][1]);
}

static struct slc_mask_run *runs_of(const struct slc_mask_repair *r, uint32_t mip, uint32_t grid,
                                    uint32_t axis, uint32_t place)
{
    const struct slc_mask_group *group = &r->group;
    size_t at = (mip - group->first_mip) * runs_per_mip(group);
    if (grid)
        at += 2 * ((size_t)group->grid_size[0][0] + group->grid_size[0][1]);
    if (axis)
        at += 2 * (size_t)group->grid_size[grid][0];
    return r->runs + at + 2 * (size_t)place;
}

static void add_to_run(struct slc_mask_run runs[2], uint32_t texel)
{
    uint32_t i = runs[0].count == 0 || runs[0].first + runs[0].count == texel ? 0 : 1;
    if (runs[i].count == 0)
        runs[i].first = texel;
    assert(runs[i].first + runs[i].count == texel);
    runs[i].count++;
}

static void find_runs(struct slc_mask_repair *r, uint32_t mip, uint32_t grid, uint32_t axis)
{
    const struct slc_neural_mip_view view = slc_mask_view(r, mip);
    const uint32_t size = axis ? view.height : view.width;
    for (uint32_t texel = 0; texel < size; texel++) {
        uint32_t corners[2], fraction;
        slc_neural_find_axis(&view, grid, axis, texel, corners, &fraction);
        for (uint32_t i = 0; i < (corners[0] == corners[1] ? 1u : 2u); i++)
            add_to_run(runs_of(r, mip, grid, axis, corners[i]), texel);
    }
}

static uint32_t longest(const struct slc_mask_repair *r, uint32_t mip, uint32_t grid, uint32_t axis)
{
    const struct slc_mask_run *runs = runs_of(r, mip, grid, axis, 0);
    uint32_t most = 0;
    for (uint32_t i = 0; i < 2 * r->group.grid_size[grid][axis]; i++)
        most = slc_max_u32(most, runs[i].count);
    return most;
}

SluiceResult slc_mask_select(struct slc_mask_repair *repair, uint32_t first_mip)
{
    struct slc_mask_repair *r = repair;
    SluiceAllocationCallbacks cb = slc_allocator(r->info->pAllocator);
    const struct slc_neural_mip_view view = slc_mask_view(r, first_mip);
    struct slc_mask_group group = {.first_mip = first_mip};
    while (first_mip + group.mip_count < r->constants.mipCount &&
           r->constants.mips[first_mip + group.mip_count].firstSlice ==
               r->constants.mips[first_mip].firstSlice)
        group.mip_count++;
    for (uint32_t g = 0; g < 2; g++) {
        group.grid_size[g][0] = view.slices[g].gridSize & 0xFFFF;
        group.grid_size[g][1] = view.slices[g].gridSize >> 16;
    }
    slc_free(&cb, r->runs, r->run_count, sizeof *r->runs);
    r->group = group;
    r->run_count = group.mip_count * runs_per_mip(&group);
    r->runs = slc_calloc(&cb, r->run_count, sizeof *r->runs);
    size_t most = r->constants.width; /* texels for slc_mask_count_group */
    for (uint32_t i = 0; i < 2 * group.mip_count && r->runs; i++) {
        const uint32_t mip = first_mip + i / 2, grid = i % 2;
        find_runs(r, mip, grid, 0);
        find_runs(r, mip, grid, 1);
        size_t texels = (size_t)longest(r, mip, grid, 0) * longest(r, mip, grid, 1);
        most = texels > most ? texels : most;
    }
    slc_free(&cb, r->decoded, r->decoded_count, sizeof *r->decoded);
    r->decoded_count = most * SLUICE_NEURAL_MAX_CHANNELS;
    r->decoded = r->runs ? slc_alloc(&cb, r->decoded_count, sizeof *r->decoded) : NULL;
    return r->decoded ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

SluiceResult slc_mask_count_group(struct slc_mask_repair *repair)
{
    const struct slc_mask_group *group = &repair->group;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < group->mip_count && result == SLUICE_SUCCESS; i++)
        result = decode_mip(repair, group->first_mip + i);
    return result;
}

/* Finds byte and bit of a code. */
static uint8_t *find_code(const struct slc_mask_repair *r, const struct slc_mask_code *code,
                          uint32_t *bits, uint32_t *shift)
{
    const SluiceNeuralConstants *k = &r->constants;
    const uint32_t features = code->grid ? k->lowFeatures : k->highFeatures;
    *bits = code->grid ? k->lowBits : k->highBits;
    const uint32_t slice = k->mips[r->group.first_mip].firstSlice + code->grid;
    const uint64_t texel = (uint64_t)code->y * r->group.grid_size[code->grid][0] + code->x;
    const uint64_t bit = (texel * features + code->feature) * *bits;
    *shift = (uint32_t)(bit % 8);
    return (uint8_t *)r->info->pLatents + k->slices[slice].dataOffset + bit / 8;
}

uint32_t slc_mask_get_code(const struct slc_mask_repair *repair, const struct slc_mask_code *code)
{
    uint32_t bits, shift;
    const uint8_t *byte = find_code(repair, code, &bits, &shift);
    return (uint32_t)*byte >> shift & ((1u << bits) - 1);
}

void slc_mask_set_code(const struct slc_mask_repair *repair, const struct slc_mask_code *code,
                       uint32_t value)
{
    uint32_t bits, shift;
    uint8_t *byte = find_code(repair, code, &bits, &shift);
    const uint32_t mask = ((1u << bits) - 1) << shift;
    *byte = (uint8_t)((*byte & ~mask) | value << shift);
}

/* Visits the texels of a code: up to four rectangles of each mip. */
static double visit(const struct slc_mask_repair *r, const struct slc_mask_code *code, double limit,
                    bool keeps)
{
    const uint32_t channels = r->info->channelCount;
    double more = 0.0, before = 0.0;
    for (int pass = keeps ? 1 : 0; pass < 2; pass++)
        for (uint32_t i = 0; i < 4 * r->group.mip_count; i++) {
            const uint32_t mip = r->group.first_mip + i / 4;
            const struct slc_mask_run *x = runs_of(r, mip, code->grid, 0, code->x) + i % 2;
            const struct slc_mask_run *y = runs_of(r, mip, code->grid, 1, code->y) + i / 2 % 2;
            const struct slc_neural_mip_view view = slc_mask_view(r, mip);
            if (x->count == 0 || y->count == 0)
                continue;
            if (pass)
                decode(r, &view, x, y, r->decoded);
            for (uint32_t t = 0; t < x->count * y->count; t++) {
                const size_t at =
                    (size_t)(y->first + t / x->count) * view.width + x->first + t % x->count;
                struct slc_mask_texel *texel = &r->texels[mip][at];
                if (!pass) {
                    before += cost_of(r, *texel);
                    continue;
                }
                struct slc_mask_texel now = measure(r->info, r->decoded + (size_t)t * channels,
                                                    r->info->ppMips[mip] + at * channels);
                more += cost_of(r, now);
                if (keeps)
                    *texel = now;
            }
            if (pass && !keeps && more - before > limit)
                return more - before; /* further texels can only increase the sum */
        }
    return more - before;
}

double slc_mask_compare(const struct slc_mask_repair *repair, const struct slc_mask_code *code,
                        double limit)
{
    return visit(repair, code, limit, false);
}

void slc_mask_count(const struct slc_mask_repair *repair, const struct slc_mask_code *code)
{
    visit(repair, code, 0.0, true);
}

struct slc_mask_texel slc_mask_decode_texel(const struct slc_mask_repair *repair, uint32_t mip,
                                            uint32_t x, uint32_t y)
{
    const struct slc_neural_mip_view view = slc_mask_view(repair, mip);
    const struct slc_mask_run column = {x, 1}, row = {y, 1};
    const size_t at = (size_t)y * view.width + x;
    float outputs[SLUICE_NEURAL_MAX_CHANNELS];
    decode(repair, &view, &column, &row, outputs);
    return measure(repair->info, outputs,
                   repair->info->ppMips[mip] + at * repair->info->channelCount);
}
