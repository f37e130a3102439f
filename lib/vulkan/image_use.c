#include "vulkan/image_use.h"

#include "base/log.h"

void slc_image_use_apply(const struct slc_image_use *use, VkImageCreateInfo *create,
                         struct slc_image_formats *formats)
{
    if (!use->mutable_format)
        return;
    create->flags |= VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
    if (use->format_count == 0)
        return;
    formats->formats[0] = create->format; /* format of the library's own views */
    for (uint32_t i = 0; i < use->format_count; i++)
        formats->formats[i + 1] = use->formats[i];
    formats->list =
        (VkImageFormatListCreateInfo){.sType = VK_STRUCTURE_TYPE_IMAGE_FORMAT_LIST_CREATE_INFO,
                                      .viewFormatCount = use->format_count + 1,
                                      .pViewFormats = formats->formats};
    create->pNext = &formats->list;
}

SluiceResult slc_image_use_init(struct slc_image_use *use, const SluiceLogCallback *log,
                                const SluiceVulkanTextureCreateInfo *info)
{
    *use = (struct slc_image_use){.mutable_format = info->mutableFormat || info->viewFormatCount,
                                  .formats = info->pViewFormats,
                                  .format_count = info->viewFormatCount};
    if (info->viewFormatCount > SLC_MAX_VIEW_FORMATS)
        return slc_log_refusal(log, "viewFormatCount is %u; it must be at most %u",
                               info->viewFormatCount, SLC_MAX_VIEW_FORMATS);
    if (info->viewFormatCount && !info->pViewFormats)
        return SLUICE_ERROR_NULL_POINTER;
    for (uint32_t i = 0; i < info->viewFormatCount; i++)
        if (info->pViewFormats[i] == VK_FORMAT_UNDEFINED)
            return slc_log_refusal(log, "pViewFormats[%u] is VK_FORMAT_UNDEFINED", i);
    return SLUICE_SUCCESS;
}
