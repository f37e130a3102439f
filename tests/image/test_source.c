#include <sluice/image.h>

#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

/* Tells where it was asked: every texel of every level has its own color. */
static void mark(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                 uint32_t height, float rgba[4])
{
    (void)user;
    rgba[0] = (float)(x + y * width);
    rgba[1] = (float)level;
    rgba[2] = (float)width;
    rgba[3] = (float)height;
}

static SluiceImageSource *create_marked(uint32_t width, uint32_t height)
{
    SluiceProceduralImage image = {NULL, mark};
    SluiceImageInfo info = {sizeof info, width, height, 0, SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                            "marked"};
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    return source;
}

static void procedural_regions_hold_the_texels_they_name(void **state)
{
    (void)state;
    SluiceImageSource *source = create_marked(301, 77);
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_int_equal(info.mipLevelCount, 9);
    assert_string_equal(info.pName, "marked");
    for (uint32_t level = 0; level < info.mipLevelCount; level++) {
        uint32_t width = slc_mip_size(301, level), height = slc_mip_size(77, level);
        SluiceImageRegion region = {level, width / 3, height / 3, width - width / 3,
                                    height - height / 3};
        size_t pitch = (region.width + 5) * 16;
        char *texels = malloc(pitch * region.height);
        memset(texels, 0x77, pitch * region.height);
        CHECK_OK(sluiceReadImageRegion(source, &region, texels, pitch));
        for (uint32_t y = 0; y < region.height; y++) {
            for (uint32_t x = 0; x < region.width; x++) {
                float rgba[4], expected[4];
                memcpy(rgba, texels + y * pitch + x * 16, 16);
                mark(NULL, level, region.x + x, region.y + y, width, height, expected);
                assert_memory_equal(rgba, expected, 16);
            }
            assert_int_equal(texels[y * pitch + region.width * 16], 0x77);
        }
        free(texels);
    }
    sluiceDestroyImageSource(source);
}

