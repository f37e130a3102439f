#include "meshes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/text.h"

#define AHEAD (MESH_READER_ROOM / 2) /* meshes that are read while another one is built */

/** A PLY file. Shapes that share a file share the pointer `path`. */
struct known_file {
    const char *path;
    uint32_t mesh;
};

static uint32_t hash_pointer(const void *pointer)
{
    uint64_t x = (uint64_t)(uintptr_t)pointer * 0x9e3779b97f4a7c15u;
    return (uint32_t)(x >> 32);
}

static struct known_file *find_file(struct known_file *files, uint32_t mask, const char *path)
{
    uint32_t at = hash_pointer(path) & mask;
    while (files[at].path && files[at].path != path)
        at = (at + 1) & mask;
    return &files[at];
}

static void assign(const struct scene *scene, struct known_file *files, uint32_t mask,
                   struct meshes *m)
{
    for (uint32_t i = 0; i < scene->info.shapeCount; i++) {
        const SluicePbrtShape shape = scene_shape(scene, i);
        struct known_file *file = shape.pPlyPath ? find_file(files, mask, shape.pPlyPath) : NULL;
        if (file && file->path) {
            m->of_shape[i] = file->mesh;
            continue;
        }
        if (file)
            *file = (struct known_file){shape.pPlyPath, m->count};
        m->of_shape[i] = m->count;
        m->items[m->count++].shape = i;
    }
}

bool meshes_create(const struct gpu *gpu, const struct scene *scene,
                   const struct mesh_reading *reading, struct meshes *m)
{
    const uint32_t count = scene->info.shapeCount;
    uint32_t size = 2;
    while (size < 2 * (uint64_t)count)
        size *= 2;
    *m = (struct meshes){.data = {.usage = structures_input_usage(gpu), .mapped = true},
                         .table.element = sizeof(struct PbrtMesh)};
    struct known_file *files = calloc(size, sizeof *files);
    m->items = calloc(count + 1u, sizeof *m->items);
    m->of_shape = calloc(count + 1u, sizeof *m->of_shape);
    bool done = files && m->items && m->of_shape;
    if (done)
        assign(scene, files, size - 1, m);
    else
        fprintf(stderr, "out of memory\n");
    free(files);
    if (done)
        m->reader = mesh_reader_create(reading->cache, reading->device, reading->thread_count);
    return done && m->reader && table_grow(gpu, &m->table, m->count + 1u);
}

static void finish_list(struct mesh_list *list)
{
    free(list->items);
    free(list->builds);
    *list = (struct mesh_list){0};
}

void meshes_finish(const struct gpu *gpu, struct structures *structures, struct meshes *m)
{
    for (uint32_t i = 0; i < m->count; i++)
        structures_give(gpu, structures, &m->items[i].structure);
    build_batch_finish(gpu, structures, &m->batch);
    finish_list(&m->waiting);
    finish_list(&m->building);
    arena_finish(gpu, &m->data);
    if (gpu->device)
        table_finish(gpu, &m->table);
    mesh_reader_destroy(m->reader);
    free(m->items);
    free(m->of_shape);
    *m = (struct meshes){0};
}

static void fail(struct meshes *m, struct mesh *mesh)
{
    mesh->state = MESH_FAILED;
    m->failed_count++;
}

static uint32_t *append(uint32_t *words, const void *values, size_t count)
{
    if (values)
        memcpy(words, values, count * sizeof *words);
    return values ? words + count : words;
}

/** Writes the compute path's tree behind the mesh's other data. */
static void write_tree(const SluicePbrtMesh *read, const struct box_tree *tree, uint32_t *at,
                       struct mesh *mesh, struct PbrtMesh *entry)
{
    const uint32_t *base = mesh->data.mapped;
    const uint32_t *nodes = mesh_tree_write(read, tree, base, at);
    entry->order = entry->indices + 3 * read->triangleCount;
    mesh->tree.address = mesh->data.address + sizeof *base * (uint64_t)(nodes - base);
    memcpy(mesh->tree.box.low, tree->nodes[0].low, sizeof mesh->tree.box.low);
    memcpy(mesh->tree.box.high, tree->nodes[0].high, sizeof mesh->tree.box.high);
}

