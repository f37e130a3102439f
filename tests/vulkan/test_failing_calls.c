/* Every Vulkan call that may fail does so once, with each possible result. */
#include "vulkan/fake_vulkan.h"

#include "support/gray_source.h"
#include "support/test.h"

/* Enough frames for the global bias to fall again, after a refused heap raised it by a level. */
enum { FRAMES = 32 };

static const struct {
    VkResult from;
    SluiceResult to;
} failures[] = {
    {VK_ERROR_OUT_OF_HOST_MEMORY, SLUICE_ERROR_OUT_OF_HOST_MEMORY},
    {VK_ERROR_OUT_OF_DEVICE_MEMORY, SLUICE_ERROR_OUT_OF_DEVICE_MEMORY},
    {VK_ERROR_DEVICE_LOST, SLUICE_ERROR_DEVICE_LOST},
    {VK_ERROR_UNKNOWN, SLUICE_ERROR_VULKAN},
};
enum { FAILURES = sizeof failures / sizeof failures[0] };

static uint8_t want_all(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

static SluiceImageSource *gray;

static SluiceResidencyMode mode; /* tested mode */
static bool mixes;               /* true: also adds paged textures */

static bool uses_upload_queue;

static SluiceResult create(struct fake_vulkan *fake, SluiceVulkanStreamer **streamer)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .tilesPerFrame = 16,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 256,
                                           .feedbackTimeoutTicks = 100};
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    info.pagedTextures = mixes;
    fake->has_upload_queue = uses_upload_queue;
    return fake_vulkan_create(fake, &info, streamer);
}

static void check_nothing_left(const struct fake_vulkan *fake)
{
    assert_int_equal(fake->live_objects, 0);
    assert_int_equal(fake->live_memory, 0);
}

static void creation_survives(void)
{
    for (size_t f = 0; f < FAILURES; f++)
        for (uint64_t n = 1;; n++) {
            static struct fake_vulkan fake; /* large */
            fake = (struct fake_vulkan){
                .tail_page_count = 1, .failing_call = n, .failure = failures[f].from};
            SluiceVulkanStreamer *streamer;
            SluiceResult result = create(&fake, &streamer);
            assert_true((result == SLUICE_SUCCESS) == (streamer != NULL));
            bool failed = fake.calls >= n;
            if (failed)
                CHECK_RESULT(result, failures[f].to);
            fake_vulkan_destroy(streamer);
            check_nothing_left(&fake);
            if (!failed)
                break;
        }
}

static void adding_survives(uint64_t objects_per_texture)
{
    static struct fake_vulkan fake; /* large */
    fake = (struct fake_vulkan){.tail_page_count = 1};
    SluiceVulkanStreamer *streamer;
    CHECK_OK(create(&fake, &streamer));
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info,
                                          .source = gray,
                                          .residencyMode =
                                              mixes ? SLUICE_RESIDENCY_MODE_PAGED : mode};
    SluiceVulkanTexture texture;
    uint64_t objects = fake.live_objects;
    for (size_t f = 0; f < FAILURES; f++)
        for (uint64_t n = 1;; n++) {
            fake.calls = 0;
            fake.failing_call = n;
            fake.failure = failures[f].from;
            SluiceResult result = sluiceAddVulkanTexture(streamer, &info, &texture);
            if (fake.calls < n) {
                CHECK_OK(result);
                break;
            }
            CHECK_RESULT(result, failures[f].to);
            assert_int_equal(fake.live_objects, objects + objects_per_texture * f);
        }
    fake.failing_call = 0;
    fake_vulkan_destroy(streamer);
    check_nothing_left(&fake);
}

/* `objects_per_array`: live objects that adding an array creates. */
static void adding_arrays_survives(uint64_t objects_per_array, bool metadata)
{
    static struct fake_vulkan fake; /* large */
    SluiceImageSource *array;
    CHECK_OK(
        sluiceCreateArrayImageSource((SluiceImageSource *[]){gray, gray, gray}, 3, NULL, &array));
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = array};
    for (size_t f = 0; f < FAILURES; f++) {
        fake = (struct fake_vulkan){.tail_page_count = 1, .metadata_size = metadata ? 65536 : 0};
        SluiceVulkanStreamer *streamer;
        CHECK_OK(create(&fake, &streamer));
        uint64_t objects = fake.live_objects, memory = fake.live_memory;
        for (uint64_t n = 1;; n++) {
            SluiceVulkanTexture textures[3];
            fake.calls = 0;
            fake.failing_call = n;
            fake.failure = failures[f].from;
            SluiceResult result = sluiceAddVulkanTextureArray(streamer, &info, 3, textures);
            if (fake.calls < n) {
                CHECK_OK(result);
                break;
            }
            CHECK_RESULT(result, failures[f].to);
            assert_int_equal(fake.live_objects, objects);
            assert_int_equal(fake.live_memory, memory);
        }
        assert_int_equal(fake.live_objects, objects + objects_per_array);
        if (metadata)
            assert_int_equal(fake.live_memory, memory + 3 * 65536);
        SluiceVulkanTexture another[3];
        CHECK_RESULT(sluiceAddVulkanTextureArray(streamer, &info, 3, another),
                     SLUICE_ERROR_LIMIT_EXCEEDED); /* one place is left */
        fake.failing_call = 0;
        fake_vulkan_destroy(streamer);
        check_nothing_left(&fake);
    }
    sluiceDestroyImageSource(array);
}

