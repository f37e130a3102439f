/* Contexts of several devices on one read pool, each with a streamer and a demand loader of the
 * same sources. All devices are of one physical device. */
#include "device/demand_runner.h"
#include "device/scene.h"

#include "support/test.h"

#include <sluice/vulkan_control.h>

#include <math.h>
#include <pthread.h>
#include <string.h>

#define DEVICES 3u
#define SIZE 1024u
#define TILE 128u
#define LEVELS 3u
#define TILES 84u
#define MOST_REGIONS 256u

/* Added to red when the texels have changed: four levels of PATTERN_LEVEL. */
#define CHANGE 64
#define LEVEL_CHANGE (CHANGE * 16 / 255.0f)

/* Counts the reads of each region. */
struct counter {
    SluiceImageSource base;
    SluiceImageSource *inner;
    bool changed; ///< set while nobody reads
    pthread_mutex_t mutex;
    uint32_t count;
    struct {
        SluiceImageRegion region;
        uint32_t reads;
    } regions[MOST_REGIONS];
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct counter *)base)->inner, info);
}

static void count(struct counter *counter, const SluiceImageRegion *region)
{
    uint32_t i = 0;
    pthread_mutex_lock(&counter->mutex);
    while (i < counter->count && memcmp(&counter->regions[i].region, region, sizeof *region) != 0)
        i++;
    assert_true(i < MOST_REGIONS);
    counter->regions[i].region = *region;
    counter->regions[i].reads++;
    counter->count += i == counter->count;
    pthread_mutex_unlock(&counter->mutex);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct counter *counter = (struct counter *)base;
    count(counter, region);
    SluiceResult result = sluiceReadImageRegion(counter->inner, region, texels, row_pitch);
    for (uint32_t y = 0; counter->changed && y < region->height; y++)
        for (uint32_t x = 0; x < region->width; x++)
            ((uint8_t *)texels)[y * row_pitch + 4 * x] += CHANGE;
    return result;
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
    pthread_mutex_init(&counter->mutex, NULL);
}

static void counter_finish(struct counter *counter)
{
    pthread_mutex_destroy(&counter->mutex);
    sluiceDestroyImageSource(counter->inner);
}

/* Checks that all tiles were read at least `least` times, and no region more than `most` times. The
 * single texel of the last level may be read more often, because each demand loader that opens it
 * reads it. */
static void check_reads(struct counter *counter, uint32_t least, uint32_t most)
{
    uint32_t tiles = 0;
    for (uint32_t i = 0; i < counter->count; i++) {
        const SluiceImageRegion *at = &counter->regions[i].region;
        bool opens = at->width == 1 && at->height == 1;
        if (counter->regions[i].reads > most * (opens ? 1 + DEVICES : 1))
            fail_msg("level %u, texel %u %u: %u reads, not %u", at->mipLevel, at->x, at->y,
                     counter->regions[i].reads, most);
        if (at->width != TILE || at->mipLevel >= LEVELS)
            continue;
        tiles++;
        assert_true(counter->regions[i].reads >= least);
    }
    assert_int_equal(tiles, TILES);
}

struct device {
    struct harness h;
    struct scene scene;
    struct runner runner;
    uint32_t streamed;
    SluiceDemandTextureId demand;
    bool used;
};

static struct device devices[DEVICES];
static SluiceReadPool *pool;
static struct counter counter;

static void add_textures(struct device *d)
{
    d->streamed = scene_add(&d->scene, &counter.base);
    d->scene.textures[d->streamed].owns = false;
    const struct scene_aim all = {0.01, 0.01, 0.98, 0.98, 0.1, 0.2, 0, 0};
    scene_aim(&d->scene, d->streamed, SCENE_SAMPLES, &all);
    const SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info,
        .image = {.source = &counter.base, .pName = "shared"},
        .pSampler = &runner_nearest};
    CHECK_OK(sluiceAddDemandTexture(d->runner.loader, &info, &d->demand));
    runner_clear(&d->runner);
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t y = 0; y < SIZE >> level; y += TILE)
            for (uint32_t x = 0; x < SIZE >> level; x += TILE)
                runner_add_texel(&d->runner, d->demand, SIZE, SIZE, level, x + TILE / 2,
                                 y + TILE / 2);
}

static void device_init(struct device *d)
{
    const SluiceVulkanContextCreateInfo context = {.readPool = pool};
    CHECK_OK(harness_set_context(&d->h, &context));
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info};
    scene_init(
        &d->scene, &d->h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    runner_init(&d->runner, &d->h, &info);
    add_textures(d);
    d->used = true;
}

static void device_finish(struct device *d)
{
    if (!d->used)
        return;
    d->used = false;
    runner_finish(&d->runner);
    scene_finish(&d->scene);
    CHECK_OK(harness_set_context(&d->h, NULL)); /* one without the pool */
}

static void init(uint32_t device_count)
{
    const SluiceReadPoolCreateInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateReadPool(&info, &pool));
    counter_init(&counter);
    for (uint32_t i = 0; i < device_count; i++)
        device_init(&devices[i]);
}

static SluiceReadPoolStatistics statistics(void)
{
    SluiceReadPoolStatistics now = {.structSize = sizeof now};
    CHECK_OK(sluiceGetReadPoolStatistics(pool, &now));
    return now;
}

static void finish(void)
{
    for (uint32_t i = 0; i < DEVICES; i++)
        device_finish(&devices[i]);
    assert_int_equal(statistics().memberCount, 0);
    assert_int_equal(statistics().keptCount, 0);
    sluiceDestroyReadPool(pool);
    counter_finish(&counter);
}

