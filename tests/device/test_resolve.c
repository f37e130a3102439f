/* Compares the resolve passes with brute force on the host, word by word. */
#include "device/harness.h"
#include "device/resolve_oracle.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"
#include "vulkan/resolve.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SLOTS 3u

struct rig {
    struct harness *h;
    struct slc_vk vk;
    struct slc_resolve resolve;
    struct harness_buffer feedback; ///< the host's copy, before and after each run
    struct slc_buffer gpu_feedback; ///< in the GPU's own memory, as in a streamer
    struct harness_buffer readback;
    uint32_t encoding, region_capacity, max_items, max_data;
    struct oracle_texture *textures;
    uint32_t texture_count;
    uint8_t *written, *reported; ///< all textures, by region
    struct oracle_item *items;
    uint32_t item_count, capacity, slot, data_count;
    struct SluiceResolveResult *results; ///< expected
    uint32_t *data;                      ///< expected
    const struct oracle_texture *fresh;  ///< texture whose record_new precedes the resolve
};

static void *allocate(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    assert_non_null(memory);
    return memory;
}

static void init_buffers(struct rig *r, const struct slc_caps *caps)
{
    uint64_t words =
        r->encoding == SLUICE_FEEDBACK_MASKS ? r->region_capacity / 2 : r->region_capacity;
    const VkBufferUsageFlags copied =
        VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    harness_buffer_init(r->h, &r->feedback, words * 4, copied);
    CHECK_OK(slc_buffer_init(&r->gpu_feedback, &r->vk, caps, words * 4,
                             copied | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, SLC_BUFFER_DEVICE));
    uint64_t slot = 4ull * r->max_items + r->max_data;
    harness_buffer_init(r->h, &r->readback, SLOTS * slot * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    memset(r->feedback.mapped, 0x5A, words * 4); /* new textures begin clean after any content */
}

static void rig_init(struct rig *r, struct harness *h, uint32_t encoding, uint32_t region_capacity,
                     uint32_t max_items)
{
    *r = (struct rig){.h = h,
                      .encoding = encoding,
                      .region_capacity = region_capacity,
                      .max_items = max_items,
                      .max_data = region_capacity / 4,
                      .capacity = region_capacity / 4};
    r->written = allocate(region_capacity, 1);
    r->reported = allocate(region_capacity, 1);
    r->textures = allocate(max_items, sizeof *r->textures);
    r->items = allocate(max_items, sizeof *r->items);
    r->results = allocate(max_items, sizeof *r->results);
    r->data = allocate(r->max_data + 1, sizeof *r->data);
    CHECK_OK(slc_vk_init_instance(&r->vk, h->instance, h->physical_device, h->get, NULL));
    CHECK_OK(slc_vk_init_device(&r->vk, h->device));
    struct slc_caps caps;
    slc_caps_init(&caps, &r->vk);
    init_buffers(r, &caps);
    struct slc_resolve_create_info info = {.feedback = r->gpu_feedback.buffer,
                                           .readback = r->readback.buffer,
                                           .region_capacity = region_capacity,
                                           .slot_count = SLOTS,
                                           .max_items = max_items,
                                           .encoding = encoding};
    CHECK_OK(slc_resolve_init(&r->resolve, &r->vk, &caps, &info));
}

static void rig_finish(struct rig *r)
{
    slc_resolve_finish(&r->resolve, &r->vk);
    slc_buffer_finish(&r->gpu_feedback, &r->vk);
    harness_buffer_finish(r->h, &r->feedback);
    harness_buffer_finish(r->h, &r->readback);
    free(r->written);
    free(r->reported);
    free(r->textures);
    free(r->items);
    free(r->results);
    free(r->data);
    harness_check_silence(r->h);
}

/* Marks a region like a shader: the finest of all levels counts. */
static void mark(struct rig *r, struct oracle_texture *t, uint32_t region, uint8_t level)
{
    uint32_t *words = r->feedback.mapped, at = t->first + region;
    if (r->encoding == SLUICE_FEEDBACK_MASKS)
        words[at / 2] |= 1u << (16 * (at % 2) + level);
    else
        words[at] = slc_min_u32(words[at], level);
    t->written[region] = (uint8_t)slc_min_u32(t->written[region], level);
}

static void clear_words(struct rig *r, uint32_t first, uint32_t count)
{
    uint32_t *words = r->feedback.mapped;
    for (uint32_t i = first; i < first + count; i++)
        if (r->encoding == SLUICE_FEEDBACK_MASKS)
            words[i / 2] &= i % 2 ? 0xFFFFu : 0xFFFF0000u;
        else
            words[i] = SLUICE_MIP_UNTOUCHED;
}

static void record_barrier(struct rig *r, VkCommandBuffer commands, VkPipelineStageFlags from,
                           VkAccessFlags written, VkPipelineStageFlags to, VkAccessFlags used)
{
    VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = written, .dstAccessMask = used};
    r->vk.CmdPipelineBarrier(commands, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

static void record_upload(struct rig *r, VkCommandBuffer commands)
{
    VkBufferCopy all = {0, 0, r->feedback.size};
    r->vk.CmdCopyBuffer(commands, r->feedback.buffer, r->gpu_feedback.buffer, 1, &all);
    record_barrier(r, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

static void record_download(struct rig *r, VkCommandBuffer commands)
{
    VkBufferCopy all = {0, 0, r->feedback.size};
    record_barrier(r, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    r->vk.CmdCopyBuffer(commands, r->gpu_feedback.buffer, r->feedback.buffer, 1, &all);
    record_barrier(r, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

static void record_resolve(struct rig *r, VkCommandBuffer commands)
{
    uint32_t slot = r->slot * (4 * r->max_items + r->max_data);
    for (uint32_t i = 0; i < r->item_count; i++)
        assert_true(slc_resolve_add(&r->resolve, r->items[i].texture->first,
                                    r->items[i].texture->count, r->items[i].flags));
    slc_resolve_record(&r->resolve, &r->vk, commands, slot, slot + 4 * r->max_items, r->capacity);
}

static void record(void *user, VkCommandBuffer commands)
{
    struct rig *r = user;
    record_upload(r, commands);
    record_resolve(r, commands);
    record_download(r, commands);
}

static void record_new(void *user, VkCommandBuffer commands)
{
    struct rig *r = user;
    slc_resolve_record_new(&r->resolve, &r->vk, commands, r->fresh->first, r->fresh->count);
}

static void begin_texture(struct rig *r, struct oracle_texture *t, uint32_t first, uint32_t count)
{
    *t = (struct oracle_texture){first, count, r->written + first, r->reported + first};
    memset(t->written, SLUICE_MIP_UNTOUCHED, count);
    memset(t->reported, SLUICE_MIP_UNTOUCHED, count);
    clear_words(r, first, count);
    r->fresh = t;
    harness_run(r->h, record_new, r);
}

static void add_texture(struct rig *r, uint32_t *next, uint32_t count)
{
    assert_true(r->texture_count < r->max_items && *next + count <= r->region_capacity);
    begin_texture(r, &r->textures[r->texture_count++], *next, count);
    *next += (count + 3) & ~3u;
}

static void check_words(struct rig *r)
{
    const uint32_t *words = r->feedback.mapped;
    for (uint32_t i = 0; i < r->texture_count; i++) {
        const struct oracle_texture *t = &r->textures[i];
        for (uint32_t j = 0; j < t->count; j++) {
            uint32_t at = t->first + j, level = words[at];
            if (r->encoding == SLUICE_FEEDBACK_MASKS) {
                uint32_t mask = words[at / 2] >> 16 * (at % 2) & 0xFFFF;
                for (level = 0; level < 16 && !(mask >> level & 1);)
                    level++;
                level = mask ? level : SLUICE_MIP_UNTOUCHED;
            }
            if (level != t->written[j])
                fail_msg("texture %u of %u regions, region %u: %u is left, expected %u", i,
                         t->count, j, level, t->written[j]);
        }
    }
}

/* Resolves r->items on the device and by brute force, and compares everything. */
static void resolve_and_compare(struct rig *r)
{
    r->slot = (r->slot + 1) % SLOTS;
    slc_resolve_begin(&r->resolve, r->slot);
    uint32_t *words = r->readback.mapped;
    words += r->slot * (4 * r->max_items + r->max_data);
    memset(words, 0xA5, 4ull * (4 * r->max_items + r->max_data));
    harness_run(r->h, record, r);
    r->data_count = oracle_resolve(r->items, r->item_count, r->capacity, r->results, r->data);
    for (uint32_t i = 0; i < r->item_count; i++) {
        struct SluiceResolveResult got;
        memcpy(&got, words + 4 * i, sizeof got);
        const struct SluiceResolveResult *e = &r->results[i];
        if (memcmp(&got, e, sizeof got) != 0)
            fail_msg("item %u of %u regions: state %u, %u words at %u, sum %x; expected state %u, "
                     "%u words at %u, sum %x",
                     i, r->items[i].texture->count, got.state, got.count, got.offset, got.checksum,
                     e->state, e->count, e->offset, e->checksum);
    }
    const uint32_t *data = words + 4 * r->max_items;
    assert_memory_equal(data, r->data, r->data_count * 4ull);
    for (uint32_t i = r->data_count; i < r->max_data; i++)
        assert_int_equal(data[i], 0xA5A5A5A5u); /* only required words are copied */
    check_words(r);
}

static void take_all(struct rig *r, uint32_t flags)
{
    r->item_count = r->texture_count;
    for (uint32_t i = 0; i < r->texture_count; i++)
        r->items[i] = (struct oracle_item){&r->textures[i], flags};
}

static void take_some(struct rig *r)
{
    r->item_count = 0;
    for (uint32_t i = 0; i < r->texture_count; i++)
        if (roll() % 3)
            r->items[r->item_count++] =
                (struct oracle_item){&r->textures[i], roll() % 16 ? 0u : SLUICE_RESOLVE_WHOLE};
    for (uint32_t i = r->item_count; i > 1; i--) { /* in any order */
        uint32_t j = (uint32_t)roll() % i;
        struct oracle_item item = r->items[i - 1];
        r->items[i - 1] = r->items[j];
        r->items[j] = item;
    }
}

/* Makes few changes, many, or none; often the last levels again. */
static void mark_some(struct rig *r)
{
    for (uint32_t i = 0; i < r->texture_count; i++) {
        struct oracle_texture *t = &r->textures[i];
        uint32_t kind = (uint32_t)roll() % 4, noise = kind == 0 ? 0 : kind == 1 ? 2 : t->count / 3;
        for (uint32_t j = 0; j < t->count && kind != 3; j++)
            if (t->reported[j] != SLUICE_MIP_UNTOUCHED)
                mark(r, t, j, t->reported[j]);
        for (uint32_t j = 0; j < noise; j++)
            mark(r, t, (uint32_t)roll() % t->count, (uint8_t)(roll() % 16));
    }
}

static const uint32_t counts[] = {1,   2,   3,   4,   5,   7,    8,    63,    64,   65,   128, 255,
                                  256, 257, 511, 512, 513, 1000, 4096, 65536, 4095, 1025, 6,   9};
enum { COUNTS = sizeof counts / sizeof counts[0] };

static uint32_t add_textures(struct rig *r, uint32_t count)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < count; i++)
        add_texture(r, &next, i < COUNTS ? counts[i] : 1 + (uint32_t)roll() % 400);
    return next;
}

static void changes_are_those_of_a_full_scan(struct harness *h, uint32_t encoding)
{
    struct rig r;
    roll_seed(51);
    rig_init(&r, h, encoding, 1u << 18, 300);
    add_textures(&r, 250);
    take_all(&r, 0);
    resolve_and_compare(&r); /* nothing was written, so nothing changes */
    assert_int_equal(r.data_count, 0);
    uint32_t states[3] = {0};
    for (uint32_t round = 0; round < 24; round++) {
        mark_some(&r);
        if (round % 4 == 0)
            take_all(&r, round % 8 ? 0 : SLUICE_RESOLVE_WHOLE);
        else
            take_some(&r);
        resolve_and_compare(&r);
        for (uint32_t i = 0; i < r.item_count; i++)
            states[r.results[i].state]++;
    }
    assert_int_equal(states[SLUICE_RESOLVED_NOTHING], 0);
    assert_true(states[SLUICE_RESOLVED_CHANGES] > 500 && states[SLUICE_RESOLVED_MAP] > 500);
    rig_finish(&r);
}

static void changes_of_levels_are_those_of_a_full_scan(void **state)
{
    changes_are_those_of_a_full_scan(*state, SLUICE_FEEDBACK_LEVELS);
}

static void changes_of_masks_are_those_of_a_full_scan(void **state)
{
    changes_are_those_of_a_full_scan(*state, SLUICE_FEEDBACK_MASKS);
}

static void what_has_no_room_stays_and_comes_later(void **state)
{
    struct rig r;
    roll_seed(52);
    rig_init(&r, *state, SLUICE_FEEDBACK_LEVELS, 1u << 18, 100);
    add_textures(&r, 100);
    uint32_t left = 0, overflows = 0;
    for (uint32_t round = 0; round < 40; round++) {
        if (round < 20)
            mark_some(&r);
        r.capacity = round < 20 ? (uint32_t)roll() % 20000 : 16384; /* in the end any item fits */
        take_all(&r, 0);
        if (round >= 20) /* waiting ones go first, as in the streamer */
            for (uint32_t i = 0, at = left; i < r.texture_count; i++, at++)
                r.items[i].texture = &r.textures[at % r.texture_count];
        resolve_and_compare(&r);
        uint32_t waiting = 0, first = UINT32_MAX;
        for (uint32_t i = 0; i < r.item_count; i++)
            if (r.results[i].state == SLUICE_RESOLVED_NOTHING && waiting++ == 0)
                first = (uint32_t)(r.items[i].texture - r.textures);
        overflows += waiting > 0;
        if (round == 39)
            assert_int_equal(waiting, 0);
        left = first == UINT32_MAX ? 0 : first;
    }
    assert_true(overflows > 15);
    for (uint32_t i = 0; i < r.texture_count; i++) /* all was reported */
        for (uint32_t j = 0; j < r.textures[i].count; j++)
            assert_int_equal(r.textures[i].written[j], SLUICE_MIP_UNTOUCHED);
    rig_finish(&r);
}

static void a_new_texture_begins_untouched_where_an_old_one_was(void **state)
{
    struct rig r;
    roll_seed(53);
    rig_init(&r, *state, SLUICE_FEEDBACK_LEVELS, 1u << 14, 32);
    uint32_t next = 0;
    for (uint32_t i = 0; i < 32; i++)
        add_texture(&r, &next, 512);
    for (uint32_t round = 0; round < 30; round++) {
        mark_some(&r);
        take_some(&r);
        resolve_and_compare(&r);
        struct oracle_texture *t = &r.textures[roll() % 32];
        begin_texture(&r, t, t->first, 1 + (uint32_t)roll() % 512);
    }
    rig_finish(&r);
}

static void segments_fill_more_than_one_row_of_workgroups(void **state)
{
    struct rig r;
    roll_seed(54);
    rig_init(&r, *state, SLUICE_FEEDBACK_LEVELS, 130u << 16, 130);
    uint32_t next = 0;
    for (uint32_t i = 0; i < 130; i++)
        add_texture(&r, &next, 65536);
    for (uint32_t i = 0; i < 100000; i++)
        mark(&r, &r.textures[roll() % 130], (uint32_t)roll() % 65536, (uint8_t)(roll() % 9));
    take_all(&r, 0);
    resolve_and_compare(&r);
    assert_true(r.resolve.segment_count > SLUICE_RESOLVE_ROW && r.data_count > 90000);
    rig_finish(&r);
}

/* Timer of a queue, which the harness has no other use for. */
struct watch {
    PFN_vkCreateQueryPool CreateQueryPool;
    PFN_vkDestroyQueryPool DestroyQueryPool;
    PFN_vkCmdResetQueryPool CmdResetQueryPool;
    PFN_vkCmdWriteTimestamp CmdWriteTimestamp;
    PFN_vkGetQueryPoolResults GetQueryPoolResults;
    VkQueryPool pool;
    double period; /* ns */
    struct rig *rig;
};

static void watch_init(struct watch *w, struct rig *r)
{
    *w = (struct watch){.rig = r};
    struct harness *h = r->h;
#define LOAD(name) w->name = (PFN_vk##name)h->GetDeviceProcAddr(h->device, "vk" #name)
    LOAD(CreateQueryPool);
    LOAD(DestroyQueryPool);
    LOAD(CmdResetQueryPool);
    LOAD(CmdWriteTimestamp);
    LOAD(GetQueryPoolResults);
#undef LOAD
    VkPhysicalDeviceProperties properties;
    h->GetPhysicalDeviceProperties(h->physical_device, &properties);
    w->period = (double)properties.limits.timestampPeriod;
    VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                  .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                  .queryCount = 2};
    assert_int_equal(w->CreateQueryPool(h->device, &info, NULL, &w->pool), VK_SUCCESS);
}

static void record_timed(void *user, VkCommandBuffer commands)
{
    struct watch *w = user;
    const VkPipelineStageFlagBits after_all = VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT;
    w->CmdResetQueryPool(commands, w->pool, 0, 2);
    record_upload(w->rig, commands);
    w->CmdWriteTimestamp(commands, after_all, w->pool, 0); /* starts after the upload */
    record_resolve(w->rig, commands);
    w->CmdWriteTimestamp(commands, after_all, w->pool, 1);
    record_download(w->rig, commands);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { TIMED = 21 };

/* Returns the median GPU time to resolve all textures after `marks` random marks, in
 * microseconds. */
static double time_resolve(struct watch *w, uint32_t marks)
{
    struct rig *r = w->rig;
    double times[TIMED];
    for (uint32_t i = 0; i < TIMED; i++) {
        for (uint32_t j = 0; j < marks; j++)
            mark(r, &r->textures[(uint32_t)roll() % r->texture_count], (uint32_t)roll() % 256,
                 (uint8_t)(roll() % 9));
        slc_resolve_begin(&r->resolve, 0);
        r->slot = 0;
        harness_run(r->h, record_timed, w);
        r->data_count = oracle_resolve(r->items, r->item_count, r->capacity, r->results, r->data);
        assert_memory_equal((uint32_t *)r->readback.mapped + 4 * r->max_items, r->data,
                            r->data_count * 4ull);
        uint64_t stamps[2];
        assert_int_equal(w->GetQueryPoolResults(r->h->device, w->pool, 0, 2, sizeof stamps, stamps,
                                                8, VK_QUERY_RESULT_64_BIT),
                         VK_SUCCESS);
        times[i] = (double)(stamps[1] - stamps[0]) * w->period * 1e-3;
    }
    qsort(times, TIMED, sizeof times[0], compare_doubles);
    return times[TIMED / 2];
}

/* 4096^2 BC7 has 16 x 16 tiles of level 0. */
static void a_thousand_textures_are_resolved_and_timed(void **state)
{
    struct rig r;
    roll_seed(55);
    rig_init(&r, *state, SLUICE_FEEDBACK_LEVELS, 256000, 1000);
    uint32_t next = 0;
    for (uint32_t i = 0; i < 1000; i++)
        add_texture(&r, &next, 256);
    struct watch watch;
    watch_init(&watch, &r);
    const uint32_t marks[] = {0, 2560, 25600, 256000};
    r.item_count = 0;
    fprintf(stderr, "# resolve of nothing, the floor: %.1f us\n", time_resolve(&watch, 0));
    take_all(&r, 0);
    for (size_t i = 0; i < sizeof marks / sizeof marks[0]; i++) {
        double time = time_resolve(&watch, marks[i]);
        fprintf(stderr,
                "# resolve of 1000 maps of 256 regions, %u marks, %u words come back: %.1f us\n",
                marks[i], r.data_count, time);
    }
    watch.DestroyQueryPool(r.h->device, watch.pool, NULL);
    rig_finish(&r);
}

static void the_list_refuses_what_it_has_no_room_for(void **state)
{
    struct rig r;
    rig_init(&r, *state, SLUICE_FEEDBACK_LEVELS, 1024, 2);
    slc_resolve_begin(&r.resolve, 0);
    assert_true(slc_resolve_add(&r.resolve, 0, 512, 0));
    assert_false(slc_resolve_add(&r.resolve, 512, 256 * 5, 0));
    assert_true(slc_resolve_add(&r.resolve, 512, 512, 0));
    assert_false(slc_resolve_add(&r.resolve, 512, 1, 0));
    slc_resolve_begin(&r.resolve, 1);
    assert_true(slc_resolve_add(&r.resolve, 512, 1, 0));
    rig_finish(&r);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(changes_of_levels_are_those_of_a_full_scan),
        cmocka_unit_test(changes_of_masks_are_those_of_a_full_scan),
        cmocka_unit_test(what_has_no_room_stays_and_comes_later),
        cmocka_unit_test(a_new_texture_begins_untouched_where_an_old_one_was),
        cmocka_unit_test(segments_fill_more_than_one_row_of_workgroups),
        cmocka_unit_test(a_thousand_textures_are_resolved_and_timed),
        cmocka_unit_test(the_list_refuses_what_it_has_no_room_for),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
