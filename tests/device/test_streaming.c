/* The loop from feedback to sharp texels: what shaders sample is what the source holds. */
#include "device/pattern.h"
#include "device/probe.h"

#include "base/checked.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

static struct harness *harness(void **state)
{
    return *state;
}

static SluiceVulkanStreamer *create(struct harness *h, SluiceVulkanStreamerCreateInfo info)
{
    harness_fill(h, &info);
    SluiceVulkanStreamer *streamer;
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    return streamer;
}

static SluiceVulkanTexture add(SluiceVulkanStreamer *streamer, SluiceImageSource *source)
{
    SluiceVulkanTextureCreateInfo info = {.source = source};
    SluiceVulkanTexture texture;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &info, &texture));
    return texture;
}

struct pass {
    struct prober *prober;
    struct probe_texture texture;
    uint32_t count, flags;
};

static void record_pass(void *user, VkCommandBuffer commands)
{
    struct pass *pass = user;
    prober_record(pass->prober, commands, pass->texture, 0, pass->count, pass->flags);
}

/* Isotropic footprints at random places. */
static void random_inputs(struct ProbeInput *inputs, uint32_t count, uint32_t width,
                          uint32_t height, double max_lod)
{
    for (uint32_t i = 0; i < count; i++) {
        double scale = exp2(max_lod * rand() / RAND_MAX);
        inputs[i] = (struct ProbeInput){
            .uv = {(float)((double)rand() / RAND_MAX), (float)((double)rand() / RAND_MAX)},
            .dx = {(float)(scale / width), 0},
            .dy = {0, (float)(scale / height)},
            .maxAnisotropy = 1};
    }
}

static void settled_sample_shows_the_level_that_was_wanted(void **state)
{
    struct harness *h = harness(state);
    SluiceVulkanStreamer *streamer =
        create(h, (SluiceVulkanStreamerCreateInfo){.feedbackTimeout = 100});
    struct prober prober;
    prober_init(&prober, h, streamer);
    SluiceImageSource *source =
        pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceVulkanTexture texture = add(streamer, source);
    struct pass pass = {&prober, prober_texture(&prober, &texture, 0, 0, 1), 2000,
                        PROBE_SAMPLE | PROBE_FEEDBACK | PROBE_RESIDENCY};
    srand(1);
    random_inputs(prober_inputs(&prober), pass.count, 1024, 1024, 6);
    harness_settle(h, streamer, 12, record_pass, &pass);
    const struct ProbeOutput *out = prober_outputs(&prober);
    for (uint32_t i = 0; i < pass.count; i++) {
        assert_int_equal(out[i].missingLevels, 0);
        assert_int_equal(out[i].nonResident, 0);
        assert_float_equal(out[i].color[0] * 16, out[i].lod, 0.15);
    }
    prober_finish(&prober);
    harness_destroy(h, streamer);
    sluiceDestroyImageSource(source);
    harness_check_silence(h);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(settled_sample_shows_the_level_that_was_wanted),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    status = cmocka_run_group_tests_name("streaming", tests, NULL, NULL);
    harness_finish(&h);
    return status;
}