static void regions_that_leave_their_level_are_refused(void **state)
{
    (void)state;
    SluiceImageSource *source = create_marked(20, 10);
    char texels[20 * 10 * 16];
    const SluiceImageRegion bad[] = {
        {0, 0, 0, 0, 1},  {0, 0, 0, 1, 0},  {0, 20, 0, 1, 1},         {0, 0, 10, 1, 1},
        {0, 1, 0, 20, 1}, {0, 0, 1, 1, 10}, {0, UINT32_MAX, 0, 2, 1}, {0, 1, 0, UINT32_MAX, 1},
        {1, 10, 0, 1, 1}, {4, 0, 1, 1, 1},  {5, 0, 0, 1, 1},          {UINT32_MAX, 0, 0, 1, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK_RESULT(sluiceReadImageRegion(source, &bad[i], texels, sizeof texels),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceImageRegion good = {0, 0, 0, 20, 10};
    CHECK_RESULT(sluiceReadImageRegion(source, &good, texels, 20 * 16 - 1),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceReadImageRegion(source, &good, texels, 20 * 16));
    CHECK_RESULT(sluiceReadImageRegion(NULL, &good, texels, 320), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceReadImageRegion(source, NULL, texels, 320), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceReadImageRegion(source, &good, NULL, 320), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetImageInfo(source, NULL), SLUICE_ERROR_NULL_POINTER);
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(NULL);
}

struct block_source {
    SluiceImageSource base;
    SluiceImageInfo info;
    SluiceImageRegion last;
};

static SluiceResult block_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct block_source *)base)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult block_read(SluiceImageSource *base, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch)
{
    (void)texels;
    (void)row_pitch;
    ((struct block_source *)base)->last = *region;
    return SLUICE_SUCCESS;
}

static void regions_of_compressed_formats_are_whole_blocks(void **state)
{
    (void)state;
    const SluiceImageSourceInterface interface = {sizeof interface, block_info, block_read, NULL};
    struct block_source source = {.base = {&interface},
                                  .info = {sizeof(SluiceImageInfo), 30, 10, 5,
                                           SLUICE_FORMAT_BC7_UNORM_BLOCK,
                                           "blocks"}}; /* levels 30x10, 15x5, 7x2 */
    static const SluiceImageRegion good[] = {{0, 0, 0, 4, 4},  {0, 8, 4, 20, 4}, {0, 0, 0, 30, 10},
                                             {0, 28, 8, 2, 2}, {1, 12, 4, 3, 1}, {2, 0, 0, 7, 2},
                                             {2, 4, 0, 3, 2},  {4, 0, 0, 1, 1}};
    static const SluiceImageRegion bad[] = {{0, 2, 0, 4, 4}, {0, 0, 2, 4, 4},  {0, 0, 0, 5, 4},
                                            {0, 0, 0, 4, 6}, {0, 28, 8, 1, 2}, {0, 28, 8, 2, 1},
                                            {2, 0, 0, 6, 2}, {2, 0, 0, 7, 1},  {0, 0, 0, 32, 4}};
    char texels[8 * 3 * 16];
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        CHECK_OK(sluiceReadImageRegion(&source.base, &good[i], texels, 128));
        assert_memory_equal(&source.last, &good[i], sizeof good[i]);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK_RESULT(sluiceReadImageRegion(&source.base, &bad[i], texels, 128),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    /* a row of 30 texels is 8 blocks of 16 bytes */
    CHECK_RESULT(sluiceReadImageRegion(&source.base, &good[2], texels, 127),
                 SLUICE_ERROR_INVALID_ARGUMENT);
}

static void sources_that_compute_texels_cannot_compress(void **state)
{
    (void)state;
    SluiceProceduralImage image = {NULL, mark};
    SluiceImageSource *source = NULL;
    for (int f = SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK; f <= SLUICE_FORMAT_BC7_SRGB_BLOCK; f++) {
        SluiceImageInfo info = {sizeof info, 8, 8, 0, (SluiceFormat)f, "blocks"};
        CHECK_RESULT(sluiceCreateProceduralImageSource(&image, &info, NULL, &source),
                     SLUICE_ERROR_UNSUPPORTED);
        CHECK_RESULT(sluiceCreateMemoryImageSource("", &info, NULL, &source),
                     SLUICE_ERROR_UNSUPPORTED);
    }
    assert_null(source);
}

static void wrong_descriptions_are_refused(void **state)
{
    (void)state;
    SluiceProceduralImage image = {NULL, mark};
    const SluiceImageInfo bad[] = {{sizeof(SluiceImageInfo), 0, 1, 0, SLUICE_FORMAT_R8_UNORM, "a"},
                                   {sizeof(SluiceImageInfo), 1, 0, 0, SLUICE_FORMAT_R8_UNORM, "a"},
                                   {sizeof(SluiceImageInfo), 4, 4, 2, SLUICE_FORMAT_R8_UNORM, "a"},
                                   {sizeof(SluiceImageInfo), 4, 4, 4, SLUICE_FORMAT_R8_UNORM, "a"},
                                   {sizeof(SluiceImageInfo), 4, 4, 0, SLUICE_FORMAT_UNDEFINED, "a"},
                                   {sizeof(SluiceImageInfo), 4, 4, 0, (SluiceFormat)99, "a"}};
    SluiceImageSource *source = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK_RESULT(sluiceCreateProceduralImageSource(&image, &bad[i], NULL, &source),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        CHECK_RESULT(sluiceCreateMemoryImageSource("", &bad[i], NULL, &source),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    }
    assert_null(source);
}

static void memory_levels_are_what_was_given_and_its_means(void **state)
{
    (void)state;
    const uint8_t texels[4][4] = {
        {0, 4, 8, 12}, {4, 8, 12, 16}, {100, 0, 0, 100}, {0, 100, 100, 0}};
    SluiceImageInfo info = {sizeof info, 4, 4, 3, SLUICE_FORMAT_R8_UNORM, NULL};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, NULL, &source));
    uint8_t read[16];
    CHECK_OK(sluiceReadImageRegion(source, &(SluiceImageRegion){0, 1, 1, 2, 3}, read, 2));
    assert_memory_equal(read, ((uint8_t[]){8, 12, 0, 0, 100, 100}), 6);
    CHECK_OK(sluiceReadImageRegion(source, &(SluiceImageRegion){1, 0, 0, 2, 2}, read, 2));
    assert_memory_equal(read, ((uint8_t[]){4, 12, 50, 50}), 4);
    CHECK_OK(sluiceReadImageRegion(source, &(SluiceImageRegion){2, 0, 0, 1, 1}, read, 1));
    assert_int_equal(read[0], 29);
    sluiceDestroyImageSource(source);
}

static void array_layers_are_the_sources_given(void **state)
{
    (void)state;
    SluiceImageInfo info = {sizeof info, 2, 2, 0, SLUICE_FORMAT_R8_UNORM, "layer"};
    SluiceImageSource *layers[3], *array = NULL;
    for (int i = 0; i < 3; i++) {
        const uint8_t texels[4] = {(uint8_t)i, (uint8_t)(10 + i), 20, 30};
        CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, NULL, &layers[i]));
    }
    CHECK_OK(sluiceCreateArrayImageSource(layers, 3, NULL, &array));
    CHECK_OK(sluiceGetImageInfo(array, &info));
    assert_int_equal(info.arrayLayerCount, 3);
    assert_int_equal(info.mipLevelCount, 2);
    for (uint32_t i = 0; i < 3; i++) {
        uint8_t read[2];
        SluiceImageRegion region = {0, 0, 0, 2, 1, i};
        CHECK_OK(sluiceReadImageRegion(array, &region, read, 2));
        assert_int_equal(read[0], i);
        assert_int_equal(read[1], 10 + i);
        region.arrayLayer = i + 1;
        if (i < 2)
            CHECK_RESULT(sluiceReadImageRegion(layers[i], &region, read, 2),
                         SLUICE_ERROR_INVALID_ARGUMENT);
    }
    uint8_t read[4];
    CHECK_RESULT(sluiceReadImageRegion(array, &(SluiceImageRegion){0, 0, 0, 2, 2, 3}, read, 2),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    sluiceDestroyImageSource(array);
    for (int i = 0; i < 3; i++)
        sluiceDestroyImageSource(layers[i]);
}

