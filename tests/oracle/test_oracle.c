/* The renderer that others are compared with agrees with formulas, and with figures that another
 * ray caster has found in the sample scenes. */
#include "oracle/oracle.h"
#include "pbrt/pbrt_files.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <vips/vips.h>

static struct pbrt_files files;
static struct oracle oracle;

static int init(void **state)
{
    (void)state;
    pbrt_files_init(&files);
    return 0;
}

static int finish(void **state)
{
    (void)state;
    oracle_finish(&oracle);
    pbrt_files_finish(&files);
    return 0;
}

static const struct oracle_settings ONE = {.dim = {8, 8}, .samples = 1, .is_quiet = true};

static void load_text(const char *text, const struct oracle_settings *settings)
{
    pbrt_write(&files, "scene.pbrt", text, strlen(text));
    assert_true(oracle_init(&oracle, pbrt_path(&files, "scene.pbrt"), settings));
}

static float pictures[64 * 64 * 4];

static const float *render(void)
{
    assert_true(oracle.camera.width * oracle.camera.height <= 64 * 64);
    oracle_render(&oracle, pictures);
    return pictures;
}

/* Counts */

static void check_counts(const char *path, uint32_t width, uint32_t height, size_t placed,
                         size_t visible, size_t entered)
{
    struct oracle_settings settings = {
        .dim = {width, height}, .samples = 1, .is_quiet = true, .nearest = true};
    struct oracle_census census;
    assert_true(oracle_init(&oracle, path, &settings));
    assert_true(oracle_census_create(&census, &oracle.scene));
    assert_true(oracle_cast(&oracle, &census, NULL, NULL));
    assert_int_equal(census.count, placed);
    assert_int_equal(oracle_census_count(census.is_visible, census.count), visible);
    assert_int_equal(oracle_census_count(census.is_entered, census.count), entered);
    oracle_census_finish(&census);
}

static void wood_shows_1062_of_1676_shapes_and_rays_enter_1430_boxes(void **state)
{
    (void)state;
    char path[1024];
    if (!pbrt_sample_path(path, "made/instances/wood.pbrt"))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    check_counts(path, 400, 225, 1676, 1062, 1430);
}

static void living_room_shows_60_of_65_shapes_and_rays_enter_63_boxes(void **state)
{
    (void)state;
    char archive[1024], path[1024];
    if (!pbrt_sample_path(archive, "bitterli/living-room.tar.xz"))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", archive);
    if (!pbrt_unpack(&files, archive))
        SKIP_TEST("tar and xz cannot unpack %s", archive);
    snprintf(path, sizeof path, "%s", pbrt_path(&files, "living-room/scene-v4.pbrt"));
    check_counts(path, 640, 360, 65, 60, 63);
}

static void boxes_behind_a_wall_are_not_entered(void **state)
{
    (void)state;
    load_text("Camera \"perspective\" \"float fov\" 90\nWorldBegin\n"
              "Translate 0 0 4\nShape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]\n"
              "\"point P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\n"
              "Translate 0 0 4\nShape \"sphere\"\n",
              &ONE);
    struct oracle_census census;
    assert_true(oracle_census_create(&census, &oracle.scene));
    assert_true(oracle_cast(&oracle, &census, NULL, NULL));
    assert_int_equal(census.hit_count, 64);
    assert_true(census.is_entered[0] && !census.is_entered[1] && !census.is_visible[1]);
    oracle_census_finish(&census);
}

/* Rays */

