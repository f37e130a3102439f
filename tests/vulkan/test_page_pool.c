/* Pages shared by users with separate timelines. */
#include "vulkan/page_pool.h"

#include "vulkan/context.h"
#include "vulkan/fake_vulkan.h"
#include "vulkan/page_leaving.h"
#include "vulkan/page_sharing.h"

#include <sluice/shared/texture_table.h>

#include "support/test.h"

#include <pthread.h>
#include <stdatomic.h>

#define FORMAT SLUICE_FORMAT_R8G8B8A8_UNORM

enum { USERS = 2, CHUNKS = 3, LAYERS = 64, NONE = SLC_MAX_PAGE_USERS };

static atomic_uint_fast64_t timelines[USERS]; ///< values of the semaphores 1, 2, ...
static uint32_t layout_count; ///< images transitioned to their layout since it was reset
static const VkCommandBuffer commands = (VkCommandBuffer)(uintptr_t)64;

static VkResult VKAPI_CALL get_value(VkDevice device, VkSemaphore semaphore, uint64_t *value)
{
    (void)device;
    *value = timelines[(uintptr_t)semaphore - 1];
    return VK_SUCCESS;
}

static void VKAPI_CALL barrier(VkCommandBuffer buffer, VkPipelineStageFlags before,
                               VkPipelineStageFlags after, VkDependencyFlags flags,
                               uint32_t memory_count, const VkMemoryBarrier *memory,
                               uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                               uint32_t image_count, const VkImageMemoryBarrier *images)
{
    (void)buffer, (void)before, (void)after, (void)flags, (void)memory_count, (void)memory;
    (void)buffer_count, (void)buffers, (void)images;
    layout_count += image_count;
}

static struct fake_vulkan fake; /* large */

struct rig {
    SluiceVulkanContext *context;
    struct slc_page_pool pool;
    uint32_t users[USERS];
};

static void init(struct rig *r, uint64_t max_size)
{
    *r = (struct rig){0};
    fake = (struct fake_vulkan){.tail_page_count = 1, .layer_size = 65536};
    const SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(&fake);
    CHECK_OK(sluiceCreateVulkanContext(&info, &r->context));
    CHECK_OK(
        slc_page_pool_init(&r->pool, &r->context->vk, &r->context->caps, &r->context->cb, CHUNKS));
    r->pool.vk.GetSemaphoreCounterValue = get_value;
    r->pool.vk.CmdPipelineBarrier = barrier;
    for (uintptr_t i = 0; i < USERS; i++) {
        timelines[i] = 0;
        CHECK_OK(
            slc_page_pool_add_user(&r->pool, (VkSemaphore)(i + 1), max_size, NULL, &r->users[i]));
    }
}

static void finish(struct rig *r)
{
    for (uint32_t i = 0; i < USERS; i++)
        if (r->users[i] != NONE)
            slc_page_pool_remove_user(&r->pool, r->users[i]);
    slc_page_pool_finish(&r->pool);
    sluiceDestroyVulkanContext(r->context);
    assert_int_equal(fake.live_objects, 0);
}

static struct slc_tile_key key_of(uint32_t level)
{
    static int source;
    return (struct slc_tile_key){(const SluiceImageSource *)(const void *)&source, 0, level, 2, 3};
}

static uint32_t record(struct rig *r, uint32_t user, uint64_t frame)
{
    layout_count = 0;
    slc_page_pool_record(&r->pool, r->users[user], frame, timelines[user], commands);
    return layout_count;
}

/* Takes all pages of the first chunk for a user, with the chunk in its layout. */
static void take_all(struct rig *r, uint32_t user, uint32_t pages[LAYERS])
{
    for (uint32_t i = 0; i < LAYERS; i++) {
        pages[i] = slc_page_pool_take(&r->pool, r->users[user], FORMAT);
        assert_int_equal(pages[i] >> 16, 0);
    }
    assert_int_equal(record(r, user, 1), 1);
    timelines[user] = 1;
}

