/** A picture of extreme half values, and the expected value at each stage. */
#ifndef TESTS_EXTREMES_VALUES_H
#define TESTS_EXTREMES_VALUES_H

#include <sluice/image.h>

#include <stdbool.h>

#define VALUES_WIDTH 160u /* four tiles of half RGBA, only one of them whole */
#define VALUES_HEIGHT 100u
#define VALUES_TEXELS (VALUES_WIDTH * VALUES_HEIGHT)
#define VALUES_LEVELS 8u

/** A row of the table in docs/numerics.md. */
struct value {
    const char *name;
    uint16_t half;  ///< in the OpenEXR file
    float in_file;  ///< meaning of `half`
    float in_half;  ///< in a store of half floats
    float in_float; ///< in a store of 32-bit floats
    float in_byte;  ///< in a store of UNORM bytes
};

#define VALUES_COUNT 19u
extern const struct value values[VALUES_COUNT];

/** Returns the value in R and G of a level's texel. B and A are 1. */
uint32_t value_at(uint32_t level, uint32_t x, uint32_t y);

/** Creates a source of the picture with all levels as halves, for sluiceWriteExrFile. */
void values_source_init(SluiceImageSource *source);

#endif /* TESTS_EXTREMES_VALUES_H */
