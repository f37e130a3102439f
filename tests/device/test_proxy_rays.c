/* Rays that hit proxy boxes on the device request the boxes that a caster on the host hits. Uses
 * ray tracing, if the device has it, and a compute shader. */
#include "device/proxy_rig.h"

#include "support/test.h"

#include "demand/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct harness h;
static bool traces;

/* The boxes of a set, and the hits of rays by the formula in double. */
struct scene {
    struct proxy_rig rig;
    SluiceProxyId ids[PROXY_RIG_BOXES];
    uint32_t index_count; ///< number of indices in `ids`
    uint64_t seed;
    bool nearest[PROXY_RIG_BOXES], entered[PROXY_RIG_BOXES];
    struct ProxyHit expected[PROXY_RIG_RAYS];
};

/* A ray's path through a box. `margin`: distance from missing the box, relative to the ray's
 * length; negative: misses. `doubt`: rounding could choose another face. */
struct crossing {
    double t, margin;
    uint32_t face;
    bool doubt;
};

static struct crossing cross(const SluiceProxyBox *box, const struct ProxyRay *ray)
{
    double enter = -HUGE_VAL, leave = HUGE_VAL, second = -HUGE_VAL, behind = HUGE_VAL;
    uint32_t enter_face = 0, leave_face = 0;
    struct crossing crossing = {.margin = HUGE_VAL};
    for (uint32_t axis = 0; axis < 3; axis++) {
        double d = ray->direction[axis], o = ray->origin[axis];
        double min = box->min[axis] - o, max = box->max[axis] - o;
        if (d == 0) {
            double margin = fmin(-min, max) / (fabs(o) + fabs(min) + fabs(max));
            crossing.margin = fmin(crossing.margin, margin);
            continue;
        }
        double near = d > 0 ? min / d : max / d, far = d > 0 ? max / d : min / d;
        second = near > enter ? enter : fmax(second, near);
        enter_face = near > enter ? 2 * axis + (d < 0) : enter_face;
        enter = fmax(enter, near);
        behind = far < leave ? leave : fmin(behind, far);
        leave_face = far < leave ? 2 * axis + (d > 0) : leave_face;
        leave = fmin(leave, far);
    }
    bool inside = enter < 0;
    double scale = fmax(fabs(enter), fabs(leave)) + 1e-30;
    crossing.margin = fmin(crossing.margin, (leave - enter) / scale);
    crossing.margin = fmin(crossing.margin, leave / scale);
    crossing.margin = fmin(crossing.margin, (ray->tMax - enter) / ray->tMax - 2e-5);
    crossing.t = inside ? 0 : enter;
    crossing.face = inside ? leave_face : enter_face;
    crossing.doubt =
        fabs(enter) < 1e-5 * scale || (inside ? behind - leave : enter - second) < 1e-5 * scale;
    return crossing;
}

/* Computes a ray's hits. Returns false if rounding could decide the result. */
static bool cast(struct scene *scene, const struct ProxyRay *ray, struct ProxyHit *hit,
                 uint32_t *entered, uint32_t *entered_count)
{
    double nearest = HUGE_VAL, second = HUGE_VAL;
    *hit = (struct ProxyHit){.proxy = PROXY_RAY_MISS};
    *entered_count = 0;
    for (uint32_t i = 0; i < scene->index_count; i++) {
        SluiceProxyBox box;
        if (scene->ids[i] == SLUICE_NO_PROXY)
            continue;
        CHECK_OK(sluiceGetProxyBox(scene->rig.geometry, scene->ids[i], &box));
        struct crossing crossing = cross(&box, ray);
        if (crossing.margin < -1e-5)
            continue;
        if (crossing.margin < 0) /* boxes are never missed, but rays beside them may hit */
            return false;
        if (crossing.doubt)
            return false;
        entered[(*entered_count)++] = i;
        second = crossing.t < nearest ? nearest : fmin(second, crossing.t);
        if (crossing.t >= nearest)
            continue;
        nearest = crossing.t;
        *hit = (struct ProxyHit){.t = (float)crossing.t, .proxy = i, .face = crossing.face};
        hit->normal[crossing.face / 2] = crossing.face % 2 ? 1 : -1;
    }
    return !(second - nearest < 1e-4 * (nearest + 1e-3));
}

static float number(struct scene *scene, float from, float to)
{
    return from + (to - from) * ((float)random_below(&scene->seed, 1u << 24) / (float)(1 << 24));
}

