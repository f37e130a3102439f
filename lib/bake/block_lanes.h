/**
 * Arithmetic on SLC_LANES blocks at a time: lane l of every vector belongs to block l.
 *
 * Lanes never mix, every operation is one of IEEE 754, and nothing is reordered. So the bytes of a
 * block do not depend on the machine, the compiler or the blocks in other lanes.
 */
#ifndef SLC_BAKE_BLOCK_LANES_H
#define SLC_BAKE_BLOCK_LANES_H

#include <stdint.h>

#ifndef SLC_LANES
#define SLC_LANES 4
#endif

typedef float slc_floats __attribute__((vector_size(4 * SLC_LANES)));
typedef int32_t slc_ints __attribute__((vector_size(4 * SLC_LANES)));

static inline slc_floats slc_all(float value)
{
    return (slc_floats){0} + value;
}

/** Returns the lanes of `a` where `mask` is -1, and of `b` where it is 0. */
static inline slc_floats slc_select(slc_ints mask, slc_floats a, slc_floats b)
{
    return (slc_floats)((mask & (slc_ints)a) | (~mask & (slc_ints)b));
}

static inline slc_ints slc_select_ints(slc_ints mask, slc_ints a, slc_ints b)
{
    return (mask & a) | (~mask & b);
}

static inline slc_floats slc_lesser(slc_floats a, slc_floats b)
{
    for (int l = 0; l < SLC_LANES; l++)
        a[l] = a[l] < b[l] ? a[l] : b[l];
    return a;
}

static inline slc_floats slc_greater(slc_floats a, slc_floats b)
{
    for (int l = 0; l < SLC_LANES; l++)
        a[l] = a[l] > b[l] ? a[l] : b[l];
    return a;
}

static inline slc_floats slc_clamp(slc_floats value, float low, float high)
{
    return slc_lesser(slc_greater(value, slc_all(low)), slc_all(high));
}

/** Rounds toward 0. */
static inline slc_ints slc_to_ints(slc_floats value)
{
    return __builtin_convertvector(value, slc_ints);
}

static inline slc_floats slc_to_floats(slc_ints value)
{
    return __builtin_convertvector(value, slc_floats);
}

#endif /* SLC_BAKE_BLOCK_LANES_H */
