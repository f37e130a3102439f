/** Partitions of BC6H and BC7 blocks into two regions. */
#ifndef SLC_BAKE_BLOCK_PARTITIONS_H
#define SLC_BAKE_BLOCK_PARTITIONS_H

#include <stdint.h>

#define SLC_PARTITION_COUNT 64

/**
 * Bit 4 y + x: the texel is in region 1. BC6H knows the first 32.
 * Source: Khronos Data Format Specification 1.3, table "Partition table for 2-subset BPTC".
 */
static const uint16_t slc_partitions[SLC_PARTITION_COUNT] = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80,
    0xe800, 0xffe8, 0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310,
    0x3100, 0x8cce, 0x088c, 0x3110, 0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa,
    0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696, 0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc,
    0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720, 0xc936, 0x936c, 0x39c6,
    0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22,
};

/**
 * Anchor of region 1: the texel whose index is stored without its highest bit. The anchor of region
 * 0 is texel 0.
 * Source: the same specification, table "BPTC anchor index values for the second subset".
 */
static const uint8_t slc_partition_anchors[SLC_PARTITION_COUNT] = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2,  2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8,  2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15,
};

#endif /* SLC_BAKE_BLOCK_PARTITIONS_H */
