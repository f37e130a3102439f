/** Packed tiles come first and find room, even if wanted tiles hold every slot. */
#include "core/check.h"
#include "core/scene.h"

#include <stdio.h>

enum { CAPACITY = 16 };

static const uint32_t heap_counts[] = {1, 4, 64}; /* 16, 64 and 1024 slots */
enum { BUDGETS = sizeof heap_counts / sizeof *heap_counts };

static const struct scene_window all_of_it = {0, 0, 8, 8, 0, 0};

static struct scene s;

/* Opens a texture that requests many more slots than exist, and holds all but the reserved ones. */
static void open_full(uint32_t heaps, bool always)
{
    if (always)
        scene_open_packed(&s, CAPACITY, heaps);
    else
        scene_open(&s, CAPACITY, heaps);
    scene_add(&s, 8192, (struct scene_window){0, 0, 64, 64, 0, 0});
    scene_run(&s, 200);
    SluiceStreamedTextureStatistics now = fixture_statistics(&s.f);
    assert_int_equal(now.heapCount, heaps);
    assert_int_equal(now.freeSlotCount, now.reservedSlotCount);
    assert_int_equal(now.standbyTileCount, 0);
    assert_true(now.requestedTileCount > 0);
}

static void shows_packed_after_the_answer(const struct scene_texture *t)
{
    uint32_t packed = t->layout.regularTileCount;
    bool listed = false;
    for (uint32_t i = 0; i < s.f.count; i++)
        listed |= s.f.tiles[i].textureId == t->id && s.f.tiles[i].tileIndex == packed;
    assert_true(listed);
    CHECK_STATE(&s.f, t->id, packed, ALLOCATED);
    scene_run(&s, s.load_frames);
    CHECK_STATE(&s.f, t->id, packed, MAPPED);
    assert_true(scene_shows_something(t));
}

static void a_texture_that_comes_into_view_shows_its_packed_level_after_one_load(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_full(heap_counts[b], false);
        struct scene_texture *t = scene_add(&s, 1024, all_of_it);
        scene_run(&s, 1);
        shows_packed_after_the_answer(t);
        scene_close(&s);
    }
}

static void packed_tiles_that_are_always_mapped_are_listed_right_after_the_add(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_full(heap_counts[b], true);
        struct scene_texture *t = scene_add(&s, 1024, (struct scene_window){0});
        s.maps_per_frame = 0;
        scene_run(&s, 1);
        assert_int_equal(s.f.count, 1);
        shows_packed_after_the_answer(t);
        scene_close(&s);
    }
}

static void as_many_textures_as_slots_are_reserved_come_in_one_frame(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_full(heap_counts[b], true);
        uint32_t count = fixture_statistics(&s.f).reservedSlotCount;
        assert_in_range(count, 1, SCENE_TEXTURES);
        count = count < SCENE_TEXTURES ? count : SCENE_TEXTURES - 1;
        for (uint32_t i = 0; i < count; i++)
            scene_add(&s, 1024, all_of_it);
        s.maps_per_frame = SCENE_TEXTURES;
        scene_run(&s, 1 + s.load_frames);
        for (uint32_t i = 1; i <= count; i++)
            assert_true(scene_shows_something(&s.textures[i]));
        scene_close(&s);
    }
}

static void textures_come_one_after_another_up_to_the_reserve(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_full(heap_counts[b], false);
        uint32_t count = fixture_statistics(&s.f).reservedSlotCount;
        for (uint32_t i = 0; i < count && s.texture_count < SCENE_TEXTURES; i++) {
            struct scene_texture *t = scene_add(&s, 1024, all_of_it);
            s.maps_per_frame = SCENE_TEXTURES;
            scene_run(&s, 1);
            shows_packed_after_the_answer(t);
        }
        scene_close(&s);
    }
}

/* Packed tiles that used the reserve are compensated as soon as regular tiles are dropped. */
static void the_reserve_fills_up_again_before_regular_tiles_are_loaded(void **state)
{
    (void)state;
    for (uint32_t b = 0; b < BUDGETS; b++) {
        open_full(heap_counts[b], false);
        uint32_t count = fixture_statistics(&s.f).reservedSlotCount;
        for (uint32_t i = 0; i < count && s.texture_count < SCENE_TEXTURES; i++)
            scene_add(&s, 1024, all_of_it);
        s.maps_per_frame = SCENE_TEXTURES;
        scene_run(&s, 20);
        s.textures[0].window = (struct scene_window){0, 0, 1, 1, 0, 0};
        for (uint32_t frame = 0; frame < 300; frame++) {
            scene_run(&s, 1);
            bool regular = false;
            for (uint32_t i = 0; i < s.f.count; i++) {
                const struct scene_texture *t = &s.textures[(uint32_t)s.f.tiles[i].textureId];
                regular |= s.f.tiles[i].tileIndex < t->layout.regularTileCount;
            }
            SluiceStreamedTextureStatistics now = fixture_statistics(&s.f);
            assert_true(!regular || now.freeSlotCount >= now.reservedSlotCount);
        }
        SluiceStreamedTextureStatistics now = fixture_statistics(&s.f);
        assert_true(now.freeSlotCount >= now.reservedSlotCount);
        scene_close(&s);
    }
}

