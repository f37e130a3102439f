#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <math.h>
#include <string.h>

#define MAX_LEVELS 8

enum outcome { STOP, LEAVE_OUT, KEEP };

static enum outcome leave_out(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place,
                              const char *why)
{
    slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, place, "%s: the shape is left out", why);
    return LEAVE_OUT;
}

static float degrees_of_turn(const struct slc_pbrt_parameters *parameters)
{
    float phi = slc_pbrt_get_float(parameters, "phimax", 360);
    return phi > 0 && phi < 360 ? phi : 360;
}

static enum outcome read_quadric(struct slc_pbrt_parser *parser, struct slc_pbrt_shape_entry *shape,
                                 const struct slc_pbrt_place *place)
{
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    float radius = slc_pbrt_get_float(parameters, "radius", 1);
    bool is_sphere = shape->kind == SLUICE_PBRT_SHAPE_SPHERE;
    if (!(radius > 0))
        return leave_out(parser, place, "the radius is not above 0");
    shape->data.quadric.radius = radius;
    shape->data.quadric.inner_radius = slc_pbrt_get_float(parameters, "innerradius", 0);
    shape->data.quadric.phi_max = degrees_of_turn(parameters);
    float z0 = slc_pbrt_get_float(parameters, "zmin", is_sphere ? -radius : -1);
    float z1 = slc_pbrt_get_float(parameters, "zmax", is_sphere ? radius : 1);
    if (shape->kind == SLUICE_PBRT_SHAPE_DISK)
        z0 = z1 = slc_pbrt_get_float(parameters, "height", 0);
    float least = z0 < z1 ? z0 : z1, most = z0 < z1 ? z1 : z0;
    if (is_sphere) {
        least = least < -radius ? -radius : least > radius ? radius : least;
        most = most > radius ? radius : most < -radius ? -radius : most;
    }
    shape->data.quadric.z_min = least;
    shape->data.quadric.z_max = most;
    if (!(shape->data.quadric.inner_radius >= 0) || !(shape->data.quadric.inner_radius < radius))
        return leave_out(parser, place, "the inner radius is not in 0 to radius");
    return KEEP;
}

static enum outcome read_plymesh(struct slc_pbrt_parser *parser, struct slc_pbrt_shape_entry *shape,
                                 const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    const char *file = slc_pbrt_get_string(&parser->parameters, "filename");
    uint32_t path;
    if (!file || !*file)
        return leave_out(parser, place, "no \"string filename\"");
    if (!slc_pbrt_intern_path(parser, file, &path))
        return STOP;
    struct slc_pbrt_meanings *meanings = slc_pbrt_meanings_of(parser, path);
    if (!meanings)
        return STOP;
    if (meanings->last[SLC_PBRT_PLY_PATH] == SLUICE_PBRT_NONE) {
        if (!slc_pbrt_grow(&scene->allocator, &scene->plys, &scene->ply_capacity,
                           scene->ply_count + 1, sizeof *scene->plys)) {
            slc_pbrt_out_of_memory(parser);
            return STOP;
        }
        scene->plys[scene->ply_count] = (struct slc_pbrt_ply_entry){.path = path};
        meanings->last[SLC_PBRT_PLY_PATH] = (uint32_t)scene->ply_count++;
    }
    shape->data.file.ply = meanings->last[SLC_PBRT_PLY_PATH];
    return KEEP;
}

/* Inline meshes */

static const struct slc_pbrt_parameter *find_points(const struct slc_pbrt_parameters *parameters,
                                                    const char *name)
{
    return slc_pbrt_find(parameters,
                         SLC_PBRT_TYPES(SLC_PBRT_POINT3) | SLC_PBRT_TYPES(SLC_PBRT_NORMAL), name);
}

/* Finds texture coordinates by all names and types. *width: numbers per element, 1 or 2. */
static const struct slc_pbrt_parameter *find_uvs(const struct slc_pbrt_parameters *parameters)
{
    static const char *const NAMES[] = {"uv", "st"};
    for (int i = 0; i < 2; i++) {
        const struct slc_pbrt_parameter *p = slc_pbrt_find(
            parameters, SLC_PBRT_TYPES(SLC_PBRT_POINT2) | SLC_PBRT_TYPES(SLC_PBRT_FLOAT), NAMES[i]);
        if (p)
            return p;
    }
    return NULL;
}

