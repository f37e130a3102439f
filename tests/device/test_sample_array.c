/* One sampler2DArray for all layers gives the same bits as each layer's own view. */
#include "device/array_scene.h"
#include "device/conform.h"
#include "device/painter.h"

#include "support/roll.h"
#include "support/test.h"

#include "array_comp.h"
#include "array_min_lod_comp.h"
#include "array_unpaged_comp.h"

#include <string.h>

#define SAMPLES 4096u
#define PIXELS (PICTURE_SIZE * PICTURE_SIZE)

struct array_probe {
    struct array_scene a;
    struct probe_texture sets[ARRAY_LAYERS];
    VkPipeline pipeline, own; ///< `own` is the prober's
    uint32_t layer;           ///< sampled layer, or PROBE_ALL_LAYERS with their number
};

static VkShaderModule create_module(const struct prober *p)
{
    if (p->h->min_lod)
        return conform_module(p->h, array_min_lod_comp, sizeof array_min_lod_comp);
    return p->paged ? conform_module(p->h, array_comp, sizeof array_comp)
                    : conform_module(p->h, array_unpaged_comp, sizeof array_unpaged_comp);
}

static VkPipeline create_pipeline(struct prober *p)
{
    struct prober_specialization specialization;
    return conform_compute_pipeline(p->h, p->layout, create_module(p),
                                    prober_specialize(p, &specialization));
}

static void probe_init(struct array_probe *p, struct harness *h, const uint32_t size[2],
                       SluiceFormat format, VkSamplerAddressMode u, VkSamplerAddressMode v,
                       float anisotropy)
{
    *p = (struct array_probe){0};
    scene_init(
        &p->a.scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .tilesPerFrame = 64});
    for (uint32_t i = 0; i < ARRAY_LAYERS; i++)
        p->a.layers[i] = pattern_source(array_scene_kind(i), size[0], size[1], format);
    CHECK_OK(sluiceCreateArrayImageSource(p->a.layers, ARRAY_LAYERS, NULL, &p->a.source));
    SluiceVulkanTextureCreateInfo create = {
        .structSize = sizeof create, .source = p->a.source, .addressModeU = u, .addressModeV = v};
    SluiceVulkanTexture textures[ARRAY_LAYERS];
    CHECK_OK(sluiceAddVulkanTextureArray(p->a.scene.streamer, &create, ARRAY_LAYERS, textures));
    for (uint32_t i = 0; i < ARRAY_LAYERS; i++)
        p->sets[i] = prober_layer(&p->a.scene.prober, &textures[i], u, v, anisotropy);
    p->pipeline = create_pipeline(&p->a.scene.prober);
    p->own = p->a.scene.prober.pipeline;
}

static void probe_finish(struct array_probe *p)
{
    struct harness *h = p->a.scene.h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    h->DestroyPipeline(h->device, p->pipeline, NULL);
    array_scene_finish(&p->a);
}

static void record(void *user, VkCommandBuffer commands)
{
    struct array_probe *p = user;
    uint32_t set = p->layer & PROBE_ALL_LAYERS ? 0 : p->layer;
    p->a.scene.prober.pipeline = p->pipeline;
    prober_record(&p->a.scene.prober, commands, p->sets[set], 0, SAMPLES, p->layer);
    p->a.scene.prober.pipeline = p->own;
}

/* Draws samples between texels of level 0 and the coarsest level, wrapped, at all angles. */
static void draw_inputs(struct array_probe *p, const uint32_t size[2], float anisotropy)
{
    struct ProbeInput *inputs = prober_inputs(&p->a.scene.prober);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float texels = (float)(1u << roll() % 9) * 0.3f, numbers[6];
        for (uint32_t k = 0; k < 6; k++)
            numbers[k] = (float)roll() / (float)ROLL_MAX * 2 - 1;
        inputs[i] = (struct ProbeInput){
            .uv = {numbers[0] * 1.5f, numbers[1] * 1.5f},
            .dx = {numbers[2] * texels / (float)size[0], numbers[3] * texels / (float)size[1]},
            .dy = {numbers[4] * texels / (float)size[0], numbers[5] * texels / (float)size[1]},
            .lodBias = i % 5 ? 0.0f : (float)(i % 7) - 3,
            .maxAnisotropy = anisotropy};
    }
}

/* Compares both samples of each output. Returns the number of samples that are coarser than
 * requested. */
static uint32_t check_equal(const struct ProbeOutput *outputs, uint32_t count)
{
    uint32_t missing = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bits[4];
        memcpy(bits, outputs[i].color, sizeof bits);
        for (uint32_t c = 0; c < 4; c++)
            if (bits[c] != outputs[i].footprint[c])
                fail_msg("sample %u, channel %u: bits %08x of the array, %08x of the layer", i, c,
                         bits[c], outputs[i].footprint[c]);
        assert_int_equal(outputs[i].missingLevels, outputs[i].wantedLevel);
        missing += outputs[i].missingLevels != 0;
    }
    return missing;
}

