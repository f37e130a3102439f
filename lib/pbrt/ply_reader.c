#include "pbrt/ply_reader.h"

#include "pbrt/affine.h"
#include "pbrt/growth.h"
#include "pbrt/ply_header.h"
#include "base/text_number.h"

#include <float.h>
#include <math.h>

#define NUMBER_REACH 64u

struct ply {
    struct slc_pbrt_window window;
    struct slc_pbrt_ply_header header;
    const char *trouble;
    bool has_large_polygons;
    const SluiceAllocationCallbacks *cb;
    uint64_t max_size;
    bool bounds_only;
    SluicePbrtBounds bounds;
    float *positions, *normals, *uvs;
    uint32_t *indices;
    size_t vertex_count, index_count;
    size_t position_capacity, normal_capacity, uv_capacity, index_capacity;
};

static SluiceResult corrupt(struct ply *ply, const char *trouble)
{
    ply->trouble = trouble;
    return SLUICE_ERROR_CORRUPT_DATA;
}

static SluiceResult cut_off(struct ply *ply)
{
    if (ply->window.failure != SLUICE_SUCCESS) {
        ply->trouble = "cannot be read to its end";
        return ply->window.failure;
    }
    return corrupt(ply, "ends too early");
}

/* Numbers */

static bool is_blank(unsigned char c)
{
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

static SluiceResult read_text(struct ply *ply, double *number)
{
    struct slc_pbrt_window *window = &ply->window;
    for (;;) {
        while (is_blank(window->bytes[window->cursor]))
            window->cursor++;
        if (window->end - window->cursor >= NUMBER_REACH || window->is_over)
            break;
        slc_pbrt_window_refill(window, window->cursor);
    }
    const unsigned char *text = window->bytes + window->cursor;
    const unsigned char *end = slc_read_number(text, number);
    if (window->cursor >= window->end)
        return cut_off(ply);
    if (end == text || (*end && !is_blank(*end)))
        return corrupt(ply, "has something that is no number");
    window->cursor += (size_t)(end - text);
    return SLUICE_SUCCESS;
}

static double decode(const unsigned char *bytes, enum slc_pbrt_ply_type type, bool is_big)
{
    uint64_t bits = 0;
    uint32_t size = slc_pbrt_ply_size(type), b32;
    double number;
    float single;
    if (type == SLC_PBRT_PLY_FLOAT && !is_big) {
        b32 = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
              (uint32_t)bytes[3] << 24;
        memcpy(&single, &b32, sizeof single);
        return single;
    }
    for (uint32_t i = 0; i < size; i++)
        bits |= (uint64_t)bytes[is_big ? size - 1 - i : i] << (8 * i);
    switch (type) {
    case SLC_PBRT_PLY_INT8: return (int8_t)bits;
    case SLC_PBRT_PLY_INT16: return (int16_t)bits;
    case SLC_PBRT_PLY_INT32: return (int32_t)bits;
    case SLC_PBRT_PLY_FLOAT:
        b32 = (uint32_t)bits;
        memcpy(&single, &b32, sizeof single);
        return single;
    case SLC_PBRT_PLY_DOUBLE: memcpy(&number, &bits, sizeof number); return number;
    default: return (double)bits;
    }
}

/* Returns `size` bytes in the window, which may move. NULL: the file ends before. */
static const unsigned char *take_bytes(struct slc_pbrt_window *window, uint32_t size)
{
    while (window->end - window->cursor < size) {
        if (window->is_over)
            return NULL;
        slc_pbrt_window_refill(window, window->cursor);
    }
    const unsigned char *bytes = window->bytes + window->cursor;
    window->cursor += size;
    return bytes;
}

static SluiceResult read_scalar(struct ply *ply, enum slc_pbrt_ply_type type, double *number)
{
    if (ply->header.format == SLC_PBRT_PLY_ASCII)
        return read_text(ply, number);
    const unsigned char *bytes = take_bytes(&ply->window, slc_pbrt_ply_size(type));
    if (!bytes)
        return cut_off(ply);
    *number = decode(bytes, type, ply->header.format == SLC_PBRT_PLY_BIG);
    return SLUICE_SUCCESS;
}

static SluiceResult read_list_count(struct ply *ply, const struct slc_pbrt_ply_property *property,
                                    uint32_t *count)
{
    double number;
    SluiceResult result = read_scalar(ply, property->count_type, &number);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!(number >= 0) || number > INT32_MAX || number != floor(number))
        return corrupt(ply, "has a list of a length that cannot be");
    *count = (uint32_t)number;
    return SLUICE_SUCCESS;
}

