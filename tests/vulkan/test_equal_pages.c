/*
 * Equal tiles on shared pages, against a naive model. Two users read, show, evict and restore tiles
 * in any order, move pages, complete their frames at any time, and abandon some.
 */
#include "vulkan/page_pool.h"

#include "vulkan/context.h"
#include "vulkan/fake_vulkan.h"
#include "vulkan/page_leaving.h"
#include "vulkan/page_sharing.h"

#include <sluice/shared/texture_table.h>

#include "support/roll.h"
#include "support/test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#define FORMAT SLUICE_FORMAT_R8G8B8A8_UNORM

enum {
    USERS = 2,
    CONTENTS = 16,
    TILES = 40,
    CHUNKS = 2,
    PAGES = 256,
    FRAMES = 3,
    COPIES = 256,
    MOVES = 64
};

enum state { ABSENT, READING, WRITTEN, SHOWN };

struct tile {
    enum state state;
    uint32_t page;
    uint64_t frame; ///< WRITTEN: frame that copies it
};

struct copy {
    uint32_t page, content;
    uint64_t frame;
};

/* Tiles move from one page to the other with this frame. */
struct move {
    uint32_t from, to;
    uint64_t frame;
    struct slc_page_readers readers;
};

struct user {
    uint32_t number; ///< number in the pool
    struct tile tiles[TILES];
    struct copy copies[COPIES]; ///< copies that are not complete
    uint32_t copy_count;
    struct move moves[MOVES]; ///< moves whose old pages are still held
    uint32_t move_count;
    uint64_t recorded;
    uint64_t last_read[CHUNKS][PAGES]; ///< by page: last frame that could read it
};

struct model {
    SluiceVulkanContext *context;
    struct slc_page_pool pool;
    struct user users[USERS];
    uint32_t texels[CHUNKS][PAGES]; ///< 1 + content of complete copies
    uint32_t shared, read, restored, moved, moved_together, moved_back;
    bool shrinks; ///< true: users return more tiles than they take
};

static atomic_uint_fast64_t timelines[USERS];
static const VkCommandBuffer commands = (VkCommandBuffer)(uintptr_t)64;
static struct fake_vulkan fake; /* large */

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
    (void)buffer_count, (void)buffers, (void)image_count, (void)images;
}

static bool identify(SluiceImageSource *source, const SluiceImageRegion *region, uint64_t *identity)
{
    (void)source;
    *identity = 1 + region->x / 128 % CONTENTS;
    return true;
}

static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                     .pfnIdentifyRegion = identify};
static SluiceImageSource source = {&interface};

static struct slc_tile_key key_of(uint32_t tile)
{
    const SluiceImageRegion region = {.x = tile * 128, .width = 128, .height = 128};
    return slc_tile_key(&source, &region, 0);
}

static void init(struct model *m)
{
    memset(m, 0, sizeof *m);
    fake = (struct fake_vulkan){.tail_page_count = 1, .layer_size = 65536};
    const SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(&fake);
    CHECK_OK(sluiceCreateVulkanContext(&info, &m->context));
    CHECK_OK(
        slc_page_pool_init(&m->pool, &m->context->vk, &m->context->caps, &m->context->cb, CHUNKS));
    m->pool.vk.GetSemaphoreCounterValue = get_value;
    m->pool.vk.CmdPipelineBarrier = barrier;
    for (uintptr_t i = 0; i < USERS; i++) {
        timelines[i] = 0;
        CHECK_OK(
            slc_page_pool_add_user(&m->pool, (VkSemaphore)(i + 1), 0, NULL, &m->users[i].number));
    }
}

/* Completes all frames, and frees pages that are leaving. */
static void finish(struct model *m)
{
    for (uint32_t i = 0; i < 2 * USERS; i++) {
        struct user *u = &m->users[i % USERS];
        u->recorded++;
        slc_page_pool_record(&m->pool, u->number, u->recorded, u->recorded, commands);
        timelines[i % USERS] = u->recorded;
    }
    assert_int_equal(m->pool.shared.going_count, 0);
    for (uint32_t i = 0; i < USERS; i++)
        slc_page_pool_remove_user(&m->pool, m->users[i].number);
    assert_int_equal(m->pool.held_count, 0);
    slc_page_pool_finish(&m->pool);
    sluiceDestroyVulkanContext(m->context);
    assert_int_equal(fake.live_objects, 0);
}