static void a_page_of_another_user_waits_for_its_frames(void **state)
{
    (void)state;
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, LAYERS * 65536);
    take_all(&r, 0, pages);
    record(&r, 0, 2);
    record(&r, 1, 1);
    r.pool.chunks.max_size = LAYERS * 65536;
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT), SLUICE_PAGE_NONE);
    slc_page_pool_give(&r.pool, r.users[0], pages[5], SLC_NO_OWNER); /* frame 2 may read it */
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT), SLUICE_PAGE_NONE);
    assert_int_equal(slc_page_pool_free_count(&r.pool, r.users[1], FORMAT), 0);
    assert_int_equal(slc_page_pool_free_count(&r.pool, r.users[0], FORMAT), 1);
    timelines[0] = 2;
    record(&r, 1, 2);
    assert_int_equal(slc_page_pool_free_count(&r.pool, r.users[1], FORMAT), 1);
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT), pages[5]);
    finish(&r);
}

static void a_user_takes_its_own_page_at_once(void **state)
{
    (void)state;
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, 0);
    take_all(&r, 0, pages);
    record(&r, 0, 2);
    slc_page_pool_give(&r.pool, r.users[0], pages[9], 77);
    assert_false(slc_page_pool_retake(&r.pool, r.users[1], pages[9], 77));
    assert_true(slc_page_pool_retake(&r.pool, r.users[0], pages[9], 77));
    slc_page_pool_give(&r.pool, r.users[0], pages[9], 77);
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[0], FORMAT), pages[9]);
    finish(&r);
}

static void a_new_image_belongs_to_its_maker_until_it_is_in_its_layout(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 0);
    uint32_t first = slc_page_pool_take(&r.pool, r.users[0], FORMAT);
    uint32_t other = slc_page_pool_take(&r.pool, r.users[1], FORMAT);
    assert_int_not_equal(first >> 16, other >> 16);
    assert_int_equal(record(&r, 0, 1), 1); /* each user its own */
    assert_int_equal(record(&r, 1, 1), 1);
    slc_page_pool_abandon(&r.pool, r.users[0], 1);
    timelines[0] = 2; /* a later frame; the abandoned one was never submitted */
    slc_page_pool_give(&r.pool, r.users[1], other, SLC_NO_OWNER);
    record(&r, 1, 2);
    for (uint32_t i = 0; i < LAYERS; i++)
        assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT) >> 16, other >> 16);
    assert_int_equal(record(&r, 0, 3), 1);
    const struct slc_page_views *views[USERS] = {slc_page_pool_views(&r.pool, r.users[0]),
                                                 slc_page_pool_views(&r.pool, r.users[1])};
    assert_ptr_not_equal(views[0]->views[first >> 16], r.pool.views.empty);
    assert_ptr_equal(views[1]->views[first >> 16], r.pool.views.empty);
    timelines[0] = 3;
    assert_int_equal(record(&r, 1, 3), 0);
    assert_ptr_equal(views[1]->views[first >> 16], views[0]->views[first >> 16]);
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT) >> 16, first >> 16);
    finish(&r);
}

static void an_empty_image_goes_when_no_user_can_see_it(void **state)
{
    (void)state;
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, 0);
    take_all(&r, 0, pages);
    record(&r, 1, 1); /* frame 1 of the other user sees the image */
    for (uint32_t i = 0; i < LAYERS; i++)
        slc_page_pool_give(&r.pool, r.users[0], pages[i], SLC_NO_OWNER);
    uint64_t frame = 2;
    for (; frame < 200; frame++) {
        timelines[0] = frame - 1;
        record(&r, 0, frame);
    }
    assert_int_equal(slc_page_pool_get_counts(&r.pool).chunk_count, 1);
    const struct slc_page_views *other = slc_page_pool_views(&r.pool, r.users[1]);
    assert_ptr_equal(slc_page_pool_views(&r.pool, r.users[0])->views[0], r.pool.views.empty);
    assert_ptr_not_equal(other->views[0],
                         r.pool.views.empty); /* another thread may be reading it */
    timelines[1] = 1;
    record(&r, 0, frame);
    assert_int_equal(slc_page_pool_get_counts(&r.pool).chunk_count, 0);
    SluiceVulkanPages pages_of_other = {.structSize = sizeof pages_of_other};
    CHECK_OK(slc_page_pool_write_views(&r.pool, r.users[1], &pages_of_other));
    assert_ptr_equal(pages_of_other.pViews[0], r.pool.views.empty);
    finish(&r);
}

