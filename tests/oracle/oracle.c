#include "oracle/oracle.h"

#include "oracle/random.h"

#include <string.h>

/* Makes what pictures need beyond hits. */
static bool init_tracer(struct oracle *o)
{
    const struct oracle_settings *s = &o->settings;
    struct vec background = vec_of(s->background);
    o->tracer = (struct oracle_tracer){.scene = &o->scene,
                                       .rays = o->rays,
                                       .values = &o->values,
                                       .mean_sky = background,
                                       .bounces = s->mode == ORACLE_DIRECT ? 0 : s->bounces,
                                       .face_forward = s->face_forward};
    if (s->mode == ORACLE_PRIMARY)
        for (uint32_t i = 0; i < o->scene.info.lightCount; i++)
            if (o->scene.lights[i].kind == SLUICE_PBRT_LIGHT_INFINITE)
                o->tracer.mean_sky = add(o->tracer.mean_sky, oracle_mean_sky(&o->values, i));
    return oracle_lights_create(&o->tracer.lights, &o->scene, &o->values, background);
}

bool oracle_init(struct oracle *o, const char *path, const struct oracle_settings *settings)
{
    *o = (struct oracle){.settings = *settings};
    if (!oracle_scene_load(&o->scene, path, settings->is_quiet) ||
        !oracle_values_create(&o->values, &o->scene))
        return false;
    o->values.nearest = settings->nearest;
    oracle_camera_init(&o->camera, &o->scene.info, settings->dim);
    o->rays = oracle_rays_create(&o->scene, &o->values);
    return o->rays && init_tracer(o);
}

void oracle_finish(struct oracle *o)
{
    oracle_lights_finish(&o->tracer.lights);
    oracle_rays_destroy(o->rays);
    oracle_values_finish(&o->values);
    oracle_scene_finish(&o->scene);
    *o = (struct oracle){0};
}

static uint64_t seed_of(const struct oracle *o, uint32_t x, uint32_t y, uint32_t sample)
{
    uint64_t pixel = (uint64_t)y * o->camera.width + x;
    return ((uint64_t)o->settings.seed << 48) + pixel * 0x2545f4914f6cdd1du +
           (uint64_t)sample * 7919;
}

static struct vec render_sample(const struct oracle *o, uint32_t x, uint32_t y, uint32_t sample)
{
    uint64_t seed = seed_of(o, x, y, sample);
    double dx = 0.5, dy = 0.5;
    if (sample > 0) {
        dx = oracle_random(&seed);
        dy = oracle_random(&seed);
    }
    struct oracle_ray ray = oracle_camera_ray(&o->camera, x + dx, y + dy);
    ray.seed = seed;
    if (o->settings.mode == ORACLE_PRIMARY)
        return oracle_preview(&o->tracer, &ray, &seed);
    return oracle_radiance(&o->tracer, ray, &seed);
}

void oracle_render(const struct oracle *o, float *rgba)
{
    uint32_t samples = o->settings.samples ? o->settings.samples : 1;
    for (uint32_t y = 0; y < o->camera.height; y++)
        for (uint32_t x = 0; x < o->camera.width; x++) {
            struct vec sum = vec(0, 0, 0);
            for (uint32_t i = 0; i < samples; i++)
                sum = add(sum, render_sample(o, x, y, i));
            sum = scale(sum, 1.0 / samples);
            const float pixel[4] = {(float)sum.x, (float)sum.y, (float)sum.z, 1};
            memcpy(rgba + 4 * ((size_t)y * o->camera.width + x), pixel, sizeof pixel);
        }
}

static void write_hit(const struct oracle *o, FILE *file, uint32_t x, uint32_t y,
                      const struct oracle_hit *hit)
{
    if (!hit) {
        fprintf(file, "%u\t%u\t-1\n", x, y);
        return;
    }
    const struct oracle_place *place = &o->scene.places[hit->place];
    fprintf(file, "%u\t%u\t%u\t%d\t%u\t%.7g\t%.6f %.6f\t%.6f %.6f %.6f\t%.6f %.6f\n", x, y,
            place->shape, place->instance == SLUICE_PBRT_NONE ? -1 : (int)place->instance,
            hit->triangle, hit->t, hit->b1, hit->b2, hit->shading.x, hit->shading.y, hit->shading.z,
            hit->point.u, hit->point.v);
}

bool oracle_cast(struct oracle *o, struct oracle_census *census, struct oracle_tiles *tiles,
                 FILE *hits)
{
    bool ok = true;
    if (hits)
        fputs("x\ty\tshape\tinstance\ttriangle\tt\tbarycentrics\tnormal\tuv\n", hits);
    for (uint32_t y = 0; y < o->camera.height; y++)
        for (uint32_t x = 0; x < o->camera.width; x++) {
            struct oracle_ray ray = oracle_camera_ray(&o->camera, x + 0.5, y + 0.5);
            struct oracle_hit hit;
            ray.seed = seed_of(o, x, y, 0);
            bool is_hit = oracle_rays_trace(o->rays, &ray, &hit);
            oracle_census_add(census, &o->scene, &ray, is_hit ? &hit : NULL);
            if (hits)
                write_hit(o, hits, x, y, is_hit ? &hit : NULL);
            if (tiles && is_hit)
                ok = ok && oracle_tiles_add(tiles, &ray, &hit);
        }
    return ok;
}
