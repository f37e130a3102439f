/* Meshes in memory for several devices. Each mesh of the scene is one triangle of 48 bytes. */
#define _XOPEN_SOURCE 700
#include "../../samples/demand-pbrt/mesh_cache.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SHAPES = 12, MESH_BYTES = 48 };

struct rig {
    char path[32];
    struct scene scene;
    struct mesh_cache *cache;
};

static void open_scene(char *path, struct scene *scene)
{
    FILE *file = fdopen(mkstemp(path), "w");
    assert_non_null(file);
    fputs("WorldBegin\n", file);
    for (int i = 0; i < SHAPES; i++)
        fprintf(file,
                "Shape \"trianglemesh\" \"point3 P\" [ %d 0 0 1 0 0 0 1 0 ] "
                "\"integer indices\" [ 0 1 2 ]\n",
                i);
    assert_int_equal(fclose(file), 0);
    const SluicePbrtSceneCreateInfo info = {.structSize = sizeof info, .pPath = path};
    *scene = (struct scene){.info.structSize = sizeof scene->info};
    CHECK_OK(sluiceOpenPbrtScene(&info, &scene->pbrt));
    CHECK_OK(sluiceGetPbrtSceneInfo(scene->pbrt, &scene->info));
    assert_int_equal(scene->info.shapeCount, SHAPES);
}

static void set_up(struct rig *rig, uint32_t device_count, uint64_t most_meshes)
{
    snprintf(rig->path, sizeof rig->path, "/tmp/sluice_meshes_XXXXXX");
    open_scene(rig->path, &rig->scene);
    rig->cache = mesh_cache_create(&rig->scene, device_count, most_meshes * MESH_BYTES);
    assert_non_null(rig->cache);
}

static void tear_down(struct rig *rig)
{
    mesh_cache_destroy(rig->cache);
    sluiceDestroyPbrtScene(rig->scene.pbrt);
    assert_int_equal(unlink(rig->path), 0);
}

static void use(struct rig *rig, uint32_t device, uint32_t shape)
{
    struct mesh_read read;
    mesh_cache_read(rig->cache, shape, &read);
    CHECK_OK(read.result);
    assert_true(read.mesh.pPositions[0] == (float)shape);
    mesh_cache_give(rig->cache, device, &read);
}

static void assert_counts(struct rig *rig, uint64_t read_count, uint64_t shared_count)
{
    uint64_t reads, shared;
    mesh_cache_get_counts(rig->cache, &reads, &shared);
    assert_int_equal(reads, read_count);
    assert_int_equal(shared, shared_count);
}

static void each_mesh_is_read_once_for_all_devices(void **state)
{
    struct rig rig;
    (void)state;
    set_up(&rig, 3, SHAPES);
    for (uint32_t device = 0; device < 3; device++)
        for (uint32_t shape = 0; shape < SHAPES; shape++)
            use(&rig, device, shape);
    assert_counts(&rig, SHAPES, 2 * SHAPES);
    use(&rig, 0, 0); /* freed when the last device had given it back */
    assert_counts(&rig, SHAPES + 1, 2 * SHAPES);
    tear_down(&rig);
}

static void meshes_of_one_device_alone_make_room_for_shared_ones(void **state)
{
    struct rig rig;
    (void)state;
    set_up(&rig, 2, 4);
    for (uint32_t shape = 0; shape < 6; shape++)
        use(&rig, 0, shape);
    for (uint32_t shape = 6; shape < SHAPES; shape++) {
        use(&rig, 0, shape);
        use(&rig, 1, shape);
    }
    assert_counts(&rig, SHAPES, SHAPES - 6);
    tear_down(&rig);
}

static void the_mesh_that_was_given_back_first_is_freed_first(void **state)
{
    struct rig rig;
    (void)state;
    set_up(&rig, 2, 3);
    for (uint32_t shape = 0; shape < 3; shape++)
        use(&rig, 0, shape);
    use(&rig, 0, 0); /* shape 1 is the oldest now */
    use(&rig, 0, 3);
    assert_counts(&rig, 4, 1);
    use(&rig, 1, 0);
    use(&rig, 1, 2);
    use(&rig, 1, 3);
    assert_counts(&rig, 4, 4);
    use(&rig, 1, 1);
    assert_counts(&rig, 5, 4);
    tear_down(&rig);
}

static void a_mesh_in_use_stays(void **state)
{
    struct rig rig;
    struct mesh_read first, second;
    (void)state;
    set_up(&rig, 2, 0);
    mesh_cache_read(rig.cache, 0, &first);
    use(&rig, 0, 1);
    mesh_cache_read(rig.cache, 0, &second);
    assert_counts(&rig, 2, 1);
    assert_ptr_equal(first.mesh.pPositions, second.mesh.pPositions);
    mesh_cache_give(rig.cache, 0, &first);
    assert_true(second.mesh.pPositions[0] == 0.0f);
    mesh_cache_give(rig.cache, 0, &second);
    use(&rig, 1, 0);
    assert_counts(&rig, 3, 1);
    tear_down(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_mesh_is_read_once_for_all_devices),
        cmocka_unit_test(meshes_of_one_device_alone_make_room_for_shared_ones),
        cmocka_unit_test(the_mesh_that_was_given_back_first_is_freed_first),
        cmocka_unit_test(a_mesh_in_use_stays),
    };
    return RUN_TESTS(tests);
}
