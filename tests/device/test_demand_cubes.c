/*
 * Cube maps in demand loading. Filters across edges and corners are compared with an oracle in
 * double that finds neighbors by distance. Samples must open and request the faces they touch, and
 * no others.
 */
#include "device/cube_oracle.h"
#include "device/demand_runner.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FACES = CUBE_ORACLE_FACES, CUBES = 12 };

/* Weights of shaders are steps of 1/256, along two axes and between two levels. */
#define TOLERANCE 0.012

struct cubes {
    uint32_t size, count; ///< size of faces; number of cubes
    struct runner_image images[CUBES * FACES];
    SluiceDemandTextureId ids[CUBES * FACES], grid;
};

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

/* Created once, because that takes longer than all samples. */
static struct harness h;
static struct runner r;
static struct cubes sets[8];
static uint32_t set_count;

static int begin(void **state)
{
    (void)state;
    runner_init(&r, &h, NULL);
    runner_sample_cubes(&r);
    return 0;
}

static int end(void **state)
{
    (void)state;
    runner_finish(&r);
    for (uint32_t i = 0; i < set_count; i++)
        for (uint32_t k = 0; k < sets[i].count * FACES; k++)
            runner_image_finish(&sets[i].images[k]);
    return 0;
}

/* Adds new textures of the images, and their grid. Clears the samples. */
static void add_textures(struct cubes *c, float anisotropy)
{
    const SluiceDemandSampler sampler = {.structSize = sizeof sampler, .maxAnisotropy = anisotropy};
    runner_clear(&r);
    for (uint32_t i = 0; i < c->count * FACES; i++) {
        const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                    .image = runner_image_desc(&c->images[i]),
                                                    .pSampler = &sampler,
                                                    .failureColor = {1, 0, 1, 1}};
        CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &c->ids[i]));
    }
    const SluiceDemandGridCreateInfo grid = {.structSize = sizeof grid,
                                             .columnCount = c->count * FACES,
                                             .rowCount = 1,
                                             .pTextureIds = c->ids,
                                             .missingColor = {0.25f, 0.5f, 0.75f, 1}};
    CHECK_OK(sluiceAddDemandGrid(r.loader, &grid, &c->grid));
}

static struct cubes *add_cubes(uint32_t size, uint32_t count, float anisotropy)
{
    struct cubes *c = &sets[set_count++];
    c->size = size;
    c->count = count;
    for (uint32_t i = 0; i < count * FACES; i++)
        runner_image_init(&c->images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, size, size,
                          100 * set_count + i);
    add_textures(c, anisotropy);
    return c;
}

/* Adds a sample with a direction of any length. dx and dy are in texels along u and v. */
static void add_sample(const struct cubes *c, uint32_t cube, uint32_t face, double u, double v,
                       double dx, double dy)
{
    struct RunnerInput in = {.kind = RUNNER_CUBE_GRAD,
                             .index = (uint32_t)c->grid,
                             .cell = cube,
                             .uv = {(float)u, (float)v}};
    double at[3], along_x[3], along_y[3], length = exp2(4 * draw() - 2);
    cube_oracle_direction(face, u, v, at);
    cube_oracle_derivative(face, dx / c->size, 0, along_x);
    cube_oracle_derivative(face, 0, dy / c->size, along_y);
    for (uint32_t i = 0; i < 3; i++) {
        in.direction[i] = (float)(length * at[i]);
        in.direction[3 + i] = (float)(length * along_x[i]);
        in.direction[6 + i] = (float)(length * along_y[i]);
    }
    runner_add(&r, in);
}

static const struct RunnerInput *input_of(uint32_t sample)
{
    return &((const struct RunnerInput *)r.inputs.mapped)[sample];
}

static struct cube_taps taps_of(const struct cubes *c, const struct RunnerInput *in, uint32_t level)
{
    const double direction[3] = {(double)in->direction[0], (double)in->direction[1],
                                 (double)in->direction[2]};
    return cube_oracle_bilinear(slc_mip_size(c->size, level), direction);
}

