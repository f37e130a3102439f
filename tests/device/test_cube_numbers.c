/*
 * Cube maps that shaders choose by numbers that differ by invocation: the streamer's array has a
 * cube view per cube. Colors are compared with the oracle of test_cubes.c.
 */
#include "device/conform.h"
#include "device/cube_rig.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include "cube_numbers_comp.h"
#include "cube_numbers_separate_comp.h"

#include <math.h>

enum { SAMPLES = 512, SIZE = 256, CUBES = 2 * CUBE_RIG_CUBES };

/* Steps of 1/256 of bilinear weights, twice, and of 1/64 between levels. */
#define TOLERANCE (2.5 / 256 + 1.0 / 64)

struct numbers {
    struct cube_rig rig;
    SluiceImageSource *flat; ///< source of a texture that is no cube, between cubes
    SluiceVulkanTexture textures[CUBE_RIG_LAYERS]; ///< two more cubes of the rig's source
    struct conform_set set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
};

static void create_pipeline(struct numbers *n, bool separate)
{
    struct harness *h = n->rig.scene.h;
    struct prober *p = &n->rig.scene.prober;
    VkDescriptorSetLayout layouts[2];
    struct prober_specialization specialization;
    conform_create_set(h, 2, 0, sizeof(uint32_t), &n->set);
    conform_write_buffers(h, &n->set, 2,
                          (const struct harness_buffer *const[]){&p->inputs, &p->outputs});
    CHECK_OK(sluiceGetVulkanDescriptorSetLayout(n->rig.scene.streamer, &layouts[0]));
    layouts[1] = n->set.set_layout;
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(uint32_t)};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 2,
                                             .pSetLayouts = layouts,
                                             .pushConstantRangeCount = 1,
                                             .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &info, NULL, &n->layout), VK_SUCCESS);
    VkShaderModule module =
        separate ? conform_module(h, cube_numbers_separate_comp, sizeof cube_numbers_separate_comp)
                 : conform_module(h, cube_numbers_comp, sizeof cube_numbers_comp);
    n->pipeline =
        conform_compute_pipeline(h, n->layout, module, prober_specialize(p, &specialization));
}

static void add_cubes(struct numbers *n, SluiceVulkanTexture textures[CUBE_RIG_LAYERS])
{
    SluiceVulkanTextureCreateInfo create = {
        .structSize = sizeof create, .source = n->rig.source, .cube = true};
    CHECK_OK(
        sluiceAddVulkanTextureArray(n->rig.scene.streamer, &create, CUBE_RIG_LAYERS, textures));
}

/* Returns false if the mode has no cubes here. The first face of the last two cubes has an odd
 * index. */
static bool numbers_init(struct numbers *n, struct harness *h, SluiceTextureArray array)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .feedbackTimeoutTicks = 1000,
                                           .maxTextureCount = 40,
                                           .textureArray = array};
    if (!cube_rig_init(&n->rig, h, info, SIZE, 1))
        return false;
    n->flat = pattern_source(PATTERN_HASH, 64, 64, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceVulkanTexture flat;
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = n->flat};
    CHECK_OK(sluiceAddVulkanTexture(n->rig.scene.streamer, &create, &flat));
    add_cubes(n, n->textures);
    assert_int_equal(n->textures[0].tableIndex % 2, 1);
    create_pipeline(n, array == SLUICE_TEXTURE_ARRAY_SEPARATE);
    return true;
}

static void numbers_finish(struct numbers *n, bool used)
{
    struct harness *h = n->rig.scene.h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    if (used) {
        h->DestroyPipeline(h->device, n->pipeline, NULL);
        h->DestroyPipelineLayout(h->device, n->layout, NULL);
        conform_destroy_set(h, &n->set);
    }
    cube_rig_finish(&n->rig);
    if (used)
        sluiceDestroyImageSource(n->flat);
}

