/* Cube maps: texels, seams, residency and feedback across edges, against an oracle in double. */
#include "device/cube_rig.h"

#include "base/checked.h"
#include "support/map_everything.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define SAMPLES 1024u

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

/* Draws a position: anywhere, on an edge, or within two texels of an edge or corner, at a level
 * with `size` texels. */
static void draw_position(uint32_t index, uint32_t size, uint32_t *face, double uv[2])
{
    *face = (uint32_t)roll() % CUBE_ORACLE_FACES;
    uint32_t along = index & 1;
    uv[0] = draw();
    uv[1] = draw();
    if (index % 4 > 0)
        uv[along] = fmin(draw() * 2 / size, 1);
    if (index % 4 > 2)
        uv[1 - along] = fmin(draw() * 2 / size, 1);
    if (index % 8 == 5)
        uv[along] = 0;
    for (uint32_t i = 0; i < 2; i++)
        if (roll() & 1)
            uv[i] = 1 - uv[i];
    double direction[3]; /* edges belong to one of two faces */
    cube_oracle_direction(*face, uv[0], uv[1], direction);
    cube_oracle_position(direction, face, uv);
}

/* Draws samples at whole LODs, where only the bilinear filter counts. */
static void draw_inputs(struct cube_rig *rig, double lods[SAMPLES])
{
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t face, level = i % rig->level_count;
        double uv[2];
        lods[i] = level == 0 ? -1.0 : (double)level;
        draw_position(i, slc_mip_size(rig->size, level), &face, uv);
        cube_rig_inputs(rig)[i] = cube_rig_input(rig, face, uv[0], uv[1], exp2(lods[i]));
    }
}

static void check_color(const struct cube_rig *rig, uint32_t cube, uint32_t sample, double lod,
                        double tolerance)
{
    const struct CubeInput *in = &cube_rig_inputs((struct cube_rig *)rig)[sample];
    const struct ProbeOutput *out = &cube_rig_outputs(rig)[sample];
    double expected[4];
    cube_rig_expect(rig, cube, in, lod, expected);
    for (uint32_t c = 0; c < 4; c++)
        if (!(fabs((double)out->color[c] - expected[c]) <= tolerance))
            fail_msg("sample %u of cube %u, direction %.9g %.9g %.9g, lod %g (resolved %g), "
                     "channel %u: %g, not %g",
                     sample, cube, (double)in->direction[0], (double)in->direction[1],
                     (double)in->direction[2], lod, (double)out->lod, c, (double)out->color[c],
                     expected[c]);
}

/* `lods` NULL: LODs that the shader chose. */
static void check_colors(const struct cube_rig *rig, uint32_t cube, const double *lods,
                         double tolerance)
{
    for (uint32_t i = 0; i < SAMPLES; i++)
        if (cube_rig_outputs(rig)[i].level != SLUICE_MIP_UNTOUCHED)
            check_color(rig, cube, i, lods ? lods[i] : (double)cube_rig_outputs(rig)[i].lod,
                        tolerance);
}

/* Steps of 1/256 of bilinear weights, twice, and of 1/64 between levels. */
#define TOLERANCE (2.5 / 256 + 1.0 / 64)

static uint32_t count_missing(const struct cube_rig *rig)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SAMPLES; i++)
        count += cube_rig_outputs(rig)[i].missingLevels != 0;
    return count;
}

static void samples_of_cubes_are_filtered_across_edges_and_corners(void **state)
{
    static const uint32_t sizes[] = {512, 300};
    static double lods[SAMPLES];
    for (uint32_t s = 0; s < 2; s++) {
        struct cube_rig rig;
        SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                               .pDebug = &map_everything};
        roll_seed(20 + s);
        if (cube_rig_init(&rig, *state, info, sizes[s], 1)) {
            draw_inputs(&rig, lods);
            for (uint32_t i = 0; i < 4; i++) {
                static const enum cube_form forms[] = {CUBE_FORM_CUBE, CUBE_FORM_CUBE,
                                                       CUBE_FORM_ARRAY, CUBE_FORM_NUMBER};
                uint32_t cube = i == 1 || i == 2;
                if (s > 0 && i > 0) /* other forms use the same filters */
                    continue;
                if (forms[i] == (rig.scene.prober.paged ? CUBE_FORM_NUMBER : CUBE_FORM_ARRAY))
                    continue; /* compiling takes longer than all samples */
                if (forms[i] == CUBE_FORM_ARRAY && !rig.textures[0].cubeArrayView)
                    continue;
                cube_rig_use(&rig, forms[i]);
                cube_rig_settle(&rig, i ? 1 : 12, cube, SAMPLES, CUBE_SAMPLE);
                assert_int_equal(count_missing(&rig), 0);
                check_colors(&rig, cube, lods, TOLERANCE);
            }
        }
        cube_rig_finish(&rig);
    }
}

