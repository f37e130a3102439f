/* What callers and their sources say wrongly is refused, with a line that names it, and leaves
 * nothing behind. */
#include "vulkan/fake_vulkan.h"

#include "support/test.h"

#include <sluice/demand.h>

#include <stdio.h>
#include <string.h>

enum { MODES = 3 };
static const SluiceResidencyMode modes[MODES] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

/* The last line and how many there were. */
struct lines {
    uint32_t count;
    char last[512];
};

static void keep_line(void *user, SluiceLogSeverity severity, const char *message)
{
    struct lines *lines = user;
    (void)severity;
    lines->count++;
    snprintf(lines->last, sizeof lines->last, "%s", message);
}

static void check_line(struct lines *lines, const char *part)
{
    if (lines->count != 1 || !strstr(lines->last, part))
        fail_msg("%u lines, the last: \"%s\", without \"%s\"", lines->count, lines->last, part);
    *lines = (struct lines){0};
}

static SluiceVulkanStreamerCreateInfo small(struct fake_vulkan *fake, struct lines *lines)
{
    *fake = (struct fake_vulkan){.tail_page_count = 1};
    SluiceVulkanStreamerCreateInfo info = {.maxTextureCount = 4,
                                           .maxRegionCount = 256,
                                           .tilesPerFrame = 16,
                                           .loaderThreadCount = 1,
                                           .log = {lines, keep_line}};
    fake_vulkan_fill(fake, &info);
    return info;
}

struct liar {
    SluiceImageSource base;
    SluiceImageInfo info;
};

