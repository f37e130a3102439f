#include "gltf_accessor.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_BYTES ((uint64_t)4 << 30)
#define WHERE_SIZE 64

static const char *place(enum gltf_kind kind, uint32_t i, char where[WHERE_SIZE])
{
    snprintf(where, WHERE_SIZE, "%s[%u]", gltf_kind_name(kind), i);
    return where;
}

static const cJSON *member(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

static bool check_buffer(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE], path[4096], cause[GLTF_CAUSE_SIZE] = "is no file";
    const cJSON *buffer = file->lists[GLTF_BUFFERS].items[i];
    const char *uri = cJSON_GetStringValue(member(buffer, "uri"));
    struct gltf_bytes *bytes = &file->buffers[i];
    uint64_t length = 0;
    place(GLTF_BUFFERS, i, where);
    if (!gltf_get_whole(file, buffer, where, "byteLength", 1, MAX_BYTES, &length))
        return false;
    if (uri && strncmp(uri, "data:", 5) == 0) {
        size_t size = 0;
        bytes->bytes = bytes->owned = gltf_decode_data_uri(uri, &size);
        bytes->size = size;
        if (!bytes->bytes)
            return gltf_fail(file, "%s: its data is no base64", where);
    } else if (uri) {
        if (!gltf_path(file, uri, path, sizeof path) || !gltf_read_file(path, bytes, cause))
            return gltf_fail(file, "%s: %.200s %s", where, uri, cause);
    } else if (i == 0 && file->chunk.bytes) {
        *bytes = file->chunk;
    } else {
        return gltf_fail(file, "%s has neither a file nor bytes", where);
    }
    if (length == 0 || bytes->size < length)
        return gltf_fail(file, "%s has %llu bytes; its byteLength is %llu", where,
                         (unsigned long long)bytes->size, (unsigned long long)length);
    bytes->size = length;
    return true;
}

/* Fields that are checked already. */
static uint64_t whole(const cJSON *object, const char *name, uint64_t otherwise)
{
    const cJSON *item = member(object, name);
    return cJSON_IsNumber(item) ? (uint64_t)item->valuedouble : otherwise;
}

struct gltf_bytes gltf_view_bytes(const struct gltf_file *file, uint32_t view)
{
    const cJSON *item = file->lists[GLTF_BUFFER_VIEWS].items[view];
    const struct gltf_bytes *buffer = &file->buffers[whole(item, "buffer", 0)];
    return (struct gltf_bytes){buffer->bytes + whole(item, "byteOffset", 0),
                               whole(item, "byteLength", 0), NULL};
}

static bool check_view(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE];
    const cJSON *view = file->lists[GLTF_BUFFER_VIEWS].items[i];
    uint64_t offset = 0, length = 0, stride = 4;
    uint32_t buffer;
    place(GLTF_BUFFER_VIEWS, i, where);
    if (!gltf_get_index(file, view, where, "buffer", GLTF_BUFFERS, &buffer) ||
        !gltf_get_whole(file, view, where, "byteOffset", 0, MAX_BYTES, &offset) ||
        !gltf_get_whole(file, view, where, "byteLength", 1, MAX_BYTES, &length) ||
        !gltf_get_whole(file, view, where, "byteStride", 4, 252, &stride))
        return false;
    if (buffer == GLTF_NONE || length == 0)
        return gltf_fail(file, "%s lacks buffer or byteLength", where);
    return offset + length <= file->buffers[buffer].size ||
           gltf_fail(file, "%s ends at byte %llu of %llu", where,
                     (unsigned long long)(offset + length),
                     (unsigned long long)file->buffers[buffer].size);
}

static uint32_t component_size(uint64_t type)
{
    return type == 5120 || type == 5121   ? 1
           : type == 5122 || type == 5123 ? 2
           : type == 5125 || type == 5126 ? 4
                                          : 0;
}

