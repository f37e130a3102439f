#include "image/format_size.h"
#include "base/struct_size.h"

struct format {
    const char *name;
    SluiceFormatInfo info;
};

#define TEXELS(name, size, channels)                                                               \
    [SLUICE_FORMAT_##name] = {#name, {sizeof(SluiceFormatInfo), size, 1, 1, channels, false}}
#define INTEGERS(name, size, channels)                                                             \
    [SLUICE_FORMAT_##name] = {#name, {sizeof(SluiceFormatInfo), size, 1, 1, channels, true}}
#define BLOCKS_OF(name, extent, size, channels)                                                    \
    [SLUICE_FORMAT_##name##_BLOCK] = {                                                             \
        #name "_BLOCK", {sizeof(SluiceFormatInfo), size, extent, extent, channels, false}}
#define BLOCKS(name, size, channels) BLOCKS_OF(name, 4, size, channels)

static const struct format formats[SLUICE_FORMAT_COUNT] = {
    [SLUICE_FORMAT_UNDEFINED] = {"UNDEFINED", {0}},
    TEXELS(R8_UNORM, 1, 1),
    TEXELS(R8G8_UNORM, 2, 2),
    TEXELS(R8G8B8A8_UNORM, 4, 4),
    TEXELS(R8G8B8A8_SRGB, 4, 4),
    TEXELS(R16_SFLOAT, 2, 1),
    TEXELS(R16G16_SFLOAT, 4, 2),
    TEXELS(R16G16B16A16_SFLOAT, 8, 4),
    TEXELS(R32_SFLOAT, 4, 1),
    TEXELS(R32G32_SFLOAT, 8, 2),
    TEXELS(R32G32B32A32_SFLOAT, 16, 4),
    TEXELS(A2B10G10R10_UNORM_PACK32, 4, 4),
    TEXELS(B10G11R11_UFLOAT_PACK32, 4, 3),
    TEXELS(E5B9G9R9_UFLOAT_PACK32, 4, 3),
    BLOCKS(BC1_RGB_UNORM, 8, 3),
    BLOCKS(BC1_RGB_SRGB, 8, 3),
    BLOCKS(BC1_RGBA_UNORM, 8, 4),
    BLOCKS(BC1_RGBA_SRGB, 8, 4),
    BLOCKS(BC2_UNORM, 16, 4),
    BLOCKS(BC2_SRGB, 16, 4),
    BLOCKS(BC3_UNORM, 16, 4),
    BLOCKS(BC3_SRGB, 16, 4),
    BLOCKS(BC4_UNORM, 8, 1),
    BLOCKS(BC4_SNORM, 8, 1),
    BLOCKS(BC5_UNORM, 16, 2),
    BLOCKS(BC5_SNORM, 16, 2),
    BLOCKS(BC6H_UFLOAT, 16, 3),
    BLOCKS(BC6H_SFLOAT, 16, 3),
    BLOCKS(BC7_UNORM, 16, 4),
    BLOCKS(BC7_SRGB, 16, 4),
    TEXELS(R16_UNORM, 2, 1),
    TEXELS(R16G16_UNORM, 4, 2),
    TEXELS(R16G16B16A16_UNORM, 8, 4),
    BLOCKS(ETC2_R8G8B8_UNORM, 8, 3),
    BLOCKS(ETC2_R8G8B8_SRGB, 8, 3),
    BLOCKS(ETC2_R8G8B8A1_UNORM, 8, 4),
    BLOCKS(ETC2_R8G8B8A1_SRGB, 8, 4),
    BLOCKS(ETC2_R8G8B8A8_UNORM, 16, 4),
    BLOCKS(ETC2_R8G8B8A8_SRGB, 16, 4),
    BLOCKS(EAC_R11_UNORM, 8, 1),
    BLOCKS(EAC_R11_SNORM, 8, 1),
    BLOCKS(EAC_R11G11_UNORM, 16, 2),
    BLOCKS(EAC_R11G11_SNORM, 16, 2),
    BLOCKS_OF(ASTC_4x4_UNORM, 4, 16, 4),
    BLOCKS_OF(ASTC_4x4_SRGB, 4, 16, 4),
    BLOCKS_OF(ASTC_8x8_UNORM, 8, 16, 4),
    BLOCKS_OF(ASTC_8x8_SRGB, 8, 16, 4),
    TEXELS(R8_SNORM, 1, 1),
    TEXELS(R8G8_SNORM, 2, 2),
    TEXELS(R8G8B8A8_SNORM, 4, 4),
    TEXELS(R16_SNORM, 2, 1),
    TEXELS(R16G16_SNORM, 4, 2),
    TEXELS(R16G16B16A16_SNORM, 8, 4),
    INTEGERS(R8_UINT, 1, 1),
    INTEGERS(R8G8_UINT, 2, 2),
    INTEGERS(R8G8B8A8_UINT, 4, 4),
    INTEGERS(R16_UINT, 2, 1),
    INTEGERS(R16G16_UINT, 4, 2),
    INTEGERS(R16G16B16A16_UINT, 8, 4),
    INTEGERS(R32_UINT, 4, 1),
    INTEGERS(R32G32_UINT, 8, 2),
    INTEGERS(R32G32B32A32_UINT, 16, 4),
    INTEGERS(R8_SINT, 1, 1),
    INTEGERS(R8G8_SINT, 2, 2),
    INTEGERS(R8G8B8A8_SINT, 4, 4),
    INTEGERS(R16_SINT, 2, 1),
    INTEGERS(R16G16_SINT, 4, 2),
    INTEGERS(R16G16B16A16_SINT, 8, 4),
    INTEGERS(R32_SINT, 4, 1),
    INTEGERS(R32G32_SINT, 8, 2),
    INTEGERS(R32G32B32A32_SINT, 16, 4),
};

/* Pairs of formats that differ only in the transfer function: linear, sRGB. */
static const SluiceFormat twins[][2] = {
    {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_R8G8B8A8_SRGB},
    {SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK},
    {SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK, SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK},
    {SLUICE_FORMAT_BC2_UNORM_BLOCK, SLUICE_FORMAT_BC2_SRGB_BLOCK},
    {SLUICE_FORMAT_BC3_UNORM_BLOCK, SLUICE_FORMAT_BC3_SRGB_BLOCK},
    {SLUICE_FORMAT_BC7_UNORM_BLOCK, SLUICE_FORMAT_BC7_SRGB_BLOCK},
    {SLUICE_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, SLUICE_FORMAT_ETC2_R8G8B8_SRGB_BLOCK},
    {SLUICE_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK, SLUICE_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK},
    {SLUICE_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK, SLUICE_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK},
    {SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK, SLUICE_FORMAT_ASTC_4x4_SRGB_BLOCK},
    {SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK, SLUICE_FORMAT_ASTC_8x8_SRGB_BLOCK},
};

bool slc_format_has_srgb_twin(SluiceFormat format)
{
    for (size_t i = 0; i < sizeof twins / sizeof twins[0]; i++)
        if (twins[i][0] == format || twins[i][1] == format)
            return true;
    return false;
}

SluiceFormat slc_format_twin(SluiceFormat format, bool srgb)
{
    for (size_t i = 0; i < sizeof twins / sizeof twins[0]; i++)
        if (twins[i][0] == format || twins[i][1] == format)
            return twins[i][srgb];
    return format;
}

bool slc_format_is_srgb(SluiceFormat format)
{
    return slc_format_has_srgb_twin(format) && slc_format_twin(format, true) == format;
}

/* Finds a format. UNDEFINED for unknown values. */
static const struct format *find(SluiceFormat format)
{
    return &formats[(uint32_t)format < SLUICE_FORMAT_COUNT ? format : SLUICE_FORMAT_UNDEFINED];
}

uint32_t slc_format_word_size(SluiceFormat format)
{
    const SluiceFormatInfo *info = &find(format)->info;
    if (slc_format_is_compressed(info) || info->blockSize == 0)
        return 1;
    return slc_format_is_packed(format) ? info->blockSize : info->blockSize / info->channelCount;
}

SluiceResult sluiceGetFormatInfo(SluiceFormat format, SluiceFormatInfo *pInfo)
{
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    if (find(format)->info.blockSize == 0)
        return SLUICE_ERROR_UNSUPPORTED;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceFormatInfo), pInfo, NULL);
    if (result == SLUICE_SUCCESS)
        slc_struct_write(SLC_STRUCT(SluiceFormatInfo), pInfo, &find(format)->info);
    return result;
}

uint32_t sluiceGetFormatTexelSize(SluiceFormat format)
{
    const SluiceFormatInfo *info = &find(format)->info;
    return info->blockSize && !slc_format_is_compressed(info) ? info->blockSize : 0;
}

uint64_t sluiceGetFormatRegionSize(SluiceFormat format, uint32_t width, uint32_t height)
{
    const SluiceFormatInfo *info = &find(format)->info;
    if (info->blockSize == 0)
        return 0;
    uint64_t row = slc_format_row_size(info, width), rows = slc_format_row_count(info, height);
    return row && rows > UINT64_MAX / row ? UINT64_MAX : row * rows;
}

const char *sluiceGetFormatName(SluiceFormat format)
{
    return find(format)->name;
}

SluiceResult sluiceGetStandardTileShape(SluiceFormat format, uint32_t *pWidth, uint32_t *pHeight)
{
    if (!pWidth || !pHeight)
        return SLUICE_ERROR_NULL_POINTER;
    const SluiceFormatInfo *info = &find(format)->info;
    uint32_t width = 0, height = 0; /* blocks */
    switch (info->blockSize) {
    case 1: width = 256, height = 256; break;
    case 2: width = 256, height = 128; break;
    case 4: width = 128, height = 128; break;
    case 8: width = 128, height = 64; break;
    case 16: width = 64, height = 64; break;
    default: return SLUICE_ERROR_UNSUPPORTED;
    }
    *pWidth = width * info->blockWidth;
    *pHeight = height * info->blockHeight;
    return SLUICE_SUCCESS;
}
