#include "support/roll.h"

static uint64_t state;

void roll_seed(uint64_t seed)
{
    state = seed;
}

/* SplitMix64: a counter, well mixed. Neighboring seeds and the lowest bits are as good as others.
 */
int roll(void)
{
    uint64_t z = state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (int)((z ^ (z >> 31)) >> 33);
}