static uint32_t components_of(const char *type)
{
    static const struct {
        const char *name;
        uint32_t count;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                 {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (size_t i = 0; type && i < sizeof types / sizeof *types; i++)
        if (strcmp(type, types[i].name) == 0)
            return types[i].count;
    return 0;
}

static bool lies_within(struct gltf_file *file, const char *where, uint32_t view, uint64_t offset,
                        uint64_t stride, uint64_t element, uint64_t count)
{
    const uint64_t size = gltf_view_bytes(file, view).size;
    const uint64_t end = offset + stride * (count - 1) + element;
    return end <= size || gltf_fail(file, "%s ends at byte %llu of bufferViews[%u], which has %llu",
                                    where, (unsigned long long)end, view, (unsigned long long)size);
}

static uint64_t read_index(const uint8_t *at, uint64_t type)
{
    return type == 5121 ? at[0]
           : type == 5123
               ? at[0] | (uint64_t)at[1] << 8
               : at[0] | (uint64_t)at[1] << 8 | (uint64_t)at[2] << 16 | (uint64_t)at[3] << 24;
}

static bool check_sparse(struct gltf_file *file, const cJSON *sparse, const char *where,
                         const struct gltf_accessor *a)
{
    const cJSON *indices = member(sparse, "indices"), *values = member(sparse, "values");
    uint64_t count = 0, type = 0, index_at = 0, value_at = 0, last = 0;
    uint32_t index_view, value_view;
    if (!gltf_get_whole(file, sparse, where, "count", 1, a->count, &count) ||
        !gltf_get_whole(file, indices, where, "componentType", 5121, 5125, &type) ||
        !gltf_get_whole(file, indices, where, "byteOffset", 0, MAX_BYTES, &index_at) ||
        !gltf_get_whole(file, values, where, "byteOffset", 0, MAX_BYTES, &value_at) ||
        !gltf_get_index(file, indices, where, "bufferView", GLTF_BUFFER_VIEWS, &index_view) ||
        !gltf_get_index(file, values, where, "bufferView", GLTF_BUFFER_VIEWS, &value_view))
        return false;
    if (count == 0 || index_view == GLTF_NONE || value_view == GLTF_NONE || type == 5122 ||
        type == 5124)
        return gltf_fail(file, "%s.sparse is incomplete", where);
    const uint32_t size = component_size(type);
    if (!lies_within(file, where, index_view, index_at, size, size, count) ||
        !lies_within(file, where, value_view, value_at, a->element, a->element, count))
        return false;
    const uint8_t *bytes = gltf_view_bytes(file, index_view).bytes + index_at;
    for (uint64_t i = 0; i < count; i++) {
        const uint64_t index = read_index(bytes + i * size, type);
        if (index >= a->count || (i > 0 && index <= last))
            return gltf_fail(file, "%s.sparse has index %llu at %llu; they grow below %llu", where,
                             (unsigned long long)index, (unsigned long long)i,
                             (unsigned long long)a->count);
        last = index;
    }
    return true;
}

bool gltf_read_accessor(struct gltf_file *file, uint32_t i, struct gltf_accessor *a)
{
    char where[WHERE_SIZE];
    const cJSON *item = file->lists[GLTF_ACCESSORS].items[i];
    *a = (struct gltf_accessor){.sparse = member(item, "sparse") != NULL,
                                .normalized = cJSON_IsTrue(member(item, "normalized"))};
    place(GLTF_ACCESSORS, i, where);
    if (!gltf_get_whole(file, item, where, "count", 1, MAX_BYTES, &a->count) ||
        !gltf_get_whole(file, item, where, "componentType", 5120, 5126, &a->component_type) ||
        !gltf_get_whole(file, item, where, "byteOffset", 0, MAX_BYTES, &a->offset) ||
        !gltf_get_index(file, item, where, "bufferView", GLTF_BUFFER_VIEWS, &a->view))
        return false;
    a->components = components_of(cJSON_GetStringValue(member(item, "type")));
    a->element = (uint64_t)a->components * component_size(a->component_type);
    a->stride = a->view == GLTF_NONE ? a->element
                                     : whole(file->lists[GLTF_BUFFER_VIEWS].items[a->view],
                                             "byteStride", a->element);
    return (a->count > 0 && a->element > 0) ||
           gltf_fail(file, "%s lacks count, type or componentType", where);
}

static bool check_accessor(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE];
    struct gltf_accessor a;
    place(GLTF_ACCESSORS, i, where);
    if (!gltf_read_accessor(file, i, &a))
        return false;
    if (a.stride < a.element)
        return gltf_fail(file, "%s: its elements overlap", where);
    if (a.view == GLTF_NONE && (!a.sparse || a.count > 1u << 24))
        return gltf_fail(file, "%s has no bufferView", where);
    if (a.view != GLTF_NONE &&
        !lies_within(file, where, a.view, a.offset, a.stride, a.element, a.count))
        return false;
    return !a.sparse ||
           check_sparse(file, member(file->lists[GLTF_ACCESSORS].items[i], "sparse"), where, &a);
}

/* Returns true if an attribute may have the accessor's components. */
static bool fits(const char *attribute, const struct gltf_accessor *a)
{
    static const struct {
        const char *begin;
        uint32_t least, most;
    } rules[] = {{"POSITION", 3, 3}, {"NORMAL", 3, 3},  {"TANGENT", 4, 4}, {"TEXCOORD_", 2, 2},
                 {"COLOR_", 3, 4},   {"JOINTS_", 4, 4}, {"WEIGHTS_", 4, 4}};
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        if (strncmp(attribute, rules[i].begin, strlen(rules[i].begin)) == 0)
            return a->components >= rules[i].least && a->components <= rules[i].most &&
                   (i > 2 || a->component_type == 5126);
    return true;
}

static bool check_attributes(struct gltf_file *file, const cJSON *primitive, const char *where,
                             uint64_t *vertices)
{
    const cJSON *attributes = member(primitive, "attributes");
    struct gltf_accessor a;
    uint32_t index;
    if (!gltf_get_index(file, attributes, where, "POSITION", GLTF_ACCESSORS, &index))
        return false;
    if (index == GLTF_NONE)
        return gltf_fail(file, "%s has no POSITION", where);
    if (!gltf_read_accessor(file, index, &a))
        return false;
    *vertices = a.count;
    for (const cJSON *item = attributes->child; item; item = item->next) {
        if (!gltf_get_index(file, attributes, where, item->string, GLTF_ACCESSORS, &index) ||
            index == GLTF_NONE || !gltf_read_accessor(file, index, &a))
            return gltf_fail(file, "%s has an attribute twice", where);
        if (a.count != *vertices || !fits(item->string, &a))
            return gltf_fail(file, "%s.%.40s: accessors[%u] has %llu elements of %u components",
                             where, item->string, index, (unsigned long long)a.count, a.components);
    }
    return true;
}

static bool check_indices(struct gltf_file *file, const cJSON *primitive, const char *where,
                          uint64_t vertices)
{
    struct gltf_accessor a;
    uint32_t index;
    if (!gltf_get_index(file, primitive, where, "indices", GLTF_ACCESSORS, &index))
        return false;
    if (index == GLTF_NONE)
        return true;
    if (!gltf_read_accessor(file, index, &a))
        return false;
    if (a.components != 1 || a.sparse || a.view == GLTF_NONE ||
        (a.component_type != 5121 && a.component_type != 5123 && a.component_type != 5125))
        return gltf_fail(file, "%s.indices: accessors[%u] is no list of indices", where, index);
    const uint8_t *bytes = gltf_view_bytes(file, a.view).bytes + a.offset;
    for (uint64_t i = 0; i < a.count; i++)
        if (read_index(bytes + i * a.stride, a.component_type) >= vertices)
            return gltf_fail(file, "%s has index %llu, but %llu vertices", where,
                             (unsigned long long)read_index(bytes + i * a.stride, a.component_type),
                             (unsigned long long)vertices);
    return true;
}

static bool check_targets(struct gltf_file *file, const cJSON *primitive, const char *where,
                          uint64_t vertices)
{
    const cJSON *targets = member(primitive, "targets");
    struct gltf_accessor a;
    uint32_t index;
    for (const cJSON *target = targets ? targets->child : NULL; target; target = target->next)
        for (const cJSON *item = target->child; item; item = item->next)
            if (!item->string ||
                !gltf_get_index(file, target, where, item->string, GLTF_ACCESSORS, &index) ||
                index == GLTF_NONE || !gltf_read_accessor(file, index, &a) || a.count != vertices)
                return gltf_fail(file, "%s has a target that does not fit", where);
    return true;
}

static bool check_mesh(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE + 32];
    const cJSON *primitives = member(file->lists[GLTF_MESHES].items[i], "primitives");
    uint32_t number = 0, material;
    if (!cJSON_IsArray(primitives) || !primitives->child)
        return gltf_fail(file, "meshes[%u] has no primitives", i);
    for (const cJSON *p = primitives->child; p; p = p->next, number++) {
        uint64_t mode = 4, vertices = 0;
        snprintf(where, sizeof where, "meshes[%u].primitives[%u]", i, number);
        if (!gltf_get_whole(file, p, where, "mode", 0, 6, &mode) ||
            !gltf_get_index(file, p, where, "material", GLTF_MATERIALS, &material) ||
            !check_attributes(file, p, where, &vertices) ||
            !check_indices(file, p, where, vertices) || !check_targets(file, p, where, vertices))
            return false;
    }
    return true;
}

