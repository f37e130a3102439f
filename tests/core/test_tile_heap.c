#include "residency/tile_heap.h"

#include "core/fixture.h"

enum { HEAPS = 6 };

/* Slots of a few heaps, and the test's own count of free slots. */
struct shelf {
    struct slc_tile_heaps heaps;
    struct failing_allocator memory;
    uint32_t capacity, count, next_id;
    uint32_t index[HEAPS]; ///< indices in struct slc_tile_heaps
    uint32_t free[HEAPS];
    uint32_t released;
};

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *id)
{
    struct shelf *s = user;
    assert_true(size == s->capacity * UINT64_C(10));
    *id = s->next_id++;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t id)
{
    struct shelf *s = user;
    assert_true(id < s->next_id);
    s->released++;
}

static void shelf_open(struct shelf *s, uint32_t capacity, uint32_t count)
{
    *s = (struct shelf){.capacity = capacity, .count = count};
    const SluiceHeapAllocator allocator = {s, allocate_heap, release_heap};
    failing_allocator_init(&s->memory, UINT64_MAX);
    CHECK_OK(slc_tile_heaps_init(&s->heaps, &s->memory.callbacks, &allocator, capacity, 10));
    for (uint32_t i = 0; i < count; i++) {
        SluiceResult answer;
        uint32_t id;
        CHECK_OK(slc_tile_heaps_add(&s->heaps, &answer, &id));
        CHECK_OK(answer);
        assert_int_equal(id, i);
        s->index[i] = slc_tile_heaps_find(&s->heaps, id);
        assert_true(s->index[i] != UINT32_MAX);
        s->free[i] = capacity;
    }
}

static void shelf_close(struct shelf *s)
{
    slc_tile_heaps_finish(&s->heaps);
    assert_int_equal(s->released, s->next_id);
    assert_int_equal(s->memory.live_bytes, 0);
}

/* Takes slots from 0 up and returns them from the top down, like a stack. */
static void set_free(struct shelf *s, uint32_t heap, uint32_t free)
{
    for (; s->free[heap] > free; s->free[heap]--) {
        uint32_t slot = slc_tile_heaps_take_from(&s->heaps, s->index[heap], heap + 1);
        if (slot != s->capacity - s->free[heap]) /* millions of times: no call */
            fail_msg("slot %u, not %u", (unsigned)slot, (unsigned)(s->capacity - s->free[heap]));
    }
    for (; s->free[heap] < free; s->free[heap]++)
        slc_tile_heaps_give(&s->heaps, s->index[heap], s->capacity - s->free[heap] - 1);
}

/* Returns the fewest free slots above 0 by looking at all heaps; UINT32_MAX: none. */
static uint32_t fewest_free(const struct shelf *s)
{
    uint32_t fewest = UINT32_MAX;
    for (uint32_t i = 0; i < s->count; i++)
        if (s->free[i] && s->free[i] < fewest)
            fewest = s->free[i];
    return fewest;
}

/* Takes and returns a slot. It must belong to a heap with the fewest free slots. */
static void check_choice(struct shelf *s)
{
    uint32_t heap = UINT32_MAX, slot = UINT32_MAX, fewest = fewest_free(s), at = 0;
    uint64_t free_total = 0;
    for (uint32_t i = 0; i < s->count; i++)
        free_total += s->free[i];
    assert_true(s->heaps.free_total == free_total);
    bool taken = slc_tile_heaps_take(&s->heaps, 7, &heap, &slot);
    assert_int_equal(taken, fewest != UINT32_MAX);
    if (!taken)
        return;
    while (at < s->count && s->index[at] != heap)
        at++;
    assert_true(at < s->count);
    assert_int_equal(s->free[at], fewest);
    assert_int_equal(slot, s->capacity - fewest);
    slc_tile_heaps_give(&s->heaps, heap, slot);
}

/* Free counts on both sides of every border of the bit set: words of 64, and words over words. */
static uint32_t border(uint32_t number, uint32_t capacity)
{
    static const uint32_t borders[] = {0,    64,    128,    4096,   4160,
                                       8192, 65536, 262144, 524288, 1048576};
    uint32_t at = borders[number / 3 % 10], side = number % 3;
    uint32_t value = side == 0 && at ? at - 1 : side == 1 ? at : at + 1;
    return value < capacity ? value : capacity;
}

enum { BORDERS = 30 };

static const uint32_t capacities[] = {1,    2,    63,   64,    65,    4095,   4096,
                                      4097, 5000, 8191, 65536, 65537, 300000, 1u << 20};
