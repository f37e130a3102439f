#include "pbrt/shape_reader.h"

#include "base/alloc.h"
#include "pbrt/ply_reader.h"

#include <math.h>

#define SEGMENTS 64u /* segments of a full turn */
#define SPHERE_ROWS 32u
#define TURN 6.283185307179586

/* Grid of points: `columns` + 1 around, `rows` + 1 from v = 0 to v = 1. */
struct grid {
    const struct slc_pbrt_shape_entry *shape;
    uint32_t columns, rows;
};

/* Computes position and, for smooth surfaces, the normal of a grid point. */
static void find_point(const struct grid *grid, uint32_t column, uint32_t row, float position[3],
                       float normal[3])
{
    const struct slc_pbrt_shape_entry *shape = grid->shape;
    double radius = shape->data.quadric.radius, z_min = shape->data.quadric.z_min,
           z_max = shape->data.quadric.z_max;
    double phi = TURN * shape->data.quadric.phi_max / 360 * column / grid->columns;
    double v = (double)row / grid->rows, around = radius, z = z_min + v * (z_max - z_min);
    double n[3] = {cos(phi), sin(phi), 0};
    if (shape->kind == SLUICE_PBRT_SHAPE_DISK) {
        around = radius + v * ((double)shape->data.quadric.inner_radius - radius);
        n[0] = n[1] = 0;
        n[2] = 1;
    } else if (shape->kind == SLUICE_PBRT_SHAPE_SPHERE) {
        double least = acos(fmax(-1, fmin(1, z_min / radius)));
        double most = acos(fmax(-1, fmin(1, z_max / radius)));
        double theta = least + v * (most - least);
        around = radius * sin(theta);
        z = radius * cos(theta);
        n[0] *= sin(theta);
        n[1] *= sin(theta);
        n[2] = cos(theta);
    }
    position[0] = (float)(around * cos(phi));
    position[1] = (float)(around * sin(phi));
    position[2] = (float)z;
    for (int i = 0; i < 3; i++)
        normal[i] = (float)n[i];
}

static void fill_vertices(const struct grid *grid, float *positions, float *normals, float *uvs)
{
    for (uint32_t row = 0; row <= grid->rows; row++)
        for (uint32_t column = 0; column <= grid->columns; column++) {
            size_t at = (size_t)row * (grid->columns + 1) + column;
            find_point(grid, column, row, positions + 3 * at, normals + 3 * at);
            uvs[2 * at] = (float)column / (float)grid->columns;
            uvs[2 * at + 1] = (float)row / (float)grid->rows;
        }
}

/* Fills indices. Triangles' normals point to the side of the vertices' normals. */
static void fill_indices(const struct grid *grid, uint32_t *indices)
{
    bool is_disk = grid->shape->kind == SLUICE_PBRT_SHAPE_DISK;
    uint32_t width = grid->columns + 1;
    for (uint32_t row = 0; row < grid->rows; row++)
        for (uint32_t column = 0; column < grid->columns; column++) {
            uint32_t a = row * width + column, b = a + 1, c = a + width, d = c + 1;
            const uint32_t outwards[6] = {a, b, d, a, d, c}, along_z[6] = {a, b, c, b, d, c};
            for (int i = 0; i < 6; i++)
                *indices++ = is_disk ? along_z[i] : outwards[i];
        }
}

SluiceResult slc_pbrt_build_quadric(const SluicePbrtScene *scene,
                                    const struct slc_pbrt_shape_entry *shape, SluicePbrtMesh *mesh)
{
    const SluiceAllocationCallbacks *cb = &scene->allocator;
    float turn = shape->data.quadric.phi_max / 360;
    struct grid grid = {shape, (uint32_t)ceilf(turn * SEGMENTS),
                        shape->kind == SLUICE_PBRT_SHAPE_SPHERE ? SPHERE_ROWS : 1};
    if (grid.columns == 0)
        grid.columns = 1;
    *mesh = (SluicePbrtMesh){.structSize = sizeof *mesh,
                             .vertexCount = (grid.columns + 1) * (grid.rows + 1),
                             .triangleCount = 2 * grid.columns * grid.rows};
    size_t vertices = mesh->vertexCount;
    float *positions = slc_alloc(cb, 3 * vertices, sizeof *positions);
    float *normals = slc_alloc(cb, 3 * vertices, sizeof *normals);
    float *uvs = slc_alloc(cb, 2 * vertices, sizeof *uvs);
    uint32_t *indices = slc_alloc(cb, 3 * (size_t)mesh->triangleCount, sizeof *indices);
    mesh->pPositions = positions;
    mesh->pNormals = normals;
    mesh->pUvs = uvs;
    mesh->pIndices = indices;
    if (!positions || !normals || !uvs || !indices) {
        slc_pbrt_free_mesh(cb, mesh);
        *mesh = (SluicePbrtMesh){.structSize = sizeof *mesh};
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    fill_vertices(&grid, positions, normals, uvs);
    fill_indices(&grid, indices);
    return SLUICE_SUCCESS;
}

SluicePbrtBounds slc_pbrt_quadric_bounds(const struct slc_pbrt_shape_entry *shape)
{
    float r = shape->data.quadric.radius;
    return (SluicePbrtBounds){{-r, -r, shape->data.quadric.z_min},
                              {r, r, shape->data.quadric.z_max}};
}
