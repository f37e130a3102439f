/* The C twins of the shaders' functions against exact arithmetic, over the whole range of float. */
#include "extremes/numerics.h"

#include "support/test.h"
#include "vulkan/shader_twins.h"

static void check_function(uint32_t function)
{
    const struct numerics_function *f = numerics_find(function);
    struct extremes_row rows[NUMERICS_ROWS];
    if (!f->call)
        return;
    numerics_begin(f, false, rows);
    uint64_t count = extremes_count(f->quick, f->many);
    for (uint64_t i = 0; i < count; i++) {
        struct NumericsCall call = {0};
        f->make(i, call.arguments);
        f->call(call.arguments, call.results);
        f->check(call.arguments, call.results, false, rows);
    }
    numerics_end(f, false, rows);
}

static void levels_of_detail_are_near_exact_ones(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < NUMERICS_LOD_COUNT; i++)
        check_function(i);
}

static void regions_and_decisions_are_near_exact_ones(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < NUMERICS_REGION_COUNT; i++)
        check_function(NUMERICS_LOD_COUNT + i);
}

/* Returns whether a region of the walk is over the same tile of the level. */
static bool is_walked(const uint32_t *walked, uint32_t count, uint32_t region, uint32_t level)
{
    for (uint32_t i = 0; i < count; i++)
        if (walked[i] >> level == region >> level)
            return true;
    return false;
}

/* Checks a walk from the first to the last region. It passes the end if the last is before the
 * first. */
static void check_walk(uint32_t first, uint32_t last, uint32_t axis_last, uint32_t level,
                       struct extremes_row *row)
{
    uint32_t step = slc_twin_range_step(first, last, axis_last, level), walked[200], count = 1;
    walked[0] = first;
    while (walked[count - 1] != last && count < 200) {
        walked[count] = slc_twin_next_region(walked[count - 1], last, axis_last, step);
        count++;
    }
    uint32_t length = last >= first ? last - first : last + axis_last + 1 - first;
    double missed = count == 200 ? 1e9 : 0;
    if (length >> level < 64) /* longer steps are for more tiles than these */
        missed += step != 1u << level;
    if (step <= 1u << level)
        for (uint32_t at = first;; at = at == axis_last ? 0 : at + 1) {
            missed += !is_walked(walked, count, at, level);
            if (at == last)
                break;
        }
    extremes_add(row, missed, "regions %u to %u of %u, level %u", first, last, axis_last + 1,
                 level);
}

static void walks_over_regions_pass_over_every_tile(void **state)
{
    (void)state;
    struct extremes_row row = {.name = "c.range_step.passed_over", .unit = "tiles"};
    uint32_t most = extremes_are_long() ? 100 : 24;
    for (uint32_t axis_last = 0; axis_last < most; axis_last++)
        for (uint32_t first = 0; first <= axis_last; first++)
            for (uint32_t last = 0; last <= axis_last; last++)
                for (uint32_t level = 0; level < 8; level++)
                    check_walk(first, last, axis_last, level, &row);
    for (uint32_t i = 0; i < 300; i++) {
        uint32_t axis_last = extremes_random(i) % 1024;
        check_walk(extremes_random(i + 1000) % (axis_last + 1),
                   extremes_random(i + 2000) % (axis_last + 1), axis_last, i % 12, &row);
    }
    extremes_end(&row);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_of_detail_are_near_exact_ones),
        cmocka_unit_test(regions_and_decisions_are_near_exact_ones),
        cmocka_unit_test(walks_over_regions_pass_over_every_tile),
    };
    return extremes_begin(argc, argv) ? RUN_TESTS(tests) : 2;
}
