/* Compares every kind of file in tests/exr/data with the formula that made it. */
#include <sluice/exr.h>

#include "base/checked.h"
#include "exr/exr_paths.h"
#include "image/convert.h"
#include "image/half.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum layout { BUILT, MIP, RIP };

struct kind {
    const char *name;
    SluiceResult result;          ///< result of opening
    const char *channels, *types; ///< letters; h half, f float, u uint
    enum layout layout;
    uint32_t width, height;
    bool rounds_up, is_lossy;
};

static const struct kind kinds[] = {
    {"scan_none", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_rle", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_zips", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_zip", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_piz", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_pxr24", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_b44", 0, "RGBA", "hhhh", BUILT, 37, 21, false, true},
    {"scan_b44a", 0, "RGBA", "hhhh", BUILT, 37, 21, false, true},
    {"scan_decreasing", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_negative_window", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"scan_float_grey", 0, "Y", "f", BUILT, 37, 21},
    {"scan_half_grey_alpha", 0, "YA", "hh", BUILT, 37, 21},
    {"scan_uint_red", 0, "R", "u", BUILT, 37, 21},
    {"scan_mixed", 0, "RGB", "hfu", BUILT, 37, 21},
    {"scan_alpha", 0, "A", "h", BUILT, 37, 21},
    {"one_level", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"multi_part", 0, "RGBA", "hhhh", BUILT, 37, 21},
    {"mip_none", 0, "RGBA", "hhhh", MIP, 37, 21},
    {"mip_rle", 0, "RGBA", "hhhh", MIP, 37, 21},
    {"mip_zips", 0, "RGBA", "hhhh", MIP, 37, 21},
    {"mip_zip", 0, "RGBA", "hhhh", MIP, 37, 21},
    {"mip_piz", 0, "RGBA", "hhhh", MIP, 37, 21},
    {"mip_pxr24", 0, "RGBA", "hhhh", MIP, 37, 21},
    {"mip_b44", 0, "RGBA", "hhhh", MIP, 37, 21, false, true},
    {"mip_b44a", 0, "RGBA", "hhhh", MIP, 37, 21, false, true},
    {"mip_up", 0, "RGBA", "hhhh", MIP, 37, 21, true},
    {"mip_random", 0, "RGBA", "hhhh", MIP, 37, 21},
    {"mip_mixed", 0, "RGB", "hfu", MIP, 37, 21},
    {"mip_one_by_n", 0, "Y", "h", MIP, 1, 77, true},
    {"mip_one_texel", 0, "RGBA", "hhhh", MIP, 1, 1},
    {"rip_down", 0, "RGBA", "hhhh", RIP, 37, 21},
    {"rip_up", 0, "RGBA", "hhhh", RIP, 21, 37, true},
    {"rip_wide", 0, "Y", "f", RIP, 70, 3},
    {"scan_depth", 0, "RGB", "hhh", BUILT, 8, 4},     /* Z beside them */
    {"mip_beside", 0, "RGBA", "hhhh", MIP, 37, 21},   /* AO.R, C, Q, Y, Z between them */
    {"scan_grey_beside", 0, "Y", "h", BUILT, 37, 21}, /* id, Z */
    {"deep", SLUICE_ERROR_UNSUPPORTED},
    {"luminance_chroma", SLUICE_ERROR_UNSUPPORTED},
    {"subsampled", SLUICE_ERROR_UNSUPPORTED},
    {"scan_layered", SLUICE_ERROR_UNSUPPORTED},
};

enum { KIND_COUNT = sizeof kinds / sizeof kinds[0] };

static SluiceResult open_kind(const struct kind *kind, SluiceFormat format,
                              SluiceImageSource **source)
{
    char name[64], path[1024];
    snprintf(name, sizeof name, "%s.exr", kind->name);
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = own_file(name, path), .format = format};
    return sluiceCreateExrImageSource(&create, source);
}

/* Returns the file's level along one axis that is read for a level of the image. */
static uint32_t file_level(const struct kind *kind, uint32_t level, uint32_t size)
{
    if (kind->layout != RIP)
        return level;
    uint32_t count = 1;
    while (kind->rounds_up ? 1u << (count - 1) < size : size >> count)
        count++;
    return slc_min_u32(level, count - 1);
}

