/*
 * Loop subdivision agrees with one that is written for this test (faces as sets of corners,
 * vertices found by searching all faces), with closed forms, and with counts by Euler's formula.
 */
#include "pbrt/pbrt_files.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MOST 4096
#define PI 3.14159265358979323846

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
    if (files.scene)
        (void)sluiceFreePbrtMesh(files.scene, &mesh);
    pbrt_files_finish(&files);
    return 0;
}

/* The naive surface */

struct naive {
    double points[MOST][3];
    int faces[MOST][3];
    int point_count, face_count;
};

static struct naive control, coarse, fine;

/* Faces with both vertices; the third corners of the first two. */
static int faces_of_edge(const struct naive *m, int a, int b, int others[2])
{
    int count = 0;
    for (int f = 0; f < m->face_count; f++)
        for (int i = 0; i < 3; i++) {
            int p = m->faces[f][i], q = m->faces[f][(i + 1) % 3];
            if (((p == a && q == b) || (p == b && q == a)) && count < 2)
                others[count++] = m->faces[f][(i + 2) % 3];
        }
    return count;
}

/* Moves a vertex: inner ones by `weight` of each neighbor, those of a boundary along it. */
static void average(const struct naive *m, int v, double (*weight)(int), double along,
                    double out[3])
{
    double all[3] = {0}, ends[3] = {0};
    int neighbors = 0, end_count = 0;
    for (int u = 0; u < m->point_count; u++) {
        int others[2], shared = u == v ? 0 : faces_of_edge(m, u, v, others);
        neighbors += shared > 0;
        end_count += shared == 1;
        for (int i = 0; i < 3; i++) {
            all[i] += shared > 0 ? m->points[u][i] : 0;
            ends[i] += shared == 1 ? m->points[u][i] : 0;
        }
    }
    double w = neighbors ? weight(neighbors) : 0;
    for (int i = 0; i < 3; i++)
        out[i] = end_count ? (1 - 2 * along) * m->points[v][i] + along * ends[i]
                           : (1 - neighbors * w) * m->points[v][i] + w * all[i];
}

static double beta(int n)
{
    return n == 3 ? 3.0 / 16 : 3.0 / (8 * n);
}

static double gamma_of(int n)
{
    return 1 / (n + 3 / (8 * beta(n)));
}

static int add_middle(const struct naive *m, int a, int b, struct naive *out)
{
    int others[2];
    bool inner = faces_of_edge(m, a, b, others) == 2;
    double point[3];
    for (int i = 0; i < 3; i++) {
        double ends = m->points[a][i] + m->points[b][i];
        point[i] = inner
                       ? 0.375 * ends + 0.125 * (m->points[others[0]][i] + m->points[others[1]][i])
                       : 0.5 * ends;
    }
    for (int p = m->point_count; p < out->point_count; p++)
        if (memcmp(out->points[p], point, sizeof point) == 0)
            return p;
    assert_true(out->point_count < MOST);
    memcpy(out->points[out->point_count], point, sizeof point);
    return out->point_count++;
}

static void refine(const struct naive *m, struct naive *out)
{
    out->point_count = m->point_count;
    out->face_count = 0;
    for (int v = 0; v < m->point_count; v++)
        average(m, v, beta, 1.0 / 8, out->points[v]);
    for (int f = 0; f < m->face_count; f++) {
        const int *c = m->faces[f];
        int ab = add_middle(m, c[0] < c[1] ? c[0] : c[1], c[0] < c[1] ? c[1] : c[0], out);
        int bc = add_middle(m, c[1] < c[2] ? c[1] : c[2], c[1] < c[2] ? c[2] : c[1], out);
        int ca = add_middle(m, c[2] < c[0] ? c[2] : c[0], c[2] < c[0] ? c[0] : c[2], out);
        const int faces[4][3] = {{c[0], ab, ca}, {ab, c[1], bc}, {ca, bc, c[2]}, {ab, bc, ca}};
        memcpy(out->faces[out->face_count], faces, sizeof faces);
        out->face_count += 4;
    }
}

