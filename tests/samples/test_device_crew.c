/* Pictures that devices trace together, without devices: each fills its rows of a picture. */
#include "device_crew.h"

#include "support/test.h"

enum { DEVICES = 3, PICTURES = 8, FIRST = 2, WIDTH = 4, NONE = 99 };

struct rig {
    struct device_crew crew;
    atomic_uint traced[DEVICES][PICTURES], written[PICTURES];
    atomic_uint right; ///< pictures that hold all parts when they are written
    uint32_t failing;  ///< picture
};

/* A share is the device's row; without shares a device fills all. */
static bool trace(void *user_data, uint32_t device, uint32_t index, struct picture *picture)
{
    struct rig *rig = user_data;
    const struct film_share share = device_crew_share(&rig->crew, device);
    for (uint32_t i = 0; i < picture->width * picture->height; i++)
        if (share.count == 0 || i / picture->width % share.count == share.index)
            picture->rgba[i][0] = (float)index;
    atomic_fetch_add(&rig->traced[device][index], 1);
    return index != rig->failing;
}

static bool write_picture(void *user_data, const struct picture *picture, uint32_t index)
{
    struct rig *rig = user_data;
    bool right = true;
    for (uint32_t i = 0; i < picture->width * picture->height; i++)
        right = right && picture->rgba[i][0] == (float)index;
    atomic_fetch_add(&rig->right, right);
    atomic_fetch_add(&rig->written[index], 1);
    return true;
}

static bool run(struct rig *rig, enum split split, uint32_t failing)
{
    static const struct device_crew_calls calls = {.trace = trace, .write = write_picture};
    *rig = (struct rig){.crew = {.calls = &calls,
                                 .user_data = rig,
                                 .split = split,
                                 .first_picture = FIRST,
                                 .end_of_pictures = PICTURES,
                                 .size = {WIDTH, DEVICES},
                                 .device_count = DEVICES},
                        .failing = failing};
    assert_true(device_crew_create_pictures(&rig->crew));
    const bool done = device_crew_trace(&rig->crew);
    device_crew_finish(&rig->crew);
    return done;
}

/** Devices that traced the picture. */
static uint32_t tracers(struct rig *rig, uint32_t index)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < DEVICES; i++)
        sum += atomic_load(&rig->traced[i][index]);
    return sum;
}

static void pictures_are_traced_once(enum split split, uint32_t tracers_of_each)
{
    struct rig rig;
    assert_true(run(&rig, split, NONE));
    for (uint32_t i = 0; i < PICTURES; i++) {
        assert_int_equal(tracers(&rig, i), i < FIRST ? 0 : tracers_of_each);
        assert_int_equal(atomic_load(&rig.written[i]), i < FIRST ? 0 : 1);
    }
    assert_int_equal(atomic_load(&rig.right), PICTURES - FIRST);
    assert_false(atomic_load(&rig.crew.ends));
}

static void all_devices_trace_their_part_of_each_picture(void **state)
{
    (void)state;
    pictures_are_traced_once(SPLIT_FRAME, DEVICES);
}

static void one_device_takes_each_picture_of_the_range(void **state)
{
    (void)state;
    pictures_are_traced_once(SPLIT_ALTERNATE, 1);
}

static void a_picture_that_fails_ends_the_run_and_is_not_written(void **state)
{
    struct rig rig;
    (void)state;
    for (int split = SPLIT_FRAME; split <= SPLIT_ALTERNATE; split++) {
        assert_false(run(&rig, (enum split)split, FIRST + 1));
        assert_true(atomic_load(&rig.crew.ends));
        assert_int_equal(atomic_load(&rig.written[FIRST]), 1);
        assert_int_equal(atomic_load(&rig.written[FIRST + 1]), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_devices_trace_their_part_of_each_picture),
        cmocka_unit_test(one_device_takes_each_picture_of_the_range),
        cmocka_unit_test(a_picture_that_fails_ends_the_run_and_is_not_written),
    };
    return RUN_TESTS(tests);
}
