/* Colors of resident textures: as Vulkan's filters define, and as a sampler shows them. */
#include "device/demand_expect.h"
#include "device/demand_images.h"
#include "device/demand_samples.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define STEP (1.0 / 255.0)

static struct demand_expectation expectation;
static bool knows_no_cubic; /* the shader does not support bicubic filters */

/* Adds a fully resident texture. Its last level is its base color. */
static uint32_t add_whole(struct demand_scene *scene, const struct demand_texture *texture)
{
    uint32_t index = demand_scene_add(scene, texture);
    struct SluiceDemandTexture *e = demand_scene_entry(scene, index);
    uint32_t levels = e->shape >> SLUICE_DEMAND_LEVEL_COUNT_SHIFT & 31;
    demand_texel(scene, index, levels - 1, 0, 0, e->baseColor);
    demand_images_load(scene, index, NULL, NULL);
    return index;
}

/* Returns the largest difference of a channel among certain colors. */
static double largest_difference(struct demand_scene *scene, uint32_t count, uint32_t *sure_count)
{
    double worst = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct DemandInput *in = &demand_inputs(scene)[i];
        const struct DemandOutput *out = &demand_outputs(scene)[i];
        struct SluiceDemandTexture entry = *demand_scene_entry(scene, in->index);
        if (knows_no_cubic)
            entry.shape &= ~(SLUICE_DEMAND_SPLINE | SLUICE_DEMAND_SMART);
        expectation.entry = &entry;
        expectation.index = in->index;
        demand_expect(&expectation, in, NULL);
        assert_int_equal(out->resident, 1);
        if (!expectation.sure)
            continue;
        ++*sure_count;
        for (int c = 0; c < 4; c++)
            worst = fmax(worst, fabs(out->color[c] - expectation.color[c]));
    }
    return worst;
}

static const uint32_t sizes[][2] = {{700, 500}, {257, 129}, {64, 64}, {65, 64}, {1, 1}, {3, 300}};
#define SIZES (sizeof sizes / sizeof sizes[0])

static double try_samplers(struct demand_scene *scene, enum demand_shader shader, bool blocks,
                           uint32_t *sure_count)
{
    expectation = (struct demand_expectation){.scene = scene};
    struct demand_texture textures[SIZES];
    demand_scene_clear(scene);
    for (uint32_t t = 0; t < SIZES; t++) {
        textures[t] = demand_random_texture(sizes[t][0], sizes[t][1]);
        textures[t].blocks = blocks;
        if (shader == DEMAND_SHADER_CUBIC || knows_no_cubic)
            demand_randomize_filter(&textures[t]);
        add_whole(scene, &textures[t]);
    }
    demand_images_upload(scene);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
        demand_inputs(scene)[i] = demand_random_input(i % SIZES, &textures[i % SIZES], i % 16 == 0);
        if (shader == DEMAND_SHADER_LOOP)
            demand_inputs(scene)[i].kind = DEMAND_LOD;
        if (shader == DEMAND_SHADER_FRAGMENT)
            demand_inputs(scene)[i].kind = DEMAND_CUBIC;
    }
    demand_scene_run(scene, shader, DEMAND_SAMPLES);
    return largest_difference(scene, DEMAND_SAMPLES, sure_count);
}

static void colors_are_those_of_the_filter(void **state)
{
    uint32_t sure = 0;
    double worst = 0;
    roll_seed(11);
    for (int round = 0; round < 6; round++)
        worst = fmax(worst, try_samplers(*state, DEMAND_SHADER_COMPUTE, false, &sure));
    print_message("# at most %.2f steps of 255 off, %u samples\n", worst / STEP, sure);
    assert_true(worst < 2 * STEP);
    assert_true(sure > 6 * DEMAND_SAMPLES / 2);
}

static void textures_with_bicubic_filters_need_shaders_that_know_them(void **state)
{
    uint32_t sure = 0;
    roll_seed(16);
    for (int round = 0; round < 6; round++) {
        double worst = try_samplers(*state, DEMAND_SHADER_CUBIC, false, &sure);
        print_message("# at most %.2f steps of 255 off\n", worst / STEP);
        assert_true(worst < 2 * STEP);
    }
    knows_no_cubic = true;
    assert_true(try_samplers(*state, DEMAND_SHADER_COMPUTE, false, &sure) < 2 * STEP);
    knows_no_cubic = false;
    assert_true(sure > 7 * DEMAND_SAMPLES / 2);
}

