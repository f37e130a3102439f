#include "pbrt/parsed_scene.h"

#include "base/alloc.h"
#include "base/limits.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "pbrt/bounds_file.h"
#include "pbrt/ply_reader.h"
#include "pbrt/shape_reader.h"

#include <string.h>

static void set_defaults(SluicePbrtSceneCreateInfo *info)
{
    info->maxIncludeDepth = info->maxIncludeDepth ? info->maxIncludeDepth : 64;
    info->maxIncludeCount = info->maxIncludeCount ? info->maxIncludeCount : 1u << 16;
    info->maxBlockDepth = info->maxBlockDepth ? info->maxBlockDepth : 1024;
    info->maxShapeCount = info->maxShapeCount ? info->maxShapeCount : 1u << 24;
    info->maxInstanceCount = info->maxInstanceCount ? info->maxInstanceCount : 1u << 26;
    info->maxTextSize = info->maxTextSize ? info->maxTextSize : UINT64_C(1) << 38;
    info->maxMeshSize = info->maxMeshSize ? info->maxMeshSize : UINT64_C(1) << 34;
}

static SluiceResult check_info(const SluicePbrtSceneCreateInfo *info)
{
    const struct slc_limit limits[] = {
        {"maxIncludeDepth", info->maxIncludeDepth, 1, 256},
        {"maxBlockDepth", info->maxBlockDepth, 1, 1u << 16},
        {"maxShapeCount", info->maxShapeCount, 1, INT32_MAX},
        {"maxInstanceCount", info->maxInstanceCount, 1, INT32_MAX},
    };
    if (!slc_allocator_is_valid(info->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    return slc_check_limits(&info->log, limits, sizeof limits / sizeof *limits);
}

SluiceResult sluiceOpenPbrtScene(const SluicePbrtSceneCreateInfo *pInfo, SluicePbrtScene **pScene)
{
    SluicePbrtSceneCreateInfo info;
    if (!pInfo || !pScene)
        return SLUICE_ERROR_NULL_POINTER;
    *pScene = NULL;
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluicePbrtSceneCreateInfo), &info, pInfo, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info.pPath)
        return SLUICE_ERROR_NULL_POINTER;
    set_defaults(&info);
    result = check_info(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluicePbrtScene *scene = slc_calloc(&cb, 1, sizeof *scene);
    if (!scene)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    scene->allocator = cb;
    scene->limits = info;
    scene->limits.pPath = scene->limits.pBoundsPath = NULL;
    scene->limits.pAllocator = NULL;
    scene->info.filmWidth = 1280;
    scene->info.filmHeight = 720;
    scene->info.cropWindow[1] = scene->info.cropWindow[3] = 1;
    result = slc_pbrt_parse(scene, info.pPath);
    if (result == SLUICE_SUCCESS && info.pBoundsPath)
        result = slc_pbrt_read_bounds_file(scene, info.pBoundsPath);
    scene->limits.pUserData = NULL;
    scene->limits.pfnProgress = NULL;
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyPbrtScene(scene);
        return result;
    }
    *pScene = scene;
    return SLUICE_SUCCESS;
}

void sluiceDestroyPbrtScene(SluicePbrtScene *scene)
{
    if (!scene)
        return;
    SluiceAllocationCallbacks cb = scene->allocator;
    slc_pbrt_names_finish(&scene->names, &cb);
    slc_free(&cb, scene->files, scene->file_capacity, sizeof *scene->files);
    slc_free(&cb, scene->materials, scene->material_capacity, sizeof *scene->materials);
    slc_free(&cb, scene->textures, scene->texture_capacity, sizeof *scene->textures);
    slc_free(&cb, scene->lights, scene->light_capacity, sizeof *scene->lights);
    slc_free(&cb, scene->shapes, scene->shape_capacity, sizeof *scene->shapes);
    slc_free(&cb, scene->spans, scene->span_capacity, sizeof *scene->spans);
    slc_free(&cb, scene->plys, scene->ply_capacity, sizeof *scene->plys);
    slc_free(&cb, scene->objects, scene->object_capacity, sizeof *scene->objects);
    slc_free(&cb, scene->instances, scene->instance_capacity, sizeof *scene->instances);
    slc_free(&cb, scene, 1, sizeof *scene);
}

/* Answers */

static SluiceResult check_index(const SluicePbrtScene *scene, const char *what, uint32_t index,
                                size_t count)
{
    if (index < count)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&scene->limits.log, "%s %u: the scene has %zu", what, index, count);
}

static const char *name_or_null(const SluicePbrtScene *scene, uint32_t name)
{
    return name == SLUICE_PBRT_NONE ? NULL : slc_pbrt_name(&scene->names, name);
}

static const char *file_of(const SluicePbrtScene *scene, const struct slc_pbrt_place *place)
{
    return slc_pbrt_name(&scene->names, scene->files[place->file].path);
}

