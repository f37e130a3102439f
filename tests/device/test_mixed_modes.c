/* Sparse, paged and dense textures of one streamer: the mode of each, the budget that they share.
 */
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define MIB (UINT64_C(1) << 20)
#define SIZE 1024u

static struct harness h;
static struct scene scene;

static const SluiceFormat rgba8 = SLUICE_FORMAT_R8G8B8A8_UNORM, rg8 = SLUICE_FORMAT_R8G8_UNORM;

/* Heaps of 1 MiB. The device seems to have no sparse images of rg8. */
static void open_scene(bool chooses, bool mixes)
{
    static const SluiceVulkanStreamerDebugInfo debug = {.structSize = sizeof debug,
                                                        .notSparse = SLUICE_FORMAT_R8G8_UNORM};
    h.leaves_auto = chooses;
    scene_init(
        &scene, &h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 2,
                                         .numExtraStandbyTiles = 20,
                                         .heapTileCapacity = 16,
                                         .pDebug = &debug,
                                         .pagedTextures = mixes});
    h.leaves_auto = false;
}

static void close_scene(void)
{
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    scene_finish(&scene);
}

static SluiceVulkanContextStatistics memory(void)
{
    SluiceVulkanContextStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanContextStatistics(h.context, &s));
    return s;
}

static uint64_t tiles_mapped(void)
{
    SluiceVulkanStreamerStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(scene.streamer, &s));
    return s.tilesMapped;
}

static uint32_t add(enum pattern_kind kind, uint32_t width, uint32_t height, SluiceFormat format,
                    SluiceResidencyMode expected)
{
    uint32_t t = scene_add(&scene, pattern_source(kind, width, height, format));
    assert_int_equal(scene.textures[t].texture.residencyMode, expected);
    return t;
}

/* Samples all over the texture, of level 0. */
static void look_at(uint32_t texture, uint32_t count)
{
    scene_aim(&scene, texture, count, &(struct scene_aim){0, 0, 1, 1, 0, 0.2, 0, 0});
}

/* Every level that is seen meanwhile is right. */
static void run_frames(uint32_t count, bool checks)
{
    for (uint32_t i = 0; i < count; i++) {
        scene_settle(&scene, 1);
        if (checks)
            scene_check_levels(&scene);
        assert_int_equal(scene_non_resident(&scene), 0);
        if (memory().memoryBudget != UINT64_MAX)
            assert_true(memory().tileMemorySize <= memory().memoryBudget);
    }
}

static void run_until_sharp(uint32_t limit, bool checks)
{
    for (uint32_t i = 0; i < limit; i++) {
        run_frames(1, checks);
        if (i > 4 && scene_missing(&scene) == 0)
            return;
    }
    fail_msg("%u samples are not sharp after %u frames", scene_missing(&scene), limit);
}

static void record_fetch(void *user, VkCommandBuffer commands)
{
    const struct scene_texture *texture = user;
    prober_record(&scene.prober, commands, texture->probe, 0, SCENE_SAMPLES, PROBE_FETCH);
}

/* Checks that texels of level 0 are those of the pattern. */
static void check_texels(enum pattern_kind kind, uint32_t index)
{
    static struct ProbeInput kept[SCENE_SAMPLES];
    const struct scene_texture *texture = &scene.textures[index];
    struct ProbeInput *inputs = prober_inputs(&scene.prober);
    SluiceFormatInfo format = {.structSize = sizeof format};
    CHECK_OK(sluiceGetFormatInfo(texture->info.format, &format));
    memcpy(kept, inputs, sizeof kept);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
        inputs[i] = (struct ProbeInput){.uv = {(float)((uint32_t)roll() % texture->info.width),
                                               (float)((uint32_t)roll() % texture->info.height)}};
    harness_run(&h, record_fetch, (void *)texture);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++) {
        const float *color = prober_outputs(&scene.prober)[i].color;
        float rgba[4];
        pattern_texel(kind, 0, (uint32_t)inputs[i].uv[0], (uint32_t)inputs[i].uv[1], rgba);
        for (uint32_t c = 0; c < format.channelCount; c++)
            if (lrintf(color[c] * 255) != lrintf(rgba[c] * 255))
                fail_msg("texture %u, texel %g %g, channel %u: %g, not %g", index,
                         (double)inputs[i].uv[0], (double)inputs[i].uv[1], c, (double)color[c],
                         (double)rgba[c]);
    }
    memcpy(inputs, kept, sizeof kept);
    scene_clear_outputs(&scene);
}