static void record(void *user, VkCommandBuffer commands)
{
    struct numbers *n = user;
    struct harness *h = n->rig.scene.h;
    const VkPipelineBindPoint point = VK_PIPELINE_BIND_POINT_COMPUTE;
    const VkDescriptorSet sets[] = {h->set, n->set.set};
    const uint32_t count = SAMPLES;
    h->CmdBindPipeline(commands, point, n->pipeline);
    h->CmdBindDescriptorSets(commands, point, n->layout, 0, 2, sets, 0, NULL);
    h->CmdPushConstants(commands, n->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof count, &count);
    h->CmdDispatch(commands, SAMPLES / 64, 1, 1);
}

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

static uint32_t number_of(const struct numbers *n, uint32_t cube)
{
    const SluiceVulkanTexture *textures = cube < CUBE_RIG_CUBES ? n->rig.textures : n->textures;
    return textures[cube % CUBE_RIG_CUBES * CUBE_ORACLE_FACES].tableIndex;
}

/* Draws any cube from `first` on at whole LODs. Every second sample is next to an edge. */
static void draw_inputs(struct numbers *n, uint32_t cubes[SAMPLES], uint32_t first)
{
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t level = i % n->rig.level_count, size = slc_mip_size(SIZE, level);
        double u = draw(), v = i % 2 ? draw() / size : draw();
        struct CubeInput *in = &cube_rig_inputs(&n->rig)[i];
        cubes[i] = first + (uint32_t)roll() % (CUBES - first);
        *in = cube_rig_input(&n->rig, (uint32_t)roll() % CUBE_ORACLE_FACES, i % 4 < 2 ? u : v,
                             i % 4 < 2 ? v : u, level == 0 ? 0.5 : exp2(level));
        in->number = number_of(n, cubes[i]);
    }
}

static void check(struct numbers *n, uint32_t first)
{
    uint32_t cubes[SAMPLES], missing = SAMPLES;
    struct harness *h = n->rig.scene.h;
    const struct ProbeOutput *outputs = cube_rig_outputs(&n->rig);
    draw_inputs(n, cubes, first);
    for (uint32_t frame = 0; frame < 30 && missing; frame++) {
        harness_settle(h, n->rig.scene.streamer, 1, record, n);
        assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
        missing = 0;
        for (uint32_t i = 0; i < SAMPLES; i++)
            missing += outputs[i].missingLevels != 0;
    }
    assert_int_equal(missing, 0);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double expected[4];
        cube_rig_expect(&n->rig, cubes[i] % CUBE_RIG_CUBES, &cube_rig_inputs(&n->rig)[i],
                        i % n->rig.level_count, expected);
        for (uint32_t c = 0; c < 4; c++)
            if (!(fabs((double)outputs[i].color[c] - expected[c]) <= TOLERANCE))
                fail_msg("sample %u of cube %u (number %u), channel %u: %g, not %g", i, cubes[i],
                         cube_rig_inputs(&n->rig)[i].number, c, (double)outputs[i].color[c],
                         expected[c]);
    }
}

static void check_array(struct harness *h, SluiceTextureArray array)
{
    struct numbers n = {0};
    roll_seed(40);
    bool used = numbers_init(&n, h, array);
    if (used) {
        check(&n, 0);
        CHECK_OK(sluiceRemoveVulkanTexture(n.rig.scene.streamer, n.rig.textures[0].textureId));
        check(&n, CUBE_RIG_CUBES);
        CHECK_OK(sluiceWaitVulkanStreamerIdle(n.rig.scene.streamer));
        add_cubes(&n, n.rig.textures);
        check(&n, 0);
    }
    numbers_finish(&n, used);
}

static void each_invocation_samples_the_cube_of_its_number(void **state)
{
    check_array(*state, SLUICE_TEXTURE_ARRAY_COMBINED);
}

static void cubes_are_images_with_samplers_of_their_own_array(void **state)
{
    check_array(*state, SLUICE_TEXTURE_ARRAY_SEPARATE);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(each_invocation_samples_the_cube_of_its_number),
        cmocka_unit_test(cubes_are_images_with_samplers_of_their_own_array),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
