/* Scenes made elsewhere: all of them load, and boxes and materials are those of the tables beside
 * them, which another program has made. */
#include "pbrt/pbrt_files.h"
#include "support/test.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct pbrt_files files;

static int init(void **state)
{
    (void)state;
    pbrt_files_init(&files);
    return 0;
}

static int finish(void **state)
{
    (void)state;
    pbrt_files_finish(&files);
    return 0;
}

/* Scenes and files to include alike. Returns how many scenes there are. */
static uint32_t load_folder(const char *folder, uint32_t *shapes)
{
    uint32_t count = 0;
    DIR *entries = opendir(folder);
    if (!entries) /* a file without an extension */
        return 0;
    for (struct dirent *entry; (entry = readdir(entries));) {
        char path[2048];
        const char *dot = strrchr(entry->d_name, '.');
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] == '.' || strcmp(entry->d_name, "malformed") == 0)
            continue;
        if (!dot) {
            count += load_folder(path, shapes);
        } else if (strcmp(dot, ".pbrt") == 0) {
            SluiceResult result = pbrt_open(&files, path);
            if (result == SLUICE_ERROR_CORRUPT_DATA && strstr(files.log, "no WorldBegin"))
                continue; /* a part of another scene */
            if (result != SLUICE_SUCCESS)
                fail_msg("%s: %s", path, files.log);
            uint32_t good = pbrt_read_all(&files);
            bool lacks_files = strstr(path, "pbrt-v3-rs/materials/mix.pbrt") != NULL;
            if (!lacks_files && good < pbrt_info(&files).shapeCount)
                fail_msg("%s: %u shapes: %s", path, good, files.log);
            *shapes += good;
            count++;
        }
    }
    closedir(entries);
    return count;
}

static void all_sample_scenes_load_with_all_of_their_shapes(void **state)
{
    (void)state;
    static const char *const FOLDERS[] = {"optix-toolkit", "pbrt-v3",  "pbrt-v3-rs",
                                          "rs_pbrt",       "bitterli", "made"};
    uint32_t scenes = 0, shapes = 0;
    for (int i = 0; i < 6; i++) {
        char path[1024];
        if (!pbrt_sample_path(path, FOLDERS[i]))
            SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
        scenes += load_folder(path, &shapes);
    }
    print_message("# %u scenes, %u shapes\n", scenes, shapes);
    assert_true(scenes >= 70);
    assert_true(shapes >= 400);
}

static void place_bounds(const float m[12], const SluicePbrtBounds *in, SluicePbrtBounds *out)
{
    for (int row = 0; row < 3; row++) {
        double least = 1e30, most = -1e30;
        for (int corner = 0; corner < 8; corner++) {
            double x = m[4 * row + 3];
            for (int i = 0; i < 3; i++)
                x += (double)m[4 * row + i] * (corner >> i & 1 ? in->most[i] : in->least[i]);
            least = fmin(least, x);
            most = fmax(most, x);
        }
        out->least[row] = (float)least;
        out->most[row] = (float)most;
    }
}

/* Boxes in the world: free shapes and shapes of instances in the order of the text. */
static uint32_t find_boxes(SluicePbrtBounds *boxes, uint32_t *shapes)
{
    SluicePbrtSceneInfo info = pbrt_info(&files);
    const SluicePbrtInstance *instances;
    uint32_t count = 0;
    for (uint32_t i = 0; i < info.shapeCount; i++)
        if (pbrt_shape(&files, i).object == SLUICE_PBRT_NONE) {
            CHECK_OK(sluiceGetPbrtShapeBounds(files.scene, i, &boxes[count]));
            shapes[count++] = i;
        }
    CHECK_OK(sluiceGetPbrtInstances(files.scene, &instances));
    for (uint32_t i = 0; i < info.instanceCount; i++) {
        SluicePbrtObject object;
        CHECK_OK(sluiceGetPbrtObject(files.scene, instances[i].object, &object));
        for (uint32_t j = 0; j < object.shapeCount; j++) {
            SluicePbrtBounds bounds;
            shapes[count] = object.firstShape + j;
            CHECK_OK(sluiceGetPbrtShapeBounds(files.scene, shapes[count], &bounds));
            place_bounds(instances[i].transform, &bounds, &boxes[count++]);
        }
    }
    return count;
}

static void check_material(const char *expected, uint32_t shape)
{
    SluicePbrtMaterial material = pbrt_material(&files, pbrt_shape(&files, shape).material);
    float rgb[3];
    if (sscanf(expected, "default %f", &rgb[0]) == 1)
        rgb[1] = rgb[2] = rgb[0];
    else if (sscanf(expected, "texture constant %f %f %f", &rgb[0], &rgb[1], &rgb[2]) != 3 &&
             sscanf(expected, "%f %f %f", &rgb[0], &rgb[1], &rgb[2]) != 3) {
        assert_non_null(strstr(expected, "texture imagemap"));
        assert_true(material.diffuse.texture != SLUICE_PBRT_NONE);
        return;
    }
    for (int i = 0; i < 3; i++)
        assert_true(fabsf(material.diffuse.value[i] - rgb[i]) < 1e-6f);
}

