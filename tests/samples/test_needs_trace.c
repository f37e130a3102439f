/** The trace of a run, read by what plays such traces. */
#include "support/test.h"

#include "base/alloc.h"
#include "demand/random.h"
#include "needs_rig.h"
#include "replay/feedback_trace.h"
#include "replay/runs.h"
#include "streaming/needs_trace.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FRAMES 5

static const SluiceStreamedTextureDesc descs[] = {
    {4096, 4096, 13, 5, 1, 128, 128, 0, 0}, /* runs longer than a byte's worth */
    {1000, 700, 10, 3, 1, 128, 64, 0, 0},
    {100, 60, 7, 0, 1, 128, 128, 0, 0},
};
#define TEXTURES (sizeof descs / sizeof *descs)

static void change_some(struct needs_rig *rig, uint64_t *seed)
{
    for (uint32_t i = 0; i < TEXTURES; i++) {
        const SluiceStreamedTextureLayout *layout = &rig->needs.textures[i].layout;
        for (uint32_t n = 0; n < 9; n++)
            needs_rig_feedback(
                rig, i)[random_below(seed, layout->feedbackWidth * layout->feedbackHeight)] =
                random_below(seed, layout->desc.regularMipCount + 1);
    }
}

static uint8_t *read_whole(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    uint8_t *data = malloc(*size);
    assert_non_null(data);
    assert_int_equal(fread(data, 1, *size, file), *size);
    fclose(file);
    return data;
}

/* The frames again, from the same seed, beside those of the trace. */
static void compare_frames(struct slc_feedback_trace *trace, struct needs_rig *rig, uint64_t seed)
{
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        uint64_t micros;
        uint32_t map_count;
        change_some(rig, &seed);
        slc_next_frame(trace, &micros, &map_count);
        assert_int_equal(micros, 16667 * (frame + 1));
        assert_int_equal(map_count, TEXTURES);
        for (uint32_t i = 0; i < TEXTURES; i++) {
            uint32_t texture;
            uint8_t map[32 * 32];
            struct slc_cursor runs = slc_next_map(trace, &texture);
            uint32_t count = trace->textures[i].feedback_width * trace->textures[i].feedback_height;
            assert_int_equal(texture, i);
            slc_get_run_pairs(&runs, map, count);
            assert_null(runs.why);
            for (uint32_t r = 0; r < count; r++)
                assert_int_equal(map[r], needs_rig_feedback(rig, i)[r]);
        }
    }
    assert_int_equal(trace->in.pos, trace->in.end);
}

static void a_trace_holds_all_maps_of_all_frames(void **state)
{
    (void)state;
    const char *path = "test_needs_trace.slt";
    struct needs_rig rig;
    struct needs_trace written;
    uint64_t seed = 3;
    needs_rig_open(&rig, descs, TEXTURES);
    assert_true(needs_trace_begin(&written, path, &rig.needs, FRAMES, 16667));
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        change_some(&rig, &seed);
        needs_rig_frame(&rig);
        needs_trace_add_frame(&written, &rig.needs, 16667 * (frame + 1));
    }
    assert_int_not_equal(access(path, F_OK), 0); /* not before it is whole */
    assert_true(needs_trace_end(&written, true));
    needs_rig_close(&rig);

    size_t size;
    uint8_t *data = read_whole(path, &size);
    struct slc_feedback_trace trace;
    const SluiceAllocationCallbacks cb = slc_allocator(NULL);
    CHECK_OK(slc_feedback_trace_open(&trace, &cb, (struct slc_cursor){.data = data, .end = size}));
    assert_null(trace.in.why);
    assert_int_equal(trace.texture_count, TEXTURES);
    assert_int_equal(trace.frame_count, FRAMES);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        assert_int_equal(trace.textures[i].primary, i);
        assert_int_equal(trace.textures[i].desc.width, descs[i].width);
        assert_int_equal(trace.textures[i].desc.packedTileCount, descs[i].packedTileCount);
    }
    needs_rig_open(&rig, descs, TEXTURES);
    compare_frames(&trace, &rig, 3);
    needs_rig_close(&rig);
    slc_feedback_trace_close(&trace, &cb);
    free(data);
    remove(path);
}

static void a_trace_of_a_failed_walk_leaves_what_was_there(void **state)
{
    (void)state;
    const char *path = "test_needs_trace_older.slt";
    struct needs_rig rig;
    struct needs_trace trace;
    char text[16] = {0};
    FILE *file = fopen(path, "w");
    fputs("older", file);
    fclose(file);
    needs_rig_open(&rig, descs, TEXTURES);
    assert_true(needs_trace_begin(&trace, path, &rig.needs, FRAMES, 16667));
    needs_rig_frame(&rig);
    needs_trace_add_frame(&trace, &rig.needs, 16667);
    assert_false(needs_trace_end(&trace, false));
    needs_rig_close(&rig);
    file = fopen(path, "r");
    (void)!fread(text, 1, sizeof text - 1, file);
    fclose(file);
    assert_string_equal(text, "older");
    assert_int_not_equal(access("test_needs_trace_older.slt.sluice-part", F_OK), 0);
    remove(path);
}

static void a_trace_that_cannot_be_opened_is_refused(void **state)
{
    (void)state;
    struct needs_rig rig;
    struct needs_trace trace;
    needs_rig_open(&rig, descs, TEXTURES);
    assert_false(needs_trace_begin(&trace, "no/such/folder/trace", &rig.needs, 1, 1));
    needs_rig_close(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_trace_holds_all_maps_of_all_frames),
        cmocka_unit_test(a_trace_of_a_failed_walk_leaves_what_was_there),
        cmocka_unit_test(a_trace_that_cannot_be_opened_is_refused),
    };
    return RUN_TESTS(tests);
}
