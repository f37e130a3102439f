/* Texels that have changed, or whose source has gone, as other members of a read pool see them. One
 * front end is told at a time; a tile loader beside it reads. */
#include "vulkan/fake_vulkan.h"

#include "support/test.h"

#include <sluice/demand.h>
#include <sluice/demand_strict.h>
#include <sluice/vulkan_control.h>
#include <sluice/vulkan_strict.h>

#include <string.h>

enum { SIZE = 1024 };

/* Every texel is the version. */
struct source {
    SluiceImageSource base; ///< must be first
    uint32_t version;       ///< changes while nobody reads
    uint32_t closed;
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
    const struct source *source = (const struct source *)base;
    for (uint32_t y = 0; y < region->height; y++)
        for (uint32_t x = 0; x < region->width; x++)
            memcpy((char *)texels + y * row_pitch + 4 * x, &source->version, 4);
    return SLUICE_SUCCESS;
}

/* Destroys a source but keeps its memory, so that another source may get the same address. */
static void destroy(SluiceImageSource *base)
{
    ((struct source *)base)->closed++;
}

static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                     .pfnGetInfo = get_info,
                                                     .pfnReadRegion = read_region,
                                                     .pfnDestroy = destroy};

static struct {
    struct fake_vulkan fake; /* large */
    SluiceReadPool *pool;
    SluiceTileLoader *reader; ///< the other member
    struct source source, other;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture streamed;
    SluiceVulkanContext *context;
    SluiceDemandLoader *demand;
    SluiceDemandTextureId texture;
} rig;

static void begin(void)
{
    memset(&rig, 0, sizeof rig);
    rig.source = (struct source){.base = {&interface}, .version = 1};
    rig.other = rig.source;
    const SluiceReadPoolCreateInfo pool = {.structSize = sizeof pool, .threadCount = 2};
    CHECK_OK(sluiceCreateReadPool(&pool, &rig.pool));
    const SluiceTileLoaderCreateInfo loader = {.structSize = sizeof loader, .readPool = rig.pool};
    CHECK_OK(sluiceCreateTileLoader(&loader, &rig.reader));
    rig.fake = (struct fake_vulkan){
        .tail_page_count = 1, .no_resolve = true, .waits_time_out = true, .readPool = rig.pool};
}

static void begin_streamer(void)
{
    begin();
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 1 << 8};
    fake_vulkan_fill(&info);
    rig.fake.no_resolve = false;
    CHECK_OK(fake_vulkan_create(&rig.fake, &info, &rig.streamer));
    const SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                  .source = &rig.source.base};
    CHECK_OK(sluiceAddVulkanTexture(rig.streamer, &create, &rig.streamed));
}

static void begin_demand(const SluiceDemandImage *image)
{
    begin();
    const SluiceVulkanContextCreateInfo context = fake_vulkan_context_info(&rig.fake);
    CHECK_OK(sluiceCreateVulkanContext(&context, &rig.context));
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .context = rig.context,
                                               .maxTextureCount = 4,
                                               .pageCapacity = 1 << 16,
                                               .maxRequestsPerLaunch = 100};
    CHECK_OK(sluiceCreateDemandLoader(&info, &rig.demand));
    const SluiceDemandTextureCreateInfo create = {.structSize = sizeof create, .image = *image};
    CHECK_OK(sluiceAddDemandTexture(rig.demand, &create, &rig.texture));
}

static void finish(void)
{
    rig.fake.frame_value = UINT32_MAX;
    fake_vulkan_destroy(rig.streamer);
    sluiceDestroyDemandLoader(rig.demand);
    sluiceDestroyVulkanContext(rig.context);
    sluiceDestroyTileLoader(rig.reader);
    sluiceDestroyReadPool(rig.pool);
    assert_int_equal(rig.fake.live_objects, 0);
}