static void a_retired_image_leaves_the_views_with_the_next_frame(void **state)
{
    (void)state;
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, 0);
    take_all(&r, 0, pages);
    record(&r, 1, 1);
    for (uint32_t i = 0; i < LAYERS; i++)
        slc_page_pool_give(&r.pool, r.users[0], pages[i], SLC_NO_OWNER);
    for (uint64_t frame = 2; frame < 100; frame++) {
        timelines[0] = frame - 1;
        record(&r, 0, frame);
    }
    const struct slc_page_views *other = slc_page_pool_views(&r.pool, r.users[1]);
    uint64_t generation = other->generation;
    record(&r, 1, 2); /* frame 1 is not complete, so the image still exists */
    assert_int_equal(slc_page_pool_get_counts(&r.pool).chunk_count, 1);
    assert_ptr_equal(other->views[0], r.pool.views.empty);
    assert_true(other->generation > generation);
    finish(&r);
}

static void a_user_that_goes_gives_its_pages_back(void **state)
{
    (void)state;
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, 0);
    take_all(&r, 0, pages);
    record(&r, 1, 1);
    slc_page_pool_remove_user(&r.pool, r.users[0]);
    r.users[0] = NONE;
    for (uint32_t i = 0; i < LAYERS; i++)
        assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT) >> 16, 0);
    finish(&r);
}

/* A user's capacity is its own limit, not the rest of the pool's. */
static void pages_that_others_hold_are_no_capacity(void **state)
{
    (void)state;
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, LAYERS * 65536); /* two users: as much again */
    take_all(&r, 0, pages);
    uint64_t all = slc_page_pool_capacity(&r.pool, r.users[0]);
    assert_int_equal(all, 2 * LAYERS);
    assert_int_equal(slc_page_pool_capacity(&r.pool, r.users[1]), all - LAYERS);
    assert_int_equal(slc_page_pool_present(&r.pool, r.users[1]), 0);
    assert_int_equal(slc_page_pool_present(&r.pool, r.users[0]), LAYERS);
    finish(&r);
}

/* Each user has a chunk within its limit. One limit falls to a quarter. */
static void memory_beyond_the_limits_is_for_the_user_beyond_its_own_to_free(void **state)
{
    (void)state;
    enum { BEYOND = LAYERS / 4 * 3 * 65536 };
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, LAYERS * 65536);
    take_all(&r, 0, pages);
    for (uint32_t i = 0; i < LAYERS; i++)
        assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT) >> 16, 1);
    record(&r, 1, 1);
    for (uint32_t i = 0; i < USERS; i++)
        assert_int_equal(slc_page_pool_excess(&r.pool, r.users[i]), 0);
    slc_page_pool_set_max_size(&r.pool, r.users[0], LAYERS / 4 * 65536);
    assert_int_equal(slc_page_pool_excess(&r.pool, r.users[0]), BEYOND);
    assert_int_equal(slc_page_pool_excess(&r.pool, r.users[1]), 0);
    for (uint32_t i = 1; i < LAYERS; i++) /* all but one: its chunk does not get smaller */
        slc_page_pool_give(&r.pool, r.users[0], pages[i], SLC_NO_OWNER);
    assert_int_equal(slc_page_pool_excess(&r.pool, r.users[0]), BEYOND);
    assert_int_equal(slc_page_pool_excess(&r.pool, r.users[1]), 0);
    slc_page_pool_give(&r.pool, r.users[0], pages[0], SLC_NO_OWNER);
    for (uint32_t i = 0; i < USERS; i++) /* no user exceeds its limit */
        assert_int_equal(slc_page_pool_excess(&r.pool, r.users[i]), BEYOND);
    finish(&r);
}

/* Frames that are never submitted delay nothing, even if no other frame of the user follows. */
static void an_abandoned_frame_is_not_waited_for(void **state)
{
    (void)state;
    struct rig r;
    uint32_t pages[LAYERS];
    init(&r, 0);
    take_all(&r, 0, pages);
    for (uint64_t frame = 2; frame < 4; frame++) {
        record(&r, 0, frame);
        slc_page_pool_give(&r.pool, r.users[0], pages[frame], SLC_NO_OWNER);
        slc_page_pool_abandon(&r.pool, r.users[0], frame);
    }
    record(&r, 1, 1);
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT), pages[2]);
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[1], FORMAT), pages[3]);
    finish(&r);
}