/* Checks that each frame shows only resident texels, filtered across edges. */
static void check_streaming(struct harness *h, uint32_t size, float anisotropy)
{
    static double lods[SAMPLES];
    struct cube_rig rig;
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .feedbackTimeoutTicks = 1000, .tilesPerFrame = 32};
    roll_seed(30);
    if (cube_rig_init(&rig, h, info, size, anisotropy)) {
        draw_inputs(&rig, lods);
        uint32_t missing = SAMPLES, partly = 0;
        for (uint32_t frame = 0; frame < 30 && missing; frame++) {
            cube_rig_settle(&rig, 1, 1, SAMPLES, CUBE_SAMPLE | CUBE_FEEDBACK);
            missing = count_missing(&rig);
            partly += missing > 0 && missing < SAMPLES;
            check_colors(&rig, 1, NULL, TOLERANCE);
        }
        assert_int_equal(missing, 0);
        assert_true(partly > 1);
        check_colors(&rig, 1, anisotropy > 1 ? NULL : lods, TOLERANCE);
    }
    cube_rig_finish(&rig);
}

static void cubes_show_only_what_is_resident_until_all_of_it_is(void **state)
{
    check_streaming(*state, 512, 1);
    check_streaming(*state, 300, 1);
}

/* Footprints of all shapes. Red identifies the finest level read; 0 is not resident. */
static void anisotropic_samples_touch_only_what_is_resident(void **state)
{
    struct harness *h = *state;
    struct cube_rig rig;
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .feedbackTimeoutTicks = 1000, .tilesPerFrame = 32};
    if (!h->anisotropy)
        SKIP_TEST("the device has no anisotropic filtering");
    roll_seed(31);
    if (cube_rig_init(&rig, h, info, 512, 8)) {
        for (uint32_t i = 0; i < SAMPLES; i++) {
            uint32_t face;
            double uv[2], angle = draw() * 6.2831853, texels = exp2(draw() * 7), ratio = draw();
            draw_position(i, 64, &face, uv);
            const double dx[2] = {cos(angle) * texels, sin(angle) * texels};
            const double dy[2] = {-sin(angle) * texels * ratio, cos(angle) * texels * ratio};
            cube_rig_inputs(&rig)[i] = cube_rig_input_with(&rig, face, uv[0], uv[1], dx, dy);
        }
        uint32_t missing = SAMPLES;
        for (uint32_t frame = 0; frame < 30 && missing; frame++) {
            cube_rig_settle(&rig, 1, 0, SAMPLES, CUBE_SAMPLE | CUBE_FEEDBACK);
            missing = count_missing(&rig);
            for (uint32_t i = 0; i < SAMPLES; i++) {
                const struct ProbeOutput *out = &cube_rig_outputs(&rig)[i];
                if (out->level == SLUICE_MIP_UNTOUCHED)
                    continue;
                float level = pattern_level(out->color);
                if (!(level >= (float)out->level - PATTERN_LEVEL_ERROR))
                    fail_msg("sample %u shows level %g, allowed %u, lod %g", i, (double)level,
                             out->level, (double)out->lod);
            }
        }
        assert_int_equal(missing, 0);
    }
    cube_rig_finish(&rig);
}

