/* Parts of demand-pbrt's flights that need no device: clusters, the tree of the world, cameras, and
 * the choice of queues. */
#include "../../samples/demand-pbrt/camera_path.h"
#include "../../samples/demand-pbrt/clusters.h"
#include "../../samples/demand-pbrt/world_tree.h"
#include "../../tools/common/gpu_queues.h"

#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST 5000u

static uint32_t next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static void fill(struct box_tree_box *boxes, uint32_t *keys, uint32_t count, uint32_t seed)
{
    for (uint32_t i = 0; i < count; i++) {
        keys[i] = 3 * i + 7;
        for (int axis = 0; axis < 3; axis++) {
            boxes[i].low[axis] = (float)(next(&seed) % 1000);
            boxes[i].high[axis] = boxes[i].low[axis] + 1.0f;
        }
    }
}

struct opening {
    const struct clusters *clusters;
    uint8_t seen[MOST];
    uint32_t steps, most, deepest;
};

/** Opens all nodes, as resolving every box would. */
static void open_all(struct opening *o, uint32_t node, uint32_t depth)
{
    struct cluster_step step = {
        .nodes = malloc((CLUSTERS_FAN * (size_t)o->clusters->size + 1) * sizeof *step.nodes)};
    assert_non_null(step.nodes);
    clusters_open(o->clusters, node, &step);
    o->steps++;
    o->most = step.count > o->most ? step.count : o->most;
    o->deepest = depth > o->deepest ? depth : o->deepest;
    for (uint32_t i = 0; i < step.count; i++)
        if (step.keys)
            o->seen[(step.keys[i] - 7) / 3]++;
        else
            open_all(o, step.nodes[i], depth + 1);
    free(step.nodes);
}

static void each_step_is_bounded_and_everything_comes_once(void **state)
{
    (void)state;
    static const uint32_t counts[] = {2, 33, 300, MOST}, sizes[] = {1, 8, 32, 400};
    static struct box_tree_box boxes[MOST];
    static uint32_t keys[MOST];
    for (size_t c = 0; c < 4; c++)
        for (size_t s = 0; s < 4; s++) {
            struct clusters clusters;
            static struct opening o;
            fill(boxes, keys, counts[c], 11);
            assert_true(clusters_create(boxes, keys, counts[c], sizes[s], NULL, &clusters));
            o = (struct opening){.clusters = &clusters};
            open_all(&o, 0, 1);
            assert_true(o.most <= CLUSTERS_FAN * sizes[s]);
            for (uint32_t i = 0; i < counts[c]; i++)
                assert_int_equal(o.seen[i], 1);
            clusters_finish(&clusters);
        }
}

/* Clusters of 64 out of 5000 are fewer than 256, so one step adds their boxes. */
static void the_way_to_a_cluster_is_short(void **state)
{
    (void)state;
    static struct box_tree_box boxes[MOST];
    static uint32_t keys[MOST];
    static struct opening o;
    struct clusters clusters;
    fill(boxes, keys, MOST, 5);
    assert_true(clusters_create(boxes, keys, MOST, 64, NULL, &clusters));
    o = (struct opening){.clusters = &clusters};
    open_all(&o, 0, 1);
    assert_int_equal(o.deepest, 2);
    assert_int_equal(o.steps, 1 + (clusters.tree.node_count + 1) / 2);
    clusters_finish(&clusters);
}

#define BOX_BIT 0x80000000u
#define NODES (8 * MOST)

/** A tree, and its expected content. */
struct world {
    struct clusters clusters;
    struct world_tree tree;
    struct box_tree_box boxes[MOST];
    uint32_t *parts; ///< part by key
    bool is_there[2][MOST];
    uint8_t seen[2][MOST];
    struct box_tree_node copy[NODES]; ///< nodes reported as written
    uint32_t written;
};

static void note_written(void *user_data, uint32_t first, uint32_t count)
{
    struct world *w = user_data;
    assert_true(first + count <= w->tree.node_count && first + count <= NODES);
    memcpy(w->copy + first, w->tree.nodes + first, count * sizeof *w->copy);
    w->written += count;
}

