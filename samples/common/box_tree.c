#include "box_tree.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#define BINS 16

struct item {
    struct box_tree_box box;
    uint32_t index;
};

/** Input of a node: items `first` to `first` + `count`. */
struct range {
    uint32_t node, first, count, depth;
};

struct build {
    struct box_tree *tree;
    struct item *items;
    uint32_t leaf_size, depth;
    const atomic_bool *canceled; ///< NULL: never
};

static bool is_canceled(const struct build *build)
{
    return build->canceled && atomic_load(build->canceled);
}

/** A plane across the axis along which the middles of items are spread most. */
struct split {
    int axis;
    float from, scale; ///< bins per unit; 0: nothing is spread
};

struct box_tree_box box_tree_empty_box(void)
{
    return (struct box_tree_box){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}

/* NaN is left out, because comparisons with it are false. */
static void grow(struct box_tree_box *box, const float low[3], const float high[3])
{
    for (int i = 0; i < 3; i++) {
        box->low[i] = low[i] < box->low[i] ? low[i] : box->low[i];
        box->high[i] = high[i] > box->high[i] ? high[i] : box->high[i];
    }
}

void box_tree_add_point(struct box_tree_box *box, const float point[3])
{
    grow(box, point, point);
}

static float half_area(const struct box_tree_box *box)
{
    const float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1],
                z = box->high[2] - box->low[2];
    return x < 0.0f ? 0.0f : x * y + y * z + z * x;
}

static float middle(const struct item *item, int axis)
{
    return 0.5f * item->box.low[axis] + 0.5f * item->box.high[axis];
}

/** Finds the box around all items. */
static struct split measure(const struct item *items, uint32_t count, struct box_tree_box *box)
{
    struct box_tree_box middles = box_tree_empty_box();
    *box = box_tree_empty_box();
    for (uint32_t i = 0; i < count; i++) {
        const float at[3] = {middle(&items[i], 0), middle(&items[i], 1), middle(&items[i], 2)};
        grow(box, items[i].box.low, items[i].box.high);
        grow(&middles, at, at);
    }
    struct split best = {0};
    float widest = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        const float width = middles.high[axis] - middles.low[axis];
        if (!(width > widest))
            continue;
        widest = width;
        best = (struct split){axis, middles.low[axis], BINS / width};
    }
    return best;
}

static int bin_of(const struct split *split, const struct item *item)
{
    const float bin = (middle(item, split->axis) - split->from) * split->scale;
    return bin > 0.0f ? bin < BINS ? (int)bin : BINS - 1 : 0; /* NaN: 0 */
}

struct bins {
    struct box_tree_box boxes[BINS];
    uint32_t counts[BINS];
};

static void fill_bins(const struct split *split, const struct item *items, uint32_t count,
                      struct bins *bins)
{
    for (int i = 0; i < BINS; i++)
        bins->boxes[i] = box_tree_empty_box();
    memset(bins->counts, 0, sizeof bins->counts);
    for (uint32_t i = 0; i < count; i++) {
        const int bin = bin_of(split, &items[i]);
        grow(&bins->boxes[bin], items[i].box.low, items[i].box.high);
        bins->counts[bin]++;
    }
}

/** Finds the first bin of the right side with the least sum of areas times counts. Neither side may
 * have more than `most` items. Returns 0 if no plane meets that. */
static int choose_bin(const struct bins *bins, uint32_t count, uint64_t most)
{
    float right_cost[BINS];
    struct box_tree_box right = box_tree_empty_box(), left = right;
    uint32_t right_count = 0, left_count = 0;
    for (int i = BINS - 1; i > 0; i--) {
        grow(&right, bins->boxes[i].low, bins->boxes[i].high);
        right_count += bins->counts[i];
        right_cost[i] = half_area(&right) * (float)right_count;
    }
    int best = 0;
    float best_cost = FLT_MAX;
    for (int i = 1; i < BINS; i++) {
        grow(&left, bins->boxes[i - 1].low, bins->boxes[i - 1].high);
        left_count += bins->counts[i - 1];
        const float cost = half_area(&left) * (float)left_count + right_cost[i];
        if (left_count == 0 || left_count == count || left_count > most ||
            count - left_count > most || !(cost < best_cost))
            continue;
        best = i;
        best_cost = cost;
    }
    return best;
}

