/** A GPU that renders its share of the picture, with its own Vulkan device, loader and world. */
#ifndef DEMAND_PBRT_DEVICE_H
#define DEMAND_PBRT_DEVICE_H

#include "launches.h"

/** Host memory that all devices read. */
struct shared {
    const struct pbrt_options *options;
    struct scene scene; ///< constant once it is open
    struct mesh_cache *meshes;
    struct picture_files pictures;
    SluiceReadPool *pool; ///< NULL: each device reads for itself
    uint32_t size[2];     ///< picture size in pixels
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
    struct PbrtLaunch constants; ///< push constants of the picture's camera
    uint64_t missing_count;      ///< pixels that were still incomplete when their picture ended
    uint32_t picture_count;      ///< pictures that this device rendered, completely or in part
    double busy_seconds;         ///< total rendering time of these pictures
    double end;                  ///< clock_seconds() at the end of the last picture
};

/** Creates the Vulkan device. `first`: device that owns the instance; NULL: create the instance.
 * `name`: as in --device. Reports errors on stderr. */
bool device_create(struct shared *shared, const struct device *first, const char *name,
                   struct device *device);
/** Creates all other objects, and loads everything for --preload. May run for several devices at
 * once. Reports errors on stderr. */
bool device_open(struct device *device, struct film_share share);
/** Accepts a zeroed device. Destroy the first device last. */
void device_destroy(struct device *device);

/** Renders the device's share of the picture after the share `way` of the --fly path, and reads it
 * into `picture`. Reports errors on stderr. */
bool device_render(struct device *device, double way, struct picture *picture);

#endif /* DEMAND_PBRT_DEVICE_H */
