#include "caption.h"

#include <string.h>

/* Dots of each character; the top row is in the highest three of 15 bits. */
static const uint16_t digits[10] = {075557, 026227, 071747, 071717, 055711,
                                    074717, 074757, 071222, 075757, 075717};
static const uint16_t letters[26] = {025755, 065656, 034443, 065556, 074647, 074644, 034553,
                                     055755, 072227, 011152, 055655, 044447, 057755, 065555,
                                     025552, 065644, 025563, 065655, 034216, 072222, 055557,
                                     055552, 055775, 055255, 055222, 071247};

static uint16_t dots_of(char c)
{
    if (c >= '0' && c <= '9')
        return digits[c - '0'];
    if (c >= 'A' && c <= 'Z')
        return letters[c - 'A'];
    if (c >= 'a' && c <= 'z')
        return letters[c - 'a'];
    switch (c) {
    case '.': return 000002;
    case ',': return 000024;
    case ':': return 002020;
    case '-': return 000700;
    case '/': return 011244;
    case '%': return 051245;
    default: return 0;
    }
}

static void fill(const struct canvas *canvas, uint32_t x, uint32_t y, uint32_t size)
{
    for (uint32_t row = y; row < y + size && row < canvas->height; row++)
        for (uint32_t column = x; column < x + size && column < canvas->width; column++)
            memset(canvas->rgba + 4 * ((size_t)row * canvas->width + column), 255, 4);
}

void caption_draw(const struct canvas *canvas, uint32_t x, uint32_t y, uint32_t scale,
                  const char *text)
{
    for (; *text; text++, x += CAPTION_WIDTH * scale) {
        uint16_t dots = dots_of(*text);
        for (uint32_t i = 0; i < 15; i++)
            if (dots >> (14 - i) & 1)
                fill(canvas, x + i % 3 * scale, y + i / 3 * scale, scale);
    }
}
