#include "container/dds_format.h"

enum { DDPF_ALPHAPIXELS = 0x1, DDPF_FOURCC = 0x4, DDPF_RGB = 0x40, DDPF_LUMINANCE = 0x20000 };

struct four_cc {
    char text[5];
    SluiceFormat format;
};

static const struct four_cc four_ccs[] = {
    {"DXT1", SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK}, {"DXT2", SLUICE_FORMAT_BC2_UNORM_BLOCK},
    {"DXT3", SLUICE_FORMAT_BC2_UNORM_BLOCK},      {"DXT4", SLUICE_FORMAT_BC3_UNORM_BLOCK},
    {"DXT5", SLUICE_FORMAT_BC3_UNORM_BLOCK},      {"ATI1", SLUICE_FORMAT_BC4_UNORM_BLOCK},
    {"BC4U", SLUICE_FORMAT_BC4_UNORM_BLOCK},      {"BC4S", SLUICE_FORMAT_BC4_SNORM_BLOCK},
    {"ATI2", SLUICE_FORMAT_BC5_UNORM_BLOCK},      {"BC5U", SLUICE_FORMAT_BC5_UNORM_BLOCK},
    {"BC5S", SLUICE_FORMAT_BC5_SNORM_BLOCK},
};

/* Returns the format of a D3DFORMAT number, which some files store instead of a FourCC. */
static SluiceFormat d3d_format(uint32_t number)
{
    switch (number) {
    case 36: return SLUICE_FORMAT_R16G16B16A16_UNORM;
    case 110: return SLUICE_FORMAT_R16G16B16A16_SNORM;
    case 111: return SLUICE_FORMAT_R16_SFLOAT;
    case 112: return SLUICE_FORMAT_R16G16_SFLOAT;
    case 113: return SLUICE_FORMAT_R16G16B16A16_SFLOAT;
    case 114: return SLUICE_FORMAT_R32_SFLOAT;
    case 115: return SLUICE_FORMAT_R32G32_SFLOAT;
    case 116: return SLUICE_FORMAT_R32G32B32A32_SFLOAT;
    default: return SLUICE_FORMAT_UNDEFINED;
    }
}

static SluiceFormat named_format(uint32_t four_cc)
{
    for (size_t i = 0; i < sizeof four_ccs / sizeof four_ccs[0]; i++)
        if (slc_u32_at((const uint8_t *)four_ccs[i].text) == four_cc)
            return four_ccs[i].format;
    return d3d_format(four_cc);
}

struct masks {
    uint32_t kind; ///< DDPF_RGB or DDPF_LUMINANCE
    uint32_t bit_count;
    uint32_t masks[4];
    SluiceFormat format;
    unsigned changes;
};

static const struct masks known_masks[] = {
    {DDPF_RGB, 32, {0xFF, 0xFF00, 0xFF0000, 0xFF000000}, SLUICE_FORMAT_R8G8B8A8_UNORM, 0},
    {DDPF_RGB,
     32,
     {0xFF0000, 0xFF00, 0xFF, 0xFF000000},
     SLUICE_FORMAT_R8G8B8A8_UNORM,
     SLC_SWAP_RED_BLUE},
    {DDPF_RGB, 32, {0xFF, 0xFF00, 0xFF0000, 0}, SLUICE_FORMAT_R8G8B8A8_UNORM, SLC_MAKE_OPAQUE},
    {DDPF_RGB,
     32,
     {0xFF0000, 0xFF00, 0xFF, 0},
     SLUICE_FORMAT_R8G8B8A8_UNORM,
     SLC_SWAP_RED_BLUE | SLC_MAKE_OPAQUE},
    {DDPF_RGB, 16, {0xFF, 0xFF00, 0, 0}, SLUICE_FORMAT_R8G8_UNORM, 0},
    {DDPF_RGB, 8, {0xFF, 0, 0, 0}, SLUICE_FORMAT_R8_UNORM, 0},
    {DDPF_LUMINANCE, 16, {0xFF, 0, 0, 0xFF00}, SLUICE_FORMAT_R8G8_UNORM, 0},
    {DDPF_LUMINANCE, 8, {0xFF, 0, 0, 0}, SLUICE_FORMAT_R8_UNORM, 0},
};

SluiceFormat slc_dds_format(const struct slc_dds_pixel_format *given, unsigned *changes)
{
    *changes = 0;
    if (given->flags & DDPF_FOURCC)
        return named_format(given->four_cc);
    uint32_t alpha = given->flags & DDPF_ALPHAPIXELS ? given->masks[3] : 0;
    for (size_t i = 0; i < sizeof known_masks / sizeof known_masks[0]; i++) {
        const struct masks *known = &known_masks[i];
        if (!(given->flags & known->kind) || given->bit_count != known->bit_count ||
            given->masks[0] != known->masks[0] || alpha != known->masks[3])
            continue;
        /* Gray has one mask; some writers repeat it for G and B. */
        if (known->kind == DDPF_RGB &&
            (given->masks[1] != known->masks[1] || given->masks[2] != known->masks[2]))
            continue;
        *changes = known->changes;
        return known->format;
    }
    return SLUICE_FORMAT_UNDEFINED;
}