/* A frame and a launch of each device in turns. */
static void run(uint32_t turns)
{
    for (uint32_t turn = 0; turn < turns; turn++)
        for (uint32_t i = 0; i < DEVICES; i++) {
            struct device *d = &devices[i];
            if (!d->used)
                continue;
            scene_settle(&d->scene, 1);
            runner_launch(&d->runner);
            CHECK_OK(sluiceWaitDemandTicket(d->runner.loader, d->runner.ticket, UINT64_MAX, NULL));
        }
}

/* Pictures of both front ends are sharp, and of these texels. */
static void check_pictures(const struct device *d)
{
    const float change = counter.changed ? LEVEL_CHANGE : 0;
    assert_int_equal(scene_missing((struct scene *)&d->scene), 0);
    const struct ProbeOutput *out = scene_outputs(&d->scene, d->streamed);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++) {
        float level = pattern_level(out[i].color) - change;
        if (level < -0.05f || level > 0.3f) /* aimed at 0.1 to 0.2 */
            fail_msg("sample %u shows level %g", i, (double)level);
    }
    uint32_t sample = 0;
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t y = 0; y < SIZE >> level; y += TILE)
            for (uint32_t x = 0; x < SIZE >> level; x += TILE, sample++) {
                struct RunnerOutput texel = runner_output(&d->runner, sample);
                float expected[4];
                pattern_texel(PATTERN_LEVEL, level, x + TILE / 2, y + TILE / 2, expected);
                expected[0] += change / 16;
                assert_true(texel.resident);
                for (uint32_t c = 0; c < 4; c++)
                    if (fabsf(texel.color[c] - expected[c]) > 1.0f / 255)
                        fail_msg("level %u, texel %u %u: channel %u is %g, not %g", level, x, y, c,
                                 (double)texel.color[c], (double)expected[c]);
            }
}

static void check_all_pictures(void)
{
    for (uint32_t i = 0; i < DEVICES; i++)
        if (devices[i].used)
            check_pictures(&devices[i]);
}

static void devices_that_run_together_read_each_tile_once(void **state)
{
    (void)state;
    for (uint32_t device_count = 2; device_count <= DEVICES; device_count++) {
        init(device_count);
        run(24);
        check_all_pictures();
        check_reads(&counter, 1, 1);
        const SluiceReadPoolStatistics now = statistics();
        assert_int_equal(now.memberCount, device_count);
        assert_int_equal(now.refusedCount, 0);
        assert_true(now.joinedCount + now.cachedCount >= (device_count - 1) * TILES);
        finish();
    }
}

static void devices_that_come_later_copy(void **state)
{
    (void)state;
    init(DEVICES);
    for (uint32_t i = 0; i < DEVICES; i++) {
        scene_settle(&devices[i].scene, 16);
        runner_load(&devices[i].runner, 16);
    }
    run(4);
    check_all_pictures();
    check_reads(&counter, 1, 1);
    finish();
}

/* A device and its context are destroyed. The others get the reads that it had begun. */
static void a_device_may_go_halfway(void **state)
{
    (void)state;
    init(DEVICES);
    run(3);
    for (uint32_t i = 0; i < DEVICES; i++) /* reads are under way */
        runner_launch(&devices[i].runner);
    device_finish(&devices[1]);
    run(24);
    check_all_pictures();
    check_reads(&counter, 1, 2); /* texels of the front ends that went were dropped */
    device_finish(&devices[0]);
    run(4);
    check_all_pictures();
    finish();
}

static void changed_texels_reach_every_device(void **state)
{
    (void)state;
    init(DEVICES);
    run(24);
    counter.changed = true;
    for (uint32_t i = 0; i < DEVICES; i++) {
        CHECK_OK(sluiceInvalidateVulkanTexture(
            devices[i].scene.streamer,
            devices[i].scene.textures[devices[i].streamed].texture.textureId, NULL, UINT32_MAX));
        CHECK_OK(sluiceInvalidateDemandTexture(devices[i].runner.loader, devices[i].demand));
    }
    run(40);
    check_all_pictures();
    check_reads(&counter, 2, 2);
    finish();
}

static void a_new_source_at_an_old_address_is_read(void **state)
{
    (void)state;
    init(2);
    run(24);
    for (uint32_t i = 0; i < 2; i++) {
        scene_remove(&devices[i].scene, devices[i].streamed);
        CHECK_OK(sluiceRemoveDemandTexture(devices[i].runner.loader, devices[i].demand));
        CHECK_OK(sluiceWaitVulkanStreamerIdle(devices[i].scene.streamer));
    }
    counter_finish(&counter);
    counter_init(&counter);
    counter.changed = true;
    for (uint32_t i = 0; i < 2; i++)
        add_textures(&devices[i]);
    run(24);
    check_all_pictures();
    check_reads(&counter, 1, 1);
    finish();
}

int main(void)
{
    int status = 0;
    for (uint32_t i = 0; i < DEVICES && status == 0; i++)
        status = harness_init(&devices[i].h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(devices_that_run_together_read_each_tile_once),
        cmocka_unit_test(devices_that_come_later_copy),
        cmocka_unit_test(a_device_may_go_halfway),
        cmocka_unit_test(changed_texels_reach_every_device),
        cmocka_unit_test(a_new_source_at_an_old_address_is_read),
    };
    status = RUN_TESTS(tests);
    for (uint32_t i = DEVICES; i-- > 0;)
        status = harness_finish(&devices[i].h, status);
    return status;
}