/* Formula of the file for one texel, as linear RGBA. */
static void formula(const struct kind *kind, uint32_t level, uint32_t x, uint32_t y, float rgba[4])
{
    uint32_t lx = file_level(kind, level, kind->width), ly = file_level(kind, level, kind->height);
    rgba[0] = rgba[1] = rgba[2] = 0.0f;
    rgba[3] = 1.0f;
    for (const char *c = kind->channels; *c; c++) {
        uint32_t k = (uint32_t)(strchr("RGBAY", *c) - "RGBAY");
        uint32_t u = (3 * x + 5 * y + 7 * lx + 11 * ly + 13 * k) % 64;
        char type = kind->types[c - kind->channels];
        float value = type == 'u' ? (float)u : (float)u / 16.0f - 1.0f;
        if (*c == 'Y')
            rgba[0] = rgba[1] = rgba[2] = value;
        else
            rgba[k] = value;
    }
}

/* A file with one channel fills one component, whatever its name. */
static void formula_for(const struct kind *kind, SluiceFormat format, uint32_t level, uint32_t x,
                        uint32_t y, float rgba[4])
{
    formula(kind, level, x, y, rgba);
    if (slc_format_channel_count(format) == 1 && strcmp(kind->channels, "A") == 0)
        rgba[0] = rgba[3];
}

static char *read_level(SluiceImageSource *source, const SluiceImageInfo *info, uint32_t level,
                        SluiceImageRegion *region)
{
    *region = (SluiceImageRegion){level, 0, 0, slc_mip_size(info->width, level),
                                  slc_mip_size(info->height, level)};
    size_t pitch = (size_t)region->width * sluiceGetFormatTexelSize(info->format);
    char *texels = malloc(pitch * region->height);
    CHECK_OK(sluiceReadImageRegion(source, region, texels, pitch));
    return texels;
}

static void check_level(const struct kind *kind, SluiceImageSource *source,
                        const SluiceImageInfo *info, uint32_t level)
{
    SluiceImageRegion region;
    char *texels = read_level(source, info, level, &region);
    size_t size = sluiceGetFormatTexelSize(info->format);
    for (uint32_t y = 0; y < region.height; y++)
        for (uint32_t x = 0; x < region.width; x++) {
            float rgba[4];
            char expected[16];
            formula_for(kind, info->format, level, x, y, rgba);
            slc_texels_from_rgba(info->format, rgba, expected, 1);
            if (memcmp(expected, texels + ((size_t)y * region.width + x) * size, size) != 0)
                fail_msg("%s as %s, level %u (%u, %u) is not what was written", kind->name,
                         sluiceGetFormatName(info->format), level, x, y);
        }
    free(texels);
}

static SluiceFormat natural_format(const struct kind *kind)
{
    bool is_half = strspn(kind->types, "h") == strlen(kind->types);
    if (strlen(kind->channels) == 1)
        return is_half ? SLUICE_FORMAT_R16_SFLOAT : SLUICE_FORMAT_R32_SFLOAT;
    return is_half ? SLUICE_FORMAT_R16G16B16A16_SFLOAT : SLUICE_FORMAT_R32G32B32A32_SFLOAT;
}

static void every_kind_opens_or_is_refused_as_documented(void **state)
{
    (void)state;
    for (int i = 0; i < KIND_COUNT; i++) {
        SluiceImageSource *source = NULL;
        SluiceImageInfo info = {.structSize = sizeof info};
        SluiceResult result = open_kind(&kinds[i], SLUICE_FORMAT_UNDEFINED, &source);
        if (result != kinds[i].result)
            fail_msg("%s: %s", kinds[i].name, sluiceGetResultName(result));
        if (result != SLUICE_SUCCESS) {
            assert_null(source);
            continue;
        }
        CHECK_OK(sluiceGetImageInfo(source, &info));
        assert_int_equal(info.width, kinds[i].width);
        assert_int_equal(info.height, kinds[i].height);
        assert_int_equal(info.mipLevelCount, slc_mip_count(slc_max_u32(info.width, info.height)));
        assert_int_equal(info.format, natural_format(&kinds[i]));
        sluiceDestroyImageSource(source);
    }
}

static void every_texel_of_every_level_is_what_was_written(void **state)
{
    (void)state;
    static const SluiceFormat formats[] = {
        SLUICE_FORMAT_UNDEFINED,           SLUICE_FORMAT_R8_UNORM,   SLUICE_FORMAT_R8G8B8A8_UNORM,
        SLUICE_FORMAT_R8G8B8A8_SRGB,       SLUICE_FORMAT_R16_SFLOAT, SLUICE_FORMAT_R16G16_SFLOAT,
        SLUICE_FORMAT_R16G16B16A16_SFLOAT, SLUICE_FORMAT_R32_SFLOAT, SLUICE_FORMAT_R32G32_SFLOAT,
        SLUICE_FORMAT_R32G32B32A32_SFLOAT, SLUICE_FORMAT_R16_UNORM,  SLUICE_FORMAT_R16G16_UNORM,
        SLUICE_FORMAT_R16G16B16A16_UNORM};
    for (int i = 0; i < KIND_COUNT; i++)
        for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++) {
            if (kinds[i].result != SLUICE_SUCCESS || kinds[i].is_lossy)
                continue;
            SluiceImageSource *source;
            SluiceImageInfo info = {.structSize = sizeof info};
            CHECK_OK(open_kind(&kinds[i], formats[f], &source));
            CHECK_OK(sluiceGetImageInfo(source, &info));
            uint32_t count = kinds[i].layout == BUILT ? 1 : info.mipLevelCount;
            for (uint32_t level = 0; level < count; level++)
                check_level(&kinds[i], source, &info, level);
            sluiceDestroyImageSource(source);
        }
}

