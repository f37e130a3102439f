/* PLY files of all kinds, made here at random, are read as they were written. */
#include "pbrt/pbrt_files.h"
#include "support/roll.h"
#include "support/test.h"

#include <stdio.h>
#include <string.h>

#define MAX_VERTICES 300u
#define MAX_FACES 400u

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

/* Contents and format of the files that are written. */
static struct model {
    enum { TEXT, LITTLE, BIG } format;
    bool is_double, has_normals, has_uvs, has_extras, faces_first, wide_indices;
    uint32_t vertex_count, face_count, triangle_count;
    float vertices[MAX_VERTICES][8];
    uint32_t faces[MAX_FACES][5], corners[MAX_FACES];
    uint32_t triangles[3 * MAX_FACES][3];
} model;

static char file[1 << 20];
static size_t file_size;

static void put_text(const char *text)
{
    memcpy(file + file_size, text, strlen(text));
    file_size += strlen(text);
}

static void put_bytes(uint64_t bits, size_t size)
{
    for (size_t i = 0; i < size; i++)
        file[file_size++] = (char)(bits >> (8 * (model.format == LITTLE ? i : size - 1 - i)));
}

static void put_float(float value)
{
    uint32_t bits;
    uint64_t wide;
    double number = value;
    char text[64];
    snprintf(text, sizeof text, "%.9g ", number);
    memcpy(&bits, &value, sizeof bits);
    memcpy(&wide, &number, sizeof wide);
    if (model.format == TEXT)
        put_text(text);
    else if (model.is_double)
        put_bytes(wide, 8);
    else
        put_bytes(bits, 4);
}

static void put_integer(uint32_t value, size_t size)
{
    char text[32];
    snprintf(text, sizeof text, "%u ", value);
    if (model.format == TEXT)
        put_text(text);
    else
        put_bytes(value, size);
}

static void end_line(void)
{
    if (model.format == TEXT)
        put_text("\n");
}

static void roll_model(void)
{
    model.format = roll() % 3;
    model.is_double = roll() % 2;
    model.has_normals = roll() % 2;
    model.has_uvs = roll() % 2;
    model.has_extras = roll() % 2;
    model.faces_first = roll() % 2;
    model.wide_indices = roll() % 2;
    model.vertex_count = 3 + (uint32_t)roll() % (MAX_VERTICES - 3);
    model.face_count = 1 + (uint32_t)roll() % (MAX_FACES - 1);
    model.triangle_count = 0;
    for (uint32_t i = 0; i < model.vertex_count; i++)
        for (int j = 0; j < 8; j++)
            model.vertices[i][j] = (float)(roll() % 2000001 - 1000000) / 1024;
    for (uint32_t i = 0; i < model.face_count; i++) {
        uint32_t *face = model.faces[i];
        model.corners[i] = 3 + (uint32_t)roll() % 3;
        for (uint32_t j = 0; j < model.corners[i]; j++)
            face[j] = (uint32_t)roll() % model.vertex_count;
        for (uint32_t j = 2; j < model.corners[i]; j++) {
            uint32_t *triangle = model.triangles[model.triangle_count++];
            triangle[0] = face[0];
            triangle[1] = face[j - 1];
            triangle[2] = face[j];
        }
    }
}

static void put_vertex_header(void)
{
    static const char *const NAMES[8] = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    char line[64];
    snprintf(line, sizeof line, "element vertex %u\n", model.vertex_count);
    put_text(line);
    for (int j = 0; j < 8; j++) {
        if ((j >= 3 && j < 6 && !model.has_normals) || (j >= 6 && !model.has_uvs))
            continue;
        if (model.has_extras && j == 3)
            put_text("property uchar red\n");
        snprintf(line, sizeof line, "property %s %s\n", model.is_double ? "double" : "float32",
                 NAMES[j]);
        put_text(line);
    }
}

static void put_face_header(void)
{
    char line[64];
    snprintf(line, sizeof line, "element face %u\n", model.face_count);
    put_text(line);
    if (model.has_extras)
        put_text("property list uint8 float32 weights\n");
    put_text(model.wide_indices ? "property list int uint vertex_indices\n"
                                : "property list uchar ushort vertex_index\n");
}

