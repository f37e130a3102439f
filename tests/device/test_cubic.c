/* Bicubic filters of streamed textures, and derivatives, against sums over texels in long double.
 */
#include "device/demand_oracle.h"
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define SAMPLES 256u
#define TEXTURES 8u

static const uint32_t sizes[TEXTURES][2] = {{1024, 1024}, {1000, 700}, {300, 200}, {512, 2048},
                                            {64, 64},     {3, 200},    {1, 1},     {640, 640}};

struct expected {
    double color[3][4]; ///< and its derivatives
    bool jumps;         ///< derivatives are not sure
    double share;
    const struct demand_tap *tap;
    double weight;
};

static void add_touch(void *user, const struct demand_touch *touch)
{
    struct expected *e = user;
    float texel[4] = {0}; /* the border's */
    if (touch->x >= 0)
        pattern_texel(PATTERN_HASH, e->tap->level, (uint32_t)touch->x, (uint32_t)touch->y, texel);
    const double weights[3] = {touch->weight, touch->du, touch->dv};
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 4; c++)
            e->color[i][c] += e->weight * weights[i] * (double)texel[c];
}

/* Isotropic, at the LOD that the shader says it showed. */
static struct expected expect(const struct scene_texture *texture, SluiceTextureFilter filter,
                              const struct ProbeInput *in, double lod)
{
    const SluiceVulkanTexture *t = &texture->texture;
    struct SluiceDemandTexture like = {.width = t->width,
                                       .height = t->height,
                                       .shape = texture->u << SLUICE_DEMAND_MODE_U_SHIFT |
                                                texture->v << SLUICE_DEMAND_MODE_V_SHIFT};
    double wanted = log2(fmax((double)in->dx[0] * t->width, (double)in->dy[1] * t->height));
    double last = t->mipLevelCount - 1, shown = fmin(fmax(lod, 0), last);
    struct expected e = {.share = fmin(fmax(fmax(lod, 0) - wanted, 0), 1)};
    if (filter != SLUICE_TEXTURE_FILTER_SMART_CUBIC)
        e.share = filter == SLUICE_TEXTURE_FILTER_CUBIC;
    for (uint32_t level = 0; level <= (uint32_t)last; level++) {
        struct demand_tap tap = {.level = level, .u = in->uv[0], .v = in->uv[1], .cubic = e.share};
        e.weight = fmax(1 - fabs(shown - level), 0);
        e.tap = &tap;
        if (!(e.weight > 0))
            continue;
        demand_oracle_touches(&like, &tap, add_touch, &e);
        e.jumps = e.jumps || demand_oracle_jumps(&like, &tap);
    }
    return e;
}

static void describe(const struct scene_texture *texture, const struct ProbeInput *in,
                     const char *what, int channel, double found, double expected, double share)
{
    fail_msg("%u x %u, modes %d %d, uv %.9g %.9g, %g texels per pixel, share %g: channel %d of %s "
             "is %g, not %g",
             texture->texture.width, texture->texture.height, (int)texture->u, (int)texture->v,
             (double)in->uv[0], (double)in->uv[1],
             (double)(in->dx[0] * (float)texture->texture.width), share, channel, what, found,
             expected);
}

struct tally {
    uint32_t samples, cubic, mixed, coarse;
};

static void check_colors(struct scene *scene, SluiceTextureFilter filter, struct tally *tally)
{
    /* steps of fractions of texels and levels; and levels that the device derives */
    double tolerance = 0.02 + (double)harness_level_error(scene->h);
    for (uint32_t t = 0; t < TEXTURES; t++) {
        const struct scene_texture *texture = &scene->textures[t];
        const struct ProbeInput *in = scene_inputs(scene, t);
        const struct ProbeOutput *out = scene_outputs(scene, t);
        for (uint32_t i = 0; i < SAMPLES; i++) {
            if (out[i].level == SLUICE_MIP_UNTOUCHED)
                continue;
            struct expected e = expect(texture, filter, &in[i], (double)out[i].lod);
            for (int c = 0; c < 4; c++)
                if (!(fabs((double)out[i].color[c] - e.color[0][c]) < tolerance))
                    describe(texture, &in[i], "the color", c, (double)out[i].color[c],
                             e.color[0][c], e.share);
            tally->samples++;
            tally->cubic += e.share > 0;
            tally->mixed += e.share > 0 && e.share < 1;
            tally->coarse += out[i].missingLevels > 0;
        }
    }
}