/* Requests only one face. Beside its edges, the other faces are coarse. */
static void edges_between_sharp_and_coarse_faces_do_not_show(void **state)
{
    struct cube_rig rig;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .feedbackTimeoutTicks = 1000};
    roll_seed(32);
    if (cube_rig_init(&rig, *state, info, 512, 1)) {
        for (uint32_t i = 0; i < SAMPLES; i++)
            cube_rig_inputs(&rig)[i] =
                cube_rig_input(&rig, 2, 0.1 + 0.8 * draw(), 0.1 + 0.8 * draw(), 0.5);
        cube_rig_settle(&rig, 12, 0, SAMPLES, CUBE_SAMPLE | CUBE_FEEDBACK);
        assert_int_equal(count_missing(&rig), 0);
        for (uint32_t i = 0; i < SAMPLES; i += 2) {
            double along = draw(), at[2] = {along, i % 4 ? 0 : 1};
            if (i % 8 >= 4)
                at[0] = at[1], at[1] = along;
            for (uint32_t k = 0; k < 2; k++) { /* a thousandth of a texel to either side */
                double aside = (k ? 1e-3 : -1e-3) / 512;
                double u = at[0] + (at[0] == along ? 0 : aside);
                double v = at[1] + (at[1] == along ? 0 : aside);
                cube_rig_inputs(&rig)[i + k] = cube_rig_input(&rig, 2, u, v, 0.5);
            }
        }
        cube_rig_settle(&rig, 1, 0, SAMPLES, CUBE_SAMPLE);
        assert_int_equal(count_missing(&rig), SAMPLES);
        for (uint32_t i = 0; i < SAMPLES; i += 2)
            for (uint32_t c = 0; c < 4; c++)
                assert_float_equal(cube_rig_outputs(&rig)[i].color[c],
                                   cube_rig_outputs(&rig)[i + 1].color[c], TOLERANCE);
        check_colors(&rig, 0, NULL, TOLERANCE);
    }
    cube_rig_finish(&rig);
}

/* Regions of all faces, in the order of the feedback buffer. */
#define GRID 4u /* 512 texels in tiles of 128 */
#define REGIONS (GRID * GRID * CUBE_ORACLE_FACES)
#define MARKED (PROBE_CAPACITY / REGIONS)

struct marking {
    struct cube_rig *rig;
    uint32_t flags;
};

static void record_marks(void *user, VkCommandBuffer commands)
{
    const struct marking *m = user;
    struct cube_rig *rig = m->rig;
    for (uint32_t i = 0; i < MARKED; i++) {
        rig->first = 0, rig->count = REGIONS, rig->flags = CUBE_CLEAR;
        cube_rig_record(rig, commands);
        rig->first = i, rig->count = 1, rig->flags = m->flags;
        cube_rig_record(rig, commands);
        rig->first = i * REGIONS, rig->count = REGIONS, rig->flags = CUBE_WORDS;
        cube_rig_record(rig, commands);
    }
    rig->first = 0, rig->count = REGIONS, rig->flags = CUBE_CLEAR;
    cube_rig_record(rig, commands);
}

/* Returns whether a tile of a level is requested. Packed levels are one tile. */
static bool is_marked(const struct ProbeOutput *words, uint32_t face, uint32_t level, uint32_t x,
                      uint32_t y)
{
    for (uint32_t i = 0; i < GRID * GRID; i++)
        if (words[face * GRID * GRID + i].level <= level &&
            (level > 2 || (i % GRID >> level == x && i / GRID >> level == y)))
            return true;
    return false;
}

static void check_marks(const struct cube_rig *rig, uint32_t sample, double lod)
{
    const struct CubeInput *in = &cube_rig_inputs((struct cube_rig *)rig)[sample];
    const struct ProbeOutput *words = &cube_rig_outputs(rig)[sample * REGIONS];
    const double direction[3] = {(double)in->direction[0], (double)in->direction[1],
                                 (double)in->direction[2]};
    lod = fmin(fmax(lod, 0), rig->level_count - 1);
    for (uint32_t level = (uint32_t)lod; level <= (uint32_t)ceil(lod); level++) {
        struct cube_taps taps = cube_oracle_bilinear(rig->size >> level, direction);
        for (uint32_t i = 0; i < taps.count; i++)
            if (taps.weights[i] > 1.0 / 512 &&
                !is_marked(words, taps.texels[i].face, level, taps.texels[i].x / 128,
                           taps.texels[i].y / 128))
                fail_msg("sample %u (%g %g %g), lod %g: tile of face %u, level %u, texel %u %u is "
                         "not marked",
                         sample, direction[0], direction[1], direction[2], lod, taps.texels[i].face,
                         level, taps.texels[i].x, taps.texels[i].y);
    }
    double texel = 2.0 * exp2(floor(lod + 0.25) + 1) / rig->size;
    for (uint32_t i = 0; i < REGIONS; i++) {
        uint32_t region = i % (GRID * GRID), x = region % GRID * 128, y = region / GRID * 128;
        if (words[i].level == SLUICE_MIP_UNTOUCHED)
            continue;
        assert_true(words[i].level >= (uint32_t)fmax(lod - 0.2, 0));
        double distance =
            cube_oracle_distance(direction, rig->size, i / (GRID * GRID), x, y, x + 128, y + 128);
        if (distance > texel * 0.5625 * 1.4143 + 1e-6)
            fail_msg("sample %u, lod %g: region %u of face %u is marked, %g texels away", sample,
                     lod, region, i / (GRID * GRID), distance / 2 * rig->size);
    }
}