/* The version of a texel that no front end reads, as the other member gets it. */
static uint32_t read_version(struct source *source)
{
    uint32_t version = 0, count = 1;
    void *texels = &version;
    uint64_t ticket;
    SluiceTileReadResult result;
    const SluiceImageRegion region = {.x = 3, .y = 3, .width = 1, .height = 1};
    const SluiceTileRead read = {
        .source = &source->base, .regionCount = 1, .pRegions = &region, .ppTexels = &texels};
    CHECK_OK(sluiceSubmitTileRead(rig.reader, &read, &ticket));
    CHECK_OK(sluiceWaitTileLoaderIdle(rig.reader));
    CHECK_OK(sluiceCollectTileReads(rig.reader, &count, &result));
    assert_int_equal(count, 1);
    CHECK_OK(result.result);
    return version;
}

/* The pool keeps texels of the source, which change now. */
static void keep_and_change(struct source *source)
{
    assert_int_equal(read_version(source), 1);
    source->version = 2;
    assert_int_equal(read_version(source), 1);
}

/* Streamers ---------------------------------------------------------------------------------- */

static void a_streamer_that_invalidates_drops_texels(void **state)
{
    (void)state;
    begin_streamer();
    keep_and_change(&rig.source);
    CHECK_OK(sluiceInvalidateVulkanTexture(rig.streamer, rig.streamed.textureId, NULL, UINT32_MAX));
    assert_int_equal(read_version(&rig.source), 2);
    finish();
}

static void a_streamer_that_removes_a_texture_drops_texels(void **state)
{
    (void)state;
    begin_streamer();
    keep_and_change(&rig.source);
    CHECK_OK(sluiceRemoveVulkanTexture(rig.streamer, rig.streamed.textureId));
    assert_int_equal(read_version(&rig.source), 2);
    finish();
}

static void a_streamer_that_replaces_a_source_drops_texels_of_both(void **state)
{
    (void)state;
    begin_streamer();
    keep_and_change(&rig.source);
    keep_and_change(&rig.other);
    CHECK_OK(sluiceReplaceVulkanSource(rig.streamer, rig.streamed.textureId, &rig.other.base));
    assert_int_equal(read_version(&rig.source), 2);
    assert_int_equal(read_version(&rig.other), 2);
    finish();
}

static void a_streamer_that_releases_a_source_drops_texels(void **state)
{
    (void)state;
    begin_streamer();
    keep_and_change(&rig.other);
    CHECK_OK(sluiceReleaseVulkanSource(rig.streamer, &rig.other.base));
    assert_int_equal(rig.other.closed, 1);
    assert_int_equal(read_version(&rig.other), 2); /* a new one at the address */
    finish();
}

/* Demand loaders ----------------------------------------------------------------------------- */

static SluiceResult open_source(void *user, SluiceImageSource **source)
{
    (void)user;
    *source = &rig.source.base;
    return SLUICE_SUCCESS;
}

static void close_source(void *user, SluiceImageSource *source)
{
    (void)user;
    destroy(source);
}

static const SluiceDemandImage by_source = {.source = &rig.source.base},
                               by_callback = {.pfnOpen = open_source, .pfnClose = close_source};

static void launch(void)
{
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    CHECK_OK(sluiceBeginDemandLaunch(rig.demand, fake_vulkan_commands(&rig.fake), &launch));
    rig.fake.frame_semaphore = launch.semaphore;
    CHECK_OK(sluiceEndDemandLaunch(rig.demand, fake_vulkan_commands(&rig.fake)));
    rig.fake.frame_value = launch.signalValue;
    CHECK_OK(sluiceProcessDemandRequests(rig.demand, &launch, 0, &requests, NULL));
}

