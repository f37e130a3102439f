#ifndef SLUICE_DEMAND_PREFIX_GLSL
#define SLUICE_DEMAND_PREFIX_GLSL

/* Prefix sums over a workgroup, in shared memory: the same whatever the size of a subgroup. */
const uint group = gl_WorkGroupSize.x;
shared uint sums[2u * group]; /* two, in turns: one barrier per step */

/** The sum over all invocations before this one; `total`: over all. For the whole workgroup. */
uint sluiceSumBefore(uint own, out uint total)
{
    uint at = gl_LocalInvocationIndex, from = 0u;
    uint sum = own;
    barrier(); /* for the call before */
    sums[at] = sum;
    for (uint step = 1u; step < group; step *= 2u) {
        barrier();
        sum += at >= step ? sums[from + at - step] : 0u;
        from = group - from;
        sums[from + at] = sum;
    }
    barrier();
    total = sums[from + group - 1u];
    return sum - own;
}

#endif
