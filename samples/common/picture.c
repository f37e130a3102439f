#include "picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sluice/exr.h>
#include <sluice/metrics.h>

#include "../../tools/common/output_file.h"
#include "png_file.h"
#include "../../tools/common/text.h"

bool picture_create(uint32_t width, uint32_t height, struct picture *picture)
{
    size_t count = (size_t)width * height;
    *picture = (struct picture){.width = width, .height = height};
    picture->rgba = calloc(count, sizeof *picture->rgba);
    picture->missing = calloc(count, sizeof *picture->missing);
    for (size_t i = 0; i < count && picture->rgba && picture->missing; i++)
        picture->rgba[i][3] = 1.0f; /* also commits the memory before pictures are timed */
    if (picture->rgba && picture->missing)
        return true;
    fprintf(stderr, "out of memory\n");
    picture_destroy(picture);
    return false;
}

void picture_destroy(struct picture *picture)
{
    free(picture->rgba);
    free(picture->missing);
    memset(picture, 0, sizeof *picture);
}

/** Tone curve of Narkowicz, "ACES Filmic Tone Mapping Curve", 2016. */
static float film_curve(float x)
{
    x = fmaxf(x, 0.0f);
    return fminf(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
}

/* NaN becomes 0. */
static float clamp(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);
}

static uint8_t encode_srgb(float x)
{
    float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
    return (uint8_t)(255.0f * encoded + 0.5f);
}

void picture_develop(const struct picture *picture, double exposure, uint8_t *rgba)
{
    const float scale = (picture->plain ? 1.0f : 0.55f) * (float)exp2(exposure);
    const size_t count = (size_t)picture->width * picture->height;
    for (size_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            const float x = scale * picture->rgba[i][c];
            rgba[4 * i + c] = encode_srgb(picture->plain ? clamp(x) : film_curve(x));
        }
        rgba[4 * i + 3] = 255;
    }
}

static void print_log(void *user_data, SluiceLogSeverity severity, const char *message)
{
    (void)user_data;
    if (severity != SLUICE_LOG_INFO)
        text_say("%s", message);
}

bool picture_write_exr(const struct picture *picture, const char *path)
{
    SluiceImageInfo info = {
        sizeof info, picture->width, picture->height, 0, SLUICE_FORMAT_R32G32B32A32_SFLOAT,
        "picture"};
    SluiceExrWriteInfo write = {
        .structSize = sizeof write, .pPath = path, .opaque = true, .log = {.pfnLog = print_log}};
    SluiceImageSource *source = NULL;
    if (!output_spares_inputs(path))
        return false;
    SluiceResult result = sluiceCreateMemoryImageSource(picture->rgba, &info, NULL, &source);
    if (result == SLUICE_SUCCESS)
        result = sluiceWriteExrFile(&write, source);
    sluiceDestroyImageSource(source);
    if (result != SLUICE_SUCCESS)
        text_say("%s: cannot write: %s", path, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static uint8_t *develop_new(const struct picture *picture, double exposure)
{
    uint8_t *rgba = malloc((size_t)picture->width * picture->height * 4);
    if (rgba)
        picture_develop(picture, exposure, rgba);
    else
        fprintf(stderr, "out of memory\n");
    return rgba;
}

bool picture_write(const struct picture *picture, double exposure, const char *folder,
                   const char *name)
{
    char path[4096];
    uint8_t *rgba = develop_new(picture, exposure);
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    bool done = rgba && png_file_write(path, rgba, picture->width, picture->height);
    free(rgba);
    snprintf(path, sizeof path, "%s/%s.exr", folder, name);
    return done && picture_write_exr(picture, path);
}

static bool write_numbered(const struct picture_place *place, const char *kind, const uint8_t *rgba,
                           const SluicePicturePair *pair)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s-%04u.png", place->folder, kind, place->number);
    return png_file_write(path, rgba, pair->width, pair->height);
}

/** Computes FLIP, and writes its error map in colors. */
static bool compare_flip(const SluicePicturePair *pair, const struct picture_place *place,
                         double *flip)
{
    const size_t count = (size_t)pair->width * pair->height;
    float *errors = malloc(count * sizeof *errors);
    uint8_t *colors = malloc(count * 4);
    const SluiceMetricMap map = {.pValues = errors};
    bool done = errors && colors &&
                sluiceComputeFlip(pair, 0.0f, &map, NULL, flip) == SLUICE_SUCCESS &&
                sluiceColorMagma(errors, count, colors) == SLUICE_SUCCESS;
    if (!done)
        fprintf(stderr, "out of memory\n");
    done = done && write_numbered(place, "flip", colors, pair);
    free(errors);
    free(colors);
    return done;
}

static bool compare(const uint8_t *rgba, const uint8_t *other, uint32_t width, uint32_t height,
                    const struct picture_place *place, struct picture_difference *d)
{
    const SluicePicturePair pair = {.structSize = sizeof pair,
                                    .pA = rgba,
                                    .pB = other,
                                    .width = width,
                                    .height = height,
                                    .format = SLUICE_PIXEL_FORMAT_RGBA8_SRGB};
    if (sluiceComputePsnr8(rgba, other, width, height, 4, &d->psnr) == SLUICE_SUCCESS &&
        sluiceComputeSsim(&pair, NULL, NULL, &d->ssim) == SLUICE_SUCCESS)
        return compare_flip(&pair, place, &d->flip) &&
               write_numbered(place, "frame", rgba, &pair) &&
               write_numbered(place, "truth", other, &pair);
    fprintf(stderr, "out of memory\n");
    return false;
}

bool picture_compare(const struct picture *picture, double exposure, const char *path,
                     const struct picture_place *place, struct picture_difference *difference)
{
    uint32_t width, height;
    uint8_t *other = png_file_read(path, &width, &height);
    if (!other)
        return false;
    bool fits = width == picture->width && height == picture->height;
    if (!fits)
        text_say("%s: is %ux%u, not %ux%u", path, width, height, picture->width, picture->height);
    uint8_t *rgba = fits ? develop_new(picture, exposure) : NULL;
    bool done = rgba && compare(rgba, other, width, height, place, difference);
    free(rgba);
    free(other);
    return done;
}