/* Reads the control mesh subdivided. Closes the scene before. */
static void read_levels(const struct naive *m, int levels)
{
    static char text[65536];
    int at = snprintf(text, sizeof text,
                      "WorldBegin\nShape \"loopsubdiv\" \"integer levels\" %d\n"
                      "\"integer indices\" [",
                      levels);
    for (int f = 0; f < m->face_count; f++)
        at += snprintf(text + at, sizeof text - (size_t)at, " %d %d %d", m->faces[f][0],
                       m->faces[f][1], m->faces[f][2]);
    at += snprintf(text + at, sizeof text - (size_t)at, " ] \"point P\" [");
    for (int v = 0; v < m->point_count; v++)
        at += snprintf(text + at, sizeof text - (size_t)at, " %.9g %.9g %.9g", m->points[v][0],
                       m->points[v][1], m->points[v][2]);
    snprintf(text + at, sizeof text - (size_t)at, " ]\n");
    if (files.scene)
        (void)sluiceFreePbrtMesh(files.scene, &mesh);
    CHECK_OK(pbrt_open_text(&files, text));
    mesh = (SluicePbrtMesh){.structSize = sizeof mesh};
    CHECK_OK(sluiceReadPbrtShape(files.scene, 0, &mesh));
}

static double distance(const float *a, const double *b)
{
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
    return sqrt(square);
}

/* Meshes */

static void add_face(int a, int b, int c)
{
    const int face[3] = {a, b, c};
    memcpy(control.faces[control.face_count++], face, sizeof face);
}

static void add_point(double x, double y, double z)
{
    const double point[3] = {x, y, z};
    memcpy(control.points[control.point_count++], point, sizeof point);
}

static void make_icosahedron(void)
{
    static const int FACES[20][3] = {{0, 1, 2},  {0, 2, 3},  {0, 3, 4},  {0, 4, 5},   {0, 5, 1},
                                     {1, 6, 2},  {2, 7, 3},  {3, 8, 4},  {4, 9, 5},   {5, 10, 1},
                                     {2, 6, 7},  {3, 7, 8},  {4, 8, 9},  {5, 9, 10},  {1, 10, 6},
                                     {11, 7, 6}, {11, 8, 7}, {11, 9, 8}, {11, 10, 9}, {11, 6, 10}};
    control = (struct naive){0};
    double z = 1 / sqrt(5), r = 2 / sqrt(5);
    add_point(0, 0, 1);
    for (int i = 0; i < 5; i++)
        add_point(r * cos(2 * PI * i / 5), r * sin(2 * PI * i / 5), z);
    for (int i = 0; i < 5; i++)
        add_point(r * cos(2 * PI * (i + 0.5) / 5), r * sin(2 * PI * (i + 0.5) / 5), -z);
    add_point(0, 0, -1);
    for (int f = 0; f < 20; f++)
        add_face(FACES[f][0], FACES[f][1], FACES[f][2]);
}

/* A sheared grid with a bump; the diagonal of one cell is turned, which makes valences of 5 and 7,
 * and one corner of the grid has a single face. */
static void make_sheet(int size, bool is_regular)
{
    control = (struct naive){0};
    for (int y = 0; y <= size; y++)
        for (int x = 0; x <= size; x++)
            add_point(x + 0.5 * y, y, is_regular ? 0 : sin(1.3 * x) * cos(0.7 * y));
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            int a = y * (size + 1) + x, b = a + 1, c = a + size + 1, d = c + 1;
            bool turned = !is_regular && x == 2 && y == 2;
            add_face(a, b, turned ? d : c);
            add_face(turned ? a : b, d, c);
        }
}

