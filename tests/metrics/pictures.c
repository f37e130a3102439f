#include "pictures.h"

#include <math.h>

double random_next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

void fill_random(uint8_t *bytes, size_t count, uint32_t seed)
{
    for (size_t i = 0; i < count; i++)
        bytes[i] = (uint8_t)(random_next(&seed) * 256);
}

void fill_drawing(uint8_t *pixels, uint32_t width, uint32_t height)
{
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint8_t *pixel = pixels + 4 * ((size_t)y * width + x);
            double distance = hypot(x - width / 3.0, y - height / 2.0);
            pixel[0] = (uint8_t)(50 + 150 * x / width);
            pixel[1] = distance < height / 4.0 ? 200 : 70;
            pixel[2] = (uint8_t)(x / 4 % 2 ? 60 + 100 * y / height : 130);
            pixel[3] = 255;
        }
}

void add_noise(const uint8_t *pixels, uint8_t *out, size_t pixel_count, int amplitude)
{
    uint32_t seed = 5;
    for (size_t i = 0; i < 4 * pixel_count; i++) {
        double value = pixels[i] + (2 * random_next(&seed) - 1) * amplitude;
        out[i] = i % 4 == 3 ? pixels[i] : (uint8_t)fmin(fmax(value + 0.5, 0), 255);
    }
}

double light_of(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

SluicePicturePair rgba8_pair(const void *a, const void *b, uint32_t width, uint32_t height)
{
    return (SluicePicturePair){.structSize = sizeof(SluicePicturePair),
                               .pA = a,
                               .pB = b,
                               .width = width,
                               .height = height};
}
