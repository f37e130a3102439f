#include "neural/file_plan.h"

#include "base/checked.h"
#include "base/limits.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "neural/slices.h"

#include <math.h>
#include <string.h>

enum { MAX_GRID_SCALE = 6 };

static SluiceResult check_numbers(const SluiceNeuralWriteInfo *info)
{
    uint32_t mips = slc_mip_count(slc_max_u32(slc_max_u32(info->width, info->height), 1));
    bool is_one = info->schema == 1;
    const struct slc_limit limits[] = {
        {"width", info->width, 1, SLUICE_NEURAL_MAX_SIZE},
        {"height", info->height, 1, SLUICE_NEURAL_MAX_SIZE},
        {"mipCount", info->mipCount ? info->mipCount : 1, 1, mips},
        {"channelCount", info->channelCount, 1, SLUICE_NEURAL_MAX_CHANNELS},
        {"textureCount", info->textureCount, 0, SLUICE_NEURAL_MAX_CHANNELS},
        {"network", (uint64_t)info->network, is_one ? 0 : SLUICE_NEURAL_NETWORK_SCHEMA3,
         is_one ? SLUICE_NEURAL_NETWORK_XLARGE : SLUICE_NEURAL_NETWORK_SCHEMA3},
        {"gridScale", info->gridScale, 1, MAX_GRID_SCALE},
        {"latentImageCount", info->latentImageCount, 0, SLUICE_NEURAL_MAX_LATENT_IMAGES},
    };
    if (!is_one && info->schema != 3)
        return slc_log_refusal(&info->log, "schema is %u; 1 and 3 are written", info->schema);
    if (info->schema == 3 && info->latentImageCount % 2)
        return slc_log_refusal(&info->log, "latentImageCount is %u; schema 3 has an even number",
                               info->latentImageCount);
    return slc_check_limits(&info->log, limits, sizeof limits / sizeof *limits);
}

static SluiceResult check_shape(const SluiceNeuralWriteInfo *info)
{
    bool is_one = info->schema == 1;
    const uint32_t features[] = {info->highFeatures, is_one ? info->lowFeatures : 4};
    const uint32_t bits[] = {is_one ? info->highBits : 4, is_one ? info->lowBits : 4};
    for (int i = 0; i < 2; i++) {
        if (features[i] == 0 || features[i] > 16 || features[i] % 4)
            return slc_log_refusal(&info->log, "%sFeatures is %u; 4, 8, 12 and 16 are possible",
                                   i ? "low" : "high", features[i]);
        if (bits[i] == 0 || bits[i] > 8 || (bits[i] & (bits[i] - 1)))
            return slc_log_refusal(&info->log, "%sBits is %u; 1, 2, 4 and 8 are possible",
                                   i ? "low" : "high", bits[i]);
    }
    if (is_one && info->highFeatures > 4 * ((uint32_t)info->network + 1))
        return slc_log_refusal(&info->log, "highFeatures is %u; the network has %u",
                               info->highFeatures, 4 * ((uint32_t)info->network + 1));
    return SLUICE_SUCCESS;
}

static SluiceResult check_texture(const SluiceNeuralWriteInfo *info, uint32_t index,
                                  SluiceNeuralTexture *texture)
{
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceNeuralTexture), texture,
                                          &info->pTextures[index], &info->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!texture->pName)
        return SLUICE_ERROR_NULL_POINTER;
    uint32_t first = texture->firstChannel, count = texture->channelCount;
    if (count == 0 || count > 4 || first >= info->channelCount ||
        count > info->channelCount - first)
        return slc_log_refusal(&info->log, "texture %u has %u channels from %u on, of %u", index,
                               count, first, info->channelCount);
    if ((uint32_t)texture->format > SLUICE_NEURAL_CHANNEL_UINT32 || texture->bcFormat > 7 ||
        (uint32_t)texture->rgbColorSpace > SLUICE_NEURAL_COLOR_HLG ||
        (uint32_t)texture->alphaColorSpace > SLUICE_NEURAL_COLOR_HLG)
        return slc_log_refusal(&info->log, "texture %u has an unknown format or color space",
                               index);
    return SLUICE_SUCCESS;
}

