#include "metrics/pixel_rows.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/struct_size.h"

#include <math.h>
#include <string.h>

static size_t pixel_size(SluicePixelFormat format)
{
    switch (format) {
    case SLUICE_PIXEL_FORMAT_RGBA8_SRGB:
    case SLUICE_PIXEL_FORMAT_R32_FLOAT: return 4;
    case SLUICE_PIXEL_FORMAT_RGBA32_FLOAT: return 16;
    }
    return 0;
}

/** False if rows of `row_size` bytes overlap or end beyond the address space. */
static bool find_pitch(size_t given, size_t row_size, uint32_t height, size_t *pitch)
{
    size_t end;
    *pitch = given ? given : row_size;
    return *pitch >= row_size && slc_mul_size(*pitch, height, &end);
}

static bool map_is_valid(const SluiceMetricMap *map, uint32_t width, uint32_t height)
{
    size_t row_size, pitch;
    return !map ||
           (slc_mul_size(width, sizeof(float), &row_size) &&
            find_pitch(map->rowPitch, row_size, height, &pitch) && pitch % sizeof(float) == 0);
}

static void init_picture(struct slc_metric_picture *picture, const SluicePicturePair *pair,
                         const void *pixels, size_t pitch)
{
    *picture = (struct slc_metric_picture){.pixels = pixels,
                                           .row_pitch = pitch,
                                           .width = pair->width,
                                           .format = pair->format,
                                           .peak = (double)pair->peak};
    for (int i = 0; i < 256; i++) {
        double value = i / 255.0;
        picture->linear[i] = value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
    }
}

SluiceResult slc_picture_pair_init(struct slc_metric_picture pictures[2],
                                   const SluicePicturePair *given, SluicePicturePair *pair,
                                   const SluiceMetricMap *map,
                                   const SluiceAllocationCallbacks *allocator)
{
    if (!given || !given->pA || !given->pB || (map && !map->pValues) ||
        !slc_allocator_is_valid(allocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluicePicturePair), pair, given, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    size_t size = pixel_size(pair->format), row_size, pitch_a, pitch_b;
    if (pair->width == 0 || pair->height == 0 || size == 0)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (pair->format != SLUICE_PIXEL_FORMAT_RGBA8_SRGB && !(pair->peak > 0 && isfinite(pair->peak)))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (!slc_mul_size(pair->width, size, &row_size) ||
        !find_pitch(pair->rowPitchA, row_size, pair->height, &pitch_a) ||
        !find_pitch(pair->rowPitchB, row_size, pair->height, &pitch_b) ||
        !map_is_valid(map, pair->width, pair->height))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    init_picture(&pictures[0], pair, pair->pA, pitch_a);
    init_picture(&pictures[1], pair, pair->pB, pitch_b);
    return SLUICE_SUCCESS;
}

static double luma(double r, double g, double b)
{
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** The value over the peak, in [0, 1]; 0 for NaN. */
static double bounded(const struct slc_metric_picture *picture, float value)
{
    if (!(value > 0))
        return 0;
    return (double)value >= picture->peak ? 1 : (double)value / picture->peak;
}

static void float_rgb(const struct slc_metric_picture *picture, const unsigned char *row,
                      uint32_t x, double rgb[3])
{
    float values[3];
    if (picture->format == SLUICE_PIXEL_FORMAT_RGBA32_FLOAT) {
        memcpy(values, row + 16 * (size_t)x, sizeof values);
    } else {
        memcpy(values, row + 4 * (size_t)x, sizeof values[0]);
        values[1] = values[2] = values[0];
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = bounded(picture, values[i]);
}

void slc_picture_read_luma(const struct slc_metric_picture *picture, uint32_t y, double *values)
{
    const unsigned char *row = picture->pixels + y * picture->row_pitch;
    for (uint32_t x = 0; x < picture->width; x++) {
        double rgb[3];
        if (picture->format == SLUICE_PIXEL_FORMAT_RGBA8_SRGB) {
            const unsigned char *pixel = row + 4 * (size_t)x;
            values[x] = luma(pixel[0], pixel[1], pixel[2]) / 255.0;
        } else {
            float_rgb(picture, row, x, rgb);
            values[x] = luma(rgb[0], rgb[1], rgb[2]);
        }
    }
}

void slc_picture_read_rgb(const struct slc_metric_picture *picture, uint32_t y, double *rgb)
{
    const unsigned char *row = picture->pixels + y * picture->row_pitch;
    for (uint32_t x = 0; x < picture->width; x++) {
        if (picture->format != SLUICE_PIXEL_FORMAT_RGBA8_SRGB)
            float_rgb(picture, row, x, rgb + 3 * (size_t)x);
        else
            for (int i = 0; i < 3; i++)
                rgb[3 * (size_t)x + i] = picture->linear[row[4 * (size_t)x + i]];
    }
}

bool slc_picture_row_is_equal(const struct slc_metric_picture pictures[2], uint32_t y)
{
    return memcmp(pictures[0].pixels + y * pictures[0].row_pitch,
                  pictures[1].pixels + y * pictures[1].row_pitch,
                  pictures[0].width * pixel_size(pictures[0].format)) == 0;
}

void slc_metric_map_write(const SluiceMetricMap *map, uint32_t width, uint32_t y,
                          const double *values)
{
    if (!map)
        return;
    size_t pitch = map->rowPitch ? map->rowPitch / sizeof(float) : width;
    float *row = map->pValues + y * pitch;
    for (uint32_t x = 0; x < width; x++)
        row[x] = (float)values[x];
}
