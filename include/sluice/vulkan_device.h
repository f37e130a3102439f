/**
 * Devices: what a Vulkan device can do for streamers and demand loaders, and the features to
 * enable. Part of `sluice-vulkan`; vulkan.h includes it. No function needs a context.
 */
#ifndef SLUICE_VULKAN_DEVICE_H
#define SLUICE_VULKAN_DEVICE_H

#include <sluice/image.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Use of device memory by a texture. */
typedef enum SluiceResidencyMode {
    SLUICE_RESIDENCY_MODE_AUTO = 0,   ///< See sluiceChooseVulkanResidencyMode.
    SLUICE_RESIDENCY_MODE_SPARSE = 1, ///< Sparse residency images.
    /**
     * Layers of array images hold tiles; shaders find them in a page table (SluiceVulkanPages). A
     * texture may exceed the device's image size limit.
     */
    SLUICE_RESIDENCY_MODE_PAGED = 2,
    /** Ordinary images with all their memory from the start. Only texels are streamed. */
    SLUICE_RESIDENCY_MODE_DENSE = 3
} SluiceResidencyMode;

/** Capabilities of a device, and its known quirks. */
typedef struct SluiceVulkanDeviceCapabilities {
    uint32_t structSize;             ///< sizeof(SluiceVulkanDeviceCapabilities).
    bool sparse;                     ///< Sparse residency 2D images, and a queue that binds them.
    bool shaderResourceResidency;    ///< Residency codes exist.
    bool shaderResourceMinLod;       ///< Samplers take a LOD clamp: SLUICE_MIN_LOD in sample.glsl.
    bool residencyNonResidentStrict; ///< Reads of unbound texels return 0.
    /** Non-uniform indices into image arrays. If false, shaders define SLUICE_PAGE_LOOP. */
    bool nonUniformIndexing;
    /** Descriptor arrays of unknown length. If false, shaders define SLUICE_PAGE_LOOP. */
    bool runtimeDescriptorArrays;
    /**
     * Best queue family with SPARSE_BINDING, preferably without graphics. It may support nothing
     * else.
     */
    uint32_t sparseQueueFamilyIndex;
    uint64_t sparseAddressSpaceSize; ///< Bytes. Also the limit per image.
    char deviceName[256];
    char driverName[256], driverInfo[256];
    VkPhysicalDeviceType deviceType;
    uint32_t apiVersion;           ///< Encoded by VK_MAKE_API_VERSION.
    bool timelineSemaphore;        ///< Required.
    bool fragmentStoresAndAtomics; ///< Required.
    bool textureCompressionBC;     ///< BC formats can be streamed.
    bool samplerAnisotropy;
    bool sparseResidencyAliased; ///< A page may be bound at several places.
    bool standardTiles;          ///< Sparse tiles have the shapes of sluiceGetStandardTileShape.
    /**
     * Residency codes exist and are correct. Software devices return wrong codes for filters
     * between levels. Sluice itself uses only MinMip maps.
     */
    bool residencyCodesExact;
    bool dedicatedSparseQueue; ///< Its family has neither graphics nor compute.
    uint32_t sparseQueueCount; ///< Queues of sparseQueueFamilyIndex.
    /**
     * Most distinct tiles ever bound in existing images, per process. 0: no limit. Software devices
     * keep a memory map for each until the image is destroyed.
     */
    uint32_t maxTouchedTiles;
    uint32_t maxImageExtent, maxImageArrayLayers;
    uint32_t maxStorageBufferRange; ///< Bytes.
    float maxSamplerAnisotropy;
    float timestampPeriod;          ///< Nanoseconds per tick. 0: no time stamps.
    uint64_t deviceLocalMemorySize; ///< Bytes of the largest device-local heap.
    /** Sparse mode streams cube maps. False on software devices, which sample only the first row of
     *  each sparse face. Paged and dense mode stream cube maps on every device. */
    bool sparseCubes;
} SluiceVulkanDeviceCapabilities;