/* B44 keeps 14 of 32 bytes per 4 x 4 halves. The pattern is hard to compress, so the bound is
 * wide. */
static void lossy_files_come_near_what_was_written(void **state)
{
    (void)state;
    for (int i = 0; i < KIND_COUNT; i++) {
        if (!kinds[i].is_lossy)
            continue;
        SluiceImageSource *source;
        SluiceImageInfo info = {.structSize = sizeof info};
        CHECK_OK(open_kind(&kinds[i], SLUICE_FORMAT_R32G32B32A32_SFLOAT, &source));
        CHECK_OK(sluiceGetImageInfo(source, &info));
        uint32_t count = kinds[i].layout == BUILT ? 1 : info.mipLevelCount;
        for (uint32_t level = 0; level < count; level++) {
            SluiceImageRegion region;
            float *texels = (float *)(void *)read_level(source, &info, level, &region);
            double error = 0;
            for (uint32_t t = 0; t < region.width * region.height; t++) {
                float rgba[4];
                formula(&kinds[i], level, t % region.width, t / region.width, rgba);
                for (int c = 0; c < 4; c++)
                    error += fabs((double)(texels[4 * t + c] - rgba[c]));
            }
            assert_true(error / (4.0 * region.width * region.height) < 0.2);
            free(texels);
        }
        sluiceDestroyImageSource(source);
    }
}

/* The filter has its own test. This one shows that it is applied to the file's level 0. */
static void built_levels_are_those_of_the_same_texels_in_memory(void **state)
{
    (void)state;
    for (int i = 0; i < KIND_COUNT; i++) {
        if (kinds[i].result != SLUICE_SUCCESS || kinds[i].layout != BUILT)
            continue;
        SluiceImageSource *source, *memory;
        SluiceImageInfo info = {.structSize = sizeof info};
        SluiceImageRegion region;
        CHECK_OK(open_kind(&kinds[i], SLUICE_FORMAT_R8G8B8A8_SRGB, &source));
        CHECK_OK(sluiceGetImageInfo(source, &info));
        char *level0 = read_level(source, &info, 0, &region);
        CHECK_OK(sluiceCreateMemoryImageSource(level0, &info, NULL, &memory));
        for (uint32_t level = 0; level < info.mipLevelCount; level++) {
            char *a = read_level(source, &info, level, &region);
            char *b = read_level(memory, &info, level, &region);
            assert_memory_equal(a, b, (size_t)region.width * region.height * 4);
            free(a);
            free(b);
        }
        free(level0);
        sluiceDestroyImageSource(source);
        sluiceDestroyImageSource(memory);
    }
}

/* Checks a region in a larger buffer: writes beyond its rows would show. */
static void check_random_region(SluiceImageSource *source, const SluiceImageInfo *info,
                                uint32_t level, const char *whole, uint32_t *random)
{
    uint32_t width = slc_mip_size(info->width, level), height = slc_mip_size(info->height, level);
    uint32_t r[4];
    for (int i = 0; i < 4; i++) {
        *random = *random * 1664525u + 1013904223u;
        r[i] = *random >> 12;
    }
    SluiceImageRegion region = {level, r[0] % width, r[1] % height, 0, 0};
    region.width = 1 + r[2] % (width - region.x);
    region.height = 1 + r[3] % (height - region.y);
    size_t size = sluiceGetFormatTexelSize(info->format);
    size_t row = region.width * size, pitch = row + r[0] % 9;
    char *texels = malloc(pitch * region.height);
    memset(texels, 0x5A, pitch * region.height);
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, pitch));
    for (uint32_t y = 0; y < region.height; y++) {
        assert_memory_equal(texels + y * pitch,
                            whole + ((size_t)(region.y + y) * width + region.x) * size, row);
        for (size_t b = row; b < pitch; b++)
            assert_int_equal(texels[y * pitch + b], 0x5A);
    }
    free(texels);
}

