/* The memory limit falls while textures are in view. The picture stays correct. */
#include "device/scene.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define MIB (UINT64_C(1) << 20)
#define SIZE 2048u /* 256, 64, 16 and 4 tiles of 128 x 128 texels, and packed levels */

static struct harness h;
static struct scene scene;
static bool no_memory; ///< for tiles

static VkResult allocate(void *user, const SluiceDeviceMemoryRequest *request,
                         SluiceDeviceMemory *memory)
{
    (void)user;
    if (no_memory && request->purpose <= SLUICE_DEVICE_MEMORY_PURPOSE_PAGES)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = request->size,
                                       .memoryTypeIndex = request->memoryTypeIndex};
    VkResult result = h.AllocateMemory(h.device, &info, NULL, &memory->memory);
    if (result != VK_SUCCESS || !request->mapped)
        return result;
    return h.MapMemory(h.device, memory->memory, 0, VK_WHOLE_SIZE, 0, &memory->pMapped);
}

static void release(void *user, const SluiceDeviceMemory *memory)
{
    (void)user;
    h.FreeMemory(h.device, memory->memory, NULL);
}

static const SluiceDeviceMemoryCallbacks callbacks = {NULL, allocate, release};

static SluiceResult use_callbacks(void)
{
    SluiceVulkanContextCreateInfo info = harness_context_info(&h);
    info.pDeviceMemory = &callbacks;
    sluiceDestroyVulkanContext(h.context);
    return sluiceCreateVulkanContext(&info, &h.context);
}

enum part { ALL = 16, CORNER = 2 }; /* tiles of level 0 along an edge */

static SluiceVulkanContextStatistics memory(void)
{
    SluiceVulkanContextStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanContextStatistics(h.context, &s));
    return s;
}

static SluiceVulkanStreamerStatistics statistics(void)
{
    SluiceVulkanStreamerStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(scene.streamer, &s));
    return s;
}

/* Two textures, heaps of 1 MiB. */
static void open_scene(uint32_t standby)
{
    scene_init(
        &scene, &h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 2,
                                         .numExtraStandbyTiles = standby,
                                         .heapTileCapacity = 16});
    for (uint32_t i = 0; i < 2; i++)
        scene_add(&scene, pattern_source(PATTERN_LEVEL, SIZE, SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM));
}

static void close_scene(void)
{
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    scene_finish(&scene);
    assert_int_equal(memory().memoryBlockCount, 0);
}

/* A sample in each tile of the part. */
static void look_at(uint32_t texture, enum part part)
{
    const struct scene_aim sharp = {0.1, 0.1, 0.8, 0.8, 0.1, 0.2, 0, 0};
    scene_aim(&scene, texture, part * part, &sharp);
    for (uint32_t i = 0; i < part * part; i++) {
        float *uv = scene_inputs(&scene, texture)[i].uv;
        uv[0] = ((float)(i % part) + uv[0]) / ALL;
        uv[1] = ((float)(i / part) + uv[1]) / ALL;
    }
}

/* Runs frames. Every level that is seen meanwhile is right. */
static void run_frames(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        scene_settle(&scene, 1);
        scene_check_levels(&scene);
    }
}

/* Returns how many frames it took. */
static uint32_t run_until_memory_is(uint64_t size, uint32_t limit)
{
    uint32_t frames = 0;
    for (; memory().tileMemorySize > size; frames++) {
        if (frames == limit)
            fail_msg("%u MiB after %u frames", (unsigned)(memory().tileMemorySize / MIB), frames);
        run_frames(1);
    }
    return frames;
}

static void run_until_sharp(uint32_t limit)
{
    for (uint32_t i = 0; i < limit; i++) {
        run_frames(1);
        if (i > 6 && scene_missing(&scene) == 0)
            return;
    }
    fail_msg("%u samples are not sharp after %u frames", scene_missing(&scene), limit);
}

static void record_fetch(void *user, VkCommandBuffer commands)
{
    const struct scene_texture *texture = user;
    prober_record(&scene.prober, commands, texture->probe, 0, PROBE_CAPACITY, PROBE_FETCH);
}

/* Texels of level 0, below `size` in tiles of odd columns or in all: the bits of the source's. */
static void check_texels_of(uint32_t index, uint32_t size, bool odd_columns)
{
    static struct ProbeInput kept[PROBE_CAPACITY];
    const struct scene_texture *texture = &scene.textures[index];
    struct ProbeInput *inputs = prober_inputs(&scene.prober);
    memcpy(kept, inputs, sizeof kept);
    for (uint32_t i = 0; i < PROBE_CAPACITY; i++) {
        uint32_t x = (uint32_t)roll() % size, y = (uint32_t)roll() % size;
        inputs[i] =
            (struct ProbeInput){.uv = {(float)(odd_columns ? x | SIZE / ALL : x), (float)y}};
    }
    harness_run(&h, record_fetch, (void *)texture);
    for (uint32_t i = 0; i < PROBE_CAPACITY; i++) {
        const float *color = prober_outputs(&scene.prober)[i].color;
        float rgba[4];
        pattern_texel(PATTERN_LEVEL, 0, (uint32_t)inputs[i].uv[0], (uint32_t)inputs[i].uv[1], rgba);
        for (uint32_t c = 0; c < 4; c++)
            if (lrintf(color[c] * 255) != lrintf(rgba[c] * 255))
                fail_msg("texel %g %g of texture %u: channel %u is %g, not %g",
                         (double)inputs[i].uv[0], (double)inputs[i].uv[1], index, c,
                         (double)color[c], (double)rgba[c]);
    }
    memcpy(inputs, kept, sizeof kept);
    scene_clear_outputs(&scene);
}

