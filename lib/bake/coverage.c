#include "bake/coverage.h"

#include "base/alloc.h"

#include <math.h>

#define STEPS 65536u
#define MAX_SCALE 16u

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

/* Returns the step of an alpha. Step s has alphas from s / STEPS on. */
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

static uint64_t count_from(const uint64_t *counts, uint32_t step)
{
    uint64_t count = 0;
    for (uint32_t i = step; i < STEPS; i++)
        count += counts[i];
    return count;
}

/* Returns the first step whose alphas all reach the threshold. Alpha 1 is in the last step. */
static uint32_t step_of(float threshold)
{
    uint32_t step = (uint32_t)ceilf(threshold * (float)STEPS);
    return step < STEPS ? step : STEPS - 1;
}

static uint32_t distance(uint32_t a, uint32_t b)
{
    return a > b ? a - b : b - a;
}

/* Finds the step from which on the share of texels is nearest to `wanted`, from the last step down.
 * Among equal steps, returns the step nearest to `first`. */
static uint32_t find_step(const uint64_t *counts, double wanted, uint32_t first)
{
    double all = (double)count_from(counts, 0), least = INFINITY;
    uint64_t reached = 0;
    uint32_t best = first, lowest = first / MAX_SCALE + 1;
    for (uint32_t i = STEPS - 1; i >= lowest; i--) {
        reached += counts[i];
        double error = fabs((double)reached / all - wanted);
        if (error < least || (error == least && distance(i, first) < distance(best, first))) {
            least = error;
            best = i;
        }
    }
    return best;
}

float slc_coverage_scale(const struct slc_coverage *coverage, uint32_t level, float threshold)
{
    const uint64_t *above = coverage->counts, *counts = above + (size_t)level * STEPS;
    uint32_t first = step_of(threshold);
    if (level == 0)
        return 1.0f;
    double wanted = (double)count_from(above, first) / (double)count_from(above, 0);
    uint32_t best = find_step(counts, wanted, first);
    return best == first ? 1.0f : threshold * (float)STEPS / (float)best;
}
