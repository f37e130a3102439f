#include "neural/neural_set.h"

#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"

SluiceResult sluiceGetNeuralSetInfo(const SluiceNeuralSet *set, SluiceNeuralSetInfo *pInfo)
{
    if (!set || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceNeuralSetInfo), pInfo, &set->file.log);
    if (result == SLUICE_SUCCESS)
        slc_struct_write(SLC_STRUCT(SluiceNeuralSetInfo), pInfo, &set->info);
    return result;
}

static SluiceResult refuse_index(const SluiceNeuralSet *set, const char *name, uint32_t index,
                                 uint32_t count)
{
    return slc_log_refusal(&set->file.log, "%s: %s is %u; the file has %u", set->file.path, name,
                           index, count);
}

SluiceResult sluiceGetNeuralTexture(const SluiceNeuralSet *set, uint32_t index,
                                    SluiceNeuralTexture *pTexture)
{
    if (!set || !pTexture)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceNeuralTexture), pTexture, &set->file.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (index >= set->info.textureCount)
        return refuse_index(set, "texture", index, set->info.textureCount);
    const struct slc_neural_document_texture *texture = &set->textures[index];
    SluiceNeuralTexture out = {
        .pName = texture->name,
        .firstChannel = texture->first_channel,
        .channelCount = texture->channel_count,
        .format = (SluiceNeuralChannelFormat)texture->format,
        .rgbColorSpace = (SluiceNeuralColorSpace)texture->rgb_color_space,
        .alphaColorSpace = (SluiceNeuralColorSpace)texture->alpha_color_space,
        .bcFormat = texture->bc_format,
    };
    slc_struct_write(SLC_STRUCT(SluiceNeuralTexture), pTexture, &out);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetNeuralChannel(const SluiceNeuralSet *set, uint32_t channel,
                                    SluiceNeuralColorSpace *pColorSpace)
{
    if (!set || !pColorSpace)
        return SLUICE_ERROR_NULL_POINTER;
    if (channel >= set->info.channelCount)
        return refuse_index(set, "channel", channel, set->info.channelCount);
    *pColorSpace = (SluiceNeuralColorSpace)set->color_spaces[channel];
    return SLUICE_SUCCESS;
}

/* Returns the number of mips that use grid `first_grid` and its partner. */
static uint32_t mips_with(const SluiceNeuralSet *set, uint32_t first_grid, uint32_t *first)
{
    uint32_t count = 0;
    *first = 0;
    for (uint32_t i = 0; i < set->info.mipCount; i++)
        if (set->mips[i].first_grid == first_grid && count++ == 0)
            *first = i;
    return count;
}

SluiceResult sluiceGetNeuralMip(const SluiceNeuralSet *set, uint32_t mip, SluiceNeuralMip *pMip)
{
    if (!set || !pMip)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceNeuralMip), pMip, &set->file.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (mip >= set->info.mipCount)
        return refuse_index(set, "mip", mip, set->info.mipCount);
    const struct slc_neural_mip *m = &set->mips[mip];
    SluiceNeuralMip out = {
        .width = m->width,
        .height = m->height,
        .latentImage = set->info.schema == 1 ? m->first_grid / 2 : m->first_grid,
        .latentImageCount = set->info.schema == 1 ? 1 : 2,
        .positionLod = m->position_lod,
        .positionScale = m->position_scale,
    };
    out.fusedMipCount = mips_with(set, m->first_grid, &out.firstFusedMip);
    slc_struct_write(SLC_STRUCT(SluiceNeuralMip), pMip, &out);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetNeuralLatentImage(const SluiceNeuralSet *set, uint32_t index,
                                        SluiceNeuralLatentImage *pImage)
{
    if (!set || !pImage)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceNeuralLatentImage), pImage, &set->file.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (index >= set->info.latentImageCount)
        return refuse_index(set, "latent image", index, set->info.latentImageCount);
    bool is_one = set->info.schema == 1;
    const struct slc_neural_grid *grid = &set->grids[is_one ? 2 * index : index];
    SluiceNeuralLatentImage out = {
        .width = grid->width,
        .height = grid->height,
        .lowWidth = is_one ? grid[1].width : 0,
        .lowHeight = is_one ? grid[1].height : 0,
        .partCount = is_one ? 2 : grid->part_count,
    };
    out.mipCount = mips_with(set, is_one ? 2 * index : index & ~1u, &out.firstMip);
    slc_struct_write(SLC_STRUCT(SluiceNeuralLatentImage), pImage, &out);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetNeuralLatentPart(const SluiceNeuralSet *set, uint32_t image, uint32_t part,
                                       SluiceNeuralLatentPart *pPart)
{
    if (!set || !pPart)
        return SLUICE_ERROR_NULL_POINTER;
    if (image >= set->info.latentImageCount)
        return refuse_index(set, "latent image", image, set->info.latentImageCount);
    bool is_one = set->info.schema == 1;
    uint32_t count = is_one ? 2 : set->grids[image].part_count;
    if (part >= count)
        return refuse_index(set, "part", part, count);
    const struct slc_neural_view *view =
        is_one ? &set->grids[2 * image + part].parts[0] : &set->grids[image].parts[part];
    *pPart = (SluiceNeuralLatentPart){.offset = view->offset,
                                      .storedSize = view->stored_size,
                                      .size = view->size,
                                      .isCompressed = view->is_compressed};
    return SLUICE_SUCCESS;
}

SluiceResult slc_neural_check_mips(const SluiceNeuralSet *set, uint32_t first, uint32_t count)
{
    uint32_t all = set->info.mipCount;
    if (count && first < all && count <= all - first)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&set->file.log, "%s: %u mips from %u on; the file has %u",
                           set->file.path, count, first, all);
}

static void widen(const struct slc_neural_grid *grid, uint64_t *begin, uint64_t *end)
{
    for (uint32_t p = 0; p < grid->part_count; p++) {
        const struct slc_neural_view *view = &grid->parts[p];
        *begin = slc_min_u64(*begin, view->offset);
        if (view->offset + view->stored_size > *end)
            *end = view->offset + view->stored_size;
    }
}

SluiceResult sluiceGetNeuralLatentRange(const SluiceNeuralSet *set, uint32_t firstMip,
                                        uint32_t mipCount, uint64_t *pOffset, uint64_t *pSize)
{
    if (!set || !pOffset || !pSize)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_neural_check_mips(set, firstMip, mipCount);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t begin = UINT64_MAX, end = 0;
    for (uint32_t i = firstMip; i < firstMip + mipCount; i++) {
        widen(&set->grids[set->mips[i].first_grid], &begin, &end);
        widen(&set->grids[set->mips[i].first_grid + 1], &begin, &end);
    }
    *pOffset = begin;
    *pSize = end - begin;
    return SLUICE_SUCCESS;
}
