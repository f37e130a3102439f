/* Refuses every allocation of every call of a streamer, once or from then on. */
#include "extremes/gallery.h"
#include "extremes/note.h"
#include "vulkan/fake_vulkan.h"

enum { FRAMES = 24, RECOVERY = 120 };

static const SluiceResidencyMode modes[] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

static struct gallery g; /* large */

/* Refuses the n-th allocation from here; with `lasting` later ones, too. */
static void refuse(uint64_t n, bool lasting)
{
    g.memory.refuse_from = g.memory.calls + n;
    g.memory.refuse_count = lasting ? 0 : 1;
}

static bool was_refused(void)
{
    return g.memory.calls > g.memory.refuse_from;
}

/* Makes a call with 0, 1, 2, ... allowed allocations until none is refused. Returns the number of
 * refusals. */
static uint64_t press(SluiceResult (*call)(struct gallery *), bool lasting)
{
    for (uint64_t n = 0;; n++) {
        uint32_t textures = g.streamer ? gallery_statistics(&g).textureCount : 0;
        uint64_t objects = g.fake.live_objects, device = g.fake.live_memory;
        refuse(n, lasting);
        SluiceResult result = call(&g);
        bool refused = was_refused();
        refuse(UINT64_MAX - g.memory.calls, false);
        if (!refused) {
            CHECK_OK(result);
            return n;
        }
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(g.fake.live_objects, objects);
        assert_int_equal(g.fake.live_memory, device);
        if (g.streamer)
            assert_int_equal(gallery_statistics(&g).textureCount, textures);
        else
            gallery_check_nothing_left(&g);
        assert_true(n < 1000);
    }
}

static SluiceResidencyMode mode;

static SluiceResult create(struct gallery *gallery)
{
    return gallery_create(gallery, mode);
}

static SluiceResult add_first(struct gallery *gallery)
{
    return gallery_add(gallery, 0);
}

static SluiceResult add_follower(struct gallery *gallery)
{
    return gallery_add(gallery, GALLERY_TEXTURES - 1);
}

static SluiceResult get_sampler(struct gallery *gallery)
{
    VkSampler sampler;
    return sluiceGetVulkanSampler(gallery->streamer, gallery->textures[0].textureId, &sampler);
}

static void creating_and_adding_survive_every_refused_allocation(void **state)
{
    (void)state;
    uint64_t refusals = 0;
    for (uint32_t i = 0; i < 6; i++) {
        mode = modes[i / 2];
        gallery_init(&g);
        uint64_t created = press(create, i % 2);
        uint64_t added = press(add_first, i % 2);
        added += press(add_follower, i % 2);
        uint64_t array = press(gallery_add_array, i % 2);
        assert_int_equal(press(get_sampler, i % 2), 1);
        assert_int_equal(press(get_sampler, i % 2), 0); /* already exists */
        assert_true(created > 20 && added > 0 && array > 0);
        refusals += created + added + array;
        for (uint32_t frame = 0; frame < FRAMES;
             frame++) /* nothing may be missing after all refusals */
            CHECK_OK(gallery_frame(&g));
        assert_true(gallery_statistics(&g).mappedTileCount >= 4 * GALLERY_TILES);
        gallery_finish(&g);
    }
    note("streamer: refused allocations of create and add", refusals, 0, 0);
}

/* Adds and removes textures between frames. Returns the first error. */
static SluiceResult live(void)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t frame = 0; frame < FRAMES && result == SLUICE_SUCCESS; frame++) {
        g.is_looked_at = frame % 12 < 9;
        result = gallery_frame(&g);
        if (result != SLUICE_SUCCESS)
            break;
        if (frame == 6)
            CHECK_OK(sluiceRemoveVulkanTexture(g.streamer, g.textures[1].textureId));
        if (frame == 11)
            result = gallery_add(&g, 1);
        uint32_t moved;
        if (frame == 13)
            result = sluiceCompactVulkanStreamer(g.streamer, 10, &moved);
    }
    return result;
}

/* A refused allocation is reported or compensated: in the end everything is resident. A poor device
 * has memory for few pages meanwhile. */
