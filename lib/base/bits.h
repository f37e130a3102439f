/** Bits of words, and prefetching: wrappers of compiler builtins, with plain C for others. */
#ifndef SLC_BASE_BITS_H
#define SLC_BASE_BITS_H

#include <stdint.h>

/* Tests define SLC_PLAIN_C to get the code for other compilers. */
#if defined(__GNUC__) && !defined(SLC_PLAIN_C)
#define SLC_PREFETCH(address) __builtin_prefetch(address)
#else
#define SLC_PREFETCH(address) ((void)(address))
#endif

/** Returns the index of the lowest set bit. `bits` must not be 0. */
static inline uint32_t slc_lowest_bit64(uint64_t bits)
{
#if defined(__GNUC__) && !defined(SLC_PLAIN_C)
    return (uint32_t)__builtin_ctzll(bits);
#else
    uint32_t bit = 0;
    for (uint32_t step = 32; step > 0; step /= 2)
        if ((bits & ((UINT64_C(1) << step) - 1)) == 0) {
            bits >>= step;
            bit += step;
        }
    return bit;
#endif
}

/** Returns the index of the lowest set bit. `bits` must not be 0. */
static inline uint32_t slc_lowest_bit(uint32_t bits)
{
#if defined(__GNUC__) && !defined(SLC_PLAIN_C)
    return (uint32_t)__builtin_ctz(bits);
#else
    return slc_lowest_bit64(bits);
#endif
}

/** Returns the index of the highest set bit. `bits` must not be 0. */
static inline uint32_t slc_highest_bit(uint32_t bits)
{
#if defined(__GNUC__) && !defined(SLC_PLAIN_C)
    return 31u - (uint32_t)__builtin_clz(bits);
#else
    uint32_t bit = 0;
    for (uint32_t step = 16; step > 0; step /= 2)
        if (bits >> step) {
            bits >>= step;
            bit += step;
        }
    return bit;
#endif
}

/** Returns the number of set bits. */
static inline uint32_t slc_count_ones(uint32_t bits)
{
#if defined(__GNUC__) && !defined(SLC_PLAIN_C)
    return (uint32_t)__builtin_popcount(bits);
#else
    uint32_t count = 0;
    for (; bits; bits &= bits - 1)
        count++;
    return count;
#endif
}

#endif /* SLC_BASE_BITS_H */
