#define _POSIX_C_SOURCE 200809L
#include "pictures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <sluice/exr.h>

#include "../common/files.h"

#define EXPOSURE_LEVEL_SIZE 64 ///< the level that exposure is measured on is no larger

static void print_log(void *user_data, SluiceLogSeverity severity, const char *message)
{
    (void)user_data;
    if (severity != SLUICE_LOG_INFO)
        fprintf(stderr, "%s\n", message);
}

static SluiceResult open_source(const char *path, SluiceFormat format, SluiceImageSource **source,
                                SluiceImageInfo *info)
{
    SluiceExrImageSourceCreateInfo create = {
        .pPath = path, .format = format, .log = {NULL, print_log}};
    SluiceResult result = sluiceCreateExrImageSource(&create, source);
    if (result != SLUICE_SUCCESS)
        return result;
    result = sluiceGetImageInfo(*source, info);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyImageSource(*source);
        *source = NULL;
    }
    return result;
}

/** Half of the memory and bandwidth for what a screen cannot show. */
static SluiceFormat narrowed(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R32_SFLOAT: return SLUICE_FORMAT_R16_SFLOAT;
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: return SLUICE_FORMAT_R16G16B16A16_SFLOAT;
    default: return format;
    }
}

static SluiceResult open_in_format(const char *path, enum pixel_format pixels,
                                   SluiceImageSource **source, SluiceImageInfo *info)
{
    if (pixels == PIXEL_FORMAT_RGBA8)
        return open_source(path, SLUICE_FORMAT_R8G8B8A8_SRGB, source, info);
    if (pixels == PIXEL_FORMAT_RGBA16F)
        return open_source(path, SLUICE_FORMAT_R16G16B16A16_SFLOAT, source, info);
    SluiceResult result = open_source(path, SLUICE_FORMAT_UNDEFINED, source, info);
    if (result != SLUICE_SUCCESS || narrowed(info->format) == info->format)
        return result;
    SluiceFormat format = narrowed(info->format);
    sluiceDestroyImageSource(*source);
    *source = NULL;
    return open_source(path, format, source, info);
}

static float half_to_float(uint16_t half)
{
    int exponent = half >> 10 & 31;
    float magnitude = exponent == 0 ? ldexpf((float)(half & 1023), -24)
                                    : ldexpf((float)((half & 1023) | 1024), exponent - 25);
    return exponent == 31 ? NAN : half & 0x8000 ? -magnitude : magnitude;
}

static float texel_luminance(const uint8_t *texel, SluiceFormat format)
{
    uint16_t half[4];
    switch (format) {
    case SLUICE_FORMAT_R16_SFLOAT: memcpy(half, texel, 2); return half_to_float(half[0]);
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT:
        memcpy(half, texel, 8);
        return 0.2126f * half_to_float(half[0]) + 0.7152f * half_to_float(half[1]) +
               0.0722f * half_to_float(half[2]);
    default: /* sRGB bytes, roughly decoded */
        return powf(
            (0.2126f * (float)texel[0] + 0.7152f * (float)texel[1] + 0.0722f * (float)texel[2]) /
                255.0f,
            2.2f);
    }
}

/** From the mean and the brightest tenth of a small level; 1 for pictures that are well exposed. */
static float exposure_for(const uint8_t *texels, uint32_t count, SluiceFormat format)
{
    uint32_t texel_size = sluiceFormatTexelSize(format);
    double sum = 0.0, log_sum = 0.0;
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        float luminance = texel_luminance(texels + (size_t)i * texel_size, format);
        if (!(luminance > 1e-6f))
            continue;
        sum += fminf(luminance, 65504.0f);
        log_sum += log2(luminance);
        used++;
    }
    if (used == 0)
        return 1.0f;
    /* The geometric mean alone makes a dark picture with a few lights far too bright. */
    double mean = 0.5 * (sum / used) + 0.5 * exp2(log_sum / used);
    return mean > 0.34   ? (float)(0.34 / mean)
           : mean < 0.09 ? (float)fmin(0.09 / mean, 4096.0)
                         : 1.0f;
}

static SluiceResult measure_exposure(struct picture *picture)
{
    SluiceImageRegion region = {0, 0, 0, picture->info.width, picture->info.height};
    while ((region.width > EXPOSURE_LEVEL_SIZE || region.height > EXPOSURE_LEVEL_SIZE) &&
           region.mipLevel + 1 < picture->info.mipLevelCount) {
        region.mipLevel++;
        region.width = region.width > 1 ? region.width / 2 : 1;
        region.height = region.height > 1 ? region.height / 2 : 1;
    }
    size_t pitch = (size_t)region.width * sluiceFormatTexelSize(picture->info.format);
    uint8_t *texels = malloc(pitch * region.height);
    if (!texels)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = sluiceReadImageRegion(picture->color, &region, texels, pitch);
    if (result == SLUICE_SUCCESS)
        picture->exposure =
            exposure_for(texels, region.width * region.height, picture->info.format);
    free(texels);
    return result;
}

