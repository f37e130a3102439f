#include "neural.h"

#include "../common/gpu.h"
#include "../common/log.h"
#include "../common/output_file.h"
#include "../common/text.h"
#include "../common/training_run.h"

#include <sluice/bake.h>
#include <sluice/store.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* From few bits per texel to many. Bits: 5 * features / scale^2 of mip 0. */
static const struct {
    uint32_t scale, features;
} sizes[] = {{4, 4}, {4, 8}, {4, 16}, {2, 8}, {2, 16}};
#define SIZE_COUNT (sizeof sizes / sizeof *sizes)

static char speaker[] = "sluice-bake: ";

/* Level 0 of a picture, decoded. */
struct picture {
    uint32_t width, height, channels;
    SluiceFormat format;
    float *texels; /* owned; [y][x][channels] */
};

static float half_to_float(uint16_t half)
{
    uint32_t exponent = half >> 10 & 31, mantissa = half & 1023, sign = half >> 15;
    float size = exponent ? (float)(1024 + mantissa) : (float)mantissa;
    for (uint32_t e = exponent ? exponent : 1; e < 25; e++)
        size *= 0.5f;
    for (uint32_t e = exponent; e > 25; e--)
        size *= 2.0f;
    return sign ? -size : size;
}

static float sample_of(const uint8_t *bytes, uint32_t size, bool is_float)
{
    uint16_t two;
    float four;
    memcpy(&two, bytes, size == 2 ? 2 : 0);
    memcpy(&four, bytes, size == 4 ? 4 : 0);
    switch (size) {
    case 1: return (float)bytes[0] / 255.0f;
    case 2: return is_float ? half_to_float(two) : (float)two / 65535.0f;
    default: return four;
    }
}

static bool is_float_format(SluiceFormat format)
{
    return format >= SLUICE_FORMAT_R16_SFLOAT && format <= SLUICE_FORMAT_R32G32B32A32_SFLOAT;
}

static bool is_plain_format(SluiceFormat format)
{
    return is_float_format(format) || format == SLUICE_FORMAT_R8_UNORM ||
           format == SLUICE_FORMAT_R8G8_UNORM || format == SLUICE_FORMAT_R8G8B8A8_UNORM ||
           format == SLUICE_FORMAT_R8G8B8A8_SRGB ||
           (format >= SLUICE_FORMAT_R16_UNORM && format <= SLUICE_FORMAT_R16G16B16A16_UNORM);
}

static bool read_level0(SluiceImageSource *source, const char *path, struct picture *picture)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceFormatInfo format = {.structSize = sizeof format};
    if (sluiceGetImageInfo(source, &info) != SLUICE_SUCCESS || !is_plain_format(info.format) ||
        sluiceGetFormatInfo(info.format, &format) != SLUICE_SUCCESS) {
        fprintf(stderr, "sluice-bake: %s: %s pictures cannot be compressed together with others\n",
                path, sluiceGetFormatName(info.format));
        return false;
    }
    *picture = (struct picture){info.width, info.height, format.channelCount, info.format, NULL};
    const size_t count = (size_t)info.width * info.height * format.channelCount;
    const uint32_t size = format.blockSize / format.channelCount;
    uint8_t *bytes = malloc(count * size);
    picture->texels = malloc(count * sizeof(float));
    const SluiceImageRegion all = {0, 0, 0, info.width, info.height, 0};
    bool is_read = bytes && picture->texels &&
                   sluiceReadImageRegion(source, &all, bytes,
                                         (size_t)info.width * format.blockSize) == SLUICE_SUCCESS;
    for (size_t i = 0; i < count && is_read; i++)
        picture->texels[i] = sample_of(bytes + i * size, size, is_float_format(info.format));
    if (!is_read)
        fprintf(stderr, "sluice-bake: %s: cannot be read\n", path);
    free(bytes);
    return is_read;
}

/* Bakes the picture to a temporary store beside the output and reads that, so that all formats of
 * the baker are read. */
