/** BC7 blocks of a picture by the encoder of sluice-bake. */
#ifndef BENCH_NEURAL_BAKED_BLOCKS_H
#define BENCH_NEURAL_BAKED_BLOCKS_H

#include <stdbool.h>
#include <stdint.h>

/** Texels of all levels in RGBA bytes, one level behind the other. */
struct chain {
    const uint8_t *texels;
    uint32_t width, height, level_count;
};

/** Returns whether this build has the encoder. */
bool baked_blocks_exist(void);

/**
 * Writes the blocks of all levels, one level behind the other. Makes levels from 1 on from level 0,
 * like sluice-bake. Reports errors on stderr.
 */
bool baked_blocks_write(const struct chain *chain, uint8_t *blocks);

#endif /* BENCH_NEURAL_BAKED_BLOCKS_H */
