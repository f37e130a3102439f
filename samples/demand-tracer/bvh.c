#include "bvh.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BINS 12
#define LEAF_TRIANGLES 4
/* Deeper down halves are equal: with 2^19 instances and 2^16 triangles, more than any scene here
 * has, TRACER_STACK_SIZE is enough for a walk. */
#define FREE_DEPTH 12

struct box {
    float low[3], high[3];
};

struct item {
    struct box box;
    uint32_t index;
};

struct build {
    struct bvh *bvh;
    struct item *items;
    uint32_t leaf_size;
};

static const struct box empty_box = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

static void grow(struct box *box, const struct box *other)
{
    for (int i = 0; i < 3; i++) {
        box->low[i] = fminf(box->low[i], other->low[i]);
        box->high[i] = fmaxf(box->high[i], other->high[i]);
    }
}

static float half_area(const struct box *box)
{
    float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1],
          z = box->high[2] - box->low[2];
    return x < 0.0f ? 0.0f : x * y + y * z + z * x;
}

static float middle(const struct item *item, int axis)
{
    return 0.5f * (item->box.low[axis] + item->box.high[axis]);
}

/** A plane across the axis along which the items' middles are spread most. */
struct split {
    int axis;
    float from, to;
};

static struct split choose_axis(const struct item *items, uint32_t count)
{
    struct split best = {0, 0.0f, 0.0f};
    for (int axis = 0; axis < 3; axis++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t i = 0; i < count; i++) {
            low = fminf(low, middle(&items[i], axis));
            high = fmaxf(high, middle(&items[i], axis));
        }
        if (high - low > best.to - best.from)
            best = (struct split){axis, low, high};
    }
    return best;
}

static int bin_of(const struct split *split, const struct item *item)
{
    float share = (middle(item, split->axis) - split->from) / (split->to - split->from);
    int bin = (int)(share * BINS);
    return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

/** The first bin of the right side, where areas times counts are least; 0: no plane helps. */
static int choose_bin(const struct split *split, const struct item *items, uint32_t count)
{
    struct box boxes[BINS], right = empty_box;
    uint32_t counts[BINS] = {0}, right_count = 0;
    float right_cost[BINS];
    for (int i = 0; i < BINS; i++)
        boxes[i] = empty_box;
    for (uint32_t i = 0; i < count; i++) {
        int bin = bin_of(split, &items[i]);
        grow(&boxes[bin], &items[i].box);
        counts[bin]++;
    }
    for (int i = BINS - 1; i > 0; i--) {
        grow(&right, &boxes[i]);
        right_count += counts[i];
        right_cost[i] = half_area(&right) * (float)right_count;
    }
    struct box left = empty_box;
    uint32_t left_count = 0;
    int best = 0;
    float best_cost = FLT_MAX;
    for (int i = 1; i < BINS; i++) {
        grow(&left, &boxes[i - 1]);
        left_count += counts[i - 1];
        float cost = half_area(&left) * (float)left_count + right_cost[i];
        if (left_count > 0 && left_count < count && cost < best_cost) {
            best = i;
            best_cost = cost;
        }
    }
    return best;
}

static int compare_middles(const void *a, const void *b, int axis)
{
    const struct item *left = a, *right = b;
    float x = middle(left, axis), y = middle(right, axis);
    return x < y ? -1 : x > y ? 1 : (left->index > right->index) - (left->index < right->index);
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

/** Sorts the items to two sides; returns how many are left, at least 1. */
static uint32_t divide(struct item *items, uint32_t count, uint32_t depth)
{
    static int (*const compare[3])(const void *, const void *) = {compare_x, compare_y, compare_z};
    struct split split = choose_axis(items, count);
    int bin = split.to > split.from && depth < FREE_DEPTH ? choose_bin(&split, items, count) : 0;
    if (bin == 0) {
        qsort(items, count, sizeof *items, compare[split.axis]);
        return count / 2;
    }
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++)
        if (bin_of(&split, &items[i]) < bin) {
            struct item item = items[i];
            items[i] = items[left];
            items[left++] = item;
        }
    return left;
}

static bool add_nodes(struct bvh *bvh, size_t count, uint32_t *first)
{
    if (bvh->count + count > bvh->capacity) {
        size_t capacity = bvh->capacity ? 2 * bvh->capacity : 4096;
        struct TracerNode *grown = realloc(bvh->nodes, capacity * sizeof *grown);
        if (!grown)
            return false;
        bvh->nodes = grown;
        bvh->capacity = capacity;
    }
    *first = (uint32_t)bvh->count;
    bvh->count += count;
    return true;
}

/** Fills `node` with `count` items from `first` on. */
static bool build_node(struct build *build, uint32_t node, uint32_t first, uint32_t count,
                       uint32_t depth)
{
    struct box box = empty_box;
    for (uint32_t i = 0; i < count; i++)
        grow(&box, &build->items[first + i].box);
    struct TracerNode filled = {.first = first, .count = count};
    memcpy(filled.low, box.low, sizeof box.low);
    memcpy(filled.high, box.high, sizeof box.high);
    if (count <= build->leaf_size) {
        build->bvh->nodes[node] = filled;
        return true;
    }
    uint32_t left = divide(build->items + first, count, depth);
    filled.count = 0;
    if (!add_nodes(build->bvh, 2, &filled.first))
        return false;
    build->bvh->nodes[node] = filled;
    return build_node(build, filled.first, first, left, depth + 1) &&
           build_node(build, filled.first + 1, first + left, count - left, depth + 1);
}

static bool build_hierarchy(struct build *build, uint32_t count, uint32_t *root)
{
    return add_nodes(build->bvh, 1, root) && build_node(build, *root, 0, count, 0);
}

static struct box triangle_box(const struct mesh *mesh, const uint32_t corners[3])
{
    struct box box = empty_box;
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++) {
            float at = mesh->vertices[corners[i]].position[axis];
            box.low[axis] = fminf(box.low[axis], at);
            box.high[axis] = fmaxf(box.high[axis], at);
        }
    return box;
}

