#define _POSIX_C_SOURCE 200809L

#include "play/trace_file.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void put(struct trace_file *f, uint64_t value, uint32_t bytes)
{
    if (f->size + bytes > f->room) {
        f->room = 2 * f->room + 4096;
        f->bytes = realloc(f->bytes, f->room);
        assert_non_null(f->bytes);
    }
    for (uint32_t i = 0; i < bytes; i++)
        f->bytes[f->size++] = (uint8_t)(value >> 8 * i);
}

void trace_file_begin(struct trace_file *f, uint32_t textures, uint32_t frames)
{
    for (const char *c = "SLTRACE1"; *c; c++)
        put(f, (uint8_t)*c, 1);
    put(f, textures, 4);
    put(f, frames, 4);
    for (int i = 0; i < 12; i++)
        put(f, 0, 4);
}

void trace_file_add_texture(struct trace_file *f, const SluiceStreamedTextureDesc *desc,
                            uint32_t primary)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetStreamedTextureLayout(desc, &layout));
    put(f, desc->width, 4);
    put(f, desc->height, 4);
    put(f, desc->tileWidth, 2);
    put(f, desc->tileHeight, 2);
    put(f, desc->mipLevelCount, 1);
    put(f, desc->regularMipCount, 1);
    put(f, desc->mipLevelCount - desc->regularMipCount, 1);
    put(f, desc->packedTileCount, 1);
    put(f, primary, 4);
    put(f, layout.desc.feedbackRegionWidth, 2);
    put(f, layout.desc.feedbackRegionHeight, 2);
    put(f, layout.feedbackWidth, 2);
    put(f, layout.feedbackHeight, 2);
    put(f, 65536, 4);
    put(f, layout.regularTileCount, 4);
    put(f, 0, 4);
}

void trace_file_add_frame(struct trace_file *f, uint64_t micros, uint32_t maps)
{
    put(f, micros, 8);
    put(f, maps, 4);
}

static void put_varint(struct trace_file *f, uint32_t value)
{
    for (; value >= 128; value >>= 7)
        put(f, (value & 127) | 128, 1);
    put(f, value, 1);
}

void trace_file_add_map(struct trace_file *f, uint32_t texture, const uint8_t *map,
                        uint32_t regions)
{
    put(f, texture, 4);
    const size_t at = f->size;
    put(f, 0, 4);
    for (uint32_t i = 0, run; i < regions; i += run) {
        for (run = 1; i + run < regions && map[i + run] == map[i]; run++)
            continue;
        put_varint(f, run);
        put(f, map[i], 1);
    }
    const uint32_t size = (uint32_t)(f->size - at - 4);
    for (uint32_t i = 0; i < 4; i++)
        f->bytes[at + i] = (uint8_t)(size >> 8 * i);
}

void trace_file_finish(struct trace_file *f)
{
    free(f->bytes);
    *f = (struct trace_file){0};
}

void trace_file_write(const struct trace_file *f, size_t size, char *path)
{
    strcpy(path, "/tmp/sluice-play-XXXXXX");
    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_true(size <= f->size);
    assert_int_equal(write(descriptor, f->bytes, size), size);
    assert_int_equal(close(descriptor), 0);
}
