/** sluiceGetTilesToMap and sluiceGetTilesToUnmap for one texture after the other. */
#include "core/fixture.h"

enum { TEXTURES = 24, CAPACITY = 16 };

struct run {
    struct fixture f;
    SluiceTextureId ids[TEXTURES];
    uint64_t frame;
    uint32_t calls; ///< per frame: 1, or one per texture
};

static void open_run(struct run *r, uint32_t heaps, uint32_t calls)
{
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    fixture_open(&r->f, CAPACITY, true);
    fixture_configure(&r->f, 0, heaps, 0, 0);
    for (uint32_t i = 0; i < TEXTURES; i++)
        r->ids[i] = fixture_add(&r->f, &desc);
    r->frame = 0;
    r->calls = calls;
}

/* Runs frames in which all textures are in view, some from farther away. Returns the number of
 * loaded tiles. */
static uint32_t run_frames(struct run *r, uint32_t frames)
{
    uint32_t uploads = 0;
    for (uint64_t end = r->frame + frames; r->frame < end; r->frame++) {
        for (uint32_t i = 0; i < TEXTURES; i++)
            fixture_feed(&r->f, r->ids[i], (uint8_t)(i % 3), r->frame, 30);
        CHECK_OK(fixture_to_unmap(&r->f, SLUICE_ALL_TEXTURES, r->frame + 3));
        CHECK_OK(sluiceCompleteRetireValue(r->f.manager, r->frame + 1));
        for (uint32_t i = 0; i < r->calls; i++) {
            SluiceTextureId id = r->calls == 1 ? SLUICE_ALL_TEXTURES : r->ids[i];
            assert_true(fixture_to_map(&r->f, id) >= 0);
            uploads += r->f.count;
            fixture_answer_mapped(&r->f);
        }
    }
    return uploads;
}

/* MAPPED tiles of all textures by level, packed ones last. */
static void count_levels(const struct run *r, uint32_t counts[SLUICE_MAX_MIP_LEVELS])
{
    for (uint32_t i = 0; i < TEXTURES; i++)
        for (uint32_t tile = 0; tile < fixture_layout(&r->f, r->ids[i]).tileCount; tile++)
            if (fixture_state(&r->f, r->ids[i], tile) == SLUICE_TILE_STATE_MAPPED)
                counts[fixture_tile(&r->f, r->ids[i], tile).mipLevel]++;
}

/* Slots that were evicted for the last texture must not go to the first one, frame after frame. */
static void a_still_picture_ends_all_uploads_and_is_that_of_calls_for_all(void **state)
{
    (void)state;
    static const uint32_t heaps[] = {40, 12, 3};
    for (uint32_t h = 0; h < 3; h++) {
        static struct run runs[2];
        uint32_t counts[2][SLUICE_MAX_MIP_LEVELS] = {{0}};
        for (uint32_t k = 0; k < 2; k++) {
            open_run(&runs[k], heaps[h], k ? TEXTURES : 1);
            run_frames(&runs[k], 200);
            assert_int_equal(run_frames(&runs[k], 200), 0);
            count_levels(&runs[k], counts[k]);
            fixture_close(&runs[k].f);
        }
        assert_memory_equal(counts[0], counts[1], sizeof counts[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_picture_ends_all_uploads_and_is_that_of_calls_for_all),
    };
    return RUN_TESTS(tests);
}
