/* strdup */
#define _XOPEN_SOURCE 700

#include "scene_import.h"

#include "gltf_geometry.h"
#include "scene_gltf.h"
#include "scene_images.h"

#include "../common/text.h"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <vulkan/vulkan_core.h>

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_VERTICES (64u << 20)
#define MAX_DEPTH (GLTF_MAX_DEPTH + 2) /* Assimp adds a root */
#define MAX_NODES 1000000u
#define MAX_KEYS 100000u
#define STACK_SIZE ((size_t)256 << 20)

struct import {
    const struct aiScene *from;
    const char *path, *cache;
    struct scene_data *scene;
    struct gltf_file gltf;
    bool is_gltf;
};

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static int wrap_of(enum aiTextureMapMode mode)
{
    switch (mode) {
    case aiTextureMapMode_Clamp: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case aiTextureMapMode_Mirror: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default: return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }
}

/* Adds an image. Reports an image that cannot be opened. */
static uint32_t add_image(struct import *import, const char *name, const int wraps[2])
{
    char path[4096];
    const char *slash = strrchr(import->path, '/');
    const int length = name[0] != '/' && slash ? (int)(slash - import->path) + 1 : 0;
    const struct scene_image_request request = {base_name(path), path, wraps[0], wraps[1],
                                                CONTENT_COLORS};
    if (name[0] == '*') {
        scene_data_note(import->scene, "%s: image %s is inside the file, which is not supported",
                        import->path, name);
        return SCENE_NO_IMAGE;
    }
    if (snprintf(path, sizeof path, "%.*s%s", length, import->path, name) >= (int)sizeof path)
        return SCENE_NO_IMAGE;
    struct scene_image_request named = request;
    named.name = base_name(path);
    return scene_images_add(import->scene, &named);
}

/* Converts a transform of Assimp, whose V points up (v = 1 - V), to V down. */
static void read_transform(const struct aiMaterial *material, enum aiTextureType type, float m[6])
{
    struct aiUVTransform t;
    if (aiGetMaterialUVTransform(material, AI_MATKEY_UVTRANSFORM(type, 0), &t) != aiReturn_SUCCESS)
        return;
    const float c = cosf(t.mRotation), s = sinf(t.mRotation);
    const float up[4] = {c * t.mScaling.x, -s * t.mScaling.y, s * t.mScaling.x, c * t.mScaling.y};
    const float down[6] = {
        up[0], -up[1], -up[2], up[3], up[1] + t.mTranslation.x, 1 - up[3] - t.mTranslation.y};
    for (int i = 0; i < 6; i++)
        if (!isfinite(down[i]))
            return;
    memcpy(m, down, sizeof down);
}

static void read_color_image(struct import *import, const struct aiMaterial *from,
                             struct scene_material *to)
{
    struct aiString name, mask;
    enum aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    enum aiTextureType type = aiTextureType_BASE_COLOR;
    if (aiGetMaterialTextureCount(from, type) == 0)
        type = aiTextureType_DIFFUSE;
    if (aiGetMaterialTexture(from, type, 0, &name, NULL, NULL, NULL, NULL, modes, NULL) !=
        aiReturn_SUCCESS)
        return;
    const int wraps[2] = {wrap_of(modes[0]), wrap_of(modes[1])};
    to->slots[SLOT_COLOR].image = add_image(import, name.data, wraps);
    to->missing = to->slots[SLOT_COLOR].image == SCENE_NO_IMAGE;
    read_transform(from, type, to->slots[SLOT_COLOR].m);
    if (aiGetMaterialTexture(from, aiTextureType_OPACITY, 0, &mask, NULL, NULL, NULL, NULL, NULL,
                             NULL) != aiReturn_SUCCESS)
        return;
    to->alpha = ALPHA_MASK;
    if (strcmp(mask.data, name.data) != 0)
        scene_data_note(import->scene, "%s: opacity image %s is not supported", import->path,
                        mask.data);
}

static void read_material(struct import *import, const struct aiMaterial *from,
                          struct scene_material *to)
{
    struct aiColor4D color = {1, 1, 1, 1};
    scene_material_init(to);
    if (aiGetMaterialColor(from, "$clr.base", 0, 0, &color) != aiReturn_SUCCESS)
        aiGetMaterialColor(from, AI_MATKEY_COLOR_DIFFUSE, &color);
    const float channels[4] = {color.r, color.g, color.b, color.a};
    for (int i = 0; i < 4; i++)
        to->color[i] = isfinite(channels[i]) ? channels[i] : 1.0f;
    read_color_image(import, from, to);
}

/* Takes materials of files other than glTF. */
static bool take_materials(struct import *import)
{
    const uint32_t count = import->from->mNumMaterials;
    struct scene_data *scene = import->scene;
    scene->materials = calloc(count + 1u, sizeof *scene->materials);
    scene->images = calloc(count + 1u, sizeof *scene->images);
    if (!scene->materials || !scene->images)
        return false;
    scene->material_count = count + 1;
    for (uint32_t i = 0; i < count; i++)
        read_material(import, import->from->mMaterials[i], &scene->materials[i]);
    scene_material_init(&scene->materials[count]);
    return true;
}