/* Opens the texture and waits for its reads. */
static void open_texture(void)
{
    SluiceDemandTicket ticket;
    SluiceDemandStatistics now = {.structSize = sizeof now};
    CHECK_OK(sluicePreloadDemandTexture(rig.demand, rig.texture, 10, &ticket));
    while (now.texturesOpened == 0) {
        CHECK_OK(sluiceWaitDemandTicket(rig.demand, ticket, UINT64_MAX, NULL));
        launch();
        CHECK_OK(sluiceGetDemandStatistics(rig.demand, &now));
    }
    CHECK_OK(sluiceWaitDemandTicket(rig.demand, ticket, UINT64_MAX, NULL));
    launch();
}

static void a_demand_loader_that_invalidates_drops_texels(void **state)
{
    (void)state;
    for (int opened = 0; opened < 2; opened++) {
        begin_demand(opened ? &by_callback : &by_source);
        if (opened)
            open_texture();
        keep_and_change(&rig.source);
        CHECK_OK(sluiceInvalidateDemandTexture(rig.demand, rig.texture));
        assert_int_equal(read_version(&rig.source), 2);
        finish();
    }
}

static void a_demand_loader_that_closes_an_image_drops_texels(void **state)
{
    (void)state;
    begin_demand(&by_callback);
    open_texture();
    keep_and_change(&rig.source);
    CHECK_OK(sluiceRemoveDemandTexture(rig.demand, rig.texture));
    for (uint32_t i = 0; i < 4; i++)
        launch();
    assert_int_equal(rig.source.closed, 1);
    assert_int_equal(read_version(&rig.source), 2); /* a new one at the address */
    finish();
}

/* Reads of it have ended, and are not collected yet: the application may destroy the source. */
static void a_demand_loader_that_removes_a_texture_drops_texels_at_once(void **state)
{
    (void)state;
    for (int reads = 0; reads < 2; reads++) {
        SluiceDemandTicket ticket;
        begin_demand(&by_source);
        open_texture();
        if (reads) {
            CHECK_OK(sluicePreloadDemandTexture(rig.demand, rig.texture, 0, &ticket));
            CHECK_OK(sluiceWaitDemandTicket(rig.demand, ticket, UINT64_MAX, NULL));
        }
        keep_and_change(&rig.source);
        CHECK_OK(sluiceRemoveDemandTexture(rig.demand, rig.texture));
        assert_int_equal(read_version(&rig.source), 2);
        finish();
    }
}

static void a_demand_loader_that_replaces_an_image_drops_texels_of_both(void **state)
{
    (void)state;
    begin_demand(&by_source);
    open_texture();
    keep_and_change(&rig.source);
    keep_and_change(&rig.other);
    const SluiceDemandImage image = {.source = &rig.other.base};
    CHECK_OK(sluiceReplaceDemandImage(rig.demand, rig.texture, &image));
    assert_int_equal(read_version(&rig.source), 2);
    assert_int_equal(read_version(&rig.other), 2);
    finish();
}

static void a_demand_loader_that_releases_a_source_drops_texels(void **state)
{
    (void)state;
    begin_demand(&by_source);
    keep_and_change(&rig.other);
    CHECK_OK(sluiceReleaseDemandSource(rig.demand, &rig.other.base));
    assert_int_equal(rig.other.closed, 1);
    assert_int_equal(read_version(&rig.other), 2);
    finish();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_streamer_that_invalidates_drops_texels),
        cmocka_unit_test(a_streamer_that_removes_a_texture_drops_texels),
        cmocka_unit_test(a_streamer_that_replaces_a_source_drops_texels_of_both),
        cmocka_unit_test(a_streamer_that_releases_a_source_drops_texels),
        cmocka_unit_test(a_demand_loader_that_invalidates_drops_texels),
        cmocka_unit_test(a_demand_loader_that_closes_an_image_drops_texels),
        cmocka_unit_test(a_demand_loader_that_removes_a_texture_drops_texels_at_once),
        cmocka_unit_test(a_demand_loader_that_replaces_an_image_drops_texels_of_both),
        cmocka_unit_test(a_demand_loader_that_releases_a_source_drops_texels),
    };
    return RUN_TESTS(tests);
}
