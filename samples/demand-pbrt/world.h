/** The world: built shapes, and boxes for all others. */
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

/** A placed shape. */
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
    struct proxies *proxies; ///< NULL: everything is placed at the start
    bool coarse;
    uint64_t budget;      ///< bytes of meshes; 0: no limit
    struct place *places; ///< owned
    uint32_t place_count, place_room;
    uint32_t *free_places; ///< owned; unused indices
    uint32_t free_count, free_room;
    uint32_t *to_build; ///< owned; meshes
    uint32_t to_build_count, to_build_room;
    struct table place_table; ///< struct PbrtPlace
    struct table used;        ///< uint by place: the last launch that hit it
    struct structure top;
    struct top_tree tree; ///< compute path only; replaces `top`
    uint32_t *part_of;    ///< owned; compute path only: part of `tree` by cluster key
    struct gpu_buffer
        instances;   ///< boxes, then places by index; rays miss places that are not live
    uint32_t *moved; ///< owned; places whose instance must be rewritten
    uint32_t moved_count, moved_room;
    bool changed; ///< true: changed since the top level was built
    /* Totals since the start. */
    uint64_t entered_count;  ///< placed shapes: a ray has entered their box
    uint64_t resolved_count; ///< boxes replaced by their contents
    uint32_t *step_nodes;    ///< owned; room for the nodes of a resolved cluster
    uint64_t resolved_nodes; ///< resolved instances and free shapes
    uint64_t most_added;     ///< most boxes added by resolving one
    uint64_t created[WORLD_BOX_KINDS];
    uint64_t peak_size; ///< bytes of meshes
    double top_seconds, resolve_seconds;
};

/** Reports errors on stderr. */
bool world_create(const struct gpu *gpu, const struct scene *scene, const struct surfaces *surfaces,
                  struct proxies *proxies, bool coarse, const struct mesh_reading *reading,
                  struct world *world);
void world_finish(struct world *world);

/** Adds one box around everything. Without proxies, places everything. */
bool world_begin(struct world *world);
/** Places the contents of a box. world_build_meshes builds the meshes. */
bool world_resolve(struct world *world, struct scene_node node);
/** Replaces shapes of evicted meshes by boxes. Rays that enter a box request the shape again. */
bool world_evict(struct world *world);
/** Continues builds that run beside launches, for the launch of that number. `waits`: wait for all
 * builds. Call only while no launch is running. */
bool world_continue_builds(struct world *world, uint32_t launch, bool waits);
/**
 * Returns in `*ready` whether a node can be resolved without waiting for files or builds. If not,
 * its unread meshes begin to be read, and world_begin_builds builds its read meshes. Use only
 * without --budget: with a budget, resolved meshes are built at once. Reports errors on stderr.
 */
bool world_fetch(struct world *world, struct scene_node node, bool *ready);
/** Builds fetched meshes beside the next launches. */
bool world_begin_builds(struct world *world);
/** Builds meshes of resolved nodes, for the launch of that number. Call only while no launch is
 * running. */
bool world_build_meshes(struct world *world, uint32_t launch);
/** Builds changed structures, for the launch of that number. Call only while no launch is
 * running. */
bool world_build(struct world *world, uint32_t launch);

#endif /* DEMAND_PBRT_WORLD_H */
