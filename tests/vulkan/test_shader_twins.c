/* C twins of shader functions, compared with brute force: a sample marks the texels that it may
 * touch. */
#include "vulkan/shader_twins.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"
#include "vulkan/texture_entry.h"

#include <string.h>

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

static void every_pixel_is_on_the_lattice_once_in_any_64_frames(void **state)
{
    (void)state;
    for (uint32_t first = 0; first < 130; first += 13)
        for (uint32_t y = 100; y < 108; y++)
            for (uint32_t x = 33; x < 41; x++) {
                uint32_t hits = 0;
                for (uint32_t frame = first; frame < first + 64; frame++)
                    hits += slc_twin_select_lattice(x, y, frame);
                assert_int_equal(hits, 1);
            }
}

static void four_consecutive_lattice_frames_hit_four_quadrants(void **state)
{
    (void)state;
    uint32_t quadrants = 0;
    for (uint32_t frame = 8; frame < 12; frame++)
        for (uint32_t i = 0; i < 64; i++)
            if (slc_twin_select_lattice(i % 8, i / 8, frame))
                quadrants |= 1u << (i % 8 / 4 + i / 32 * 2);
    assert_int_equal(quadrants, 15);
}

/* Four visits in a row have four frame seeds, frame >> 4, so each corner is marked once. */
static void every_pixel_is_in_a_block_once_in_any_16_frames(void **state)
{
    (void)state;
    for (uint32_t first = 0; first < 40; first += 3)
        for (uint32_t y = 100; y < 116; y++)
            for (uint32_t x = 33; x < 49; x++) {
                uint32_t hits = 0, corners = 0;
                for (uint32_t frame = first; frame < first + 64; frame++) {
                    bool selected = slc_twin_select_block(x, y, frame);
                    assert_int_equal(selected, slc_twin_select_block(x & ~3u, y & ~3u, frame));
                    hits += selected && frame < first + 16;
                    corners |= selected ? 1u << (frame >> 4 & 3) : 0;
                }
                assert_int_equal(hits, 1);
                assert_int_equal(corners, 15);
            }
}

static void random_selection_decides_per_quad(void **state)
{
    (void)state;
    for (uint32_t seed = 0; seed < 50; seed++)
        for (uint32_t y = 0; y < 64; y += 2)
            for (uint32_t x = 0; x < 64; x += 2) {
                bool first = slc_twin_select_random_quad(x, y, seed, 0.25f);
                assert_int_equal(first, slc_twin_select_random_quad(x + 1, y, seed, 0.25f));
                assert_int_equal(first, slc_twin_select_random_quad(x, y + 1, seed, 0.25f));
                assert_int_equal(first, slc_twin_select_random_quad(x + 1, y + 1, seed, 0.25f));
            }
}

/* 256 x 256 quads x 16 seeds are a million draws: five standard deviations are 5 sqrt(n p q). */
static void random_selection_has_its_probability_and_no_memory(void **state)
{
    (void)state;
    const float probabilities[] = {0.5f, 0.25f, 0.0625f, 0.015625f, 0.005f};
    for (size_t p = 0; p < sizeof probabilities / sizeof probabilities[0]; p++) {
        double hits = 0, twice = 0, beside = 0, n = 256.0 * 256 * 16;
        for (uint32_t seed = 0; seed < 16; seed++)
            for (uint32_t y = 0; y < 256; y++)
                for (uint32_t x = 0; x < 256; x++) {
                    bool hit = slc_twin_select_random_quad(2 * x, 2 * y, seed, probabilities[p]);
                    hits += hit;
                    twice += hit &&
                             slc_twin_select_random_quad(2 * x, 2 * y, seed + 1, probabilities[p]);
                    beside += hit &&
                              slc_twin_select_random_quad(2 * x + 2, 2 * y, seed, probabilities[p]);
                }
        double e = n * (double)probabilities[p], e2 = e * (double)probabilities[p];
        assert_true(fabs(hits - e) < 5 * sqrt(e));
        assert_true(fabs(twice - e2) < 5 * sqrt(e2));
        assert_true(fabs(beside - e2) < 5 * sqrt(e2));
    }
}

static void probability_beyond_its_ends_is_never_or_always(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 1000; i++) {
        assert_true(slc_twin_select_random_quad(i, 7, i, 1.0f));
        assert_true(slc_twin_select_random_quad(i, 7, i, INFINITY));
        assert_false(slc_twin_select_random_quad(i, 7, i, 0.0f));
        assert_false(slc_twin_select_random_quad(i, 7, i, -1.0f));
        assert_false(slc_twin_select_random_quad(i, 7, i, NAN));
    }
}

