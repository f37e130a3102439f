#include "oracle/output.h"

#include "oracle/pictures.h"

#include <sluice/metrics.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vips/vips.h>

static uint8_t encode(double x)
{
    x = x > 0 ? fmin(x, 1) : 0;
    x = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
    return (uint8_t)(255 * x + 0.5);
}

static bool write_png(const char *path, const float *rgba, uint32_t width, uint32_t height)
{
    size_t count = 3 * (size_t)width * height;
    uint8_t *bytes = malloc(count);
    for (size_t i = 0; bytes && i < count; i++)
        bytes[i] = encode((double)rgba[i / 3 * 4 + i % 3]);
    VipsImage *image = bytes ? vips_image_new_from_memory(bytes, count, (int)width, (int)height, 3,
                                                          VIPS_FORMAT_UCHAR)
                             : NULL;
    bool ok = image && vips_pngsave(image, path, NULL) == 0;
    if (!ok)
        fprintf(stderr, "%s: cannot be written: %s\n", path, vips_error_buffer());
    vips_error_clear();
    if (image)
        g_object_unref(image);
    free(bytes);
    return ok;
}

/* Rows from the bottom, floats of this machine, which is little endian. */
static bool write_pfm(const char *path, const float *rgba, uint32_t width, uint32_t height)
{
    FILE *file = fopen(path, "wb");
    bool ok = file && fprintf(file, "PF\n%u %u\n-1.0\n", width, height) > 0;
    for (uint32_t y = height; ok && y-- > 0;)
        for (uint32_t x = 0; ok && x < width; x++)
            ok = fwrite(&rgba[4 * ((size_t)y * width + x)], sizeof(float), 3, file) == 3;
    if (file)
        ok &= fclose(file) == 0;
    if (!ok)
        fprintf(stderr, "%s: cannot be written\n", path);
    return ok;
}

bool oracle_write(const char *path, const float *rgba, uint32_t width, uint32_t height)
{
    size_t size = strlen(path);
    if (size > 4 && strcmp(path + size - 4, ".png") == 0)
        return write_png(path, rgba, width, height);
    return write_pfm(path, rgba, width, height);
}

static void add_pixel(const float *a, const float *b, struct oracle_difference *d)
{
    bool is_equal = true;
    for (int i = 0; i < 3; i++) {
        double x = fmin(fmax(a[i], 0), 1) - fmin(fmax(b[i], 0), 1);
        d->mean_a += a[i];
        d->mean_b += b[i];
        d->rms += x * x;
        is_equal = is_equal && fabs(x) < 1.0 / 255;
    }
    d->equal += is_equal;
}

static bool measure(const float *a, const float *b, uint32_t width, uint32_t height,
                    struct oracle_difference *d)
{
    SluicePicturePair pair = {.structSize = sizeof pair,
                              .pA = a,
                              .pB = b,
                              .width = width,
                              .height = height,
                              .format = SLUICE_PIXEL_FORMAT_RGBA32_FLOAT,
                              .peak = 1};
    double count = (double)width * height;
    *d = (struct oracle_difference){0};
    for (size_t i = 0; i < (size_t)width * height; i++)
        add_pixel(a + 4 * i, b + 4 * i, d);
    d->mean_a /= 3 * count;
    d->mean_b /= 3 * count;
    d->rms = sqrt(d->rms / (3 * count));
    d->equal /= count;
    return sluiceComputeFlip(&pair, 0, NULL, NULL, &d->flip) == SLUICE_SUCCESS;
}

bool oracle_compare(const char *path, const float *rgba, uint32_t width, uint32_t height,
                    struct oracle_difference *difference)
{
    struct oracle_picture picture;
    struct oracle_lookup lookup = {.wrap = SLUICE_PBRT_WRAP_CLAMP, .nearest = true};
    if (!oracle_picture_read(&picture, path))
        return false;
    float *other = calloc((size_t)width * height, 4 * sizeof *other);
    bool ok = other && picture.width == width && picture.height == height;
    for (size_t i = 0; ok && i < (size_t)width * height; i++) {
        double alpha;
        struct vec c = oracle_picture_sample(&picture, &lookup, ((double)(i % width) + 0.5) / width,
                                             ((double)(i / width) + 0.5) / height, &alpha);
        const float pixel[4] = {(float)c.x, (float)c.y, (float)c.z, 1};
        memcpy(other + 4 * i, pixel, sizeof pixel);
    }
    if (!ok)
        fprintf(stderr, "%s: has %u x %u pixels, not %u x %u\n", path, picture.width,
                picture.height, width, height);
    ok = ok && measure(rgba, other, width, height, difference);
    free(other);
    oracle_picture_finish(&picture);
    return ok;
}
