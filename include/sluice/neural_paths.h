/**
 * Paths by which shaders decode neural textures (neural.h): which ones a device has, what to enable
 * for them, and weights in the device's layout. Part of `sluice-vulkan`. docs/neural.md compares
 * the paths.
 */
#ifndef SLUICE_NEURAL_PATHS_H
#define SLUICE_NEURAL_PATHS_H

#include <sluice/neural.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Paths of a device. Names in capitals: definitions for neural.glsl and neural_matrix.glsl. */
typedef struct SluiceNeuralPaths {
    uint32_t structSize; ///< sizeof(SluiceNeuralPaths).
    bool integerDot;     ///< SLUICE_NEURAL_INTEGER_DOT: VK_KHR_shader_integer_dot_product.
    bool half;           ///< SLUICE_NEURAL_HALF: shaderFloat16.
    bool vectorInt8;     ///< SLUICE_NEURAL_VECTOR: VK_NV_cooperative_vector.
    bool vectorFp8;      ///< The same with SLUICE_NEURAL_FP8.
    bool matrix;         ///< neural_matrix.glsl: VK_KHR_cooperative_matrix, with full subgroups.
    /** Shape of int8 products with int32 sums that the device lists for subgroups:
     * SLUICE_NEURAL_MATRIX_M, N and K. 0 without `matrix`. */
    uint32_t matrixM, matrixN, matrixK;
    VkShaderStageFlags vectorStages; ///< Stages with cooperative vectors. 0 without vectorInt8.
} SluiceNeuralPaths;

/**
 * Gets the paths of a device. A cooperative path requires support in compute shaders and a listed
 * combination of types. Check vectorStages before other stages use vectors. neural_matrix.glsl is
 * for compute shaders only, because of its shared memory.
 *
 * `pAllocator` may be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize;
 *         SLUICE_ERROR_UNSUPPORTED if a function of Vulkan 1.2 is missing;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetNeuralPaths(VkInstance instance, VkPhysicalDevice physicalDevice,
                                             PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                             const SluiceAllocationCallbacks *pAllocator,
                                             SluiceNeuralPaths *pPaths);

/** Most extensions of all paths. */
#define SLUICE_NEURAL_MAX_EXTENSIONS 4

/** Extensions and features of paths, for vkCreateDevice. Never grows. Must not move while `pNext`
 *  is used. */
typedef struct SluiceNeuralPathFeatures {
    uint32_t extensionCount;
    const char *extensions[SLUICE_NEURAL_MAX_EXTENSIONS]; ///< Static strings.
    void *pNext;          ///< Chain of feature structs in `storage`. Ends with the one given.
    uint64_t storage[16]; ///< Private.
} SluiceNeuralPathFeatures;

/**
 * Gets the features and extensions to enable for paths. Clear paths in `pPaths` that you do not use
 * first. Sets features in `*pVulkan12` (shaderFloat16, shaderInt8, vulkanMemoryModel); features
 * that are already set are kept. Chain `pFeatures->pNext` into VkDeviceCreateInfo, and name the
 * extensions.
 *
 * `pNext` may be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceRequireNeuralPaths(const SluiceNeuralPaths *pPaths, void *pNext,
                                                 VkPhysicalDeviceVulkan12Features *pVulkan12,
                                                 SluiceNeuralPathFeatures *pFeatures);

/** Weights to convert. A field of zero selects its default. */
typedef struct SluiceNeuralConvertInfo {
    uint32_t structSize; ///< sizeof(SluiceNeuralConvertInfo).
    VkDevice device;     ///< Required, with VK_NV_cooperative_vector enabled.
    PFN_vkGetDeviceProcAddr pfnGetDeviceProcAddr; ///< Required.
    /** Required. Only schema and inputCount are read. */
    const SluiceNeuralConstants *pConstants;
    SluiceNeuralWeightKind weightKind; ///< INT8 or FP8. Default: INT8.
    const void *pWeights;              ///< Required. From sluiceGetNeuralWeights, of that kind.
    uint64_t weightSize;               ///< Bytes.
    SluiceLogCallback log;
} SluiceNeuralConvertInfo;

/**
 * Writes weights as shaders with SLUICE_NEURAL_VECTOR read them: matrices have the layout that is
 * the device's best for inference (vkConvertCooperativeVectorMatrixNV). Runs on the host and
 * submits nothing. Other devices and drivers may have another layout, so do not keep the bytes.
 *
 * `pBytes` may be NULL: `*pSize` becomes the number of bytes. Otherwise `*pSize` says how many
 * bytes are there, and becomes how many were written. Upload them to a multiple of 64 bytes in a
 * storage buffer.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, logged, for a wrong structSize
 *         or weights that do not fit the constants; SLUICE_ERROR_SIZE_MISMATCH for too few bytes;
 *         SLUICE_ERROR_UNSUPPORTED if the device has no vkConvertCooperativeVectorMatrixNV;
 *         SLUICE_ERROR_VULKAN if that fails.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceConvertNeuralWeights(const SluiceNeuralConvertInfo *pInfo,
                                                   uint64_t *pSize, void *pBytes);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_NEURAL_PATHS_H */
