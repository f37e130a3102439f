/** The scene for the device's own ray tracing: one structure per shape, one over all instances. */
#ifndef TRACER_ACCEL_H
#define TRACER_ACCEL_H

#include "../../tools/common/gpu.h"
#include "scene.h"

struct accel_structure {
    VkAccelerationStructureKHR handle;
    struct gpu_buffer storage;
};

/** Zeroed is empty. */
struct accel {
    struct accel_structure shapes[SHAPE_COUNT], scene;
    struct gpu_buffer instances;
};

/** Usage of buffers that builds read. */
#define ACCEL_INPUT_USAGE                                                                          \
    (VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |                        \
     VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT)

/** Builds on a device with ray tracing, and waits. Reports errors on stderr. */
bool accel_build(const struct gpu *gpu, const struct scene *scene, VkBuffer vertices,
                 VkBuffer indices, struct accel *accel);
void accel_finish(const struct gpu *gpu, struct accel *accel);

#endif /* TRACER_ACCEL_H */
