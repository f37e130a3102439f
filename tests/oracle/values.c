#include "oracle/values.h"

#include <stdio.h>
#include <stdlib.h>

bool oracle_values_create(struct oracle_values *values, const struct oracle_scene *scene)
{
    size_t count = (size_t)scene->info.textureCount + scene->info.lightCount + 1;
    *values = (struct oracle_values){.scene = scene,
                                     .pictures = calloc(count, sizeof *values->pictures),
                                     .states = calloc(count, sizeof *values->states)};
    return values->pictures && values->states;
}

void oracle_values_finish(struct oracle_values *values)
{
    if (values->pictures)
        for (size_t i = 0;
             i < (size_t)values->scene->info.textureCount + values->scene->info.lightCount; i++)
            oracle_picture_finish(&values->pictures[i]);
    free(values->pictures);
    free(values->states);
    *values = (struct oracle_values){0};
}

static const struct oracle_picture *picture_at(struct oracle_values *values, size_t index,
                                               const char *path)
{
    if (values->states[index] == 0)
        values->states[index] = oracle_picture_read(&values->pictures[index], path) ? 1 : 2;
    return values->states[index] == 1 ? &values->pictures[index] : NULL;
}

void oracle_map(const SluicePbrtTexture *t, const struct oracle_point *point, double *s, double *r)
{
    double m[12];
    matrix_of(t->worldToTexture, m);
    if (t->mapping == SLUICE_PBRT_MAPPING_UV) {
        *s = t->scale[0] * point->u + t->delta[0];
        *r = t->scale[1] * point->v + t->delta[1];
        return;
    }
    struct vec p = apply_point(m, point->world);
    if (t->mapping == SLUICE_PBRT_MAPPING_PLANAR) {
        *s = dot(p, vec_of(t->axes)) + t->delta[0];
        *r = dot(p, vec_of(t->axes + 3)) + t->delta[1];
        return;
    }
    double turn = atan2(p.y, p.x) / (2 * ORACLE_PI);
    turn += turn < 0 ? 1 : 0;
    *s = t->mapping == SLUICE_PBRT_MAPPING_SPHERICAL ? acos(unit(p).z) / ORACLE_PI : turn;
    *r = t->mapping == SLUICE_PBRT_MAPPING_SPHERICAL ? turn : p.z;
}

/* A color, or a number three times. */
static struct vec constant(const float value[3], bool is_float)
{
    return is_float ? vec(value[0], value[0], value[0]) : vec_of(value);
}

static struct vec sample_image(struct oracle_values *values, uint32_t index, double s, double t,
                               double *alpha)
{
    const SluicePbrtTexture *texture = &values->scene->textures[index];
    const struct oracle_picture *picture = picture_at(values, index, texture->pImagePath);
    struct oracle_lookup lookup = {texture->wrap, texture->encoding, texture->gamma,
                                   values->nearest || texture->filter == SLUICE_PBRT_FILTER_POINT};
    if (!picture)
        return constant(texture->value, texture->isFloat);
    struct vec color = oracle_picture_sample(picture, &lookup, s, 1 - t, alpha);
    if (!picture->has_alpha)
        *alpha = -1;
    if (texture->invert)
        color = sub(vec(1, 1, 1), color);
    return scale(color, texture->imageScale);
}

/* Inputs of a number are numbers. */
static struct vec sample_input(struct oracle_values *values, bool is_float,
                               const SluicePbrtValue *input, const struct oracle_point *point)
{
    if (!is_float)
        return oracle_value(values, input, point);
    double x = oracle_number(values, input, point);
    return vec(x, x, x);
}

/* Returns the color of a texture, and the alpha of its picture in `*alpha`, or -1 if it has
 * none. */
