#include "oracle/tiles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vips/vips.h>

/* Tolerances of level and texel, for the rounding of floats. */
#define LOD_SLACK 0.004
#define TEXEL_SLACK 0.03

/* A picture's size and tile size. */
struct oracle_shape {
    uint32_t width, height; /* 0: not read yet */
    uint32_t tile[2];
};

struct oracle_key {
    uint64_t tile; /* 0: free */
    enum oracle_tile sure;
};

/* A sample of a texture: coordinates, and their derivatives along both axes of the cone. */
struct sample {
    uint32_t texture;
    double at[2], change[2][2];
};

bool oracle_tiles_create(struct oracle_tiles *t, const struct oracle_scene *scene, double spread)
{
    *t = (struct oracle_tiles){.scene = scene, .spread = spread, .size = 1 << 16};
    t->keys = calloc(t->size, sizeof *t->keys);
    t->shapes = calloc(scene->info.textureCount + 1u, sizeof *t->shapes);
    return t->keys && t->shapes;
}

void oracle_tiles_finish(struct oracle_tiles *t)
{
    free(t->keys);
    free(t->shapes);
    *t = (struct oracle_tiles){0};
}

static bool mark(struct oracle_tiles *t, uint64_t tile, enum oracle_tile sure)
{
    size_t at = (size_t)((tile * 0x9e3779b97f4a7c15u) >> 20) & (t->size - 1);
    while (t->keys[at].tile && t->keys[at].tile != tile)
        at = (at + 1) & (t->size - 1);
    t->count += t->keys[at].tile == 0;
    if (!t->keys[at].tile || t->keys[at].sure < sure)
        t->keys[at] = (struct oracle_key){tile, sure};
    return 2 * t->count < t->size;
}

/* Textures of one file share its tiles. */
static uint32_t first_of_picture(const struct oracle_scene *scene, uint32_t texture)
{
    for (uint32_t i = 0; i < texture; i++)
        if (scene->textures[i].pImagePath &&
            strcmp(scene->textures[i].pImagePath, scene->textures[texture].pImagePath) == 0)
            return i;
    return texture;
}

/* Reads the tile size: Vulkan's standard sparse image block shapes, 64 KiB of texels of 1 to 16
 * bytes. */
static bool read_shape(struct oracle_tiles *t, uint32_t texture)
{
    static const uint32_t TILES[5][2] = {{256, 256}, {256, 128}, {128, 128}, {128, 64}, {64, 64}};
    struct oracle_shape *shape = &t->shapes[texture];
    if (shape->width > 0)
        return true;
    VipsImage *image = vips_image_new_from_file(t->scene->textures[texture].pImagePath, NULL);
    if (!image)
        return false;
    uint32_t channels = image->Bands == 3 ? 4 : (uint32_t)image->Bands, power = 0;
    uint32_t bytes = channels * (image->BandFmt == VIPS_FORMAT_UCHAR ? 1 : 2);
    while (1u << power < bytes)
        power++;
    *shape = (struct oracle_shape){(uint32_t)image->Xsize, (uint32_t)image->Ysize, {0}};
    memcpy(shape->tile, TILES[power], sizeof shape->tile);
    t->picture_count++;
    g_object_unref(image);
    return true;
}

/* Marks texels. A texel on both sides of the tolerance is certainly sampled. */
static bool mark_texels(struct oracle_tiles *t, const struct sample *s, uint32_t level,
                        bool is_sure)
{
    const struct oracle_shape *shape = &t->shapes[s->texture];
    uint32_t size[2] = {shape->width >> level, shape->height >> level};
    if (2 * size[0] <= shape->tile[0] && 2 * size[1] <= shape->tile[1])
        return true; /* in the tail: docs/demand.md, "Memory" */
    bool clamps = t->scene->textures[s->texture].wrap != SLUICE_PBRT_WRAP_REPEAT;
    for (int i = 0; i < 36; i++) {
        uint64_t key = (uint64_t)(s->texture + 1) << 40 | (uint64_t)level << 32;
        bool sure = is_sure, likely = true;
        for (int axis = 0; axis < 2; axis++) {
            int way = axis ? i / 6
                           : i % 6; /* below, at or above by the tolerance; first or second texel */
            double x = s->at[axis] * size[axis] - 0.5;
            long n = (long)size[axis],
                 texel = (long)floor(x + TEXEL_SLACK * (way / 2 - 1)) + way % 2;
            long low = (long)floor(x - TEXEL_SLACK), high = (long)floor(x + TEXEL_SLACK);
            sure = sure && texel >= high && texel <= low + 1;
            likely = likely && texel >= (long)floor(x) && texel <= (long)floor(x) + 1;
            texel = clamps ? (texel < 0 ? 0 : texel >= n ? n - 1 : texel) : ((texel % n) + n) % n;
            key |= (uint64_t)((uint32_t)texel / shape->tile[axis]) << (axis ? 16 : 0);
        }
        if (!mark(t, key,
                  sure     ? ORACLE_TILE_SURE
                  : likely ? ORACLE_TILE_LIKELY
                           : ORACLE_TILE_MAYBE))
            return false;
    }
    return true;
}

