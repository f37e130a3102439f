#include "pbrt/shape_reader.h"

#include "base/alloc.h"
#include "pbrt/lexer.h"
#include "pbrt/loop_subdivision.h"
#include "pbrt/ply_reader.h"
#include "base/text_number.h"

#include <float.h>
#include <math.h>

#define NUMBER_REACH 64u

/* Reads a number of a list with checked syntax. False: the text has changed. */
static bool read_one(struct slc_pbrt_lexer *lexer, double *number)
{
    struct slc_pbrt_window *window = &lexer->window;
    if (slc_pbrt_skip_blanks(lexer) == 0)
        return false;
    while (window->end - window->cursor < NUMBER_REACH && !window->is_over)
        slc_pbrt_window_refill(window, window->cursor);
    struct slc_pbrt_token token;
    const unsigned char *text = window->bytes + window->cursor;
    const unsigned char *end = slc_read_number(text, number);
    if ((size_t)(end - text) < NUMBER_REACH) {
        window->cursor += (size_t)(end - text);
        window->cursor += *end == ',';
        return end > text && fabs(*number) <= FLT_MAX;
    }
    slc_pbrt_next_token(lexer, &token); /* very long numbers */
    end = slc_read_number((const unsigned char *)token.text, number);
    return token.kind == SLC_PBRT_TOKEN_WORD && end > (const unsigned char *)token.text &&
           fabs(*number) <= FLT_MAX;
}

/* Array that receives the numbers of a span: floats or indices. */
struct out {
    float *floats;
    uint32_t *indices;
};

static SluiceResult read_span(const SluicePbrtScene *scene, const struct slc_pbrt_span *span,
                              struct out out, uint64_t *bytes_read)
{
    const struct slc_pbrt_file *file = &scene->files[span->file];
    struct slc_pbrt_lexer lexer;
    SluiceResult result = slc_pbrt_lexer_open(&lexer, slc_pbrt_name(&scene->names, file->path),
                                              NULL, &scene->allocator);
    if (result != SLUICE_SUCCESS)
        return result;
    bool ok = slc_pbrt_stamps_equal(&lexer.window.stamp, &file->stamp) &&
              slc_pbrt_window_seek(&lexer.window, span->offset);
    uint64_t start = lexer.window.file_offset;
    for (uint32_t i = 0; ok && i < span->count; i++) {
        double number;
        ok = read_one(&lexer, &number);
        if (ok && out.floats)
            out.floats[i] = (float)number;
        else if (ok && number >= 0 && number <= INT32_MAX)
            out.indices[i] = (uint32_t)number;
        else
            ok = false;
    }
    *bytes_read += lexer.window.file_offset - start;
    result = lexer.window.failure != SLUICE_SUCCESS ? lexer.window.failure : SLUICE_ERROR_IO;
    slc_pbrt_lexer_finish(&lexer);
    return ok ? SLUICE_SUCCESS : result;
}

static SluiceResult read_floats(const SluicePbrtScene *scene, const struct slc_pbrt_span *span,
                                const float **floats, uint64_t *bytes_read)
{
    if (span->count == 0)
        return SLUICE_SUCCESS;
    float *array = slc_alloc(&scene->allocator, span->count, sizeof *array);
    if (!array)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *floats = array;
    return read_span(scene, span, (struct out){.floats = array}, bytes_read);
}

/* Reads the corners, or fills 0, 1, 2, ... if the scene has none. */
static SluiceResult read_corners(const SluicePbrtScene *scene, const struct slc_pbrt_span *span,
                                 uint32_t count, uint32_t *corners, uint64_t *bytes_read)
{
    if (span->count)
        return read_span(scene, span, (struct out){.indices = corners}, bytes_read);
    for (uint32_t i = 0; i < count; i++)
        corners[i] = i;
    return SLUICE_SUCCESS;
}

/* Splits patches (0, 1, 2, 3), in rows, into triangles (0, 1, 2) and (1, 3, 2). */
static void split_patches(const uint32_t *corners, uint32_t patch_count, uint32_t *indices)
{
    static const uint8_t ORDER[6] = {0, 1, 2, 1, 3, 2};
    for (size_t i = 0; i < patch_count; i++)
        for (int j = 0; j < 6; j++)
            indices[6 * i + j] = corners[4 * i + ORDER[j]];
}