/** Copies a mesh to the device: positions, normals, uvs, indices. */
static void write_mesh(const SluicePbrtMesh *read, const struct box_tree *tree, struct mesh *mesh,
                       struct PbrtMesh *entry)
{
    const struct arena_part *part = &mesh->data;
    const size_t count = read->vertexCount;
    uint32_t *const base = part->mapped;
    uint32_t *at = append(base, read->pPositions, 3 * count);
    *entry =
        (struct PbrtMesh){.address = {(uint32_t)part->address, (uint32_t)(part->address >> 32)}};
    entry->normals = read->pNormals ? (uint32_t)(at - base) : 0;
    at = append(at, read->pNormals, 3 * count);
    entry->uvs = read->pUvs ? (uint32_t)(at - base) : 0;
    at = append(at, read->pUvs, 2 * count);
    entry->indices = (uint32_t)(at - base);
    if (tree->node_count > 0)
        write_tree(read, tree, at, mesh, entry);
    else
        append(at, read->pIndices, 3 * (size_t)read->triangleCount);
}

static uint64_t words_of(const SluicePbrtMesh *read, const struct box_tree *tree)
{
    const uint64_t per_vertex = 3u + (read->pNormals ? 3u : 0) + (read->pUvs ? 2u : 0);
    return per_vertex * read->vertexCount +
           (tree->node_count > 0 ? mesh_tree_words(read, tree) : 3ull * read->triangleCount);
}

static void set_geometry(const SluicePbrtMesh *read, const struct mesh *mesh,
                         const struct PbrtMesh *entry, struct structure_build *build)
{
    *build = (struct structure_build){
        .type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
        .primitive_count = read->triangleCount,
        .geometry = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
            .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR,
            .flags = VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR,
            .geometry.triangles = {
                .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
                .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
                .vertexData.deviceAddress = mesh->data.address,
                .vertexStride = 3 * sizeof(float),
                .maxVertex = read->vertexCount - 1,
                .indexType = VK_INDEX_TYPE_UINT32,
                .indexData.deviceAddress = mesh->data.address + 4ull * entry->indices}}};
}

/** Copies a mesh to the device, followed by the compute path's tree. */
static bool place_mesh(const struct gpu *gpu, const SluicePbrtMesh *read, struct meshes *m,
                       struct mesh *mesh, struct PbrtMesh *entry)
{
    const double start = clock_seconds();
    struct box_tree tree = {0};
    const bool done = (gpu->ray_tracing || mesh_tree_build(read, &tree)) &&
                      words_of(read, &tree) <= UINT32_MAX &&
                      arena_take(gpu, &m->data, 4 * words_of(read, &tree), &mesh->data);
    if (done)
        write_mesh(read, &tree, mesh, entry);
    m->build_seconds += gpu->ray_tracing ? 0.0 : clock_seconds() - start;
    box_tree_finish(&tree);
    return done;
}

/** Returns false if there is nothing to build. */
static bool read_mesh(const struct gpu *gpu, const struct scene *scene, struct meshes *m,
                      uint32_t index, struct structure_build *build)
{
    struct mesh *mesh = &m->items[index];
    struct PbrtMesh *entry = table_at(&m->table, index);
    struct mesh_read taken;
    mesh_reader_take(m->reader, mesh->shape, &taken);
    const SluicePbrtMesh read = taken.mesh;
    m->read_seconds += taken.seconds;
    if (m->says_what_it_reads) {
        const SluicePbrtShape shape = scene_shape(scene, mesh->shape);
        text_say("mesh %u: %s: %u triangles", index, shape.pPlyPath ? shape.pPlyPath : shape.pFile,
                 read.triangleCount);
    }
    bool done = taken.result == SLUICE_SUCCESS && read.triangleCount > 0 && read.vertexCount > 0 &&
                place_mesh(gpu, &read, m, mesh, entry);
    if (done) {
        set_geometry(&read, mesh, entry, build);
        build->target = &mesh->structure;
        build->compact = !m->uncompacted;
        mesh->triangle_count = read.triangleCount;
        m->triangle_count += read.triangleCount;
        m->normal_count += read.pNormals ? read.vertexCount : 0;
        m->uv_count += read.pUvs ? read.vertexCount : 0;
        m->bytes_read += read.bytesRead;
    } else {
        fail(m, mesh); /* the library or the arena has reported the error */
    }
    mesh_reader_give(m->reader, &taken);
    return done;
}

