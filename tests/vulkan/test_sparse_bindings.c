#include "vulkan/sparse_bindings.h"

#include "base/alloc.h"
#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

#include <stdlib.h>

enum { CAPACITY = 64, IMAGES = 4, HEAP = 16, HEAPS = 3, COLUMNS = 20 };

struct fixture {
    SluiceAllocationCallbacks cb;
    struct slc_bind_list list;
    struct slc_sparse_bindings bindings;
};

static int setup(void **state)
{
    struct fixture *f = malloc(sizeof *f);
    f->cb = slc_allocator(NULL);
    CHECK_OK(slc_bind_list_init(&f->list, &f->cb, CAPACITY));
    CHECK_OK(slc_sparse_bindings_init(&f->bindings, &f->cb, IMAGES));
    for (uint32_t heap = 0; heap < HEAPS; heap++)
        CHECK_OK(slc_sparse_bindings_add_heap(&f->bindings, &f->cb, heap, HEAP));
    *state = f;
    return 0;
}

static int teardown(void **state)
{
    struct fixture *f = *state;
    slc_sparse_bindings_finish(&f->bindings, &f->cb);
    slc_bind_list_finish(&f->list, &f->cb);
    free(f);
    return 0;
}

static struct slc_tile_place at(uint32_t x)
{
    return (struct slc_tile_place){0, x, 0};
}

static uint32_t bind(struct fixture *f, uint32_t image, uint32_t x, uint32_t heap, uint32_t slot)
{
    uint32_t unbound;
    assert_true(
        slc_sparse_bindings_bind(&f->bindings, &f->list, image, at(x), heap, slot, &unbound));
    return unbound;
}

static void check_entry(const struct fixture *f, uint32_t entry, uint32_t image, uint32_t x,
                        uint32_t heap, uint32_t slot)
{
    assert_true(entry < f->list.count);
    const struct slc_bind *b = &f->list.binds[entry];
    assert_int_equal(b->image, image);
    assert_int_equal(b->place.x, x);
    assert_int_equal(b->heap_id, heap);
    if (heap != SLC_UNBIND)
        assert_int_equal(b->slot, slot);
}

static void page_that_was_given_up_is_taken_from_its_tile_when_another_gets_it(void **state)
{
    struct fixture *f = *state;
    assert_int_equal(bind(f, 0, 5, 1, 7), SLC_NO_IMAGE);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    assert_int_equal(f->list.count, 1); /* nothing is unbound yet */
    assert_int_equal(bind(f, 2, 9, 1, 7), 0);
    assert_int_equal(f->list.count, 3);
    check_entry(f, 1, 0, 5, SLC_UNBIND, 0);
    check_entry(f, 2, 2, 9, 1, 7);
    assert_int_equal(f->bindings.unbind_count, 1);
    assert_int_equal(f->bindings.unbinds_saved, 0);
}

static void neighbors_that_were_given_up_are_unbound_in_the_same_run(void **state)
{
    struct fixture *f = *state;
    for (uint32_t x = 0; x < 7; x++)
        bind(f, 0, x, 1, 13 - 2 * x);
    for (uint32_t x = 0; x < 7; x++)
        if (x != 1)
            slc_sparse_bindings_evict(&f->bindings, 0, at(x));
    slc_bind_list_clear(&f->list);
    assert_int_equal(bind(f, 2, 9, 1, 13 - 2 * 4), 0);
    slc_bind_list_build_runs(&f->list);
    assert_int_equal(f->list.run_count, 2);
    const struct slc_bind_run *run = &f->list.runs[0]; /* up to the neighbor that is not evicted */
    assert_int_equal(run->heap_id, SLC_UNBIND);
    assert_int_equal(run->place.x, 2);
    assert_int_equal(run->column_count, 5);
    assert_int_equal(f->bindings.unbind_count, 5);
    assert_int_equal(bind(f, 3, 0, 1, 13 - 2 * 6), SLC_NO_IMAGE);
    assert_int_equal(bind(f, 3, 1, 1, 13), 0);
}

