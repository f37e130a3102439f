/* Wrong arguments of callers and sources are refused. A log line names them, and nothing is left
 * behind. */
#include "vulkan/fake_vulkan.h"

#include "support/streamer_manager.h"
#include "support/test.h"

#include <sluice/demand.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MODES = 3 };
static const SluiceResidencyMode modes[MODES] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

/* Last log line, and number of lines. */
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
    *fake = (struct fake_vulkan){.tail_page_count = 1, .log = {lines, keep_line}};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 256,
                                           .tilesPerFrame = 16};
    fake_vulkan_fill(&info);
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
    static const SluiceImageSourceInterface interface = {sizeof interface, lie, read_nothing, NULL,
                                                         NULL};
    static const struct {
        SluiceImageInfo info;
        uint32_t layers;
        const char *line;
    } cases[] = {
        {{sizeof(SluiceImageInfo), 0, 512, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}, 1, "width"},
        {{sizeof(SluiceImageInfo), 512, 0, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}, 1, "height"},
        {{sizeof(SluiceImageInfo), (1u << 20) + 1, 4, 21, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"},
         1,
         "width"},
        {{sizeof(SluiceImageInfo), 512, UINT32_MAX, 32, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"},
         1,
         "height"},
        {{sizeof(SluiceImageInfo), 512, 512, 0, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"},
         1,
         "mipLevelCount"},
        {{sizeof(SluiceImageInfo), 512, 512, 1, SLUICE_FORMAT_R8G8B8A8_UNORM, "level 0 alone"},
         1,
         "mipLevelCount"},
        {{sizeof(SluiceImageInfo), 512, 512, 11, SLUICE_FORMAT_R8G8B8A8_UNORM, NULL},
         1,
         "mipLevelCount"},
        {{sizeof(SluiceImageInfo), 512, 512, UINT32_MAX, SLUICE_FORMAT_R8G8B8A8_UNORM, ""},
         1,
         "mipLevelCount"},
        {{sizeof(SluiceImageInfo), 512, 512, 10, SLUICE_FORMAT_UNDEFINED, "a"}, 1, "format"},
        {{sizeof(SluiceImageInfo), 512, 512, 10, (SluiceFormat)SLUICE_FORMAT_COUNT, "a"},
         1,
         "format"},
        {{sizeof(SluiceImageInfo), 512, 512, 10, (SluiceFormat)-5, "a"}, 1, "format"},
        {{sizeof(SluiceImageInfo), 512, 512, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a", UINT32_MAX},
         UINT32_MAX,
         "arrayLayerCount"},
    };
    for (uint32_t m = 0; m < MODES; m++) {
        struct lines lines = {0};
        SluiceVulkanStreamer *streamer;
        SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
        info.residencyMode = modes[m];
        CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
        uint64_t objects = fake.live_objects;
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            struct liar liar = {{&interface}, cases[i].info};
            SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                    .source = &liar.base};
            SluiceVulkanTexture textures[4];
            CHECK_RESULT(sluiceAddVulkanTextureArray(streamer, &create, cases[i].layers, textures),
                         SLUICE_ERROR_INVALID_ARGUMENT);
            check_line(&lines, cases[i].line);
            assert_int_equal(fake.live_objects, objects);
        }
        fake_vulkan_destroy(streamer);
        assert_int_equal(fake.live_objects, 0);
    }
}

static void *allocate_unless(void *refuses, size_t size, size_t alignment)
{
    (void)alignment;
    return *(bool *)refuses ? NULL : malloc(size);
}

static void release(void *user, void *memory, size_t size)
{
    (void)user, (void)size;
    free(memory);
}

/* Returns a context whose allocator fails from now on. */
static SluiceVulkanContext *context_without_memory(struct fake_vulkan *fake, struct lines *lines)
{
    static bool refuses;
    static const SluiceAllocationCallbacks callbacks = {&refuses, allocate_unless, release};
    *fake = (struct fake_vulkan){.pAllocator = &callbacks, .log = {lines, keep_line}};
    *lines = (struct lines){0};
    const SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(fake);
    SluiceVulkanContext *context;
    refuses = false;
    CHECK_OK(sluiceCreateVulkanContext(&info, &context));
    refuses = true;
    return context;
}

static SluiceVulkanContext *create_context(struct fake_vulkan *fake, struct lines *lines)
{
    *fake = (struct fake_vulkan){.log = {lines, keep_line}};
    *lines = (struct lines){0};
    const SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(fake);
    SluiceVulkanContext *context;
    CHECK_OK(sluiceCreateVulkanContext(&info, &context));
    return context;
}

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

/* Limits are checked first. At a limit, creation stops early for lack of memory. */
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
        FIELD(SluiceVulkanStreamerCreateInfo, residencyFadeTicks, UINT64_C(1) << 40),
        FIELD(SluiceVulkanStreamerCreateInfo, feedbackEncoding, SLUICE_FEEDBACK_ENCODING_MASKS),
        FIELD(SluiceVulkanStreamerCreateInfo, residencyMode, SLUICE_RESIDENCY_MODE_DENSE)};
    static struct fake_vulkan fake; /* large */
    struct lines lines;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanContext *context = context_without_memory(&fake, &lines);
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        for (uint64_t beyond = 0; beyond < 2; beyond++) {
            SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .context = context};
            fake_vulkan_fill(&info);
            set_field(&info, &fields[i], fields[i].most + beyond);
            CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer),
                         beyond ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            if (beyond)
                check_line(&lines, fields[i].name);
        }
    sluiceDestroyVulkanContext(context);
}

