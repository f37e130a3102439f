#include "device/directory_rig.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include "use_pages_comp.h"

#define BLOCK SLUICE_DEMAND_BLOCK_PAGES

static void init_shader(struct directory_rig *r)
{
    const struct slc_compute_pass pass = {use_pages_comp, sizeof use_pages_comp, {0}};
    const struct slc_compute_create_info info = {
        .binding_count = 3, .push_size = 4, .set_count = 1, .passes = &pass, .pass_count = 1};
    CHECK_OK(slc_compute_init(&r->use, &r->vk, &info));
    const VkBuffer buffers[3] = {r->dir.directory.buffer, r->dir.masks.buffer, r->uses.buffer};
    slc_compute_set_buffers(&r->use, &r->vk, 0, buffers);
}

void directory_rig_init(struct directory_rig *r, struct harness *h,
                        const SluiceAllocationCallbacks *cb, uint32_t page_capacity,
                        uint32_t block_capacity)
{
    *r = (struct directory_rig){
        .h = h, .page_capacity = page_capacity, .block_capacity = block_capacity};
    demand_rig_init(h, &r->vk, &r->caps);
    struct slc_page_directory_create_info info = {page_capacity, block_capacity,
                                                  DIRECTORY_RIG_SLOTS};
    CHECK_OK(slc_page_directory_init(&r->dir, &r->vk, &r->caps, cb, &info));
    assert_int_equal(slc_page_directory_device_size(&info),
                     r->dir.directory.size + r->dir.blocks.size + r->dir.masks.size);
    const VkBufferUsageFlags to = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    harness_buffer_init(h, &r->directory, r->dir.directory.size, to);
    harness_buffer_init(h, &r->blocks, r->dir.blocks.size, to);
    harness_buffer_init(h, &r->masks, r->dir.masks.size, to);
    harness_buffer_init(h, &r->uses, DIRECTORY_RIG_USES * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    init_shader(r);
    r->pages = demand_rig_allocate(page_capacity, sizeof *r->pages);
    r->before = demand_rig_allocate(page_capacity, sizeof *r->before);
    r->group_counts = demand_rig_allocate(page_capacity / BLOCK, sizeof *r->group_counts);
    for (uint32_t i = 0; i < DIRECTORY_RIG_SLOTS; i++)
        r->used[i] = demand_rig_allocate(page_capacity, sizeof *r->used[i]);
}

void directory_rig_finish(struct directory_rig *r)
{
    slc_compute_finish(&r->use, &r->vk);
    slc_page_directory_finish(&r->dir);
    harness_buffer_finish(r->h, &r->directory);
    harness_buffer_finish(r->h, &r->blocks);
    harness_buffer_finish(r->h, &r->masks);
    harness_buffer_finish(r->h, &r->uses);
    free(r->pages);
    free(r->before);
    free(r->group_counts);
    for (uint32_t i = 0; i < DIRECTORY_RIG_SLOTS; i++)
        free(r->used[i]);
    harness_check_silence(r->h);
}

static bool show(struct directory_rig *r, uint32_t page, uint64_t value, bool wide)
{
    struct naive_page *p = &r->pages[page];
    uint32_t *count = &r->group_counts[page / BLOCK];
    if (*count == 0 && r->group_count == r->block_capacity)
        return false;
    r->group_count += *count == 0;
    *count += !p->there;
    *p = (struct naive_page){value, true, wide, p->used};
    return true;
}

void directory_rig_show(struct directory_rig *r, uint32_t page, uint64_t value, bool wide)
{
    SluiceResult expected =
        show(r, page, value, wide) ? SLUICE_SUCCESS : SLUICE_ERROR_LIMIT_EXCEEDED;
    CHECK_RESULT(slc_page_directory_show(&r->dir, page, value, wide), expected);
    assert_int_equal(slc_page_directory_has(&r->dir, page), r->pages[page].there);
}

void directory_rig_refuse(struct directory_rig *r, uint32_t page)
{
    SluiceResult expected = show(r, page, SLUICE_DEMAND_PAGE_REFUSED, false)
                                ? SLUICE_SUCCESS
                                : SLUICE_ERROR_LIMIT_EXCEEDED;
    CHECK_RESULT(slc_page_directory_refuse(&r->dir, page), expected);
}

void directory_rig_hide(struct directory_rig *r, uint32_t page)
{
    struct naive_page *p = &r->pages[page];
    uint32_t group = page / BLOCK;
    slc_page_directory_hide(&r->dir, page);
    assert_false(slc_page_directory_has(&r->dir, page));
    if (!p->there)
        return;
    p->there = false;
    if (--r->group_counts[group] > 0)
        return;
    r->group_count--;
    for (uint32_t i = 0; i < BLOCK; i++)
        r->pages[group * BLOCK + i].used = false;
}

static void record_changes(void *user, VkCommandBuffer commands)
{
    struct directory_rig *r = user;
    CHECK_OK(slc_page_directory_record(&r->dir, commands, r->slot));
    demand_rig_record_download(&r->vk, commands, &r->dir.directory, &r->directory);
    demand_rig_record_download(&r->vk, commands, &r->dir.blocks, &r->blocks);
    demand_rig_record_download(&r->vk, commands, &r->dir.masks, &r->masks);
}

static void check_page(const struct directory_rig *r, uint32_t page, uint32_t block)
{
    const struct naive_page *p = &r->pages[page];
    const struct SluiceDemandBlockMasks *masks =
        (const struct SluiceDemandBlockMasks *)r->masks.mapped + block;
    const uint32_t *words =
        (const uint32_t *)r->blocks.mapped + (size_t)block * SLUICE_DEMAND_BLOCK_WORDS;
    uint32_t at = page % BLOCK;
    if ((masks->resident >> at & 1) != p->there || (masks->used >> at & 1) != p->used)
        fail_msg("page %u, block %u: masks %x, %x; expected %d, %d", page, block, masks->resident,
                 masks->used, p->there, p->used);
    if (p->there && words[at] != (uint32_t)p->value)
        fail_msg("page %u: %x, expected %x", page, words[at], (uint32_t)p->value);
    if (p->there && p->wide && words[BLOCK + at] != (uint32_t)(p->value >> 32))
        fail_msg("page %u: high word %x, expected %x", page, words[BLOCK + at],
                 (uint32_t)(p->value >> 32));
}

static void check_device(const struct directory_rig *r)
{
    const uint32_t *directory = r->directory.mapped;
    bool *taken = demand_rig_allocate(r->block_capacity + 1, sizeof *taken);
    for (uint32_t group = 0; group < r->page_capacity / BLOCK; group++) {
        uint32_t block = directory[group];
        assert_int_equal(block != SLUICE_DEMAND_NO_BLOCK, r->group_counts[group] > 0);
        if (block == SLUICE_DEMAND_NO_BLOCK)
            continue;
        assert_true(block <= r->block_capacity && !taken[block]);
        taken[block] = true;
        for (uint32_t i = 0; i < BLOCK; i++)
            check_page(r, group * BLOCK + i, block);
    }
    free(taken);
}

void directory_rig_recorded(struct directory_rig *r)
{
    memcpy(r->before, r->pages, r->page_capacity * sizeof *r->pages);
}

void directory_rig_record(struct directory_rig *r)
{
    harness_run(r->h, record_changes, r);
    directory_rig_recorded(r);
    check_device(r);
}

static void record_uses(void *user, VkCommandBuffer commands)
{
    struct directory_rig *r = user;
    slc_compute_bind(&r->use, &r->vk, commands, 0, &r->use_count);
    slc_compute_dispatch(&r->use, &r->vk, commands, 0, (r->use_count + 63) / 64, 1);
}

static void record_uses_and_take(void *user, VkCommandBuffer commands)
{
    struct directory_rig *r = user;
    record_uses(r, commands);
    slc_page_directory_record_used(&r->dir, commands, r->slot);
}

void directory_rig_launch(struct directory_rig *r, bool takes)
{
    const uint32_t *uses = r->uses.mapped;
    harness_run(r->h, takes ? record_uses_and_take : record_uses, r);
    for (uint32_t i = 0; i < r->use_count; i++)
        if (r->before[uses[i]].there) {
            r->before[uses[i]].used = true;
            r->pages[uses[i]].used = true;
        }
    for (uint32_t i = 0; i < r->page_capacity && takes; i++) {
        r->used[r->slot][i] = r->before[i].used;
        r->before[i].used = r->pages[i].used = false;
    }
}

void directory_rig_check_used(struct directory_rig *r, uint32_t slot)
{
    struct slc_page_used_iterator iterator = {0};
    bool *seen = demand_rig_allocate(r->page_capacity, sizeof *seen);
    uint32_t page;
    while (slc_page_directory_next_used(&r->dir, slot, &iterator, &page)) {
        assert_true(page < r->page_capacity && !seen[page]);
        seen[page] = true;
    }
    assert_false(slc_page_directory_next_used(&r->dir, slot, &iterator, &page));
    for (uint32_t i = 0; i < r->page_capacity; i++)
        if (seen[i] != r->used[slot][i])
            fail_msg("page %u: used %d, expected %d", i, seen[i], r->used[slot][i]);
    free(seen);
}
