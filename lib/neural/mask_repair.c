/* Repair of masks: changes one or two codes of latents at a time, until masks decode to exactly 0
 * and 1. */
#include "neural/mask_cost.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"

#include <math.h>
#include <string.h>

#define PASSES 40
#define FIRST_PENALTY 0.01 /* most squared error for one more exact texel; doubles per pass */
#define MOST_PENALTY 5.0
#define PAIRS_FROM 3 /* first pass with changes of two codes */
#define KICKS_FROM 9 /* from here on, every third pass may make other texels inexact */
#define MOVES 12     /* most changes for one texel in a pass */
#define SEEDS 6      /* first changes of pairs to try */
#define REACH 3      /* largest change of a code */

/* Change of a code, and its cost. */
struct move {
    struct slc_mask_code code;
    uint32_t value;
    double cost;
};

/* Texel to repair. */
struct target {
    uint32_t mip, x, y;
};

/* The SEEDS cheapest changes, cheapest first. */
struct best_moves {
    struct move moves[SEEDS];
    uint32_t count, limit;
};

static void insert(struct best_moves *best, const struct move *move)
{
    if (best->count == best->limit && move->cost >= best->moves[best->count - 1].cost)
        return;
    uint32_t at = best->count < best->limit ? best->count++ : best->count - 1;
    for (; at > 0 && best->moves[at - 1].cost > move->cost; at--)
        best->moves[at] = best->moves[at - 1];
    best->moves[at] = *move;
}

static double worst(const struct best_moves *best)
{
    return best->count == best->limit ? best->moves[best->count - 1].cost : INFINITY;
}

/* Tries all changes of a code that improve the target. */
static void try_code(const struct slc_mask_repair *r, const struct target *target,
                     const struct slc_mask_code *code, float excess, struct best_moves *best)
{
    const uint32_t bits = code->grid ? r->constants.lowBits : r->constants.highBits;
    const int32_t kept = (int32_t)slc_mask_get_code(r, code), last = (1 << bits) - 1;
    for (int32_t direction = -1; direction <= 1; direction += 2)
        for (int32_t step = 1; step <= REACH; step++) {
            const int32_t value = kept + direction * step;
            if (value < 0 || value > last)
                break;
            slc_mask_set_code(r, code, (uint32_t)value);
            if (!(slc_mask_decode_texel(r, target->mip, target->x, target->y).excess < excess))
                break;
            const struct move move = {*code, (uint32_t)value,
                                      slc_mask_compare(r, code, worst(best))};
            insert(best, &move);
        }
    slc_mask_set_code(r, code, (uint32_t)kept);
}

static void try_all(const struct slc_mask_repair *r, const struct target *target,
                    struct best_moves *best)
{
    const struct slc_neural_mip_view view = slc_mask_view(r, target->mip);
    const float excess = slc_mask_decode_texel(r, target->mip, target->x, target->y).excess;
    for (uint32_t g = 0; g < 2; g++) {
        const uint32_t features = g ? r->constants.lowFeatures : r->constants.highFeatures;
        struct slc_neural_corners corners;
        slc_neural_find_corners(&view, g, target->x, target->y, &corners);
        for (uint32_t i = 0; i < 4 * features; i++) {
            const uint32_t texel = corners.texels[i / features], width = r->group.grid_size[g][0];
            const struct slc_mask_code code = {g, texel % width, texel / width, i % features};
            bool is_first = corners.weights[i / features] > 0;
            for (uint32_t k = 0; k < i / features; k++)
                is_first = is_first && corners.texels[k] != texel;
            if (is_first)
                try_code(r, target, &code, excess, best);
        }
    }
}

static void apply(struct slc_mask_repair *r, const struct slc_mask_code *code, uint32_t value)
{
    slc_mask_set_code(r, code, value);
    slc_mask_count(r, code);
}

static bool apply_two(struct slc_mask_repair *r, const struct target *target,
                      const struct move *first)
{
    const uint32_t kept = slc_mask_get_code(r, &first->code);
    struct best_moves second = {.limit = 1};
    apply(r, &first->code, first->value);
    try_all(r, target, &second);
    if (second.count > 0 && second.moves[0].cost + first->cost < 0.0) {
        apply(r, &second.moves[0].code, second.moves[0].value);
        return true;
    }
    apply(r, &first->code, kept);
    return false;
}