static void pages_of_a_tail_are_unbound_one_by_one(void **state)
{
    struct fixture *f = *state;
    uint32_t unbound;
    for (uint32_t x = 0; x < 3; x++) {
        struct slc_tile_place place = {SLC_TAIL_LEVEL, x, 0};
        assert_true(slc_sparse_bindings_bind(&f->bindings, &f->list, 0, place, 0, x, &unbound));
        slc_sparse_bindings_evict(&f->bindings, 0, place);
    }
    assert_int_equal(bind(f, 1, 0, 0, 1), 0);
    assert_int_equal(f->bindings.unbind_count, 1);
}

static void tile_that_gets_another_page_is_bound_over(void **state)
{
    struct fixture *f = *state;
    bind(f, 0, 5, 1, 7);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    assert_int_equal(bind(f, 0, 5, 2, 3), SLC_NO_IMAGE);
    assert_int_equal(f->list.count, 2);
    check_entry(f, 1, 0, 5, 2, 3);
    assert_int_equal(bind(f, 1, 1, 1, 7), SLC_NO_IMAGE); /* the old page is bound nowhere */
    assert_int_equal(f->bindings.unbind_count, 0);
    assert_int_equal(f->bindings.unbinds_saved, 1);
}

static void tile_that_gets_its_page_again_needs_no_bind(void **state)
{
    struct fixture *f = *state;
    bind(f, 0, 5, 1, 7);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    assert_int_equal(bind(f, 0, 5, 1, 7), SLC_NO_IMAGE);
    assert_int_equal(f->list.count, 1);
    assert_int_equal(f->bindings.unbinds_saved, 1);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    assert_int_equal(bind(f, 0, 6, 1, 7), 0); /* it has it still */
}

/* Two tiles swap their pages within one batch: each place has one final state, none an unbind. */
static void swapped_pages_are_two_binds(void **state)
{
    struct fixture *f = *state;
    bind(f, 0, 0, 0, 0);
    bind(f, 1, 0, 1, 1);
    slc_bind_list_clear(&f->list);
    slc_sparse_bindings_evict(&f->bindings, 0, at(0));
    slc_sparse_bindings_evict(&f->bindings, 1, at(0));
    assert_int_equal(bind(f, 0, 0, 1, 1), 1); /* the unbind of the other tile comes first */
    assert_int_equal(bind(f, 1, 0, 0, 0), SLC_NO_IMAGE);
    slc_bind_list_build_runs(&f->list);
    assert_int_equal(f->list.run_count, 2);
    check_entry(f, 0, 0, 0, 1, 1);
    check_entry(f, 1, 1, 0, 0, 0);
}

/* Each tile gets the slot that the other had. The slots are exchanged, and nothing is bound. */
static void tiles_get_their_old_pages_back_whatever_slots_they_are_given(void **state)
{
    struct fixture *f = *state;
    bind(f, 0, 5, 1, 7);
    bind(f, 2, 9, 1, 8);
    slc_bind_list_clear(&f->list);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    slc_sparse_bindings_evict(&f->bindings, 2, at(9));
    assert_true(slc_sparse_bindings_restore(&f->bindings, 0, at(5), 1, 8));
    assert_false(
        slc_sparse_bindings_restore(&f->bindings, 0, at(5), 1, 7)); /* it is not evicted now */
    assert_int_equal(bind(f, 2, 9, 1, 7), SLC_NO_IMAGE);
    assert_int_equal(f->list.count, 0);
    assert_int_equal(f->bindings.unbinds_saved, 2);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    assert_int_equal(bind(f, 1, 3, 1, 8), 0); /* by the slot, which stands for page 7 now */
    check_entry(f, 0, 0, 5, SLC_UNBIND, 0);
    check_entry(f, 1, 1, 3, 1, 7);
}

