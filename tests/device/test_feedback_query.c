/* Feedback with the level that the device reports: sufficient for the picture, without extra
 * tiles. */
#include "device/painter.h"
#include "device/scene.h"

#include "support/map_everything.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PIXELS (PICTURE_SIZE * PICTURE_SIZE)

struct result {
    float level[PIXELS]; ///< shown level
    uint64_t tiles;
};

enum way { EVERYTHING, COMPUTED, QUERIED, QUERIED_LATE };

/* Draws a floor until each pixel had its turn to write. */
static void draw(struct harness *h, enum way way, uint32_t width, uint32_t height, float anisotropy,
                 float bias, struct result *result)
{
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .pDebug = way == EVERYTHING ? &map_everything : NULL});
    uint32_t t = scene_add_as(
        &scene, pattern_source(PATTERN_LEVEL, width, height, SLUICE_FORMAT_R8G8B8A8_UNORM),
        VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, anisotropy,
        SLUICE_NO_TEXTURE);
    struct painter painter;
    painter_init_as(&painter, &scene.prober, scene.textures[t].probe,
                    way == QUERIED        ? PAINTER_QUERY
                    : way == QUERIED_LATE ? PAINTER_QUERY_LATE
                                          : PAINTER_COMPUTE);
    painter.lattice = true;
    prober_inputs(&scene.prober)[0] = (struct ProbeInput){
        .uv = {0.2f, 0.1f}, .dx = {0.3f, 0.01f}, .lodBias = bias, .maxAnisotropy = anisotropy};
    harness_settle(h, scene.streamer, 72, painter_record, &painter);
    for (uint32_t i = 0; i < PIXELS; i++)
        result->level[i] = pattern_level(prober_outputs(&scene.prober)[i].color);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    result->tiles = stats.tilesMapped;
    painter_finish(&painter);
    scene_finish(&scene);
}

/*
 * A sample with exactly the levels it touches is clamped, because the computed level may be up to
 * its margin finer than the device's. The picture may be that much coarser, but finer only by the
 * device's deviation from the formula.
 */
static void check(struct harness *h, uint32_t width, uint32_t height, float anisotropy, float bias,
                  enum way way)
{
    static struct result truth, computed, queried;
    draw(h, EVERYTHING, width, height, anisotropy, bias, &truth);
    draw(h, COMPUTED, width, height, anisotropy, bias, &computed);
    draw(h, way, width, height, anisotropy, bias, &queried);
    const float margin = anisotropy > 1 ? 0.1875f : 0.125f, finer = 4 * harness_level_error(h);
    uint32_t different = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        float coarser = queried.level[i] - truth.level[i];
        if (!(coarser >= -finer - PATTERN_LEVEL_ERROR && coarser <= margin + PATTERN_LEVEL_ERROR))
            fail_msg("%ux%u, anisotropy %g: pixel (%u, %u) shows level %g, not %g", width, height,
                     (double)anisotropy, i % PICTURE_SIZE, i / PICTURE_SIZE,
                     (double)queried.level[i], (double)truth.level[i]);
        different += coarser > PATTERN_LEVEL_ERROR;
    }
    fprintf(stderr,
            "# %ux%u, anisotropy %g: %llu tiles by query, %llu computed; %u pixels differ\n", width,
            height, (double)anisotropy, (unsigned long long)queried.tiles,
            (unsigned long long)computed.tiles, different);
    assert_true(queried.tiles <= computed.tiles && queried.tiles < truth.tiles);
}

static void queried_feedback_is_enough_for_a_trilinear_picture(void **state)
{
    check(*state, 2048, 2048, 1, 0, QUERIED);
    check(*state, 1500, 1999, 1, -0.5f, QUERIED);
}

/* The control flow is uniform, so the device still has all pixels of each quad. */
static void a_query_behind_branches_is_enough_for_a_trilinear_picture(void **state)
{
    check(*state, 2048, 2048, 1, 0, QUERIED_LATE);
}

static void queried_feedback_is_enough_for_an_anisotropic_picture(void **state)
{
    struct harness *h = *state;
    if (!h->anisotropy)
        SKIP_TEST("the device has no anisotropic filtering");
    check(h, 2048, 2048, 8, 0, QUERIED);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(queried_feedback_is_enough_for_a_trilinear_picture),
        cmocka_unit_test(a_query_behind_branches_is_enough_for_a_trilinear_picture),
        cmocka_unit_test(queried_feedback_is_enough_for_an_anisotropic_picture),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
