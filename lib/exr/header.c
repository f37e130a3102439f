#include "exr/exr_file.h"

#include "base/checked.h"

#include <string.h>

static SluiceResult read_size(struct slc_exr_file *file)
{
    exr_attr_box2i_t window;
    exr_result_t result = exr_get_data_window(file->context, 0, &window);
    if (result != EXR_ERR_SUCCESS)
        return slc_input_fail(&file->input, slc_exr_result(file, result), "has no data window");
    int64_t width = (int64_t)window.max.x - window.min.x + 1;
    int64_t height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 1 || height < 1)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA, "has an empty data window");
    if (width > SLC_EXR_MAX_SIZE || height > SLC_EXR_MAX_SIZE)
        return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                              "is %lld x %lld texels, at most %u in either direction are read",
                              (long long)width, (long long)height, SLC_EXR_MAX_SIZE);
    file->width = (uint32_t)width;
    file->height = (uint32_t)height;
    file->first_line = window.min.y;
    return SLUICE_SUCCESS;
}

static SluiceResult read_tiling(struct slc_exr_file *file)
{
    uint32_t width, height;
    exr_tile_level_mode_t mode;
    exr_tile_round_mode_t rounding;
    exr_result_t result =
        exr_get_tile_descriptor(file->context, 0, &width, &height, &mode, &rounding);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_tile_levels(file->context, 0, &file->level_count_x, &file->level_count_y);
    if (result != EXR_ERR_SUCCESS || width == 0 || height == 0 || file->level_count_x < 1 ||
        file->level_count_y < 1)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                              "has no valid tile description");
    file->layout = mode == EXR_TILE_ONE_LEVEL       ? SLC_EXR_ONE_LEVEL
                   : mode == EXR_TILE_MIPMAP_LEVELS ? SLC_EXR_MIPMAP
                                                    : SLC_EXR_RIPMAP;
    file->chunk_width = width;
    file->chunk_height = height;
    return SLUICE_SUCCESS;
}

static SluiceResult read_lines_per_chunk(struct slc_exr_file *file)
{
    int32_t lines = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(file->context, 0, &lines);
    if (result != EXR_ERR_SUCCESS || lines < 1)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA, "has no valid compression");
    file->layout = SLC_EXR_SCANLINES;
    file->level_count_x = file->level_count_y = 1;
    file->chunk_width = file->width;
    file->chunk_height = (uint32_t)lines;
    return SLUICE_SUCCESS;
}

static SluiceResult read_layout(struct slc_exr_file *file)
{
    exr_storage_t storage;
    exr_result_t result = exr_get_storage(file->context, 0, &storage);
    if (result != EXR_ERR_SUCCESS)
        return slc_input_fail(&file->input, slc_exr_result(file, result), "has no storage type");
    switch (storage) {
    case EXR_STORAGE_SCANLINE: return read_lines_per_chunk(file);
    case EXR_STORAGE_TILED: return read_tiling(file);
    case EXR_STORAGE_DEEP_SCANLINE:
    case EXR_STORAGE_DEEP_TILED:
        return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                              "has deep data%s, which is not read; flatten it to an ordinary image",
                              file->is_multipart ? " in its first part" : "");
    default:
        return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                              "has the unknown storage type %d", (int)storage);
    }
}

static SluiceResult check_compression(struct slc_exr_file *file)
{
    exr_result_t result = exr_get_compression(file->context, 0, &file->compression);
    if (result != EXR_ERR_SUCCESS)
        return slc_input_fail(&file->input, slc_exr_result(file, result),
                              "has no compression type");
    int major, minor, patch;
    const char *extra;
    exr_get_library_version(&major, &minor, &patch, &extra);
    bool is_dwa =
        file->compression == EXR_COMPRESSION_DWAA || file->compression == EXR_COMPRESSION_DWAB;
    if (is_dwa && (major < 3 || (major == 3 && minor < 2)))
        return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                              "is DWA compressed, which OpenEXRCore %d.%d.%d does not decode; use "
                              "3.2 or newer, or compress the file otherwise",
                              major, minor, patch);
    return SLUICE_SUCCESS;
}

/* Checks the memory of a chunk, and the ratio of image size to file size. */
static SluiceResult check_plausibility(struct slc_exr_file *file)
{
    uint64_t texels = (uint64_t)slc_min_u32(file->chunk_width, file->width) *
                      slc_min_u32(file->chunk_height, file->height);
    if (texels * file->texel_size > 1u << 30)
        return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                              "has tiles of %u x %u texels, which need more than 1 GiB each; use "
                              "smaller ones",
                              file->chunk_width, file->chunk_height);
    /* The strongest compression, DWA of a constant, stays well below 65536 : 1. */
    uint64_t image = (uint64_t)file->width * file->height * file->texel_size;
    if (image / 65536 > file->input.size)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                              "says it is %u x %u texels, which a file of %llu bytes cannot hold",
                              file->width, file->height, (unsigned long long)file->input.size);
    return SLUICE_SUCCESS;
}

