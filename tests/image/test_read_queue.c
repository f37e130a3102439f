#include "image/read_queue.h"
#include "base/alloc.h"
#include "support/test.h"

enum { CAPACITY = 13, SOURCES = 3, PER_SOURCE = 2, MAX_TEXELS = 20, MANY = 10000 };

/* A naive queue: an array that is searched. */
struct model_read {
    enum { QUEUED, DELAYED, RUNNING, ENDED } state;
    uint32_t priority, source, texels;
    uint64_t ticket, order, due;
};

struct model {
    struct model_read reads[MANY];
    uint32_t count, running, running_texels, running_of[SOURCES];
};

static SluiceImageSource sources[SOURCES]; /* only their addresses matter */

static bool is_more_urgent(const struct model_read *a, const struct model_read *b)
{
    return a->priority != b->priority ? a->priority > b->priority : a->order < b->order;
}

/* Queues reads that are due. Starts the most urgent read of a source with room, if it fits. */
static struct model_read *model_start(struct model *model, uint64_t now)
{
    struct model_read *best = NULL;
    for (uint32_t i = 0; i < model->count; i++) {
        struct model_read *read = &model->reads[i];
        if (read->state == DELAYED && read->due <= now)
            read->state = QUEUED;
        if (read->state == QUEUED && model->running_of[read->source] < PER_SOURCE &&
            (!best || is_more_urgent(read, best)))
            best = read;
    }
    if (!best || (model->running > 0 && model->running_texels + best->texels > MAX_TEXELS))
        return NULL;
    best->state = RUNNING;
    model->running++;
    model->running_of[best->source]++;
    model->running_texels += best->texels;
    return best;
}

static void model_stop(struct model *model, struct model_read *read)
{
    if (read->state == RUNNING) {
        model->running--;
        model->running_of[read->source]--;
        model->running_texels -= read->texels;
    }
}

static uint64_t submit(struct slc_read_queue *queue, uint32_t source, uint32_t priority,
                       uint32_t texel_count)
{
    SluiceImageRegion region = {0, 0, 0, texel_count, 1};
    void *texels = &region;
    SluiceTileRead read = {.source = &sources[source],
                           .regionCount = 1,
                           .pRegions = &region,
                           .ppTexels = &texels,
                           .priority = priority,
                           .userValue = priority};
    uint64_t ticket = 0;
    bool queued = slc_read_queue_submit(queue, &read, &ticket);
    assert_int_equal(queued, ticket != 0);
    return ticket;
}

/* Without a known format, a texel counts as 16 bytes. */
static void queue_init(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb,
                       uint32_t capacity)
{
    struct slc_read_queue_limits limits = {capacity, capacity, PER_SOURCE, 16 * MAX_TEXELS};
    CHECK_OK(slc_read_queue_init(queue, cb, &limits));
}

/* Picks a running read, or sometimes any read that has not ended. At most CAPACITY reads exist. */
static struct model_read *pick(struct model *model, uint32_t random)
{
    struct model_read *open[CAPACITY];
    uint32_t count = 0;
    for (uint32_t i = 0; i < model->count; i++)
        if (model->reads[i].state == RUNNING || (random % 8 == 0 && model->reads[i].state != ENDED))
            open[count++] = &model->reads[i];
    return count ? open[random / 8 % count] : NULL;
}

static void model_submit(struct model *model, struct slc_read_queue *queue, uint32_t random,
                         uint32_t uncollected)
{
    uint32_t source = random >> 4 & 15, priority = random >> 8 & 3;
    uint32_t texels = 1 + (random >> 12) % (MAX_TEXELS + 5); /* some fit only alone */
    source = source < SOURCES ? source : 0;
    uint64_t ticket = submit(queue, source, priority, texels);
    assert_int_equal(ticket != 0, uncollected < CAPACITY);
    if (ticket) {
        model->reads[model->count] = (struct model_read){
            QUEUED, priority, source, texels, ticket, (uint64_t)model->count, 0};
        model->count++;
    }
}

static void random_use_starts_reads_as_a_plain_search_would(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_read_queue queue;
    static struct model model;
    queue_init(&queue, &cb, CAPACITY);
    uint32_t random = 5, uncollected = 0, started = 0, delayed = 0;
    uint64_t now = 1;
    for (int step = 0; step < MANY; step++, now += random >> 20 & 7) {
        random = random * 1664525u + 1013904223u;
        uint32_t choice = random >> 29, before = model.count;
        struct model_read *read = pick(&model, random >> 10);
        if (choice <= 2) {
            model_submit(&model, &queue, random, uncollected);
            uncollected += model.count - before;
        } else if (choice <= 4) {
            struct slc_read *got = slc_read_queue_start(&queue, now);
            struct model_read *expected = model_start(&model, now);
            assert_int_equal(!got, !expected);
            if (got)
                assert_int_equal(got->result.ticket, expected->ticket);
            started += got != NULL;
        } else if (read && choice == 5) { /* ended or dropped */
            slc_read_queue_end(&queue, slc_read_queue_find(&queue, read->ticket), SLUICE_SUCCESS);
            model_stop(&model, read);
            read->state = ENDED;
        } else if (read && choice == 6 && read->state == RUNNING) {
            read->due = now + (random >> 10 & 31);
            slc_read_queue_delay(&queue, slc_read_queue_find(&queue, read->ticket), read->due);
            model_stop(&model, read);
            read->state = DELAYED;
            delayed++;
        } else {
            SluiceTileReadResult result;
            for (; slc_read_queue_collect(&queue, &result); uncollected--)
                assert_null(slc_read_queue_find(&queue, result.ticket));
        }
    }
    assert_true(started > MANY / 20 && delayed > MANY / 100);
    slc_read_queue_finish(&queue, &cb);
}

