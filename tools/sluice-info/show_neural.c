#include "file_report.h"

#include "neural_file.h"

#include "../common/input.h"
#include "../common/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char *const spaces[] = {"linear", "sRGB", "HLG"};
static const char *const formats[] = {"UNKNOWN", "UNORM8",  "UNORM16",
                                      "FLOAT16", "FLOAT32", "UINT32"};
static const char *const networks[] = {"small", "medium", "large", "xlarge", "schema 3"};

/* Prints a message of the library, which names the file. */
static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    if (severity != SLUICE_LOG_INFO)
        text_say("sluice-info: %s", message);
}

bool is_neural_file(const char *path)
{
    char start[4] = {0};
    FILE *file = input_open(path);
    if (!file)
        return false;
    (void)!fread(start, 1, sizeof start, file);
    fclose(file);
    return memcmp(start, "NTEX", 4) == 0;
}

/* Opens a file. The library reports all errors except these two. */
SluiceNeuralSet *open_neural_file(const char *path)
{
    SluiceNeuralSetCreateInfo info = {
        .structSize = sizeof info, .pPath = path, .log = {NULL, on_log}};
    SluiceNeuralSet *set = NULL;
    SluiceResult result = sluiceOpenNeuralSet(&info, &set);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY || result == SLUICE_NOT_READY)
        text_say("sluice-info: %s: %s", path, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS ? set : NULL;
}

static SluiceNeuralTexture texture_of(const SluiceNeuralSet *set, uint32_t index)
{
    SluiceNeuralTexture texture = {.structSize = sizeof texture};
    sluiceGetNeuralTexture(set, index, &texture);
    return texture;
}

static SluiceNeuralMip mip_of(const SluiceNeuralSet *set, uint32_t index)
{
    SluiceNeuralMip mip = {.structSize = sizeof mip};
    sluiceGetNeuralMip(set, index, &mip);
    return mip;
}

static SluiceNeuralLatentImage image_of(const SluiceNeuralSet *set, uint32_t index)
{
    SluiceNeuralLatentImage image = {.structSize = sizeof image};
    sluiceGetNeuralLatentImage(set, index, &image);
    return image;
}

static const char *channel_space(const SluiceNeuralSet *set, uint32_t channel)
{
    SluiceNeuralColorSpace space = SLUICE_NEURAL_COLOR_LINEAR;
    sluiceGetNeuralChannel(set, channel, &space);
    return spaces[space];
}

/* Returns the bytes of an image in the file, and whether some are compressed. */
static uint64_t stored_size(const SluiceNeuralSet *set, uint32_t image, uint32_t parts,
                            bool *is_compressed)
{
    uint64_t size = 0;
    *is_compressed = false;
    for (uint32_t p = 0; p < parts; p++) {
        SluiceNeuralLatentPart part;
        sluiceGetNeuralLatentPart(set, image, p, &part);
        size += part.storedSize;
        *is_compressed |= part.isCompressed;
    }
    return size;
}

static uint64_t weight_size(const SluiceNeuralSet *set, SluiceNeuralWeightKind kind)
{
    uint64_t size = 0;
    return sluiceGetNeuralWeights(set, kind, NULL, &size, NULL) == SLUICE_SUCCESS ? size : 0;
}

static void print_weights(FILE *out, const SluiceNeuralSet *set, const SluiceNeuralSetInfo *info)
{
    fprintf(out, "  weights                ");
    if (info->hasInt8)
        fprintf(out, " INT8, %" PRIu64 " bytes%s", weight_size(set, SLUICE_NEURAL_WEIGHTS_INT8),
                info->hasFp8 ? ";" : "");
    if (info->hasFp8)
        fprintf(out, " FP8, %" PRIu64 " bytes", weight_size(set, SLUICE_NEURAL_WEIGHTS_FP8));
    fprintf(out, "\n");
}

static void print_textures(FILE *out, const SluiceNeuralSet *set, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceNeuralTexture t = texture_of(set, i);
        fprintf(out, "  texture %-15u ", i);
        text_write(out, t.pName);
        fprintf(out, ": channels %u to %u, %s", t.firstChannel, t.firstChannel + t.channelCount - 1,
                formats[t.format]);
        fprintf(out, ", %s", spaces[t.rgbColorSpace]);
        if (t.channelCount == 4)
            fprintf(out, ", alpha %s", spaces[t.alphaColorSpace]);
        if (t.bcFormat)
            fprintf(out, ", as BC%u", t.bcFormat);
        fprintf(out, "\n");
    }
}