static void record_slopes(void *user, VkCommandBuffer commands)
{
    struct scene *scene = user;
    for (uint32_t t = 0; t < TEXTURES; t++)
        prober_record(&scene->prober, commands, scene->textures[t].probe, t * SCENE_SAMPLES,
                      SAMPLES, PROBE_SLOPES);
}

static void check_slopes(struct scene *scene, SluiceTextureFilter filter)
{
    static float lods[TEXTURES][SAMPLES];
    uint32_t checked = 0;
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SAMPLES; i++)
            lods[t][i] = scene_outputs(scene, t)[i].lod;
    harness_frame(scene->h, scene->streamer, true, record_slopes, scene);
    for (uint32_t t = 0; t < TEXTURES; t++) {
        const struct scene_texture *texture = &scene->textures[t];
        for (uint32_t i = 0; i < SAMPLES; i++) {
            const struct ProbeInput *in = &scene_inputs(scene, t)[i];
            const struct ProbeOutput *out = &scene_outputs(scene, t)[i];
            struct expected e = expect(texture, filter, in, (double)lods[t][i]);
            float slopes[6];
            memcpy(slopes, out->footprint, sizeof slopes);
            for (int c = 0; c < 4; c++)
                if (!(fabs((double)out->color[c] - e.color[0][c]) < 0.02))
                    describe(texture, in, "the color", c, (double)out->color[c], e.color[0][c],
                             e.share);
            if (e.jumps)
                continue;
            checked++;
            double n = exp2(-floor(fmax((double)lods[t][i], 0)));
            for (int c = 0; c < 6; c++) {
                double size =
                    fmax(n * (c < 3 ? texture->texture.width : texture->texture.height), 1);
                if (!(fabs((double)slopes[c] - e.color[1 + c / 3][c % 3]) < 0.03 * size))
                    describe(texture, in, c < 3 ? "du" : "dv", c % 3, (double)slopes[c],
                             e.color[1 + c / 3][c % 3], e.share);
            }
        }
    }
    assert_true(checked > TEXTURES * SAMPLES / 2);
}

static void add_textures(struct scene *scene, SluiceTextureFilter filter, bool feedback)
{
    uint32_t modes = scene->h->mirror_clamp ? 5 : 4;
    scene->filter = filter;
    for (uint32_t t = 0; t < TEXTURES; t++) {
        uint32_t index = scene_add_as(
            scene,
            pattern_source(PATTERN_HASH, sizes[t][0], sizes[t][1], SLUICE_FORMAT_R8G8B8A8_UNORM),
            (VkSamplerAddressMode)(t % modes), (VkSamplerAddressMode)((t + t / modes) % modes), 1,
            SLUICE_NO_TEXTURE);
        assert_int_equal(scene->textures[index].texture.filter, filter);
        scene->textures[index].no_feedback = !feedback;
        scene_aim(scene, index, SAMPLES,
                  &(struct scene_aim){-0.5, -0.5, 2, 2, -3, t % 2 ? 4 : 1, 0, 0});
    }
}

static void start(struct scene *scene, struct harness *h, uint32_t tiles_per_frame)
{
    h->cubic = true;
    scene_init(
        scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100,
                                         .tilesPerFrame = tiles_per_frame});
}

static void finish(struct scene *scene)
{
    assert_int_equal(scene_non_resident(scene), 0);
    scene_finish(scene);
    scene->h->cubic = false;
}

