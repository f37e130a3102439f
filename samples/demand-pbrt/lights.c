#include "lights.h"

#include <math.h>
#include <string.h>

#include "transform.h"

static float cos_degrees(float degrees)
{
    return cosf(degrees * 3.14159265358979f / 180.0f);
}

static uint32_t add_sky(const SluicePbrtLight *light, struct textures *textures)
{
    const SluicePbrtTexture texture = {.pFile = light->pFile,
                                       .line = light->line,
                                       .pName = "sky",
                                       .pImagePath = light->pImagePath,
                                       .wrap = light->layout == SLUICE_PBRT_SKY_EQUAL_AREA
                                                   ? SLUICE_PBRT_WRAP_CLAMP
                                                   : SLUICE_PBRT_WRAP_REPEAT,
                                       .filter = SLUICE_PBRT_FILTER_TRILINEAR};
    const struct picture_use *use = textures_find(textures, &texture);
    return use ? (uint32_t)use->id : PBRT_NONE;
}

static void fill_light(const SluicePbrtLight *light, struct textures *textures,
                       struct PbrtLight *out)
{
    *out = (struct PbrtLight){.kind = light->kind,
                              .texture = PBRT_NONE,
                              .skyLayout = light->layout,
                              .cosInner = cos_degrees(light->coneAngle - light->coneDeltaAngle),
                              .cosOuter = cos_degrees(light->coneAngle)};
    memcpy(out->color, light->color, sizeof out->color);
    memcpy(out->position, light->position, sizeof out->position);
    memcpy(out->direction, light->direction, sizeof out->direction);
    if (light->kind != SLUICE_PBRT_LIGHT_INFINITE)
        return;
    if (!transform_invert(light->lightToWorld, out->worldToLight))
        out->worldToLight[0] = out->worldToLight[5] = out->worldToLight[10] = 1.0f;
    if (light->pImagePath)
        out->texture = add_sky(light, textures);
}

bool lights_create(const struct gpu *gpu, const struct scene *scene, struct textures *textures,
                   struct table *table, bool *only_areas)
{
    const uint32_t count = scene->info.lightCount;
    *table = (struct table){.element = sizeof(struct PbrtLight)};
    *only_areas = true;
    if (!table_grow(gpu, table, count + 1))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const SluicePbrtLight light = scene_light(scene, i);
        fill_light(&light, textures, table_at(table, i));
        *only_areas = *only_areas && light.kind == SLUICE_PBRT_LIGHT_AREA;
    }
    return true;
}

static bool is_sky_dark(const struct scene *scene, const float background[3])
{
    if (background[0] + background[1] + background[2] > 0.0f)
        return false;
    for (uint32_t i = 0; i < scene->info.lightCount; i++)
        if (scene_light(scene, i).kind == SLUICE_PBRT_LIGHT_INFINITE)
            return false;
    return true;
}

void lights_constants(const struct scene *scene, const struct pbrt_options *o, bool only_areas,
                      uint32_t emitter_count, struct PbrtLaunch *c)
{
    memcpy(c->background, o->background, sizeof c->background);
    c->mode = (uint32_t)o->mode;
    c->bounces = o->bounces;
    c->lightCount = scene->info.lightCount;
    c->emitterCount = emitter_count;
    c->flags |= (o->face_forward ? PBRT_LAUNCH_FACE_FORWARD : 0) |
                (scene->info.version == 4 ? PBRT_LAUNCH_VERSION_4 : 0) |
                (only_areas ? PBRT_LAUNCH_HEADLIGHT : 0) |
                (is_sky_dark(scene, o->background) ? PBRT_LAUNCH_DARK_SKY : 0);
}