/* The copy may still be pending when the tile returns to its page. */
static void a_page_that_came_back_is_shared_when_its_copy_is_complete(void **state)
{
    (void)state;
    struct rig r;
    const struct slc_tile_key key = key_of(1);
    init(&r, 0);
    uint32_t page = slc_page_pool_take(&r.pool, r.users[0], FORMAT);
    slc_page_share_announce(&r.pool, r.users[0], &key);
    slc_page_share_place(&r.pool, r.users[0], &key, page);
    record(&r, 0, 1);
    slc_page_share_written(&r.pool, r.users[0], page, 1);
    slc_page_pool_give(&r.pool, r.users[0], page, 7);
    record(&r, 0, 2);
    assert_true(slc_page_pool_retake(&r.pool, r.users[0], page, 7));
    slc_page_share_adopt(&r.pool, r.users[0], &key, page);
    slc_page_pool_abandon(&r.pool, r.users[0], 2);
    record(&r, 1, 1);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[1], &key), SLC_SHARE_WAIT);
    assert_int_equal(slc_page_share_take(&r.pool, r.users[1], &key), SLUICE_PAGE_NONE);
    timelines[0] = 1;
    record(&r, 1, 2);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[1], &key), SLC_SHARE_READY);
    assert_int_equal(slc_page_share_take(&r.pool, r.users[1], &key), page);
    finish(&r);
}

/* A new user takes the number of a user that was idle for long, and begins to read a tile. */
static void a_new_user_is_waited_for_in_the_place_of_an_idle_one(void **state)
{
    (void)state;
    struct rig r;
    const struct slc_tile_key key = key_of(1);
    init(&r, 0);
    uint32_t idle = r.users[1];
    slc_page_share_announce(&r.pool, idle, &key);
    for (uint64_t frame = 1; frame < 20; frame++) {
        record(&r, 0, frame);
        timelines[0] = frame;
    }
    assert_int_equal(slc_page_share_look(&r.pool, r.users[0], &key), SLC_SHARE_NONE);
    slc_page_pool_remove_user(&r.pool, idle);
    CHECK_OK(slc_page_pool_add_user(&r.pool, (VkSemaphore)(uintptr_t)2, 0, NULL, &r.users[1]));
    assert_int_equal(r.users[1], idle);
    slc_page_share_announce(&r.pool, r.users[1], &key);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[0], &key), SLC_SHARE_WAIT);
    record(&r, 0, 20);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[0], &key), SLC_SHARE_WAIT);
    finish(&r);
}

/* User 0 has read the tile and copied it in frame 1. Returns its page. */
static uint32_t copy_tile(struct rig *r, const struct slc_tile_key *key)
{
    uint32_t page = slc_page_pool_take(&r->pool, r->users[0], FORMAT);
    slc_page_share_announce(&r->pool, r->users[0], key);
    slc_page_share_place(&r->pool, r->users[0], key, page);
    record(r, 0, 1);
    slc_page_share_written(&r->pool, r->users[0], page, 1);
    timelines[0] = 1;
    record(r, 1, 1);
    return page;
}

static void a_shared_page_is_free_when_no_frame_of_any_reader_is_left(void **state)
{
    (void)state;
    struct rig r;
    const struct slc_tile_key key = key_of(1);
    init(&r, 0);
    uint32_t page = copy_tile(&r, &key);
    assert_int_equal(slc_page_share_take(&r.pool, r.users[1], &key), page);
    record(&r, 1, 2);
    slc_page_pool_give(&r.pool, r.users[1], page, SLC_NO_OWNER); /* frame 2 may read it */
    slc_page_pool_give(&r.pool, r.users[0], page, 5);
    assert_false(slc_page_pool_retake(&r.pool, r.users[0], page, 5));
    for (uint32_t i = 1; i < LAYERS; i++)
        assert_int_not_equal(slc_page_pool_take(&r.pool, r.users[0], FORMAT), page);
    record(&r, 0, 2);
    assert_int_equal(slc_page_pool_free_count(&r.pool, r.users[0], FORMAT), UINT32_MAX);
    assert_true(slc_page_layer(&r.pool.chunks, page)->held);
    timelines[1] = 2;
    record(&r, 0, 3);
    assert_false(slc_page_layer(&r.pool.chunks, page)->held);
    assert_int_equal(slc_page_pool_take(&r.pool, r.users[0], FORMAT), page);
    finish(&r);
}

