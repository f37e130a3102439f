#include <sluice/ktx2.h>

#include "base/struct_size.h"
#include "container/container_source.h"

#include <string.h>

/* Offsets in the file: the identifier, the header, the index of data other than levels, then 24
 * bytes for each level. */
enum {
    AT_FORMAT = 12,
    AT_WIDTH = 20,
    AT_HEIGHT = 24,
    AT_DEPTH = 28,
    AT_LAYER_COUNT = 32,
    AT_FACE_COUNT = 36,
    AT_LEVEL_COUNT = 40,
    AT_SUPERCOMPRESSION = 44,
    HEADER_END = 80,
    LEVEL_SIZE = 24
};

enum { FIRST_ASTC = 157, LAST_ASTC = 184 }; /* VkFormat */
enum { SCHEME_NONE = 0, SCHEME_BASIS_LZ = 1, SCHEME_ZSTD = 2, FACE_COUNT = 6 };

static const uint8_t identifier[12] = {0xAB, 'K',  'T',  'X',  ' ',  '2',
                                       '0',  0xBB, '\r', '\n', 0x1A, '\n'};

/* Returns the format of a VkFormat number. Two formats need swapped channels. */
static SluiceFormat vulkan_format(uint32_t number, unsigned *changes)
{
    switch (number) {
    case 9: return SLUICE_FORMAT_R8_UNORM;
    case 10: return SLUICE_FORMAT_R8_SNORM;
    case 13: return SLUICE_FORMAT_R8_UINT;
    case 14: return SLUICE_FORMAT_R8_SINT;
    case 16: return SLUICE_FORMAT_R8G8_UNORM;
    case 17: return SLUICE_FORMAT_R8G8_SNORM;
    case 20: return SLUICE_FORMAT_R8G8_UINT;
    case 21: return SLUICE_FORMAT_R8G8_SINT;
    case 37: return SLUICE_FORMAT_R8G8B8A8_UNORM;
    case 38: return SLUICE_FORMAT_R8G8B8A8_SNORM;
    case 41: return SLUICE_FORMAT_R8G8B8A8_UINT;
    case 42: return SLUICE_FORMAT_R8G8B8A8_SINT;
    case 43: return SLUICE_FORMAT_R8G8B8A8_SRGB;
    case 44: *changes = SLC_SWAP_RED_BLUE; return SLUICE_FORMAT_R8G8B8A8_UNORM;
    case 50: *changes = SLC_SWAP_RED_BLUE; return SLUICE_FORMAT_R8G8B8A8_SRGB;
    case 64: return SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32;
    case 70: return SLUICE_FORMAT_R16_UNORM;
    case 71: return SLUICE_FORMAT_R16_SNORM;
    case 74: return SLUICE_FORMAT_R16_UINT;
    case 75: return SLUICE_FORMAT_R16_SINT;
    case 76: return SLUICE_FORMAT_R16_SFLOAT;
    case 77: return SLUICE_FORMAT_R16G16_UNORM;
    case 78: return SLUICE_FORMAT_R16G16_SNORM;
    case 81: return SLUICE_FORMAT_R16G16_UINT;
    case 82: return SLUICE_FORMAT_R16G16_SINT;
    case 83: return SLUICE_FORMAT_R16G16_SFLOAT;
    case 91: return SLUICE_FORMAT_R16G16B16A16_UNORM;
    case 92: return SLUICE_FORMAT_R16G16B16A16_SNORM;
    case 95: return SLUICE_FORMAT_R16G16B16A16_UINT;
    case 96: return SLUICE_FORMAT_R16G16B16A16_SINT;
    case 97: return SLUICE_FORMAT_R16G16B16A16_SFLOAT;
    case 98: return SLUICE_FORMAT_R32_UINT;
    case 99: return SLUICE_FORMAT_R32_SINT;
    case 100: return SLUICE_FORMAT_R32_SFLOAT;
    case 101: return SLUICE_FORMAT_R32G32_UINT;
    case 102: return SLUICE_FORMAT_R32G32_SINT;
    case 103: return SLUICE_FORMAT_R32G32_SFLOAT;
    case 107: return SLUICE_FORMAT_R32G32B32A32_UINT;
    case 108: return SLUICE_FORMAT_R32G32B32A32_SINT;
    case 109: return SLUICE_FORMAT_R32G32B32A32_SFLOAT;
    case 122: return SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32;
    case 123: return SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32;
    case 131: return SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK;
    case 132: return SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK;
    case 133: return SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK;
    case 134: return SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK;
    case 135: return SLUICE_FORMAT_BC2_UNORM_BLOCK;
    case 136: return SLUICE_FORMAT_BC2_SRGB_BLOCK;
    case 137: return SLUICE_FORMAT_BC3_UNORM_BLOCK;
    case 138: return SLUICE_FORMAT_BC3_SRGB_BLOCK;
    case 139: return SLUICE_FORMAT_BC4_UNORM_BLOCK;
    case 140: return SLUICE_FORMAT_BC4_SNORM_BLOCK;
    case 141: return SLUICE_FORMAT_BC5_UNORM_BLOCK;
    case 142: return SLUICE_FORMAT_BC5_SNORM_BLOCK;
    case 143: return SLUICE_FORMAT_BC6H_UFLOAT_BLOCK;
    case 144: return SLUICE_FORMAT_BC6H_SFLOAT_BLOCK;
    case 145: return SLUICE_FORMAT_BC7_UNORM_BLOCK;
    case 146: return SLUICE_FORMAT_BC7_SRGB_BLOCK;
    case 147: return SLUICE_FORMAT_ETC2_R8G8B8_UNORM_BLOCK;
    case 148: return SLUICE_FORMAT_ETC2_R8G8B8_SRGB_BLOCK;
    case 149: return SLUICE_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK;
    case 150: return SLUICE_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK;
    case 151: return SLUICE_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK;
    case 152: return SLUICE_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK;
    case 153: return SLUICE_FORMAT_EAC_R11_UNORM_BLOCK;
    case 154: return SLUICE_FORMAT_EAC_R11_SNORM_BLOCK;
    case 155: return SLUICE_FORMAT_EAC_R11G11_UNORM_BLOCK;
    case 156: return SLUICE_FORMAT_EAC_R11G11_SNORM_BLOCK;
    case 157: return SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK;
    case 158: return SLUICE_FORMAT_ASTC_4x4_SRGB_BLOCK;
    case 171: return SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK;
    case 172: return SLUICE_FORMAT_ASTC_8x8_SRGB_BLOCK;
    default: return SLUICE_FORMAT_UNDEFINED;
    }
}

