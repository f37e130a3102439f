#include <sluice/dds.h>

#include "base/struct_size.h"
#include "container/dds_format.h"
#include "container/container_source.h"

#include <stdio.h>
#include <string.h>

/* Offsets in the file: the magic number, DDS_HEADER, DDS_HEADER_DXT10. */
enum {
    AT_HEADER_SIZE = 4,
    AT_FLAGS = 8,
    AT_HEIGHT = 12,
    AT_WIDTH = 16,
    AT_DEPTH = 24,
    AT_LEVEL_COUNT = 28,
    AT_FORMAT_SIZE = 76,
    AT_FORMAT = 80,
    AT_CAPS2 = 112,
    HEADER_END = 128,
    AT_DXGI_FORMAT = 128,
    AT_DIMENSION = 132,
    AT_MISC = 136,
    AT_ARRAY_SIZE = 140,
    DX10_END = 148
};

enum {
    DDSD_DEPTH = 0x800000,
    DDPF_FOURCC = 0x4,
    CAPS2_CUBE = 0x200,
    CAPS2_FACES = 0xFC00,
    CAPS2_VOLUME = 0x200000,
    DIMENSION_2D = 3,
    MISC_CUBE = 0x4,
    FACE_COUNT = 6
};

static struct slc_dds_pixel_format pixel_format_at(const uint8_t *bytes)
{
    struct slc_dds_pixel_format format = {
        slc_u32_at(bytes), slc_u32_at(bytes + 4), slc_u32_at(bytes + 8), {0}};
    for (uint32_t i = 0; i < 4; i++)
        format.masks[i] = slc_u32_at(bytes + 12 + 4 * i);
    return format;
}

static bool has_dx10(const uint8_t *header)
{
    return (slc_u32_at(header + AT_FORMAT) & DDPF_FOURCC) &&
           memcmp(header + AT_FORMAT + 4, "DX10", 4) == 0;
}

static SluiceResult refuse_format(const struct slc_input_file *file,
                                  const struct slc_dds_pixel_format *format)
{
    char name[5] = {0}, printable[5];
    for (uint32_t i = 0; i < 4; i++)
        name[i] = (char)(format->four_cc >> 8 * i);
    slc_printable(name, printable, sizeof printable);
    if (format->flags & DDPF_FOURCC)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "has the format %s (0x%08X), which is not read; write it as BC1 to "
                              "BC7 or RGBA",
                              printable, format->four_cc);
    return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                          "has texels of %u bits with the masks %X, %X, %X, %X, which are not "
                          "read; write it as BC1 to BC7 or RGBA",
                          format->bit_count, format->masks[0], format->masks[1], format->masks[2],
                          format->masks[3]);
}

/* Reads format and layers of a header without DX10. */
static SluiceResult read_legacy(const struct slc_input_file *file, const uint8_t *header,
                                struct slc_container_layout *layout)
{
    uint32_t caps2 = slc_u32_at(header + AT_CAPS2);
    struct slc_dds_pixel_format format = pixel_format_at(header + AT_FORMAT);
    layout->format = slc_dds_format(&format, &layout->changes);
    if (layout->format == SLUICE_FORMAT_UNDEFINED)
        return refuse_format(file, &format);
    bool has_depth =
        (slc_u32_at(header + AT_FLAGS) & DDSD_DEPTH) && slc_u32_at(header + AT_DEPTH) > 1;
    if ((caps2 & CAPS2_VOLUME) || has_depth)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "is a volume; 2D textures, arrays and cube maps are read");
    if ((caps2 & CAPS2_CUBE) && (caps2 & CAPS2_FACES) != CAPS2_FACES)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "is a cube map without all of its faces; write all six");
    layout->cube = caps2 & CAPS2_CUBE;
    layout->layer_count = layout->cube ? FACE_COUNT : 1;
    return SLUICE_SUCCESS;
}

