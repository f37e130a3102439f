/*
 * Fading: tiles that become resident appear step by step at the requested rate, without reading
 * missing texels. The final picture equals the one without fading.
 */
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TEXTURES 6u
#define FADE_TIME 16u /* frames per level */
#define STEP (1.0f / FADE_TIME)
#define QUANTUM (1.0f / SLUICE_SHOWN_STEPS)
#define COMPARED_FRAMES 70u
#define MAX_FRAMES 160u /* seven levels of fading, and the loads before */

struct kind {
    uint32_t width, height;
    SluiceFormat format;
    VkSamplerAddressMode mode;
    float anisotropy;
};

static const struct kind kinds[TEXTURES] = {
    {1024, 1024, SLUICE_FORMAT_R32G32B32A32_SFLOAT, VK_SAMPLER_ADDRESS_MODE_REPEAT, 1},
    {1000, 700, SLUICE_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, 1},
    {2048, 300, SLUICE_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1},
    {129, 2000, SLUICE_FORMAT_R8G8B8A8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT, 1},
    {1024, 1024, SLUICE_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLER_ADDRESS_MODE_REPEAT, 16},
    {700, 900, SLUICE_FORMAT_R32G32B32A32_SFLOAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 4}};

static struct ProbeOutput settled[TEXTURES][SCENE_SAMPLES], shown[TEXTURES][SCENE_SAMPLES];

/* Adds textures to a running streamer, so that all are loaded from nothing. */
static void begin(struct scene *scene, struct harness *h, uint64_t fade_time)
{
    scene_init(
        scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .texturesPerFrame = TEXTURES,
                                         .tilesPerFrame = 64,
                                         .residencyFadeTicks = fade_time});
    const struct scene_aim aim = {-0.5, -0.5, 2, 2, -1, 3, 0, 0};
    roll_seed(51);
    for (uint32_t t = 0; t < TEXTURES; t++) {
        const struct kind *k = &kinds[t];
        scene_add_as(scene, pattern_source(PATTERN_LEVEL, k->width, k->height, k->format), k->mode,
                     k->mode, h->anisotropy ? k->anisotropy : 1, SLUICE_NO_TEXTURE);
        struct scene_aim of_texture = aim;
        of_texture.max_ratio = k->anisotropy > 1 ? 8 : 0;
        scene_aim(scene, t, SCENE_SAMPLES, &of_texture);
    }
}

static void take_picture(struct scene *scene, struct ProbeOutput picture[][SCENE_SAMPLES])
{
    for (uint32_t t = 0; t < TEXTURES; t++)
        memcpy(picture[t], scene_outputs(scene, t), sizeof picture[t]);
}

static uint32_t fading(const struct scene *scene)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene->streamer, &stats);
    return stats.fadingTextures;
}

/* A widened footprint that gets narrower may leave a coarser neighbor: a few. */
static uint32_t jumps;

/* Checks the step between two samples. Returns true if the level changed. */
static bool check_step(const struct ProbeOutput *before, const struct ProbeOutput *now,
                       const struct kind *k, float error)
{
    assert_true(now->color[3] > 0.99f); /* missing texels are transparent */
    if (before->level == SLUICE_MIP_UNTOUCHED)
        return false;
    /* samplers end with the chain and begin with level 0 */
    float step = fmaxf(before->lod, 0) - fmaxf(now->lod, 0);
    float seen = pattern_level(before->color) - pattern_level(now->color);
    if (!(step >= 0 && step <= STEP + 1e-5f)) {
        print_message("# from lod %g to %g in a frame, anisotropy %g\n", (double)before->lod,
                      (double)now->lod, (double)k->anisotropy);
        assert_true(step >= 0 && k->anisotropy > 1);
        jumps++;
    }
    /* an 8-bit texture tells levels in 16 steps; anisotropy may go by whole levels */
    float rough = k->format == SLUICE_FORMAT_R8G8B8A8_UNORM ? 2 * PATTERN_LEVEL_ERROR : 0.01f;
    if (k->anisotropy <= 1 && !(fabsf(seen) <= STEP + QUANTUM + rough + error))
        fail_msg("from level %g to %g in a frame, lod %g to %g",
                 (double)pattern_level(before->color), (double)pattern_level(now->color),
                 (double)before->lod, (double)now->lod);
    return step > 0;
}