static void tile_does_not_get_back_what_another_heap_or_tile_has(void **state)
{
    struct fixture *f = *state;
    assert_false(
        slc_sparse_bindings_restore(&f->bindings, 0, at(5), 1, 7)); /* it never was there */
    bind(f, 0, 5, 1, 7);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    assert_false(slc_sparse_bindings_restore(&f->bindings, 0, at(5), 2, 7));
    assert_int_equal(bind(f, 2, 9, 1, 7), 0);
    assert_false(slc_sparse_bindings_restore(&f->bindings, 0, at(5), 1, 8));
    assert_int_equal(f->bindings.unbinds_saved, 0);
}

static void list_without_room_for_two_changes_nothing(void **state)
{
    struct fixture *f = *state;
    bind(f, 0, 5, 1, 7);
    slc_sparse_bindings_evict(&f->bindings, 0, at(5));
    while (f->list.count < CAPACITY - 1)
        slc_bind_list_put(&f->list, 3, at(f->list.count), 0, 0);
    uint32_t unbound, image;
    assert_false(slc_sparse_bindings_bind(&f->bindings, &f->list, 1, at(1), 1, 7, &unbound));
    assert_int_equal(f->list.count, CAPACITY - 1);
    slc_bind_list_put(&f->list, 3, at(100), 0, 0);
    assert_false(slc_sparse_bindings_unbind(&f->bindings, &f->list, 1, 7, &image));
    slc_bind_list_clear(&f->list);
    assert_true(slc_sparse_bindings_unbind(&f->bindings, &f->list, 1, 7, &image));
    assert_int_equal(image, 0);
    check_entry(f, 0, 0, 5, SLC_UNBIND, 0);
    assert_true(slc_sparse_bindings_unbind(&f->bindings, &f->list, 1, 7, &image));
    assert_int_equal(image, SLC_NO_IMAGE);
    assert_int_equal(f->list.count, 1);
}

static void image_that_is_gone_leaves_its_pages_free(void **state)
{
    struct fixture *f = *state;
    for (uint32_t x = 0; x < 5; x++)
        bind(f, x % 2, x, 0, x);
    slc_sparse_bindings_evict(&f->bindings, 0, at(2));
    slc_sparse_bindings_drop_image(&f->bindings, 0);
    assert_int_equal(f->bindings.unbinds_saved, 1);
    for (uint32_t slot = 0; slot < 5; slot += 2)
        assert_int_equal(bind(f, 3, slot, 0, slot), SLC_NO_IMAGE);
    slc_sparse_bindings_evict(&f->bindings, 1, at(3));
    assert_int_equal(bind(f, 3, 3, 0, 3), 1);
}

