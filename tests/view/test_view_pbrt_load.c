/* mkdtemp */
#define _XOPEN_SOURCE 700

/* Opening scenes of pbrt without a device: a canceled one reads no further. */
#include "support/test.h"

#include "scene_open.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define SHAPES 20000u

static char folder[] = "/tmp/sluice-view-pbrt-XXXXXX", path[64], cache[64];

static uint64_t write_scene(void)
{
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.pbrt", folder);
    snprintf(cache, sizeof cache, "%s/cache", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    int size = fprintf(file, "WorldBegin\n");
    for (uint32_t i = 0; i < SHAPES; i++)
        size += fprintf(file, "Translate 1 %u 0\nShape \"sphere\"\n", i % 7);
    assert_int_equal(fclose(file), 0);
    return (uint64_t)size;
}

static bool open_scene(struct scene_progress *progress, struct scene_data *scene)
{
    const char *const paths[] = {path};
    const struct scene_request request = {
        .paths = paths, .path_count = 1, .cache = cache, .progress = progress};
    return scene_open_paths(&request, scene);
}

static void a_canceled_scene_reads_no_text(void **state)
{
    (void)state;
    struct scene_progress progress = {0};
    struct scene_data scene;
    const uint64_t size = write_scene();
    assert_true(size > 4u << 17);
    atomic_store(&progress.canceled, true);
    assert_false(open_scene(&progress, &scene));
    assert_true(atomic_load(&progress.read_size) == 0);
    atomic_store(&progress.canceled, false);
    assert_true(open_scene(&progress, &scene));
    assert_true(atomic_load(&progress.read_size) == size);
    scene_data_finish(&scene);
    unlink(path);
    char pictures[80];
    snprintf(pictures, sizeof pictures, "%s/pictures", cache);
    rmdir(pictures);
    rmdir(cache);
    assert_int_equal(rmdir(folder), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_canceled_scene_reads_no_text)};
    return RUN_TESTS(tests);
}