SluiceResult sluiceGetPbrtSceneInfo(const SluicePbrtScene *scene, SluicePbrtSceneInfo *pInfo)
{
    if (!scene || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluicePbrtSceneInfo), pInfo, &scene->limits.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluicePbrtSceneInfo info = scene->info;
    info.shapeCount = (uint32_t)scene->shape_count;
    info.objectCount = (uint32_t)scene->object_count;
    info.instanceCount = (uint32_t)scene->instance_count;
    info.materialCount = (uint32_t)scene->material_count;
    info.textureCount = (uint32_t)scene->texture_count;
    info.lightCount = (uint32_t)scene->light_count;
    slc_struct_write(SLC_STRUCT(SluicePbrtSceneInfo), pInfo, &info);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetPbrtTexture(const SluicePbrtScene *scene, uint32_t index,
                                  SluicePbrtTexture *pTexture)
{
    if (!scene || !pTexture)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluicePbrtTexture), pTexture, &scene->limits.log);
    if (result == SLUICE_SUCCESS)
        result = check_index(scene, "texture", index, scene->texture_count);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_pbrt_texture_entry *entry = &scene->textures[index];
    SluicePbrtTexture texture = entry->texture;
    texture.pName = slc_pbrt_name(&scene->names, entry->name);
    texture.pFile = file_of(scene, &entry->place);
    texture.line = entry->place.line;
    texture.pImagePath = name_or_null(scene, entry->image);
    slc_struct_write(SLC_STRUCT(SluicePbrtTexture), pTexture, &texture);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetPbrtMaterial(const SluicePbrtScene *scene, uint32_t index,
                                   SluicePbrtMaterial *pMaterial)
{
    if (!scene || !pMaterial)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluicePbrtMaterial), pMaterial, &scene->limits.log);
    if (result == SLUICE_SUCCESS)
        result = check_index(scene, "material", index, scene->material_count);
    if (result != SLUICE_SUCCESS)
        return result;
    SluicePbrtMaterial material = scene->materials[index].material;
    material.pType = slc_pbrt_name(&scene->names, scene->materials[index].type);
    slc_struct_write(SLC_STRUCT(SluicePbrtMaterial), pMaterial, &material);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetPbrtLight(const SluicePbrtScene *scene, uint32_t index,
                                SluicePbrtLight *pLight)
{
    if (!scene || !pLight)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluicePbrtLight), pLight, &scene->limits.log);
    if (result == SLUICE_SUCCESS)
        result = check_index(scene, "light", index, scene->light_count);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_pbrt_light_entry *entry = &scene->lights[index];
    SluicePbrtLight light = entry->light;
    light.pFile = file_of(scene, &entry->place);
    light.line = entry->place.line;
    light.pImagePath = name_or_null(scene, entry->image);
    slc_struct_write(SLC_STRUCT(SluicePbrtLight), pLight, &light);
    return SLUICE_SUCCESS;
}

static void fill_data(const SluicePbrtScene *scene, const struct slc_pbrt_shape_entry *entry,
                      SluicePbrtShape *shape)
{
    switch (entry->kind) {
    case SLUICE_PBRT_SHAPE_PLY:
        shape->pPlyPath = slc_pbrt_name(&scene->names, scene->plys[entry->data.file.ply].path);
        break;
    case SLUICE_PBRT_SHAPE_SPHERE:
    case SLUICE_PBRT_SHAPE_DISK:
    case SLUICE_PBRT_SHAPE_CYLINDER:
        shape->radius = entry->data.quadric.radius;
        shape->innerRadius = entry->data.quadric.inner_radius;
        shape->zMin = entry->data.quadric.z_min;
        shape->zMax = entry->data.quadric.z_max;
        shape->phiMax = entry->data.quadric.phi_max;
        break;
    case SLUICE_PBRT_SHAPE_LOOP: shape->levels = entry->data.mesh.levels; break;
    case SLUICE_PBRT_SHAPE_TRIANGLES:
    case SLUICE_PBRT_SHAPE_BILINEAR: break;
    }
}

SluiceResult sluiceGetPbrtShape(const SluicePbrtScene *scene, uint32_t index,
                                SluicePbrtShape *pShape)
{
    if (!scene || !pShape)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluicePbrtShape), pShape, &scene->limits.log);
    if (result == SLUICE_SUCCESS)
        result = check_index(scene, "shape", index, scene->shape_count);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_pbrt_shape_entry *entry = &scene->shapes[index];
    SluicePbrtShape shape = {.kind = entry->kind,
                             .pFile = file_of(scene, &entry->place),
                             .line = entry->place.line,
                             .column = entry->place.column,
                             .object = entry->object,
                             .material = entry->material,
                             .areaLight = entry->area_light,
                             .alpha = entry->alpha,
                             .reverseOrientation = entry->reverse_orientation};
    memcpy(shape.transform, entry->transform, sizeof shape.transform);
    fill_data(scene, entry, &shape);
    slc_struct_write(SLC_STRUCT(SluicePbrtShape), pShape, &shape);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetPbrtObject(const SluicePbrtScene *scene, uint32_t index,
                                 SluicePbrtObject *pObject)
{
    if (!scene || !pObject)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = check_index(scene, "object", index, scene->object_count);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_pbrt_object_entry *entry = &scene->objects[index];
    *pObject = (SluicePbrtObject){slc_pbrt_name(&scene->names, entry->name), entry->first_shape,
                                  entry->shape_count};
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetPbrtInstances(const SluicePbrtScene *scene,
                                    const SluicePbrtInstance **ppInstances)
{
    if (!scene || !ppInstances)
        return SLUICE_ERROR_NULL_POINTER;
    *ppInstances = scene->instance_count ? scene->instances : NULL;
    return SLUICE_SUCCESS;
}
