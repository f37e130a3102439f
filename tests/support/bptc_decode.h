/** Plain decoders of BC7 and BC6H, written from the specification, to compare encoders with. */
#ifndef TESTS_BPTC_DECODE_H
#define TESTS_BPTC_DECODE_H

#include <stdbool.h>
#include <stdint.h>

/** Modes 1, 4, 5 and 6; false for others. Returns the mode in `*mode`. */
bool bc7_decode(const uint8_t block[16], uint8_t rgba[64], int *mode);

/** Decodes all modes of BC6H to halves of R, G and B. `*mode` becomes 1 to 14. Returns false for
 * reserved modes. */
bool bc6h_decode(bool is_signed, const uint8_t block[16], uint16_t rgb[48], int *mode);

#endif
