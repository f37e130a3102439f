/* Compares the page table on the device with a naive one, word by word. */
#include "device/directory_rig.h"

#include "demand_vulkan/scan.h"
#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

#include "base/alloc.h"

#include <string.h>

static SluiceAllocationCallbacks cb;

static uint64_t random_value(void)
{
    return (uint64_t)demand_rig_random(1u << 30) << 34 ^ demand_rig_random(1u << 30);
}

/* Returns a page, mostly near others, from few blocks, so that blocks appear and disappear. */
static uint32_t random_page(const struct directory_rig *r)
{
    uint32_t kind = demand_rig_random(8);
    if (kind == 0)
        return demand_rig_random(r->page_capacity);
    uint32_t group = demand_rig_random(24) * (r->page_capacity / 24 / 32);
    return group * 32 + demand_rig_random(kind < 4 ? 5 : 70);
}

static void change_some(struct directory_rig *r, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t page = random_page(r), kind = demand_rig_random(16);
        if (kind < 6)
            directory_rig_show(r, page, random_value(), false);
        else if (kind < 8)
            directory_rig_show(r, page, random_value(), true);
        else if (kind < 9)
            directory_rig_refuse(r, page);
        else
            directory_rig_hide(r, page);
    }
}

static void the_device_shows_what_a_naive_table_shows(void **state)
{
    static const uint32_t capacities[] = {1, 7, 63, 64, 500};
    roll_seed(81);
    for (uint32_t i = 0; i < sizeof capacities / sizeof capacities[0]; i++) {
        struct directory_rig r;
        directory_rig_init(&r, *state, &cb, 1u << 14, capacities[i]);
        directory_rig_record(&r); /* nothing yet */
        for (uint32_t round = 0; round < 60; round++) {
            r.slot = round % DIRECTORY_RIG_SLOTS;
            change_some(&r, round % 7 * 20);
            directory_rig_record(&r);
        }
        for (uint32_t page = 0; page < r.page_capacity; page++)
            directory_rig_hide(&r, page);
        directory_rig_record(&r);
        assert_int_equal(r.group_count, 0);
        directory_rig_finish(&r);
    }
}

static void a_block_is_there_again_as_soon_as_its_last_page_is_hidden(void **state)
{
    struct directory_rig r;
    directory_rig_init(&r, *state, &cb, 1u << 12, 2);
    directory_rig_show(&r, 0, 10, false);
    directory_rig_refuse(&r, 31);
    directory_rig_show(&r, 4095, (uint64_t)12 << 32 | 11, true);
    directory_rig_record(&r);
    directory_rig_show(&r, 64, 13, false); /* there is no block for it */
    assert_false(r.pages[64].there);
    directory_rig_hide(&r, 0);
    directory_rig_show(&r, 64, 13, false); /* the other page has it */
    assert_false(r.pages[64].there);
    directory_rig_hide(&r, 31);
    directory_rig_show(&r, 64, 14, false);
    assert_true(r.pages[64].there);
    directory_rig_record(&r);
    directory_rig_hide(&r, 64);
    directory_rig_show(&r, 0, 15, false);
    directory_rig_hide(&r, 0);
    directory_rig_show(&r, 65, 16, false);
    directory_rig_record(&r);
    directory_rig_finish(&r);
}

static void fill_uses(struct directory_rig *r)
{
    uint32_t *uses = r->uses.mapped;
    r->use_count = demand_rig_random(200);
    for (uint32_t i = 0; i < r->use_count; i++)
        uses[i] = random_page(r);
}

static void used_bits_arrive_whoever_has_the_blocks_by_then(void **state)
{
    struct directory_rig r;
    roll_seed(82);
    directory_rig_init(&r, *state, &cb, 1u << 13, 90);
    uint32_t used = 0;
    for (uint32_t round = 0; round < 80; round++) {
        r.slot = round % DIRECTORY_RIG_SLOTS;
        if (round >= DIRECTORY_RIG_SLOTS)
            directory_rig_check_used(&r, r.slot); /* used bits of three launches ago */
        change_some(&r, 60);
        directory_rig_record(&r);
        for (uint32_t twice = 0; twice < round % 3; twice++) {
            fill_uses(&r);
            directory_rig_launch(&r, false);
        }
        if (round % 5 == 0)
            directory_rig_record(&r); /* used bits exist, and nothing changes them */
        bool takes = round % 4 != 2;  /* otherwise the bits stay, unless their block disappears */
        if (takes && round % 4 == 0)
            change_some(&r, 60); /* not seen by this launch */
        fill_uses(&r);
        directory_rig_launch(&r, takes);
        for (uint32_t i = 0; i < r.page_capacity; i++)
            used += r.used[r.slot][i];
    }
    assert_true(used > 2000);
    directory_rig_finish(&r);
}

