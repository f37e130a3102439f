/* A streamer and a demand loader of one context show the same textures. */
#include "device/demand_runner.h"
#include "device/scene.h"

#include "vulkan/page_pool.h"
#include "vulkan/streamer.h"

#include "support/test.h"

#include <math.h>
#include <string.h>

/* Tiles of 128 x 128 texels: 64, 16 and 4 in the levels with tiles in both front ends. Level 3 is a
 * tile of the demand loader and packed in the streamer. Coarser levels are packed or tail in
 * both. */
#define SIZE 1024u
#define TILE 128u
#define LEVELS 3u
#define TILES 84u

/* Counts the reads of each shared tile. */
struct counter {
    SluiceImageSource base;
    SluiceImageSource *inner;
    atomic_uint reads[LEVELS][SIZE / TILE][SIZE / TILE];
    atomic_uint succeeded, failed;
    atomic_uint failures_left; ///< reads of tiles that still fail
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct counter *)base)->inner, info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct counter *counter = (struct counter *)base;
    bool counts = region->mipLevel < LEVELS && region->width == TILE && region->height == TILE;
    if (counts && atomic_load(&counter->failures_left) > 0) {
        atomic_fetch_sub(&counter->failures_left, 1);
        atomic_fetch_add(&counter->failed, 1);
        return SLUICE_ERROR_CORRUPT_DATA;
    }
    if (counts) {
        atomic_fetch_add(&counter->reads[region->mipLevel][region->y / TILE][region->x / TILE], 1);
        atomic_fetch_add(&counter->succeeded, 1);
    }
    return sluiceReadImageRegion(counter->inner, region, texels, row_pitch);
}

static void destroy(SluiceImageSource *base)
{
    (void)base;
}

static const SluiceImageSourceInterface counter_interface = {.structSize = sizeof counter_interface,
                                                             .pfnGetInfo = get_info,
                                                             .pfnReadRegion = read_region,
                                                             .pfnDestroy = destroy};

static void counter_init(struct counter *counter)
{
    memset(counter, 0, sizeof *counter);
    counter->base.pInterface = &counter_interface;
    counter->inner = pattern_source(PATTERN_LEVEL, SIZE, SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
}

static uint32_t most_reads(struct counter *counter)
{
    uint32_t most = 0;
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t y = 0; y < SIZE / TILE >> level; y++)
            for (uint32_t x = 0; x < SIZE / TILE >> level; x++)
                most = counter->reads[level][y][x] > most ? counter->reads[level][y][x] : most;
    return most;
}

static struct harness h;

struct stage {
    struct scene scene;
    struct runner runner;
    struct counter counter;
    bool launches_first;
    uint32_t streamed;            ///< index in the scene
    SluiceDemandTextureId demand; ///< texture of the same source in the demand loader
};

static void stream(struct stage *s)
{
    s->streamed = scene_add(&s->scene, &s->counter.base);
    s->scene.textures[s->streamed].owns = false;
    const struct scene_aim all = {0.01, 0.01, 0.98, 0.98, 0.1, 0.2, 0, 0};
    scene_aim(&s->scene, s->streamed, SCENE_SAMPLES, &all);
}

static void add_to_loader(struct stage *s)
{
    const SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info,
        .image = {.source = &s->counter.base, .pName = "shared"},
        .pSampler = &runner_nearest};
    CHECK_OK(sluiceAddDemandTexture(s->runner.loader, &info, &s->demand));
    runner_clear(&s->runner);
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t y = 0; y < SIZE >> level; y += TILE)
            for (uint32_t x = 0; x < SIZE >> level; x += TILE)
                runner_add_texel(&s->runner, s->demand, SIZE, SIZE, level, x + TILE / 2,
                                 y + TILE / 2);
}

static void init_with(struct stage *s, uint64_t budget, uint64_t timeout)
{
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = budget};
    counter_init(&s->counter);
    scene_init(
        &s->scene, &h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = timeout});
    runner_init(&s->runner, &h, &info);
    stream(s);
    add_to_loader(s);
}