static void add_level(struct cubes *c, const struct RunnerInput *in, uint32_t level, double weight,
                      double rgba[4])
{
    struct cube_taps taps = taps_of(c, in, level);
    for (uint32_t i = 0; i < taps.count; i++) {
        float texel[4];
        runner_image_texel(&c->images[in->cell * FACES + taps.texels[i].face], level,
                           taps.texels[i].x, taps.texels[i].y, texel);
        for (uint32_t k = 0; k < 4; k++)
            rgba[k] += weight * taps.weights[i] * (double)texel[k];
    }
}

static void check_color(struct cubes *c, uint32_t sample, double lod)
{
    const struct RunnerInput *in = input_of(sample);
    struct RunnerOutput out = runner_output(&r, sample);
    double expected[4] = {0};
    lod = fmin(fmax(lod, 0), slc_mip_count(c->size) - 1);
    uint32_t level = (uint32_t)lod;
    add_level(c, in, level, 1 - (lod - level), expected);
    if (lod > level)
        add_level(c, in, level + 1, lod - level, expected);
    for (uint32_t k = 0; k < 4; k++)
        if (!out.resident || !(fabs((double)out.color[k] - expected[k]) <= TOLERANCE))
            fail_msg("sample %u of cube %u, direction %.9g %.9g %.9g, lod %g, channel %u: %s, %g, "
                     "not %g",
                     sample, in->cell, (double)in->direction[0], (double)in->direction[1],
                     (double)in->direction[2], lod, k, out.resident ? "resident" : "missing",
                     (double)out.color[k], expected[k]);
}

/* Draws a position: anywhere, on an edge, or within two texels of an edge or corner, at a level
 * with `size` texels. */
static void draw_position(uint32_t index, uint32_t size, uint32_t *face, double uv[2])
{
    uint32_t along = index & 1;
    *face = (uint32_t)roll() % FACES;
    uv[0] = draw();
    uv[1] = draw();
    if (index % 4 > 0)
        uv[along] = fmin(2 * draw() / size, 1);
    if (index % 4 > 2)
        uv[1 - along] = fmin(2 * draw() / size, 1);
    if (index % 8 == 5)
        uv[along] = 0;
    for (uint32_t i = 0; i < 2; i++)
        if (roll() & 1)
            uv[i] = 1 - uv[i];
    double direction[3]; /* edges belong to one of two faces */
    cube_oracle_direction(*face, uv[0], uv[1], direction);
    cube_oracle_position(direction, face, uv);
}

static void check_filter(uint32_t size)
{
    enum { SAMPLES = 1500 };
    static double lods[SAMPLES];
    struct cubes *c = add_cubes(size, 2, 1);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t face, level = i % slc_mip_count(size);
        double uv[2];
        lods[i] = level == 0 ? -1 : i % 5 ? level : level - draw();
        draw_position(i, slc_mip_size(size, level), &face, uv);
        add_sample(c, (uint32_t)roll() % 2, face, uv[0], uv[1], exp2(lods[i]), exp2(lods[i]));
    }
    assert_in_range(runner_load(&r, 30), 3, 29);
    for (uint32_t i = 0; i < SAMPLES; i++)
        check_color(c, i, lods[i]);
}

static void samples_are_filtered_across_edges_and_corners(void **state)
{
    (void)state;
    roll_seed(50);
    check_filter(300); /* tiles of 128, and a mip tail */
    check_filter(16);  /* only a mip tail */
}