static SluiceResult plan_textures(const SluiceNeuralWriteInfo *info, SluiceNeuralSet *set)
{
    if (info->textureCount && !info->pTextures)
        return SLUICE_ERROR_NULL_POINTER;
    for (uint32_t i = 0; i < info->textureCount; i++) {
        SluiceNeuralTexture texture = {.structSize = sizeof texture};
        SluiceResult result = check_texture(info, i, &texture);
        if (result != SLUICE_SUCCESS)
            return result;
        set->info.validChannels |= ((1u << texture.channelCount) - 1) << texture.firstChannel;
        set->textures[i] = (struct slc_neural_document_texture){
            .name = texture.pName,
            .first_channel = texture.firstChannel,
            .channel_count = texture.channelCount,
            .format = (uint32_t)texture.format,
            .rgb_color_space = (uint32_t)texture.rgbColorSpace,
            .alpha_color_space = (uint32_t)texture.alphaColorSpace,
            .bc_format = texture.bcFormat,
        };
    }
    for (uint32_t i = 0; info->pColorSpaces && i < info->channelCount; i++) {
        set->color_spaces[i] = (uint32_t)info->pColorSpaces[i];
        if (set->color_spaces[i] > SLUICE_NEURAL_COLOR_HLG)
            return slc_log_refusal(&info->log,
                                   "color space of channel %u is %u; 0 to 2 are possible", i,
                                   set->color_spaces[i]);
    }
    return SLUICE_SUCCESS;
}

/* Returns the texels of a grid of latent image n: fine, or coarse (schema 1). */
static uint32_t grid_size(const SluiceNeuralWriteInfo *info, uint32_t size, uint32_t n,
                          bool is_coarse)
{
    uint32_t base = size / (info->gridScale * (is_coarse ? 2 : 1));
    return slc_max_u32(1, base >> (info->schema == 1 ? 2 * n : n));
}

/* Returns the number of latent images with more than one texel; an even number in schema 3. */
static uint32_t default_image_count(const SluiceNeuralWriteInfo *info)
{
    uint32_t size = slc_max_u32(info->width, info->height), count = 0;
    if (info->latentImageCount)
        return info->latentImageCount;
    if (info->schema == 3) {
        count = slc_mip_count(grid_size(info, size, 0, false)) & ~1u;
        return slc_max_u32(2, slc_min_u32(count, SLUICE_NEURAL_MAX_LATENT_IMAGES));
    }
    while (count < SLUICE_NEURAL_MAX_LATENT_IMAGES && grid_size(info, size, count, true) > 1)
        count++;
    return slc_max_u32(1, count);
}

static void plan_grids(const SluiceNeuralWriteInfo *info, SluiceNeuralSet *set)
{
    bool is_one = info->schema == 1;
    for (uint32_t n = 0; n < set->info.latentImageCount; n++)
        for (uint32_t coarse = 0; coarse < (is_one ? 2u : 1u); coarse++)
            set->grids[set->grid_count++] = (struct slc_neural_grid){
                .width = grid_size(info, info->width, n, coarse),
                .height = grid_size(info, info->height, n, coarse),
                .features = coarse ? set->info.lowFeatures : set->info.highFeatures,
                .bits = coarse ? set->info.lowBits : set->info.highBits,
                .part_count = is_one ? 1 : set->info.highFeatures / 4,
            };
}

static void plan_mip_1(const SluiceNeuralWriteInfo *info, SluiceNeuralSet *set, uint32_t mip)
{
    uint32_t own = slc_mip_count(info->gridScale - 1); /* ceil(log2(gridScale)) */
    uint32_t n = slc_min_u32(set->info.latentImageCount - 1, mip > own ? (mip - own) / 2 : 0);
    set->mips[mip].first_grid = 2 * n;
    set->mips[mip].position_lod = ((float)mip - 2 * (float)n) / 3;
    set->mips[mip].position_scale = exp2f((float)mip - 2 * (float)n);
}