/* +x of the picture is -x of the world when one looks down with y up: pbrt is left-handed. */
static void rays_through_pixels_hit_where_a_left_handed_camera_looks(void **state)
{
    (void)state;
    load_text("LookAt 0 0 2  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\n"
              "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]\n"
              "\"point P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\n",
              &ONE);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++) {
            struct oracle_ray ray = oracle_camera_ray(&oracle.camera, x + 0.5, y + 0.5);
            struct oracle_hit hit;
            double at[2] = {-2 * ((x + 0.5) / 4 - 1), -2 * ((y + 0.5) / 4 - 1)};
            assert_true(oracle_rays_trace(oracle.rays, &ray, &hit));
            assert_true(fabs(hit.position.x - at[0]) < 1e-5);
            assert_true(fabs(hit.position.y - at[1]) < 1e-5);
            assert_true(fabs(hit.t - sqrt(4 + at[0] * at[0] + at[1] * at[1])) < 1e-5);
            assert_true(hit.geometric.z > 0.999);
        }
}

static double count_hits(void)
{
    struct oracle_census census;
    assert_true(oracle_census_create(&census, &oracle.scene));
    assert_true(oracle_cast(&oracle, &census, NULL, NULL));
    double count = (double)census.hit_count;
    oracle_census_finish(&census);
    return count;
}

static const char CARD[] = "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2] \"point P\" "
                           "[-9 -9 4  9 -9 4  -9 9 4  9 9 4] \"float alpha\" 0.25\n";

static void alpha_is_a_probability_in_version_4_and_a_threshold_in_version_3(void **state)
{
    (void)state;
    struct oracle_settings settings = {.dim = {64, 64}, .samples = 1, .is_quiet = true};
    char text[1024];
    snprintf(text, sizeof text, "WorldBegin\n%s", CARD);
    load_text(text, &settings);
    assert_true(fabs(count_hits() / 4096 - 0.25) < 4 * sqrt(0.25 * 0.75 / 4096));
    oracle_finish(&oracle);
    snprintf(text, sizeof text, "WorldBegin\n%sWorldEnd\n", CARD);
    load_text(text, &settings);
    assert_true(count_hits() == 4096);
}

/* Light */

/* 1 on all surfaces and from everywhere is 1 in every pixel. */
static void nothing_can_be_seen_in_a_white_furnace(void **state)
{
    (void)state;
    static const char *const MATERIALS[] = {"\"matte\" \"rgb Kd\" [1 1 1]",
                                            "\"mirror\" \"rgb Kr\" [1 1 1]",
                                            "\"glass\" \"rgb Kr\" [1 1 1] \"rgb Kt\" [1 1 1]",
                                            "\"plastic\" \"rgb Kd\" [1 1 1] \"rgb Ks\" [1 1 1]"};
    for (int i = 0; i < 4; i++) {
        struct oracle_settings settings = ONE;
        char text[1024];
        settings.mode = ORACLE_PATH;
        settings.samples = 4;
        settings.bounces = 1000;
        snprintf(text, sizeof text,
                 "LookAt 3 2 2  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n"
                 "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial %s\n"
                 "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2 0 1 4 1 5 4]\n"
                 "\"point P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0  -1 -1 1  1 -1 1]\nWorldEnd\n",
                 MATERIALS[i]);
        load_text(text, &settings);
        const float *rgba = render();
        for (int j = 0; j < 64 * 4; j++)
            if (fabsf(rgba[j] - 1) > 1e-5f)
                fail_msg("%s: pixel %d: %g", MATERIALS[i], j / 4, (double)rgba[j]);
        oracle_finish(&oracle);
    }
}

static void a_point_light_falls_off_with_the_square_of_its_distance(void **state)
{
    (void)state;
    struct oracle_settings settings = ONE;
    settings.mode = ORACLE_DIRECT;
    load_text("LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\"\nWorldBegin\n"
              "LightSource \"point\" \"rgb I\" [3 3 3] \"point from\" [0.5 0.25 2]\n"
              "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n"
              "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]\n"
              "\"point P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\nWorldEnd\n",
              &settings);
    const float *rgba = render();
    for (int i = 0; i < 64; i++) {
        double x = 0.5 + ((i % 8 + 0.5) / 4 - 1), y = 0.25 + ((i / 8 + 0.5) / 4 - 1);
        double square = x * x + y * y + 4;
        double expected = 0.5 / ORACLE_PI * 3 * 2 / sqrt(square) / square;
        assert_true(fabs((double)rgba[4 * i] - expected) < 1e-5);
    }
}

/* Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-4: a point below the
 * corner of a parallel rectangle, four times. */
static void a_square_light_gives_what_its_configuration_factor_says(void **state)
{
    (void)state;
    struct oracle_settings settings = {
        .dim = {1, 1}, .samples = 20000, .mode = ORACLE_DIRECT, .is_quiet = true};
    load_text("LookAt 0 0 0.5  0 0 0  0 1 0\n"
              "Camera \"orthographic\" \"float screenwindow\" [-.001 .001 -.001 .001]\nWorldBegin\n"
              "Material \"matte\" \"rgb Kd\" [1 1 1]\n"
              "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]\n"
              "\"point P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\n"
              "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\n"
              "Shape \"trianglemesh\" \"integer indices\" [0 2 1 1 2 3]\n"
              "\"point P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]\nWorldEnd\n",
              &settings);
    double a = 1 / sqrt(2), factor = 4 * (2 * a * atan(a)) / (2 * ORACLE_PI);
    const float *rgba = render();
    if (fabs((double)rgba[0] - 2 * factor) > 0.01 * 2 * factor)
        fail_msg("%g, not %g", (double)rgba[0], 2 * factor);
}

static void what_stands_between_a_light_and_a_surface_casts_a_shadow(void **state)
{
    (void)state;
    struct oracle_settings settings = ONE;
    settings.mode = ORACLE_DIRECT;
    load_text(
        "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\"\nWorldBegin\n"
        "LightSource \"distant\" \"rgb L\" [1 1 1] \"point from\" [4 0 4] \"point to\" [0 0 0]\n"
        "Material \"matte\" \"rgb Kd\" [1 1 1]\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]\n"
        "\"point P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]\n"
        "\"point P\" [2 -9 2  4 -9 2  2 9 2  4 9 2]\nWorldEnd\n",
        &settings);
    const float *rgba = render();
    for (int i = 0; i < 64; i++) { /* the shadow lies where x is 0 to 2: in the left half */
        double expected = i % 8 < 4 ? 0 : sqrt(0.5) / ORACLE_PI;
        if (fabs((double)rgba[4 * i] - expected) > 1e-5)
            fail_msg("pixel %d: %g, not %g", i, (double)rgba[4 * i], expected);
    }
}

int main(int argc, char **argv)
{
    (void)argc;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(wood_shows_1062_of_1676_shapes_and_rays_enter_1430_boxes,
                                        init, finish),
        cmocka_unit_test_setup_teardown(living_room_shows_60_of_65_shapes_and_rays_enter_63_boxes,
                                        init, finish),
        cmocka_unit_test_setup_teardown(boxes_behind_a_wall_are_not_entered, init, finish),
        cmocka_unit_test_setup_teardown(rays_through_pixels_hit_where_a_left_handed_camera_looks,
                                        init, finish),
        cmocka_unit_test_setup_teardown(
            alpha_is_a_probability_in_version_4_and_a_threshold_in_version_3, init, finish),
        cmocka_unit_test_setup_teardown(nothing_can_be_seen_in_a_white_furnace, init, finish),
        cmocka_unit_test_setup_teardown(a_point_light_falls_off_with_the_square_of_its_distance,
                                        init, finish),
        cmocka_unit_test_setup_teardown(a_square_light_gives_what_its_configuration_factor_says,
                                        init, finish),
        cmocka_unit_test_setup_teardown(what_stands_between_a_light_and_a_surface_casts_a_shadow,
                                        init, finish),
    };
    if (VIPS_INIT(argv[0]) != 0)
        return 1;
    vips_concurrency_set(1);
    int failed = RUN_TESTS(tests);
    vips_shutdown();
    return failed;
}
