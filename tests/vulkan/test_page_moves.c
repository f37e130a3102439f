/* Moves tiles out of an image of pages, with one or many tiles per page. Some frames are
 * abandoned. */
#include "vulkan/page_moves.h"

#include "vulkan/context.h"
#include "vulkan/fake_vulkan.h"
#include "vulkan/page_sharing.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/shared/texture_table.h>

#include <string.h>

#define FORMAT SLUICE_FORMAT_R8G8B8A8_UNORM
#define SINGLE(page) (TILES - 1u - (page)) /* tile of the first part, alone on its page */

enum { CHUNKS = 4, LAYERS = 64, PARTS = 3, EDGE = 40, TILES = EDGE * EDGE, CHANGES = 256 };

static struct fake_vulkan fake; /* large */
static struct slc_page_moves moves;
static uint64_t completed;  ///< completed frame
static uint32_t copy_count; ///< copies of the last frame

struct rig {
    struct failing_allocator allocator;
    SluiceVulkanContext *context;
    struct slc_page_pool pool;
    struct slc_page_table table;
    uint32_t user;
    uint64_t frame;
};

static VkResult VKAPI_CALL get_value(VkDevice device, VkSemaphore semaphore, uint64_t *value)
{
    (void)device, (void)semaphore;
    *value = completed;
    return VK_SUCCESS;
}

static void VKAPI_CALL copy_image(VkCommandBuffer buffer, VkImage from, VkImageLayout from_layout,
                                  VkImage to, VkImageLayout to_layout, uint32_t count,
                                  const VkImageCopy *copy)
{
    (void)buffer, (void)from_layout, (void)to_layout;
    assert_true(count == 1 && from != to && copy->srcSubresource.layerCount == 1);
    copy_count++;
}

static void init(struct rig *r)
{
    memset(r, 0, sizeof *r);
    fake = (struct fake_vulkan){.tail_page_count = 1, .layer_size = 65536};
    completed = 0;
    failing_allocator_init(&r->allocator, UINT64_MAX);
    SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(&fake);
    info.pAllocator = &r->allocator.callbacks;
    CHECK_OK(sluiceCreateVulkanContext(&info, &r->context));
    const struct slc_vk *vk = &r->context->vk;
    CHECK_OK(slc_page_pool_init(&r->pool, vk, &r->context->caps, &r->context->cb, CHUNKS));
    r->pool.vk.GetSemaphoreCounterValue = get_value;
    r->pool.vk.CmdCopyImage = copy_image;
    CHECK_OK(slc_page_pool_add_user(&r->pool, (VkSemaphore)1, 0, NULL, &r->user));
    CHECK_OK(slc_page_table_init(&r->table, vk, &r->context->caps, &r->context->cb,
                                 PARTS * (TILES + 64), PARTS, CHANGES));
    for (uint32_t i = 0; i < PARTS; i++)
        CHECK_OK(slc_page_table_add(&r->table, i,
                                    &(SluiceStreamedTextureDesc){.width = EDGE * FAKE_TILE,
                                                                 .height = EDGE * FAKE_TILE,
                                                                 .tileWidth = FAKE_TILE,
                                                                 .tileHeight = FAKE_TILE,
                                                                 .regularMipCount = 1}));
    memset(&moves, 0, sizeof moves);
    moves = (struct slc_page_moves){.pool = &r->pool,
                                    .table = &r->table,
                                    .user = r->user,
                                    .store_reserve = CHANGES / 2,
                                    .left = UINT32_MAX};
}

static void finish(struct rig *r)
{
    slc_page_pool_remove_user(&r->pool, r->user);
    slc_page_table_finish(&r->table);
    slc_page_pool_finish(&r->pool);
    sluiceDestroyVulkanContext(r->context);
    assert_int_equal(fake.live_objects, 0);
    assert_int_equal(r->allocator.live_count, 0);
}

/* Returns the number of pages that the frame copies. */
static uint32_t record(struct rig *r)
{
    VkCommandBuffer commands = fake_vulkan_commands(&fake);
    copy_count = 0;
    slc_page_moves_complete(&moves, completed);
    slc_page_pool_record(&r->pool, r->user, ++r->frame, completed, commands);
    slc_page_table_record_begin(&r->table, r->frame, commands);
    slc_page_moves_record(&moves, r->frame, commands);
    slc_page_table_record_publish(&r->table, commands);
    return copy_count;
}

static void abandon(struct rig *r, uint64_t frame)
{
    slc_page_pool_abandon(&r->pool, r->user, frame);
    slc_page_moves_abandon(&moves, frame);
    slc_page_table_abandon(&r->table, frame);
}

