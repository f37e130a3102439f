#include "world.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/text.h"
#include "../common/ray_table.h"
#include "budget.h"
#include "emitters.h"
#include "transform.h"

#define MOST_PLACES (1u << 24) /* instanceCustomIndex has 24 bits */

/* Flag of scene_node.shape. In an instance: all shapes like this one, which is the first. Without
 * an instance: a node in the tree of clusters. */
#define GROUP (1u << 31)

static enum world_box node_kind(struct scene_node node)
{
    if (node.shape == SLUICE_PBRT_NONE)
        return node.instance == SLUICE_PBRT_NONE ? BOX_SCENE : BOX_INSTANCE;
    if (node.instance == SLUICE_PBRT_NONE)
        return node.shape & GROUP ? BOX_CLUSTER : BOX_FREE_SHAPE;
    return node.shape & GROUP ? BOX_GROUP : BOX_INSTANCE_SHAPE;
}

/** Creates the compute path's tree. */
static bool create_tree(struct world *w)
{
    const struct clusters *clusters = &w->scene->clusters;
    if (w->proxies)
        w->proxies->notes_moves = true;
    if (clusters->size > 0) {
        w->part_of =
            clusters_list_nodes(clusters, w->scene->info.shapeCount + w->scene->info.instanceCount);
        if (!w->part_of) {
            fprintf(stderr, "out of memory\n");
            return false;
        }
    }
    return top_tree_create(w->gpu, clusters, &w->tree);
}

bool world_create(const struct gpu *gpu, const struct scene *scene, const struct surfaces *surfaces,
                  struct proxies *proxies, bool coarse, const struct mesh_reading *reading,
                  struct world *w)
{
    *w = (struct world){.gpu = gpu,
                        .scene = scene,
                        .surfaces = surfaces,
                        .proxies = proxies,
                        .coarse = coarse,
                        .place_table.element = sizeof(struct PbrtPlace),
                        .used.element = sizeof(uint32_t),
                        .changed = true};
    return structures_create(gpu, &w->structures) && (gpu->ray_tracing || create_tree(w)) &&
           meshes_create(gpu, scene, reading, &w->meshes) && table_grow(gpu, &w->place_table, 1) &&
           table_grow(gpu, &w->used, 1);
}

void world_finish(struct world *w)
{
    if (!w->gpu)
        return;
    structures_give(w->gpu, &w->structures, &w->top);
    top_tree_finish(w->gpu, &w->tree);
    meshes_finish(w->gpu, &w->structures, &w->meshes);
    structures_finish(w->gpu, &w->structures);
    gpu_destroy_buffer(w->gpu, &w->instances);
    table_finish(w->gpu, &w->place_table);
    table_finish(w->gpu, &w->used);
    free(w->places);
    free(w->free_places);
    free(w->to_build);
    free(w->moved);
    free(w->step_nodes);
    free(w->part_of);
    *w = (struct world){0};
}

static bool has_room(void **items, uint32_t count, uint32_t *room, size_t size)
{
    if (count < *room)
        return true;
    uint32_t more = *room ? 2 * *room : 64;
    void *grown = realloc(*items, more * size);
    if (!grown) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    *items = grown;
    *room = more;
    return true;
}

/** Notes a place whose instance must be rewritten when the top level is built. */
static bool note_moved(struct world *w, uint32_t place)
{
    if (!has_room((void **)&w->moved, w->moved_count, &w->moved_room, sizeof(uint32_t)))
        return false;
    w->moved[w->moved_count++] = place;
    return true;
}

/* Lists an absent mesh for building. Until one of its places is live, each new place lists it
 * again. */
static bool ask_for_mesh(struct world *w, uint32_t mesh)
{
    if (w->meshes.items[mesh].state != MESH_ABSENT || w->meshes.items[mesh].place_count > 0)
        return true;
    if (!has_room((void **)&w->to_build, w->to_build_count, &w->to_build_room, sizeof(uint32_t)))
        return false;
    w->to_build[w->to_build_count++] = mesh;
    return true;
}

