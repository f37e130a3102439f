#include "material_files.h"

#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>

#include "../../tools/common/files.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"
#include "patterns.h"

#define SUPERSAMPLES 3 ///< per axis and texel

static const struct {
    const char *name;
    pattern_fn pattern;
    uint32_t channels;
    bool srgb;
} textures[] = {
    {"albedo", pattern_mosaic, 3, true},
    {"height", pattern_mosaic_height, 1, false},
    {"roughness", pattern_mosaic_roughness, 1, false},
};

static uint8_t to_byte(float linear, bool srgb)
{
    float value = fminf(fmaxf(linear, 0.0f), 1.0f);
    if (srgb)
        value = value <= 0.0031308f ? 12.92f * value : 1.055f * powf(value, 1.0f / 2.4f) - 0.055f;
    return (uint8_t)(value * 255.0f + 0.5f);
}

/** Computes the mean over the samples of a texel, linear. */
static void sample_texel(pattern_fn pattern, uint32_t x, uint32_t y, uint32_t size, float mean[3])
{
    const float step = 1.0f / (float)(size * SUPERSAMPLES);
    mean[0] = mean[1] = mean[2] = 0.0f;
    for (uint32_t i = 0; i < SUPERSAMPLES * SUPERSAMPLES; i++) {
        float rgb[3], u = ((float)(x * SUPERSAMPLES + i % SUPERSAMPLES) + 0.5f) * step,
                      v = ((float)(y * SUPERSAMPLES + i / SUPERSAMPLES) + 0.5f) * step;
        pattern(u, v, step, rgb);
        for (int c = 0; c < 3; c++)
            mean[c] += rgb[c] / (SUPERSAMPLES * SUPERSAMPLES);
    }
}

static bool write_png(const char *path, const uint8_t *bytes, uint32_t size, uint32_t channels)
{
    png_image image = {.version = PNG_IMAGE_VERSION, .width = size, .height = size};
    image.format = channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
    struct output_file *file = output_file_begin(path);
    bool done =
        file && png_image_write_to_stdio(&image, output_file_stream(file), 0, bytes, 0, NULL);
    if (file && !done)
        text_say("%s: cannot write: %s", path, image.message);
    return output_file_end(file, done);
}

bool material_files_write(const char *folder, uint32_t size)
{
    uint8_t *bytes = malloc((size_t)size * size * 3);
    bool done = bytes && files_make_folders(folder);
    if (!bytes)
        fprintf(stderr, "out of memory\n");
    for (size_t i = 0; done && i < sizeof textures / sizeof *textures; i++) {
        uint8_t *out = bytes;
        char path[4096];
        for (uint32_t at = 0; at < size * size; at++) {
            float mean[3];
            sample_texel(textures[i].pattern, at % size, at / size, size, mean);
            for (uint32_t c = 0; c < textures[i].channels; c++)
                *out++ = to_byte(mean[c], textures[i].srgb);
        }
        snprintf(path, sizeof path, "%s/%s.png", folder, textures[i].name);
        done = write_png(path, bytes, size, textures[i].channels);
    }
    free(bytes);
    return done;
}
