#include "supersample.h"

#include <math.h>
#include <stddef.h>

void supersample_init(struct supersample *tables)
{
    for (int i = 0; i < 256; i++) {
        double value = i / 255.0;
        double light = value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
        tables->light[i] = (uint32_t)lround(65535 * light);
    }
    for (int i = 0; i < 65536; i++) {
        double light = i / 65535.0;
        double value = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
        tables->encoded[i] = (uint8_t)lround(255 * value);
    }
}

/** Averages a square of `factor` pixels per side; `corner` is its first pixel. */
static void average_square(const struct supersample *tables, const uint8_t *corner, uint32_t factor,
                           size_t pitch, uint8_t *pixel)
{
    uint32_t sums[4] = {0}, count = factor * factor;
    for (uint32_t y = 0; y < factor; y++)
        for (uint32_t x = 0; x < factor; x++) {
            const uint8_t *from = corner + y * pitch + 4 * (size_t)x;
            for (int i = 0; i < 3; i++)
                sums[i] += tables->light[from[i]];
            sums[3] += from[3];
        }
    for (int i = 0; i < 3; i++)
        pixel[i] = tables->encoded[(sums[i] + count / 2) / count];
    pixel[3] = (uint8_t)((sums[3] + count / 2) / count);
}

void supersample_average(const struct supersample *tables, const uint8_t *large, uint32_t factor,
                         uint32_t width, uint32_t height, uint8_t *small)
{
    size_t pitch = 4 * (size_t)width * factor;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            average_square(tables, large + y * factor * pitch + 4 * (size_t)x * factor, factor,
                           pitch, small + 4 * ((size_t)y * width + x));
}
