/* Changing content of produced textures and byte pages is written again in place. The old content
 * is visible until then. The oracle is the shader's function of texel and version. */
#include "device/demand_maker.h"

#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <string.h>

enum { WIDTH = 700, HEIGHT = 500, TILE = 128, LAUNCHES = 30 };

static struct harness h;

static void open_made(struct runner *r, struct demand_maker *m, uint64_t budget, uint32_t tiles)
{
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = budget, .maxTilesInFlight = tiles};
    runner_init(r, &h, &info);
    demand_maker_init(m, r, WIDTH, HEIGHT);
    demand_maker_add(m);
}

static void close_made(struct runner *r, struct demand_maker *m)
{
    runner_finish(r);
    demand_maker_finish(m);
}

/* A sample in each tile of all levels but the last, whose color the application provides. Tiles of
 * 64 KiB have 128x128 texels. */
struct probe {
    uint32_t level, x, y;
};
enum { PROBES = 64 };

static uint32_t add_probes(struct demand_maker *m, struct probe probes[PROBES])
{
    uint32_t count = 0;
    runner_clear(m->r);
    for (uint32_t level = 0; level < 9; level++)
        for (uint32_t y = 0; y < slc_mip_size(HEIGHT, level); y += TILE)
            for (uint32_t x = 0; x < slc_mip_size(WIDTH, level); x += TILE) {
                assert_true(count < PROBES);
                probes[count++] = (struct probe){level, x, y};
                demand_maker_add_texel(m, level, x, y);
            }
    return count;
}

static bool shows(const struct demand_maker *m, const struct probe *probes, uint32_t i,
                  uint32_t version)
{
    return demand_maker_shows(m, i, version, probes[i].level, probes[i].x, probes[i].y);
}

static void check_all(const struct demand_maker *m, const struct probe *probes, uint32_t count,
                      uint32_t version)
{
    for (uint32_t i = 0; i < count; i++)
        if (!shows(m, probes, i, version))
            fail_msg("level %u (%u, %u) is not of version %u", probes[i].level, probes[i].x,
                     probes[i].y, version);
}

static void launch(struct runner *r, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        runner_launch(r);
}

static void only_tiles_that_changed_are_made_again(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    struct probe probes[PROBES];
    open_made(&r, &m, 0, 0);
    uint32_t count = add_probes(&m, probes);
    runner_load(&r, LAUNCHES);
    check_all(&m, probes, count, 0);
    uint32_t made = m.made_count;
    m.maker.version = 1;
    /* texels 200 to 299 of 700: tiles 1 and 2; at level 1 (350) 100 to 149: tiles 0 and 1 */
    const SluiceImageRegion region = {0, 200, 130, 100, 20, 0};
    CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, &region, 2));
    launch(&r, 3);
    assert_int_equal(m.made_count - made, 2 + 2);
    assert_int_equal(runner_statistics(&r).remadeCount, 4);
    for (uint32_t i = 0; i < count; i++) {
        const struct probe *p = &probes[i];
        bool changed = (p->level == 0 && p->y == TILE && (p->x == TILE || p->x == 2 * TILE)) ||
                       (p->level == 1 && p->y == 0 && p->x < 2 * TILE);
        assert_true(shows(&m, probes, i, changed));
    }
    CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
    launch(&r, 3);
    check_all(&m, probes, count, 1);
    close_made(&r, &m);
}

/* In each launch every sample is resident and has one of both versions. */
static void the_old_content_is_seen_until_the_new_one_is_there(void **state)
{
    (void)state;
    for (uint32_t abandon = 0; abandon < 2; abandon++) {
        struct runner r;
        struct demand_maker m;
        struct probe probes[PROBES];
        open_made(&r, &m, 0, 8);
        uint32_t count = add_probes(&m, probes), old = 0;
        runner_load(&r, LAUNCHES);
        m.maker.version = 1;
        m.answer_level = 0;
        m.answer = SLUICE_NOT_READY;
        CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
        h.abandon_one_in = abandon ? 2 : 0;
        for (uint32_t i = 0; i < 60; i++) {
            if (i == 20)
                m.answer_level = UINT32_MAX;
            runner_launch(&r);
            for (uint32_t k = 0; k < count; k++) {
                assert_true(shows(&m, probes, k, 0) || shows(&m, probes, k, 1));
                old += shows(&m, probes, k, 0);
            }
        }
        h.abandon_one_in = 0;
        assert_true(old > 0);
        check_all(&m, probes, count, 1);
        assert_int_equal(runner_statistics(&r).failedCount, 0);
        close_made(&r, &m);
    }
}