static SluiceResult lie(SluiceImageSource *source, SluiceImageInfo *info)
{
    *info = ((struct liar *)source)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_nothing(SluiceImageSource *source, const SluiceImageRegion *region,
                                 void *texels, size_t row_pitch)
{
    (void)source, (void)region, (void)texels, (void)row_pitch;
    return SLUICE_SUCCESS;
}

static void infos_that_no_image_has_are_refused_in_every_mode(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    static const SluiceImageSourceInterface interface = {lie, read_nothing, NULL, NULL};
    static const struct {
        SluiceImageInfo info;
        uint32_t layers;
        const char *line;
    } cases[] = {
        {{0, 512, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}, 1, "width"},
        {{512, 0, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}, 1, "height"},
        {{(1u << 20) + 1, 4, 21, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}, 1, "width"},
        {{512, UINT32_MAX, 32, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}, 1, "height"},
        {{512, 512, 0, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}, 1, "mipLevelCount"},
        {{512, 512, 1, SLUICE_FORMAT_R8G8B8A8_UNORM, "level 0 alone"}, 1, "mipLevelCount"},
        {{512, 512, 11, SLUICE_FORMAT_R8G8B8A8_UNORM, NULL}, 1, "mipLevelCount"},
        {{512, 512, UINT32_MAX, SLUICE_FORMAT_R8G8B8A8_UNORM, ""}, 1, "mipLevelCount"},
        {{512, 512, 10, SLUICE_FORMAT_UNDEFINED, "a"}, 1, "format"},
        {{512, 512, 10, (SluiceFormat)SLUICE_FORMAT_COUNT, "a"}, 1, "format"},
        {{512, 512, 10, (SluiceFormat)-5, "a"}, 1, "format"},
        {{512, 512, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a", UINT32_MAX},
         UINT32_MAX,
         "arrayLayerCount"},
    };
    for (uint32_t m = 0; m < MODES; m++) {
        struct lines lines = {0};
        SluiceVulkanStreamer *streamer;
        SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
        info.residencyMode = modes[m];
        CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
        uint64_t objects = fake.live_objects;
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            struct liar liar = {{&interface}, cases[i].info};
            SluiceVulkanTextureCreateInfo create = {.source = &liar.base};
            SluiceVulkanTexture textures[4];
            CHECK_RESULT(sluiceAddVulkanTextureArray(streamer, &create, cases[i].layers, textures),
                         SLUICE_ERROR_INVALID_ARGUMENT);
            check_line(&lines, cases[i].line);
            assert_int_equal(fake.live_objects, objects);
        }
        sluiceDestroyVulkanStreamer(streamer);
        assert_int_equal(fake.live_objects, 0);
    }
}

static void *refuse(void *user, size_t size, size_t alignment)
{
    (void)user, (void)size, (void)alignment;
    return NULL;
}

static void free_nothing(void *user, void *memory, size_t size)
{
    (void)user, (void)memory, (void)size;
}

static const SluiceAllocationCallbacks no_memory = {NULL, refuse, free_nothing};

#define FIELD(type, name, most)                                                                    \
    {                                                                                              \
#name, offsetof(type, name), sizeof(((type *)NULL)->name), most                            \
    }
struct field {
    const char *name;
    size_t offset, size;
    uint64_t most;
};

static void set_field(void *info, const struct field *field, uint64_t value)
{
    uint32_t word = (uint32_t)value;
    memcpy((char *)info + field->offset, field->size == 4 ? (void *)&word : (void *)&value,
           field->size);
}

/* Limits come first: at a limit it is memory that is lacking, without which creation stops early.
 */
static void streamers_take_every_limit_of_the_header_and_nothing_beyond(void **state)
{
    (void)state;
    static const struct field fields[] = {
        FIELD(SluiceVulkanStreamerCreateInfo, framesInFlight, 16),
        FIELD(SluiceVulkanStreamerCreateInfo, maxTextureCount, 1u << 20),
        FIELD(SluiceVulkanStreamerCreateInfo, tilesPerFrame, 1u << 14),
        FIELD(SluiceVulkanStreamerCreateInfo, maxLoadsInFlight, 1u << 16),
        FIELD(SluiceVulkanStreamerCreateInfo, heapTileCapacity, 1u << 20),
        FIELD(SluiceVulkanStreamerCreateInfo, maxRegionCount, 1u << 28),
        FIELD(SluiceVulkanStreamerCreateInfo, maxPageChunkCount, 1u << 10),
        FIELD(SluiceVulkanStreamerCreateInfo, residencyFadeTime, UINT64_C(1) << 40),
        FIELD(SluiceVulkanStreamerCreateInfo, feedbackEncoding, SLUICE_FEEDBACK_ENCODING_MASKS),
        FIELD(SluiceVulkanStreamerCreateInfo, residencyMode, SLUICE_RESIDENCY_MODE_DENSE)};
    static struct fake_vulkan fake; /* large */
    SluiceVulkanStreamer *streamer;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        for (uint64_t beyond = 0; beyond < 2; beyond++) {
            struct lines lines = {0};
            SluiceVulkanStreamerCreateInfo info = {.pAllocator = &no_memory,
                                                   .log = {&lines, keep_line}};
            fake_vulkan_fill(&fake, &info);
            set_field(&info, &fields[i], fields[i].most + beyond);
            CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer),
                         beyond ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            if (beyond)
                check_line(&lines, fields[i].name);
        }
}

static SluiceDemandLoaderCreateInfo demand_info(struct fake_vulkan *fake, struct lines *lines)
{
    SluiceVulkanStreamerCreateInfo handles;
    *fake = (struct fake_vulkan){0};
    *lines = (struct lines){0};
    fake_vulkan_fill(fake, &handles);
    return (SluiceDemandLoaderCreateInfo){.instance = handles.instance,
                                          .physicalDevice = handles.physicalDevice,
                                          .device = handles.device,
                                          .pfnGetInstanceProcAddr = handles.pfnGetInstanceProcAddr,
                                          .log = {lines, keep_line}};
}

