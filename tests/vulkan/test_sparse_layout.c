#include "vulkan/sparse_layout.h"

#include "base/checked.h"
#include "support/test.h"

#define SPACE (1ull << 40)

static SluiceImageInfo image(uint32_t width, uint32_t height, SluiceFormat format)
{
    return (SluiceImageInfo){sizeof(SluiceImageInfo),
                             width,
                             height,
                             slc_mip_count(slc_max_u32(width, height)),
                             format,
                             "test"};
}

static VkSparseImageMemoryRequirements color(uint32_t tile_width, uint32_t tile_height,
                                             uint32_t tail_level, uint64_t tail_size,
                                             uint64_t tail_offset)
{
    return (VkSparseImageMemoryRequirements){
        .formatProperties = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
                             .imageGranularity = {tile_width, tile_height, 1}},
        .imageMipTailFirstLod = tail_level,
        .imageMipTailSize = tail_size,
        .imageMipTailOffset = tail_offset};
}

static const VkMemoryRequirements small = {
    .size = 1 << 20, .alignment = 65536, .memoryTypeBits = 1};

/* Reported by an H200 for RGBA8 16384^2: the tail starts at the 64 texel level and has one page. */
static void one_page_tail_is_one_packed_tile(void **state)
{
    (void)state;
    SluiceImageInfo info = image(16384, 16384, SLUICE_FORMAT_R8G8B8A8_UNORM);
    VkSparseImageMemoryRequirements c = color(128, 128, 8, 65536, 1ull << 33);
    struct slc_sparse_layout layout;
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
    assert_true(layout.opaque_tail);
    assert_int_equal(layout.desc.regularMipCount, 8);
    assert_int_equal(layout.desc.packedTileCount, 1);
    assert_int_equal(layout.tail_offset, 1ull << 33);
    assert_int_equal(layout.desc.feedbackRegionWidth, 128);
    assert_false(layout.uneven);
    SluiceTile tile = {.mipLevel = 8};
    struct slc_tile_place place = slc_sparse_layout_place(&layout, &tile);
    assert_int_equal(place.level, SLC_TAIL_LEVEL);
    assert_int_equal(place.x, 0);
}

/* Reported by an H200 for RGBA8 16384x128: 2.75 MiB of tail from level 1 on. */
static void many_page_tail_is_as_many_packed_tiles(void **state)
{
    (void)state;
    SluiceImageInfo info = image(16384, 128, SLUICE_FORMAT_R8G8B8A8_UNORM);
    VkSparseImageMemoryRequirements c = color(128, 128, 1, 44 * 65536, 1 << 23);
    struct slc_sparse_layout layout;
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
    assert_int_equal(layout.desc.regularMipCount, 1);
    assert_int_equal(layout.desc.packedTileCount, 44);
    SluiceTile tile = {.mipLevel = 1, .x = 43};
    assert_int_equal(slc_sparse_layout_place(&layout, &tile).x, 43);
    SluiceStreamedTextureLayout streamed = {.structSize = sizeof streamed};
    CHECK_OK(sluiceGetStreamedTextureLayout(&layout.desc, &streamed));
    assert_int_equal(streamed.tileCount, 128 + 44);
}

/* Reported by an H200 for images smaller than a tile. */
static void image_that_is_all_tail_has_one_region(void **state)
{
    (void)state;
    SluiceImageInfo info = image(100, 30, SLUICE_FORMAT_R8G8B8A8_UNORM);
    VkSparseImageMemoryRequirements c = color(128, 128, 0, 2 * 65536, 0);
    struct slc_sparse_layout layout;
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
    assert_int_equal(layout.desc.regularMipCount, 0);
    SluiceStreamedTextureLayout streamed = {.structSize = sizeof streamed};
    CHECK_OK(sluiceGetStreamedTextureLayout(&layout.desc, &streamed));
    assert_int_equal(streamed.feedbackWidth * streamed.feedbackHeight, 1);
    assert_int_equal(streamed.minMipWidth * streamed.minMipHeight, 1);
}

