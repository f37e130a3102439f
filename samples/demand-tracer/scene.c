#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/noise.h"

#define PLANTS_PER_TEXTURE 4u
#define SITE_SPACING 1.25f ///< meters
#define GOLDEN_ANGLE 2.3999632f

/** Placement of an instance: scaled, then turned around y, then moved. */
struct placement {
    struct vec3 at, scale;
    float turn; ///< radians
};

static void write_transforms(const struct placement *place, struct TracerInstance *instance)
{
    const float c = cosf(place->turn), s = sinf(place->turn);
    const struct vec3 k = place->scale, t = place->at;
    const float forth[12] = {c * k.x, 0, s * k.z, t.x, 0, k.y, 0, t.y, -s * k.x, 0, c * k.z, t.z};
    const float back[12] = {c / k.x, 0,          -s / k.x, -(c * t.x - s * t.z) / k.x,
                            0,       1.0f / k.y, 0,        -t.y / k.y,
                            s / k.z, 0,          c / k.z,  -(s * t.x + c * t.z) / k.z};
    memcpy(instance->toWorld, forth, sizeof forth);
    memcpy(instance->toObject, back, sizeof back);
}

static void add_instance(struct scene *scene, enum shape_kind kind, uint32_t texture,
                         uint32_t flags, const struct placement *place)
{
    if (scene->instance_count == scene->instance_capacity)
        return;
    struct TracerInstance *instance = &scene->instances[scene->instance_count];
    *instance = (struct TracerInstance){
        .firstIndex = scene->shapes[kind].first_index,
        .rootNode = scene->shapes[kind].root_node,
        .texture = texture,
        .flags = flags | (scene->shapes[kind].cut_out ? TRACER_CUT_OUT : 0u),
    };
    write_transforms(place, instance);
    scene->kinds[scene->instance_count++] = kind;
}

/** Returns the place of the i-th site, arranged like the seeds of a sunflower, moved a little. y is
 * on the ground. */
static struct vec3 site(uint32_t i, float spacing, uint32_t seed)
{
    uint32_t hash = noise_hash((int32_t)i, 17, seed);
    float radius = spacing * sqrtf((float)i + 0.6f), angle = GOLDEN_ANGLE * (float)i;
    float x = radius * cosf(angle) + spacing * 0.35f * (noise_unit(hash) - 0.5f);
    float z = radius * sinf(angle) + spacing * 0.35f * (noise_unit(hash * 0x9e3779b1u) - 0.5f);
    return (struct vec3){x, ground_height(x, z), z};
}

/** Tests for sites that would block the camera's view. */
static bool is_near_camera(struct vec3 at, float clearance)
{
    struct scene_camera camera = scene_default_camera();
    struct vec3 way = vec3_sub(at, camera.eye);
    return way.x * way.x + way.z * way.z < clearance * clearance;
}

static enum shape_kind choose_thing(uint32_t hash)
{
    static const enum shape_kind kinds[8] = {SHAPE_BALL,  SHAPE_VASE, SHAPE_GOURD,  SHAPE_BALL,
                                             SHAPE_GOURD, SHAPE_VASE, SHAPE_PEBBLE, SHAPE_BALL};
    return kinds[hash >> 13 & 7];
}

/** Adds a thing whose lowest point is at `foot`. */
static void add_thing(struct scene *scene, uint32_t hash, uint32_t texture, float size,
                      struct vec3 foot)
{
    enum shape_kind kind = choose_thing(hash);
    float stands[SHAPE_COUNT] = {[SHAPE_BALL] = 1.0f, [SHAPE_GOURD] = 0.82f, [SHAPE_PEBBLE] = 0.6f};
    struct placement place = {foot, {size, size, size}, NOISE_TAU * noise_unit(hash * 0xc2b2ae3du)};
    place.at.y += stands[kind] * size - 0.01f;
    add_instance(scene, kind, texture, hash & 1 || kind == SHAPE_VASE ? TRACER_GLOSSY : 0u, &place);
}

/** Adds a thing, which may stand on a pedestal if two textures are left. Returns the number of
 * textures used. */
static uint32_t add_site(struct scene *scene, uint32_t hash, uint32_t texture, uint32_t left,
                         struct vec3 at)
{
    float share = noise_unit(hash * 0x85ebca77u);
    if (left < 2 || share < 0.4f) {
        add_thing(scene, hash, texture, 0.30f + 0.45f * share, at);
        return 1;
    }
    float height = 0.10f + 0.45f * (share - 0.4f), width = 0.36f + 0.12f * noise_unit(hash);
    struct placement box = {
        {at.x, at.y + height - 0.05f, at.z}, {width, height, width}, 0.7f * (share - 0.7f)};
    add_instance(scene, SHAPE_BOX, texture, 0, &box);
    add_thing(scene, hash, texture + 1, width * 0.78f,
              (struct vec3){at.x, at.y + 2.0f * height - 0.05f, at.z});
    return 2;
}

