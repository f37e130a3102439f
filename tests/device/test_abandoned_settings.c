/*
 * Frames that are abandoned in bunches, with textures that come and go inside them, under settings
 * that test_abandoned.c leaves at their defaults.
 */
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

enum { TEXTURES = 5, STEPS = 40, SAMPLES = 96 };

struct outcome {
    struct ProbeOutput outputs[TEXTURES][SAMPLES];
};

static void add(struct scene *scene, uint32_t i, uint32_t step)
{
    static const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_R8_UNORM,
                                           SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    uint32_t size = step % 3 == 0 ? 1024 : step % 3 == 1 ? 900 : 300;
    SluiceTextureId primary = SLUICE_NO_TEXTURE;
    if (i == 4)
        primary = scene->textures[3].used ? scene->textures[3].texture.textureId : primary;
    uint32_t t =
        scene_add_as(scene,
                     pattern_source(PATTERN_HASH, size, size + 60 * (i == 4 ? 3 : i),
                                    formats[i == 4 ? 0 : i % 3]),
                     VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT, 1, primary);
    assert_int_equal(t, i);
}

static void act(struct scene *scene, uint32_t step)
{
    uint32_t i = step % TEXTURES;
    if (step % 6 != 5)
        return;
    if (i == 3 || i == 4) { /* a primary and its follower come and go together */
        scene_remove(scene, 3);
        scene_remove(scene, 4);
        add(scene, 3, step);
        add(scene, 4, step);
    } else {
        scene_remove(scene, i);
        add(scene, i, step);
    }
}

static void aim(struct scene *scene, uint32_t leg)
{
    roll_seed(100 + leg);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        const struct scene_aim where = {
            roll() % 100 / 100.0, roll() % 100 / 100.0, 0.3, 0.3, -1, 4, 0, 0};
        scene_aim(scene, i, SAMPLES, &where);
        if (leg % 3 == 1 && i % 2)
            scene->textures[i].sample_count = 0;
    }
    memcpy(scene_inputs(scene, 4), scene_inputs(scene, 3), SAMPLES * sizeof(struct ProbeInput));
}

static uint32_t chance;
static uint32_t dice(void)
{
    chance = chance * 1664525u + 1013904223u;
    return chance >> 16;
}

static void bunch(struct harness *h, struct scene *scene, uint32_t step, bool *acted)
{
    SluiceStreamingFrame first = {.structSize = sizeof first}, frame = {.structSize = sizeof frame};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    uint32_t count = 1 + dice() % 3;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    for (uint32_t i = 0; i < count; i++) {
        VkCommandBuffer commands = h->commands[i];
        assert_int_equal(h->ResetCommandBuffer(commands, 0), VK_SUCCESS);
        assert_int_equal(h->BeginCommandBuffer(commands, &begin), VK_SUCCESS);
        if (dice() % 2)
            CHECK_OK(sluiceWaitVulkanStreamerIdle(scene->streamer));
        SluiceResult result =
            sluiceBeginStreamingFrame(scene->streamer, commands, h->time, i ? &frame : &first);
        CHECK_OK(result);
        if (!*acted && dice() % 2) {
            act(scene, step);
            *acted = true;
        }
        if (dice() % 2)
            scene_record(scene, commands);
        bool last = i + 1 == count;
        if (!last || dice() % 2)
            CHECK_OK(sluiceEndStreamingFrame(scene->streamer, commands));
        assert_int_equal(h->EndCommandBuffer(commands), VK_SUCCESS);
    }
    if (!*acted && dice() % 2) {
        act(scene, step);
        *acted = true;
    }
    if (count == 3 && dice() % 2) /* in two parts */
        CHECK_OK(sluiceAbandonStreamingFrame(scene->streamer, &frame));
    CHECK_OK(sluiceAbandonStreamingFrame(scene->streamer, &first));
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(h->ResetCommandBuffer(h->commands[i], 0), VK_SUCCESS);
}

static void take(struct harness *h, const SluiceVulkanStreamerCreateInfo *info, bool abandons,
                 struct outcome *outcome)
{
    struct scene scene;
    chance = 1;
    scene_init(&scene, h, *info);
    for (uint32_t i = 0; i < TEXTURES; i++)
        add(&scene, i, 0);
    for (uint32_t step = 0; step < STEPS; step++) {
        bool acted = false;
        if (step % 5 == 0)
            aim(&scene, step / 5);
        for (uint32_t k = 0; abandons && k < 2 && dice() % 2; k++)
            bunch(h, &scene, step, &acted);
        if (!acted)
            act(&scene, step);
        if (dice() % 4 == 0)
            CHECK_OK(sluiceWaitVulkanStreamerIdle(scene.streamer));
        harness_frame(h, scene.streamer, dice() % 3 == 0, scene_record, &scene);
    }
    aim(&scene, 99);
    scene_clear_outputs(&scene);
    scene_settle(&scene, 60);
    assert_int_equal(scene_missing(&scene), 0);
    for (uint32_t i = 0; i < TEXTURES; i++)
        memcpy(outcome->outputs[i], scene_outputs(&scene, i), sizeof outcome->outputs[i]);
    scene_finish(&scene);
}

static void a_walk_with_frames_abandoned_ends_as_one_without(void **state)
{
    const SluiceVulkanStreamerCreateInfo infos[] = {
        {.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
         .feedbackTimeoutTicks = 2,
         .packedLevelsOnDemand = true,
         .tilesPerFrame = 16},
        {.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
         .feedbackTimeoutTicks = 12,
         .feedbackInTurns = true,
         .texturesPerFrame = 1},
        {.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
         .feedbackTimeoutTicks = 3,
         .residencyFadeTicks = 4,
         .packedLevelsOnDemand = true,
         .feedbackReadbackSize = 160,
         .numExtraStandbyTiles = 6},
    };
    struct outcome *plain = calloc(1, sizeof *plain), *other = calloc(1, sizeof *other);
    assert_true(plain && other);
    for (uint32_t k = 0; k < sizeof infos / sizeof infos[0]; k++) {
        take(*state, &infos[k], false, plain);
        take(*state, &infos[k], true, other);
        for (uint32_t i = 0; i < TEXTURES; i++)
            for (uint32_t s = 0; s < SAMPLES; s++)
                if (memcmp(&plain->outputs[i][s], &other->outputs[i][s],
                           sizeof plain->outputs[i][s]) != 0)
                    fail_msg("setting %u, texture %u: sample %u differs", k, i, s);
    }
    free(plain);
    free(other);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(a_walk_with_frames_abandoned_ends_as_one_without)};
    tests[0].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