static struct slc_pbrt_span span_of(const struct slc_pbrt_parameter *p, size_t count)
{
    return p ? (struct slc_pbrt_span){p->value_offset, p->value_file, (uint32_t)count}
             : (struct slc_pbrt_span){0};
}

static bool add_spans(struct slc_pbrt_parser *parser, const struct slc_pbrt_span *spans)
{
    SluicePbrtScene *scene = parser->scene;
    if (!slc_pbrt_grow(&scene->allocator, &scene->spans, &scene->span_capacity,
                       scene->span_count + SLC_PBRT_SPAN_COUNT, sizeof *scene->spans) ||
        scene->span_count > UINT32_MAX - SLC_PBRT_SPAN_COUNT)
        return slc_pbrt_out_of_memory(parser);
    memcpy(scene->spans + scene->span_count, spans, SLC_PBRT_SPAN_COUNT * sizeof *spans);
    scene->span_count += SLC_PBRT_SPAN_COUNT;
    return true;
}

/* Returns the box around the transformed points. */
static SluicePbrtBounds bounds_of(const struct slc_pbrt_parser *parser,
                                  const struct slc_pbrt_parameter *points, size_t count)
{
    const union slc_pbrt_cell *cells = slc_pbrt_cells(&parser->parameters, points);
    SluicePbrtBounds bounds = slc_pbrt_no_bounds();
    for (size_t i = 0; i < count; i++) {
        double point[3] = {cells[3 * i].number, cells[3 * i + 1].number, cells[3 * i + 2].number};
        float out[3];
        slc_pbrt_apply_point(&parser->state.transform, point, point);
        for (int j = 0; j < 3; j++)
            out[j] = slc_pbrt_clamped_float(point[j]);
        slc_pbrt_add_point(&bounds, out);
    }
    return bounds;
}

static bool indices_are_below(const union slc_pbrt_cell *cells, size_t count, size_t limit)
{
    for (size_t i = 0; i < count; i++)
        if (cells[i].integer < 0 || (size_t)cells[i].integer >= limit)
            return false;
    return true;
}

/* Returns an attribute if its count fits the vertices; otherwise warns and returns NULL. */
static const struct slc_pbrt_parameter *with_count(struct slc_pbrt_parser *parser,
                                                   const struct slc_pbrt_parameter *p, size_t count,
                                                   const struct slc_pbrt_place *place,
                                                   const char *what)
{
    if (!p || p->count == count)
        return p;
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                 "the mesh has %zu numbers of %s where %zu belong: they are ignored", p->count,
                 what, count);
    return NULL;
}

static enum outcome read_mesh(struct slc_pbrt_parser *parser, struct slc_pbrt_shape_entry *shape,
                              const struct slc_pbrt_place *place)
{
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    const struct slc_pbrt_parameter *positions = find_points(parameters, "P");
    const struct slc_pbrt_parameter *indices =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_INTEGER), "indices");
    uint32_t corners = shape->kind == SLUICE_PBRT_SHAPE_BILINEAR ? 4 : 3;
    if (!positions)
        return leave_out(parser, place, "no \"point P\"");
    size_t vertices = positions->count / 3, index_count = indices ? indices->count : 0;
    if (!indices && (vertices != corners || shape->kind == SLUICE_PBRT_SHAPE_LOOP))
        return leave_out(parser, place, "no \"integer indices\"");
    if (!indices)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "no \"integer indices\": the vertices are taken in their order");
    if (index_count % corners)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "%zu indices: the last %zu are ignored", index_count, index_count % corners);
    index_count -= index_count % corners;
    if (indices && index_count == 0)
        return leave_out(parser, place, "no face");
    if (indices && !indices_are_below(slc_pbrt_cells(parameters, indices), index_count, vertices))
        return leave_out(parser, place, "an index is not in 0 to the number of vertices");
    const struct slc_pbrt_parameter *normals =
        with_count(parser, find_points(parameters, "N"), 3 * vertices, place, "N");
    const struct slc_pbrt_parameter *uvs =
        with_count(parser, find_uvs(parameters), 2 * vertices, place, "uv");
    struct slc_pbrt_span spans[SLC_PBRT_SPAN_COUNT] = {
        [SLC_PBRT_SPAN_POSITIONS] = span_of(positions, 3 * vertices),
        [SLC_PBRT_SPAN_INDICES] = span_of(indices, index_count),
        [SLC_PBRT_SPAN_NORMALS] = span_of(normals, 3 * vertices),
        [SLC_PBRT_SPAN_UVS] = span_of(uvs, 2 * vertices)};
    int32_t levels =
        slc_pbrt_get_integer(parameters, "levels", slc_pbrt_get_integer(parameters, "nlevels", 3));
    shape->data.mesh.levels = levels < 0 ? 0 : levels > MAX_LEVELS ? MAX_LEVELS : (uint32_t)levels;
    shape->data.mesh.spans = (uint32_t)parser->scene->span_count;
    shape->data.mesh.bounds = bounds_of(parser, positions, vertices);
    return add_spans(parser, spans) ? KEEP : STOP;
}

