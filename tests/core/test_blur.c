/** Picture with working sets larger than the budget, while the camera stands still. */
#include "core/scene.h"

/* 16 textures of 86 tiles, all in view. */
enum { TEXTURES = 16, WORKING_SET = 16 * 86, CAPACITY = 16 };

static struct scene s;

static void open_all_in_view(uint32_t heaps, uint32_t maps_per_frame)
{
    scene_open(&s, CAPACITY, heaps);
    s.maps_per_frame = maps_per_frame;
    for (uint32_t i = 0; i < TEXTURES; i++)
        scene_add(&s, 1024, (struct scene_window){0, 0, 8, 8, 0, 0});
    assert_int_equal(scene_working_set(&s), WORKING_SET);
}

/* 1.5, 4, 10 and 40 times the budget. */
static const uint32_t budgets[] = {57, 21, 8, 2};
enum { BUDGETS = sizeof budgets / sizeof *budgets };

static void every_region_in_view_soon_shows_something_and_from_then_on(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_all_in_view(budgets[b], 4);
        /* A round of maps, a load, and if fine tiles came first: another round and a retirement. */
        scene_run(&s, 2 * scene_round(&s) + 2 * s.load_frames + s.retire_frames + s.timeout_frames);
        for (uint32_t frame = 0; frame < 200; frame++) {
            for (uint32_t i = 0; i < TEXTURES; i++)
                assert_true(scene_shows_something(&s.textures[i]));
            scene_run(&s, 1);
        }
        scene_close(&s);
    }
}

static void check_even(void)
{
    uint32_t least = UINT32_MAX, most = 0;
    for (uint32_t i = 0; i < s.texture_count; i++) {
        uint32_t deficit = scene_deficit(&s.textures[i]);
        least = deficit < least ? deficit : least;
        most = deficit > most ? deficit : most;
    }
    if (most - least > 1100)
        fail_msg("%u slots: from %u to %u thousandths of a level are missing",
                 (unsigned)(s.config.maxHeapCount * CAPACITY), (unsigned)least, (unsigned)most);
}

static void equal_textures_that_are_seen_at_once_are_equally_blurry(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_all_in_view(budgets[b], TEXTURES);
        scene_run(&s, 300);
        check_even();
        scene_close(&s);
    }
}

static void equal_textures_are_equally_blurry(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_all_in_view(budgets[b], 4);
        scene_run(&s, 300);
        check_even();
        scene_close(&s);
    }
}

static void equal_textures_are_equally_blurry_however_slow_the_round_robin(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_all_in_view(budgets[b], 1);
        scene_run(&s, 600);
        check_even();
        scene_close(&s);
    }
}

static void a_texture_that_comes_later_is_as_sharp_as_the_others(void **state)
{
    (void)state;
    scene_open(&s, CAPACITY, 24); /* 384 slots: four and a half textures */
    for (uint32_t i = 0; i < 8; i++) {
        scene_add(&s, 1024, (struct scene_window){0, 0, 8, 8, 0, 0});
        scene_run(&s, 100);
    }
    check_even();
    scene_close(&s);
}

static void the_blur_grows_smoothly_with_the_working_set(void **state)
{
    (void)state;
    uint32_t before = 0;
    /* Budgets that each are three quarters of the one before, from enough to a fortieth. */
    for (uint32_t heaps = 92; heaps >= 2; heaps = heaps * 3 / 4) {
        open_all_in_view(heaps, 4);
        scene_run(&s, 300);
        uint32_t deficit = scene_mean_deficit(&s);
        if (deficit + 100 < before || deficit > before + 1000)
            fail_msg("%u slots: %u thousandths of a level after %u", (unsigned)(heaps * CAPACITY),
                     (unsigned)deficit, (unsigned)before);
        assert_true(heaps != 92 || deficit == 0);
        before = deficit;
        scene_close(&s);
    }
    assert_in_range(before, 2000, 4000); /* a fortieth: between two and a half and three levels */
}

static void more_heaps_sharpen_it_again_until_nothing_is_missing(void **state)
{
    (void)state;
    open_all_in_view(2, 4);
    scene_run(&s, 300);
    uint32_t before = scene_mean_deficit(&s);
    assert_true(fixture_statistics(&s.f).globalMipBias > 0);
    static const uint32_t more[] = {4, 8, 21, 57, 92};
    for (uint32_t i = 0; i < sizeof more / sizeof *more; i++) {
        s.config.maxHeapCount = more[i];
        scene_configure(&s);
        scene_run(&s, 1000);
        uint32_t deficit = scene_mean_deficit(&s);
        assert_true(deficit < before);
        before = deficit;
    }
    assert_int_equal(before, 0);
    assert_int_equal(fixture_statistics(&s.f).globalMipBias, 0);
    assert_int_equal(fixture_statistics(&s.f).requestedTileCount, 0);
    scene_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_region_in_view_soon_shows_something_and_from_then_on),
        cmocka_unit_test(equal_textures_that_are_seen_at_once_are_equally_blurry),
        cmocka_unit_test(equal_textures_are_equally_blurry),
        cmocka_unit_test(equal_textures_are_equally_blurry_however_slow_the_round_robin),
        cmocka_unit_test(a_texture_that_comes_later_is_as_sharp_as_the_others),
        cmocka_unit_test(the_blur_grows_smoothly_with_the_working_set),
        cmocka_unit_test(more_heaps_sharpen_it_again_until_nothing_is_missing),
    };
    return RUN_TESTS(tests);
}
