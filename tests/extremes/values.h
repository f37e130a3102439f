/** A picture whose texels are the ends of what a half holds, and what each stage makes of them. */
#ifndef TESTS_EXTREMES_VALUES_H
#define TESTS_EXTREMES_VALUES_H

#include <sluice/image.h>

#include <stdbool.h>

#define VALUES_WIDTH 160u /* four tiles of half RGBA, none of them whole but one */
#define VALUES_HEIGHT 100u
#define VALUES_TEXELS (VALUES_WIDTH * VALUES_HEIGHT)
#define VALUES_LEVELS 8u

/** docs/numerics.md has the same table. */
struct value {
    const char *name;
    uint16_t half;  ///< in the OpenEXR file
    float in_file;  ///< what that means
    float in_half;  ///< in a store of half floats
    float in_float; ///< in a store of 32-bit floats
    float in_byte;  ///< in a store of UNORM bytes
};

#define VALUES_COUNT 19u
extern const struct value values[VALUES_COUNT];

/** Which value a texel of a level has in R and G; B and A are 1. */
uint32_t value_at(uint32_t level, uint32_t x, uint32_t y);

/** The picture, all levels, as halves; a source for sluiceWriteExrFile. */
void values_source_init(SluiceImageSource *source);

#endif /* TESTS_EXTREMES_VALUES_H */