static struct PbrtPlace describe(const struct world *w, const SluicePbrtShape *shape,
                                 const struct place *place, const float transform[12])
{
    const bool has_map = shape->alpha.texture != SLUICE_PBRT_NONE;
    return (struct PbrtPlace){.mesh = place->mesh,
                              .surface = shape->material,
                              .alpha = has_map ? surfaces_alpha(w->surfaces, shape->alpha.texture)
                                               : PBRT_NONE,
                              .alphaValue = has_map ? 1.0f : shape->alpha.value[0],
                              .flags = emitters_place_flags(w->scene, shape, transform),
                              .light = shape->areaLight,
                              .shape = place->node.shape,
                              .instance = place->node.instance};
}

static bool is_opaque(const struct world *w, const struct PbrtPlace *entry)
{
    return entry->alpha == PBRT_NONE && (w->scene->info.version == 3 || entry->alphaValue >= 1.0f);
}

static bool place_shape(struct world *w, struct scene_node node)
{
    const uint32_t mesh = w->meshes.of_shape[node.shape];
    if (w->meshes.items[mesh].state == MESH_FAILED)
        return true;
    const uint32_t index = w->free_count ? w->free_places[w->free_count - 1] : w->place_count;
    if (index == MOST_PLACES) {
        fprintf(stderr, "more than %u shapes are in sight\n", MOST_PLACES);
        return false;
    }
    if (!ask_for_mesh(w, mesh) || !note_moved(w, index) ||
        !has_room((void **)&w->places, index, &w->place_room, sizeof *w->places) ||
        !table_grow(w->gpu, &w->place_table, index + 1) || !table_grow(w->gpu, &w->used, index + 1))
        return false;
    float m[12];
    const SluicePbrtShape shape = scene_shape(w->scene, node.shape);
    scene_node_transform(w->scene, node, m);
    *(w->free_count ? &w->free_count : &w->place_count) += w->free_count ? -1u : 1u;
    struct place *place = &w->places[index];
    *place = (struct place){.node = node, .mesh = mesh, .live = true};
    const struct PbrtPlace entry = describe(w, &shape, place, m);
    *(struct PbrtPlace *)table_at(&w->place_table, index) = entry;
    *(uint32_t *)table_at(&w->used, index) = 0;
    place->instance = (VkAccelerationStructureInstanceKHR){
        .instanceCustomIndex = index & 0xffffffu,
        .mask = 0xff,
        .instanceShaderBindingTableRecordOffset = PBRT_GROUP_MESH,
        .flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR |
                 (is_opaque(w, &entry) ? VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR : 0)};
    memcpy(place->instance.transform.matrix, m, sizeof m);
    w->meshes.items[mesh].place_count++;
    w->entered_count++;
    w->changed = true;
    return true;
}

/** Returns whether two shapes of an object may share a box. The rule is OptiX Toolkit's; PBRT.md
 * has none. */
static bool is_alike(const struct world *w, uint32_t a, uint32_t b)
{
    const SluicePbrtShape one = scene_shape(w->scene, a), other = scene_shape(w->scene, b);
    const SluicePbrtMaterial m = scene_material(w->scene, one.material);
    const SluicePbrtMaterial n = scene_material(w->scene, other.material);
    return (one.kind == SLUICE_PBRT_SHAPE_SPHERE) == (other.kind == SLUICE_PBRT_SHAPE_SPHERE) &&
           (one.alpha.texture == SLUICE_PBRT_NONE) == (other.alpha.texture == SLUICE_PBRT_NONE) &&
           (m.diffuse.texture == SLUICE_PBRT_NONE) == (n.diffuse.texture == SLUICE_PBRT_NONE);
}

/** Returns the next placed shape from `from` on. `like`: shape that it must resemble, or
 * SLUICE_PBRT_NONE. */
