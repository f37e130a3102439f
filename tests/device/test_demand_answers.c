/* Pages that the application answers: listed once and in order, answered late or never, withdrawn,
 * set before they are missed, and pinned. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <stdatomic.h>
#include <string.h>

static struct harness h;

enum { PAGES = 2000, SIZE = 3000 };

struct app {
    SluiceDemandResourceId id;
    uint32_t first;
    uint64_t evicted[64];
    uint32_t evicted_count;
    atomic_bool blocked; ///< true: fills return NOT_READY
    atomic_uint fills;
};

static void on_evict(void *user, uint32_t page, uint64_t value)
{
    struct app *app = user;
    (void)page;
    if (app->evicted_count < 64)
        app->evicted[app->evicted_count] = value;
    app->evicted_count++;
}

static SluiceResult fill(void *user, uint32_t page, uint64_t *value)
{
    struct app *app = user;
    atomic_fetch_add(&app->fills, 1);
    *value = page;
    return atomic_load(&app->blocked) ? SLUICE_NOT_READY : SLUICE_SUCCESS;
}

static void add_values(struct runner *r, struct app *app, uint32_t limit, bool filled)
{
    const SluiceDemandResourceCreateInfo info = {.structSize = sizeof info,
                                                 .pageCount = PAGES,
                                                 .maxResidentPageCount = limit,
                                                 .pUserData = app,
                                                 .pfnFill = filled ? fill : NULL,
                                                 .pfnEvict = on_evict};
    *app = (struct app){0};
    CHECK_OK(sluiceAddDemandResource(r->loader, &info, &app->id, &app->first));
}

static void add_bytes(struct runner *r, struct app *app, uint32_t size)
{
    const SluiceDemandResourceCreateInfo info = {
        .structSize = sizeof info, .pageCount = PAGES, .pUserData = app, .pageSize = size};
    *app = (struct app){0};
    CHECK_OK(sluiceAddDemandResource(r->loader, &info, &app->id, &app->first));
}

static void aim(struct runner *r, const struct app *app, const uint32_t *pages, uint32_t count)
{
    runner_clear(r);
    for (uint32_t i = 0; i < count; i++)
        runner_add_page(r, app->first + pages[i]);
}

static void check_list(struct runner *r, const struct app *app, const uint32_t *pages,
                       uint32_t count)
{
    uint32_t listed[64], n = 64;
    CHECK_OK(sluiceGetMissedDemandPages(r->loader, app->id, &n, listed));
    assert_int_equal(n, count);
    if (count)
        assert_memory_equal(listed, pages, count * sizeof *pages);
}

static void check_value(const struct runner *r, uint32_t sample, uint64_t value)
{
    struct RunnerOutput out = runner_output(r, sample);
    assert_true(out.resident);
    assert_true(((uint64_t)out.value[1] << 32 | out.value[0]) == value);
}

static void missed_pages_are_listed_once_and_in_order(void **state)
{
    (void)state;
    static const uint32_t first[] = {1500, 3, 7, 3, 1999, 0}, second[] = {5, 1500, 2, 1024};
    static const uint32_t first_list[] = {0, 3, 7, 1500, 1999}, second_list[] = {2, 5, 1024};
    struct runner r;
    struct app app;
    runner_init(&r, &h, NULL);
    add_values(&r, &app, 0, false);
    check_list(&r, &app, NULL, 0);
    aim(&r, &app, first, 6);
    runner_launch(&r);
    assert_int_equal(r.requests.missingCount, 5);
    assert_int_equal(r.requests.servedCount, 5);
    aim(&r, &app, second, 4);
    runner_launch(&r);
    assert_int_equal(r.requests.missingCount, 4);
    assert_int_equal(r.requests.pendingCount, 1);
    uint32_t some[2], n = 2; /* two at a time */
    CHECK_RESULT(sluiceGetMissedDemandPages(r.loader, app.id, &n, some), SLUICE_INCOMPLETE);
    assert_int_equal(n, 2);
    assert_memory_equal(some, first_list, sizeof some);
    uint32_t rest[6];
    memcpy(rest, first_list + 2, 3 * sizeof *rest);
    memcpy(rest + 3, second_list, 3 * sizeof *rest);
    check_list(&r, &app, rest, 6);
    runner_launch(&r);
    check_list(&r, &app, NULL, 0); /* awaited, and already listed */
    assert_int_equal(r.requests.missingCount, 4);
    for (uint32_t i = 0; i < 4; i++)
        CHECK_OK(sluiceSetDemandPageValue(r.loader, app.id, second[i], 1000 + second[i], false));
    runner_launch(&r);
    assert_int_equal(r.requests.missingCount, 0);
    for (uint32_t i = 0; i < 4; i++)
        check_value(&r, i, 1000 + second[i]);
    runner_finish(&r);
    assert_int_equal(app.evicted_count, 4); /* only answered pages */
}