static SluiceResult read_format(const struct slc_input_file *file, const uint8_t *header,
                                struct slc_container_layout *layout)
{
    uint32_t format = slc_u32_at(header + AT_FORMAT);
    uint32_t scheme = slc_u32_at(header + AT_SUPERCOMPRESSION);
    if (scheme == SCHEME_BASIS_LZ || format == 0)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "holds Basis Universal texels, which nothing here decodes; "
                              "transcode it: ktx transcode --target bc7");
    if (scheme != SCHEME_NONE && scheme != SCHEME_ZSTD)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "has the supercompression scheme %u, which is not read; write it "
                              "without, or with Zstandard",
                              scheme);
    layout->levels_are_compressed = scheme == SCHEME_ZSTD;
    layout->format = vulkan_format(format, &layout->changes);
    if (layout->format == SLUICE_FORMAT_UNDEFINED && format >= FIRST_ASTC && format <= LAST_ASTC)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "holds ASTC blocks of another size than 4x4 and 8x8 (VkFormat %u), "
                              "whose tiles have no power of two; write it with one of these",
                              format);
    if (layout->format == SLUICE_FORMAT_UNDEFINED)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "has the VkFormat %u, which is not read; write it as BC1 to BC7 or "
                              "RGBA",
                              format);
    return SLUICE_SUCCESS;
}

