/* The residency machine alone: owners are numbers, tiles are numbers. */
#include "residency/create.h"

#include "base/alloc.h"
#include "residency/defragment.h"
#include "residency/node.h"
#include "residency/node_list.h"
#include "residency/nodes.h"
#include "residency/request_queues.h"
#include "residency/standby.h"
#include "support/test.h"

enum { TILES = 16, HEAP_TILES = 4 };

/** A machine, and what it has told. */
struct rig {
    struct slc_machine machine;
    SluiceAllocationCallbacks cb;
    uint32_t requested[2]; ///< by owner
    bool resident[TILES];
    uint32_t given_up, released, next_heap;
};

static void on_requested(void *user, uint32_t owner, bool now)
{
    struct rig *rig = user;
    rig->requested[owner] += now ? 1 : UINT32_MAX;
}

static void on_resident(void *user, const struct slc_node *node, bool now)
{
    struct rig *rig = user;
    assert_true(rig->resident[node->tile] != now);
    rig->resident[node->tile] = now;
}

static void on_given_up(void *user, uint32_t node, bool now)
{
    struct rig *rig = user;
    assert_int_equal(slc_node_at(&rig->machine, node)->state, SLUICE_TILE_STATE_GIVEN_UP);
    rig->given_up += now ? 1 : UINT32_MAX;
}

static void on_released(void *user, const struct slc_node *node)
{
    struct rig *rig = user;
    assert_false(rig->resident[node->tile]);
    rig->released++;
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *id)
{
    (void)size;
    *id = ((struct rig *)user)->next_heap++;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t id)
{
    (void)user;
    (void)id;
}

static struct rig *make(void)
{
    struct rig *rig = test_calloc(1, sizeof *rig);
    struct slc_machine *r = &rig->machine;
    rig->cb = slc_allocator(NULL);
    r->limits = (struct slc_machine_limits){.standby = 2, .load_attempts = 2, .retry_delay = 10};
    SluiceHeapAllocator heaps = {rig, allocate_heap, release_heap};
    struct slc_machine_user user = {rig, on_requested, on_resident, on_given_up, on_released, NULL};
    CHECK_OK(slc_machine_init(r, &rig->cb, &user, &heaps, HEAP_TILES, 65536));
    assert_true(slc_reserve_nodes(r, TILES));
    return rig;
}

static void destroy(struct rig *rig)
{
    slc_machine_finish(&rig->machine);
    test_free(rig);
}

static void hand_out(struct rig *rig, uint32_t node)
{
    struct slc_machine *r = &rig->machine;
    struct slc_node *n = slc_node_at(r, node);
    uint32_t id;
    SluiceResult answer;
    if (!slc_tile_heaps_take(&r->heaps, node, &n->heap, &n->slot)) {
        CHECK_OK(slc_tile_heaps_add(&r->heaps, &answer, &id));
        assert_true(slc_tile_heaps_take(&r->heaps, node, &n->heap, &n->slot));
    }
    slc_node_handed_out(r, node);
}

static uint32_t load(struct rig *rig, uint32_t owner, uint32_t tile, uint32_t level)
{
    uint32_t node = slc_node_request(&rig->machine, owner, tile, level, 0);
    hand_out(rig, node);
    slc_node_mapped(&rig->machine, node);
    return node;
}

static void coarse_tiles_are_requested_first_of_equals_the_more_needed(void **state)
{
    (void)state;
    struct rig *rig = make();
    struct slc_machine *r = &rig->machine;
    uint32_t fine = slc_node_request(r, 0, 0, 0, 3);
    uint32_t coarse = slc_node_request(r, 1, 1, 4, 0);
    uint32_t needed = slc_node_request(r, 0, 2, 4, 7);
    uint32_t packed = slc_node_request(r, 1, 3, SLC_PACKED_CLASS, 0);
    assert_int_equal(slc_first_request(r), packed);
    assert_int_equal(slc_next_request(r, packed), needed);
    assert_int_equal(slc_next_request(r, needed), coarse);
    assert_int_equal(slc_next_request(r, coarse), fine);
    assert_int_equal(slc_next_request(r, fine), 0);
    assert_int_equal(rig->requested[0], 2);
    assert_int_equal(rig->requested[1], 2);
    slc_node_unwanted(r, fine);
    assert_int_equal(rig->requested[0], 1);
    assert_int_equal(rig->released, 1);
    destroy(rig);
}

