/** A GPU that traces its part, and all that each GPU has for itself: device, loader, film. */
#ifndef TRACER_DEVICE_H
#define TRACER_DEVICE_H

#include "history.h"

struct tracer;

/** Zeroed is empty. */
struct device {
    struct tracer *tracer; ///< that it is part of
    const struct tracer_options *options;
    uint32_t index;
    struct gpu gpu;
    bool unsupported;
    SluiceReadPool *pool; ///< of all devices; NULL: it reads for itself
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    SluiceDemandTextureId *ids; ///< owned; of the textures
    struct film film;
    struct renderer renderer;
    struct launches launches;
    struct history history;
    uint64_t missing_count; ///< pixels of finished pictures that are still missing
    uint64_t done_count;    ///< paths of finished pictures, for progress
    uint64_t path_count;    ///< complete paths, for progress; under the tracer's mutex
    uint32_t picture_count; ///< that it traced, or its tiles of
    double busy_seconds;    ///< of all of these
    double end;             ///< clock_seconds() after the last
};

/** Creates the Vulkan device. `first`: has the instance; NULL: creates it. `name`: as in --device.
 *  Says on stderr why it failed. */
bool device_create(const struct tracer_options *options, const struct device *first,
                   const char *name, struct device *device);
/** Creates all else. Several devices can be opened at a time. Says on stderr why it failed. */
bool device_open(struct device *device, const struct scene *scene, struct textures *textures,
                 struct film_share share);
/** NULL or zeroed is fine. The first device is destroyed last. */
void device_destroy(struct device *device);

/** Traces the device's share of a picture, and reads it into `picture`. Says on stderr why it
 *  failed. */
bool device_trace(struct device *device, const struct scene_camera *camera,
                  struct picture *picture);

#endif /* TRACER_DEVICE_H */