static bool check_children(struct gltf_file *file, uint32_t i, uint32_t *parents)
{
    const cJSON *children = member(file->lists[GLTF_NODES].items[i], "children");
    if (children && !cJSON_IsArray(children))
        return gltf_fail(file, "nodes[%u].children is no array", i);
    for (const cJSON *item = children ? children->child : NULL; item; item = item->next) {
        const double child = cJSON_GetNumberValue(item);
        if (!(child >= 0 && child < file->lists[GLTF_NODES].count))
            return gltf_fail(file, "nodes[%u] has a child that is no node", i);
        if (parents[(uint32_t)child] != GLTF_NONE)
            return gltf_fail(file, "nodes[%.0f] is a child twice", child);
        parents[(uint32_t)child] = i;
    }
    return true;
}

/* Checks the depth of a node. Each node has at most one parent, so a cycle never reaches a root. */
static bool check_depth(struct gltf_file *file, uint32_t i, const uint32_t *parents)
{
    uint32_t depth = 0;
    for (uint32_t node = i; parents[node] != GLTF_NONE; node = parents[node])
        if (++depth > GLTF_MAX_DEPTH)
            return gltf_fail(file, "nodes[%u] is within itself, or deeper than %u", i,
                             GLTF_MAX_DEPTH);
    return true;
}

