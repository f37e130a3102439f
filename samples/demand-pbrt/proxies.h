/** Proxies of things that are not made yet: boxes for geometry, numbers for surfaces. */
#ifndef DEMAND_PBRT_PROXIES_H
#define DEMAND_PBRT_PROXIES_H

#include <sluice/vulkan_proxy.h>

#include "scene.h"
#include "structures.h"

/** Nodes and surfaces that launches requested. */
struct proxy_requests {
    struct scene_node *nodes; ///< owned
    uint32_t *surfaces;       ///< owned
    SluiceProxyId *ids;       ///< owned; proxies of the nodes of proxies_list
    uint32_t node_count, node_room;
    uint32_t surface_count, surface_room;
    uint32_t id_room;
};

/** A box that was added or removed. */
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
    uint32_t box_page, surface_page; ///< first pages of requests, for shaders
    struct scene_node *nodes;        ///< owned; node by box index
    uint32_t node_room;
    SluiceProxyId *ids; ///< owned; scratch space for requests
    uint32_t id_room;
    struct gpu_buffer buffer; ///< boxes, 24 bytes each
    uint32_t box_count;       ///< boxes in `buffer`
    uint64_t version;         ///< version of the boxes in `buffer`
    struct structure structure;
    bool changed;            ///< true: changed since the structure was built
    bool notes_moves;        ///< record moves for the compute path's tree
    struct moved_box *moved; ///< owned
    uint32_t moved_count, moved_room;
    uint64_t added_count; ///< boxes added since the start
    uint32_t most_count;  ///< peak number of boxes
    double bytes_per_box; ///< host and device memory at the peak number, without the structure
};

/** Surfaces are the scene's materials, then its textures. Reports errors on stderr. */
bool proxies_create(SluiceDemandLoader *loader, const struct scene *scene, struct proxies *proxies);
/** Call before the loader is destroyed. */
void proxies_finish(const struct gpu *gpu, struct structures *structures, struct proxies *proxies);

/** Adds a box for a node. Reports errors on stderr. */
bool proxies_add(struct proxies *proxies, struct scene_node node, const SluicePbrtBounds *box);
uint32_t proxies_box_count(const struct proxies *proxies);
/** Bytes in host and device memory. */
double proxies_memory(const struct proxies *proxies);

/** Order and number in which requests are taken. */
struct proxy_order {
    bool largest_first;
    bool one_node, one_surface; ///< take one per call; the rest is requested again
};

/** Gets the requests of processed launches, and removes the requested boxes. Surfaces stay, so rays
 * request a surface again until it is made. Reports errors on stderr. */
bool proxies_take(struct proxies *proxies, const struct proxy_order *order,
                  struct proxy_requests *requests);
/** Lists the requests of processed launches, boxes nearest to `eye` first. Removes nothing:
 * whatever is neither taken by proxies_take_node nor made is requested again. */
bool proxies_list(struct proxies *proxies, const float eye[3], struct proxy_requests *requests);
/** Removes the box of a listed node. `number`: index in the list. */
bool proxies_take_node(struct proxies *proxies, const struct proxy_requests *requests,
                       uint32_t number);
/** Clears the list of moved boxes. */
void proxies_forget_moves(struct proxies *proxies);
void proxy_requests_finish(struct proxy_requests *requests);

/** Builds the structure of the boxes if they have changed. Without boxes there is no structure. */
bool proxies_build(const struct gpu *gpu, struct structures *structures, struct proxies *proxies);

#endif /* DEMAND_PBRT_PROXIES_H */
