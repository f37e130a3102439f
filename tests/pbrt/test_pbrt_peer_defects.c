/*
 * Defects of PbrtSceneLoader, the reader of pbrt scenes in the OptiX Toolkit, must not occur here.
 * Numbers are those of a list of twenty. samples/demand-pbrt/test_peer_defects.py has the defects
 * of the renderer.
 */
#include "pbrt/pbrt_files.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define HEADER "WorldBegin\n"
#define MESH "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0] "

static struct pbrt_files files;
static SluicePbrtMesh mesh;

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

static void open_text(const char *text)
{
    CHECK_OK(pbrt_open_text(&files, text));
}

static void read_mesh(uint32_t shape)
{
    mesh = (SluicePbrtMesh){.structSize = sizeof mesh};
    CHECK_OK(sluiceReadPbrtShape(files.scene, shape, &mesh));
}

static void free_mesh(void)
{
    CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
}

static bool is_near(float a, double b)
{
    return fabs((double)a - b) < 1e-5;
}

static void write_ply(const char *faces, int count)
{
    char text[1024];
    int size =
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                 "property float z\nelement face %d\nproperty list uchar int vertex_indices\n"
                 "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 0.5 0\n%s",
                 count, faces);
    pbrt_write(&files, "mesh.ply", text, (size_t)size);
}

/* OptiX Toolkit reads every mesh completely while parsing, and again for each use. */
static void defect_1_no_mesh_is_read_while_parsing(void **state)
{
    (void)state;
    SluicePbrtBounds bounds;
    open_text(HEADER "Shape \"plymesh\" \"string filename\" \"mesh.ply\"\nTranslate 1 0 0\n"
                     "Shape \"plymesh\" \"string filename\" \"mesh.ply\"\n");
    write_ply("not a face\n", 1); /* not needed for the bounds */
    CHECK_OK(sluiceGetPbrtShapeBounds(files.scene, 0, &bounds));
    assert_true(bounds.least[0] == -1.0f && bounds.most[0] == 1.0f);
    assert_int_equal(unlink(pbrt_path(&files, "mesh.ply")), 0);
    CHECK_OK(sluiceGetPbrtShapeBounds(files.scene, 1,
                                      &bounds)); /* bounds of the file that was read before */
    assert_true(bounds.least[0] == 0.0f && bounds.most[0] == 2.0f);
}

static void defect_2_quads_leave_the_next_face_alone(void **state)
{
    (void)state;
    open_text(HEADER "Shape \"plymesh\" \"string filename\" \"mesh.ply\"\n");
    write_ply("4 0 1 2 3\n3 2 3 4\n5 0 1 2 3 4\n", 3);
    read_mesh(0);
    const uint32_t last[3] = {2, 3, 4};
    assert_int_equal(mesh.triangleCount, 6);
    assert_memory_equal(mesh.pIndices + 6, last, sizeof last);
    double area = 0; /* the quad 1, the triangle 0.25, the pentagon 1.5 */
    for (uint32_t i = 0; i < mesh.triangleCount; i++) {
        const float *a = mesh.pPositions + 3 * mesh.pIndices[3 * i];
        const float *b = mesh.pPositions + 3 * mesh.pIndices[3 * i + 1];
        const float *c = mesh.pPositions + 3 * mesh.pIndices[3 * i + 2];
        area += ((double)b[0] - a[0]) * (c[1] - a[1]) - ((double)b[1] - a[1]) * (c[0] - a[0]);
    }
    assert_true(fabs(area / 2 - 2.75) < 1e-6);
    free_mesh();
    write_ply("3 0 1 5\n", 1);
    CHECK_RESULT(sluiceReadPbrtShape(files.scene, 0, &mesh), SLUICE_ERROR_CORRUPT_DATA);
}

static void defect_3_inline_meshes_keep_their_normals(void **state)
{
    (void)state;
    open_text(HEADER MESH "\"normal N\" [0 0 1 0 1 0 1 0 0]\n" MESH
                          "\"point N\" [0 0 1 0 1 0 1 0 0]\n");
    const float normals[9] = {0, 0, 1, 0, 1, 0, 1, 0, 0};
    for (uint32_t i = 0; i < 2; i++) {
        read_mesh(i);
        assert_non_null(mesh.pNormals);
        assert_memory_equal(mesh.pNormals, normals, sizeof normals);
        free_mesh();
    }
}

