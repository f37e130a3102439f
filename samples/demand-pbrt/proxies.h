/** What stands for things that are not made: boxes for geometry, numbers for surfaces. */
#ifndef DEMAND_PBRT_PROXIES_H
#define DEMAND_PBRT_PROXIES_H

#include <sluice/vulkan_proxy.h>

#include "scene.h"
#include "structures.h"

/** What launches asked for. */
struct proxy_requests {
    struct scene_node *nodes; ///< owned
    uint32_t *surfaces;       ///< owned
    SluiceProxyId *ids;       ///< owned; of the nodes of proxies_list
    uint32_t node_count, node_room;
    uint32_t surface_count, surface_room;
    uint32_t id_room;
};

/** A box that came or left. */
struct moved_box {
    uint32_t index;
    bool is_there;
    SluiceProxyBox box;
};

/** Zeroed is empty. */
struct proxies {
    SluiceDemandLoader *loader;
    SluiceProxySet *boxes, *surfaces;
    SluiceDemandResourceId box_resource, surface_resource;
    uint32_t box_page, surface_page; ///< first pages, for shaders
    struct scene_node *nodes;        ///< owned; what the box of an index stands for
    uint32_t node_room;
    SluiceProxyId *ids; ///< owned; room for requested ones
    uint32_t id_room;
    struct gpu_buffer buffer; ///< of boxes, 24 bytes each
    uint32_t box_count;       ///< of the buffer
    uint64_t version;         ///< of the buffer
    struct structure structure;
    bool changed;            ///< since the structure was built
    bool notes_moves;        ///< for the compute path's tree, which forgets them
    struct moved_box *moved; ///< owned
    uint32_t moved_count, moved_room;
    uint64_t added_count; ///< boxes since the beginning
    uint32_t most_count;  ///< boxes at a time
    double bytes_per_box; ///< on host and device when they were most, without their structure
};

/** Surfaces are the materials of the scene, then its textures. Says on stderr why it failed. */
bool proxies_create(SluiceDemandLoader *loader, const struct scene *scene, struct proxies *proxies);
/** Before the loader is destroyed. */
void proxies_finish(const struct gpu *gpu, struct structures *structures, struct proxies *proxies);

/** Adds a box for a node. Says on stderr why it failed. */
bool proxies_add(struct proxies *proxies, struct scene_node node, const SluicePbrtBounds *box);
uint32_t proxies_box_count(const struct proxies *proxies);
/** Bytes on host and device. */
double proxies_memory(const struct proxies *proxies);

/** How requests are taken. */
struct proxy_order {
    bool largest_first;
    bool one_node, one_surface; ///< what else is asked for is asked for again
};

/** Gets what processed launches asked for, and removes the boxes. Surfaces stay, so that rays ask
 *  again for those that are not made, or no more. Says on stderr why it failed. */
bool proxies_take(struct proxies *proxies, const struct proxy_order *order,
                  struct proxy_requests *requests);
/** Lists what processed launches asked for, boxes nearest to `eye` first. All of it stays, and what
 *  is not taken with the function below, or made, is asked for again. */
bool proxies_list(struct proxies *proxies, const float eye[3], struct proxy_requests *requests);
/** Removes the box of a listed node: the number is that in the list. */
bool proxies_take_node(struct proxies *proxies, const struct proxy_requests *requests,
                       uint32_t number);
/** Afterwards no box has moved. */
void proxies_forget_moves(struct proxies *proxies);
void proxy_requests_finish(struct proxy_requests *requests);

/** Builds the structure of the boxes if they have changed. Without boxes there is none. */
bool proxies_build(const struct gpu *gpu, struct structures *structures, struct proxies *proxies);

#endif /* DEMAND_PBRT_PROXIES_H */