static void add_things(struct scene *scene, uint32_t seed, uint32_t first, uint32_t end)
{
    for (uint32_t i = 0, texture = first; texture < end; i++) {
        struct vec3 at = site(i, SITE_SPACING, seed);
        if (!is_near_camera(at, 1.7f))
            texture += add_site(scene, noise_hash((int32_t)i, 4, seed), texture, end - texture, at);
    }
}

static void add_plants(struct scene *scene, uint32_t seed, uint32_t first, uint32_t end)
{
    uint32_t count = (end - first) * PLANTS_PER_TEXTURE;
    for (uint32_t i = 0, added = 0; added < count; i++) {
        uint32_t hash = noise_hash((int32_t)i, 9, seed);
        struct vec3 at = site(i, 0.95f, seed + 1);
        if (is_near_camera(at, 2.7f))
            continue;
        float size = 0.35f + 0.4f * noise_unit(hash);
        struct placement place = {at, {size, size, size}, NOISE_TAU * noise_unit(hash * 7u)};
        add_instance(scene, hash & 4 ? SHAPE_GRASSES : SHAPE_SHRUB, first + added++ % (end - first),
                     0, &place);
    }
}

static uint32_t first_leaf_texture(uint32_t texture_count)
{
    return texture_count - (texture_count + 4) / 5;
}

enum texture_use scene_texture_use(uint32_t texture, uint32_t texture_count)
{
    if (texture == 0)
        return TEXTURE_OF_GROUND;
    return texture < first_leaf_texture(texture_count) ? TEXTURE_OF_THING : TEXTURE_OF_LEAVES;
}

static bool build_shapes(struct scene *scene)
{
    for (int kind = 0; kind < SHAPE_COUNT; kind++) {
        struct shape *shape = &scene->shapes[kind];
        shape->first_index = (uint32_t)scene->mesh.index_count;
        if (!shapes_append((enum shape_kind)kind, &scene->mesh))
            return false;
        shape->index_count = (uint32_t)scene->mesh.index_count - shape->first_index;
        shape->cut_out = kind == SHAPE_SHRUB || kind == SHAPE_GRASSES;
        if (!bvh_add_triangles(&scene->bvh, &scene->mesh, shape->first_index, shape->index_count,
                               &shape->root_node))
            return false;
    }
    return true;
}

static bool add_instances(struct scene *scene, uint32_t seed)
{
    uint32_t things_end = first_leaf_texture(scene->texture_count);
    scene->instance_capacity = scene->texture_count * (PLANTS_PER_TEXTURE + 1);
    scene->instances = calloc(scene->instance_capacity, sizeof *scene->instances);
    scene->kinds = calloc(scene->instance_capacity, sizeof *scene->kinds);
    if (!scene->instances || !scene->kinds)
        return false;
    add_instance(scene, SHAPE_GROUND, 0, 0, &(struct placement){{0, 0, 0}, {1, 1, 1}, 0});
    add_things(scene, seed, 1, things_end);
    add_plants(scene, seed, things_end, scene->texture_count);
    return bvh_add_instances(&scene->bvh, scene->instances, scene->instance_count);
}

bool scene_build(uint32_t seed, uint32_t texture_count, struct scene *scene)
{
    memset(scene, 0, sizeof *scene);
    scene->texture_count = texture_count;
    if (build_shapes(scene) && add_instances(scene, seed))
        return true;
    fprintf(stderr, "out of memory\n");
    scene_finish(scene);
    return false;
}

void scene_finish(struct scene *scene)
{
    mesh_finish(&scene->mesh);
    bvh_finish(&scene->bvh);
    free(scene->instances);
    free(scene->kinds);
    memset(scene, 0, sizeof *scene);
}

struct scene_camera scene_default_camera(void)
{
    return (struct scene_camera){{0.4f, 1.7f, 6.6f}, {0.0f, 0.42f, 0.6f}, 0.70f};
}

struct scene_camera scene_turn_camera(const struct scene_camera *camera, double share)
{
    struct scene_camera turned = *camera;
    if (share >= 1.0)
        return turned;
    const double c = cos(share * 6.283185307179586), s = sin(share * 6.283185307179586);
    const double x = camera->eye.x - camera->target.x, z = camera->eye.z - camera->target.z;
    turned.eye.x = (float)(camera->target.x + c * x - s * z);
    turned.eye.z = (float)(camera->target.z + s * x + c * z);
    return turned;
}
