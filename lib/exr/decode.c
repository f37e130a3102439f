#include "exr/decode.h"

#include "base/checked.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "image/half.h"
#include "image/srgb.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH = 64 }; /* texels of one conversion */

SluiceFormat slc_exr_natural_format(const struct slc_exr_file *file)
{
    bool is_half = file->widest == EXR_PIXEL_HALF;
    if (file->channel_count == 1)
        return is_half ? SLUICE_FORMAT_R16_SFLOAT : SLUICE_FORMAT_R32_SFLOAT;
    return is_half ? SLUICE_FORMAT_R16G16B16A16_SFLOAT : SLUICE_FORMAT_R32G32B32A32_SFLOAT;
}

void slc_exr_decoder_init(struct slc_exr_decoder *decoder, struct slc_exr_file *file)
{
    exr_decode_pipeline_t empty = EXR_DECODE_PIPELINE_INITIALIZER;
    *decoder = (struct slc_exr_decoder){.file = file, .pipeline = empty};
}

void slc_exr_decoder_finish(struct slc_exr_decoder *decoder)
{
    if (decoder->is_open)
        exr_decoding_destroy(decoder->file->context, &decoder->pipeline);
    decoder->is_open = false;
}

/*
 * Reads and decompresses a chunk with OpenEXRCore, without unpacking. OpenEXRCore's unpacking does
 * not saturate, clamp or encode, and unpacks whole chunks where a region needs only a corner.
 */
static exr_result_t decompress(struct slc_exr_decoder *decoder, const exr_chunk_info_t *info)
{
    exr_const_context_t context = decoder->file->context;
    exr_decode_pipeline_t *pipeline = &decoder->pipeline;
    exr_result_t result;
    if (decoder->is_open) {
        result = exr_decoding_update(context, 0, info, pipeline);
    } else {
        result = exr_decoding_initialize(context, 0, info, pipeline);
        decoder->is_open = result == EXR_ERR_SUCCESS;
        if (result == EXR_ERR_SUCCESS)
            result = exr_decoding_choose_default_routines(context, 0, pipeline);
        pipeline->unpack_and_convert_fn = NULL;
        decoder->decompress = pipeline->decompress_fn;
    }
    /* Incompressible chunks are stored raw. OpenEXRCore 3.1 wrongly decodes these, too, for B44. */
    bool is_raw = info->packed_size == info->unpacked_size;
    pipeline->decompress_fn = is_raw ? NULL : decoder->decompress;
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(context, 0, pipeline) : result;
}

/* Loads `count` values of one channel of a row from the file's bytes. */
static void load_span(exr_pixel_type_t type, const unsigned char *source, float *values,
                      uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (type == EXR_PIXEL_HALF) {
            uint32_t half = source[2 * i] | (uint32_t)source[2 * i + 1] << 8;
            values[i] = slc_float_from_half((uint16_t)half);
            continue;
        }
        const unsigned char *bytes = source + 4 * (size_t)i;
        uint32_t bits = bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
                        (uint32_t)bytes[3] << 24;
        values[i] = type == EXR_PIXEL_UINT ? (float)bits : slc_float_from_bits(bits);
    }
}

/* Encoding of a component in the target. ENCODE_WORD keeps the file's 32 bits. */
enum encoding {
    ENCODE_FLOAT,
    ENCODE_HALF,
    ENCODE_UNORM8,
    ENCODE_UNORM16,
    ENCODE_SRGB,
    ENCODE_WORD
};

/* Returns the encoding of component `c`. Alpha is linear in every format. */
static enum encoding encoding_of(SluiceFormat format, uint32_t c)
{
    if (format == SLUICE_FORMAT_R8G8B8A8_SRGB)
        return c < 3 ? ENCODE_SRGB : ENCODE_UNORM8;
    if (slc_format_is_unorm16(format))
        return ENCODE_UNORM16;
    if (slc_format_is_half(format))
        return ENCODE_HALF;
    if (slc_format_is_integer(format))
        return ENCODE_WORD;
    return sluiceGetFormatTexelSize(format) / slc_format_channel_count(format) == 1 ? ENCODE_UNORM8
                                                                                    : ENCODE_FLOAT;
}

static void store_span(enum encoding encoding, const float *values, char *result, size_t stride,
                       uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, result += stride) {
        uint16_t word;
        uint8_t step;
        switch (encoding) {
        case ENCODE_FLOAT:
        case ENCODE_WORD: memcpy(result, &values[i], 4); break;
        case ENCODE_HALF:
            word = slc_half_from_float(values[i]);
            memcpy(result, &word, 2);
            break;
        case ENCODE_UNORM16:
            word = slc_unorm16_from_float(values[i]);
            memcpy(result, &word, 2);
            break;
        case ENCODE_UNORM8:
        case ENCODE_SRGB:
            step = encoding == ENCODE_SRGB ? slc_srgb_from_linear(values[i])
                                           : slc_unorm8_from_float(values[i]);
            memcpy(result, &step, 1);
            break;
        }
    }
}