static const float extremes[] = {0.0f,    -0.0f,    1e-45f,    1e-38f, 1e-20f,   1.0f,
                                 -1.0f,   1e6f,     -1e6f,     1e18f,  1e30f,    -1e30f,
                                 3.4e38f, INFINITY, -INFINITY, NAN,    0.999999f};
#define EXTREMES (sizeof extremes / sizeof extremes[0])

static void lod_is_finite_whatever_the_arguments(void **state)
{
    (void)state;
    for (size_t i = 0; i < EXTREMES; i++)
        for (size_t j = 0; j < EXTREMES; j++)
            for (size_t k = 0; k < EXTREMES; k++) {
                struct slc_twin_vec2 a = {extremes[i], extremes[j]}, b = {extremes[k], 1.0f};
                float lod = slc_twin_compute_lod(a, b, extremes[k], extremes[i]);
                assert_true(lod >= -32.0f && lod <= 32.0f);
                assert_true(slc_twin_finest_level(lod, 0.125f, 15) < 15);
                assert_true(slc_twin_coarsest_level(lod, 1) == 0);
            }
}

static void lod_follows_the_longer_axis_up_to_the_anisotropy(void **state)
{
    (void)state;
    struct slc_twin_vec2 long_axis = {16, 0}, short_axis = {0, 2};
    assert_float_equal(slc_twin_compute_lod(long_axis, short_axis, 0, 1), 4, 1e-5);
    assert_float_equal(slc_twin_compute_lod(short_axis, long_axis, 0, 4), 2, 1e-5);
    assert_float_equal(slc_twin_compute_lod(long_axis, short_axis, 0, 8), 1, 1e-5);
    assert_float_equal(slc_twin_compute_lod(long_axis, short_axis, 0, 16), 1, 1e-5);
    assert_float_equal(slc_twin_compute_lod(long_axis, short_axis, -1.5f, 16), -0.5, 1e-5);
}

static struct SluiceTextureEntry entry(uint32_t width, uint32_t height, uint32_t tile_width,
                                       uint32_t tile_height)
{
    struct SluiceTextureEntry e = {.width = width,
                                   .height = height,
                                   .mipLevelCount = slc_mip_count(slc_max_u32(width, height)),
                                   .regionWidth = tile_width,
                                   .regionHeight = tile_height,
                                   .regionCountX = slc_div_up_u32(width, tile_width),
                                   .regionCountY = slc_div_up_u32(height, tile_height)};
    while (slc_mip_size(width, e.regularMipCount) > tile_width ||
           slc_mip_size(height, e.regularMipCount) > tile_height)
        e.regularMipCount++;
    for (uint32_t l = 1; l < e.mipLevelCount; l++)
        if ((slc_mip_size(width, l) * 2 != slc_mip_size(width, l - 1) &&
             slc_mip_size(width, l - 1) > 1) ||
            (slc_mip_size(height, l) * 2 != slc_mip_size(height, l - 1) &&
             slc_mip_size(height, l - 1) > 1))
            e.flags |= SLUICE_TEXTURE_FLAG_UNEVEN;
    return e;
}

static void region_is_inside_the_map_whatever_the_coordinate(void **state)
{
    (void)state;
    for (uint32_t mode = 0; mode <= 4; mode++)
        for (size_t i = 0; i < EXTREMES; i++)
            for (size_t j = 0; j < EXTREMES; j++) {
                struct SluiceTextureEntry e = entry(1000, 130, 128, 128);
                e.addressModeU = e.addressModeV = mode;
                struct slc_twin_vec2 uv = {extremes[i], extremes[j]},
                                     d = {extremes[j], extremes[i]};
                struct slc_twin_wants w = slc_twin_wants(&e, uv, d, d, 0, extremes[i]);
                assert_true(w.regions.first[0] < 8 && w.regions.last[0] < 8);
                assert_true(w.regions.first[1] < 2 && w.regions.last[1] < 2);
                assert_true(w.level < e.mipLevelCount);
            }
}

/* Texel that a tap at integer position t reads; -1 for the border's. */
static int64_t address(int64_t t, int64_t size, uint32_t mode)
{
    switch (mode) {
    case SLUICE_ADDRESS_MODE_REPEAT: return ((t % size) + size) % size;
    case SLUICE_ADDRESS_MODE_MIRRORED_REPEAT: {
        int64_t m = ((t % (2 * size)) + 2 * size) % (2 * size);
        return m < size ? m : 2 * size - 1 - m;
    }
    case SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER: return t < 0 || t >= size ? -1 : t;
    case SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE: t = t < 0 ? -1 - t : t; break;
    }
    return t < 0 ? 0 : t >= size ? size - 1 : t;
}