static uint32_t next_shape(const struct world *w, const SluicePbrtObject *object, uint32_t from,
                           uint32_t like)
{
    for (uint32_t i = from; i < object->firstShape + object->shapeCount; i++)
        if (!scene_box_is_empty(&w->scene->boxes[i]) &&
            (like == SLUICE_PBRT_NONE || is_alike(w, i, like)))
            return i;
    return SLUICE_PBRT_NONE;
}

static bool add_box(struct world *w, struct scene_node node, const SluicePbrtBounds *box)
{
    if (!w->proxies)
        return world_resolve(w, node);
    w->created[node_kind(node)]++;
    return proxies_add(w->proxies, node, box);
}

static bool add_group(struct world *w, uint32_t instance, const SluicePbrtObject *object,
                      uint32_t first)
{
    SluicePbrtBounds box = bounds_none();
    for (uint32_t i = first; i != SLUICE_PBRT_NONE; i = next_shape(w, object, i + 1, first)) {
        const SluicePbrtBounds one = scene_node_box(w->scene, (struct scene_node){instance, i});
        bounds_add(&box, &one);
    }
    return add_box(w, (struct scene_node){instance, first | GROUP}, &box);
}

static bool fetch_mesh(struct world *w, uint32_t shape, bool *ready)
{
    const uint32_t mesh = w->meshes.of_shape[shape];
    const enum mesh_fetch is = meshes_fetch(&w->meshes, mesh);
    *ready = *ready && (is == MESH_IS_THERE || (is == MESH_IS_READ && w->budget > 0));
    return is != MESH_IS_READ || w->budget > 0 ||
           meshes_prepare(w->gpu, w->scene, &w->meshes, mesh);
}

/** Fetches an instance with a single part, which needs no box of its own. */
static bool fetch_single(struct world *w, uint32_t instance, bool *ready)
{
    const SluicePbrtObject object = scene_object_of(w->scene, instance);
    const uint32_t first = next_shape(w, &object, object.firstShape, SLUICE_PBRT_NONE);
    return first == SLUICE_PBRT_NONE ||
           next_shape(w, &object, first + 1, SLUICE_PBRT_NONE) != SLUICE_PBRT_NONE ||
           fetch_mesh(w, first, ready);
}

static bool fetch_group(struct world *w, struct scene_node node, bool *ready)
{
    const SluicePbrtObject object = scene_object_of(w->scene, node.instance);
    const uint32_t first = node.shape & ~GROUP;
    bool done = true;
    for (uint32_t i = first; i != SLUICE_PBRT_NONE && done;
         i = next_shape(w, &object, i + 1, first))
        done = fetch_mesh(w, i, ready);
    return done;
}

/** Adds boxes for the parts of an instance. A single part needs none. */
static bool resolve_instance(struct world *w, uint32_t instance)
{
    const SluicePbrtObject object = scene_object_of(w->scene, instance);
    const uint32_t first = next_shape(w, &object, object.firstShape, SLUICE_PBRT_NONE);
    if (first == SLUICE_PBRT_NONE)
        return true;
    if (next_shape(w, &object, first + 1, SLUICE_PBRT_NONE) == SLUICE_PBRT_NONE)
        return place_shape(w, (struct scene_node){instance, first});
    bool done = true;
    for (uint32_t i = first; i != SLUICE_PBRT_NONE && done;
         i = next_shape(w, &object, i + 1, SLUICE_PBRT_NONE)) {
        const struct scene_node node = {instance, i};
        const SluicePbrtBounds box = scene_node_box(w->scene, node);
        if (!w->coarse)
            done = add_box(w, node, &box);
        else if (next_shape(w, &object, object.firstShape, i) == i) /* first shape of its group */
            done = add_group(w, instance, &object, i);
    }
    return done;
}

