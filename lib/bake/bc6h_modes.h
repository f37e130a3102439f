/** Storage of region ends in the 14 modes of BC6H. */
#ifndef SLC_BAKE_BC6H_MODES_H
#define SLC_BAKE_BC6H_MODES_H

#include <stdint.h>

#define SLC_BC6H_MODE_COUNT 14

struct slc_bc6h_mode {
    uint8_t number;            ///< 1 to 14, as Direct3D counts them
    uint8_t value, value_bits; ///< mode bits, the first bits of the block
    uint8_t regions;
    uint8_t bits;      ///< per channel of the first end; of all ends if deltas are 0
    uint8_t deltas[3]; ///< bits per difference from the first end; 0: ends are stored
    /**
     * Fields after the mode bits, in file order: channel, end (w and x of region 0, y and z of
     * region 1) and bit numbers.
     */
    const char *layout;
};

/**
 * Modes of one region, then of two, each in the order of their precision.
 * Source: Khronos Data Format Specification 1.3, table "Block formats for BPTC float".
 */
static const struct slc_bc6h_mode slc_bc6h_modes[SLC_BC6H_MODE_COUNT] = {
    {14, 0x0f, 5, 1, 16, {4, 4, 4}, "rw0-9 gw0-9 bw0-9 rx0-3 rw15-10 gx0-3 gw15-10 bx0-3 bw15-10"},
    {13, 0x0b, 5, 1, 12, {8, 8, 8}, "rw0-9 gw0-9 bw0-9 rx0-7 rw11-10 gx0-7 gw11-10 bx0-7 bw11-10"},
    {12, 0x07, 5, 1, 11, {9, 9, 9}, "rw0-9 gw0-9 bw0-9 rx0-8 rw10 gx0-8 gw10 bx0-8 bw10"},
    {11, 0x03, 5, 1, 10, {0, 0, 0}, "rw0-9 gw0-9 bw0-9 rx0-9 gx0-9 bx0-9"},
    {3,
     0x02,
     5,
     2,
     11,
     {5, 4, 4},
     "rw0-9 gw0-9 bw0-9 rx0-4 rw10 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-3 bw10 bz1 "
     "by0-3 ry0-4 bz2 rz0-4 bz3"},
    {4,
     0x06,
     5,
     2,
     11,
     {4, 5, 4},
     "rw0-9 gw0-9 bw0-9 rx0-3 rw10 gz4 gy0-3 gx0-4 gw10 gz0-3 bx0-3 bw10 bz1 "
     "by0-3 ry0-3 bz0 bz2 rz0-3 gy4 bz3"},
    {5,
     0x0a,
     5,
     2,
     11,
     {4, 4, 5},
     "rw0-9 gw0-9 bw0-9 rx0-3 rw10 by4 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-4 bw10 "
     "by0-3 ry0-3 bz1 bz2 rz0-3 bz4 bz3"},
    {1,
     0x00,
     2,
     2,
     10,
     {5, 5, 5},
     "gy4 by4 bz4 rw0-9 gw0-9 bw0-9 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 "
     "by0-3 ry0-4 bz2 rz0-4 bz3"},
    {6,
     0x0e,
     5,
     2,
     9,
     {5, 5, 5},
     "rw0-8 by4 gw0-8 gy4 bw0-8 bz4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 "
     "by0-3 ry0-4 bz2 rz0-4 bz3"},
    {7,
     0x12,
     5,
     2,
     8,
     {6, 5, 5},
     "rw0-7 gz4 by4 gw0-7 bz2 gy4 bw0-7 bz3 bz4 rx0-5 gy0-3 gx0-4 bz0 gz0-3 "
     "bx0-4 bz1 by0-3 ry0-5 rz0-5"},
    {8,
     0x16,
     5,
     2,
     8,
     {5, 6, 5},
     "rw0-7 bz0 by4 gw0-7 gy5 gy4 bw0-7 gz5 bz4 rx0-4 gz4 gy0-3 gx0-5 gz0-3 "
     "bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3"},
    {9,
     0x1a,
     5,
     2,
     8,
     {5, 5, 6},
     "rw0-7 bz1 by4 gw0-7 by5 gy4 bw0-7 bz5 bz4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 "
     "bx0-5 by0-3 ry0-4 bz2 rz0-4 bz3"},
    {2,
     0x01,
     2,
     2,
     7,
     {6, 6, 6},
     "gy5 gz4 gz5 rw0-6 bz0 bz1 by4 gw0-6 by5 bz2 gy4 bw0-6 bz3 bz5 bz4 rx0-5 "
     "gy0-3 gx0-5 gz0-3 bx0-5 by0-3 ry0-5 rz0-5"},
    {10,
     0x1e,
     5,
     2,
     6,
     {0, 0, 0},
     "rw0-5 gz4 bz0 bz1 by4 gw0-5 gy5 by5 bz2 gy4 bw0-5 gz5 bz3 bz5 bz4 rx0-5 "
     "gy0-3 gx0-5 gz0-3 bx0-5 by0-3 ry0-5 rz0-5"},
};

#endif /* SLC_BAKE_BC6H_MODES_H */