static void tails_of_compressed_formats_are_found_in_their_places(void **state)
{
    struct demand_scene *scene = *state;
    uint32_t sure = 0;
    roll_seed(12);
    demand_scene_reshape(scene, VK_FORMAT_R8G8B8A8_UNORM, 7, 6);
    assert_true(try_samplers(scene, DEMAND_SHADER_COMPUTE, true, &sure) < 2 * STEP);
    assert_true(try_samplers(scene, DEMAND_SHADER_COMPUTE, false, &sure) < 2 * STEP);
    demand_scene_reshape(scene, VK_FORMAT_R8G8B8A8_UNORM, 7, 7);
}

static void images_found_by_a_loop_are_those_found_by_an_index(void **state)
{
    uint32_t sure = 0;
    roll_seed(13);
    assert_true(try_samplers(*state, DEMAND_SHADER_LOOP, false, &sure) < 2 * STEP);
    assert_true(sure > DEMAND_SAMPLES / 2);
}

static void hlsl_samples_and_requests_what_glsl_does(void **state)
{
    static struct DemandOutput outputs[2][DEMAND_SAMPLES];
    static uint8_t requests[2][DEMAND_PAGES / 8];
    struct demand_scene *scene = *state;
    for (uint32_t missing = 0; missing < 2; missing++) {
        for (uint32_t hlsl = 0; hlsl < 2; hlsl++) {
            enum demand_shader shader = hlsl ? DEMAND_SHADER_HLSL : DEMAND_SHADER_COMPUTE;
            uint32_t sure = 0;
            roll_seed(17);
            try_samplers(scene, DEMAND_SHADER_COMPUTE, false, &sure);
            if (missing)
                memset(scene->blocks.mapped, 0xFF, (size_t)scene->blocks.size);
            if (missing)
                memset(scene->masks.mapped, 0, (size_t)scene->masks.size);
            demand_scene_run(scene, shader, DEMAND_SAMPLES);
            memcpy(outputs[hlsl], demand_outputs(scene), sizeof outputs[hlsl]);
            memcpy(requests[hlsl], scene->requests.mapped, sizeof requests[hlsl]);
        }
        assert_int_equal(outputs[0][3].resident, !missing);
        assert_memory_equal(outputs[0], outputs[1], sizeof outputs[0]);
        assert_memory_equal(requests[0], requests[1], sizeof requests[0]);
    }
}

static void describe(const struct DemandInput *in, uint32_t mode, int channel, double off)
{
    print_message("# mode %u, channel %d, %.1f steps: uv %.9g %.9g, dx %.9g %.9g, dy %.9g %.9g\n",
                  mode, channel, off / STEP, in->uv[0], in->uv[1], in->dx[0], in->dx[1], in->dy[0],
                  in->dy[1]);
}

/* Devices disagree about fractions of levels, and about levels of footprints that are no
 * squares. */
static void make_whole(struct DemandInput *in, const struct demand_texture *t)
{
    double side = exp2(roll() % 8);
    in->dx[0] = (float)(side / t->width);
    in->dy[1] = (float)(side / t->height);
    in->dx[1] = in->dy[0] = 0;
}

static void isotropic_samples_are_those_of_a_sampler(void **state)
{
    struct demand_scene *scene = *state;
    double worst = 0;
    roll_seed(14);
    for (uint32_t mode = 0; mode < (scene->h->mirror_clamp ? 5 : 4); mode++) {
        demand_scene_clear(scene);
        struct demand_texture t = {.width = 300,
                                   .height = 200,
                                   .mode_u = mode,
                                   .mode_v = mode == 4 ? 4 : (mode + 1) % 4,
                                   .anisotropy = 1,
                                   .border_color = {1, 1, 1, 1}};
        uint32_t index = add_whole(scene, &t);
        demand_images_upload(scene);
        demand_images_plain_finish(scene);
        demand_images_plain(scene, index);
        for (uint32_t i = 0; i < DEMAND_SAMPLES; i += 2) {
            struct DemandInput *in = &demand_inputs(scene)[i];
            in[0] = demand_random_input(index, &t, false);
            in[0].kind = DEMAND_GRAD;
            if (harness_level_error(scene->h) > 0)
                make_whole(&in[0], &t);
            in[1] = in[0];
            in[1].kind = DEMAND_HARDWARE;
        }
        demand_scene_run(scene, DEMAND_SHADER_COMPUTE, DEMAND_SAMPLES);
        for (uint32_t i = 0; i < DEMAND_SAMPLES; i += 2)
            for (int c = 0; c < 4; c++) {
                double off = fabsf(demand_outputs(scene)[i].color[c] -
                                   demand_outputs(scene)[i + 1].color[c]);
                if (off > 2 * STEP)
                    describe(&demand_inputs(scene)[i], mode, c, off);
                worst = fmax(worst, off);
            }
    }
    print_message("# at most %.2f steps of 255 off the sampler\n", worst / STEP);
    assert_true(worst < 2 * STEP);
}