static void bicubic_samples_are_sums_of_16_texels(void **state)
{
    for (int filter = 0; filter <= SLUICE_TEXTURE_FILTER_SMART_CUBIC; filter++) {
        struct scene scene;
        struct tally tally = {0};
        roll_seed(41);
        start(&scene, *state, 64);
        add_textures(&scene, (SluiceTextureFilter)filter, true);
        scene_settle(&scene, 20);
        assert_int_equal(scene_missing(&scene), 0);
        check_colors(&scene, (SluiceTextureFilter)filter, &tally);
        check_slopes(&scene, (SluiceTextureFilter)filter);
        assert_int_equal(tally.samples, TEXTURES * SAMPLES);
        if (filter == SLUICE_TEXTURE_FILTER_SMART_CUBIC) {
            assert_in_range(tally.cubic, TEXTURES * SAMPLES / 4, TEXTURES * SAMPLES * 7 / 8);
            assert_true(tally.mixed > TEXTURES * SAMPLES / 16);
        }
        finish(&scene);
    }
}

static void levels_that_are_resident_stand_in_and_count_as_magnified(void **state)
{
    struct scene scene;
    struct tally tally = {0};
    roll_seed(42);
    start(&scene, *state, 4);
    add_textures(&scene, SLUICE_TEXTURE_FILTER_SMART_CUBIC, true);
    for (int i = 0; i < 12; i++) {
        scene_settle(&scene, 1);
        check_colors(&scene, SLUICE_TEXTURE_FILTER_SMART_CUBIC, &tally);
    }
    assert_true(tally.coarse > SAMPLES && tally.cubic > TEXTURES * SAMPLES);
    finish(&scene);
}

static void packed_levels_alone_are_filtered_bicubically(void **state)
{
    struct scene scene;
    struct tally tally = {0};
    roll_seed(43);
    start(&scene, *state, 64);
    add_textures(&scene, SLUICE_TEXTURE_FILTER_CUBIC, false);
    scene_settle(&scene, 6);
    check_colors(&scene, SLUICE_TEXTURE_FILTER_CUBIC, &tally);
    check_slopes(&scene, SLUICE_TEXTURE_FILTER_CUBIC);
    assert_true(tally.coarse > 2 * SAMPLES);
    finish(&scene);
}

/* All samples are in one tile, and only bicubic ones reach into the one on the left. */
static void tiles_that_only_16_texels_reach_are_wanted(void **state)
{
    for (int filter = 1; filter <= SLUICE_TEXTURE_FILTER_SMART_CUBIC; filter++) {
        struct scene scene;
        roll_seed(44);
        start(&scene, *state, 64);
        scene.filter = (SluiceTextureFilter)filter;
        uint32_t t = scene_add(
            &scene, pattern_source(PATTERN_HASH, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM));
        scene_aim(&scene, t, SAMPLES,
                  &(struct scene_aim){129.15 / 1024, 0.3, 0.3 / 1024, 0.01, -3, -1, 0, 0});
        scene_settle(&scene, 20);
        assert_int_equal(scene_missing(&scene), 0);
        for (uint32_t i = 0; i < SAMPLES; i++) {
            const struct ProbeOutput *out = &scene_outputs(&scene, t)[i];
            struct expected e = expect(&scene.textures[t], scene.filter,
                                       &scene_inputs(&scene, t)[i], (double)out->lod);
            for (int c = 0; c < 4; c++)
                assert_true(fabs((double)out->color[c] - e.color[0][c]) < 0.02);
        }
        finish(&scene);
    }
}

static void wrong_filters_are_refused(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    SluiceImageSource *source = pattern_source(PATTERN_HASH, 64, 64, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceVulkanTextureCreateInfo info = {
        .structSize = sizeof info, .source = source, .filter = (SluiceTextureFilter)3};
    SluiceVulkanTexture texture;
    h->quiet = true;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h->last_message, "filter is 3"));
    info.filter = SLUICE_TEXTURE_FILTER_CUBIC;
    info.cube = true;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    h->quiet = false;
    scene_finish(&scene);
    sluiceDestroyImageSource(source);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(bicubic_samples_are_sums_of_16_texels),
        cmocka_unit_test(levels_that_are_resident_stand_in_and_count_as_magnified),
        cmocka_unit_test(packed_levels_alone_are_filtered_bicubically),
        cmocka_unit_test(tiles_that_only_16_texels_reach_are_wanted),
        cmocka_unit_test(wrong_filters_are_refused),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