static void add(struct scene *scene, const SluiceProxyBox *box)
{
    SluiceProxyId id = proxy_rig_add(&scene->rig, box);
    uint32_t index = (uint32_t)id;
    scene->ids[index] = id;
    if (index >= scene->index_count)
        scene->index_count = index + 1;
}

/* Adds boxes in [-10, 10]. One in three has zero thickness along an axis. */
static void add_random(struct scene *scene, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceProxyBox box;
        for (uint32_t axis = 0; axis < 3; axis++) {
            box.min[axis] = number(scene, -10, 9.5f);
            box.max[axis] = box.min[axis] + number(scene, 0.1f, 1.5f);
        }
        if (i % 3 == 0)
            box.max[i / 3 % 3] = box.min[i / 3 % 3];
        add(scene, &box);
    }
}

/* Returns a ray from anywhere, sometimes inside boxes or along axes. Half of the rays aim at a
 * box. */
static struct ProxyRay random_ray(struct scene *scene)
{
    struct ProxyRay ray = {.tMax = number(scene, 1, 60)};
    for (uint32_t axis = 0; axis < 3; axis++) {
        ray.origin[axis] = number(scene, -12, 12);
        ray.direction[axis] = number(scene, -1, 1);
    }
    uint32_t target = random_below(&scene->seed, 2 * scene->index_count + 1);
    if (target < scene->index_count && scene->ids[target] != SLUICE_NO_PROXY) {
        SluiceProxyBox box;
        CHECK_OK(sluiceGetProxyBox(scene->rig.geometry, scene->ids[target], &box));
        for (uint32_t axis = 0; axis < 3; axis++)
            ray.direction[axis] = 0.5f * (box.min[axis] + box.max[axis]) - ray.origin[axis];
    } else if (random_below(&scene->seed, 2) == 0) {
        uint32_t axis = random_below(&scene->seed, 3);
        ray.direction[axis] = 0;
        if (random_below(&scene->seed, 2))
            ray.direction[(axis + 1) % 3] = 0;
    }
    return ray;
}

static void aim(struct scene *scene, uint32_t count)
{
    static uint32_t entered[PROXY_RIG_BOXES];
    memset(scene->nearest, 0, sizeof scene->nearest);
    memset(scene->entered, 0, sizeof scene->entered);
    for (uint32_t i = 0; i < count;) {
        struct ProxyRay ray = random_ray(scene);
        uint32_t n;
        if (!cast(scene, &ray, &scene->expected[i], entered, &n))
            continue;
        for (uint32_t k = 0; k < n; k++)
            scene->entered[entered[k]] = true;
        if (scene->expected[i].proxy != PROXY_RAY_MISS)
            scene->nearest[scene->expected[i].proxy] = true;
        proxy_rig_rays(&scene->rig)[i++] = ray;
    }
    scene->rig.ray_count = count;
}

static void check_hits(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->rig.ray_count; i++) {
        const struct ProxyHit *hit = &proxy_rig_hits(&scene->rig)[i], *wanted = &scene->expected[i];
        assert_int_equal(hit->proxy, wanted->proxy);
        if (wanted->proxy == PROXY_RAY_MISS)
            continue;
        assert_true(fabsf(hit->t - wanted->t) <= 2e-5f * (wanted->t + 1));
        assert_int_equal(hit->face, wanted->face);
        assert_memory_equal(hit->normal, wanted->normal, sizeof hit->normal);
    }
}

static uint32_t check_requested(const struct scene *scene, const SluiceProxySet *set,
                                const bool *wanted)
{
    static SluiceProxyId ids[PROXY_RIG_BOXES];
    uint32_t count = PROXY_RIG_BOXES, at = 0;
    CHECK_OK(sluiceGetRequestedProxies(set, NULL, &count, ids));
    for (uint32_t i = 0; i < scene->index_count; i++)
        if (wanted[i])
            assert_true(at < count && ids[at++] == scene->ids[i]);
    assert_int_equal(at, count);
    return count;
}

static void clear(struct scene *scene)
{
    CHECK_OK(sluiceClearProxyRequests(scene->rig.geometry, SLUICE_ALL_PROXIES));
    CHECK_OK(sluiceClearProxyRequests(scene->rig.materials, SLUICE_ALL_PROXIES));
}