static bool has_level(double lod, uint32_t level)
{
    lod = fmax(lod, 0);
    return floor(lod) == level || (floor(lod) + 1 == level && lod - floor(lod) > 1.0 / 512);
}

static bool touch(struct oracle_tiles *t, struct sample *s)
{
    double longest = 0;
    s->texture = first_of_picture(t->scene, s->texture);
    if (!read_shape(t, s->texture))
        return false;
    const struct oracle_shape *shape = &t->shapes[s->texture];
    for (int i = 0; i < 2; i++)
        longest =
            fmax(longest, hypot(s->change[i][0] * shape->width, s->change[i][1] * shape->height));
    double lod = log2(fmax(longest, 1e-6));
    for (uint32_t level = 0; level < 16; level++) {
        bool low = has_level(lod - LOD_SLACK, level), high = has_level(lod + LOD_SLACK, level);
        if ((low || high) && !mark_texels(t, s, level, low && high))
            return false;
    }
    return true;
}

/* Computes the cone's footprint on the plane in world space: along the ray, and across. */
static void cover(const struct oracle_tiles *t, const struct oracle_ray *ray,
                  const struct oracle_hit *hit, struct vec axes[2])
{
    struct vec n = hit->geometric, across = unit(cross(n, ray->direction));
    double width = t->spread * hit->t, cosine = fmax(fabs(dot(n, ray->direction)), 1e-4);
    if (length(cross(n, ray->direction)) < 1e-6)
        across = unit(cross(n, fabs(n.x) > 0.5 ? vec(0, 1, 0) : vec(1, 0, 0)));
    axes[0] = scale(cross(across, n), width / cosine);
    axes[1] = scale(across, width);
}

/* Returns a neighboring point on the triangle's plane, solved for its barycentric coordinates. */
static struct oracle_point beside(const struct oracle_tiles *t, const struct oracle_hit *hit,
                                  struct vec step)
{
    const struct oracle_place *place = &t->scene->places[hit->place];
    struct oracle_hit moved = *hit;
    struct vec p[3];
    oracle_corners(&t->scene->meshes[place->mesh], hit->triangle, p);
    for (int i = 0; i < 3; i++)
        p[i] = apply_point(place->transform, p[i]);
    struct vec a = sub(p[1], p[0]), b = sub(p[2], p[0]), n = cross(a, b);
    double square = dot(n, n);
    if (square > 0) {
        moved.b1 += dot(cross(step, b), n) / square;
        moved.b2 += dot(cross(a, step), n) / square;
    }
    oracle_find_point(t->scene, &moved);
    return moved.point;
}

static bool touch_value(struct oracle_tiles *t, const SluicePbrtValue *value,
                        const struct oracle_point points[3])
{
    if (value->texture == SLUICE_PBRT_NONE)
        return true;
    const SluicePbrtTexture *texture = &t->scene->textures[value->texture];
    double at[3][2];
    for (int i = 0; i < 3; i++)
        oracle_map(texture, &points[i], &at[i][0], &at[i][1]);
    switch (texture->kind) {
    case SLUICE_PBRT_TEXTURE_IMAGE: break;
    case SLUICE_PBRT_TEXTURE_CHECKERBOARD:
        return touch_value(t, &texture->inputs[((long)floor(at[0][0]) + (long)floor(at[0][1])) & 1],
                           points);
    case SLUICE_PBRT_TEXTURE_MIX:
        if (!touch_value(t, &texture->amount, points))
            return false;
        return touch_value(t, &texture->inputs[0], points) &&
               touch_value(t, &texture->inputs[1], points);
    case SLUICE_PBRT_TEXTURE_SCALE:
        return touch_value(t, &texture->inputs[0], points) &&
               touch_value(t, &texture->inputs[1], points);
    default: return true;
    }
    struct sample s = {.texture = value->texture, .at = {at[0][0], 1 - at[0][1]}};
    for (int i = 0; i < 2; i++)
        for (int axis = 0; axis < 2; axis++)
            s.change[i][axis] = at[i + 1][axis] - at[0][axis];
    return !texture->pImagePath || touch(t, &s);
}

bool oracle_tiles_add(struct oracle_tiles *t, const struct oracle_ray *ray,
                      const struct oracle_hit *hit)
{
    const struct oracle_scene *scene = t->scene;
    const SluicePbrtMaterial *m =
        &scene->materials[scene->shapes[scene->places[hit->place].shape].material];
    struct vec axes[2];
    cover(t, ray, hit, axes);
    struct oracle_point points[3] = {hit->point, beside(t, hit, axes[0]), beside(t, hit, axes[1])};
    return touch_value(t, &m->diffuse, points) && touch_value(t, &m->specular, points) &&
           touch_value(t, &m->transmission, points);
}

size_t oracle_tiles_count(const struct oracle_tiles *t, enum oracle_tile least)
{
    size_t sum = t->picture_count;
    for (size_t i = 0; i < t->size; i++)
        sum += t->keys[i].tile && t->keys[i].sure >= least;
    return sum;
}