/**
 * Gets the capabilities of a device.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED if pfnGetInstanceProcAddr lacks a
 *         function.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult
sluiceGetVulkanDeviceCapabilities(VkInstance instance, VkPhysicalDevice physicalDevice,
                                  PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                  SluiceVulkanDeviceCapabilities *pCapabilities);

/**
 * Gets the mode that AUTO resolves to for a streamer of `maxTextureCount` textures (0: 1024). Other
 * modes are returned unchanged.
 *
 * AUTO is sparse mode if the device supports it, else paged mode. Exception: software devices limit
 * the number of tiles (maxTouchedTiles), and a texture uses 8 of them before anything is sampled.
 * There AUTO is paged mode if maxTextureCount is above maxTouchedTiles / 16: above 3071 with the
 * Linux default of 65530 memory maps.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceChooseVulkanResidencyMode(
    const SluiceVulkanDeviceCapabilities *pCapabilities, SluiceResidencyMode mode,
    uint32_t maxTextureCount, SluiceResidencyMode *pMode);

/** Support of a device for one format, as a 2D image that is sampled and copied to. */
typedef struct SluiceVulkanFormatCapabilities {
    uint32_t structSize; ///< sizeof(SluiceVulkanFormatCapabilities).
    bool sampled;        ///< Can be sampled.
    bool linearFilter;   ///< Can be sampled with linear filters. Paged mode requires it.
    bool sparse;         ///< Supports sparse residency images of 64 KiB tiles.
    /** Sparse granularity as reported by the driver. 0 without sparse support. */
    uint32_t granularityWidth, granularityHeight;
    uint32_t tileWidth, tileHeight; ///< Texels of a tile. Corrected if the driver reports blocks.
    /** Limits of sparse images; without sparse support, of ordinary images. */
    uint32_t maxWidth, maxHeight, maxMipLevelCount, maxArrayLayerCount;
    uint64_t maxImageSize; ///< Bytes.
} SluiceVulkanFormatCapabilities;

/**
 * Gets the support of a device for a format.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED for unknown formats or if a function
 *         is missing.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetVulkanFormatCapabilities(
    VkInstance instance, VkPhysicalDevice physicalDevice,
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr, SluiceFormat format,
    SluiceVulkanFormatCapabilities *pCapabilities);

/** Layout of a sparse image on a device. Determined by creating the image. */
typedef struct SluiceVulkanSparseImageLayout {
    uint32_t structSize; ///< sizeof(SluiceVulkanSparseImageLayout).
    uint32_t mipLevelCount;
    uint32_t tileWidth, tileHeight; ///< Texels.
    uint32_t regularMipCount;       ///< Levels whose tiles are bound one by one.
    uint32_t packedTileCount;       ///< Pages of all other (packed) levels.
    bool driverTail;       ///< The driver packs those levels; else each is a tile of its own.
    uint64_t tailSize;     ///< Bytes. 0 without driverTail.
    uint64_t metadataSize; ///< Bytes, bound separately. 0: none.
    uint64_t imageSize;    ///< Bytes of address space.
    uint64_t alignment;    ///< Bytes.
    uint32_t memoryTypeBits;
} SluiceVulkanSparseImageLayout;

/**
 * Gets how a device lays out a sparse image of the size and format of `pImage`.
 *
 * Create `device` with the features of sluiceRequireVulkanFeatures. Other fields of `pImage` are
 * ignored; mipLevelCount may be 0. `pLog` may be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED, with a message to `pLog`, if the
 *         image cannot be streamed; SLUICE_ERROR_INVALID_ARGUMENT for a size of 0;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY, SLUICE_ERROR_OUT_OF_DEVICE_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetVulkanSparseImageLayout(
    VkInstance instance, VkPhysicalDevice physicalDevice, VkDevice device,
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr, const SluiceLogCallback *pLog,
    const SluiceImageInfo *pImage, SluiceVulkanSparseImageLayout *pLayout);

/**
 * Enables in `*pFeatures` and `*pVulkan12` the features that a streamer of this mode requires. Pass
 * both to vkCreateDevice (VkPhysicalDeviceFeatures2 chain). No extension is required.
 *
 * Set sType and zero the rest. Features you already set are kept. textureCompressionBC, ETC2 and
 * ASTC_LDR are enabled if the device has them. `pLog` may be NULL.
 *
 * Features per mode:
 * - All modes: timelineSemaphore, fragmentStoresAndAtomics.
 * - Sparse: also sparseBinding, sparseResidencyImage2D and a queue family with SPARSE_BINDING.
 * - Paged: also shaderSampledImageArrayDynamicIndexing.
 * - AUTO: requires the features of the mode it resolves to.
 *
 * Enabled in every mode if available, for shaders that serve all modes and for arrays of textures:
 * shaderSampledImageArrayDynamicIndexing, shaderSampledImageArrayNonUniformIndexing,
 * runtimeDescriptorArray; for the samplers of textures: samplerAnisotropy,
 * samplerMirrorClampToEdge; and for arrays of cube maps: imageCubeArray.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for an unknown mode;
 *         SLUICE_ERROR_UNSUPPORTED if the device lacks a feature (the log names it).
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceRequireVulkanFeatures(
    VkInstance instance, VkPhysicalDevice physicalDevice,
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr, SluiceResidencyMode mode,
    const SluiceLogCallback *pLog, VkPhysicalDeviceFeatures *pFeatures,
    VkPhysicalDeviceVulkan12Features *pVulkan12);

#ifdef __cplusplus
}
#endif

#endif /* SLUICE_VULKAN_DEVICE_H */