/* The tile column of `level` over a region's column, as the manager finds it. */
static uint32_t column_of_region(uint32_t region, uint32_t size, uint32_t tile, uint32_t level)
{
    for (uint32_t l = 1; l <= level; l++) {
        uint32_t last = slc_div_up_u32(slc_mip_size(size, l), tile) - 1;
        region = slc_min_u32(region >> 1, last);
    }
    return region;
}

/* The regions of an axis that are looked at. */
struct columns {
    uint32_t count, at[80];
};

static struct columns columns_of(const struct slc_twin_footprint *f, int axis, uint32_t last,
                                 uint32_t level)
{
    uint32_t end = f->last[axis], step = slc_twin_range_step(f->first[axis], end, last, level);
    struct columns c = {1, {f->first[axis]}};
    while (c.at[c.count - 1] != end) {
        assert_true(c.count < 80);
        c.at[c.count] = slc_twin_next_region(c.at[c.count - 1], end, last, step);
        c.count++;
    }
    return c;
}

/* Returns whether every tap of a linear filter at `u` is in a tile of `level` over one of the
 * regions. */
static bool axis_is_covered(double u, uint32_t size, uint32_t tile, uint32_t level, uint32_t mode,
                            const struct columns *columns)
{
    uint32_t level_size = slc_mip_size(size, level);
    int64_t first = (int64_t)floor(u * level_size - 0.5);
    for (int64_t t = first; t <= first + 1; t++) {
        int64_t texel = address(t, level_size, mode);
        if (texel < 0)
            continue;
        bool found = false;
        for (uint32_t i = 0; i < columns->count; i++)
            found |= column_of_region(columns->at[i], size, tile, level) == (uint32_t)texel / tile;
        if (!found)
            return false;
    }
    return true;
}

static double random_coordinate(uint32_t size, uint32_t tile)
{
    double u;
    switch (roll() % 5) {
    case 0: u = draw(); break;
    case 1: u = (roll() % (int)(size / tile + 2)) * (double)tile / size; break; /* tile border */
    case 2: u = roll() % 2; break;                                              /* image border */
    case 3: u = draw() * 6 - 3; break;
    default: u = (roll() % (int)size + 0.5) / size; break; /* texel center */
    }
    return u + (draw() - 0.5) * (roll() % 3) / size;
}

/* required <= marked, with every level that the sampler may choose and taps along the long axis. */
static void check_random_samples(uint32_t width, uint32_t height, uint32_t tile_width,
                                 uint32_t tile_height, int samples)
{
    struct SluiceTextureEntry e = entry(width, height, tile_width, tile_height);
    for (int i = 0; i < samples; i++) {
        e.addressModeU = (uint32_t)roll() % 5;
        e.addressModeV = (uint32_t)roll() % 5;
        float anisotropy = roll() % 2 ? 1.0f : 8.0f, bias = (float)(roll() % 3 - 1) * 0.7f;
        double scale = exp2(draw() * (e.mipLevelCount + 1) - 1), angle = draw() * 6.283;
        double ratio = 1 + draw() * 12;
        struct slc_twin_vec2 uv = {(float)random_coordinate(width, tile_width),
                                   (float)random_coordinate(height, tile_height)};
        struct slc_twin_vec2 dx = {(float)(cos(angle) * scale / width),
                                   (float)(sin(angle) * scale / height)};
        struct slc_twin_vec2 dy = {(float)(-sin(angle) * scale * ratio / width),
                                   (float)(cos(angle) * scale * ratio / height)};
        struct slc_twin_wants w = slc_twin_wants(&e, uv, dx, dy, bias, anisotropy);
        struct slc_twin_vec2 tx = {dx.x * (float)width, dx.y * (float)height};
        struct slc_twin_vec2 ty = {dy.x * (float)width, dy.y * (float)height};
        float lod = slc_twin_compute_lod(tx, ty, bias, anisotropy);
        uint32_t coarsest = slc_twin_coarsest_level(lod, e.mipLevelCount);
        const struct columns xs = columns_of(&w.regions, 0, e.regionCountX - 1, w.level);
        const struct columns ys = columns_of(&w.regions, 1, e.regionCountY - 1, w.level);
        for (uint32_t level = w.level; level <= coarsest && level < e.regularMipCount; level++)
            for (int tap = anisotropy > 1 ? -8 : 0; tap <= (anisotropy > 1 ? 8 : 0); tap++) {
                double at = tap / 16.0; /* dy is the longer one */
                bool covered = axis_is_covered((double)uv.x + at * (double)dy.x, width, tile_width,
                                               level, e.addressModeU, &xs) &&
                               axis_is_covered((double)uv.y + at * (double)dy.y, height,
                                               tile_height, level, e.addressModeV, &ys);
                if (!covered)
                    fail_msg("%ux%u level %u of %u (lod %g): uv %.9g %.9g, modes %u %u, tap %d",
                             width, height, level, w.level, (double)lod, (double)uv.x, (double)uv.y,
                             e.addressModeU, e.addressModeV, tap);
            }
    }
}