/* Three faces around a corner of a boundary, and a tetrahedron beside them: valences of 3. */
static void make_pieces(void)
{
    control = (struct naive){0};
    for (int i = 0; i < 4; i++)
        add_point(i & 1, i >> 1, i == 3);
    add_face(0, 2, 1);
    add_face(0, 1, 3);
    add_face(0, 3, 2);
    add_face(1, 2, 3);
    add_point(5, 0, 0);
    for (int i = 0; i < 4; i++)
        add_point(5 + cos(0.9 * i), sin(0.9 * i), 0.2 * i * i);
    for (int i = 0; i < 3; i++)
        add_face(4, 5 + i, 6 + i);
}

/* Tests */

static void compare(int levels)
{
    double greatest = 0;
    coarse = control;
    for (int i = 0; i < levels; i++) {
        refine(&coarse, &fine);
        coarse = fine;
    }
    read_levels(&control, levels);
    assert_int_equal(mesh.vertexCount, coarse.point_count);
    assert_int_equal(mesh.triangleCount, coarse.face_count);
    for (int v = 0; v < coarse.point_count; v++) {
        double limit[3], least = 1e9;
        average(&coarse, v, gamma_of, 1.0 / 5, limit);
        for (uint32_t i = 0; i < mesh.vertexCount; i++) {
            double d = distance(mesh.pPositions + 3 * (size_t)i, limit);
            least = d < least ? d : least;
        }
        greatest = least > greatest ? least : greatest;
    }
    if (greatest > 1e-5)
        fail_msg("%d levels: a vertex is %g away", levels, greatest);
}

static void vertices_are_those_of_a_naive_subdivision(void **state)
{
    (void)state;
    for (int levels = 0; levels <= 2; levels++) {
        make_icosahedron();
        compare(levels);
        make_sheet(4, false);
        compare(levels);
        make_pieces();
        compare(levels);
    }
}

/* 12 - 30 + 20 = 2, and each level splits edges and faces. */
static void an_icosahedron_has_the_counts_that_euler_gives(void **state)
{
    (void)state;
    make_icosahedron();
    for (int levels = 0; levels <= 5; levels++) {
        uint32_t faces = 20u << (2 * levels), edges = faces / 2 * 3;
        read_levels(&control, levels);
        assert_int_equal(mesh.triangleCount, faces);
        assert_int_equal(mesh.vertexCount, 2 + edges - faces);
    }
}

/* The ring's sum is 5 / sqrt(5) of a vertex; gamma(5) is 1/10. A limit does not move. Normals
 * point inwards, as pbrt has them for faces that run counterclockwise. */
static void vertices_of_an_icosahedron_stay_on_their_axes_at_every_level(void **state)
{
    (void)state;
    make_icosahedron();
    for (int levels = 0; levels <= 4; levels++) {
        read_levels(&control, levels);
        for (int v = 0; v < 12; v++)
            for (int i = 0; i < 3; i++) {
                double axis = control.points[v][i], expected = (0.5 + 0.5 / sqrt(5)) * axis;
                assert_true(fabs((double)mesh.pPositions[3 * v + i] - expected) < 2e-6);
                assert_true(fabs((double)mesh.pNormals[3 * v + i] + axis) < 1e-5);
            }
    }
}

/* Values of the box spline of a regular mesh: 1/2 at its middle, 1/12 at its six neighbors. */
static void a_regular_mesh_has_the_quartic_box_spline_as_its_limit(void **state)
{
    (void)state;
    make_sheet(6, true);
    int middle = 3 * 7 + 3;
    control.points[middle][2] = 1;
    for (int levels = 0; levels <= 2; levels++) {
        read_levels(&control, levels);
        for (int v = 0; v < control.point_count; v++) {
            int x = v % 7 - 3, y = v / 7 - 3;
            bool is_near = (x || y) && x >= -1 && x <= 1 && y >= -1 && y <= 1 && x != y;
            double expected = v == middle ? 1.0 / 2 : is_near ? 1.0 / 12 : 0;
            assert_true(fabs((double)mesh.pPositions[3 * v + 2] - expected) < 1e-6);
        }
    }
}

