/*
 * Arguments that are 0, denormal, huge, infinite or no numbers, in one lane or in all: samples are
 * finite, of texels that are resident, and lanes beside them are not touched.
 */
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define TEXTURES 10u
#define ROUNDS 12u

static const float specials[] = {0.0f,   -0.0f,   1e-45f,    -1e-45f,  1e-38f,    FLT_MIN,
                                 1e-20f, 0.5f,    0.999999f, 1.0f,     -1.0f,     1e6f,
                                 -1e6f,  1e18f,   1e30f,     -1e30f,   0.9e33f,   -0.9e33f,
                                 1e36f,  FLT_MAX, -FLT_MAX,  INFINITY, -INFINITY, NAN};
#define SPECIALS (sizeof specials / sizeof specials[0])

static struct ProbeInput ordinary[TEXTURES][SCENE_SAMPLES];
static struct ProbeOutput expected[TEXTURES][SCENE_SAMPLES];

static void begin(struct scene *scene, struct harness *h)
{
    scene_init(
        scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1u << 20,
                                         .texturesPerFrame = TEXTURES,
                                         .residencyFadeTicks = 1u << 30});
    for (uint32_t t = 0; t < TEXTURES; t++) {
        VkSamplerAddressMode mode = (VkSamplerAddressMode)(t % 5);
        if (mode == VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE && !h->mirror_clamp)
            mode = VK_SAMPLER_ADDRESS_MODE_REPEAT;
        scene_add_as(scene,
                     pattern_source(PATTERN_LEVEL, t % 3 ? 1024 : 700, t % 2 ? 1024 : 1300,
                                    SLUICE_FORMAT_R16G16B16A16_SFLOAT),
                     mode, mode, h->anisotropy && t >= 5 ? 16 : 1, SLUICE_NO_TEXTURE);
        const struct scene_aim aim = {0.1, 0.1, 0.4, 0.4, 0, 2, 0, 0};
        scene_aim(scene, t, SCENE_SAMPLES, &aim);
    }
    scene_settle(scene, 12);
    for (uint32_t t = 0; t < TEXTURES; t++) {
        const struct scene_aim anywhere = {-1, -1, 3, 3, -2, 8, t >= 5 ? 20 : 0, 0};
        scene_aim(scene, t, SCENE_SAMPLES, &anywhere);
        scene->textures[t].no_feedback = true;
        memcpy(ordinary[t], scene_inputs(scene, t), sizeof ordinary[t]);
    }
    scene_settle(scene, 1);
    for (uint32_t t = 0; t < TEXTURES; t++)
        memcpy(expected[t], scene_outputs(scene, t), sizeof expected[t]);
}

/* Replaces one argument or many, of one lane in seven or of all, by special values. */
static bool make_special(struct ProbeInput *in, uint32_t lane, uint32_t round)
{
    if (round % 2 == 0 && lane % 7 != round % 7)
        return false;
    float *slots[] = {&in->uv[0], &in->uv[1], &in->dx[0],  &in->dx[1],
                      &in->dy[0], &in->dy[1], &in->lodBias};
    uint32_t count = roll() % 2 ? 1 : 1 + (uint32_t)roll() % 7;
    while (count-- > 0)
        *slots[roll() % 7] = specials[(uint32_t)roll() % SPECIALS];
    return true;
}

static void describe(const char *what, const struct ProbeInput *in, const struct ProbeOutput *out,
                     uint32_t texture)
{
    fail_msg("%s: texture %u, uv %g %g dx %g %g dy %g %g bias %g anisotropy %g; color %g %g %g "
             "%g, lod %g, level %u",
             what, texture, (double)in->uv[0], (double)in->uv[1], (double)in->dx[0],
             (double)in->dx[1], (double)in->dy[0], (double)in->dy[1], (double)in->lodBias,
             (double)in->maxAnisotropy, (double)out->color[0], (double)out->color[1],
             (double)out->color[2], (double)out->color[3], (double)out->lod, out->level);
}

static void check_special(const struct scene *scene, uint32_t t, uint32_t i)
{
    const struct ProbeOutput *out = &scene_outputs(scene, t)[i];
    const struct ProbeInput *inputs = scene->prober.inputs.mapped;
    const struct ProbeInput *in = &inputs[t * SCENE_SAMPLES + i];
    bool bordered = scene->textures[t].u == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    for (uint32_t c = 0; c < 4; c++)
        if (!(out->color[c] >= 0 && out->color[c] <= 1.001f))
            describe("not a color of the texture", in, out, t);
    if (!bordered && !(out->color[3] > 0.99f))
        describe("texels that are not resident", in, out, t);
    if (!bordered && !(pattern_level(out->color) >= (float)out->level - PATTERN_LEVEL_ERROR))
        describe("a finer level than is allowed", in, out, t);
    if (out->level >= 12 || !isfinite(out->lod) || out->nonResident)
        describe("no level, or of texels that are not resident", in, out, t);
}

static void draw_specials(struct scene *scene, uint32_t round)
{
    static bool special[TEXTURES][SCENE_SAMPLES];
    for (uint32_t t = 0; t < TEXTURES; t++) {
        memcpy(scene_inputs(scene, t), ordinary[t], sizeof ordinary[t]);
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            special[t][i] = make_special(&scene_inputs(scene, t)[i], i, round);
    }
    scene_clear_outputs(scene);
    scene_settle(scene, 1);
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            if (special[t][i])
                check_special(scene, t, i);
            else
                assert_memory_equal(scene_outputs(scene, t)[i].color, expected[t][i].color,
                                    sizeof expected[t][i].color);
}

static void arguments_of_any_value_sample_what_is_resident(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    roll_seed(71);
    begin(&scene, h);
    uint32_t clamped = 0;
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            clamped += expected[t][i].missingLevels != 0;
    assert_true(clamped > TEXTURES * SCENE_SAMPLES / 4);
    for (uint32_t round = 0; round < ROUNDS; round++)
        draw_specials(&scene, round);
    scene_finish(&scene);
}

static void samplers_that_clamp_take_arguments_of_any_value(void **state)
{
    struct harness *h = *state;
    if (!h->caps.shaderResourceMinLod)
        SKIP_TEST("the device has no shaderResourceMinLod");
    h->min_lod = true;
    arguments_of_any_value_sample_what_is_resident(state);
    h->min_lod = false;
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(arguments_of_any_value_sample_what_is_resident),
        cmocka_unit_test(samplers_that_clamp_take_arguments_of_any_value),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
