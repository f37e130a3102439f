/* mkdtemp */
#define _XOPEN_SOURCE 700

/* Opening scenes of pbrt without a device: a canceled one reads no further. */
#include "support/test.h"

#include "scene_open.h"
#include "scene_pbrt.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SHAPES 20000u

static char folder[] = "/tmp/sluice-view-pbrt-XXXXXX", path[64], cache[64], picture[64];

static FILE *begin_scene(void)
{
    strcpy(folder, "/tmp/sluice-view-pbrt-XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.pbrt", folder);
    snprintf(cache, sizeof cache, "%s/cache", folder);
    snprintf(picture, sizeof picture, "%s/wood.png", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    return file;
}

static void remove_scene(void)
{
    char pictures[80];
    unlink(path);
    unlink(picture);
    snprintf(pictures, sizeof pictures, "%s/pictures", cache);
    rmdir(pictures);
    rmdir(cache);
    assert_int_equal(rmdir(folder), 0);
}

static uint64_t write_scene(void)
{
    FILE *file = begin_scene();
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
    remove_scene();
}

/* Each of 31 mixtures has the one before as both inputs: 2^31 ways lead to the last input.
 * The picture is an empty file: opening a scene reads no picture. */
static void write_mixtures(const char *last)
{
    FILE *file = begin_scene(), *empty = fopen(picture, "w");
    assert_true(empty && fclose(empty) == 0);
    fprintf(file, "WorldBegin\nTexture \"t0\" \"spectrum\" %s\n", last);
    for (uint32_t i = 1; i < 32; i++)
        fprintf(file,
                "Texture \"t%u\" \"spectrum\" \"mix\" \"texture tex1\" \"t%u\" "
                "\"texture tex2\" \"t%u\"\n",
                i, i - 1, i - 1);
    fprintf(file, "Material \"diffuse\" \"texture reflectance\" \"t31\"\nShape \"sphere\"\n");
    assert_int_equal(fclose(file), 0);
}

static void pictures_of_nested_mixtures_are_found_at_once(void **state)
{
    (void)state;
    for (uint32_t has_picture = 0; has_picture < 2; has_picture++) {
        struct scene_progress progress = {0};
        struct scene_data scene;
        write_mixtures(has_picture ? "\"imagemap\" \"string filename\" \"wood.png\""
                                   : "\"constant\" \"rgb value\" [.5 .2 .1]");
        assert_true(open_scene(&progress, &scene));
        const struct scene *opened = &scene.pbrt->scene;
        const SluicePbrtMaterial material = scene_material(opened, scene_shape(opened, 0).material);
        assert_int_equal(scene_pbrt_picture_of(scene.pbrt, &material.diffuse),
                         has_picture ? 0 : UINT32_MAX);
        scene_data_finish(&scene);
        remove_scene();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_canceled_scene_reads_no_text),
        cmocka_unit_test(pictures_of_nested_mixtures_are_found_at_once)};
    return RUN_TESTS(tests);
}
