#include <sluice/image.h>

uint32_t sluiceFormatTexelSize(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_UNDEFINED: return 0;
    case SLUICE_FORMAT_R8_UNORM: return 1;
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return 4;
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return 4;
    case SLUICE_FORMAT_R16_SFLOAT: return 2;
    case SLUICE_FORMAT_R16G16_SFLOAT: return 4;
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: return 8;
    case SLUICE_FORMAT_R32_SFLOAT: return 4;
    case SLUICE_FORMAT_R32G32_SFLOAT: return 8;
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: return 16;
    }
    return 0;
}

const char *sluiceFormatString(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_UNDEFINED: return "UNDEFINED";
    case SLUICE_FORMAT_R8_UNORM: return "R8_UNORM";
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return "R8G8B8A8_UNORM";
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return "R8G8B8A8_SRGB";
    case SLUICE_FORMAT_R16_SFLOAT: return "R16_SFLOAT";
    case SLUICE_FORMAT_R16G16_SFLOAT: return "R16G16_SFLOAT";
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: return "R16G16B16A16_SFLOAT";
    case SLUICE_FORMAT_R32_SFLOAT: return "R32_SFLOAT";
    case SLUICE_FORMAT_R32G32_SFLOAT: return "R32G32_SFLOAT";
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: return "R32G32B32A32_SFLOAT";
    }
    return "UNDEFINED";
}

SluiceResult sluiceGetStandardTileShape(SluiceFormat format, uint32_t *pWidth, uint32_t *pHeight)
{
    if (!pWidth || !pHeight)
        return SLUICE_ERROR_NULL_POINTER;
    switch (sluiceFormatTexelSize(format)) {
    case 1: *pWidth = 256, *pHeight = 256; return SLUICE_SUCCESS;
    case 2: *pWidth = 256, *pHeight = 128; return SLUICE_SUCCESS;
    case 4: *pWidth = 128, *pHeight = 128; return SLUICE_SUCCESS;
    case 8: *pWidth = 128, *pHeight = 64; return SLUICE_SUCCESS;
    case 16: *pWidth = 64, *pHeight = 64; return SLUICE_SUCCESS;
    }
    return SLUICE_ERROR_UNSUPPORTED;
}
