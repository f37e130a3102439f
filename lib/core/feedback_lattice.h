/** How the walking lattice of shaders/include/sluice/stochastic.glsl meets a region: what it
 * misses. */
#ifndef SLC_CORE_FEEDBACK_LATTICE_H
#define SLC_CORE_FEEDBACK_LATTICE_H

#include <stdint.h>

/* Pixels of the lattice and frames in which it comes to all of them. */
#define SLC_LATTICE_PHASES 64

/**
 * The share of first frames from which `frames` (at least 1) frames, `step` apart, miss every pixel
 * of a region of width x height pixels, where it lies worst. Step 0: at unequal distances, of which
 * nothing is known, so that one frame alone counts.
 */
double slc_lattice_miss(uint32_t width, uint32_t height, double frames, uint32_t step);

/** Such frames until the first of them meets it: from half of all first frames, and from all of
 *  them; infinity: never. */
void slc_lattice_frames(uint32_t width, uint32_t height, uint32_t step, double *median,
                        double *longest);

#endif /* SLC_CORE_FEEDBACK_LATTICE_H */
