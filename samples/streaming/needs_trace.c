#include "needs_trace.h"

#include <stdlib.h>

#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

#define TILE_BYTES 65536u

static void put(FILE *file, uint64_t value, int size)
{
    for (int i = 0; i < size; i++)
        fputc((int)(value >> (8 * i) & 0xFF), file);
}

static void put_header(FILE *file, uint32_t texture_count, uint32_t frame_count,
                       uint32_t frame_microseconds)
{
    fputs("SLTRACE1", file);
    put(file, texture_count, 4);
    put(file, frame_count, 4);
    put(file, texture_count, 4); /* maps per frame */
    put(file, frame_microseconds, 4);
    put(file, 0, 4);            /* seed */
    put(file, 1000, 4);         /* visibility, per mille */
    put(file, 0, 4);            /* dropped, per mille */
    put(file, 1, 4);            /* textures per set */
    for (int i = 0; i < 6; i++) /* profile, reserved */
        put(file, 0, 4);
}

static void put_texture(FILE *file, const SluiceStreamedTextureLayout *layout, uint32_t index)
{
    const SluiceStreamedTextureDesc *desc = &layout->desc;
    put(file, desc->width, 4);
    put(file, desc->height, 4);
    put(file, desc->tileWidth, 2);
    put(file, desc->tileHeight, 2);
    put(file, desc->mipLevelCount, 1);
    put(file, desc->regularMipCount, 1);
    put(file, desc->mipLevelCount - desc->regularMipCount, 1);
    put(file, desc->packedTileCount, 1);
    put(file, index, 4);
    put(file, desc->feedbackRegionWidth, 2);
    put(file, desc->feedbackRegionHeight, 2);
    put(file, layout->feedbackWidth, 2);
    put(file, layout->feedbackHeight, 2);
    put(file, TILE_BYTES, 4);
    put(file, layout->regularTileCount, 4);
    put(file, 0, 4);
}

/* Returns whether all values fit into the fields of the format. */
static bool fits(const SluiceStreamedTextureLayout *layout)
{
    const SluiceStreamedTextureDesc *desc = &layout->desc;
    return desc->tileWidth <= UINT16_MAX && desc->tileHeight <= UINT16_MAX &&
           desc->packedTileCount <= UINT8_MAX && desc->feedbackRegionWidth <= UINT16_MAX &&
           desc->feedbackRegionHeight <= UINT16_MAX && layout->feedbackWidth <= UINT16_MAX &&
           layout->feedbackHeight <= UINT16_MAX;
}

bool needs_trace_begin(struct needs_trace *trace, const char *path, const struct needs *needs,
                       uint32_t frame_count, uint32_t frame_microseconds)
{
    size_t most = 0;
    for (uint32_t i = 0; i < needs->texture_count; i++) {
        const SluiceStreamedTextureLayout *layout = &needs->textures[i].layout;
        size_t regions = (size_t)layout->feedbackWidth * layout->feedbackHeight;
        most = regions > most ? regions : most;
        if (!fits(layout)) {
            text_say("%s: a texture is too large for this format", path);
            return false;
        }
    }
    *trace = (struct needs_trace){.runs = malloc(2 * most + 16)};
    if (!trace->runs)
        fprintf(stderr, "out of memory\n");
    trace->output = trace->runs ? output_file_begin(path) : NULL;
    if (!trace->output) {
        free(trace->runs);
        *trace = (struct needs_trace){0};
        return false;
    }
    trace->file = output_file_stream(trace->output);
    put_header(trace->file, needs->texture_count, frame_count, frame_microseconds);
    for (uint32_t i = 0; i < needs->texture_count; i++)
        put_texture(trace->file, &needs->textures[i].layout, i);
    return true;
}

/* Encodes pairs of run length (varint) and value. At most 2 bytes per texel. */
static size_t encode(const uint8_t *map, size_t count, uint8_t *runs)
{
    size_t size = 0;
    for (size_t at = 0; at < count;) {
        size_t end = at + 1;
        while (end < count && map[end] == map[at])
            end++;
        size_t run = end - at;
        for (; run > 127; run >>= 7)
            runs[size++] = (uint8_t)(run & 127) | 128;
        runs[size++] = (uint8_t)run;
        runs[size++] = map[at];
        at = end;
    }
    return size;
}

void needs_trace_add_frame(struct needs_trace *trace, const struct needs *needs,
                           uint64_t microseconds)
{
    if (!trace->file)
        return;
    put(trace->file, microseconds, 8);
    put(trace->file, needs->texture_count, 4);
    for (uint32_t i = 0; i < needs->texture_count; i++) {
        const struct needs_texture *texture = &needs->textures[i];
        size_t regions = (size_t)texture->layout.feedbackWidth * texture->layout.feedbackHeight;
        size_t size = encode(needs->levels + texture->first_region, regions, trace->runs);
        put(trace->file, i, 4);
        put(trace->file, size, 4);
        fwrite(trace->runs, 1, size, trace->file);
    }
}

bool needs_trace_end(struct needs_trace *trace, bool keep)
{
    bool written = !trace->output || output_file_end(trace->output, keep);
    free(trace->runs);
    *trace = (struct needs_trace){0};
    return written;
}