static void defect_4_uvs_have_four_names_and_indices_are_checked(void **state)
{
    (void)state;
    open_text(HEADER MESH "\"float uv\" [0 0 1 0 0 .5]\n" MESH "\"float st\" [0 0 1 0 0 .5]\n" MESH
                          "\"point2 uv\" [0 0 1 0 0 .5]\n" MESH "\"point2 st\" [0 0 1 0 0 .5]\n"
                          "Shape \"trianglemesh\" \"integer indices\" [0 1 3] "
                          "\"point P\" [0 0 0 1 0 0 0 1 0]\n"
                          "Shape \"trianglemesh\" \"integer indices\" [0 1 -1] "
                          "\"point P\" [0 0 0 1 0 0 0 1 0]\n"
                          "Shape \"trianglemesh\" \"integer indices\" [0 1 2]\n");
    const float uvs[6] = {0, 0, 1, 0, 0, .5f};
    assert_int_equal(pbrt_info(&files).shapeCount, 4);
    for (uint32_t i = 0; i < 4; i++) {
        read_mesh(i);
        assert_non_null(mesh.pUvs);
        assert_memory_equal(mesh.pUvs, uvs, sizeof uvs);
        free_mesh();
    }
}

/* Cameras placed by Transform, and mirrored ones. Element [row * 4 + column]. */
static void defect_5_all_transforms_place_the_camera(void **state)
{
    (void)state;
    open_text("Transform [1 0 0 0  0 1 0 0  0 0 1 0  -3 -4 -5 1]\nCamera \"perspective\"\n" HEADER);
    const float *m = pbrt_info(&files).cameraToWorld;
    assert_true(is_near(m[3], 3) && is_near(m[7], 4) && is_near(m[11], 5));
    open_text("LookAt 0 -5 0  0 0 0  0 0 1\nCamera \"perspective\"\n" HEADER);
    SluicePbrtSceneInfo plain = pbrt_info(&files);
    open_text("Scale -1 1 1\nLookAt 0 -5 0  0 0 0  0 0 1\nCamera \"perspective\"\n" HEADER);
    SluicePbrtSceneInfo mirrored = pbrt_info(&files);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sign = column == 0 ? -1 : 1, value = plain.cameraToWorld[4 * row + column];
            assert_true(is_near(mirrored.cameraToWorld[4 * row + column], sign * value));
        }
}

static void defect_7_textures_of_the_world_are_found(void **state)
{
    (void)state;
    open_text(HEADER
              "Texture \"world\" \"color\" \"constant\" \"rgb value\" [.1 .2 .3]\n"
              "AttributeBegin\nTexture \"outer\" \"color\" \"constant\" \"rgb value\" [.4 .5 .6]\n"
              "AttributeBegin\nMaterial \"matte\" \"texture Kd\" \"world\"\nShape \"sphere\"\n"
              "Material \"matte\" \"texture Kd\" \"outer\"\nShape \"sphere\"\n"
              "Material \"matte\" \"texture Kd\" \"nowhere\"\nShape \"sphere\"\n"
              "AttributeEnd\nAttributeEnd\n");
    const float expected[3] = {.1f, .4f, .5f};
    for (uint32_t i = 0; i < 3; i++) {
        SluicePbrtMaterial m = pbrt_material(&files, pbrt_shape(&files, i).material);
        assert_true(is_near(m.diffuse.value[0], (double)expected[i]));
    }
}

static void defect_8_materials_inherit_nothing_from_blocks(void **state)
{
    (void)state;
    open_text(HEADER
              "AttributeBegin\nMaterial \"matte\" \"rgb Kd\" [1 0 0]\n"
              "AttributeBegin\nMaterial \"mirror\"\nShape \"sphere\"\nAttributeEnd\n"
              "Material \"matte\"\nShape \"sphere\"\nMaterial \"plastic\"\nShape \"sphere\"\n"
              "AttributeEnd\n");
    SluicePbrtMaterial mirror = pbrt_material(&files, pbrt_shape(&files, 0).material);
    SluicePbrtMaterial matte = pbrt_material(&files, pbrt_shape(&files, 1).material);
    SluicePbrtMaterial plastic = pbrt_material(&files, pbrt_shape(&files, 2).material);
    assert_true(mirror.diffuse.value[0] == 0.0f && is_near(mirror.specular.value[1], 0.9));
    for (int i = 0; i < 3; i++) {
        assert_true(matte.diffuse.value[i] == 0.5f);
        assert_true(plastic.diffuse.value[i] == 0.25f);
    }
}