static void packed_tiles_stand_first_in_every_list(void **state)
{
    (void)state;
    scene_open(&s, CAPACITY, 16);
    s.loads_per_frame = 16;
    for (uint32_t frame = 0; frame < 100; frame++) {
        if (frame % 3 == 0 && s.texture_count < 30)
            scene_add(&s, 1024, all_of_it);
        scene_run(&s, 1);
        bool regular = false;
        for (uint32_t i = 0; i < s.f.count; i++) {
            const struct scene_texture *t = &s.textures[(uint32_t)s.f.tiles[i].textureId];
            bool packed = s.f.tiles[i].tileIndex >= t->layout.regularTileCount;
            assert_false(packed && regular);
            regular |= !packed;
        }
    }
    scene_close(&s);
}

/* Few slots for many textures: the first ones must not keep the others invisible. */
static void every_texture_shows_something_as_long_as_packed_tiles_fit(void **state)
{
    (void)state;
    for (uint32_t count = 9; count <= 24; count++) {
        scene_open(&s, CAPACITY, 2); /* 32 slots */
        for (uint32_t i = 0; i < count; i++) {
            if (i == 8)
                scene_run(&s, 200);
            scene_add(&s, 1024, all_of_it);
        }
        scene_run(&s, 300);
        for (uint32_t i = 0; i < count; i++)
            if (!scene_shows_something(&s.textures[i]))
                fail_msg("%u textures: nothing of texture %u is shown after 300 frames",
                         (unsigned)count, (unsigned)i);
        scene_close(&s);
    }
}

/** Describes 64x64 texels in one packed tile. */
static SluiceStreamedTextureDesc tiny_texture(bool outside)
{
    return (SluiceStreamedTextureDesc){.width = 64,
                                       .height = 64,
                                       .mipLevelCount = 7,
                                       .packedTileCount = 1,
                                       .tileWidth = 128,
                                       .tileHeight = 128,
                                       .feedbackRegionWidth = 64,
                                       .feedbackRegionHeight = 64,
                                       .packedTilesOutside = outside};
}

static void packed_tiles_outside_of_heaps_need_no_slot(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, CAPACITY, true);
    f.heaps.limit = 1;
    fixture_configure(&f, 0, 1, 5, 1);
    SluiceStreamedTextureDesc desc = tiny_texture(true);
    SluiceTextureId ids[1000];
    for (uint32_t i = 0; i < 1000; i++)
        ids[i] = fixture_add(&f, &desc);
    fixture_load(&f);
    SluiceStreamedTextureStatistics now = fixture_statistics(&f);
    assert_int_equal(now.heapCount, 0);
    assert_int_equal(now.mappedTileCount, 1000);
    SluiceTextureId regular = fixture_add_small(&f);
    for (uint32_t time = 1; time < 40; time++) {
        fixture_feed(&f, ids[time], 0, time, 1000);
        fixture_feed(&f, regular, 0, time, 1000);
        fixture_load(&f);
    }
    CHECK_STATE(&f, regular, 0, MAPPED);
    now = fixture_statistics(&f);
    assert_int_equal(now.freeSlotCount, CAPACITY - 6);
    assert_int_equal(now.globalMipBias, 0); /* 16 slots are enough for 6 tiles */
    for (uint32_t i = 0; i < 1000; i++)
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[i], 1));
    assert_null(slc_manager_check(f.manager));
    fixture_close(&f);
}

/* Returns the frames until another texture has all its tiles. Before, `outside` small visible
 * textures and larger ones come and go. */
static uint32_t frames_beside(uint32_t outside)
{
    struct fixture f;
    fixture_open(&f, CAPACITY, false);
    fixture_configure(&f, 2000, 1, 5, 1);
    SluiceStreamedTextureDesc tiny = tiny_texture(true), large = full_chain(512, 512, 128, 128);
    SluiceTextureId ids[1000], first = fixture_add_small(&f), second = fixture_add(&f, &large);
    for (uint32_t i = 0; i < outside; i++)
        fixture_feed(&f, ids[i] = fixture_add(&f, &tiny), 0, 1, 2);
    fixture_load(&f);
    for (uint32_t i = 0; i < outside; i++)
        fixture_feed(&f, ids[i], SLUICE_MIP_UNTOUCHED, 10, 2);
    assert_int_equal(fixture_statistics(&f).standbyTileCount, outside);
    fixture_feed(&f, second, 0, 11, 2);
    fixture_load(&f);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 1); /* kept for packed tiles */
    fixture_feed(&f, second, SLUICE_MIP_UNTOUCHED, 20, 2);
    uint32_t time = 20;
    for (; time < 2000 && fixture_state(&f, first, 0) != SLUICE_TILE_STATE_MAPPED; time++) {
        fixture_feed(&f, first, 0, time, 2);
        fixture_load(&f);
        fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    }
    assert_null(slc_manager_check(f.manager));
    assert_int_equal(fixture_statistics(&f).mappedTileCount, 6);
    if (outside > 0)
        CHECK_STATE(&f, ids[0], 0, STANDBY); /* evicting it gains nothing */
    for (uint32_t i = 0; i < outside; i++)
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[i], 1));
    fixture_close(&f);
    return time - 20;
}

