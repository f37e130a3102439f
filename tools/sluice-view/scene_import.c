/* strdup */
#define _XOPEN_SOURCE 700

#include "scene_import.h"

#include "../../samples/streaming/cache.h"
#include "../common/clock.h"
#include "../common/files.h"
#include "../common/log.h"
#include "../common/text.h"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <sluice/open.h>
#include <vulkan/vulkan_core.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_VERTICES (64u << 20)
#define MAX_DEPTH 64u
#define MAX_NODES 1000000u
#define MAX_KEYS 100000u
#define BAKE_SECONDS 600.0

struct import {
    const struct aiScene *from;
    const char *path;
    struct scene_data *scene;
    uint32_t *images_of_materials; ///< SCENE_NO_IMAGE: none
};

static char *copy_text(const char *text)
{
    return strdup(text);
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Blanks and other characters may be escaped in glTF. */
static void join(const char *scene, const char *name, char *path, size_t size)
{
    const char *slash = strrchr(scene, '/');
    size_t length = 0;
    if (name[0] != '/' && slash)
        length = (size_t)snprintf(path, size, "%.*s/", (int)(slash - scene), scene);
    while (*name && length + 1 < size) {
        unsigned code;
        if (name[0] == '%' && sscanf(name + 1, "%2x", &code) == 1 && code > 0) {
            path[length++] = (char)code;
            name += 3;
        } else {
            path[length++] = *name++;
        }
    }
    path[length < size ? length : size - 1] = '\0';
}

static int wrap_of(enum aiTextureMapMode mode)
{
    switch (mode) {
    case aiTextureMapMode_Clamp: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case aiTextureMapMode_Mirror: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default: return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }
}

static uint32_t find_image(const struct scene_data *scene, const char *path, const int wraps[2])
{
    for (uint32_t i = 0; i < scene->image_count; i++)
        if (strcmp(scene->images[i].path, path) == 0 && scene->images[i].wrap_u == wraps[0] &&
            scene->images[i].wrap_v == wraps[1])
            return i;
    return SCENE_NO_IMAGE;
}

/* An image that cannot be opened is named and left out. */
static uint32_t add_image(struct import *import, const char *name, const int wraps[2])
{
    char path[4096];
    struct scene_data *scene = import->scene;
    if (name[0] == '*') {
        text_say("sluice-view: %s: image %s is inside the file, which is not supported",
                 import->path, name);
        return SCENE_NO_IMAGE;
    }
    join(import->path, name, path, sizeof path);
    const uint32_t known = find_image(scene, path, wraps);
    if (known != SCENE_NO_IMAGE)
        return known;
    struct scene_image *image = &scene->images[scene->image_count];
    *image = (struct scene_image){.wrap_u = wraps[0], .wrap_v = wraps[1]};
    const SluiceResult result = sluiceOpenImageSource(scene->opener, path, &image->source);
    if (result != SLUICE_SUCCESS) {
        text_say("sluice-view: %s: %s", path, sluiceGetResultName(result));
        return SCENE_NO_IMAGE;
    }
    image->name = copy_text(base_name(path));
    image->path = copy_text(path);
    scene->image_count++;
    return image->name && image->path ? scene->image_count - 1 : SCENE_NO_IMAGE;
}

static uint32_t image_of_material(struct import *import, const struct aiMaterial *material)
{
    struct aiString name;
    enum aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    enum aiTextureType type = aiTextureType_BASE_COLOR;
    if (aiGetMaterialTextureCount(material, type) == 0)
        type = aiTextureType_DIFFUSE;
    if (aiGetMaterialTextureCount(material, type) == 0 ||
        aiGetMaterialTexture(material, type, 0, &name, NULL, NULL, NULL, NULL, modes, NULL) !=
            aiReturn_SUCCESS)
        return SCENE_NO_IMAGE;
    const int wraps[2] = {wrap_of(modes[0]), wrap_of(modes[1])};
    return add_image(import, name.data, wraps);
}

static void read_color(const struct aiMaterial *material, float color[4])
{
    struct aiColor4D read = {1, 1, 1, 1};
    if (aiGetMaterialColor(material, "$clr.base", 0, 0, &read) != aiReturn_SUCCESS)
        aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &read);
    const float read_channels[4] = {read.r, read.g, read.b, read.a};
    for (int i = 0; i < 4; i++)
        color[i] = isfinite(read_channels[i]) ? read_channels[i] : 1.0f;
}