static void plan_mip_3(const SluiceNeuralWriteInfo *info, SluiceNeuralSet *set, uint32_t mip)
{
    static const uint32_t SHARED[MAX_GRID_SCALE] = {2, 3, 3, 3, 4, 4};
    struct slc_neural_mip *m = &set->mips[mip];
    uint32_t shared = SHARED[info->gridScale - 1];
    uint32_t n = mip + 2 > shared ? (mip + 2 - shared) & ~1u : 0;
    m->first_grid = slc_min_u32(n, set->info.latentImageCount - 2);
    const struct slc_neural_grid *grid = &set->grids[m->first_grid];
    double x = (double)grid->width / m->width, y = (double)grid->height / m->height;
    double scale = 0.5 * (x > y ? x : y), lod = 0.25 * log2(scale);
    m->position_scale = (float)scale;
    m->position_lod = (float)(lod < -1 ? -1 : lod > 1 ? 1 : lod);
}

static void plan_mips(const SluiceNeuralWriteInfo *info, SluiceNeuralSet *set)
{
    for (uint32_t i = 0; i < set->info.mipCount; i++) {
        set->mips[i].width = slc_mip_size(info->width, i);
        set->mips[i].height = slc_mip_size(info->height, i);
        (info->schema == 1 ? plan_mip_1 : plan_mip_3)(info, set, i);
    }
}

SluiceResult slc_neural_plan(const SluiceNeuralWriteInfo *info, struct SluiceNeuralSet *set)
{
    bool is_one = info->schema == 1;
    memset(set, 0, sizeof *set);
    SluiceResult result = check_numbers(info);
    if (result == SLUICE_SUCCESS)
        result = check_shape(info);
    if (result == SLUICE_SUCCESS)
        result = plan_textures(info, set);
    if (result != SLUICE_SUCCESS)
        return result;
    set->shape = slc_neural_shape_of(info->network);
    set->info.schema = info->schema;
    set->info.width = info->width;
    set->info.height = info->height;
    set->info.mipCount =
        info->mipCount ? info->mipCount : slc_mip_count(slc_max_u32(info->width, info->height));
    set->info.channelCount = (info->channelCount + 1) & ~1u; /* even, as in all writers */
    set->info.textureCount = info->textureCount;
    set->info.network = info->network;
    set->info.inputCount = set->shape.inputs[0];
    set->info.highFeatures = info->highFeatures;
    set->info.lowFeatures = is_one ? info->lowFeatures : info->highFeatures;
    set->info.highBits = is_one ? info->highBits : 4;
    set->info.lowBits = is_one ? info->lowBits : 4;
    set->info.gridScale = info->gridScale;
    set->info.latentImageCount = default_image_count(info);
    plan_grids(info, set);
    plan_mips(info, set);
    return SLUICE_SUCCESS;
}

SluiceResult sluicePlanNeuralFile(const SluiceNeuralWriteInfo *pInfo,
                                  SluiceNeuralConstants *pConstants, uint64_t *pLatentSize)
{
    if (!pInfo || !pConstants || !pLatentSize)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralWriteInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralWriteInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    struct SluiceNeuralSet set;
    result = slc_neural_plan(&info, &set);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_neural_request request = {.mip_count = set.info.mipCount,
                                         .size = {info.width, info.height}};
    SluiceNeuralConstants constants;
    slc_neural_fill_constants(&set, &request, &constants);
    uint64_t size = slc_neural_whole_slices(&set, constants.slices);
    if (size > SLC_NEURAL_MAX_LATENTS)
        return slc_log_refusal(&info.log, "latents have %llu bytes; at most 2^29 are possible",
                               (unsigned long long)size);
    *pConstants = constants;
    *pLatentSize = size;
    return SLUICE_SUCCESS;
}
