#include "vulkan/packed_units.h"

#include "base/alloc.h"
#include "image/format_size.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SLOT = 65536 };

static const SluiceFormatInfo texel = {sizeof texel, 4, 1, 1, 4};

/* Every texel of every packed level is in exactly one rectangle, and no two share slot bytes. */
static void check(uint32_t width, uint32_t height, uint32_t regular, SluiceFormat format)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetFormatInfo(format, &info));
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    SluiceStreamedTextureDesc desc = {.width = width,
                                      .height = height,
                                      .mipLevelCount = slc_mip_count(slc_max_u32(width, height)),
                                      .regularMipCount = regular};
    struct slc_packed_units packed;
    CHECK_OK(slc_packed_units_init(&packed, &cb, &desc, &info, SLOT));
    uint32_t rect = 0;
    for (uint32_t u = 0; u < packed.unit_count; u++) {
        uint32_t end = 0;
        assert_int_equal(packed.units[u].first_rect, rect);
        assert_true(packed.units[u].rect_count > 0);
        assert_true(packed.units[u].rect_count <= SLUICE_MAX_READ_REGIONS);
        for (uint32_t i = 0; i < packed.units[u].rect_count; i++, rect++) {
            const struct slc_packed_rect *r = &packed.rects[rect];
            assert_true(r->offset >= end && r->offset % SLC_STAGING_ALIGNMENT == 0);
            assert_true(r->region.x % info.blockWidth == 0 && r->region.y % info.blockHeight == 0);
            end = r->offset +
                  (uint32_t)sluiceGetFormatRegionSize(format, r->region.width, r->region.height);
            assert_true(end <= SLOT);
        }
    }
    assert_int_equal(rect, packed.rect_count);
    for (uint32_t level = regular; level < desc.mipLevelCount; level++) {
        uint32_t w = slc_mip_size(width, level), h = slc_mip_size(height, level);
        uint8_t *seen = calloc(w, h);
        for (uint32_t i = 0; i < packed.rect_count; i++) {
            const SluiceImageRegion *r = &packed.rects[i].region;
            if (r->mipLevel != level)
                continue;
            assert_true(r->x + r->width <= w && r->y + r->height <= h);
            for (uint32_t y = r->y; y < r->y + r->height; y++)
                for (uint32_t x = r->x; x < r->x + r->width; x++)
                    assert_int_equal(seen[(size_t)y * w + x]++, 0);
        }
        assert_null(memchr(seen, 0, (size_t)w * h));
        free(seen);
    }
    slc_packed_units_finish(&packed, &cb);
}

static void every_texel_is_read_once(void **state)
{
    (void)state;
    check(128, 128, 0, SLUICE_FORMAT_R8G8B8A8_UNORM);
    check(1000, 1000, 3, SLUICE_FORMAT_R8G8B8A8_UNORM);
    check(1, 1, 0, SLUICE_FORMAT_R32G32B32A32_SFLOAT);
    check(16384, 128, 1, SLUICE_FORMAT_R8G8B8A8_UNORM);
    check(16384, 3, 0, SLUICE_FORMAT_R32G32B32A32_SFLOAT);
    check(3, 16384, 0, SLUICE_FORMAT_R32G32B32A32_SFLOAT);
    check(12345, 67, 2, SLUICE_FORMAT_R16G16B16A16_SFLOAT);
    check(65536, 1, 3, SLUICE_FORMAT_R8_UNORM);
    check(16384, 128, 0, SLUICE_FORMAT_BC7_UNORM_BLOCK);
    check(4099, 3001, 1, SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK);
    check(65537, 5, 0, SLUICE_FORMAT_BC3_SRGB_BLOCK);
    check(1, 1, 0, SLUICE_FORMAT_BC4_UNORM_BLOCK);
}

static void small_levels_share_a_unit(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    SluiceStreamedTextureDesc desc = {
        .width = 1024, .height = 1024, .mipLevelCount = 11, .regularMipCount = 3};
    struct slc_packed_units packed;
    CHECK_OK(slc_packed_units_init(&packed, &cb, &desc, &texel, SLOT));
    assert_int_equal(packed.unit_count, 2); /* 128x128 fills one, the other seven levels one more */
    slc_packed_units_finish(&packed, &cb);
}

static void creation_survives_every_allocation_failure(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = {.width = 64, .height = 64, .mipLevelCount = 7};
    for (uint64_t n = 0;; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_packed_units packed;
        SluiceResult result = slc_packed_units_init(&packed, &a.callbacks, &desc, &texel, SLOT);
        if (result == SLUICE_SUCCESS)
            slc_packed_units_finish(&packed, &a.callbacks);
        assert_int_equal(a.live_count, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_is_read_once),
        cmocka_unit_test(small_levels_share_a_unit),
        cmocka_unit_test(creation_survives_every_allocation_failure),
    };
    return RUN_TESTS(tests);
}
