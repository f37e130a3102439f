/* A device that runs out of memory, and one that is lost, while a streamer uses it. */
#include "extremes/gallery.h"
#include "extremes/note.h"
#include "support/streamer_manager.h"

#include <sluice/manager.h>

enum { HEAP = 8 * 65536, FRAMES = 60, RECOVERY = 150 };

static const SluiceResidencyMode modes[] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

static struct gallery g; /* large */

static void open_gallery(SluiceResidencyMode mode)
{
    gallery_init(&g);
    g.fake.layer_size = 65536;
    CHECK_OK(gallery_create(&g, mode));
    for (uint32_t t = 0; t < GALLERY_TEXTURES; t++)
        CHECK_OK(gallery_add(&g, t));
}

/* Returns the coarsest level that any region of the textures shows; 255: some region shows
 * nothing. */
static uint8_t coarsest(void)
{
    uint8_t worst = 0;
    for (uint32_t t = 0; t < GALLERY_TEXTURES; t++) {
        uint8_t map[16];
        CHECK_OK(sluiceWriteMinMipData(manager_of(g.streamer), g.textures[t].textureId, 4,
                                       sizeof map, map));
        for (uint32_t i = 0; i < 16; i++)
            worst = map[i] > worst ? map[i] : worst;
    }
    return worst;
}

static SluiceResult run_frames(uint32_t count)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++)
        result = gallery_frame(&g);
    return result;
}

/* Runs with memory for `heaps` heaps, later for all. Returns the frames until everything is
 * sharp. */
static uint32_t starve(SluiceResidencyMode mode, uint32_t heaps, bool *is_coarse)
{
    open_gallery(mode);
    CHECK_OK(gallery_frame(&g));
    g.fake.memory_limit = g.fake.live_memory + heaps * (uint64_t)HEAP;
    uint64_t limit = g.fake.memory_limit;
    CHECK_OK(run_frames(FRAMES));
    assert_true(g.fake.live_memory <= limit);
    SluiceVulkanStreamerStatistics s = gallery_statistics(&g);
    assert_int_equal(s.failedTileCount + s.givenUpTileCount + s.tilesFailed, 0);
    *is_coarse = s.mappedTileCount < GALLERY_TEXTURES * GALLERY_TILES;
    if (heaps > 1) /* every texture shows something */
        assert_true(coarsest() <= 3);
    assert_true(!*is_coarse || coarsest() > 0);
    g.fake.memory_limit = 0;
    uint32_t frames = 0;
    while (coarsest() > 0 && ++frames < RECOVERY)
        CHECK_OK(gallery_frame(&g));
    assert_true(gallery_statistics(&g).mappedTileCount >= GALLERY_TEXTURES * GALLERY_TILES);
    gallery_finish(&g);
    return frames;
}

static void memory_that_ends_is_a_coarser_picture_until_there_is_more(void **state)
{
    (void)state;
    uint32_t coarse = 0, cases = 0, slowest = 0;
    for (uint32_t m = 0; m < 2; m++) /* dense images have their memory, or are not created */
        for (uint32_t heaps = 0; heaps < 12; heaps++, cases++) {
            bool is_coarse;
            uint32_t frames = starve(modes[m], heaps, &is_coarse);
            slowest = frames > slowest ? frames : slowest;
            coarse += is_coarse;
        }
    note("device memory that ends: frames until all is sharp again", cases, slowest, RECOVERY - 1);
    assert_true(slowest < RECOVERY);
    assert_true(coarse >= 8);
}

/* Tiles that wait for memory stop waiting when they are unwanted, or their texture is removed. */
static void what_waits_for_memory_ends_with_the_wish_for_it(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 4; i++) {
        open_gallery(modes[i / 2]);
        g.fake.memory_limit = g.fake.live_memory + HEAP;
        CHECK_OK(run_frames(10));
        SluiceVulkanStreamerStatistics s = gallery_statistics(&g);
        assert_true(s.requestedTileCount + s.allocatedTileCount > 0);
        if (i % 2) {
            g.is_looked_at = false;
            CHECK_OK(run_frames(40));
        } else {
            for (uint32_t t = GALLERY_TEXTURES; t-- > 0;)
                CHECK_OK(sluiceRemoveVulkanTexture(g.streamer, g.textures[t].textureId));
            CHECK_OK(run_frames(10));
        }
        s = gallery_statistics(&g);
        assert_int_equal(
            s.requestedTileCount + s.allocatedTileCount + s.canceledTileCount + s.loadsInFlight, 0);
        g.fake.memory_limit = 0;
        g.is_looked_at = true;
        for (uint32_t t = 0; t < GALLERY_TEXTURES && i % 2 == 0; t++)
            CHECK_OK(gallery_add(&g, t));
        CHECK_OK(run_frames(RECOVERY));
        assert_int_equal(coarsest(), 0);
        gallery_finish(&g);
    }
}

