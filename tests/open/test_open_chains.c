/* Opened files have the levels that streaming requires where Sluice can build them. */
#include <sluice/open.h>

#include "base/checked.h"
#include "container/container_files.h"
#include "image/info.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static void count_errors(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)message;
    *(int *)user += severity == SLUICE_LOG_ERROR;
}

static struct file_bytes make_file(const struct picture *picture, bool is_dds)
{
    return is_dds ? make_dds(picture) : make_ktx2(picture, 0);
}

/* The last level of a layer of the file, with all coarser ones. */
static SluiceImageSource *make_oracle(const struct picture *p, uint32_t layer)
{
    uint32_t level = picture_level_count(p) - 1;
    SluiceImageInfo info = {.structSize = sizeof info,
                            .width = slc_mip_size(p->width, level),
                            .height = slc_mip_size(p->height, level),
                            .format = p->format->format};
    size_t size = (size_t)info.width * info.height * p->format->block_size;
    uint8_t *texels = malloc(size);
    assert_non_null(texels);
    for (size_t i = 0; i < size; i++)
        texels[i] = picture_byte(layer, level, i);
    SluiceImageSource *oracle;
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, NULL, &oracle));
    free(texels);
    return oracle;
}

static void check_level(SluiceImageSource *source, SluiceImageSource *oracle,
                        const struct picture *p, uint32_t layer, uint32_t level)
{
    SluiceImageRegion region = {.mipLevel = level,
                                .width = slc_mip_size(p->width, level),
                                .height = slc_mip_size(p->height, level),
                                .arrayLayer = layer};
    size_t pitch = (size_t)region.width * p->format->block_size, size = pitch * region.height;
    uint8_t *texels = malloc(size), *expected = malloc(size);
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, pitch));
    region.mipLevel -= picture_level_count(p) - 1;
    region.arrayLayer = 0;
    CHECK_OK(sluiceReadImageRegion(oracle, &region, expected, pitch));
    assert_memory_equal(texels, expected, size);
    free(texels);
    free(expected);
}

static void check_completed(SluiceImageSource *source, const struct picture *p)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceOpenedImageInfo opened = {.structSize = sizeof opened};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_int_equal(info.mipLevelCount, slc_mip_count(slc_max_u32(p->width, p->height)));
    assert_int_equal(info.cube, p->is_cube);
    assert_null(slc_image_info_trouble(&info, SLC_LEVELS_TO_TAIL));
    for (uint32_t layer = 0; layer < picture_layer_count(p); layer++) {
        SluiceImageSource *oracle = make_oracle(p, layer);
        for (uint32_t level = picture_level_count(p) - 1; level < info.mipLevelCount; level++)
            check_level(source, oracle, p, layer, level);
        sluiceDestroyImageSource(oracle);
    }
    CHECK_OK(sluiceGetOpenedImageInfo(source, &opened));
    check_picture(opened.source, p); /* the levels of the file */
}

static void levels_that_uncompressed_files_lack_are_built(void **state)
{
    (void)state;
    const struct picture pictures[] = {
        {format_names_of(SLUICE_FORMAT_R8G8B8A8_SRGB), 517, 258, 0, false, 1},
        {format_names_of(SLUICE_FORMAT_R16G16B16A16_UNORM), 300, 300, 0, false, 3},
        {format_names_of(SLUICE_FORMAT_R8G8B8A8_UNORM), 256, 256, 1, true, 1},
        {format_names_of(SLUICE_FORMAT_R8_UNORM), 64, 64, 3, false, 6},
    };
    int errors = 0;
    SluiceImageOpener *opener;
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .log = {&errors, count_errors}};
    CHECK_OK(sluiceCreateImageOpener(&info, &opener));
    for (size_t i = 0; i < 2 * sizeof pictures / sizeof pictures[0]; i++) {
        const struct picture *picture = &pictures[i / 2];
        struct file_bytes file = make_file(picture, i % 2 == 0);
        struct scratch scratch;
        SluiceImageSource *source;
        scratch_init(&scratch, &file);
        free(file.bytes);
        CHECK_OK(sluiceOpenImageSource(opener, scratch.path, &source));
        check_completed(source, picture);
        sluiceDestroyImageSource(source);
        scratch_finish(&scratch);
    }
    assert_int_equal(errors, 0);
    sluiceDestroyImageOpener(opener);
}

/* The opener does not know what they are for: short chains to the tail can be streamed. */
static void compressed_files_keep_their_levels(void **state)
{
    (void)state;
    const struct format_names *bc7 = format_names_of(SLUICE_FORMAT_BC7_UNORM_BLOCK);
    const struct picture pictures[] = {{bc7, 512, 512, 0, false, 1}, {bc7, 512, 512, 0, false, 2}};
    int errors = 0;
    SluiceImageOpener *opener;
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .log = {&errors, count_errors}};
    CHECK_OK(sluiceCreateImageOpener(&info, &opener));
    for (uint32_t i = 0; i < 2; i++) {
        struct file_bytes file = make_dds(&pictures[i]);
        struct scratch scratch;
        SluiceImageSource *source;
        SluiceImageInfo image = {.structSize = sizeof image};
        scratch_init(&scratch, &file);
        free(file.bytes);
        CHECK_OK(sluiceOpenImageSource(opener, scratch.path, &source));
        check_picture(source, &pictures[i]);
        assert_int_equal(errors, 0);
        CHECK_OK(sluiceGetImageInfo(source, &image));
        const char *trouble = slc_image_info_trouble(&image, SLC_LEVELS_TO_TAIL);
        assert_int_equal(trouble != NULL, i == 0);
        assert_true(!trouble || strstr(trouble, "write the file again with all levels"));
        sluiceDestroyImageSource(source);
        scratch_finish(&scratch);
    }
    sluiceDestroyImageOpener(opener);
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    const struct picture picture = {
        format_names_of(SLUICE_FORMAT_R8G8B8A8_UNORM), 200, 100, 0, false, 1};
    struct file_bytes file = make_dds(&picture);
    struct scratch scratch;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    scratch_init(&scratch, &file);
    free(file.bytes);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        SluiceImageOpener *opener = NULL;
        SluiceImageSource *source = NULL;
        failing_allocator_init(&a, n);
        SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .pAllocator = &a.callbacks};
        result = sluiceCreateImageOpener(&info, &opener);
        if (result == SLUICE_SUCCESS)
            result = sluiceOpenImageSource(opener, scratch.path, &source);
        if (result == SLUICE_SUCCESS)
            result = read_everything(source);
        sluiceDestroyImageSource(source);
        sluiceDestroyImageOpener(opener);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(a.live_bytes, 0);
    }
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_that_uncompressed_files_lack_are_built),
        cmocka_unit_test(compressed_files_keep_their_levels),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
