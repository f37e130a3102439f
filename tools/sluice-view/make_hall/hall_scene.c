#include "hall_scene.h"

#include "hall_geometry.h"

#include <cjson/cJSON.h>

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MADE_ELSEWHERE 4u ///< textures of normals and of roughness, the first ones in the file
#define MOST_INDICES (HALL_MOST_VERTICES / 4 * 6)

enum { FLOATS = 5126, SHORTS = 5123 }; // component types of glTF

static const struct {
    const char *name;
    double color[4], emissive[3], metalness, roughness;
} groups_of[GROUPS] = {
    {"walls", {0.085, 0.16, 0.175, 1}, {0}, 0, 0.95},
    {"ceiling", {0.8, 0.78, 0.74, 1}, {0.13, 0.13, 0.125}, 0, 1},
    {"skylights", {0, 0, 0, 1}, {0.93, 0.96, 1}, 0, 1},
    {"gilded frames", {0.83, 0.6, 0.25, 1}, {0}, 1, 0.45},
    {"wooden frames", {0.055, 0.03, 0.02, 1}, {0}, 0, 0.4},
    {"trim", {0.62, 0.6, 0.56, 1}, {0}, 0, 0.7},
};

/* Positions of the camera, and its rotation to the left about the y axis, in radians. */
static const struct {
    double seconds, x, y, z, turn;
} walk[] = {{0, 0, 1.3, 3, 0},         {4, 0, 1.3, -7, 0},        {7, 0.4, 1.3, -14, -0.8},
            {10, -0.6, 1.3, -20, 0.6}, {14, 0.3, 1.3, -31, -0.5}, {18, 0, 1.3, -41, 0}};
#define WALK_KEYS (sizeof walk / sizeof walk[0])

/* The JSON being built, and the bytes of its accessors. */
struct gltf {
    cJSON *root, *accessors, *materials, *meshes, *nodes, *children;
    struct mesh all;       ///< vertices of all meshes
    uint32_t most_indices; ///< largest number of indices in a mesh
};

static cJSON *add_array(cJSON *object, const char *name)
{
    cJSON *array = cJSON_CreateArray();
    cJSON_AddItemToObject(object, name, array);
    return array;
}

static cJSON *add_entry(cJSON *array)
{
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddItemToArray(array, entry);
    return entry;
}

static void add_numbers(cJSON *object, const char *name, const double *numbers, int count)
{
    cJSON_AddItemToObject(object, name, cJSON_CreateDoubleArray(numbers, count));
}

/* Adds an accessor. Returns its index. */
static int add_accessor(struct gltf *g, int view, size_t offset, int type, size_t count,
                        const char *shape)
{
    cJSON *accessor = add_entry(g->accessors);
    cJSON_AddNumberToObject(accessor, "bufferView", view);
    cJSON_AddNumberToObject(accessor, "byteOffset", (double)offset);
    cJSON_AddNumberToObject(accessor, "componentType", type);
    cJSON_AddNumberToObject(accessor, "count", (double)count);
    cJSON_AddStringToObject(accessor, "type", shape);
    return cJSON_GetArraySize(g->accessors) - 1;
}

static void add_limits(cJSON *accessor, const struct mesh *mesh)
{
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (uint32_t v = 0; v < mesh->count; v++)
        for (int i = 0; i < 3; i++) {
            const double at = (double)mesh->vertices[v].position[i];
            low[i] = at < low[i] ? at : low[i];
            high[i] = at > high[i] ? at : high[i];
        }
    add_numbers(accessor, "min", low, 3);
    add_numbers(accessor, "max", high, 3);
}

/* Adds a mesh, and a node that shows it. Its material is the next one to be added. View 0 has the
 * vertices. View 1 has indices for the quads of the largest mesh. */