/* Every shape */

static enum outcome read_data(struct slc_pbrt_parser *parser, const char *type,
                              struct slc_pbrt_shape_entry *shape,
                              const struct slc_pbrt_place *place)
{
    static const struct {
        const char *type;
        enum outcome (*read)(struct slc_pbrt_parser *, struct slc_pbrt_shape_entry *,
                             const struct slc_pbrt_place *);
    } KINDS[] = {
        [SLUICE_PBRT_SHAPE_TRIANGLES] = {"trianglemesh", read_mesh},
        [SLUICE_PBRT_SHAPE_PLY] = {"plymesh", read_plymesh},
        [SLUICE_PBRT_SHAPE_SPHERE] = {"sphere", read_quadric},
        [SLUICE_PBRT_SHAPE_DISK] = {"disk", read_quadric},
        [SLUICE_PBRT_SHAPE_CYLINDER] = {"cylinder", read_quadric},
        [SLUICE_PBRT_SHAPE_LOOP] = {"loopsubdiv", read_mesh},
        [SLUICE_PBRT_SHAPE_BILINEAR] = {"bilinearmesh", read_mesh},
    };
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++)
        if (strcmp(type, KINDS[i].type) == 0) {
            shape->kind = (SluicePbrtShapeKind)i;
            return KINDS[i].read(parser, shape, place);
        }
    char key[80] = "shape ";
    strncat(key, type, sizeof key - strlen(key) - 1);
    return slc_pbrt_warn_once(parser, key, place,
                              "shapes of the type \"%s\" are not known: they are left out", key + 6)
               ? LEAVE_OUT
               : STOP;
}

/* Takes transform, material and lights of a shape from the graphics state. */
static bool read_surroundings(struct slc_pbrt_parser *parser, struct slc_pbrt_shape_entry *shape,
                              const struct slc_pbrt_place *place)
{
    const struct slc_pbrt_state *state = &parser->state;
    bool found;
    shape->place = *place;
    shape->object = parser->object;
    shape->area_light = state->area_light;
    shape->reverse_orientation = state->reverse_orientation;
    shape->alpha = (SluicePbrtValue){{1, 1, 1}, SLUICE_PBRT_NONE};
    slc_pbrt_to_floats(&state->transform, shape->transform);
    if (shape->object != SLUICE_PBRT_NONE && shape->area_light != SLUICE_PBRT_NONE) {
        shape->area_light = SLUICE_PBRT_NONE;
        if (!slc_pbrt_warn_once(parser, "area lights in objects", place,
                                "shapes of objects emit no light"))
            return false;
    }
    return slc_pbrt_read_value(parser, "alpha", true, &shape->alpha, &found) &&
           slc_pbrt_override_material(parser, state->material, &shape->material);
}

bool slc_pbrt_shape(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    struct slc_pbrt_shape_entry shape = {0};
    uint32_t type;
    bool found;
    char text[64] = "";
    if (!slc_pbrt_read_name(parser, "type of the shape", &type, &found) ||
        !slc_pbrt_read_parameters_for(parser, SLC_PBRT_TARGET_SHAPE))
        return false;
    if (!found)
        return true;
    strncat(text, slc_pbrt_name(&scene->names, type), sizeof text - 1);
    enum outcome outcome = read_data(parser, text, &shape, place);
    if (outcome != KEEP)
        return outcome == LEAVE_OUT;
    if (!read_surroundings(parser, &shape, place))
        return false;
    if (scene->shape_count >= scene->limits.maxShapeCount)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, place,
                             "%zu shapes: maxShapeCount", scene->shape_count);
    if (!slc_pbrt_grow(&scene->allocator, &scene->shapes, &scene->shape_capacity,
                       scene->shape_count + 1, sizeof *scene->shapes))
        return slc_pbrt_out_of_memory(parser);
    scene->shapes[scene->shape_count++] = shape;
    return true;
}