static uint32_t *texels_of(struct model *m, uint32_t page)
{
    return &m->texels[page >> 16][page & 0xFFFFu];
}

static bool is_on_page(const struct tile *tile, uint32_t page)
{
    return tile->state >= WRITTEN && tile->page == page;
}

static uint32_t count_tiles(const struct user *u, uint32_t page)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < TILES; i++)
        count += is_on_page(&u->tiles[i], page);
    return count;
}

/* Checks that no tile shows the page, and that no frame of the other user can still read it. */
static void check_fresh(struct model *m, uint32_t user, uint32_t page)
{
    for (uint32_t i = 0; i < USERS; i++) {
        assert_int_equal(count_tiles(&m->users[i], page), 0);
        if (i != user)
            assert_true(timelines[i] >= m->users[i].last_read[page >> 16][page & 0xFFFFu]);
    }
}

static void add_copy(struct user *u, uint32_t page, uint32_t content)
{
    assert_true(u->copy_count < COPIES);
    u->copies[u->copy_count++] = (struct copy){page, content, u->recorded};
}

/* Ends a read: takes a new page for the tile. */
static void place(struct model *m, uint32_t user, uint32_t index)
{
    struct user *u = &m->users[user];
    struct tile *tile = &u->tiles[index];
    const struct slc_tile_key key = key_of(index);
    uint32_t page = slc_page_pool_take(&m->pool, u->number, FORMAT);
    if (page == SLUICE_PAGE_NONE) {
        slc_page_share_withdraw(&m->pool, u->number, &key);
        tile->state = ABSENT;
        return;
    }
    check_fresh(m, user, page);
    *tile = (struct tile){WRITTEN, page, u->recorded};
    slc_page_share_place(&m->pool, u->number, &key, page);
    slc_page_share_written(&m->pool, u->number, page, u->recorded);
    add_copy(u, page, 1 + index % CONTENTS);
    m->read++;
}

static void start(struct model *m, uint32_t user, uint32_t index)
{
    struct user *u = &m->users[user];
    struct tile *tile = &u->tiles[index];
    const struct slc_tile_key key = key_of(index);
    uint32_t old = tile->page;
    enum slc_share share = slc_page_share_look(&m->pool, u->number, &key);
    if (share == SLC_SHARE_WAIT)
        return;
    if (share == SLC_SHARE_READY) {
        uint32_t page = slc_page_share_take(&m->pool, u->number, &key);
        assert_int_not_equal(page, SLUICE_PAGE_NONE);
        assert_int_equal(*texels_of(m, page), 1 + index % CONTENTS);
        *tile = (struct tile){SHOWN, page, 0};
        m->shared++;
        return;
    }
    if (old != SLUICE_PAGE_NONE && slc_page_pool_retake(&m->pool, u->number, old, index)) {
        check_fresh(m, user, old);
        slc_page_share_adopt(&m->pool, u->number, &key, old);
        *tile = (struct tile){SHOWN, old, 0};
        m->restored++;
        return;
    }
    slc_page_share_announce(&m->pool, u->number, &key);
    *tile = (struct tile){READING, SLUICE_PAGE_NONE, 0};
}

static void give(struct model *m, uint32_t user, uint32_t index, bool keep)
{
    struct user *u = &m->users[user];
    uint32_t page = u->tiles[index].page;
    u->tiles[index].state = ABSENT;
    u->tiles[index].page = keep ? page : SLUICE_PAGE_NONE;
    u->last_read[page >> 16][page & 0xFFFFu] = u->recorded;
    slc_page_pool_give(&m->pool, u->number, page, keep ? index : SLC_NO_OWNER);
}