static void init(struct stage *s, uint64_t budget)
{
    init_with(s, budget, 1000);
}

static void finish(struct stage *s)
{
    runner_finish(&s->runner);
    scene_finish(&s->scene);
    sluiceDestroyImageSource(s->counter.inner);
}

static uint32_t held_pages(const struct stage *s)
{
    return s->scene.streamer->pages->held_count;
}

static uint64_t shared_count(const struct stage *s)
{
    return runner_statistics(&s->runner).sharedCount;
}

static SluiceVulkanStreamerStatistics streamer_statistics(const struct stage *s)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s->scene.streamer, &stats));
    return stats;
}

static void check_streamed(struct stage *s)
{
    assert_int_equal(scene_missing(&s->scene), 0);
    scene_check_levels(&s->scene);
    const struct ProbeOutput *out = scene_outputs(&s->scene, s->streamed);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
        assert_int_equal(out[i].level, 0);
}

static void check_demand(const struct stage *s)
{
    uint32_t sample = 0;
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t y = 0; y < SIZE >> level; y += TILE)
            for (uint32_t x = 0; x < SIZE >> level; x += TILE, sample++) {
                struct RunnerOutput out = runner_output(&s->runner, sample);
                float expected[4];
                pattern_texel(PATTERN_LEVEL, level, x + TILE / 2, y + TILE / 2, expected);
                assert_true(out.resident);
                for (uint32_t i = 0; i < 4; i++)
                    if (fabsf(out.color[i] - expected[i]) > 1.0f / 255)
                        fail_msg("level %u, texel %u %u: channel %u is %g, not %g", level, x, y, i,
                                 (double)out.color[i], (double)expected[i]);
            }
}

/* Runs frames and launches in turns until both show everything. */
static void run_both(struct stage *s, uint32_t limit)
{
    for (uint32_t i = 0; i < limit; i++) {
        if (!s->launches_first)
            scene_settle(&s->scene, 1);
        runner_launch(&s->runner);
        CHECK_OK(sluiceWaitDemandTicket(s->runner.loader, s->runner.ticket, UINT64_MAX, NULL));
        if (s->launches_first)
            scene_settle(&s->scene, 1);
        if (i > 8 && s->runner.requests.missingCount == 0 && scene_missing(&s->scene) == 0)
            return;
    }
    fail_msg("%u frames and launches were too few", limit);
}

static void the_demand_loader_shows_tiles_of_the_streamer(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, 0);
    scene_settle(&s.scene, 12);
    check_streamed(&s);
    assert_int_equal(s.counter.succeeded, TILES);
    assert_int_equal(held_pages(&s), TILES);
    assert_in_range(runner_load(&s.runner, 8), 2, 7);
    check_demand(&s);
    assert_int_equal(s.counter.succeeded, TILES);
    assert_int_equal(shared_count(&s), TILES);
    assert_int_equal(held_pages(&s), TILES);
    finish(&s);
}

static void the_streamer_shows_tiles_of_the_demand_loader(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, 0);
    runner_load(&s.runner, 8);
    check_demand(&s);
    assert_int_equal(s.counter.succeeded, TILES);
    scene_settle(&s.scene, 12);
    check_streamed(&s);
    assert_int_equal(s.counter.succeeded, TILES);
    assert_int_equal(streamer_statistics(&s).tilesShared, TILES);
    assert_int_equal(held_pages(&s), TILES);
    finish(&s);
}

static void both_at_once_read_each_tile_once(void **state)
{
    static struct stage s;
    (void)state;
    for (int order = 0; order < 2; order++) {
        s.launches_first = order;
        init(&s, 0);
        run_both(&s, 60);
        check_streamed(&s);
        check_demand(&s);
        assert_int_equal(most_reads(&s.counter), 1);
        assert_int_equal(s.counter.succeeded, TILES);
        assert_int_equal(shared_count(&s) + streamer_statistics(&s).tilesShared, TILES);
        assert_int_equal(held_pages(&s), TILES);
        finish(&s);
    }
}