static void print_images(FILE *out, const SluiceNeuralSet *set, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceNeuralLatentImage image = image_of(set, i);
        bool is_compressed;
        uint64_t size = stored_size(set, i, image.partCount, &is_compressed);
        fprintf(out, "  latent image %-10u %u x %u", i, image.width, image.height);
        if (image.lowWidth)
            fprintf(out, " and %u x %u", image.lowWidth, image.lowHeight);
        fprintf(out, " texels, %" PRIu64 " bytes%s", size, is_compressed ? " (GDeflate)" : "");
        if (image.mipCount)
            fprintf(out, ", mips %u to %u\n", image.firstMip, image.firstMip + image.mipCount - 1);
        else
            fprintf(out, ", no mip\n");
    }
}

static void print_mips(FILE *out, const SluiceNeuralSet *set, uint32_t count)
{
    fprintf(out, "  mip   width  height  latents  fused with      lod  position scale\n");
    for (uint32_t i = 0; i < count; i++) {
        SluiceNeuralMip mip = mip_of(set, i);
        fprintf(out, "  %3u %7u %7u  %7u  %4u to %-4u %8.4f  %g\n", i, mip.width, mip.height,
                mip.latentImage, mip.firstFusedMip, mip.firstFusedMip + mip.fusedMipCount - 1,
                (double)mip.positionLod, (double)mip.positionScale);
    }
}

static void print_set(FILE *out, const SluiceNeuralSet *set, const SluiceNeuralSetInfo *info,
                      const char *path)
{
    uint64_t offset = 0, size = 0;
    sluiceGetNeuralLatentRange(set, 0, info->mipCount, &offset, &size);
    text_write(out, path);
    fprintf(out, ": neural textures, schema %u\n", info->schema);
    fprintf(out, "  size                    %u x %u texels, %u mips\n", info->width, info->height,
            info->mipCount);
    fprintf(out, "  channels                %u:", info->channelCount);
    for (uint32_t c = 0; c < info->channelCount; c++)
        fprintf(out, " %s", info->validChannels >> c & 1 ? channel_space(set, c) : "unused");
    fprintf(out, "\n  network                 %s, %u inputs\n", networks[info->network],
            info->inputCount);
    print_weights(out, set, info);
    if (info->schema == 1)
        fprintf(out, "  codes                   %u of %u bits, coarse %u of %u bits\n",
                info->highFeatures, info->highBits, info->lowFeatures, info->lowBits);
    else
        fprintf(out, "  codes                   %u of %u bits\n", info->highFeatures,
                info->highBits);
    fprintf(out,
            "  latents                 %" PRIu64 " bytes from %" PRIu64
            " on, 1 texel for %u x %u\n",
            info->latentSize, offset, info->gridScale, info->gridScale);
    fprintf(out, "  file                    %" PRIu64 " bytes, %.3f bits per texel of mip 0\n",
            info->fileSize,
            8 * (double)info->fileSize / ((double)info->width * (double)info->height));
    print_textures(out, set, info->textureCount);
    print_images(out, set, info->latentImageCount);
    print_mips(out, set, info->mipCount);
}

static void print_textures_json(FILE *out, const SluiceNeuralSet *set, uint32_t count)
{
    fprintf(out, ", \"textures\": [");
    for (uint32_t i = 0; i < count; i++) {
        SluiceNeuralTexture t = texture_of(set, i);
        fprintf(out, "%s{\"name\": ", i ? ", " : "");
        text_write_json(out, t.pName);
        fprintf(out,
                ", \"firstChannel\": %u, \"channelCount\": %u, \"format\": \"%s\", "
                "\"rgbColorSpace\": \"%s\", \"alphaColorSpace\": \"%s\", \"bcFormat\": %u}",
                t.firstChannel, t.channelCount, formats[t.format], spaces[t.rgbColorSpace],
                spaces[t.alphaColorSpace], t.bcFormat);
    }
    fprintf(out, "]");
}