static void demand_loaders_take_every_limit_of_the_header_and_nothing_beyond(void **state)
{
    (void)state;
    static const struct field fields[] = {
        FIELD(SluiceDemandLoaderCreateInfo, launchesInFlight, 16),
        FIELD(SluiceDemandLoaderCreateInfo, maxTextureCount, 1u << 24),
        FIELD(SluiceDemandLoaderCreateInfo, pageCapacity, UINT64_C(1) << 31),
        FIELD(SluiceDemandLoaderCreateInfo, maxRequestsPerLaunch, 1u << 20),
        FIELD(SluiceDemandLoaderCreateInfo, maxTilesInFlight, 1u << 16),
        FIELD(SluiceDemandLoaderCreateInfo, maxPageChunkCount, 1u << 10)};
    static const struct field budget = FIELD(SluiceDemandLoaderCreateInfo, memoryBudget, 0);
    static struct fake_vulkan fake; /* large */
    struct lines lines;
    SluiceDemandLoader *loader;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        for (uint64_t beyond = 0; beyond < 2; beyond++) {
            SluiceDemandLoaderCreateInfo info = demand_info(&fake, &lines);
            info.pAllocator = &no_memory;
            set_field(&info, &fields[i], fields[i].most + beyond);
            CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader),
                         beyond ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            if (beyond)
                check_line(&lines, fields[i].name);
        }
    SluiceDemandLoaderCreateInfo info = demand_info(&fake, &lines);
    info.pAllocator = &no_memory;
    set_field(&info, &budget, UINT64_C(4) << 20);
    CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    set_field(&info, &budget, (UINT64_C(4) << 20) - 1);
    CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "memoryBudget");
}

static void queue_families_must_be_there_and_do_what_they_are_for(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    static const struct {
        SluiceResidencyMode mode;
        uint32_t family, sparse_family;
        const char *line; ///< NULL: good
    } cases[] = {
        {SLUICE_RESIDENCY_MODE_SPARSE, 0, 0, NULL},
        {SLUICE_RESIDENCY_MODE_SPARSE, FAKE_COMPUTE_FAMILY, FAKE_SPARSE_FAMILY, NULL},
        {SLUICE_RESIDENCY_MODE_PAGED, 0, FAKE_FAMILIES, NULL},
        {SLUICE_RESIDENCY_MODE_DENSE, FAKE_COMPUTE_FAMILY, UINT32_MAX, NULL},
        {SLUICE_RESIDENCY_MODE_SPARSE, FAKE_FAMILIES, 0, "queueFamilyIndex is 4"},
        {SLUICE_RESIDENCY_MODE_DENSE, UINT32_MAX, 0, "queueFamilyIndex is 4294967295"},
        {SLUICE_RESIDENCY_MODE_PAGED, FAKE_TRANSFER_FAMILY, 0, "VK_QUEUE_COMPUTE_BIT"},
        {SLUICE_RESIDENCY_MODE_PAGED, FAKE_SPARSE_FAMILY, 0, "VK_QUEUE_COMPUTE_BIT"},
        {SLUICE_RESIDENCY_MODE_SPARSE, 0, FAKE_FAMILIES, "sparseQueueFamilyIndex is 4"},
        {SLUICE_RESIDENCY_MODE_SPARSE, 0, FAKE_COMPUTE_FAMILY, "VK_QUEUE_SPARSE_BINDING_BIT"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct lines lines = {0};
        SluiceVulkanStreamer *streamer;
        SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
        info.residencyMode = cases[i].mode;
        info.queueFamilyIndex = cases[i].family;
        info.sparseQueueFamilyIndex = cases[i].sparse_family;
        CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer),
                     cases[i].line ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_SUCCESS);
        if (cases[i].line)
            check_line(&lines, cases[i].line);
        sluiceDestroyVulkanStreamer(streamer);
        assert_int_equal(fake.live_objects, 0);
    }
    static const uint32_t bad[] = {FAKE_TRANSFER_FAMILY, FAKE_SPARSE_FAMILY, FAKE_FAMILIES,
                                   UINT32_MAX};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct lines lines;
        SluiceDemandLoader *loader;
        SluiceDemandLoaderCreateInfo info = demand_info(&fake, &lines);
        info.queueFamilyIndex = bad[i];
        CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
        check_line(&lines, "queueFamilyIndex is");
    }
}

