#include "pbrt/loop_subdivision.h"

#include "pbrt/ply_reader.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define NONE UINT32_MAX
#define PI 3.14159265358979323846

/*
 * Half-edge 3 * f + i runs from corner i of face f to the next corner. `twins` has the half-edge
 * of the other face, or NONE at a boundary. `starts` has a half-edge that leaves the vertex; at a
 * boundary the one without a twin; NONE if no face has the vertex.
 */
struct level {
    float *positions;  ///< owned; [vertex_count][3]
    uint32_t *corners; ///< owned; [face_count][3]
    uint32_t *twins;   ///< owned; [face_count][3]
    uint32_t *starts;  ///< owned; [vertex_count]
    uint32_t vertex_count, face_count;
};

static uint32_t next(uint32_t edge)
{
    return edge % 3 == 2 ? edge - 2 : edge + 1;
}

static uint32_t previous(uint32_t edge)
{
    return edge % 3 == 0 ? edge + 2 : edge - 1;
}

static bool init_level(const SluiceAllocationCallbacks *cb, uint32_t vertex_count,
                       uint32_t face_count, struct level *level)
{
    *level = (struct level){.vertex_count = vertex_count, .face_count = face_count};
    level->positions = slc_alloc(cb, 3 * (size_t)vertex_count, sizeof *level->positions);
    level->corners = slc_alloc(cb, 3 * (size_t)face_count, sizeof *level->corners);
    level->twins = slc_alloc(cb, 3 * (size_t)face_count, sizeof *level->twins);
    level->starts = slc_alloc(cb, vertex_count, sizeof *level->starts);
    return level->positions && level->corners && level->twins && level->starts;
}

static void finish_level(const SluiceAllocationCallbacks *cb, struct level *level)
{
    size_t edges = 3 * (size_t)level->face_count, vertices = level->vertex_count;
    slc_free(cb, level->positions, 3 * vertices, sizeof *level->positions);
    slc_free(cb, level->corners, edges, sizeof *level->corners);
    slc_free(cb, level->twins, edges, sizeof *level->twins);
    slc_free(cb, level->starts, vertices, sizeof *level->starts);
    *level = (struct level){0};
}

/* The control mesh */

/* Orders half-edges by one of their two vertices, the lower or the higher one. Stable. */
static void sort_edges(const struct level *level, bool by_lower, const uint32_t *in, uint32_t *out,
                       uint32_t *begins)
{
    uint32_t count = 3 * level->face_count;
    memset(begins, 0, ((size_t)level->vertex_count + 1) * sizeof *begins);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < count; i++) {
            uint32_t from = level->corners[in[i]], to = level->corners[next(in[i])];
            uint32_t key = (from < to) == by_lower ? from : to;
            if (pass == 0)
                begins[key + 1]++;
            else
                out[begins[key]++] = in[i];
        }
        for (uint32_t i = 0; i < level->vertex_count && pass == 0; i++)
            begins[i + 1] += begins[i];
    }
}

/* Neighbors in the order join the same vertices. False: more than two do, or in one direction. */
static bool join_twins(struct level *level, const uint32_t *order)
{
    uint32_t count = 3 * level->face_count;
    for (uint32_t i = 0; i < count; i++)
        level->twins[i] = NONE;
    for (uint32_t i = 1; i < count; i++) {
        uint32_t a = order[i - 1], b = order[i];
        uint32_t from = level->corners[a], to = level->corners[next(a)];
        uint32_t other_from = level->corners[b], other_to = level->corners[next(b)];
        if (from == to || (from == other_from && to == other_to))
            return false;
        if (from != other_to || to != other_from)
            continue;
        if (level->twins[a] != NONE)
            return false;
        level->twins[a] = b;
        level->twins[b] = a;
    }
    return true;
}

/* Goes around a vertex from a half-edge, to the end of a boundary or once around. */
static uint32_t rewind_fan(const struct level *level, uint32_t edge)
{
    for (uint32_t first = edge; level->twins[edge] != NONE;) {
        edge = next(level->twins[edge]);
        if (edge == first)
            break;
    }
    return edge;
}