static bool resolve_group(struct world *w, struct scene_node node)
{
    const SluicePbrtObject object = scene_object_of(w->scene, node.instance);
    const uint32_t first = node.shape & ~GROUP;
    bool done = true;
    for (uint32_t i = first; i != SLUICE_PBRT_NONE && done;
         i = next_shape(w, &object, i + 1, first))
        done = place_shape(w, (struct scene_node){node.instance, i});
    return done;
}

static bool add_node(void *user_data, struct scene_node node)
{
    struct world *w = user_data;
    const SluicePbrtBounds box = scene_node_box(w->scene, node);
    return add_box(w, node, &box);
}

/** Adds a box for a node in the tree of clusters. */
static bool add_cluster(struct world *w, uint32_t index)
{
    const struct box_tree_node *node = &w->scene->clusters.tree.nodes[index];
    SluicePbrtBounds box;
    memcpy(box.least, node->low, sizeof box.least);
    memcpy(box.most, node->high, sizeof box.most);
    return add_box(w, (struct scene_node){SLUICE_PBRT_NONE, index | GROUP}, &box);
}

/** Resolves a cluster to a bounded number of boxes, so that frames end in time. */
static bool resolve_cluster(struct world *w, uint32_t index)
{
    const struct clusters *clusters = &w->scene->clusters;
    struct cluster_step step = {.nodes = w->step_nodes};
    clusters_open(clusters, index, &step);
    bool done = true;
    for (uint32_t i = 0; i < step.count && done; i++)
        done = step.keys ? add_node(w, scene_node_of_key(w->scene, step.keys[i]))
                         : add_cluster(w, step.nodes[i]);
    return done;
}

static bool resolve_scene(struct world *w)
{
    return w->proxies && w->scene->clusters.size ? resolve_cluster(w, 0)
                                                 : scene_for_each(w->scene, add_node, w);
}

bool world_resolve(struct world *w, struct scene_node node)
{
    const double start = clock_seconds();
    const uint64_t before = w->proxies ? w->proxies->added_count : 0;
    const enum world_box kind = node_kind(node);
    bool done;
    switch (kind) {
    case BOX_SCENE: done = resolve_scene(w); break;
    case BOX_CLUSTER: done = resolve_cluster(w, node.shape & ~GROUP); break;
    case BOX_INSTANCE: done = resolve_instance(w, node.instance); break;
    case BOX_GROUP: done = resolve_group(w, node); break;
    default: done = place_shape(w, node); break;
    }
    const uint64_t added = w->proxies ? w->proxies->added_count - before : 0;
    w->most_added = added > w->most_added ? added : w->most_added;
    w->resolved_nodes += kind == BOX_INSTANCE || kind == BOX_FREE_SHAPE;
    w->resolved_count++;
    w->resolve_seconds += clock_seconds() - start;
    return done;
}

bool world_begin(struct world *w)
{
    const size_t most = CLUSTERS_FAN * (size_t)w->scene->clusters.size + 1;
    const struct scene_node all = {SLUICE_PBRT_NONE, SLUICE_PBRT_NONE};
    if (w->scene->place_count == 0)
        return true;
    w->step_nodes = malloc(most * sizeof *w->step_nodes);
    if (!w->step_nodes) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    /* With a single node, the scene's box would equal the node's box. */
    if (w->scene->node_count == 1)
        return world_resolve(w, all);
    return add_box(w, all, &w->scene->box);
}

/* Removes places whose meshes could not be read. */
static void remove_failed(struct world *w)
{
    for (uint32_t i = 0; i < w->moved_count; i++) {
        struct place *place = &w->places[w->moved[i]];
        place->live = place->live && w->meshes.items[place->mesh].state == MESH_BUILT;
    }
}

/** Replaces a shape whose mesh is evicted by a box. */
static bool take_back(struct world *w, uint32_t index)
{
    struct place *place = &w->places[index];
    const SluicePbrtBounds box = scene_node_box(w->scene, place->node);
    if (!has_room((void **)&w->free_places, w->free_count, &w->free_room, sizeof(uint32_t)) ||
        !note_moved(w, index))
        return false;
    w->free_places[w->free_count++] = index;
    w->meshes.items[place->mesh].place_count--;
    place->live = false;
    w->changed = true;
    return proxies_add(w->proxies, place->node, &box);
}

