/** A GPU that traces its share of the picture, with its own Vulkan device, loader and film. */
#ifndef TRACER_DEVICE_H
#define TRACER_DEVICE_H

#include "history.h"

struct tracer;

/** Zeroed is empty. */
struct device {
    struct tracer *tracer; ///< tracer that the device is part of
    const struct tracer_options *options;
    uint32_t index;
    struct gpu gpu;
    bool unsupported;
    SluiceReadPool *pool; ///< shared by all devices; NULL: the loader has its own threads
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    SluiceDemandTextureId *ids; ///< owned; loader's id of each image
    struct film film;
    struct renderer renderer;
    struct launches launches;
    struct history history;
    uint64_t missing_count; ///< pixels that were still incomplete when their picture ended
    uint64_t done_count;    ///< paths of finished pictures, for progress
    uint64_t path_count;    ///< complete paths, for progress; under the tracer's mutex
    uint32_t picture_count; ///< pictures that this device traced, completely or in part
    double busy_seconds;    ///< total tracing time of these pictures
    double end;             ///< clock_seconds() at the end of the last picture
};

/** Creates the Vulkan device. `first`: device that owns the instance; NULL: create the instance.
 * `name`: as in --device. Reports errors on stderr. */
bool device_create(const struct tracer_options *options, const struct device *first,
                   const char *name, struct device *device);
/** Creates all other objects. May run for several devices at once. Reports errors on stderr. */
bool device_open(struct device *device, const struct scene *scene, struct textures *textures,
                 struct film_share share);
/** Accepts NULL or a zeroed device. Destroy the first device last. */
void device_destroy(struct device *device);

/** Traces the device's share of a picture, and reads it into `picture`. Reports errors on
 * stderr. */
bool device_trace(struct device *device, const struct scene_camera *camera,
                  struct picture *picture);

#endif /* TRACER_DEVICE_H */
