/* Text of scenes: transforms against a naive model, cameras, scopes, materials. */
#include "pbrt/pbrt_files.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if TEST_HAS_ZLIB
#include <zlib.h>
#endif

#define HEADER "WorldBegin\n"

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

/* The naive model: 4 x 4 matrices, multiplied as in a textbook. */

typedef double matrix[4][4];

static void multiply(matrix a, matrix b)
{
    matrix c;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            c[i][j] = 0;
            for (int k = 0; k < 4; k++)
                c[i][j] += a[i][k] * b[k][j];
        }
    memcpy(a, c, sizeof c);
}

static void set_identity(matrix m)
{
    memset(m, 0, sizeof(matrix));
    for (int i = 0; i < 4; i++)
        m[i][i] = 1;
}

/* Rodrigues: v cos + (k x v) sin + k (k . v)(1 - cos) on each unit vector. */
static void set_rotation(matrix m, double degrees, const double axis[3])
{
    double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    double k[3] = {axis[0] / length, axis[1] / length, axis[2] / length};
    double s = sin(degrees * acos(-1) / 180), c = cos(degrees * acos(-1) / 180);
    set_identity(m);
    for (int column = 0; column < 3; column++) {
        double v[3] = {column == 0, column == 1, column == 2};
        double cross[3] = {k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2],
                           k[0] * v[1] - k[1] * v[0]};
        double dot = k[column];
        for (int row = 0; row < 3; row++)
            m[row][column] = v[row] * c + cross[row] * s + k[row] * dot * (1 - c);
    }
}

/* Appends a random directive to the text, and to the model. */
static void add_directive(char *text, size_t size, matrix model)
{
    double n[16];
    matrix m;
    size_t length = strlen(text);
    for (int i = 0; i < 16; i++) {
        uint32_t drawn = (uint32_t)roll() % 4001;
        n[i] = ((double)drawn - 2000) / 1000;
    }
    if (fabs(n[1]) + fabs(n[2]) + fabs(n[3]) == 0)
        n[1] = 1;
    set_identity(m);
    switch ((uint32_t)roll() % 5) {
    case 0:
        snprintf(text + length, size - length, "Translate %.3f %.3f %.3f\n", n[0], n[1], n[2]);
        for (int i = 0; i < 3; i++)
            m[i][3] = n[i];
        break;
    case 1:
        snprintf(text + length, size - length, "Scale %.3f %.3f %.3f\n", n[0], n[1], n[2]);
        for (int i = 0; i < 3; i++)
            m[i][i] = n[i];
        break;
    case 2:
        snprintf(text + length, size - length, "Rotate %.3f %.3f %.3f %.3f\n", 100 * n[0], n[1],
                 n[2], n[3]);
        set_rotation(m, 100 * n[0], n + 1);
        break;
    default: {
        bool replaces = n[12] > 1;
        int at = snprintf(text + length, size - length, "%s [",
                          replaces ? "Transform" : "ConcatTransform");
        length += (size_t)at;
        for (int i = 0; i < 16; i++) {
            m[i % 4][i / 4] = i % 4 == 3 ? i == 15 : n[i];
            at = snprintf(text + length, size - length, " %.3f", m[i % 4][i / 4]);
            length += (size_t)at;
        }
        snprintf(text + length, size - length, " ]\n");
        if (replaces)
            set_identity(model);
    }
    }
    multiply(model, m);
}

static void transforms_are_those_of_a_naive_model(void **state)
{
    (void)state;
    roll_seed(18);
    for (int round = 0; round < 200; round++) {
        char text[8192] = HEADER;
        matrix model;
        double size = 1e-3;
        set_identity(model);
        uint32_t count = (uint32_t)roll() % 8;
        for (uint32_t i = 0; i <= count; i++)
            add_directive(text, sizeof text, model);
        strcat(text, "Shape \"sphere\"\n");
        CHECK_OK(pbrt_open_text(&files, text));
        SluicePbrtShape shape = pbrt_shape(&files, 0);
        for (int i = 0; i < 12; i++)
            size = fmax(size, fabs(model[i / 4][i % 4]));
        for (int i = 0; i < 12; i++)
            if (fabs(shape.transform[i] - model[i / 4][i % 4]) > 1e-6 * size)
                fail_msg("%s element %d is %g, not %g", text, i, (double)shape.transform[i],
                         model[i / 4][i % 4]);
    }
}