/* Copies halves, the common case. Infinities and NaN keep their bits. */
static void copy_half_span(const unsigned char *source, char *result, size_t stride, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, result += stride) {
        uint16_t half = (uint16_t)(source[2 * i] | (uint32_t)source[2 * i + 1] << 8);
        memcpy(result, &half, 2);
    }
}

/* Copies 32-bit words. Conversion to float would lose integers above 2^24. */
static void copy_word_span(const unsigned char *source, char *result, size_t stride, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, source += 4, result += stride) {
        uint32_t word = source[0] | (uint32_t)source[1] << 8 | (uint32_t)source[2] << 16 |
                        (uint32_t)source[3] << 24;
        memcpy(result, &word, 4);
    }
}

/* Source and encoding of one component of the target. */
struct component {
    uint32_t size;
    enum encoding encoding;
    size_t stride;
};

static void convert_span(exr_pixel_type_t type, const unsigned char *source,
                         const struct component *component, char *result, uint32_t count)
{
    float values[BATCH];
    uint32_t size = type == EXR_PIXEL_HALF ? 2 : 4;
    if (type == EXR_PIXEL_HALF && component->encoding == ENCODE_HALF) {
        copy_half_span(source, result, component->stride, count);
        return;
    }
    if (component->encoding == ENCODE_WORD) {
        copy_word_span(source, result, component->stride, count);
        return;
    }
    for (uint32_t done = 0; done < count; done += BATCH) {
        uint32_t step = slc_min_u32(BATCH, count - done);
        load_span(type, source + (size_t)done * size, values, step);
        store_span(component->encoding, values, result + done * component->stride,
                   component->stride, step);
    }
}

/* Fills a component that the file lacks with 0, alpha with 1. */
static void fill_span(bool is_alpha, const struct component *component, char *result,
                      uint32_t count)
{
    bool is_word = component->encoding == ENCODE_WORD;
    float one = is_word ? slc_float_from_bits(1) : 1.0f, value = is_alpha ? one : 0.0f;
    for (uint32_t i = 0; i < count; i++, result += component->stride)
        store_span(component->encoding, &value, result, component->stride, 1);
}

/* Returns the channel of a component, or -1. With one channel and one component, names are ignored.
 */
static int32_t find_channel(const struct slc_exr_file *file, uint32_t component_count, uint32_t c)
{
    return component_count == 1 && file->channel_count == 1 ? 0 : file->rgba[c];
}

/* Loads R, G and B of a part of a row from the file's bytes, for conversion of primaries. */
static void load_colors(const struct slc_exr_file *file, const unsigned char *row,
                        uint32_t chunk_width, uint32_t first, float *colors, uint32_t count)
{
    float values[BATCH];
    for (uint32_t c = 0; c < 3; c++) {
        const struct slc_exr_channel *channel = &file->channels[file->rgba[c]];
        load_span(channel->type,
                  row + (size_t)chunk_width * channel->offset + (size_t)first * channel->size,
                  values, count);
        for (uint32_t i = 0; i < count; i++)
            colors[3 * i + c] = values[i];
    }
}

/* Stores halves. Infinities and NaN of the file stay infinities and NaN. */
static void store_kept_halves(const float *values, char *result, size_t stride, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, result += stride) {
        uint32_t bits = slc_float_bits(values[i]);
        uint16_t half = slc_half_from_float(values[i]);
        if ((bits & 0x7F800000u) == 0x7F800000u)
            half = (uint16_t)((bits >> 16 & 0x8000u) | 0x7C00u | (bits >> 13 & 0x3FFu));
        memcpy(result, &half, 2);
    }
}

