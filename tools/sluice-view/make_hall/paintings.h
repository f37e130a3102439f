/** Paintings of the hall: geometric pictures of few colors, which a PNG file holds in little space.
 */
#ifndef SLUICE_VIEW_PAINTINGS_H
#define SLUICE_VIEW_PAINTINGS_H

#include <stdint.h>

#define PAINTING_KINDS 17u
#define PAINTING_COLORS 8u

struct painting {
    uint32_t kind; ///< below PAINTING_KINDS
    uint32_t seed;
    double aspect; ///< width / height
};

/** Colors of palette `number`, any number: sRGB, 8 bits per channel. */
const uint8_t (*painting_palette(uint32_t number))[3];

/** Color at (x, y): an index below PAINTING_COLORS. x is 0 to the aspect, y is 0 at the top to 1.
 */
uint32_t painting_color(const struct painting *painting, double x, double y);

/** Colors of the floor, and the color at (x, y), 0 to 1: planks in a herringbone pattern. Opposite
 * edges fit together. */
extern const uint8_t painting_floor_palette[PAINTING_COLORS][3];
uint32_t painting_floor(double x, double y);

#endif /* SLUICE_VIEW_PAINTINGS_H */
