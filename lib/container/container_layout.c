#include "container/container_layout.h"

#include "base/checked.h"
#include "image/format_size.h"

SluiceResult slc_layout_check(const struct slc_container_layout *layout,
                              const struct slc_input_file *file)
{
    if (layout->width == 0 || layout->height == 0 || layout->layer_count == 0)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA, "is %u x %u texels, %u layers",
                              layout->width, layout->height, layout->layer_count);
    if (layout->width > SLC_CONTAINER_MAX_SIZE || layout->height > SLC_CONTAINER_MAX_SIZE ||
        layout->layer_count > SLC_CONTAINER_MAX_LAYERS)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "is %u x %u texels, %u layers; at most %u and %u", layout->width,
                              layout->height, layout->layer_count, SLC_CONTAINER_MAX_SIZE,
                              SLC_CONTAINER_MAX_LAYERS);
    if (layout->cube && layout->width != layout->height)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                              "is a cube map of %u x %u texels; faces are square", layout->width,
                              layout->height);
    uint32_t full = slc_mip_count(slc_max_u32(layout->width, layout->height));
    if (layout->level_count > full)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                              "has %u levels, but %u x %u texels have %u", layout->level_count,
                              layout->width, layout->height, full);
    return SLUICE_SUCCESS;
}

uint64_t slc_layout_image_size(const struct slc_container_layout *layout, uint32_t level)
{
    return sluiceGetFormatRegionSize(layout->format, slc_mip_size(layout->width, level),
                                     slc_mip_size(layout->height, level));
}

/* Returns the representative of all formats with the same bytes, for example UNORM for SRGB. */
static SluiceFormat bytes_of(SluiceFormat format)
{
    SluiceFormat linear = slc_format_twin(format, false);
    return linear == SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK ? SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK
                                                       : linear;
}

SluiceResult slc_layout_rename(struct slc_container_layout *layout,
                               const struct slc_input_file *file, SluiceFormat format)
{
    if (format != SLUICE_FORMAT_UNDEFINED && bytes_of(format) != bytes_of(layout->format))
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "holds %s and cannot be read as %s; nothing is converted",
                              sluiceGetFormatName(layout->format), sluiceGetFormatName(format));
    if (format != SLUICE_FORMAT_UNDEFINED)
        layout->format = format;
    return SLUICE_SUCCESS;
}