static void answers_are_taken_back_and_missed_again(void **state)
{
    (void)state;
    static const uint32_t pages[] = {10, 20, 30};
    struct runner r;
    struct app app;
    runner_init(&r, &h, NULL);
    add_values(&r, &app, 0, false);
    aim(&r, &app, pages, 3);
    runner_launch(&r);
    check_list(&r, &app, pages, 3);
    CHECK_OK(sluiceSetDemandPageValue(r.loader, app.id, 20, UINT64_MAX, false));
    CHECK_OK(sluiceInvalidateDemandPages(r.loader, app.id, 30, 1)); /* without an answer */
    runner_launch(&r);
    check_value(&r, 1, UINT64_MAX);
    check_list(&r, &app, pages + 2, 1);
    CHECK_OK(sluiceInvalidateDemandPages(r.loader, app.id, 0, PAGES));
    assert_int_equal(app.evicted_count, 0); /* a launch could have been in flight */
    runner_launch(&r);
    assert_int_equal(app.evicted_count, 1);
    assert_true(app.evicted[0] == UINT64_MAX);
    check_list(&r, &app, pages, 3);
    /* A page withdrawn before it was listed is not listed. */
    CHECK_OK(sluiceInvalidateDemandPages(r.loader, app.id, 10, 11));
    runner_launch(&r);
    CHECK_OK(sluiceInvalidateDemandPages(r.loader, app.id, 10, 1));
    check_list(&r, &app, pages + 1, 1);
    CHECK_OK(sluiceRemoveDemandResource(r.loader, app.id)); /* with unanswered pages */
    CHECK_RESULT(sluiceSetDemandPageValue(r.loader, app.id, 20, 1, false),
                 SLUICE_ERROR_STALE_TEXTURE);
    runner_launch(&r);
    runner_finish(&r);
    assert_int_equal(app.evicted_count, 1);
}

static void values_are_there_before_anybody_misses_them(void **state)
{
    (void)state;
    static const uint32_t pages[] = {1, 50, 1999};
    struct runner r;
    struct app app;
    for (uint32_t filled = 0; filled < 2; filled++) {
        runner_init(&r, &h, NULL);
        add_values(&r, &app, 0, filled);
        for (uint32_t i = 0; i < 3; i++)
            CHECK_OK(sluiceSetDemandPageValue(r.loader, app.id, pages[i], 7 + pages[i], false));
        aim(&r, &app, pages, 3);
        runner_launch(&r);
        assert_int_equal(r.requests.missingCount, 0);
        for (uint32_t i = 0; i < 3; i++)
            check_value(&r, i, 7 + pages[i]);
        CHECK_OK(sluiceSetDemandPageValue(r.loader, app.id, 50, 99, false)); /* another value */
        runner_launch(&r);
        check_value(&r, 1, 99);
        assert_int_equal(app.evicted_count, 1);
        assert_int_equal(app.evicted[0], 57);
        assert_int_equal(app.fills, 0);
        runner_finish(&r);
        assert_int_equal(app.evicted_count, 4);
    }
}

static void set_pages_are_evicted_unless_they_are_pinned(void **state)
{
    (void)state;
    enum { LIMIT = 40 };
    struct runner r;
    struct app app;
    uint32_t pages[LIMIT];
    runner_init(&r, &h, NULL);
    add_values(&r, &app, LIMIT, true);
    for (uint32_t i = 0; i < 20; i++)
        CHECK_OK(sluiceSetDemandPageValue(r.loader, app.id, i, 5000 + i, i < 10));
    for (uint32_t round = 0; round < 5; round++) {
        for (uint32_t i = 0; i < 30; i++)
            pages[i] = 100 + round * 30 + i;
        aim(&r, &app, pages, 30);
        runner_load(&r, 9);
        assert_int_equal(r.requests.missingCount, 0);
    }
    uint32_t fills = app.fills;
    for (uint32_t i = 0; i < 20; i++)
        pages[i] = i;
    aim(&r, &app, pages, 20);
    runner_load(&r, 9);
    for (uint32_t i = 0; i < 20; i++)
        check_value(&r, i, i < 10 ? 5000 + i : i);
    assert_int_equal(app.fills, fills + 10);
    CHECK_OK(sluiceInvalidateDemandPages(r.loader, app.id, 0, 1)); /* no longer pinned */
    runner_load(&r, 9);
    check_value(&r, 0, 0);
    /* 9 is pinned and 11 was used: 20 places in total. */
    for (uint32_t i = 0; i <= 20; i++)
        CHECK_RESULT(sluiceSetDemandPageValue(r.loader, app.id, 1000 + i, 1, false),
                     i < 20 ? SLUICE_SUCCESS : SLUICE_NOT_READY);
    runner_finish(&r);
}

static void a_page_that_is_being_filled_cannot_be_set(void **state)
{
    (void)state;
    static const uint32_t page = 4;
    struct runner r;
    struct app app;
    runner_init(&r, &h, NULL);
    add_values(&r, &app, 0, true);
    app.blocked = true;
    aim(&r, &app, &page, 1);
    runner_launch(&r);
    SluiceResult result = sluiceSetDemandPageValue(r.loader, app.id, page, 9, false);
    assert_int_equal(result, SLUICE_NOT_READY);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    runner_clear(&r);
    runner_launch(&r); /* sees the end of the load */
    CHECK_OK(sluiceSetDemandPageValue(r.loader, app.id, page, 9, false));
    aim(&r, &app, &page, 1);
    runner_launch(&r);
    check_value(&r, 0, 9);
    runner_finish(&r);
}

