/* Checks trees of boxes node by node, for the properties that walks rely on. */
#include "../../samples/common/box_tree.h"

#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST 3000u

static uint32_t next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static float uniform(uint32_t *state)
{
    return (float)next(state) / 16777216.0f;
}

static void fill(struct box_tree_box *boxes, uint32_t count, float size, uint32_t seed)
{
    for (uint32_t i = 0; i < count; i++)
        for (int axis = 0; axis < 3; axis++) {
            boxes[i].low[axis] = 200.0f * uniform(&seed) - 100.0f;
            boxes[i].high[axis] = boxes[i].low[axis] + size * uniform(&seed);
        }
}

struct visit {
    const struct box_tree *tree;
    const struct box_tree_box *boxes;
    uint32_t leaf_size, deepest, node_count;
    uint8_t seen[MOST]; /* boxes in leaves */
};

static void check_contains(const struct box_tree_node *node, const float low[3],
                           const float high[3])
{
    for (int axis = 0; axis < 3; axis++) {
        assert_true(node->low[axis] <= low[axis]);
        assert_true(node->high[axis] >= high[axis]);
    }
}

static void visit(struct visit *v, uint32_t index, uint32_t depth)
{
    assert_true(index < v->tree->node_count);
    const struct box_tree_node *node = &v->tree->nodes[index];
    v->node_count++;
    v->deepest = depth > v->deepest ? depth : v->deepest;
    assert_true(node->count <= v->leaf_size);
    for (uint32_t i = 0; i < node->count; i++) {
        const uint32_t box = v->tree->order[node->first + i];
        v->seen[box]++;
        check_contains(node, v->boxes[box].low, v->boxes[box].high);
    }
    for (uint32_t i = 0; i < 2 && node->count == 0; i++) {
        const struct box_tree_node *child = &v->tree->nodes[node->first + i];
        check_contains(node, child->low, child->high);
        visit(v, node->first + i, depth + 1);
    }
}

/** Returns the depth of the deepest leaf. */
static uint32_t check_tree(const struct box_tree_box *boxes, uint32_t count, uint32_t leaf_size)
{
    static struct visit v;
    struct box_tree tree;
    assert_true(box_tree_build(boxes, count, leaf_size, &tree));
    v = (struct visit){.tree = &tree, .boxes = boxes, .leaf_size = leaf_size};
    visit(&v, 0, 0);
    assert_int_equal(v.node_count, tree.node_count);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(v.seen[i], 1);
    box_tree_finish(&tree);
    return v.deepest;
}

static void each_box_is_in_one_leaf_and_in_all_nodes_above(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 2, 3, 4, 5, 8, 9, 100, MOST};
    static struct box_tree_box boxes[MOST];
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        for (uint32_t leaf_size = 1; leaf_size <= 4; leaf_size += 3) {
            fill(boxes, counts[i], i % 2 ? 0.0f : 30.0f, 7 + (uint32_t)i);
            assert_true(check_tree(boxes, counts[i], leaf_size) <= BOX_TREE_MOST_DEPTH);
        }
}

static void no_boxes_give_no_nodes(void **state)
{
    (void)state;
    struct box_tree tree;
    assert_true(box_tree_build(NULL, 0, 4, &tree));
    assert_int_equal(tree.node_count, 0);
    box_tree_finish(&tree);
    box_tree_finish(&tree);
}

static void equal_boxes_at_one_place_are_halved(void **state)
{
    (void)state;
    static struct box_tree_box boxes[MOST];
    memset(boxes, 0, sizeof boxes);
    assert_int_equal(check_tree(boxes, 2048, 1), 11);
    assert_int_equal(check_tree(boxes, 2048, 4), 9);
}

/* Each plane between bins splits off one or two boxes. Without a limit leaves would be 250 deep. */
static void boxes_at_powers_of_two_stay_within_the_depth(void **state)
{
    (void)state;
    static struct box_tree_box boxes[MOST];
    for (int i = 0; i < 240; i++)
        for (int axis = 0; axis < 3; axis++)
            boxes[i].low[axis] = boxes[i].high[axis] = axis == 1 ? ldexpf(1.0f, i - 120) : 0.0f;
    const uint32_t depth = check_tree(boxes, 240, 1);
    assert_in_range(depth, 20, BOX_TREE_MOST_DEPTH);
}

