/**
 * Coverage of cut-outs: the share of visible texels per level, and the scale of alpha that
 * preserves it in coarser levels.
 *
 * Alpha is counted in 65536 steps per level, 512 KiB per level, in a pass before the levels are
 * written. Texels are not kept.
 */
#ifndef SLC_BAKE_COVERAGE_H
#define SLC_BAKE_COVERAGE_H

#include <sluice/base.h>

struct slc_coverage {
    uint32_t level_count;
    uint64_t *counts; ///< [level_count][65536]
};

/** Allocates the counters. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_coverage_init(struct slc_coverage *coverage, const SluiceAllocationCallbacks *cb,
                               uint32_t level_count);
void slc_coverage_finish(struct slc_coverage *coverage, const SluiceAllocationCallbacks *cb);
uint64_t slc_coverage_memory(uint32_t level_count);

/** Counts the alpha of `count` texels of four floats, clamped to [0, 1]. */
void slc_coverage_add(struct slc_coverage *coverage, uint32_t level, const float *rgba,
                      uint32_t count);

/**
 * Returns the scale of alpha for which the share of texels of `level` that reach `threshold` is
 * nearest to the share of level 0. 1 for level 0. At most 16, so that faint texels do not become
 * solid.
 */
float slc_coverage_scale(const struct slc_coverage *coverage, uint32_t level, float threshold);

#endif /* SLC_BAKE_COVERAGE_H */