static bool fits(const SluiceImageInfo *info, const struct picture_limits *limits)
{
    uint64_t bytes = (uint64_t)info->width * info->height * sluiceFormatTexelSize(info->format);
    return info->width <= limits->max_size && info->height <= limits->max_size &&
           bytes + bytes / 3 <= limits->max_bytes;
}

static SluiceResult open_picture(const char *path, enum pixel_format pixels,
                                 const struct picture_limits *limits, struct picture *picture)
{
    memset(picture, 0, sizeof *picture);
    picture->exposure = 1.0f;
    SluiceResult result = open_in_format(path, pixels, &picture->color, &picture->info);
    if (result == SLUICE_SUCCESS && !fits(&picture->info, limits)) {
        fprintf(stderr, "%s: %u x %u texels are more than the device can address\n", path,
                picture->info.width, picture->info.height);
        result = SLUICE_ERROR_UNSUPPORTED;
    }
    if (result == SLUICE_SUCCESS)
        result = measure_exposure(picture);
    picture->grey = picture->info.format == SLUICE_FORMAT_R16_SFLOAT;
    picture->path = strdup(path);
    return picture->path ? result : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static void close_picture(struct picture *picture)
{
    sluiceDestroyImageSource(picture->color);
    sluiceDestroyImageSource(picture->relief);
    free(picture->path);
}

/* The patterns are at their final address only after the list is complete. */
static bool create_reliefs(struct picture_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        struct picture *picture = &list->pictures[i];
        picture->relief_pattern = (struct pattern_image){
            .name = "relief",
            .width = (picture->info.width + 1) / 2,
            .height = (picture->info.height + 1) / 2,
            .pattern = pattern_canvas,
            .supersamples = 1,
        };
        SluiceResult result = pattern_create_source(&picture->relief_pattern,
                                                    SLUICE_FORMAT_R8_UNORM, &picture->relief);
        if (result != SLUICE_SUCCESS) {
            fprintf(stderr, "%s: no relief: %s\n", picture->path, sluiceResultString(result));
            return false;
        }
    }
    return true;
}

static bool open_files(const struct file_list *files, enum pixel_format pixels,
                       const struct picture_limits *limits, struct picture_list *list)
{
    list->pictures = calloc(files->count ? files->count : 1, sizeof *list->pictures);
    if (!list->pictures)
        return false;
    for (size_t i = 0; i < files->count; i++) {
        struct picture *picture = &list->pictures[list->count];
        SluiceResult result = open_picture(files->paths[i], pixels, limits, picture);
        if (result == SLUICE_SUCCESS) {
            list->count++;
            continue;
        }
        fprintf(stderr, "%s: left out: %s\n", files->paths[i], sluiceResultString(result));
        close_picture(picture);
        list->refused++;
    }
    if (list->count == 0)
        fprintf(stderr, "there is no picture to hang\n");
    return list->count > 0 && create_reliefs(list);
}

static bool collect_generated(const struct settings *settings, struct file_list *files)
{
    char folder[4000], paths[GENERATED_COUNT][4096];
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (!generate_folder(settings->cache, settings->generate_scale, folder, sizeof folder) ||
        !generate_pictures(folder, settings->generate_scale,
                           processors > 1 ? (uint32_t)processors : 1, paths))
        return false;
    for (uint32_t i = 0; i < GENERATED_COUNT; i++)
        if (!files_collect(paths[i], ".exr", files))
            return false;
    return true;
}

bool pictures_open(const struct settings *settings, const struct picture_limits *limits,
                   struct picture_list *list)
{
    struct file_list files = {0};
    bool collected = settings->images.count > 0 || collect_generated(settings, &files);
    for (size_t i = 0; collected && i < settings->images.count; i++)
        collected = files_collect(settings->images.items[i], ".exr", &files);
    *list = (struct picture_list){0};
    bool opened =
        collected && open_files(&files, (enum pixel_format)settings->format, limits, list);
    files_finish(&files);
    if (!opened)
        pictures_close(list);
    return opened;
}

void pictures_close(struct picture_list *list)
{
    for (uint32_t i = 0; i < list->count; i++)
        close_picture(&list->pictures[i]);
    free(list->pictures);
    *list = (struct picture_list){0};
}
