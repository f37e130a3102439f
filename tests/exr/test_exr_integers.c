/* Channels of integers, from files that are written here byte by byte. */
#include <sluice/exr.h>

#include "exr/exr_paths.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 5, HEIGHT = 3 };

/* A file in memory that grows at its end. */
struct bytes {
    uint8_t data[2048];
    size_t size;
};

static void put(struct bytes *file, const void *data, size_t size)
{
    assert_true(file->size + size <= sizeof file->data);
    memcpy(file->data + file->size, data, size);
    file->size += size;
}

static void put_number(struct bytes *file, uint64_t number, int count)
{
    for (int i = 0; i < count; i++)
        put(file, &(uint8_t){(uint8_t)(number >> 8 * i)}, 1);
}

static void put_attribute(struct bytes *file, const char *name, const char *type, uint32_t size)
{
    put(file, name, strlen(name) + 1);
    put(file, type, strlen(type) + 1);
    put_number(file, size, 4);
}

/* Above 2^24, where floats have gaps, and with the largest number. */
static uint32_t number_of(char channel, uint32_t x, uint32_t y)
{
    if (x == 0 && y == 0)
        return UINT32_MAX;
    return 0x01000001u + 2 * (x + WIDTH * y) + ((uint32_t)channel << 25);
}

static void put_header(struct bytes *file, const char *channels)
{
    uint32_t count = (uint32_t)strlen(channels);
    put_number(file, 20000630, 4);
    put_number(file, 2, 4);
    put_attribute(file, "channels", "chlist", 18 * count + 1);
    for (uint32_t c = 0; c < count; c++) {
        put(file, (char[]){channels[c], 0}, 2);
        put_number(file, 0, 4); /* uint */
        put_number(file, 0, 4);
        put_number(file, 1, 4);
        put_number(file, 1, 4);
    }
    put_number(file, 0, 1);
    put_attribute(file, "compression", "compression", 1);
    put_number(file, 0, 1);
    for (int i = 0; i < 2; i++) {
        put_attribute(file, i == 0 ? "dataWindow" : "displayWindow", "box2i", 16);
        put_number(file, 0, 8);
        put_number(file, WIDTH - 1, 4);
        put_number(file, HEIGHT - 1, 4);
    }
    put_attribute(file, "lineOrder", "lineOrder", 1);
    put_number(file, 0, 1);
    put_attribute(file, "pixelAspectRatio", "float", 4);
    put_number(file, 0x3F800000, 4);
    put_attribute(file, "screenWindowCenter", "v2f", 8);
    put_number(file, 0, 8);
    put_attribute(file, "screenWindowWidth", "float", 4);
    put_number(file, 0x3F800000, 4);
    put_number(file, 0, 1);
}

/* Scanlines without compression. `channels` are in alphabetical order. */
static void write_file(struct bytes *file, const char *channels)
{
    file->size = 0;
    put_header(file, channels);
    uint32_t line_size = 4 * WIDTH * (uint32_t)strlen(channels);
    for (uint32_t y = 0; y < HEIGHT; y++)
        put_number(file, file->size + 8 * (HEIGHT - y) + (uint64_t)y * (8 + line_size), 8);
    for (uint32_t y = 0; y < HEIGHT; y++) {
        put_number(file, y, 4);
        put_number(file, line_size, 4);
        for (const char *c = channels; *c; c++)
            for (uint32_t x = 0; x < WIDTH; x++)
                put_number(file, number_of(*c, x, y), 4);
    }
}

static SluiceResult open_bytes(const struct bytes *file, SluiceFormat format,
                               SluiceImageSource **source)
{
    SluiceInput input = {.structSize = sizeof input, .pBytes = file->data, .size = file->size};
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pInput = &input, .format = format};
    return sluiceCreateExrImageSource(&create, source);
}

static void check_level_0(const char *channels, SluiceFormat format, uint32_t component_count)
{
    struct bytes file;
    SluiceImageSource *source;
    uint32_t texels[HEIGHT][WIDTH][4];
    SluiceImageRegion region = {0, 0, 0, WIDTH, HEIGHT};
    write_file(&file, channels);
    CHECK_OK(open_bytes(&file, format, &source));
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, (size_t)4 * component_count * WIDTH));
    const uint32_t *texel = &texels[0][0][0];
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        for (uint32_t c = 0; c < component_count; c++, texel++)
            assert_int_equal(*texel, strchr(channels, "RGBA"[c])
                                         ? number_of("RGBA"[c], i % WIDTH, i / WIDTH)
                                         : (uint32_t)(c == 3));
    sluiceDestroyImageSource(source);
}

static void integers_come_out_bit_by_bit(void **state)
{
    (void)state;
    check_level_0("R", SLUICE_FORMAT_R32_UINT, 1);
    check_level_0("GR", SLUICE_FORMAT_R32G32_UINT, 2);
    check_level_0("ABGR", SLUICE_FORMAT_R32G32B32A32_UINT, 4);
}

static void channels_that_are_missing_read_as_0_and_alpha_as_1(void **state)
{
    (void)state;
    check_level_0("GR", SLUICE_FORMAT_R32G32B32A32_UINT, 4);
    check_level_0("R", SLUICE_FORMAT_R32G32_UINT, 2);
}

static void built_levels_hold_integers_of_level_0(void **state)
{
    (void)state;
    struct bytes file;
    SluiceImageSource *source;
    uint32_t coarse[2];
    SluiceImageRegion region = {1, 0, 0, 2, 1};
    write_file(&file, "R");
    CHECK_OK(open_bytes(&file, SLUICE_FORMAT_R32_UINT, &source));
    CHECK_OK(sluiceReadImageRegion(source, &region, coarse, sizeof coarse));
    for (int i = 0; i < 2; i++) {
        bool is_there = false;
        for (uint32_t t = 0; t < WIDTH * HEIGHT; t++)
            is_there = is_there || coarse[i] == number_of('R', t % WIDTH, t / WIDTH);
        assert_true(is_there);
    }
    sluiceDestroyImageSource(source);
}

static void files_of_floats_and_narrow_integers_are_refused(void **state)
{
    (void)state;
    char path[1024];
    struct bytes file;
    SluiceImageSource *source = NULL;
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = own_file("scan_mixed.exr", path),
                                             .format = SLUICE_FORMAT_R32G32B32A32_UINT};
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_UNSUPPORTED);
    write_file(&file, "R");
    CHECK_RESULT(open_bytes(&file, SLUICE_FORMAT_R16_UINT, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(open_bytes(&file, SLUICE_FORMAT_R32_SINT, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integers_come_out_bit_by_bit),
        cmocka_unit_test(channels_that_are_missing_read_as_0_and_alpha_as_1),
        cmocka_unit_test(built_levels_hold_integers_of_level_0),
        cmocka_unit_test(files_of_floats_and_narrow_integers_are_refused),
    };
    return RUN_TESTS(tests);
}
