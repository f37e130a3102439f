/* Contexts of several fake devices share a read pool. A thread uses each device. */
#include "vulkan/fake_vulkan.h"

#include "support/fault_source.h"
#include "support/test.h"

#include <sluice/vulkan_control.h>

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

enum { DEVICES = 3, SIZE = 1024 };

struct device {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture texture;
    SluiceImageSource *source;
    uint64_t time;
    uint32_t rounds; ///< rounds of the function `change`
    bool looks;      ///< shaders sample everything
    uint32_t copies; ///< copies of tiles and levels
    uint32_t oldest; ///< oldest version in them
};

/* A source whose texels all equal the version. */
struct versions {
    SluiceImageSource base; ///< must be first
    atomic_uint version;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    (void)base;
    info->width = info->height = SIZE;
    info->mipLevelCount = 11;
    info->format = SLUICE_FORMAT_R8G8B8A8_UNORM;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    const uint32_t version = ((struct versions *)base)->version;
    for (uint32_t y = 0; y < region->height; y++)
        for (uint32_t x = 0; x < region->width; x++)
            memcpy((char *)texels + y * row_pitch + 4 * x, &version, 4);
    return SLUICE_SUCCESS;
}

static const SluiceImageSourceInterface versions_interface = {
    .structSize = sizeof versions_interface, .pfnGetInfo = get_info, .pfnReadRegion = read_region};

static struct device devices[DEVICES]; /* large */
static struct versions versions;
static SluiceReadPool *pool;
static struct fault_source source; ///< shared by all textures

static uint8_t want(void *user, uint32_t region)
{
    (void)region;
    return ((struct device *)user)->looks ? 0 : SLUICE_MIP_UNTOUCHED;
}

static void add_texture(struct device *d)
{
    const SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                  .source = &source.base};
    CHECK_OK(sluiceAddVulkanTexture(d->streamer, &create, &d->texture));
}

static void device_init(struct device *d)
{
    *d = (struct device){.fake = {.tail_page_count = 1, .want = want, .user = d, .readPool = pool},
                         .looks = true};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 1 << 8,
                                           .feedbackTimeoutTicks = 2};
    fake_vulkan_fill(&info);
    CHECK_OK(fake_vulkan_create(&d->fake, &info, &d->streamer));
    add_texture(d);
}

static void init(uint32_t device_count, uint64_t cache_size)
{
    const SluiceReadPoolCreateInfo info = {
        .structSize = sizeof info, .threadCount = 3, .cacheSize = cache_size};
    CHECK_OK(sluiceCreateReadPool(&info, &pool));
    versions.base.pInterface = &versions_interface;
    versions.version = 1;
    fault_source_init(&source, &versions.base);
    for (uint32_t i = 0; i < device_count; i++)
        device_init(&devices[i]);
}

static void finish(uint32_t device_count)
{
    for (uint32_t i = 0; i < device_count; i++) {
        fake_vulkan_destroy(devices[i].streamer);
        assert_int_equal(devices[i].fake.live_objects, 0);
    }
    sluiceDestroyReadPool(pool);
    fault_source_finish(&source);
}

static void frame(struct device *d)
{
    struct fake_vulkan *fake = &d->fake;
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    fake->published = false;
    fake->copy_count = fake->bind_count = 0;
    CHECK_OK(sluiceBeginStreamingFrame(d->streamer, fake_vulkan_commands(fake), ++d->time, &frame));
    CHECK_OK(sluiceEndStreamingFrame(d->streamer, fake_vulkan_commands(fake)));
    fake->frame_semaphore = frame.semaphore;
    fake->frame_value = frame.signalValue;
    for (uint32_t i = 0; i < fake->copy_count; i++)
        if (fake->copies[i].texel < d->oldest)
            d->oldest = fake->copies[i].texel;
    d->copies += fake->copy_count;
}

static bool is_sharp(const struct device *d)
{
    SluiceVulkanTextureState state = {.structSize = sizeof state};
    CHECK_OK(sluiceGetVulkanTextureState(d->streamer, d->texture.textureId, NULL, &state));
    return state.residentLevel == 0 && state.reloadingTileCount == 0;
}

static void run_until_sharp(struct device *d)
{
    d->looks = true;
    for (uint32_t i = 0; i < 10000 && (i < 4 || !is_sharp(d)); i++) {
        CHECK_OK(sluiceWaitVulkanStreamerIdle(d->streamer));
        frame(d);
    }
    assert_true(is_sharp(d));
}

static void *load(void *argument)
{
    run_until_sharp(argument);
    return NULL;
}

static void on_threads(uint32_t device_count, void *(*work)(void *))
{
    pthread_t threads[DEVICES];
    for (uint32_t i = 0; i < device_count; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, work, &devices[i]), 0);
    for (uint32_t i = 0; i < device_count; i++)
        pthread_join(threads[i], NULL);
}

