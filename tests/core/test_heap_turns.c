/** Heaps of an application that releases every empty one at once. */
#include "core/scene.h"

static struct scene s;

/* A texture whose working set swings; nothing is kept on standby, heaps are released every frame.
 */
static struct scene_texture *open_scene(uint32_t capacity)
{
    scene_open(&s, capacity, 0);
    s.timeout_frames = 2;
    s.loads_per_frame = 512;
    s.releases_heaps = true;
    s.config.missesToExpire = 1; /* else what swings is learned and held */
    scene_configure(&s);
    return scene_add(&s, 8192, (struct scene_window){0, 0, 0, 1, 0, 0});
}

/* Between `base` and `base + more` tiles of level 0 in a row, and what lies over them. */
static void swing(struct scene_texture *t, uint32_t base, uint32_t more, uint32_t period,
                  uint32_t frames)
{
    for (uint32_t frame = 0; frame < frames; frame++) {
        t->window.width = base + (frame / period % 2 ? more : 0);
        scene_run(&s, 1);
    }
}

static void a_swing_by_a_few_tiles_makes_no_heap_after_the_first_turns(void **state)
{
    (void)state;
    for (uint32_t base = 8; base < 40; base++) {
        for (uint32_t more = 1; more <= 4; more += 3) {
            struct scene_texture *t = open_scene(16);
            swing(t, base, more, 8, 64);
            uint64_t unmapped = s.unmapped;
            uint32_t asked = s.f.heaps.asked, released = s.f.heaps.released;
            swing(t, base, more, 8, 400);
            assert_true(s.unmapped > unmapped + 20); /* else nothing swings */
            if (s.f.heaps.asked > asked || s.f.heaps.released > released)
                fail_msg("%u and %u tiles: %u heaps made, %u released", (unsigned)base,
                         (unsigned)more, (unsigned)(s.f.heaps.asked - asked),
                         (unsigned)(s.f.heaps.released - released));
            scene_close(&s);
        }
    }
}

/* Single slots too: a heap of one or two slots has no half to speak of. */
static void small_heaps_take_few_turns(void **state)
{
    (void)state;
    for (uint32_t capacity = 4; capacity <= 8; capacity *= 2) {
        for (uint32_t base = 8; base < 24; base++) {
            struct scene_texture *t = open_scene(capacity);
            swing(t, base, 1, 8, 64);
            uint32_t asked = s.f.heaps.asked;
            swing(t, base, 1, 8, 400);
            assert_in_range(s.f.heaps.asked - asked, 0, 25 * 2); /* 25 swings */
            scene_close(&s);
        }
    }
}

static void a_working_set_that_shrinks_for_good_gives_its_heaps_back(void **state)
{
    (void)state;
    struct scene_texture *t = open_scene(16);
    t->window = (struct scene_window){0, 0, 32, 8, 0, 0};
    scene_run(&s, 50);
    uint32_t most = s.f.heaps.living_count;
    assert_true(most * 16 > 256);
    t->window = (struct scene_window){0, 0, 4, 1, 0, 0};
    scene_run(&s, 50);
    SluiceStreamedTextureStatistics now = fixture_statistics(&s.f);
    assert_true(s.f.heaps.released > 0);
    assert_in_range(now.freeSlotCount, 0, now.heapCount * 16 - now.mappedTileCount);
    scene_remove(&s, t);
    scene_run(&s, 10);
    assert_int_equal(s.f.heaps.living_count, 0); /* no slot taken: all of them */
    scene_close(&s);
}

static void a_still_camera_makes_and_releases_none(void **state)
{
    (void)state;
    for (uint32_t width = 1; width <= 33; width += 4) {
        struct scene_texture *t = open_scene(16);
        t->window.width = width;
        scene_run(&s, 20);
        uint32_t asked = s.f.heaps.asked;
        scene_run(&s, 200);
        assert_int_equal(s.f.heaps.asked, asked);
        assert_int_equal(s.f.heaps.released, 0);
        scene_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_swing_by_a_few_tiles_makes_no_heap_after_the_first_turns),
        cmocka_unit_test(small_heaps_take_few_turns),
        cmocka_unit_test(a_working_set_that_shrinks_for_good_gives_its_heaps_back),
        cmocka_unit_test(a_still_camera_makes_and_releases_none),
    };
    return RUN_TESTS(tests);
}
