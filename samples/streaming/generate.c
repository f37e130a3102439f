#define _POSIX_C_SOURCE 200809L
#include "generate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <sluice/exr.h>

#include "../../tools/common/files.h"
#include "../../tools/common/log.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/text.h"
#include "cache.h"

/* In the order on the walls. About 105 million texels, 1.1 GB as half floats with all levels. */
static const struct pattern_image pictures[GENERATED_COUNT] = {
    {"coast", 8192, 3072, pattern_coast, 1},
    {"chart", 4096, 4096, pattern_chart, 1},
    {"guilloche", 4099, 2050, pattern_guilloche, 1},
    {"mandelbrot", 4097, 4099, pattern_mandelbrot, 2},
    {"julia", 6000, 3000, pattern_julia, 2},
    {"glass", 2400, 4100, pattern_glass, 1},
    {"nebula", 4500, 2251, pattern_nebula, 1},
};

static void pattern_texel(void *user_data, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                          uint32_t height, float rgba[4])
{
    const struct pattern_image *image = user_data;
    float aspect = (float)image->width / (float)image->height;
    uint32_t samples = level == 0 ? 1 : image->supersamples;
    float step = 1.0f / (float)samples, sum[3] = {0, 0, 0};
    for (uint32_t row = 0; row < samples; row++)
        for (uint32_t column = 0; column < samples; column++) {
            float u = ((float)x + ((float)column + 0.5f) * step) / (float)width * aspect;
            float v = ((float)y + ((float)row + 0.5f) * step) / (float)height, rgb[3];
            image->pattern(u, v, step / (float)height, rgb);
            for (int i = 0; i < 3; i++)
                sum[i] += rgb[i] * step * step;
        }
    memcpy(rgba, sum, sizeof sum);
    rgba[3] = 1.0f;
}

SluiceResult pattern_create_source(const struct pattern_image *image, SluiceFormat format,
                                   SluiceImageSource **source)
{
    SluiceProceduralImage procedural = {(void *)image, pattern_texel};
    SluiceImageInfo info = {sizeof info, image->width, image->height, 0, format, image->name};
    return sluiceCreateProceduralImageSource(&procedural, &info, NULL, source);
}

bool generate_folder(const char *cache, uint32_t scale, char *path, size_t size)
{
    char name[32] = "gallery-2";
    if (scale != 1)
        snprintf(name, sizeof name, "gallery-2-of-%u", scale);
    return cache_path(cache, name, path, size) && files_make_folders(path);
}

struct generation {
    struct progress progress;
    uint64_t done_before; ///< texels of the files before this one
};

static bool note_progress(void *user_data, uint64_t done, uint64_t total)
{
    struct generation *generation = user_data;
    (void)total;
    progress_update(&generation->progress, generation->done_before + done);
    return true;
}

static struct pattern_image scaled(const struct pattern_image *image, uint32_t scale)
{
    struct pattern_image small = *image;
    small.width = (image->width + scale - 1) / scale;
    small.height = (image->height + scale - 1) / scale;
    return small;
}

static uint64_t chain_texels(const struct pattern_image *image)
{
    uint64_t sum = 0;
    for (uint32_t w = image->width, h = image->height;;
         w = w > 1 ? w / 2 : 1, h = h > 1 ? h / 2 : 1) {
        sum += (uint64_t)w * h;
        if (w == 1 && h == 1)
            return sum;
    }
}

static bool write_picture(const struct pattern_image *image, const char *path,
                          uint32_t thread_count, struct generation *generation)
{
    SluiceImageSource *source = NULL;
    SluiceResult result = pattern_create_source(image, SLUICE_FORMAT_R16G16B16A16_SFLOAT, &source);
    SluiceExrWriteInfo info = {.structSize = sizeof info,
                               .pPath = path,
                               .tileWidth =
                                   128, /* size of the GPU's tile, so that each is read once */
                               .tileHeight = 64,
                               .threadCount = thread_count,
                               .opaque = true,
                               .log = {NULL, log_say},
                               .pUserData = generation,
                               .pfnProgress = note_progress};
    if (result == SLUICE_SUCCESS)
        result = sluiceWriteExrFile(&info, source);
    sluiceDestroyImageSource(source);
    if (result != SLUICE_SUCCESS)
        text_say("%s: cannot be made: %s", path, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

bool generate_pictures(const char *folder, uint32_t scale, uint32_t thread_count,
                       char paths[GENERATED_COUNT][4096])
{
    struct pattern_image missing[GENERATED_COUNT];
    uint32_t missing_index[GENERATED_COUNT], missing_count = 0;
    struct generation generation = {.done_before = 0};
    uint64_t total = 0;
    for (uint32_t i = 0; i < GENERATED_COUNT; i++) {
        struct pattern_image image = scaled(&pictures[i], scale);
        snprintf(paths[i], sizeof paths[i], "%s/%s-%ux%u.exr", folder, image.name, image.width,
                 image.height);
        if (access(paths[i], R_OK) == 0)
            continue;
        missing_index[missing_count] = i;
        missing[missing_count++] = image;
        total += chain_texels(&image);
    }
    if (missing_count == 0)
        return true;

    text_say("making %u pictures in %s", missing_count, folder);
    progress_begin(&generation.progress, "generating", "texels", total);
    for (uint32_t i = 0; i < missing_count; i++) {
        if (!write_picture(&missing[i], paths[missing_index[i]], thread_count, &generation))
            return false;
        generation.done_before += chain_texels(&missing[i]);
    }
    progress_end(&generation.progress);
    return true;
}
