#include "device/scan_rig.h"

#include "support/roll.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#define GUARD 0xA5A5A5A5u
#define SECTION SLUICE_DEMAND_SECTION_PAGES

void scan_rig_init(struct scan_rig *r, struct harness *h, uint32_t section_count,
                   uint32_t list_capacity, uint32_t want_capacity)
{
    *r = (struct scan_rig){.h = h,
                           .page_capacity = section_count * SECTION,
                           .section_count = section_count,
                           .list_capacity = list_capacity,
                           .page_end = section_count * SECTION,
                           .capacity = list_capacity,
                           .want_capacity = want_capacity,
                           .clear = true,
                           .send_ranks = true};
    demand_rig_init(h, &r->vk, &r->caps);
    struct slc_demand_scan_create_info info = {r->page_capacity, SCAN_RIG_SLOTS, list_capacity};
    CHECK_OK(slc_demand_scan_init(&r->scan, &r->vk, &r->caps, &info));
    const VkBufferUsageFlags from = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                             to = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    harness_buffer_init(h, &r->requests, r->scan.requests.size, from);
    harness_buffer_init(h, &r->sections, r->scan.sections.size, from);
    harness_buffer_init(h, &r->requests_after, r->scan.requests.size, to);
    harness_buffer_init(h, &r->sections_after, r->scan.sections.size, to);
    memset(r->requests.mapped, 0, r->requests.size);
    memset(r->sections.mapped, 0, r->sections.size);
    r->ranks = demand_rig_allocate(section_count, 1);
    r->old = demand_rig_allocate(section_count, 1);
    r->wants = demand_rig_allocate(want_capacity, sizeof *r->wants);
}

void scan_rig_finish(struct scan_rig *r)
{
    slc_demand_scan_finish(&r->scan, &r->vk);
    harness_buffer_finish(r->h, &r->requests);
    harness_buffer_finish(r->h, &r->sections);
    harness_buffer_finish(r->h, &r->requests_after);
    harness_buffer_finish(r->h, &r->sections_after);
    free(r->ranks);
    free(r->old);
    free(r->wants);
    harness_check_silence(r->h);
}

bool scan_rig_bit(const struct harness_buffer *buffer, uint32_t bit)
{
    return ((const uint32_t *)buffer->mapped)[bit / 32] >> bit % 32 & 1;
}

void scan_rig_set_bit(struct harness_buffer *buffer, uint32_t bit, bool value)
{
    uint32_t *word = (uint32_t *)buffer->mapped + bit / 32;
    *word = value ? *word | 1u << bit % 32 : *word & ~(1u << bit % 32);
}

/* Requests a page like a shader. */
void scan_rig_request(struct scan_rig *r, uint32_t page)
{
    scan_rig_set_bit(&r->requests, page, true);
    scan_rig_set_bit(&r->sections, page / SECTION, true);
}

static int compare_wants(const void *a, const void *b)
{
    const struct scan_want *x = a, *y = b;
    if (x->age != y->age)
        return x->age < y->age ? -1 : 1;
    if (x->rank != y->rank)
        return x->rank < y->rank ? -1 : 1;
    return x->page < y->page ? -1 : x->page > y->page;
}

static void collect(struct scan_rig *r, uint32_t section)
{
    const struct scan_want first = {r->old[section] ? 0 : 1, r->ranks[section], section * SECTION};
    uint32_t before = r->want_count;
    for (uint32_t i = 0; i < SECTION; i++)
        if (scan_rig_bit(&r->requests, first.page + i)) {
            assert_true(r->want_count < r->want_capacity);
            r->wants[r->want_count] = first;
            r->wants[r->want_count++].page += i;
        }
    r->expected.sectionCount += r->want_count > before;
    r->old[section] = 0;
    scan_rig_set_bit(&r->sections, section, false);
}

/* Applies the expected scan to the list, and to requests, sections and ages. */
static void scan_by_sorting(struct scan_rig *r)
{
    r->expected = (struct SluiceDemandScanResult){0};
    r->want_count = 0;
    for (uint32_t s = 0; s < (r->page_end + SECTION - 1) / SECTION; s++)
        if (scan_rig_bit(&r->sections, s))
            collect(r, s);
    qsort(r->wants, r->want_count, sizeof *r->wants, compare_wants);
    uint32_t listed = r->want_count < r->capacity ? r->want_count : r->capacity;
    r->expected.listedCount = listed;
    r->expected.requestCount = r->want_count;
    r->expected.postponedCount = r->want_count - listed;
    for (uint32_t i = 0; i < r->want_count; i++)
        if (i < listed) {
            scan_rig_set_bit(&r->requests, r->wants[i].page, false);
        } else {
            scan_rig_set_bit(&r->sections, r->wants[i].page / SECTION, true);
            r->old[r->wants[i].page / SECTION] = 1;
        }
}