/* Takes or returns a tile's page, or cancels its read. */
static void change_tile(struct model *m, uint32_t user)
{
    struct user *u = &m->users[user];
    uint32_t index = (uint32_t)roll() % TILES;
    struct tile *tile = &u->tiles[index];
    const struct slc_tile_key key = key_of(index);
    uint32_t choice = (uint32_t)roll() % 8;
    switch (tile->state) {
    case ABSENT:
        if (choice < (m->shrinks ? 2u : 8u))
            start(m, user, index);
        break;
    case READING:
        if (choice == 0) { /* failed, or canceled */
            slc_page_share_withdraw(&m->pool, u->number, &key);
            tile->state = ABSENT;
        } else {
            place(m, user, index);
        }
        break;
    case WRITTEN: break;
    case SHOWN:
        if (choice < (m->shrinks ? 8u : 3u))
            give(m, user, index, choice > 0);
        break;
    }
}

static void record(struct model *m, uint32_t user)
{
    struct user *u = &m->users[user];
    slc_page_pool_record(&m->pool, u->number, ++u->recorded, timelines[user], commands);
    for (uint32_t i = 0; i < u->copy_count; i++)
        if (u->copies[i].frame == 0) { /* abandoned: copied again */
            u->copies[i].frame = u->recorded;
            slc_page_share_written(&m->pool, u->number, u->copies[i].page, u->recorded);
        }
}

/* Releases old pages in the order of the moves. */
static void end_moves(struct model *m, uint32_t user)
{
    struct user *u = &m->users[user];
    uint32_t over = 0;
    while (
        over < u->move_count && u->moves[over].frame <= timelines[user] &&
        slc_page_pool_end_move(&m->pool, u->number, u->moves[over].from, &u->moves[over].readers)) {
        uint32_t from = u->moves[over++].from;
        u->last_read[from >> 16][from & 0xFFFFu] = timelines[user];
    }
    u->move_count -= over;
    memmove(u->moves, u->moves + over, u->move_count * sizeof *u->moves);
}

static void copy_moved(struct model *m, uint32_t user, uint64_t frame)
{
    struct user *u = &m->users[user];
    for (uint32_t i = 0; i < u->move_count; i++)
        if (u->moves[i].frame == frame)
            *texels_of(m, u->moves[i].to) = *texels_of(m, u->moves[i].from);
}

/* Moves tiles that are still on the new page back to the old one. */
static void move_back(struct model *m, uint32_t user)
{
    struct user *u = &m->users[user];
    while (u->move_count && u->moves[u->move_count - 1].frame == u->recorded + 1) {
        const struct move *move = &u->moves[--u->move_count];
        bool there = count_tiles(u, move->to) > 0;
        assert_int_equal(slc_page_pool_move_back(&m->pool, u->number, move->from, move->to), there);
        for (uint32_t i = 0; i < TILES; i++)
            if (is_on_page(&u->tiles[i], move->to))
                u->tiles[i].page = move->from;
        m->moved_back += there;
    }
}

/* Completes the oldest incomplete frame. */
static void complete(struct model *m, uint32_t user)
{
    struct user *u = &m->users[user];
    if (timelines[user] == u->recorded)
        return;
    uint64_t frame = ++timelines[user];
    copy_moved(m, user, frame);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < u->copy_count; i++) {
        if (u->copies[i].frame != frame) {
            u->copies[kept++] = u->copies[i];
            continue;
        }
        *texels_of(m, u->copies[i].page) = u->copies[i].content;
        for (uint32_t j = 0; j < TILES; j++)
            if (u->tiles[j].state == WRITTEN && u->tiles[j].page == u->copies[i].page)
                u->tiles[j].state = SHOWN;
    }
    u->copy_count = kept;
}

static void abandon(struct model *m, uint32_t user)
{
    struct user *u = &m->users[user];
    if (timelines[user] == u->recorded)
        return;
    for (uint32_t i = 0; i < u->copy_count; i++)
        if (u->copies[i].frame == u->recorded)
            u->copies[i].frame = 0;
    slc_page_pool_abandon(&m->pool, u->number, u->recorded--);
    for (uint32_t i = 0; i < CHUNKS * PAGES; i++)
        if (u->last_read[i / PAGES][i % PAGES] > u->recorded)
            u->last_read[i / PAGES][i % PAGES] = u->recorded;
    move_back(m, user);
}

/* Returns the page with the texels that the tile will show: a move's target has them once the move
 * is complete. */
