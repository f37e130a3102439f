#include "bake/coverage.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

#define STEPS 65536u
#define MAX_SCALE 16.0f

SluiceResult slc_coverage_init(struct slc_coverage *coverage, const SluiceAllocationCallbacks *cb,
                               uint32_t level_count)
{
    coverage->level_count = level_count;
    coverage->counts = slc_calloc(cb, (size_t)level_count * STEPS, sizeof *coverage->counts);
    return coverage->counts ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_coverage_finish(struct slc_coverage *coverage, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, coverage->counts, (size_t)coverage->level_count * STEPS, sizeof *coverage->counts);
    coverage->counts = NULL;
}

uint64_t slc_coverage_memory(uint32_t level_count)
{
    return (uint64_t)level_count * STEPS * sizeof(uint64_t);
}

/* The step that holds alphas from step / STEPS on. */
static uint32_t alpha_step(float alpha)
{
    if (!(alpha > 0.0f))
        return 0;
    return alpha >= 1.0f ? STEPS - 1 : (uint32_t)(alpha * (float)STEPS);
}

void slc_coverage_add(struct slc_coverage *coverage, uint32_t level, const float *rgba,
                      uint32_t count)
{
    uint64_t *counts = coverage->counts + (size_t)level * STEPS;
    for (uint32_t i = 0; i < count; i++)
        counts[alpha_step(rgba[4 * (size_t)i + 3])]++;
}

static double share_from(const uint64_t *counts, uint32_t step)
{
    uint64_t reached = 0, all = 0;
    for (uint32_t i = 0; i < STEPS; i++) {
        all += counts[i];
        reached += i >= step ? counts[i] : 0;
    }
    return all ? (double)reached / (double)all : 0.0;
}

float slc_coverage_scale(const struct slc_coverage *coverage, uint32_t level, float threshold)
{
    const uint64_t *counts = coverage->counts + (size_t)level * STEPS;
    if (level == 0)
        return 1.0f;
    double wanted = share_from(coverage->counts, (uint32_t)ceilf(threshold * (float)(STEPS)));
    double all = 0.0, reached = 0.0, least = INFINITY;
    for (uint32_t i = 0; i < STEPS; i++)
        all += (double)counts[i];
    uint32_t first = (uint32_t)ceilf(threshold * (float)STEPS), best = first;
    /* From 1 down; of steps that are as near as each other the one next to the threshold. */
    for (uint32_t i = STEPS; i-- > 0;) {
        reached += (double)counts[i];
        float scale = threshold * (float)STEPS / (float)(i ? i : 1);
        if (i == 0 || scale > MAX_SCALE || scale < 1.0f / MAX_SCALE)
            continue;
        double distance = fabs(reached / all - wanted);
        bool is_nearer_threshold = labs((long)i - (long)first) < labs((long)best - (long)first);
        if (distance < least || (distance == least && is_nearer_threshold)) {
            least = distance;
            best = i;
        }
    }
    return best == first ? 1.0f : threshold * (float)STEPS / (float)best;
}