static void demand_loaders_take_every_limit_of_the_header_and_nothing_beyond(void **state)
{
    (void)state;
    static const struct field fields[] = {
        FIELD(SluiceDemandLoaderCreateInfo, launchesInFlight, 16),
        FIELD(SluiceDemandLoaderCreateInfo, maxTextureCount, 1u << 24),
        FIELD(SluiceDemandLoaderCreateInfo, pageCapacity, UINT64_C(1) << 31),
        FIELD(SluiceDemandLoaderCreateInfo, maxRequestsPerLaunch, 1u << 20),
        FIELD(SluiceDemandLoaderCreateInfo, maxTilesInFlight, 1u << 16)};
    static const struct field budget = FIELD(SluiceDemandLoaderCreateInfo, memoryBudget, 0);
    static struct fake_vulkan fake; /* large */
    struct lines lines;
    SluiceDemandLoader *loader;
    SluiceVulkanContext *context = context_without_memory(&fake, &lines);
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        for (uint64_t beyond = 0; beyond < 2; beyond++) {
            SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .context = context};
            set_field(&info, &fields[i], fields[i].most + beyond);
            CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader),
                         beyond ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            if (beyond)
                check_line(&lines, fields[i].name);
        }
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .context = context};
    set_field(&info, &budget, UINT64_C(4) << 20);
    CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    set_field(&info, &budget, (UINT64_C(4) << 20) - 1);
    CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "memoryBudget");
    sluiceDestroyVulkanContext(context);
}

static void contexts_take_every_limit_of_the_header_and_nothing_beyond(void **state)
{
    (void)state;
    static const struct field fields[] = {
        FIELD(SluiceVulkanContextCreateInfo, loaderThreadCount, 1u << 10),
        FIELD(SluiceVulkanContextCreateInfo, maxPageChunkCount, 1u << 10)};
    static struct fake_vulkan fake; /* large */
    struct lines lines = {0};
    fake = (struct fake_vulkan){.log = {&lines, keep_line}};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        for (uint64_t beyond = 0; beyond < 2; beyond++) {
            SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(&fake);
            SluiceVulkanContext *context;
            set_field(&info, &fields[i], fields[i].most + beyond);
            CHECK_RESULT(sluiceCreateVulkanContext(&info, &context),
                         beyond ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_SUCCESS);
            if (beyond)
                check_line(&lines, fields[i].name);
            sluiceDestroyVulkanContext(context);
        }
}