static void check_launches(struct scene *scene, bool by_rays)
{
    static const bool none[PROXY_RIG_BOXES];
    clear(scene);
    proxy_rig_launch(&scene->rig, by_rays, false);
    check_hits(scene);
    uint32_t hit = check_requested(scene, scene->rig.geometry, scene->nearest);
    check_requested(scene, scene->rig.materials, none);
    assert_int_equal(scene->rig.requests.missingCount, hit);
    clear(scene);
    proxy_rig_launch(&scene->rig, by_rays, true);
    check_requested(scene, scene->rig.geometry, none);
    check_requested(scene, scene->rig.materials, scene->entered);
}

static struct scene *scene_new(uint64_t seed)
{
    struct scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    scene->seed = seed;
    proxy_rig_init(&scene->rig, &h, traces);
    return scene;
}

static void scene_free(struct scene *scene)
{
    proxy_rig_finish(&scene->rig);
    free(scene);
}

/* Boxes are added and removed, and indices reused. */
static void compare(bool by_rays)
{
    enum { ROUNDS = 3 };
    struct scene *scene = scene_new(11 + by_rays);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        add_random(scene, 150);
        aim(scene, 700);
        check_launches(scene, by_rays);
        for (uint32_t i = 0; i < scene->index_count; i++) {
            if (scene->ids[i] == SLUICE_NO_PROXY || random_below(&scene->seed, 3) == 0)
                continue;
            proxy_rig_remove(&scene->rig, scene->ids[i]);
            scene->ids[i] = SLUICE_NO_PROXY;
        }
        aim(scene, 300);
        check_launches(scene, by_rays);
    }
    scene_free(scene);
}

static void rays_request_the_boxes_that_a_host_caster_hits(void **state)
{
    (void)state;
    if (!traces)
        SKIP_TEST("the device has no ray-tracing pipelines");
    compare(true);
}

static void a_compute_shader_requests_the_boxes_that_a_host_caster_hits(void **state)
{
    (void)state;
    compare(false);
}

/* Squares of zero thickness, also far from the origin. Rays hit their middles, also from within. */
static void boxes_of_zero_thickness_are_hit(void **state)
{
    (void)state;
    enum { COUNT = 120 };
    struct scene *scene = scene_new(21);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t flat = i % 3;
        float scale = ldexpf(1, (int)(i % 12) * 3 - 12); /* 2^-12 to 2^21 */
        SluiceProxyBox box;
        struct ProxyRay *ray = &proxy_rig_rays(&scene->rig)[i];
        *ray = (struct ProxyRay){.tMax = 1e9f};
        for (uint32_t axis = 0; axis < 3; axis++) {
            float at = number(scene, -1, 1);
            box.min[axis] = scale * at;
            box.max[axis] = scale * (axis == flat ? at : at + 0.5f);
            float middle = 0.5f * (box.min[axis] + box.max[axis]);
            ray->direction[axis] = axis == flat ? (i & 1 ? 1.0f : -1.0f) : 0;
            ray->origin[axis] = middle - ray->direction[axis] * (i % 5 ? scale : 0);
        }
        add(scene, &box);
    }
    scene->rig.ray_count = COUNT;
    for (uint32_t i = 0; i < COUNT; i++)
        scene->entered[i] = true;
    for (uint32_t by_rays = 0; by_rays <= traces; by_rays++) {
        clear(scene);
        proxy_rig_launch(&scene->rig, by_rays, true); /* each is entered even if not the nearest */
        check_requested(scene, scene->rig.materials, scene->entered);
    }
    scene_free(scene);
}

static void a_set_without_boxes_is_hit_by_nothing(void **state)
{
    (void)state;
    const SluiceProxyBox unit = {{-1, -1, -1}, {1, 1, 1}};
    struct scene *scene = scene_new(31);
    aim(scene, 64);
    for (uint32_t by_rays = 0; by_rays <= traces; by_rays++) {
        check_launches(scene, by_rays);
        add(scene, &unit); /* and a structure whose only box was removed */
        proxy_rig_launch(&scene->rig, by_rays, false);
        proxy_rig_remove(&scene->rig, scene->ids[0]);
        scene->ids[0] = SLUICE_NO_PROXY;
        check_launches(scene, by_rays);
    }
    scene_free(scene);
}

int main(void)
{
    int status = harness_init_with(&h, ray_device_extensions, RAY_DEVICE_EXTENSION_COUNT,
                                   ray_device_features());
    traces = status == 0;
    if (status == 77)
        status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_request_the_boxes_that_a_host_caster_hits),
        cmocka_unit_test(a_compute_shader_requests_the_boxes_that_a_host_caster_hits),
        cmocka_unit_test(boxes_of_zero_thickness_are_hit),
        cmocka_unit_test(a_set_without_boxes_is_hit_by_nothing),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
