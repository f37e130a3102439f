#include "oracle/rays.h"

#include "oracle/embree.h"
#include "oracle/random.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

struct oracle_rays {
    const struct oracle_scene *scene;
    struct oracle_values *values;
    RTCDevice device;
    RTCScene top;
    RTCScene *meshes; ///< owned; a scene of one mesh each
};

/* Embree hands the context of a ray to the filter. The library's part comes first. */
struct context {
    oracle_context embree;
    struct oracle_rays *rays;
    const struct oracle_ray *ray;
};

/* Points of surfaces */

static struct vec blend(const float *array, const uint32_t *corners, const struct oracle_hit *hit)
{
    struct vec a = vec_of(array + 3 * (size_t)corners[0]);
    struct vec b = vec_of(array + 3 * (size_t)corners[1]);
    struct vec c = vec_of(array + 3 * (size_t)corners[2]);
    return add(scale(a, 1 - hit->b1 - hit->b2), add(scale(b, hit->b1), scale(c, hit->b2)));
}

static void find_uv(const SluicePbrtMesh *mesh, const uint32_t *corners, struct oracle_hit *hit)
{
    double b[3] = {1 - hit->b1 - hit->b2, hit->b1, hit->b2};
    hit->point.u = hit->b1 + hit->b2; /* corners (0, 0), (1, 0), (1, 1) */
    hit->point.v = hit->b2;
    if (!mesh->pUvs)
        return;
    hit->point.u = hit->point.v = 0;
    for (int i = 0; i < 3; i++) {
        hit->point.u += b[i] * (double)mesh->pUvs[2 * (size_t)corners[i]];
        hit->point.v += b[i] * (double)mesh->pUvs[2 * (size_t)corners[i] + 1];
    }
}

static double greatest(struct vec v)
{
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
}

/* Embree computes with floats: its errors grow with coordinates, distances and triangles. */
static double find_offset(const double m[12], const struct vec corners[3],
                          const struct oracle_hit *hit)
{
    double size = greatest(hit->position) + hit->t;
    for (int i = 0; i < 3; i++)
        size = fmax(size, greatest(sub(apply_point(m, corners[i]), hit->position)));
    return 4e-6 * size;
}

void oracle_find_point(const struct oracle_scene *scene, struct oracle_hit *hit)
{
    const struct oracle_place *place = &scene->places[hit->place];
    const SluicePbrtShape *shape = &scene->shapes[place->shape];
    const SluicePbrtMesh *mesh = &scene->meshes[place->mesh];
    const uint32_t *corners = &mesh->pIndices[3 * (size_t)hit->triangle];
    struct vec p[3];
    oracle_corners(mesh, hit->triangle, p);
    struct vec outside = cross(sub(p[1], p[0]), sub(p[2], p[0]));
    if (shape->reverseOrientation)
        outside = scale(outside, -1);
    hit->position = apply_point(place->transform, blend(mesh->pPositions, corners, hit));
    hit->geometric = unit(apply_normal(place->transform, outside));
    hit->shading = hit->geometric;
    if (mesh->pNormals) {
        bool is_quadric =
            shape->kind >= SLUICE_PBRT_SHAPE_SPHERE && shape->kind <= SLUICE_PBRT_SHAPE_CYLINDER;
        struct vec n = blend(mesh->pNormals, corners, hit);
        n = unit(apply_normal(place->transform, n));
        if (shape->reverseOrientation && (is_quadric || scene->info.version == 4))
            n = scale(n, -1);
        if (dot(n, n) > 0.5) {
            hit->shading = n;
            hit->geometric = turn_to(hit->geometric, n);
        }
    }
    find_uv(mesh, corners, hit);
    hit->point.world = hit->position;
    hit->offset = find_offset(place->transform, p, hit);
}

/* Alpha */

/* The share of rays that a surface stops at a point. */
static double find_cover(struct oracle_rays *rays, const struct oracle_hit *hit)
{
    const SluicePbrtShape *shape = &rays->scene->shapes[rays->scene->places[hit->place].shape];
    const SluicePbrtMaterial *material = &rays->scene->materials[shape->material];
    if (material->kind == SLUICE_PBRT_MATERIAL_NONE && shape->areaLight == SLUICE_PBRT_NONE)
        return 0;
    double alpha = oracle_number(rays->values, &shape->alpha, &hit->point);
    if (rays->scene->info.version == 3)
        alpha = alpha == 0 ? 0 : 1;
    return alpha * fmin(1, mean(oracle_value(rays->values, &material->opacity, &hit->point)));
}

static bool is_plain(const struct oracle_rays *rays, const SluicePbrtShape *shape)
{
    const SluicePbrtMaterial *material = &rays->scene->materials[shape->material];
    const float *opacity = material->opacity.value;
    return shape->alpha.texture == SLUICE_PBRT_NONE && shape->alpha.value[0] >= 1 &&
           material->opacity.texture == SLUICE_PBRT_NONE && opacity[0] >= 1 && opacity[1] >= 1 &&
           opacity[2] >= 1 && material->kind != SLUICE_PBRT_MATERIAL_NONE;
}

