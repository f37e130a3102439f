#include "shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../common/noise.h"
#include "../common/vecmath.h"

#define NORMAL_STEP 1e-3f

/** A point of a surface over (u, v) in [0, 1]. */
typedef struct vec3 (*surface_point)(float u, float v, int part);

struct patch {
    surface_point point;
    int part;
    int columns, rows;
    float uv_scale[2];
};

static bool reserve(void **items, size_t item_size, size_t count, size_t *capacity)
{
    if (count <= *capacity)
        return true;
    size_t wanted = count * 2;
    void *grown = realloc(*items, wanted * item_size);
    if (!grown)
        return false;
    *items = grown;
    *capacity = wanted;
    return true;
}

/** Normal of the surface. At a pole, where the patch has no width, it points away from the
 * origin. */
static struct vec3 patch_normal(const struct patch *patch, float u, float v)
{
    const float step = NORMAL_STEP;
    struct vec3 along_u =
        vec3_sub(patch->point(u + step, v, patch->part), patch->point(u - step, v, patch->part));
    struct vec3 along_v =
        vec3_sub(patch->point(u, v + step, patch->part), patch->point(u, v - step, patch->part));
    struct vec3 normal = vec3_cross(along_u, along_v);
    if (vec3_dot(normal, normal) > 1e-14f)
        return vec3_normalize(normal);
    return vec3_normalize(patch->point(u, v, patch->part));
}

static struct TracerVertex patch_vertex(const struct patch *patch, float u, float v)
{
    struct vec3 at = patch->point(u, v, patch->part), normal = patch_normal(patch, u, v);
    return (struct TracerVertex){{at.x, at.y, at.z},
                                 {normal.x, normal.y, normal.z},
                                 {u * patch->uv_scale[0], v * patch->uv_scale[1]}};
}

static bool append_patch(const struct patch *patch, struct mesh *mesh)
{
    size_t vertex_count = (size_t)(patch->columns + 1) * (size_t)(patch->rows + 1);
    size_t index_count = 6 * (size_t)patch->columns * (size_t)patch->rows;
    if (!reserve((void **)&mesh->vertices, sizeof *mesh->vertices,
                 mesh->vertex_count + vertex_count, &mesh->vertex_capacity) ||
        !reserve((void **)&mesh->indices, sizeof *mesh->indices, mesh->index_count + index_count,
                 &mesh->index_capacity))
        return false;
    const uint32_t first = (uint32_t)mesh->vertex_count, pitch = (uint32_t)patch->columns + 1;
    for (int row = 0; row <= patch->rows; row++)
        for (int column = 0; column <= patch->columns; column++)
            mesh->vertices[mesh->vertex_count++] = patch_vertex(
                patch, (float)column / (float)patch->columns, (float)row / (float)patch->rows);
    for (uint32_t row = 0; row < (uint32_t)patch->rows; row++)
        for (uint32_t column = 0; column < (uint32_t)patch->columns; column++) {
            const uint32_t a = first + row * pitch + column;
            const uint32_t corners[6] = {a, a + 1, a + pitch, a + pitch, a + 1, a + pitch + 1};
            memcpy(mesh->indices + mesh->index_count, corners, sizeof corners);
            mesh->index_count += 6;
        }
    return true;
}

float ground_height(float x, float z)
{
    struct noise_sum hills = noise_octaves(x, z, 0.045f, 3, 0.4f, 0.0f, 91);
    float distance = sqrtf(x * x + z * z);
    return 0.9f * hills.value * noise_smoothstep(3.0f, 30.0f, distance) + 0.08f * hills.value;
}

static struct vec3 ground_point(float u, float v, int part)
{
    (void)part;
    float x = (2.0f * u - 1.0f) * GROUND_EXTENT, z = (1.0f - 2.0f * v) * GROUND_EXTENT;
    return (struct vec3){x, ground_height(x, z), z};
}

/** Direction from the south pole (v = 0) up. u goes eastwards, so that u, v and the outside are a
 * right-handed system. */
static struct vec3 direction_at(float u, float v)
{
    float longitude = NOISE_TAU * u, latitude = 0.5f * NOISE_TAU * (v - 0.5f);
    return (struct vec3){cosf(latitude) * sinf(longitude), sinf(latitude),
                         cosf(latitude) * cosf(longitude)};
}

static struct vec3 ball_point(float u, float v, int part)
{
    (void)part;
    return direction_at(u, v);
}

static struct vec3 gourd_point(float u, float v, int part)
{
    (void)part;
    struct vec3 at = direction_at(u, v);
    float ribs = 1.0f - 0.085f * (1.0f - fabsf(cosf(5.0f * NOISE_TAU * u))) * cosf(at.y * 1.5f);
    float waist = ribs * (0.97f - 0.12f * sinf(2.4f * at.y));
    return (struct vec3){at.x * waist, at.y * 0.82f, at.z * waist};
}