/* An image, its memory, a view per layer, and a view of all layers. */
static void adding_an_array_survives_every_failing_call(void **state)
{
    (void)state;
    mode = SLUICE_RESIDENCY_MODE_SPARSE;
    adding_arrays_survives(6, true); /* the memory is that of metadata */
    mode = SLUICE_RESIDENCY_MODE_PAGED;
    adding_arrays_survives(6, false);
    mode = SLUICE_RESIDENCY_MODE_DENSE;
    adding_arrays_survives(6, false);
}

/* Runs frames that complete at once, until one fails. */
static SluiceResult stream(struct fake_vulkan *fake, SluiceVulkanStreamer *streamer)
{
    for (uint64_t i = 1; i <= FRAMES; i++) {
        fake->bind_count = fake->copy_count = 0;
        fake->published = false;
        fake->bind_value = fake->submitted_bind_value;
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        SluiceResult result = sluiceWaitVulkanStreamerIdle(streamer);
        if (result == SLUICE_SUCCESS)
            result = sluiceBeginStreamingFrame(streamer, fake_vulkan_commands(fake), i, &frame);
        if (result != SLUICE_SUCCESS)
            return result;
        CHECK_OK(sluiceEndStreamingFrame(streamer, fake_vulkan_commands(fake)));
        fake->frame_semaphore = frame.semaphore;
        fake->frame_value = frame.signalValue;
    }
    return SLUICE_SUCCESS;
}

/* A buffer per frame in flight, through which MinMip maps are copied. Without it they are copied
 * later. */
#define STAGING_CALLS (3u * 4u)

/* Runs frames until one fails. After that, only destroying the streamer is allowed. */
static void frames_survive(uint32_t packed_count, uint32_t binds_per_call, uint32_t harmless_calls)
{
    uint32_t harmless = 0;
    for (size_t f = 0; f < FAILURES; f++)
        for (uint64_t n = 1;; n++) {
            static struct fake_vulkan fake; /* large */
            fake = (struct fake_vulkan){
                .tail_page_count = 1, .want = want_all, .maxBindsPerCall = binds_per_call};
            SluiceVulkanStreamer *streamer;
            CHECK_OK(create(&fake, &streamer));
            SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = gray};
            SluiceVulkanTexture texture;
            CHECK_OK(sluiceAddVulkanTexture(streamer, &info, &texture));
            fake.calls = 0;
            fake.failing_call = n;
            fake.failure = failures[f].from;
            SluiceResult result = stream(&fake, streamer);
            bool failed = fake.calls >= n;
            SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
            sluiceGetVulkanStreamerStatistics(streamer, &stats);
            if (result == SLUICE_SUCCESS) {
                harmless += failed;
                assert_true((stats.uploadQueueCopies > 0) == uses_upload_queue);
                assert_int_equal(stats.tilesMapped - stats.tilesUnmapped, 16 + 4 + packed_count);
            } else {
                assert_true(failed);
                CHECK_RESULT(result, failures[f].to);
            }
            fake_vulkan_destroy(streamer);
            check_nothing_left(&fake);
            if (!failed)
                break;
        }
    assert_int_equal(harmless, harmless_calls * FAILURES);
}

static void creation_survives_every_failing_call(void **state)
{
    (void)state;
    for (mode = SLUICE_RESIDENCY_MODE_SPARSE; mode <= SLUICE_RESIDENCY_MODE_DENSE; mode++)
        creation_survives();
    mode = SLUICE_RESIDENCY_MODE_SPARSE;
    mixes = true;
    creation_survives();
    mixes = false;
    uses_upload_queue = true;
    creation_survives();
    uses_upload_queue = false;
}

static void adding_survives_every_failing_call(void **state)
{
    (void)state;
    mode = SLUICE_RESIDENCY_MODE_SPARSE;
    adding_survives(2); /* image and view */
    mode = SLUICE_RESIDENCY_MODE_PAGED;
    adding_survives(3); /* and memory */
    mode = SLUICE_RESIDENCY_MODE_DENSE;
    adding_survives(3);
    mode = SLUICE_RESIDENCY_MODE_SPARSE;
    mixes = true;
    adding_survives(3);
    mixes = false;
}

static void frames_survive_every_failing_call(void **state)
{
    (void)state;
    mode = SLUICE_RESIDENCY_MODE_SPARSE;
    /* Heaps that the device refuses are only a smaller budget. */
    frames_survive(1, 0, STAGING_CALLS + 2);
    frames_survive(1, 1, STAGING_CALLS + 2);
    mode = SLUICE_RESIDENCY_MODE_PAGED;
    /* Packed levels fill two tiles; a chunk that is refused is tried again with half of the pages.
     */
    frames_survive(2, 0, STAGING_CALLS + 4);
    mode = SLUICE_RESIDENCY_MODE_DENSE;
    frames_survive(2, 0, STAGING_CALLS + 0);
    uses_upload_queue = true;
    frames_survive(2, 0, STAGING_CALLS + 0);
    uses_upload_queue = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(creation_survives_every_failing_call),
        cmocka_unit_test(adding_survives_every_failing_call),
        cmocka_unit_test(adding_an_array_survives_every_failing_call),
        cmocka_unit_test(frames_survive_every_failing_call),
    };
    gray = gray_source(512, 512);
    int failed = RUN_TESTS(tests);
    sluiceDestroyImageSource(gray);
    return failed;
}