static void check_feedback(struct harness *h, uint32_t flags)
{
    static double lods[MARKED];
    struct cube_rig rig;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info};
    roll_seed(33);
    if (cube_rig_init(&rig, h, info, 512, 1)) {
        cube_rig_settle(&rig, 3, 0, 0, 0);
        for (uint32_t round = 0; round < 6; round++) {
            for (uint32_t i = 0; i < MARKED; i++) {
                uint32_t face;
                double uv[2];
                lods[i] = draw() * 6 - 1;
                draw_position(i, slc_mip_size(512, (uint32_t)fmax(lods[i], 0)), &face, uv);
                cube_rig_inputs(&rig)[i] = cube_rig_input(&rig, face, uv[0], uv[1], exp2(lods[i]));
                cube_rig_inputs(&rig)[i].lod = (float)lods[i];
            }
            struct marking marking = {&rig, flags};
            harness_run(h, record_marks, &marking);
            for (uint32_t i = 0; i < MARKED; i++)
                check_marks(&rig, i, lods[i]);
        }
    }
    cube_rig_finish(&rig);
}

static void feedback_marks_every_face_that_a_sample_touches_and_no_region_far_away(void **state)
{
    check_feedback(*state, CUBE_FEEDBACK);
    check_feedback(*state, CUBE_FEEDBACK_LOD);
}

static void pixels_of_a_quad_share_the_feedback_of_all_faces(void **state)
{
    check_feedback(*state, CUBE_FEEDBACK_QUAD);
}

/* Runs in a language, and returns the outputs. */
static void run_in(struct cube_rig *rig, enum cube_form form, uint32_t flags,
                   struct ProbeOutput outputs[PROBE_CAPACITY])
{
    scene_clear_outputs(&rig->scene);
    cube_rig_use(rig, form);
    if (flags & CUBE_SAMPLE) {
        cube_rig_settle(rig, 1, 0, SAMPLES, flags);
    } else {
        struct marking marking = {rig, flags};
        harness_run(rig->scene.h, record_marks, &marking);
    }
    memcpy(outputs, cube_rig_outputs(rig), PROBE_CAPACITY * sizeof *outputs);
}

/* GPU compilers contract the languages' equal expressions differently. On an NVIDIA H200 LODs
 * differ by up to 1.2e-5, where gradients nearly cancel; samplers use steps of 2^-8. CI's lavapipe
 * rounds both alike. */
static bool same_output(struct harness *h, const struct ProbeOutput *a, const struct ProbeOutput *b)
{
    struct ProbeOutput near = *b;
    if (!harness_is_software(h)) {
        for (uint32_t c = 0; c < 4; c++)
            if (fabs((double)a->color[c] - (double)b->color[c]) <= 0x1p-12)
                near.color[c] = a->color[c];
        if (fabs((double)a->lod - (double)b->lod) <= 0x1p-14)
            near.lod = a->lod;
    }
    return memcmp(a, &near, sizeof near) == 0;
}

static void compare_languages(struct cube_rig *rig, uint32_t flags, uint32_t count)
{
    static struct ProbeOutput glsl[PROBE_CAPACITY], hlsl[PROBE_CAPACITY];
    run_in(rig, CUBE_FORM_CUBE, flags, glsl);
    run_in(rig, CUBE_FORM_HLSL, flags, hlsl);
    for (uint32_t i = 0; i < count; i++)
        if (!same_output(rig->scene.h, &glsl[i], &hlsl[i]))
            fail_msg("flags %u, output %u: HLSL %.9g %.9g, lod %.9g, level %u; GLSL %.9g %.9g, lod "
                     "%.9g, level %u",
                     flags, i, (double)hlsl[i].color[0], (double)hlsl[i].color[1],
                     (double)hlsl[i].lod, hlsl[i].level, (double)glsl[i].color[0],
                     (double)glsl[i].color[1], (double)glsl[i].lod, glsl[i].level);
}

