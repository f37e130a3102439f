/* Integer textures: a sample is one texel of the source, at the level nearest to its LOD. */
#include "device/conform.h"
#include "device/scene.h"

#include "base/checked.h"
#include "image/format_size.h"
#include "support/map_everything.h"
#include "support/roll.h"
#include "support/test.h"

#include "integer_comp.h"
#include "integer_hlsl.h"
#include "integer_signed_comp.h"
#include "integer_signed_hlsl.h"

#include <math.h>
#include <string.h>

#define SAMPLES 256u

/* Numbers that identify level, layer and position. They use all bits, so SINT formats hold negative
 * ones. */
struct numbers {
    SluiceImageSource base;
    SluiceImageInfo info;
};

static uint32_t number_at(const struct numbers *n, uint32_t level, uint32_t x, uint32_t y,
                          uint32_t channel)
{
    uint32_t hash = (level * 0x9E3779B1u ^ x * 0x85EBCA77u ^ y * 0xC2B2AE3Du) + channel * 77u +
                    (uint32_t)n->info.format;
    hash = (hash ^ hash >> 15) * 0x2C1B3C6Du;
    return (hash ^ hash >> 12) * 0x297A2D39u;
}

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    *info = ((struct numbers *)source)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    const struct numbers *n = (const struct numbers *)source;
    SluiceFormatInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetFormatInfo(n->info.format, &info));
    uint32_t size = info.blockSize / info.channelCount;
    for (uint32_t y = 0; y < region->height; y++)
        for (uint32_t i = 0; i < region->width * info.channelCount; i++) {
            uint32_t number = number_at(n, region->mipLevel, region->x + i / info.channelCount,
                                        region->y + y, i % info.channelCount);
            memcpy((char *)texels + y * row_pitch + (size_t)i * size, &number, size);
        }
    return SLUICE_SUCCESS;
}

static void keep(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface numbers_interface = {sizeof numbers_interface, get_info,
                                                             read_region, keep, NULL};

static void numbers_init(struct numbers *n, SluiceFormat format, uint32_t width, uint32_t height)
{
    *n = (struct numbers){.base = {&numbers_interface},
                          .info = {.structSize = sizeof n->info,
                                   .width = width,
                                   .height = height,
                                   .mipLevelCount = slc_mip_count(slc_max_u32(width, height)),
                                   .format = format,
                                   .pName = "numbers"}};
}

struct rig {
    struct scene scene;
    struct numbers numbers;
    SluiceVulkanTexture texture;
    struct probe_texture set;
    VkPipeline pipeline;
};

static bool is_streamed(struct harness *h, SluiceFormat format)
{
    SluiceVulkanFormatCapabilities caps = {.structSize = sizeof caps};
    CHECK_OK(
        sluiceGetVulkanFormatCapabilities(h->instance, h->physical_device, h->get, format, &caps));
    assert_false(caps.linearFilter);
    return h->mode == SLUICE_RESIDENCY_MODE_SPARSE  ? caps.sampled && caps.sparse
           : h->mode == SLUICE_RESIDENCY_MODE_DENSE ? caps.sampled
                                                    : false;
}

/* The harness keeps the modules with its pipelines. */
static VkPipeline pipeline_of(const struct prober *p, bool is_signed, bool hlsl)
{
    struct harness *h = p->h;
    struct prober_specialization specialization;
    VkPipeline *pipeline = hlsl ? &h->probe_pipelines[HARNESS_HLSL_KINDS + is_signed]
                                : &h->probe_pipelines[HARNESS_PROBE_KINDS - 1 - is_signed];
    VkShaderModule module;
    if (*pipeline)
        return *pipeline;
    if (hlsl)
        module = is_signed ? conform_module(h, integer_signed_hlsl, sizeof integer_signed_hlsl)
                           : conform_module(h, integer_hlsl, sizeof integer_hlsl);
    else
        module = is_signed ? conform_module(h, integer_signed_comp, sizeof integer_signed_comp)
                           : conform_module(h, integer_comp, sizeof integer_comp);
    *pipeline =
        conform_compute_pipeline(h, p->layout, module, prober_specialize(p, &specialization));
    return *pipeline;
}

/* Returns false if the mode refuses the format, as is right. */
static bool rig_init(struct rig *rig, struct harness *h, SluiceFormat format, uint32_t width,
                     uint32_t height, bool everything)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .feedbackTimeoutTicks = 100,
                                           .pDebug = everything ? &map_everything : NULL};
    bool streamed = is_streamed(h, format);
    scene_init(&rig->scene, h, info);
    numbers_init(&rig->numbers, format, width, height);
    SluiceVulkanTextureCreateInfo create = {
        .structSize = sizeof create, .source = &rig->numbers.base, .maxAnisotropy = 4};
    h->quiet = !streamed;
    CHECK_RESULT(sluiceAddVulkanTexture(rig->scene.streamer, &create, &rig->texture),
                 streamed ? SLUICE_SUCCESS : SLUICE_ERROR_UNSUPPORTED);
    h->quiet = false;
    if (streamed) {
        assert_true(rig->texture.maxAnisotropy == 1.0f);
        rig->set = prober_nearest(&rig->scene.prober, &rig->texture);
        rig->pipeline = pipeline_of(&rig->scene.prober, slc_format_is_sint(format), false);
    }
    return streamed;
}

