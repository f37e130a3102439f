#include "palette_png.h"

#include <png.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Returns the index of the first of three mixtures of colors a < b. */
static uint32_t pair_index(uint32_t a, uint32_t b)
{
    return PAINTING_COLORS + 3 * (b * (b - 1) / 2 + a);
}

uint8_t palette_mix(const uint32_t samples[4])
{
    uint32_t counts[PAINTING_COLORS] = {0}, most = 0, other = 0;
    for (int i = 0; i < 4; i++)
        counts[samples[i]]++;
    for (uint32_t c = 1; c < PAINTING_COLORS; c++)
        most = counts[c] > counts[most] ? c : most;
    if (counts[most] == 4)
        return (uint8_t)most;
    other = most == 0 ? 1 : 0;
    for (uint32_t c = 0; c < PAINTING_COLORS; c++)
        other = c != most && counts[c] > counts[other] ? c : other;
    const uint32_t low = most < other ? most : other, high = most < other ? other : most;
    const uint32_t of_high = high == most ? counts[most] : 4 - counts[most];
    return (uint8_t)(pair_index(low, high) + of_high - 1);
}

static double linear(double byte)
{
    return pow(byte / 255, 2.2);
}

static void fill_palette(const uint8_t (*colors)[3], png_color palette[PALETTE_SIZE])
{
    for (uint32_t c = 0; c < PAINTING_COLORS; c++)
        palette[c] = (png_color){colors[c][0], colors[c][1], colors[c][2]};
    for (uint32_t b = 1; b < PAINTING_COLORS; b++)
        for (uint32_t a = 0; a < b; a++)
            for (uint32_t quarter = 1; quarter < 4; quarter++) {
                png_byte mixed[3];
                for (int i = 0; i < 3; i++)
                    mixed[i] = (png_byte)lround(255 * pow((linear(colors[a][i]) * (4 - quarter) +
                                                           linear(colors[b][i]) * quarter) /
                                                              4,
                                                          1 / 2.2));
                palette[pair_index(a, b) + quarter - 1] = (png_color){mixed[0], mixed[1], mixed[2]};
            }
}

bool palette_png_write(const char *path, const uint8_t *indices, uint32_t width, uint32_t height,
                       const uint8_t (*colors)[3])
{
    png_color palette[PALETTE_SIZE];
    fill_palette(colors, palette);
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool written = false;
    if (file && info && !setjmp(png_jmpbuf(png))) {
        png_init_io(png, file);
        png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_PLTE(png, info, palette, PALETTE_SIZE);
        png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
        png_set_compression_level(png, 9);
        png_set_compression_mem_level(png, 9);
        png_set_filter(png, 0, PNG_FILTER_NONE);
        png_write_info(png, info);
        for (uint32_t y = 0; y < height; y++)
            png_write_row(png, indices + (size_t)y * width);
        png_write_end(png, info);
        written = true;
    }
    png_destroy_write_struct(&png, &info);
    written = file && fclose(file) == 0 && written;
    if (!written)
        fprintf(stderr, "make-hall: cannot write %s\n", path);
    return written;
}