static void check_table(const char *scene, const char *table)
{
    static SluicePbrtBounds boxes[64];
    uint32_t shapes[64], row = 0;
    char path[1024], line[1024];
    if (!pbrt_sample_path(path, scene))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    CHECK_OK(pbrt_open(&files, path));
    uint32_t count = find_boxes(boxes, shapes);
    assert_true(pbrt_sample_path(path, table));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        float box[6];
        char diffuse[256];
        if (sscanf(
                line,
                "%*d\t%*[^\t]\t%*[^\t]\t%*[^\t]\t%*d\t%*d\t%f %f %f %f %f %f\t%*[^\t]\t%255[^\t]",
                &box[0], &box[1], &box[2], &box[3], &box[4], &box[5], diffuse) != 7)
            continue;
        assert_true(row < count);
        for (int i = 0; i < 3; i++)
            if (fabsf(boxes[row].least[i] - box[i]) > 2e-4f ||
                fabsf(boxes[row].most[i] - box[3 + i]) > 2e-4f)
                fail_msg("%s, row %u, axis %d: %g to %g", scene, row, i,
                         (double)boxes[row].least[i], (double)boxes[row].most[i]);
        check_material(diffuse, shapes[row++]);
    }
    fclose(file);
    assert_int_equal(row, count);
}

static void transforms_place_shapes_where_the_table_says(void **state)
{
    (void)state;
    check_table("made/transforms/transforms.pbrt", "made/transforms/transforms.tsv");
}

static void transforms_of_object_and_instance_add_up(void **state)
{
    (void)state;
    check_table("made/instances/transforms-add-up.pbrt", "made/instances/transforms-add-up.tsv");
}

static void blocks_save_and_restore_what_the_table_says(void **state)
{
    (void)state;
    check_table("made/state/inherit.pbrt", "made/state/inherit.tsv");
}

static void thirteen_encodings_of_a_cube_are_one_cube(void **state)
{
    (void)state;
    char path[1024];
    if (!pbrt_sample_path(path, "made/ply/ply.pbrt"))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    CHECK_OK(pbrt_open(&files, path));
    uint32_t count = pbrt_info(&files).shapeCount;
    assert_true(count >= 13);
    for (uint32_t i = 0; i < count; i++) {
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        CHECK_OK(sluiceReadPbrtShape(files.scene, i, &mesh));
        assert_int_equal(mesh.triangleCount, 12);
        double area = 0;
        for (uint32_t t = 0; t < mesh.triangleCount; t++) {
            const float *p[3];
            double a[3], b[3], c[3];
            for (int j = 0; j < 3; j++)
                p[j] = &mesh.pPositions[3 * mesh.pIndices[3 * t + (uint32_t)j]];
            for (int j = 0; j < 3; j++) {
                a[j] = (double)p[1][j] - p[0][j];
                b[j] = (double)p[2][j] - p[0][j];
            }
            for (int j = 0; j < 3; j++)
                c[j] = a[(j + 1) % 3] * b[(j + 2) % 3] - a[(j + 2) % 3] * b[(j + 1) % 3];
            area += 0.5 * sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        }
        assert_true(fabs(area - 6) < 1e-5);
        sluiceFreePbrtMesh(files.scene, &mesh);
    }
}

/* A room of 65 files, in an archive. The headers of its PLY files announce 143 163 triangles. */
static void the_living_room_has_its_65_shapes_and_all_of_their_triangles(void **state)
{
    (void)state;
    char archive[1024];
    uint32_t triangles = 0, plys = 0;
    if (!pbrt_sample_path(archive, "bitterli/living-room.tar.xz"))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", archive);
    if (!pbrt_unpack(&files, archive))
        SKIP_TEST("tar and xz cannot unpack %s", archive);
    CHECK_OK(pbrt_open(&files, pbrt_path(&files, "living-room/scene-v4.pbrt")));
    SluicePbrtSceneInfo info = pbrt_info(&files);
    assert_int_equal(info.version, 4);
    assert_int_equal(info.shapeCount, 65);
    assert_int_equal(info.lightCount, 1);
    assert_true(info.filmWidth == 1280 && info.filmHeight == 720);
    assert_int_equal(files.errors, 0);
    assert_int_equal(pbrt_read_all(&files), 65);
    for (uint32_t i = 0; i < info.shapeCount; i++) {
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        plys += pbrt_shape(&files, i).kind == SLUICE_PBRT_SHAPE_PLY;
        CHECK_OK(sluiceReadPbrtShape(files.scene, i, &mesh));
        triangles += mesh.triangleCount;
        CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
    }
    assert_int_equal(plys, 65);
    assert_int_equal(triangles, 143163);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_sample_scenes_load_with_all_of_their_shapes, init,
                                        finish),
        cmocka_unit_test_setup_teardown(transforms_place_shapes_where_the_table_says, init, finish),
        cmocka_unit_test_setup_teardown(transforms_of_object_and_instance_add_up, init, finish),
        cmocka_unit_test_setup_teardown(blocks_save_and_restore_what_the_table_says, init, finish),
        cmocka_unit_test_setup_teardown(thirteen_encodings_of_a_cube_are_one_cube, init, finish),
        cmocka_unit_test_setup_teardown(
            the_living_room_has_its_65_shapes_and_all_of_their_triangles, init, finish),
    };
    return RUN_TESTS(tests);
}