/* Applies a change or a pair of changes with negative cost, or a kick. False: no change. */
static bool improve(struct slc_mask_repair *r, const struct target *target, uint32_t pass)
{
    struct best_moves best = {.limit = SEEDS};
    try_all(r, target, &best);
    if (best.count == 0)
        return false;
    bool is_accepted = best.moves[0].cost < 0.0;
    for (uint32_t i = 0; i < best.count && !is_accepted && pass >= PAIRS_FROM; i++)
        if (apply_two(r, target, &best.moves[i]))
            return true;
    /* A kick leaves a local optimum; repairs of other texels may then continue. */
    const bool is_kick = !is_accepted && pass >= KICKS_FROM && pass % 3 == 0;
    const struct move *move = &best.moves[is_kick ? pass / 3 % best.count : 0];
    if (is_accepted || is_kick)
        apply(r, &move->code, move->value);
    return is_accepted || is_kick;
}

static void repair_mip(struct slc_mask_repair *r, uint32_t mip, uint32_t pass)
{
    const uint32_t width = slc_mip_size(r->constants.width, mip);
    const uint32_t height = slc_mip_size(r->constants.height, mip);
    for (uint32_t i = 0; i < width * height; i++) {
        const struct target target = {mip, i % width, i / width};
        for (int k = 0; k < MOVES && r->texels[mip][i].excess > 0.0f; k++)
            if (!improve(r, &target, pass))
                break;
    }
}

static uint64_t count_wrong(const struct slc_mask_repair *r, uint32_t first, uint32_t count)
{
    uint64_t wrong = 0;
    for (uint32_t m = first; m < first + count; m++) {
        const size_t texels =
            (size_t)slc_mip_size(r->constants.width, m) * slc_mip_size(r->constants.height, m);
        for (size_t i = 0; i < texels; i++)
            wrong += r->texels[m][i].excess > 0.0f;
    }
    return wrong;
}

/* Repairs a group, cheap changes first: the penalty rises with every pass. Kicks may increase the
 * error, so the best latents are kept. */
static SluiceResult repair_group(struct slc_mask_repair *r)
{
    const struct slc_mask_group *group = &r->group;
    uint64_t least = count_wrong(r, group->first_mip, group->mip_count), wrong = least;
    r->penalty = FIRST_PENALTY;
    for (uint32_t pass = 0; pass < PASSES && wrong > 0; pass++) {
        if (pass == KICKS_FROM)
            memcpy(r->best_latents, r->info->pLatents, (size_t)r->info->latentSize);
        for (uint32_t m = group->first_mip; m < group->first_mip + group->mip_count; m++)
            repair_mip(r, m, pass);
        wrong = count_wrong(r, group->first_mip, group->mip_count);
        if (pass >= KICKS_FROM && wrong < least)
            memcpy(r->best_latents, r->info->pLatents, (size_t)r->info->latentSize);
        least = pass < KICKS_FROM || wrong < least ? wrong : least;
        r->penalty = fmin(2.0 * r->penalty, MOST_PENALTY);
    }
    if (wrong == least)
        return SLUICE_SUCCESS;
    memcpy(r->info->pLatents, r->best_latents, (size_t)r->info->latentSize);
    return slc_mask_count_group(r);
}

static uint64_t count_certain(const SluiceNeuralMaskInfo *info)
{
    const SluiceNeuralConstants *k = info->pConstants;
    uint64_t certain = 0;
    for (uint32_t m = 0; m < k->mipCount; m++) {
        const size_t texels = (size_t)slc_mip_size(k->width, m) * slc_mip_size(k->height, m);
        for (size_t i = 0; i < texels; i++) {
            bool is_certain = false;
            for (uint32_t c = 0; c < info->channelCount; c++) {
                const float wanted = info->ppMips[m][i * info->channelCount + c];
                is_certain |= (info->maskChannels >> c & 1) && (wanted <= 0.0f || wanted >= 1.0f);
            }
            certain += is_certain;
        }
    }
    return certain;
}

/* Checks for finite values: NaN would make comparisons of costs arbitrary. */
static SluiceResult check_values(const SluiceNeuralMaskInfo *info)
{
    const SluiceNeuralConstants *k = info->pConstants;
    for (uint32_t c = 0; info->pLossWeights && c < info->channelCount; c++)
        if (!isfinite(info->pLossWeights[c]))
            return slc_log_refusal(&info->log, "pLossWeights[%u] is not finite", c);
    for (uint32_t m = 0; m < k->mipCount; m++) {
        const uint32_t width = slc_mip_size(k->width, m);
        const size_t row = (size_t)width * info->channelCount;
        const size_t count = row * slc_mip_size(k->height, m);
        for (size_t i = 0; i < count; i++)
            if (!isfinite(info->ppMips[m][i]))
                return slc_log_refusal(
                    &info->log, "channel %zu of texel %zu, %zu of mip %u is not finite",
                    i % info->channelCount, i % row / info->channelCount, i / row, m);
    }
    return SLUICE_SUCCESS;
}

