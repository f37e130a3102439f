/* Boxes: which are refused, which are widened, and what is written into the caller's memory. */
#include "support/test.h"

#include <sluice/proxy.h>

#include "demand/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static SluiceProxySet *create(void)
{
    SluiceProxySet *set;
    const SluiceProxySetCreateInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateProxySet(&info, &set));
    return set;
}

static float random_float(uint64_t *seed, float scale)
{
    return scale * ((float)random_below(seed, 1u << 24) / (1 << 23) - 1);
}

/* At least half of the sides are of zero thickness, or almost so. */
static SluiceProxyBox random_thin_box(uint64_t *seed)
{
    SluiceProxyBox box;
    float scale = ldexpf(1, (int)random_below(seed, 120) - 60);
    for (uint32_t axis = 0; axis < 3; axis++) {
        float a = random_float(seed, scale), b = random_float(seed, scale);
        uint32_t kind = axis == 2 ? 4 : random_below(seed, 4);
        b = kind < 2 ? a : kind == 2 ? nextafterf(a, b) : b;
        box.min[axis] = fminf(a, b);
        box.max[axis] = fmaxf(a, b);
    }
    return box;
}

static void boxes_of_zero_thickness_become_thick_enough_to_be_hit(void **state)
{
    (void)state;
    SluiceProxySet *set = create();
    uint64_t seed = 3;
    for (uint32_t i = 0; i < 5000; i++) {
        SluiceProxyBox box = random_thin_box(&seed), got;
        SluiceProxyId id;
        double largest = 0;
        CHECK_OK(sluiceAddGeometryProxy(set, &box, &id));
        CHECK_OK(sluiceGetProxyBox(set, id, &got));
        for (uint32_t axis = 0; axis < 3; axis++)
            largest = fmax(largest, fmax(fabs(box.min[axis]), fabs(box.max[axis])));
        for (uint32_t axis = 0; axis < 3; axis++) {
            double thickness = (double)got.max[axis] - got.min[axis], least = ldexp(largest, -20);
            assert_true(got.min[axis] <= box.min[axis] && got.max[axis] >= box.max[axis]);
            assert_true(thickness >= 0.75 * least); /* the rest is rounding */
            if ((double)box.max[axis] - box.min[axis] > 1.01 * least)
                assert_true(got.min[axis] == box.min[axis] && got.max[axis] == box.max[axis]);
            else
                assert_true(thickness <= 2.2 * least);
        }
    }
    sluiceDestroyProxySet(set);
}

static void degenerate_boxes_are_refused(void **state)
{
    (void)state;
    static const SluiceProxyBox boxes[] = {
        {{NAN, 0, 0}, {1, 1, 1}},       {{0, 0, 0}, {1, NAN, 1}},
        {{0, 0, -INFINITY}, {1, 1, 1}}, {{0, 0, 0}, {1, INFINITY, 1}},
        {{0, 2, 0}, {1, 1, 1}},         {{3, 4, 5}, {3, 4, 5}},
        {{0, 0, 0}, {0, 0, 0}},         {{0, 0, 0}, {1e-38f, 1e-38f, 1e-38f}},
        {{0, 0, 0}, {2e30f, 1, 1}},     {{-2e30f, 0, 0}, {1, 1, 1}}};
    SluiceProxySet *set = create();
    for (uint32_t i = 0; i < sizeof boxes / sizeof *boxes; i++) {
        SluiceProxyId id = 7;
        CHECK_RESULT(sluiceAddGeometryProxy(set, &boxes[i], &id), SLUICE_ERROR_INVALID_ARGUMENT);
        assert_true(id == 7);
    }
    SluiceProxySetInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetProxySetInfo(set, &info));
    assert_int_equal(info.proxyCount, 0);
    sluiceDestroyProxySet(set);
}

enum { MOST = 1000, BUFFERS = 3 };

/* The caller's memory: what was last written into it, and how far it is. */
struct memory {
    SluiceProxyBox boxes[MOST], before[MOST];
    uint64_t version;
    uint32_t range_capacity, ranges_written;
};