/* One in two frames and launches is recorded, abandoned and recorded again. */
static void abandoned_frames_never_show_a_page_that_was_not_written(void **state)
{
    static struct stage s;
    (void)state;
    uint32_t before = h.abandon_one_in;
    h.abandon_one_in = 2;
    for (int order = 0; order < 3; order++) {
        init(&s, 0);
        if (order == 0)
            scene_settle(&s.scene, 12);
        else if (order == 1)
            runner_load(&s.runner, 8);
        run_both(&s, 80);
        check_streamed(&s);
        check_demand(&s);
        assert_int_equal(s.counter.succeeded, TILES);
        assert_int_equal(held_pages(&s), TILES);
        finish(&s);
    }
    h.abandon_one_in = before;
}

static void a_read_that_fails_for_one_is_tried_by_the_other(void **state)
{
    static struct stage s;
    (void)state;
    h.quiet = true;
    init(&s, 0);
    scene_settle(&s.scene, 5); /* levels without tiles are resident */
    s.counter.failures_left = 30;
    for (int i = 0; i < 40; i++) {
        scene_settle(&s.scene, 1);
        runner_launch(&s.runner);
        CHECK_OK(sluiceWaitDemandTicket(s.runner.loader, s.runner.ticket, UINT64_MAX, NULL));
        if (s.counter.failures_left == 0)
            CHECK_OK(sluiceRetryDemandTexture(s.runner.loader, s.demand));
    }
    check_streamed(&s);
    check_demand(&s);
    assert_int_equal(s.counter.succeeded, TILES);
    assert_int_equal(held_pages(&s), TILES);
    finish(&s);
    h.quiet = false;
}

static void a_tile_stays_while_one_of_them_has_it(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, 0);
    run_both(&s, 60);
    scene_remove(&s.scene, s.streamed);
    scene_settle(&s.scene, 20);
    runner_launch(&s.runner);
    check_demand(&s);
    assert_int_equal(held_pages(&s), TILES);
    stream(&s); /* again, from the demand loader's pages */
    scene_settle(&s.scene, 12);
    check_streamed(&s);
    assert_int_equal(s.counter.succeeded, TILES);
    CHECK_OK(sluiceRemoveDemandTexture(s.runner.loader, s.demand));
    runner_clear(&s.runner);
    for (int i = 0; i < 4; i++)
        runner_launch(&s.runner);
    scene_settle(&s.scene, 20);
    check_streamed(&s);
    assert_int_equal(held_pages(&s), TILES);
    add_to_loader(&s);
    runner_load(&s.runner, 8);
    check_demand(&s);
    assert_int_equal(s.counter.succeeded, TILES);
    scene_remove(&s.scene, s.streamed);
    CHECK_OK(sluiceRemoveDemandTexture(s.runner.loader, s.demand));
    runner_clear(&s.runner);
    for (int i = 0; i < 4; i++) {
        scene_settle(&s.scene, 1);
        runner_launch(&s.runner);
    }
    assert_int_equal(held_pages(&s), 0);
    finish(&s);
}

/* The demand loader has memory for 64 tiles. */
static void eviction_by_one_leaves_the_other_its_tiles(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, (uint64_t)64 << 16);
    scene_settle(&s.scene, 12);
    for (int i = 0; i < 12; i++) {
        runner_launch(&s.runner);
        CHECK_OK(sluiceWaitDemandTicket(s.runner.loader, s.runner.ticket, UINT64_MAX, NULL));
        scene_settle(&s.scene, 1);
        check_streamed(&s);
    }
    assert_in_range(runner_statistics(&s.runner).residentTileCount, 1, 64);
    assert_int_equal(s.counter.succeeded, TILES);
    assert_in_range(held_pages(&s), TILES, TILES + 2); /* level 3, for its bias, and the tail */
    finish(&s);
}

