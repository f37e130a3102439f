#include "oracle/scene.h"

#include <stdio.h>
#include <stdlib.h>

static void say(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    if (!*(bool *)user)
        fprintf(stderr, "%s\n", message);
}

static bool read_tables(struct oracle_scene *s)
{
    s->shapes = calloc(s->info.shapeCount + 1u, sizeof *s->shapes);
    s->materials = calloc(s->info.materialCount + 1u, sizeof *s->materials);
    s->textures = calloc(s->info.textureCount + 1u, sizeof *s->textures);
    s->lights = calloc(s->info.lightCount + 1u, sizeof *s->lights);
    if (!s->shapes || !s->materials || !s->textures || !s->lights)
        return false;
    bool ok = true;
    for (uint32_t i = 0; i < s->info.shapeCount; i++) {
        s->shapes[i].structSize = sizeof s->shapes[i];
        ok &= sluiceGetPbrtShape(s->pbrt, i, &s->shapes[i]) == SLUICE_SUCCESS;
    }
    for (uint32_t i = 0; i < s->info.materialCount; i++) {
        s->materials[i].structSize = sizeof s->materials[i];
        ok &= sluiceGetPbrtMaterial(s->pbrt, i, &s->materials[i]) == SLUICE_SUCCESS;
    }
    for (uint32_t i = 0; i < s->info.textureCount; i++) {
        s->textures[i].structSize = sizeof s->textures[i];
        ok &= sluiceGetPbrtTexture(s->pbrt, i, &s->textures[i]) == SLUICE_SUCCESS;
    }
    for (uint32_t i = 0; i < s->info.lightCount; i++) {
        s->lights[i].structSize = sizeof s->lights[i];
        ok &= sluiceGetPbrtLight(s->pbrt, i, &s->lights[i]) == SLUICE_SUCCESS;
    }
    return ok;
}

/* The mesh of an earlier shape with the same PLY file, or SLUICE_PBRT_NONE. */
static uint32_t find_mesh(const struct oracle_scene *s, uint32_t shape)
{
    const char *path = s->shapes[shape].pPlyPath;
    for (uint32_t i = shape; path && i-- > 0;)
        if (s->shapes[i].pPlyPath == path)
            return s->mesh_of_shape[i];
    return SLUICE_PBRT_NONE;
}

static bool read_meshes(struct oracle_scene *s)
{
    s->meshes = calloc(s->info.shapeCount + 1u, sizeof *s->meshes);
    s->mesh_of_shape = calloc(s->info.shapeCount + 1u, sizeof *s->mesh_of_shape);
    if (!s->meshes || !s->mesh_of_shape)
        return false;
    for (uint32_t i = 0; i < s->info.shapeCount; i++) {
        s->mesh_of_shape[i] = find_mesh(s, i);
        if (s->mesh_of_shape[i] != SLUICE_PBRT_NONE)
            continue;
        SluicePbrtMesh *mesh = &s->meshes[s->mesh_count];
        mesh->structSize = sizeof *mesh;
        if (sluiceReadPbrtShape(s->pbrt, i, mesh) == SLUICE_SUCCESS) {
            s->mesh_of_shape[i] = s->mesh_count++;
            s->triangle_count += mesh->triangleCount;
        } else {
            s->failed_count++;
        }
    }
    return true;
}

static const struct oracle_box NOTHING = {{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};

static void cover(struct oracle_box *box, struct vec p)
{
    box->least = vec(fmin(box->least.x, p.x), fmin(box->least.y, p.y), fmin(box->least.z, p.z));
    box->most = vec(fmax(box->most.x, p.x), fmax(box->most.y, p.y), fmax(box->most.z, p.z));
}

static struct oracle_box cover_mesh(const double m[12], const SluicePbrtMesh *mesh)
{
    struct oracle_box box = NOTHING;
    for (uint32_t i = 0; i < mesh->vertexCount; i++)
        cover(&box, apply_point(m, vec_of(&mesh->pPositions[3 * (size_t)i])));
    return box;
}

static void add_place(struct oracle_scene *s, uint32_t shape, uint32_t instance,
                      const SluicePbrtInstance *instances)
{
    struct oracle_place *place = &s->places[s->place_count];
    double own[12], outer[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    if (s->mesh_of_shape[shape] == SLUICE_PBRT_NONE)
        return;
    *place = (struct oracle_place){shape, instance, s->mesh_of_shape[shape]};
    if (instance != SLUICE_PBRT_NONE)
        matrix_of(instances[instance].transform, outer);
    matrix_of(s->shapes[shape].transform, own);
    matrix_product(outer, own, place->transform);
    place->box = cover_mesh(place->transform, &s->meshes[place->mesh]);
    s->place_count++;
}

static bool list_places(struct oracle_scene *s)
{
    const SluicePbrtInstance *instances;
    SluicePbrtObject object;
    size_t count = s->info.shapeCount;
    if (sluiceGetPbrtInstances(s->pbrt, &instances) != SLUICE_SUCCESS)
        return false;
    for (uint32_t i = 0; i < s->info.instanceCount; i++)
        if (sluiceGetPbrtObject(s->pbrt, instances[i].object, &object) == SLUICE_SUCCESS)
            count += object.shapeCount;
    s->places = calloc(count + 1, sizeof *s->places);
    if (!s->places)
        return false;
    for (uint32_t i = 0; i < s->info.shapeCount; i++)
        if (s->shapes[i].object == SLUICE_PBRT_NONE)
            add_place(s, i, SLUICE_PBRT_NONE, instances);
    for (uint32_t i = 0; i < s->info.instanceCount; i++)
        if (sluiceGetPbrtObject(s->pbrt, instances[i].object, &object) == SLUICE_SUCCESS)
            for (uint32_t j = 0; j < object.shapeCount; j++)
                add_place(s, object.firstShape + j, i, instances);
    return true;
}

bool oracle_scene_load(struct oracle_scene *s, const char *path, bool quiet)
{
    static bool is_quiet;
    is_quiet = quiet;
    SluicePbrtSceneCreateInfo info = {
        .structSize = sizeof info, .pPath = path, .log = {&is_quiet, say}};
    *s = (struct oracle_scene){.info = {.structSize = sizeof s->info}};
    SluiceResult result = sluiceOpenPbrtScene(&info, &s->pbrt);
    if (result != SLUICE_SUCCESS) {
        fprintf(stderr, "%s: %s\n", path, sluiceGetResultName(result));
        return false;
    }
    if (sluiceGetPbrtSceneInfo(s->pbrt, &s->info) == SLUICE_SUCCESS && read_tables(s) &&
        read_meshes(s) && list_places(s))
        return true;
    fprintf(stderr, "%s: out of memory\n", path);
    return false;
}

void oracle_scene_finish(struct oracle_scene *s)
{
    for (uint32_t i = 0; i < s->mesh_count; i++)
        sluiceFreePbrtMesh(s->pbrt, &s->meshes[i]);
    free(s->shapes);
    free(s->materials);
    free(s->textures);
    free(s->lights);
    free(s->meshes);
    free(s->mesh_of_shape);
    free(s->places);
    sluiceDestroyPbrtScene(s->pbrt);
    *s = (struct oracle_scene){0};
}

void oracle_corners(const SluicePbrtMesh *mesh, uint32_t triangle, struct vec corners[3])
{
    for (int i = 0; i < 3; i++)
        corners[i] =
            vec_of(&mesh->pPositions[3 * (size_t)mesh->pIndices[3 * (size_t)triangle + (size_t)i]]);
}
