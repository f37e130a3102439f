/**
 * How much of each level of a cut-out is there, and by what its alpha is scaled so that this stays.
 *
 * Alpha is counted in 65536 steps per level, half a MiB each, in a pass before the levels are
 * written; nothing of the levels themselves is kept.
 */
#ifndef SLC_BAKE_COVERAGE_H
#define SLC_BAKE_COVERAGE_H

#include <sluice/base.h>

struct slc_coverage {
    uint32_t level_count;
    uint64_t *counts; ///< [level_count][65536]
};

/** Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_coverage_init(struct slc_coverage *coverage, const SluiceAllocationCallbacks *cb,
                               uint32_t level_count);
void slc_coverage_finish(struct slc_coverage *coverage, const SluiceAllocationCallbacks *cb);
uint64_t slc_coverage_memory(uint32_t level_count);

/** Alpha of `count` texels of four floats, clamped to [0, 1]. */
void slc_coverage_add(struct slc_coverage *coverage, uint32_t level, const float *rgba,
                      uint32_t count);

/**
 * What alpha of `level` is multiplied by so that the share of texels that reach `threshold` is as
 * near as can be to that of level 0. 1 for level 0; at most 16, so that what is hardly there does
 * not become solid.
 */
float slc_coverage_scale(const struct slc_coverage *coverage, uint32_t level, float threshold);

#endif /* SLC_BAKE_COVERAGE_H */