static SluiceResult skip_list(struct ply *ply, const struct slc_pbrt_ply_property *property)
{
    uint32_t count;
    double number;
    SluiceResult result = read_list_count(ply, property, &count);
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++)
        result = read_scalar(ply, property->type, &number);
    return result;
}

/* Arrays */

static SluiceResult reserve(struct ply *ply, void *array_address, size_t *capacity, size_t needed)
{
    if (needed <= *capacity)
        return SLUICE_SUCCESS;
    uint64_t others = ply->position_capacity + ply->normal_capacity + ply->uv_capacity +
                      ply->index_capacity - *capacity;
    if (others + needed > ply->max_size / sizeof(float)) {
        ply->trouble = "is larger than maxMeshSize";
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    return slc_pbrt_grow(ply->cb, array_address, capacity, needed, sizeof(float))
               ? SLUICE_SUCCESS
               : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/* Returns the elements to allocate at first: all, or at most 65536 for compressed files. */
static size_t expected(const struct ply *ply, const struct slc_pbrt_ply_element *element)
{
    size_t most = ply->window.inflater ? 65536 : SIZE_MAX;
    return element->count < most ? (size_t)element->count : most;
}

static SluiceResult add_vertex(struct ply *ply, const double values[SLC_PBRT_PLY_NO_ROLE])
{
    float v[8];
    for (int i = 0; i < 8; i++) {
        if (!(fabs(values[i]) <= FLT_MAX))
            return corrupt(ply, "has a vertex that is not finite");
        v[i] = (float)values[i];
    }
    size_t at = ply->vertex_count++;
    if (ply->bounds_only) {
        slc_pbrt_add_point(&ply->bounds, v);
        return SLUICE_SUCCESS;
    }
    SluiceResult result = reserve(ply, &ply->positions, &ply->position_capacity, 3 * (at + 1));
    if (result == SLUICE_SUCCESS && ply->header.roles >> SLC_PBRT_PLY_NX & 1)
        result = reserve(ply, &ply->normals, &ply->normal_capacity, 3 * (at + 1));
    if (result == SLUICE_SUCCESS && ply->header.roles >> SLC_PBRT_PLY_U & 1)
        result = reserve(ply, &ply->uvs, &ply->uv_capacity, 2 * (at + 1));
    if (result != SLUICE_SUCCESS)
        return result;
    memcpy(ply->positions + 3 * at, v, 3 * sizeof *v);
    if (ply->normals)
        memcpy(ply->normals + 3 * at, v + SLC_PBRT_PLY_NX, 3 * sizeof *v);
    if (ply->uvs)
        memcpy(ply->uvs + 2 * at, v + SLC_PBRT_PLY_U, 2 * sizeof *v);
    return SLUICE_SUCCESS;
}

/* Reads a polygon as a fan. Indices are checked later, when all vertices are known. */
static SluiceResult read_face(struct ply *ply, const struct slc_pbrt_ply_property *property)
{
    uint32_t count, first = 0, before = 0;
    SluiceResult result = read_list_count(ply, property, &count);
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++) {
        double number;
        result = read_scalar(ply, property->type, &number);
        if (result != SLUICE_SUCCESS)
            return result;
        if (!(number >= 0) || number > INT32_MAX || number != floor(number))
            return corrupt(ply, "has an index that cannot be");
        uint32_t index = (uint32_t)number;
        if (i >= 2) {
            result = reserve(ply, &ply->indices, &ply->index_capacity, ply->index_count + 3);
            if (result != SLUICE_SUCCESS)
                return result;
            ply->indices[ply->index_count++] = first;
            ply->indices[ply->index_count++] = before;
            ply->indices[ply->index_count++] = index;
        }
        ply->has_large_polygons |= i >= 4;
        first = i == 0 ? index : first;
        before = index;
    }
    return result;
}

static SluiceResult read_fields(struct ply *ply, const struct slc_pbrt_ply_element *element,
                                double values[])
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t j = 0; j < element->property_count && result == SLUICE_SUCCESS; j++) {
        const struct slc_pbrt_ply_property *p = &element->properties[j];
        if (p->role == SLC_PBRT_PLY_INDICES && !ply->bounds_only)
            result = read_face(ply, p);
        else if (p->count_type < SLC_PBRT_PLY_NO_TYPE)
            result = skip_list(ply, p);
        else
            result = read_scalar(ply, p->type, &values[p->role]);
    }
    return result;
}