static void add_mesh(struct gltf *g, const char *name, const struct mesh *mesh)
{
    const size_t first = g->all.count * sizeof(struct vertex);
    for (uint32_t v = 0; v < mesh->count; v++)
        g->all.vertices[g->all.count++] = mesh->vertices[v];
    if (mesh->count / 4 * 6 > g->most_indices)
        g->most_indices = mesh->count / 4 * 6;
    cJSON *entry = add_entry(g->meshes), *node = add_entry(g->nodes);
    cJSON *primitive = add_entry(add_array(entry, "primitives"));
    cJSON *attributes = cJSON_AddObjectToObject(primitive, "attributes");
    const int position = add_accessor(g, 0, first, FLOATS, mesh->count, "VEC3");
    add_limits(cJSON_GetArrayItem(g->accessors, position), mesh);
    cJSON_AddNumberToObject(attributes, "POSITION", position);
    cJSON_AddNumberToObject(
        attributes, "NORMAL",
        add_accessor(g, 0, first + offsetof(struct vertex, normal), FLOATS, mesh->count, "VEC3"));
    cJSON_AddNumberToObject(
        attributes, "TEXCOORD_0",
        add_accessor(g, 0, first + offsetof(struct vertex, uv), FLOATS, mesh->count, "VEC2"));
    cJSON_AddNumberToObject(primitive, "indices",
                            add_accessor(g, 1, 0, SHORTS, mesh->count / 4 * 6, "SCALAR"));
    cJSON_AddNumberToObject(primitive, "material", cJSON_GetArraySize(g->materials));
    cJSON_AddStringToObject(entry, "name", name);
    cJSON_AddStringToObject(node, "name", name);
    cJSON_AddNumberToObject(node, "mesh", cJSON_GetArraySize(g->meshes) - 1);
    cJSON_AddItemToArray(g->children, cJSON_CreateNumber(cJSON_GetArraySize(g->nodes) - 1));
}

/* Adds a texture, and returns its entry. Writes `repeat` unless it is {1, 1}. */
static cJSON *add_texture(cJSON *object, const char *name, uint32_t texture, double repeat_u,
                          double repeat_v)
{
    cJSON *entry = cJSON_AddObjectToObject(object, name);
    cJSON_AddNumberToObject(entry, "index", texture);
    if (repeat_u != 1 || repeat_v != 1) {
        cJSON *extensions = cJSON_AddObjectToObject(entry, "extensions");
        add_numbers(cJSON_AddObjectToObject(extensions, "KHR_texture_transform"), "scale",
                    (double[]){repeat_u, repeat_v}, 2);
    }
    return entry;
}

/* Adds the material of a painting. Every third has normals of canvas, every second has roughness:
 * textures follow primaries of another size. */
static void add_picture_material(struct gltf *g, const char *name, uint32_t number)
{
    cJSON *material = add_entry(g->materials);
    cJSON_AddStringToObject(material, "name", name);
    cJSON *rough = cJSON_AddObjectToObject(material, "pbrMetallicRoughness");
    add_texture(rough, "baseColorTexture", MADE_ELSEWHERE + number, 1,
                number == HALL_FLOOR ? (double)((HALL_FRONT - HALL_BACK) / (2 * HALL_WALL)) : 1);
    cJSON_AddNumberToObject(rough, "metallicFactor", 0);
    cJSON_AddNumberToObject(rough, "roughnessFactor", number == HALL_FLOOR ? 0.55 : 0.8);
    if (number != HALL_FLOOR && (number % 2 == 1 || number % 6 == 0))
        add_texture(rough, "metallicRoughnessTexture", number % 2 == 1 ? 3 : 2, 1, 1);
    if (number != HALL_FLOOR && number % 3 == 0)
        add_texture(material, "normalTexture", number % 2 == 1 ? 1 : 0, 4, 4);
}

static void add_group_material(struct gltf *g, int group)
{
    cJSON *material = add_entry(g->materials);
    cJSON_AddStringToObject(material, "name", groups_of[group].name);
    cJSON *rough = cJSON_AddObjectToObject(material, "pbrMetallicRoughness");
    add_numbers(rough, "baseColorFactor", groups_of[group].color, 4);
    cJSON_AddNumberToObject(rough, "metallicFactor", groups_of[group].metalness);
    cJSON_AddNumberToObject(rough, "roughnessFactor", groups_of[group].roughness);
    add_numbers(material, "emissiveFactor", groups_of[group].emissive, 3);
}

static void add_image(cJSON *images, cJSON *textures, const char *path, bool repeats)
{
    cJSON *texture = add_entry(textures);
    cJSON_AddNumberToObject(texture, "sampler", repeats ? 0 : 1);
    cJSON_AddNumberToObject(texture, "source", cJSON_GetArraySize(images));
    cJSON_AddStringToObject(add_entry(images), "uri", path);
}

