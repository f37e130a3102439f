/* The path of a rasterizer: implicit derivatives, a few selected pixels write feedback. */
#include "device/painter.h"
#include "device/scene.h"

#include "support/map_everything.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PIXELS (PICTURE_SIZE * PICTURE_SIZE)

struct picture {
    struct scene scene;
    struct painter painter;
    uint32_t texture;
};

static void picture_init(struct picture *p, struct harness *h, bool everything, uint32_t width,
                         uint32_t height, float anisotropy)
{
    scene_init(
        &p->scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .pDebug = everything ? &map_everything : NULL,
                                         .tilesPerFrame = 64});
    p->texture = scene_add_as(
        &p->scene, pattern_source(PATTERN_LEVEL, width, height, SLUICE_FORMAT_R8G8B8A8_UNORM),
        VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, anisotropy,
        SLUICE_NO_TEXTURE);
    painter_init(&p->painter, &p->scene.prober, p->scene.textures[p->texture].probe);
}

static void picture_finish(struct picture *p)
{
    painter_finish(&p->painter);
    scene_finish(&p->scene);
}

/* The floor: `height` over it, in units of the texture's size. */
static void look(struct picture *p, double u, double v, double height, double angle, float bias)
{
    prober_inputs(&p->scene.prober)[0] =
        (struct ProbeInput){.uv = {(float)u, (float)v},
                            .dx = {(float)height, (float)angle},
                            .lodBias = bias,
                            .maxAnisotropy = p->scene.textures[p->texture].anisotropy};
}

static void frames(struct picture *p, uint32_t count)
{
    harness_settle(p->scene.h, p->scene.streamer, count, painter_record, &p->painter);
}

static uint32_t missing_pixels(struct picture *p)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++)
        count += prober_outputs(&p->scene.prober)[i].missingLevels != 0;
    return count;
}

/* Never finer than allowed, never the 0 of a texel that is not there. */
static void check_levels(struct picture *p)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        const struct ProbeOutput *out = &prober_outputs(&p->scene.prober)[i];
        double ellipse = scene_ellipse_lod(out, &p->scene.textures[p->texture]);
        if (out->level != SLUICE_MIP_UNTOUCHED &&
            !(pattern_level(out->color) >= (float)out->level - PATTERN_LEVEL_ERROR &&
              (out->level == 0 || ellipse >= out->level)))
            fail_msg("pixel (%u, %u) shows level %g (ellipse %g), allowed %u, wanted %u, lod %g",
                     i % PICTURE_SIZE, i / PICTURE_SIZE, (double)pattern_level(out->color), ellipse,
                     out->level, out->wantedLevel, (double)out->lod);
    }
}

static void compare_with_truth(struct harness *h, uint32_t width, uint32_t height, float anisotropy,
                               bool lattice, uint32_t frame_count)
{
    static struct ProbeOutput truth[PIXELS];
    for (int streamed = 0; streamed < 2; streamed++) {
        struct picture p;
        picture_init(&p, h, !streamed, width, height, anisotropy);
        p.painter.lattice = lattice;
        look(&p, 0.2, 0.1, 0.3, 1.0 / 100, -0.25f);
        for (uint32_t frame = 0; frame < frame_count; frame++) {
            frames(&p, 1);
            check_levels(&p);
        }
        assert_int_equal(missing_pixels(&p), 0);
        assert_int_equal(scene_non_resident(&p.scene), 0);
        if (!streamed)
            memcpy(truth, prober_outputs(&p.scene.prober), sizeof truth);
        else
            for (uint32_t i = 0; i < PIXELS; i++)
                assert_memory_equal(prober_outputs(&p.scene.prober)[i].color, truth[i].color,
                                    4 * sizeof(float));
        picture_finish(&p);
    }
}

static void settled_trilinear_picture_is_that_of_a_resident_texture(void **state)
{
    compare_with_truth(*state, 2048, 2048, 1, false, 60);
    compare_with_truth(*state, 1500, 1999, 1, false, 60);
}

static void settled_anisotropic_picture_is_that_of_a_resident_texture(void **state)
{
    struct harness *h = *state;
    if (!h->anisotropy)
        SKIP_TEST("the device has no anisotropic filtering");
    compare_with_truth(h, 2048, 2048, 8, false, 60);
    compare_with_truth(h, 1500, 1999, 16, false, 60);
}

/* Each pixel is selected once in 64 frames, so that a few more frames settle everything. */
static void lattice_settles_a_picture_in_seventy_frames(void **state)
{
    compare_with_truth(*state, 2048, 2048, 1, true, 74);
}

/* The device clamps the bias of an implicit sample, at maxSamplerLodBias, which may be as low as 2.
 */
static void any_lod_bias_shows_only_what_is_there(void **state)
{
    const float biases[] = {20, 40, 1e30f, INFINITY, -20, -40, -1e30f, -INFINITY, NAN};
    const double heights[] = {1e-8, 1e-6, 1e-3, 1, 1e3};
    for (uint32_t b = 0; b < sizeof biases / sizeof biases[0]; b++) {
        struct picture p;
        picture_init(&p, *state, false, 2048, 2048, 1);
        for (uint32_t i = 0; i < sizeof heights / sizeof heights[0]; i++) {
            look(&p, 0, 0, heights[i], 1.0 / 100, biases[b]);
            for (uint32_t frame = 0; frame < 4; frame++) {
                frames(&p, 1);
                check_levels(&p);
            }
        }
        assert_int_equal(scene_non_resident(&p.scene), 0);
        picture_finish(&p);
    }
}

static void moving_camera_never_shows_what_is_not_there(void **state)
{
    struct harness *h = *state;
    const float anisotropies[] = {1, 16};
    for (int a = 0; a < (h->anisotropy ? 2 : 1); a++) {
        struct picture p;
        picture_init(&p, h, false, 4000, 3000, anisotropies[a]);
        for (int frame = 0; frame < 90; frame++) {
            look(&p, 0.02 * frame, 0.01 * frame, 0.02 + 0.3 * (frame % 30) / 30.0, 1.0 / 64, 0);
            harness_frame(h, p.scene.streamer, true, painter_record, &p.painter);
            check_levels(&p);
        }
        assert_int_equal(scene_non_resident(&p.scene), 0);
        picture_finish(&p);
    }
}

static void samplers_that_clamp_show_only_what_is_there(void **state)
{
    struct harness *h = *state;
    if (!h->caps.shaderResourceMinLod)
        SKIP_TEST("the device has no shaderResourceMinLod");
    h->min_lod = true;
    compare_with_truth(h, 1500, 1999, h->anisotropy ? 8 : 1, false, 60);
    moving_camera_never_shows_what_is_not_there(state);
    h->min_lod = false;
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(settled_trilinear_picture_is_that_of_a_resident_texture),
        cmocka_unit_test(settled_anisotropic_picture_is_that_of_a_resident_texture),
        cmocka_unit_test(lattice_settles_a_picture_in_seventy_frames),
        cmocka_unit_test(any_lod_bias_shows_only_what_is_there),
        cmocka_unit_test(moving_camera_never_shows_what_is_not_there),
        cmocka_unit_test(samplers_that_clamp_show_only_what_is_there),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
