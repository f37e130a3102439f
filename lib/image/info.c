#include "image/info.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "image/format_size.h"

#include <string.h>

SluiceResult slc_image_info_init(const SluiceAllocationCallbacks *cb, const SluiceImageInfo *given,
                                 SluiceImageInfo *info)
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    if (given->width == 0 || given->height == 0 ||
        sluiceGetFormatInfo(given->format, &format) != SLUICE_SUCCESS)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (slc_format_is_compressed(&format) || given->arrayLayerCount > 1 || given->cube)
        return SLUICE_ERROR_UNSUPPORTED;
    uint32_t level_count = slc_mip_count(slc_max_u32(given->width, given->height));
    if (given->mipLevelCount != 0 && given->mipLevelCount != level_count)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    char *name = slc_strdup(cb, given->pName ? given->pName : "");
    if (!name)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *info = *given;
    info->mipLevelCount = level_count;
    info->pName = name;
    return SLUICE_SUCCESS;
}

static bool last_level_fits_into_tile(const SluiceImageInfo *info)
{
    uint32_t width = 0, height = 0;
    return sluiceGetStandardTileShape(info->format, &width, &height) == SLUICE_SUCCESS &&
           slc_mip_size(info->width, info->mipLevelCount - 1) <= width &&
           slc_mip_size(info->height, info->mipLevelCount - 1) <= height;
}

/* Levels of compressed formats cannot be built. */
static const char *tail_trouble(const SluiceImageInfo *info)
{
    if (last_level_fits_into_tile(info))
        return NULL;
    return sluiceGetFormatTexelSize(info->format) == 0
               ? "mipLevelCount ends before a level fits into a tile; write the file again with "
                 "all levels"
               : "mipLevelCount ends before a level fits into a tile; build the others with "
                 "sluiceCreateCompleteChainSource";
}

static const char *level_trouble(const SluiceImageInfo *info, enum slc_image_levels levels)
{
    uint32_t full = slc_mip_count(slc_max_u32(info->width, info->height));
    if (info->mipLevelCount == full)
        return NULL;
    if (info->mipLevelCount == 0 || info->mipLevelCount > full)
        return "mipLevelCount is 0 or beyond the full chain's";
    switch (levels) {
    case SLC_LEVELS_ALL: return "mipLevelCount is not the full chain's";
    case SLC_LEVELS_ALL_OR_ONE:
        return info->mipLevelCount == 1 ? NULL : "mipLevelCount is neither 1 nor the full chain's";
    case SLC_LEVELS_TO_TAIL: return tail_trouble(info);
    case SLC_LEVELS_ANY: break;
    }
    return NULL;
}

const char *slc_image_info_trouble(const SluiceImageInfo *info, enum slc_image_levels levels)
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    if (info->width == 0 || info->height == 0 || info->width > SLC_MAX_IMAGE_EXTENT ||
        info->height > SLC_MAX_IMAGE_EXTENT)
        return "width or height is 0 or beyond 2^20";
    if (sluiceGetFormatInfo(info->format, &format) != SLUICE_SUCCESS)
        return "format is unknown";
    if (info->arrayLayerCount > SLC_MAX_IMAGE_LAYERS)
        return "arrayLayerCount is beyond 2^16";
    if (info->cube && info->width != info->height)
        return "faces of cube maps are not square";
    if (info->cube && (info->arrayLayerCount == 0 || info->arrayLayerCount % SLC_CUBE_FACES))
        return "arrayLayerCount of cube maps is no multiple of 6";
    if ((uint32_t)info->addressModeU > SLUICE_IMAGE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE ||
        (uint32_t)info->addressModeV > SLUICE_IMAGE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE)
        return "addressModeU or addressModeV is unknown";
    return level_trouble(info, levels);
}

SluiceResult slc_image_info_check(const SluiceImageInfo *info, enum slc_image_levels levels,
                                  const SluiceLogCallback *log)
{
    const char *trouble = slc_image_info_trouble(info, levels);
    if (!trouble)
        return SLUICE_SUCCESS;
    return slc_log_refusal(
        log,
        "%s: the source's %s: width %u, height %u, mipLevelCount %u, format %s (%d), "
        "arrayLayerCount %u",
        info->pName && info->pName[0] ? info->pName : "image", trouble, info->width, info->height,
        info->mipLevelCount, sluiceGetFormatName(info->format), (int)info->format,
        info->arrayLayerCount);
}

void slc_image_info_finish(const SluiceAllocationCallbacks *cb, SluiceImageInfo *info)
{
    slc_free(cb, (char *)info->pName, strlen(info->pName) + 1, 1);
    info->pName = NULL;
}
