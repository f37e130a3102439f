/* Image sources for the textures of a set. */
#include <sluice/neural_source.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "image/convert.h"

#include <string.h>

enum { MAX_CHANNELS = 4 };

struct neural_source {
    SluiceImageSource base;
    SluiceAllocationCallbacks allocator;
    const SluiceNeuralSet *set;
    SluiceNeuralSet *owned;
    SluiceNeuralTexture texture;
    SluiceNeuralWeightKind kind;
    SluiceNeuralColorSpace from[MAX_CHANNELS], to[MAX_CHANNELS]; ///< `to`: before encoding
    SluiceImageInfo info;
    void *weights;
    uint64_t weight_size;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct neural_source *)base)->info;
    return SLUICE_SUCCESS;
}

/* Memory of a read: latents, then a row of the network's outputs, and the row as RGBA. */
struct scratch {
    SluiceNeuralConstants constants;
    unsigned char *memory;
    size_t size;
    uint64_t latent_size;
    float *channels, *rgba;
    const void *latents;
};

static SluiceResult scratch_init(struct scratch *scratch, const struct neural_source *source,
                                 const SluiceImageRegion *region)
{
    const SluiceNeuralRequest request = {.firstMip = region->mipLevel,
                                         .mipCount = 1,
                                         .x = region->x,
                                         .y = region->y,
                                         .width = region->width,
                                         .height = region->height};
    *scratch = (struct scratch){0};
    SluiceResult result = sluiceReadNeuralLatents(source->set, &request, &scratch->constants,
                                                  &scratch->latent_size, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    size_t floats = (size_t)region->width * 2 * MAX_CHANNELS, latents = 0;
    if (scratch->latent_size > SIZE_MAX ||
        !slc_add_size((size_t)scratch->latent_size, floats * sizeof(float), &latents))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    scratch->size = latents;
    scratch->memory = slc_alloc(&source->allocator, scratch->size, 1);
    if (!scratch->memory)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    scratch->channels = (float *)(void *)scratch->memory;
    scratch->rgba = scratch->channels + floats / 2;
    scratch->latents = scratch->channels + floats;
    return sluiceReadNeuralLatents(source->set, &request, &scratch->constants,
                                   &scratch->latent_size, scratch->memory + floats * sizeof(float));
}

static void write_row(const struct neural_source *source, const struct scratch *scratch,
                      uint32_t width, void *texels)
{
    const uint32_t count = source->texture.channelCount;
    for (uint32_t x = 0; x < width; x++) {
        float *rgba = &scratch->rgba[x * MAX_CHANNELS];
        memcpy(rgba, (float[]){0, 0, 0, 1}, sizeof(float[MAX_CHANNELS]));
        for (uint32_t c = 0; c < count; c++)
            rgba[c] = sluiceConvertNeuralColor(scratch->channels[x * count + c], source->from[c],
                                               source->to[c]);
    }
    slc_texels_from_rgba(source->info.format, scratch->rgba, texels, width);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct neural_source *source = (struct neural_source *)base;
    struct scratch scratch;
    SluiceResult result = scratch_init(&scratch, source, region);
    SluiceNeuralDecodeInfo decode = {.structSize = sizeof decode,
                                     .pConstants = &scratch.constants,
                                     .pLatents = scratch.latents,
                                     .latentSize = scratch.latent_size,
                                     .pWeights = source->weights,
                                     .weightSize = source->weight_size,
                                     .weightKind = source->kind,
                                     .mip = region->mipLevel,
                                     .x = region->x,
                                     .width = region->width,
                                     .height = 1,
                                     .firstChannel = source->texture.firstChannel,
                                     .channelCount = source->texture.channelCount,
                                     .pTexels = scratch.channels};
    for (uint32_t y = 0; y < region->height && result == SLUICE_SUCCESS; y++) {
        decode.y = region->y + y;
        result = sluiceDecodeNeuralTexels(&decode);
        if (result == SLUICE_SUCCESS)
            write_row(source, &scratch, region->width, (unsigned char *)texels + y * row_pitch);
    }
    if (scratch.memory)
        slc_free(&source->allocator, scratch.memory, scratch.size, 1);
    return result;
}

static void destroy(SluiceImageSource *base)
{
    struct neural_source *source = (struct neural_source *)base;
    const SluiceAllocationCallbacks cb = source->allocator;
    sluiceDestroyNeuralSet(source->owned);
    if (source->weights)
        slc_free(&cb, source->weights, (size_t)source->weight_size, 1);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface neural_interface = {sizeof neural_interface, get_info,
                                                            read_region, destroy};

/* Chooses the format. Integer formats with sRGB encode RGB; float formats are linear. */
static void choose_format(struct neural_source *source)
{
    static const SluiceFormat formats[3][3] = {
        {SLUICE_FORMAT_R8_UNORM, SLUICE_FORMAT_R8G8_UNORM, SLUICE_FORMAT_R8G8B8A8_UNORM},
        {SLUICE_FORMAT_R16_UNORM, SLUICE_FORMAT_R16G16_UNORM, SLUICE_FORMAT_R16G16B16A16_UNORM},
        {SLUICE_FORMAT_R16_SFLOAT, SLUICE_FORMAT_R16G16_SFLOAT, SLUICE_FORMAT_R16G16B16A16_SFLOAT}};
    const SluiceNeuralTexture *t = &source->texture;
    bool is_float = t->format == SLUICE_NEURAL_CHANNEL_FLOAT16 ||
                    t->format == SLUICE_NEURAL_CHANNEL_FLOAT32 ||
                    t->rgbColorSpace == SLUICE_NEURAL_COLOR_HLG;
    bool is_srgb = !is_float && t->rgbColorSpace == SLUICE_NEURAL_COLOR_SRGB;
    uint32_t depth = is_float ? 2 : t->format == SLUICE_NEURAL_CHANNEL_UNORM16 ? 1 : 0;
    source->info.format = is_srgb && depth == 0
                              ? SLUICE_FORMAT_R8G8B8A8_SRGB
                              : formats[depth][slc_min_u32(t->channelCount, 3) - 1];
    for (uint32_t c = 0; c < MAX_CHANNELS; c++) {
        bool encoded_later =
            is_float || (c < 3 && source->info.format == SLUICE_FORMAT_R8G8B8A8_SRGB);
        source->to[c] = encoded_later ? SLUICE_NEURAL_COLOR_LINEAR
                        : c < 3       ? t->rgbColorSpace
                                      : t->alphaColorSpace;
    }
}

static SluiceResult read_weights(struct neural_source *source)
{
    SluiceResult result =
        sluiceGetNeuralWeights(source->set, source->kind, NULL, &source->weight_size, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    source->weights = slc_alloc(&source->allocator, (size_t)source->weight_size, 1);
    if (!source->weights)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return sluiceGetNeuralWeights(source->set, source->kind, NULL, &source->weight_size,
                                  source->weights);
}

static SluiceResult fill(struct neural_source *source, uint32_t index)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetNeuralSetInfo(source->set, &info);
    source->texture.structSize = sizeof source->texture;
    if (result == SLUICE_SUCCESS)
        result = sluiceGetNeuralTexture(source->set, index, &source->texture);
    for (uint32_t c = 0; c < source->texture.channelCount && result == SLUICE_SUCCESS; c++)
        result =
            sluiceGetNeuralChannel(source->set, source->texture.firstChannel + c, &source->from[c]);
    if (result != SLUICE_SUCCESS)
        return result;
    source->info = (SluiceImageInfo){.structSize = sizeof source->info,
                                     .width = info.width,
                                     .height = info.height,
                                     .mipLevelCount = info.mipCount,
                                     .pName = source->texture.pName};
    choose_format(source);
    return read_weights(source);
}

static SluiceResult create(const SluiceNeuralImageSourceCreateInfo *info,
                           SluiceImageSource **source)
{
    const SluiceAllocationCallbacks cb = slc_allocator(info->pAllocator);
    struct neural_source *made = slc_calloc(&cb, 1, sizeof *made);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    made->base.pInterface = &neural_interface;
    made->allocator = cb;
    made->set = info->ownedSet ? info->ownedSet : info->set;
    made->kind = info->weights;
    SluiceResult result = fill(made, info->textureIndex);
    if (result != SLUICE_SUCCESS) {
        destroy(&made->base);
        return result;
    }
    made->owned = info->ownedSet;
    *source = &made->base;
    return SLUICE_SUCCESS;
}

static SluiceResult check(const SluiceNeuralImageSourceCreateInfo *info)
{
    SluiceNeuralSetInfo set = {.structSize = sizeof set};
    if ((!info->set && !info->ownedSet) || !slc_allocator_is_valid(info->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    if (info->set && info->ownedSet)
        return slc_log_refusal(&info->log, "set and ownedSet are both set");
    SluiceResult result = sluiceGetNeuralSetInfo(info->set ? info->set : info->ownedSet, &set);
    if (result == SLUICE_SUCCESS && info->textureIndex >= set.textureCount)
        return slc_log_refusal(&info->log, "textureIndex is %u; the set has %u textures",
                               info->textureIndex, set.textureCount);
    return result;
}

SluiceResult sluiceCreateNeuralImageSource(const SluiceNeuralImageSourceCreateInfo *pInfo,
                                           SluiceImageSource **pSource)
{
    SluiceNeuralImageSourceCreateInfo info;
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralImageSourceCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    result = pSource ? check(&info) : SLUICE_ERROR_NULL_POINTER;
    if (result == SLUICE_SUCCESS)
        result = create(&info, pSource);
    if (result != SLUICE_SUCCESS)
        sluiceDestroyNeuralSet(info.ownedSet);
    return result;
}
