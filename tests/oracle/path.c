#include "oracle/path.h"

#include "oracle/random.h"

/* A path on its way. */
struct path {
    struct oracle_ray ray;
    struct vec weight, sum;
    bool sees_emitters; ///< direct light has not counted them
    uint64_t *seed;
};

static const SluicePbrtMaterial *choose_material(const struct oracle_tracer *tracer,
                                                 const struct oracle_hit *hit, uint64_t *seed)
{
    const struct oracle_scene *scene = tracer->scene;
    const SluicePbrtMaterial *m =
        &scene->materials[scene->shapes[scene->places[hit->place].shape].material];
    while (m->kind == SLUICE_PBRT_MATERIAL_MIX) {
        double amount = oracle_number(tracer->values, &m->amount, &hit->point);
        m = &scene->materials[m->materials[oracle_random(seed) < amount]];
    }
    return m;
}

static struct vec reflect(struct vec direction, struct vec n)
{
    return unit(along(direction, n, -2 * dot(direction, n)));
}

/* Sends the path on from a point on the side to which `away` points. */
static void go_on(struct path *path, const struct oracle_hit *hit, struct vec away,
                  struct vec direction, struct vec weight)
{
    path->ray.origin = along(hit->position, away, hit->offset);
    path->ray.direction = direction;
    path->ray.seed = *path->seed;
    path->weight = mul(path->weight, weight);
}

/* A direction around n, distributed as the cosine. */
static struct vec scatter(struct vec n, uint64_t *seed)
{
    double turn = 2 * ORACLE_PI * oracle_random(seed), r2 = oracle_random(seed);
    struct vec other = fabs(n.x) > 0.5 ? vec(0, 1, 0) : vec(1, 0, 0);
    struct vec a = unit(cross(n, other)), b = cross(n, a);
    return unit(add(scale(n, sqrt(1 - r2)),
                    add(scale(a, cos(turn) * sqrt(r2)), scale(b, sin(turn) * sqrt(r2)))));
}

/* Returns whether the path continues. */
static bool leave_diffuse(const struct oracle_tracer *tracer, struct path *path,
                          const struct oracle_hit *hit, struct vec color)
{
    struct vec back = scale(path->ray.direction, -1);
    struct vec side = turn_to(hit->geometric, back), n = turn_to(hit->shading, side);
    struct vec light = oracle_direct_light(&tracer->lights, tracer->rays, hit, n, side, path->seed);
    path->sum = add(path->sum, mul(path->weight, mul(color, light)));
    struct vec direction = scatter(n, path->seed);
    if (dot(direction, side) <= 0 || mean(color) <= 0)
        return false;
    go_on(path, hit, side, direction, color);
    path->sees_emitters = false;
    return true;
}

static bool leave_mirror(struct path *path, const struct oracle_hit *hit, struct vec color)
{
    struct vec back = scale(path->ray.direction, -1);
    struct vec side = turn_to(hit->geometric, back), n = turn_to(hit->shading, back);
    struct vec direction = reflect(path->ray.direction, n);
    if (dot(direction, side) <= 0)
        return false;
    go_on(path, hit, side, direction, color);
    path->sees_emitters = true;
    return true;
}

/* The share that a dielectric reflects. `eta`: of the far side, relative to the near one. */
static double fresnel(double cosine, double eta)
{
    double sine2 = (1 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1)
        return 1;
    double far_cosine = sqrt(1 - sine2);
    double parallel = (eta * cosine - far_cosine) / (eta * cosine + far_cosine);
    double across = (cosine - eta * far_cosine) / (cosine + eta * far_cosine);
    return (parallel * parallel + across * across) / 2;
}

static bool leave_glass(const struct oracle_tracer *tracer, struct path *path,
                        const struct oracle_hit *hit, const SluicePbrtMaterial *material)
{
    struct vec d = path->ray.direction, n = turn_to(hit->shading, scale(d, -1));
    double eta = dot(hit->shading, d) < 0 ? material->eta : 1 / (double)material->eta;
    double cosine = -dot(n, d);
    if (oracle_random(path->seed) < fresnel(cosine, eta))
        return leave_mirror(path, hit,
                            oracle_value(tracer->values, &material->specular, &hit->point));
    double far_cosine = sqrt(fmax(0, 1 - (1 - cosine * cosine) / (eta * eta)));
    struct vec through = unit(along(scale(d, 1 / eta), n, cosine / eta - far_cosine));
    go_on(path, hit, turn_to(hit->geometric, d), through,
          oracle_value(tracer->values, &material->transmission, &hit->point));
    path->sees_emitters = true;
    return true;
}

