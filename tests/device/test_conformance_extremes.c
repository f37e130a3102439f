/*
 * Arguments that are not finite, or as good as that: marks stay inside the map, at a level of the
 * chain, and the coarsest where nothing is known; other lanes and other maps stay as they are.
 */
#include "device/suite.h"

#include "support/roll.h"
#include "support/test.h"

#include <float.h>
#include <math.h>

static const float specials[] = {
    0.0f,  -0.0f,     1e-45f, -1e-45f, 1e-38f,   FLT_MIN,  1e-20f,     0.5f,  0.999999f,
    1.0f,  1.000001f, -1.0f,  -0.5f,   4096.0f,  1e6f,     1000000.5f, -1e6f, 16777216.0f,
    1e18f, 1e30f,     -1e30f, FLT_MAX, -FLT_MAX, INFINITY, -INFINITY,  NAN};
#define SPECIALS (sizeof specials / sizeof specials[0])

static const uint32_t lanes[] = {1, 7}; /* all of a subgroup, or one in seven of it */

static struct SluiceTextureEntry entry_of(uint32_t i)
{
    return i % 2 ? conform_entry(512, 512, 64, 64, suite_modes[i / 2 % SUITE_MODES])
                 : conform_entry(300, 700, 64, 32, suite_modes[i / 2 % SUITE_MODES]);
}

/* Adds ordinary samples beside the special one. */
static void add_neighbors(struct suite *s, struct SluiceTextureEntry e, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++)
        suite_add(s, e, suite_level_input(&e, i), 0.3 + 0.07 * i, 0.6);
}

static void coordinates_of_any_value_mark_inside_the_map(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t t = 0; t < 2 * SUITE_MODES; t++)
        for (uint32_t i = 0; i < SPECIALS; i++)
            for (uint32_t j = 0; j < SPECIALS; j++) {
                struct SluiceTextureEntry e = entry_of(t);
                struct ConformInput in = suite_level_input(&e, (i + j) % 4);
                in.maxAnisotropy = (i + j) % 3 ? 1 : 8;
                in.mode = i % 2 ? CONFORM_GRAD : CONFORM_LOD;
                in.lod = (float)((i + j) % 4);
                suite_add(s, e, in, (double)specials[i], (double)specials[j]);
                add_neighbors(s, e, lanes[(i + j) / 8 % 2]);
            }
    suite_end(s, "special_uv");
}

static void derivatives_of_any_value_mark_inside_the_map(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t i = 0; i < SPECIALS; i++)
        for (uint32_t j = 0; j < SPECIALS; j++)
            for (uint32_t k = 0; k < 8; k++) {
                struct SluiceTextureEntry e = entry_of(i + j + k);
                struct ConformInput in = suite_level_input(&e, 2);
                float *slots[] = {&in.dx[0], &in.dx[1], &in.dy[0], &in.dy[1]};
                *slots[k % 4] = specials[i];
                *slots[(k + 1 + k / 4) % 4] = specials[j];
                in.maxAnisotropy = (i + j + k) % 2 ? 1 : 16;
                suite_add(s, e, in, 0.4, 0.7);
                add_neighbors(s, e, lanes[(i + j) / 8 % 2]);
            }
    suite_end(s, "special_derivatives");
}

static void biases_anisotropies_and_levels_of_any_value_mark_inside_the_map(void **state)
{
    struct suite *s = suite_begin(*state);
    for (uint32_t i = 0; i < SPECIALS; i++)
        for (uint32_t j = 0; j < SPECIALS; j++)
            for (uint32_t k = 0; k < 4; k++) {
                struct SluiceTextureEntry e = entry_of(i + j + k);
                struct ConformInput in = suite_level_input(&e, 2);
                in.dx[0] *= 3;
                in.lodBias = specials[i];
                in.maxAnisotropy = specials[j];
                in.lod = specials[i];
                in.mode = k == 3 ? CONFORM_LOD : CONFORM_GRAD;
                suite_add(s, e, in, 0.4, 0.7);
                add_neighbors(s, e, lanes[(i + j) / 8 % 2]);
            }
    suite_end(s, "special_bias");
}

/* Far outside the image floats are coarse. The coordinates that they represent are still exact. */
static void coordinates_far_outside_wrap_exactly(void **state)
{
    const double far[] = {2, 17, 255, 4096, 65536, 1e5, 999999, 1e6, 4194303, 8388607, 1e7};
    struct suite *s = suite_begin(*state);
    for (uint32_t t = 0; t < 4 * SUITE_MODES; t++) {
        uint32_t size = 256u << t / SUITE_MODES * 2;
        struct SluiceTextureEntry e =
            conform_entry(size, size, 128, 128, suite_modes[t % SUITE_MODES]);
        for (uint32_t i = 0; i < sizeof far / sizeof far[0]; i++)
            for (uint32_t k = 0; k < 16; k++) {
                struct ConformInput in = suite_level_input(&e, k % 5);
                double at = far[i] + k / 16.0;
                suite_add(s, e, in, at, -at - 1.0 / 32);
                in.maxAnisotropy = 8;
                in.dx[0] *= 8;
                suite_add(s, e, in, -at, at);
            }
    }
    suite_end(s, "far_uv");
}

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

/* A multiple of 2^-18, so that the differences between fragments are exact. */
static float rounded(double x)
{
    return (float)(round(x * 262144) / 262144);
}

static void random_samples_find_their_tiles_in_all_stages(void **state)
{
    struct suite *s = suite_begin(*state);
    roll_seed(91);
    for (uint32_t i = 0; i < 40000; i++) {
        struct SluiceTextureEntry e =
            conform_entry(1 + (uint32_t)(exp2(draw() * 11)), 1 + (uint32_t)(exp2(draw() * 11)),
                          32u << roll() % 4, 32u << roll() % 4, suite_modes[i % SUITE_MODES]);
        e.addressModeV = suite_modes[(uint32_t)roll() % SUITE_MODES];
        double length = exp2(draw() * (e.mipLevelCount + 2) - 2), angle = draw() * 6.2832;
        double ratio = roll() % 2 ? 1 : exp2(draw() * 6), turn = roll() % 2 ? 1.5708 : draw();
        struct ConformInput in = {.dx = {rounded(cos(angle) * length * ratio / e.width),
                                         rounded(sin(angle) * length * ratio / e.height)},
                                  .dy = {rounded(cos(angle + turn) * length / e.width),
                                         rounded(sin(angle + turn) * length / e.height)},
                                  .lodBias = roll() % 3 ? 0 : (float)(draw() * 4 - 2),
                                  .maxAnisotropy = roll() % 2 ? 1 : (float)(1 + draw() * 15),
                                  .mode = i % 4 ? CONFORM_IMPLICIT : CONFORM_LOD,
                                  .lod = (float)(draw() * 14 - 2)};
        suite_add(s, e, in, (double)rounded(draw() * 3 - 1), (double)rounded(draw() * 3 - 1));
    }
    suite_end(s, "random");
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(coordinates_of_any_value_mark_inside_the_map),
        cmocka_unit_test(derivatives_of_any_value_mark_inside_the_map),
        cmocka_unit_test(biases_anisotropies_and_levels_of_any_value_mark_inside_the_map),
        cmocka_unit_test(coordinates_far_outside_wrap_exactly),
        cmocka_unit_test(random_samples_find_their_tiles_in_all_stages),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    status = RUN_TESTS(tests);
    suite_print_total();
    return harness_finish(&h, status);
}
