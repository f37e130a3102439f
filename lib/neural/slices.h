/** Slices: rectangles of grids for the texels of a request. docs/neural.md has the rules. */
#ifndef SLC_NEURAL_SLICES_H
#define SLC_NEURAL_SLICES_H

#include "neural/neural_set.h"

#include <math.h>

/** Most bytes of latents per request, so that bit offsets fit in 32 bits. */
#define SLC_NEURAL_MAX_LATENTS ((uint64_t)1 << 29)

/** Request: a rectangle in `first_mip`, and `mip_count` mips. All lie in the set. */
struct slc_neural_request {
    uint32_t first_mip, mip_count;
    uint32_t origin[2], size[2]; ///< x and y
};

/**
 * Returns 256 times the position of texel `x` of a mip of `size` texels in a grid of `grid` texels.
 * The center of grid texel 0 is 0. Bits 8 and up are the lower corner, the others the fraction.
 * Sizes are at most 2^15.
 */
static inline int32_t slc_neural_place(uint32_t x, uint32_t grid, uint32_t size)
{
    uint32_t a = (2 * x + 1) * grid, b = 2 * size;
    return (int32_t)(a / b * 256 + a % b * 256 / b) - 128;
}

/** Returns floor(place / 256), without a shift of a negative number. */
static inline int32_t slc_neural_corner(int32_t place)
{
    return (place + 256) / 256 - 1;
}

/** Returns the network's input for a position wave or level. Decision 86: why schemas differ. */
static inline int32_t slc_neural_wave_code(uint32_t schema, float value)
{
    float code = schema == 1 ? value * 127.5f : floorf(value * 127.5f - 0.5f);
    float least = schema == 1 ? -128.0f : -127.0f;
    return (int32_t)(code < least ? least : code > 127.0f ? 127.0f : code);
}

/** Returns the bytes of a slice, padded to a multiple of 4. */
uint64_t slc_neural_slice_bytes(uint32_t width, uint32_t height, uint32_t bits_per_texel);

/**
 * Fills the slices for the request; dataOffset counts from 0. Other slices stay unchanged. Returns
 * the bytes of all slices.
 */
uint64_t slc_neural_make_slices(const SluiceNeuralSet *set,
                                const struct slc_neural_request *request,
                                SluiceNeuralSlice slices[SLC_NEURAL_MAX_GRIDS]);

/** Fills slices with all grids as a whole, also unused grids. Returns their bytes. */
uint64_t slc_neural_whole_slices(const SluiceNeuralSet *set,
                                 SluiceNeuralSlice slices[SLC_NEURAL_MAX_GRIDS]);

/** Fills all constants except the slices. */
void slc_neural_fill_constants(const SluiceNeuralSet *set, const struct slc_neural_request *request,
                               SluiceNeuralConstants *constants);

/** Returns an upper bound for the bytes of a request of this size, whose origin is a multiple of
 *  `alignment`, a power of two. Ignores `request->origin`. */
uint64_t slc_neural_bound_slices(const SluiceNeuralSet *set,
                                 const struct slc_neural_request *request, uint32_t alignment);

#endif /* SLC_NEURAL_SLICES_H */
