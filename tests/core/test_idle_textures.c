/** Textures without new maps: their tiles make room for others when slots are short. */
#include "core/scene.h"

enum { CAPACITY = 64, TILES = 86 }; /* TILES: of a texture of 1024 x 1024 */

static const struct scene_window all_of_it = {0, 0, 8, 8, 0, 0};

static struct scene s;

/* Opens `count` textures with 512 slots. Five of them and their reserve fit. */
static void open_scene(uint32_t count)
{
    scene_open(&s, CAPACITY, 8);
    for (uint32_t i = 0; i < count; i++)
        scene_add(&s, 1024, all_of_it);
    scene_run(&s, 200);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(scene_deficit(&s.textures[i]), 0);
}

static uint32_t mapped(uint32_t texture)
{
    return scene_tiles_in(&s, &s.textures[texture], SLUICE_TILE_STATE_MAPPED);
}

static void without_pressure_they_keep_everything(void **state)
{
    (void)state;
    open_scene(5);
    for (uint32_t i = 0; i < 4; i++)
        s.textures[i].silent = true;
    scene_run(&s, 5000);
    for (uint32_t i = 0; i < 5; i++)
        assert_int_equal(mapped(i), TILES);
    assert_int_equal(s.unmapped, 0);
    scene_close(&s);
}

static void under_pressure_they_go_one_after_another_the_oldest_first(void **state)
{
    (void)state;
    open_scene(5);
    static const uint32_t order[] = {3, 1, 2};
    for (uint32_t i = 0; i < 3; i++) {
        s.textures[order[i]].silent = true;
        scene_run(&s, 100);
    }
    scene_run(&s, 100);
    for (uint32_t i = 0; i < 3; i++) {
        struct scene_texture *t = scene_add(&s, 1024, all_of_it);
        scene_run(&s, 40);
        assert_int_equal(scene_deficit(t), 0);
        for (uint32_t k = 0; k < 3; k++)
            assert_int_equal(mapped(order[k]), k <= i ? 0 : TILES);
        assert_int_equal(mapped(0), TILES);
        assert_int_equal(mapped(4), TILES);
    }
    scene_close(&s);
}

static void no_more_of_them_go_than_are_needed(void **state)
{
    (void)state;
    open_scene(5);
    for (uint32_t i = 0; i < 4; i++)
        s.textures[i].silent = true;
    scene_run(&s, 400);
    scene_add(&s, 256, (struct scene_window){0, 0, 2, 2, 0, 0}); /* 6 tiles: there is still room */
    scene_run(&s, 40);
    assert_int_equal(s.unmapped, 0);
    scene_add(&s, 1024, all_of_it);
    scene_run(&s, 40);
    assert_int_equal(mapped(0), 0);
    for (uint32_t i = 1; i < 5; i++)
        assert_int_equal(mapped(i), TILES);
    scene_close(&s);
}

static void one_that_is_looked_at_again_comes_back(void **state)
{
    (void)state;
    open_scene(5);
    s.textures[0].silent = s.textures[1].silent = true;
    scene_run(&s, 200);
    scene_add(&s, 1024, all_of_it);
    scene_run(&s, 40);
    assert_int_equal(mapped(0), 0);
    s.textures[0].silent = false;
    scene_run(&s, 40);
    assert_int_equal(mapped(0), TILES);
    assert_int_equal(scene_deficit(&s.textures[0]), 0);
    assert_int_equal(mapped(1), 0);
    scene_close(&s);
}

/* A texture with 1365 regular tiles has more nodes, regions and maps than one with 85. */
static void their_memory_comes_back_too(void **state)
{
    (void)state;
    scene_open(&s, CAPACITY, 8);
    scene_add(&s, 4096, (struct scene_window){0, 0, 16, 16, 0, 0}); /* 345 tiles */
    scene_run(&s, 100);
    uint64_t before = fixture_statistics(&s.f).hostMemorySize;
    s.textures[0].silent = true;
    scene_run(&s, 200);
    assert_true(fixture_statistics(&s.f).hostMemorySize >= before);
    for (uint32_t i = 0; i < 2; i++)
        scene_add(&s, 1024, all_of_it);
    scene_run(&s, 40);
    assert_int_equal(mapped(0), 0);
    uint64_t after = fixture_statistics(&s.f).hostMemorySize;
    assert_true(after + (uint64_t)4 * 1365 < before); /* not even an index per tile is left */
    scene_close(&s);
}

/* 16 textures with a map every `round` frames each. They require 1.5 times the slots. */
static void check_slow_round(uint32_t timeout, bool one_is_fast)
{
    scene_open(&s, CAPACITY, 8);
    s.timeout_frames = timeout;
    s.loads_per_frame = FIXTURE_ROOM;
    s.maps_per_frame = 16;
    for (uint32_t i = 0; i < 16; i++)
        scene_add(&s, 1024, (struct scene_window){0, 0, 5, 5, 0, 0});
    for (uint32_t frame = 0; frame < 2000; frame++) {
        for (uint32_t i = 0; i < 16; i++)
            s.textures[i].silent = frame % 100 != 0 && !(one_is_fast && i == 15);
        scene_run(&s, 1);
    }
    assert_true(fixture_statistics(&s.f).requestedTileCount > 0); /* there is pressure */
    if (s.unmapped > 0)
        fail_msg("a timeout of %u frames, one fast %d: %u tiles were given back", (unsigned)timeout,
                 one_is_fast, (unsigned)s.unmapped);
    for (uint32_t i = 0; i < 16; i++)
        assert_true(mapped(i) > 0);
    scene_close(&s);
}

static void textures_with_a_map_now_and_then_keep_theirs(void **state)
{
    (void)state;
    check_slow_round(100, false);
    check_slow_round(30, false);
    check_slow_round(30, true);
    check_slow_round(8, false);
}

static void textures_with_a_map_in_many_timeouts_keep_theirs_beside_faster_ones(void **state)
{
    (void)state;
    check_slow_round(8, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_pressure_they_keep_everything),
        cmocka_unit_test(under_pressure_they_go_one_after_another_the_oldest_first),
        cmocka_unit_test(no_more_of_them_go_than_are_needed),
        cmocka_unit_test(one_that_is_looked_at_again_comes_back),
        cmocka_unit_test(their_memory_comes_back_too),
        cmocka_unit_test(textures_with_a_map_now_and_then_keep_theirs),
        cmocka_unit_test(textures_with_a_map_in_many_timeouts_keep_theirs_beside_faster_ones),
    };
    return RUN_TESTS(tests);
}