static uint8_t byte_of(uint32_t page, uint32_t at)
{
    return (uint8_t)(page * 31 + at * 7 + (at >> 8));
}

static uint32_t hash_of(uint32_t page, uint32_t size)
{
    uint32_t sum = 2166136261u;
    for (uint32_t i = 0; i < size; i++)
        sum = (sum ^ byte_of(page, i)) * 16777619u;
    return sum;
}

static void set_bytes(struct runner *r, const struct app *app, uint32_t page, uint32_t size,
                      bool pinned)
{
    static uint8_t bytes[1u << 20];
    for (uint32_t i = 0; i < size; i++)
        bytes[i] = byte_of(page, i);
    SluiceResult result = sluiceSetDemandPageBytes(r->loader, app->id, page % PAGES, bytes, pinned);
    CHECK_OK(result);
}

static void aim_bytes(struct runner *r, const struct app *app, uint32_t count, uint32_t size)
{
    runner_clear(r);
    for (uint32_t i = 0; i < count; i++)
        runner_add(r, (struct RunnerInput){
                          .kind = RUNNER_BYTES, .index = app->first + i, .dx = {(float)size}});
}

static void bytes_are_set_and_answered(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, SIZE, 65536, 500000};
    if (!h.reads_bytes)
        skip();
    for (uint32_t s = 0; s < 4; s++) {
        struct runner r;
        struct app app;
        uint32_t size = sizes[s], listed[8], n = 8;
        h.runs_bytes = true;
        runner_init(&r, &h, NULL);
        add_bytes(&r, &app, size);
        set_bytes(&r, &app, 0, size, false);
        set_bytes(&r, &app, 1, size, true);
        aim_bytes(&r, &app, 4, size);
        runner_launch(&r);
        assert_int_equal(r.requests.missingCount, 2);
        CHECK_OK(sluiceGetMissedDemandPages(r.loader, app.id, &n, listed));
        assert_int_equal(n, 2);
        assert_int_equal(listed[0], 2);
        assert_int_equal(listed[1], 3);
        set_bytes(&r, &app, 2, size, false);
        set_bytes(&r, &app, PAGES + 1, size, false); /* other bytes for page 1 */
        runner_launch(&r);
        assert_int_equal(r.requests.missingCount, 1);
        assert_int_equal(runner_output(&r, 0).value[0], hash_of(0, size));
        assert_int_equal(runner_output(&r, 1).value[0], hash_of(PAGES + 1, size));
        assert_int_equal(runner_output(&r, 2).value[0], hash_of(2, size));
        assert_false(runner_output(&r, 3).resident);
        set_bytes(&r, &app, 3, size, false);
        CHECK_OK(sluiceInvalidateDemandPages(r.loader, app.id, 3, 1)); /* before a launch has it */
        runner_launch(&r);
        assert_false(runner_output(&r, 3).resident);
        runner_finish(&r);
    }
}

static void wrong_answers_are_refused(void **state)
{
    (void)state;
    struct runner r;
    struct app values, bytes;
    uint8_t data[SIZE] = {0};
    uint32_t page, n = 1;
    runner_init(&r, &h, NULL);
    add_values(&r, &values, 0, false);
    add_bytes(&r, &bytes, SIZE);
    h.quiet = true;
    CHECK_RESULT(sluiceSetDemandPageValue(r.loader, bytes.id, 0, 1, false),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h.last_message, "pageSize is 3000"));
    CHECK_RESULT(sluiceSetDemandPageBytes(r.loader, values.id, 0, data, false),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceSetDemandPageValue(r.loader, values.id, PAGES, 1, false),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h.last_message, "page is 2000"));
    CHECK_RESULT(sluiceSetDemandPageBytes(r.loader, bytes.id, UINT32_MAX, data, false),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceSetDemandPageValue(r.loader, 77, 0, 1, false), SLUICE_ERROR_UNKNOWN_TEXTURE);
    CHECK_RESULT(sluiceGetMissedDemandPages(r.loader, 77, &n, &page), SLUICE_ERROR_UNKNOWN_TEXTURE);
    h.quiet = false;
    /* Sets twice before a launch: the first bytes are still in the staging memory. */
    CHECK_OK(sluiceSetDemandPageBytes(r.loader, bytes.id, 0, data, false));
    CHECK_RESULT(sluiceSetDemandPageBytes(r.loader, bytes.id, 0, data, false), SLUICE_NOT_READY);
    runner_finish(&r);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missed_pages_are_listed_once_and_in_order),
        cmocka_unit_test(answers_are_taken_back_and_missed_again),
        cmocka_unit_test(values_are_there_before_anybody_misses_them),
        cmocka_unit_test(set_pages_are_evicted_unless_they_are_pinned),
        cmocka_unit_test(a_page_that_is_being_filled_cannot_be_set),
        cmocka_unit_test(bytes_are_set_and_answered),
        cmocka_unit_test(wrong_answers_are_refused),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
