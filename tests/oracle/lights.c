#include "oracle/lights.h"

#include "oracle/random.h"

#include <stdlib.h>

#define ORACLE_FAR 1e300 /* distance of lights without a position */

/* Shapes with alpha are not sampled: pbrt's direct light looks up no alpha there. */
bool oracle_is_chosen(const struct oracle_scene *scene, size_t place)
{
    const SluicePbrtShape *shape = &scene->shapes[scene->places[place].shape];
    return shape->areaLight != SLUICE_PBRT_NONE && shape->alpha.texture == SLUICE_PBRT_NONE &&
           shape->alpha.value[0] >= 1;
}

/* The light's side is that of the geometric normal, oriented as in oracle_find_point. */
static struct oracle_emitter make_emitter(const struct oracle_scene *scene, size_t place,
                                          uint32_t triangle)
{
    const double *m = scene->places[place].transform;
    const SluicePbrtShape *shape = &scene->shapes[scene->places[place].shape];
    struct oracle_hit hit = {.place = place, .triangle = triangle, .b1 = 1.0 / 3, .b2 = 1.0 / 3};
    struct vec p[3];
    oracle_corners(&scene->meshes[scene->places[place].mesh], triangle, p);
    for (int i = 0; i < 3; i++)
        p[i] = apply_point(m, p[i]);
    oracle_find_point(scene, &hit);
    struct oracle_emitter e = {.corner = p[0],
                               .side1 = sub(p[1], p[0]),
                               .side2 = sub(p[2], p[0]),
                               .outside = hit.geometric,
                               .light = shape->areaLight};
    e.area = length(cross(e.side1, e.side2)) / 2;
    return e;
}

bool oracle_lights_create(struct oracle_lights *lights, const struct oracle_scene *scene,
                          struct oracle_values *values, struct vec background)
{
    size_t count = 0;
    *lights = (struct oracle_lights){scene, values, .background = background};
    for (size_t i = 0; i < scene->place_count; i++)
        if (oracle_is_chosen(scene, i))
            count += scene->meshes[scene->places[i].mesh].triangleCount;
    lights->emitters = calloc(count + 1, sizeof *lights->emitters);
    if (!lights->emitters)
        return false;
    for (size_t i = 0; i < scene->place_count; i++)
        for (uint32_t t = 0;
             oracle_is_chosen(scene, i) && t < scene->meshes[scene->places[i].mesh].triangleCount;
             t++) {
            struct oracle_emitter e = make_emitter(scene, i, t);
            e.weight_before = lights->weight;
            if (!(e.area > 0))
                continue;
            lights->weight += e.area * mean(vec_of(scene->lights[e.light].color));
            lights->emitters[lights->emitter_count++] = e;
        }
    return true;
}

void oracle_lights_finish(struct oracle_lights *lights)
{
    free(lights->emitters);
    *lights = (struct oracle_lights){0};
}

struct vec oracle_emitted(const struct oracle_lights *lights, const struct oracle_hit *hit,
                          struct vec direction)
{
    const struct oracle_scene *scene = lights->scene;
    uint32_t index = scene->shapes[scene->places[hit->place].shape].areaLight;
    if (index == SLUICE_PBRT_NONE)
        return vec(0, 0, 0);
    const SluicePbrtLight *light = &scene->lights[index];
    if (!light->isTwoSided && dot(hit->geometric, direction) <= 0)
        return vec(0, 0, 0);
    return vec_of(light->color);
}

struct vec oracle_surroundings(const struct oracle_lights *lights, struct vec direction)
{
    struct vec sum = lights->background;
    for (uint32_t i = 0; i < lights->scene->info.lightCount; i++)
        if (lights->scene->lights[i].kind == SLUICE_PBRT_LIGHT_INFINITE)
            sum = add(sum, oracle_sky(lights->values, i, direction));
    return sum;
}

/* A point on the surface, with the start of its shadow rays. */
struct receiver {
    struct oracle_rays *rays;
    struct vec point, normal, side;
    double offset;
    uint64_t *seed;
};