/* Rejects candidates that alpha cuts out. Rays come one at a time. */
static void filter(const struct RTCFilterFunctionNArguments *arguments)
{
    const struct context *context = (const struct context *)arguments->context;
    const struct RTCHit *candidate = (const struct RTCHit *)arguments->hit;
    struct oracle_rays *rays = context->rays;
    struct oracle_hit hit = {.place = candidate->instID[0],
                             .triangle = candidate->primID,
                             .b1 = candidate->u,
                             .b2 = candidate->v};
    assert(arguments->N == 1);
    if (is_plain(rays, &rays->scene->shapes[rays->scene->places[hit.place].shape]))
        return;
    oracle_find_point(rays->scene, &hit);
    double cover = find_cover(rays, &hit);
    uint64_t seed = context->ray->seed ^ (uint64_t)hit.place << 32 ^ hit.triangle;
    if (cover <= 0 || (cover < 1 && oracle_random(&seed) >= cover))
        arguments->valid[0] = 0;
}

/* Scenes of Embree */

static RTCScene make_mesh(const struct oracle_rays *rays, const SluicePbrtMesh *mesh)
{
    RTCScene scene = rtcNewScene(rays->device);
    RTCGeometry geometry = rtcNewGeometry(rays->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                               RTC_FORMAT_FLOAT3, 12, mesh->vertexCount);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT3, 12, mesh->triangleCount);
    for (size_t i = 0; positions && i < 3 * (size_t)mesh->vertexCount; i++)
        positions[i] = mesh->pPositions[i];
    for (size_t i = 0; indices && i < 3 * (size_t)mesh->triangleCount; i++)
        indices[i] = mesh->pIndices[i];
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
    return scene;
}

/* Instances have the indices of places as their ids. Flat ones cannot be hit. */
static void add_place(struct oracle_rays *rays, size_t index)
{
    const struct oracle_place *place = &rays->scene->places[index];
    const double *m = place->transform;
    float columns[12];
    double volume = fabs(determinant(m));
    if (!(volume > 1e-30) || volume > 1e30)
        return;
    for (int i = 0; i < 12; i++)
        columns[i] = (float)m[4 * (i % 3) + i / 3];
    RTCGeometry geometry = rtcNewGeometry(rays->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, rays->meshes[place->mesh]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(rays->top, geometry, (unsigned)index);
    rtcReleaseGeometry(geometry);
}

struct oracle_rays *oracle_rays_create(const struct oracle_scene *scene,
                                       struct oracle_values *values)
{
    struct oracle_rays *rays = calloc(1, sizeof *rays);
    if (!rays)
        return NULL;
    *rays = (struct oracle_rays){.scene = scene,
                                 .values = values,
                                 .device = rtcNewDevice("threads=1"),
                                 .meshes = calloc(scene->mesh_count + 1u, sizeof *rays->meshes)};
    if (!rays->device || !rays->meshes || scene->place_count > UINT32_MAX - 1) {
        fprintf(stderr, "oracle: Embree does not start\n");
        oracle_rays_destroy(rays);
        return NULL;
    }
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        rays->meshes[i] = make_mesh(rays, &scene->meshes[i]);
    rays->top = rtcNewScene(rays->device);
    rtcSetSceneFlags(rays->top, RTC_SCENE_FLAG_ROBUST);
    for (size_t i = 0; i < scene->place_count; i++)
        add_place(rays, i);
    rtcCommitScene(rays->top);
    if (rtcGetDeviceError(rays->device) == RTC_ERROR_NONE)
        return rays;
    fprintf(stderr, "oracle: Embree reports an error\n");
    oracle_rays_destroy(rays);
    return NULL;
}

void oracle_rays_destroy(struct oracle_rays *rays)
{
    if (!rays)
        return;
    if (rays->top)
        rtcReleaseScene(rays->top);
    for (uint32_t i = 0; rays->meshes && i < rays->scene->mesh_count; i++)
        if (rays->meshes[i])
            rtcReleaseScene(rays->meshes[i]);
    if (rays->device)
        rtcReleaseDevice(rays->device);
    free(rays->meshes);
    free(rays);
}

/* Rays */

static bool trace(struct oracle_rays *rays, const struct oracle_ray *ray, struct RTCRayHit *out)
{
    struct context context = {.rays = rays, .ray = ray};
    *out = (struct RTCRayHit){
        .ray = {.org_x = (float)ray->origin.x,
                .org_y = (float)ray->origin.y,
                .org_z = (float)ray->origin.z,
                .dir_x = (float)ray->direction.x,
                .dir_y = (float)ray->direction.y,
                .dir_z = (float)ray->direction.z,
                .tfar = (float)fmin(ray->longest, 3e38),
                .mask = UINT32_MAX},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
    oracle_init_context(&context.embree);
    oracle_intersect(rays->top, &context.embree, out);
    return out->hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool oracle_rays_trace(struct oracle_rays *rays, const struct oracle_ray *ray,
                       struct oracle_hit *hit)
{
    struct RTCRayHit found;
    if (!trace(rays, ray, &found))
        return false;
    *hit = (struct oracle_hit){.place = found.hit.instID[0],
                               .triangle = found.hit.primID,
                               .t = found.ray.tfar,
                               .b1 = found.hit.u,
                               .b2 = found.hit.v};
    oracle_find_point(rays->scene, hit);
    return true;
}

bool oracle_rays_is_blocked(struct oracle_rays *rays, const struct oracle_ray *ray)
{
    struct RTCRayHit found;
    return trace(rays, ray, &found);
}
