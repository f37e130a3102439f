/* The words of the page table on the device against what its entries say. */
#include "vulkan/page_table.h"

#include "vulkan/context.h"
#include "vulkan/fake_vulkan.h"

#include "support/roll.h"
#include "support/test.h"

#include <sluice/shared/texture_table.h>

enum { PARTS = 4, WORDS = 2048, CHANGES = 64 };

static struct fake_vulkan fake; /* large */

struct rig {
    SluiceVulkanContext *context;
    struct slc_page_table table;
    bool used[PARTS];
    uint64_t frame;
};

static void init(struct rig *r)
{
    *r = (struct rig){0};
    fake = (struct fake_vulkan){.tail_page_count = 1};
    const SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(&fake);
    CHECK_OK(sluiceCreateVulkanContext(&info, &r->context));
    CHECK_OK(slc_page_table_init(&r->table, &r->context->vk, &r->context->caps, &r->context->cb,
                                 WORDS, PARTS, CHANGES));
    fake.watches[0].buffer = r->table.buffer.buffer;
}

static void finish(struct rig *r)
{
    slc_page_table_finish(&r->table);
    sluiceDestroyVulkanContext(r->context);
    assert_int_equal(fake.live_objects, 0);
}

static void add(struct rig *r, uint32_t part)
{
    const uint32_t sizes[][2] = {{1024, 1024}, {1000, 300}, {129, 1000}, {384, 384}};
    SluiceStreamedTextureDesc desc = {.width = sizes[roll() % 4][0],
                                      .height = sizes[roll() % 4][1],
                                      .tileWidth = FAKE_TILE,
                                      .tileHeight = FAKE_TILE,
                                      .regularMipCount = 2};
    r->used[part] = slc_page_table_add(&r->table, part, &desc) == SLUICE_SUCCESS;
    assert_true(r->used[part]);
}

static void change_tile(struct rig *r, uint32_t part)
{
    const struct slc_page_table_part *p = &r->table.parts[part];
    uint32_t width = (p->desc.width + FAKE_TILE - 1) / FAKE_TILE;
    uint32_t height = (p->desc.height + FAKE_TILE - 1) / FAKE_TILE;
    uint32_t x = (uint32_t)roll() % width, y = (uint32_t)roll() % height;
    uint32_t word = slc_page_table_word(&r->table, part, 0, x, y);
    uint32_t page = (uint32_t)roll() % 1024;
    const uint32_t entries[] = {page | SLC_PAGE_SHOWN, page | SLC_PAGE_SHOWN, page,
                                page | SLC_PAGE_GIVEN, SLUICE_PAGE_NONE};
    r->table.entries[word] = entries[roll() % 5];
    slc_page_table_store(&r->table, part, word, r->frame);
}

/* Checks the words that shaders read: the first word of each level, and a page or none per tile. */
static void check(const struct rig *r)
{
    const uint32_t *words = fake.watches[0].words;
    for (uint32_t i = 0; i < PARTS; i++) {
        const struct slc_page_table_part *p = &r->table.parts[i];
        if (!r->used[i])
            continue;
        uint32_t tiles = ((p->desc.width + 127) / 128) * ((p->desc.height + 127) / 128);
        assert_int_equal(words[p->first_word], p->first_word + 2);
        assert_int_equal(words[p->first_word + 1], p->first_word + 2 + tiles);
        for (uint32_t word = p->first_word + 2; word < p->first_word + p->word_count; word++) {
            uint32_t entry = r->table.entries[word];
            bool shown = !(entry & SLC_PAGE_GIVEN) && entry & SLC_PAGE_SHOWN;
            assert_int_equal(words[word],
                             shown ? entry & ~(uint32_t)SLC_PAGE_SHOWN : SLUICE_PAGE_NONE);
        }
    }
}

static void change(struct rig *r)
{
    uint32_t part = (uint32_t)roll() % PARTS;
    if (r->used[part] && roll() % 8 == 0) {
        slc_page_table_remove(&r->table, part);
        r->used[part] = false;
    } else if (!r->used[part] && r->table.store_count == 0) {
        add(r, part);
    }
}

/* Frames are recorded, some abandoned, some abandoned before anything was published. */
static void the_device_has_what_the_entries_say(void **state)
{
    (void)state;
    struct rig r;
    uint32_t abandoned = 0;
    init(&r);
    roll_seed(71);
    for (uint64_t step = 0; step < 3000; step++) {
        VkCommandBuffer commands = fake_vulkan_commands(&fake);
        r.frame++;
        fake_vulkan_mark(&fake);
        change(&r);
        for (int i = 0; i < CHANGES / 4; i++) {
            uint32_t part = (uint32_t)roll() % PARTS;
            if (r.used[part])
                change_tile(&r, part);
        }
        uint32_t fate = (uint32_t)roll() % 4;
        if (fate > 0) {
            slc_page_table_record_begin(&r.table, r.frame, commands);
            slc_page_table_record_publish(&r.table, commands);
        }
        if (fate > 1) {
            check(&r);
            continue;
        }
        fake_vulkan_undo(&fake);
        slc_page_table_abandon(&r.table, r.frame);
        abandoned++;
    }
    assert_in_range(abandoned, 1000, 2000);
    finish(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_device_has_what_the_entries_say),
    };
    return RUN_TESTS(tests);
}
