#include "replay/feedback_trace.h"

#include "base/alloc.h"

#define TEXTURE_SIZE 40u
#define FRAME_SIZE 12u
#define MAP_SIZE 8u
#define TILE_BYTES 65536u

/* Checks that repeated values of the trace agree, to find damage early. */
static const char *check_texture(const struct slc_trace_texture *texture, uint32_t mip_count,
                                 uint32_t packed_mips, uint32_t tile_bytes, uint32_t regular_tiles)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (sluiceGetStreamedTextureLayout(&texture->desc, &layout) != SLUICE_SUCCESS)
        return "a texture's sizes and level counts do not fit together";
    if (layout.desc.feedbackRegionWidth != texture->desc.feedbackRegionWidth ||
        layout.desc.feedbackRegionHeight != texture->desc.feedbackRegionHeight ||
        layout.feedbackWidth != texture->feedback_width ||
        layout.feedbackHeight != texture->feedback_height)
        return "a feedback map's size is not that of its texture";
    if (texture->desc.regularMipCount + packed_mips != mip_count)
        return "a texture's levels are neither regular nor packed";
    if (layout.regularTileCount != regular_tiles)
        return "a texture's tile count is wrong";
    return tile_bytes == TILE_BYTES ? NULL : "a tile is not 64 KiB";
}

static void read_texture(struct slc_feedback_trace *trace, uint32_t index)
{
    struct slc_cursor *in = &trace->in;
    struct slc_trace_texture *t = &trace->textures[index];
    *t = (struct slc_trace_texture){.offset = in->pos};
    t->desc.width = slc_get_u32(in);
    t->desc.height = slc_get_u32(in);
    t->desc.tileWidth = slc_get_u16(in);
    t->desc.tileHeight = slc_get_u16(in);
    t->desc.mipLevelCount = slc_get_u8(in);
    t->desc.regularMipCount = slc_get_u8(in);
    uint32_t packed_mips = slc_get_u8(in);
    t->desc.packedTileCount = slc_get_u8(in);
    t->primary = slc_get_u32(in);
    t->desc.feedbackRegionWidth = slc_get_u16(in);
    t->desc.feedbackRegionHeight = slc_get_u16(in);
    t->feedback_width = slc_get_u16(in);
    t->feedback_height = slc_get_u16(in);
    uint32_t tile_bytes = slc_get_u32(in);
    uint32_t regular_tiles = slc_get_u32(in);
    slc_get_u32(in); /* reserved */
    if (in->why)
        return;
    const char *why =
        check_texture(t, t->desc.mipLevelCount, packed_mips, tile_bytes, regular_tiles);
    if (t->primary >= trace->texture_count)
        why = "a texture's primary does not exist";
    if (why)
        slc_cursor_fail(in, t->offset, why);
}

static void read_textures(struct slc_feedback_trace *trace)
{
    struct slc_cursor *in = &trace->in;
    for (uint32_t i = 0; !in->why && i < trace->texture_count; i++)
        read_texture(trace, i);
    for (uint32_t i = 0; !in->why && i < trace->texture_count; i++) {
        const struct slc_trace_texture *t = &trace->textures[i];
        if (trace->textures[t->primary].primary != t->primary)
            slc_cursor_fail(in, t->offset, "a texture's primary follows another one");
    }
}

SluiceResult slc_feedback_trace_open(struct slc_feedback_trace *trace,
                                     const SluiceAllocationCallbacks *cb, struct slc_cursor in)
{
    *trace = (struct slc_feedback_trace){.in = in};
    slc_get_bytes(&trace->in, 8);
    trace->texture_count = slc_get_u32(&trace->in);
    trace->frame_count = slc_get_u32(&trace->in);
    slc_get_bytes(&trace->in, 48); /* information about the generator, and reserved */
    if (trace->in.why)
        return SLUICE_SUCCESS;
    size_t left = trace->in.end - trace->in.pos;
    if (trace->texture_count > left / TEXTURE_SIZE) {
        slc_cursor_fail(&trace->in, 8, "there are fewer textures than it says");
        return SLUICE_SUCCESS;
    }
    left -= (size_t)trace->texture_count * TEXTURE_SIZE;
    if (trace->frame_count > left / FRAME_SIZE) {
        slc_cursor_fail(&trace->in, 12, "there are fewer frames than it says");
        return SLUICE_SUCCESS;
    }
    if (trace->texture_count == 0)
        return SLUICE_SUCCESS;
    trace->textures = slc_alloc(cb, trace->texture_count, sizeof *trace->textures);
    if (!trace->textures)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    read_textures(trace);
    return SLUICE_SUCCESS;
}

void slc_feedback_trace_close(struct slc_feedback_trace *trace, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, trace->textures, trace->texture_count, sizeof *trace->textures);
    trace->textures = NULL;
}

void slc_next_frame(struct slc_feedback_trace *trace, uint64_t *micros, uint32_t *map_count)
{
    size_t start = trace->in.pos;
    *micros = slc_get_u64(&trace->in);
    *map_count = slc_get_u32(&trace->in);
    if (!trace->in.why && *map_count > (trace->in.end - trace->in.pos) / MAP_SIZE)
        slc_cursor_fail(&trace->in, start + 8, "there are fewer maps than the frame says");
}

struct slc_cursor slc_next_map(struct slc_feedback_trace *trace, uint32_t *texture)
{
    struct slc_cursor *in = &trace->in;
    size_t start = in->pos;
    *texture = slc_get_u32(in);
    if (!in->why && *texture >= trace->texture_count)
        slc_cursor_fail(in, start, "a map's texture does not exist");
    uint32_t size = slc_get_u32(in);
    struct slc_cursor map = *in;
    if (slc_get_bytes(in, size))
        map.end = in->pos;
    else
        map = *in;
    return map;
}
