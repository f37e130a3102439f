/*
 * Compares marks of samples with brute force: required tiles are marked, and marked tiles are
 * allowed. Prints the number of marked tiles beyond the required ones.
 */
#include "device/suite.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

static const double offsets[] = {-4,
                                 -1,
                                 -0.5 - 1.0 / 64,
                                 -0.5 - 1.0 / 512,
                                 -0.5,
                                 -0.5 + 1.0 / 512,
                                 -0.5 + 1.0 / 64,
                                 -1.0 / 512,
                                 0,
                                 1.0 / 512,
                                 0.5 - 1.0 / 64,
                                 0.5 - 1.0 / 512,
                                 0.5,
                                 0.5 + 1.0 / 512,
                                 0.5 + 1.0 / 64,
                                 1,
                                 4};
#define OFFSETS (sizeof offsets / sizeof offsets[0])

/*
 * Samples beside every border of every level, along both axes and in the corners. At this level
 * only, or with a half step at this one and the next.
 */
static void add_borders(struct suite *s, struct SluiceTextureEntry e, double step, bool anisotropic)
{
    for (uint32_t l = 0; l < e.mipLevelCount; l++) {
        double w = e.width >> l ? e.width >> l : 1, h = e.height >> l ? e.height >> l : 1;
        for (uint32_t b = 0; b * e.regionWidth <= w; b++)
            for (uint32_t i = 0; i < OFFSETS; i++) {
                struct ConformInput in = suite_level_input(&e, l - step);
                double reach = 0;
                if (anisotropic) {
                    in.maxAnisotropy = (float)(2u << (i + b + l) % 4);
                    in.dx[0] *= in.maxAnisotropy;
                    reach = (i % 2 ? 0.5 : -0.5) * (double)in.maxAnisotropy * exp2(-step);
                }
                double at = (b * e.regionWidth + offsets[i] + reach) / w;
                double other = (b * e.regionHeight + offsets[(i * 7) % OFFSETS]) / h;
                suite_add(s, e, in, at, 0.37);
                suite_add(s, e, in, at, other);
                if (!anisotropic)
                    suite_add(s, e, in, 0.61, other);
            }
    }
}

static const double level_steps[] = {0, 0.5};

static void point_footprints_find_their_tiles_at_borders(void **state)
{
    struct suite *s = suite_begin(*state);
    s->filter = (struct oracle_filter){.nearest = true};
    for (uint32_t i = 0; i < 2 * SUITE_MODES; i++)
        add_borders(s, conform_entry(256, 256, 64, 64, suite_modes[i / 2]), level_steps[i % 2],
                    false);
    suite_end(s, "point_border");
}

static void linear_footprints_find_their_tiles_at_borders(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t i = 0; i < 2 * SUITE_MODES; i++) {
        uint32_t mode = suite_modes[i / 2];
        add_borders(s, conform_entry(256, 256, 64, 64, mode), level_steps[i % 2], false);
        add_borders(s, conform_entry(512, 256, 128, 64, mode), level_steps[i % 2], false);
        add_borders(s, conform_entry(200, 300, 32, 64, mode), level_steps[i % 2], false);
    }
    suite_end(s, "linear_border");
}

/* Sizes whose levels are rounded down repeatedly: tiles are farthest from their regions. */
static void linear_footprints_of_uneven_sizes_find_their_tiles_at_borders(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t i = 0; i < 2 * SUITE_MODES; i++) {
        uint32_t mode = suite_modes[i / 2];
        add_borders(s, conform_entry(255, 127, 8, 8, mode), level_steps[i % 2], false);
        add_borders(s, conform_entry(511, 1023, 32, 64, mode), level_steps[i % 2], false);
    }
    suite_end(s, "uneven_border");
}

static void anisotropic_footprints_find_their_tiles_at_borders(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t i = 0; i < 2 * SUITE_MODES; i++) {
        add_borders(s, conform_entry(512, 512, 64, 64, suite_modes[i / 2]), level_steps[i % 2],
                    true);
        add_borders(s, conform_entry(600, 500, 128, 128, suite_modes[i / 2]), level_steps[i % 2],
                    true);
    }
    suite_end(s, "anisotropic_border");
}

