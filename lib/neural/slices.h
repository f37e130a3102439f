/** Which rectangle of a grid the texels of a request take. docs/neural.md has the rules. */
#ifndef SLC_NEURAL_SLICES_H
#define SLC_NEURAL_SLICES_H

#include "neural/neural_set.h"

#include <math.h>

/** Most bytes of latents at once: offsets of bits fit in 32 bits. */
#define SLC_NEURAL_MAX_LATENTS ((uint64_t)1 << 29)

/** A rectangle of texels of `first_mip`, and `mip_count` mips from there on. All are the set's. */
struct slc_neural_request {
    uint32_t first_mip, mip_count;
    uint32_t origin[2], size[2]; ///< x and y
};

/**
 * 256 times the place of texel `x` of a mip of `size` texels in a grid of `grid` texels, measured
 * from the center of grid texel 0: bits 8 and up are the lower corner, the others the fraction.
 * Sizes are at most 2^15.
 */
static inline int32_t slc_neural_place(uint32_t x, uint32_t grid, uint32_t size)
{
    uint32_t a = (2 * x + 1) * grid, b = 2 * size;
    return (int32_t)(a / b * 256 + a % b * 256 / b) - 128;
}

/** floor(place / 256), without a shift of a negative number. */
static inline int32_t slc_neural_corner(int32_t place)
{
    return (place + 256) / 256 - 1;
}

/** Input of the network for a position wave or a level. Decision 86 says why the schemas differ. */
static inline int32_t slc_neural_wave_code(uint32_t schema, float value)
{
    float code = schema == 1 ? value * 127.5f : floorf(value * 127.5f - 0.5f);
    float least = schema == 1 ? -128.0f : -127.0f;
    return (int32_t)(code < least ? least : code > 127.0f ? 127.0f : code);
}

/** Bytes of a slice, padded to a multiple of 4. */
uint64_t slc_neural_slice_bytes(uint32_t width, uint32_t height, uint32_t bits_per_texel);

/**
 * Fills the slices that the request takes; dataOffset counts from 0. Slices of other latents stay.
 * Returns the bytes of all.
 */
uint64_t slc_neural_make_slices(const SluiceNeuralSet *set,
                                const struct slc_neural_request *request,
                                SluiceNeuralSlice slices[SLC_NEURAL_MAX_GRIDS]);

/** Fills the slices of all grids as a whole, also those that no mip uses. Returns their bytes. */
uint64_t slc_neural_whole_slices(const SluiceNeuralSet *set,
                                 SluiceNeuralSlice slices[SLC_NEURAL_MAX_GRIDS]);

/** Fills everything but the slices. */
void slc_neural_fill_constants(const SluiceNeuralSet *set, const struct slc_neural_request *request,
                               SluiceNeuralConstants *constants);

/** Bytes that no rectangle of this size takes more of, whose origin is a multiple of `alignment`,
 *  a power of two. `request->origin` is not used. */
uint64_t slc_neural_bound_slices(const SluiceNeuralSet *set,
                                 const struct slc_neural_request *request, uint32_t alignment);

#endif /* SLC_NEURAL_SLICES_H */