static void launch_with(struct directory_rig *r, uint32_t page, bool takes)
{
    *(uint32_t *)r->uses.mapped = page;
    r->use_count = 1;
    directory_rig_launch(r, takes);
}

static void nobody_inherits_the_used_bits_of_a_block(void **state)
{
    struct directory_rig r;
    directory_rig_init(&r, *state, &cb, 1u << 12, 2);
    directory_rig_show(&r, 5, 1, false);
    directory_rig_show(&r, 100, 2, false);
    directory_rig_record(&r);
    launch_with(&r, 5, false);
    directory_rig_hide(&r, 5);
    directory_rig_show(&r, 37, 3, false); /* uses this bit of this block again */
    directory_rig_record(&r);
    launch_with(&r, 37, false);
    directory_rig_hide(&r, 37);
    directory_rig_record(&r); /* the block is unused */
    launch_with(&r, 100, true);
    assert_true(r.used[0][100]);
    directory_rig_check_used(&r, 0);
    directory_rig_finish(&r);
}

static void used_bits_of_an_empty_table_are_none(void **state)
{
    struct directory_rig r;
    directory_rig_init(&r, *state, &cb, 1u << 12, 4);
    directory_rig_record(&r);
    launch_with(&r, 5, true);
    directory_rig_check_used(&r, 0);
    directory_rig_show(&r, 5, 1, false);
    launch_with(&r, 5, true); /* not recorded yet */
    directory_rig_check_used(&r, 0);
    directory_rig_record(&r);
    launch_with(&r, 5, true);
    assert_true(r.used[0][5]);
    directory_rig_check_used(&r, 0);
    directory_rig_finish(&r);
}

static void more_changes_than_a_slot_holds_make_it_grow_or_wait(void **state)
{
    struct directory_rig r;
    directory_rig_init(&r, *state, &cb, 1u << 16, 2048);
    for (uint32_t page = 0; page < r.page_capacity; page += 3)
        directory_rig_show(&r, page, page * 7ull, false);
    struct slc_page_directory *dir = &r.dir;
    demand_rig_limit_memory(&r.vk, 0);
    CHECK_RESULT(slc_page_directory_record(dir, r.h->commands[0], 0),
                 SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
    demand_rig_limit_memory(&r.vk, UINT32_MAX);
    r.caps.max_storage_buffer_range = 1000;
    CHECK_RESULT(slc_page_directory_record(dir, r.h->commands[0], 0), SLUICE_ERROR_LIMIT_EXCEEDED);
    r.caps.max_storage_buffer_range = UINT32_MAX;
    directory_rig_record(&r); /* all changes were kept */
    directory_rig_show(&r, 1, 2, false);
    directory_rig_record(&r); /* large buffers are kept */
    directory_rig_finish(&r);
}

static VKAPI_ATTR void VKAPI_CALL no_dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y,
                                              uint32_t z)
{
    (void)commands;
    fail_msg("a dispatch of %u, %u, %u", x, y, z);
}

static void nothing_is_dispatched_where_nothing_changed(void **state)
{
    struct directory_rig r;
    directory_rig_init(&r, *state, &cb, 1u << 12, 4);
    directory_rig_show(&r, 5, 1, false);
    directory_rig_record(&r);
    PFN_vkCmdDispatch dispatch = r.vk.CmdDispatch;
    r.vk.CmdDispatch = no_dispatch;
    directory_rig_hide(&r, 6);
    directory_rig_record(&r);
    r.vk.CmdDispatch = dispatch;
    directory_rig_finish(&r);
}

/* A table that is too large for a naive one. */
struct large {
    struct slc_vk vk;
    struct slc_page_directory dir;
    struct harness_buffer directory, blocks;
};

