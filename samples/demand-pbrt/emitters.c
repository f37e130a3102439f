#include "emitters.h"

#include <stdio.h>
#include <stdlib.h>

#include "transform.h"

struct list {
    const struct gpu *gpu;
    const struct scene *scene;
    struct table *table;
    double *weights; ///< owned; weights of the elements
    uint32_t count;
    double total;
};

static double mean_of(const float color[3])
{
    return ((double)color[0] + color[1] + color[2]) / 3.0;
}

/* Returns whether paths sample points on the shape. Shapes with alpha are left out, because points
 * that alpha cuts out emit nothing and sampling does not look alpha up. Their light counts where a
 * ray hits them. */
static bool is_listed(const struct scene *scene, const SluicePbrtShape *shape)
{
    return shape->areaLight != SLUICE_PBRT_NONE && shape->alpha.texture == SLUICE_PBRT_NONE &&
           (scene->info.version == 3 || shape->alpha.value[0] >= 1.0f) &&
           mean_of(scene_light(scene, shape->areaLight).color) > 0.0;
}

uint32_t emitters_place_flags(const struct scene *scene, const SluicePbrtShape *shape,
                              const float transform[12])
{
    uint32_t flags = 0;
    if (shape->reverseOrientation && scene->info.version == 4) /* pbrt-v3 does not negate them */
        flags |= PBRT_PLACE_NEGATED;
    if (shape->reverseOrientation != (transform_determinant(transform) < 0.0))
        flags |= PBRT_PLACE_REVERSED;
    if (shape->areaLight == SLUICE_PBRT_NONE)
        return flags;
    if (scene_light(scene, shape->areaLight).isTwoSided)
        flags |= PBRT_PLACE_TWO_SIDED;
    return flags | PBRT_PLACE_EMITS | (is_listed(scene, shape) ? PBRT_PLACE_LISTED : 0);
}

static void cross(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const float a[3], const float b[3])
{
    return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

/* Returns the side that emits, as in shaders/hit.glsl. If the file has normals, they choose the
 * side. */
static bool is_turned(const SluicePbrtMesh *mesh, const uint32_t corners[3], uint32_t flags,
                      const float inverse[12], const float face[3])
{
    float n[3] = {0}, normal[3];
    bool reversed = flags & PBRT_PLACE_REVERSED;
    if (!mesh->pNormals)
        return reversed;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            n[j] += mesh->pNormals[3 * (size_t)corners[i] + j];
    for (int i = 0; i < 3; i++) /* multiply by the transposed inverse */
        normal[i] = n[0] * inverse[i] + n[1] * inverse[4 + i] + n[2] * inverse[8 + i];
    double side = dot(normal, face) * (flags & PBRT_PLACE_NEGATED ? -1.0 : 1.0);
    return side == 0.0 ? reversed : side < 0.0;
}

static bool add_triangle(struct list *list, const SluicePbrtShape *shape,
                         const SluicePbrtMesh *mesh, uint32_t triangle, const float inverse[12])
{
    const uint32_t *corners = mesh->pIndices + 3 * (size_t)triangle;
    const SluicePbrtLight light = scene_light(list->scene, shape->areaLight);
    struct PbrtEmitter e = {.light = shape->areaLight, .isTwoSided = light.isTwoSided};
    float p[3][3], face[3];
    for (int i = 0; i < 3; i++)
        transform_point(shape->transform, mesh->pPositions + 3 * (size_t)corners[i], p[i]);
    for (int i = 0; i < 3; i++) {
        e.corner[i] = p[0][i];
        e.side1[i] = p[1][i] - p[0][i];
        e.side2[i] = p[2][i] - p[0][i];
    }
    cross(e.side1, e.side2, face);
    const double doubled = sqrt(dot(face, face));
    if (!(doubled > 0.0))
        return true;
    const uint32_t flags = emitters_place_flags(list->scene, shape, shape->transform);
    const double sign = is_turned(mesh, corners, flags, inverse, face) ? -1.0 : 1.0;
    for (int i = 0; i < 3; i++)
        e.outside[i] = (float)(sign * face[i] / doubled);
    if (!table_grow(list->gpu, list->table, list->count + 1))
        return false;
    *(struct PbrtEmitter *)table_at(list->table, list->count) = e;
    list->weights[list->count++] = 0.5 * doubled * mean_of(light.color);
    list->total += 0.5 * doubled * mean_of(light.color);
    return true;
}

static bool add_shape(struct list *list, uint32_t index)
{
    const SluicePbrtShape shape = scene_shape(list->scene, index);
    SluicePbrtMesh mesh = {.structSize = sizeof mesh};
    float inverse[12];
    if (scene_box_is_empty(&list->scene->boxes[index]) || !is_listed(list->scene, &shape) ||
        !transform_invert(shape.transform, inverse) ||
        sluiceReadPbrtShape(list->scene->pbrt, index, &mesh) != SLUICE_SUCCESS)
        return true; /* no error: paths do not sample it, or the log has the cause */
    double *more =
        realloc(list->weights, ((size_t)list->count + mesh.triangleCount + 1) * sizeof *more);
    bool done = more != NULL;
    if (done)
        list->weights = more;
    else
        fprintf(stderr, "out of memory\n");
    for (uint32_t i = 0; i < mesh.triangleCount && done; i++)
        done = add_triangle(list, &shape, &mesh, i, inverse);
    (void)sluiceFreePbrtMesh(list->scene->pbrt, &mesh);
    return done;
}

bool emitters_create(const struct gpu *gpu, const struct scene *scene, bool are_read,
                     struct table *lights, struct table *emitters)
{
    struct list list = {.gpu = gpu, .scene = scene, .table = emitters};
    *emitters = (struct table){.element = sizeof(struct PbrtEmitter)};
    bool done = table_grow(gpu, emitters, 1);
    emitters->count = 0;
    for (uint32_t i = 0; i < scene->info.shapeCount && are_read && done; i++)
        done = add_shape(&list, i);
    double below = 0.0;
    for (uint32_t i = 0; i < list.count; i++) {
        struct PbrtEmitter *e = table_at(emitters, i);
        struct PbrtLight *light = table_at(lights, e->light);
        e->below = (float)(below / list.total);
        light->density = (float)(mean_of(light->color) / list.total);
        below += list.weights[i];
    }
    free(list.weights);
    return done;
}