static void hlsl_samples_and_marks_what_glsl_does(void **state)
{
    struct harness *h = *state;
    struct cube_rig rig;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .feedbackTimeoutTicks = 1000};
    if (h->mode != SLUICE_RESIDENCY_MODE_PAGED)
        return; /* a module for pages includes the code of other modes */
    roll_seed(34);
    assert_true(cube_rig_init(&rig, h, info, 512, h->anisotropy ? 4 : 1));
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t face;
        double uv[2], texels = exp2(draw() * 7 - 1);
        const double dx[2] = {texels, 0.2 * texels * draw()}, dy[2] = {0, texels * (0.2 + draw())};
        draw_position(i, 64, &face, uv);
        cube_rig_inputs(&rig)[i] = cube_rig_input_with(&rig, face, uv[0], uv[1], dx, dy);
        cube_rig_inputs(&rig)[i].lod = (float)log2(texels);
    }
    /* Few samples, so most of the cube stays coarse. */
    cube_rig_settle(&rig, 12, 0, 40, CUBE_FEEDBACK);
    compare_languages(&rig, CUBE_SAMPLE, SAMPLES);
    assert_in_range(count_missing(&rig), SAMPLES / 4, SAMPLES - 40);
    compare_languages(&rig, CUBE_FEEDBACK, MARKED * REGIONS);
    compare_languages(&rig, CUBE_FEEDBACK_QUAD, MARKED * REGIONS);
    compare_languages(&rig, CUBE_FEEDBACK_LOD, MARKED * REGIONS);
    cube_rig_finish(&rig);
}

static void directions_without_a_face_show_the_coarsest_level(void **state)
{
    static const float bad[][3] = {{0, 0, 0}, {NAN, 0, 1}, {INFINITY, 1, 0}, {0, -INFINITY, 0}};
    struct cube_rig rig;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .pDebug = &map_everything};
    if (cube_rig_init(&rig, *state, info, 512, 1)) {
        for (uint32_t i = 0; i < 6; i++) {
            struct CubeInput *input = &cube_rig_inputs(&rig)[i];
            *input = cube_rig_input(&rig, 0, 0.5, 0.5, 1);
            if (i < 4)
                memcpy(input->direction, bad[i], sizeof bad[i]);
            else
                input->dx[i - 4] = i == 4 ? NAN : INFINITY;
        }
        cube_rig_settle(&rig, 16, 0, 6, CUBE_SAMPLE | CUBE_FEEDBACK);
        for (uint32_t i = 0; i < 6; i++)
            assert_float_equal(pattern_level(cube_rig_outputs(&rig)[i].color), 9,
                               PATTERN_LEVEL_ERROR);
    }
    cube_rig_finish(&rig);
}

static void images_that_are_no_cubes_are_refused(void **state)
{
    static const struct {
        uint32_t width, height, layer_count;
        const char *why;
    } cases[] = {{64, 32, 6, "not square: width 64, height 32"},
                 {64, 64, 5,
                  "no multiple of 6: width 64, height 64, mipLevelCount 7, format "
                  "R8G8B8A8_UNORM (2), arrayLayerCount 5"}};
    struct harness *h = *state;
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    for (uint32_t i = 0; i < 2; i++) {
        SluiceImageSource *layer = pattern_source(PATTERN_HASH, cases[i].width, cases[i].height,
                                                  SLUICE_FORMAT_R8G8B8A8_UNORM);
        SluiceImageSource *layers[6] = {layer, layer, layer, layer, layer, layer}, *array;
        SluiceVulkanTexture textures[6];
        CHECK_OK(sluiceCreateArrayImageSource(layers, cases[i].layer_count, NULL, &array));
        SluiceVulkanTextureCreateInfo info = {
            .structSize = sizeof info, .source = array, .cube = true};
        h->quiet = true;
        CHECK_RESULT(
            sluiceAddVulkanTextureArray(scene.streamer, &info, cases[i].layer_count, textures),
            SLUICE_ERROR_INVALID_ARGUMENT);
        h->quiet = false;
        if (!strstr(h->last_message, cases[i].why))
            fail_msg("\"%s\" does not say \"%s\"", h->last_message, cases[i].why);
        sluiceDestroyImageSource(array);
        sluiceDestroyImageSource(layer);
    }
    scene_finish(&scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_of_cubes_are_filtered_across_edges_and_corners),
        cmocka_unit_test(cubes_show_only_what_is_resident_until_all_of_it_is),
        cmocka_unit_test(anisotropic_samples_touch_only_what_is_resident),
        cmocka_unit_test(edges_between_sharp_and_coarse_faces_do_not_show),
        cmocka_unit_test(feedback_marks_every_face_that_a_sample_touches_and_no_region_far_away),
        cmocka_unit_test(pixels_of_a_quad_share_the_feedback_of_all_faces),
        cmocka_unit_test(hlsl_samples_and_marks_what_glsl_does),
        cmocka_unit_test(directions_without_a_face_show_the_coarsest_level),
        cmocka_unit_test(images_that_are_no_cubes_are_refused),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