static void add_images(struct gltf *g)
{
    static const char *const made_elsewhere[MADE_ELSEWHERE] = {
        "textures/normal_512.png", "textures/normal_1024.png", "textures/orm_256.png",
        "textures/orm_2048.png"};
    cJSON *samplers = add_array(g->root, "samplers"), *images = add_array(g->root, "images");
    cJSON *textures = add_array(g->root, "textures");
    for (int i = 0; i < 2; i++) { /* repeat, clamp */
        cJSON *sampler = add_entry(samplers);
        cJSON_AddNumberToObject(sampler, "magFilter", 9729);
        cJSON_AddNumberToObject(sampler, "minFilter", 9987);
        cJSON_AddNumberToObject(sampler, "wrapS", i == 0 ? 10497 : 33071);
        cJSON_AddNumberToObject(sampler, "wrapT", i == 0 ? 10497 : 33071);
    }
    for (uint32_t i = 0; i < MADE_ELSEWHERE; i++)
        add_image(images, textures, made_elsewhere[i], true);
    for (uint32_t i = 0; i <= HALL_FLOOR; i++)
        add_image(images, textures, hall_picture(i).path, i == HALL_FLOOR);
}

static void add_meshes(struct gltf *g, struct mesh *groups, struct mesh *one)
{
    for (uint32_t i = 0; i <= HALL_FLOOR; i++) {
        char name[32];
        one->count = 0;
        if (i < HALL_FLOOR)
            hall_add_painting(one, groups, i);
        else
            hall_add_quad(one, (float[]){-HALL_WALL, 0, HALL_BACK}, (float[]){2 * HALL_WALL, 0, 0},
                          (float[]){0, 0, HALL_FRONT - HALL_BACK});
        snprintf(name, sizeof name, i < HALL_FLOOR ? "panel %02u" : "floor", i);
        add_mesh(g, name, one);
        add_picture_material(g, name, i);
    }
    hall_add_room(groups);
    for (int i = 0; i < GROUPS; i++) {
        add_mesh(g, groups_of[i].name, &groups[i]);
        add_group_material(g, i);
    }
}

/* Adds the camera and its walk. Views 2 to 4 have the keys. */
static void add_camera(struct gltf *g)
{
    cJSON *camera = add_entry(add_array(g->root, "cameras")), *node = add_entry(g->nodes);
    const int number = cJSON_GetArraySize(g->nodes) - 1;
    cJSON_AddStringToObject(camera, "type", "perspective");
    cJSON *lens = cJSON_AddObjectToObject(camera, "perspective");
    cJSON_AddNumberToObject(lens, "yfov", 1);
    cJSON_AddNumberToObject(lens, "znear", 0.05);
    cJSON_AddNumberToObject(lens, "zfar", 100);
    cJSON_AddStringToObject(node, "name", "camera");
    cJSON_AddNumberToObject(node, "camera", 0);
    add_numbers(node, "translation", (double[]){walk[0].x, walk[0].y, walk[0].z}, 3);
    cJSON_AddItemToArray(g->children, cJSON_CreateNumber(number));

    cJSON *animation = add_entry(add_array(g->root, "animations"));
    cJSON_AddStringToObject(animation, "name", "walk");
    cJSON *samplers = add_array(animation, "samplers"),
          *channels = add_array(animation, "channels");
    const int times = add_accessor(g, 2, 0, FLOATS, WALK_KEYS, "SCALAR");
    cJSON *limits = cJSON_GetArrayItem(g->accessors, times);
    add_numbers(limits, "min", (double[]){walk[0].seconds}, 1);
    add_numbers(limits, "max", (double[]){walk[WALK_KEYS - 1].seconds}, 1);
    for (int i = 0; i < 2; i++) {
        cJSON *sampler = add_entry(samplers), *channel = add_entry(channels);
        cJSON_AddNumberToObject(sampler, "input", times);
        cJSON_AddNumberToObject(
            sampler, "output",
            add_accessor(g, 3 + i, 0, FLOATS, WALK_KEYS, i == 0 ? "VEC3" : "VEC4"));
        cJSON_AddStringToObject(sampler, "interpolation", "LINEAR");
        cJSON_AddNumberToObject(channel, "sampler", i);
        cJSON *target = cJSON_AddObjectToObject(channel, "target");
        cJSON_AddNumberToObject(target, "node", number);
        cJSON_AddStringToObject(target, "path", i == 0 ? "translation" : "rotation");
    }
}

