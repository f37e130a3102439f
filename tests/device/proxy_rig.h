/**
 * Rays through the boxes of proxies, in launches of a demand loader. Uses the device's ray tracing,
 * with intersection, any-hit and closest-hit programs, or a compute shader. Both use proxy.glsl and
 * the descriptor set of the launch.
 */
#ifndef TESTS_DEVICE_PROXY_RIG_H
#define TESTS_DEVICE_PROXY_RIG_H

#include "device/ray_structures.h"

#include <sluice/vulkan_proxy.h>

#include "proxy_rays_shared.h"

#define PROXY_RIG_RAYS 4096u
#define PROXY_RIG_BOXES 4096u
#define PROXY_RIG_GROUPS 4u /* rays begin, miss, hit, enter */

struct proxy_rig {
    struct harness *h;
    bool traces;              ///< true: has ray tracing; false: compute only
    struct ray_device device; ///< traces
    SluiceDemandLoader *loader;
    SluiceProxySet *geometry, *materials; ///< a material per geometry, with the same index
    SluiceDemandResourceId resources[2];
    uint32_t first_pages[2]; ///< geometry, materials
    struct ray_buffer boxes; ///< with an address if it traces
    struct ray_buffer instances, table;
    struct harness_buffer plain_boxes, rays, hits;
    uint64_t version; ///< version of the boxes
    struct ray_structure bottom, top;
    bool has_structures;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline rays_pipeline, compute_pipeline;
    VkStridedDeviceAddressRegionKHR groups[PROXY_RIG_GROUPS];
    uint32_t ray_count;
    SluiceDemandRequests requests;
};

/** `traces`: `h` was created with ray_device_extensions. */
void proxy_rig_init(struct proxy_rig *rig, struct harness *h, bool traces);
void proxy_rig_finish(struct proxy_rig *rig);

/** Adds a geometry and its material. Returns the id of the geometry. */
SluiceProxyId proxy_rig_add(struct proxy_rig *rig, const SluiceProxyBox *box);
/** Removes a geometry and its material. */
void proxy_rig_remove(struct proxy_rig *rig, SluiceProxyId id);

struct ProxyRay *proxy_rig_rays(struct proxy_rig *rig);
const struct ProxyHit *proxy_rig_hits(const struct proxy_rig *rig);

/** Writes changed boxes, rebuilds the structures, launches and processes. `through`: rays request
 * the materials of all entered boxes instead of the nearest geometry. */
void proxy_rig_launch(struct proxy_rig *rig, bool by_rays, bool through);

#endif /* TESTS_DEVICE_PROXY_RIG_H */