static void tile_unwanted_longest_is_evicted_first_and_may_be_restored(void **state)
{
    (void)state;
    struct rig *rig = make();
    struct slc_machine *r = &rig->machine;
    uint32_t nodes[3];
    for (uint32_t i = 0; i < 3; i++)
        nodes[i] = load(rig, 0, i, 0);
    for (uint32_t i = 0; i < 3; i++)
        slc_node_set_state(r, nodes[i], SLUICE_TILE_STATE_STANDBY);
    assert_int_equal(r->standby.count, 2); /* the limit */
    assert_int_equal(r->evicted.head, nodes[0]);
    assert_true(rig->resident[0]); /* until it is unmapped */
    slc_node_wanted(r, nodes[0]);
    assert_int_equal(r->evicted.count, 0);
    assert_int_equal(r->restored_total, 1);
    slc_evict_standby(r, 0);
    assert_int_equal(r->evicted.head, nodes[1]);
    destroy(rig);
}

static void slot_is_free_when_its_retire_value_has_completed(void **state)
{
    (void)state;
    struct rig *rig = make();
    struct slc_machine *r = &rig->machine;
    uint32_t node = load(rig, 0, 5, 1);
    slc_node_retire(r, node, 7);
    assert_false(rig->resident[5]);
    assert_int_equal(rig->released, 1);
    assert_int_equal(r->heaps.free_total, HEAP_TILES - 1);
    r->completed_retire = 6;
    slc_collect_retired(r);
    assert_int_equal(r->heaps.free_total, HEAP_TILES - 1);
    r->completed_retire = 7;
    slc_collect_retired(r);
    assert_int_equal(r->heaps.free_total, HEAP_TILES);
    destroy(rig);
}

static void tile_that_fails_too_often_is_given_up(void **state)
{
    (void)state;
    struct rig *rig = make();
    struct slc_machine *r = &rig->machine;
    uint32_t node = slc_node_request(r, 0, 9, 2, 0);
    for (uint64_t attempt = 0; attempt < 2; attempt++) {
        hand_out(rig, node);
        slc_node_free_slot(r, node);
        slc_node_fail(r, node, 100 * attempt);
        assert_int_equal(rig->given_up, attempt);
        if (attempt == 0) {
            assert_int_equal(slc_node_at(r, node)->order, 10); /* due */
            slc_node_request_again(r, node);
        }
    }
    slc_node_unwanted(r, node);
    assert_int_equal(rig->given_up, 0);
    assert_int_equal(rig->released, 1);
    destroy(rig);
}

static void count_move(void *user, const struct slc_node *node, uint32_t heap_id, uint32_t slot)
{
    (void)slot;
    assert_true(node->heap != heap_id); /* ids are indices here */
    ++*(uint32_t *)user;
}

static void defragmenting_empties_the_least_used_heap(void **state)
{
    (void)state;
    struct rig *rig = make();
    struct slc_machine *r = &rig->machine;
    uint32_t nodes[HEAP_TILES + 1], moves = 0;
    for (uint32_t i = 0; i < HEAP_TILES + 1; i++)
        nodes[i] = load(rig, 0, i, 0);
    slc_node_retire(r, nodes[0], 0);
    struct slc_move_listener listener = {&moves, count_move};
    CHECK_OK(slc_defragment(r, 0, 8, &listener));
    assert_int_equal(moves, 1);
    assert_int_equal(r->heaps.heaps[0].free_count, 0);
    assert_int_equal(r->heaps.heaps[1].free_count, HEAP_TILES);
    destroy(rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarse_tiles_are_requested_first_of_equals_the_more_needed),
        cmocka_unit_test(tile_unwanted_longest_is_evicted_first_and_may_be_restored),
        cmocka_unit_test(slot_is_free_when_its_retire_value_has_completed),
        cmocka_unit_test(tile_that_fails_too_often_is_given_up),
        cmocka_unit_test(defragmenting_empties_the_least_used_heap),
    };
    return RUN_TESTS(tests);
}