static void random_rectangles_are_cut_from_the_whole_level(void **state)
{
    (void)state;
    uint32_t random = 11;
    for (int i = 0; i < KIND_COUNT; i++) {
        if (kinds[i].result != SLUICE_SUCCESS)
            continue;
        SluiceImageSource *source;
        SluiceImageInfo info = {.structSize = sizeof info};
        CHECK_OK(open_kind(&kinds[i], SLUICE_FORMAT_UNDEFINED, &source));
        CHECK_OK(sluiceGetImageInfo(source, &info));
        for (uint32_t level = 0; level < info.mipLevelCount; level++) {
            SluiceImageRegion region;
            char *whole = read_level(source, &info, level, &region);
            for (int k = 0; k < 12; k++)
                check_random_region(source, &info, level, whole, &random);
            free(whole);
        }
        sluiceDestroyImageSource(source);
    }
}

struct message {
    char text[1024];
    int errors;
};

static void keep_error(void *user, SluiceLogSeverity severity, const char *text)
{
    struct message *message = user;
    if (severity == SLUICE_LOG_ERROR) {
        snprintf(message->text, sizeof message->text, "%s", text);
        message->errors++;
    }
}

static void refusals_name_the_file_the_reason_and_a_way_out(void **state)
{
    (void)state;
    static const char *const expected[][3] = {
        {"deep.exr", "deep data", "flatten"},
        {"luminance_chroma.exr", "BY, RY, Y", "convert"},
        {"subsampled.exr", "channel Y is subsampled 2 x 2", "convert"},
        {"scan_layered.exr", "diffuse.B, diffuse.G, diffuse.R", "file of their own"},
    };
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        char path[1024];
        struct message message = {0};
        SluiceImageSource *source;
        SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                                 .pPath = own_file(expected[i][0], path),
                                                 .log = {&message, keep_error}};
        CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_UNSUPPORTED);
        assert_int_equal(message.errors, 1);
        for (int k = 0; k < 3; k++)
            if (!strstr(message.text, expected[i][k]))
                fail_msg("'%s' does not say '%s'", message.text, expected[i][k]);
    }
}

static void keep_news(void *user, SluiceLogSeverity severity, const char *text)
{
    struct message *message = user;
    snprintf(message->text, sizeof message->text, "%s", text);
    message->errors += severity != SLUICE_LOG_INFO;
}

static void channels_that_are_passed_over_are_named(void **state)
{
    (void)state;
    char path[1024];
    struct message message = {0};
    SluiceImageSource *source;
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = own_file("mip_beside.exr", path),
                                             .log = {&message, keep_news}};
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    assert_int_equal(message.errors, 0);
    assert_non_null(strstr(message.text, "A, AO.R, B, C, G, Q, R, Y, Z; only RGBA are read"));
    sluiceDestroyImageSource(source);
}

static void images_beyond_the_size_limit_are_refused(void **state)
{
    (void)state;
    char path[1024];
    SluiceImageSource *source;
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = own_file("scan_zip.exr", path),
                                             .maxImageSize = 37 * 21 * 8 - 1};
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_UNSUPPORTED);
    create.maxImageSize++;
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    sluiceDestroyImageSource(source);
}

static void what_is_no_file_gets_its_own_result(void **state)
{
    (void)state;
    SluiceImageSource *source = NULL;
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = "/no such folder/no such file.exr"};
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_FILE_NOT_FOUND);
    create.pPath = "";
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_FILE_NOT_FOUND);
    create.pPath = "/tmp";
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_IO);
    create.pPath = "/dev/zero";
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_IO);
    create.pPath = NULL;
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCreateExrImageSource(NULL, &source), SLUICE_ERROR_NULL_POINTER);
    create = (SluiceExrImageSourceCreateInfo){.structSize = sizeof(SluiceExrImageSourceCreateInfo),
                                              .pPath = "x"};
    const SluiceFormat wrong[] = {SLUICE_FORMAT_COUNT, SLUICE_FORMAT_BC7_UNORM_BLOCK,
                                  SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32, SLUICE_FORMAT_R8G8_SNORM,
                                  SLUICE_FORMAT_R16_SNORM};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        create.format = wrong[i];
        CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    assert_null(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_opens_or_is_refused_as_documented),
        cmocka_unit_test(every_texel_of_every_level_is_what_was_written),
        cmocka_unit_test(lossy_files_come_near_what_was_written),
        cmocka_unit_test(built_levels_are_those_of_the_same_texels_in_memory),
        cmocka_unit_test(random_rectangles_are_cut_from_the_whole_level),
        cmocka_unit_test(refusals_name_the_file_the_reason_and_a_way_out),
        cmocka_unit_test(channels_that_are_passed_over_are_named),
        cmocka_unit_test(images_beyond_the_size_limit_are_refused),
        cmocka_unit_test(what_is_no_file_gets_its_own_result),
    };
    return RUN_TESTS(tests);
}