static void check_explicit(struct harness *h, const uint32_t size[2], SluiceFormat format,
                           VkSamplerAddressMode u, VkSamplerAddressMode v, float anisotropy)
{
    static struct ProbeOutput uniform[ARRAY_LAYERS][SAMPLES];
    struct array_probe p;
    probe_init(&p, h, size, format, u, v, anisotropy);
    draw_inputs(&p, size, anisotropy);
    const struct ProbeOutput *outputs = prober_outputs(&p.a.scene.prober);
    for (p.layer = 0; p.layer < ARRAY_LAYERS; p.layer++)
        for (uint32_t frame = 0; frame < 7;
             frame++) { /* first nothing is resident, then parts, then all requested tiles */
            harness_settle(h, p.a.scene.streamer, 1, record, &p);
            assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
            uint32_t missing = check_equal(outputs, SAMPLES);
            assert_true(frame > 0 || missing > 0);
        }
    for (p.layer = 0; p.layer < ARRAY_LAYERS; p.layer++) {
        harness_run(h, record, &p);
        memcpy(uniform[p.layer], outputs, sizeof uniform[p.layer]);
    }
    assert_memory_not_equal(uniform[0][1].color, uniform[1][1].color, 4 * sizeof(float));
    p.layer = PROBE_ALL_LAYERS | ARRAY_LAYERS;
    harness_run(h, record, &p);
    for (uint32_t i = 0; i < SAMPLES; i++)
        assert_memory_equal(outputs[i].color, uniform[i % ARRAY_LAYERS][i].color,
                            4 * sizeof(float));
    probe_finish(&p);
}

static void samples_of_an_array_are_those_of_its_layers(void **state)
{
    static const uint32_t size[2] = {1024, 512}, odd[2] = {700, 1300}, packed[2] = {512, 300};
    check_explicit(*state, size, SLUICE_FORMAT_R8G8B8A8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                   VK_SAMPLER_ADDRESS_MODE_REPEAT, 1);
    check_explicit(*state, odd, SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                   VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                   1);
    check_explicit(*state, packed, SLUICE_FORMAT_R8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                   VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1);
}

static void anisotropic_samples_of_an_array_are_those_of_its_layers(void **state)
{
    static const uint32_t size[2] = {1024, 512};
    struct harness *h = *state;
    if (!h->anisotropy)
        SKIP_TEST("the device has no anisotropic filtering");
    check_explicit(h, size, SLUICE_FORMAT_R8G8B8A8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                   VK_SAMPLER_ADDRESS_MODE_REPEAT, 8);
}

static void check_pictures(struct harness *h, float anisotropy)
{
    static const uint32_t size[2] = {2048, 1024};
    struct array_probe p;
    probe_init(&p, h, size, SLUICE_FORMAT_R8G8B8A8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
               VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, anisotropy);
    prober_inputs(&p.a.scene.prober)[0] = (struct ProbeInput){.uv = {0.2f, 0.1f},
                                                              .dx = {0.3f, 1.0f / 100},
                                                              .lodBias = -0.25f,
                                                              .maxAnisotropy = anisotropy};
    for (uint32_t layer = 0; layer < ARRAY_LAYERS; layer++) {
        struct painter painter;
        painter_init_as(&painter, &p.a.scene.prober, p.sets[layer], PAINTER_LAYER);
        painter.layer = layer;
        for (uint32_t frame = 0; frame < 8; frame++) {
            harness_settle(h, p.a.scene.streamer, 1, painter_record, &painter);
            assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
            uint32_t missing = check_equal(prober_outputs(&p.a.scene.prober), PIXELS);
            assert_true(frame > 0 || missing > PIXELS / 4);
        }
        painter_finish(&painter);
    }
    probe_finish(&p);
}

static void pictures_of_an_array_are_those_of_its_layers(void **state)
{
    struct harness *h = *state;
    check_pictures(h, 1);
    if (h->anisotropy)
        check_pictures(h, 8);
}

static void samplers_that_clamp_show_the_same_of_arrays(void **state)
{
    static const uint32_t size[2] = {1024, 512};
    struct harness *h = *state;
    if (!h->caps.shaderResourceMinLod)
        SKIP_TEST("the device has no shaderResourceMinLod");
    h->min_lod = true;
    check_explicit(h, size, SLUICE_FORMAT_R8G8B8A8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                   VK_SAMPLER_ADDRESS_MODE_REPEAT, 1);
    check_pictures(h, 1);
    h->min_lod = false;
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_of_an_array_are_those_of_its_layers),
        cmocka_unit_test(anisotropic_samples_of_an_array_are_those_of_its_layers),
        cmocka_unit_test(pictures_of_an_array_are_those_of_its_layers),
        cmocka_unit_test(samplers_that_clamp_show_the_same_of_arrays),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