static uint32_t page_with_texels(const struct user *u, uint32_t user, uint32_t page)
{
    for (uint32_t i = u->move_count; i-- > 0;)
        if (u->moves[i].to == page && u->moves[i].frame > timelines[user])
            page = u->moves[i].from;
    return page;
}

static bool is_left(const struct user *u, uint32_t page)
{
    for (uint32_t i = 0; i < u->move_count; i++)
        if (u->moves[i].from == page)
            return true;
    return false;
}

static void check(struct model *m)
{
    uint32_t held[USERS] = {0}, equal[USERS] = {0}, all = 0;
    for (uint32_t page = 0; page < CHUNKS * PAGES; page++) {
        uint32_t word = page / PAGES << 16 | page % PAGES, holders = 0;
        for (uint32_t i = 0; i < USERS; i++) {
            uint32_t tiles = count_tiles(&m->users[i], word);
            bool holds = tiles > 0 || is_left(&m->users[i], word);
            held[i] += holds;
            equal[i] += tiles > 1 ? tiles - 1 : 0;
            holders += holds;
        }
        all += holders > 0;
    }
    for (uint32_t i = 0; i < USERS; i++) {
        assert_int_equal(m->pool.users[m->users[i].number].held_count, held[i]);
        assert_int_equal(m->pool.users[m->users[i].number].equal_count, equal[i]);
        for (uint32_t j = 0; j < TILES; j++)
            if (m->users[i].tiles[j].state == SHOWN)
                assert_int_equal(
                    *texels_of(m, page_with_texels(&m->users[i], i, m->users[i].tiles[j].page)),
                    1 + j % CONTENTS);
    }
    assert_int_equal(m->pool.held_count - m->pool.shared.going_count, all);
}

/* Moves all tiles on a page. Pages that another user also holds stay. */
static void move_page(struct model *m, uint32_t user, uint32_t index)
{
    struct user *u = &m->users[user];
    const struct tile *tile = &u->tiles[index];
    struct move *move = &u->moves[u->move_count];
    if (tile->state != SHOWN || u->move_count == MOVES || u->recorded == timelines[user])
        return;
    uint32_t from = tile->page, others = count_tiles(&m->users[1 - user], from);
    assert_int_equal(slc_page_pool_tiles_on(&m->pool, u->number, from),
                     others ? 0 : count_tiles(u, from));
    if (!slc_page_pool_move(&m->pool, u->number, from, u->recorded, &move->to, &move->readers))
        return;
    assert_int_equal(others, 0);
    assert_int_equal(page_with_texels(u, user, from), from);
    check_fresh(m, user, move->to);
    move->from = from;
    move->frame = u->recorded;
    u->move_count++;
    for (uint32_t i = 0; i < TILES; i++)
        if (is_on_page(&u->tiles[i], from))
            u->tiles[i].page = move->to;
    m->moved++;
    m->moved_together += count_tiles(u, move->to) > 1;
}

static void equal_tiles_are_on_one_page_in_any_order(void **state)
{
    (void)state;
    static struct model m;
    uint32_t shared = 0, read = 0, restored = 0, moved = 0, together = 0, back = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        roll_seed(seed);
        init(&m);
        for (uint32_t i = 0; i < USERS * TILES; i++)
            m.users[i / TILES].tiles[i % TILES].page = SLUICE_PAGE_NONE;
        for (uint32_t i = 0; i < USERS; i++)
            record(&m, i);
        for (uint32_t i = 0; i < 3000; i++) {
            uint32_t user = (uint32_t)roll() % USERS;
            uint32_t choice = (uint32_t)roll() % 16;
            if (choice == 0)
                abandon(&m, user);
            else if (choice < 4)
                complete(&m, user);
            else if (choice < 6 && m.users[user].recorded < timelines[user] + FRAMES)
                record(&m, user);
            else if (choice < 7)
                for (uint32_t j = 0; j < TILES; j++)
                    move_page(&m, user, j);
            else if (m.users[user].recorded > timelines[user])
                change_tile(&m, user);
            end_moves(&m, user);
            m.shrinks = i / 400 % 2;
            check(&m);
        }
        shared += m.shared;
        read += m.read;
        restored += m.restored;
        moved += m.moved;
        together += m.moved_together;
        back += m.moved_back;
        finish(&m);
    }
    printf("# %u tiles shared, %u read, %u restored\n", shared, read, restored);
    printf("# %u pages moved, %u with several tiles, %u back\n", moved, together, back);
    assert_in_range(shared, 2000, 60000);
    assert_in_range(read, 100, 60000);
    assert_in_range(restored, 30, 60000);
    assert_in_range(together, 500, 60000);
    assert_in_range(back, 200, 60000);
}

