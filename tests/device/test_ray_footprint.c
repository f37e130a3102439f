/*
 * Cones and differentials of ray_footprint.glsl against finite differences: neighboring rays are
 * traced in double through the same mirrors and lenses, and their uvs are compared.
 */
#include "device/conform.h"

#include "support/roll.h"
#include "support/test.h"

#include "ray_footprint_comp.h"
#include "ray_footprint_shared.h"

#include <math.h>
#include <string.h>

#define CALLS 1024u

typedef struct vec3 {
    double x, y, z;
} vec3;

struct ray {
    vec3 at, direction;
};

static vec3 make(double x, double y, double z)
{
    return (vec3){x, y, z};
}

static vec3 read3(const float *v)
{
    return make((double)v[0], (double)v[1], (double)v[2]);
}

static void write3(float *out, vec3 v)
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static double dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* a + s * b */
static vec3 add(vec3 a, double s, vec3 b)
{
    return make(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static vec3 scale(double s, vec3 v)
{
    return make(s * v.x, s * v.y, s * v.z);
}

static vec3 cross(vec3 a, vec3 b)
{
    return make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static double length(vec3 v)
{
    return sqrt(dot(v, v));
}

static vec3 unit(vec3 v)
{
    return scale(1 / length(v), v);
}

static double draw(double from, double to)
{
    return from + (to - from) * roll() / ROLL_MAX;
}

static vec3 draw_vec3(double from, double to)
{
    vec3 v;
    v.x = draw(from, to);
    v.y = draw(from, to);
    v.z = draw(from, to);
    return v;
}

/* Returns false if the ray misses, or comes so flat or so near to total reflection that one step of
 * a float makes a large difference. */
static bool meet(const RaySurface *s, struct ray *r)
{
    double radius = (double)s->radius, eta = (double)s->eta, distance;
    vec3 center = read3(s->center), normal = center;
    if (radius == 0) {
        distance = ((double)s->offset - dot(center, r->at)) / dot(center, r->direction);
    } else {
        vec3 o = add(r->at, -1, center);
        double b = dot(o, r->direction), square = b * b - dot(o, o) + radius * radius;
        if (square < 0)
            return false;
        distance = s->far ? -b + sqrt(square) : -b - sqrt(square);
    }
    if (!(distance > 0.05 && distance < 50))
        return false;
    r->at = add(r->at, distance, r->direction);
    if (radius != 0)
        normal = scale(1 / radius, add(r->at, -1, center));
    double facing = dot(normal, r->direction);
    if (fabs(facing) < 0.25)
        return false;
    vec3 across = add(r->direction, -facing, normal); /* the part that Snell's law scales */
    if (s->event == RAY_EVENT_REFLECT) {
        r->direction = add(across, -facing, normal);
        return true;
    }
    across = scale(eta, across);
    double square = 1 - dot(across, across);
    if (fabs(square) < 0.1)
        return false;
    if (square < 0)
        r->direction = add(r->direction, -2 * facing, normal);
    else
        r->direction = add(across, copysign(sqrt(square), facing), normal);
    return true;
}

/* `x` and `y` are in pixels. False: this path is no test. */
static bool trace(const struct RayCall *call, double x, double y, struct ray *r, double uv[2])
{
    r->at = read3(call->origin);
    r->direction = unit(add(add(read3(call->toward), x, read3(call->right)), y, read3(call->down)));
    for (uint32_t i = 0; i < RAY_SURFACES; i++)
        if (call->surfaces[i].event != RAY_EVENT_NONE && !meet(&call->surfaces[i], r))
            return false;
    vec3 p0 = read3(call->positions), e1 = add(read3(call->positions + 3), -1, p0);
    vec3 e2 = add(read3(call->positions + 6), -1, p0), area = cross(e1, e2);
    double facing = dot(area, r->direction) / length(area);
    double distance = dot(area, add(p0, -1, r->at)) / dot(area, r->direction);
    if (!(fabs(facing) > 0.25) || !(distance > 0.05))
        return false;
    r->at = add(r->at, distance, r->direction);
    vec3 at = add(r->at, -1, p0);
    double w1 = dot(cross(at, e2), area) / dot(area, area);
    double w2 = dot(cross(e1, at), area) / dot(area, area);
    for (uint32_t i = 0; i < 2; i++) {
        double uv0 = (double)call->uvs[i], uv1 = (double)call->uvs[2 + i],
               uv2 = (double)call->uvs[4 + i];
        uv[i] = uv0 + w1 * (uv1 - uv0) + w2 * (uv2 - uv0);
    }
    return true;
}

/* dx and dy by central differences. */
static bool differences(const struct RayCall *call, double out[4])
{
    const double step = 1e-3;
    struct ray r;
    for (uint32_t i = 0; i < 2; i++) {
        double after[2], before[2], x = i ? 0 : step, y = i ? step : 0;
        if (!trace(call, x, y, &r, after) || !trace(call, -x, -y, &r, before))
            return false;
        for (uint32_t c = 0; c < 2; c++)
            out[2 * i + c] = (after[c] - before[c]) / (2 * step);
    }
    return true;
}

/* A camera with square pixels of `spread` radians. In `flat` scenes z is 0 everywhere. */
static void draw_camera(struct RayCall *call, bool flat)
{
    vec3 toward = draw_vec3(-0.5, 0.5), side = draw_vec3(-1, 1), origin = draw_vec3(-0.5, 0.5);
    toward.x = 1;
    if (flat) {
        toward.z = 0;
        origin.z = 0;
        side = make(0, 0, 1);
    }
    double spread = draw(1e-4, 2e-3);
    vec3 d = unit(toward), right = unit(cross(d, side)), down = cross(d, right);
    write3(call->origin, origin);
    write3(call->toward, toward);
    write3(call->right, scale(spread * length(toward), right));
    write3(call->down, scale(spread * length(toward), down));
    call->pixelSpread = (float)spread;
}

static void draw_triangle(struct RayCall *call, vec3 around, bool flat)
{
    vec3 corner = add(around, 1, draw_vec3(-2, 2));
    vec3 edge1 = draw_vec3(-1, 1), edge2 = draw_vec3(-1, 1);
    if (flat) {
        edge1.z = 0;
        edge2 = make(0, 0, 0.7);
    }
    write3(call->positions, corner);
    write3(call->positions + 3, add(corner, 1, edge1));
    write3(call->positions + 6, add(corner, 1, edge2));
    for (uint32_t i = 0; i < 6; i++)
        call->uvs[i] = (float)draw(-2, 2);
    call->size[0] = (float)(1 << roll() % 12);
    call->size[1] = (float)(1 << roll() % 12);
}

static void draw_surface(RaySurface *s, double x, bool curved, bool flat, uint32_t event)
{
    *s = (RaySurface){.event = event};
    s->eta = (float)draw(0.6, 1.7);
    vec3 normal = draw_vec3(-0.6, 0.6);
    normal.x = 1;
    if (flat)
        normal.z = 0;
    normal = unit(normal);
    if (!curved) {
        write3(s->center, normal);
        s->offset = (float)(x * normal.x);
        return;
    }
    s->radius = (float)draw(1, 6);
    s->far = (uint32_t)roll() % 2;
    /* the side that the ray hits is near x */
    write3(s->center, add(make(x, 0, 0), s->far ? -(double)s->radius : (double)s->radius, normal));
}

/* Draws until the path can be traced. */
static void draw_path(struct RayCall *call, uint32_t i, bool curved, bool refracting, bool flat)
{
    double unused[4];
    do {
        memset(call, 0, sizeof *call);
        call->function = RAY_PATH;
        draw_camera(call, flat);
        for (uint32_t k = 0; k < i % (RAY_SURFACES + 1); k++)
            draw_surface(&call->surfaces[k], k ? draw(0, 6) : 4, curved && roll() % 4, flat,
                         refracting && roll() % 2 ? RAY_EVENT_REFRACT : RAY_EVENT_REFLECT);
        draw_triangle(call, make(i % 3 ? 3 : 5, 0, 0), flat); /* 5: seen directly */
    } while (!differences(call, unused));
}

static void run_calls(struct harness *h, struct RayCall *calls)
{
    struct harness_buffer buffer;
    struct conform_set set;
    uint32_t count = CALLS;
    harness_buffer_init(h, &buffer, CALLS * sizeof *calls, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    memcpy(buffer.mapped, calls, CALLS * sizeof *calls);
    conform_create_set(h, 1, 0, sizeof count, &set);
    conform_write_buffers(h, &set, 1, (const struct harness_buffer *const[]){&buffer});
    VkPipeline pipeline = conform_compute_pipeline(
        h, set.layout, conform_module(h, ray_footprint_comp, sizeof ray_footprint_comp), NULL);
    conform_run_job(h, &(struct conform_job){.set = &set,
                                             .stage = CONFORM_STAGE_COMPUTE,
                                             .pipeline = pipeline,
                                             .count = CALLS,
                                             .push = &count,
                                             .push_size = sizeof count});
    memcpy(calls, buffer.mapped, CALLS * sizeof *calls);
    h->DestroyPipeline(h->device, pipeline, NULL);
    conform_destroy_set(h, &set);
    harness_buffer_finish(h, &buffer);
}

static double longest(const double g[4])
{
    return fmax(hypot(g[0], g[1]), hypot(g[2], g[3]));
}

/* Relative to the longer derivative. Floats lose digits where a path is long and bends much. */
#define TOLERANCE 1e-3

static void differentials_are_those_of_neighboring_rays(void **state)
{
    static struct RayCall calls[CALLS];
    double largest = 0, expected[4];
    roll_seed(1);
    for (uint32_t i = 0; i < CALLS; i++)
        draw_path(&calls[i], i, i % 4 > 0, i % 8 > 3, false);
    run_calls(*state, calls);
    for (uint32_t i = 0; i < CALLS; i++) {
        assert_true(differences(&calls[i], expected));
        for (uint32_t k = 0; k < 4; k++) {
            double error = fabs((double)calls[i].differential[k] - expected[k]) / longest(expected);
            if (!(error <= TOLERANCE))
                fail_msg("path %u, derivative %u: %g, expected %g of %g", i, k,
                         (double)calls[i].differential[k], expected[k], longest(expected));
            largest = fmax(largest, error);
        }
    }
    print_message("# error.differential %.3g\n", largest);
}

/* The ellipse's matrix, sum of the products of its axes, does not depend on the choice of axes. */
static void ellipse(const double g[4], double out[3])
{
    out[0] = g[0] * g[0] + g[2] * g[2];
    out[1] = g[0] * g[1] + g[2] * g[3];
    out[2] = g[1] * g[1] + g[3] * g[3];
}

static void read_cone(const struct RayCall *call, double g[4])
{
    for (uint32_t k = 0; k < 4; k++)
        g[k] = (double)call->cone[k];
}

static void cones_cover_the_pixel_after_plane_mirrors(void **state)
{
    static struct RayCall calls[CALLS];
    roll_seed(2);
    for (uint32_t i = 0; i < CALLS; i++)
        draw_path(&calls[i], i, false, false, false);
    run_calls(*state, calls);
    for (uint32_t i = 0; i < CALLS; i++) {
        double expected[4], got[4], a[3], b[3];
        assert_true(differences(&calls[i], expected));
        read_cone(&calls[i], got);
        ellipse(expected, a);
        ellipse(got, b);
        for (uint32_t k = 0; k < 3; k++)
            if (!(fabs(a[k] - b[k]) <= TOLERANCE * (a[0] + a[2])))
                fail_msg("path %u, number %u of the ellipse: %g, expected %g", i, k, b[k], a[k]);
    }
}

/* Across the plane, differences equal those of the cone only where nothing bends. */
static void cones_follow_curves_and_refraction_in_the_plane_of_incidence(void **state)
{
    static struct RayCall calls[CALLS];
    double largest = 0;
    roll_seed(3);
    for (uint32_t i = 0; i < CALLS; i++)
        draw_path(&calls[i], i, true, true, true);
    run_calls(*state, calls);
    for (uint32_t i = 0; i < CALLS; i++) {
        double expected[4], got[4];
        assert_true(differences(&calls[i], expected));
        read_cone(&calls[i], got);
        double sign = got[0] * expected[0] + got[1] * expected[1] < 0 ? -1 : 1;
        /* a cone that is focused on the triangle has lost its digits */
        double scale = fmax(hypot(expected[0], expected[1]), 0.02 * longest(expected));
        double error = hypot(sign * got[0] - expected[0], sign * got[1] - expected[1]) / scale;
        if (!(error <= TOLERANCE))
            fail_msg("path %u: (%g %g), expected (%g %g)", i, got[0], got[1], sign * expected[0],
                     sign * expected[1]);
        largest = fmax(largest, error);
    }
    print_message("# error.cone %.3g\n", largest);
}

static void lods_are_those_of_the_gradients(void **state)
{
    static struct RayCall calls[CALLS];
    roll_seed(4);
    for (uint32_t i = 0; i < CALLS; i++) {
        draw_path(&calls[i], i, true, true, false);
        if (i % 2) { /* uv is in the proportions of the triangle, turned and scaled */
            vec3 p0 = read3(calls[i].positions), e1 = add(read3(calls[i].positions + 3), -1, p0);
            vec3 e2 = add(read3(calls[i].positions + 6), -1, p0), u = unit(e1);
            double scale = draw(0.1, 4), along = dot(e2, u), across = length(add(e2, -along, u));
            const double uvs[6] = {
                1, 2, 1, 2 + scale * length(e1), 1 - scale * across, 2 + scale * along};
            for (uint32_t k = 0; k < 6; k++)
                calls[i].uvs[k] = (float)uvs[k];
            calls[i].size[1] = calls[i].size[0];
        }
    }
    run_calls(*state, calls);
    for (uint32_t i = 0; i < CALLS; i++) {
        double g[4], size[2] = {(double)calls[i].size[0], (double)calls[i].size[1]};
        struct ray r;
        double uv[2];
        assert_true(trace(&calls[i], 0, 0, &r, uv));
        read_cone(&calls[i], g);
        double x = hypot(g[0] * size[0], g[1] * size[1]), y = hypot(g[2] * size[0], g[3] * size[1]);
        assert_float_equal(calls[i].coneGradientLod, log2(fmax(x, y)), 2e-3);
        /* the axes' area, times the ratio of the axes on the plane: 1 / cosine */
        vec3 p0 = read3(calls[i].positions), e1 = add(read3(calls[i].positions + 3), -1, p0);
        vec3 area = unit(cross(e1, add(read3(calls[i].positions + 6), -1, p0)));
        double texels = fabs(g[0] * g[3] - g[1] * g[2]) * size[0] * size[1];
        double expected = 0.5 * log2(texels / fabs(dot(area, r.direction)));
        assert_float_equal(calls[i].coneLod, expected, 2e-2);
        if (i % 2)
            assert_float_equal(calls[i].coneLod, calls[i].coneGradientLod, 2e-2);
    }
}

static vec3 interpolated(const struct RayCall *call, vec3 step)
{
    vec3 p0 = read3(call->positions), e1 = add(read3(call->positions + 3), -1, p0);
    vec3 e2 = add(read3(call->positions + 6), -1, p0), area = cross(e1, e2);
    double w1 = (double)call->weights[0] + dot(cross(step, e2), area) / dot(area, area);
    double w2 = (double)call->weights[1] + dot(cross(e1, step), area) / dot(area, area);
    vec3 n = scale(1 - w1 - w2, read3(call->normals));
    return unit(add(add(n, w1, read3(call->normals + 3)), w2, read3(call->normals + 6)));
}

/* Corners on a sphere, with its normals. */
static void draw_sphere_triangle(struct RayCall *call, double radius)
{
    vec3 center = draw_vec3(-1, 1), middle = unit(draw_vec3(-1, 1));
    memset(call, 0, sizeof *call);
    call->function = RAY_NORMAL;
    for (uint32_t k = 0; k < 3; k++) {
        vec3 n = unit(add(middle, 0.3, draw_vec3(-1, 1)));
        write3(call->normals + 3 * k, n);
        write3(call->positions + 3 * k, add(center, radius, n));
    }
    call->weights[0] = (float)draw(0, 0.5);
    call->weights[1] = (float)draw(0, 0.5);
    write3(call->step, scale(radius, draw_vec3(-0.1, 0.1)));
}

static void normals_change_as_between_neighboring_points(void **state)
{
    static struct RayCall calls[CALLS];
    static double radii[CALLS];
    const double small = 1e-5;
    roll_seed(5);
    for (uint32_t i = 0; i < CALLS; i++) {
        double area;
        radii[i] = draw(0.5, 3) * (i % 2 ? -1 : 1); /* seen from inside: concave */
        do {
            draw_sphere_triangle(&calls[i], radii[i]);
            vec3 p0 = read3(calls[i].positions), e1 = add(read3(calls[i].positions + 3), -1, p0);
            vec3 e2 = add(read3(calls[i].positions + 6), -1, p0);
            area = length(cross(e1, e2)) / (length(e1) * length(e2));
        } while (area < 0.1);
    }
    run_calls(*state, calls);
    for (uint32_t i = 0; i < CALLS; i++) {
        vec3 step = read3(calls[i].step), got = read3(calls[i].normalChange);
        vec3 difference = add(interpolated(&calls[i], scale(small, step)), -1,
                              interpolated(&calls[i], scale(-small, step)));
        vec3 expected = scale(1 / (2 * small), difference);
        assert_true(length(add(got, -1, expected)) <= TOLERANCE * fmax(length(expected), 0.05));
        assert_float_equal(calls[i].curvature * (float)radii[i], 1, 1e-3);
    }
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(differentials_are_those_of_neighboring_rays),
        cmocka_unit_test(cones_cover_the_pixel_after_plane_mirrors),
        cmocka_unit_test(cones_follow_curves_and_refraction_in_the_plane_of_incidence),
        cmocka_unit_test(lods_are_those_of_the_gradients),
        cmocka_unit_test(normals_change_as_between_neighboring_points),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