/* The second level appears at a fraction of 1/256, on devices with 8 bits of it. */
static void levels_at_a_fraction_find_their_tiles(void **state)
{
    const double fractions[] = {-1.0 / 256,    -0.5 / 256,    0,    0.5 / 256, 1.0 / 256, 1.5 / 256,
                                0.12,          0.125,         0.13, 0.1875,    0.5,       0.99,
                                1 - 1.0 / 256, 1 - 0.5 / 256, 1.0};
    struct suite *s = suite_begin(*state);
    s->filter.lod_quantum = 1.0 / 256;
    for (uint32_t a = 0; a < 3; a++)
        for (uint32_t m = 0; m < SUITE_MODES; m++) {
            struct SluiceTextureEntry e = conform_entry(512, 512, 64, 64, suite_modes[m]);
            for (uint32_t l = 0; l < e.mipLevelCount; l++)
                for (uint32_t i = 0; i < sizeof fractions / sizeof fractions[0]; i++) {
                    struct ConformInput in = suite_level_input(&e, l + fractions[i]);
                    in.maxAnisotropy = a == 2 ? 4 : 1;
                    in.mode = a == 1 ? CONFORM_LOD : CONFORM_GRAD;
                    in.lod = (float)(l + fractions[i]);
                    double texel = exp2(l) / 512;
                    suite_add(s, e, in, 0.5 - 0.75 * texel, 0.25 + 0.75 * texel);
                    suite_add(s, e, in, 0.55, 0.55);
                    suite_add(s, e, in, 0.75 + 0.6 * texel, 1 - 0.4 * texel);
                }
        }
    suite_end(s, "fraction");
}

/* Samplers may choose finer levels than the formula: up to 0.12 levels was measured. */
static void samplers_a_little_finer_find_their_tiles(void **state)
{
    struct suite *s = suite_begin(*state);
    s->filter.lod_offset = -0.12;
    for (uint32_t m = 0; m < SUITE_MODES; m++) {
        struct SluiceTextureEntry e = conform_entry(500, 512, 64, 32, suite_modes[m]);
        for (double lod = 0; lod < 9; lod += 0.04)
            for (int i = 0; i < 4; i++) {
                struct ConformInput in = suite_level_input(&e, lod);
                suite_add(s, e, in, 0.5 + 0.13 * i, 0.21 * i);
                in.maxAnisotropy = 8;
                in.dx[0] *= 8;
                suite_add(s, e, in, 0.5 + 0.13 * i, 0.21 * i);
            }
    }
    suite_end(s, "finer_sampler");
}

static void biases_at_both_ends_of_the_chain_are_clamped(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t m = 0; m < SUITE_MODES; m++) {
        struct SluiceTextureEntry e = conform_entry(256, 512, 64, 64, suite_modes[m]);
        for (int l = -1; l <= (int)e.mipLevelCount; l++)
            for (int b = -48; b <= 48; b++) {
                struct ConformInput in = suite_level_input(&e, l);
                /* sixteenths up to 1, then whole levels, far beyond the chain */
                in.lodBias = abs(b) <= 16 ? (float)b / 16 : (float)(b > 0 ? b - 15 : b + 15);
                suite_add(s, e, in, 0.49 + 0.002 * b, 0.7);
            }
    }
    suite_end(s, "bias");
}

static void add_biased(struct suite *s)
{
    for (uint32_t m = 0; m < SUITE_MODES; m++) {
        struct SluiceTextureEntry e = conform_entry(2048, 1024, 64, 64, suite_modes[m]);
        for (int l = 0; l < 9; l++)
            for (int b = -16; b <= 8; b++)
                for (int n = 2; n <= 16; n *= 2) {
                    struct ConformInput in = suite_level_input(&e, l);
                    in.lodBias = (float)b / 4;
                    in.maxAnisotropy = (float)n;
                    in.dx[0] *= (float)n;
                    suite_add(s, e, in, 0.49 + 0.02 * b, 0.7);
                    in = suite_level_input(&e, l);
                    in.lodBias = (float)b / 4;
                    in.maxAnisotropy = (float)n;
                    in.dy[1] *= (float)n;
                    in.dy[0] = in.dy[1] * 0.6f;
                    suite_add(s, e, in, 0.49 + 0.02 * b, 0.7);
                }
    }
}

/* The bias moves the level. On some devices the length of the footprint does not change. */
static void anisotropic_footprints_with_a_bias_find_their_tiles(void **state)
{
    struct suite *s = suite_begin(*state);
    add_biased(s);
    suite_end(s, "anisotropic_bias");
}

static void anisotropic_footprints_that_grow_with_a_bias_find_their_tiles(void **state)
{
    struct suite *s = suite_begin(*state);
    s->filter.bias_scales = true;
    add_biased(s);
    suite_end(s, "anisotropic_bias_scaled");
}

/* Nearly parallel derivatives: the ellipse is narrow and long, but the lengths suggest a wide
 * footprint. */