static void sparse_mode_needs_a_context_with_a_sparse_queue(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    for (uint32_t m = 0; m < MODES; m++) {
        struct lines lines = {0};
        SluiceVulkanStreamer *streamer;
        SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
        SluiceVulkanContextCreateInfo context = fake_vulkan_context_info(&fake);
        bool sparse = modes[m] == SLUICE_RESIDENCY_MODE_SPARSE;
        context.sparseQueue = VK_NULL_HANDLE;
        CHECK_OK(sluiceCreateVulkanContext(&context, &info.context));
        info.residencyMode = modes[m];
        CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer),
                     sparse ? SLUICE_ERROR_NULL_POINTER : SLUICE_SUCCESS);
        if (sparse)
            check_line(&lines, "sparseQueue");
        sluiceDestroyVulkanStreamer(streamer);
        sluiceDestroyVulkanContext(info.context);
        assert_int_equal(fake.live_objects, 0);
    }
}

static void texture_fields_out_of_range_are_named(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    static const SluiceImageSourceInterface interface = {sizeof interface, lie, read_nothing, NULL,
                                                         NULL};
    struct liar source = {
        {&interface}, {sizeof(SluiceImageInfo), 512, 512, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}};
    struct lines lines = {0};
    SluiceVulkanStreamer *streamer;
    SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    const SluiceResult refused = SLUICE_ERROR_INVALID_ARGUMENT;
    const SluiceVulkanTextureCreateInfo good = {.structSize = sizeof good, .source = &source.base};
    SluiceVulkanTextureCreateInfo create = good;
    SluiceVulkanTexture textures[2];
    create.addressModeU = (VkSamplerAddressMode)5;
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &create, textures), refused);
    check_line(&lines, "addressModeU is 5; it must be from 0 to 4");
    create = good;
    create.addressModeV = (VkSamplerAddressMode)-1;
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &create, textures), refused);
    check_line(&lines, "addressModeV is 4294967295; it must be from 0 to 4");
    create = good;
    create.maxAnisotropy = 17;
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &create, textures), refused);
    check_line(&lines, "maxAnisotropy is 17; it must be 0 to 16");
    CHECK_RESULT(sluiceAddVulkanTextureArray(streamer, &good, 2, textures), refused);
    check_line(&lines, "layerCount is 2; the source has 1 layers");
    fake_vulkan_destroy(streamer);
}

static void contradictory_times_are_named(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    struct lines lines;
    SluiceVulkanContext *context = create_context(&fake, &lines);
    const SluiceVulkanStreamerCreateInfo good = {.structSize = sizeof good, .context = context};
    const SluiceResult refused = SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceVulkanStreamerCreateInfo info = good;
    SluiceVulkanStreamer *streamer;
    info.ticksPerSecond = UINT64_C(1000000000001);
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), refused);
    check_line(&lines, "ticksPerSecond is 1000000000001; it must be at most 10^12");
    info = good;
    info.newestFeedbackMapOnly = true;
    info.feedbackTimeoutTicks = 9;
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), refused);
    check_line(&lines, "feedbackTimeoutTicks is 9;");
    info = good;
    info.noStandbyTiles = true;
    info.numExtraStandbyTiles = 8;
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), refused);
    check_line(&lines, "numExtraStandbyTiles is 8;");
    sluiceDestroyVulkanContext(context);
}

static void without_a_context_nothing_is_created(void **state)
{
    (void)state;
    SluiceVulkanStreamer *streamer;
    SluiceDemandLoader *loader;
    const SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .maxTextureCount = 4};
    const SluiceDemandLoaderCreateInfo demand = {.structSize = sizeof demand, .maxTextureCount = 4};
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCreateDemandLoader(&demand, &loader), SLUICE_ERROR_NULL_POINTER);
    assert_null(streamer);
    assert_null(loader);
}