static uint32_t *word(struct rig *r, uint32_t part, uint32_t tile)
{
    return &r->table.entries[slc_page_table_word(&r->table, part, 0, tile % EDGE, tile / EDGE)];
}

static struct slc_tile_key key_of(uint32_t tile)
{
    static int source;
    return (struct slc_tile_key){(const SluiceImageSource *)(const void *)&source, 0, 0, tile, 0};
}

static void show(struct rig *r, uint32_t part, uint32_t tile, uint32_t page)
{
    *word(r, part, tile) = page | SLC_PAGE_SHOWN;
}

static uint32_t take(struct rig *r)
{
    uint32_t page = slc_page_pool_take(&r->pool, r->user, FORMAT);
    assert_int_not_equal(page, SLUICE_PAGE_NONE);
    return page;
}

/* Fills the first image, and one tile of the second. `count` tiles of each part share the first
 * page. */
static void fill(struct rig *r, uint32_t count)
{
    const struct slc_tile_key key = key_of(0);
    uint32_t pages[LAYERS + 1];
    slc_page_share_announce(&r->pool, r->user, &key);
    for (uint32_t i = 0; i <= LAYERS; i++)
        show(r, 0, SINGLE(i), pages[i] = take(r));
    slc_page_share_place(&r->pool, r->user, &key, pages[0]);
    record(r);
    slc_page_share_written(&r->pool, r->user, pages[0], 1);
    completed = 1;
    record(r);
    for (uint32_t i = 0; i < PARTS * count; i++)
        show(r, i % PARTS, i / PARTS, slc_page_share_take(&r->pool, r->user, &key));
}

static uint32_t count_words(struct rig *r, uint32_t page)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PARTS * TILES; i++)
        count += *word(r, i % PARTS, i / PARTS) == (page | SLC_PAGE_SHOWN);
    return count;
}

static void leave(struct rig *r, uint32_t chunk)
{
    r->pool.chunks.at[chunk].leaving = true;
    r->pool.leaving = chunk;
    r->pool.leaving_user = r->user;
}

/* Takes the tile off its page. It may be restored. */
static void evict(struct rig *r, uint32_t part, uint32_t tile)
{
    uint32_t *entry = word(r, part, tile), page = slc_page_of_entry(*entry);
    slc_page_pool_give(&r->pool, r->user, page, (uint32_t)(entry - r->table.entries));
    *entry = page | SLC_PAGE_GIVEN;
}

static void all_tiles_of_a_page_move_with_one_copy(void **state)
{
    (void)state;
    struct rig r;
    init(&r);
    fill(&r, 1000);
    evict(&r, 0, SINGLE(5));
    leave(&r, 0);
    assert_int_equal(record(&r), LAYERS - 1);
    assert_int_equal(count_words(&r, 0), 0);
    uint32_t to = slc_page_of_entry(*word(&r, 1, 0));
    assert_int_equal(to >> 16, 1);
    assert_int_equal(count_words(&r, to), PARTS * 1000 + 1);
    assert_int_equal(r.pool.chunks.at[0].free_count, 1);
    completed = r.frame;
    assert_int_equal(record(&r), 0);
    assert_int_equal(r.pool.chunks.at[0].free_count, LAYERS);
    finish(&r);
}

/* Tiles leave their new pages, and another tile takes one, before the frame is abandoned. */
static void tiles_of_an_abandoned_frame_are_on_their_old_pages(void **state)
{
    (void)state;
    struct rig r;
    init(&r);
    fill(&r, 20);
    evict(&r, 0, SINGLE(5));
    leave(&r, 0);
    record(&r);
    uint32_t equal = slc_page_of_entry(*word(&r, 0, 0));
    uint32_t single = slc_page_of_entry(*word(&r, 0, SINGLE(7)));
    uint32_t gone = slc_page_of_entry(*word(&r, 0, SINGLE(9)));
    evict(&r, 0, 0);
    evict(&r, 0, SINGLE(7));
    evict(&r, 0, SINGLE(9));
    uint32_t other = take(&r);
    assert_true(other == single || other == gone);
    show(&r, 2, TILES - 1, other);
    record(&r);
    abandon(&r, r.frame - 1);
    assert_int_equal(count_words(&r, 0), PARTS * 20 + 1 - 1);
    assert_int_equal(count_words(&r, equal), 0);
    for (uint32_t i = 1; i < LAYERS; i++)
        assert_int_equal(count_words(&r, i), i != 5 && i != 7 && i != 9);
    assert_int_equal(*word(&r, 2, TILES - 1), other | SLC_PAGE_SHOWN);
    uint32_t left = other == single ? gone : single, tile = SINGLE(other == single ? 9 : 7);
    uint32_t owner = (uint32_t)(word(&r, 0, tile) - r.table.entries);
    assert_false(slc_page_pool_retake(&r.pool, r.user, left, owner)); /* nothing was copied there */
    assert_int_equal(record(&r), LAYERS - 3);
    completed = r.frame;
    record(&r);
    assert_int_equal(r.pool.chunks.at[0].free_count, LAYERS);
    finish(&r);
}