static bool survive_frames(uint64_t n, bool lasting, bool is_poor)
{
    gallery_init(&g);
    g.fake.layer_size = 65536;
    CHECK_OK(gallery_create(&g, mode));
    for (uint32_t t = 0; t < GALLERY_TEXTURES; t++)
        CHECK_OK(gallery_add(&g, t));
    g.fake.memory_limit = is_poor ? g.fake.live_memory + 10 * 65536 : 0;
    refuse(n, lasting);
    SluiceResult result = live();
    g.fake.memory_limit = 0;
    bool refused = was_refused();
    refuse(UINT64_MAX - g.memory.calls, false);
    if (result != SLUICE_SUCCESS) {
        assert_true(refused);
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    } else {
        g.is_looked_at = true;
        for (uint32_t frame = 0; frame < FRAMES + (is_poor ? RECOVERY : 0); frame++)
            CHECK_OK(gallery_frame(&g));
        assert_true(gallery_statistics(&g).mappedTileCount >= GALLERY_TEXTURES * GALLERY_TILES);
        assert_int_equal(gallery_statistics(&g).requestedTileCount, 0);
    }
    gallery_finish(&g);
    return refused;
}

static void frames_survive_every_refused_allocation(void **state)
{
    (void)state;
    uint64_t refusals = 0;
    for (uint32_t i = 0; i < 10; i++) {
        uint64_t n = 0;
        mode = modes[i / 2 % 3];
        while (survive_frames(n, i % 2, i >= 6))
            assert_true(++n < 1000);
        assert_true(n > 5);
        refusals += n;
    }
    note("streamer: refused allocations of frames", refusals, 0, 0);
}

/* Functions that the list of allocations marks as allocating nothing. */
static void questions_take_no_memory(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        gallery_init(&g);
        CHECK_OK(gallery_create(&g, modes[i]));
        CHECK_OK(gallery_add(&g, 0));
        for (uint32_t frame = 0; frame < 5; frame++)
            CHECK_OK(gallery_frame(&g));
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        CHECK_OK(
            sluiceBeginStreamingFrame(g.streamer, fake_vulkan_commands(&g.fake), ++g.time, &frame));
        uint64_t calls = g.memory.calls;
        g.memory.refuse_from = 0;
        SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
        SluiceVulkanPages pages = {.structSize = sizeof pages};
        VkDescriptorSetLayout layout;
        SluiceTileLoaderStatistics reads = {.structSize = sizeof reads};
        sluiceGetVulkanBuffers(g.streamer, &buffers);
        sluiceGetVulkanPages(g.streamer, &pages);
        CHECK_OK(sluiceGetVulkanDescriptorSetLayout(g.streamer, &layout));
        SluiceResidencyMode resolved;
        CHECK_OK(sluiceGetVulkanResidencyMode(g.streamer, &resolved));
        assert_int_equal(resolved, modes[i]);
        const SluiceVulkanDeviceCapabilities caps = {.structSize = sizeof caps, .sparse = true};
        CHECK_OK(sluiceChooseVulkanResidencyMode(&caps, modes[i], 0, &resolved));
        assert_int_equal(resolved, modes[i]);
        SluiceStreamedTextureManager *manager;
        CHECK_OK(sluiceGetVulkanStreamerManager(g.streamer, &manager));
        CHECK_OK(sluiceGetVulkanReadStatistics(g.streamer, NULL, &reads));
        CHECK_OK(sluiceRetryVulkanSource(g.streamer, NULL));
        assert_true(gallery_statistics(&g).textureCount == 1);
        CHECK_OK(sluiceAbandonStreamingFrame(g.streamer, &frame));
        CHECK_OK(sluiceWaitVulkanStreamerIdle(g.streamer));
        CHECK_OK(sluiceRemoveVulkanTexture(g.streamer, g.textures[0].textureId));
        assert_int_equal(g.memory.calls, calls);
        gallery_finish(&g);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(creating_and_adding_survive_every_refused_allocation),
        cmocka_unit_test(frames_survive_every_refused_allocation),
        cmocka_unit_test(questions_take_no_memory),
    };
    return RUN_TESTS(tests);
}