static void what_is_ended_without_a_begin_and_time_that_runs_back_are_named(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    struct lines lines = {0};
    SluiceVulkanStreamer *streamer;
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
    info.ticksPerSecond = 60;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    VkCommandBuffer commands = fake_vulkan_commands(&fake);
    CHECK_RESULT(sluiceEndStreamingFrame(streamer, commands), SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "no frame can be ended");
    CHECK_OK(sluiceBeginStreamingFrame(streamer, commands, 7, &frame));
    CHECK_OK(sluiceEndStreamingFrame(streamer, commands));
    CHECK_RESULT(sluiceBeginStreamingFrame(streamer, commands, 6, &frame),
                 SLUICE_ERROR_TIME_BACKWARDS);
    check_line(&lines, "timeStamp is 6; it must not be below the last frame's, 7");
    fake_vulkan_destroy(streamer);

    SluiceDemandLoader *loader;
    const SluiceDemandLoaderCreateInfo demand = {.structSize = sizeof demand,
                                                 .context = create_context(&fake, &lines)};
    CHECK_OK(sluiceCreateDemandLoader(&demand, &loader));
    CHECK_RESULT(sluiceEndDemandLaunch(loader, fake_vulkan_commands(&fake)),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "no launch can be ended");
    sluiceDestroyDemandLoader(loader);
    sluiceDestroyVulkanContext(demand.context);
}

static void what_demand_loading_refuses_is_named(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    struct lines lines = {0};
    SluiceDemandLoader *loader;
    small(&fake, &lines);
    const SluiceDemandLoaderCreateInfo demand = {.structSize = sizeof demand,
                                                 .context = create_context(&fake, &lines)};
    const SluiceDemandTextureId none[1] = {SLUICE_NO_DEMAND_TEXTURE};
    const SluiceDemandSampler sampler = {.structSize = sizeof sampler, .lodBias = 17};
    SluiceDemandGridCreateInfo cells = {
        .structSize = sizeof cells, .columnCount = 1, .rowCount = 1, .pTextureIds = none};
    SluiceDemandTextureId grid, id;
    const SluiceResult refused = SLUICE_ERROR_INVALID_ARGUMENT;
    CHECK_OK(sluiceCreateDemandLoader(&demand, &loader));
    CHECK_OK(sluiceAddDemandGrid(loader, &cells, &grid));
    cells.pTextureIds = &grid;
    CHECK_RESULT(sluiceAddDemandGrid(loader, &cells, &id), refused);
    check_line(&lines, "sluiceAddDemandGrid: texture 0x");
    cells.pTextureIds = none;
    cells.baseId = grid;
    CHECK_RESULT(sluiceAddDemandGrid(loader, &cells, &id), refused);
    check_line(&lines, "sluiceAddDemandGrid: texture 0x");
    cells.baseId = 12345;
    CHECK_RESULT(sluiceAddDemandGrid(loader, &cells, &id), SLUICE_ERROR_UNKNOWN_TEXTURE);
    cells.columnCount = 0;
    cells.rowCount = 3;
    CHECK_RESULT(sluiceAddDemandGrid(loader, &cells, &id), refused);
    check_line(&lines, "sluiceAddDemandGrid: a grid of 0 x 3 textures is empty");
    CHECK_RESULT(sluiceAddDemandTextureVariant(loader, grid, &sampler, &id), refused);
    check_line(&lines, "sluiceAddDemandTextureVariant: texture 0x");
    CHECK_RESULT(sluiceInvalidateDemandTexture(loader, grid), refused);
    check_line(&lines, "sluiceInvalidateDemandTexture: texture 0x");
    CHECK_RESULT(sluicePreloadDemandTexture(loader, grid, 0, NULL), refused);
    check_line(&lines, "sluicePreloadDemandTexture: texture 0x");
    CHECK_RESULT(sluiceRetryDemandTexture(loader, SLUICE_NO_DEMAND_TEXTURE), refused);
    check_line(&lines, "SLUICE_ALL_DEMAND_TEXTURES");
    const SluiceDemandTicket foreign = (UINT64_C(3) << 32) + 7;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    CHECK_RESULT(sluiceGetDemandTicketStatus(loader, foreign, &status), refused);
    check_line(&lines, "sluiceGetDemandTicketStatus: ticket is 12884901895;");
    CHECK_RESULT(sluiceWaitDemandTicket(loader, foreign, 0, NULL), refused);
    check_line(&lines, "sluiceWaitDemandTicket: ticket is 12884901895;");
    CHECK_RESULT(sluiceCancelDemandTicket(loader, foreign), refused);
    check_line(&lines, "sluiceCancelDemandTicket: ticket is 12884901895;");
    CHECK_OK(sluiceRetryDemandTexture(loader, SLUICE_ALL_DEMAND_TEXTURES));
    sluiceDestroyDemandLoader(loader);
    sluiceDestroyVulkanContext(demand.context);
}