static void heap_ids_may_be_far_apart(void **state)
{
    struct fixture *f = *state;
    CHECK_RESULT(slc_sparse_bindings_add_heap(&f->bindings, &f->cb, UINT32_MAX, HEAP),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    bind(f, 0, 1, 2, 15);
    CHECK_OK(slc_sparse_bindings_add_heap(&f->bindings, &f->cb, 100, HEAP)); /* moves everything */
    slc_sparse_bindings_evict(&f->bindings, 0, at(1));
    assert_int_equal(bind(f, 1, 1, 2, 15), 0);
    assert_int_equal(bind(f, 1, 2, 100, 15), SLC_NO_IMAGE);
}

/* Bindings of a device: the page of each image and column, or -1. `live`: not evicted. */
struct model {
    int device[IMAGES][COLUMNS];
    bool live[IMAGES][COLUMNS];
    bool taken[HEAPS * HEAP];
};

static void execute(struct fixture *f, struct model *m)
{
    slc_bind_list_build_runs(&f->list);
    for (uint32_t r = 0; r < f->list.run_count; r++) {
        const struct slc_bind_run *run = &f->list.runs[r];
        assert_int_equal(run->row_count, 1);
        for (uint32_t i = 0; i < run->column_count; i++)
            m->device[run->image][run->place.x + i] =
                run->heap_id == SLC_UNBIND ? -1 : (int)(run->heap_id * HEAP + run->slot + i);
    }
    slc_bind_list_clear(&f->list);
    bool seen[HEAPS * HEAP] = {0};
    for (uint32_t i = 0; i < IMAGES; i++)
        for (uint32_t x = 0; x < COLUMNS; x++) {
            int page = m->device[i][x];
            assert_true(page >= 0 || !m->live[i][x]);
            if (page < 0)
                continue;
            assert_false(seen[page]); /* no page belongs to two tiles */
            seen[page] = true;
        }
}

static void pages_never_belong_to_two_tiles_whatever_happens(void **state)
{
    struct fixture *f = *state;
    struct model m = {0};
    for (uint32_t i = 0; i < IMAGES; i++)
        for (uint32_t x = 0; x < COLUMNS; x++)
            m.device[i][x] = -1;
    int pages[IMAGES][COLUMNS];
    uint32_t revived = 0;
    roll_seed(11);
    for (int step = 0; step < 50000; step++) {
        uint32_t image = (uint32_t)roll() % IMAGES, x = (uint32_t)roll() % COLUMNS;
        uint32_t page = (uint32_t)roll() % (HEAPS * HEAP);
        if (m.live[image][x]) {
            slc_sparse_bindings_evict(&f->bindings, image, at(x));
            m.live[image][x] = false;
            m.taken[pages[image][x]] = false;
        } else if (!m.taken[page] && f->list.count < CAPACITY - 2) {
            uint32_t count = f->list.count;
            if (roll() % 2 &&
                slc_sparse_bindings_restore(&f->bindings, image, at(x), page / HEAP, page % HEAP)) {
                assert_int_equal(f->list.count, count);
                revived++;
            } else {
                bind(f, image, x, page / HEAP, page % HEAP);
            }
            m.live[image][x] = m.taken[page] = true;
            pages[image][x] = (int)page;
        }
        if (roll() % 12 == 0)
            execute(f, &m);
        for (uint32_t i = 0; i < IMAGES && f->list.count == 0; i++)
            for (uint32_t c = 0; c < COLUMNS; c++)
                if (m.live[i][c]) /* some page of the slot's heap: others go with theirs */
                    assert_int_equal(m.device[i][c] / HEAP, pages[i][c] / HEAP);
    }
    assert_true(revived > 100);
    assert_true(f->bindings.unbinds_saved > 100 && f->bindings.unbind_count > 100);
}

static void creation_survives_every_allocation_failure(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_sparse_bindings bindings;
        result = slc_sparse_bindings_init(&bindings, &a.callbacks, 3);
        for (uint32_t heap = 0; heap < 3 && result == SLUICE_SUCCESS; heap++)
            result = slc_sparse_bindings_add_heap(&bindings, &a.callbacks, heap, HEAP);
        slc_sparse_bindings_finish(&bindings, &a.callbacks);
        assert_int_equal(a.live_count, 0);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(page_that_was_given_up_is_taken_from_its_tile_when_another_gets_it),
        TEST(neighbors_that_were_given_up_are_unbound_in_the_same_run),
        TEST(pages_of_a_tail_are_unbound_one_by_one),
        TEST(tile_that_gets_another_page_is_bound_over),
        TEST(tile_that_gets_its_page_again_needs_no_bind),
        TEST(swapped_pages_are_two_binds),
        TEST(tiles_get_their_old_pages_back_whatever_slots_they_are_given),
        TEST(tile_does_not_get_back_what_another_heap_or_tile_has),
        TEST(list_without_room_for_two_changes_nothing),
        TEST(image_that_is_gone_leaves_its_pages_free),
        TEST(heap_ids_may_be_far_apart),
        TEST(pages_never_belong_to_two_tiles_whatever_happens),
        cmocka_unit_test(creation_survives_every_allocation_failure),
    };
    return RUN_TESTS(tests);
}
