/** A GPU that renders its part, and all that each GPU has for itself: device, loader, world. */
#ifndef DEMAND_PBRT_DEVICE_H
#define DEMAND_PBRT_DEVICE_H

#include "launches.h"

/** Memory of the host that all devices read. */
struct shared {
    const struct pbrt_options *options;
    struct scene scene; ///< constant once it is open
    struct mesh_cache *meshes;
    struct picture_files pictures;
    SluiceReadPool *pool; ///< NULL: each device reads for itself
    uint32_t size[2];     ///< of the picture, pixels
};

/** Zeroed is empty. */
struct device {
    struct shared *shared;
    uint32_t index;
    struct gpu gpu;
    bool unsupported;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    struct textures textures;
    struct surfaces surfaces;
    struct table lights, emitters;
    struct proxies proxies;
    struct world world;
    struct film film;
    struct tracing tracing;
    struct launches launches;
    struct PbrtLaunch constants; ///< of the camera of the picture
    uint64_t missing_count;      ///< pixels of finished pictures that are still missing
    uint32_t picture_count;      ///< that it rendered, or its tiles of
    double busy_seconds;         ///< of all of these
    double end;                  ///< clock_seconds() after the last
};

/** Creates the Vulkan device. `first`: has the instance; NULL: creates it. `name`: as in --device.
 *  Says on stderr why it failed. */
bool device_create(struct shared *shared, const struct device *first, const char *name,
                   struct device *device);
/** Creates all else, and loads everything for --preload. Several devices can be opened at a time.
 *  Says on stderr why it failed. */
bool device_open(struct device *device, struct film_share share);
/** A zeroed one is fine. The first device is destroyed last. */
void device_destroy(struct device *device);

/** Renders the device's share of what the camera sees after a share of the way of --fly, and reads
 *  it into `picture`. Says on stderr why it failed. */
bool device_render(struct device *device, double way, struct picture *picture);

#endif /* DEMAND_PBRT_DEVICE_H */
