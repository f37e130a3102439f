/** Source of a random sequence's decisions: a seeded generator, or the bytes of a file. */
#ifndef TESTS_CORE_CHOICE_H
#define TESTS_CORE_CHOICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct choice {
    uint64_t state;       ///< state of the generator
    const uint8_t *bytes; ///< if not NULL: source of decisions
    size_t size, at;
};

static inline uint64_t choice_bits(struct choice *c, uint32_t byte_count)
{
    if (!c->bytes) { /* splitmix64 */
        uint64_t z = (c->state += 0x9E3779B97F4A7C15u);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    uint64_t bits = 0;
    for (uint32_t i = 0; i < byte_count; i++)
        bits = bits << 8 | (c->at < c->size ? c->bytes[c->at++] : 0);
    return bits;
}

static inline uint64_t choice_u64(struct choice *c)
{
    return choice_bits(c, 8);
}

/** Returns 0 to n - 1, or 0 if n is 0. */
static inline uint32_t choice_below(struct choice *c, uint32_t n)
{
    return n ? (uint32_t)(choice_bits(c, n <= 256 ? 1 : 4) % n) : 0;
}

/** Returns low to high, inclusive. */
static inline uint32_t choice_range(struct choice *c, uint32_t low, uint32_t high)
{
    return low + choice_below(c, high - low + 1);
}

/** Returns true once in n times. */
static inline bool choice_once_in(struct choice *c, uint32_t n)
{
    return choice_below(c, n) == 1 % n;
}

/** Returns false once all bytes are used. Always true for a generator. */
static inline bool choice_goes_on(const struct choice *c)
{
    return !c->bytes || c->at < c->size;
}

#endif /* TESTS_CORE_CHOICE_H */
