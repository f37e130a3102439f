#include "vulkan/bind_list.h"

#include "base/alloc.h"
#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#define CAPACITY 1024u

static struct slc_tile_place place(uint32_t level, uint32_t x, uint32_t y)
{
    return (struct slc_tile_place){level, x, y};
}

struct fixture {
    struct slc_bind_list list;
    SluiceAllocationCallbacks cb;
};

static int setup(void **state)
{
    struct fixture *f = malloc(sizeof *f);
    f->cb = slc_allocator(NULL);
    CHECK_OK(slc_bind_list_init(&f->list, &f->cb, CAPACITY));
    *state = f;
    return 0;
}

static int teardown(void **state)
{
    struct fixture *f = *state;
    slc_bind_list_finish(&f->list, &f->cb);
    free(f);
    return 0;
}

static void tile_put_twice_keeps_its_last_state(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    slc_bind_list_put(list, 0, place(1, 4, 5), SLC_UNBIND, 0);
    slc_bind_list_put(list, 0, place(1, 4, 5), 3, 7);
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 1);
    assert_int_equal(list->runs[0].heap_id, 3);
    assert_int_equal(list->runs[0].slot, 7);

    slc_bind_list_clear(list);
    slc_bind_list_put(list, 0, place(1, 4, 5), 3, 7);
    slc_bind_list_put(list, 0, place(1, 4, 5), SLC_UNBIND, 0);
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 1);
    assert_int_equal(list->runs[0].heap_id, SLC_UNBIND);
}

static void row_neighbors_with_consecutive_slots_are_one_run(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    slc_bind_list_put(list, 0, place(0, 6, 2), 1, 12);
    slc_bind_list_put(list, 0, place(0, 4, 2), 1, 10);
    slc_bind_list_put(list, 0, place(0, 5, 2), 1, 11);
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 1);
    assert_int_equal(list->runs[0].place.x, 4);
    assert_int_equal(list->runs[0].column_count, 3);
    assert_int_equal(list->runs[0].row_count, 1);
    assert_int_equal(list->runs[0].slot, 10);
}

static void run_ends_where_slot_heap_row_level_or_image_changes(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    slc_bind_list_put(list, 0, place(0, 0, 0), 1, 0);
    slc_bind_list_put(list, 0, place(0, 1, 0), 1, 2); /* slot */
    slc_bind_list_put(list, 0, place(0, 2, 0), 2, 3); /* heap */
    slc_bind_list_put(list, 0, place(0, 3, 1), 2, 4); /* row */
    slc_bind_list_put(list, 0, place(1, 4, 1), 2, 5); /* level */
    slc_bind_list_put(list, 1, place(1, 5, 1), 2, 6); /* image */
    slc_bind_list_put(list, 1, place(1, 7, 1), 2, 7); /* a gap */
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 7);
}

static void unbinds_of_a_row_are_one_run_but_not_with_binds(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    slc_bind_list_put(list, 0, place(0, 0, 0), SLC_UNBIND, 9);
    slc_bind_list_put(list, 0, place(0, 1, 0), SLC_UNBIND, 3);
    slc_bind_list_put(list, 0, place(0, 2, 0), 0, 4);
    slc_bind_list_put(list, 0, place(0, 3, 0), SLC_UNBIND, 5);
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 3);
    assert_int_equal(list->runs[0].column_count, 2);
}

static void put_row(struct slc_bind_list *list, uint32_t y, uint32_t count, uint32_t slot)
{
    for (uint32_t x = 0; x < count; x++)
        slc_bind_list_put(list, 0, place(0, 2 + x, y), slot == SLC_UNBIND ? slot : 1, slot + x);
}

static void rows_with_consecutive_slots_are_one_run(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    put_row(list, 5, 3, 16);
    put_row(list, 3, 3, 10);
    put_row(list, 4, 3, 13);
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 1);
    assert_int_equal(list->runs[0].place.x, 2);
    assert_int_equal(list->runs[0].place.y, 3);
    assert_int_equal(list->runs[0].column_count, 3);
    assert_int_equal(list->runs[0].row_count, 3);
    assert_int_equal(list->runs[0].slot, 10);
}

static void rows_stay_apart_where_width_slot_or_a_gap_is_between_them(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    put_row(list, 0, 3, 10);
    put_row(list, 1, 2, 13); /* width */
    put_row(list, 2, 2, 16); /* slot */
    put_row(list, 4, 2, 18); /* gap */
    put_row(list, 5, 2, SLC_UNBIND);
    put_row(list, 6, 2, SLC_UNBIND); /* unbinds need no order of slots */
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 5);
    assert_int_equal(list->runs[4].row_count, 2);
}