static SluiceResult read_dx10(const struct slc_input_file *file, const uint8_t *header,
                              struct slc_container_layout *layout)
{
    uint32_t number = slc_u32_at(header + AT_DXGI_FORMAT);
    uint32_t dimension = slc_u32_at(header + AT_DIMENSION);
    uint32_t array_size = slc_u32_at(header + AT_ARRAY_SIZE);
    layout->cube = slc_u32_at(header + AT_MISC) & MISC_CUBE;
    uint32_t faces = layout->cube ? FACE_COUNT : 1;
    layout->format = slc_dxgi_format(number, &layout->changes);
    if (layout->format == SLUICE_FORMAT_UNDEFINED)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "has the DXGI format %u, which is not read; write it as BC1 to BC7 "
                              "or RGBA",
                              number);
    if (dimension != DIMENSION_2D)
        return slc_input_fail(file, SLUICE_ERROR_UNSUPPORTED,
                              "has the resource dimension %u; 2D textures, arrays and cube maps "
                              "are read",
                              dimension);
    layout->layer_count = array_size > UINT32_MAX / faces ? UINT32_MAX : array_size * faces;
    return SLUICE_SUCCESS;
}

/* Finds offsets. Layers follow each other, each with all its levels. */
static SluiceResult place_images(const struct slc_input_file *file, uint64_t start,
                                 struct slc_container_layout *layout)
{
    uint64_t chain = 0;
    for (uint32_t i = 0; i < layout->level_count; i++) {
        layout->levels[i].offset = start + chain;
        chain += slc_layout_image_size(layout, i);
    }
    for (uint32_t i = 0; i < layout->level_count; i++)
        layout->levels[i].layer_stride = chain;
    if (chain * layout->layer_count <= file->size - start)
        return SLUICE_SUCCESS;
    return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                          "has %llu bytes; %u x %u texels of %s, %u layers, need %llu",
                          (unsigned long long)file->size, layout->width, layout->height,
                          sluiceGetFormatName(layout->format), layout->layer_count,
                          (unsigned long long)(start + chain * layout->layer_count));
}

static SluiceResult check_magic(const struct slc_input_file *file, const uint8_t *header)
{
    if (memcmp(header, "DDS ", 4) != 0)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA, "is not a DDS file");
    if (slc_u32_at(header + AT_HEADER_SIZE) == 124 && slc_u32_at(header + AT_FORMAT_SIZE) == 32)
        return SLUICE_SUCCESS;
    return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                          "has a header of %u and a format of %u bytes, not 124 and 32",
                          slc_u32_at(header + AT_HEADER_SIZE), slc_u32_at(header + AT_FORMAT_SIZE));
}

static SluiceResult read_header(const struct slc_input_file *file,
                                struct slc_container_layout *layout)
{
    uint8_t header[DX10_END];
    SluiceResult result = slc_input_file_read(file, 0, header, HEADER_END);
    if (result == SLUICE_SUCCESS)
        result = check_magic(file, header);
    if (result != SLUICE_SUCCESS)
        return result;
    bool is_dx10 = has_dx10(header);
    if (is_dx10)
        result = slc_input_file_read(file, HEADER_END, header + HEADER_END, DX10_END - HEADER_END);
    if (result == SLUICE_SUCCESS)
        result = (is_dx10 ? read_dx10 : read_legacy)(file, header, layout);
    if (result != SLUICE_SUCCESS)
        return result;
    layout->width = slc_u32_at(header + AT_WIDTH);
    layout->height = slc_u32_at(header + AT_HEIGHT);
    layout->level_count = slc_u32_at(header + AT_LEVEL_COUNT);
    if (layout->level_count == 0)
        layout->level_count = 1; /* some writers store 0 for a file without chain */
    result = slc_layout_check(layout, file);
    return result == SLUICE_SUCCESS ? place_images(file, is_dx10 ? DX10_END : HEADER_END, layout)
                                    : result;
}

SluiceResult sluiceCreateDdsImageSource(const SluiceDdsImageSourceCreateInfo *pInfo,
                                        SluiceImageSource **pSource)
{
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDdsImageSourceCreateInfo given = {.structSize = sizeof given};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceDdsImageSourceCreateInfo), &given, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_container_create_info info = {
        .choice = {given.pPath, given.pInput, given.filePool},
        .format = given.format,
        .allocator = given.pAllocator,
        .log = &given.log,
        .read_header = read_header,
    };
    return slc_container_source_create(&info, pSource);
}