static void record(void *user, VkCommandBuffer commands)
{
    struct rig *rig = user;
    VkPipeline own = rig->scene.prober.pipeline;
    rig->scene.prober.pipeline = rig->pipeline;
    prober_record(&rig->scene.prober, commands, rig->set, 0, SAMPLES, PROBE_FEEDBACK);
    rig->scene.prober.pipeline = own;
}

static void settle(struct rig *rig, uint32_t frame_count)
{
    harness_settle(rig->scene.h, rig->scene.streamer, frame_count, record, rig);
    assert_int_equal(rig->scene.h->DeviceWaitIdle(rig->scene.h->device), VK_SUCCESS);
}

/* Samples inside texels of the level nearest to the LOD, so that rounding does not matter. */
static void draw_samples(struct rig *rig, double span)
{
    const SluiceImageInfo *info = &rig->numbers.info;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t level = (uint32_t)roll() % (info->mipLevelCount + 1); /* beyond the last, too */
        double offset = (double)roll() / ROLL_MAX * 0.9 - 0.45;
        double texels = level ? exp2(level + offset) : 0.3;
        uint32_t shown = slc_min_u32(level, info->mipLevelCount - 1);
        uint32_t width = slc_mip_size(info->width, shown);
        uint32_t height = slc_mip_size(info->height, shown);
        uint32_t columns = slc_max_u32(1, (uint32_t)(width * span));
        uint32_t rows = slc_max_u32(1, (uint32_t)(height * span));
        uint32_t x = (uint32_t)roll() % columns, y = (uint32_t)roll() % rows;
        double u = 0.1 + 0.8 * (double)roll() / ROLL_MAX;
        double v = 0.1 + 0.8 * (double)roll() / ROLL_MAX;
        prober_inputs(&rig->scene.prober)[i] =
            (struct ProbeInput){.uv = {(float)((x + u) / width), (float)((y + v) / height)},
                                .dx = {(float)(texels / info->width), 0},
                                .dy = {0, (float)(texels / info->height)},
                                .lodBias = (float)shown};
    }
}

