#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "neural/slices.h"
#include "neural/view_reader.h"

#include <string.h>

/* Fills in defaults and checks that the set has the requested texels. */
static SluiceResult check_request(const SluiceNeuralSet *set, const SluiceNeuralRequest *given,
                                  struct slc_neural_request *request)
{
    SluiceNeuralRequest r = given ? *given : (SluiceNeuralRequest){0};
    if (r.firstMip < set->info.mipCount && r.mipCount == 0)
        r.mipCount = set->info.mipCount - r.firstMip;
    SluiceResult result = slc_neural_check_mips(set, r.firstMip, r.mipCount);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_neural_mip *mip = &set->mips[r.firstMip];
    if (r.width == 0 && r.height == 0 && r.x == 0 && r.y == 0) {
        r.width = mip->width;
        r.height = mip->height;
    }
    if (r.width == 0 || r.height == 0 || r.x >= mip->width || r.width > mip->width - r.x ||
        r.y >= mip->height || r.height > mip->height - r.y)
        return slc_log_refusal(
            &set->file.log, "%s: rectangle is %u x %u at %u, %u; mip %u has %u x %u texels",
            set->file.path, r.width, r.height, r.x, r.y, r.firstMip, mip->width, mip->height);
    *request = (struct slc_neural_request){r.firstMip, r.mipCount, {r.x, r.y}, {r.width, r.height}};
    return SLUICE_SUCCESS;
}

/* Rows of one part of a grid. Only one row is in memory, for any number of rows in the file. */
struct rows {
    struct slc_neural_view_reader reader;
    uint8_t *bytes;
    size_t size;
};

/* Opens rows. `row_bits`: bits of the widest row. */
static SluiceResult open_rows(struct rows *rows, const SluiceNeuralSet *set,
                              const struct slc_neural_view *view, uint64_t row_bits)
{
    SluiceResult result = slc_neural_open_view(set, view, &rows->reader);
    rows->size = (size_t)(row_bits / 8 + 2);
    rows->bytes = result == SLUICE_SUCCESS ? slc_alloc(&set->allocator, rows->size, 1) : NULL;
    return result == SLUICE_SUCCESS && !rows->bytes ? SLUICE_ERROR_OUT_OF_HOST_MEMORY : result;
}

/* Reads bits from `bit` on to `rows->bytes`. The first is bit `bit` mod 8 of the first byte. */
static SluiceResult read_row(struct rows *rows, uint64_t bit, uint64_t count)
{
    uint64_t first = bit / 8, end = (bit + count + 7) / 8;
    return slc_neural_read_view_part(&rows->reader, first, (size_t)(end - first), rows->bytes);
}

static void close_rows(struct rows *rows)
{
    slc_free(&rows->reader.set->allocator, rows->bytes, rows->size, 1);
    slc_neural_close_view(&rows->reader);
}

/* Copies `count` bits, a multiple of 4, from `from` bits behind `in` to `to` bits behind `out`. */
static void copy_bits(uint8_t *out, uint64_t to, const uint8_t *in, uint32_t from, uint64_t count)
{
    if ((to | from | count) % 8 == 0) {
        memcpy(out + to / 8, in + from / 8, (size_t)(count / 8));
        return;
    }
    for (uint64_t i = 0; i < count; i += 4) {
        uint64_t source = from + i, target = to + i;
        uint8_t nibble = in[source / 8] >> source % 8 & 15;
        out[target / 8] =
            (uint8_t)((out[target / 8] & ~(15u << target % 8)) | (uint32_t)nibble << target % 8);
    }
}

/* Rectangle of a grid with contiguous rows and columns in the file. */
struct block {
    const struct slc_neural_grid *grid;
    uint32_t left, top, width, height; ///< rectangle in the grid
    uint32_t to_x, to_y;               ///< position in the slice
    uint32_t slice_width;
};