static void devices_on_threads_read_what_one_device_reads(void **state)
{
    (void)state;
    init(1, 0);
    on_threads(1, load);
    uint64_t alone = source.read_count;
    finish(1);
    assert_in_range(alone, 64 + 16 + 4, 100); /* tiles, and the levels of the tail */
    for (uint32_t count = 2; count <= DEVICES; count++) {
        init(count, 0);
        on_threads(count, load);
        assert_int_equal(source.read_count, alone);
        SluiceReadPoolStatistics now = {.structSize = sizeof now};
        CHECK_OK(sluiceGetReadPoolStatistics(pool, &now));
        assert_int_equal(now.readCount, alone);
        assert_int_equal(now.joinedCount + now.cachedCount, (count - 1) * alone);
        finish(count);
    }
}

/* Stops sampling, invalidates, and removes and adds the texture, while frames and reads
 * continue. */
static void *change(void *argument)
{
    struct device *d = argument;
    for (d->rounds = 0; d->rounds < 60; d->rounds++) {
        d->looks = d->rounds % 5 != 0;
        if (d->rounds % 7 == 3)
            CHECK_OK(
                sluiceInvalidateVulkanTexture(d->streamer, d->texture.textureId, NULL, UINT32_MAX));
        if (d->rounds % 11 == 5) {
            CHECK_OK(sluiceRemoveVulkanTexture(d->streamer, d->texture.textureId));
            frame(d);
            CHECK_OK(sluiceWaitVulkanStreamerIdle(d->streamer));
            frame(d);
            add_texture(d);
        }
        for (uint32_t i = 0; i < 4; i++)
            frame(d);
    }
    run_until_sharp(d);
    return NULL;
}

/* Everything is resident. Tiles read after a change have its version, or a later one of another
 * device. */
static void *read_again(void *argument)
{
    struct device *d = argument;
    change(d);
    for (uint32_t round = 0; round < 8; round++) {
        run_until_sharp(d);
        d->copies = 0;
        d->oldest = UINT32_MAX;
        const uint32_t version = ++versions.version;
        CHECK_OK(
            sluiceInvalidateVulkanTexture(d->streamer, d->texture.textureId, NULL, UINT32_MAX));
        run_until_sharp(d);
        assert_true(d->copies >= 64 + 16 + 4);
        assert_true(d->oldest >= version);
    }
    return NULL;
}

static void devices_on_threads_may_change_their_textures(void **state)
{
    (void)state;
    init(DEVICES, 1 << 20); /* room for 16 tiles */
    source.delay_us = 10;
    on_threads(DEVICES, read_again);
    finish(DEVICES);
}

static void a_context_is_a_member_while_it_exists(void **state)
{
    (void)state;
    SluiceReadPoolStatistics now = {.structSize = sizeof now};
    init(2, 0);
    CHECK_OK(sluiceGetReadPoolStatistics(pool, &now));
    assert_int_equal(now.memberCount, 2);
    sluiceDestroyReadPool(pool); /* refused */
    run_until_sharp(&devices[0]);
    CHECK_OK(sluiceGetReadPoolStatistics(pool, &now));
    assert_true(now.keptCount > 0);
    fake_vulkan_destroy(devices[0].streamer);
    devices[0].streamer = NULL;
    CHECK_OK(sluiceGetReadPoolStatistics(pool, &now));
    assert_int_equal(now.memberCount, 1);
    assert_int_equal(now.keptCount, 0);
    run_until_sharp(&devices[1]); /* caches nothing, because it is alone */
    CHECK_OK(sluiceGetReadPoolStatistics(pool, &now));
    assert_int_equal(now.keptCount, 0);
    assert_true(now.keptPeakSize > 0);
    finish(2);
}

static void keep_line(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    strncpy(user, message, 255);
}

static SluiceResult refuse_job(void *user, void (*run)(void *), void *job)
{
    (void)user, (void)run, (void)job;
    return SLUICE_NOT_READY;
}

static void settings_of_the_pool_are_refused_in_its_contexts(void **state)
{
    (void)state;
    static const SluiceJobSystem jobs = {NULL, refuse_job};
    init(0, 0);
    for (uint32_t i = 0; i < 3; i++) {
        char line[256] = "";
        struct device *d = &devices[0];
        SluiceVulkanContext *context;
        *d = (struct device){.fake = {.readPool = pool, .log = {line, keep_line}}};
        SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(&d->fake);
        info.loaderThreadCount = i == 0;
        info.maxReadsPerSource = i == 1;
        info.pJobSystem = i == 2 ? &jobs : NULL;
        CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(line, "are those of readPool: set them to 0"));
    }
    finish(0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(devices_on_threads_read_what_one_device_reads),
        cmocka_unit_test(devices_on_threads_may_change_their_textures),
        cmocka_unit_test(a_context_is_a_member_while_it_exists),
        cmocka_unit_test(settings_of_the_pool_are_refused_in_its_contexts),
    };
    return RUN_TESTS(tests);
}
