#include "pbrt/parsed_scene.h"

#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "pbrt/ply_reader.h"
#include "pbrt/shape_reader.h"

#include <stdio.h>
#include <string.h>

static SluiceResult fail_ply(const SluicePbrtScene *scene, const struct slc_pbrt_shape_entry *shape,
                             SluiceResult result, const struct slc_pbrt_ply_trouble *trouble)
{
    const char *path = slc_pbrt_name(&scene->names, scene->plys[shape->data.file.ply].path);
    return slc_pbrt_fail(scene, result, &shape->place, "%s: %s: the shape is left out", path,
                         trouble->text ? trouble->text : slc_pbrt_failure_text(result));
}

static void warn_about_ply(const SluicePbrtScene *scene, const struct slc_pbrt_shape_entry *shape,
                           const struct slc_pbrt_ply_trouble *trouble)
{
    char text[512];
    snprintf(text, sizeof text, "%s: %s",
             slc_pbrt_name(&scene->names, scene->plys[shape->data.file.ply].path), trouble->text);
    slc_pbrt_warn(scene, &shape->place, text);
}

/* Reads the vertices of a PLY file, unless read before. */
static SluiceResult find_ply_bounds(SluicePbrtScene *scene,
                                    const struct slc_pbrt_shape_entry *shape)
{
    struct slc_pbrt_ply_entry *ply = &scene->plys[shape->data.file.ply];
    struct slc_pbrt_ply_trouble trouble = {NULL};
    if (ply->state == SLC_PBRT_PLY_KNOWN)
        return SLUICE_SUCCESS;
    if (ply->state == SLC_PBRT_PLY_FAILED) {
        trouble.text = "failed before";
        return fail_ply(scene, shape, ply->failure, &trouble);
    }
    SluiceResult result =
        slc_pbrt_ply_read_bounds(slc_pbrt_name(&scene->names, ply->path), &scene->allocator,
                                 &ply->bounds, &ply->stamp, &trouble);
    if (result == SLUICE_SUCCESS) {
        ply->state = SLC_PBRT_PLY_KNOWN;
        return SLUICE_SUCCESS;
    }
    if (result != SLUICE_ERROR_OUT_OF_HOST_MEMORY && result != SLUICE_NOT_READY) {
        ply->state = SLC_PBRT_PLY_FAILED;
        ply->failure = result;
    }
    return fail_ply(scene, shape, result, &trouble);
}

SluiceResult sluiceGetPbrtShapeBounds(SluicePbrtScene *scene, uint32_t index,
                                      SluicePbrtBounds *pBounds)
{
    if (!scene || !pBounds)
        return SLUICE_ERROR_NULL_POINTER;
    if (index >= scene->shape_count)
        return slc_log_refusal(&scene->limits.log, "shape %u: the scene has %zu", index,
                               scene->shape_count);
    const struct slc_pbrt_shape_entry *shape = &scene->shapes[index];
    struct slc_pbrt_affine transform = slc_pbrt_from_floats(shape->transform);
    SluicePbrtBounds bounds;
    switch (shape->kind) {
    case SLUICE_PBRT_SHAPE_TRIANGLES:
    case SLUICE_PBRT_SHAPE_LOOP:
    case SLUICE_PBRT_SHAPE_BILINEAR: *pBounds = shape->data.mesh.bounds; return SLUICE_SUCCESS;
    case SLUICE_PBRT_SHAPE_PLY: {
        SluiceResult result = find_ply_bounds(scene, shape);
        if (result != SLUICE_SUCCESS)
            return result;
        bounds = scene->plys[shape->data.file.ply].bounds;
        break;
    }
    default: bounds = slc_pbrt_quadric_bounds(shape);
    }
    *pBounds = slc_pbrt_apply_bounds(&transform, &bounds);
    return SLUICE_SUCCESS;
}

static SluiceResult read_ply(const SluicePbrtScene *scene, const struct slc_pbrt_shape_entry *shape,
                             SluicePbrtMesh *mesh)
{
    struct slc_pbrt_ply_trouble trouble = {NULL};
    const char *path = slc_pbrt_name(&scene->names, scene->plys[shape->data.file.ply].path);
    SluiceResult result =
        slc_pbrt_ply_read_mesh(path, &scene->allocator, scene->limits.maxMeshSize, mesh, &trouble);
    if (result == SLUICE_SUCCESS && trouble.text)
        warn_about_ply(scene, shape, &trouble);
    return result == SLUICE_SUCCESS ? result : fail_ply(scene, shape, result, &trouble);
}

SluiceResult sluiceReadPbrtShape(const SluicePbrtScene *scene, uint32_t index,
                                 SluicePbrtMesh *pMesh)
{
    if (!scene || !pMesh)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluicePbrtMesh), pMesh, &scene->limits.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluicePbrtMesh mesh = {0}; /* also after an error, so that it can be freed */
    slc_struct_write(SLC_STRUCT(SluicePbrtMesh), pMesh, &mesh);
    if (index >= scene->shape_count)
        return slc_log_refusal(&scene->limits.log, "shape %u: the scene has %zu", index,
                               scene->shape_count);
    const struct slc_pbrt_shape_entry *shape = &scene->shapes[index];
    switch (shape->kind) {
    case SLUICE_PBRT_SHAPE_TRIANGLES:
    case SLUICE_PBRT_SHAPE_LOOP:
    case SLUICE_PBRT_SHAPE_BILINEAR: result = slc_pbrt_read_inline_mesh(scene, shape, &mesh); break;
    case SLUICE_PBRT_SHAPE_PLY: result = read_ply(scene, shape, &mesh); break;
    default: result = slc_pbrt_build_quadric(scene, shape, &mesh);
    }
    slc_struct_write(SLC_STRUCT(SluicePbrtMesh), pMesh, &mesh);
    return result;
}

SluiceResult sluiceFreePbrtMesh(const SluicePbrtScene *scene, SluicePbrtMesh *pMesh)
{
    SluicePbrtMesh mesh = {0};
    if (!scene || !pMesh)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluicePbrtMesh), pMesh, &scene->limits.log);
    if (result != SLUICE_SUCCESS)
        return result;
    memcpy(&mesh, pMesh, slc_min_u32(pMesh->structSize, sizeof mesh));
    slc_pbrt_free_mesh(&scene->allocator, &mesh);
    mesh = (SluicePbrtMesh){0};
    slc_struct_write(SLC_STRUCT(SluicePbrtMesh), pMesh, &mesh);
    return SLUICE_SUCCESS;
}