static SluiceResult read_element(struct ply *ply, const struct slc_pbrt_ply_element *element)
{
    bool is_fixed = element->stride && ply->header.format != SLC_PBRT_PLY_ASCII;
    bool is_big = ply->header.format == SLC_PBRT_PLY_BIG;
    for (uint64_t i = 0; i < element->count; i++) {
        double values[SLC_PBRT_PLY_NO_ROLE + 1] = {0};
        SluiceResult result = SLUICE_SUCCESS;
        if (is_fixed) {
            const unsigned char *bytes = take_bytes(&ply->window, element->stride);
            if (!bytes)
                return cut_off(ply);
            for (uint32_t j = 0; element->is_vertex && j < element->property_count; j++) {
                const struct slc_pbrt_ply_property *p = &element->properties[j];
                if (p->role < SLC_PBRT_PLY_NO_ROLE)
                    values[p->role] = decode(bytes, p->type, is_big);
                bytes += slc_pbrt_ply_size(p->type);
            }
        } else {
            result = read_fields(ply, element, values);
        }
        if (result == SLUICE_SUCCESS && element->is_vertex)
            result = add_vertex(ply, values);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return SLUICE_SUCCESS;
}

/* Ignores normals and uvs with a missing component. */
static void drop_partial_roles(struct slc_pbrt_ply_header *header)
{
    const uint32_t normals = 7u << SLC_PBRT_PLY_NX, uvs = 3u << SLC_PBRT_PLY_U;
    if ((header->roles & normals) != normals)
        header->roles &= ~normals;
    if ((header->roles & uvs) != uvs)
        header->roles &= ~uvs;
}

static SluiceResult open_ply(struct ply *ply, const char *path)
{
    SluiceResult result = slc_pbrt_window_open(&ply->window, path, ply->cb);
    if (result != SLUICE_SUCCESS)
        return result;
    ply->trouble = slc_pbrt_ply_read_header(&ply->window, &ply->header);
    drop_partial_roles(&ply->header);
    if (ply->trouble)
        return ply->window.failure != SLUICE_SUCCESS ? ply->window.failure
                                                     : SLUICE_ERROR_CORRUPT_DATA;
    return SLUICE_SUCCESS;
}

SluiceResult slc_pbrt_ply_read_bounds(const char *path, const SluiceAllocationCallbacks *cb,
                                      SluicePbrtBounds *bounds, struct slc_pbrt_stamp *stamp,
                                      struct slc_pbrt_ply_trouble *trouble)
{
    struct ply *ply = slc_calloc(cb, 1, sizeof *ply);
    if (!ply)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    ply->cb = cb;
    ply->bounds_only = true;
    ply->bounds = slc_pbrt_no_bounds();
    SluiceResult result = open_ply(ply, path);
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i <= ply->header.vertex_element; i++)
        result = read_element(ply, &ply->header.elements[i]);
    *bounds = ply->bounds;
    *stamp = ply->window.stamp;
    trouble->text = ply->trouble;
    slc_pbrt_window_finish(&ply->window);
    slc_free(cb, ply, 1, sizeof *ply);
    return result;
}

