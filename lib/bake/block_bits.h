/** Writes the 128 bits of a block, lowest first. */
#ifndef SLC_BAKE_BLOCK_BITS_H
#define SLC_BAKE_BLOCK_BITS_H

#include <stdint.h>

struct slc_block_bits {
    uint64_t low, high;
    uint32_t count; ///< bits written so far
};

/** Appends the lowest `count` bits of `value`, 0 to 32. Its other bits must be 0. */
static inline void slc_put_bits(struct slc_block_bits *bits, uint32_t value, uint32_t count)
{
    if (bits->count < 64) {
        bits->low |= (uint64_t)value << bits->count;
        if (bits->count + count > 64)
            bits->high |= (uint64_t)value >> (64 - bits->count);
    } else {
        bits->high |= (uint64_t)value << (bits->count - 64);
    }
    bits->count += count;
}

static inline void slc_store_bits(const struct slc_block_bits *bits, uint8_t block[16])
{
    for (int i = 0; i < 8; i++) {
        block[i] = (uint8_t)(bits->low >> (8 * i));
        block[8 + i] = (uint8_t)(bits->high >> (8 * i));
    }
}

#endif /* SLC_BAKE_BLOCK_BITS_H */