static uint32_t fade_to_the_end(struct harness *h, struct scene *scene)
{
    static struct ProbeOutput before[TEXTURES][SCENE_SAMPLES];
    const float error = harness_level_error(h);
    uint32_t steps = 0, frames = 0, idle = 0;
    take_picture(scene, before);
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            before[t][i].level = SLUICE_MIP_UNTOUCHED;
    for (; idle < 10; frames++) {
        scene_settle(scene, 1);
        take_picture(scene, shown);
        for (uint32_t t = 0; t < TEXTURES; t++)
            for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
                if (shown[t][i].level != SLUICE_MIP_UNTOUCHED)
                    steps += check_step(&before[t][i], &shown[t][i], &kinds[t], error);
        memcpy(before, shown, sizeof before);
        idle = fading(scene) ? 0 : idle + 1;
        assert_true(frames < MAX_FRAMES);
    }
    print_message("# settled after %u frames\n", frames - idle);
    return steps;
}

static void what_arrives_is_shown_step_by_step_and_settles_exactly(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    begin(&scene, h, 0);
    scene_settle(&scene, 20);
    assert_int_equal(scene_missing(&scene), 0);
    assert_int_equal(fading(&scene), 0);
    take_picture(&scene, settled);
    scene_finish(&scene);

    begin(&scene, h, FADE_TIME);
    jumps = 0;
    uint32_t steps = fade_to_the_end(h, &scene);
    assert_true(jumps <= steps / 10000);
    assert_true(steps > 20 * TEXTURES * SCENE_SAMPLES);
    assert_int_equal(scene_missing(&scene), 0);
    assert_int_equal(scene_non_resident(&scene), 0);
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            assert_memory_equal(shown[t][i].color, settled[t][i].color, sizeof shown[t][i].color);
    scene_finish(&scene);
}

/* Draws the frames of a fade, in which samplers or derivatives clamp. */
static struct ProbeOutput *draw_fade(struct harness *h, bool min_lod)
{
    const size_t picture = sizeof shown / sizeof(struct ProbeOutput);
    struct ProbeOutput *frames = malloc(COMPARED_FRAMES * sizeof shown);
    struct scene scene;
    assert_non_null(frames);
    h->min_lod = min_lod;
    begin(&scene, h, FADE_TIME);
    for (uint32_t i = 0; i < COMPARED_FRAMES; i++) {
        scene_settle(&scene, 1);
        take_picture(&scene, shown);
        memcpy(frames + i * picture, shown, sizeof shown);
    }
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
    h->min_lod = false;
    return frames;
}

static void samplers_that_clamp_show_what_wider_derivatives_show(void **state)
{
    struct harness *h = *state;
    if (!h->caps.shaderResourceMinLod)
        SKIP_TEST("the device has no shaderResourceMinLod");
    struct ProbeOutput *frames[2] = {draw_fade(h, false), draw_fade(h, true)};
    const float error = harness_level_error(h);
    float worst = 0;
    uint32_t clamped = 0;
    for (uint32_t i = 0; i < COMPARED_FRAMES * TEXTURES * SCENE_SAMPLES; i++) {
        const struct ProbeOutput *wide = &frames[0][i], *clamp = &frames[1][i];
        const struct kind *k = &kinds[i / SCENE_SAMPLES % TEXTURES];
        if (wide->level == SLUICE_MIP_UNTOUCHED)
            continue;
        assert_true(clamp->color[3] > 0.99f);
        /* anisotropic footprints differ, and 8-bit textures resolve 16 steps per level */
        if (k->anisotropy > 1 || k->format == SLUICE_FORMAT_R8G8B8A8_UNORM)
            continue;
        assert_true(wide->lod == clamp->lod);
        clamped += clamp->minLod > 0;
        float apart = fabsf(pattern_level(wide->color) - pattern_level(clamp->color));
        worst = fmaxf(worst, apart);
        if (apart > QUANTUM + 0.002f + error) /* sixteen-bit floats: 0.002 levels */
            fail_msg("clamped at %g: level %g, by derivatives %g", (double)clamp->minLod,
                     (double)pattern_level(clamp->color), (double)pattern_level(wide->color));
    }
    print_message("# %u clamped samples, at most %g levels apart\n", clamped, (double)worst);
    if (h->mode != SLUICE_RESIDENCY_MODE_PAGED) /* pages are filtered in the shader */
        assert_true(clamped > 1000);
    free(frames[0]);
    free(frames[1]);
}