static void look_at_item(struct world *w, const struct box_tree_node *leaf)
{
    const int kind = leaf->first & BOX_BIT ? WORLD_TREE_BOX : WORLD_TREE_PLACE;
    const uint32_t index = leaf->first & ~BOX_BIT;
    assert_int_equal(leaf->count, 1);
    assert_true(index < MOST && w->is_there[kind][index]);
    assert_memory_equal(leaf->low, w->boxes[index].low, sizeof leaf->low);
    assert_memory_equal(leaf->high, w->boxes[index].high, sizeof leaf->high);
    w->seen[kind][index]++;
}

static void look_at_node(struct world *w, uint32_t index, uint32_t depth)
{
    assert_true(depth <= BOX_TREE_MOST_DEPTH);
    const struct box_tree_node *node = &w->copy[index];
    if (node->count > 0) {
        if (node->first != WORLD_TREE_NOTHING)
            look_at_item(w, node);
        return;
    }
    for (uint32_t i = node->first; i < node->first + 2; i++) {
        const struct box_tree_node *child = &w->copy[i];
        for (int axis = 0; axis < 3 && child->first != WORLD_TREE_NOTHING; axis++) {
            assert_true(node->low[axis] <= child->low[axis]);
            assert_true(node->high[axis] >= child->high[axis]);
        }
        look_at_node(w, i, depth + 1);
    }
}

static void check_world(struct world *w)
{
    w->written = 0;
    assert_true(world_tree_build(&w->tree, note_written, w));
    memset(w->seen, 0, sizeof w->seen);
    look_at_node(w, 0, 0);
    for (int kind = 0; kind < 2; kind++)
        for (uint32_t i = 0; i < MOST; i++)
            assert_int_equal(w->seen[kind][i], w->is_there[kind][i]);
}

static struct world *create_world(uint32_t cluster_size)
{
    static struct world w;
    static uint32_t keys[MOST], own[MOST];
    memset(&w, 0, sizeof w);
    fill(w.boxes, keys, MOST, 3);
    for (uint32_t i = 0; i < MOST; i++)
        own[i] = i;
    if (cluster_size < MOST)
        assert_true(clusters_create(w.boxes, own, MOST, cluster_size, NULL, &w.clusters));
    w.parts = clusters_list_nodes(&w.clusters, MOST);
    assert_non_null(w.parts);
    assert_true(world_tree_create(&w.clusters, BOX_BIT, &w.tree));
    return &w;
}

static void set(struct world *w, int kind, uint32_t index, bool is_there)
{
    w->is_there[kind][index] = is_there;
    assert_true(world_tree_set(&w->tree, (enum world_tree_kind)kind, index,
                               is_there ? w->parts[index] : WORLD_TREE_NO_PART, &w->boxes[index]));
}

static void destroy_world(struct world *w)
{
    world_tree_finish(&w->tree);
    clusters_finish(&w->clusters);
    free(w->parts);
}

static void the_world_has_what_came_and_did_not_leave(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {32, 500, MOST};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        struct world *w = create_world(sizes[s]);
        uint32_t seed = 17;
        check_world(w);
        for (int round = 0; round < 12; round++) {
            const uint32_t count = round % 3 == 2 ? 3 : 900;
            for (uint32_t i = 0; i < count; i++) /* some come, leave and come again in between */
                set(w, (int)(next(&seed) % 2), next(&seed) % 1500, next(&seed) % 3 > 0);
            check_world(w);
        }
        for (uint32_t i = 0; i < 2 * 1500; i++)
            set(w, (int)(i % 2), i / 2, false);
        check_world(w);
        destroy_world(w);
    }
}

/* A box becomes a shape: only its cluster is rebuilt. */
static void only_parts_that_changed_are_built(void **state)
{
    (void)state;
    struct world *w = create_world(64);
    const uint32_t above = 2 + w->clusters.tree.node_count;
    for (uint32_t i = 0; i < MOST; i++)
        set(w, WORLD_TREE_BOX, i, true);
    check_world(w);
    assert_int_equal(w->tree.built_count, MOST);
    for (uint32_t i = 0; i < MOST; i += 611) {
        const uint64_t before = w->tree.built_count;
        set(w, WORLD_TREE_BOX, i, false);
        set(w, WORLD_TREE_PLACE, i, true);
        check_world(w);
        assert_in_range(w->tree.built_count - before, 1, 64);
        assert_in_range(w->written, above, above + 2 * 64);
    }
    check_world(w);
    assert_int_equal(w->written, above);
    destroy_world(w);
}

