/* Tiles that wait for a page until another user of the pool shares them. */
#include "vulkan/fake_vulkan.h"

#include "vulkan/page_sharing.h"
#include "vulkan/streamer.h"

#include "support/gray_source.h"
#include "support/test.h"

#include <sluice/shared/texture_table.h>

#define SIDE 16u /* tiles */

enum { SIZE = 2048, PAGES = 1024, LOADS = 16 };

struct stage {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *source;
    uint64_t time;
    uint32_t other; ///< user of the pool
    uint32_t pages[PAGES];
    uint32_t page_count;
};

static uint8_t want(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

static struct slc_page_pool *pool_of(struct stage *s)
{
    return s->streamer->pages;
}

/* Takes all pages of the pool. */
static void take_all(struct stage *s)
{
    struct slc_page_pool *pool = pool_of(s);
    CHECK_OK(slc_page_pool_add_user(pool, (VkSemaphore)(uintptr_t)999, 0, NULL, &s->other));
    pool->chunks.max_size = (uint64_t)PAGES / 2 * 65536;
    for (s->page_count = 0; s->page_count < PAGES; s->page_count++) {
        uint32_t page = slc_page_pool_take(pool, s->other, SLUICE_FORMAT_R8G8B8A8_UNORM);
        if (page == SLUICE_PAGE_NONE)
            break;
        s->pages[s->page_count] = page;
    }
    pool->chunks.refused_tick = 0; /* heaps can still be allocated */
    assert_in_range(s->page_count, SIDE * SIDE + 1, PAGES - 1);
}

static void init(struct stage *s)
{
    *s = (struct stage){.fake = {.want = want, .user = s, .layer_size = 65536}};
    s->source = gray_source(SIZE, SIZE);
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                           .maxTextureCount = 1,
                                           .maxRegionCount = 1024,
                                           .maxLoadsInFlight = LOADS,
                                           .feedbackTimeoutTicks = 1000};
    fake_vulkan_fill(&info);
    CHECK_OK(fake_vulkan_create(&s->fake, &info, &s->streamer));
    const SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = s->source};
    SluiceVulkanTexture texture;
    CHECK_OK(sluiceAddVulkanTexture(s->streamer, &create, &texture));
    take_all(s);
}

static void finish(struct stage *s)
{
    slc_page_pool_remove_user(pool_of(s), s->other);
    fake_vulkan_destroy(s->streamer);
    sluiceDestroyImageSource(s->source);
    assert_int_equal(s->fake.live_objects, 0);
}

static void frame(struct stage *s)
{
    struct fake_vulkan *fake = &s->fake;
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    fake->published = false;
    fake->copy_count = 0;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
    CHECK_OK(sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(fake), ++s->time, &frame));
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(fake)));
    fake->frame_semaphore = frame.semaphore;
    fake->frame_value = frame.signalValue;
}

static uint64_t shared_count(const struct stage *s)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s->streamer, &stats));
    return stats.tilesShared;
}

static void copy_tile(struct stage *s, const struct slc_tile_key *key, uint32_t page)
{
    slc_page_share_announce(pool_of(s), s->other, key);
    slc_page_share_place(pool_of(s), s->other, key, page);
    slc_page_share_written(pool_of(s), s->other, page, 1);
}

/* The other user has copied all tiles, and may give a page back. Returns how many tiles there are.
 */
static uint32_t copy_all(struct stage *s, bool gives)
{
    struct slc_page_pool *pool = pool_of(s);
    VkCommandBuffer commands = fake_vulkan_commands(&s->fake);
    uint32_t count = 0;
    slc_page_pool_record(pool, s->other, 1, 0, commands);
    for (uint32_t level = 0; SIDE >> level > 0; level++)
        for (uint32_t y = 0; y < SIDE >> level; y++)
            for (uint32_t x = 0; x < SIDE >> level; x++) {
                const struct slc_tile_key key = {s->source, 0, level, x * 128, y * 128};
                copy_tile(s, &key, s->pages[count++]);
            }
    slc_page_pool_record(pool, s->other, 2, 1, commands);
    if (gives)
        slc_page_pool_give(pool, s->other, s->pages[count], SLC_NO_OWNER);
    slc_page_pool_record(pool, s->other, 3, 2, commands);
    return count;
}

/* Shares need neither a page nor a staging slot, so that only the limit of shares bounds a frame's
 * changes. */
static void share_all(bool gives)
{
    static struct stage s; /* large */
    init(&s);
    for (int i = 0; i < 60; i++)
        frame(&s);
    assert_int_equal(shared_count(&s), 0);
    assert_true(s.streamer->deferred.count > 4 * LOADS);
    uint32_t count = copy_all(&s, gives);
    uint64_t before = 0;
    for (int i = 0; i < 100 && before + 1 < count; i++) {
        frame(&s);
        assert_in_range(shared_count(&s) - before, 1, 2 * LOADS);
        before = shared_count(&s);
    }
    assert_in_range(before, count - 1, count); /* the last level may be packed */
    finish(&s);
}

static void deferred_tiles_that_are_shared_are_bounded_per_frame(void **state)
{
    (void)state;
    share_all(true);
}

static void deferred_tiles_share_pages_while_none_is_free(void **state)
{
    (void)state;
    share_all(false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(deferred_tiles_that_are_shared_are_bounded_per_frame),
        cmocka_unit_test(deferred_tiles_share_pages_while_none_is_free),
    };
    return RUN_TESTS(tests);
}