static void look_at_makes_a_left_handed_camera(void **state)
{
    (void)state;
    CHECK_OK(
        pbrt_open_text(&files, "LookAt 0 -5 0  0 0 0  0 0 1\nCamera \"perspective\"\n" HEADER));
    SluicePbrtSceneInfo info = pbrt_info(&files);
    /* Right is -x, up +z, forward +y. */
    static const float EXPECTED[12] = {-1, 0, 0, 0, 0, 0, 1, -5, 0, 1, 0, 0};
    for (int i = 0; i < 12; i++)
        assert_true(fabsf(info.cameraToWorld[i] - EXPECTED[i]) < 1e-6f);
    assert_true(info.fieldOfView == 90);
    assert_int_equal(info.filmWidth, 1280);
    assert_true(fabsf(info.screenWindow[1] - 1280.0f / 720) < 1e-6f);
    assert_true(info.screenWindow[3] == 1);
}

static void a_matrix_and_look_at_make_the_same_camera(void **state)
{
    (void)state;
    CHECK_OK(pbrt_open_text(
        &files, "LookAt 0 -4 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 60\n" HEADER));
    SluicePbrtSceneInfo a = pbrt_info(&files);
    CHECK_OK(pbrt_open_text(&files, "Transform [ -1 0 0 0  0 0 1 0  0 1 0 0  0 0 4 1 ]\n"
                                    "Camera \"perspective\" \"float halffov\" 30\n" HEADER));
    SluicePbrtSceneInfo b = pbrt_info(&files);
    for (int i = 0; i < 12; i++)
        assert_true(fabsf(a.cameraToWorld[i] - b.cameraToWorld[i]) < 1e-6f);
    assert_true(a.fieldOfView == b.fieldOfView);
}

static void parameters_go_on_after_an_included_file(void **state)
{
    (void)state;
    pbrt_write(&files, "part.pbrt", "Shape \"sphere\"", 14);
    CHECK_OK(pbrt_open_text(&files, HEADER
                            "Include \"part.pbrt\" \"float radius\" 3 \"rgb Kd\" [0 1 0]\n"));
    SluicePbrtShape shape = pbrt_shape(&files, 0);
    assert_true(shape.radius == 3);
    SluicePbrtMaterial material = pbrt_material(&files, shape.material);
    assert_true(material.diffuse.value[0] == 0 && material.diffuse.value[1] == 1);
}

static void an_import_leaves_the_state_as_it_was(void **state)
{
    (void)state;
    static const char PART[] =
        "Translate 9 9 9\nMakeNamedMaterial \"m\" \"string type\" \"diffuse\" "
        "\"rgb reflectance\" [0 0 1]\nAttributeBegin\nShape \"sphere\"";
    pbrt_write(&files, "part.pbrt", PART, sizeof PART - 1);
    CHECK_OK(pbrt_open_text(&files, HEADER
                            "Import \"part.pbrt\"\nNamedMaterial \"m\"\nShape \"sphere\"\n"));
    assert_int_equal(pbrt_info(&files).shapeCount, 2);
    assert_true(pbrt_shape(&files, 0).transform[3] == 9);
    SluicePbrtShape shape = pbrt_shape(&files, 1);
    assert_true(shape.transform[3] == 0);
    assert_true(pbrt_material(&files, shape.material).diffuse.value[2] == 1);
}