static void defect_9_mixtures_and_textures_of_textures_are_kept(void **state)
{
    (void)state;
    pbrt_write(&files, "p.png", "", 0);
    open_text(
        HEADER
        "MakeNamedMaterial \"a\" \"string type\" \"matte\"\n"
        "MakeNamedMaterial \"blend\" \"string type\" \"mix\" \"string namedmaterial1\" \"a\" "
        "\"string namedmaterial2\" \"a\"\nNamedMaterial \"blend\"\nShape \"sphere\"\n"
        "Texture \"p\" \"color\" \"imagemap\" \"string filename\" \"p.png\" \"float uscale\" 4\n"
        "Texture \"s\" \"color\" \"scale\" \"texture tex1\" \"p\" \"rgb tex2\" [.5 .5 .5]\n"
        "Texture \"m\" \"color\" \"mix\" \"texture tex1\" \"s\" \"rgb tex2\" [1 0 0]\n"
        "Material \"matte\" \"texture Kd\" \"m\"\nShape \"sphere\"\n");
    SluicePbrtMaterial blend = pbrt_material(&files, pbrt_shape(&files, 0).material);
    assert_int_equal(blend.kind, SLUICE_PBRT_MATERIAL_MIX);
    SluicePbrtMaterial matte = pbrt_material(&files, pbrt_shape(&files, 1).material);
    SluicePbrtTexture mix = {.structSize = sizeof mix}, scale = mix, picture = mix;
    CHECK_OK(sluiceGetPbrtTexture(files.scene, matte.diffuse.texture, &mix));
    assert_int_equal(mix.kind, SLUICE_PBRT_TEXTURE_MIX);
    CHECK_OK(sluiceGetPbrtTexture(files.scene, mix.inputs[0].texture, &scale));
    assert_int_equal(scale.kind, SLUICE_PBRT_TEXTURE_SCALE);
    CHECK_OK(sluiceGetPbrtTexture(files.scene, scale.inputs[0].texture, &picture));
    assert_true(picture.pImagePath && picture.scale[0] == 4.0f);
}

static void defect_10_orientation_toggles_and_no_object_ends_the_load(void **state)
{
    (void)state;
    open_text(HEADER "ReverseOrientation\nReverseOrientation\nShape \"sphere\"\n"
                     "ObjectBegin \"a\"\nShape \"sphere\"\nObjectEnd\n"
                     "ObjectBegin \"b\"\nShape \"nothing known\"\nObjectInstance \"a\"\n"
                     "Shape \"disk\"\nObjectEnd\nObjectInstance \"b\"\n");
    SluicePbrtSceneInfo info = pbrt_info(&files);
    assert_false(pbrt_shape(&files, 0).reverseOrientation);
    assert_int_equal(info.shapeCount, 3);
    assert_int_equal(info.instanceCount, 1); /* no instance of "a" inside of "b" */
    assert_int_equal(pbrt_shape(&files, 2).kind, SLUICE_PBRT_SHAPE_DISK);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, init, finish)
    const struct CMUnitTest tests[] = {
        TEST(defect_1_no_mesh_is_read_while_parsing),
        TEST(defect_2_quads_leave_the_next_face_alone),
        TEST(defect_3_inline_meshes_keep_their_normals),
        TEST(defect_4_uvs_have_four_names_and_indices_are_checked),
        TEST(defect_5_all_transforms_place_the_camera),
        TEST(defect_7_textures_of_the_world_are_found),
        TEST(defect_8_materials_inherit_nothing_from_blocks),
        TEST(defect_9_mixtures_and_textures_of_textures_are_kept),
        TEST(defect_10_orientation_toggles_and_no_object_ends_the_load),
    };
    return RUN_TESTS(tests);
}