static void a_tile_that_was_restored_goes_back_with_its_frame(void **state)
{
    (void)state;
    struct rig r;
    init(&r);
    fill(&r, 0);
    evict(&r, 0, SINGLE(5));
    leave(&r, 0);
    record(&r);
    uint32_t to = slc_page_of_entry(*word(&r, 0, SINGLE(7)));
    evict(&r, 0, SINGLE(7));
    uint32_t owner = (uint32_t)(word(&r, 0, SINGLE(7)) - r.table.entries);
    assert_true(slc_page_pool_retake(&r.pool, r.user, to, owner));
    show(&r, 0, SINGLE(7), to);
    abandon(&r, r.frame);
    assert_int_equal(*word(&r, 0, SINGLE(7)), 7 | SLC_PAGE_SHOWN);
    assert_int_equal(r.pool.chunks.at[1].free_count, LAYERS - 1);
    finish(&r);
}

static void a_page_whose_texels_a_frame_copies_moves_later(void **state)
{
    (void)state;
    struct rig r;
    init(&r);
    fill(&r, 0);
    evict(&r, 0, SINGLE(5));
    slc_page_share_written(&r.pool, r.user, 7, r.frame);
    leave(&r, 0);
    assert_int_equal(record(&r), LAYERS - 2);
    abandon(&r, 2); /* and is copied again */
    assert_int_equal(record(&r), LAYERS - 2);
    slc_page_share_written(&r.pool, r.user, 7, r.frame);
    assert_int_equal(record(&r), 0);
    completed = r.frame;
    assert_int_equal(record(&r), 1);
    finish(&r);
}

/* The list of changed words must grow. */
static void without_host_memory_a_page_of_many_tiles_moves_later(void **state)
{
    (void)state;
    struct rig r;
    init(&r);
    fill(&r, 1000);
    evict(&r, 0, SINGLE(5));
    leave(&r, 0);
    r.allocator.refuse_from = r.allocator.calls;
    assert_int_equal(record(&r), LAYERS - 2);
    assert_int_equal(count_words(&r, 0), PARTS * 1000 + 1);
    r.allocator.refuse_from = UINT64_MAX;
    assert_int_equal(record(&r), 1);
    assert_int_equal(count_words(&r, 0), 0);
    finish(&r);
}

static uint32_t choose(struct rig *r, uint32_t pages, uint32_t *chunk)
{
    uint32_t held, lacking;
    slc_page_pool_stay(&r->pool, r->user);
    lacking = slc_page_pool_choose_leaving(&r->pool, r->user, (uint64_t)pages * 65536, &held);
    *chunk = slc_page_pool_leaving(&r->pool, r->user);
    return lacking;
}

/* Images of 64, 64, 128 and 256 pages. The last one has 84 tiles. */
static void images_leave_so_that_much_of_the_budget_can_be_used(void **state)
{
    (void)state;
    struct rig r;
    uint32_t chunk;
    init(&r);
    for (uint32_t i = 0; i < 340; i++)
        show(&r, 0, i, take(&r));
    record(&r);
    assert_int_equal(choose(&r, 388, &chunk), 84); /* 64 + 64 pages may stay: the large ones go */
    assert_int_equal(chunk, 3);
    assert_int_equal(choose(&r, 64, &chunk), 0); /* nothing has to be evicted */
    assert_int_not_equal(chunk, 3);
    assert_int_equal(choose(&r, 0, &chunk), 0);
    assert_true(chunk < 2); /* the fewest moves */
    finish(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_tiles_of_a_page_move_with_one_copy),
        cmocka_unit_test(tiles_of_an_abandoned_frame_are_on_their_old_pages),
        cmocka_unit_test(a_tile_that_was_restored_goes_back_with_its_frame),
        cmocka_unit_test(a_page_whose_texels_a_frame_copies_moves_later),
        cmocka_unit_test(without_host_memory_a_page_of_many_tiles_moves_later),
        cmocka_unit_test(images_leave_so_that_much_of_the_budget_can_be_used),
    };
    return RUN_TESTS(tests);
}