static void auto_picks_a_mode_for_each_texture(void **state)
{
    (void)state;
    open_scene(true, true);
    const uint32_t t[] = {
        add(PATTERN_HASH, 700, 300, rgba8, SLUICE_RESIDENCY_MODE_SPARSE),
        add(PATTERN_HASH, 700, 300, rg8, SLUICE_RESIDENCY_MODE_PAGED),
        add(PATTERN_HASH, 64, 64, rgba8, SLUICE_RESIDENCY_MODE_DENSE),
        add(PATTERN_HASH, 256, 128, rg8, SLUICE_RESIDENCY_MODE_DENSE),
        add(PATTERN_HASH, 1024, 512, rg8, SLUICE_RESIDENCY_MODE_PAGED),
    };
    scene.texture_mode = SLUICE_RESIDENCY_MODE_PAGED; /* whatever the device can */
    const uint32_t paged = add(PATTERN_HASH, 300, 500, rgba8, SLUICE_RESIDENCY_MODE_PAGED);
    const uint32_t count = sizeof t / sizeof t[0];
    for (uint32_t i = 0; i < count; i++)
        look_at(t[i], SCENE_SAMPLES);
    look_at(paged, SCENE_SAMPLES);
    run_until_sharp(30, false);
    for (uint32_t i = 0; i < count; i++)
        check_texels(PATTERN_HASH, t[i]);
    check_texels(PATTERN_HASH, paged);
    assert_true(memory().pageMemorySize > 0 && memory().heapMemorySize > 0);
    scene_remove(&scene, t[1]);
    scene_remove(&scene, t[0]);
    run_until_sharp(30, false);
    close_scene();
}

static double mean_level(uint32_t texture)
{
    double sum = 0;
    for (uint32_t i = 0; i < scene.textures[texture].sample_count; i++)
        sum += scene_outputs(&scene, texture)[i].missingLevels;
    return sum / scene.textures[texture].sample_count;
}

/* 21 MiB of tiles in 8 MiB: all become coarser alike. Then what is seen takes it all, and back. */
static void sparse_and_paged_textures_share_a_budget(void **state)
{
    (void)state;
    open_scene(false, true);
    h.quiet = true; /* images of pages are refused until heaps have made room */
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 8 * MIB));
    scene.texture_mode = SLUICE_RESIDENCY_MODE_SPARSE;
    for (uint32_t i = 0; i < 2; i++)
        add(PATTERN_LEVEL, SIZE, SIZE, rgba8, SLUICE_RESIDENCY_MODE_SPARSE);
    look_at(0, SCENE_SAMPLES / 2);
    run_until_sharp(30, true); /* 6 MiB of heaps */
    scene.texture_mode = SLUICE_RESIDENCY_MODE_PAGED;
    for (uint32_t i = 2; i < 4; i++)
        add(PATTERN_LEVEL, SIZE, SIZE, rgba8, SLUICE_RESIDENCY_MODE_PAGED);
    for (uint32_t i = 0; i < 4; i++)
        look_at(i, SCENE_SAMPLES / 2);
    run_frames(60, true);
    uint64_t mapped = tiles_mapped();
    run_frames(20, true);
    assert_int_equal(tiles_mapped(), mapped); /* settled */
    assert_true(memory().tileMemorySize > 7 * MIB);
    double sparse = 0.5 * (mean_level(0) + mean_level(1));
    double paged = 0.5 * (mean_level(2) + mean_level(3));
    print_message("# levels too coarse: sparse %.2f, paged %.2f\n", sparse, paged);
    assert_true(sparse > 0.2 && paged > 0.2 && fabs(sparse - paged) < 0.5);
    for (uint32_t i = 0; i < 2; i++) { /* a paged texture alone, then a sparse one */
        for (uint32_t j = 0; j < 4; j++)
            scene.textures[j].sample_count = 0;
        scene_aim(&scene, 2 - 2 * i, SCENE_SAMPLES / 8,
                  &(struct scene_aim){0.05, 0.05, 0.5, 0.5, 0, 0.2, 0, 0});
        run_until_sharp(200, true);
    }
    h.quiet = false;
    close_scene();
}

/* One in two frames is recorded, given up and recorded again. */
static void abandoned_frames_lose_nothing(void **state)
{
    h.abandon_one_in = 2;
    auto_picks_a_mode_for_each_texture(state);
    h.abandon_one_in = 0;
    assert_true(h.abandoned_count > 5);
}

static void check_refusal(SluiceResidencyMode mode, SluiceFormat format, const char *reason)
{
    static const uint32_t texels[300 * 200];
    const SluiceImageInfo image = {
        .structSize = sizeof image, .width = 300, .height = 200, .format = format};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &image, NULL, &source));
    const SluiceVulkanTextureCreateInfo info = {
        .structSize = sizeof info, .source = source, .residencyMode = mode};
    SluiceVulkanTexture texture;
    h.quiet = true;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture), SLUICE_ERROR_UNSUPPORTED);
    h.quiet = false;
    if (!strstr(h.last_message, reason))
        fail_msg("\"%s\" does not say \"%s\"", h.last_message, reason);
    sluiceDestroyImageSource(source);
}

static void refusals_say_why(void **state)
{
    (void)state;
    open_scene(false, false);
    check_refusal(SLUICE_RESIDENCY_MODE_PAGED, rgba8, "pagedTextures");
    close_scene();
    open_scene(false, true);
    check_refusal(SLUICE_RESIDENCY_MODE_SPARSE, rg8,
                  "R8G8_UNORM is not available as a sparse image");
    check_refusal(SLUICE_RESIDENCY_MODE_PAGED, SLUICE_FORMAT_R32_UINT, "no linear filter");
    close_scene();
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    h.mixes = true;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(auto_picks_a_mode_for_each_texture),
        cmocka_unit_test(sparse_and_paged_textures_share_a_budget),
        cmocka_unit_test(abandoned_frames_lose_nothing),
        cmocka_unit_test(refusals_say_why),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