static void tiles_under_way_are_made_again(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < 12; n++) {
        struct runner r;
        struct demand_maker m;
        struct probe probes[PROBES];
        open_made(&r, &m, 0, 0);
        uint32_t count = add_probes(&m, probes);
        h.abandon_one_in = n >= 6 ? 2 : 0;
        launch(&r, n % 6);
        CHECK_OK(runner_submit(&r)); /* not processed yet */
        m.maker.version = 1;
        CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
        CHECK_OK(sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, NULL));
        CHECK_OK(runner_submit(&r));
        m.maker.version = 2; /* again, perhaps while the last change is being made */
        CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
        CHECK_OK(sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, NULL));
        launch(&r, 8);
        h.abandon_one_in = 0;
        check_all(&m, probes, count, 2);
        close_made(&r, &m);
    }
}

/* More tiles than memory: tiles seen first can only be restored. */
static void evicted_tiles_come_back_new(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 4u << 20};
    runner_init(&r, &h, &info);
    demand_maker_init(&m, &r, 2048, 1024);
    demand_maker_add(&m);
    for (uint32_t round = 0; round < 3; round++) {
        runner_clear(&r);
        for (uint32_t i = 0; i < 40; i++)
            demand_maker_add_texel(&m, 0, round % 2 * 1024 + i % 8 * TILE, i / 8 * TILE);
        if (round == 2) {
            m.maker.version = 1;
            CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
        }
        runner_load(&r, LAUNCHES);
        launch(&r, 2);
        for (uint32_t i = 0; i < 40; i++)
            assert_true(demand_maker_shows(&m, i, m.maker.version, 0,
                                           round % 2 * 1024 + i % 8 * TILE, i / 8 * TILE));
    }
    assert_true(runner_statistics(&r).evictedCount > 0);
    close_made(&r, &m);
}

static void a_remake_that_fails_leaves_the_old_content_and_is_reported(void **state)
{
    (void)state;
    static const SluiceResult answers[] = {SLUICE_ERROR_IO, SLUICE_NOT_READY};
    for (uint32_t i = 0; i < 2; i++) {
        struct runner r;
        struct demand_maker m;
        const SluiceImageRegion region = {0, 0, 0, 1, 1, 0};
        runner_init(&r, &h, NULL);
        demand_maker_init(&m, &r, WIDTH, HEIGHT);
        m.timeout = 4;
        demand_maker_add(&m);
        demand_maker_add_texel(&m, 0, 9, 9);
        runner_load(&r, LAUNCHES);
        m.maker.version = 1;
        m.answer_level = 0;
        m.answer = answers[i];
        CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, &region, 1));
        uint32_t warnings = h.log_count[SLUICE_LOG_WARNING];
        h.quiet = true;
        launch(&r, 8);
        h.quiet = false;
        assert_int_equal(h.log_count[SLUICE_LOG_WARNING], warnings + 1);
        assert_non_null(strstr(h.last_message, "cannot be made again"));
        assert_int_equal(runner_statistics(&r).failedCount, 1);
        assert_true(demand_maker_shows(&m, 0, 0, 0, 9, 9));
        m.answer_level = UINT32_MAX;
        CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, &region, 1));
        launch(&r, 2);
        assert_true(demand_maker_shows(&m, 0, 1, 0, 9, 9));
        close_made(&r, &m);
    }
}

/* There are four jobs. A removed texture may take some with it. */
static void textures_removed_while_they_are_made_again_lose_no_job(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    struct probe probes[PROBES];
    open_made(&r, &m, 0, 4);
    for (uint32_t round = 0; round < 20; round++) {
        uint32_t count = add_probes(&m, probes);
        runner_load(&r, LAUNCHES);
        launch(&r, 2);
        check_all(&m, probes, count, 0);
        m.answer_level = round % 2 ? UINT32_MAX : 0;
        m.answer = SLUICE_NOT_READY;
        CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
        launch(&r, 1 + round % 3);
        if (round % 4 < 2) {
            CHECK_OK(sluiceRemoveDemandTexture(r.loader, m.id));
        } else {
            m.removes = true;
            if (round % 3)
                CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
        }
        launch(&r, 3);
        runner_clear(&r);
        demand_maker_finish(&m);
        demand_maker_init(&m, &r, WIDTH, HEIGHT);
        demand_maker_add(&m);
    }
    uint32_t count = add_probes(&m, probes);
    runner_load(&r, LAUNCHES);
    m.maker.version = 1;
    CHECK_OK(sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX));
    launch(&r, 2 * count);
    check_all(&m, probes, count, 1);
    close_made(&r, &m);
}

