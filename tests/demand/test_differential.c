#include "demand/naive_residency.h"
#include "demand/random.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>

struct pair {
    struct slc_demand_residency *residency;
    struct naive_residency naive;
    struct fake_memory memories[2][NAIVE_CLASSES]; /* the residency's, the naive one's */
    struct slc_page_request attributes[NAIVE_PAGES];
    struct failing_allocator allocator;
    uint64_t random, value;
    uint64_t answers[SLC_REQUEST_POSTPONED + 1];
    bool may_fail;
};

static uint32_t below(struct pair *p, uint32_t limit)
{
    return random_below(&p->random, limit);
}

/* Low ids, and the highest there are. */
static uint32_t id_of(uint32_t page)
{
    return page < NAIVE_PAGES / 2 ? page * 37 : INT32_MAX - (NAIVE_PAGES - 1 - page);
}

static void draw_attributes(struct pair *p, uint32_t page)
{
    p->attributes[page] =
        (struct slc_page_request){.page = id_of(page),
                                  .class_index = (uint8_t)(below(p, 4) % NAIVE_CLASSES),
                                  .rank = (uint8_t)below(p, 4),
                                  .pinned = below(p, 12) == 0,
                                  .kind = below(p, 2)};
}

static void start(struct pair *p, uint64_t seed)
{
    *p = (struct pair){.random = seed * 0x9E3779B97F4A7C15u + 1, .may_fail = seed % 3 == 0};
    failing_allocator_init(&p->allocator, UINT64_MAX);
    const struct slc_page_residency_create_info info = {.cb = &p->allocator.callbacks,
                                                        .class_count = NAIVE_CLASSES,
                                                        .no_eviction = seed % 11 == 0,
                                                        .no_lod_bias = seed % 2 == 0};
    CHECK_OK(slc_residency_create(&info, &p->residency));
    p->naive.no_eviction = info.no_eviction;
    p->naive.no_lod_bias = info.no_lod_bias;
    for (uint32_t c = 0; c < NAIVE_CLASSES; c++) { /* class 1 has no places */
        uint32_t limit = 2 + below(p, 20);
        struct slc_page_memory memory[2] = {{0}};
        for (uint32_t side = 0; side < 2 && c != 1; side++) {
            uint32_t extra = side == 0 ? below(p, 8) : 0;
            fake_memory_init(&p->memories[side][c],
                             side == 0 ? limit + extra : p->memories[0][c].place_count, 3);
            memory[side] = fake_page_memory(&p->memories[side][c]);
        }
        p->naive.memories[c] = memory[1];
        p->naive.limits[c] = limit;
        CHECK_OK(slc_residency_set_class(p->residency, c, limit, c == 1 ? NULL : &memory[0]));
    }
    for (uint32_t i = 0; i < NAIVE_PAGES; i++) {
        p->naive.pages[i].id = id_of(i);
        p->naive.pages[i].place = SLC_NO_PLACE;
        draw_attributes(p, i);
    }
}

static void compare(struct pair *p)
{
    assert_true(slc_residency_check(p->residency));
    for (uint32_t c = 0; c < NAIVE_CLASSES; c++) {
        struct slc_residency_counts counts, *naive = &p->naive.counts[c];
        slc_residency_get_counts(p->residency, c, &counts);
        naive->resident = naive->loading = naive->refused = 0;
        for (uint32_t i = 0; i < NAIVE_PAGES; i++) {
            const struct naive_page *page = &p->naive.pages[i];
            naive->resident += page->class_index == c && page->state == NAIVE_RESIDENT;
            naive->loading += page->class_index == c && page->state == NAIVE_LOADING;
            naive->refused += page->class_index == c && page->state == NAIVE_REFUSED;
        }
        assert_memory_equal(&counts, naive, sizeof counts);
        assert_int_equal(p->memories[0][c].taken_count, p->memories[1][c].taken_count);
    }
    for (uint32_t i = 0; i < NAIVE_PAGES; i++) {
        const struct naive_page *page = &p->naive.pages[i];
        bool places = page->state == NAIVE_LOADING && !page->dropped && page->class_index != 1;
        assert_int_equal(slc_residency_place(p->residency, page->id),
                         places ? page->place : SLC_NO_PLACE);
    }
}

static void request(struct pair *p, uint32_t page)
{
    SluiceResult result;
    bool fails = p->may_fail && below(p, 4) == 0;
    p->allocator.refuse_from = fails ? p->allocator.calls : UINT64_MAX;
    enum slc_request_answer answer =
        slc_residency_request(p->residency, &p->attributes[page], &result);
    p->allocator.refuse_from = UINT64_MAX;
    if (result != SLUICE_SUCCESS) {
        assert_true(fails);
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(answer, SLC_REQUEST_POSTPONED);
        compare(p); /* nothing has changed */
        return;
    }
    p->naive.blurriest = slc_residency_lod_bias(p->residency) == 24;
    assert_int_equal(answer, naive_request(&p->naive, page, &p->attributes[page]));
    p->answers[answer]++;
}

