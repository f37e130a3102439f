/* Limits of a manager's counters: all ids used up, one slot, no slot. */
#include "core/sound.h"
#include "extremes/note.h"

#include "core/state.h"

enum { FRAMES = 400 };

/* Sets the generation, because reaching it takes 2^32 removals. */
static void set_generation(struct fixture *f, SluiceTextureId id, uint32_t generation)
{
    slc_texture_at(f->manager, (uint32_t)id)->generation = generation;
}

static SluiceTextureId id_of(uint32_t index, uint32_t generation)
{
    return (SluiceTextureId)generation << 32 | index;
}

static void an_index_whose_generations_are_used_up_never_comes_back(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId keeper = fixture_add_small(&f);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, fixture_add_small(&f), 0));
    set_generation(&f, id_of(1, 1), UINT32_MAX - 2);
    SluiceTextureId last = fixture_add_small(&f);
    assert_true(last == id_of(1, UINT32_MAX - 1));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, last, 0));
    SluiceTextureId end = fixture_add_small(&f);
    assert_true(end == id_of(1, UINT32_MAX));
    fixture_feed(&f, end, 0, 1, 10);
    fixture_load(&f);
    CHECK_STATE(&f, end, 0, MAPPED);
    CHECK_RESULT(sluiceGetTileState(f.manager, last, 0, NULL, NULL), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, end, 0));
    CHECK_SOUND(&f);
    uint32_t repeated = 0;
    for (uint32_t i = 0; i < 100; i++) {
        SluiceTextureId next = fixture_add_small(&f);
        repeated += next != id_of(2, i + 1); /* not index 1 in generation 0 or 1 again */
        CHECK_RESULT(sluiceGetTileState(f.manager, end, 0, NULL, NULL), SLUICE_ERROR_STALE_TEXTURE);
        CHECK_RESULT(sluiceGetTileState(f.manager, id_of(1, 0), 0, NULL, NULL),
                     SLUICE_ERROR_UNKNOWN_TEXTURE);
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, next, 0));
    }
    CHECK_STATE(&f, keeper, 0, FREE);
    note("ids after the last generation: unexpected ones", 100, repeated, 0);
    assert_int_equal(repeated, 0);
    fixture_close(&f);
}

/* The most tiles that had a slot at a time. */
static uint32_t stream_frame(struct fixture *f, const SluiceTextureId *ids, uint32_t frame,
                             uint64_t *random)
{
    for (uint32_t i = 0; i < 3; i++) /* one is looked at, forty frames long */
        if (frame / 40 % 3 == i)
            sound_feed_region(f, ids[i], next_random(random) % 4,
                              (uint8_t)(next_random(random) % 3), frame, 20);
        else
            sound_feed(f, ids[i], SLUICE_MIP_UNTOUCHED, frame, 20);
    SOUND(f, fixture_to_cancel(f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f->count, 0); /* all were answered */
    SOUND(f, sluiceCompleteRetireValue(f->manager, frame));
    SOUND(f, fixture_to_unmap(f, SLUICE_ALL_TEXTURES, frame + 1));
    assert_true(fixture_to_map(f, SLUICE_ALL_TEXTURES) >= 0);
    CHECK_SOUND(f);
    SluiceStreamedTextureStatistics s = fixture_statistics(f);
    sound_answer_mapped(f);
    return s.mappedTileCount + s.standbyTileCount + s.allocatedTileCount + s.retiringSlotCount;
}

static uint32_t stream(struct fixture *f, const SluiceTextureId *ids, uint64_t *random)
{
    uint32_t most = 0;
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        uint32_t held = stream_frame(f, ids, frame, random);
        most = held > most ? held : most;
    }
    return most;
}

/* One slot holds one of the 18 tiles at a time, for any requests. At the end it holds the only
 * wanted tile. */
static void one_slot_holds_one_tile(void **state)
{
    (void)state;
    static struct fixture f;
    uint64_t random = 11;
    uint32_t most = 0;
    for (uint32_t standby = 0; standby < 3; standby++) {
        fixture_open(&f, 1, standby == 1);
        fixture_configure(&f, standby, 1, 0, 0);
        SluiceStreamedTextureDesc packed = full_chain(1, 1, 128, 128);
        SluiceTextureId ids[3];
        for (uint32_t i = 0; i < 3; i++)
            ids[i] = fixture_add_small(&f);
        uint32_t held = stream(&f, ids, &random);
        most = held > most ? held : most;
        assert_int_equal(fixture_statistics(&f).heapCount, 1);
        assert_true(fixture_statistics(&f).unmappedTotal >= (standby == 1 ? 0 : 9));
        for (uint32_t i = 0; i < 3; i++)
            CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[i], 402));
        SluiceTextureId last = fixture_add(&f, &packed);
        sound_feed(&f, last, 0, 500, 20);
        SOUND(&f, sluiceCompleteRetireValue(f.manager, 402));
        sound_load(&f);
        CHECK_STATE(&f, last, 0, MAPPED);
        fixture_close(&f);
    }
    note("one slot: tiles that had it at a time", 3 * FRAMES, most, 1);
    assert_int_equal(most, 1);
}

static void without_any_memory_requests_wait_and_are_served_when_there_is_some(void **state)
{
    (void)state;
    static struct fixture f;
    uint64_t random = 12;
    fixture_open(&f, 8, true);
    f.heaps.limit = 0;
    SluiceTextureId ids[3];
    for (uint32_t i = 0; i < 3; i++)
        ids[i] = fixture_add_small(&f);
    assert_int_equal(stream(&f, ids, &random), 0);
    SluiceStreamedTextureStatistics s = fixture_statistics(&f);
    assert_int_equal(s.heapCount + s.mappedTileCount + s.handedOutTotal, 0);
    assert_true(s.requestedTileCount >= 3);  /* the packed ones always */
    assert_int_equal(f.heaps.asked, FRAMES); /* once a frame */
    f.heaps.limit = FIXTURE_HEAPS;
    for (uint32_t i = 0; i < 3; i++)
        sound_feed(&f, ids[i], 0, 401 + i, 20);
    for (uint32_t frame = 404; frame < 500; frame++) { /* the bias falls again */
        sound_feed(&f, ids[frame % 3], 0, frame, 20);
        sound_load(&f);
    }
    uint32_t missing = 3 * 6 - fixture_statistics(&f).mappedTileCount;
    note("no memory: tiles missing once there is some", 3 * 6, missing, 0);
    assert_int_equal(missing, 0);
    assert_int_equal(fixture_statistics(&f).globalMipBias, 0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_index_whose_generations_are_used_up_never_comes_back),
        cmocka_unit_test(one_slot_holds_one_tile),
        cmocka_unit_test(without_any_memory_requests_wait_and_are_served_when_there_is_some),
    };
    return RUN_TESTS(tests);
}
