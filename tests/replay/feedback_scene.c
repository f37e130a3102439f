#include "feedback_scene.h"

#include "support/test.h"

#define FRAMES 12

static void put(const SluiceRecordWriter *out, uint64_t value, int size)
{
    uint8_t bytes[8];
    for (int i = 0; i < size; i++)
        bytes[i] = (uint8_t)(value >> (8 * i));
    CHECK_OK(out->pfnWrite(out->pUserData, bytes, (size_t)size));
}

static void put_texture(const SluiceRecordWriter *out, uint32_t size, uint32_t primary)
{
    uint32_t levels = 0, regular = 0, tiles = 0;
    for (; size >> levels; levels++) {
        uint32_t across = ((size >> levels) + 127) / 128;
        if (size >> levels < 128)
            continue;
        regular++;
        tiles += across * across;
    }
    put(out, size, 4);
    put(out, size, 4);
    put(out, 128, 2);
    put(out, 128, 2);
    put(out, levels, 1);
    put(out, regular, 1);
    put(out, levels - regular, 1);
    put(out, 1, 1);
    put(out, primary, 4);
    put(out, 128, 2);
    put(out, 128, 2);
    put(out, size / 128, 2);
    put(out, size / 128, 2);
    put(out, 65536, 4);
    put(out, tiles, 4);
    put(out, 0, 4);
}

void make_feedback_scene(struct trace_buffer *trace)
{
    SluiceRecordWriter out = trace_buffer_writer(trace);
    CHECK_OK(out.pfnWrite(out.pUserData, "SLTRACE1", 8));
    put(&out, 3, 4);
    put(&out, FRAMES, 4);
    for (int i = 0; i < 12; i++)
        put(&out, 0, 4);
    put_texture(&out, 512, 0);
    put_texture(&out, 1024, 0);
    put_texture(&out, 256, 2);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        uint32_t row = frame < 6 ? frame / 2 : 3;
        put(&out, frame * 100000, 8);
        put(&out, 2, 4);
        put(&out, 0, 4);
        put(&out, 6, 4); /* three pairs: untouched rows, one of level 0, untouched ones */
        put(&out, 4 * row, 1);
        put(&out, 255, 1);
        put(&out, 4, 1);
        put(&out, 0, 1);
        put(&out, 4 * (3 - row), 1);
        put(&out, 255, 1);
        put(&out, 2, 4);
        put(&out, 2, 4);
        put(&out, 4, 1);
        put(&out, frame < 6 ? 1 : 255, 1);
    }
}