static SluiceResult read_faces(const SluicePbrtScene *scene,
                               const struct slc_pbrt_shape_entry *shape,
                               const struct slc_pbrt_span *span, SluicePbrtMesh *mesh)
{
    const SluiceAllocationCallbacks *cb = &scene->allocator;
    bool is_patch = shape->kind == SLUICE_PBRT_SHAPE_BILINEAR;
    uint32_t width = is_patch ? 4 : 3, count = span->count ? span->count : width;
    uint32_t triangles = is_patch ? count / width * 2 : count / width;
    uint32_t *indices = slc_alloc(cb, 3 * (size_t)triangles, sizeof *indices);
    uint32_t *corners = is_patch ? slc_alloc(cb, count, sizeof *corners) : indices;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (indices && corners)
        result = read_corners(scene, span, count, corners, &mesh->bytesRead);
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < count; i++)
        if (corners[i] >= mesh->vertexCount)
            result = SLUICE_ERROR_IO;
    if (result == SLUICE_SUCCESS && is_patch)
        split_patches(corners, count / width, indices);
    if (is_patch)
        slc_free(cb, corners, count, sizeof *corners);
    if (indices) {
        mesh->pIndices = indices;
        mesh->triangleCount = triangles;
    }
    return result;
}

static SluiceResult subdivide(const SluicePbrtScene *scene,
                              const struct slc_pbrt_shape_entry *shape, SluicePbrtMesh *mesh)
{
    SluiceResult result = slc_pbrt_subdivide(&scene->allocator, shape->data.mesh.levels,
                                             scene->limits.maxMeshSize, mesh);
    if (result != SLUICE_ERROR_UNSUPPORTED)
        return result;
    slc_pbrt_warn(scene, &shape->place,
                  "faces do not form one surface with a direction: the control mesh is shown");
    return SLUICE_SUCCESS;
}

SluiceResult slc_pbrt_read_inline_mesh(const SluicePbrtScene *scene,
                                       const struct slc_pbrt_shape_entry *shape,
                                       SluicePbrtMesh *mesh)
{
    const struct slc_pbrt_span *spans = &scene->spans[shape->data.mesh.spans];
    uint64_t numbers = 0;
    *mesh = (SluicePbrtMesh){.structSize = sizeof *mesh,
                             .vertexCount = spans[SLC_PBRT_SPAN_POSITIONS].count / 3};
    for (int i = 0; i < SLC_PBRT_SPAN_COUNT; i++)
        numbers += spans[i].count;
    if (numbers > scene->limits.maxMeshSize / sizeof(float))
        return slc_pbrt_fail(scene, SLUICE_ERROR_LIMIT_EXCEEDED, &shape->place,
                             "the mesh is larger than maxMeshSize");
    SluiceResult result =
        read_floats(scene, &spans[SLC_PBRT_SPAN_POSITIONS], &mesh->pPositions, &mesh->bytesRead);
    if (result == SLUICE_SUCCESS)
        result =
            read_floats(scene, &spans[SLC_PBRT_SPAN_NORMALS], &mesh->pNormals, &mesh->bytesRead);
    if (result == SLUICE_SUCCESS)
        result = read_floats(scene, &spans[SLC_PBRT_SPAN_UVS], &mesh->pUvs, &mesh->bytesRead);
    if (result == SLUICE_SUCCESS)
        result = read_faces(scene, shape, &spans[SLC_PBRT_SPAN_INDICES], mesh);
    if (result == SLUICE_SUCCESS && shape->kind == SLUICE_PBRT_SHAPE_LOOP)
        result = subdivide(scene, shape, mesh);
    if (result == SLUICE_SUCCESS)
        return SLUICE_SUCCESS;
    slc_pbrt_free_mesh(&scene->allocator, mesh);
    *mesh = (SluicePbrtMesh){.structSize = sizeof *mesh};
    if (result == SLUICE_ERROR_LIMIT_EXCEEDED)
        return slc_pbrt_fail(scene, result, &shape->place,
                             "subdivided, the mesh is larger than maxMeshSize");
    return slc_pbrt_fail(scene, result, &shape->place, "the mesh cannot be read again: %s",
                         result == SLUICE_ERROR_IO ? "the text has changed"
                                                   : slc_pbrt_failure_text(result));
}