/* Reported by lavapipe: no tail, tailFirstLod is the level count. */
static void without_a_tail_levels_within_one_tile_are_packed(void **state)
{
    (void)state;
    const struct {
        uint32_t width, height, regular, packed;
    } cases[] = {{1024, 1024, 3, 8}, {1000, 1000, 3, 7}, {129, 1, 1, 7},    {128, 128, 0, 8},
                 {1, 1, 0, 1},       {16384, 128, 7, 8}, {4097, 3001, 5, 8}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        SluiceImageInfo info = image(cases[i].width, cases[i].height, SLUICE_FORMAT_R8G8B8A8_UNORM);
        VkSparseImageMemoryRequirements c = color(128, 128, info.mipLevelCount, 0, 0);
        struct slc_sparse_layout layout;
        CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
        assert_false(layout.opaque_tail);
        assert_int_equal(layout.desc.regularMipCount, cases[i].regular);
        assert_int_equal(layout.desc.packedTileCount, cases[i].packed);
        SluiceTile tile = {.mipLevel = cases[i].regular, .x = cases[i].packed - 1};
        struct slc_tile_place place = slc_sparse_layout_place(&layout, &tile);
        assert_int_equal(place.level, info.mipLevelCount - 1);
        assert_int_equal(place.x, 0);
    }
}

/* With standard layouts, packed levels have their own image. */
static void standard_layouts_count_packed_levels_by_their_texels(void **state)
{
    (void)state;
    const struct {
        uint32_t width, height, regular, packed;
        SluiceFormat format;
    } cases[] = {{1024, 1024, 3, 2, SLUICE_FORMAT_R8G8B8A8_UNORM}, /* 65536 + 16384 + ... */
                 {1000, 1000, 3, 2, SLUICE_FORMAT_R8G8B8A8_UNORM}, /* 62500 + 15376 + ... */
                 {100, 30, 0, 1, SLUICE_FORMAT_R8G8B8A8_UNORM},    /* 12000 + 3000 + ... */
                 {1, 1, 0, 1, SLUICE_FORMAT_R8G8B8A8_UNORM},
                 {1024, 1024, 2, 2, SLUICE_FORMAT_R8_UNORM},           /* 256 x 256 and less */
                 {128, 128, 1, 1, SLUICE_FORMAT_R16G16B16A16_SFLOAT}}; /* tiles of 128 x 64 */
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        SluiceImageInfo info = image(cases[i].width, cases[i].height, cases[i].format);
        struct slc_sparse_layout layout;
        CHECK_OK(slc_standard_layout_init(&layout, &info));
        assert_int_equal(layout.desc.regularMipCount, cases[i].regular);
        assert_int_equal(layout.desc.packedTileCount, cases[i].packed);
    }
}

static void regular_tile_is_where_it_says(void **state)
{
    (void)state;
    SluiceImageInfo info = image(1024, 1024, SLUICE_FORMAT_R8_UNORM);
    VkSparseImageMemoryRequirements c = color(256, 256, 11, 0, 0);
    struct slc_sparse_layout layout;
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
    SluiceTile tile = {.mipLevel = 1, .x = 1, .y = 0};
    struct slc_tile_place place = slc_sparse_layout_place(&layout, &tile);
    assert_int_equal(place.level, 1);
    assert_int_equal(place.x, 1);
    assert_int_equal(place.y, 0);
}

static void sizes_that_do_not_halve_evenly_are_told(void **state)
{
    (void)state;
    const struct {
        uint32_t width, height;
        bool uneven;
    } cases[] = {{1024, 1024, false}, {1024, 1, false}, {1000, 1000, true}, {1025, 1024, true},
                 {1024, 3, true},     {1, 1, false},    {4096, 128, false}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        SluiceImageInfo info = image(cases[i].width, cases[i].height, SLUICE_FORMAT_R8G8B8A8_UNORM);
        VkSparseImageMemoryRequirements c = color(128, 128, info.mipLevelCount, 0, 0);
        struct slc_sparse_layout layout;
        CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
        assert_int_equal(layout.uneven, cases[i].uneven);
    }
}

static void tiles_that_are_not_pages_and_images_beyond_the_space_are_refused(void **state)
{
    (void)state;
    SluiceImageInfo info = image(1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    struct slc_sparse_layout layout;
    VkSparseImageMemoryRequirements c = color(64, 64, 11, 0, 0);
    CHECK_RESULT(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE),
                 SLUICE_ERROR_UNSUPPORTED);
    c = color(128, 128, 11, 0, 0);
    CHECK_RESULT(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, small.size - 1),
                 SLUICE_ERROR_UNSUPPORTED);
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, small.size));
    VkMemoryRequirements aligned = small;
    aligned.alignment = 131072;
    CHECK_RESULT(slc_sparse_layout_init(&layout, &info, &aligned, &c, NULL, SPACE),
                 SLUICE_ERROR_UNSUPPORTED);
}