static void packed_tiles_outside_on_standby_hold_up_no_other_texture(void **state)
{
    (void)state;
    uint32_t none = frames_beside(0), many = frames_beside(1000);
    printf("# %u frames, %u beside 1000 tiles without slots\n", none, many);
    assert_int_equal(many, none);
}

static void packed_tiles_outside_leave_standby_to_tiles_with_slots(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[8];
    fixture_open(&f, CAPACITY, false);
    fixture_configure(&f, 6, 1, 5, 1);
    SluiceStreamedTextureDesc tiny = tiny_texture(true);
    SluiceTextureId small = fixture_add_small(&f);
    for (uint32_t i = 0; i < 8; i++)
        fixture_feed(&f, ids[i] = fixture_add(&f, &tiny), 0, 1, 2);
    fixture_feed(&f, small, 0, 1, 2);
    fixture_load(&f);
    fixture_feed(&f, small, SLUICE_MIP_UNTOUCHED, 10, 2);
    for (uint32_t i = 0; i < 8; i++)
        fixture_feed(&f, ids[i], SLUICE_MIP_UNTOUCHED, 10, 2);
    fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    assert_int_equal(f.count, 2); /* each kind may have six */
    assert_int_equal(f.tiles[0].textureId, ids[0]);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 2));
    fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    assert_int_equal(f.count, 4);
    assert_int_equal(f.tiles[0].textureId, small);
    assert_null(slc_manager_check(f.manager));
    fixture_configure(&f, 1, 1, 5, 1);
    fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    assert_int_equal(f.count, 1 + 5);
    fixture_close(&f);
}

/* A texture requests far more than there are slots, beside textures that cannot be loaded. */
static void blur_beside(uint32_t failing, SluiceStreamedTextureStatistics *now)
{
    struct fixture f;
    fixture_open(&f, CAPACITY, true);
    f.heaps.limit = 1;
    fixture_configure(&f, 0, 1, 1, 1);
    SluiceStreamedTextureDesc desc = tiny_texture(true);
    for (uint32_t i = 0; i < failing; i++)
        fixture_add(&f, &desc);
    fixture_to_map(&f, SLUICE_ALL_TEXTURES);
    assert_int_equal(f.count, failing);
    for (uint32_t i = 0; i < failing; i++)
        CHECK_OK(
            sluiceReportFailedTiles(f.manager, f.tiles[i].textureId, 1, &f.tiles[i].tileIndex, 0));
    SluiceStreamedTextureDesc large = full_chain(4096, 4096, 128, 128);
    SluiceTextureId id = fixture_add(&f, &large);
    for (uint32_t time = 1; time < 60; time++) {
        fixture_feed(&f, id, 0, time, 1000);
        fixture_load(&f);
        fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    }
    assert_null(slc_manager_check(f.manager));
    *now = fixture_statistics(&f);
    assert_int_equal(now->givenUpTileCount, failing);
    fixture_close(&f);
}

static void packed_tiles_outside_that_failed_do_not_change_the_bias(void **state)
{
    (void)state;
    SluiceStreamedTextureStatistics none, many;
    blur_beside(0, &none);
    blur_beside(1000, &many);
    assert_true(none.globalMipBias > 0);
    assert_int_equal(many.globalMipBias, none.globalMipBias);
    assert_int_equal(many.requestedTileCount, none.requestedTileCount);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texture_that_comes_into_view_shows_its_packed_level_after_one_load),
        cmocka_unit_test(packed_tiles_that_are_always_mapped_are_listed_right_after_the_add),
        cmocka_unit_test(as_many_textures_as_slots_are_reserved_come_in_one_frame),
        cmocka_unit_test(textures_come_one_after_another_up_to_the_reserve),
        cmocka_unit_test(the_reserve_fills_up_again_before_regular_tiles_are_loaded),
        cmocka_unit_test(packed_tiles_stand_first_in_every_list),
        cmocka_unit_test(every_texture_shows_something_as_long_as_packed_tiles_fit),
        cmocka_unit_test(packed_tiles_outside_of_heaps_need_no_slot),
        cmocka_unit_test(packed_tiles_outside_on_standby_hold_up_no_other_texture),
        cmocka_unit_test(packed_tiles_outside_leave_standby_to_tiles_with_slots),
        cmocka_unit_test(packed_tiles_outside_that_failed_do_not_change_the_bias),
    };
    return RUN_TESTS(tests);
}