/* Each of two users has two textures of one source. */
static void a_page_is_held_once_for_all_tiles_on_it(void **state)
{
    (void)state;
    struct rig r;
    const struct slc_tile_key key = key_of(1);
    init(&r, 0);
    uint32_t page = copy_tile(&r, &key);
    for (uint32_t i = 0; i < USERS; i++) {
        assert_int_equal(slc_page_share_look(&r.pool, r.users[i], &key), SLC_SHARE_READY);
        assert_int_equal(slc_page_share_take(&r.pool, r.users[i], &key), page);
    }
    assert_int_equal(r.pool.held_count, 1);
    for (uint32_t i = 0; i < USERS; i++) {
        assert_int_equal(r.pool.users[r.users[i]].held_count, 1);
        slc_page_pool_give(&r.pool, r.users[i], page, 7);
        assert_false(slc_page_pool_retake(&r.pool, r.users[i], page, 7));
        assert_int_equal(r.pool.users[r.users[i]].held_count, 1 - i);
    }
    slc_page_pool_give(&r.pool, r.users[0], page, 7);
    assert_int_equal(r.pool.users[r.users[0]].held_count, 0);
    finish(&r);
}

static void a_texture_that_goes_takes_no_read_of_others_away(void **state)
{
    (void)state;
    struct rig r;
    const struct slc_tile_key keys[] = {key_of(1), key_of(2)};
    init(&r, 0);
    slc_page_share_announce(&r.pool, r.users[0], &keys[0]);
    slc_page_share_announce(&r.pool, r.users[1], &keys[1]);
    slc_page_share_leave(&r.pool, r.users[1], keys[0].source);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[1], &keys[0]), SLC_SHARE_WAIT);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[0], &keys[1]), SLC_SHARE_NONE);
    finish(&r);
}

/* A read that began before the change, and a page that comes back with old texels. */
static void texels_from_before_a_change_get_no_name_of_new_ones(void **state)
{
    (void)state;
    struct rig r;
    struct slc_tile_key old = key_of(1), changed = old;
    init(&r, 0);
    uint32_t given = copy_tile(&r, &old);
    slc_page_pool_give(&r.pool, r.users[0], given, 7);
    slc_page_share_announce(&r.pool, r.users[0], &old); /* for another texture of the user */
    assert_int_equal(slc_page_share_generation(&r.pool, old.source), 0);
    changed.generation = slc_page_share_drop(&r.pool, old.source);
    assert_int_equal(slc_page_share_drop(&r.pool, old.source), changed.generation);
    assert_int_equal(slc_page_share_generation(&r.pool, old.source), changed.generation);
    assert_int_equal(slc_page_share_generation(&r.pool, NULL), 0); /* another source */
    slc_page_share_announce(&r.pool, r.users[0], &changed);
    uint32_t page = slc_page_pool_take(&r.pool, r.users[0], FORMAT);
    slc_page_share_place(&r.pool, r.users[0], &old, page);
    record(&r, 0, 2);
    slc_page_share_written(&r.pool, r.users[0], page, 2);
    timelines[0] = 2;
    record(&r, 1, 2);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[1], &changed), SLC_SHARE_WAIT);
    slc_page_share_withdraw(&r.pool, r.users[0], &changed);
    assert_true(slc_page_pool_retake(&r.pool, r.users[0], given, 7));
    slc_page_share_adopt(&r.pool, r.users[0], &old, given);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[1], &old), SLC_SHARE_READY);
    assert_int_equal(slc_page_share_look(&r.pool, r.users[1], &changed), SLC_SHARE_NONE);
    assert_true(slc_page_share_drop(&r.pool, old.source) != changed.generation);
    finish(&r);
}