static void tiles_of_another_shape_are_other_tiles(void **state)
{
    (void)state;
    SluiceImageRegion region = {.width = 128, .height = 64};
    const struct slc_tile_key wide = slc_tile_key(&source, &region, 0);
    region.width = 64;
    region.height = 128;
    const struct slc_tile_key high = slc_tile_key(&source, &region, 0);
    assert_true(wide.x == high.x && wide.y == high.y);
    assert_int_not_equal(wide.level, high.level);
}

/* A thread per user. Each shows all contents many times, from pages that either user wrote. */
struct walker {
    struct model *model;
    uint32_t user;
    uint32_t wrong;
};

static atomic_uint contents[CHUNKS][PAGES]; ///< 1 + content

static void *walk(void *argument)
{
    struct walker *w = argument;
    struct slc_page_pool *pool = &w->model->pool;
    uint32_t user = w->model->users[w->user].number, random = w->user + 1;
    uint32_t pages[TILES];
    for (uint32_t i = 0; i < TILES; i++)
        pages[i] = SLUICE_PAGE_NONE;
    for (uint64_t frame = 1; frame < 3000; frame++) {
        slc_page_pool_record(pool, user, frame, timelines[w->user], commands);
        for (uint32_t i = 0; i < TILES; i++) {
            const struct slc_tile_key key = key_of(i);
            random = random * 1664525u + 1013904223u;
            if (random >> 31)
                continue;
            if (pages[i] != SLUICE_PAGE_NONE) {
                w->wrong += contents[pages[i] >> 16][pages[i] & 0xFFFFu] != 1 + i % CONTENTS;
                slc_page_pool_give(pool, user, pages[i], SLC_NO_OWNER);
                pages[i] = SLUICE_PAGE_NONE;
                continue;
            }
            enum slc_share share = slc_page_share_look(pool, user, &key);
            if (share == SLC_SHARE_READY)
                pages[i] = slc_page_share_take(pool, user, &key);
            if (share != SLC_SHARE_NONE)
                continue;
            slc_page_share_announce(pool, user, &key);
            pages[i] = slc_page_pool_take(pool, user, FORMAT);
            if (pages[i] == SLUICE_PAGE_NONE) {
                slc_page_share_withdraw(pool, user, &key);
                continue;
            }
            slc_page_share_place(pool, user, &key, pages[i]);
            contents[pages[i] >> 16][pages[i] & 0xFFFFu] = 1 + i % CONTENTS;
            slc_page_share_written(pool, user, pages[i], frame);
        }
        timelines[w->user] = w->model->users[w->user].recorded = frame;
    }
    for (uint32_t i = 0; i < TILES; i++)
        if (pages[i] != SLUICE_PAGE_NONE)
            slc_page_pool_give(pool, user, pages[i], SLC_NO_OWNER);
    return NULL;
}

static void users_on_threads_of_their_own_share_equal_tiles(void **state)
{
    (void)state;
    static struct model m;
    pthread_t threads[USERS];
    struct walker walkers[USERS];
    init(&m);
    for (uint32_t i = 0; i < USERS; i++) {
        walkers[i] = (struct walker){&m, i, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, walk, &walkers[i]), 0);
    }
    for (uint32_t i = 0; i < USERS; i++)
        pthread_join(threads[i], NULL);
    for (uint32_t i = 0; i < USERS; i++)
        assert_int_equal(walkers[i].wrong, 0);
    finish(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_tiles_are_on_one_page_in_any_order),
        cmocka_unit_test(tiles_of_another_shape_are_other_tiles),
        cmocka_unit_test(users_on_threads_of_their_own_share_equal_tiles),
    };
    return RUN_TESTS(tests);
}