static void record_scan(void *user, VkCommandBuffer commands)
{
    struct scan_rig *r = user;
    if (r->clear)
        slc_demand_scan_record_clear(&r->scan, &r->vk, commands);
    if (r->send_ranks)
        slc_demand_scan_record_ranks(&r->scan, &r->vk, commands, r->ranks, 0, r->section_count);
    r->clear = r->send_ranks = false;
    demand_rig_record_upload(&r->vk, commands, &r->requests, &r->scan.requests);
    demand_rig_record_upload(&r->vk, commands, &r->sections, &r->scan.sections);
    /* Chooses one workgroup or several passes: results must be equal. */
    r->scan.section_count = 1;
    r->scan.one_group_sections = roll() % 2 ? UINT32_MAX : 0;
    slc_demand_scan_record(&r->scan, &r->vk, commands, r->slot, r->page_end, r->capacity);
    demand_rig_record_download(&r->vk, commands, &r->scan.requests, &r->requests_after);
    demand_rig_record_download(&r->vk, commands, &r->scan.sections, &r->sections_after);
}

static void check_list(struct scan_rig *r)
{
    const uint32_t *pages;
    struct SluiceDemandScanResult got = slc_demand_scan_result(&r->scan, r->slot, &pages);
    const struct SluiceDemandScanResult *e = &r->expected;
    if (memcmp(&got, e, sizeof got) != 0)
        fail_msg("%u of %u listed, %u sections, %u stay; expected %u of %u, %u, %u",
                 got.listedCount, got.requestCount, got.sectionCount, got.postponedCount,
                 e->listedCount, e->requestCount, e->sectionCount, e->postponedCount);
    for (uint32_t i = 0; i < got.listedCount; i++)
        if (pages[i] != r->wants[i].page)
            fail_msg("place %u of %u: page %u, expected %u", i, got.listedCount, pages[i],
                     r->wants[i].page);
    /* only required words are copied; other slots are unchanged */
    const uint32_t *words = r->scan.readback.mapped, *end = words + r->scan.readback.size / 4;
    for (const uint32_t *word = words; word < end; word++)
        if (word < pages - 4 || word >= pages + got.listedCount)
            assert_int_equal(*word, GUARD);
}

/* Lists the pages of a section that find room. Returns the number of others. */
static uint32_t list_section(struct scan_rig *r, uint32_t section)
{
    uint32_t left = 0;
    for (uint32_t page = section * SECTION; page < (section + 1) * SECTION; page++) {
        if (!scan_rig_bit(&r->requests, page))
            continue;
        if (r->want_count == r->capacity) {
            left++;
            continue;
        }
        r->wants[r->want_count++].page = page;
        scan_rig_set_bit(&r->requests, page, false);
    }
    return left;
}

/* Computes the expected scan by walking all ages, ranks and sections, for more requests than can be
 * sorted. */
static void scan_by_walking(struct scan_rig *r)
{
    uint8_t *left = demand_rig_allocate(r->section_count, 1);
    r->expected = (struct SluiceDemandScanResult){0};
    r->want_count = 0;
    for (uint32_t key = 0; key < 2 * SLUICE_DEMAND_RANKS; key++)
        for (uint32_t s = 0; s < r->section_count; s++) {
            uint32_t of_section = (r->old[s] ? 0u : SLUICE_DEMAND_RANKS) + r->ranks[s];
            if (of_section != key || !scan_rig_bit(&r->sections, s))
                continue;
            uint32_t stay = list_section(r, s);
            left[s] = stay > 0;
            r->expected.postponedCount += stay;
            r->expected.sectionCount++;
            scan_rig_set_bit(&r->sections, s, stay > 0);
        }
    memcpy(r->old, left, r->section_count);
    free(left);
    r->expected.listedCount = r->want_count;
    r->expected.requestCount = r->want_count + r->expected.postponedCount;
}

static void scan_with(struct scan_rig *r, void (*oracle)(struct scan_rig *r))
{
    r->slot = (r->slot + 1) % SCAN_RIG_SLOTS;
    memset(r->scan.readback.mapped, 0xA5, r->scan.readback.size);
    harness_run(r->h, record_scan, r);
    oracle(r);
    check_list(r);
    assert_memory_equal(r->requests_after.mapped, r->requests.mapped, r->requests.size);
    assert_memory_equal(r->sections_after.mapped, r->sections.mapped, r->sections.size);
}

void scan_rig_scan(struct scan_rig *r)
{
    scan_with(r, scan_by_sorting);
}

void scan_rig_scan_many(struct scan_rig *r)
{
    scan_with(r, scan_by_walking);
}