/* Byte pages filled with one word each. */
struct words {
    uint32_t version, first, made_count;
    SluiceDemandResourceId id;
};
enum { SIZE = 256, PAGES = 40 };

static SluiceResult record_pages(void *user, const SluiceBytePageBatch *batch,
                                 SluiceResult *answers)
{
    struct words *w = user;
    (void)answers;
    for (uint32_t i = 0; i < batch->pageCount; i++)
        h.CmdFillBuffer(batch->commandBuffer, batch->buffer, batch->pPages[i].offset, SIZE,
                        batch->pPages[i].page * 77 + w->version);
    w->made_count += batch->pageCount;
    return SLUICE_SUCCESS;
}

static bool words_show(const struct runner *r, uint32_t page, uint32_t version)
{
    uint32_t sum = 2166136261u, word = page * 77 + version;
    for (uint32_t i = 0; i < SIZE; i++)
        sum = (sum ^ (word >> i % 4 * 8 & 255)) * 16777619u;
    struct RunnerOutput out = runner_output(r, page);
    return out.resident && out.value[0] == sum;
}

static void open_words(struct runner *r, struct words *w, uint32_t limit)
{
    const SluiceDemandLoaderCreateInfo create = {.structSize = sizeof create,
                                                 .memoryBudget = 16u << 20};
    if (!h.reads_bytes)
        skip();
    h.runs_bytes = true;
    runner_init(r, &h, &create);
    *w = (struct words){0};
    const SluiceDemandResourceCreateInfo info = {.structSize = sizeof info,
                                                 .pageCount = PAGES,
                                                 .maxResidentPageCount = limit,
                                                 .pUserData = w,
                                                 .pageSize = SIZE,
                                                 .byteOffsets = true,
                                                 .pfnRecordPages = record_pages};
    CHECK_OK(sluiceAddDemandResource(r->loader, &info, &w->id, &w->first));
}

static void load_words(struct runner *r, const struct words *w, uint32_t first, uint32_t count)
{
    runner_clear(r);
    for (uint32_t page = first; page < first + count; page++)
        runner_add(r, (struct RunnerInput){
                          .kind = RUNNER_BYTES, .index = w->first + page, .dx = {(float)SIZE}});
    runner_load(r, LAUNCHES);
}

/* The limit evicts although slots are free: pages are restored without being written. */
static void evicted_pages_whose_slot_is_free_come_back_new(void **state)
{
    (void)state;
    enum { LIMIT = 10 };
    for (uint32_t changed = 0; changed < 2; changed++) {
        struct runner r;
        struct words w;
        open_words(&r, &w, LIMIT);
        load_words(&r, &w, 0, LIMIT);
        load_words(&r, &w, LIMIT, LIMIT);
        w.version = changed;
        if (changed)
            CHECK_OK(sluiceRemakeDemandPages(r.loader, w.id, 0, LIMIT));
        load_words(&r, &w, 0, LIMIT);
        for (uint32_t page = 0; page < LIMIT; page++)
            assert_true(words_show(&r, page, changed));
        assert_int_equal(runner_statistics(&r).restoredCount, changed ? 0 : LIMIT);
        runner_finish(&r);
    }
}

static void byte_pages_that_changed_are_made_again(void **state)
{
    (void)state;
    struct runner r;
    struct words w;
    open_words(&r, &w, 0);
    load_words(&r, &w, 0, PAGES);
    uint32_t made = w.made_count;
    w.version = 5;
    CHECK_OK(sluiceRemakeDemandPages(r.loader, w.id, 10, 7));
    launch(&r, 3);
    assert_int_equal(w.made_count - made, 7);
    for (uint32_t page = 0; page < PAGES; page++)
        assert_true(words_show(&r, page, page >= 10 && page < 17 ? 5 : 0));
    h.quiet = true;
    CHECK_RESULT(sluiceRemakeDemandPages(r.loader, w.id, 10, PAGES), SLUICE_ERROR_INVALID_ARGUMENT);
    h.quiet = false;
    CHECK_OK(sluiceRemoveDemandResource(r.loader, w.id));
    CHECK_RESULT(sluiceRemakeDemandPages(r.loader, w.id, 0, 1), SLUICE_ERROR_STALE_TEXTURE);
    runner_finish(&r);
}

