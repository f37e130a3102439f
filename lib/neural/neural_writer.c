#include "base/alloc.h"
#include "base/little_endian.h"
#include "base/log.h"
#include "base/part_file.h"
#include "base/struct_size.h"
#include "neural/file_text.h"
#include "neural/network.h"
#include "neural/file_plan.h"
#include "neural/slices.h"

#include <string.h>

enum { HEADER_SIZE = 40 };

static uint64_t view_size(const struct slc_neural_grid *grid)
{
    return slc_neural_slice_bytes(grid->width, grid->height,
                                  grid->features * grid->bits / grid->part_count);
}

/* Latents of all grids as views, each padded to 4 bytes. */
struct latent_views {
    uint8_t *bytes; ///< owned
    uint64_t size;
};

static void put_code(uint8_t *bytes, uint64_t bit, uint32_t code)
{
    bytes[bit / 8] |= (uint8_t)(code << bit % 8);
}

/* Reader of single codes, from bytes or from packed latents. */
struct code_reader {
    const uint8_t *codes;  ///< NULL: `packed`
    const uint8_t *packed; ///< packed latents of the grid
    uint32_t bits;
    bool is_out_of_range;
};

static uint32_t read_code(struct code_reader *reader, uint64_t index)
{
    if (!reader->codes) {
        uint64_t bit = index * reader->bits;
        return (uint32_t)reader->packed[bit / 8] >> bit % 8 & ((1u << reader->bits) - 1);
    }
    reader->is_out_of_range |= reader->codes[index] >> reader->bits != 0;
    return reader->codes[index] & ((1u << reader->bits) - 1);
}

/* Writes the parts of a grid one behind the other. */
static void pack_grid(const struct slc_neural_grid *grid, struct code_reader *reader,
                      uint8_t *bytes)
{
    uint64_t texels = (uint64_t)grid->width * grid->height, part_size = view_size(grid);
    uint32_t features = grid->features / grid->part_count;
    reader->bits = grid->bits;
    for (uint64_t t = 0; t < texels; t++)
        for (uint32_t f = 0; f < grid->features; f++) {
            uint8_t *part = bytes + f / features * part_size;
            put_code(part, (t * features + f % features) * grid->bits,
                     read_code(reader, t * grid->features + f));
        }
}

static SluiceResult pack_latents(const SluiceNeuralWriteInfo *info, const SluiceNeuralSet *set,
                                 struct latent_views *views)
{
    struct code_reader reader = {.codes = info->pCodes, .packed = info->pLatents};
    uint8_t *bytes = views->bytes;
    for (uint32_t i = 0; i < set->grid_count; i++) {
        const struct slc_neural_grid *grid = &set->grids[i];
        uint64_t codes = (uint64_t)grid->width * grid->height * grid->features;
        pack_grid(grid, &reader, bytes);
        if (reader.is_out_of_range)
            return slc_log_refusal(&info->log, "a code of grid %u is 2^%u or more", i, grid->bits);
        bytes += view_size(grid) * grid->part_count;
        if (reader.codes)
            reader.codes += codes;
        else
            reader.packed +=
                slc_neural_slice_bytes(grid->width, grid->height, grid->features * grid->bits);
    }
    return SLUICE_SUCCESS;
}

static void add_piece(struct slc_neural_pieces *pieces, const uint8_t *bytes, uint64_t size,
                      bool has_checksum)
{
    pieces->pieces[pieces->count++] = (struct slc_neural_piece){bytes, size, has_checksum};
}

static void add_network(struct slc_neural_pieces *pieces, const SluiceNeuralSet *set,
                        SluiceNeuralWeightKind kind, const uint8_t *blob)
{
    struct slc_neural_blob at = slc_neural_blob_of(&set->shape, kind);
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        uint32_t outputs = set->shape.outputs[i];
        bool is_half = kind == SLUICE_NEURAL_WEIGHTS_FP8 && i + 1 < SLUICE_NEURAL_LAYERS;
        add_piece(pieces, blob + at.weights[i], (uint64_t)outputs * set->shape.inputs[i], false);
        if (!is_half)
            add_piece(pieces, blob + at.scales[i], 4 * (uint64_t)outputs, false);
        add_piece(pieces, blob + at.biases[i], (is_half ? 2 : 4) * (uint64_t)outputs, false);
    }
    pieces->has[kind] = true;
}

/* Adds the latents. Schema 1 has no checksums. */
static void add_latents(struct slc_neural_pieces *pieces, const SluiceNeuralSet *set,
                        const uint8_t *bytes)
{
    pieces->first_latent = pieces->count;
    for (uint32_t i = 0; i < set->grid_count; i++) {
        uint64_t stored = view_size(&set->grids[i]);
        uint64_t size = set->info.schema == 1
                            ? stored
                            : 2 * (uint64_t)set->grids[i].width * set->grids[i].height;
        for (uint32_t p = 0; p < set->grids[i].part_count; p++, bytes += stored)
            add_piece(pieces, bytes, size, set->info.schema == 3);
    }
}

/* Destination of the file. */
struct sink {
    const SluiceNeuralWriteInfo *info;
    struct slc_part_file part;
};

static SluiceResult put(const struct sink *sink, const void *bytes, size_t size)
{
    if (size == 0)
        return SLUICE_SUCCESS;
    if (sink->info->pfnWrite)
        return sink->info->pfnWrite(sink->info->pUserData, bytes, size);
    return slc_part_file_append(&sink->part, bytes, size);
}