static SluiceResult read_shape(const struct slc_input_file *file, const uint8_t *header,
                               struct slc_container_layout *layout)
{
    uint32_t layers = slc_u32_at(header + AT_LAYER_COUNT);
    uint32_t faces = slc_u32_at(header + AT_FACE_COUNT);
    layout->width = slc_u32_at(header + AT_WIDTH);
    layout->height = slc_u32_at(header + AT_HEIGHT);
    layout->level_count = slc_u32_at(header + AT_LEVEL_COUNT);
    if (layout->level_count == 0)
        layout->level_count = 1; /* 0 means: the reader generates the other levels */
    if (layers == 0)
        layers = 1; /* not an array */
    if (slc_u32_at(header + AT_DEPTH) != 0 || (layout->width != 0 && layout->height == 0))
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "is a volume or a 1D texture; 2D textures, arrays and cube maps are "
                              "read");
    if (faces != 1 && faces != FACE_COUNT)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA, "has %u faces", faces);
    layout->cube = faces == FACE_COUNT;
    layout->layer_count = layers > UINT32_MAX / faces ? UINT32_MAX : layers * faces;
    return slc_layout_check(layout, file);
}

/* Finds offset and size of a level from its index entry. A level holds all its layers. */
static SluiceResult place_level(const struct slc_input_file *file, const uint8_t *entry,
                                uint32_t index, struct slc_container_layout *layout)
{
    struct slc_level_layout *level = &layout->levels[index];
    uint64_t size = slc_u64_at(entry + 16), first = HEADER_END + LEVEL_SIZE * layout->level_count;
    level->offset = slc_u64_at(entry);
    level->stored_size = slc_u64_at(entry + 8);
    level->layer_stride = slc_layout_image_size(layout, index);
    level->size = level->layer_stride * layout->layer_count;
    if (size != level->size || (!layout->levels_are_compressed && level->stored_size != size))
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                              "level %u has %llu bytes, stored as %llu; its texels need %llu",
                              index, (unsigned long long)size,
                              (unsigned long long)level->stored_size,
                              (unsigned long long)level->size);
    if (level->offset >= first && level->stored_size <= file->size &&
        level->offset <= file->size - level->stored_size && level->stored_size > 0)
        return SLUICE_SUCCESS;
    return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                          "level %u, %llu bytes at %llu, lies outside of the file's %llu bytes",
                          index, (unsigned long long)level->stored_size,
                          (unsigned long long)level->offset, (unsigned long long)file->size);
}

static SluiceResult read_header(const struct slc_input_file *file,
                                struct slc_container_layout *layout)
{
    uint8_t header[HEADER_END], levels[SLC_MAX_MIP_LEVELS * LEVEL_SIZE];
    SluiceResult result = slc_input_file_read(file, 0, header, HEADER_END);
    if (result != SLUICE_SUCCESS)
        return result;
    if (memcmp(header, identifier, sizeof identifier) != 0)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA, "is not a KTX2 file");
    result = read_format(file, header, layout);
    if (result == SLUICE_SUCCESS)
        result = read_shape(file, header, layout);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_read(file, HEADER_END, levels, LEVEL_SIZE * layout->level_count);
    for (uint32_t i = 0; i < layout->level_count && result == SLUICE_SUCCESS; i++)
        result = place_level(file, levels + LEVEL_SIZE * i, i, layout);
    return result;
}

SluiceResult sluiceCreateKtx2ImageSource(const SluiceKtx2ImageSourceCreateInfo *pInfo,
                                         SluiceImageSource **pSource)
{
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceKtx2ImageSourceCreateInfo given = {.structSize = sizeof given};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceKtx2ImageSourceCreateInfo), &given, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_container_create_info info = {
        .choice = {given.pPath, given.pInput, given.filePool},
        .format = given.format,
        .allocator = given.pAllocator,
        .log = &given.log,
        .max_cache_size = given.maxCacheSize ? given.maxCacheSize : (uint64_t)1 << 29,
        .read_header = read_header,
    };
    return slc_container_source_create(&info, pSource);
}
