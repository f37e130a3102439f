#include "image/info.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/format.h"

#include <string.h>

SluiceResult slc_image_info_init(const SluiceAllocationCallbacks *cb, const SluiceImageInfo *given,
                                 SluiceImageInfo *info)
{
    SluiceFormatInfo format;
    if (given->width == 0 || given->height == 0 ||
        sluiceGetFormatInfo(given->format, &format) != SLUICE_SUCCESS)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (slc_format_is_compressed(&format) || given->arrayLayerCount > 1)
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

void slc_image_info_finish(const SluiceAllocationCallbacks *cb, SluiceImageInfo *info)
{
    slc_free(cb, (char *)info->pName, strlen(info->pName) + 1, 1);
    info->pName = NULL;
}