static void add_vertices(struct import *import, const struct aiMesh *mesh,
                         const struct aiMatrix4x4 *to_world)
{
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
        *v = (struct scene_vertex){{p.x, p.y, p.z}, {n.x, n.y, n.z}, {{0}}};
        for (int set = 0; set < 2; set++)
            if (mesh->mTextureCoords[set])
                memcpy(v->uv[set], &mesh->mTextureCoords[set][i], sizeof v->uv[set]);
    }
}

/* Assimp does not check indices. */
static bool is_triangle(const struct aiMesh *mesh, const struct aiFace *face)
{
    for (unsigned k = 0; face->mNumIndices == 3 && k < 3; k++)
        if (face->mIndices[k] >= mesh->mNumVertices)
            return false;
    return face->mNumIndices == 3;
}

/* The last material is for meshes without one. */
static uint32_t material_of(const struct import *import, const struct aiMesh *mesh)
{
    const uint32_t last = import->scene->material_count - 1;
    const uint32_t index = mesh->mMaterialIndex;
    if (index >= import->from->mNumMaterials)
        return last;
    return import->is_gltf ? gltf_material_number(&import->gltf, import->from->mMaterials[index])
                           : index;
}

/* Mirrored triangles turn the other way. */
static void add_mesh(struct import *import, const struct aiMesh *mesh,
                     const struct aiMatrix4x4 *to_world)
{
    struct scene_data *scene = import->scene;
    const uint32_t first = scene->vertex_count;
    const bool mirrored = aiMatrix4Determinant(to_world) < 0;
    struct scene_part *part = &scene->parts[scene->part_count++];
    *part = (struct scene_part){.first_index = scene->index_count};
    part->material = material_of(import, mesh);
    add_vertices(import, mesh, to_world);
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        for (unsigned k = 0; is_triangle(mesh, face) && k < 3; k++)
            scene->indices[scene->index_count++] = first + face->mIndices[mirrored ? 2 - k : k];
    }
    part->index_count = scene->index_count - part->first_index;
}

/* Sums over all visited nodes. Assimp refuses cycles. Depth and sums are bounded here. */
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

/* Returns a camera of the file at a position and rotation. `parent`: matrix of its parent node. */
static struct view_camera camera_of(const struct aiCamera *camera, struct aiVector3D position,
                                    const struct aiQuaternion *rotation,
                                    const struct aiMatrix4x4 *parent)
{
    struct aiMatrix3x3 turn, outer;
    struct aiVector3D look = camera->mLookAt;
    aiMatrix3FromQuaternion(&turn, rotation);
    aiTransformVecByMatrix3(&look, &turn);
    aiMatrix3FromMatrix4(&outer, parent);
    aiTransformVecByMatrix3(&look, &outer);
    aiTransformVecByMatrix4(&position, parent);
    const struct vec3 eye = {position.x, position.y, position.z};
    const float aspect = camera->mAspect > 0 ? camera->mAspect : 1.777f;
    const float fov = 2 * atanf(tanf(camera->mHorizontalFOV / 2) / aspect);
    return view_camera_at(eye, vec3_add(eye, (struct vec3){look.x, look.y, look.z}),
                          fov > 0.2f && fov < 2.5f ? fov : 1.0f);
}

/* Returns a camera at a time. Positions interpolate linearly; rotations take the previous key. */
static struct view_camera camera_at_time(const struct aiCamera *camera,
                                         const struct aiNodeAnim *channel, double time,
                                         const struct aiMatrix4x4 *parent)
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
    return camera_of(camera, at, &channel->mRotationKeys[r].mValue, parent);
}

static void take_path(struct import *import, const struct aiCamera *camera,
                      const struct aiNodeAnim *channel, double ticks,
                      const struct aiMatrix4x4 *parent)
{
    const double per_second = ticks > 0 ? ticks : 1000.0;
    if (channel->mNumPositionKeys == 0 || channel->mNumRotationKeys == 0)
        return;
    float last = -1;
    for (unsigned i = 0; i < channel->mNumRotationKeys && i < MAX_KEYS; i++) {
        const double time = channel->mRotationKeys[i].mTime;
        const struct view_camera at = camera_at_time(camera, channel, time, parent);
        if ((float)(time / per_second) > last)
            camera_path_add(&import->scene->tour, last = (float)(time / per_second), &at);
    }
    for (unsigned i = 0;
         i < channel->mNumPositionKeys && channel->mNumRotationKeys == 1 && i < MAX_KEYS; i++) {
        const double time = channel->mPositionKeys[i].mTime;
        const struct view_camera at = camera_at_time(camera, channel, time, parent);
        if ((float)(time / per_second) > last)
            camera_path_add(&import->scene->tour, last = (float)(time / per_second), &at);
    }
}

