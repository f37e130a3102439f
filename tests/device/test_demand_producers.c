/* Tiles and byte pages of a demand loader that commands of the application write. The oracle is the
 * function that the shader computes, on the host. */
#include "device/demand_maker.h"

#include "support/test.h"

#include <stdio.h>
#include <string.h>

enum { WIDTH = 700, HEIGHT = 500, STEP = 9, LAUNCHES = 30 };

static struct harness h;

static void open_loader(struct runner *r, uint64_t budget, uint32_t tiles_in_flight)
{
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = budget, .maxTilesInFlight = tiles_in_flight};
    runner_init(r, &h, &info);
}

static void check_equal_to_twin(uint32_t abandon_one_in, uint32_t tiles_in_flight)
{
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, tiles_in_flight);
    demand_maker_init(&m, &r, WIDTH, HEIGHT);
    /* Memory may hold the texels of the test before. */
    m.maker.version = 1 + tiles_in_flight + abandon_one_in;
    demand_maker_add(&m);
    demand_maker_sample(&m, STEP);
    h.abandon_one_in = abandon_one_in;
    uint32_t launches = runner_load(&r, LAUNCHES);
    h.abandon_one_in = 0;
    assert_true(launches < LAUNCHES);
    demand_maker_check(&m, STEP);
    SluiceDemandStatistics s = runner_statistics(&r);
    assert_int_equal(s.bytesRead, 0);
    assert_int_equal(s.bytesUploaded, 0);
    assert_int_equal(s.failedCount, 0);
    assert_true(s.producedCount > 30);
    assert_int_equal(s.producedCount, s.residentTileCount);
    runner_finish(&r);
    demand_maker_finish(&m);
}

static void texels_are_those_of_the_host_twin(void **state)
{
    (void)state;
    check_equal_to_twin(0, 0);
}

static void abandoned_launches_lose_no_tile(void **state)
{
    (void)state;
    check_equal_to_twin(2, 8); /* in many launches */
}

static void few_jobs_make_all_tiles_in_more_launches(void **state)
{
    (void)state;
    check_equal_to_twin(0, 4);
}

/* More tiles than memory holds, looked at in turns. */
static void evicted_tiles_are_made_again(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 4u << 20, 0);
    demand_maker_init(&m, &r, 2048, 2048);
    demand_maker_add(&m);
    for (uint32_t round = 0; round < 8; round++) {
        runner_clear(&r);
        uint32_t left = round % 2 * 1024, top = round / 2 % 2 * 1024;
        for (uint32_t i = 0; i < 48; i++)
            demand_maker_add_texel(&m, 0, left + i % 8 * 128, top + i / 8 * 128 + i);
        runner_load(&r, LAUNCHES);
        for (uint32_t i = 0; i < 48; i++)
            assert_true(demand_maker_shows(&m, i, 0, 0, left + i % 8 * 128, top + i / 8 * 128 + i));
    }
    SluiceDemandStatistics s = runner_statistics(&r);
    assert_true(s.evictedCount > 100);
    assert_true(s.producedCount > 200);
    runner_finish(&r);
    demand_maker_finish(&m);
}

static void a_tile_that_fails_shows_a_coarser_level_and_is_reported(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, 0);
    demand_maker_init(&m, &r, WIDTH, HEIGHT);
    demand_maker_add(&m);
    m.answer_level = 0;
    m.answer = SLUICE_ERROR_IO;
    demand_maker_add_texel(&m, 1, 9, 9);
    demand_maker_add_texel(&m, 0, 18, 18);
    uint32_t warnings = h.log_count[SLUICE_LOG_WARNING];
    h.quiet = true;
    runner_load(&r, LAUNCHES);
    h.quiet = false;
    assert_int_equal(h.log_count[SLUICE_LOG_WARNING], warnings + 1);
    assert_non_null(strstr(h.last_message, "cannot be made"));
    assert_int_equal(runner_statistics(&r).failedCount, 1);
    assert_true(demand_maker_shows(&m, 0, 0, 1, 9, 9));
    assert_true(demand_maker_shows(&m, 1, 0, 1, 9, 9)); /* the coarser level */
    m.answer_level = UINT32_MAX;
    CHECK_OK(sluiceRetryDemandTexture(r.loader, m.id));
    runner_load(&r, LAUNCHES);
    assert_true(demand_maker_shows(&m, 1, 0, 0, 18, 18));
    runner_finish(&r);
    demand_maker_finish(&m);
}

