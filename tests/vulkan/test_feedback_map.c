/* The host's copy of a feedback map follows the results of resolves, and notices damage. */
#include "support/roll.h"
#include "support/test.h"
#include "vulkan/feedback_map.h"

#include <sluice/shared/texture_table.h>

#include <string.h>

enum { MAX_REGIONS = 1000 };

struct fixture {
    uint8_t levels[MAX_REGIONS], truth[MAX_REGIONS];
    uint32_t data[MAX_REGIONS];
    struct slc_feedback_map map;
};

static void begin(struct fixture *f, uint32_t count)
{
    memset(f->truth, SLUICE_MIP_UNTOUCHED, sizeof f->truth);
    slc_feedback_map_init(&f->map, f->levels, count);
}

static uint32_t checksum(const struct fixture *f)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < f->map.region_count; i++)
        sum += slc_resolve_weight(i) * (255u - f->truth[i]);
    return sum;
}

static struct SluiceResolveResult change(struct fixture *f, uint32_t change_count)
{
    struct SluiceResolveResult result = {.state = SLUICE_RESOLVED_CHANGES};
    for (uint32_t i = 0; i < f->map.region_count && result.count < change_count; i++) {
        if ((uint32_t)roll() % f->map.region_count >= change_count)
            continue;
        f->truth[i] = roll() % 3 ? (uint8_t)(roll() % 15) : SLUICE_MIP_UNTOUCHED;
        f->data[result.count++] = i << 8 | f->truth[i];
    }
    result.checksum = checksum(f);
    return result;
}

static struct SluiceResolveResult whole(struct fixture *f)
{
    uint32_t count = f->map.region_count;
    for (uint32_t i = 0; i < count; i++)
        if (roll() % 2)
            f->truth[i] = (uint8_t)(roll() % 15);
    memset(f->data, 0, sizeof f->data);
    for (uint32_t i = 0; i < count; i++)
        f->data[i / 4] |= (uint32_t)f->truth[i] << 8 * (i % 4);
    return (struct SluiceResolveResult){SLUICE_RESOLVED_MAP, (count + 3) / 4, 0, checksum(f)};
}

static void a_map_follows_changes_and_whole_maps(void **state)
{
    (void)state;
    static struct fixture f;
    roll_seed(7);
    const uint32_t counts[] = {1, 2, 3, 4, 5, 63, 256, 999, MAX_REGIONS};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        begin(&f, counts[c]);
        assert_int_equal(f.map.checksum, 0);
        for (int round = 0; round < 200; round++) {
            struct SluiceResolveResult result =
                roll() % 3 ? change(&f, 1 + (uint32_t)roll() % counts[c]) : whole(&f);
            assert_true(slc_feedback_map_update(&f.map, &result, f.data));
            assert_memory_equal(f.levels, f.truth, counts[c]);
        }
    }
}

static void any_wrong_level_is_noticed(void **state)
{
    (void)state;
    static struct fixture f;
    roll_seed(8);
    for (int round = 0; round < 1000; round++) {
        begin(&f, 1 + (uint32_t)roll() % MAX_REGIONS);
        struct SluiceResolveResult result = whole(&f);
        uint32_t region = (uint32_t)roll() % f.map.region_count;
        f.data[region / 4] ^= (1u + (uint32_t)roll() % 255) << 8 * (region % 4);
        assert_false(slc_feedback_map_update(&f.map, &result, f.data));
    }
}

static void a_missed_list_is_noticed_and_a_whole_map_repairs_it(void **state)
{
    (void)state;
    static struct fixture f;
    roll_seed(9);
    begin(&f, 100);
    f.truth[17] = 3; /* never told */
    struct SluiceResolveResult result = {SLUICE_RESOLVED_CHANGES, 0, 0, checksum(&f)};
    assert_false(slc_feedback_map_update(&f.map, &result, f.data));
    result = whole(&f);
    assert_true(slc_feedback_map_update(&f.map, &result, f.data));
    assert_memory_equal(f.levels, f.truth, 100);
}

static void results_beyond_the_map_are_refused(void **state)
{
    (void)state;
    static struct fixture f;
    begin(&f, 10);
    f.data[0] = 10u << 8;
    struct SluiceResolveResult result = {SLUICE_RESOLVED_CHANGES, 1, 0, 0};
    assert_false(slc_feedback_map_update(&f.map, &result, f.data));
    result = (struct SluiceResolveResult){SLUICE_RESOLVED_MAP, 4, 0, 0};
    assert_false(slc_feedback_map_update(&f.map, &result, f.data));
    for (uint32_t i = 0; i < 10; i++)
        assert_int_equal(f.levels[i], SLUICE_MIP_UNTOUCHED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_map_follows_changes_and_whole_maps),
        cmocka_unit_test(any_wrong_level_is_noticed),
        cmocka_unit_test(a_missed_list_is_noticed_and_a_whole_map_repairs_it),
        cmocka_unit_test(results_beyond_the_map_are_refused),
    };
    return RUN_TESTS(tests);
}