static void write(const SluiceProxySet *set, struct memory *memory)
{
    SluiceProxyRange ranges[8];
    uint32_t count = 77;
    const SluiceProxyBoxWrite info = {.structSize = sizeof info,
                                      .capacity = MOST,
                                      .pBoxes = memory->boxes,
                                      .rangeCapacity = memory->range_capacity,
                                      .pRanges = ranges};
    memcpy(memory->before, memory->boxes, sizeof memory->boxes);
    CHECK_OK(sluiceWriteProxyBoxes(set, &info, &memory->version, &count));
    assert_in_range(count, 0, memory->range_capacity);
    uint32_t at = 0;
    for (uint32_t i = 0; i <= count; i++) { /* between ranges nothing is touched */
        uint32_t end = i < count ? ranges[i].first : MOST;
        assert_true(end >= at);
        assert_memory_equal(memory->boxes + at, memory->before + at,
                            (end - at) * sizeof *memory->boxes);
        at = i < count ? ranges[i].first + ranges[i].count : MOST;
    }
    memory->ranges_written += count;
    CHECK_OK(sluiceWriteProxyBoxes(set, &info, &memory->version, &count));
    assert_int_equal(count, 0); /* nothing has changed since */
}

static void check_memory(const SluiceProxySet *set, const SluiceProxyId *ids,
                         const struct memory *memory)
{
    SluiceProxySetInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetProxySetInfo(set, &info));
    for (uint32_t i = 0; i < info.indexCount; i++) {
        SluiceProxyBox box;
        if (ids[i] == SLUICE_NO_PROXY) {
            box = memory->boxes[i]; /* a point */
            assert_memory_equal(box.min, box.max, sizeof box.min);
            assert_true(fabsf(box.min[0]) < 0x1p61f);
            continue;
        }
        CHECK_OK(sluiceGetProxyBox(set, ids[i], &box));
        assert_memory_equal(&memory->boxes[i], &box, sizeof box);
    }
}

static void check_bounds(const SluiceProxySet *set, const SluiceProxyId *ids)
{
    SluiceProxyBox bounds, box,
        all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < MOST; i++) {
        if (ids[i] == SLUICE_NO_PROXY)
            continue;
        CHECK_OK(sluiceGetProxyBox(set, ids[i], &box));
        for (uint32_t axis = 0; axis < 3; axis++) {
            all.min[axis] = box.min[axis] < all.min[axis] ? box.min[axis] : all.min[axis];
            all.max[axis] = box.max[axis] > all.max[axis] ? box.max[axis] : all.max[axis];
        }
    }
    SluiceResult result = sluiceGetProxyBounds(set, &bounds);
    CHECK_RESULT(result, isinf(all.min[0]) ? SLUICE_NOT_READY : SLUICE_SUCCESS);
    if (result == SLUICE_SUCCESS)
        assert_memory_equal(&bounds, &all, sizeof all);
}

/* Few at first, then up to `MOST`, then few again: the last index goes up and down. */
static void change(SluiceProxySet *set, SluiceProxyId *ids, uint32_t *live, uint32_t wanted,
                   uint64_t *seed)
{
    const SluiceProxyRequests none = {.structSize = sizeof none};
    while (*live < wanted) {
        SluiceProxyBox box = random_thin_box(seed);
        SluiceProxyId id;
        CHECK_OK(sluiceAddGeometryProxy(set, &box, &id));
        assert_in_range((uint32_t)id, 0, MOST - 1);
        ids[(uint32_t)id] = id;
        ++*live;
    }
    for (uint32_t i = 0; *live > wanted; i = random_below(seed, MOST)) {
        if (ids[i] == SLUICE_NO_PROXY)
            continue;
        CHECK_OK(sluiceRemoveProxy(set, ids[i]));
        ids[i] = SLUICE_NO_PROXY;
        --*live;
    }
    if (random_below(seed, 2)) /* sometimes indices stay taken for a while */
        CHECK_OK(sluiceAddProxyRequests(set, &none));
}

static void only_changed_boxes_are_written_into_any_number_of_buffers(void **state)
{
    (void)state;
    SluiceProxySet *set = create();
    SluiceProxyId *ids = calloc(MOST, sizeof *ids);
    struct memory *memories = calloc(BUFFERS, sizeof *memories);
    uint64_t seed = 9;
    uint32_t live = 0;
    assert_true(ids && memories);
    for (uint32_t i = 0; i < BUFFERS; i++)
        memories[i].range_capacity = 1 + 3 * i;
    for (uint32_t step = 0; step < 300; step++) {
        struct memory *memory = &memories[random_below(&seed, BUFFERS)];
        uint32_t most = step < 100 ? 90 : 400; /* removed ones may wait for their indices */
        change(set, ids, &live, step % 7 == 0 ? 0 : random_below(&seed, most), &seed);
        if (step % 11 == 0)
            CHECK_OK(sluiceAddProxyRequests(
                set, &(SluiceProxyRequests){.structSize = sizeof(SluiceProxyRequests)}));
        write(set, memory);
        check_memory(set, ids, memory);
        check_bounds(set, ids);
    }
    free(memories);
    free(ids);
    sluiceDestroyProxySet(set);
}

