/** Chance that the walking lattice of shaders/include/sluice/stochastic.glsl misses a region. */
#ifndef SLC_CORE_FEEDBACK_LATTICE_H
#define SLC_CORE_FEEDBACK_LATTICE_H

#include <stdint.h>

/* Pixels of a lattice cell, and frames in which the lattice visits all of them. */
#define SLC_LATTICE_PHASES 64

/**
 * Returns the share of first frames from which `frames` (at least 1) frames, `step` apart, miss
 * every pixel of a region of width x height pixels in its worst position. Step 0: the distances are
 * unequal and unknown, so only one frame counts.
 */
double slc_lattice_miss(uint32_t width, uint32_t height, double frames, uint32_t step);

/** Returns the number of frames, `step` apart, until one meets the region: median over all first
 *  frames, and the longest. Infinity: never. */
void slc_lattice_frames(uint32_t width, uint32_t height, uint32_t step, double *median,
                        double *longest);

#endif /* SLC_CORE_FEEDBACK_LATTICE_H */