/* The order of changes does not matter. */
static void equal_worlds_have_equal_parts(void **state)
{
    (void)state;
    static struct box_tree_node tops[2][MOST];
    uint32_t count = 0;
    for (int turn = 0; turn < 2; turn++) {
        struct world *w = create_world(64);
        for (uint32_t i = 0; i < 1000; i++)
            set(w, WORLD_TREE_PLACE, turn ? 999 - i : i, true);
        if (turn)
            check_world(w);
        for (uint32_t i = 0; i < 1000; i += 3)
            set(w, WORLD_TREE_PLACE, i, false);
        check_world(w);
        count = 2 + w->clusters.tree.node_count;
        for (uint32_t i = 0; i < count; i++) {
            tops[turn][i] = w->tree.nodes[i];
            if (i >= 2 && w->clusters.tree.nodes[i - 2].count > 0)
                tops[turn][i].first =
                    0; /* the position of a part's nodes depends on the order of changes */
        }
        destroy_world(w);
    }
    assert_memory_equal(tops[0], tops[1], count * sizeof **tops);
}

/* pbrt's default: the camera at the origin looks along z, y is up. */
static const float plain[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static void assert_matrix(const float m[12], const float expected[12])
{
    for (int i = 0; i < 12; i++)
        assert_true(fabsf(m[i] - expected[i]) < 1e-5f);
}

/* In pbrt's LookAt, x is up cross forward: seen from the south, x is east. */
static void cameras_look_at_points_as_those_of_pbrt(void **state)
{
    (void)state;
    const struct camera_view south = {
        .eye = {0, -5, 0}, .look = {0, 3, 0}, .up = {0, 1, 2}, .given = true, .has_up = true};
    const float expected[12] = {-1, 0, 0, 0, 0, 0, 1, -5, 0, 1, 0, 0};
    float m[12];
    camera_look_at(&south, plain, m);
    assert_matrix(m, expected);
}

static void cameras_keep_mirrors_and_units_of_the_scene(void **state)
{
    (void)state;
    const float like[12] = {-2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0};
    const struct camera_view view = {.eye = {1, 2, 3}, .look = {1, 2, 9}, .given = true};
    const float expected[12] = {-2, 0, 0, 1, 0, 2, 0, 2, 0, 0, 2, 3};
    float m[12];
    camera_look_at(&view, like, m);
    assert_matrix(m, expected);
}

static void looking_straight_up_gives_right_angles(void **state)
{
    (void)state;
    const struct camera_view view = {.look = {0, 7, 0}, .given = true};
    float m[12];
    camera_look_at(&view, plain, m);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const float product = m[a] * m[b] + m[4 + a] * m[4 + b] + m[8 + a] * m[8 + b];
            assert_true(fabsf(product - (a == b ? 1.0f : 0.0f)) < 1e-5f);
        }
}

/** Writes a rotation around y by an angle, at the position x. */
static void turned(double angle, float x, float m[12])
{
    const float c = (float)cos(angle), s = (float)sin(angle);
    const float matrix[12] = {c, 0, s, x, 0, 1, 0, 0, -s, 0, c, 0};
    memcpy(m, matrix, sizeof matrix);
}

static void the_way_between_cameras_turns_evenly(void **state)
{
    (void)state;
    static const double angles[] = {0.001, 0.7, 2.0, 3.1, -2.5};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++)
        for (int step = 0; step <= 8; step++) {
            float from[12], to[12], m[12], expected[12];
            turned(0.3, 0.0f, from);
            turned(0.3 + angles[i], 4.0f, to);
            turned(0.3 + angles[i] * step / 8, 0.5f * (float)step, expected);
            camera_between(from, to, (float)step / 8, m);
            assert_matrix(m, expected);
        }
}