static void a_change_of_one_box_writes_one_group(void **state)
{
    (void)state;
    SluiceProxySet *set = create();
    struct memory *memory = calloc(1, sizeof *memory);
    SluiceProxyId ids[MOST];
    SluiceProxyRange ranges[4];
    uint32_t count;
    const SluiceProxyBox unit = {{0, 0, 0}, {1, 1, 1}};
    assert_non_null(memory);
    for (uint32_t i = 0; i < MOST; i++)
        CHECK_OK(sluiceAddGeometryProxy(set, &unit, &ids[i]));
    SluiceProxyBoxWrite info = {.structSize = sizeof info,
                                .capacity = MOST,
                                .pBoxes = memory->boxes,
                                .rangeCapacity = 4,
                                .pRanges = ranges};
    CHECK_OK(sluiceWriteProxyBoxes(set, &info, &memory->version, &count));
    assert_int_equal(count, 1);
    assert_true(ranges[0].first == 0 && ranges[0].count == MOST);
    CHECK_OK(sluiceRemoveProxy(set, ids[130]));
    CHECK_OK(sluiceRemoveProxy(set, ids[MOST - 1]));
    CHECK_OK(sluiceWriteProxyBoxes(set, &info, &memory->version, &count));
    assert_int_equal(count, 2);
    assert_true(ranges[0].first == 128 && ranges[0].count == 64);
    assert_true(ranges[1].first == 960 && ranges[1].count == 40);
    info.capacity = MOST - 2; /* one less than there are */
    CHECK_RESULT(sluiceWriteProxyBoxes(set, &info, &memory->version, &count),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    info.capacity = MOST;
    info.rangeCapacity = 0;
    CHECK_RESULT(sluiceWriteProxyBoxes(set, &info, &memory->version, &count),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    free(memory);
    sluiceDestroyProxySet(set);
}

/* The caller passes the number of boxes as the capacity of memory that has room for more. One index
 * behind them becomes free before those between. */
static void boxes_between_are_written_when_the_last_index_rises(void **state)
{
    enum { COUNT = 200, KEPT = 10, FAR = 150 };
    (void)state;
    SluiceProxySet *set = create();
    SluiceProxyId ids[COUNT], id;
    SluiceProxyBox boxes[COUNT];
    SluiceProxyRange ranges[8];
    uint64_t version = 0;
    uint32_t count;
    const SluiceProxyBox unit = {{0, 0, 0}, {1, 1, 1}};
    SluiceProxyBoxWrite info = {.structSize = sizeof info,
                                .capacity = KEPT,
                                .pBoxes = boxes,
                                .rangeCapacity = 8,
                                .pRanges = ranges};
    SluiceProxyRequests launch = {.structSize = sizeof launch, .begunLaunch = 1};
    memset(boxes, 0x7F, sizeof boxes);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(sluiceAddGeometryProxy(set, &unit, &ids[i]));
    CHECK_OK(sluiceRemoveProxy(set, ids[FAR]));
    CHECK_OK(sluiceAddProxyRequests(set, &launch));
    for (uint32_t i = KEPT; i < COUNT; i++)
        if (i != FAR)
            CHECK_OK(sluiceRemoveProxy(set, ids[i]));
    CHECK_OK(sluiceWriteProxyBoxes(set, &info, &version, &count));
    launch.begunLaunch = 2;
    launch.processedLaunch = 1;
    CHECK_OK(sluiceAddProxyRequests(set, &launch));
    CHECK_OK(sluiceAddGeometryProxy(set, &unit, &id));
    assert_int_equal((uint32_t)id, FAR);
    info.capacity = FAR + 1;
    CHECK_OK(sluiceWriteProxyBoxes(set, &info, &version, &count));
    for (uint32_t i = 0; i <= FAR; i++) {
        const SluiceProxyBox expected = {{0, 0, 0}, {1, 1, 1}}, hole = {{0, 0, 0}, {0, 0, 0}};
        bool is_live = i < KEPT || i == FAR;
        if (memcmp(&boxes[i], is_live ? &expected : &hole, sizeof hole) != 0)
            fail_msg("box %u is not written", i);
    }
    sluiceDestroyProxySet(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_of_zero_thickness_become_thick_enough_to_be_hit),
        cmocka_unit_test(degenerate_boxes_are_refused),
        cmocka_unit_test(boxes_between_are_written_when_the_last_index_rises),
        cmocka_unit_test(only_changed_boxes_are_written_into_any_number_of_buffers),
        cmocka_unit_test(a_change_of_one_box_writes_one_group),
    };
    return RUN_TESTS(tests);
}