/* Share of a direction's light that arrives: 0, or the cosine. */
static double arriving(const struct receiver *at, struct vec towards, double distance)
{
    double cosine = dot(at->normal, towards);
    if (cosine <= 0 || dot(at->side, towards) <= 0)
        return 0;
    /* Starts at the ray's origin: aimed from the point itself, the ray could graze a lamp before
     * its end. */
    struct vec start = along(at->point, at->side, at->offset);
    struct vec path = sub(along(at->point, towards, distance), start);
    struct oracle_ray ray = {start, unit(path), length(path) * (1 - 1e-5), *at->seed};
    if (distance >= ORACLE_FAR) {
        ray.direction = towards;
        ray.longest = distance;
    }
    return oracle_rays_is_blocked(at->rays, &ray) ? 0 : cosine;
}

/* pbrt-v3: fourth power of the cosine's position between the edges. pbrt-v4: a smooth step. */
static double fall_off(const struct oracle_scene *scene, const SluicePbrtLight *light,
                       struct vec towards)
{
    double cosine = -dot(towards, vec_of(light->direction));
    double outer = cos((double)light->coneAngle * ORACLE_PI / 180);
    double inner =
        cos(((double)light->coneAngle - (double)light->coneDeltaAngle) * ORACLE_PI / 180);
    if (cosine <= outer)
        return 0;
    if (cosine >= inner)
        return 1;
    double x = (cosine - outer) / (inner - outer);
    return scene->info.version == 3 ? x * x * x * x : x * x * (3 - 2 * x);
}

bool oracle_sent(const struct oracle_scene *scene, uint32_t index, struct vec point,
                 struct vec *towards, double *distance, struct vec *color)
{
    const SluicePbrtLight *light = &scene->lights[index];
    *towards = vec_of(light->direction);
    *distance = ORACLE_FAR;
    *color = vec_of(light->color);
    if (light->kind == SLUICE_PBRT_LIGHT_DISTANT)
        return true;
    if (light->kind != SLUICE_PBRT_LIGHT_POINT && light->kind != SLUICE_PBRT_LIGHT_SPOT)
        return false;
    struct vec path = sub(vec_of(light->position), point);
    *distance = length(path);
    *towards = unit(path);
    *color = scale(*color, 1 / (*distance * *distance));
    if (light->kind == SLUICE_PBRT_LIGHT_SPOT)
        *color = scale(*color, fall_off(scene, light, *towards));
    return *distance > 0;
}

static const struct oracle_emitter *choose_emitter(const struct oracle_lights *lights,
                                                   double weight)
{
    size_t least = 0, most = lights->emitter_count;
    while (most - least > 1) {
        size_t middle = (least + most) / 2;
        if (lights->emitters[middle].weight_before <= weight)
            least = middle;
        else
            most = middle;
    }
    return &lights->emitters[least];
}

static struct vec from_emitters(const struct oracle_lights *lights, const struct receiver *at)
{
    if (!(lights->weight > 0))
        return vec(0, 0, 0);
    const struct oracle_emitter *e =
        choose_emitter(lights, oracle_random(at->seed) * lights->weight);
    const SluicePbrtLight *light = &lights->scene->lights[e->light];
    double root = sqrt(oracle_random(at->seed)), across = oracle_random(at->seed);
    struct vec target =
        add(e->corner, add(scale(e->side1, root * (1 - across)), scale(e->side2, root * across)));
    struct vec path = sub(target, at->point), towards = unit(path);
    double distance = length(path), cosine = -dot(e->outside, towards);
    cosine = light->isTwoSided ? fabs(cosine) : cosine;
    if (cosine <= 0 || distance <= 0)
        return vec(0, 0, 0);
    struct vec color = vec_of(light->color);
    double density = mean(color) / lights->weight; /* sampled points per area */
    double share = arriving(at, towards, distance) * cosine / (distance * distance * density);
    return scale(color, share / ORACLE_PI);
}

struct vec oracle_direct_light(const struct oracle_lights *lights, struct oracle_rays *rays,
                               const struct oracle_hit *hit, struct vec normal, struct vec side,
                               uint64_t *seed)
{
    struct receiver at = {rays, hit->position, normal, side, hit->offset, seed};
    struct vec sum = from_emitters(lights, &at);
    for (uint32_t i = 0; i < lights->scene->info.lightCount; i++) {
        struct vec towards, color;
        double distance;
        if (oracle_sent(lights->scene, i, at.point, &towards, &distance, &color) && mean(color) > 0)
            sum = along(sum, color, arriving(&at, towards, distance) / ORACLE_PI);
    }
    return sum;
}