static void a_tile_that_is_never_ready_fails_after_its_timeout(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, 0);
    demand_maker_init(&m, &r, WIDTH, HEIGHT);
    m.timeout = 5;
    demand_maker_add(&m);
    m.answer_level = 0;
    m.answer = SLUICE_NOT_READY;
    demand_maker_add_texel(&m, 0, 18, 18);
    h.quiet = true;
    for (uint32_t i = 0; i < 12; i++)
        runner_launch(&r);
    h.quiet = false;
    assert_int_equal(r.requests.missingCount, 0); /* refused: it is not asked for any more */
    assert_int_equal(runner_statistics(&r).failedCount, 1);
    runner_finish(&r);
    demand_maker_finish(&m);
}

/* The first answers are late. */
static void a_tile_that_is_not_ready_comes_later(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, 0);
    demand_maker_init(&m, &r, WIDTH, HEIGHT);
    demand_maker_add(&m);
    m.answer_level = 0;
    m.answer = SLUICE_NOT_READY;
    demand_maker_add_texel(&m, 0, 18, 18);
    for (uint32_t i = 0; i < 8; i++)
        runner_launch(&r);
    assert_false(runner_output(&r, 0).resident);
    m.answer_level = UINT32_MAX;
    runner_load(&r, LAUNCHES);
    assert_true(demand_maker_shows(&m, 0, 0, 0, 18, 18));
    assert_int_equal(runner_statistics(&r).failedCount, 0);
    runner_finish(&r);
    demand_maker_finish(&m);
}

/* The levels lie in one page. Some are recorded before one fails. */
static void a_mip_tail_that_fails_half_way_shows_the_failure_color(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, 0);
    demand_maker_init(&m, &r, WIDTH, HEIGHT);
    demand_maker_add(&m);
    m.answer_level = 6;
    m.answer = SLUICE_ERROR_IO;
    demand_maker_add_texel(&m, 5, 3, 3);
    h.quiet = true;
    runner_load(&r, LAUNCHES);
    h.quiet = false;
    struct RunnerOutput out = runner_output(&r, 0);
    assert_true(out.resident && out.color[0] == 1 && out.color[1] == 0 && out.color[2] == 1);
    assert_int_equal(runner_statistics(&r).residentTileCount, 0);
    m.answer_level = UINT32_MAX;
    CHECK_OK(sluiceRetryDemandTexture(r.loader, m.id));
    runner_load(&r, LAUNCHES);
    assert_true(demand_maker_shows(&m, 0, 0, 5, 3, 3));
    runner_finish(&r);
    demand_maker_finish(&m);
}

/* There are four jobs. One that is lost would be missed after a few textures. */
static void removing_the_texture_in_its_callback_loses_no_job(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, 4);
    for (uint32_t round = 0; round < 13; round++) {
        bool last = round == 12;
        runner_clear(&r);
        demand_maker_init(&m, &r, WIDTH, HEIGHT);
        demand_maker_add(&m);
        demand_maker_sample(&m, 60);
        m.answer_level = round % 3 ? 0 : UINT32_MAX;
        m.answer = round % 3 == 1 ? SLUICE_NOT_READY : SLUICE_ERROR_IO;
        for (uint32_t i = 0; i < 4 + round % 4 && !last; i++)
            runner_launch(&r);
        m.removes = !last;
        h.quiet = true;
        if (last)
            m.answer_level = UINT32_MAX;
        runner_load(&r, last ? LAUNCHES : 4);
        h.quiet = false;
        if (last)
            demand_maker_check(&m, 60);
        assert_int_equal(h.DeviceWaitIdle(h.device), VK_SUCCESS);
        if (!last)
            demand_maker_finish(&m);
    }
    runner_finish(&r);
    demand_maker_finish(&m);
}

static void a_texture_removed_while_its_tiles_are_made_loses_no_job(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, 4);
    for (uint32_t round = 0; round < 12; round++) {
        demand_maker_init(&m, &r, WIDTH, HEIGHT);
        demand_maker_add(&m);
        demand_maker_sample(&m, 60);
        for (uint32_t i = 0; i < 1 + round % 6; i++)
            runner_launch(&r);
        CHECK_OK(sluiceRemoveDemandTexture(r.loader, m.id));
        uint32_t asked = m.asked_count;
        runner_launch(&r);
        assert_int_equal(m.asked_count, asked);
        runner_clear(&r);
        demand_maker_finish(&m);
    }
    demand_maker_init(&m, &r, WIDTH, HEIGHT);
    demand_maker_add(&m);
    demand_maker_sample(&m, STEP);
    runner_load(&r, LAUNCHES);
    demand_maker_check(&m, STEP);
    runner_finish(&r);
    demand_maker_finish(&m);
}

/* Byte pages: each is filled with one word. */
struct words {
    uint32_t size, version;
    uint32_t failing_page, late_page; ///< UINT32_MAX: none
    uint32_t made_count;
    bool removes;
    struct runner *r;
    SluiceDemandResourceId id;
    uint32_t first;
};