/* Assimp has transformed coordinates with V up; here V grows downwards. */
static void transform_uv(const struct aiMaterial *material, float uv[2])
{
    struct aiUVTransform t;
    if (aiGetMaterialUVTransform(material, AI_MATKEY_UVTRANSFORM(aiTextureType_DIFFUSE, 0), &t) !=
        aiReturn_SUCCESS)
        return;
    const float u = uv[0] * t.mScaling.x, v = (1 - uv[1]) * t.mScaling.y;
    const float c = cosf(t.mRotation), s = sinf(t.mRotation);
    uv[0] = c * u - s * v + t.mTranslation.x;
    uv[1] = 1 - (s * u + c * v + t.mTranslation.y);
}

static void add_vertices(struct import *import, const struct aiMesh *mesh,
                         const struct aiMatrix4x4 *to_world)
{
    const struct aiMaterial *material = import->from->mMaterials[mesh->mMaterialIndex];
    struct aiMatrix4x4 inverse = *to_world;
    struct aiMatrix3x3 normals;
    aiMatrix4Inverse(&inverse);
    aiTransposeMatrix4(&inverse);
    aiMatrix3FromMatrix4(&normals, &inverse);
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        struct scene_vertex *v = &import->scene->vertices[import->scene->vertex_count++];
        struct aiVector3D p = mesh->mVertices[i], n = {0, 1, 0};
        aiTransformVecByMatrix4(&p, to_world);
        if (mesh->mNormals)
            n = mesh->mNormals[i];
        aiTransformVecByMatrix3(&n, &normals);
        *v = (struct scene_vertex){{p.x, p.y, p.z}, {n.x, n.y, n.z}, {0, 0}};
        if (mesh->mTextureCoords[0]) {
            memcpy(v->uv, &mesh->mTextureCoords[0][i], sizeof v->uv);
            transform_uv(material, v->uv);
        }
    }
}

static void add_mesh(struct import *import, const struct aiMesh *mesh,
                     const struct aiMatrix4x4 *to_world)
{
    struct scene_data *scene = import->scene;
    const uint32_t first = scene->vertex_count;
    struct scene_part *part = &scene->parts[scene->part_count++];
    *part = (struct scene_part){.first_index = scene->index_count,
                                .image = import->images_of_materials[mesh->mMaterialIndex]};
    read_color(import->from->mMaterials[mesh->mMaterialIndex], part->color);
    add_vertices(import, mesh, to_world);
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        for (unsigned k = 0; mesh->mFaces[i].mNumIndices == 3 && k < 3; k++)
            scene->indices[scene->index_count++] = first + mesh->mFaces[i].mIndices[k];
    part->index_count = scene->index_count - part->first_index;
}

/* What the visits of all nodes come to. Assimp refuses circles; depth and sums are bounded here. */
struct sums {
    size_t vertices, indices, parts;
    unsigned visits;
};

static void visit(struct import *import, const struct aiNode *node,
                  const struct aiMatrix4x4 *parent, struct sums *sums, unsigned depth)
{
    struct aiMatrix4x4 to_world = *parent;
    aiMultiplyMatrix4(&to_world, &node->mTransformation);
    if (depth == MAX_DEPTH || ++sums->visits > MAX_NODES)
        return;
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *mesh = import->from->mMeshes[node->mMeshes[i]];
        if (!(mesh->mPrimitiveTypes & aiPrimitiveType_TRIANGLE))
            continue;
        sums->vertices += mesh->mNumVertices;
        sums->indices += 3 * (size_t)mesh->mNumFaces;
        sums->parts++;
        if (import->scene->vertices)
            add_mesh(import, mesh, &to_world);
    }
    for (unsigned i = 0; i < node->mNumChildren; i++)
        visit(import, node->mChildren[i], &to_world, sums, depth + 1);
}