static void granularity_in_blocks_is_told_from_granularity_in_texels(void **state)
{
    (void)state;
    const struct {
        SluiceFormat format;
        VkExtent3D said, meant;
    } cases[] = {
        {SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, {128, 64, 1}, {512, 256, 1}}, /* lavapipe */
        {SLUICE_FORMAT_BC4_SNORM_BLOCK, {128, 64, 1}, {512, 256, 1}},
        {SLUICE_FORMAT_BC7_UNORM_BLOCK, {64, 64, 1}, {256, 256, 1}},
        {SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, {512, 256, 1}, {512, 256, 1}}, /* as specified */
        {SLUICE_FORMAT_BC7_SRGB_BLOCK, {256, 256, 1}, {256, 256, 1}},
        {SLUICE_FORMAT_R32G32B32A32_SFLOAT, {64, 64, 1}, {64, 64, 1}},
        {SLUICE_FORMAT_R8_UNORM, {256, 256, 1}, {256, 256, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        SluiceImageInfo info = image(4096, 4096, cases[i].format);
        VkSparseImageMemoryRequirements c =
            color(cases[i].said.width, cases[i].said.height, info.mipLevelCount, 0, 0);
        struct slc_sparse_layout layout;
        CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
        assert_int_equal(layout.desc.tileWidth, cases[i].meant.width);
        assert_int_equal(layout.desc.tileHeight, cases[i].meant.height);
        assert_int_equal(
            sluiceGetFormatRegionSize(info.format, layout.desc.tileWidth, layout.desc.tileHeight),
            SLC_TILE_SIZE);
    }
}

static void block_tiles_that_are_not_pages_are_refused(void **state)
{
    (void)state;
    SluiceImageInfo info = image(4096, 4096, SLUICE_FORMAT_BC7_UNORM_BLOCK);
    VkSparseImageMemoryRequirements c = color(128, 128, info.mipLevelCount, 0, 0);
    struct slc_sparse_layout layout;
    CHECK_RESULT(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE),
                 SLUICE_ERROR_UNSUPPORTED);
}

static void layers_of_an_array_have_tails_of_their_own_or_are_refused(void **state)
{
    (void)state;
    SluiceImageInfo info = image(1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    info.arrayLayerCount = 6;
    VkSparseImageMemoryRequirements c = color(128, 128, 3, 2 * 65536, 1 << 23);
    c.imageMipTailStride = 1 << 24;
    struct slc_sparse_layout layout;
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
    assert_int_equal(layout.tail_stride, 1 << 24);
    assert_int_equal(layout.desc.packedTileCount, 2);
    c.formatProperties.flags = VK_SPARSE_IMAGE_FORMAT_SINGLE_MIPTAIL_BIT;
    CHECK_RESULT(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE),
                 SLUICE_ERROR_UNSUPPORTED);
    info.arrayLayerCount = 1; /* then there is only one to share it */
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
    info.arrayLayerCount = 6;
    c = color(128, 128, info.mipLevelCount, 0, 0); /* no tail at all */
    c.formatProperties.flags = VK_SPARSE_IMAGE_FORMAT_SINGLE_MIPTAIL_BIT;
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, NULL, SPACE));
}

static void metadata_is_remembered(void **state)
{
    (void)state;
    SluiceImageInfo info = image(1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    VkSparseImageMemoryRequirements c = color(128, 128, 3, 65536, 0);
    VkSparseImageMemoryRequirements m = {.imageMipTailOffset = 77, .imageMipTailSize = 131072};
    struct slc_sparse_layout layout;
    CHECK_OK(slc_sparse_layout_init(&layout, &info, &small, &c, &m, SPACE));
    assert_int_equal(layout.metadata_offset, 77);
    assert_int_equal(layout.metadata_size, 131072);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_page_tail_is_one_packed_tile),
        cmocka_unit_test(many_page_tail_is_as_many_packed_tiles),
        cmocka_unit_test(image_that_is_all_tail_has_one_region),
        cmocka_unit_test(without_a_tail_levels_within_one_tile_are_packed),
        cmocka_unit_test(standard_layouts_count_packed_levels_by_their_texels),
        cmocka_unit_test(regular_tile_is_where_it_says),
        cmocka_unit_test(sizes_that_do_not_halve_evenly_are_told),
        cmocka_unit_test(tiles_that_are_not_pages_and_images_beyond_the_space_are_refused),
        cmocka_unit_test(granularity_in_blocks_is_told_from_granularity_in_texels),
        cmocka_unit_test(block_tiles_that_are_not_pages_are_refused),
        cmocka_unit_test(layers_of_an_array_have_tails_of_their_own_or_are_refused),
        cmocka_unit_test(metadata_is_remembered),
    };
    return RUN_TESTS(tests);
}
