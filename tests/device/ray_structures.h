/** Buffers with addresses and acceleration structures, for tests that trace rays. */
#ifndef TESTS_DEVICE_RAY_STRUCTURES_H
#define TESTS_DEVICE_RAY_STRUCTURES_H

#include "device/harness.h"

#define RAY_DEVICE_EXTENSION_COUNT 3u
extern const char *const ray_device_extensions[RAY_DEVICE_EXTENSION_COUNT];
/** Returns a static feature chain for harness_init_with. */
void *ray_device_features(void);

/* clang-format off */
#define RAY_DEVICE_FUNCTIONS(X)                                                                    \
    X(CmdBuildAccelerationStructuresKHR) X(CmdTraceRaysKHR) X(CreateAccelerationStructureKHR)      \
    X(CreateRayTracingPipelinesKHR) X(DestroyAccelerationStructureKHR)                             \
    X(GetAccelerationStructureBuildSizesKHR) X(GetAccelerationStructureDeviceAddressKHR)           \
    X(GetBufferDeviceAddress) X(GetRayTracingShaderGroupHandlesKHR)
/* clang-format on */

/** A host visible buffer with an address. */
struct ray_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *mapped;
    VkDeviceAddress address;
};

struct ray_structure {
    struct ray_buffer storage, scratch;
    VkAccelerationStructureKHR handle;
};

struct ray_device {
    struct harness *h;
#define RAY_DEVICE_MEMBER(name) PFN_vk##name name;
    RAY_DEVICE_FUNCTIONS(RAY_DEVICE_MEMBER)
#undef RAY_DEVICE_MEMBER
};

/** `h` was created with the extensions and features above. */
void ray_device_init(struct ray_device *device, struct harness *h);

void ray_buffer_init(struct ray_device *device, struct ray_buffer *buffer, uint64_t size,
                     VkBufferUsageFlags usage);
void ray_buffer_finish(struct ray_device *device, struct ray_buffer *buffer);

/** Builds a structure of one geometry, and waits. */
void ray_structure_build(struct ray_device *device, struct ray_structure *structure,
                         VkAccelerationStructureTypeKHR type,
                         const VkAccelerationStructureGeometryKHR *geometry, uint32_t count);
void ray_structure_finish(struct ray_device *device, struct ray_structure *structure);

#endif /* TESTS_DEVICE_RAY_STRUCTURES_H */