static void what_a_sample_may_touch_is_marked(void **state)
{
    (void)state;
    roll_seed(11);
    check_random_samples(1024, 1024, 128, 128, 40000);
    check_random_samples(1000, 1000, 128, 128, 40000);
    check_random_samples(1025, 513, 128, 128, 40000);
    check_random_samples(129, 257, 64, 64, 40000);
    check_random_samples(4097, 3001, 256, 128, 40000);
    check_random_samples(2048, 1, 128, 128, 20000);
    check_random_samples(1, 2053, 64, 64, 20000);
    check_random_samples(16384, 200, 256, 256, 20000);
    check_random_samples(8191, 8191, 64, 64, 40000);
}

/* 384x384 with 8 levels halves evenly, and its three columns are no mask. */
static void only_powers_of_two_have_quick_shapes(void **state)
{
    (void)state;
    for (uint32_t width = 1; width <= 1024; width += width < 70 ? 1 : 61)
        for (uint32_t height = 1; height <= 512; height += 37) {
            struct SluiceTextureEntry e = entry(width, height, 64, 32);
            e.flags = 0;
            slc_texture_entry_complete(&e);
            bool powers = (width & (width - 1)) == 0 && (height & (height - 1)) == 0;
            assert_int_equal((e.shape & SLUICE_SHAPE_QUICK) != 0, powers);
            assert_true(!powers || ((e.regionLastX & (e.regionLastX + 1)) == 0 &&
                                    (e.regionLastY & (e.regionLastY + 1)) == 0));
        }
}

/* Marks by exponents, demands by logarithms: at steps of levels, too, marks must not be the less.
 */
static void marked_levels_enclose_those_that_are_sampled(void **state)
{
    (void)state;
    for (int lod = -2; lod < 12; lod++)
        for (int eighths = -40; eighths <= 40; eighths++)
            for (int ulps = -2; ulps <= 2; ulps++)
                for (int n = 1; n <= 16; n *= 2) {
                    float d = ldexpf(1.0f + (float)ulps * 1.2e-7f, lod), bias = (float)eighths / 8;
                    struct slc_twin_vec2 dx = {d, 0}, dy = {0, d * (float)(n > 4 ? 4 : 1)},
                                         uv = {0, 0};
                    struct slc_twin_levels marked = slc_twin_quick_levels(
                        slc_twin_square_lods(dx, dy, (float)n), bias, (float)n, 15);
                    struct slc_twin_levels sampled =
                        slc_twin_safe_levels(uv, dx, dy, bias, (float)n, 15);
                    assert_true(marked.level <= sampled.level);
                    assert_true(marked.coarsest >= sampled.coarsest);
                    assert_true(marked.widest >= sampled.widest);
                }
}

static void one_region_is_marked_far_from_its_border(void **state)
{
    (void)state;
    struct SluiceTextureEntry e = entry(1024, 1024, 128, 128);
    struct slc_twin_vec2 d = {1.0f / 1024, 0}, t = {0, 1.0f / 1024};
    for (int i = 2; i < 126; i++) {
        struct slc_twin_vec2 uv = {(3 * 128 + (float)i) / 1024, (5 * 128 + (float)i) / 1024};
        struct slc_twin_wants w = slc_twin_wants(&e, uv, d, t, 0, 1);
        assert_int_equal(w.level, 0);
        const uint32_t region[2] = {3, 5};
        assert_memory_equal(w.regions.first, region, sizeof region);
        assert_memory_equal(w.regions.last, region, sizeof region);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pixel_is_on_the_lattice_once_in_any_64_frames),
        cmocka_unit_test(four_consecutive_lattice_frames_hit_four_quadrants),
        cmocka_unit_test(every_pixel_is_in_a_block_once_in_any_16_frames),
        cmocka_unit_test(random_selection_decides_per_quad),
        cmocka_unit_test(random_selection_has_its_probability_and_no_memory),
        cmocka_unit_test(probability_beyond_its_ends_is_never_or_always),
        cmocka_unit_test(lod_is_finite_whatever_the_arguments),
        cmocka_unit_test(lod_follows_the_longer_axis_up_to_the_anisotropy),
        cmocka_unit_test(region_is_inside_the_map_whatever_the_coordinate),
        cmocka_unit_test(what_a_sample_may_touch_is_marked),
        cmocka_unit_test(only_powers_of_two_have_quick_shapes),
        cmocka_unit_test(marked_levels_enclose_those_that_are_sampled),
        cmocka_unit_test(one_region_is_marked_far_from_its_border),
    };
    return RUN_TESTS(tests);
}