/* Writes hall.bin: vertices, indices of quads, then times, positions and rotations of the walk. */
static bool write_bytes(struct gltf *g, const char *path)
{
    FILE *file = fopen(path, "wb");
    cJSON *views = add_array(g->root, "bufferViews");
    uint16_t *indices = malloc(MOST_INDICES * sizeof *indices);
    float times[WALK_KEYS], places[WALK_KEYS][3], turns[WALK_KEYS][4] = {{0}};
    if (!file || !indices)
        return false;
    for (uint32_t i = 0; i < MOST_INDICES; i++)
        indices[i] = (uint16_t)(i / 6 * 4 + (const uint16_t[]){0, 2, 1, 1, 2, 3}[i % 6]);
    for (uint32_t i = 0; i < WALK_KEYS; i++) {
        times[i] = (float)walk[i].seconds;
        places[i][0] = (float)walk[i].x;
        places[i][1] = (float)walk[i].y;
        places[i][2] = (float)walk[i].z;
        turns[i][1] = (float)sin(walk[i].turn / 2);
        turns[i][3] = (float)cos(walk[i].turn / 2);
    }
    const struct {
        const void *data;
        size_t size;
        int stride, target; ///< 0: none
    } parts[5] = {
        {g->all.vertices, g->all.count * sizeof(struct vertex), sizeof(struct vertex), 34962},
        {indices, g->most_indices * sizeof *indices, 0, 34963},
        {times, sizeof times, 0, 0},
        {places, sizeof places, 0, 0},
        {turns, sizeof turns, 0, 0}};
    size_t offset = 0;
    bool written = true;
    for (int i = 0; i < 5; i++) {
        cJSON *view = add_entry(views);
        cJSON_AddNumberToObject(view, "buffer", 0);
        cJSON_AddNumberToObject(view, "byteOffset", (double)offset);
        cJSON_AddNumberToObject(view, "byteLength", (double)parts[i].size);
        if (parts[i].stride)
            cJSON_AddNumberToObject(view, "byteStride", parts[i].stride);
        if (parts[i].target)
            cJSON_AddNumberToObject(view, "target", parts[i].target);
        written = fwrite(parts[i].data, 1, parts[i].size, file) == parts[i].size && written;
        offset += parts[i].size;
    }
    cJSON *buffer = add_entry(add_array(g->root, "buffers"));
    cJSON_AddStringToObject(buffer, "uri", "hall.bin");
    cJSON_AddNumberToObject(buffer, "byteLength", (double)offset);
    free(indices);
    return fclose(file) == 0 && written;
}

static bool write_text(const cJSON *root, const char *path)
{
    char *text = cJSON_Print(root);
    FILE *file = fopen(path, "w");
    const bool written = text && file && fputs(text, file) >= 0 && fputc('\n', file) >= 0;
    free(text);
    return file && fclose(file) == 0 && written;
}

bool hall_scene_write(const char *folder)
{
    char path[4096];
    struct vertex *vertices = calloc(HALL_MOST_VERTICES * (GROUPS + 2), sizeof *vertices);
    struct mesh groups[GROUPS], one = {vertices, 0};
    struct gltf g = {.root = cJSON_CreateObject()};
    if (!vertices)
        return false;
    g.all.vertices = vertices + HALL_MOST_VERTICES;
    for (uint32_t i = 0; i < GROUPS; i++)
        groups[i] = (struct mesh){vertices + HALL_MOST_VERTICES * (i + 2), 0};
    cJSON *asset = cJSON_AddObjectToObject(g.root, "asset");
    cJSON_AddStringToObject(asset, "version", "2.0");
    cJSON_AddStringToObject(asset, "generator", "make-hall");
    cJSON_AddStringToObject(asset, "copyright", "CC0");
    cJSON_AddNumberToObject(g.root, "scene", 0);
    cJSON *used = add_array(g.root, "extensionsUsed");
    cJSON_AddItemToArray(used, cJSON_CreateString("KHR_texture_transform"));
    add_images(&g);
    g.materials = add_array(g.root, "materials");
    g.meshes = add_array(g.root, "meshes");
    g.nodes = add_array(g.root, "nodes");
    g.children = add_array(add_entry(add_array(g.root, "scenes")), "nodes");
    g.accessors = add_array(g.root, "accessors");
    add_meshes(&g, groups, &one);
    add_camera(&g);
    snprintf(path, sizeof path, "%s/hall.bin", folder);
    bool written = write_bytes(&g, path);
    snprintf(path, sizeof path, "%s/hall.gltf", folder);
    written = written && write_text(g.root, path);
    if (!written)
        fprintf(stderr, "make-hall: cannot write hall.gltf and hall.bin in %s\n", folder);
    cJSON_Delete(g.root);
    free(vertices);
    return written;
}
