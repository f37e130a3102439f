#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <math.h>
#include <string.h>

#define MAX_LIGHTS ((size_t)1 << 24)

static bool add_light(struct slc_pbrt_parser *parser, const struct slc_pbrt_light_entry *entry)
{
    SluicePbrtScene *scene = parser->scene;
    if (scene->light_count >= MAX_LIGHTS)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, &entry->place, "2^24 lights");
    if (!slc_pbrt_grow(&scene->allocator, &scene->lights, &scene->light_capacity,
                       scene->light_count + 1, sizeof *scene->lights))
        return slc_pbrt_out_of_memory(parser);
    scene->lights[scene->light_count++] = *entry;
    return true;
}

/* Reads a color parameter, times its scale parameters. False: stop. */
static bool read_radiance(struct slc_pbrt_parser *parser, const char *name, float color[3])
{
    float scale[3];
    color[0] = color[1] = color[2] = 1;
    slc_pbrt_read_color(parser, name, color, true);
    float factor = slc_pbrt_get_float(&parser->parameters, "scale", 1);
    if (!slc_pbrt_read_color(parser, "scale", scale, true))
        scale[0] = scale[1] = scale[2] = factor;
    for (int i = 0; i < 3; i++)
        color[i] *= scale[i];
    return parser->result == SLUICE_SUCCESS;
}

/* Sets *direction to the transformed unit vector from a to b; unchanged if its length is 0. */
static void set_direction(const struct slc_pbrt_affine *transform, const double a[3],
                          const double b[3], float direction[3])
{
    double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    slc_pbrt_apply_vector(transform, d, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3 && length > 0; i++)
        direction[i] = (float)(d[i] / length);
}

static void set_position(const struct slc_pbrt_affine *transform, const double point[3],
                         float position[3])
{
    double p[3];
    slc_pbrt_apply_point(transform, point, p);
    for (int i = 0; i < 3; i++)
        position[i] = slc_pbrt_clamped_float(p[i]);
}

static bool read_sky(struct slc_pbrt_parser *parser, struct slc_pbrt_light_entry *entry,
                     const struct slc_pbrt_place *place)
{
    SluicePbrtLight *light = &entry->light;
    const char *map = slc_pbrt_get_string(&parser->parameters, "mapname");
    struct slc_pbrt_stamp stamp;
    if (!map) {
        map = slc_pbrt_get_string(&parser->parameters, "filename");
        light->layout = SLUICE_PBRT_SKY_EQUAL_AREA;
    }
    if (!map)
        return true;
    if (!slc_pbrt_intern_path(parser, map, &entry->image))
        return false;
    const char *path = slc_pbrt_name(&parser->scene->names, entry->image);
    if (slc_pbrt_stamp_of(path, &stamp))
        return true;
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                 "%s: no such picture; the light has one color", path);
    entry->image = SLUICE_PBRT_NONE;
    return true;
}

static bool read_light(struct slc_pbrt_parser *parser, const char *type,
                       struct slc_pbrt_light_entry *entry, const struct slc_pbrt_place *place,
                       bool *is_known)
{
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    const struct slc_pbrt_affine *transform = &parser->state.transform;
    SluicePbrtLight *light = &entry->light;
    double from[3] = {0, 0, 0}, to[3] = {0, 0, 1};
    slc_pbrt_get_point(parameters, "from", from);
    slc_pbrt_get_point(parameters, "to", to);
    slc_pbrt_to_floats(transform, light->lightToWorld);
    set_position(transform, from, light->position);
    light->direction[2] = 1;
    *is_known = true;
    if (strcmp(type, "distant") == 0) {
        light->kind = SLUICE_PBRT_LIGHT_DISTANT;
        set_direction(transform, to, from, light->direction);
        return read_radiance(parser, "L", light->color);
    }
    if (strcmp(type, "infinite") == 0 || strcmp(type, "exinfinite") == 0) {
        light->kind = SLUICE_PBRT_LIGHT_INFINITE;
        return read_radiance(parser, "L", light->color) && read_sky(parser, entry, place);
    }
    if (strcmp(type, "spot") == 0) {
        light->kind = SLUICE_PBRT_LIGHT_SPOT;
        set_direction(transform, from, to, light->direction);
        light->coneAngle = slc_pbrt_get_float(parameters, "coneangle", 30);
        light->coneDeltaAngle = slc_pbrt_get_float(parameters, "conedeltaangle", 5);
        return read_radiance(parser, "I", light->color);
    }
    if (strcmp(type, "goniometric") == 0 || strcmp(type, "projection") == 0) {
        light->kind = SLUICE_PBRT_LIGHT_POINT;
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "%s lights are taken as point lights", type);
        return read_radiance(parser, "I", light->color);
    }
    light->kind = SLUICE_PBRT_LIGHT_POINT;
    *is_known = strcmp(type, "point") == 0;
    return read_radiance(parser, "I", light->color);
}

bool slc_pbrt_light_source(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_light_entry entry = {.place = *place, .image = SLUICE_PBRT_NONE};
    uint32_t type;
    bool found, is_known;
    char text[64] = "";
    if (!slc_pbrt_read_name(parser, "type of the light", &type, &found) ||
        !slc_pbrt_read_parameters_for(parser, SLC_PBRT_TARGET_LIGHT))
        return false;
    if (!found)
        return true;
    strncat(text, slc_pbrt_name(&parser->scene->names, type), sizeof text - 1);
    if (!read_light(parser, text, &entry, place, &is_known))
        return false;
    if (is_known)
        return add_light(parser, &entry);
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                 "lights of the type \"%s\" are not known: left out", text);
    return true;
}

bool slc_pbrt_area_light_source(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_light_entry entry = {.place = *place, .image = SLUICE_PBRT_NONE};
    uint32_t type;
    bool found;
    if (!slc_pbrt_read_name(parser, "type of the light", &type, &found) ||
        !slc_pbrt_read_parameters_for(parser, SLC_PBRT_TARGET_LIGHT))
        return false;
    if (!found)
        return true;
    entry.light.kind = SLUICE_PBRT_LIGHT_AREA;
    entry.light.isTwoSided = slc_pbrt_get_bool(&parser->parameters, "twosided", false);
    slc_pbrt_to_floats(&parser->state.transform, entry.light.lightToWorld);
    const char *text = slc_pbrt_name(&parser->scene->names, type);
    if (strcmp(text, "diffuse") != 0 && strcmp(text, "area") != 0) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "area lights of the type \"%s\" are not known: left out", text);
        return true;
    }
    if (!read_radiance(parser, "L", entry.light.color) || !add_light(parser, &entry))
        return false;
    parser->state.area_light = (uint32_t)parser->scene->light_count - 1;
    return true;
}