static void check_sample(const struct rig *rig, uint32_t i, uint32_t level)
{
    const struct numbers *n = &rig->numbers;
    const struct ProbeInput *in = &prober_inputs((struct prober *)&rig->scene.prober)[i];
    const struct ProbeOutput *out = &prober_outputs(&rig->scene.prober)[i];
    SluiceFormatInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetFormatInfo(n->info.format, &info));
    uint32_t bits = 8 * info.blockSize / info.channelCount, unused = 32 - bits;
    uint32_t x = (uint32_t)((double)in->uv[0] * slc_mip_size(n->info.width, level));
    uint32_t y = (uint32_t)((double)in->uv[1] * slc_mip_size(n->info.height, level));
    for (uint32_t c = 0; c < 4; c++) {
        uint32_t expected = c == 3; /* value of channels that the format lacks */
        if (c < info.channelCount) {
            expected = number_at(n, level, x, y, c) << unused;
            expected = slc_format_is_sint(n->info.format) ? (uint32_t)((int32_t)expected >> unused)
                                                          : expected >> unused;
        }
        if (out->footprint[c] != expected)
            fail_msg("%s %ux%u, sample %u, level %u (%u, %u), channel %u: 0x%x, not 0x%x",
                     sluiceGetFormatName(n->info.format), n->info.width, n->info.height, i, level,
                     x, y, c, out->footprint[c], expected);
    }
}

static void check_all(const struct rig *rig)
{
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const struct ProbeOutput *out = &prober_outputs(&rig->scene.prober)[i];
        uint32_t level = (uint32_t)prober_inputs((struct prober *)&rig->scene.prober)[i].lodBias;
        assert_int_equal(out->missingLevels, 0);
        assert_int_equal(out->level, level);
        check_sample(rig, i, level);
    }
}

/* Runs in GLSL, then in HLSL. */
static void samples_are_texels_of_the_level_nearest_to_their_lod(void **state)
{
    static const uint32_t sizes[][2] = {{512, 256}, {301, 77}, {5, 3}};
    struct harness *h = *state;
    uint32_t count = 0;
    roll_seed(11);
    for (uint32_t f = SLUICE_FORMAT_R8_UINT; f <= SLUICE_FORMAT_R32G32B32A32_SINT; f++)
        for (uint32_t s = 0; s < 3; s++) {
            struct rig rig;
            if (rig_init(&rig, h, (SluiceFormat)f, sizes[s][0], sizes[s][1], true)) {
                draw_samples(&rig, 1);
                settle(&rig, 12);
                check_all(&rig);
                scene_clear_outputs(&rig.scene);
                rig.pipeline = pipeline_of(&rig.scene.prober, slc_format_is_sint(f), true);
                settle(&rig, 1);
                check_all(&rig);
                count += s == 0;
            }
            scene_finish(&rig.scene);
        }
    print_message("# formats.integer %u\n", count);
    assert_true(h->mode == SLUICE_RESIDENCY_MODE_PAGED ? count == 0 : count >= 9);
}

/* Streams from the packed levels to the finest. Every shown value must be a texel of its level. */
static void integers_are_streamed_by_feedback(void **state)
{
    struct rig rig;
    roll_seed(12);
    if (rig_init(&rig, *state, SLUICE_FORMAT_R32_UINT, 2048, 2048, false)) {
        uint32_t missing = 1;
        draw_samples(&rig, 0.2);
        for (uint32_t frame = 0; frame < 24; frame++) {
            settle(&rig, 1);
            missing = 0;
            for (uint32_t i = 0; i < SAMPLES; i++) {
                const struct ProbeOutput *out = &prober_outputs(&rig.scene.prober)[i];
                missing += out->missingLevels != 0;
                if (out->missingLevels != SLUICE_MIP_UNTOUCHED)
                    check_sample(&rig, i, out->level);
            }
        }
        SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
        CHECK_OK(sluiceGetVulkanStreamerStatistics(rig.scene.streamer, &stats));
        assert_int_equal(missing, 0);
        assert_true(stats.mappedTileCount < stats.tileCount / 2);
    }
    scene_finish(&rig.scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_are_texels_of_the_level_nearest_to_their_lod),
        cmocka_unit_test(integers_are_streamed_by_feedback),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