bool world_evict(struct world *w)
{
    for (uint32_t i = 0; i < w->place_count; i++)
        if (w->places[i].live && w->meshes.items[w->places[i].mesh].leaves && !take_back(w, i))
            return false;
    for (uint32_t i = 0; i < w->meshes.count; i++) {
        struct mesh *mesh = &w->meshes.items[i];
        if (mesh->leaves && mesh->state == MESH_BUILT)
            meshes_evict(w->gpu, &w->structures, &w->meshes, i);
        mesh->leaves = false;
    }
    return true;
}

static bool build_some(struct world *w, uint32_t first, uint32_t count, uint32_t launch)
{
    if (!meshes_build(w->gpu, w->scene, &w->structures, &w->meshes, w->to_build + first, count,
                      launch))
        return false;
    w->peak_size = w->meshes.size > w->peak_size ? w->meshes.size : w->peak_size;
    return true;
}

/** Builds meshes one by one until the budget is spent. The remaining shapes become boxes again. */
static bool build_within_budget(struct world *w, uint32_t count, uint32_t launch)
{
    bool fits = true;
    for (uint32_t i = 0; i < count; i++) {
        struct mesh *mesh = &w->meshes.items[w->to_build[i]];
        if (fits && (!build_some(w, i, 1, launch) || !budget_make_room(w, launch, &fits)))
            return false;
        mesh->leaves = mesh->leaves || mesh->state == MESH_ABSENT;
    }
    return world_evict(w);
}

bool world_fetch(struct world *w, struct scene_node node, bool *ready)
{
    *ready = true;
    switch (node_kind(node)) {
    case BOX_FREE_SHAPE:
    case BOX_INSTANCE_SHAPE: return fetch_mesh(w, node.shape, ready);
    case BOX_INSTANCE: return fetch_single(w, node.instance, ready);
    case BOX_GROUP: return fetch_group(w, node, ready);
    default: return true;
    }
}

bool world_begin_builds(struct world *w)
{
    return meshes_begin(w->gpu, &w->structures, &w->meshes);
}

bool world_continue_builds(struct world *w, uint32_t launch, bool waits)
{
    bool done = meshes_continue(w->gpu, &w->structures, &w->meshes, launch, waits);
    if (done && waits)
        done = world_begin_builds(w) &&
               meshes_continue(w->gpu, &w->structures, &w->meshes, launch, true);
    w->peak_size = w->meshes.size > w->peak_size ? w->meshes.size : w->peak_size;
    return done;
}

/* The last launch may have built one mesh above the budget. It was kept for that launch. */
static bool return_to_budget(struct world *w, uint32_t launch)
{
    bool fits;
    return w->budget == 0 || w->meshes.size <= w->budget ||
           (budget_make_room(w, launch, &fits) && world_evict(w));
}

bool world_build_meshes(struct world *w, uint32_t launch)
{
    if (!return_to_budget(w, launch))
        return false;
    const uint32_t count = w->to_build_count;
    if (count == 0)
        return true;
    w->to_build_count = 0;
    if (!(w->budget ? build_within_budget(w, count, launch) : build_some(w, 0, count, launch)))
        return false;
    remove_failed(w);
    return true;
}

/** Writes changed instances only: instances keep their index in the buffer. */
static void write_instances(struct world *w)
{
    VkAccelerationStructureInstanceKHR *instances = w->instances.mapped;
    const struct structure *boxes = w->proxies ? &w->proxies->structure : NULL;
    instances[0] = (VkAccelerationStructureInstanceKHR){
        .transform.matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
        .mask = 0xff,
        .instanceShaderBindingTableRecordOffset = PBRT_GROUP_BOX,
        .accelerationStructureReference = boxes ? boxes->address : 0};
    for (uint32_t i = 0; i < w->moved_count; i++) {
        struct place *place = &w->places[w->moved[i]];
        place->instance.accelerationStructureReference =
            place->live ? w->meshes.items[place->mesh].structure.address : 0;
        instances[1 + w->moved[i]] = place->instance;
    }
    w->moved_count = 0;
}