static bool check_node(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE];
    const cJSON *node = file->lists[GLTF_NODES].items[i];
    float values[16];
    uint32_t index;
    place(GLTF_NODES, i, where);
    return gltf_get_index(file, node, where, "mesh", GLTF_MESHES, &index) &&
           gltf_get_index(file, node, where, "camera", GLTF_CAMERAS, &index) &&
           gltf_get_index(file, node, where, "skin", GLTF_SKINS, &index) &&
           gltf_get_floats(file, node, where, "matrix", 16, values) &&
           gltf_get_floats(file, node, where, "translation", 3, values) &&
           gltf_get_floats(file, node, where, "rotation", 4, values) &&
           gltf_get_floats(file, node, where, "scale", 3, values);
}

static bool check_nodes(struct gltf_file *file)
{
    const uint32_t count = file->lists[GLTF_NODES].count;
    uint32_t *parents = malloc((count + 1u) * sizeof *parents);
    bool good = parents != NULL || gltf_fail(file, "out of memory");
    if (good)
        memset(parents, 0xFF, (count + 1u) * sizeof *parents);
    for (uint32_t i = 0; good && i < count; i++)
        good = check_node(file, i) && check_children(file, i, parents);
    for (uint32_t i = 0; good && i < count; i++)
        good = check_depth(file, i, parents);
    free(parents);
    return good;
}

/* Checks an array of indices. */
static bool check_numbers(struct gltf_file *file, const cJSON *array, const char *where,
                          enum gltf_kind kind)
{
    if (array && !cJSON_IsArray(array))
        return gltf_fail(file, "%s is no array of %s", where, gltf_kind_name(kind));
    for (const cJSON *item = array ? array->child : NULL; item; item = item->next) {
        const double number = cJSON_GetNumberValue(item);
        if (!(number >= 0 && number < file->lists[kind].count))
            return gltf_fail(file, "%s names one of %s that is not there", where,
                             gltf_kind_name(kind));
    }
    return true;
}