static void a_texture_without_memory_can_be_added_when_there_is_some(void **state)
{
    (void)state;
    for (uint32_t m = 0; m < 3; m++) {
        gallery_init(&g);
        CHECK_OK(gallery_create(&g, modes[m]));
        CHECK_OK(gallery_add(&g, 0));
        uint64_t objects = g.fake.live_objects;
        g.fake.memory_limit = g.fake.live_memory;
        for (uint32_t i = 0; i < 5; i++) {
            SluiceResult result = gallery_add(&g, 1);
            if (result == SLUICE_SUCCESS) { /* sparse: memory is allocated later */
                assert_int_equal(m, 0);
                break;
            }
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
            assert_int_equal(g.fake.live_objects, objects);
            assert_int_equal(g.fake.live_memory, g.fake.memory_limit);
        }
        g.fake.memory_limit = 0;
        if (m > 0)
            CHECK_OK(gallery_add(&g, 1));
        CHECK_OK(gallery_add(&g, 2));
        CHECK_OK(run_frames(FRAMES));
        assert_int_equal(coarsest(), 0);
        gallery_finish(&g);
    }
}

/* Makes every call of a streamer's life. Returns the first error. */
static SluiceResult live(SluiceResidencyMode mode)
{
    SluiceResult result = gallery_create(&g, mode);
    for (uint32_t t = 0; t < GALLERY_TEXTURES && result == SLUICE_SUCCESS; t++)
        result = gallery_add(&g, t);
    for (uint32_t frame = 0; frame < 12 && result == SLUICE_SUCCESS; frame++) {
        g.is_looked_at = frame < 9;
        result = gallery_frame(&g);
        if (frame == 6 && result == SLUICE_SUCCESS)
            CHECK_OK(sluiceRemoveVulkanTexture(g.streamer, g.textures[1].textureId));
        if (frame == 8 && result == SLUICE_SUCCESS)
            result = gallery_add(&g, 1);
    }
    return result;
}

/* Shuts down like a program, after any error. */
static void shut_down(void)
{
    if (!g.streamer)
        return;
    SluiceTileLoaderStatistics reads = {.structSize = sizeof reads};
    CHECK_OK(sluiceGetVulkanReadStatistics(g.streamer, NULL, &reads));
    (void)gallery_statistics(&g);
    for (uint32_t i = 0; i < 2; i++) {
        SluiceResult result = sluiceWaitVulkanStreamerIdle(g.streamer);
        assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_DEVICE_LOST);
    }
}

static void a_device_that_is_lost_is_told_and_everything_can_be_destroyed(void **state)
{
    (void)state;
    uint64_t cases = 0, untold = 0;
    for (uint32_t m = 0; m < 3; m++)
        for (uint64_t n = 1;; n++) {
            gallery_init(&g);
            g.fake.failing_call = n;
            g.fake.fails_on = true;
            g.fake.failure = VK_ERROR_DEVICE_LOST;
            SluiceResult result = live(modes[m]);
            bool failed = g.fake.calls >= n;
            untold += failed && result == SLUICE_SUCCESS;
            if (result != SLUICE_SUCCESS)
                CHECK_RESULT(result, SLUICE_ERROR_DEVICE_LOST);
            shut_down();
            gallery_finish(&g);
            if (!failed)
                break;
            cases++;
        }
    note("device lost: calls at which nobody was told", cases, (double)untold, 0);
    assert_int_equal(untold, 0);
    assert_true(cases > 150);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_that_ends_is_a_coarser_picture_until_there_is_more),
        cmocka_unit_test(what_waits_for_memory_ends_with_the_wish_for_it),
        cmocka_unit_test(a_texture_without_memory_can_be_added_when_there_is_some),
        cmocka_unit_test(a_device_that_is_lost_is_told_and_everything_can_be_destroyed),
    };
    return RUN_TESTS(tests);
}