/* The manager of a streamer refuses calls that the streamer makes itself. Calls that pages
 * recommend still work. */
static void the_manager_of_a_streamer_takes_no_calls_of_its_loop(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    static const SluiceImageSourceInterface interface = {sizeof interface, lie, read_nothing, NULL,
                                                         NULL};
    struct liar source = {
        {&interface}, {sizeof(SluiceImageInfo), 512, 512, 10, SLUICE_FORMAT_R8G8B8A8_UNORM, "a"}};
    struct lines lines = {0};
    SluiceVulkanStreamer *streamer;
    SluiceVulkanStreamerCreateInfo info = small(&fake, &lines);
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    SluiceStreamedTextureManager *manager = manager_of(streamer);
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = &source.base};
    SluiceVulkanTexture texture;
    SluiceStreamedTextureDesc desc = {512, 512, 10, 2, 1, 128, 128};
    SluiceTextureId id;
    uint8_t map[16] = {0};
    SluiceFeedbackDesc feedback = {
        .structSize = sizeof feedback, .pMinMip = map, .width = 4, .height = 4};
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
    CHECK_RESULT(sluiceReportCanceledTiles(manager, id, 1, &tile, 1), refused);
    CHECK_RESULT(sluiceCompleteRetireValue(manager, 1), refused);
    CHECK_RESULT(sluiceDefragmentTiles(manager, 1, &count, moves), refused);
    CHECK_RESULT(sluiceGetMinMipUpdates(manager, &count, rects), refused);
    CHECK_RESULT(sluiceRemoveStreamedTexture(manager, id, 1), refused);
    sluiceDestroyStreamedTextureManager(manager);
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .numExtraStandbyTiles = 3};
    CHECK_OK(sluiceGetStatistics(manager, &statistics));
    assert_int_equal(statistics.textureCount, 1);
    CHECK_OK(sluiceSetConfig(manager, &config));
    CHECK_OK(sluiceTrimStandbyTiles(manager, 0));
    CHECK_OK(sluiceRetryFailedTiles(manager, id));
    CHECK_OK(sluiceGetGivenUpTiles(manager, &count, tiles));
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    CHECK_OK(sluiceBeginStreamingFrame(streamer, fake_vulkan_commands(&fake), 1, &frame));
    CHECK_RESULT(sluiceRemoveStreamedTexture(manager, id, 1), refused);
    CHECK_OK(sluiceRemoveVulkanTexture(streamer, id));
    CHECK_RESULT(sluiceCompleteRetireValue(manager, 1), refused);
    fake_vulkan_destroy(streamer);
    assert_int_equal(fake.live_objects, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(infos_that_no_image_has_are_refused_in_every_mode),
        cmocka_unit_test(streamers_take_every_limit_of_the_header_and_nothing_beyond),
        cmocka_unit_test(contexts_take_every_limit_of_the_header_and_nothing_beyond),
        cmocka_unit_test(demand_loaders_take_every_limit_of_the_header_and_nothing_beyond),
        cmocka_unit_test(sparse_mode_needs_a_context_with_a_sparse_queue),
        cmocka_unit_test(texture_fields_out_of_range_are_named),
        cmocka_unit_test(contradictory_times_are_named),
        cmocka_unit_test(without_a_context_nothing_is_created),
        cmocka_unit_test(what_is_ended_without_a_begin_and_time_that_runs_back_are_named),
        cmocka_unit_test(what_demand_loading_refuses_is_named),
        cmocka_unit_test(the_manager_of_a_streamer_takes_no_calls_of_its_loop),
    };
    return RUN_TESTS(tests);
}