static void pages_of_a_tail_stay_single(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    for (uint32_t i = 0; i < 4; i++)
        slc_bind_list_put(list, 0, place(SLC_TAIL_LEVEL, i, 0), 0, i);
    slc_bind_list_build_runs(list);
    assert_int_equal(list->run_count, 4);
}

static void full_list_refuses(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    for (uint32_t i = 0; i < CAPACITY; i++)
        assert_true(slc_bind_list_put(list, 0, place(0, i, 0), 0, i));
    assert_false(slc_bind_list_put(list, 0, place(0, CAPACITY, 0), 0, 0));
    assert_int_equal(list->count, CAPACITY);
}

#define IMAGES 2u
#define LEVELS 2u
#define SIZE 6u

/* Oracle: an array of what each tile is bound to, painted in the order of the puts. */
static void random_changes_end_in_the_same_bindings_as_one_by_one(void **state)
{
    struct slc_bind_list *list = &((struct fixture *)*state)->list;
    uint32_t tall_run_count = 0;
    roll_seed(7);
    for (int round = 0; round < 300; round++) {
        int64_t wanted[IMAGES][LEVELS][SIZE][SIZE], got[IMAGES][LEVELS][SIZE][SIZE];
        memset(wanted, 0x7F, sizeof wanted);
        memset(got, 0x7F, sizeof got);
        slc_bind_list_clear(list);
        for (int i = roll() % (round % 2 ? 1000 : 200); i >= 0; i--) {
            uint32_t image = (uint32_t)roll() % IMAGES, level = (uint32_t)roll() % LEVELS;
            uint32_t x = (uint32_t)roll() % SIZE, y = (uint32_t)roll() % SIZE;
            uint32_t heap = roll() % 3 ? (uint32_t)roll() % 2 : SLC_UNBIND;
            if (round % 2) /* whole rows */
                heap = image;
            uint32_t slot = roll() % 4 ? y * SIZE + x : (uint32_t)roll() % 50;
            assert_true(slc_bind_list_put(list, image, place(level, x, y), heap, slot));
            wanted[image][level][y][x] = heap == SLC_UNBIND ? -1 : (int64_t)heap << 32 | slot;
        }
        slc_bind_list_build_runs(list);
        for (uint32_t i = 0; i < list->run_count; i++) {
            const struct slc_bind_run *run = &list->runs[i];
            tall_run_count += run->row_count > 1;
            for (uint32_t j = 0; j < run->column_count * run->row_count; j++) {
                uint32_t x = run->place.x + j % run->column_count;
                uint32_t y = run->place.y + j / run->column_count;
                int64_t *tile = &got[run->image][run->place.level][y][x];
                assert_int_equal(*tile, 0x7F7F7F7F7F7F7F7F); /* no range twice */
                *tile =
                    run->heap_id == SLC_UNBIND ? -1 : (int64_t)run->heap_id << 32 | (run->slot + j);
            }
        }
        assert_memory_equal(got, wanted, sizeof got);
    }
    assert_true(tall_run_count > 0);
}

static void creation_survives_every_allocation_failure(void **state)
{
    (void)state;
    for (uint64_t n = 0;; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_bind_list list;
        SluiceResult result = slc_bind_list_init(&list, &a.callbacks, 10);
        if (result == SLUICE_SUCCESS)
            slc_bind_list_finish(&list, &a.callbacks);
        assert_int_equal(a.live_count, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(tile_put_twice_keeps_its_last_state, setup, teardown),
        cmocka_unit_test_setup_teardown(row_neighbors_with_consecutive_slots_are_one_run, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(run_ends_where_slot_heap_row_level_or_image_changes, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(unbinds_of_a_row_are_one_run_but_not_with_binds, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(rows_with_consecutive_slots_are_one_run, setup, teardown),
        cmocka_unit_test_setup_teardown(rows_stay_apart_where_width_slot_or_a_gap_is_between_them,
                                        setup, teardown),
        cmocka_unit_test_setup_teardown(pages_of_a_tail_stay_single, setup, teardown),
        cmocka_unit_test_setup_teardown(full_list_refuses, setup, teardown),
        cmocka_unit_test_setup_teardown(random_changes_end_in_the_same_bindings_as_one_by_one,
                                        setup, teardown),
        cmocka_unit_test(creation_survives_every_allocation_failure),
    };
    return RUN_TESTS(tests);
}