static void array_layers_must_say_what_an_image_can_be(void **state)
{
    (void)state;
    const SluiceImageSourceInterface interface = {sizeof interface, block_info, block_read, NULL};
    const SluiceImageInfo bad[] = {
        {sizeof(SluiceImageInfo), 0, 16, 5, SLUICE_FORMAT_R8_UNORM, "no width"},
        {sizeof(SluiceImageInfo), 16, 0, 5, SLUICE_FORMAT_R8_UNORM, "no height"},
        {sizeof(SluiceImageInfo), (1u << 20) + 1, 1, 21, SLUICE_FORMAT_R8_UNORM, "too wide"},
        {sizeof(SluiceImageInfo), 1, (1u << 20) + 1, 21, SLUICE_FORMAT_R8_UNORM, "too high"},
        {sizeof(SluiceImageInfo), 16, 16, 0, SLUICE_FORMAT_R8_UNORM, "no levels"},
        {sizeof(SluiceImageInfo), 16, 16, 6, SLUICE_FORMAT_R8_UNORM, "too many levels"},
        {sizeof(SluiceImageInfo), 16, 16, 5, SLUICE_FORMAT_UNDEFINED, "no format"},
        {sizeof(SluiceImageInfo), 16, 16, 5, (SluiceFormat)SLUICE_FORMAT_COUNT, "unknown format"},
        {sizeof(SluiceImageInfo), 16, 16, 5, (SluiceFormat)-1, "negative format"},
    };
    const SluiceImageInfo good[] = {
        {sizeof(SluiceImageInfo), 16, 16, 5, SLUICE_FORMAT_R8_UNORM, NULL, 0},
        {sizeof(SluiceImageInfo), 1u << 20, 1, 21, SLUICE_FORMAT_R8_UNORM, NULL, 1},
        {sizeof(SluiceImageInfo), 16, 16, 1, SLUICE_FORMAT_R8_UNORM, "level 0 alone", 1},
        {sizeof(SluiceImageInfo), 16, 16, 4, SLUICE_FORMAT_R8_UNORM, "all but the last", 1}};
    struct block_source source = {.base = {&interface}};
    SluiceImageSource *layers[] = {&source.base}, *array = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        source.info = bad[i];
        CHECK_RESULT(sluiceCreateArrayImageSource(layers, 1, NULL, &array),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        assert_null(array);
    }
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        source.info = good[i];
        CHECK_OK(sluiceCreateArrayImageSource(layers, 1, NULL, &array));
        sluiceDestroyImageSource(array);
    }
}

static void sources_without_an_interface_are_refused(void **state)
{
    (void)state;
    const SluiceImageSourceInterface nothing = {.structSize = sizeof nothing};
    const SluiceImageSourceInterface unreadable = {sizeof unreadable, block_info, NULL, NULL};
    struct block_source source = {
        .info = {sizeof(SluiceImageInfo), 16, 16, 5, SLUICE_FORMAT_R8_UNORM, NULL}};
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageRegion region = {0, 0, 0, 1, 1};
    char texel;
    for (int i = 0; i < 2; i++) {
        source.base.pInterface = i ? &nothing : NULL;
        CHECK_RESULT(sluiceGetImageInfo(&source.base, &info), SLUICE_ERROR_NULL_POINTER);
        CHECK_RESULT(sluiceReadImageRegion(&source.base, &region, &texel, 1),
                     SLUICE_ERROR_NULL_POINTER);
        sluiceDestroyImageSource(&source.base);
    }
    source.base.pInterface = &unreadable;
    CHECK_RESULT(sluiceReadImageRegion(&source.base, &region, &texel, 1),
                 SLUICE_ERROR_NULL_POINTER);
}