/* A camera that turns all the time, with memory for a part of the textures. */
static void tiles_that_come_and_go_while_fading_are_not_missed(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 4,
                                         .tilesPerFrame = 32,
                                         .heapTileCapacity = 64,
                                         .maxHeapCount = 4,
                                         .texturesPerFrame = TEXTURES,
                                         .residencyFadeTicks = 6});
    roll_seed(52);
    for (uint32_t t = 0; t < TEXTURES; t++)
        scene_add_as(
            &scene, pattern_source(PATTERN_LEVEL, kinds[t].width, kinds[t].height, kinds[t].format),
            kinds[t].mode, kinds[t].mode, h->anisotropy ? kinds[t].anisotropy : 1,
            SLUICE_NO_TEXTURE);
    uint32_t faded = 0;
    for (uint32_t frame = 0; frame < 300; frame++) {
        if (frame % 5 == 0) {
            assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
            if (frame)
                scene_check_levels(&scene);
            uint32_t t = (uint32_t)roll() % TEXTURES;
            double left = (double)roll() / ROLL_MAX, top = (double)roll() / ROLL_MAX;
            struct scene_aim aim = {left, top, 0.3, 0.3, -1, 3, kinds[t].anisotropy > 1 ? 20 : 3,
                                    0};
            scene_aim(&scene, t, 128, &aim);
        }
        harness_frame(h, scene.streamer, frame % 3 == 0, scene_record, &scene);
        faded += fading(&scene) > 0;
    }
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_check_levels(&scene);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_true(stats.tilesUnmapped > 100);
    assert_true(faded > 100);
    scene_finish(&scene);
}

/* Another texture gets its regions and table entry, and begins with nothing. */
static void a_texture_that_goes_while_fading_takes_its_fade_along(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    begin(&scene, h, 1000);
    for (uint32_t round = 0; round < 4; round++) {
        /* queues that bind take their time */
        for (uint32_t frame = 0; frame < 6 || fading(&scene) < TEXTURES; frame++) {
            assert_true(frame < 100);
            scene_settle(&scene, 1);
        }
        scene_remove(&scene, 0);
        harness_settle(h, scene.streamer, round, scene_record, &scene);
        scene_add(&scene,
                  pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R16G16B16A16_SFLOAT));
        const struct scene_aim aim = {0, 0, 1, 1, 0, 1, 0, 0};
        scene_aim(&scene, 0, SCENE_SAMPLES, &aim);
        scene_settle(&scene, 1);
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            assert_int_equal(scene_outputs(&scene, 0)[i].level, SLUICE_MIP_UNTOUCHED);
    }
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

static void a_fade_that_would_not_end_is_refused(void **state)
{
    struct harness *h = *state;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyFadeTicks = (1ull << 40) + 1};
    harness_fill(h, &info);
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_INVALID_ARGUMENT);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(what_arrives_is_shown_step_by_step_and_settles_exactly),
        cmocka_unit_test(samplers_that_clamp_show_what_wider_derivatives_show),
        cmocka_unit_test(tiles_that_come_and_go_while_fading_are_not_missed),
        cmocka_unit_test(a_texture_that_goes_while_fading_takes_its_fade_along),
        cmocka_unit_test(a_fade_that_would_not_end_is_refused),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
