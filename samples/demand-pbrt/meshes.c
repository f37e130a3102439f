#include "meshes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/text.h"
#include "compaction.h"

#define AHEAD (MESH_READER_ROOM / 2) /* meshes that are read while another is built */

/** A PLY file that several shapes have has one pointer as its path. */
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

bool meshes_create(const struct gpu *gpu, const struct scene *scene, uint32_t thread_count,
                   struct meshes *m)
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
        m->reader = mesh_reader_create(scene, thread_count);
    return done && m->reader && table_grow(gpu, &m->table, m->count + 1u);
}

void meshes_finish(const struct gpu *gpu, struct structures *structures, struct meshes *m)
{
    for (uint32_t i = 0; i < m->count; i++)
        structures_give(gpu, structures, &m->items[i].structure);
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

/** Of the compute path: behind everything else. */
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

/** Copies what was read to the device, where the compute path's tree is behind it. */
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

/** False: there is nothing to build. */
static bool read_mesh(const struct gpu *gpu, const struct scene *scene, struct meshes *m,
                      uint32_t index, struct structure_build *build)
{
    struct mesh *mesh = &m->items[index];
    struct PbrtMesh *entry = table_at(&m->table, index);
    struct mesh_read taken;
    mesh_reader_take(m->reader, mesh->shape, &taken);
    SluicePbrtMesh read = taken.mesh;
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
        fail(m, mesh); /* the library has said why, or the arena */
    }
    (void)sluiceFreePbrtMesh(scene->pbrt, &read);
    return done;
}

bool meshes_build(const struct gpu *gpu, const struct scene *scene, struct structures *structures,
                  struct meshes *m, const uint32_t *which, uint32_t count, uint32_t launch)
{
    struct structure_build *builds = calloc(count + 1u, sizeof *builds);
    uint32_t build_count = 0, asked = 0;
    if (!builds) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        while (asked < count && asked < i + AHEAD &&
               mesh_reader_ask(m->reader, m->items[which[asked]].shape))
            asked++;
        build_count += read_mesh(gpu, scene, m, which[i], &builds[build_count]);
    }
    double start = clock_seconds();
    bool done = structures_build(gpu, structures, builds, build_count) &&
                (m->uncompacted || structures_compact(gpu, structures, builds, build_count));
    m->build_seconds += clock_seconds() - start;
    free(builds);
    for (uint32_t i = 0; i < count; i++) {
        struct mesh *mesh = &m->items[which[i]];
        if (mesh->state == MESH_FAILED)
            continue;
        mesh->state = MESH_BUILT;
        mesh->built_at = mesh->used_at = launch;
        m->size += meshes_size_of(mesh);
        m->built_count++;
    }
    return done;
}

bool meshes_fetch(struct meshes *m, uint32_t index)
{
    const struct mesh *mesh = &m->items[index];
    if (mesh->state != MESH_ABSENT || mesh_reader_is_ready(m->reader, mesh->shape))
        return true;
    (void)mesh_reader_ask(m->reader, mesh->shape);
    return false;
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
