/** Arithmetic with overflow checks. */
#ifndef SLC_BASE_CHECKED_H
#define SLC_BASE_CHECKED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Writes a * b to *out and returns true, or returns false if it does not fit. */
static inline bool slc_mul_size(size_t a, size_t b, size_t *out)
{
    if (b != 0 && a > SIZE_MAX / b)
        return false;
    *out = a * b;
    return true;
}

/** Writes a + b to *out and returns true, or returns false if it does not fit. */
static inline bool slc_add_size(size_t a, size_t b, size_t *out)
{
    if (a > SIZE_MAX - b)
        return false;
    *out = a + b;
    return true;
}

static inline uint32_t slc_min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint64_t slc_min_u64(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static inline uint32_t slc_max_u32(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/** ceil(a / b) without overflow; b > 0. */
static inline uint32_t slc_div_up_u32(uint32_t a, uint32_t b)
{
    return a / b + (a % b != 0);
}

/** Size of one mip level: max(1, size >> level). */
static inline uint32_t slc_mip_size(uint32_t size, uint32_t level)
{
    return level < 32 && size >> level ? size >> level : 1;
}

/** Levels of a full chain: floor(log2(size)) + 1; size > 0. */
static inline uint32_t slc_mip_count(uint32_t size)
{
    /* Integer, because log2f(2^21 - 1) rounds up to 21 and would give one level too many. */
    uint32_t count = 0;
    for (; size; size >>= 1)
        count++;
    return count;
}

/** floor(log2(x)); x > 0. */
static inline uint32_t slc_log2_u32(uint32_t x)
{
    return slc_mip_count(x) - 1;
}

#endif /* SLC_BASE_CHECKED_H */
