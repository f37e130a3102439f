/* slc_around against a search of every neighbor of each region of a MinMip map. */
#include "support/roll.h"
#include "support/test.h"
#include "vulkan/around.h"

#define MOST 40u

static bool has(int64_t at, uint32_t count, bool wraps)
{
    return wraps || (at >= 0 && at < count);
}

static uint32_t wrap(int64_t at, uint32_t count)
{
    return (uint32_t)((at % (int64_t)count + (int64_t)count) % (int64_t)count);
}

static uint32_t look(const struct slc_around *a, uint32_t x, uint32_t y)
{
    uint32_t most = 0, own = a->texels[y * a->width + x];
    int r = (int)a->radius;
    for (int dy = -r; dy <= r; dy++)
        for (int dx = -r; dx <= r; dx++) {
            int64_t cx = (int64_t)x + dx, cy = (int64_t)y + dy;
            if (!has(cx, a->width, a->wraps_x) || !has(cy, a->height, a->wraps_y))
                continue;
            uint32_t texel = a->texels[wrap(cy, a->height) * a->width + wrap(cx, a->width)];
            most = texel > most ? texel : most;
        }
    return own | most << 16;
}

static void check_map(uint32_t width, uint32_t height, uint32_t radius, uint32_t wraps)
{
    static uint16_t texels[MOST * MOST], scratch[2 * (MOST + SLC_MAX_AROUND) + 1];
    static uint32_t words[MOST + 1];
    for (uint32_t i = 0; i < width * height; i++)
        texels[i] = (uint16_t)(roll() % 4 ? roll() % 3 : roll());
    struct slc_around a = {texels, width, height, radius, wraps & 1, wraps >> 1 & 1};
    scratch[2 * (width + radius)] = 0x5A5A;
    for (uint32_t y = 0; y < height; y++) {
        words[width] = 0xDEADBEEF;
        slc_around_row(&a, y, scratch, words);
        for (uint32_t x = 0; x < width; x++)
            if (words[x] != look(&a, x, y))
                fail_msg("%ux%u radius %u wraps %u: (%u, %u) is %x, not %x", width, height, radius,
                         wraps, x, y, words[x], look(&a, x, y));
        assert_int_equal(words[width], 0xDEADBEEF);
        assert_int_equal(scratch[2 * (width + radius)], 0x5A5A);
    }
}

static void words_hold_the_largest_texel_around(void **state)
{
    (void)state;
    roll_seed(1);
    for (uint32_t wraps = 0; wraps < 4; wraps++)
        for (uint32_t radius = 1; radius <= SLC_MAX_AROUND; radius++) {
            for (uint32_t height = 1; height <= 6; height++)
                for (uint32_t width = 1; width <= 6; width++)
                    check_map(width, height, radius, wraps);
            check_map(MOST, 17, radius, wraps);
            check_map(17, MOST, radius, wraps);
            check_map(1, MOST, radius, wraps);
            check_map(MOST, 1, radius, wraps);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(words_hold_the_largest_texel_around)};
    return RUN_TESTS(tests);
}