/* Each of the quaternion's components is the largest one in one turn. */
static void half_turns_end_where_they_should(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++)
        for (int mirror = 0; mirror < 2; mirror++) {
            float to[12] = {0}, m[12];
            for (int i = 0; i < 3; i++)
                to[5 * i] = (i == axis ? 1.0f : -1.0f) * (mirror && i == 0 ? -1.0f : 1.0f);
            camera_between(plain, to, 1.0f, m);
            assert_matrix(m, to);
        }
}

#define DRAWS (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT)

/** Chooses queues as gpu.c does, with a sparse queue in family `sparse`. Returns the index of the
 * queue for builds. */
static uint32_t choose(const VkQueueFamilyProperties *families, uint32_t count, uint32_t sparse,
                       struct gpu *gpu, struct gpu_queue_list *list)
{
    *list = (struct gpu_queue_list){0};
    gpu_queue_add(list, families, gpu->family);
    if (sparse != gpu->family)
        gpu_queue_add(list, families, sparse);
    return gpu_queue_add_builder(list, families, count, gpu);
}

static void builds_have_a_queue_that_computes_alone(void **state)
{
    (void)state;
    static const VkQueueFamilyProperties families[] = {
        {DRAWS, 16, 0, {0}}, {VK_QUEUE_TRANSFER_BIT, 2, 0, {0}}, {VK_QUEUE_COMPUTE_BIT, 8, 0, {0}}};
    static struct gpu gpu;
    struct gpu_queue_list list;
    assert_int_equal(choose(families, 3, 0, &gpu, &list), 0);
    assert_int_equal(gpu.build_family, 2);
    assert_int_equal(list.count, 2);
    assert_int_equal(choose(families, 3, 1, &gpu, &list), 0);
    assert_int_equal(gpu.build_family, 2);
    assert_int_equal(list.count, 3);
}

static void builds_never_share_the_queue_of_sparse_binds(void **state)
{
    (void)state;
    VkQueueFamilyProperties families[] = {{DRAWS, 1, 0, {0}}, {VK_QUEUE_COMPUTE_BIT, 2, 0, {0}}};
    static struct gpu gpu;
    struct gpu_queue_list list;
    assert_int_equal(choose(families, 2, 1, &gpu, &list), 1);
    assert_int_equal(gpu.build_family, 1);
    assert_int_equal(list.infos[1].queueCount, 2);
    families[1].queueCount = 1;
    assert_int_equal(choose(families, 2, 1, &gpu, &list), 0);
    assert_int_equal(gpu.build_family, 0);
    assert_int_equal(list.infos[1].queueCount, 1);
}

static void builds_have_the_second_queue_of_a_single_family_or_the_first(void **state)
{
    (void)state;
    VkQueueFamilyProperties family = {DRAWS, 2, 0, {0}};
    static struct gpu gpu;
    struct gpu_queue_list list;
    assert_int_equal(choose(&family, 1, 0, &gpu, &list), 1);
    assert_int_equal(list.infos[0].queueCount, 2);
    family.queueCount = 1;
    assert_int_equal(choose(&family, 1, 0, &gpu, &list), 0);
    assert_int_equal(list.infos[0].queueCount, 1);
    assert_int_equal(list.count, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_step_is_bounded_and_everything_comes_once),
        cmocka_unit_test(the_way_to_a_cluster_is_short),
        cmocka_unit_test(the_world_has_what_came_and_did_not_leave),
        cmocka_unit_test(only_parts_that_changed_are_built),
        cmocka_unit_test(equal_worlds_have_equal_parts),
        cmocka_unit_test(cameras_look_at_points_as_those_of_pbrt),
        cmocka_unit_test(cameras_keep_mirrors_and_units_of_the_scene),
        cmocka_unit_test(looking_straight_up_gives_right_angles),
        cmocka_unit_test(the_way_between_cameras_turns_evenly),
        cmocka_unit_test(half_turns_end_where_they_should),
        cmocka_unit_test(builds_have_a_queue_that_computes_alone),
        cmocka_unit_test(builds_never_share_the_queue_of_sparse_binds),
        cmocka_unit_test(builds_have_the_second_queue_of_a_single_family_or_the_first),
    };
    return RUN_TESTS(tests);
}
