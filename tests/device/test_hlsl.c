/* Compares shaders in HLSL with the same shaders in GLSL: results are bit-identical for any
 * resident tiles. */
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <string.h>

enum { TEXTURES = 4, WORDS = 256 };

struct session {
    struct scene scene;
    uint32_t flags;
    bool words; ///< true: compare the words of written feedback
};

static void record(void *user, VkCommandBuffer commands)
{
    struct session *s = user;
    for (uint32_t t = 0; t < TEXTURES; t++) {
        const struct probe_texture probe = s->scene.textures[t].probe;
        prober_record(&s->scene.prober, commands, probe, t * SCENE_SAMPLES, SCENE_SAMPLES,
                      s->flags);
        if (s->words)
            prober_record(&s->scene.prober, commands, probe, t * SCENE_SAMPLES, WORDS, PROBE_WORDS);
    }
}

/* Runs one frame with shaders in one language. Returns its outputs. */
static void run(struct session *s, bool hlsl, struct ProbeOutput outputs[PROBE_CAPACITY])
{
    struct harness *h = s->scene.h;
    scene_clear_outputs(&s->scene);
    h->hlsl = hlsl;
    prober_choose_pipeline(&s->scene.prober);
    harness_settle(h, s->scene.streamer, 1, record, s);
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    h->hlsl = false;
    prober_choose_pipeline(&s->scene.prober);
    memcpy(outputs, prober_outputs(&s->scene.prober), PROBE_CAPACITY * sizeof *outputs);
}

static void compare(struct session *s, const char *what, uint32_t flags)
{
    static struct ProbeOutput glsl[PROBE_CAPACITY], hlsl[PROBE_CAPACITY];
    uint32_t written = 0;
    s->flags = flags;
    run(s, false, glsl);
    run(s, true, hlsl);
    for (uint32_t i = 0; i < TEXTURES * SCENE_SAMPLES; i++) {
        static const struct ProbeOutput nothing;
        written += memcmp(&glsl[i], &nothing, sizeof nothing) != 0;
        if (memcmp(&glsl[i], &hlsl[i], sizeof glsl[i]) != 0)
            fail_msg("%s, input %u: HLSL %.9g %.9g, lod %.9g, level %u, missing %u; GLSL %.9g "
                     "%.9g, lod %.9g, level %u, missing %u",
                     what, i, (double)hlsl[i].color[0], (double)hlsl[i].color[1],
                     (double)hlsl[i].lod, hlsl[i].level, hlsl[i].missingLevels,
                     (double)glsl[i].color[0], (double)glsl[i].color[1], (double)glsl[i].lod,
                     glsl[i].level, glsl[i].missingLevels);
    }
    assert_true(written > (s->words ? WORDS : SCENE_SAMPLES));
}

static void add_textures(struct scene *scene)
{
    const VkSamplerAddressMode modes[TEXTURES] = {
        VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER};
    for (uint32_t t = 0; t < TEXTURES; t++) {
        const struct scene_aim aim = {-0.5, -0.5, 2, 2, -1, 6, t % 2 ? 8 : 0, t == 2 ? 0.5f : 0};
        scene->filter = t == 1 ? SLUICE_TEXTURE_FILTER_CUBIC : SLUICE_TEXTURE_FILTER_LINEAR;
        uint32_t at = scene_add_as(
            scene, pattern_source(PATTERN_HASH, 500, 512, SLUICE_FORMAT_R8G8B8A8_UNORM), modes[t],
            modes[TEXTURES - 1 - t], scene->h->anisotropy && t % 2 ? 4 : 1, SLUICE_NO_TEXTURE);
        assert_int_equal(at, t);
        scene_aim(scene, t, SCENE_SAMPLES, &aim);
    }
}

/* Writes feedback for few samples, so most of the textures stay coarse. */
static void stream_a_part(struct session *s)
{
    for (uint32_t t = 0; t < TEXTURES; t++)
        s->scene.textures[t].sample_count = 24;
    scene_settle(&s->scene, 12);
    for (uint32_t t = 0; t < TEXTURES; t++)
        s->scene.textures[t].sample_count = SCENE_SAMPLES;
}

static void samples_and_feedback_are_those_of_glsl(void **state)
{
    static struct session s;
    s = (struct session){0};
    roll_seed(61);
    scene_init(
        &s.scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    add_textures(&s.scene);
    stream_a_part(&s);
    compare(&s, "functions of numbers", PROBE_TWINS);
    compare(&s, "samples", PROBE_SAMPLE);
    uint32_t missing = scene_missing(&s.scene);
    print_message("# %u of %u samples are coarser than wanted\n", missing,
                  TEXTURES * SCENE_SAMPLES);
    assert_in_range(missing, SCENE_SAMPLES / 2, TEXTURES * SCENE_SAMPLES - SCENE_SAMPLES / 2);
    s.words = true;
    compare(&s, "feedback", PROBE_FEEDBACK);
    scene_finish(&s.scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {cmocka_unit_test(samples_and_feedback_are_those_of_glsl)};
    tests[0].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