static const struct aiNode *find_node(const struct aiNode *node, const char *name, unsigned depth)
{
    const struct aiNode *found = strcmp(node->mName.data, name) == 0 ? node : NULL;
    for (unsigned i = 0; !found && depth < MAX_DEPTH && i < node->mNumChildren; i++)
        found = find_node(node->mChildren[i], name, depth + 1);
    return found;
}

static struct aiMatrix4x4 world_of(const struct aiNode *node)
{
    struct aiMatrix4x4 product, inner;
    aiIdentityMatrix4(&product);
    for (; node; node = node->mParent) {
        inner = product;
        product = node->mTransformation;
        aiMultiplyMatrix4(&product, &inner);
    }
    return product;
}

static void take_camera(struct import *import)
{
    const struct aiScene *from = import->from;
    const struct aiCamera *camera = from->mNumCameras > 0 ? from->mCameras[0] : NULL;
    const struct aiNode *node = camera ? find_node(from->mRootNode, camera->mName.data, 0) : NULL;
    if (!node)
        return;
    const struct aiMatrix4x4 parent = world_of(node->mParent);
    struct aiVector3D scaling, position;
    struct aiQuaternion rotation;
    aiDecomposeMatrix(&node->mTransformation, &scaling, &rotation, &position);
    import->scene->camera = camera_of(camera, position, &rotation, &parent);
    for (unsigned a = 0; a < from->mNumAnimations; a++)
        for (unsigned c = 0; c < from->mAnimations[a]->mNumChannels; c++)
            if (import->scene->tour.count == 0 &&
                strcmp(from->mAnimations[a]->mChannels[c]->mNodeName.data, camera->mName.data) == 0)
                take_path(import, camera, from->mAnimations[a]->mChannels[c],
                          from->mAnimations[a]->mTicksPerSecond, &parent);
}

static bool allocate(struct import *import, const struct sums *sums)
{
    struct scene_data *scene = import->scene;
    if (sums->vertices > MAX_VERTICES || sums->indices > 3 * (size_t)MAX_VERTICES)
        return false;
    scene->name = strdup(base_name(import->path));
    scene->vertices = calloc(sums->vertices + 1, sizeof *scene->vertices);
    scene->indices = calloc(sums->indices + 1, sizeof *scene->indices);
    scene->parts = calloc(sums->parts + 1, sizeof *scene->parts);
    return scene->name && scene->vertices && scene->indices && scene->parts;
}

static bool take_scene(struct import *import)
{
    struct sums sums;
    if (import->is_gltf ? !scene_gltf_materials(&import->gltf, import->cache, import->scene)
                        : !take_materials(import))
        return false;
    visit_all(import, &sums);
    if (!allocate(import, &sums)) {
        text_say("sluice-view: %s: too large, or out of memory", import->path);
        return false;
    }
    visit_all(import, &sums);
    if (!import->is_gltf)
        take_camera(import);
    else if (!scene_gltf_cameras(&import->gltf, import->scene))
        return false;
    if (import->scene->index_count > 0)
        return true;
    text_say("sluice-view: %s: has no triangles", import->path);
    return false;
}

/* For Assimp, and for functions that recurse into its nodes. */
static void *import_file(void *user)
{
    struct import *import = user;
    const unsigned flags =
        aiProcess_Triangulate | aiProcess_GenNormals | aiProcess_SortByPType | aiProcess_FlipUVs;
    import->from = import->is_gltf ? gltf_import_geometry(&import->gltf, flags)
                                   : aiImportFile(import->path, flags);
    if (!import->from)
        text_say("sluice-view: %s: %s", import->path, aiGetErrorString());
    const bool taken = import->from && take_scene(import);
    aiReleaseImport(import->from);
    return taken ? import : NULL;
}

/* Assimp recurses into its input, so the stack is large. Unused parts of the stack cost no memory.
 */
static bool import_on_thread(struct import *import)
{
    pthread_attr_t attributes;
    pthread_t thread;
    void *taken = NULL;
    if (pthread_attr_init(&attributes) != 0)
        return false;
    const bool began = pthread_attr_setstacksize(&attributes, STACK_SIZE) == 0 &&
                       pthread_create(&thread, &attributes, import_file, import) == 0;
    pthread_attr_destroy(&attributes);
    if (!began)
        text_say("sluice-view: no thread for %s", import->path);
    return began && pthread_join(thread, &taken) == 0 && taken;
}

bool scene_import(const char *path, const char *cache, bool wait, struct scene_data *scene)
{
    struct import import = {
        .path = path, .cache = cache, .scene = scene, .is_gltf = gltf_is_name(path)};
    bool taken = scene_images_create_opener(cache, scene);
    if (taken && import.is_gltf && !gltf_open(path, &import.gltf)) {
        text_say("sluice-view: %s", import.gltf.error);
        taken = false;
    }
    taken = taken && import_on_thread(&import);
    if (import.is_gltf)
        gltf_finish(&import.gltf);
    if (!taken)
        return false;
    scene_data_find_sets(scene);
    scene_data_complete(scene);
    if (wait)
        scene_images_wait(scene);
    return true;
}