/* Copies a block of schema 1: codes have the same order in file and slice. */
static SluiceResult copy_block_1(const SluiceNeuralSet *set, const struct block *b, uint8_t *out)
{
    uint64_t bits = b->grid->features * b->grid->bits, pitch = b->grid->width * bits;
    uint64_t begin = b->top * pitch + b->left * bits;
    struct rows rows;
    SluiceResult result = open_rows(&rows, set, &b->grid->parts[0], b->width * bits);
    for (uint32_t y = 0; y < b->height && result == SLUICE_SUCCESS; y++) {
        uint64_t bit = begin + y * pitch;
        result = read_row(&rows, bit, b->width * bits);
        if (result == SLUICE_SUCCESS)
            copy_bits(out, ((uint64_t)(b->to_y + y) * b->slice_width + b->to_x) * bits, rows.bytes,
                      (uint32_t)(bit % 8), b->width * bits);
    }
    close_rows(&rows);
    return result;
}

/* Copies a layer of schema 3, with 4 codes per texel. Slices hold all codes of a texel together. */
static SluiceResult copy_layer(const SluiceNeuralSet *set, const struct block *b, uint32_t layer,
                               uint8_t *out)
{
    uint64_t pitch = 16 * (uint64_t)b->grid->width, begin = b->top * pitch + 16 * (uint64_t)b->left;
    uint32_t layers = b->grid->part_count;
    struct rows rows;
    SluiceResult result = open_rows(&rows, set, &b->grid->parts[layer], 16 * (uint64_t)b->width);
    for (uint32_t y = 0; y < b->height && result == SLUICE_SUCCESS; y++) {
        uint8_t *texel =
            out + 2 * (((size_t)(b->to_y + y) * b->slice_width + b->to_x) * layers + layer);
        result = read_row(&rows, begin + y * pitch, 16 * (uint64_t)b->width);
        for (uint32_t x = 0; x < b->width && result == SLUICE_SUCCESS; x++, texel += 2 * layers)
            memcpy(texel, rows.bytes + 2 * (size_t)x, 2);
    }
    close_rows(&rows);
    return result;
}

static SluiceResult copy_block_3(const SluiceNeuralSet *set, const struct block *b, uint8_t *out)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < b->grid->part_count && result == SLUICE_SUCCESS; i++)
        result = copy_layer(set, b, i, out);
    return result;
}

static bool has_compressed_part(const struct slc_neural_grid *grid)
{
    for (uint32_t i = 0; i < grid->part_count; i++)
        if (grid->parts[i].is_compressed)
            return true;
    return false;
}

/* Verifies checksums at a grid's first read, if compressed or read as a whole. */
static SluiceResult verify_grid(const SluiceNeuralSet *set, uint32_t index, bool is_whole)
{
    const struct slc_neural_grid *grid = &set->grids[index];
    SluiceResult result = SLUICE_SUCCESS;
    if (atomic_load(&set->verified[index]) || !(is_whole || has_compressed_part(grid)))
        return result;
    for (uint32_t i = 0; i < grid->part_count && result == SLUICE_SUCCESS; i++)
        result = slc_neural_verify_view(set, &grid->parts[i]);
    if (result == SLUICE_SUCCESS)
        atomic_store(&set->verified[index], true);
    return result;
}

/* Reads a slice. A slice that wraps consists of up to four blocks. */
static SluiceResult read_slice(const SluiceNeuralSet *set, uint32_t index,
                               const SluiceNeuralSlice *slice, uint8_t *out)
{
    const struct slc_neural_grid *grid = &set->grids[index];
    uint32_t width = slice->sliceSize & 0xFFFF, height = slice->sliceSize >> 16;
    bool is_whole = slice->sliceSize == slice->gridSize;
    SluiceResult result = verify_grid(set, index, is_whole);
    struct block b = {.grid = grid, .slice_width = width};
    for (b.to_y = 0; b.to_y < height && result == SLUICE_SUCCESS; b.to_y += b.height) {
        b.top = ((slice->origin >> 16) + b.to_y) % grid->height;
        b.height = slc_min_u32(height - b.to_y, grid->height - b.top);
        for (b.to_x = 0; b.to_x < width && result == SLUICE_SUCCESS; b.to_x += b.width) {
            b.left = ((slice->origin & 0xFFFF) + b.to_x) % grid->width;
            b.width = slc_min_u32(width - b.to_x, grid->width - b.left);
            result = (set->info.schema == 1 ? copy_block_1 : copy_block_3)(set, &b, out);
        }
    }
    return result;
}

