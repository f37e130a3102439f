/** What is in the world now: shapes that are built, and boxes for all others. */
#ifndef DEMAND_PBRT_WORLD_H
#define DEMAND_PBRT_WORLD_H

#include "meshes.h"
#include "options.h"
#include "proxies.h"
#include "surfaces.h"
#include "top_tree.h"

enum world_box {
    BOX_SCENE,
    BOX_FREE_SHAPE,
    BOX_INSTANCE,
    BOX_INSTANCE_SHAPE,
    BOX_GROUP,
    BOX_CLUSTER
};
#define WORLD_BOX_KINDS 6

/** A shape in the world. */
struct place {
    struct scene_node node;
    uint32_t mesh;
    bool live;
    VkAccelerationStructureInstanceKHR instance;
};

/** Zeroed is empty. */
struct world {
    const struct gpu *gpu;
    const struct scene *scene;
    const struct surfaces *surfaces;
    struct structures structures;
    struct meshes meshes;
    struct proxies *proxies; ///< NULL: everything is placed at once
    bool coarse;
    uint64_t budget;      ///< bytes of meshes; 0: no limit
    struct place *places; ///< owned
    uint32_t place_count, place_room;
    uint32_t *free_places; ///< owned; indices that nothing uses
    uint32_t free_count, free_room;
    uint32_t *to_build; ///< owned; meshes
    uint32_t to_build_count, to_build_room;
    struct table place_table; ///< struct PbrtPlace
    struct table used;        ///< uint by place: the last launch that hit it
    struct structure top;
    struct top_tree tree; ///< instead, of the compute path
    uint32_t *part_of;    ///< owned; ... part of its tree by key of the clusters, if there are any
    struct gpu_buffer
        instances;   ///< the boxes, then places by index: those that are not live hit nothing
    uint32_t *moved; ///< owned; places whose instance must be written
    uint32_t moved_count, moved_room;
    bool changed; ///< since the top level was built
    /* Since the beginning. */
    uint64_t entered_count;  ///< shapes whose box a ray entered: those that were placed
    uint64_t resolved_count; ///< boxes that became what is in them
    uint32_t *step_nodes;    ///< owned; room for what a box of clusters becomes
    uint64_t resolved_nodes; ///< ... that were instances or shapes of no object
    uint64_t most_added;     ///< boxes, by resolving one
    uint64_t created[WORLD_BOX_KINDS];
    uint64_t peak_size; ///< bytes of meshes
    double top_seconds, resolve_seconds;
};

/** Says on stderr why it failed. */
bool world_create(const struct gpu *gpu, const struct scene *scene, const struct surfaces *surfaces,
                  struct proxies *proxies, bool coarse, const struct mesh_reading *reading,
                  struct world *world);
void world_finish(struct world *world);

/** Adds one box around everything; without proxies, everything. */
bool world_begin(struct world *world);
/** Puts what is in a box into the world. Meshes are built by world_build. */
bool world_resolve(struct world *world, struct scene_node node);
/** Boxes for shapes of meshes that leave: they are asked for again when a ray enters them. */
bool world_evict(struct world *world);
/** Goes on with builds beside the launches, for the launch with that number; `waits` until there
 *  are none. No launch is under way. */
bool world_continue_builds(struct world *world, uint32_t launch, bool waits);
/**
 * Whether a node can be resolved without waiting, neither for files nor for builds. If not, its
 * meshes are read from now on, or, where they are read, are built by world_begin_builds. Without a
 * --budget alone: with one, what is resolved is built at once. Says on stderr why it failed.
 */
bool world_fetch(struct world *world, struct scene_node node, bool *ready);
/** Builds beside the next launches what was fetched. */
bool world_begin_builds(struct world *world);
/** Builds meshes of what was resolved, for the launch with that number. No launch is under way. */
bool world_build_meshes(struct world *world, uint32_t launch);
/** Builds what has changed, for the launch with that number. No launch is under way. */
bool world_build(struct world *world, uint32_t launch);

#endif /* DEMAND_PBRT_WORLD_H */