static void visit_all(struct import *import, struct sums *sums)
{
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    *sums = (struct sums){0};
    visit(import, import->from->mRootNode, &identity, sums, 0);
}

/* A camera of the file at a place of its path. Its node stands in the root. */
static struct view_camera camera_of(const struct aiCamera *camera, struct aiVector3D position,
                                    const struct aiQuaternion *rotation)
{
    struct aiMatrix3x3 turn;
    struct aiVector3D look = camera->mLookAt;
    aiMatrix3FromQuaternion(&turn, rotation);
    aiTransformVecByMatrix3(&look, &turn);
    const struct vec3 eye = {position.x, position.y, position.z};
    const float aspect = camera->mAspect > 0 ? camera->mAspect : 1.777f;
    const float fov = 2 * atanf(tanf(camera->mHorizontalFOV / 2) / aspect);
    return view_camera_at(eye, vec3_add(eye, (struct vec3){look.x, look.y, look.z}),
                          fov > 0.2f && fov < 2.5f ? fov : 1.0f);
}

/* Keys of a channel are joined by straight lines; rotations take the nearest key before them. */
static struct view_camera camera_at_time(const struct aiCamera *camera,
                                         const struct aiNodeAnim *channel, double time)
{
    unsigned p = 0, r = 0;
    while (p + 1 < channel->mNumPositionKeys && channel->mPositionKeys[p + 1].mTime <= time)
        p++;
    while (r + 1 < channel->mNumRotationKeys && channel->mRotationKeys[r + 1].mTime <= time)
        r++;
    struct aiVector3D at = channel->mPositionKeys[p].mValue;
    if (p + 1 < channel->mNumPositionKeys && time > channel->mPositionKeys[p].mTime) {
        const struct aiVectorKey *a = &channel->mPositionKeys[p], *b = a + 1;
        const float part = (float)((time - a->mTime) / (b->mTime - a->mTime));
        at = (struct aiVector3D){at.x + (b->mValue.x - at.x) * part,
                                 at.y + (b->mValue.y - at.y) * part,
                                 at.z + (b->mValue.z - at.z) * part};
    }
    return camera_of(camera, at, &channel->mRotationKeys[r].mValue);
}

static void take_path(struct import *import, const struct aiCamera *camera,
                      const struct aiNodeAnim *channel, double ticks)
{
    const double per_second = ticks > 0 ? ticks : 1000.0;
    if (channel->mNumPositionKeys == 0 || channel->mNumRotationKeys == 0)
        return;
    float last = -1;
    for (unsigned i = 0; i < channel->mNumRotationKeys && i < MAX_KEYS; i++) {
        const double time = channel->mRotationKeys[i].mTime;
        const struct view_camera at = camera_at_time(camera, channel, time);
        if ((float)(time / per_second) > last)
            camera_path_add(&import->scene->tour, last = (float)(time / per_second), &at);
    }
    for (unsigned i = 0;
         i < channel->mNumPositionKeys && channel->mNumRotationKeys == 1 && i < MAX_KEYS; i++) {
        const double time = channel->mPositionKeys[i].mTime;
        const struct view_camera at = camera_at_time(camera, channel, time);
        if ((float)(time / per_second) > last)
            camera_path_add(&import->scene->tour, last = (float)(time / per_second), &at);
    }
}