/* `left` has room for a number of each vertex. False: a vertex has two fans. */
static bool find_starts(struct level *level, uint32_t *left)
{
    for (uint32_t i = 0; i < level->vertex_count; i++) {
        level->starts[i] = NONE;
        left[i] = 0;
    }
    for (uint32_t edge = 0; edge < 3 * level->face_count; edge++) {
        level->starts[level->corners[edge]] = edge;
        left[level->corners[edge]]++;
    }
    for (uint32_t i = 0; i < level->vertex_count; i++) {
        if (level->starts[i] == NONE)
            continue;
        uint32_t start = rewind_fan(level, level->starts[i]), edge = start;
        level->starts[i] = start;
        do {
            left[i]--;
            edge = level->twins[previous(edge)];
        } while (edge != NONE && edge != start);
        if (left[i] > 0)
            return false;
    }
    return true;
}

static SluiceResult connect(const SluiceAllocationCallbacks *cb, struct level *level)
{
    size_t edges = 3 * (size_t)level->face_count, vertices = (size_t)level->vertex_count + 1;
    uint32_t *first = slc_alloc(cb, edges, sizeof *first);
    uint32_t *second = slc_alloc(cb, edges, sizeof *second);
    uint32_t *begins = slc_alloc(cb, vertices, sizeof *begins);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (first && second && begins) {
        for (uint32_t i = 0; i < edges; i++)
            first[i] = i;
        sort_edges(level, false, first, second, begins);
        sort_edges(level, true, second, first, begins);
        result = join_twins(level, first) && find_starts(level, begins) ? SLUICE_SUCCESS
                                                                        : SLUICE_ERROR_UNSUPPORTED;
    }
    slc_free(cb, first, edges, sizeof *first);
    slc_free(cb, second, edges, sizeof *second);
    slc_free(cb, begins, vertices, sizeof *begins);
    return result;
}

static SluiceResult take_control_mesh(const SluiceAllocationCallbacks *cb,
                                      const SluicePbrtMesh *mesh, struct level *level)
{
    if (!init_level(cb, mesh->vertexCount, mesh->triangleCount, level))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memcpy(level->positions, mesh->pPositions, 3 * sizeof(float) * mesh->vertexCount);
    memcpy(level->corners, mesh->pIndices, 3 * sizeof(uint32_t) * mesh->triangleCount);
    return connect(cb, level);
}

/* Vertices around a vertex */

/* Sums over the ring. The first two members are corners of the boundary, where there is one. */
struct ring {
    uint32_t first, last; ///< vertices; of a boundary its ends
    uint32_t count;
    bool is_boundary;
    double sum[3];
};

/* Calls `visit` for the vertices around a vertex, in order; at a boundary, from end to end. */
static void walk(const struct level *level, uint32_t vertex,
                 void (*visit)(void *user_data, uint32_t number, const float *position),
                 void *user_data, struct ring *ring)
{
    uint32_t start = level->starts[vertex], edge = start;
    *ring = (struct ring){.is_boundary = start != NONE && level->twins[start] == NONE};
    while (edge != NONE) {
        uint32_t member = level->corners[next(edge)];
        ring->first = ring->count ? ring->first : member;
        for (int pass = 0; pass < 2; pass++) {
            const float *p = level->positions + 3 * (size_t)member;
            for (int i = 0; i < 3; i++)
                ring->sum[i] += (double)p[i];
            if (visit)
                visit(user_data, ring->count, p);
            ring->last = member;
            ring->count++;
            /* The last face of a boundary has two members. */
            if (level->twins[previous(edge)] != NONE)
                break;
            member = level->corners[previous(edge)];
        }
        edge = level->twins[previous(edge)];
        if (edge == start)
            break;
    }
}

/* The vertex weighs 1 - count * weight, or 1 - 2 * edge_weight at a boundary. */
static void blend(const struct level *level, uint32_t vertex, const struct ring *ring,
                  double weight, double edge_weight, float out[3])
{
    const float *p = level->positions + 3 * (size_t)vertex;
    const float *first = level->positions + 3 * (size_t)ring->first;
    const float *last = level->positions + 3 * (size_t)ring->last;
    for (int i = 0; i < 3; i++) {
        double around = ring->is_boundary ? edge_weight * ((double)first[i] + (double)last[i])
                                          : weight * ring->sum[i];
        double others = ring->is_boundary ? 2 * edge_weight : weight * ring->count;
        out[i] = (float)((1 - others) * (double)p[i] + around);
    }
}