static void a_named_material_may_be_made_later(void **state)
{
    (void)state;
    CHECK_OK(pbrt_open_text(&files, HEADER "NamedMaterial \"m\"\nShape \"sphere\"\n"
                                           "NamedMaterial \"n\"\nShape \"sphere\"\n"
                                           "MakeNamedMaterial \"m\" \"string type\" \"mirror\"\n"));
    assert_int_equal(pbrt_material(&files, pbrt_shape(&files, 0).material).kind,
                     SLUICE_PBRT_MATERIAL_MIRROR);
    /* "n" is never made, so the one before stays, which is "m". */
    assert_int_equal(pbrt_material(&files, pbrt_shape(&files, 1).material).kind,
                     SLUICE_PBRT_MATERIAL_MIRROR);
    assert_non_null(strstr(files.log, "scene.pbrt:4:1: no material has the name \"n\""));
}

static void mixtures_of_themselves_end(void **state)
{
    (void)state;
    CHECK_OK(pbrt_open_text(
        &files, HEADER
        "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"b\" \"b\"]\n"
        "MakeNamedMaterial \"b\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]\n"
        "NamedMaterial \"a\"\nShape \"sphere\"\n"));
    assert_int_equal(pbrt_material(&files, pbrt_shape(&files, 0).material).kind,
                     SLUICE_PBRT_MATERIAL_DIFFUSE);
    assert_true(files.errors > 0);
}

static void both_versions_weigh_mixtures_their_way(void **state)
{
    (void)state;
    static const char *const MIXTURES[2] = {
        "\"string namedmaterial1\" \"red\" \"string namedmaterial2\" \"blue\" \"rgb amount\" [.25 "
        ".25 .25]",
        "\"string materials\" [\"red\" \"blue\"] \"float amount\" .75"};
    for (int i = 0; i < 2; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 HEADER "MakeNamedMaterial \"red\" \"string type\" \"matte\" \"rgb Kd\" [1 0 0]\n"
                        "MakeNamedMaterial \"blue\" \"string type\" \"matte\" \"rgb Kd\" [0 0 1]\n"
                        "Material \"mix\" %s\nShape \"sphere\"\n",
                 MIXTURES[i]);
        CHECK_OK(pbrt_open_text(&files, text));
        SluicePbrtMaterial mix = pbrt_material(&files, pbrt_shape(&files, 0).material);
        assert_int_equal(mix.kind, SLUICE_PBRT_MATERIAL_MIX);
        float red = 0;
        for (int j = 0; j < 2; j++)
            red += (j ? mix.amount.value[0] : 1 - mix.amount.value[0]) *
                   pbrt_material(&files, mix.materials[j]).diffuse.value[0];
        assert_true(fabsf(red - 0.25f) < 1e-6f);
    }
}

static void equal_materials_are_one(void **state)
{
    (void)state;
    CHECK_OK(pbrt_open_text(&files,
                            HEADER "Material \"matte\" \"rgb Kd\" [.1 .2 .3]\nShape \"sphere\"\n"
                                   "Material \"plastic\"\nShape \"sphere\"\n"
                                   "Material \"matte\" \"rgb Kd\" [.1 .2 .3]\nShape \"sphere\"\n"));
    assert_int_equal(pbrt_shape(&files, 0).material, pbrt_shape(&files, 2).material);
    assert_true(pbrt_shape(&files, 0).material != pbrt_shape(&files, 1).material);
}

static void reverse_orientation_is_toggled(void **state)
{
    (void)state;
    CHECK_OK(pbrt_open_text(
        &files,
        HEADER "ReverseOrientation\nShape \"sphere\"\nReverseOrientation\nShape \"sphere\"\n"));
    assert_true(pbrt_shape(&files, 0).reverseOrientation);
    assert_false(pbrt_shape(&files, 1).reverseOrientation);
}

static void a_later_object_replaces_one_of_its_name(void **state)
{
    (void)state;
    const SluicePbrtInstance *instances;
    CHECK_OK(pbrt_open_text(
        &files, HEADER
        "ObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\nObjectInstance \"o\"\n"
        "ObjectBegin \"o\"\nShape \"disk\"\nShape \"disk\"\nObjectEnd\nObjectInstance \"o\"\n"));
    CHECK_OK(sluiceGetPbrtInstances(files.scene, &instances));
    assert_int_equal(pbrt_info(&files).instanceCount, 2);
    SluicePbrtObject first, second;
    CHECK_OK(sluiceGetPbrtObject(files.scene, instances[0].object, &first));
    CHECK_OK(sluiceGetPbrtObject(files.scene, instances[1].object, &second));
    assert_int_equal(first.shapeCount, 1);
    assert_int_equal(second.shapeCount, 2);
    assert_int_equal(second.firstShape, 1);
}