static void wrong_areas_are_refused(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    struct runner_image image;
    SluiceImageRegion region = {0, 600, 400, 101, 100, 0};
    open_made(&r, &m, 0, 0);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 64, 64, 1);
    SluiceDemandTextureId read = runner_add_texture(&r, &image);
    h.quiet = true;
    CHECK_RESULT(sluiceRemakeDemandTiles(r.loader, m.id, &region, 1),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    region = (SluiceImageRegion){10, 0, 0, 1, 1, 0};
    CHECK_RESULT(sluiceRemakeDemandTiles(r.loader, m.id, &region, 1),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceRemakeDemandTiles(r.loader, read, NULL, 1), SLUICE_ERROR_INVALID_ARGUMENT);
    h.quiet = false;
    region = (SluiceImageRegion){0, UINT32_MAX, 0, 2, 1, 0};
    h.quiet = true;
    CHECK_RESULT(sluiceRemakeDemandTiles(r.loader, m.id, &region, 1),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    h.quiet = false;
    runner_finish(&r);
    runner_image_finish(&image);
    demand_maker_finish(&m);
}

static void without_host_memory_remakes_are_refused_and_come_later(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    struct probe probes[PROBES];
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    CHECK_OK(
        harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.pAllocator = &memory.callbacks}));
    open_made(&r, &m, 0, 0);
    uint32_t count = add_probes(&m, probes), refused = 0;
    runner_load(&r, LAUNCHES);
    m.maker.version = 1;
    SluiceResult result;
    do {
        memory.refuse_from = memory.calls + refused;
        result = sluiceRemakeDemandTiles(r.loader, m.id, NULL, UINT32_MAX);
        memory.refuse_from = UINT64_MAX;
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        launch(&r, 3);
        check_all(&m, probes, count, result == SLUICE_SUCCESS);
    } while (result != SLUICE_SUCCESS && ++refused < 20);
    CHECK_OK(result);
    assert_true(refused > 0);
    close_made(&r, &m);
    CHECK_OK(harness_set_context(&h, NULL));
    assert_int_equal(memory.live_count, 0);
}

static void without_host_memory_page_remakes_are_refused(void **state)
{
    (void)state;
    struct runner r;
    struct words w;
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    CHECK_OK(
        harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.pAllocator = &memory.callbacks}));
    open_words(&r, &w, 0);
    load_words(&r, &w, 0, PAGES);
    w.version = 5;
    memory.refuse_from = memory.calls;
    CHECK_RESULT(sluiceRemakeDemandPages(r.loader, w.id, 0, PAGES),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    memory.refuse_from = UINT64_MAX;
    launch(&r, 3);
    for (uint32_t page = 0; page < PAGES; page++)
        assert_true(words_show(&r, page, 0));
    CHECK_OK(sluiceRemakeDemandPages(r.loader, w.id, 0, PAGES));
    launch(&r, LAUNCHES);
    for (uint32_t page = 0; page < PAGES; page++)
        assert_true(words_show(&r, page, 5));
    runner_finish(&r);
    CHECK_OK(harness_set_context(&h, NULL));
    assert_int_equal(memory.live_count, 0);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_tiles_that_changed_are_made_again),
        cmocka_unit_test(the_old_content_is_seen_until_the_new_one_is_there),
        cmocka_unit_test(tiles_under_way_are_made_again),
        cmocka_unit_test(evicted_tiles_come_back_new),
        cmocka_unit_test(a_remake_that_fails_leaves_the_old_content_and_is_reported),
        cmocka_unit_test(textures_removed_while_they_are_made_again_lose_no_job),
        cmocka_unit_test(byte_pages_that_changed_are_made_again),
        cmocka_unit_test(evicted_pages_whose_slot_is_free_come_back_new),
        cmocka_unit_test(without_host_memory_remakes_are_refused_and_come_later),
        cmocka_unit_test(without_host_memory_page_remakes_are_refused),
        cmocka_unit_test(wrong_areas_are_refused),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
