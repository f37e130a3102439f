/** BC7 from RGBA bytes: modes 1, 4, 5 and 6. */
#ifndef SLC_BAKE_BC7_ENCODE_H
#define SLC_BAKE_BC7_ENCODE_H

#include <sluice/bake.h>

/**
 * Encodes `count` blocks of 16 RGBA texels, row by row. Writes 16 bytes per block.
 *
 * The bytes of a block depend on its texels and the quality alone. Blocks of one color are exact.
 * Source: Khronos Data Format Specification 1.3, chapter "BPTC Compressed Texture Image
 * Formats".
 */
void slc_encode_bc7(SluiceBakeQuality quality, const uint8_t (*rgba)[64], size_t count,
                    uint8_t *blocks);

#endif /* SLC_BAKE_BC7_ENCODE_H */
