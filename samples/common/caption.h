/** Words in pictures: capital letters, digits and a few signs, 3 x 5 dots each. */
#ifndef SAMPLES_COMMON_CAPTION_H
#define SAMPLES_COMMON_CAPTION_H

#include <stdint.h>

#define CAPTION_WIDTH 4u  ///< dots of a letter with the gap after it
#define CAPTION_HEIGHT 5u ///< dots

/** Target of drawing: [height][width] RGBA bytes. */
struct canvas {
    uint8_t *rgba; ///< borrowed
    uint32_t width, height;
};

/** Draws white letters, `scale` pixels per dot, from (x, y) on, cut at the edges. Other characters
 * become blanks. */
void caption_draw(const struct canvas *canvas, uint32_t x, uint32_t y, uint32_t scale,
                  const char *text);

#endif /* SAMPLES_COMMON_CAPTION_H */
