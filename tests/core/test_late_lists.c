#include "core/app_model.h"

/* Steps after which an application reads its lists and answers; 0: never. */
struct habits {
    uint32_t map, cancel, unmap, answer, complete, replace, defragment, release;
};

static void run(const struct habits *h, uint64_t seed, uint32_t steps,
                SluiceStreamedTextureStatistics *last)
{
    static struct app_model a;
    app_open(&a, seed);
    for (uint32_t step = 1; step <= steps; step++) {
        app_feed(&a);
        if (h->cancel && step % h->cancel == 0)
            app_read_cancel_list(&a);
        if (h->answer && step % h->answer == 0)
            app_answer(&a, 2);
        if (h->unmap && step % h->unmap == 0)
            app_read_unmap_list(&a);
        if (h->map && step % h->map == 0)
            app_read_map_list(&a);
        if (h->complete && step % h->complete == 0)
            app_complete(&a);
        if (h->replace && step % h->replace == 0)
            app_replace_texture(&a);
        if (h->defragment && step % h->defragment == 0)
            app_defragment(&a);
        if (h->release && step % h->release == 0)
            app_release_heaps(&a);
        app_check(&a);
    }
    *last = fixture_statistics(&a.f);
    app_close(&a);
}

static void nothing_is_lost_however_late_the_lists_are_read(void **state)
{
    (void)state;
    static const struct habits late[] = {
        {1, 1, 1, 1, 1, 9, 7, 5},    /* all of it in time */
        {2, 17, 13, 3, 5, 31, 9, 8}, /* each at a time of its own */
        {3, 40, 50, 1, 1, 70, 0, 0}, /* few unmap lists: the heaps stay full */
        {12, 1, 1, 2, 9, 60, 11, 3}, /* few map lists: requests pile up */
        {1, 1, 1, 12, 40, 45, 6, 4}, /* slow loads and a GPU far behind */
    };
    for (size_t i = 0; i < sizeof late / sizeof *late; i++) {
        uint64_t mapped = 0, unmapped = 0, canceled = 0, failed = 0;
        for (uint64_t seed = 1; seed <= 4; seed++) {
            SluiceStreamedTextureStatistics last = {.structSize = sizeof last};
            run(&late[i], seed, 300, &last);
            mapped += last.mappedTotal;
            unmapped += last.unmappedTotal;
            canceled += last.canceledTotal;
            failed += last.failedTotal;
        }
        /* Check that the runs had enough events to be meaningful. */
        assert_true(mapped > 100 && unmapped > 20 && canceled > 50 && failed > 50);
    }
}

static void nothing_is_lost_if_a_list_is_never_read(void **state)
{
    (void)state;
    static const struct habits never[] = {
        {1, 0, 1, 1, 1, 20, 9, 9}, /* canceled loads are answered without being listed */
        {1, 1, 0, 1, 1, 20, 9, 9}, /* nothing is unmapped */
        {1, 0, 0, 1, 0, 0, 9, 9},  /* nor does the GPU end, nor a texture go */
        {1, 1, 1, 0, 1, 20, 9, 9}, /* no load ends but by removal */
        {0, 1, 1, 1, 1, 20, 9, 9}, /* nothing is handed out */
    };
    for (size_t i = 0; i < sizeof never / sizeof *never; i++) {
        for (uint64_t seed = 1; seed <= 4; seed++) {
            SluiceStreamedTextureStatistics last = {.structSize = sizeof last};
            run(&never[i], seed, 200, &last);
            assert_int_equal(last.unmappedTotal > 0, i == 0);
            assert_int_equal(last.mappedTotal > 0, i < 3);
            assert_int_equal(last.handedOutTotal > 0, i < 4);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_lost_however_late_the_lists_are_read),
        cmocka_unit_test(nothing_is_lost_if_a_list_is_never_read),
    };
    return RUN_TESTS(tests);
}