static void inline_meshes_are_read_again_from_their_place(void **state)
{
    (void)state;
    CHECK_OK(pbrt_open_text(
        &files, HEADER "Shape \"trianglemesh\" # a comment\n\"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1]"
                       "\"point P\" [ # another one [ 7\n 0 0 0 1e0 0 0 +1 1. 0 0,  1, -.5e-1 ]\n"
                       "\"float st\" [0 0 1 0 1 1 0 1] \"integer indices\"[0 1 2 0 2 3]\n"));
    SluicePbrtMesh mesh = {.structSize = sizeof mesh};
    CHECK_OK(sluiceReadPbrtShape(files.scene, 0, &mesh));
    static const float POSITIONS[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, -.05f};
    static const uint32_t INDICES[6] = {0, 1, 2, 0, 2, 3};
    assert_int_equal(mesh.vertexCount, 4);
    assert_int_equal(mesh.triangleCount, 2);
    assert_memory_equal(mesh.pPositions, POSITIONS, sizeof POSITIONS);
    assert_memory_equal(mesh.pIndices, INDICES, sizeof INDICES);
    assert_true(mesh.pNormals[2] == 1 && mesh.pUvs[2] == 1);
    sluiceFreePbrtMesh(files.scene, &mesh);
    pbrt_write(&files, "scene.pbrt", HEADER, strlen(HEADER));
    CHECK_RESULT(sluiceReadPbrtShape(files.scene, 0, &mesh), SLUICE_ERROR_IO);
    sluiceFreePbrtMesh(files.scene, &mesh);
}

static void numbers_are_those_of_the_c_library(void **state)
{
    (void)state;
    roll_seed(7);
    for (int i = 0; i < 500; i++) {
        char text[256], number[64];
        uint32_t digits = (uint32_t)roll() % 1000000000, more = (uint32_t)roll() % 1000000,
                 exponent = (uint32_t)roll() % 60;
        snprintf(number, sizeof number, "%u.%06ue%d", digits, more, (int)exponent - 35);
        snprintf(text, sizeof text, HEADER "Shape \"sphere\" \"float radius\" %s\n", number);
        float expected = strtof(number, NULL);
        if (!(expected > 0))
            continue;
        CHECK_OK(pbrt_open_text(&files, text));
        float found = pbrt_shape(&files, 0).radius;
        if (found != expected && found != nextafterf(expected, 0) &&
            found != nextafterf(expected, HUGE_VALF))
            fail_msg("%s is %.9g, not %.9g", number, (double)found, (double)expected);
    }
}

/* The last message. */
static char last_message[1024];

static void keep_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user, (void)severity;
    snprintf(last_message, sizeof last_message, "%s", message);
}

static SluiceResult open_with(SluicePbrtSceneCreateInfo info, const char *name)
{
    char path[600];
    snprintf(path, sizeof path, "%s", pbrt_path(&files, name));
    info.structSize = sizeof info;
    info.pPath = path;
    info.log.pfnLog = keep_message;
    sluiceDestroyPbrtScene(files.scene);
    files.scene = NULL;
    return sluiceOpenPbrtScene(&info, &files.scene);
}