static SluiceResult check_chunk_count(struct slc_exr_file *file)
{
    exr_result_t result = exr_get_chunk_count(file->context, 0, &file->chunk_count);
    if (result != EXR_ERR_SUCCESS || file->chunk_count < 1 ||
        (uint64_t)file->chunk_count > file->input.size / sizeof(uint64_t))
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                              "says it has %d chunks, which a file of %llu bytes cannot hold",
                              file->chunk_count, (unsigned long long)file->input.size);
    return SLUICE_SUCCESS;
}

SluiceResult slc_exr_level_size(const struct slc_exr_file *file, uint32_t level, uint32_t *width,
                                uint32_t *height)
{
    if (file->layout == SLC_EXR_SCANLINES) {
        *width = file->width;
        *height = file->height;
        return SLUICE_SUCCESS;
    }
    int32_t x = (int32_t)slc_min_u32(level, (uint32_t)file->level_count_x - 1);
    int32_t y = (int32_t)slc_min_u32(level, (uint32_t)file->level_count_y - 1);
    int32_t level_width = 0, level_height = 0;
    exr_result_t result = exr_get_level_sizes(file->context, 0, x, y, &level_width, &level_height);
    if (result != EXR_ERR_SUCCESS || level_width < 1 || level_height < 1)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA, "has no size for level %u",
                              level);
    *width = (uint32_t)level_width;
    *height = (uint32_t)level_height;
    return SLUICE_SUCCESS;
}

/* Checks that levels are no smaller than Vulkan's. Files that round up have one texel more. */
static SluiceResult check_levels(struct slc_exr_file *file)
{
    uint32_t level_count = 1;
    if (file->layout == SLC_EXR_MIPMAP || file->layout == SLC_EXR_RIPMAP)
        level_count = slc_mip_count(slc_max_u32(file->width, file->height));
    for (uint32_t level = 0; level < level_count; level++) {
        uint32_t width = 0, height = 0;
        SluiceResult result = slc_exr_level_size(file, level, &width, &height);
        if (result != SLUICE_SUCCESS)
            return result;
        if (width < slc_mip_size(file->width, level) || height < slc_mip_size(file->height, level))
            return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                                  "level %u is %u x %u texels, too few", level, width, height);
    }
    return SLUICE_SUCCESS;
}

/* Moves *offset behind one attribute of a header. *last: the header has ended. */
static SluiceResult skip_attribute(struct slc_exr_file *file, uint64_t *offset, bool *last)
{
    /* name and type, each with a zero at the end, and a size; names have at most 255 bytes */
    unsigned char bytes[256 + 256 + 4] = {0};
    uint64_t rest = *offset < file->input.size ? file->input.size - *offset : 0;
    size_t size = rest < sizeof bytes ? (size_t)rest : sizeof bytes;
    SluiceResult result = slc_input_file_read(&file->input, *offset, bytes, size);
    if (result != SLUICE_SUCCESS)
        return result;
    *last = size > 0 && bytes[0] == 0;
    if (*last) {
        *offset += 1;
        return SLUICE_SUCCESS;
    }
    const unsigned char *type = memchr(bytes, 0, size);
    const unsigned char *value =
        type ? memchr(type + 1, 0, size - (size_t)(type + 1 - bytes)) : NULL;
    if (!value || (size_t)(value + 5 - bytes) > size)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                              "has a broken attribute at %llu", (unsigned long long)*offset);
    uint32_t length =
        value[1] | (uint32_t)value[2] << 8 | (uint32_t)value[3] << 16 | (uint32_t)value[4] << 24;
    *offset += (uint64_t)(value + 5 - bytes) + length;
    return SLUICE_SUCCESS;
}

/*
 * Finds the chunk table of a rip map. OpenEXRCore up to 3.1 counts the chunks of rip maps wrongly
 * (docs/decisions/0010-what-openexrcore-is-trusted-with.md). The table follows the headers. A
 * header is a list of attributes up to an empty name. A multi-part file ends its list of headers
 * with an empty header.
 */
static SluiceResult find_chunk_table(struct slc_exr_file *file)
{
    uint64_t offset = 8; /* magic number, version and flags */
    bool last = false;
    while (!last) {
        SluiceResult result = skip_attribute(file, &offset, &last);
        if (result != SLUICE_SUCCESS)
            return result;
        if (!last || !file->is_multipart)
            continue;
        unsigned char next;
        result = slc_input_file_read(&file->input, offset, &next, 1);
        if (result != SLUICE_SUCCESS)
            return result;
        last = next == 0;
        offset += last;
    }
    file->chunk_table_offset = offset;
    return SLUICE_SUCCESS;
}

static SluiceResult read_multipart_flag(struct slc_exr_file *file)
{
    unsigned char bytes[8];
    SluiceResult result = slc_input_file_read(&file->input, 0, bytes, sizeof bytes);
    file->is_multipart = result == SLUICE_SUCCESS && (bytes[5] & 0x10);
    return result;
}

SluiceResult slc_exr_read_header(struct slc_exr_file *file)
{
    static SluiceResult (*const steps[])(struct slc_exr_file *) = {
        read_multipart_flag,    read_size,         read_layout,  slc_exr_read_channels,
        slc_exr_read_primaries, check_compression, check_levels, check_plausibility,
        check_chunk_count,
    };
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        SluiceResult result = steps[i](file);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return file->layout == SLC_EXR_RIPMAP ? find_chunk_table(file) : SLUICE_SUCCESS;
}