bool bvh_add_triangles(struct bvh *bvh, struct mesh *mesh, uint32_t first_index,
                       uint32_t index_count, uint32_t *root)
{
    const uint32_t count = index_count / 3;
    uint32_t *indices = mesh->indices + first_index;
    uint32_t *sorted = malloc(index_count * sizeof *sorted);
    struct build build = {bvh, malloc(count * sizeof *build.items), LEAF_TRIANGLES};
    bool done = sorted && build.items;
    for (uint32_t i = 0; done && i < count; i++)
        build.items[i] = (struct item){triangle_box(mesh, indices + 3 * i), i};
    done = done && build_hierarchy(&build, count, root);
    for (uint32_t i = 0; done && i < count; i++)
        memcpy(sorted + 3 * i, indices + 3 * build.items[i].index, 3 * sizeof *sorted);
    if (done)
        memcpy(indices, sorted, index_count * sizeof *sorted);
    free(build.items);
    free(sorted);
    return done;
}

/** Around the corners of the shape's box. */
static struct box instance_box(const struct bvh *bvh, const struct TracerInstance *instance)
{
    const struct TracerNode *root = &bvh->nodes[instance->rootNode];
    struct box box = empty_box;
    for (int corner = 0; corner < 8; corner++) {
        struct box point;
        for (int row = 0; row < 3; row++) {
            const float *m = instance->toWorld + 4 * row;
            float at = m[3];
            for (int axis = 0; axis < 3; axis++)
                at += m[axis] * (corner >> axis & 1 ? root->high[axis] : root->low[axis]);
            point.low[row] = point.high[row] = at;
        }
        grow(&box, &point);
    }
    return box;
}

bool bvh_add_instances(struct bvh *bvh, const struct TracerInstance *instances, uint32_t count)
{
    struct build build = {bvh, malloc(count * sizeof *build.items), 1};
    if (!build.items)
        return false;
    for (uint32_t i = 0; i < count; i++)
        build.items[i] = (struct item){instance_box(bvh, &instances[i]), i};
    size_t first_node = bvh->count;
    bool done = build_hierarchy(&build, count, &bvh->scene_root);
    for (size_t i = first_node; done && i < bvh->count; i++)
        if (bvh->nodes[i].count > 0)
            bvh->nodes[i].first = build.items[bvh->nodes[i].first].index;
    free(build.items);
    return done;
}

void bvh_finish(struct bvh *bvh)
{
    free(bvh->nodes);
    memset(bvh, 0, sizeof *bvh);
}