static bool read_picture(SluiceBaker *baker, const char *path, const struct options *options,
                         struct picture *picture)
{
    size_t length = strlen(options->output) + 16;
    char *store = malloc(length);
    SluiceImageSource *source = NULL;
    if (!store)
        return false;
    snprintf(store, length, "%s.picture.store", options->output);
    SluiceBakeSettings settings = options->settings;
    settings.structSize = sizeof settings;
    settings.uncompressed = true;
    const SluiceBakeInfo bake = {.structSize = sizeof bake,
                                 .pInputPath = path,
                                 .pOutputPath = store,
                                 .pSettings = &settings,
                                 .force = true};
    const SluiceStoreImageSourceCreateInfo info = {
        .structSize = sizeof info, .pPath = store, .log = {speaker, log_say}};
    SluiceResult result = sluiceBakeFile(baker, &bake, NULL);
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateStoreImageSource(&info, &source);
    if (result != SLUICE_SUCCESS)
        fprintf(stderr, "sluice-bake: %s: %s\n", path, sluiceGetResultName(result));
    bool is_read = result == SLUICE_SUCCESS && read_level0(source, path, picture);
    sluiceDestroyImageSource(source);
    remove(store);
    free(store);
    return is_read;
}

/* Pictures without alpha have four channels in stores. */
static void drop_opaque_alpha(struct picture *picture)
{
    const size_t count = (size_t)picture->width * picture->height;
    if (picture->channels != 4)
        return;
    for (size_t i = 0; i < count; i++)
        if (picture->texels[4 * i + 3] < 1.0f)
            return;
    for (size_t i = 0; i < count; i++)
        memmove(picture->texels + 3 * i, picture->texels + 4 * i, 3 * sizeof(float));
    picture->channels = 3;
}

/* Copies the file's name without folder and extension. */
static void name_of(const char *path, char name[TRAINING_SET_NAME])
{
    const char *slash = strrchr(path, '/');
    snprintf(name, TRAINING_SET_NAME, "%s", slash ? slash + 1 : path);
    char *dot = strrchr(name, '.');
    if (dot && dot != name)
        *dot = '\0';
}

static bool add_picture(struct training_set *set, const char *path, struct picture *picture,
                        bool mask)
{
    char name[TRAINING_SET_NAME];
    name_of(path, name);
    bool is_float = is_float_format(picture->format);
    bool is_16 = picture->format >= SLUICE_FORMAT_R16_UNORM && !is_float;
    drop_opaque_alpha(picture);
    const struct training_picture added = {.name = name,
                                           .width = picture->width,
                                           .height = picture->height,
                                           .channel_count = picture->channels,
                                           .texels = picture->texels,
                                           .format = is_float ? SLUICE_NEURAL_CHANNEL_FLOAT16
                                                     : is_16  ? SLUICE_NEURAL_CHANNEL_UNORM16
                                                              : SLUICE_NEURAL_CHANNEL_UNORM8,
                                           .space = is_float ? SLUICE_NEURAL_COLOR_HLG
                                                    : picture->format == SLUICE_FORMAT_R8G8B8A8_SRGB
                                                        ? SLUICE_NEURAL_COLOR_SRGB
                                                        : SLUICE_NEURAL_COLOR_LINEAR,
                                           .mask = mask && picture->channels == 4};
    return training_set_add(set, &added);
}

/* Parses "NAME=W,NAME=W". */
static bool weigh(struct training_set *set, const char *text)
{
    while (text && *text) {
        char name[TRAINING_SET_NAME];
        const char *equals = strchr(text, '=');
        char *end = NULL;
        const float weight = equals ? strtof(equals + 1, &end) : 0.0f;
        const size_t length = equals ? (size_t)(equals - text) : 0;
        if (!equals || end == equals + 1 || (*end && *end != ',') || length >= sizeof name ||
            !(weight > 0.0f && weight <= 1000.0f)) {
            fprintf(stderr,
                    "sluice-bake: --loss-weights %s: is no NAME=W with W above 0 and at most "
                    "1000\n",
                    text);
            return false;
        }
        snprintf(name, sizeof name, "%.*s", (int)length, text);
        if (!training_set_weigh(set, name, weight)) {
            fprintf(stderr, "sluice-bake: --loss-weights %s: no picture has this name\n", name);
            return false;
        }
        text = *end ? end + 1 : end;
    }
    return true;
}