static uint32_t word_of(const struct words *w, uint32_t page)
{
    return (page + 1) * 2654435761u + w->version * 977u;
}

static SluiceResult record_pages(void *user, const SluiceBytePageBatch *batch,
                                 SluiceResult *answers)
{
    struct words *w = user;
    assert_int_equal(batch->structSize, sizeof *batch);
    assert_int_equal(batch->resourceId, w->id);
    assert_int_equal(batch->pageSize, w->size);
    for (uint32_t i = 0; i < batch->pageCount; i++) {
        const SluiceBytePageTarget *page = &batch->pPages[i];
        assert_true(page->address % 16 == 0 && page->offset % 16 == 0);
        if (page->page == w->failing_page)
            answers[i] = SLUICE_ERROR_IO;
        else if (page->page == w->late_page)
            answers[i] = SLUICE_NOT_READY;
        else
            h.CmdFillBuffer(batch->commandBuffer, batch->buffer, page->offset, w->size,
                            word_of(w, page->page));
        w->made_count += answers[i] == SLUICE_SUCCESS;
    }
    if (w->removes)
        CHECK_OK(sluiceRemoveDemandResource(w->r->loader, w->id));
    return SLUICE_SUCCESS;
}

static void words_add(struct words *w, struct runner *r, uint32_t size)
{
    *w = (struct words){.size = size, .failing_page = UINT32_MAX, .late_page = UINT32_MAX, .r = r};
    const SluiceDemandResourceCreateInfo info = {.structSize = sizeof info,
                                                 .pageCount = 1000,
                                                 .pUserData = w,
                                                 .pageSize = size,
                                                 .byteOffsets = true,
                                                 .pfnRecordPages = record_pages,
                                                 .timeoutLaunches = 4};
    CHECK_OK(sluiceAddDemandResource(r->loader, &info, &w->id, &w->first));
}

static void words_sample(struct words *w, uint32_t page)
{
    runner_add(w->r, (struct RunnerInput){
                         .kind = RUNNER_BYTES, .index = w->first + page, .dx = {(float)w->size}});
}

/* Returns whether a sample found the page's word in all its bytes. */
static bool words_show(const struct words *w, uint32_t sample, uint32_t page)
{
    uint32_t sum = 2166136261u, word = word_of(w, page);
    for (uint32_t i = 0; i < w->size; i++)
        sum = (sum ^ (word >> i % 4 * 8 & 255)) * 16777619u;
    struct RunnerOutput out = runner_output(w->r, sample);
    return out.resident && out.value[0] == sum;
}

static void open_bytes(struct runner *r)
{
    if (!h.reads_bytes)
        skip();
    h.runs_bytes = true;
    open_loader(r, 16u << 20, 0);
}

static void byte_pages_are_what_commands_wrote(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {16, 4000, 65536, 131072};
    for (uint32_t i = 0; i < 4; i++) {
        struct runner r;
        struct words w;
        open_bytes(&r);
        words_add(&w, &r, sizes[i]);
        for (uint32_t page = 0; page < 8; page++)
            words_sample(&w, page * 100);
        h.abandon_one_in = i % 2 ? 2 : 0;
        assert_true(runner_load(&r, LAUNCHES) < LAUNCHES);
        h.abandon_one_in = 0;
        for (uint32_t page = 0; page < 8; page++)
            assert_true(words_show(&w, page, page * 100));
        SluiceDemandStatistics s = runner_statistics(&r);
        assert_int_equal(s.bytesRead + s.bytesUploaded, 0);
        assert_int_equal(s.producedCount, 8);
        assert_int_equal(s.residentBytePageCount, 8);
        runner_finish(&r);
    }
}

static void byte_pages_that_fail_are_missing_and_reported(void **state)
{
    (void)state;
    struct runner r;
    struct words w;
    open_bytes(&r);
    words_add(&w, &r, 4000);
    w.failing_page = 1;
    w.late_page = 2;
    for (uint32_t page = 0; page < 3; page++)
        words_sample(&w, page);
    uint32_t warnings = h.log_count[SLUICE_LOG_WARNING];
    h.quiet = true;
    for (uint32_t i = 0; i < 10; i++)
        runner_launch(&r);
    h.quiet = false;
    assert_true(words_show(&w, 0, 0));
    assert_false(runner_output(&r, 1).resident);
    assert_false(runner_output(&r, 2).resident);
    assert_int_equal(h.log_count[SLUICE_LOG_WARNING], warnings + 1);
    assert_int_equal(runner_statistics(&r).failedCount, 2);
    w.failing_page = w.late_page = UINT32_MAX;
    CHECK_OK(sluiceRetryDemandTexture(r.loader, SLUICE_ALL_DEMAND_TEXTURES));
    runner_load(&r, LAUNCHES);
    for (uint32_t page = 0; page < 3; page++)
        assert_true(words_show(&w, page, page));
    runner_finish(&r);
}