static struct vec3 pebble_point(float u, float v, int part)
{
    (void)part;
    struct vec3 at = direction_at(u, v);
    float dents = 0.20f * sinf(2.3f * at.x + 1.7f * at.z + 0.4f) * cosf(2.9f * at.y + at.x) +
                  0.09f * sinf(5.1f * at.z - 3.3f * at.y) * sinf(4.7f * at.x + 1.0f);
    return vec3_scale((struct vec3){at.x, 0.72f * at.y, 0.88f * at.z}, 0.92f + dents);
}

/** Point on one of six faces. Points are denser where the edges are round. */
static struct vec3 box_point(float u, float v, int face)
{
    const float radius = 0.13f, inner = 1.0f - radius;
    float x = 2.0f * u - 1.0f, y = 2.0f * v - 1.0f;
    float a = 0.25f * x + 0.75f * sinf(0.25f * NOISE_TAU * x);
    float b = 0.25f * y + 0.75f * sinf(0.25f * NOISE_TAU * y);
    const struct vec3 faces[6] = {{a, b, 1.0f},  {-a, b, -1.0f}, {1.0f, b, -a},
                                  {-1.0f, b, a}, {a, 1.0f, -b},  {a, -1.0f, b}};
    struct vec3 at = faces[face];
    struct vec3 core = {noise_clamp(at.x, -inner, inner), noise_clamp(at.y, -inner, inner),
                        noise_clamp(at.z, -inner, inner)};
    return vec3_add(core, vec3_scale(vec3_normalize(vec3_sub(at, core)), radius));
}

/** Point on the outside, from the foot up and over the lip. The belly is at a third of the
 * height. */
static struct vec3 vase_point(float u, float v, int part)
{
    (void)part;
    float height = fminf(v / 0.92f, 1.0f), lip = fmaxf(v - 0.92f, 0.0f) / 0.08f;
    float belly = sinf(0.5f * NOISE_TAU * powf(fmaxf(height, 0.0f), 0.72f));
    float radius = 0.30f + 0.52f * belly * belly + 0.14f * noise_smoothstep(0.8f, 1.0f, height);
    radius = (radius - 0.06f * lip) * noise_smoothstep(-0.02f, 0.012f, v);
    float y = 2.0f * height - 0.25f * lip * lip;
    return (struct vec3){radius * sinf(NOISE_TAU * u), y, radius * cosf(NOISE_TAU * u)};
}

/** Point of a leaf: u across it, v from its stalk to its tip. */
static struct vec3 leaf_point(float u, float v, uint32_t hash, float lean, float width)
{
    float turn = NOISE_TAU * noise_unit(hash),
          length = 0.75f + 0.5f * noise_unit(hash * 0x9e3779b1u);
    float angle = lean * (0.5f + noise_unit(hash * 0x85ebca77u));
    float bend = angle + (0.3f + 1.3f * angle) * v; /* angle from the upright */
    float out = length * (0.08f + 0.85f * v * sinf(0.5f * (angle + bend)));
    float up = length * v * cosf(0.5f * (angle + bend));
    float across = width * (u - 0.5f), fold = 0.25f * fabsf(across);
    return (struct vec3){out * sinf(turn) + across * cosf(turn), up + fold,
                         out * cosf(turn) - across * sinf(turn)};
}

static struct vec3 shrub_point(float u, float v, int leaf)
{
    return leaf_point(u, v, noise_hash(leaf, 0, 3), 0.75f, 0.36f);
}

static struct vec3 grasses_point(float u, float v, int leaf)
{
    return leaf_point(u, v, noise_hash(leaf, 1, 5), 0.38f, 0.16f);
}

static bool append_parts(struct patch patch, int count, struct mesh *mesh)
{
    const struct mesh before = *mesh;
    for (patch.part = 0; patch.part < count; patch.part++)
        if (!append_patch(&patch, mesh)) {
            mesh->vertex_count = before.vertex_count;
            mesh->index_count = before.index_count;
            return false;
        }
    return true;
}

bool shapes_append(enum shape_kind kind, struct mesh *mesh)
{
    static const struct {
        struct patch patch;
        int parts;
    } shapes[SHAPE_COUNT] = {
        [SHAPE_GROUND] = {{ground_point, 0, 160, 160, {28.0f, 28.0f}}, 1},
        [SHAPE_BALL] = {{ball_point, 0, 96, 48, {2.0f, 1.0f}}, 1},
        [SHAPE_GOURD] = {{gourd_point, 0, 160, 48, {2.0f, 1.0f}}, 1},
        [SHAPE_PEBBLE] = {{pebble_point, 0, 80, 40, {2.0f, 1.0f}}, 1},
        [SHAPE_BOX] = {{box_point, 0, 18, 18, {1.0f, 1.0f}}, 6},
        [SHAPE_VASE] = {{vase_point, 0, 80, 64, {2.0f, 1.0f}}, 1},
        [SHAPE_SHRUB] = {{shrub_point, 0, 2, 8, {1.0f, 1.0f}}, 26},
        [SHAPE_GRASSES] = {{grasses_point, 0, 2, 8, {1.0f, 1.0f}}, 34},
    };
    return append_parts(shapes[kind].patch, shapes[kind].parts, mesh);
}

void mesh_finish(struct mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->indices);
    memset(mesh, 0, sizeof *mesh);
}