static void put_vertices(void)
{
    for (uint32_t i = 0; i < model.vertex_count; i++) {
        for (int j = 0; j < 8; j++) {
            if ((j >= 3 && j < 6 && !model.has_normals) || (j >= 6 && !model.has_uvs))
                continue;
            if (model.has_extras && j == 3)
                put_integer(200, 1);
            put_float(model.vertices[i][j]);
        }
        end_line();
    }
}

static void put_faces(void)
{
    bool was_double = model.is_double;
    model.is_double = false;
    for (uint32_t i = 0; i < model.face_count; i++) {
        if (model.has_extras) {
            put_integer(i % 3, 1);
            for (uint32_t j = 0; j < i % 3; j++)
                put_float(0.5f);
        }
        put_integer(model.corners[i], model.wide_indices ? 4 : 1);
        for (uint32_t j = 0; j < model.corners[i]; j++)
            put_integer(model.faces[i][j], model.wide_indices ? 4 : 2);
        end_line();
    }
    model.is_double = was_double;
}

static void write_model(void)
{
    static const char *const FORMATS[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    file_size = 0;
    put_text("ply\nformat ");
    put_text(FORMATS[model.format]);
    put_text(" 1.0\ncomment made by a test\n");
    if (model.faces_first)
        put_face_header();
    put_vertex_header();
    if (!model.faces_first)
        put_face_header();
    put_text("end_header\n");
    if (model.faces_first)
        put_faces();
    put_vertices();
    if (!model.faces_first)
        put_faces();
    pbrt_write(&files, "a.ply", file, file_size);
}

static void check_model(void)
{
    SluicePbrtMesh mesh = {.structSize = sizeof mesh};
    SluicePbrtBounds bounds;
    CHECK_OK(sluiceGetPbrtShapeBounds(files.scene, 0, &bounds));
    CHECK_OK(sluiceReadPbrtShape(files.scene, 0, &mesh));
    assert_int_equal(mesh.vertexCount, model.vertex_count);
    assert_int_equal(mesh.triangleCount, model.triangle_count);
    assert_int_equal(mesh.pNormals != NULL, model.has_normals);
    assert_int_equal(mesh.pUvs != NULL, model.has_uvs);
    assert_memory_equal(mesh.pIndices, model.triangles, 12 * (size_t)model.triangle_count);
    for (uint32_t i = 0; i < model.vertex_count; i++) {
        const float *v = model.vertices[i];
        assert_memory_equal(mesh.pPositions + 3 * i, v, 12);
        if (mesh.pNormals)
            assert_memory_equal(mesh.pNormals + 3 * i, v + 3, 12);
        if (mesh.pUvs)
            assert_memory_equal(mesh.pUvs + 2 * i, v + 6, 8);
    }
    for (int j = 0; j < 3; j++) {
        float least = model.vertices[0][j], most = least;
        for (uint32_t i = 1; i < model.vertex_count; i++) {
            least = model.vertices[i][j] < least ? model.vertices[i][j] : least;
            most = model.vertices[i][j] > most ? model.vertices[i][j] : most;
        }
        assert_true(bounds.least[j] == least && bounds.most[j] == most);
    }
    CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
}

#define SCENE "WorldBegin\nShape \"plymesh\" \"string filename\" \"a.ply\"\n"

static void files_of_all_kinds_are_read_as_they_were_written(void **state)
{
    (void)state;
    roll_seed(3);
    for (int i = 0; i < 200; i++) {
        roll_model();
        write_model();
        CHECK_OK(pbrt_open_text(&files, SCENE));
        check_model();
    }
}

static void files_cut_off_anywhere_are_refused(void **state)
{
    (void)state;
    roll_seed(4);
    for (int i = 0; i < 60; i++) {
        roll_model();
        write_model();
        /* The last number of a text file may be cut shorter and still be one. */
        size_t size = (size_t)roll() % (file_size - 8);
        pbrt_write(&files, "a.ply", file, size);
        CHECK_OK(pbrt_open_text(&files, SCENE));
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        CHECK_RESULT(sluiceReadPbrtShape(files.scene, 0, &mesh), SLUICE_ERROR_CORRUPT_DATA);
        assert_null(mesh.pPositions);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(files_of_all_kinds_are_read_as_they_were_written, init,
                                        finish),
        cmocka_unit_test_setup_teardown(files_cut_off_anywhere_are_refused, init, finish),
    };
    return RUN_TESTS(tests);
}