static void deliver_colors(struct slc_exr_file *file, const unsigned char *row,
                           const SluiceImageRegion *chunk, const SluiceImageRegion *shared,
                           const struct slc_exr_target *target, char *result)
{
    uint32_t component_count = slc_min_u32(3, slc_format_channel_count(target->format));
    size_t texel_size = sluiceGetFormatTexelSize(target->format);
    uint32_t size = (uint32_t)texel_size / slc_format_channel_count(target->format);
    enum encoding encoding = encoding_of(target->format, 0);
    for (uint32_t done = 0; done < shared->width; done += BATCH, result += BATCH * texel_size) {
        float colors[3 * BATCH], values[BATCH];
        uint32_t count = slc_min_u32(BATCH, shared->width - done);
        load_colors(file, row, chunk->width, shared->x - chunk->x + done, colors, count);
        slc_convert_colors(file->to_rec709, colors, count);
        for (uint32_t c = 0; c < component_count; c++) {
            for (uint32_t i = 0; i < count; i++)
                values[i] = colors[3 * i + c];
            if (encoding == ENCODE_HALF && file->channels[file->rgba[c]].type == EXR_PIXEL_HALF)
                store_kept_halves(values, result + c * size, texel_size, count);
            else
                store_span(encoding, values, result + c * size, texel_size, count);
        }
    }
}

/* Writes all components in the part of a row that chunk and target share. */
static void deliver_row(struct slc_exr_file *file, const unsigned char *row,
                        const SluiceImageRegion *chunk, const SluiceImageRegion *shared,
                        const struct slc_exr_target *target, char *result)
{
    uint32_t component_count = slc_format_channel_count(target->format);
    size_t texel_size = sluiceGetFormatTexelSize(target->format);
    struct component component = {(uint32_t)texel_size / component_count, ENCODE_FLOAT, texel_size};
    if (file->converts)
        deliver_colors(file, row, chunk, shared, target, result);
    for (uint32_t c = 0; c < component_count; c++, result += component.size) {
        component.encoding = encoding_of(target->format, c);
        if (file->converts && c < 3)
            continue;
        int32_t index = find_channel(file, component_count, c);
        if (index < 0) {
            fill_span(c == 3, &component, result, shared->width);
            continue;
        }
        const struct slc_exr_channel *channel = &file->channels[index];
        const unsigned char *source = row + (size_t)chunk->width * channel->offset +
                                      (size_t)(shared->x - chunk->x) * channel->size;
        convert_span(channel->type, source, &component, result, shared->width);
    }
}

static SluiceImageRegion intersect(const SluiceImageRegion *a, const SluiceImageRegion *b)
{
    uint32_t x0 = slc_max_u32(a->x, b->x), x1 = slc_min_u32(a->x + a->width, b->x + b->width);
    uint32_t y0 = slc_max_u32(a->y, b->y), y1 = slc_min_u32(a->y + a->height, b->y + b->height);
    bool is_empty = x1 <= x0 || y1 <= y0;
    return (SluiceImageRegion){a->mipLevel, x0, y0, is_empty ? 0 : x1 - x0, is_empty ? 0 : y1 - y0};
}

/*
 * Maps an error of a decompressor. Up to 3.1, OpenEXRCore also returns OUT_OF_MEMORY for corrupt
 * bytes. So OUT_OF_HOST_MEMORY is returned only if a chunk's largest buffer cannot be allocated.
 */
static SluiceResult explain(const struct slc_exr_file *file, const exr_chunk_info_t *info,
                            exr_result_t result)
{
    if (result != EXR_ERR_OUT_OF_MEMORY)
        return slc_exr_result(file, result);
    void *probe = malloc((size_t)(info->packed_size + 3 * info->unpacked_size) + (1u << 22));
    SluiceResult answer = probe ? SLUICE_ERROR_CORRUPT_DATA : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    free(probe);
    return answer;
}

SluiceResult slc_exr_decode_chunk(struct slc_exr_decoder *decoder,
                                  const struct slc_exr_chunk *chunk,
                                  const struct slc_exr_target *target)
{
    struct slc_exr_file *file = decoder->file;
    exr_result_t result = decompress(decoder, &chunk->info);
    if (result != EXR_ERR_SUCCESS) {
        SluiceResult answer = explain(file, &chunk->info, result);
        return slc_input_fail(&file->input, answer, "cannot decode the chunk at %llu: %s",
                              (unsigned long long)chunk->info.data_offset,
                              answer == SLUICE_ERROR_CORRUPT_DATA
                                  ? "its bytes are damaged"
                                  : exr_get_default_error_message(result));
    }
    const unsigned char *texels = decoder->pipeline.unpacked_buffer;
    SluiceImageRegion shared = intersect(&chunk->region, &target->region);
    size_t row_size = (size_t)chunk->region.width * file->texel_size;
    size_t result_texel = sluiceGetFormatTexelSize(target->format);
    for (uint32_t y = shared.y; y < shared.y + shared.height; y++)
        deliver_row(file, texels + (y - chunk->region.y) * row_size, &chunk->region, &shared,
                    target,
                    target->texels + (y - target->region.y) * target->pitch +
                        (shared.x - target->region.x) * result_texel);
    return SLUICE_SUCCESS;
}