/* The texels are older than the abandoned frames, unless one of these copied them again. */
static void an_abandoned_frame_leaves_the_texels_that_came_back(void **state)
{
    (void)state;
    struct rig r;
    const struct slc_tile_key key = key_of(1);
    for (int copied = 0; copied < 2; copied++) {
        init(&r, 0);
        uint32_t page = copy_tile(&r, &key);
        record(&r, 0, 2);
        slc_page_pool_give(&r.pool, r.users[0], page, 7);
        assert_true(slc_page_pool_retake(&r.pool, r.users[0], page, 7));
        slc_page_share_adopt(&r.pool, r.users[0], &key, page);
        if (copied)
            slc_page_share_written(&r.pool, r.users[0], page, 2);
        slc_page_pool_abandon(&r.pool, r.users[0], 2);
        record(&r, 1, 2);
        assert_int_equal(slc_page_share_look(&r.pool, r.users[1], &key),
                         copied ? SLC_SHARE_WAIT : SLC_SHARE_READY);
        finish(&r);
    }
}

static void a_page_that_was_left_waits_for_frames_of_all_readers(void **state)
{
    (void)state;
    struct rig r;
    const struct slc_tile_key key = key_of(1);
    struct slc_page_readers readers;
    uint32_t to;
    init(&r, 0);
    uint32_t page = copy_tile(&r, &key);
    assert_int_equal(slc_page_share_take(&r.pool, r.users[1], &key), page);
    record(&r, 1, 2);
    assert_int_equal(slc_page_pool_held_in(&r.pool, r.users[0], 0), SLC_NONE);
    slc_page_pool_give(&r.pool, r.users[1], page, SLC_NO_OWNER); /* frame 2 may read it */
    assert_int_equal(slc_page_pool_held_in(&r.pool, r.users[0], 0), 1);
    record(&r, 0, 2);
    assert_true(slc_page_pool_move(&r.pool, r.users[0], page, 2, &to, &readers));
    timelines[0] = 2;
    assert_false(slc_page_pool_end_move(&r.pool, r.users[0], page, &readers));
    for (uint32_t i = 2; i < LAYERS + 1; i++)
        assert_int_not_equal(slc_page_pool_take(&r.pool, r.users[0], FORMAT), page);
    timelines[1] = 2;
    record(&r, 0, 3);
    assert_true(slc_page_pool_end_move(&r.pool, r.users[0], page, &readers));
    assert_false(slc_page_layer(&r.pool.chunks, page)->held);
    finish(&r);
}

struct walker {
    struct rig *rig;
    uint32_t user;
    uint32_t pages[LAYERS];
    uint32_t taken, wrong; ///< pages taken; pages that another user held at that time
};

static atomic_uint owners[CHUNKS][LAYERS * 4]; ///< user + 1; 0: unused

static atomic_uint *owner_of(uint32_t page)
{
    return &owners[page >> 16][page & 0xFFFFu];
}

/* Runs frames of one user on its own thread. Each frame replaces half of its pages. */
static void *walk(void *argument)
{
    struct walker *w = argument;
    struct slc_page_pool *pool = &w->rig->pool;
    uint32_t random = w->user + 1;
    for (uint64_t frame = 1; frame < 2000; frame++) {
        for (uint32_t i = 0; i < LAYERS; i++) {
            random = random * 1664525u + 1013904223u;
            if (random >> 31)
                continue;
            if (w->pages[i] != SLUICE_PAGE_NONE) {
                w->wrong += atomic_exchange(owner_of(w->pages[i]), 0) != w->user + 1;
                slc_page_pool_give(pool, w->user, w->pages[i], SLC_NO_OWNER);
            }
            w->pages[i] = frame / 200 % 2 ? SLUICE_PAGE_NONE /* until images are destroyed */
                                          : slc_page_pool_take(pool, w->user, FORMAT);
            if (w->pages[i] == SLUICE_PAGE_NONE)
                continue;
            w->taken++;
            w->wrong += atomic_exchange(owner_of(w->pages[i]), w->user + 1) != 0;
        }
        slc_page_pool_record(pool, w->user, frame, timelines[w->user], commands);
        const struct slc_page_views *views = slc_page_pool_views(pool, w->user);
        for (uint32_t i = 0; i < views->count; i++)
            w->wrong += views->views[i] == VK_NULL_HANDLE;
        for (uint32_t i = 0; i < LAYERS; i++)
            w->wrong +=
                w->pages[i] != SLUICE_PAGE_NONE && views->views[w->pages[i] >> 16] == views->empty;
        timelines[w->user] = frame - 1;
    }
    return NULL;
}

