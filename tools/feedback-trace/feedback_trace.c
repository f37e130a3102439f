#include "feedback_trace.h"

#include "../common/input.h"
#include "../common/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SIZE ((uint64_t)4 << 30) ///< bytes of a trace; larger ones could exhaust the memory

enum { HEADER_SIZE = 64, TEXTURE_SIZE = 40, FRAME_SIZE = 12, MAP_SIZE = 8, TILE_BYTES = 65536 };

static void fail(struct feedback_trace *t, size_t at, const char *why)
{
    if (t->why)
        return;
    t->why = why;
    t->why_at = at;
}

/** Reads a little-endian number. Returns 0 after an error. */
static uint64_t get(struct feedback_trace *t, uint32_t byte_count)
{
    uint64_t value = 0;
    if (byte_count > t->size - t->at)
        fail(t, t->size, "it ends too early");
    if (t->why)
        return 0;
    for (uint32_t i = 0; i < byte_count; i++)
        value |= (uint64_t)t->data[t->at + i] << 8 * i;
    t->at += byte_count;
    return value;
}

static uint32_t get_u32(struct feedback_trace *t)
{
    return (uint32_t)get(t, 4);
}

/** Reads a LEB128 number of at most 32 bits. `end`: end of the map. */
static uint32_t get_run(struct feedback_trace *t, size_t end)
{
    uint64_t run = 0;
    for (uint32_t shift = 0; shift < 35 && t->at < end; shift += 7) {
        uint64_t byte = get(t, 1);
        run |= (byte & 127) << shift;
        if (byte < 128)
            return run <= UINT32_MAX ? (uint32_t)run : UINT32_MAX;
    }
    fail(t, t->at, "a map's run is no number");
    return 0;
}

/* Values in the trace that must agree with the texture's description. */
struct stated {
    uint32_t packed_levels, map_width, map_height, tile_bytes, tile_count;
};

static const char *check_texture(const SluiceStreamedTextureDesc *desc,
                                 const SluiceStreamedTextureLayout *layout,
                                 const struct stated *stated)
{
    if (layout->desc.feedbackRegionWidth != desc->feedbackRegionWidth ||
        layout->desc.feedbackRegionHeight != desc->feedbackRegionHeight ||
        layout->feedbackWidth != stated->map_width || layout->feedbackHeight != stated->map_height)
        return "a feedback map's size is not that of its texture";
    if (desc->regularMipCount + stated->packed_levels != desc->mipLevelCount)
        return "a texture's levels are neither regular nor packed";
    if (layout->regularTileCount != stated->tile_count || stated->tile_bytes != TILE_BYTES)
        return "a texture's tiles are not what its sizes give";
    if ((uint64_t)stated->map_width * stated->map_height > FEEDBACK_TRACE_MAX_REGIONS ||
        layout->tileCount > FEEDBACK_TRACE_MAX_TILES)
        return "a texture is larger than can be played";
    return NULL;
}

static void read_texture(struct feedback_trace *t, struct feedback_texture *texture)
{
    SluiceStreamedTextureDesc desc = {0};
    struct stated stated;
    size_t start = t->at;
    desc.width = get_u32(t);
    desc.height = get_u32(t);
    desc.tileWidth = (uint32_t)get(t, 2);
    desc.tileHeight = (uint32_t)get(t, 2);
    desc.mipLevelCount = (uint32_t)get(t, 1);
    desc.regularMipCount = (uint32_t)get(t, 1);
    stated.packed_levels = (uint32_t)get(t, 1);
    desc.packedTileCount = (uint32_t)get(t, 1);
    texture->primary = get_u32(t);
    desc.feedbackRegionWidth = (uint32_t)get(t, 2);
    desc.feedbackRegionHeight = (uint32_t)get(t, 2);
    stated.map_width = (uint32_t)get(t, 2);
    stated.map_height = (uint32_t)get(t, 2);
    stated.tile_bytes = get_u32(t);
    stated.tile_count = get_u32(t);
    get_u32(t); /* reserved */
    if (t->why)
        return;
    const char *why = "a texture's sizes and level counts do not fit together";
    texture->layout.structSize = sizeof texture->layout;
    if (sluiceGetStreamedTextureLayout(&desc, &texture->layout) == SLUICE_SUCCESS)
        why = check_texture(&desc, &texture->layout, &stated);
    if (!why && texture->primary >= t->texture_count)
        why = "a texture's primary does not exist";
    if (why)
        fail(t, start, why);
}

static void check_primaries(struct feedback_trace *t)
{
    for (uint32_t i = 0; !t->why && i < t->texture_count; i++)
        if (t->textures[t->textures[i].primary].primary != t->textures[i].primary)
            fail(t, HEADER_SIZE + (size_t)i * TEXTURE_SIZE,
                 "a texture's primary follows another one");
}

static size_t map_size(const struct feedback_texture *texture)
{
    return (size_t)texture->layout.feedbackWidth * texture->layout.feedbackHeight;
}