static void launch(struct pair *p)
{
    uint64_t number = p->naive.launch + 1 + below(p, 8) / 7, missing = 0;
    slc_residency_begin(p->residency, number);
    naive_begin(&p->naive, number);
    uint32_t first = below(p, NAIVE_PAGES), count = below(p, NAIVE_PAGES);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t page = (first + i * 5) % NAIVE_PAGES;
        slc_residency_use(p->residency, id_of(page));
        naive_use(&p->naive, page);
    }
    for (uint32_t i = below(p, 20); i > 0; i--, missing++)
        request(p, (first + below(p, 25)) % NAIVE_PAGES);
    slc_residency_settle(p->residency, missing + below(p, 3));
    naive_settle(&p->naive);
}

static void end_reads(struct pair *p)
{
    for (uint32_t i = 0; i < NAIVE_PAGES; i++) {
        if (p->naive.pages[i].state != NAIVE_LOADING || below(p, 3) == 0)
            continue;
        if (below(p, 8) == 0) {
            bool refuse = below(p, 2);
            slc_residency_failed(p->residency, id_of(i), refuse);
            naive_failed(&p->naive, i, refuse);
        } else {
            slc_residency_loaded(p->residency, id_of(i), ++p->value);
            naive_loaded(&p->naive, i, p->value);
        }
    }
}

/* A few pages; or many ids of which one is known. */
static void forget(struct pair *p)
{
    enum { LAST_LOW = NAIVE_PAGES / 2 - 1 };
    uint32_t first = below(p, NAIVE_PAGES), count = 1 + below(p, 4);
    bool many = below(p, 8) == 0;
    if (many) {
        first = LAST_LOW;
        count = 1;
        slc_residency_forget(p->residency, id_of(first), id_of(first + 1) - id_of(first));
    }
    for (uint32_t i = first; i < first + count && i < NAIVE_PAGES; i++) {
        if (!many)
            slc_residency_forget(p->residency, id_of(i), 1);
        naive_forget(&p->naive, i);
        draw_attributes(p, i);
    }
}

static void prepare(struct pair *p)
{
    struct slc_page_change changes[2][NAIVE_PAGES];
    struct slc_page_evicted evicted[7];
    uint32_t capacity = below(p, 3) == 0 ? 1 + below(p, 4) : NAIVE_PAGES;
    if (below(p, 4)) {
        p->naive.prepared = p->naive.launch + 1 + below(p, 2) > p->naive.prepared
                                ? p->naive.launch + 1 + below(p, 2)
                                : p->naive.prepared;
        if (p->naive.prepared > p->naive.launch)
            slc_residency_prepare(p->residency, p->naive.prepared);
    }
    uint32_t count = slc_residency_take_changes(p->residency, changes[0], capacity);
    assert_int_equal(count, naive_take_changes(&p->naive, changes[1], capacity));
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(changes[0][i].page, changes[1][i].page);
        assert_int_equal(changes[0][i].shown, changes[1][i].shown);
        assert_int_equal(changes[0][i].class_index, changes[1][i].class_index);
        if (changes[0][i].shown == SLC_SHOW_RESIDENT)
            assert_int_equal(changes[0][i].value, changes[1][i].value);
    }
    count = slc_residency_take_evicted(p->residency, evicted, 7);
    for (uint32_t i = 0; i < count; i++) {
        const struct slc_page_evicted *naive = &p->naive.evicted[p->naive.evicted_begin++];
        assert_int_equal(evicted[i].page, naive->page);
        assert_int_equal(evicted[i].class_index, naive->class_index);
        assert_int_equal(evicted[i].value, naive->value);
    }
    assert_true(count == 7 || p->naive.evicted_begin == p->naive.evicted_end);
}

static void step(struct pair *p)
{
    uint32_t c;
    switch (below(p, 12)) {
    case 0: request(p, below(p, NAIVE_PAGES)); break; /* outside launches, as preloading does */
    case 1: forget(p); break;
    case 2:
        c = below(p, NAIVE_CLASSES);
        if (below(p, 6) == 0) {
            uint64_t limit = below(p, 24);
            struct slc_page_memory memory = fake_page_memory(&p->memories[0][c]);
            CHECK_OK(slc_residency_set_class(p->residency, c, limit, c == 1 ? NULL : &memory));
            naive_set_limit(&p->naive, c, limit);
        }
        break;
    case 3:
    case 4:
    case 5: prepare(p); break;
    case 6:
    case 7:
    case 8: end_reads(p); break;
    default: launch(p); break;
    }
    compare(p);
}

static void random_calls_agree_with_a_naive_model(void **state)
{
    (void)state;
    struct pair *p = malloc(sizeof *p);
    assert_non_null(p);
    uint64_t answers[SLC_REQUEST_POSTPONED + 1] = {0};
    for (uint64_t seed = 1; seed <= 120; seed++) {
        start(p, seed);
        for (uint32_t i = 0; i < 1500; i++)
            step(p);
        slc_residency_destroy(p->residency);
        assert_int_equal(p->allocator.live_count, 0);
        for (uint32_t i = 0; i <= SLC_REQUEST_POSTPONED; i++)
            answers[i] += p->answers[i];
    }
    for (uint32_t i = 0; i <= SLC_REQUEST_POSTPONED; i++)
        assert_true(answers[i] > 1000); /* or the calls show little */
    free(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_calls_agree_with_a_naive_model),
    };
    return RUN_TESTS(tests);
}