/* Away from the boundary's own rule, which keeps straight boundaries straight. */
static void a_plane_stays_a_plane_with_its_normal(void **state)
{
    (void)state;
    make_sheet(4, true);
    read_levels(&control, 3);
    for (uint32_t v = 0; v < mesh.vertexCount; v++) {
        assert_true(mesh.pPositions[3 * v + 2] == 0);
        assert_true(fabsf(mesh.pNormals[3 * v + 2] + 1) < 1e-5f);
    }
}

static void levels_are_three_unless_the_scene_says_otherwise(void **state)
{
    (void)state;
    static const char *const WORDS[] = {"", "\"integer levels\" 1", "\"integer nlevels\" [2]"};
    const uint32_t triangles[] = {4 * 64, 4 * 4, 4 * 16};
    for (int i = 0; i < 3; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "WorldBegin\nShape \"loopsubdiv\" %s \"integer indices\" [0 2 1 0 1 3 0 3 2 1 2 3]"
                 " \"point P\" [0 0 0 1 0 0 0 1 0 0 0 1]\n",
                 WORDS[i]);
        CHECK_OK(pbrt_open_text(&files, text));
        mesh = (SluicePbrtMesh){.structSize = sizeof mesh};
        CHECK_OK(sluiceReadPbrtShape(files.scene, 0, &mesh));
        assert_int_equal(mesh.triangleCount, triangles[i]);
        CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
    }
}

/* Three faces at an edge, two in one direction, a corner twice, two fans at a vertex. */
static void meshes_that_are_no_surface_keep_their_faces(void **state)
{
    (void)state;
    static const char *const FACES[] = {"0 1 2 1 0 3 0 1 4", "0 1 2 0 1 3", "0 0 1", "0 1 2 0 3 4"};
    for (int i = 0; i < 4; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "WorldBegin\nShape \"loopsubdiv\" \"integer indices\" [%s] "
                 "\"point P\" [0 0 0 1 0 0 0 1 0 -1 0 0 0 -1 0]\n",
                 FACES[i]);
        CHECK_OK(pbrt_open_text(&files, text));
        mesh = (SluicePbrtMesh){.structSize = sizeof mesh};
        CHECK_OK(sluiceReadPbrtShape(files.scene, 0, &mesh));
        assert_int_equal(mesh.vertexCount, 5);
        assert_non_null(strstr(files.log, "the control mesh is shown"));
        CHECK_OK(sluiceFreePbrtMesh(files.scene, &mesh));
    }
}

static void a_surface_beyond_the_limit_is_refused(void **state)
{
    (void)state;
    static const char TEXT[] =
        "WorldBegin\nShape \"loopsubdiv\" \"integer levels\" 8 \"integer indices\" "
        "[0 2 1 0 1 3 0 3 2 1 2 3] \"point P\" [0 0 0 1 0 0 0 1 0 0 0 1]\n";
    pbrt_write(&files, "scene.pbrt", TEXT, sizeof TEXT - 1);
    SluicePbrtSceneCreateInfo info = {.structSize = sizeof info,
                                      .pPath = pbrt_path(&files, "scene.pbrt"),
                                      .maxMeshSize = 1 << 20};
    CHECK_OK(sluiceOpenPbrtScene(&info, &files.scene));
    mesh = (SluicePbrtMesh){.structSize = sizeof mesh};
    CHECK_RESULT(sluiceReadPbrtShape(files.scene, 0, &mesh), SLUICE_ERROR_LIMIT_EXCEEDED);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, init, finish)
    const struct CMUnitTest tests[] = {
        TEST(vertices_are_those_of_a_naive_subdivision),
        TEST(an_icosahedron_has_the_counts_that_euler_gives),
        TEST(vertices_of_an_icosahedron_stay_on_their_axes_at_every_level),
        TEST(a_regular_mesh_has_the_quartic_box_spline_as_its_limit),
        TEST(a_plane_stays_a_plane_with_its_normal),
        TEST(levels_are_three_unless_the_scene_says_otherwise),
        TEST(meshes_that_are_no_surface_keep_their_faces),
        TEST(a_surface_beyond_the_limit_is_refused),
    };
    return RUN_TESTS(tests);
}
