#include "neural/view_reader.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/little_endian.h"
#include "neural/gdeflate.h"

#include <string.h>
#include <zlib.h>

/* Limit for a compressed tile. Stored blocks make a tile only a few bytes larger. */
#define MAX_STORED_TILE (2 * SLC_GDEFLATE_TILE)

static SluiceResult corrupt(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                            const char *what)
{
    return slc_input_fail_at(&set->file, SLUICE_ERROR_CORRUPT_DATA, view->offset, what);
}

/* Finds a tile in the file. Entry 0 of the table, the last tile's size, is wrong in some files and
 * therefore ignored: the last tile ends with the view. */
static SluiceResult find_tile(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                              uint32_t count, uint32_t tile, uint64_t *offset, uint64_t *size)
{
    uint8_t entries[8] = {0};
    uint64_t begin = 0, table = SLC_GDEFLATE_HEADER + 4 * (uint64_t)count;
    if (table > view->stored_size)
        return corrupt(set, view, "compressed latents are shorter than their table");
    uint64_t end = view->stored_size - table;
    bool is_first = tile == 0, is_last = tile + 1 == count;
    if (!is_first || !is_last) {
        /* entries of this tile and the next, if present */
        uint32_t from = is_first ? 1 : tile, to = is_last ? tile : tile + 1;
        SluiceResult result =
            slc_input_file_read(&set->file, view->offset + SLC_GDEFLATE_HEADER + 4 * (uint64_t)from,
                                entries, 4 * (size_t)(to - from + 1));
        if (result != SLUICE_SUCCESS)
            return result;
        begin = is_first ? 0 : slc_get_u32(entries);
        end = is_last ? end : slc_get_u32(entries + (is_first ? 0 : 4));
    }
    if (begin > end || end > view->stored_size - table || end - begin > MAX_STORED_TILE)
        return corrupt(set, view, "compressed latents have a table that contradicts itself");
    *offset = view->offset + table + begin;
    *size = end - begin;
    return SLUICE_SUCCESS;
}

static SluiceResult inflate_tile(struct slc_neural_view_reader *r, uint32_t tile)
{
    uint64_t offset = 0, stored = 0;
    uint64_t left = r->view->size - (uint64_t)tile * SLC_GDEFLATE_TILE;
    r->number = UINT32_MAX;
    SluiceResult result = find_tile(r->set, r->view, r->tile_count, tile, &offset, &stored);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_read(&r->set->file, offset, r->stored, (size_t)stored);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_gdeflate_inflate(r->stored, (size_t)stored, r->tile,
                              (size_t)slc_min_u64(left, SLC_GDEFLATE_TILE)))
        return corrupt(r->set, r->view, "compressed latents do not inflate");
    r->number = tile;
    return SLUICE_SUCCESS;
}

static SluiceResult read_header(struct slc_neural_view_reader *r)
{
    uint8_t head[SLC_GDEFLATE_HEADER];
    struct slc_gdeflate_header header;
    if (r->view->stored_size < sizeof head)
        return corrupt(r->set, r->view, "compressed latents are shorter than their header");
    SluiceResult result = slc_input_file_read(&r->set->file, r->view->offset, head, sizeof head);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_gdeflate_read_header(head, &header) || header.size != r->view->size)
        return corrupt(r->set, r->view,
                       "compressed latents have a header that contradicts their view");
    r->tile_count = header.tile_count;
    return SLUICE_SUCCESS;
}

SluiceResult slc_neural_open_view(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                                  struct slc_neural_view_reader *reader)
{
    *reader = (struct slc_neural_view_reader){.set = set, .view = view, .number = UINT32_MAX};
    if (!view->is_compressed)
        return SLUICE_SUCCESS;
    reader->stored = slc_alloc(&set->allocator, MAX_STORED_TILE + SLC_GDEFLATE_TILE, 1);
    if (!reader->stored)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    reader->tile = reader->stored + MAX_STORED_TILE;
    return read_header(reader);
}

void slc_neural_close_view(struct slc_neural_view_reader *reader)
{
    if (reader->stored)
        slc_free(&reader->set->allocator, reader->stored, MAX_STORED_TILE + SLC_GDEFLATE_TILE, 1);
    reader->stored = reader->tile = NULL;
}

SluiceResult slc_neural_read_view_part(struct slc_neural_view_reader *reader, uint64_t offset,
                                       size_t size, void *bytes)
{
    SluiceResult result = SLUICE_SUCCESS;
    if (!reader->stored)
        return slc_input_file_read(&reader->set->file, reader->view->offset + offset, bytes, size);
    for (uint8_t *to = bytes; size && result == SLUICE_SUCCESS;) {
        uint32_t tile = (uint32_t)(offset / SLC_GDEFLATE_TILE);
        size_t at = (size_t)(offset % SLC_GDEFLATE_TILE);
        size_t part = SLC_GDEFLATE_TILE - at < size ? SLC_GDEFLATE_TILE - at : size;
        if (tile != reader->number)
            result = inflate_tile(reader, tile);
        if (result == SLUICE_SUCCESS)
            memcpy(to, reader->tile + at, part);
        to += part;
        offset += part;
        size -= part;
    }
    return result;
}

static SluiceResult compare(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                            uint32_t crc)
{
    if (view->crc == 0 || view->crc == crc)
        return SLUICE_SUCCESS;
    return corrupt(set, view, "checksum mismatch");
}

SluiceResult slc_neural_read_view(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                                  void *bytes)
{
    struct slc_neural_view_reader reader;
    SluiceResult result = slc_neural_open_view(set, view, &reader);
    if (result == SLUICE_SUCCESS)
        result = slc_neural_read_view_part(&reader, 0, (size_t)view->size, bytes);
    slc_neural_close_view(&reader);
    if (result == SLUICE_SUCCESS && view->crc)
        result = compare(set, view, (uint32_t)crc32_z(0, bytes, (size_t)view->size));
    return result;
}

static SluiceResult sum_view(struct slc_neural_view_reader *reader, uint8_t *bytes, uLong *crc)
{
    SluiceResult result = SLUICE_SUCCESS;
    const uint64_t end = reader->view->size;
    for (uint64_t at = 0; at < end && result == SLUICE_SUCCESS; at += SLC_GDEFLATE_TILE) {
        size_t size = (size_t)slc_min_u64(end - at, SLC_GDEFLATE_TILE);
        result = slc_neural_read_view_part(reader, at, size, bytes);
        if (result == SLUICE_SUCCESS)
            *crc = crc32_z(*crc, bytes, size);
    }
    return result;
}

SluiceResult slc_neural_verify_view(const SluiceNeuralSet *set, const struct slc_neural_view *view)
{
    struct slc_neural_view_reader reader;
    uLong crc = 0;
    if (view->crc == 0)
        return SLUICE_SUCCESS;
    uint8_t *bytes = slc_alloc(&set->allocator, SLC_GDEFLATE_TILE, 1);
    if (!bytes)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = slc_neural_open_view(set, view, &reader);
    if (result == SLUICE_SUCCESS)
        result = sum_view(&reader, bytes, &crc);
    slc_neural_close_view(&reader);
    slc_free(&set->allocator, bytes, SLC_GDEFLATE_TILE, 1);
    return result == SLUICE_SUCCESS ? compare(set, view, (uint32_t)crc) : result;
}