static void add_skewed(struct suite *s)
{
    roll_seed(71);
    for (uint32_t i = 0; i < 8192; i++) {
        struct SluiceTextureEntry e = conform_entry(512, 512, 64, 64, suite_modes[i % SUITE_MODES]);
        double angle = 6.2832 * roll() / ROLL_MAX, turn = 0.3 * roll() / ROLL_MAX;
        double length = exp2(7.0 * roll() / ROLL_MAX) / 512, ratio = exp2(2.0 * roll() / ROLL_MAX);
        struct ConformInput in = {
            .dx = {(float)(cos(angle) * length), (float)(sin(angle) * length)},
            .dy = {(float)(cos(angle + turn) * length * ratio),
                   (float)(sin(angle + turn) * length * ratio)},
            .maxAnisotropy = (float)(1 << roll() % 5)};
        double border = 64.0 * (roll() % 9) / 512,
               away = 3 * length * (2.0 * roll() / ROLL_MAX - 1);
        suite_add(s, e, in, border + away, (double)roll() / ROLL_MAX);
    }
}

static void skewed_footprints_find_their_tiles_by_the_lengths(void **state)
{
    struct suite *s = suite_begin(*state);
    add_skewed(s);
    suite_end(s, "skewed");
}

static void skewed_footprints_find_their_tiles_by_the_ellipse(void **state)
{
    struct suite *s = suite_begin(*state);
    s->filter.by_ellipse = true;
    add_skewed(s);
    suite_end(s, "skewed_ellipse");
}

static void samplers_a_little_coarser_find_their_tiles_by_the_ellipse(void **state)
{
    struct suite *s = suite_begin(*state);
    s->filter.by_ellipse = true;
    s->filter.lod_offset = 0.12;
    add_skewed(s);
    suite_end(s, "skewed_coarser");
}

/* Without derivatives the sample is at level 0; with large ones at the last level of one texel. */
static void levels_beyond_the_chain_are_its_ends(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t m = 0; m < SUITE_MODES; m++)
        for (uint32_t size = 1; size <= 4096; size *= 4) {
            struct SluiceTextureEntry e = conform_entry(size, size, 128, 128, suite_modes[m]);
            for (double lod = -60; lod <= 60; lod += 3.5)
                for (int n = 1; n <= 16; n *= 4) {
                    struct ConformInput in = suite_level_input(&e, lod);
                    in.maxAnisotropy = (float)n;
                    suite_add(s, e, in, 0.3, 0.6);
                    in.mode = CONFORM_LOD;
                    in.lod = (float)lod;
                    suite_add(s, e, in, 0.3, 0.6);
                }
            struct ConformInput none = {.maxAnisotropy = 1};
            suite_add(s, e, none, 0.3, 0.6);
            none.maxAnisotropy = 16;
            suite_add(s, e, none, 0.3, 0.6);
        }
    suite_end(s, "chain_ends");
}

/* An irregular grid at all levels. */
static void add_grid(struct suite *s, struct SluiceTextureEntry e, uint32_t steps, double lod_step)
{
    for (double lod = 0; lod <= e.mipLevelCount; lod += lod_step)
        for (uint32_t y = 0; y <= steps; y++)
            for (uint32_t x = 0; x <= steps; x++) {
                struct ConformInput in = suite_level_input(&e, lod);
                in.mode = (x + y) % 4 == 0 ? CONFORM_LOD : CONFORM_GRAD;
                in.lod = (float)lod;
                suite_add(s, e, in, (double)x / steps, (double)y / steps);
            }
}

static void sizes_that_do_not_halve_evenly_find_their_tiles(void **state)
{
    const uint32_t sizes[][4] = {
        {15, 15, 4, 4},         {17, 17, 8, 8},         {15, 17, 4, 8},
        {100, 100, 32, 32},     {100, 100, 16, 4},      {1025, 1025, 128, 128},
        {4100, 4100, 128, 128}, {4100, 1025, 256, 128}, {511, 513, 64, 64}};
    struct suite *s = suite_begin(*state);
    for (uint32_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (uint32_t m = 0; m < SUITE_MODES; m++)
            add_grid(
                s,
                conform_entry(sizes[i][0], sizes[i][1], sizes[i][2], sizes[i][3], suite_modes[m]),
                7, 1.1);
    suite_end(s, "uneven");
}

/* A tile of level 1 may cover three regions in each direction. */
static void level_1_of_odd_sizes_finds_its_tiles_at_every_border(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t size = 257; size <= 511; size += 18)
        for (uint32_t m = 0; m < SUITE_MODES; m++) {
            struct SluiceTextureEntry e = conform_entry(size, size + 1, 32, 32, suite_modes[m]);
            for (uint32_t texel = 0; texel < size / 2; texel++) {
                struct ConformInput in = suite_level_input(&e, 1);
                if (texel % 32 < 2 || texel % 32 > 29)
                    suite_add(s, e, in, (texel + 0.5) / (size / 2), (texel + 0.25) / (size / 2));
            }
        }
    suite_end(s, "three_by_three");
}