/** Returns false when out of memory. */
static bool read_textures(struct feedback_trace *t)
{
    size_t largest = 1;
    t->textures = calloc((size_t)t->texture_count + 1, sizeof *t->textures);
    if (!t->textures)
        return false;
    for (uint32_t i = 0; !t->why && i < t->texture_count; i++) {
        read_texture(t, &t->textures[i]);
        size_t size = t->why ? 0 : map_size(&t->textures[i]);
        largest = size > largest ? size : largest;
    }
    check_primaries(t);
    t->map = malloc(largest);
    return t->map != NULL;
}

static bool read_header(struct feedback_trace *t)
{
    if (t->size >= 8 && memcmp(t->data, "SLUICERT", 8) == 0) {
        fail(t, 0,
             "it is a recording of a manager, for sluice-replay; feedback is in needs.trace, "
             "which streaming --needs-trace writes");
        return true;
    }
    if (t->size < HEADER_SIZE || memcmp(t->data, "SLTRACE1", 8) != 0) {
        fail(t, 0, "it is no SLTRACE1 trace");
        return true;
    }
    t->at = 8;
    t->texture_count = get_u32(t);
    t->frame_count = get_u32(t);
    t->at = HEADER_SIZE;
    size_t left = t->size - HEADER_SIZE;
    if (t->texture_count > left / TEXTURE_SIZE)
        fail(t, 8, "there are fewer textures than it says");
    else if (t->frame_count > (left - (size_t)t->texture_count * TEXTURE_SIZE) / FRAME_SIZE)
        fail(t, 12, "there are fewer frames than it says");
    return t->why || read_textures(t);
}

void feedback_trace_next_frame(struct feedback_trace *t, uint64_t *micros, uint32_t *map_count)
{
    size_t start = t->at;
    *micros = get(t, 8);
    *map_count = get_u32(t);
    if (!t->why && *map_count > (t->size - t->at) / MAP_SIZE)
        fail(t, start + 8, "there are fewer maps than the frame says");
}

const uint8_t *feedback_trace_next_map(struct feedback_trace *t, uint32_t *texture)
{
    size_t start = t->at, filled = 0;
    *texture = get_u32(t);
    uint32_t bytes = get_u32(t);
    if (!t->why && *texture >= t->texture_count)
        fail(t, start, "a map's texture does not exist");
    if (!t->why && bytes > t->size - t->at)
        fail(t, start + 4, "it ends before the map does");
    if (t->why)
        return t->map;
    size_t end = t->at + bytes, room = map_size(&t->textures[*texture]);
    while (!t->why && t->at < end) {
        uint32_t run = get_run(t, end);
        uint8_t value = (uint8_t)get(t, 1);
        if (t->at > end || run > room - filled) {
            fail(t, start, "a map is not of its texture's size");
            break;
        }
        memset(t->map + filled, value, run);
        filled += run;
    }
    if (filled != room)
        fail(t, start, "a map is not of its texture's size");
    return t->map;
}

void feedback_trace_rewind(struct feedback_trace *t)
{
    t->at = t->first_frame;
}

static void check_frames(struct feedback_trace *t)
{
    uint64_t last = 0;
    for (uint32_t i = 0; !t->why && i < t->frame_count; i++) {
        size_t start = t->at;
        uint64_t time;
        uint32_t map_count, texture;
        feedback_trace_next_frame(t, &time, &map_count);
        if (time < last)
            fail(t, start, "time goes backwards");
        for (uint32_t m = 0; !t->why && m < map_count; m++)
            feedback_trace_next_map(t, &texture);
        last = time;
    }
    if (t->at != t->size)
        fail(t, t->at, "there is more behind the last frame");
}

/* Reads any file, including /dev/fd/N. */
static bool read_file(struct feedback_trace *t, const char *path)
{
    char *data = NULL;
    FILE *stream = input_open_stream(path);
    bool done = stream && input_read_rest(stream, MAX_SIZE, &data, &t->size);
    int error = errno;
    if (stream)
        fclose(stream);
    t->data = (uint8_t *)data;
    errno = error;
    return done;
}

bool feedback_trace_open(struct feedback_trace *t, const char *path)
{
    *t = (struct feedback_trace){0};
    bool done = read_file(t, path) && read_header(t);
    if (done && !t->why) {
        t->first_frame = t->at;
        check_frames(t);
        feedback_trace_rewind(t);
    }
    if (!done)
        text_say("%s: %s", path, input_reason(errno));
    else if (t->why)
        text_say("%s: %s (at byte %zu)", path, t->why, t->why_at);
    if (done && !t->why)
        return true;
    feedback_trace_close(t);
    return false;
}

void feedback_trace_close(struct feedback_trace *t)
{
    free(t->textures);
    free(t->map);
    free(t->data);
    *t = (struct feedback_trace){0};
}

bool feedback_trace_same_shape(const SluiceStreamedTextureDesc *a,
                               const SluiceStreamedTextureDesc *b)
{
    return a->width == b->width && a->height == b->height && a->tileWidth == b->tileWidth &&
           a->tileHeight == b->tileHeight && a->mipLevelCount == b->mipLevelCount &&
           a->regularMipCount == b->regularMipCount && a->packedTileCount == b->packedTileCount;
}