static bool read_set(const struct options *options, struct training_set *set)
{
    const SluiceBakerCreateInfo info = {
        .structSize = sizeof info, .threadCount = options->threads, .log = {speaker, log_say}};
    SluiceBaker *baker;
    if (sluiceCreateBaker(&info, &baker) != SLUICE_SUCCESS) {
        fprintf(stderr, "sluice-bake: out of memory\n");
        return false;
    }
    bool is_read = true;
    for (size_t i = 0; i < options->inputs.count && is_read; i++) {
        struct picture picture = {0};
        is_read = read_picture(baker, options->inputs.items[i], options, &picture) &&
                  add_picture(set, options->inputs.items[i], &picture, options->mask);
        free(picture.texels);
    }
    sluiceDestroyBaker(baker);
    return is_read && weigh(set, options->weights) && training_set_finish_mips(set);
}

static void print_run(const struct options *options, const struct training_run *run)
{
    double bits = 5.0 * run->features / (run->scale * run->scale);
    if (options->json) {
        printf("{\"file\": ");
        text_write_json(stdout, options->output);
        printf(", \"bits_per_texel\": %g, \"size\": %" PRIu64
               ", \"psnr\": %.3f, \"fp8_psnr\": %.3f, "
               "\"exact_mask\": %.5f, \"repaired\": %" PRIu64
               ", \"steps\": %u, \"seconds\": %.3f, \"repair_seconds\": %.3f}\n",
               bits, run->file_size, run->psnr, run->fp8_psnr, run->exact_mask, run->repaired,
               run->steps_run, run->seconds, run->repair_seconds);
        return;
    }
    text_write(stdout, options->output);
    printf(": %g bits per texel, %" PRIu64 " bytes, %.2f dB (int8), %.2f dB (fp8), %u steps in "
           "%.1f s\n",
           bits, run->file_size, run->psnr, run->fp8_psnr, run->steps_run, run->seconds);
}

/* Trains one size, or all from small to large until one reaches the quality. */
static bool compress(const struct options *options, const struct gpu *gpu,
                     const struct training_set *set)
{
    bool is_search = options->psnr > 0.0;
    size_t first = is_search ? 0 : (size_t)options->bits, last = is_search ? SIZE_COUNT - 1 : first;
    for (size_t i = first; i <= last; i++) {
        struct training_run run = {.gpu = gpu,
                                   .set = set,
                                   .scale = sizes[i].scale,
                                   .features = sizes[i].features,
                                   .steps = options->steps,
                                   .batch = options->batch,
                                   .seed = options->seed,
                                   .output = options->output,
                                   .checkpoint = options->checkpoint,
                                   .progress = options->progress};
        if (!training_run(&run))
            return false;
        print_run(options, &run);
        if (is_search && run.psnr >= options->psnr)
            return true;
    }
    if (is_search)
        fprintf(stderr, "sluice-bake: %g dB are not reached\n", options->psnr);
    return !is_search;
}

bool neural_bake(const struct options *options)
{
    struct training_set set = {0};
    struct gpu gpu;
    const struct gpu_request request = {.device = options->device};
    bool unsupported;
    output_set_speaker(speaker);
    if (!gpu_create(&request, &gpu, &unsupported))
        return false;
    for (size_t i = 0; i < options->inputs.count; i++)
        if (!output_add_input(options->inputs.items[i])) {
            gpu_destroy(&gpu);
            return false;
        }
    bool is_done = output_can_write(options->output) && read_set(options, &set) &&
                   compress(options, &gpu, &set);
    training_set_free(&set);
    gpu_destroy(&gpu);
    log_finish();
    return is_done;
}