static void what_is_missing_in_a_create_info_is_named(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    static const SluiceAllocationCallbacks half = {.pfnAllocate = refuse};
    for (int i = 0; i < 5; i++) {
        static const char *const names[] = {"instance is NULL", "physicalDevice is NULL",
                                            "device is NULL", "pfnGetInstanceProcAddr is NULL",
                                            "pAllocator is NULL"};
        struct lines lines = {0};
        SluiceVulkanStreamer *streamer;
        SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
        SluiceDemandLoader *loader;
        SluiceDemandLoaderCreateInfo demand = demand_info(&fake, &lines);
        info.instance = demand.instance = i == 0 ? NULL : info.instance;
        info.physicalDevice = demand.physicalDevice = i == 1 ? NULL : info.physicalDevice;
        info.device = demand.device = i == 2 ? NULL : info.device;
        if (i == 3)
            info.pfnGetInstanceProcAddr = demand.pfnGetInstanceProcAddr = NULL;
        info.pAllocator = demand.pAllocator = i == 4 ? &half : NULL;
        CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_NULL_POINTER);
        check_line(&lines, names[i]);
        CHECK_RESULT(sluiceCreateDemandLoader(&demand, &loader), SLUICE_ERROR_NULL_POINTER);
        check_line(&lines, names[i]);
    }
}

static void what_is_ended_without_a_begin_and_time_that_runs_back_are_named(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    struct lines lines = {0};
    SluiceVulkanStreamer *streamer;
    SluiceStreamingFrame frame;
    SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
    info.timeStampsPerSecond = 60;
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    VkCommandBuffer commands = fake_vulkan_commands(&fake);
    CHECK_RESULT(sluiceEndStreamingFrame(streamer, commands), SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "no frame can be ended");
    CHECK_OK(sluiceBeginStreamingFrame(streamer, commands, 7, &frame));
    CHECK_OK(sluiceEndStreamingFrame(streamer, commands));
    CHECK_RESULT(sluiceBeginStreamingFrame(streamer, commands, 6, &frame),
                 SLUICE_ERROR_TIME_BACKWARDS);
    check_line(&lines, "timeStamp is 6; it must not be below the last frame's, 7");
    sluiceDestroyVulkanStreamer(streamer);

    SluiceDemandLoader *loader;
    SluiceDemandLoaderCreateInfo demand = demand_info(&fake, &lines);
    CHECK_OK(sluiceCreateDemandLoader(&demand, &loader));
    CHECK_RESULT(sluiceEndDemandLaunch(loader, fake_vulkan_commands(&fake)),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "no launch can be ended");
    sluiceDestroyDemandLoader(loader);
}

/* As loaders do when the instance was created for an older version. */
static void instances_of_vulkan_1_1_hear_what_to_do(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    static const char *const newer[] = {"vkGetSemaphoreCounterValue", "vkWaitSemaphores",
                                        "vkGetPhysicalDeviceFeatures2"};
    for (size_t i = 0; i < sizeof newer / sizeof newer[0]; i++) {
        struct lines lines = {0};
        SluiceVulkanStreamer *streamer;
        SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
        fake.missing = newer[i];
        CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_UNSUPPORTED);
        check_line(&lines, "create the instance with apiVersion 1.2");
        SluiceDemandLoader *loader;
        SluiceDemandLoaderCreateInfo demand = demand_info(&fake, &lines);
        fake.missing = newer[i];
        CHECK_RESULT(sluiceCreateDemandLoader(&demand, &loader), SLUICE_ERROR_UNSUPPORTED);
        check_line(&lines, "create the instance with apiVersion 1.2");
    }
}