static double even_weight(uint32_t count)
{
    return count == 3 ? 3.0 / 16 : 3.0 / (8.0 * count);
}

/* Subdivision */

static void place_edge_vertex(const struct level *level, uint32_t edge, float out[3])
{
    uint32_t twin = level->twins[edge];
    const float *a = level->positions + 3 * (size_t)level->corners[edge];
    const float *b = level->positions + 3 * (size_t)level->corners[next(edge)];
    for (int i = 0; i < 3; i++)
        out[i] = (float)(0.5 * ((double)a[i] + (double)b[i]));
    if (twin == NONE)
        return;
    const float *c = level->positions + 3 * (size_t)level->corners[previous(edge)];
    const float *d = level->positions + 3 * (size_t)level->corners[previous(twin)];
    for (int i = 0; i < 3; i++)
        out[i] =
            (float)(0.375 * ((double)a[i] + (double)b[i]) + 0.125 * ((double)c[i] + (double)d[i]));
}

/* Face f becomes 4 f + i at its corner i, and 4 f + 3 in its middle. The first half of edge i is
 * edge i of the face at corner i, the second half edge i of the face at the next corner. */
static void split_edge(const struct level *level, uint32_t edge, uint32_t vertex, struct level *out)
{
    uint32_t face = edge / 3, i = edge % 3, after = next(edge) % 3, before = previous(edge) % 3;
    uint32_t near = 3 * (4 * face + i), far = 3 * (4 * face + after), middle = 3 * (4 * face + 3);
    uint32_t twin = level->twins[edge];
    out->corners[near + i] = level->corners[edge];
    out->corners[near + after] = out->corners[far + i] = out->corners[middle + i] = vertex;
    out->twins[near + after] = middle + before;
    out->twins[middle + before] = near + after;
    out->twins[near + i] = out->twins[far + i] = NONE;
    if (twin != NONE) {
        uint32_t other = twin / 3, j = twin % 3;
        out->twins[near + i] = 3 * (4 * other + next(twin) % 3) + j;
        out->twins[far + i] = 3 * (4 * other + j) + j;
    }
    if (edge == level->starts[level->corners[edge]])
        out->starts[level->corners[edge]] = near + i;
    out->starts[vertex] = twin == NONE ? far + i : middle + i;
}

static uint32_t count_edges(const struct level *level)
{
    uint32_t count = 0;
    for (uint32_t edge = 0; edge < 3 * level->face_count; edge++)
        count += level->twins[edge] == NONE || edge < level->twins[edge];
    return count;
}

static bool subdivide(const SluiceAllocationCallbacks *cb, const struct level *level,
                      struct level *out)
{
    if (!init_level(cb, level->vertex_count + count_edges(level), 4 * level->face_count, out))
        return false;
    for (uint32_t i = 0; i < level->vertex_count; i++) {
        struct ring ring;
        out->starts[i] = NONE;
        walk(level, i, NULL, NULL, &ring);
        blend(level, i, &ring, ring.count ? even_weight(ring.count) : 0, 1.0 / 8,
              out->positions + 3 * (size_t)i);
    }
    uint32_t vertex = level->vertex_count;
    for (uint32_t edge = 0; edge < 3 * level->face_count; edge++) {
        uint32_t twin = level->twins[edge];
        if (twin != NONE && twin < edge)
            continue;
        place_edge_vertex(level, edge, out->positions + 3 * (size_t)vertex);
        split_edge(level, edge, vertex, out);
        if (twin != NONE)
            split_edge(level, twin, vertex, out);
        vertex++;
    }
    assert(vertex == out->vertex_count);
    return true;
}

/* The limit */

struct tangents {
    double s[3], t[3];
    uint32_t count; ///< vertices in the ring
    bool is_boundary;
};

/* Weight of ring member `k` in the tangent across a boundary. */
static double across_weight(uint32_t count, uint32_t k)
{
    static const double REGULAR[4] = {-1, 2, 2, -1};
    if (count == 2)
        return 1;
    if (count == 3)
        return k == 1;
    if (count == 4)
        return REGULAR[k];
    double theta = PI / (count - 1);
    return k == 0 || k == count - 1 ? -sin(theta) : -(2 * cos(theta) - 2) * sin(k * theta);
}