static void tiles_that_the_streamer_evicted_come_back_from_the_other(void **state)
{
    static struct stage s;
    (void)state;
    init_with(&s, 0, 4);
    run_both(&s, 60);
    uint64_t before = streamer_statistics(&s).tilesShared;
    s.scene.textures[s.streamed].sample_count = 0;
    scene_settle(&s.scene, 20);
    assert_in_range(streamer_statistics(&s).tilesUnmapped, TILES, UINT64_MAX);
    runner_launch(&s.runner);
    check_demand(&s);
    assert_int_equal(held_pages(&s), TILES);
    s.scene.textures[s.streamed].sample_count = SCENE_SAMPLES;
    scene_settle(&s.scene, 20);
    check_streamed(&s);
    assert_int_equal(streamer_statistics(&s).tilesShared, before + TILES);
    assert_int_equal(s.counter.succeeded, TILES);
    assert_int_equal(held_pages(&s), TILES);
    finish(&s);
}

static void changed_texels_are_read_again_by_the_one_that_was_told(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, 0);
    run_both(&s, 60);
    CHECK_OK(sluiceInvalidateDemandTexture(s.runner.loader, s.demand));
    runner_load(&s.runner, 8);
    check_demand(&s);
    assert_int_equal(s.counter.succeeded, 2 * TILES);
    assert_int_equal(held_pages(&s), 2 * TILES);
    scene_settle(&s.scene, 2);
    check_streamed(&s);
    finish(&s);
}

/* The streamer has begun to read, and then runs no frame for a long time. */
static void an_idle_front_end_is_not_waited_for(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, 0);
    while (s.counter.succeeded == 0)
        scene_settle(&s.scene, 1);
    for (int i = 0; i < 20; i++) {
        runner_launch(&s.runner);
        CHECK_OK(sluiceWaitDemandTicket(s.runner.loader, s.runner.ticket, UINT64_MAX, NULL));
    }
    assert_int_equal(s.runner.requests.missingCount, 0);
    check_demand(&s);
    scene_settle(&s.scene, 12);
    check_streamed(&s);
    finish(&s);
}

static pthread_mutex_t queue_mutex = PTHREAD_MUTEX_INITIALIZER;

/* Locks the queue that two threads share, as applications must. */
static VKAPI_ATTR VkResult VKAPI_CALL submit_alone(VkQueue queue, uint32_t count,
                                                   const VkSubmitInfo *submits, VkFence fence)
{
    static PFN_vkQueueSubmit submit;
    pthread_mutex_lock(&queue_mutex);
    if (!submit)
        submit = (PFN_vkQueueSubmit)h.GetDeviceProcAddr(h.device, "vkQueueSubmit");
    VkResult result = submit(queue, count, submits, fence);
    pthread_mutex_unlock(&queue_mutex);
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL wait_alone(VkDevice device)
{
    static PFN_vkDeviceWaitIdle wait;
    pthread_mutex_lock(&queue_mutex);
    if (!wait)
        wait = (PFN_vkDeviceWaitIdle)h.GetDeviceProcAddr(h.device, "vkDeviceWaitIdle");
    VkResult result = wait(device);
    pthread_mutex_unlock(&queue_mutex);
    return result;
}

/* Returns a harness for another thread: same device, separate command buffers. */
static struct harness harness_of_thread(void)
{
    struct harness other = h;
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = h.family};
    assert_int_equal(h.CreateCommandPool(h.device, &pool, NULL, &other.pool), VK_SUCCESS);
    const VkCommandBufferAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = other.pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = HARNESS_FRAMES};
    assert_int_equal(h.AllocateCommandBuffers(h.device, &info, other.commands), VK_SUCCESS);
    memset(other.last, 0, sizeof other.last);
    return other;
}

/* Returns the level that a color of PATTERN_LEVEL shows. */
static uint32_t shown_level(const float color[4])
{
    return (uint32_t)lroundf(color[0] * 16) - 1;
}

/* Allows coarser levels if there is no memory for the samples' tiles. */
static void check_resident(const struct stage *s)
{
    uint32_t sample = 0;
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t y = 0; y < SIZE >> level; y += TILE)
            for (uint32_t x = 0; x < SIZE >> level; x += TILE, sample++) {
                struct RunnerOutput out = runner_output(&s->runner, sample);
                float expected[4];
                if (!out.resident)
                    continue;
                uint32_t shown = shown_level(out.color);
                assert_in_range(shown, level, 10);
                pattern_texel(PATTERN_LEVEL, shown, (x + TILE / 2) >> (shown - level),
                              (y + TILE / 2) >> (shown - level), expected);
                for (uint32_t i = 0; i < 4; i++)
                    assert_true(fabsf(out.color[i] - expected[i]) <= 1.0f / 255);
            }
}

