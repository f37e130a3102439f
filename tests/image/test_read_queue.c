#include "image/read_queue.h"
#include "base/alloc.h"
#include "support/test.h"

/* The same queue as plainly as can be: an array that is searched. */
struct model_read {
    bool queued;
    uint32_t priority;
    uint64_t ticket, order;
};

enum { CAPACITY = 13, MANY = 20000 };

static struct model_read *most_urgent(struct model_read *model, int count)
{
    struct model_read *best = NULL;
    for (int i = 0; i < count; i++) {
        struct model_read *read = &model[i];
        if (read->queued && (!best || read->priority > best->priority ||
                             (read->priority == best->priority && read->order < best->order)))
            best = read;
    }
    return best;
}

static uint64_t submit(struct slc_read_queue *queue, uint32_t priority)
{
    SluiceImageRegion region = {0, 0, 0, 1, 1};
    void *texels = &region;
    SluiceTileRead read = {.regionCount = 1,
                           .pRegions = &region,
                           .ppTexels = &texels,
                           .priority = priority,
                           .userValue = priority};
    uint64_t ticket = 0;
    return slc_read_queue_submit(queue, &read, &ticket) ? ticket : 0;
}

static void random_use_starts_reads_as_a_plain_search_would(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_read_queue queue;
    CHECK_OK(slc_read_queue_init(&queue, &cb, CAPACITY));
    static struct model_read model[MANY];
    int count = 0;
    uint32_t random = 5, uncollected = 0;
    uint64_t last_ticket = 0;
    for (int step = 0; step < MANY; step++) {
        random = random * 1664525u + 1013904223u;
        uint32_t choice = random >> 30;
        struct model_read *urgent = most_urgent(model, count);
        if (choice <= 1) {
            uint64_t ticket = submit(&queue, random >> 8 & 3);
            assert_int_equal(ticket != 0, uncollected < CAPACITY);
            if (ticket) {
                model[count] = (struct model_read){true, random >> 8 & 3, ticket, (uint64_t)count};
                count++;
                uncollected++;
                last_ticket = ticket;
            }
        } else if (choice == 2) {
            struct slc_read *read = slc_read_queue_start(&queue);
            assert_int_equal(!read, !urgent);
            if (read) {
                assert_int_equal(read->result.ticket, urgent->ticket);
                urgent->queued = false;
                slc_read_queue_end(&queue, read, SLUICE_SUCCESS, 1);
            }
        } else { /* drop the latest if it is still queued, and collect */
            struct slc_read *read = slc_read_queue_find(&queue, last_ticket);
            if (read && read->state == SLC_READ_QUEUED) {
                assert_true(model[count - 1].queued);
                model[count - 1].queued = false;
                slc_read_queue_end(&queue, read, SLUICE_ERROR_CANCELLED, 0);
            }
            SluiceTileReadResult result;
            while (slc_read_queue_collect(&queue, &result)) {
                assert_null(slc_read_queue_find(&queue, result.ticket));
                uncollected--;
            }
        }
    }
    assert_true(count > MANY / 10);
    slc_read_queue_finish(&queue, &cb);
}

static void tickets_are_never_zero_and_never_come_back(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_read_queue queue;
    CHECK_OK(slc_read_queue_init(&queue, &cb, 2));
    uint64_t seen[100];
    for (int i = 0; i < 100; i++) {
        SluiceTileReadResult result;
        seen[i] = submit(&queue, 0);
        assert_true(seen[i] != 0);
        for (int k = 0; k < i; k++) {
            assert_true(seen[k] != seen[i]);
            assert_null(slc_read_queue_find(&queue, seen[k]));
        }
        slc_read_queue_end(&queue, slc_read_queue_find(&queue, seen[i]), SLUICE_SUCCESS, 0);
        assert_true(slc_read_queue_collect(&queue, &result));
    }
    assert_null(slc_read_queue_find(&queue, 0));
    slc_read_queue_finish(&queue, &cb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_use_starts_reads_as_a_plain_search_would),
        cmocka_unit_test(tickets_are_never_zero_and_never_come_back),
    };
    return RUN_TESTS(tests);
}
