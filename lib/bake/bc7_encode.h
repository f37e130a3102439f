/** BC7 from RGBA bytes: modes 1, 4, 5 and 6. */
#ifndef SLC_BAKE_BC7_ENCODE_H
#define SLC_BAKE_BC7_ENCODE_H

#include <sluice/bake.h>

/**
 * `count` blocks of 16 texels each, row by row, to `count` blocks of 16 bytes.
 *
 * A block becomes the same bytes on every machine and beside any others. Blocks of one color are
 * exact. Source: Khronos Data Format Specification 1.3, chapter "BPTC Compressed Texture Image
 * Formats".
 */
void slc_encode_bc7(SluiceBakeQuality quality, const uint8_t (*rgba)[64], size_t count,
                    uint8_t *blocks);

#endif /* SLC_BAKE_BC7_ENCODE_H */