/* A texture in a grid is sampled by itself, clamped, at the fraction of uv. */
static void check_grid_sample(struct demand_scene *scene, uint32_t grid, const uint32_t cells[6],
                              uint32_t i, double *worst, uint32_t *beyond)
{
    struct DemandInput in = demand_inputs(scene)[i];
    const struct DemandOutput *out = &demand_outputs(scene)[i];
    float x = floorf(in.uv[0]), y = floorf(in.uv[1]);
    bool inside = x >= 0 && x < 3 && y >= 0 && y < 2;
    uint32_t member = inside ? cells[(uint32_t)y * 3 + (uint32_t)x] : SLUICE_DEMAND_NO_TEXTURE;
    assert_int_equal(out->resident, 1);
    if (member == SLUICE_DEMAND_NO_TEXTURE) {
        ++*beyond;
        for (int c = 0; c < 4; c++)
            assert_float_equal(out->color[c], demand_scene_entry(scene, grid)->baseColor[c], 0);
        return;
    }
    struct SluiceDemandTexture entry = *demand_scene_entry(scene, member);
    const uint32_t modes = 63u << SLUICE_DEMAND_MODE_U_SHIFT;
    entry.shape = (entry.shape & ~modes) |
                  SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE << SLUICE_DEMAND_MODE_U_SHIFT |
                  SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE << SLUICE_DEMAND_MODE_V_SHIFT;
    in.uv[0] -= x;
    in.uv[1] -= y;
    expectation.entry = &entry;
    expectation.index = member;
    demand_expect(&expectation, &in, NULL);
    for (int c = 0; c < 4 && expectation.sure; c++)
        *worst = fmax(*worst, fabs(out->color[c] - expectation.color[c]));
}

static void grids_show_their_textures_clamped_and_a_color_beyond(void **state)
{
    struct demand_scene *scene = *state;
    roll_seed(15);
    demand_scene_clear(scene);
    expectation = (struct demand_expectation){.scene = scene};
    uint32_t cells[6];
    struct demand_texture t;
    for (uint32_t i = 0; i < 6; i++) {
        t = demand_random_texture(100 + 40 * i, 200 - 30 * i);
        cells[i] = i == 4 ? SLUICE_DEMAND_NO_TEXTURE : add_whole(scene, &t);
    }
    demand_images_upload(scene);
    uint32_t grid = scene->texture_count++;
    *demand_scene_entry(scene, grid) =
        (struct SluiceDemandTexture){.state = SLUICE_DEMAND_TEXTURE_GRID,
                                     .width = 3,
                                     .height = 2,
                                     .levels = scene->level_count,
                                     .baseColor = {0.125f, 0.25f, 0.5f, 0.75f}};
    memcpy((uint32_t *)scene->levels.mapped + scene->level_count, cells, sizeof cells);
    scene->level_count += 6;
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
        struct DemandInput in = demand_random_input(grid, &t, false);
        in.uv[0] = (float)(4.0 * demand_random() - 0.5);
        in.uv[1] = i % 8 ? (float)(3.0 * demand_random() - 0.5) : (float)(i % 5) - 1;
        demand_inputs(scene)[i] = in;
    }
    demand_scene_run(scene, DEMAND_SHADER_COMPUTE, DEMAND_SAMPLES);
    double worst = 0;
    uint32_t beyond = 0;
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++)
        check_grid_sample(scene, grid, cells, i, &worst, &beyond);
    assert_true(worst < 2 * STEP);
    assert_in_range(beyond, DEMAND_SAMPLES / 4, DEMAND_SAMPLES * 3 / 4);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    static struct demand_scene scene;
    demand_scene_init(&scene, &h, VK_FORMAT_R8G8B8A8_UNORM, 7, 7);
    struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_are_those_of_the_filter),
        cmocka_unit_test(textures_with_bicubic_filters_need_shaders_that_know_them),
        cmocka_unit_test(tails_of_compressed_formats_are_found_in_their_places),
        cmocka_unit_test(images_found_by_a_loop_are_those_found_by_an_index),
        cmocka_unit_test(hlsl_samples_and_requests_what_glsl_does),
        cmocka_unit_test(isotropic_samples_are_those_of_a_sampler),
        cmocka_unit_test(grids_show_their_textures_clamped_and_a_color_beyond),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &scene;
    status = RUN_TESTS(tests);
    demand_scene_finish(&scene);
    return harness_finish(&h, status);
}
