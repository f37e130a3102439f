/*
 * Every tile that this device's own sampler reads is marked. The reads are observed, not computed,
 * because drivers differ in levels of detail and in the footprints of anisotropy.
 */
#include "device/suite.h"
#include "device/truth.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>

#define SAMPLES 1536u

struct comparison {
    struct truth truth;
    struct conform conform;
    struct conform_sample samples[SAMPLES];
    struct oracle_tiles touched, asked;
    uint64_t needed, excess;
};

static struct comparison comparison;

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

/* A multiple of 2^-18, so that the differences between fragments are exact. */
static float rounded(double x)
{
    return (float)(round(x * 262144) / 262144);
}

static double random_coordinate(uint32_t size, uint32_t region, double length)
{
    double border = (double)(roll() % (int)(size / region + 2)) * region / size;
    switch (roll() % 4) {
    case 0: return draw() * 3 - 1;
    case 1: return border + (draw() - 0.5) * length * 4;
    case 2: return border + (draw() - 0.5) * 2 / size;
    default: return border + (roll() % 2 ? 0.5 : -0.5) * length;
    }
}

static struct ConformInput random_input(const struct SluiceTextureEntry *e, float anisotropy,
                                        bool biased)
{
    double texels = exp2(draw() * (e->mipLevelCount + 1) - 1), angle = draw() * 6.2832;
    double ratio = roll() % 2 ? exp2(draw() * 5) : 1;
    double turn = roll() % 2 ? 1.5708 : draw() * draw() * 1.5708;
    double x = texels / e->width, y = texels / e->height;
    struct ConformInput in = {
        .dx = {rounded(cos(angle) * x * ratio), rounded(sin(angle) * y * ratio)},
        .dy = {rounded(cos(angle + turn) * x), rounded(sin(angle + turn) * y)},
        .lodBias = biased ? (float)(roll() % 33 - 16) / 8 : 0,
        .maxAnisotropy = anisotropy};
    in.uv[0] = rounded(random_coordinate(e->width, e->regionWidth, x * ratio));
    in.uv[1] = rounded(random_coordinate(e->height, e->regionHeight, y * ratio));
    return in;
}

static void check_sample(void *user, const struct conform_sample *sample, const uint32_t *map)
{
    struct comparison *c = user;
    const struct SluiceTextureEntry *e = &sample->entry;
    oracle_tiles_init(&c->touched, e);
    oracle_tiles_init(&c->asked, e);
    truth_add(&c->truth, (uint32_t)(sample - c->samples), &c->touched);
    oracle_decode(&c->asked, map);
    for (uint32_t l = 0; l < e->mipLevelCount; l++)
        for (uint32_t y = 0; y < c->touched.height[l]; y++)
            for (uint32_t x = 0; x < c->touched.width[l]; x++)
                if (*oracle_tile(&c->touched, l, x, y) && !*oracle_tile(&c->asked, l, x, y))
                    suite_describe(sample, "the sampler reads a tile that is not asked for", l, x,
                                   y);
    oracle_close(&c->touched);
    for (uint32_t i = 0; i < c->touched.count; i++) {
        c->needed += c->touched.has[i];
        c->excess += c->asked.has[i] && !c->touched.has[i];
    }
}

struct filter {
    const char *name;
    bool nearest, nearest_mip;
    float anisotropy;
};

static const struct filter filters[] = {{"point", true, true, 1},
                                        {"point_mip_linear", true, false, 1},
                                        {"linear_mip_point", false, true, 1},
                                        {"trilinear", false, false, 1},
                                        {"anisotropic_2", false, false, 2},
                                        {"anisotropic_4", false, false, 4},
                                        {"anisotropic_16", false, false, 16}};
#define FILTERS (sizeof filters / sizeof filters[0])

static void compare(struct SluiceTextureEntry e, const struct filter *filter,
                    enum conform_stage stage, bool explicit_lod)
{
    struct comparison *c = &comparison;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        c->samples[i].entry = e;
        c->samples[i].in = random_input(&e, filter->anisotropy, i % 3 == 0 && !explicit_lod);
        if (stage == CONFORM_STAGE_FRAGMENT)
            c->samples[i].in.mode = CONFORM_IMPLICIT;
        if (explicit_lod) {
            c->samples[i].in.mode = CONFORM_LOD;
            c->samples[i].in.lod = (float)(draw() * (e.mipLevelCount + 1) - 1);
        }
    }
    truth_set_sampler(&c->truth, &e, filter->nearest, filter->nearest_mip, filter->anisotropy);
    truth_run(&c->truth, stage, c->samples, SAMPLES);
    assert_int_equal(conform_run(&c->conform, stage, c->samples, SAMPLES, check_sample, c),
                     SAMPLES);
}

static void compare_all(struct harness *h, const char *what, enum conform_stage stage,
                        bool explicit_lod)
{
    const uint32_t sizes[][4] = {{256, 256, 32, 32}, {200, 150, 32, 32}, {129, 511, 64, 64}};
    struct comparison *c = &comparison;
    uint64_t needed[FILTERS] = {0}, excess[FILTERS] = {0};
    conform_init(&c->conform, h);
    roll_seed(81);
    for (uint32_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        struct SluiceTextureEntry e =
            conform_entry(sizes[s][0], sizes[s][1], sizes[s][2], sizes[s][3], 0);
        truth_init(&c->truth, h, &e);
        for (uint32_t f = 0; f < FILTERS; f++)
            for (uint32_t m = 0; m < SUITE_MODES; m++) {
                e.addressModeU = suite_modes[m];
                e.addressModeV = suite_modes[(m + f) % SUITE_MODES];
                if (filters[f].anisotropy > 1 && !h->anisotropy)
                    continue;
                if (!h->mirror_clamp &&
                    (e.addressModeU == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE ||
                     e.addressModeV == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE))
                    continue;
                c->needed = c->excess = 0;
                compare(e, &filters[f], stage, explicit_lod);
                needed[f] += c->needed;
                excess[f] += c->excess;
            }
        truth_finish(&c->truth);
    }
    conform_finish(&c->conform);
    for (uint32_t f = 0; f < FILTERS; f++)
        print_message("# needed.%s.%s %llu tiles\n# overmarked.%s.%s %llu tiles\n", what,
                      filters[f].name, (unsigned long long)needed[f], what, filters[f].name,
                      (unsigned long long)excess[f]);
    assert_true(needed[0] > 0);
}

static void explicit_derivatives_mark_all_that_the_sampler_reads(void **state)
{
    compare_all(*state, "grad", CONFORM_STAGE_COMPUTE, false);
}

static void implicit_derivatives_mark_all_that_the_sampler_reads(void **state)
{
    compare_all(*state, "implicit", CONFORM_STAGE_FRAGMENT, false);
}

static void explicit_levels_mark_all_that_the_sampler_reads(void **state)
{
    compare_all(*state, "lod", CONFORM_STAGE_COMPUTE, true);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(explicit_derivatives_mark_all_that_the_sampler_reads),
        cmocka_unit_test(implicit_derivatives_mark_all_that_the_sampler_reads),
        cmocka_unit_test(explicit_levels_mark_all_that_the_sampler_reads),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