static void invalidated_and_set_pages_are_not_those_that_were_under_way(void **state)
{
    (void)state;
    uint32_t set_count = 0;
    for (uint32_t after = 1; after < 5; after++) {
        struct runner r;
        struct words w;
        static uint8_t bytes[4000];
        open_bytes(&r);
        words_add(&w, &r, sizeof bytes);
        words_sample(&w, 7);
        words_sample(&w, 8);
        for (uint32_t i = 0; i < after; i++)
            runner_launch(&r);
        w.version++;
        CHECK_OK(sluiceInvalidateDemandPages(r.loader, w.id, 7, 1));
        SluiceResult set = sluiceSetDemandPageBytes(r.loader, w.id, 8, bytes, false);
        assert_true(set == SLUICE_SUCCESS || set == SLUICE_NOT_READY); /* it is being written */
        runner_load(&r, LAUNCHES);
        assert_true(words_show(&w, 0, 7));
        bool made = words_show(&w, 1, 8);
        w.version--;
        made |= words_show(&w, 1, 8);
        assert_int_equal(made, set != SLUICE_SUCCESS);
        set_count += set == SLUICE_SUCCESS;
        runner_finish(&r);
    }
    assert_true(set_count > 0 && set_count < 4);
}

static void removing_the_resource_in_its_callback_loses_no_job(void **state)
{
    (void)state;
    struct runner r;
    struct words w[8];
    open_bytes(&r);
    for (uint32_t i = 0; i < 8; i++) {
        runner_clear(&r);
        words_add(&w[i], &r, 4000);
        w[i].removes = i < 7;
        for (uint32_t page = 0; page < 40; page++)
            words_sample(&w[i], page);
        runner_load(&r, i < 7 ? 4 : LAUNCHES);
    }
    for (uint32_t page = 0; page < 40; page++)
        assert_true(words_show(&w[7], page, page));
    assert_int_equal(runner_statistics(&r).residentBytePageCount, 40);
    runner_finish(&r);
}

static void wrong_producers_are_refused(void **state)
{
    (void)state;
    struct runner r;
    struct demand_maker m;
    open_loader(&r, 0, 0);
    demand_maker_init(&m, &r, 64, 64);
    SluiceTileProducer producer = maker_producer(&m.maker, &m.info);
    SluiceDemandTextureCreateInfo info = {.structSize = sizeof info, .pProducer = &producer};
    SluiceDemandTextureId id;
    h.quiet = true;
    m.info.width = 0;
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &info, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    m.info.width = 64;
    m.info.format = SLUICE_FORMAT_R32_UINT;
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &info, &id), SLUICE_ERROR_UNSUPPORTED);
    m.info.format = SLUICE_FORMAT_R8G8B8A8_UNORM;
    producer.pfnRecordTiles = NULL;
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &info, &id), SLUICE_ERROR_NULL_POINTER);
    struct runner_image image;
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 64, 64, 1);
    producer = maker_producer(&m.maker, &m.info);
    info.image = runner_image_desc(&image);
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &info, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceDemandResourceCreateInfo pages = {
        .structSize = sizeof pages, .pageCount = 1, .pfnRecordPages = record_pages};
    SluiceDemandResourceId resource;
    uint32_t first;
    CHECK_RESULT(sluiceAddDemandResource(r.loader, &pages, &resource, &first),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    h.quiet = false;
    runner_image_finish(&image);
    runner_finish(&r);
    demand_maker_finish(&m);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_those_of_the_host_twin),
        cmocka_unit_test(abandoned_launches_lose_no_tile),
        cmocka_unit_test(few_jobs_make_all_tiles_in_more_launches),
        cmocka_unit_test(evicted_tiles_are_made_again),
        cmocka_unit_test(a_tile_that_fails_shows_a_coarser_level_and_is_reported),
        cmocka_unit_test(a_tile_that_is_never_ready_fails_after_its_timeout),
        cmocka_unit_test(a_tile_that_is_not_ready_comes_later),
        cmocka_unit_test(a_mip_tail_that_fails_half_way_shows_the_failure_color),
        cmocka_unit_test(removing_the_texture_in_its_callback_loses_no_job),
        cmocka_unit_test(a_texture_removed_while_its_tiles_are_made_loses_no_job),
        cmocka_unit_test(byte_pages_are_what_commands_wrote),
        cmocka_unit_test(byte_pages_that_fail_are_missing_and_reported),
        cmocka_unit_test(invalidated_and_set_pages_are_not_those_that_were_under_way),
        cmocka_unit_test(removing_the_resource_in_its_callback_loses_no_job),
        cmocka_unit_test(wrong_producers_are_refused),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