static void take_camera(struct import *import)
{
    const struct aiScene *from = import->from;
    if (from->mNumCameras == 0)
        return;
    const struct aiCamera *camera = from->mCameras[0];
    const struct aiNode *node = NULL;
    for (unsigned i = 0; i < from->mRootNode->mNumChildren; i++)
        if (strcmp(from->mRootNode->mChildren[i]->mName.data, camera->mName.data) == 0)
            node = from->mRootNode->mChildren[i];
    if (!node)
        return;
    struct aiVector3D scaling, position;
    struct aiQuaternion rotation;
    aiDecomposeMatrix(&node->mTransformation, &scaling, &rotation, &position);
    import->scene->camera = camera_of(camera, position, &rotation);
    for (unsigned a = 0; a < from->mNumAnimations; a++)
        for (unsigned c = 0; c < from->mAnimations[a]->mNumChannels; c++)
            if (import->scene->tour.count == 0 &&
                strcmp(from->mAnimations[a]->mChannels[c]->mNodeName.data, camera->mName.data) == 0)
                take_path(import, camera, from->mAnimations[a]->mChannels[c],
                          from->mAnimations[a]->mTicksPerSecond);
}

static bool allocate(struct import *import, const struct sums *sums)
{
    const struct aiScene *from = import->from;
    struct scene_data *scene = import->scene;
    if (sums->vertices > MAX_VERTICES || sums->indices > 3 * (size_t)MAX_VERTICES)
        return false;
    scene->name = copy_text(base_name(import->path));
    scene->vertices = calloc(sums->vertices + 1, sizeof *scene->vertices);
    scene->indices = calloc(sums->indices + 1, sizeof *scene->indices);
    scene->parts = calloc(sums->parts + 1, sizeof *scene->parts);
    scene->images = calloc(from->mNumMaterials + 1u, sizeof *scene->images);
    import->images_of_materials =
        calloc(from->mNumMaterials + 1u, sizeof *import->images_of_materials);
    return scene->name && scene->vertices && scene->indices && scene->parts && scene->images &&
           import->images_of_materials;
}

/* Pictures without tiles are baked in the background; what waits for them is the same in each run.
 */
static void wait_for_bakes(const struct scene_data *scene)
{
    const double end = clock_seconds() + BAKE_SECONDS;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        SluiceOpenedImageInfo info = {.structSize = sizeof info};
        while (sluiceGetOpenedImageInfo(scene->images[i].source, &info) == SLUICE_SUCCESS &&
               !info.ready && info.failure == SLUICE_SUCCESS && clock_seconds() < end)
            clock_sleep_until(clock_seconds() + 0.01);
    }
}

static bool create_opener(const char *cache, struct scene_data *scene)
{
    char folder[4096];
    if (!cache_path(cache, "pictures", folder, sizeof folder) || !files_make_folders(folder))
        return false;
    const SluiceImageOpenerCreateInfo info = {
        .structSize = sizeof info, .pCacheFolder = folder, .log = {NULL, log_say}};
    const SluiceResult result = sluiceCreateImageOpener(&info, &scene->opener);
    if (result != SLUICE_SUCCESS)
        text_say("sluice-view: %s", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static bool take_scene(struct import *import)
{
    struct sums sums;
    visit_all(import, &sums);
    if (!allocate(import, &sums)) {
        text_say("sluice-view: %s: too large, or out of memory", import->path);
        return false;
    }
    for (unsigned i = 0; i < import->from->mNumMaterials; i++)
        import->images_of_materials[i] = image_of_material(import, import->from->mMaterials[i]);
    visit_all(import, &sums);
    take_camera(import);
    if (import->scene->index_count > 0)
        return true;
    text_say("sluice-view: %s: has no triangles", import->path);
    return false;
}

bool scene_import(const char *path, const char *cache, bool wait, struct scene_data *scene)
{
    struct import import = {.path = path, .scene = scene};
    *scene = (struct scene_data){0};
    if (!create_opener(cache, scene))
        return false;
    import.from = aiImportFile(path, aiProcess_Triangulate | aiProcess_GenNormals |
                                         aiProcess_SortByPType | aiProcess_FlipUVs);
    bool taken = false;
    if (!import.from)
        text_say("sluice-view: %s: %s", path, aiGetErrorString());
    else
        taken = take_scene(&import);
    aiReleaseImport(import.from);
    free(import.images_of_materials);
    if (!taken)
        return false;
    scene_data_complete(scene);
    if (wait)
        wait_for_bakes(scene);
    return true;
}