/* What the streamer does itself nobody else does; what pages tell people to call goes on. */
static void the_manager_of_a_streamer_takes_no_calls_of_its_loop(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    static const SluiceImageSourceInterface interface = {lie, read_nothing, NULL, NULL};
    struct liar source = {{&interface}, {512, 512, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}};
    struct lines lines = {0};
    SluiceVulkanStreamer *streamer;
    SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    SluiceStreamedTextureManager *manager = sluiceGetVulkanStreamerManager(streamer);
    SluiceVulkanTextureCreateInfo create = {.source = &source.base};
    SluiceVulkanTexture texture;
    SluiceStreamedTextureDesc desc = {512, 512, 10, 2, 1, 128, 128};
    SluiceTextureId id;
    uint8_t map[16] = {0};
    SluiceFeedbackDesc feedback = {.pMinMip = map, .width = 4, .height = 4};
    SluiceTile tiles[4];
    SluiceTileMove moves[4];
    SluiceMinMipRect rects[4];
    uint32_t count = 4, tile = 0;
    const SluiceResult refused = SLUICE_ERROR_INVALID_ARGUMENT;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &texture));
    id = texture.textureId;
    CHECK_RESULT(sluiceAddStreamedTexture(manager, &desc, &id), refused);
    CHECK_RESULT(sluiceUpdateWithSamplerFeedback(manager, id, &feedback, 1, 1), refused);
    CHECK_RESULT(sluiceMatchPrimaryTexture(manager, id, id, 1, 1), refused);
    CHECK_RESULT(sluiceSetPrimaryTexture(manager, id, id), refused);
    CHECK_RESULT(sluiceGetTilesToMap(manager, id, &count, tiles), refused);
    CHECK_RESULT(sluiceGetTilesToUnmap(manager, id, 1, &count, tiles), refused);
    CHECK_RESULT(sluiceGetTilesToCancel(manager, id, &count, tiles), refused);
    CHECK_RESULT(sluiceUpdateTilesMapping(manager, id, 1, &tile), refused);
    CHECK_RESULT(sluiceReportFailedTiles(manager, id, 1, &tile, 1), refused);
    CHECK_RESULT(sluiceReportCancelledTiles(manager, id, 1, &tile, 1), refused);
    CHECK_RESULT(sluiceCompleteRetireValue(manager, 1), refused);
    CHECK_RESULT(sluiceDefragmentTiles(manager, 1, &count, moves), refused);
    CHECK_RESULT(sluiceGetMinMipUpdates(manager, &count, rects), refused);
    CHECK_RESULT(sluiceRemoveStreamedTexture(manager, id, 1), refused);
    sluiceDestroyStreamedTextureManager(manager);
    SluiceStreamedTextureStatistics statistics;
    SluiceStreamedTextureManagerConfig config = {.numExtraStandbyTiles = 3};
    CHECK_OK(sluiceGetStatistics(manager, &statistics));
    assert_int_equal(statistics.textureCount, 1);
    CHECK_OK(sluiceSetConfig(manager, &config));
    CHECK_OK(sluiceTrimStandbyTiles(manager, 0));
    CHECK_OK(sluiceRetryFailedTiles(manager, id));
    CHECK_OK(sluiceGetGivenUpTiles(manager, &count, tiles));
    SluiceStreamingFrame frame;
    CHECK_OK(sluiceBeginStreamingFrame(streamer, fake_vulkan_commands(&fake), 1, &frame));
    CHECK_RESULT(sluiceRemoveStreamedTexture(manager, id, 1), refused);
    CHECK_OK(sluiceRemoveVulkanTexture(streamer, id));
    CHECK_RESULT(sluiceCompleteRetireValue(manager, 1), refused);
    sluiceDestroyVulkanStreamer(streamer);
    assert_int_equal(fake.live_objects, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(infos_that_no_image_has_are_refused_in_every_mode),
        cmocka_unit_test(streamers_take_every_limit_of_the_header_and_nothing_beyond),
        cmocka_unit_test(demand_loaders_take_every_limit_of_the_header_and_nothing_beyond),
        cmocka_unit_test(queue_families_must_be_there_and_do_what_they_are_for),
        cmocka_unit_test(what_is_missing_in_a_create_info_is_named),
        cmocka_unit_test(what_is_ended_without_a_begin_and_time_that_runs_back_are_named),
        cmocka_unit_test(instances_of_vulkan_1_1_hear_what_to_do),
        cmocka_unit_test(the_manager_of_a_streamer_takes_no_calls_of_its_loop),
    };
    return RUN_TESTS(tests);
}
