#include "exr/chunk.h"

#include "base/checked.h"

#include <string.h>

static uint64_t little_endian(const unsigned char *bytes, int count)
{
    uint64_t value = 0;
    while (count-- > 0)
        value = value << 8 | bytes[count];
    return value;
}

static uint32_t tiles_along(struct slc_exr_file *file, int32_t level_x, int32_t level_y, bool in_x)
{
    int32_t width = 0, height = 0;
    if (exr_get_level_sizes(file->context, 0, level_x, level_y, &width, &height) != EXR_ERR_SUCCESS)
        return 0;
    return in_x ? slc_div_up_u32((uint32_t)width, file->chunk_width)
                : slc_div_up_u32((uint32_t)height, file->chunk_height);
}

/* Returns the index of a chunk. Order: level in y, level in x, row, column. */
static uint64_t find_rip_index(struct slc_exr_file *file, const exr_chunk_info_t *info)
{
    uint64_t tiles_in_row = 0, index = 0;
    for (int32_t x = 0; x < file->level_count_x; x++)
        tiles_in_row += tiles_along(file, x, 0, true);
    for (int32_t y = 0; y < info->level_y; y++)
        index += tiles_in_row * tiles_along(file, 0, y, false);
    uint64_t rows = tiles_along(file, 0, info->level_y, false);
    for (int32_t x = 0; x < info->level_x; x++)
        index += tiles_along(file, x, 0, true) * rows;
    return index + (uint64_t)info->start_y * tiles_along(file, info->level_x, 0, true) +
           (uint64_t)info->start_x;
}

/* Reads the leader of a tile of a rip map. Other files use exr_read_tile_chunk_info, which has
 * wrong offsets for rip maps only. */
static SluiceResult read_rip_leader(struct slc_exr_file *file, exr_chunk_info_t *info)
{
    uint64_t index = find_rip_index(file, info);
    if (index >= (uint64_t)file->chunk_count)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                              "chunk %llu is beyond the last", (unsigned long long)index);
    unsigned char bytes[24];
    SluiceResult result =
        slc_input_file_read(&file->input, file->chunk_table_offset + 8 * index, bytes, 8);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t offset = little_endian(bytes, 8);
    size_t leader = file->is_multipart ? 24 : 20; /* part, tile, level and size */
    result = slc_input_file_read(&file->input, offset, bytes + 24 - leader, leader);
    if (result != SLUICE_SUCCESS)
        return result;
    bool matches = (!file->is_multipart || little_endian(bytes, 4) == 0) &&
                   little_endian(bytes + 4, 4) == (uint32_t)info->start_x &&
                   little_endian(bytes + 8, 4) == (uint32_t)info->start_y &&
                   little_endian(bytes + 12, 4) == info->level_x &&
                   little_endian(bytes + 16, 4) == info->level_y;
    if (!matches)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                              "the chunk at %llu is not tile %d, %d of level %u, %u",
                              (unsigned long long)offset, info->start_x, info->start_y,
                              info->level_x, info->level_y);
    info->idx = (int32_t)index;
    info->packed_size = little_endian(bytes + 20, 4);
    info->data_offset = offset + leader;
    return SLUICE_SUCCESS;
}

static SluiceResult find_rip_tile(struct slc_exr_file *file, struct slc_exr_chunk *chunk,
                                  int32_t level_x, int32_t level_y, uint32_t x, uint32_t y)
{
    chunk->info = (exr_chunk_info_t){
        .start_x = (int32_t)x,
        .start_y = (int32_t)y,
        .width = (int32_t)chunk->region.width,
        .height = (int32_t)chunk->region.height,
        .level_x = (uint8_t)level_x,
        .level_y = (uint8_t)level_y,
        .type = EXR_STORAGE_TILED,
        .compression = (uint8_t)file->compression,
        .unpacked_size = (uint64_t)chunk->region.width * chunk->region.height * file->texel_size,
    };
    return read_rip_leader(file, &chunk->info);
}

static SluiceResult find_with_library(struct slc_exr_file *file, struct slc_exr_chunk *chunk,
                                      int32_t level_x, int32_t level_y, uint32_t x, uint32_t y)
{
    exr_result_t result;
    if (file->layout == SLC_EXR_SCANLINES)
        result = exr_read_scanline_chunk_info(
            file->context, 0, file->first_line + (int32_t)chunk->region.y, &chunk->info);
    else
        result = exr_read_tile_chunk_info(file->context, 0, (int32_t)x, (int32_t)y, level_x,
                                          level_y, &chunk->info);
    if (result == EXR_ERR_SUCCESS)
        return SLUICE_SUCCESS;
    return slc_input_fail(&file->input, slc_exr_result(file, result),
                          "cannot find chunk %u, %u of level %d: %s", x, y, level_x,
                          exr_get_default_error_message(result));
}

/*
 * Checks the sizes of a chunk before OpenEXRCore allocates or reads. OpenEXRCore accepts smaller
 * sizes for uncompressed data and then unpacks uninitialized memory.
 */
static SluiceResult check_chunk(struct slc_exr_file *file, const struct slc_exr_chunk *chunk)
{
    const exr_chunk_info_t *info = &chunk->info;
    uint64_t unpacked = (uint64_t)chunk->region.width * chunk->region.height * file->texel_size;
    bool is_raw = file->compression == EXR_COMPRESSION_NONE;
    if ((uint32_t)info->width == chunk->region.width &&
        (uint32_t)info->height == chunk->region.height && info->unpacked_size == unpacked &&
        info->packed_size > 0 && info->packed_size <= unpacked &&
        (!is_raw || info->packed_size == unpacked) && info->data_offset <= file->input.size &&
        info->packed_size <= file->input.size - info->data_offset)
        return SLUICE_SUCCESS;
    return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                          "the chunk at %llu has %llu bytes for %u x %u texels of %u bytes",
                          (unsigned long long)info->data_offset,
                          (unsigned long long)info->packed_size, chunk->region.width,
                          chunk->region.height, file->texel_size);
}

SluiceResult slc_exr_chunk_find(struct slc_exr_file *file, uint32_t level, uint32_t x, uint32_t y,
                                struct slc_exr_chunk *chunk)
{
    memset(chunk, 0, sizeof *chunk);
    uint32_t width = 0, height = 0;
    SluiceResult result = slc_exr_level_size(file, level, &width, &height);
    if (result != SLUICE_SUCCESS)
        return result;
    chunk->region.mipLevel = level;
    chunk->region.x = x * file->chunk_width;
    chunk->region.y = y * file->chunk_height;
    chunk->region.width = slc_min_u32(file->chunk_width, width - chunk->region.x);
    chunk->region.height = slc_min_u32(file->chunk_height, height - chunk->region.y);
    int32_t level_x = (int32_t)slc_min_u32(level, (uint32_t)file->level_count_x - 1);
    int32_t level_y = (int32_t)slc_min_u32(level, (uint32_t)file->level_count_y - 1);
    if (file->layout == SLC_EXR_RIPMAP)
        result = find_rip_tile(file, chunk, level_x, level_y, x, y);
    else
        result = find_with_library(file, chunk, level_x, level_y, x, y);
    return result == SLUICE_SUCCESS ? check_chunk(file, chunk) : result;
}
