#include "stage_pick.h"

#include <math.h>

static struct vec3 position_of(const struct scene_vertex *vertex)
{
    return (struct vec3){vertex->position[0], vertex->position[1], vertex->position[2]};
}

/* Intersects a ray and the plane of a triangle. Moeller and Trumbore: "Fast, Minimum Storage
 * Ray/Triangle Intersection", 1997. */
static bool meets_plane(struct vec3 eye, struct vec3 ray,
                        const struct scene_vertex *const corners[3], float *t, float *b, float *c)
{
    const struct vec3 first = position_of(corners[0]);
    const struct vec3 e1 = vec3_sub(position_of(corners[1]), first);
    const struct vec3 e2 = vec3_sub(position_of(corners[2]), first);
    const struct vec3 p = vec3_cross(ray, e2), to = vec3_sub(eye, first), q = vec3_cross(to, e1);
    const float determinant = vec3_dot(e1, p);
    if (fabsf(determinant) < 1e-12f)
        return false;
    *b = vec3_dot(to, p) / determinant;
    *c = vec3_dot(ray, q) / determinant;
    *t = vec3_dot(e2, q) / determinant;
    return true;
}

static bool meets(struct vec3 eye, struct vec3 ray, const struct scene_vertex *const corners[3],
                  float *t, float *b, float *c)
{
    return meets_plane(eye, ray, corners, t, b, c) && *b >= 0 && *c >= 0 && *b + *c <= 1 && *t > 0;
}

static float wrap(float x)
{
    return x - floorf(x);
}

/* Writes the UVs of a slot's image at a point of a triangle, not wrapped. */
static void uv_at(const struct scene_slot *slot, const struct scene_vertex *const corners[3],
                  float b, float c, float to[2])
{
    const float *m = slot->m;
    float uv[2];
    for (int k = 0; k < 2; k++)
        uv[k] = corners[0]->uv[slot->uv_set][k] * (1 - b - c) +
                corners[1]->uv[slot->uv_set][k] * b + corners[2]->uv[slot->uv_set][k] * c;
    to[0] = m[0] * uv[0] + m[1] * uv[1] + m[4];
    to[1] = m[2] * uv[0] + m[3] * uv[1] + m[5];
}

static const struct scene_slot *slot_of(const struct scene_data *scene, uint32_t material)
{
    return &scene->materials[material].slots[SLOT_COLOR];
}

static void corners_of(const struct scene_data *scene, uint32_t first_index,
                       const struct scene_vertex *corners[3])
{
    for (int k = 0; k < 3; k++)
        corners[k] = &scene->vertices[scene->indices[first_index + (uint32_t)k]];
}

static void try_part(const struct scene_data *scene, const struct scene_part *part, struct vec3 eye,
                     struct vec3 ray, float *nearest, struct stage_pick *pick)
{
    for (uint32_t i = 0; i + 2 < part->index_count; i += 3) {
        const struct scene_slot *slot = slot_of(scene, part->material);
        const struct scene_vertex *corners[3];
        float t, b, c, uv[2];
        corners_of(scene, part->first_index + i, corners);
        if (!meets(eye, ray, corners, &t, &b, &c) || t >= *nearest)
            continue;
        *nearest = t;
        uv_at(slot, corners, b, c, uv);
        *pick = (struct stage_pick){.hit = true,
                                    .texture = slot->image == SCENE_NO_IMAGE ? STAGE_NO_TEXTURE
                                                                             : slot->image,
                                    .u = wrap(uv[0]),
                                    .v = wrap(uv[1]),
                                    .position = vec3_add(eye, vec3_scale(ray, t)),
                                    .material = part->material,
                                    .first_index = part->first_index + i};
    }
}

struct ray {
    struct vec3 from, along;
};

static struct ray ray_at(const struct view_camera *camera, float aspect, float x, float y)
{
    const struct view_extent extent = view_camera_extent(camera, aspect);
    const struct vec3 forward = view_camera_forward(camera), right = view_camera_right(camera);
    const struct vec3 up = vec3_cross(right, forward);
    const struct vec3 aside =
        vec3_add(vec3_scale(right, (2 * x - 1) * extent.x), vec3_scale(up, (1 - 2 * y) * extent.y));
    if (camera->span > 0)
        return (struct ray){vec3_add(camera->position, aside), forward};
    return (struct ray){camera->position, vec3_add(forward, aside)};
}