static uint32_t partition(const struct split *split, int bin, struct item *items, uint32_t count)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (bin_of(split, &items[i]) >= bin)
            continue;
        const struct item item = items[i];
        items[i] = items[left];
        items[left++] = item;
    }
    return left;
}

/** Maps a float, NaN included, to an integer that sorts in the same order. */
static uint32_t sortable(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static int compare_middles(const struct item *a, const struct item *b, int axis)
{
    const uint32_t x = sortable(middle(a, axis)), y = sortable(middle(b, axis));
    return x != y ? (x > y) - (x < y) : (a->index > b->index) - (a->index < b->index);
}

static int compare_x(const void *a, const void *b)
{
    return compare_middles(a, b, 0);
}

static int compare_y(const void *a, const void *b)
{
    return compare_middles(a, b, 1);
}

static int compare_z(const void *a, const void *b)
{
    return compare_middles(a, b, 2);
}

/** Sorts items to two sides, each of which fits below the depth. Returns the number on the left. */
static uint32_t divide(const struct build *build, const struct split *split,
                       const struct range *range)
{
    static int (*const compare[3])(const void *, const void *) = {compare_x, compare_y, compare_z};
    const uint64_t most = (uint64_t)build->leaf_size << (build->depth - 1 - range->depth);
    struct item *items = build->items + range->first;
    int bin = 0;
    if (split->scale > 0.0f) {
        struct bins bins;
        fill_bins(split, items, range->count, &bins);
        bin = choose_bin(&bins, range->count, most);
    }
    if (is_canceled(build))
        return range->count / 2;
    if (bin > 0)
        return partition(split, bin, items, range->count);
    qsort(items, range->count, sizeof *items, compare[split->axis]);
    return range->count / 2;
}

/* Returns false if the build was canceled. */
static bool build_nodes(const struct build *build, uint32_t count)
{
    struct box_tree *tree = build->tree;
    struct range stack[BOX_TREE_MOST_DEPTH + 2];
    uint32_t height = 1;
    stack[0] = (struct range){.count = count};
    tree->node_count = 1;
    while (height > 0 && !is_canceled(build)) {
        const struct range range = stack[--height];
        struct box_tree_node *node = &tree->nodes[range.node];
        struct box_tree_box box;
        const struct split split = measure(build->items + range.first, range.count, &box);
        *node = (struct box_tree_node){.first = range.first, .count = range.count};
        memcpy(node->low, box.low, sizeof box.low);
        memcpy(node->high, box.high, sizeof box.high);
        if (range.count <= build->leaf_size)
            continue;
        const uint32_t left = divide(build, &split, &range), next = tree->node_count;
        node->first = next;
        node->count = 0;
        tree->node_count += 2;
        stack[height++] =
            (struct range){next + 1, range.first + left, range.count - left, range.depth + 1};
        stack[height++] = (struct range){next, range.first, left, range.depth + 1};
    }
    return height == 0;
}

bool box_tree_build(const struct box_tree_box *boxes, uint32_t count, uint32_t leaf_size,
                    struct box_tree *tree)
{
    return box_tree_build_within(boxes, count, leaf_size, BOX_TREE_MOST_DEPTH, tree);
}

bool box_tree_build_within(const struct box_tree_box *boxes, uint32_t count, uint32_t leaf_size,
                           uint32_t depth, struct box_tree *tree)
{
    return box_tree_build_until(boxes, count, leaf_size, depth, NULL, tree);
}

bool box_tree_build_until(const struct box_tree_box *boxes, uint32_t count, uint32_t leaf_size,
                          uint32_t depth, const atomic_bool *canceled, struct box_tree *tree)
{
    *tree = (struct box_tree){0};
    if (count == 0)
        return true;
    struct build build = {tree, malloc(count * sizeof *build.items), leaf_size, depth, canceled};
    tree->nodes = malloc((2 * (size_t)count - 1) * sizeof *tree->nodes);
    tree->order = malloc(count * sizeof *tree->order);
    bool done = build.items && tree->nodes && tree->order;
    for (uint32_t i = 0; i < count && done; i++)
        build.items[i] = (struct item){boxes[i], i};
    done = done && build_nodes(&build, count);
    for (uint32_t i = 0; i < count && done; i++)
        tree->order[i] = build.items[i].index;
    free(build.items);
    if (!done)
        box_tree_finish(tree);
    return done;
}

void box_tree_finish(struct box_tree *tree)
{
    free(tree->nodes);
    free(tree->order);
    *tree = (struct box_tree){0};
}
