#include "image/pairing_heap.h"

#include "support/test.h"

struct item {
    int key;
    struct slc_heap_node node;
};

static bool is_smaller(const struct slc_heap_node *a, const struct slc_heap_node *b)
{
    return SLC_CONTAINER_OF(a, struct item, node)->key <
           SLC_CONTAINER_OF(b, struct item, node)->key;
}

static int smallest(const struct item *items, int count)
{
    int best = -1;
    for (int i = 0; i < count; i++)
        if (slc_heap_node_is_in(&items[i].node) && (best < 0 || items[i].key < items[best].key))
            best = i;
    return best;
}

/* Keys are distinct. After any removal, the smallest remaining key is in front. */
static void the_smallest_is_in_front_whatever_comes_and_goes(void **state)
{
    (void)state;
    enum { COUNT = 60, STEPS = 50000 };
    static struct item items[COUNT];
    struct slc_pairing_heap heap = {NULL, is_smaller};
    uint32_t random = 1;
    for (int step = 0; step < STEPS; step++) {
        random = random * 1664525u + 1013904223u;
        struct item *item = &items[(random >> 8) % COUNT];
        bool takes_first = (random >> 28) < 3 && heap.root;
        if (takes_first)
            item = SLC_CONTAINER_OF(heap.root, struct item, node);
        if (slc_heap_node_is_in(&item->node)) {
            if (step % 3 == 0)
                item->key = -1; /* the key of a removed item may have changed */
            slc_pairing_heap_remove(&heap, &item->node);
        } else {
            item->key = (int)(random % 1000) * COUNT + (int)(item - items);
            slc_pairing_heap_add(&heap, &item->node);
        }
        int best = smallest(items, COUNT);
        assert_ptr_equal(heap.root, best < 0 ? NULL : &items[best].node);
    }
}

static void sorted_input_comes_out_sorted(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    static struct item items[COUNT];
    struct slc_pairing_heap heap = {NULL, is_smaller};
    for (int turn = 0; turn < 2; turn++) {
        for (int i = 0; i < COUNT; i++) {
            items[i].key = turn ? COUNT - 1 - i : i;
            slc_pairing_heap_add(&heap, &items[i].node);
        }
        for (int i = 0; i < COUNT; i++) {
            struct slc_heap_node *first = heap.root;
            assert_int_equal(SLC_CONTAINER_OF(first, struct item, node)->key, i);
            slc_pairing_heap_remove(&heap, first);
            assert_false(slc_heap_node_is_in(first));
        }
        assert_null(heap.root);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_smallest_is_in_front_whatever_comes_and_goes),
        cmocka_unit_test(sorted_input_comes_out_sorted),
    };
    return RUN_TESTS(tests);
}