static void record_large(void *user, VkCommandBuffer commands)
{
    struct large *l = user;
    CHECK_OK(slc_page_directory_record(&l->dir, commands, 0));
    demand_rig_record_download(&l->vk, commands, &l->dir.directory, &l->directory);
    demand_rig_record_download(&l->vk, commands, &l->dir.blocks, &l->blocks);
}

static void sixty_four_mi_pages_have_both_ends_and_fit_into_64_megabytes(void **state)
{
    struct harness *h = *state;
    struct large l;
    struct slc_caps caps;
    const uint32_t page_count = 1u << 26, shown = 3000, step = (page_count - 1) / (shown - 1);
    const struct slc_page_directory_create_info info = {page_count, 100000, 1};
    const struct slc_demand_scan_create_info scan = {page_count, 2, 8192};
    assert_true(slc_page_directory_device_size(&info) + slc_demand_scan_device_size(&scan) <
                64000000);
    demand_rig_init(h, &l.vk, &caps);
    CHECK_OK(slc_page_directory_init(&l.dir, &l.vk, &caps, &cb, &info));
    harness_buffer_init(h, &l.directory, l.dir.directory.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    harness_buffer_init(h, &l.blocks, l.dir.blocks.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    CHECK_OK(slc_page_directory_show(&l.dir, page_count - 1, 77, false));
    for (uint32_t i = 0; i < shown; i++)
        CHECK_OK(slc_page_directory_show(&l.dir, i * step, i, false));
    harness_run(h, record_large, &l);
    const uint32_t *directory = l.directory.mapped, *blocks = l.blocks.mapped;
    uint32_t count = 0;
    for (uint32_t i = 0; i < page_count / 32; i++)
        count += directory[i] != SLUICE_DEMAND_NO_BLOCK;
    assert_int_equal(count, shown + 1);
    assert_int_equal(blocks[directory[page_count / 32 - 1] * 64 + 31], 77);
    for (uint32_t i = 0; i < shown; i++)
        assert_int_equal(blocks[directory[i * step / 32] * 64 + i * step % 32], i);
    slc_page_directory_finish(&l.dir);
    harness_buffer_finish(h, &l.directory);
    harness_buffer_finish(h, &l.blocks);
    harness_check_silence(h);
}

struct few {
    struct slc_vk vk;
    struct slc_page_directory dir;
    struct harness_buffer directory, masks;
};

static void record_few(void *user, VkCommandBuffer commands)
{
    struct few *f = user;
    CHECK_OK(slc_page_directory_record(&f->dir, commands, 0));
    demand_rig_record_download(&f->vk, commands, &f->dir.directory, &f->directory);
    demand_rig_record_download(&f->vk, commands, &f->dir.masks, &f->masks);
}

static void a_block_that_is_kept_shows_nothing_and_stays(void **state)
{
    struct harness *h = *state;
    struct few f;
    struct slc_caps caps;
    const struct slc_page_directory_create_info info = {1024, 1, 1};
    demand_rig_init(h, &f.vk, &caps);
    CHECK_OK(slc_page_directory_init(&f.dir, &f.vk, &caps, &cb, &info));
    harness_buffer_init(h, &f.directory, f.dir.directory.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    harness_buffer_init(h, &f.masks, f.dir.masks.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const uint32_t *directory = f.directory.mapped;
    const struct SluiceDemandBlockMasks *masks = f.masks.mapped;
    CHECK_OK(slc_page_directory_show(&f.dir, 3, 77, false));
    harness_run(h, record_few, &f);
    assert_int_equal(directory[0], 1);
    assert_int_equal(masks[1].resident, 8);
    slc_page_directory_hide(&f.dir, 3);
    CHECK_OK(slc_page_directory_keep(&f.dir, 70)); /* it gets the only block */
    CHECK_OK(slc_page_directory_keep(&f.dir, 71));
    harness_run(h, record_few, &f);
    assert_int_equal(directory[0], SLUICE_DEMAND_NO_BLOCK);
    assert_int_equal(directory[2], 1);
    assert_int_equal(masks[1].resident, 0);
    assert_int_equal(masks[1].used, 0);
    CHECK_RESULT(slc_page_directory_keep(&f.dir, 0), SLUICE_ERROR_LIMIT_EXCEEDED);
    slc_page_directory_unkeep(&f.dir, 0); /* is not kept */
    CHECK_OK(slc_page_directory_show(&f.dir, 70, 5, false));
    slc_page_directory_unkeep(&f.dir, 70);
    slc_page_directory_hide(&f.dir, 70);
    harness_run(h, record_few, &f);
    assert_int_equal(directory[2], 1);
    assert_int_equal(masks[1].resident, 0);
    slc_page_directory_unkeep(&f.dir, 71);
    harness_run(h, record_few, &f);
    assert_int_equal(directory[2], SLUICE_DEMAND_NO_BLOCK);
    slc_page_directory_finish(&f.dir);
    harness_buffer_finish(h, &f.directory);
    harness_buffer_finish(h, &f.masks);
    harness_check_silence(h);
}

/* Makes all allocating calls. Refused calls must change nothing. Returns true if none was
 * refused. */
static bool show_with_little_memory(struct directory_rig *r, uint64_t refuse_from)
{
    struct failing_allocator allocator;
    failing_allocator_init(&allocator, refuse_from);
    const struct slc_page_directory_create_info info = {1u << 14, 300, 2};
    struct slc_page_directory dir;
    SluiceResult result =
        slc_page_directory_init(&dir, &r->vk, &r->caps, &allocator.callbacks, &info);
    uint32_t shown = 0;
    if (result == SLUICE_SUCCESS) {
        for (; shown < 200 && result == SLUICE_SUCCESS; shown += result == SLUICE_SUCCESS)
            result = slc_page_directory_show(&dir, shown * 64, shown, false);
        for (uint32_t i = 0; i < 200; i++)
            assert_int_equal(slc_page_directory_has(&dir, i * 64), i < shown);
        for (uint32_t i = 0; i < shown; i++) /* hiding needs no memory */
            slc_page_directory_hide(&dir, i * 64);
        assert_false(slc_page_directory_has(&dir, 0));
    }
    slc_page_directory_finish(&dir);
    assert_int_equal(allocator.live_count, 0);
    if (result != SLUICE_SUCCESS)
        assert_int_equal(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    return result == SLUICE_SUCCESS;
}

static void without_host_memory_nothing_changes_and_hiding_works(void **state)
{
    struct directory_rig r = {.h = *state};
    demand_rig_init(r.h, &r.vk, &r.caps);
    uint64_t count = 0;
    while (!show_with_little_memory(&r, count))
        count++;
    assert_in_range(count, 15, 40);
    harness_check_silence(r.h);
}

static void without_device_memory_or_range_nothing_is_left(void **state)
{
    struct slc_vk vk;
    struct slc_caps caps;
    struct slc_page_directory dir;
    const struct slc_page_directory_create_info info = {1u << 20, 100, 2};
    demand_rig_init(*state, &vk, &caps);
    for (uint32_t count = 0; count < 4; count++) {
        demand_rig_limit_memory(&vk, count);
        CHECK_RESULT(slc_page_directory_init(&dir, &vk, &caps, &cb, &info),
                     SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
        assert_null(dir.directory.buffer);
        slc_page_directory_finish(&dir);
    }
    demand_rig_limit_memory(&vk, UINT32_MAX);
    caps.max_storage_buffer_range = (1u << 20) / 8 - 1;
    CHECK_RESULT(slc_page_directory_init(&dir, &vk, &caps, &cb, &info),
                 SLUICE_ERROR_LIMIT_EXCEEDED);
    harness_check_silence(*state);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    cb = slc_allocator(NULL);
    struct CMUnitTest tests[] = {
        cmocka_unit_test(the_device_shows_what_a_naive_table_shows),
        cmocka_unit_test(a_block_is_there_again_as_soon_as_its_last_page_is_hidden),
        cmocka_unit_test(a_block_that_is_kept_shows_nothing_and_stays),
        cmocka_unit_test(used_bits_arrive_whoever_has_the_blocks_by_then),
        cmocka_unit_test(nobody_inherits_the_used_bits_of_a_block),
        cmocka_unit_test(used_bits_of_an_empty_table_are_none),
        cmocka_unit_test(more_changes_than_a_slot_holds_make_it_grow_or_wait),
        cmocka_unit_test(nothing_is_dispatched_where_nothing_changed),
        cmocka_unit_test(sixty_four_mi_pages_have_both_ends_and_fit_into_64_megabytes),
        cmocka_unit_test(without_host_memory_nothing_changes_and_hiding_works),
        cmocka_unit_test(without_device_memory_or_range_nothing_is_left),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
