/* Feedback out of a ray tracer's closest-hit shader, with the footprints of ray cones. */
#include "device/pattern.h"
#include "device/ray_tracer.h"

#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"
#include "vulkan/shader_twins.h"

#include <math.h>
#include <string.h>

enum { SIZE = 2048, REGIONS_X = 16, REGIONS = REGIONS_X * REGIONS_X }; /* tiles of 128 x 128 */

struct stage {
    struct harness *h;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *source;
    SluiceVulkanTexture texture;
    struct writer writer;
    struct ray_tracer tracer;
    uint8_t expected[REGIONS];
};

static void stage_init(struct stage *stage, struct harness *h)
{
    *stage = (struct stage){.h = h};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .feedbackTimeoutTicks = 1000};
    harness_fill(h, &info);
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &stage->streamer));
    stage->source = pattern_source(PATTERN_LEVEL, SIZE, SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceVulkanTextureCreateInfo texture = {.structSize = sizeof texture, .source = stage->source};
    CHECK_OK(sluiceAddVulkanTexture(stage->streamer, &texture, &stage->texture));
    writer_init(&stage->writer, h, stage->streamer, WRITER_LEVELS);
    ray_tracer_init(&stage->tracer, h, &stage->writer);
    stage->tracer.cone_angle = 1e-3f;
    harness_frame(h, stage->streamer, true, NULL, NULL); /* clears the maps */
}

static void stage_finish(struct stage *stage)
{
    ray_tracer_finish(&stage->tracer);
    writer_finish(&stage->writer);
    harness_destroy(stage->h, stage->streamer);
    sluiceDestroyImageSource(stage->source);
    harness_check_silence(stage->h);
}

static float draw(void)
{
    return (float)roll() / (float)ROLL_MAX;
}

static void expect(struct stage *stage, float u, float v, float width)
{
    const struct SluiceTextureEntry entry = {.width = SIZE,
                                             .height = SIZE,
                                             .mipLevelCount = 12,
                                             .regionWidth = 128,
                                             .regionHeight = 128,
                                             .regionCountX = REGIONS_X,
                                             .regionCountY = REGIONS_X};
    struct slc_twin_wants wants =
        slc_twin_wants(&entry, (struct slc_twin_vec2){u, v}, (struct slc_twin_vec2){width, 0},
                       (struct slc_twin_vec2){0, width}, 0, 1);
    const uint32_t *region = wants.regions.first; /* far from the borders there is one */
    assert_memory_equal(region, wants.regions.last, sizeof wants.regions.last);
    uint8_t *at = &stage->expected[region[1] * REGIONS_X + region[0]];
    if (wants.level < *at)
        *at = (uint8_t)wants.level;
}

/* Half way between the levels' steps and away from the borders, so that rounding decides nothing;
 * some rays miss the floor. */
static void aim(struct stage *stage, uint32_t count)
{
    memset(stage->expected, SLUICE_MIP_UNTOUCHED, sizeof stage->expected);
    stage->writer.count = count;
    for (uint32_t i = 0; i < count; i++) {
        float level = (float)(roll() % 4) + 0.6f;
        float width = exp2f(level) / (float)SIZE;
        float u = ((float)(roll() % REGIONS_X) + 0.25f + 0.5f * draw()) / REGIONS_X;
        float v = ((float)(roll() % REGIONS_X) + 0.25f + 0.5f * draw()) / REGIONS_X;
        bool misses = roll() % 4 == 0;
        writer_inputs(&stage->writer)[i] =
            (struct WriterInput){.uv = {misses ? u + 1.0f : u, v},
                                 .dx = {width / stage->tracer.cone_angle, 0},
                                 .tableIndex = stage->texture.tableIndex};
        if (!misses)
            expect(stage, u, v, width);
    }
}

static void a_closest_hit_shader_marks_what_its_ray_cone_covers(void **state)
{
    static struct stage stage;
    roll_seed(81);
    stage_init(&stage, *state);
    for (uint32_t round = 0; round < 5; round++) {
        aim(&stage, 20 + 10 * round);
        harness_run(stage.h, ray_tracer_record, &stage.tracer);
        const uint32_t *words = writer_words(&stage.writer, 0, REGIONS);
        for (uint32_t i = 0; i < REGIONS; i++)
            assert_int_equal(words[i], stage.expected[i]);
        harness_frame(stage.h, stage.streamer, true, NULL, NULL); /* resolves and clears */
    }
    stage_finish(&stage);
}

static void what_rays_hit_becomes_resident(void **state)
{
    static struct stage stage;
    roll_seed(82);
    stage_init(&stage, *state);
    aim(&stage, 60);
    harness_settle(stage.h, stage.streamer, 8, ray_tracer_record, &stage.tracer);
    uint8_t map[REGIONS];
    CHECK_OK(sluiceWriteMinMipData(manager_of(stage.streamer), stage.texture.textureId, REGIONS_X,
                                   REGIONS, map));
    uint32_t touched = 0;
    for (uint32_t i = 0; i < REGIONS; i++) {
        assert_true(map[i] <= stage.expected[i]);
        touched += stage.expected[i] != SLUICE_MIP_UNTOUCHED;
    }
    assert_true(touched > 20);
    stage_finish(&stage);
}

int main(void)
{
    struct harness h;
    int status = harness_init_with(&h, ray_device_extensions, RAY_DEVICE_EXTENSION_COUNT,
                                   ray_device_features());
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closest_hit_shader_marks_what_its_ray_cone_covers),
        cmocka_unit_test(what_rays_hit_becomes_resident),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