struct stage_pick scene_pick(const struct scene_data *scene, const struct view_camera *camera,
                             float aspect, float x, float y)
{
    struct stage_pick pick = {.texture = STAGE_NO_TEXTURE};
    const struct ray ray = ray_at(camera, aspect, x, y);
    float nearest = INFINITY;
    for (uint32_t i = 0; i < scene->part_count; i++)
        try_part(scene, &scene->parts[i], ray.from, ray.along, &nearest, &pick);
    return pick;
}

bool scene_pick_pixel(const struct scene_data *scene, const struct stage_pick *pick,
                      const struct stage_pixel *pixel, float parts[4])
{
    const struct view_camera *camera = &pixel->camera;
    const float aspect = (float)pixel->width / (float)pixel->height;
    const struct ray rays[3] = {
        ray_at(camera, aspect, pixel->x, pixel->y),
        ray_at(camera, aspect, pixel->x + 1.0f / (float)pixel->width, pixel->y),
        ray_at(camera, aspect, pixel->x, pixel->y + 1.0f / (float)pixel->height)};
    const struct scene_vertex *corners[3];
    float uv[3][2];
    if (!pick->hit || pick->texture == STAGE_NO_TEXTURE)
        return false;
    corners_of(scene, pick->first_index, corners);
    for (int i = 0; i < 3; i++) {
        float t, b, c;
        if (!meets_plane(rays[i].from, rays[i].along, corners, &t, &b, &c) || !(t > 0))
            return false;
        uv_at(slot_of(scene, pick->material), corners, b, c, uv[i]);
    }
    for (int i = 0; i < 4; i++)
        parts[i] = uv[1 + i / 2][i % 2] - uv[0][i % 2];
    return true;
}

/* Repetitions of a texture that are searched within a triangle, per axis. */
#define MOST_WRAPS 8

static bool inside(float uv[3][2], float u, float v, float *b, float *c)
{
    const float e1[2] = {uv[1][0] - uv[0][0], uv[1][1] - uv[0][1]};
    const float e2[2] = {uv[2][0] - uv[0][0], uv[2][1] - uv[0][1]};
    const float to[2] = {u - uv[0][0], v - uv[0][1]};
    const float determinant = e1[0] * e2[1] - e1[1] * e2[0];
    if (fabsf(determinant) < 1e-20f)
        return false;
    *b = (to[0] * e2[1] - to[1] * e2[0]) / determinant;
    *c = (e1[0] * to[1] - e1[1] * to[0]) / determinant;
    return *b >= 0 && *c >= 0 && *b + *c <= 1;
}

/* Finds u, v in a triangle. A repeated texture may have this point several times; one is found. */
static bool find_in_triangle(const struct scene_slot *slot,
                             const struct scene_vertex *const corners[3], float u, float v,
                             float *b, float *c)
{
    float uv[3][2], first[2];
    for (int i = 0; i < 3; i++)
        uv_at(slot, corners, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f, uv[i]);
    for (int k = 0; k < 2; k++)
        first[k] = floorf(fminf(uv[0][k], fminf(uv[1][k], uv[2][k])));
    for (int y = 0; y < MOST_WRAPS; y++)
        for (int x = 0; x < MOST_WRAPS; x++)
            if (inside(uv, first[0] + (float)x + u, first[1] + (float)y + v, b, c))
                return true;
    return false;
}

static bool find_in_part(const struct scene_data *scene, const struct scene_part *part,
                         const struct scene_slot *slot, float u, float v, struct vec3 *position,
                         struct vec3 *normal)
{
    for (uint32_t i = 0; i + 2 < part->index_count; i += 3) {
        const struct scene_vertex *corners[3];
        float b, c;
        corners_of(scene, part->first_index + i, corners);
        if (!find_in_triangle(slot, corners, u, v, &b, &c))
            continue;
        const struct vec3 first = position_of(corners[0]);
        const struct vec3 e1 = vec3_sub(position_of(corners[1]), first);
        const struct vec3 e2 = vec3_sub(position_of(corners[2]), first);
        *position = vec3_add(first, vec3_add(vec3_scale(e1, b), vec3_scale(e2, c)));
        *normal = vec3_normalize(vec3_cross(e1, e2));
        return true;
    }
    return false;
}

bool scene_find_texel(const struct scene_data *scene, uint32_t image, float u, float v,
                      struct vec3 *position, struct vec3 *normal)
{
    for (uint32_t i = 0; i < scene->part_count; i++)
        for (int k = 0; k < SLOT_COUNT; k++) {
            const struct scene_slot *slot = &scene->materials[scene->parts[i].material].slots[k];
            if (slot->image == image &&
                find_in_part(scene, &scene->parts[i], slot, u, v, position, normal))
                return true;
        }
    return false;
}