SluiceFormat slc_dxgi_format(uint32_t number, unsigned *changes)
{
    *changes = 0;
    switch (number) {
    case 2: return SLUICE_FORMAT_R32G32B32A32_SFLOAT;
    case 3: return SLUICE_FORMAT_R32G32B32A32_UINT;
    case 4: return SLUICE_FORMAT_R32G32B32A32_SINT;
    case 10: return SLUICE_FORMAT_R16G16B16A16_SFLOAT;
    case 11: return SLUICE_FORMAT_R16G16B16A16_UNORM;
    case 12: return SLUICE_FORMAT_R16G16B16A16_UINT;
    case 13: return SLUICE_FORMAT_R16G16B16A16_SNORM;
    case 14: return SLUICE_FORMAT_R16G16B16A16_SINT;
    case 16: return SLUICE_FORMAT_R32G32_SFLOAT;
    case 17: return SLUICE_FORMAT_R32G32_UINT;
    case 18: return SLUICE_FORMAT_R32G32_SINT;
    case 24: return SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32;
    case 26: return SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32;
    case 28: return SLUICE_FORMAT_R8G8B8A8_UNORM;
    case 29: return SLUICE_FORMAT_R8G8B8A8_SRGB;
    case 30: return SLUICE_FORMAT_R8G8B8A8_UINT;
    case 31: return SLUICE_FORMAT_R8G8B8A8_SNORM;
    case 32: return SLUICE_FORMAT_R8G8B8A8_SINT;
    case 34: return SLUICE_FORMAT_R16G16_SFLOAT;
    case 35: return SLUICE_FORMAT_R16G16_UNORM;
    case 36: return SLUICE_FORMAT_R16G16_UINT;
    case 37: return SLUICE_FORMAT_R16G16_SNORM;
    case 38: return SLUICE_FORMAT_R16G16_SINT;
    case 41: return SLUICE_FORMAT_R32_SFLOAT;
    case 42: return SLUICE_FORMAT_R32_UINT;
    case 43: return SLUICE_FORMAT_R32_SINT;
    case 49: return SLUICE_FORMAT_R8G8_UNORM;
    case 50: return SLUICE_FORMAT_R8G8_UINT;
    case 51: return SLUICE_FORMAT_R8G8_SNORM;
    case 52: return SLUICE_FORMAT_R8G8_SINT;
    case 54: return SLUICE_FORMAT_R16_SFLOAT;
    case 56: return SLUICE_FORMAT_R16_UNORM;
    case 57: return SLUICE_FORMAT_R16_UINT;
    case 58: return SLUICE_FORMAT_R16_SNORM;
    case 59: return SLUICE_FORMAT_R16_SINT;
    case 61: return SLUICE_FORMAT_R8_UNORM;
    case 62: return SLUICE_FORMAT_R8_UINT;
    case 63: return SLUICE_FORMAT_R8_SNORM;
    case 64: return SLUICE_FORMAT_R8_SINT;
    case 67: return SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32;
    case 71: return SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK;
    case 72: return SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK;
    case 74: return SLUICE_FORMAT_BC2_UNORM_BLOCK;
    case 75: return SLUICE_FORMAT_BC2_SRGB_BLOCK;
    case 77: return SLUICE_FORMAT_BC3_UNORM_BLOCK;
    case 78: return SLUICE_FORMAT_BC3_SRGB_BLOCK;
    case 80: return SLUICE_FORMAT_BC4_UNORM_BLOCK;
    case 81: return SLUICE_FORMAT_BC4_SNORM_BLOCK;
    case 83: return SLUICE_FORMAT_BC5_UNORM_BLOCK;
    case 84: return SLUICE_FORMAT_BC5_SNORM_BLOCK;
    case 87: *changes = SLC_SWAP_RED_BLUE; return SLUICE_FORMAT_R8G8B8A8_UNORM;
    case 88: *changes = SLC_SWAP_RED_BLUE | SLC_MAKE_OPAQUE; return SLUICE_FORMAT_R8G8B8A8_UNORM;
    case 91: *changes = SLC_SWAP_RED_BLUE; return SLUICE_FORMAT_R8G8B8A8_SRGB;
    case 93: *changes = SLC_SWAP_RED_BLUE | SLC_MAKE_OPAQUE; return SLUICE_FORMAT_R8G8B8A8_SRGB;
    case 95: return SLUICE_FORMAT_BC6H_UFLOAT_BLOCK;
    case 96: return SLUICE_FORMAT_BC6H_SFLOAT_BLOCK;
    case 98: return SLUICE_FORMAT_BC7_UNORM_BLOCK;
    case 99: return SLUICE_FORMAT_BC7_SRGB_BLOCK;
    default: return SLUICE_FORMAT_UNDEFINED;
    }
}