static void check_texels(uint32_t index, uint32_t size)
{
    check_texels_of(index, size, false);
}

static void unneeded_tiles_go_when_the_budget_falls(void **state)
{
    (void)state;
    open_scene(2000);
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    uint64_t before = memory().tileMemorySize;
    assert_true(before > 38 * MIB);
    look_at(0, CORNER);
    scene.textures[1].sample_count = 0;
    run_frames(10);
    assert_true(memory().tileMemorySize >= before); /* kept: nobody needs it */
    uint32_t mapped = statistics().mappedTileCount;
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 12 * MIB));
    if (h.mode == SLUICE_RESIDENCY_MODE_DENSE)
        run_frames(20); /* dense images keep all their memory */
    else
        run_until_memory_is(12 * MIB, 40);
    run_until_sharp(40);
    assert_int_equal(statistics().mappedTileCount, mapped);
    check_texels(0, SIZE / 8);
    run_frames(10);
    assert_true(memory().tileMemorySize <=
                (h.mode == SLUICE_RESIDENCY_MODE_DENSE ? before : 12 * MIB));

    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    check_texels(0, SIZE);
    check_texels(1, SIZE);
    close_scene();
}

static void what_is_seen_gets_blurrier_when_the_budget_falls_below_it(void **state)
{
    (void)state;
    if (h.mode == SLUICE_RESIDENCY_MODE_DENSE)
        return;
    open_scene(0);
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    assert_true(memory().tileMemorySize > 38 * MIB);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 16 * MIB));
    run_until_memory_is(16 * MIB, 60);
    run_frames(20);
    assert_true(memory().tileMemorySize <= 16 * MIB);
    assert_true(scene_missing(&scene) > 0);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    run_until_sharp(120);
    check_texels(0, SIZE);
    check_texels(1, SIZE);
    close_scene();
}

/* Tiles move out of heaps that few of them keep, without any budget. */
static void heaps_that_few_tiles_keep_are_emptied_on_request(void **state)
{
    (void)state;
    uint32_t moved, most = 0, calls = 0;
    if (h.mode == SLUICE_RESIDENCY_MODE_DENSE)
        return;
    open_scene(0);
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    uint64_t before = memory().tileMemorySize;
    for (uint32_t i = 0; i < ALL * ALL; i++) /* every other column */
        scene_inputs(&scene, 0)[i] = scene_inputs(&scene, 0)[i | 1];
    scene.textures[1].sample_count = 0;
    run_frames(10);
    assert_true(memory().tileMemorySize == before);
    uint64_t uploaded = statistics().bytesUploaded;
    do {
        CHECK_OK(sluiceCompactVulkanStreamer(scene.streamer, 8, &moved));
        assert_true(moved <= 8);
        most = moved > most ? moved : most;
        run_frames(1);
        scene_check_levels(&scene);
    } while ((moved > 0 || calls < 8) && ++calls < 200);
    run_frames(8);
    run_until_sharp(20);
    assert_int_equal(most, 8);
    assert_true(calls < 200);
    SluiceVulkanStreamerStatistics stats = statistics();
    uint64_t least = stats.mappedTileCount * UINT64_C(65536);
    if (h.mode == SLUICE_RESIDENCY_MODE_SPARSE)
        assert_in_range(memory().heapMemorySize, least, least + 8 * MIB);
    else /* images of pages double in size, and tiles are copied from one to another */
        assert_in_range(memory().pageMemorySize, least, before / 2);
    if (h.mode == SLUICE_RESIDENCY_MODE_PAGED)
        assert_true(statistics().bytesUploaded == uploaded);
    check_texels_of(0, SIZE, true);
    close_scene();
}

/* The device refuses all allocations while tiles move and are loaded. */
static void a_device_without_memory_in_the_midst_changes_no_picture(void **state)
{
    (void)state;
    h.quiet = true;
    open_scene(100);
    look_at(0, ALL);
    run_until_sharp(60);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 8 * MIB));
    run_frames(2);
    no_memory = true;
    look_at(1, ALL);
    run_frames(30);
    look_at(1, CORNER);
    run_frames(30);
    if (h.mode != SLUICE_RESIDENCY_MODE_DENSE)
        assert_true(memory().tileMemorySize <= 8 * MIB);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    run_frames(4);
    no_memory = false;
    look_at(1, ALL);
    run_until_sharp(200);
    check_texels(0, SIZE);
    check_texels(1, SIZE);
    close_scene();
    h.quiet = false;
}

/* One in two frames is recorded, given up and recorded again. */
static void abandoned_frames_lose_no_tile_that_moves(void **state)
{
    (void)state;
    uint32_t before = h.abandon_one_in, count = h.abandoned_count;
    h.abandon_one_in = 2;
    unneeded_tiles_go_when_the_budget_falls(state);
    heaps_that_few_tiles_keep_are_emptied_on_request(state);
    what_is_seen_gets_blurrier_when_the_budget_falls_below_it(state);
    assert_true(h.abandoned_count > count + 50);
    h.abandon_one_in = before;
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    if (use_callbacks() != SLUICE_SUCCESS)
        return harness_finish(&h, 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unneeded_tiles_go_when_the_budget_falls),
        cmocka_unit_test(heaps_that_few_tiles_keep_are_emptied_on_request),
        cmocka_unit_test(what_is_seen_gets_blurrier_when_the_budget_falls_below_it),
        cmocka_unit_test(a_device_without_memory_in_the_midst_changes_no_picture),
        cmocka_unit_test(abandoned_frames_lose_no_tile_that_moves),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