static void add_tangents(void *user_data, uint32_t k, const float *p)
{
    struct tangents *tangents = user_data;
    double turn = 2 * PI * k / tangents->count;
    double s = cos(turn), t = -sin(turn); /* pbrt goes around the other way */
    if (tangents->is_boundary) {
        s = (k == tangents->count - 1) - (double)(k == 0);
        t = across_weight(tangents->count, k);
    }
    for (int i = 0; i < 3; i++) {
        tangents->s[i] += s * (double)p[i];
        tangents->t[i] += t * (double)p[i];
    }
}

static void find_normal(const struct level *level, uint32_t vertex, const struct ring *around,
                        float out[3])
{
    static const double OWN[5] = {0, 0, -2, -1, -2}; /* weight of the vertex in t at a boundary */
    struct tangents v = {.count = around->count, .is_boundary = around->is_boundary};
    struct ring ring;
    double n[3], square = 0;
    walk(level, vertex, add_tangents, &v, &ring);
    for (int i = 0; i < 3 && v.is_boundary && v.count <= 4; i++)
        v.t[i] += OWN[v.count] * (double)level->positions[3 * (size_t)vertex + i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = v.s[j] * v.t[k] - v.s[k] * v.t[j];
        square += n[i] * n[i];
    }
    for (int i = 0; i < 3; i++)
        out[i] = square > 0 ? (float)(n[i] / sqrt(square)) : 0;
}

static void find_limit(const struct level *level, float *positions, float *normals)
{
    for (uint32_t i = 0; i < level->vertex_count; i++) {
        struct ring ring;
        walk(level, i, NULL, NULL, &ring);
        double weight = ring.count ? 1 / (ring.count + 3 / (8 * even_weight(ring.count))) : 0;
        blend(level, i, &ring, weight, 1.0 / 5, positions + 3 * (size_t)i);
        find_normal(level, i, &ring, normals + 3 * (size_t)i);
    }
}

static SluiceResult make_mesh(const SluiceAllocationCallbacks *cb, struct level *level,
                              SluicePbrtMesh *mesh)
{
    size_t numbers = 3 * (size_t)level->vertex_count;
    float *positions = slc_alloc(cb, numbers, sizeof *positions);
    float *normals = slc_alloc(cb, numbers, sizeof *normals);
    if (!positions || !normals) {
        slc_free(cb, positions, numbers, sizeof *positions);
        slc_free(cb, normals, numbers, sizeof *normals);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    find_limit(level, positions, normals);
    uint64_t bytes_read = mesh->bytesRead;
    slc_pbrt_free_mesh(cb, mesh);
    *mesh = (SluicePbrtMesh){.structSize = sizeof *mesh,
                             .vertexCount = level->vertex_count,
                             .triangleCount = level->face_count,
                             .pPositions = positions,
                             .pNormals = normals,
                             .pIndices = level->corners,
                             .bytesRead = bytes_read};
    level->corners = NULL;
    return SLUICE_SUCCESS;
}

/* True if the next level has no more bytes than allowed, and indices of 32 bits. */
static bool may_subdivide(const struct level *level, uint64_t max_size)
{
    uint64_t vertices = (uint64_t)level->vertex_count + count_edges(level);
    uint64_t corners = 12 * (uint64_t)level->face_count;
    return corners < UINT32_MAX && vertices < UINT32_MAX && 4 * corners + 24 * vertices <= max_size;
}

SluiceResult slc_pbrt_subdivide(const SluiceAllocationCallbacks *cb, uint32_t levels,
                                uint64_t max_size, SluicePbrtMesh *mesh)
{
    struct level level = {0};
    SluiceResult result = take_control_mesh(cb, mesh, &level);
    for (uint32_t i = 0; i < levels && result == SLUICE_SUCCESS; i++) {
        struct level finer = {0};
        if (!may_subdivide(&level, max_size))
            result = SLUICE_ERROR_LIMIT_EXCEEDED;
        else if (!subdivide(cb, &level, &finer))
            result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        finish_level(cb, &level);
        level = finer;
    }
    if (result == SLUICE_SUCCESS)
        result = make_mesh(cb, &level, mesh);
    finish_level(cb, &level);
    return result;
}