static bool check_skin(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE];
    const cJSON *skin = file->lists[GLTF_SKINS].items[i], *joints = member(skin, "joints");
    struct gltf_accessor a;
    uint32_t matrices, skeleton;
    place(GLTF_SKINS, i, where);
    if (!check_numbers(file, joints, where, GLTF_NODES) ||
        !gltf_get_index(file, skin, where, "skeleton", GLTF_NODES, &skeleton) ||
        !gltf_get_index(file, skin, where, "inverseBindMatrices", GLTF_ACCESSORS, &matrices))
        return false;
    return matrices == GLTF_NONE ||
           (gltf_read_accessor(file, matrices, &a) && a.components == 16 &&
            a.component_type == 5126 && a.count >= (uint64_t)cJSON_GetArraySize(joints)) ||
           gltf_fail(file, "%s has fewer matrices than joints", where);
}

static bool check_image(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE];
    const cJSON *image = file->lists[GLTF_IMAGES].items[i];
    uint32_t view;
    return gltf_get_index(file, image, place(GLTF_IMAGES, i, where), "bufferView",
                          GLTF_BUFFER_VIEWS, &view);
}

static bool check_texture(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE];
    const cJSON *texture = file->lists[GLTF_TEXTURES].items[i];
    uint32_t index;
    static const char *const sources[] = {"KHR_texture_basisu", "EXT_texture_webp",
                                          "MSFT_texture_dds"};
    const cJSON *extensions = member(texture, "extensions");
    place(GLTF_TEXTURES, i, where);
    for (size_t k = 0; k < sizeof sources / sizeof *sources; k++)
        if (!gltf_get_index(file, member(extensions, sources[k]), where, "source", GLTF_IMAGES,
                            &index))
            return false;
    return gltf_get_index(file, texture, where, "source", GLTF_IMAGES, &index) &&
           gltf_get_index(file, texture, where, "sampler", GLTF_SAMPLERS, &index);
}

static bool check_scene(struct gltf_file *file, uint32_t i)
{
    char where[WHERE_SIZE];
    return check_numbers(file, member(file->lists[GLTF_SCENES].items[i], "nodes"),
                         place(GLTF_SCENES, i, where), GLTF_NODES);
}

/* Refuses required extensions that pack meshes. Other extensions are ignored. */
static bool check_extensions(struct gltf_file *file)
{
    static const char *const refused[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                          "KHR_mesh_quantization"};
    const cJSON *required = member(file->json, "extensionsRequired");
    for (const cJSON *item = required ? required->child : NULL; item; item = item->next)
        for (size_t i = 0; cJSON_IsString(item) && i < sizeof refused / sizeof *refused; i++)
            if (strcmp(item->valuestring, refused[i]) == 0)
                return gltf_fail(file, "requires %s, which is not supported", refused[i]);
    return true;
}

bool gltf_check(struct gltf_file *file)
{
    static bool (*const checks[GLTF_KIND_COUNT])(struct gltf_file *, uint32_t) = {
        [GLTF_BUFFERS] = check_buffer,
        [GLTF_BUFFER_VIEWS] = check_view,
        [GLTF_ACCESSORS] = check_accessor,
        [GLTF_MESHES] = check_mesh,
        [GLTF_SCENES] = check_scene,
        [GLTF_TEXTURES] = check_texture,
        [GLTF_IMAGES] = check_image,
        [GLTF_SKINS] = check_skin,
        [GLTF_ANIMATIONS] = gltf_check_animation};
    const cJSON *asset = member(file->json, "asset");
    const char *version = cJSON_GetStringValue(member(asset, "version"));
    uint32_t scene;
    if (!version || strncmp(version, "2.", 2) != 0)
        return gltf_fail(file, "is no glTF of version 2");
    if (!check_extensions(file))
        return false;
    for (int kind = 0; kind < GLTF_KIND_COUNT; kind++)
        for (uint32_t i = 0; checks[kind] && i < file->lists[kind].count; i++)
            if (!checks[kind](file, i))
                return false;
    return check_nodes(file) &&
           gltf_get_index(file, file->json, "the file", "scene", GLTF_SCENES, &scene);
}