static void a_delayed_read_is_started_when_it_is_due(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_read_queue queue;
    queue_init(&queue, &cb, 4);
    assert_true(slc_read_queue_next_due(&queue) == UINT64_MAX && slc_read_queue_is_idle(&queue));
    uint64_t ticket = submit(&queue, 0, 0, 1);
    struct slc_read *read = slc_read_queue_start(&queue, 100);
    slc_read_queue_add_attempt(&queue, read, SLUICE_ERROR_IO, 4096, 7);
    slc_read_queue_delay(&queue, read, 150);
    assert_int_equal(slc_read_queue_next_due(&queue), 150);
    assert_null(slc_read_queue_start(&queue, 149));
    assert_false(slc_read_queue_is_idle(&queue));
    SluiceTileLoaderStatistics s = {.structSize = sizeof s};
    slc_read_queue_write_statistics(&queue, &sources[0], &s);
    assert_true(s.delayedCount == 1 && s.retriedCount == 1 && s.failedCount == 1);
    assert_true(s.lastFailure == SLUICE_ERROR_IO && s.lastFailureOffset == 4096);
    assert_ptr_equal(slc_read_queue_start(&queue, 150), read);
    slc_read_queue_add_attempt(&queue, read, SLUICE_SUCCESS, 0, 9);
    slc_read_queue_end(&queue, read, SLUICE_SUCCESS);
    slc_read_queue_write_statistics(&queue, NULL, &s);
    assert_true(s.delayedCount == 0 && s.retriedCount == 1 && s.succeededCount == 1);
    assert_true(s.attemptCount == 2 && s.meanLatencyNs == 8 && s.maxLatencyNs == 9);
    SluiceTileReadResult result;
    assert_true(slc_read_queue_collect(&queue, &result));
    assert_int_equal(result.ticket, ticket);
    slc_read_queue_finish(&queue, &cb);
}

/* Both limits are reached when the waiting read is resumed. */
static void copies_start_without_limits(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_read_queue queue;
    struct slc_shared_region *texels = (struct slc_shared_region *)&cb; /* never examined */
    for (int fails = 0; fails < 2; fails++) {
        queue_init(&queue, &cb, CAPACITY);
        submit(&queue, 0, 1, MAX_TEXELS);
        struct slc_read *read = slc_read_queue_start(&queue, 0);
        slc_read_queue_wait(&queue, read);
        submit(&queue, 0, 0, MAX_TEXELS);
        struct slc_read *other = slc_read_queue_start(&queue, 0);
        submit(&queue, 0, 2, 1);
        assert_null(slc_read_queue_start(&queue, 0));
        read->held = fails ? NULL : texels;
        read->failed.result = fails ? SLUICE_ERROR_IO : SLUICE_SUCCESS;
        slc_read_queue_resume(&queue, read);
        assert_ptr_equal(slc_read_queue_start(&queue, 0), read);
        read->held = NULL;
        read->failed.result = SLUICE_SUCCESS;
        slc_read_queue_resume(&queue, read); /* another region remains */
        assert_null(slc_read_queue_start(&queue, 0));
        slc_read_queue_end(&queue, other, SLUICE_SUCCESS);
        struct slc_read *urgent = slc_read_queue_start(&queue, 0);
        assert_int_equal(urgent->priority, 2);
        slc_read_queue_end(&queue, urgent, SLUICE_SUCCESS);
        assert_ptr_equal(slc_read_queue_start(&queue, 0), read);
        slc_read_queue_end(&queue, read, SLUICE_SUCCESS);
        assert_true(slc_read_queue_is_idle(&queue));
        assert_int_equal(queue.own_load.running_count, 0);
        assert_int_equal(queue.own_load.running_size, 0);
        slc_read_queue_finish(&queue, &cb);
    }
}