/* Each limit is what this scene needs: one less is too little. */
static void limits_stop_the_reader(void **state)
{
    (void)state;
    static const char SCENE[] = HEADER "Include \"a\"\nInclude \"a\"\n"
                                       "AttributeBegin\nAttributeBegin\nAttributeEnd\n"
                                       "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0]"
                                       " \"integer indices\" [0 1 2]\nAttributeEnd\n"
                                       "ObjectInstance \"o\"\nObjectInstance \"o\"\n";
    static const char A[] = "Include \"b\"\n";
    static const char B[] = "ObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\n";
    const uint64_t text_size = sizeof SCENE - 1 + 2 * (sizeof A - 1 + sizeof B - 1);
    SluicePbrtMesh mesh = {.structSize = sizeof mesh};
    pbrt_write(&files, "scene.pbrt", SCENE, sizeof SCENE - 1);
    pbrt_write(&files, "a", A, sizeof A - 1);
    pbrt_write(&files, "b", B, sizeof B - 1);
#define NEEDS(field, value)                                                                        \
    do {                                                                                           \
        CHECK_RESULT(open_with((SluicePbrtSceneCreateInfo){.field = (value)-1}, "scene.pbrt"),     \
                     SLUICE_ERROR_LIMIT_EXCEEDED);                                                 \
        assert_non_null(strstr(last_message, #field));                                             \
        CHECK_OK(open_with((SluicePbrtSceneCreateInfo){.field = (value)}, "scene.pbrt"));          \
    } while (0)
    NEEDS(maxIncludeDepth, 3);
    NEEDS(maxIncludeCount, 4);
    NEEDS(maxBlockDepth, 2);
    NEEDS(maxShapeCount, 3);
    NEEDS(maxInstanceCount, 2);
    NEEDS(maxTextSize, text_size);
#undef NEEDS
    assert_int_equal(pbrt_info(&files).textSize, text_size);
    CHECK_OK(open_with((SluicePbrtSceneCreateInfo){.maxMeshSize = 12 * 4 - 1}, "scene.pbrt"));
    CHECK_RESULT(sluiceReadPbrtShape(files.scene, 2, &mesh), SLUICE_ERROR_LIMIT_EXCEEDED);
    CHECK_OK(open_with((SluicePbrtSceneCreateInfo){.maxMeshSize = 12 * 4}, "scene.pbrt"));
    CHECK_OK(sluiceReadPbrtShape(files.scene, 2, &mesh));
    CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
}

/* A kilobyte of the file is a megabyte of text. */
static void compressed_text_stops_at_its_limit(void **state)
{
    (void)state;
#if TEST_HAS_ZLIB
    enum { LIMIT = 1 << 20, LINES = 1 << 21 };
    static char ones[2 * LINES];
    unsigned line = 0;
    for (size_t i = 0; i < sizeof ones; i++)
        ones[i] = i % 2 ? '\n' : '1';
    for (int imported = 0; imported < 2; imported++) {
        gzFile file = gzopen(pbrt_path(&files, "a.gz"), "wb1");
        gzputs(file, "Shape \"trianglemesh\" \"point P\" [\n");
        gzwrite(file, ones, sizeof ones);
        gzputs(file, "]\n");
        assert_int_equal(gzclose(file), Z_OK);
        const char *text = imported ? HEADER "Import \"a.gz\"\n" : HEADER "Include \"a.gz\"\n";
        pbrt_write(&files, "scene.pbrt", text, strlen(text));
        CHECK_RESULT(open_with((SluicePbrtSceneCreateInfo){.maxTextSize = LIMIT}, "scene.pbrt"),
                     SLUICE_ERROR_LIMIT_EXCEEDED);
        assert_int_equal(sscanf(strstr(last_message, "a.gz:"), "a.gz:%u:", &line), 1);
        assert_in_range(line, LIMIT / 4, LIMIT / 2 + (1 << 17)); /* read ahead */
    }
#else
    SKIP_TEST("Sluice is built without zlib");
#endif
}

static void the_gamma_of_a_texture_is_any_number(void **state)
{
    static const struct {
        const char *text;
        float gamma;
    } encodings[] = {{"gamma 2.2", 2.2f}, {"gamma 22e-1", 2.2f}, {"gamma 99999999999999", 1e14f},
                     {"gamma 1e99", 1},   {"gamma -2", 1},       {"gamma ", 1}};
    (void)state;
    pbrt_write(&files, "a.png", "", 0);
    for (size_t i = 0; i < sizeof encodings / sizeof *encodings; i++) {
        char text[200];
        SluicePbrtTexture texture = {.structSize = sizeof texture};
        snprintf(text, sizeof text,
                 HEADER "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" "
                        "\"string encoding\" \"%s\"\n",
                 encodings[i].text);
        CHECK_OK(pbrt_open_text(&files, text));
        CHECK_OK(sluiceGetPbrtTexture(files.scene, 0, &texture));
        assert_int_equal(texture.encoding, SLUICE_PBRT_ENCODING_GAMMA);
        if (texture.gamma != encodings[i].gamma)
            fail_msg("\"%s\" is %.9g", encodings[i].text, (double)texture.gamma);
    }
}

/* Textures below one, walked as renderers do. */
static uint32_t texture_depth(uint32_t index)
{
    SluicePbrtTexture texture = {.structSize = sizeof texture};
    uint32_t most = 0;
    CHECK_OK(sluiceGetPbrtTexture(files.scene, index, &texture));
    const SluicePbrtValue values[] = {texture.inputs[0], texture.inputs[1], texture.amount};
    for (int i = 0; i < 3; i++)
        if (values[i].texture != SLUICE_PBRT_NONE) {
            uint32_t depth = 1 + texture_depth(values[i].texture);
            most = depth > most ? depth : most;
        }
    return most;
}

static void textures_nest_32_deep(void **state)
{
    static const char *const KINDS[][2] = {
        {"scale", "tex2"}, {"mix", "tex1"}, {"mix", "amount"}, {"checkerboard", "tex2"}};
    enum { COUNT = 40 };
    (void)state;
    for (size_t kind = 0; kind < sizeof KINDS / sizeof *KINDS; kind++) {
        char text[COUNT * 100] = HEADER "Texture \"t0\" \"float\" \"constant\" \"float value\" 1\n";
        for (int i = 1; i <= COUNT; i++)
            sprintf(text + strlen(text),
                    "Texture \"t%d\" \"float\" \"%s\" \"texture %s\" \"t%d\"\n", i, KINDS[kind][0],
                    KINDS[kind][1], i - 1);
        CHECK_OK(pbrt_open_text(&files, text));
        for (uint32_t i = 0; i <= 32; i++)
            assert_int_equal(texture_depth(i), i);
        for (uint32_t i = 33; i <= COUNT; i++)
            assert_int_equal(texture_depth(i), i - 33);
        SluicePbrtTexture texture = {.structSize = sizeof texture};
        CHECK_OK(sluiceGetPbrtTexture(files.scene, 33, &texture));
        assert_int_equal(texture.kind, SLUICE_PBRT_TEXTURE_CONSTANT);
        if (kind == 0)
            assert_true(texture.value[0] == 1.0f); /* the product of ones */
        assert_int_equal(files.warnings, 1);
        assert_non_null(strstr(files.log, ":35:")); /* the line of t33 */
    }
}

static void a_mesh_that_could_not_be_read_can_be_freed(void **state)
{
    (void)state;
    static const char TEXT[] = HEADER "Shape \"plymesh\" \"string filename\" \"none.ply\"\n";
    CHECK_OK(pbrt_open_text(&files, TEXT));
    for (uint32_t index = 0; index < 2; index++) { /* without a file, and none at all */
        SluicePbrtMesh mesh;
        memset(&mesh, 0xA5, sizeof mesh);
        mesh.structSize = sizeof mesh;
        CHECK_RESULT(sluiceReadPbrtShape(files.scene, index, &mesh),
                     index ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_ERROR_FILE_NOT_FOUND);
        assert_true(!mesh.pPositions && !mesh.pIndices && mesh.vertexCount == 0);
        CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
    }
}

static void bounds_are_remembered_in_a_file(void **state)
{
    (void)state;
    static const char PLY[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 0\n1 0 0\n0 2 3\n3 0 1 2\n";
    SluicePbrtBounds before, after;
    char ply[600], remembered[600], path[600];
    pbrt_write(&files, "a.ply", PLY, sizeof PLY - 1);
    CHECK_OK(pbrt_open_text(&files, HEADER "Shape \"plymesh\" \"string filename\" \"a.ply\"\n"));
    CHECK_OK(sluiceGetPbrtShapeBounds(files.scene, 0, &before));
    assert_true(before.most[1] == 2 && before.most[2] == 3);
    strcpy(remembered, pbrt_path(&files, "bounds"));
    strcpy(ply, pbrt_path(&files, "a.ply"));
    strcpy(path, pbrt_path(&files, "scene.pbrt"));
    CHECK_OK(sluiceWritePbrtBounds(files.scene, remembered));
    SluicePbrtSceneCreateInfo info = {
        .structSize = sizeof info, .pPath = path, .pBoundsPath = remembered};
    sluiceDestroyPbrtScene(files.scene);
    CHECK_OK(sluiceOpenPbrtScene(&info, &files.scene));
    pbrt_write(&files, "a.ply", "not a PLY file", 14); /* is not looked at */
    CHECK_OK(sluiceGetPbrtShapeBounds(files.scene, 0, &after));
    assert_memory_equal(&before, &after, sizeof before);
    /* It has changed since, so it is read again. */
    sluiceDestroyPbrtScene(files.scene);
    CHECK_OK(sluiceOpenPbrtScene(&info, &files.scene));
    CHECK_RESULT(sluiceGetPbrtShapeBounds(files.scene, 0, &after), SLUICE_ERROR_CORRUPT_DATA);
}

static void compressed_files_are_read_like_plain_ones(void **state)
{
    (void)state;
#if TEST_HAS_ZLIB
    enum { COUNT = 60000 };
    static const char HEAD[] = "ply\nformat ascii 1.0\nelement vertex 60000\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 1\n"
                               "property list uchar int vertex_indices\nend_header\n";
    char path[600];
    strcpy(path, pbrt_path(&files, "scene.pbrt.gz"));
    gzFile scene = gzopen(path, "wb"), ply = gzopen(pbrt_path(&files, "a.ply.gz"), "wb");
    gzputs(scene, HEADER "Shape \"plymesh\" \"string filename\" \"a.ply.gz\"\n"
                         "Shape \"trianglemesh\" \"integer indices\" [0 1 59999] \"point P\" [\n");
    gzputs(ply, HEAD);
    for (int i = 0; i < COUNT; i++) {
        gzprintf(scene, "%d %d.5 -%d\n", i, i, i);
        gzprintf(ply, "%d %d.5 -%d\n", i, i, i);
    }
    gzputs(scene, "]\n");
    gzputs(ply, "3 0 1 59999\n");
    assert_int_equal(gzclose(scene), Z_OK);
    assert_int_equal(gzclose(ply), Z_OK);
    CHECK_OK(pbrt_open(&files, path));
    assert_int_equal(pbrt_read_all(&files), 2);
    for (uint32_t shape = 0; shape < 2; shape++) {
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        CHECK_OK(sluiceReadPbrtShape(files.scene, shape, &mesh));
        assert_int_equal(mesh.vertexCount, COUNT);
        assert_int_equal(mesh.pIndices[2], COUNT - 1);
        for (int i = 0; i < COUNT; i++)
            assert_true(mesh.pPositions[3 * i] == (float)i &&
                        mesh.pPositions[3 * i + 1] == (float)i + 0.5f &&
                        mesh.pPositions[3 * i + 2] == (float)-i);
        CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
    }
#else
    SKIP_TEST("Sluice is built without zlib");
#endif
}

static uint32_t messages;

static void count_messages(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user, (void)severity, (void)message;
    messages++;
}

struct watch {
    uint64_t most, last; /* bytes after which the reader is stopped, and those reported last */
    uint32_t calls, stops;
};

static bool watch_progress(void *user, uint64_t read_size)
{
    struct watch *watch = user;
    assert_true(read_size >= watch->last && read_size <= watch->last + (1u << 17));
    watch->last = read_size;
    watch->calls++;
    watch->stops += read_size >= watch->most;
    return read_size < watch->most;
}

static SluiceResult open_watched(struct watch *watch)
{
    const SluicePbrtSceneCreateInfo info = {.structSize = sizeof info,
                                            .pPath = pbrt_path(&files, "scene.pbrt"),
                                            .pAllocator = files.allocator,
                                            .log = {&files, count_messages},
                                            .pUserData = watch,
                                            .pfnProgress = watch_progress};
    messages = 0;
    return sluiceOpenPbrtScene(&info, &files.scene);
}

/* 3.3 MB in a list, a comment, and files that include one another. */
static uint64_t write_long_text(void)
{
    const size_t size = 1u << 20;
    char *part = malloc(size + 1), *text = malloc(2 * size + 256);
    assert_true(part && text);
    memset(part, ' ', size);
    part[size] = 0;
    for (size_t i = 0; i + 15 < size; i += 15)
        memcpy(part + i, "Shape \"sphere\"\n", 15);
    pbrt_write(&files, "part.pbrt", part, size);
    memset(part, '1', size);
    for (size_t i = 0; i < size; i += 2)
        part[i] = ' ';
    const int length = snprintf(text, 2 * size + 256,
                                HEADER "Include \"part.pbrt\"\n# %s\nShape \"trianglemesh\" "
                                       "\"point P\" [0 0 0 1 0 0 0 1 0] \"float x\" [ %s ]\n",
                                part, part);
    assert_true(length > 0);
    pbrt_write(&files, "scene.pbrt", text, (size_t)length);
    free(part);
    free(text);
    return size + (uint64_t)length;
}

/* The reader asks before each read, and reads nothing after it was stopped: however long the text
 * is, the end takes no longer than a window of it. */
static void a_reader_that_is_stopped_reads_no_further(void **state)
{
    (void)state;
    const uint64_t size = write_long_text();
    struct watch all = {.most = UINT64_MAX};
    CHECK_OK(open_watched(&all));
    assert_true(all.last == size);
    sluiceDestroyPbrtScene(files.scene);
    for (uint32_t i = 0; i < all.calls; i++) {
        struct watch watch = {.most = (uint64_t)i << 17};
        assert_int_equal(open_watched(&watch), SLUICE_ERROR_CANCELED);
        assert_null(files.scene);
        assert_int_equal(watch.stops, 1);
        assert_true(watch.last <= watch.most + (1u << 17));
        assert_int_equal(messages, 0);
        if (watch.most + (1u << 17) > size)
            break;
    }
}

static void options_of_both_forms_are_skipped(void **state)
{
    (void)state;
    CHECK_OK(pbrt_open_text(&files, "Option \"disablepixeljitter\" true\nOption \"string r\" "
                                    "[\"world\"]\n" HEADER "Shape \"sphere\"\n"));
    assert_int_equal(pbrt_info(&files).shapeCount, 1);
    assert_string_equal(files.log, "");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, init, finish)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(transforms_are_those_of_a_naive_model),
        TEST(look_at_makes_a_left_handed_camera),
        TEST(a_matrix_and_look_at_make_the_same_camera),
        TEST(parameters_go_on_after_an_included_file),
        TEST(an_import_leaves_the_state_as_it_was),
        TEST(a_named_material_may_be_made_later),
        TEST(mixtures_of_themselves_end),
        TEST(both_versions_weigh_mixtures_their_way),
        TEST(equal_materials_are_one),
        TEST(reverse_orientation_is_toggled),
        TEST(a_later_object_replaces_one_of_its_name),
        TEST(inline_meshes_are_read_again_from_their_place),
        TEST(numbers_are_those_of_the_c_library),
        TEST(limits_stop_the_reader),
        TEST(compressed_text_stops_at_its_limit),
        TEST(the_gamma_of_a_texture_is_any_number),
        TEST(textures_nest_32_deep),
        TEST(a_mesh_that_could_not_be_read_can_be_freed),
        TEST(bounds_are_remembered_in_a_file),
        TEST(compressed_files_are_read_like_plain_ones),
        TEST(options_of_both_forms_are_skipped),
        TEST(a_reader_that_is_stopped_reads_no_further),
    };
    return RUN_TESTS(tests);
}
