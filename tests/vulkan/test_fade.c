#include "vulkan/fade.h"

#include "support/roll.h"
#include "support/test.h"

static void the_clock_gives_the_steps_that_are_due_and_keeps_the_rest(void **state)
{
    (void)state;
    struct slc_fade_clock clock = {.time_per_level = 1000};
    slc_fade_clock_advance(&clock, 500);
    uint32_t sum = 0;
    for (uint64_t now = 501; now <= 100500; now += 1 + now % 17)
        sum += slc_fade_clock_advance(&clock, now);
    sum += slc_fade_clock_advance(&clock, 100500);
    assert_int_equal(sum, 100 * SLUICE_SHOWN_STEPS);
    assert_int_equal(slc_fade_clock_advance(&clock, 100500), 0);
}

static void no_time_per_level_and_long_pauses_are_at_once(void **state)
{
    (void)state;
    struct slc_fade_clock at_once = {0}, slow = {.time_per_level = SLC_MAX_FADE_TIME};
    assert_int_equal(slc_fade_clock_advance(&at_once, 0), UINT16_MAX);
    assert_int_equal(slc_fade_clock_advance(&at_once, 1), UINT16_MAX);
    assert_int_equal(slc_fade_clock_advance(&slow, SLC_MAX_FADE_TIME), SLUICE_SHOWN_STEPS);
    assert_int_equal(slc_fade_clock_advance(&slow, UINT64_MAX), UINT16_MAX);
    assert_int_equal(slc_fade_clock_advance(&slow, UINT64_MAX), 0);
}

static void texels_sink_by_steps_and_rise_at_once(void **state)
{
    (void)state;
    const uint8_t levels[] = {0, 2, 3, 5, 255, 0, 4};
    uint16_t texels[] = {slc_settled_texel(5),
                         slc_settled_texel(2),
                         slc_settled_texel(2),
                         slc_settled_texel(255),
                         0xFFFF,
                         30,
                         slc_settled_texel(4) + 7};
    assert_true(slc_fade_row(levels, texels, 7, 40));
    assert_int_equal(texels[0], 5 * 256 + 48 - 40);
    assert_int_equal(texels[1], 2 * 256 + 48);
    assert_int_equal(texels[2], 3 * 256 + 48);
    assert_int_equal(texels[3], 5 * 256 + 48); /* the first thing that is there */
    assert_true(texels[4] >= SLUICE_SHOWN_NOTHING);
    assert_int_equal(texels[5], 0);
    assert_int_equal(texels[6], 4 * 256 + 48);
    for (uint32_t i = 0; i < 32; i++)
        assert_true(slc_fade_row(levels, texels, 7, 40));
    assert_false(slc_fade_row(levels, texels, 7, 40)); /* 1328 of them in 34 frames */
}

/* Whatever was there before, a texel never allows more than its level. */
static void texels_never_allow_what_is_not_resident(void **state)
{
    (void)state;
    roll_seed(41);
    for (uint32_t i = 0; i < 100000; i++) {
        uint8_t level = (uint8_t)(roll() % 4 ? roll() % 21 : 255);
        uint16_t before = (uint16_t)roll(), texel = before, steps = (uint16_t)(roll() % 2000);
        bool moves = slc_fade_row(&level, &texel, 1, steps);
        assert_true(texel >= slc_settled_texel(level));
        assert_int_equal(moves, texel != slc_settled_texel(level));
        if (before < SLUICE_SHOWN_NOTHING && texel < before)
            assert_true(before - texel <= steps);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_clock_gives_the_steps_that_are_due_and_keeps_the_rest),
        cmocka_unit_test(no_time_per_level_and_long_pauses_are_at_once),
        cmocka_unit_test(texels_sink_by_steps_and_rise_at_once),
        cmocka_unit_test(texels_never_allow_what_is_not_resident),
    };
    return RUN_TESTS(tests);
}