static void a_source_is_forgotten_when_nothing_of_it_is_left(void **state)
{
    (void)state;
    enum { COUNT = 100 };
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    static SluiceImageSource many[COUNT];
    struct slc_read_queue queue;
    SluiceTileLoaderStatistics s = {.structSize = sizeof s};
    SluiceTileReadResult result;
    queue_init(&queue, &cb, COUNT);
    for (uint32_t i = 0; i < COUNT; i++) {
        SluiceImageRegion region = {0, 0, 0, 1, 1};
        void *texels = &region;
        uint64_t ticket;
        SluiceTileRead read = {&many[i], 1, &region, &texels, i, 0};
        assert_true(slc_read_queue_submit(&queue, &read, &ticket));
    }
    for (uint32_t i = COUNT; i-- > 0;) { /* the last one is the most urgent */
        CHECK_RESULT(slc_read_queue_forget(&queue, &many[i]), SLUICE_NOT_READY);
        struct slc_read *read = slc_read_queue_start(&queue, 0);
        assert_ptr_equal(read->source->source, &many[i]);
        slc_read_queue_end(&queue, read, SLUICE_SUCCESS);
        CHECK_RESULT(slc_read_queue_forget(&queue, &many[i]), SLUICE_NOT_READY);
        assert_true(slc_read_queue_collect(&queue, &result));
        slc_read_queue_write_statistics(&queue, &many[i], &s);
        assert_int_equal(s.succeededCount, 1);
        CHECK_OK(slc_read_queue_forget(&queue, &many[i]));
        CHECK_OK(slc_read_queue_forget(&queue, &many[i]));
        slc_read_queue_write_statistics(&queue, &many[i], &s);
        assert_int_equal(s.readCount, 0);
        for (uint32_t k = 0; k < i; k++) { /* the others are still found */
            slc_read_queue_write_statistics(&queue, &many[k], &s);
            assert_int_equal(s.readCount, 1);
        }
    }
    slc_read_queue_write_statistics(&queue, NULL, &s);
    assert_int_equal(s.readCount, COUNT);
    slc_read_queue_finish(&queue, &cb);
}

/* Three sources are remembered. Among sources without reads, the one longest without goes first. */
static void sources_without_reads_give_way_to_new_ones(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    static SluiceImageSource many[5];
    static const uint32_t order[] = {0, 1, 2, 0, 3, 4, 1};
    static const bool known[7][5] = {{1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 1, 1, 0, 0},
                                     {1, 1, 1, 0, 0}, {1, 0, 1, 1, 0}, {1, 0, 0, 1, 1},
                                     {0, 1, 0, 1, 1}};
    struct slc_read_queue queue;
    struct slc_read_queue_limits limits = {2, 3, 1, 100};
    CHECK_OK(slc_read_queue_init(&queue, &cb, &limits));
    for (uint32_t i = 0; i < 7; i++) {
        SluiceImageRegion region = {0, 0, 0, 1, 1};
        void *texels = &region;
        uint64_t ticket;
        SluiceTileReadResult result;
        SluiceTileLoaderStatistics s = {.structSize = sizeof s};
        SluiceTileRead read = {&many[order[i]], 1, &region, &texels, 0, 0};
        assert_true(slc_read_queue_submit(&queue, &read, &ticket));
        slc_read_queue_end(&queue, slc_read_queue_start(&queue, 0), SLUICE_SUCCESS);
        assert_true(slc_read_queue_collect(&queue, &result));
        for (uint32_t k = 0; k < 5; k++) {
            slc_read_queue_write_statistics(&queue, &many[k], &s);
            assert_int_equal(s.readCount > 0, known[i][k]);
        }
        slc_read_queue_write_statistics(&queue, NULL, &s);
        assert_int_equal(s.readCount, i + 1);
    }
    slc_read_queue_finish(&queue, &cb);
}

static void tickets_are_never_zero_and_never_come_back(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_read_queue queue;
    queue_init(&queue, &cb, 2);
    uint64_t seen[100];
    for (int i = 0; i < 100; i++) {
        SluiceTileReadResult result;
        seen[i] = submit(&queue, 0, 0, 1);
        assert_true(seen[i] != 0);
        for (int k = 0; k < i; k++) {
            assert_true(seen[k] != seen[i]);
            assert_null(slc_read_queue_find(&queue, seen[k]));
        }
        slc_read_queue_end(&queue, slc_read_queue_find(&queue, seen[i]), SLUICE_SUCCESS);
        assert_true(slc_read_queue_collect(&queue, &result));
    }
    assert_null(slc_read_queue_find(&queue, 0));
    slc_read_queue_finish(&queue, &cb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_use_starts_reads_as_a_plain_search_would),
        cmocka_unit_test(a_delayed_read_is_started_when_it_is_due),
        cmocka_unit_test(copies_start_without_limits),
        cmocka_unit_test(a_source_is_forgotten_when_nothing_of_it_is_left),
        cmocka_unit_test(sources_without_reads_give_way_to_new_ones),
        cmocka_unit_test(tickets_are_never_zero_and_never_come_back),
    };
    return RUN_TESTS(tests);
}