static void numbers_that_are_not_finite_do_no_harm(void **state)
{
    (void)state;
    static const float strange[] = {NAN, INFINITY, -INFINITY, 3.0e38f, -3.0e38f};
    static struct box_tree_box boxes[MOST];
    uint32_t seed = 5;
    fill(boxes, 500, 1.0f, 3);
    for (uint32_t i = 0; i < 500; i += 3) {
        boxes[i].low[next(&seed) % 3] = strange[next(&seed) % 5];
        boxes[i].high[next(&seed) % 3] = strange[next(&seed) % 5];
    }
    struct box_tree tree;
    uint8_t seen[500] = {0};
    assert_true(box_tree_build(boxes, 500, 2, &tree));
    for (uint32_t i = 0; i < 500; i++)
        seen[tree.order[i]]++;
    for (uint32_t i = 0; i < 500; i++)
        assert_int_equal(seen[i], 1);
    box_tree_finish(&tree);
}

static void the_same_boxes_give_the_same_tree(void **state)
{
    (void)state;
    static struct box_tree_box boxes[MOST];
    struct box_tree one, other;
    fill(boxes, MOST, 5.0f, 11);
    assert_true(box_tree_build(boxes, MOST, 2, &one));
    assert_true(box_tree_build(boxes, MOST, 2, &other));
    assert_int_equal(one.node_count, other.node_count);
    assert_memory_equal(one.nodes, other.nodes, one.node_count * sizeof *one.nodes);
    assert_memory_equal(one.order, other.order, MOST * sizeof *one.order);
    box_tree_finish(&one);
    box_tree_finish(&other);
}

/** Sum of the areas of all nodes relative to the root's: expected number of boxes that a random ray
 * enters. */
static double cost(const struct box_tree *tree)
{
    double sum = 0.0, root = 0.0;
    for (uint32_t i = 0; i < tree->node_count; i++) {
        const struct box_tree_node *n = &tree->nodes[i];
        const double x = n->high[0] - n->low[0], y = n->high[1] - n->low[1],
                     z = n->high[2] - n->low[2];
        sum += x * y + y * z + z * x;
        root = i == 0 ? sum : root;
    }
    return sum / root;
}

/* Compares with trees of equally many nodes and boxes that split the list in the middle. */
static void trees_cost_less_than_halves_of_the_list(void **state)
{
    (void)state;
    static struct box_tree_box boxes[MOST], flat[MOST];
    struct box_tree tree, naive;
    fill(boxes, 2048, 1.0f, 19);
    memset(flat, 0, sizeof flat);
    assert_true(box_tree_build(boxes, 2048, 1, &tree));
    assert_true(box_tree_build(flat, 2048, 1, &naive));
    for (uint32_t i = naive.node_count; i-- > 0;) { /* children follow their parents */
        struct box_tree_node *n = &naive.nodes[i];
        struct box_tree_box box = box_tree_empty_box();
        for (uint32_t c = 0; c < 2; c++) {
            const struct box_tree_box *leaf = &boxes[naive.order[n->count ? n->first : 0]];
            const struct box_tree_node *child = &naive.nodes[n->count ? i : n->first + c];
            box_tree_add_point(&box, n->count ? leaf->low : child->low);
            box_tree_add_point(&box, n->count ? leaf->high : child->high);
        }
        memcpy(n->low, box.low, sizeof n->low);
        memcpy(n->high, box.high, sizeof n->high);
    }
    assert_true(cost(&tree) < 0.2 * cost(&naive));
    box_tree_finish(&tree);
    box_tree_finish(&naive);
}

static void a_canceled_build_leaves_nothing(void **state)
{
    (void)state;
    struct box_tree_box boxes[100];
    struct box_tree tree;
    atomic_bool canceled = true;
    for (int i = 0; i < 100; i++)
        boxes[i] = (struct box_tree_box){{(float)i, 0, 0}, {(float)i + 1, 1, 1}};
    assert_false(box_tree_build_until(boxes, 100, 2, 20, &canceled, &tree));
    assert_null(tree.nodes);
    assert_int_equal(tree.node_count, 0);
    canceled = false;
    assert_true(box_tree_build_until(boxes, 100, 2, 20, &canceled, &tree));
    box_tree_finish(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_box_is_in_one_leaf_and_in_all_nodes_above),
        cmocka_unit_test(no_boxes_give_no_nodes),
        cmocka_unit_test(a_canceled_build_leaves_nothing),
        cmocka_unit_test(equal_boxes_at_one_place_are_halved),
        cmocka_unit_test(boxes_at_powers_of_two_stay_within_the_depth),
        cmocka_unit_test(numbers_that_are_not_finite_do_no_harm),
        cmocka_unit_test(the_same_boxes_give_the_same_tree),
        cmocka_unit_test(trees_cost_less_than_halves_of_the_list),
    };
    return RUN_TESTS(tests);
}