static SluiceResult read_slices(const SluiceNeuralSet *set, const SluiceNeuralConstants *constants,
                                uint64_t size, uint8_t *bytes)
{
    SluiceResult result = SLUICE_SUCCESS;
    memset(bytes, 0, (size_t)size);
    for (uint32_t i = 0; i < set->grid_count && result == SLUICE_SUCCESS; i++)
        if (constants->slices[i].sliceSize)
            result =
                read_slice(set, i, &constants->slices[i], bytes + constants->slices[i].dataOffset);
    return result;
}

static SluiceResult check_size(const SluiceNeuralSet *set, uint64_t size)
{
    if (size <= SLC_NEURAL_MAX_LATENTS)
        return SLUICE_SUCCESS;
    return slc_input_fail(&set->file, SLUICE_ERROR_LIMIT_EXCEEDED,
                          "needs %llu bytes of latents for the texels asked for; at most 2^29 are "
                          "possible, ask for a smaller rectangle",
                          (unsigned long long)size);
}

SluiceResult sluiceReadNeuralLatents(const SluiceNeuralSet *set,
                                     const SluiceNeuralRequest *pRequest,
                                     SluiceNeuralConstants *pConstants, uint64_t *pSize,
                                     void *pBytes)
{
    struct slc_neural_request request;
    SluiceNeuralConstants constants;
    if (!set || !pConstants || !pSize)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = check_request(set, pRequest, &request);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_neural_fill_constants(set, &request, &constants);
    uint64_t size = slc_neural_make_slices(set, &request, constants.slices), room = *pSize;
    result = check_size(set, size);
    if (result != SLUICE_SUCCESS)
        return result;
    *pSize = size;
    if (pBytes && room < size)
        return SLUICE_ERROR_SIZE_MISMATCH;
    if (pBytes)
        result = read_slices(set, &constants, size, pBytes);
    if (result == SLUICE_SUCCESS)
        *pConstants = constants;
    return result;
}

SluiceResult sluiceBoundNeuralLatents(const SluiceNeuralSet *set,
                                      const SluiceNeuralRequest *pRequest, uint32_t alignment,
                                      uint64_t *pSize)
{
    struct slc_neural_request request;
    if (!set || !pRequest || !pSize)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralRequest at_origin = *pRequest;
    at_origin.x = at_origin.y = 0;
    SluiceResult result = check_request(set, &at_origin, &request);
    if (result != SLUICE_SUCCESS)
        return result;
    bool is_power = alignment && !(alignment & (alignment - 1));
    *pSize = slc_neural_bound_slices(set, &request, is_power ? alignment : 1);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReadNeuralLatentPart(const SluiceNeuralSet *set, uint32_t image, uint32_t part,
                                        uint64_t *pSize, void *pBytes)
{
    SluiceNeuralLatentPart found;
    if (!pSize)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = sluiceGetNeuralLatentPart(set, image, part, &found);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t room = *pSize;
    *pSize = found.size;
    if (!pBytes)
        return SLUICE_SUCCESS;
    if (room < found.size)
        return SLUICE_ERROR_SIZE_MISMATCH;
    bool is_one = set->info.schema == 1;
    return slc_neural_read_view(
        set, is_one ? &set->grids[2 * image + part].parts[0] : &set->grids[image].parts[part],
        pBytes);
}