static void users_may_be_on_threads_of_their_own(void **state)
{
    (void)state;
    struct rig r;
    struct walker walkers[USERS];
    pthread_t threads[USERS];
    init(&r, 0);
    for (uint32_t i = 0; i < USERS; i++) {
        walkers[i] = (struct walker){.rig = &r, .user = r.users[i]};
        for (uint32_t j = 0; j < LAYERS; j++)
            walkers[i].pages[j] = SLUICE_PAGE_NONE;
        assert_int_equal(pthread_create(&threads[i], NULL, walk, &walkers[i]), 0);
    }
    for (uint32_t i = 0; i < USERS; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(walkers[i].wrong, 0);
        assert_true(walkers[i].taken > 1000);
    }
    finish(&r);
}

static PFN_vkAllocateMemory real_allocate;
static uint32_t allocation_count;

static VkResult VKAPI_CALL count_allocation(VkDevice device, const VkMemoryAllocateInfo *info,
                                            const VkAllocationCallbacks *cb, VkDeviceMemory *memory)
{
    allocation_count++;
    return real_allocate(device, info, cb, memory);
}

/* In each tick 50 textures are added and 50 pages requested. */
static void textures_that_are_added_do_not_make_a_full_device_try_again(void **state)
{
    (void)state;
    uint32_t tries[3];
    for (int k = 0; k < 3; k++) { /* without preparing; preparing nothing; preparing 4 MiB */
        struct rig r;
        init(&r, 0);
        real_allocate = r.pool.vk.AllocateMemory;
        r.pool.vk.AllocateMemory = count_allocation;
        if (k == 2)
            r.pool.chunks.kept_size = 1 << 22;
        fake.memory_limit = 1;
        allocation_count = 0;
        uint32_t room_count = 0;
        for (int i = 0; i < 50; i++) {
            if (k > 0)
                slc_page_pool_prepare(&r.pool, r.users[0], FORMAT);
            room_count += slc_page_chunks_room(&r.pool.chunks, r.pool.timelines.tick) > 0;
            assert_int_equal(slc_page_pool_take(&r.pool, r.users[0], FORMAT), SLC_NONE);
        }
        assert_true(room_count <= 1);
        tries[k] = allocation_count;
        finish(&r);
    }
    assert_true(tries[0] > 0);
    assert_int_equal(tries[1], tries[0]);
    assert_true(tries[2] <= 2 * tries[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_page_of_another_user_waits_for_its_frames),
        cmocka_unit_test(a_user_takes_its_own_page_at_once),
        cmocka_unit_test(a_new_image_belongs_to_its_maker_until_it_is_in_its_layout),
        cmocka_unit_test(an_empty_image_goes_when_no_user_can_see_it),
        cmocka_unit_test(a_retired_image_leaves_the_views_with_the_next_frame),
        cmocka_unit_test(a_user_that_goes_gives_its_pages_back),
        cmocka_unit_test(pages_that_others_hold_are_no_capacity),
        cmocka_unit_test(memory_beyond_the_limits_is_for_the_user_beyond_its_own_to_free),
        cmocka_unit_test(an_abandoned_frame_is_not_waited_for),
        cmocka_unit_test(a_page_that_came_back_is_shared_when_its_copy_is_complete),
        cmocka_unit_test(a_new_user_is_waited_for_in_the_place_of_an_idle_one),
        cmocka_unit_test(a_shared_page_is_free_when_no_frame_of_any_reader_is_left),
        cmocka_unit_test(a_page_is_held_once_for_all_tiles_on_it),
        cmocka_unit_test(a_texture_that_goes_takes_no_read_of_others_away),
        cmocka_unit_test(an_abandoned_frame_leaves_the_texels_that_came_back),
        cmocka_unit_test(texels_from_before_a_change_get_no_name_of_new_ones),
        cmocka_unit_test(a_page_that_was_left_waits_for_frames_of_all_readers),
        cmocka_unit_test(users_may_be_on_threads_of_their_own),
        cmocka_unit_test(textures_that_are_added_do_not_make_a_full_device_try_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
