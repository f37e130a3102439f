/* Where in a DDS or KTX2 file it is that a read failed. */
#define _XOPEN_SOURCE 700

#include <sluice/dds.h>
#include <sluice/ktx2.h>

#include "container/container_files.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* 40 x 24 texels of 4 bytes, 2 layers: level 0 has 3840 bytes per layer. */
static struct picture rgba(void)
{
    return (struct picture){.format = format_names_of(SLUICE_FORMAT_R8G8B8A8_UNORM),
                            .width = 40,
                            .height = 24,
                            .layer_count = 2};
}

static SluiceImageSource *open_file(const char *path, bool is_ktx2)
{
    SluiceDdsImageSourceCreateInfo dds = {.structSize = sizeof dds, .pPath = path};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {.structSize = sizeof ktx2, .pPath = path};
    SluiceImageSource *source = NULL;
    CHECK_OK(is_ktx2 ? sluiceCreateKtx2ImageSource(&ktx2, &source)
                     : sluiceCreateDdsImageSource(&dds, &source));
    return source;
}

static void a_file_that_was_cut_ends_in_the_row_that_is_told(void **state)
{
    (void)state;
    unsigned char texels[8 * 4 * 2];
    struct picture picture = rgba();
    struct file_bytes file = make_dds(&picture);
    struct scratch scratch;
    scratch_init(&scratch, &file);
    SluiceImageSource *source = open_file(scratch.path, false);
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    SluiceImageRegion region = {.x = 3, .y = 10, .width = 8, .height = 2};
    uint64_t second_row = file.header_size + 11 * 160 + 3 * 4;
    assert_int_equal(truncate(scratch.path, (off_t)second_row + 4), 0);
    SluiceImageFault fault;
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &region, texels, 32, &fault),
                 SLUICE_ERROR_IO);
    assert_string_equal(fault.pName, scratch.path);
    assert_int_equal(fault.offset, second_row);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
    free(file.bytes);
}

#ifdef TEST_HAS_ZSTD
static uint64_t number_at(const uint8_t *bytes, int size)
{
    uint64_t value = 0;
    for (int i = size - 1; i >= 0; i--)
        value = value << 8 | bytes[i];
    return value;
}
#endif

static void a_level_that_does_not_decompress_is_told_where_it_begins(void **state)
{
    (void)state;
#ifdef TEST_HAS_ZSTD
    unsigned char texel[4];
    struct picture picture = rgba();
    struct file_bytes file = make_ktx2(&picture, 2);
    uint64_t level_1 = number_at(file.bytes + 80 + 24, 8); /* KTX2: the level index is at 80 */
    memset(file.bytes + level_1, 0xA5, 8);
    struct scratch scratch;
    scratch_init(&scratch, &file);
    SluiceImageSource *source = open_file(scratch.path, true);
    SluiceImageRegion region = {.mipLevel = 1, .x = 5, .y = 5, .width = 1, .height = 1};
    SluiceImageFault fault;
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &region, texel, 4, &fault),
                 SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(fault.offset, level_1);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
    free(file.bytes);
#else
    SKIP_TEST("built without Zstandard");
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_that_was_cut_ends_in_the_row_that_is_told),
        cmocka_unit_test(a_level_that_does_not_decompress_is_told_where_it_begins),
    };
    return RUN_TESTS(tests);
}