/* Each sample has its own cube, so that opened faces and read tiles belong to one sample. */
static void faces_and_tiles_that_a_sample_touches_are_requested_and_no_others(void **state)
{
    (void)state;
    uint32_t tiles = 0, faces = 0;
    uint64_t before = runner_statistics(&r).residentTileCount;
    roll_seed(51);
    struct cubes *c = add_cubes(512, CUBES, 1); /* three levels with 16, 4 and 1 tiles */
    for (uint32_t i = 0; i < CUBES; i++) {
        uint32_t level = i % 3, size = 512u >> level, face = (uint32_t)roll() % FACES;
        double along = 0.3 + 0.05 * draw(), inside = (0.1 + 0.3 * draw()) / size;
        double uv[2] = {i % 4 < 3 ? inside : along, i % 4 == 2 ? inside : along};
        if (i % 4 == 1)
            uv[0] = 1 - uv[0];
        add_sample(c, i, face, uv[0], uv[1], exp2(level ? (double)level : -1),
                   exp2(level ? (double)level : -1));
    }
    assert_in_range(runner_load(&r, 30), 3, 29);
    for (uint32_t i = 0; i < CUBES; i++) {
        struct cube_taps taps = taps_of(c, input_of(i), i % 3);
        bool touched[FACES] = {false};
        for (uint32_t k = 0; k < taps.count; k++) {
            const struct cube_texel *t = &taps.texels[k];
            bool known = false;
            for (uint32_t m = 0; m < k; m++)
                known = known ||
                        (taps.texels[m].face == t->face && taps.texels[m].x / 128 == t->x / 128 &&
                         taps.texels[m].y / 128 == t->y / 128);
            tiles += !known;
            touched[t->face] = true;
        }
        for (uint32_t face = 0; face < FACES; face++) {
            faces += touched[face];
            if ((c->images[i * FACES + face].opened != 0) != touched[face])
                fail_msg("cube %u, face %u: %s", i, face,
                         touched[face] ? "not opened" : "opened without need");
        }
        check_color(c, i, i % 3);
    }
    assert_in_range(faces, CUBES + 1, CUBES * FACES - 1);
    assert_int_equal(runner_statistics(&r).residentTileCount - before, tiles);
}

/* Rows of samples along an axis, many of them across an edge, equal the mean of isotropic
 * samples. */
static void rows_of_anisotropic_samples_cross_edges(void **state)
{
    (void)state;
    enum { SAMPLES = 200 };
    roll_seed(52);
    struct cubes *c = add_cubes(300, 1, 4);
    for (uint32_t i = 0; i < SAMPLES; i++)
        add_sample(c, 0, i % FACES, 0.02 * draw(), 0.2 + 0.6 * draw(), 16, 4);
    assert_in_range(runner_load(&r, 30), 3, 29);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const struct RunnerInput *in = input_of(i);
        struct RunnerOutput out = runner_output(&r, i);
        double expected[4] = {0};
        for (uint32_t tap = 0; tap < 4; tap++) {
            struct RunnerInput one = *in;
            double at[3];
            cube_oracle_direction(i % FACES, (double)in->uv[0] + (tap - 1.5) * 4 / 300,
                                  (double)in->uv[1], at);
            for (uint32_t k = 0; k < 3; k++)
                one.direction[k] = (float)at[k];
            add_level(c, &one, 2, 0.25, expected);
        }
        for (uint32_t k = 0; k < 4; k++)
            assert_float_equal(out.color[k], expected[k], TOLERANCE);
    }
}

static void faces_that_fail_and_empty_cells_show_their_colors(void **state)
{
    (void)state;
    static const float bad[][3] = {{0, 0, 0}, {NAN, 0, 1}, {INFINITY, 1, 0}};
    roll_seed(53);
    struct cubes *c = add_cubes(64, 1, 1);
    c->images[2].open_result = SLUICE_ERROR_CORRUPT_DATA;
    add_sample(c, 0, 2, 0.5, 0.5, 1, 1);       /* the face that fails */
    add_sample(c, 0, 4, 0.5, 0.25 / 64, 1, 1); /* beside it: 1/4 of its color */
    for (uint32_t i = 0; i < 3; i++) {
        add_sample(c, 0, 0, 0.5, 0.5, 1, 1);
        for (uint32_t k = 0; k < 3; k++)
            ((struct RunnerInput *)r.inputs.mapped)[2 + i].direction[k] = bad[i][k];
    }
    add_sample(c, 9, 0, 0.5, 0.5, 1, 1); /* beyond the last cube: uses the last one */
    runner_load(&r, 20);
    float texel[4];
    runner_image_texel(&c->images[4], 0, 31, 0, texel);
    assert_float_equal(runner_output(&r, 0).color[0], 1, 1e-6);
    assert_float_equal(runner_output(&r, 0).color[1], 0, 1e-6);
    float other[4];
    runner_image_texel(&c->images[4], 0, 32, 0, other);
    double inside = 0.75 * ((double)texel[1] + (double)other[1]) / 2;
    assert_float_equal(runner_output(&r, 1).color[1], inside, TOLERANCE);
    for (uint32_t i = 0; i < 3; i++) {
        runner_image_texel(&c->images[0], 6, 0, 0, texel);
        assert_true(runner_output(&r, 2 + i).resident);
        assert_float_equal(runner_output(&r, 2 + i).color[1], texel[1], TOLERANCE);
    }
    ((struct RunnerInput *)r.inputs.mapped)[5].cell = 0;
    check_color(c, 5, 0);
}