static void array_layers_must_be_alike(void **state)
{
    (void)state;
    SluiceImageSource *marked = create_marked(4, 4), *wide = create_marked(8, 4), *array = NULL;
    SluiceImageSource *different[] = {marked, wide}, *same[] = {marked, marked};
    CHECK_RESULT(sluiceCreateArrayImageSource(different, 2, NULL, &array),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceCreateArrayImageSource(same, 0, NULL, &array),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceCreateArrayImageSource(NULL, 2, NULL, &array), SLUICE_ERROR_NULL_POINTER);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        result = sluiceCreateArrayImageSource(same, 2, &a.callbacks, &array);
        if (result == SLUICE_SUCCESS) {
            SluiceImageSource *nested[] = {array, array}, *other;
            CHECK_RESULT(sluiceCreateArrayImageSource(nested, 2, NULL, &other),
                         SLUICE_ERROR_INVALID_ARGUMENT);
            sluiceDestroyImageSource(array);
        }
        assert_int_equal(a.live_bytes, 0);
    }
    SluiceProceduralImage image = {NULL, mark};
    SluiceImageInfo info = {sizeof info, 8, 8, 0, SLUICE_FORMAT_R8_UNORM, "array", 2};
    CHECK_RESULT(sluiceCreateProceduralImageSource(&image, &info, NULL, &array),
                 SLUICE_ERROR_UNSUPPORTED);
    sluiceDestroyImageSource(marked);
    sluiceDestroyImageSource(wide);
}

static void creation_survives_every_refused_allocation(void **state)
{
    (void)state;
    SluiceProceduralImage image = {NULL, mark};
    SluiceImageInfo info = {sizeof info, 3, 5, 0, SLUICE_FORMAT_R8_UNORM, "name"};
    for (int kind = 0; kind < 2; kind++) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
            struct failing_allocator a;
            SluiceImageSource *source = NULL;
            assert_true(n < 100);
            failing_allocator_init(&a, n);
            result = kind ? sluiceCreateMemoryImageSource("0123456789abcdef", &info, &a.callbacks,
                                                          &source)
                          : sluiceCreateProceduralImageSource(&image, &info, &a.callbacks, &source);
            if (result != SLUICE_SUCCESS) {
                CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
                assert_null(source);
            }
            sluiceDestroyImageSource(source);
            assert_int_equal(a.live_bytes, 0);
        }
    }
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    SluiceProceduralImage image = {NULL, mark}, empty = {NULL, NULL};
    SluiceImageInfo info = {sizeof info, 3, 5, 0, SLUICE_FORMAT_R8_UNORM, "name"};
    SluiceImageSource *source = NULL;
    SluiceAllocationCallbacks half = {0};
    const SluiceResult expected = SLUICE_ERROR_NULL_POINTER;
    CHECK_RESULT(sluiceCreateProceduralImageSource(NULL, &info, NULL, &source), expected);
    CHECK_RESULT(sluiceCreateProceduralImageSource(&empty, &info, NULL, &source), expected);
    CHECK_RESULT(sluiceCreateProceduralImageSource(&image, NULL, NULL, &source), expected);
    CHECK_RESULT(sluiceCreateProceduralImageSource(&image, &info, NULL, NULL), expected);
    CHECK_RESULT(sluiceCreateProceduralImageSource(&image, &info, &half, &source), expected);
    CHECK_RESULT(sluiceCreateMemoryImageSource(NULL, &info, NULL, &source), expected);
    CHECK_RESULT(sluiceCreateMemoryImageSource("", NULL, NULL, &source), expected);
    CHECK_RESULT(sluiceCreateMemoryImageSource("", &info, NULL, NULL), expected);
    CHECK_RESULT(sluiceCreateMemoryImageSource("", &info, &half, &source), expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(procedural_regions_hold_the_texels_they_name),
        cmocka_unit_test(regions_that_leave_their_level_are_refused),
        cmocka_unit_test(regions_of_compressed_formats_are_whole_blocks),
        cmocka_unit_test(sources_that_compute_texels_cannot_compress),
        cmocka_unit_test(wrong_descriptions_are_refused),
        cmocka_unit_test(memory_levels_are_what_was_given_and_its_means),
        cmocka_unit_test(array_layers_are_the_sources_given),
        cmocka_unit_test(array_layers_must_be_alike),
        cmocka_unit_test(array_layers_must_say_what_an_image_can_be),
        cmocka_unit_test(sources_without_an_interface_are_refused),
        cmocka_unit_test(creation_survives_every_refused_allocation),
        cmocka_unit_test(null_pointers_are_refused),
    };
    return RUN_TESTS(tests);
}