/* Checks that slices are whole grids, which codes are addressed in. Decoding checks the rest. */
static SluiceResult check(const SluiceNeuralMaskInfo *info)
{
    const SluiceNeuralConstants *k = info->pConstants;
    if (k->mipCount == 0 || k->mipCount > SLUICE_NEURAL_MAX_MIPS)
        return slc_log_refusal(&info->log, "mipCount is %u, must be 1 to %d", k->mipCount,
                               SLUICE_NEURAL_MAX_MIPS);
    if (k->width == 0 || k->width > SLUICE_NEURAL_MAX_SIZE || k->height == 0 ||
        k->height > SLUICE_NEURAL_MAX_SIZE)
        return slc_log_refusal(&info->log, "mip 0 has %u x %u texels, must have 1 to %d each way",
                               k->width, k->height, SLUICE_NEURAL_MAX_SIZE);
    if (info->channelCount == 0 || info->channelCount > SLUICE_NEURAL_MAX_CHANNELS)
        return slc_log_refusal(&info->log, "channelCount is %u, must be 1 to %d",
                               info->channelCount, SLUICE_NEURAL_MAX_CHANNELS);
    for (uint32_t m = 0; m < k->mipCount; m++) {
        if (!info->ppMips[m])
            return SLUICE_ERROR_NULL_POINTER;
        if (k->mips[m].firstSlice > 14)
            return slc_log_refusal(&info->log, "mips[%u].firstSlice is %u, must be 0 to 14", m,
                                   k->mips[m].firstSlice);
        if (m > 0 && k->mips[m].firstSlice != k->mips[m - 1].firstSlice &&
            k->mips[m].firstSlice < k->mips[m - 1].firstSlice + 2u)
            return slc_log_refusal(&info->log,
                                   "mips[%u].firstSlice is %u after %u: must be equal or "
                                   "at least 2 more",
                                   m, k->mips[m].firstSlice, k->mips[m - 1].firstSlice);
        for (uint32_t g = 0; g < 2; g++) {
            const SluiceNeuralSlice *slice = &k->slices[k->mips[m].firstSlice + g];
            if (slice->origin != 0 || slice->sliceSize != slice->gridSize)
                return slc_log_refusal(&info->log, "slices[%u] is no whole grid",
                                       k->mips[m].firstSlice + g);
        }
    }
    return SLUICE_SUCCESS;
}

static SluiceResult repair_all(struct slc_mask_repair *r, SluiceNeuralMaskReport *report)
{
    const uint32_t mips = r->constants.mipCount;
    SluiceResult result = SLUICE_SUCCESS;
    report->texelCount = count_certain(r->info);
    report->wrongBefore = report->wrongAfter = count_wrong(r, 0, mips);
    if (r->info->maxWrongCount && report->wrongBefore > r->info->maxWrongCount)
        return SLUICE_SUCCESS;
    for (uint32_t m = 0; m < mips && result == SLUICE_SUCCESS; m += r->group.mip_count) {
        result = slc_mask_select(r, m);
        if (result == SLUICE_SUCCESS)
            result = repair_group(r);
    }
    report->wrongAfter = count_wrong(r, 0, mips);
    return result;
}

SluiceResult sluiceRepairNeuralMasks(const SluiceNeuralMaskInfo *pInfo,
                                     SluiceNeuralMaskReport *pReport)
{
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralMaskInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralMaskInfo), &info, pInfo, &pInfo->log);
    if (result == SLUICE_SUCCESS && pReport)
        result = slc_struct_check(SLC_STRUCT(SluiceNeuralMaskReport), pReport, &info.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info.pConstants || !info.pLatents || !info.pInt8Weights || !info.ppMips ||
        !slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    result = check(&info);
    if (result == SLUICE_SUCCESS)
        result = check_values(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_mask_repair repair;
    SluiceNeuralMaskReport report = {.structSize = sizeof report};
    result = slc_mask_init(&repair, &info);
    if (result == SLUICE_SUCCESS)
        result = repair_all(&repair, &report);
    slc_mask_finish(&repair);
    if (result == SLUICE_SUCCESS && pReport)
        slc_struct_write(SLC_STRUCT(SluiceNeuralMaskReport), pReport, &report);
    return result;
}