#define CAPACITY_COUNT (sizeof capacities / sizeof *capacities)

static void the_only_heap_is_found_at_every_border(void **state)
{
    (void)state;
    for (size_t c = 0; c < CAPACITY_COUNT; c++) {
        struct shelf s;
        shelf_open(&s, capacities[c], 1);
        for (uint32_t i = BORDERS; i-- > 0;) {
            set_free(&s, 0, border(i, s.capacity));
            check_choice(&s);
        }
        shelf_close(&s);
    }
}

static void the_fullest_of_two_is_found_at_every_pair_of_borders(void **state)
{
    (void)state;
    for (size_t c = 0; c < CAPACITY_COUNT; c++) {
        struct shelf s;
        shelf_open(&s, capacities[c], 2);
        for (uint32_t i = BORDERS; i-- > 0;) {
            set_free(&s, 0, border(i, s.capacity));
            for (uint32_t k = 0; k < BORDERS && s.capacity <= 8192; k++) {
                set_free(&s, 1, border(k, s.capacity));
                check_choice(&s);
            }
            set_free(&s, 1, border(i / 2, s.capacity)); /* large heaps with one other border each */
            check_choice(&s);
        }
        shelf_close(&s);
    }
}

/* Counts walk up and down, and sometimes jump to a border. */
static void random_counts_are_searched_as_by_looking_at_all(void **state)
{
    (void)state;
    uint64_t random = 41;
    for (size_t c = 0; c < CAPACITY_COUNT; c++) {
        struct shelf s;
        shelf_open(&s, capacities[c], HEAPS);
        for (uint32_t step = 0; step < 3000; step++) {
            uint32_t heap = next_random(&random) % HEAPS, most = 2 * 70 + 1;
            uint32_t free = s.free[heap] + next_random(&random) % most;
            free = free < most / 2 ? 0 : free - most / 2;
            if (next_random(&random) % (1 + s.capacity / 1000) == 0)
                free = border(next_random(&random) % BORDERS, s.capacity);
            set_free(&s, heap, free < s.capacity ? free : s.capacity);
            check_choice(&s);
        }
        shelf_close(&s);
    }
}

static void every_slot_of_the_largest_heap_is_handed_out_once(void **state)
{
    (void)state;
    struct shelf s;
    shelf_open(&s, 1u << 20, 2);
    uint32_t heap, slot, first = UINT32_MAX;
    for (uint32_t i = 0; i < s.capacity; i++) {
        bool taken = slc_tile_heaps_take(&s.heaps, 1, &heap, &slot);
        first = i ? first : heap;
        if (!taken || heap != first || slot != i)
            fail_msg("slot %u of heap %u comes after %u", (unsigned)slot, (unsigned)heap,
                     (unsigned)i);
    }
    assert_true(slc_tile_heaps_take(&s.heaps, 1, &heap, &slot)); /* then the other one */
    assert_true(heap != first && slot == 0);
    slc_tile_heaps_give(&s.heaps, first, 12345);
    assert_true(slc_tile_heaps_take(&s.heaps, 1, &heap, &slot)); /* the fuller one again */
    assert_true(heap == first && slot == 12345);
    shelf_close(&s);
}

static void released_heaps_are_never_chosen(void **state)
{
    (void)state;
    for (size_t c = 0; c < CAPACITY_COUNT; c++) {
        struct shelf s;
        shelf_open(&s, capacities[c], HEAPS);
        for (uint32_t left = HEAPS; left-- > 0;) {
            set_free(&s, left, s.capacity); /* it was fuller than all others */
            slc_tile_heaps_release(&s.heaps, s.index[left]);
            assert_int_equal(s.released, HEAPS - left);
            assert_true(slc_tile_heaps_find(&s.heaps, left) == UINT32_MAX);
            s.count = left;
            if (left) /* the fullest, but not full where it can be helped */
                set_free(&s, left - 1, s.capacity - s.capacity / (s.capacity < 100 ? 2 : 50));
            check_choice(&s);
        }
        assert_true(s.heaps.free_total == 0 && s.heaps.live_count == 0);
        shelf_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_only_heap_is_found_at_every_border),
        cmocka_unit_test(the_fullest_of_two_is_found_at_every_pair_of_borders),
        cmocka_unit_test(random_counts_are_searched_as_by_looking_at_all),
        cmocka_unit_test(every_slot_of_the_largest_heap_is_handed_out_once),
        cmocka_unit_test(released_heaps_are_never_chosen),
    };
    return RUN_TESTS(tests);
}