enum { COMPARED = 400, COMPARED_LAUNCHES = 8 };

/* Runs launches that load new textures of the images. Records outputs and misses. The last face has
 * none. */
static void run_launches(struct cubes *c, struct RunnerOutput outputs[][COMPARED],
                         uint32_t missing[COMPARED_LAUNCHES])
{
    add_textures(c, 4);
    roll_seed(54);
    for (uint32_t i = 0; i < COMPARED; i++) {
        uint32_t face;
        double uv[2], texels = exp2(10 * draw() - 1);
        draw_position(i, slc_mip_size(c->size, (uint32_t)fmax(log2(texels), 0)), &face, uv);
        add_sample(c, (uint32_t)roll() % 2, face, uv[0], uv[1], texels, texels * (0.2 + draw()));
    }
    for (uint32_t k = 0; k < COMPARED_LAUNCHES; k++) {
        runner_launch(&r);
        missing[k] = r.requests.missingCount;
        memcpy(outputs[k], r.outputs.mapped, sizeof outputs[k]);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
}

static void hlsl_samples_and_requests_what_glsl_does(void **state)
{
    static struct RunnerOutput glsl[COMPARED_LAUNCHES][COMPARED], hlsl[COMPARED_LAUNCHES][COMPARED];
    uint32_t misses[2][COMPARED_LAUNCHES];
    struct cubes *c = add_cubes(300, 2, 4);
    (void)state;
    c->images[2 * FACES - 1].open_result = SLUICE_ERROR_CORRUPT_DATA;
    run_launches(c, glsl, misses[0]);
    runner_sample_in_hlsl(&r, true);
    run_launches(c, hlsl, misses[1]);
    runner_sample_cubes(&r);
    for (uint32_t k = 0; k < COMPARED_LAUNCHES; k++) {
        assert_int_equal(misses[1][k], misses[0][k]);
        for (uint32_t i = 0; i < COMPARED; i++)
            if (memcmp(&glsl[k][i], &hlsl[k][i], sizeof glsl[k][i]) != 0)
                fail_msg("launch %u, sample %u: HLSL %.9g, resident %u; GLSL %.9g, resident %u", k,
                         i, (double)hlsl[k][i].color[1], hlsl[k][i].resident,
                         (double)glsl[k][i].color[1], glsl[k][i].resident);
    }
    assert_true(misses[0][0] > 0 && misses[0][1] > 0);
    assert_int_equal(misses[0][COMPARED_LAUNCHES - 1], 0);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        /* First, because HLSL finds pages by a loop over the first two images. */
        cmocka_unit_test(hlsl_samples_and_requests_what_glsl_does),
        cmocka_unit_test(samples_are_filtered_across_edges_and_corners),
        cmocka_unit_test(faces_and_tiles_that_a_sample_touches_are_requested_and_no_others),
        cmocka_unit_test(rows_of_anisotropic_samples_cross_edges),
        cmocka_unit_test(faces_that_fail_and_empty_cells_show_their_colors),
    };
    tap_filter_stdout();
    return harness_finish(&h, cmocka_run_group_tests_name(__FILE__, tests, begin, end));
}