static bool reserve(struct mesh_list *list)
{
    if (list->count < list->room)
        return true;
    const uint32_t room = list->room ? 2 * list->room : 32;
    uint32_t *items = realloc(list->items, room * sizeof *items);
    list->items = items ? items : list->items;
    struct structure_build *builds = realloc(list->builds, room * sizeof *builds);
    list->builds = builds ? builds : list->builds;
    if (!items || !builds) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    list->room = room;
    return true;
}

bool meshes_prepare(const struct gpu *gpu, const struct scene *scene, struct meshes *m,
                    uint32_t index)
{
    struct mesh_list *list = &m->waiting;
    if (!reserve(list))
        return false;
    if (read_mesh(gpu, scene, m, index, &list->builds[list->build_count])) {
        list->build_count += gpu->ray_tracing;
        list->items[list->count++] = index;
        m->items[index].state = MESH_BUILDING;
    }
    return true;
}

bool meshes_begin(const struct gpu *gpu, struct structures *structures, struct meshes *m)
{
    if (m->building.count > 0 || m->waiting.count == 0)
        return true;
    const struct mesh_list list = m->building;
    m->building = m->waiting;
    m->waiting = list;
    return build_batch_begin(gpu, structures, &m->batch, m->building.builds,
                             m->building.build_count);
}

bool meshes_continue(const struct gpu *gpu, struct structures *structures, struct meshes *m,
                     uint32_t launch, bool waits)
{
    const double start = clock_seconds();
    if (m->building.count == 0)
        return true;
    const bool done = build_batch_continue(gpu, structures, &m->batch, waits);
    m->build_seconds += clock_seconds() - start;
    if (!done || m->batch.stage != BATCH_IDLE)
        return done;
    for (uint32_t i = 0; i < m->building.count; i++) {
        struct mesh *mesh = &m->items[m->building.items[i]];
        mesh->state = MESH_BUILT;
        mesh->built_at = mesh->used_at = launch;
        m->size += meshes_size_of(mesh);
        m->built_count++;
    }
    m->building.count = m->building.build_count = 0;
    return true;
}

bool meshes_build(const struct gpu *gpu, const struct scene *scene, struct structures *structures,
                  struct meshes *m, const uint32_t *which, uint32_t count, uint32_t launch)
{
    uint32_t asked = 0;
    bool done = true;
    for (uint32_t i = 0; i < count && done; i++) {
        while (asked < count && asked < i + AHEAD &&
               mesh_reader_ask(m->reader, m->items[which[asked]].shape))
            asked++;
        done = m->items[which[i]].state != MESH_ABSENT || meshes_prepare(gpu, scene, m, which[i]);
    }
    return done && meshes_continue(gpu, structures, m, launch, true) &&
           meshes_begin(gpu, structures, m) && meshes_continue(gpu, structures, m, launch, true);
}

enum mesh_fetch meshes_fetch(struct meshes *m, uint32_t index)
{
    const struct mesh *mesh = &m->items[index];
    if (mesh->state == MESH_BUILDING)
        return MESH_IS_BUILT_LATER;
    if (mesh->state != MESH_ABSENT)
        return MESH_IS_THERE;
    if (mesh_reader_is_ready(m->reader, mesh->shape))
        return MESH_IS_READ;
    (void)mesh_reader_ask(m->reader, mesh->shape);
    return MESH_IS_READ_LATER;
}

uint64_t meshes_size_of(const struct mesh *mesh)
{
    return mesh->data.size + mesh->structure.storage.size;
}

void meshes_evict(const struct gpu *gpu, struct structures *structures, struct meshes *m,
                  uint32_t index)
{
    struct mesh *mesh = &m->items[index];
    m->size -= meshes_size_of(mesh);
    structures_give(gpu, structures, &mesh->structure);
    arena_give(gpu, &m->data, &mesh->data);
    mesh->state = MESH_ABSENT;
    m->evicted_count++;
}
