/** Tiles that the GPU makes of latents, beside copies of the same texels. */
#ifndef BENCH_NEURAL_TILES_H
#define BENCH_NEURAL_TILES_H

#include "material.h"
#include "stopwatch.h"

/**
 * Measures tiles of 64 KiB per second for each format, and for RGBA8 tiles that are copied from
 * device memory and from host memory. Prints figures. Reports errors on stderr.
 */
bool tiles_measure(const struct gpu *gpu, const struct material *material,
                   const struct stopwatch *stopwatch, uint32_t repeats);

#endif /* BENCH_NEURAL_TILES_H */