static void textures_one_texel_wide_find_their_tiles(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t m = 0; m < SUITE_MODES; m++) {
        add_grid(s, conform_entry(1, 1000, 128, 128, suite_modes[m]), 9, 0.7);
        add_grid(s, conform_entry(4096, 1, 256, 64, suite_modes[m]), 9, 0.7);
        add_grid(s, conform_entry(1, 1, 128, 128, suite_modes[m]), 9, 0.7);
        add_grid(s, conform_entry(2, 3, 128, 128, suite_modes[m]), 9, 0.7);
    }
    suite_end(s, "one_texel");
}

/* Levels of one tile are requested by their own numbers, down to the last. */
static void tail_levels_are_marked_as_they_are(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t m = 0; m < SUITE_MODES; m++) {
        add_grid(s, conform_entry(1024, 1024, 16, 16, suite_modes[m]), 7, 1);
        add_grid(s, conform_entry(64, 64, 128, 128, suite_modes[m]), 7, 0.5);
    }
    suite_end(s, "tail");
}

static void the_largest_textures_find_their_tiles(void **state)
{
    struct suite *s = suite_begin(*state);
    roll_seed(72);
    for (uint32_t i = 0; i < 300; i++) {
        struct SluiceTextureEntry e =
            conform_entry(16384, i % 3 ? 16384 : 16383, 128, 128, suite_modes[i % SUITE_MODES]);
        struct ConformInput in = suite_level_input(&e, 15.0 * roll() / ROLL_MAX);
        in.maxAnisotropy = (float)(1 << roll() % 5);
        in.dx[0] *= (float)(1 + roll() % 20);
        double border = 128.0 * (roll() % 129) / 16384;
        double away = exp2(16.0 * roll() / ROLL_MAX) / 16384;
        suite_add(s, e, in, roll() % 2 ? border + away : border - away, (double)roll() / ROLL_MAX);
    }
    suite_end(s, "largest");
}

/* Positions and levels of ordinary pictures, not difficult ones. */
static void add_ordinary(struct suite *s, float anisotropy)
{
    roll_seed(73);
    for (uint32_t i = 0; i < 4000; i++) {
        struct SluiceTextureEntry e = conform_entry(4096, 4096, 128, 128, 0);
        double lod = 5.0 * roll() / ROLL_MAX, angle = 6.2832 * roll() / ROLL_MAX;
        double ratio = anisotropy > 1 ? exp2(4.0 * roll() / ROLL_MAX) : 1;
        double minor = exp2(lod) / 4096, major = minor * ratio;
        struct ConformInput in = {.dx = {(float)(cos(angle) * major), (float)(sin(angle) * major)},
                                  .dy = {(float)(-sin(angle) * minor), (float)(cos(angle) * minor)},
                                  .maxAnisotropy = anisotropy};
        suite_add(s, e, in, (double)roll() / ROLL_MAX, (double)roll() / ROLL_MAX);
    }
}

static void ordinary_samples_ask_for_little_more_than_they_need(void **state)
{
    struct suite *s = suite_begin(*state);
    add_ordinary(s, 1);
    suite_end(s, "ordinary");
    assert_true(s->excess < s->needed / 20);
    s = suite_begin(*state);
    add_ordinary(s, 8);
    suite_end(s, "ordinary_anisotropic");
    assert_true(s->excess < s->needed / 10);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(point_footprints_find_their_tiles_at_borders),
        cmocka_unit_test(linear_footprints_find_their_tiles_at_borders),
        cmocka_unit_test(linear_footprints_of_uneven_sizes_find_their_tiles_at_borders),
        cmocka_unit_test(anisotropic_footprints_find_their_tiles_at_borders),
        cmocka_unit_test(levels_at_a_fraction_find_their_tiles),
        cmocka_unit_test(samplers_a_little_finer_find_their_tiles),
        cmocka_unit_test(biases_at_both_ends_of_the_chain_are_clamped),
        cmocka_unit_test(anisotropic_footprints_with_a_bias_find_their_tiles),
        cmocka_unit_test(anisotropic_footprints_that_grow_with_a_bias_find_their_tiles),
        cmocka_unit_test(skewed_footprints_find_their_tiles_by_the_lengths),
        cmocka_unit_test(skewed_footprints_find_their_tiles_by_the_ellipse),
        cmocka_unit_test(samplers_a_little_coarser_find_their_tiles_by_the_ellipse),
        cmocka_unit_test(levels_beyond_the_chain_are_its_ends),
        cmocka_unit_test(sizes_that_do_not_halve_evenly_find_their_tiles),
        cmocka_unit_test(level_1_of_odd_sizes_finds_its_tiles_at_every_border),
        cmocka_unit_test(textures_one_texel_wide_find_their_tiles),
        cmocka_unit_test(tail_levels_are_marked_as_they_are),
        cmocka_unit_test(the_largest_textures_find_their_tiles),
        cmocka_unit_test(ordinary_samples_ask_for_little_more_than_they_need),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    status = RUN_TESTS(tests);
    suite_print_total();
    return harness_finish(&h, status);
}
