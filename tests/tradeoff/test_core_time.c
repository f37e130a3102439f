/* Number of frames of a recording, compared with the lines of its dump in tests/data. */
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core_time.h"

static double count_frames(const char *name, size_t cut)
{
    char path[4096];
    static char data[1 << 20];
    const char *root = getenv("SLUICE_SOURCE_ROOT");
    snprintf(path, sizeof path, "%s/tests/data/%s.trace", root ? root : ".", name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    assert_true(size > cut && size < sizeof data);
    return core_time_count_frames(data, size - cut);
}

static void frames_are_those_that_ask_for_tiles(void **state)
{
    (void)state;
    assert_true(count_frames("failures", 0) == 8.0);
    assert_true(count_frames("frame_loop", 0) == 12.0);
}

static void a_frame_that_asks_for_no_tile_is_one(void **state)
{
    (void)state;
    assert_true(count_frames("defragment", 0) == 2.0);
}

static void a_recording_that_is_cut_off_has_no_time(void **state)
{
    (void)state;
    assert_true(count_frames("frame_loop", 3) == 0.0);
    assert_true(isnan(core_time_per_frame("/nowhere/at.all")));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_those_that_ask_for_tiles),
        cmocka_unit_test(a_frame_that_asks_for_no_tile_is_one),
        cmocka_unit_test(a_recording_that_is_cut_off_has_no_time),
    };
    return RUN_TESTS(tests);
}