/** Grows the buffer, and copies the old content on the host. */
static bool reserve_instances(struct world *w)
{
    const VkDeviceSize size = (w->place_count + 1ull) * sizeof(VkAccelerationStructureInstanceKHR);
    if (w->instances.size >= size)
        return true;
    gpu_destroy_buffer(w->gpu, &w->instances);
    if (!gpu_create_buffer(w->gpu, size + size / 2, structures_input_usage(w->gpu), &w->instances))
        return false;
    VkAccelerationStructureInstanceKHR *instances = w->instances.mapped;
    for (uint32_t i = 0; i < w->place_count; i++)
        instances[1 + i] = w->places[i].instance;
    return true;
}

static bool build_top(struct world *w)
{
    if (!reserve_instances(w))
        return false;
    structures_give(w->gpu, &w->structures, &w->top);
    write_instances(w);
    struct structure_build build = {
        .type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
        .primitive_count = w->place_count + 1,
        .target = &w->top,
        .geometry = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
            .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
            .geometry.instances = {
                .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
                .data.deviceAddress = ray_buffer_address(w->gpu, w->instances.buffer)}}};
    return structures_build(w->gpu, &w->structures, &build, 1);
}

/** Returns the part of the tree that a node belongs to. */
static uint32_t part_of(const struct world *w, struct scene_node node)
{
    const enum world_box kind = node_kind(node);
    if (!w->part_of || kind == BOX_SCENE || kind == BOX_CLUSTER)
        return WORLD_TREE_REST;
    return w
        ->part_of[node.instance == SLUICE_PBRT_NONE ? node.shape
                                                    : w->scene->info.shapeCount + node.instance];
}

static bool place_in_tree(struct world *w, uint32_t index)
{
    const struct place *place = &w->places[index];
    const VkAccelerationStructureInstanceKHR *instance = &place->instance;
    const struct mesh_tree *tree = &w->meshes.items[place->mesh].tree;
    struct top_tree_place at = {
        .box = tree->box,
        .nodes = tree->address,
        .opaque = (instance->flags & VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR) != 0};
    memcpy(at.to_world, instance->transform.matrix, sizeof at.to_world);
    return top_tree_set(w->gpu, &w->tree, index, part_of(w, place->node), place->live ? &at : NULL);
}

/** Builds the compute path's tree. */
static bool build_top_tree(struct world *w)
{
    for (uint32_t i = 0; i < w->moved_count; i++)
        if (!place_in_tree(w, w->moved[i]))
            return false;
    w->moved_count = 0;
    for (uint32_t i = 0; w->proxies && i < w->proxies->moved_count; i++) {
        const struct moved_box *moved = &w->proxies->moved[i];
        if (!top_tree_set_box(&w->tree, moved->index, part_of(w, w->proxies->nodes[moved->index]),
                              moved->is_there ? &moved->box : NULL))
            return false;
    }
    if (w->proxies)
        proxies_forget_moves(w->proxies);
    return top_tree_build(w->gpu, &w->tree);
}

bool world_build(struct world *w, uint32_t launch)
{
    if (!world_build_meshes(w, launch))
        return false;
    if (!w->changed && (!w->proxies || !w->proxies->changed))
        return true;
    double start = clock_seconds();
    bool done = (!w->proxies || proxies_build(w->gpu, &w->structures, w->proxies)) &&
                (w->gpu->ray_tracing ? build_top(w) : build_top_tree(w));
    w->top_seconds += clock_seconds() - start;
    w->changed = !done;
    return done;
}
