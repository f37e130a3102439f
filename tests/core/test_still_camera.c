/** Working sets larger than the budget, while the camera stands still. Loading must end. */
#include "core/scene.h"

enum { CAPACITY = 16 };

static struct scene s;

/* 16 textures of which each shows a window, sharp in the middle; `times` the budget in tenths. */
static void open_scene(uint32_t times, uint8_t rings, uint32_t maps_per_frame)
{
    scene_open(&s, CAPACITY, 1);
    s.maps_per_frame = maps_per_frame;
    for (uint32_t i = 0; i < 16; i++)
        scene_add(&s, 2048, (struct scene_window){i % 4, i / 4, 12, 12, 0, rings});
    uint32_t heaps = scene_working_set(&s) * 10 / times / CAPACITY;
    assert_in_range(heaps, 2, FIXTURE_HEAPS);
    s.config.maxHeapCount = heaps;
    scene_configure(&s);
}

static const uint32_t times[] = {15, 40, 100, 400};
enum { TIMES = sizeof times / sizeof *times };

/* Checks that nothing is uploaded for 300 frames and the bias does not change. */
static void check_rest(uint32_t tenths)
{
    uint64_t uploads = s.uploads, unmapped = s.unmapped;
    uint32_t least = UINT32_MAX, most = 0;
    scene_rest(&s);
    for (uint32_t frame = 0; frame < 300; frame++) {
        scene_run(&s, 1);
        uint32_t bias = fixture_statistics(&s.f).globalMipBias;
        least = bias < least ? bias : least;
        most = bias > most ? bias : most;
    }
    if (s.uploads > uploads || s.unmapped > unmapped || most > least)
        fail_msg("%u tenths, %u maps a frame: %u uploads, of one tile %u, bias %u to %u",
                 (unsigned)tenths, (unsigned)s.maps_per_frame, (unsigned)(s.uploads - uploads),
                 (unsigned)scene_most_uploads(&s), (unsigned)least, (unsigned)most);
}

static void uploads_end_some_round_robins_after_the_camera_stands_still(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < TIMES; i++) {
        for (uint8_t rings = 0; rings < 3; rings += 2) {
            for (uint32_t maps = 1; maps <= 16; maps *= 4) {
                if (rings && times[i] == 400)
                    continue; /* too few tiles for a fortieth */
                open_scene(times[i], rings, maps);
                scene_run(&s, 40 * scene_round(&s) + 4 * s.timeout_frames);
                check_rest(times[i]);
                scene_close(&s);
            }
        }
    }
}

/* While the scene settles, a tile is loaded once, and again only where the bias overshot. */
static void few_tiles_are_loaded_twice_while_it_settles(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < TIMES; i++) {
        open_scene(times[i], 0, 4);
        scene_run(&s, 400);
        uint32_t slots = s.config.maxHeapCount * CAPACITY;
        if (scene_most_uploads(&s) > 2 || s.uploads > 2 * slots)
            fail_msg("%u tenths: %u uploads for %u slots, of one tile %u", (unsigned)times[i],
                     (unsigned)s.uploads, (unsigned)slots, (unsigned)scene_most_uploads(&s));
        scene_close(&s);
    }
}

static void uploads_end_after_the_camera_stops(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < TIMES; i++) {
        open_scene(times[i], 0, 4);
        for (uint32_t step = 0; step < 40; step++) {
            for (uint32_t k = 0; k < 16; k++)
                s.textures[k].window.x = (step / 8 + k) % 5;
            scene_run(&s, 4);
        }
        assert_true(s.unmapped > 0);
        scene_run(&s, 40 * scene_round(&s) + 4 * s.timeout_frames);
        check_rest(times[i]);
        scene_close(&s);
    }
}

static void uploads_end_after_the_budget_has_changed(void **state)
{
    (void)state;
    open_scene(40, 0, 4);
    uint32_t heaps = s.config.maxHeapCount;
    scene_run(&s, 300);
    for (uint32_t i = 0; i < 6; i++) {
        s.config.maxHeapCount = heaps + (i + 1) * heaps / 4;
        scene_configure(&s);
        scene_run(&s, 300);
        check_rest(40);
    }
    scene_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uploads_end_some_round_robins_after_the_camera_stands_still),
        cmocka_unit_test(few_tiles_are_loaded_twice_while_it_settles),
        cmocka_unit_test(uploads_end_after_the_camera_stops),
        cmocka_unit_test(uploads_end_after_the_budget_has_changed),
    };
    return RUN_TESTS(tests);
}