static struct vec sample(struct oracle_values *values, uint32_t index,
                         const struct oracle_point *point, double *alpha)
{
    const SluicePbrtTexture *texture = &values->scene->textures[index];
    bool is_float = texture->isFloat;
    double s, t;
    oracle_map(texture, point, &s, &t);
    *alpha = -1;
    switch (texture->kind) {
    case SLUICE_PBRT_TEXTURE_IMAGE: return sample_image(values, index, s, t, alpha);
    case SLUICE_PBRT_TEXTURE_CHECKERBOARD:
        return sample_input(values, is_float,
                            &texture->inputs[((long)floor(s) + (long)floor(t)) & 1], point);
    case SLUICE_PBRT_TEXTURE_SCALE:
        return mul(sample_input(values, is_float, &texture->inputs[0], point),
                   sample_input(values, is_float, &texture->inputs[1], point));
    case SLUICE_PBRT_TEXTURE_MIX: {
        double amount = oracle_number(values, &texture->amount, point);
        return add(scale(sample_input(values, is_float, &texture->inputs[0], point), 1 - amount),
                   scale(sample_input(values, is_float, &texture->inputs[1], point), amount));
    }
    default: return constant(texture->value, is_float);
    }
}

struct vec oracle_value(struct oracle_values *values, const SluicePbrtValue *value,
                        const struct oracle_point *point)
{
    double alpha;
    if (value->texture == SLUICE_PBRT_NONE)
        return vec_of(value->value);
    return sample(values, value->texture, point, &alpha);
}

double oracle_number(struct oracle_values *values, const SluicePbrtValue *value,
                     const struct oracle_point *point)
{
    double alpha;
    if (value->texture == SLUICE_PBRT_NONE)
        return value->value[0];
    struct vec color = sample(values, value->texture, point, &alpha);
    if (values->scene->info.version == 4)
        return alpha >= 0 ? alpha : mean(color);
    return luminance(color);
}

/* Clarberg's equal-area map of the sphere, as pbrt-v4 has it. */
static void equal_area(struct vec d, double *u, double *v)
{
    double x = fabs(d.x), y = fabs(d.y), radius = sqrt(fmax(0, 1 - fabs(d.z)));
    double most = fmax(x, y), least = fmin(x, y);
    double phi = atan(most > 0 ? least / most : 0) * 2 / ORACLE_PI;
    phi = x < y ? 1 - phi : phi;
    double b = phi * radius, a = radius - b;
    if (d.z < 0) {
        double swapped = a;
        a = 1 - b;
        b = 1 - swapped;
    }
    *u = (copysign(a, d.x) + 1) / 2;
    *v = (copysign(b, d.y) + 1) / 2;
}

struct vec oracle_sky(struct oracle_values *values, uint32_t index, struct vec direction)
{
    const SluicePbrtLight *light = &values->scene->lights[index];
    struct oracle_lookup lookup = {.wrap = SLUICE_PBRT_WRAP_CLAMP};
    double m[12], u, v, alpha;
    if (!light->pImagePath)
        return vec_of(light->color);
    const struct oracle_picture *picture =
        picture_at(values, values->scene->info.textureCount + index, light->pImagePath);
    if (!picture)
        return vec_of(light->color);
    matrix_of(light->lightToWorld, m);
    struct vec d = unit(apply_inverse_vector(m, direction));
    if (light->layout == SLUICE_PBRT_SKY_EQUAL_AREA) {
        equal_area(d, &u, &v);
    } else {
        lookup.wrap = SLUICE_PBRT_WRAP_REPEAT;
        u = atan2(d.y, d.x) / (2 * ORACLE_PI);
        v = acos(fmax(-1, fmin(1, d.z))) / ORACLE_PI;
    }
    return mul(vec_of(light->color), oracle_picture_sample(picture, &lookup, u, v, &alpha));
}

struct vec oracle_mean_sky(struct oracle_values *values, uint32_t index)
{
    const SluicePbrtLight *light = &values->scene->lights[index];
    const struct oracle_lookup lookup = {.wrap = SLUICE_PBRT_WRAP_CLAMP, .nearest = true};
    const struct oracle_picture *picture = NULL;
    struct vec sum = vec(0, 0, 0);
    double alpha;
    if (light->pImagePath)
        picture = picture_at(values, values->scene->info.textureCount + index, light->pImagePath);
    if (!picture)
        return vec_of(light->color);
    for (uint32_t y = 0; y < picture->height; y++)
        for (uint32_t x = 0; x < picture->width; x++)
            sum = add(sum, oracle_picture_sample(picture, &lookup, (x + 0.5) / picture->width,
                                                 (y + 0.5) / picture->height, &alpha));
    return mul(vec_of(light->color), scale(sum, 1.0 / picture->width / picture->height));
}
