/** Random numbers that are the same on every machine. */
#ifndef TESTS_DEMAND_RANDOM_H
#define TESTS_DEMAND_RANDOM_H

#include <stdint.h>

/** xorshift64; `*state` is not 0. */
static inline uint32_t random_below(uint64_t *state, uint32_t limit)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (uint32_t)((*state >> 32) % limit);
}

#endif /* TESTS_DEMAND_RANDOM_H */
