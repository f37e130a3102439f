#include "core/fixture.h"

static uint64_t bytes(const struct fixture *f)
{
    return f->memory.live_bytes;
}

/* Bytes for 64 textures of this shape, none of them sampled. */
static uint64_t cost_of_64(const SluiceStreamedTextureDesc *desc)
{
    struct fixture f;
    fixture_open(&f, 64, false);
    uint64_t before = bytes(&f);
    for (uint32_t i = 0; i < 64; i++)
        fixture_add(&f, desc);
    uint64_t after = bytes(&f);
    fixture_close(&f);
    return after - before;
}

static void idle_textures_hold_nothing_per_tile(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc tiny = full_chain(1, 1, 128, 128);
    SluiceStreamedTextureDesc huge = full_chain(1u << 20, 1u << 20, 256, 256);
    uint64_t cost = cost_of_64(&huge); /* 22 million tiles each */
    assert_true(cost == cost_of_64(&tiny));
    assert_true(cost <= 64 * 1024);
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = fixture_add(&f, &huge);
    uint64_t before = bytes(&f); /* nor does looking at it cost anything */
    CHECK_STATE(&f, id, 22000000, FREE);
    uint8_t texel = 0;
    SluiceMinMipRect rect = {id, 4000, 4000, 1, 1};
    CHECK_OK(sluiceWriteMinMipRect(f.manager, &rect, 1, 1, &texel));
    assert_int_equal(texel, SLUICE_MIP_UNTOUCHED);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 0);
    assert_true(bytes(&f) == before);
    fixture_close(&f);
}

static void packed_tiles_cost_by_their_count_alone(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true); /* wanted from the start */
    SluiceStreamedTextureDesc huge = full_chain(1u << 20, 1u << 20, 256, 256);
    huge.packedTileCount = 8;
    uint64_t before = bytes(&f);
    fixture_add(&f, &huge);
    fixture_load(&f);
    assert_int_equal(fixture_statistics(&f).mappedTileCount, 8);
    assert_true(bytes(&f) - before <= 64 * 1024);
    fixture_close(&f);
}

/* A walk past many pictures: those out of sight hold a few bytes per tile and no tile's books. */
static void textures_out_of_sight_hold_a_few_bytes_per_tile(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    SluiceTextureId ids[150];
    for (uint32_t i = 0; i < 150; i++)
        ids[i] = fixture_add(&f, &desc);
    uint64_t after_few = 0;
    for (uint32_t i = 0; i < 150; i++) {
        fixture_feed(&f, ids[i], 0, i, 0);
        fixture_load(&f);
        assert_int_equal(fixture_statistics(&f).mappedTileCount, 86);
        fixture_feed(&f, ids[i], SLUICE_MIP_UNTOUCHED, i, 0);
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        assert_int_equal(f.count, 86);
        if (i == 9)
            after_few = bytes(&f);
    }
    assert_true(bytes(&f) <= after_few + 140 * 16 * (86 + 64)); /* tiles and regions */
    assert_int_equal(f.heaps.living_count, 2);
    fixture_close(&f);
}

static void old_maps_are_let_go(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceStreamedTextureDesc desc = full_chain(8192, 8192, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    uint64_t after_few = 0;
    for (uint64_t t = 0; t < 400; t++) { /* 4096 regions each, all different in time */
        fixture_feed_region(&f, id, (uint32_t)(t * 37 % 4096), 5, t, 4);
        if (t == 50)
            after_few = bytes(&f);
    }
    assert_true(bytes(&f) <= after_few);
    fixture_close(&f);
}

static void adding_and_removing_for_ever_takes_no_more(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    uint64_t after_few = 0;
    for (uint32_t i = 0; i < 500; i++) {
        SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f);
        CHECK_OK(sluiceSetPrimaryTexture(f.manager, b, a));
        fixture_feed(&f, a, 0, i, 3);
        CHECK_OK(fixture_to_map_at_most(&f, a, FIXTURE_ROOM));
        fixture_answer_mapped(&f);
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, i % 2 ? a : b, i + 1));
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, i % 2 ? b : a, i + 1));
        CHECK_OK(sluiceCompleteRetireValue(f.manager, i));
        if (i == 20)
            after_few = bytes(&f);
    }
    assert_true(bytes(&f) <= after_few);
    fixture_close(&f);
}

static void statistics_say_how_much_memory_is_held(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true);
    assert_true(fixture_statistics(&f).hostMemorySize == bytes(&f));
    SluiceStreamedTextureDesc desc = full_chain(2048, 1024, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    assert_true(fixture_statistics(&f).hostMemorySize == bytes(&f));
    fixture_feed(&f, id, 0, 0, 5);
    fixture_load(&f);
    assert_true(fixture_statistics(&f).hostMemorySize == bytes(&f));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, id, 0));
    assert_true(fixture_statistics(&f).hostMemorySize == bytes(&f));
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(idle_textures_hold_nothing_per_tile),
        cmocka_unit_test(packed_tiles_cost_by_their_count_alone),
        cmocka_unit_test(textures_out_of_sight_hold_a_few_bytes_per_tile),
        cmocka_unit_test(old_maps_are_let_go),
        cmocka_unit_test(adding_and_removing_for_ever_takes_no_more),
        cmocka_unit_test(statistics_say_how_much_memory_is_held),
    };
    return RUN_TESTS(tests);
}