static SluiceResult put_padded(const struct sink *sink, const void *bytes, uint64_t size)
{
    static const uint8_t ZEROS[4];
    SluiceResult result = put(sink, bytes, (size_t)size);
    return result == SLUICE_SUCCESS ? put(sink, ZEROS, (size_t)(-size & 3)) : result;
}

static SluiceResult put_file(const struct sink *sink, const struct slc_neural_text *text,
                             const struct slc_neural_pieces *pieces)
{
    uint8_t header[HEADER_SIZE] = "NTEX";
    uint64_t data_size = 0;
    for (uint32_t i = 0; i < pieces->count; i++)
        data_size += (pieces->pieces[i].size + 3) / 4 * 4;
    slc_put_u32(header + 4, 0x100);
    slc_put_u64(header + 8, HEADER_SIZE);
    slc_put_u64(header + 16, text->size);
    slc_put_u64(header + 24, (HEADER_SIZE + text->size + 3) / 4 * 4);
    slc_put_u64(header + 32, data_size);
    SluiceResult result = put(sink, header, HEADER_SIZE);
    if (result == SLUICE_SUCCESS)
        result = put_padded(sink, text->text, text->size);
    for (uint32_t i = 0; i < pieces->count && result == SLUICE_SUCCESS; i++)
        result = put_padded(sink, pieces->pieces[i].bytes, pieces->pieces[i].size);
    return result;
}

static SluiceResult write_pieces(const SluiceNeuralWriteInfo *info,
                                 const struct slc_neural_text *text,
                                 const struct slc_neural_pieces *pieces,
                                 const SluiceAllocationCallbacks *cb)
{
    struct sink sink = {.info = info};
    if (info->pfnWrite)
        return put_file(&sink, text, pieces);
    SluiceResult result =
        slc_part_file_open(&sink.part, info->pPath, SLC_PART_FILE_STREAM, cb, &info->log);
    if (result == SLUICE_SUCCESS)
        result = put_file(&sink, text, pieces);
    SluiceResult finished = slc_part_file_finish(&sink.part, result == SLUICE_SUCCESS);
    return result == SLUICE_SUCCESS ? finished : result;
}

static SluiceResult check_weights(const SluiceNeuralWriteInfo *info, const SluiceNeuralSet *set)
{
    const void *blobs[] = {info->pInt8Weights, info->pFp8Weights};
    if (!blobs[0] && !blobs[1])
        return SLUICE_ERROR_NULL_POINTER;
    for (int kind = 0; kind < 2; kind++)
        if (blobs[kind] &&
            !slc_neural_blob_is_sound(&set->shape, (SluiceNeuralWeightKind)kind, blobs[kind]))
            return slc_log_refusal(&info->log,
                                   "a scale, bias or weight of the %s network is no "
                                   "number or beyond 2^63",
                                   kind ? "FP8" : "INT8");
    return SLUICE_SUCCESS;
}

/* Writes the description. Long texture names may exceed readers' limit for the text. */
static SluiceResult describe(const SluiceNeuralWriteInfo *info, const SluiceNeuralSet *set,
                             const struct slc_neural_pieces *pieces, struct slc_neural_text *text)
{
    slc_neural_describe(text, set, pieces);
    if (text->failed)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (text->size <= SLC_NEURAL_MAX_TEXT_SIZE)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&info->log,
                           "the description has %zu bytes, most of them names of textures; at "
                           "most %u are read",
                           text->size, SLC_NEURAL_MAX_TEXT_SIZE);
}

static SluiceResult write_set(const SluiceNeuralWriteInfo *info, const SluiceNeuralSet *set,
                              const SluiceAllocationCallbacks *cb)
{
    struct slc_neural_pieces pieces = {.count = 0};
    struct slc_neural_text text = {.allocator = *cb};
    struct latent_views views = {NULL, 0};
    for (uint32_t i = 0; i < set->grid_count; i++)
        views.size += view_size(&set->grids[i]) * set->grids[i].part_count;
    if (views.size > 2 * SLC_NEURAL_MAX_LATENTS)
        return slc_log_refusal(&info->log, "latents have %llu bytes; at most 2^30 are written",
                               (unsigned long long)views.size);
    views.bytes = slc_calloc(cb, (size_t)views.size, 1);
    if (!views.bytes)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = pack_latents(info, set, &views);
    if (result == SLUICE_SUCCESS) {
        if (info->pInt8Weights)
            add_network(&pieces, set, SLUICE_NEURAL_WEIGHTS_INT8, info->pInt8Weights);
        if (info->pFp8Weights)
            add_network(&pieces, set, SLUICE_NEURAL_WEIGHTS_FP8, info->pFp8Weights);
        add_latents(&pieces, set, views.bytes);
        result = describe(info, set, &pieces, &text);
    }
    if (result == SLUICE_SUCCESS)
        result = write_pieces(info, &text, &pieces, cb);
    slc_neural_text_finish(&text);
    slc_free(cb, views.bytes, (size_t)views.size, 1);
    return result;
}

SluiceResult sluiceWriteNeuralFile(const SluiceNeuralWriteInfo *pInfo)
{
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralWriteInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralWriteInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if ((!info.pPath && !info.pfnWrite) || (!info.pCodes && !info.pLatents) ||
        !slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    struct SluiceNeuralSet set;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    result = slc_neural_plan(&info, &set);
    if (result == SLUICE_SUCCESS)
        result = check_weights(&info, &set);
    return result == SLUICE_SUCCESS ? write_set(&info, &set, &cb) : result;
}
