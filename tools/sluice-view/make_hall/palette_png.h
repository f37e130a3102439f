/** PNG files with a palette: 8 colors and the mixtures at edges. */
#ifndef SLUICE_VIEW_PALETTE_PNG_H
#define SLUICE_VIEW_PALETTE_PNG_H

#include "paintings.h"

#include <stdbool.h>
#include <stdint.h>

/** Number of colors in the palette: colors of a painting, and three mixtures of each pair. */
#define PALETTE_SIZE (PAINTING_COLORS + PAINTING_COLORS * (PAINTING_COLORS - 1) / 2 * 3)

/** Returns the index of the mixture of four samples, each below PAINTING_COLORS. Ignores a third
 *  color. */
uint8_t palette_mix(const uint32_t samples[4]);

/** Writes width x height indices below PALETTE_SIZE. Reports failures on stderr. */
bool palette_png_write(const char *path, const uint8_t *indices, uint32_t width, uint32_t height,
                       const uint8_t (*colors)[3]);

#endif /* SLUICE_VIEW_PALETTE_PNG_H */