struct tracing {
    struct stage *stage;
    atomic_bool stops;
    uint32_t launches;
};

/* Adds and removes its texture. There is memory for 64 of its tiles. */
static void *trace(void *user)
{
    struct tracing *t = user;
    struct stage *s = t->stage;
    for (; !atomic_load(&t->stops); t->launches++) {
        runner_launch(&s->runner);
        CHECK_OK(sluiceWaitDemandTicket(s->runner.loader, s->runner.ticket, UINT64_MAX, NULL));
        check_resident(s);
        if (t->launches % 16 == 15) {
            CHECK_OK(sluiceRemoveDemandTexture(s->runner.loader, s->demand));
            add_to_loader(s);
        }
    }
    return NULL;
}

/* The loader stops. The streamer reads tiles whose pages the loader took and never filled after
 * eight frames without a launch (page_sharing.c): 12 frames in all, or more if reads are late. */
static void settle_until_sharp(struct stage *s)
{
    uint32_t frames = 2; /* until feedback arrives */
    scene_settle(&s->scene, frames);
    for (; scene_missing(&s->scene) > 0 && frames < 60; frames++)
        scene_settle(&s->scene, 1);
}

static void front_ends_may_be_on_two_threads(void **state)
{
    static struct stage s;
    static struct harness other;
    (void)state;
    h.QueueSubmit = submit_alone;
    h.DeviceWaitIdle = wait_alone;
    other = harness_of_thread();
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = (uint64_t)64 << 16, .noLodBias = true};
    counter_init(&s.counter);
    scene_init(
        &s.scene, &h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 4});
    runner_init(&s.runner, &other, &info);
    stream(&s);
    add_to_loader(&s);
    struct tracing tracing = {.stage = &s};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, trace, &tracing), 0);
    for (uint32_t i = 0; i < 240; i++) {
        bool looks = i / 40 % 2 == 0; /* stops sampling until empty images are freed */
        s.scene.textures[s.streamed].sample_count = looks ? SCENE_SAMPLES : 0;
        scene_settle(&s.scene, 1);
        scene_check_levels(&s.scene);
        if (i % 80 == 79) {
            scene_remove(&s.scene, s.streamed);
            stream(&s);
        }
    }
    atomic_store(&tracing.stops, true);
    pthread_join(thread, NULL);
    assert_true(tracing.launches > 16);
    settle_until_sharp(&s);
    check_streamed(&s);
    assert_true(shared_count(&s) + streamer_statistics(&s).tilesShared > 0);
    finish(&s);
    h.DestroyCommandPool(h.device, other.pool, NULL);
    assert_int_equal(other.message_count, 0);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_demand_loader_shows_tiles_of_the_streamer),
        cmocka_unit_test(the_streamer_shows_tiles_of_the_demand_loader),
        cmocka_unit_test(both_at_once_read_each_tile_once),
        cmocka_unit_test(abandoned_frames_never_show_a_page_that_was_not_written),
        cmocka_unit_test(a_read_that_fails_for_one_is_tried_by_the_other),
        cmocka_unit_test(a_tile_stays_while_one_of_them_has_it),
        cmocka_unit_test(eviction_by_one_leaves_the_other_its_tiles),
        cmocka_unit_test(tiles_that_the_streamer_evicted_come_back_from_the_other),
        cmocka_unit_test(changed_texels_are_read_again_by_the_one_that_was_told),
        cmocka_unit_test(an_idle_front_end_is_not_waited_for),
        cmocka_unit_test(front_ends_may_be_on_two_threads),
    };
    CHECK_OK(
        harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.readRetry = {.maxAttempts = 1}}));
    return harness_finish(&h, RUN_TESTS(tests));
}