/* The coat reflects as often as it is strong. */
static bool leave_glossy(const struct oracle_tracer *tracer, struct path *path,
                         const struct oracle_hit *hit, const SluicePbrtMaterial *material,
                         struct vec diffuse)
{
    double eta = material->eta > 1 ? (double)material->eta : 1.5;
    double base = (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1));
    double cosine = fabs(dot(hit->shading, path->ray.direction));
    double strength = base + (1 - base) * pow(1 - fmin(1, cosine), 5);
    if (tracer->bounces > 0 && oracle_random(path->seed) < strength)
        return leave_mirror(path, hit,
                            oracle_value(tracer->values, &material->specular, &hit->point));
    return leave_diffuse(tracer, path, hit, diffuse);
}

static bool leave(const struct oracle_tracer *tracer, struct path *path,
                  const struct oracle_hit *hit)
{
    const SluicePbrtMaterial *material = choose_material(tracer, hit, path->seed);
    struct vec diffuse = oracle_value(tracer->values, &material->diffuse, &hit->point);
    switch (material->kind) {
    case SLUICE_PBRT_MATERIAL_MIRROR:
        return leave_mirror(path, hit,
                            oracle_value(tracer->values, &material->specular, &hit->point));
    case SLUICE_PBRT_MATERIAL_GLASS: return leave_glass(tracer, path, hit, material);
    case SLUICE_PBRT_MATERIAL_GLOSSY: return leave_glossy(tracer, path, hit, material, diffuse);
    case SLUICE_PBRT_MATERIAL_NONE: return false;
    default: return leave_diffuse(tracer, path, hit, diffuse);
    }
}

struct vec oracle_radiance(const struct oracle_tracer *tracer, struct oracle_ray ray,
                           uint64_t *seed)
{
    struct path path = {ray, vec(1, 1, 1), vec(0, 0, 0), true, seed};
    for (uint32_t bounce = 0;; bounce++) {
        struct oracle_hit hit;
        /* The last ray only asks whether infinite lights arrive. */
        if (!oracle_rays_trace(tracer->rays, &path.ray, &hit))
            return add(path.sum,
                       mul(path.weight, oracle_surroundings(&tracer->lights, path.ray.direction)));
        if (path.sees_emitters || !oracle_is_chosen(tracer->scene, hit.place))
            path.sum =
                add(path.sum, mul(path.weight, oracle_emitted(&tracer->lights, &hit,
                                                              scale(path.ray.direction, -1))));
        if (bounce > tracer->bounces || !leave(tracer, &path, &hit))
            return path.sum;
    }
}

struct vec oracle_preview(const struct oracle_tracer *tracer, const struct oracle_ray *ray,
                          uint64_t *seed)
{
    const struct oracle_scene *scene = tracer->scene;
    struct oracle_hit hit;
    if (!oracle_rays_trace(tracer->rays, ray, &hit))
        return oracle_surroundings(&tracer->lights, ray->direction);
    const SluicePbrtMaterial *m = choose_material(tracer, &hit, seed);
    struct vec color = oracle_value(tracer->values, &m->diffuse, &hit.point);
    if (m->kind == SLUICE_PBRT_MATERIAL_MIRROR || m->kind == SLUICE_PBRT_MATERIAL_GLASS)
        color = add(color, scale(add(oracle_value(tracer->values, &m->specular, &hit.point),
                                     oracle_value(tracer->values, &m->transmission, &hit.point)),
                                 0.5));
    struct vec back = scale(ray->direction, -1);
    struct vec n = tracer->face_forward ? turn_to(hit.shading, back) : hit.shading;
    struct vec light = add(tracer->mean_sky, vec(0.4, 0.4, 0.4));
    bool only_areas = true;
    for (uint32_t i = 0; i < scene->info.lightCount; i++) {
        struct vec towards, sent;
        double distance;
        only_areas = only_areas && scene->lights[i].kind == SLUICE_PBRT_LIGHT_AREA;
        if (oracle_sent(scene, i, hit.position, &towards, &distance, &sent))
            light = along(light, sent, fmax(dot(n, towards), 0));
    }
    if (only_areas)
        light = along(light, vec(0.6, 0.6, 0.6), fabs(dot(n, ray->direction)));
    return add(mul(color, light), oracle_emitted(&tracer->lights, &hit, back));
}