static void print_images_json(FILE *out, const SluiceNeuralSet *set, uint32_t count)
{
    fprintf(out, ", \"latentImages\": [");
    for (uint32_t i = 0; i < count; i++) {
        SluiceNeuralLatentImage image = image_of(set, i);
        fprintf(out,
                "%s{\"width\": %u, \"height\": %u, \"lowWidth\": %u, \"lowHeight\": %u, "
                "\"firstMip\": %u, \"mipCount\": %u, \"parts\": [",
                i ? ", " : "", image.width, image.height, image.lowWidth, image.lowHeight,
                image.firstMip, image.mipCount);
        for (uint32_t p = 0; p < image.partCount; p++) {
            SluiceNeuralLatentPart part;
            sluiceGetNeuralLatentPart(set, i, p, &part);
            fprintf(out,
                    "%s{\"offset\": %" PRIu64 ", \"storedSize\": %" PRIu64 ", \"size\": %" PRIu64
                    ", \"compressed\": %s}",
                    p ? ", " : "", part.offset, part.storedSize, part.size,
                    part.isCompressed ? "true" : "false");
        }
        fprintf(out, "]}");
    }
    fprintf(out, "]");
}

static void print_mips_json(FILE *out, const SluiceNeuralSet *set, uint32_t count)
{
    fprintf(out, ", \"mips\": [");
    for (uint32_t i = 0; i < count; i++) {
        SluiceNeuralMip mip = mip_of(set, i);
        uint64_t offset = 0, size = 0;
        sluiceGetNeuralLatentRange(set, i, 1, &offset, &size);
        fprintf(out,
                "%s{\"width\": %u, \"height\": %u, \"latentImage\": %u, \"latentImageCount\": %u, "
                "\"firstFusedMip\": %u, \"fusedMipCount\": %u, \"positionLod\": %.9g, "
                "\"positionScale\": %.9g, \"latentOffset\": %" PRIu64 ", \"latentSize\": %" PRIu64
                "}",
                i ? ", " : "", mip.width, mip.height, mip.latentImage, mip.latentImageCount,
                mip.firstFusedMip, mip.fusedMipCount, (double)mip.positionLod,
                (double)mip.positionScale, offset, size);
    }
    fprintf(out, "]");
}

static void print_set_json(FILE *out, const SluiceNeuralSet *set, const SluiceNeuralSetInfo *info,
                           const char *path)
{
    fprintf(out, "{\"file\": ");
    text_write_json(out, path);
    fprintf(out,
            ", \"kind\": \"neural textures\", \"schema\": %u, \"width\": %u, \"height\": %u, "
            "\"mipLevelCount\": %u, \"channelCount\": %u, \"network\": \"%s\", \"inputCount\": %u",
            info->schema, info->width, info->height, info->mipCount, info->channelCount,
            networks[info->network], info->inputCount);
    fprintf(out,
            ", \"highFeatures\": %u, \"highBits\": %u, \"lowFeatures\": %u, \"lowBits\": %u, "
            "\"gridScale\": %u, \"int8Size\": %" PRIu64 ", \"fp8Size\": %" PRIu64
            ", \"fileSize\": %" PRIu64 ", \"latentSize\": %" PRIu64 ", \"channels\": [",
            info->highFeatures, info->highBits, info->lowFeatures, info->lowBits, info->gridScale,
            info->hasInt8 ? weight_size(set, SLUICE_NEURAL_WEIGHTS_INT8) : 0,
            info->hasFp8 ? weight_size(set, SLUICE_NEURAL_WEIGHTS_FP8) : 0, info->fileSize,
            info->latentSize);
    for (uint32_t c = 0; c < info->channelCount; c++)
        fprintf(out, "%s{\"colorSpace\": \"%s\", \"valid\": %s}", c ? ", " : "",
                channel_space(set, c), info->validChannels >> c & 1 ? "true" : "false");
    fprintf(out, "]");
    print_textures_json(out, set, info->textureCount);
    print_images_json(out, set, info->latentImageCount);
    print_mips_json(out, set, info->mipCount);
    fprintf(out, "}\n");
}

bool report_neural_file(const char *path, bool json, FILE *out)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    SluiceNeuralSet *set = open_neural_file(path);
    if (!set)
        return false;
    sluiceGetNeuralSetInfo(set, &info);
    (json ? print_set_json : print_set)(out, set, &info, path);
    sluiceDestroyNeuralSet(set);
    return true;
}