static SluiceResult read_all(struct ply *ply)
{
    struct slc_pbrt_ply_header *header = &ply->header;
    size_t vertices = expected(ply, &header->elements[header->vertex_element]);
    size_t faces = expected(ply, &header->elements[header->face_element]);
    SluiceResult result = SLUICE_SUCCESS;
    if (vertices < ply->max_size / 64 && faces < ply->max_size / 64) {
        result = reserve(ply, &ply->positions, &ply->position_capacity, 3 * vertices);
        if (result == SLUICE_SUCCESS)
            result = reserve(ply, &ply->indices, &ply->index_capacity, 3 * faces);
    }
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < header->element_count; i++)
        result = read_element(ply, &header->elements[i]);
    if (result != SLUICE_SUCCESS)
        return result;
    if (ply->index_count == 0)
        return corrupt(ply, "has no triangle");
    for (size_t i = 0; i < ply->index_count; i++)
        if (ply->indices[i] >= ply->vertex_count)
            return corrupt(ply, "has an index beyond its vertices");
    return SLUICE_SUCCESS;
}

/* Moves an array to an allocation of exactly its size. */
static bool fit(const SluiceAllocationCallbacks *cb, void *array_address, size_t *capacity,
                size_t count)
{
    void *array;
    memcpy(&array, array_address, sizeof array);
    if (!array || *capacity == count)
        return true;
    void *exact = slc_alloc(cb, count, sizeof(float));
    if (!exact)
        return false;
    memcpy(exact, array, count * sizeof(float));
    slc_free(cb, array, *capacity, sizeof(float));
    memcpy(array_address, &exact, sizeof exact);
    *capacity = count;
    return true;
}

static bool fit_all(struct ply *ply)
{
    return fit(ply->cb, &ply->positions, &ply->position_capacity, 3 * ply->vertex_count) &&
           fit(ply->cb, &ply->normals, &ply->normal_capacity, 3 * ply->vertex_count) &&
           fit(ply->cb, &ply->uvs, &ply->uv_capacity, 2 * ply->vertex_count) &&
           fit(ply->cb, &ply->indices, &ply->index_capacity, ply->index_count);
}

SluiceResult slc_pbrt_ply_read_mesh(const char *path, const SluiceAllocationCallbacks *cb,
                                    uint64_t max_size, SluicePbrtMesh *mesh,
                                    struct slc_pbrt_ply_trouble *trouble)
{
    struct ply *ply = slc_calloc(cb, 1, sizeof *ply);
    *mesh = (SluicePbrtMesh){.structSize = sizeof *mesh};
    if (!ply)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    ply->cb = cb;
    ply->max_size = max_size;
    SluiceResult result = open_ply(ply, path);
    if (result == SLUICE_SUCCESS)
        result = read_all(ply);
    if (result == SLUICE_SUCCESS && !fit_all(ply))
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS) {
        *mesh = (SluicePbrtMesh){.structSize = sizeof *mesh,
                                 .vertexCount = (uint32_t)ply->vertex_count,
                                 .triangleCount = (uint32_t)(ply->index_count / 3),
                                 .pPositions = ply->positions,
                                 .pNormals = ply->normals,
                                 .pUvs = ply->uvs,
                                 .pIndices = ply->indices,
                                 .bytesRead = ply->window.file_offset};
        if (ply->has_large_polygons)
            ply->trouble = "has polygons of more than four corners, which are split";
    } else {
        slc_free(cb, ply->positions, ply->position_capacity, sizeof(float));
        slc_free(cb, ply->normals, ply->normal_capacity, sizeof(float));
        slc_free(cb, ply->uvs, ply->uv_capacity, sizeof(float));
        slc_free(cb, ply->indices, ply->index_capacity, sizeof(float));
    }
    trouble->text = ply->trouble;
    slc_pbrt_window_finish(&ply->window);
    slc_free(cb, ply, 1, sizeof *ply);
    return result;
}

static void free_array(const SluiceAllocationCallbacks *cb, const void *array, size_t count)
{
    slc_free(cb, (void *)(uintptr_t)array, count, sizeof(float));
}

void slc_pbrt_free_mesh(const SluiceAllocationCallbacks *cb, SluicePbrtMesh *mesh)
{
    free_array(cb, mesh->pPositions, 3 * (size_t)mesh->vertexCount);
    free_array(cb, mesh->pNormals, 3 * (size_t)mesh->vertexCount);
    free_array(cb, mesh->pUvs, 2 * (size_t)mesh->vertexCount);
    free_array(cb, mesh->pIndices, 3 * (size_t)mesh->triangleCount);
    mesh->pPositions = mesh->pNormals = mesh->pUvs = NULL;
    mesh->pIndices = NULL;
}
