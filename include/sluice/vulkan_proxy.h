/**
 * Proxies (proxy.h) on Vulkan: requests from the launches of a demand loader, and boxes as the
 * primitives of an acceleration structure. Part of `sluice-vulkan`.
 */
#ifndef SLUICE_VULKAN_PROXY_H
#define SLUICE_VULKAN_PROXY_H

#include <sluice/demand.h>
#include <sluice/proxy.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Adds the resource through which shaders request the proxies of a set: maxProxyCount pages that
 * never become resident. The page of a proxy is `*pFirstPage` + its index; pass `*pFirstPage` to
 * sluiceRequestGeometryProxy or sluiceRequestMaterialProxy (shaders/include/sluice/proxy.glsl).
 *
 * `rank` is that of SluiceDemandResourceCreateInfo. Remove the resource with
 * sluiceRemoveDemandResource.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; otherwise as sluiceAddDemandResource.
 */
SLUICE_API SluiceResult sluiceAddDemandProxies(SluiceDemandLoader *loader,
                                               const SluiceProxySet *set, uint32_t rank,
                                               SluiceDemandResourceId *pResourceId,
                                               uint32_t *pFirstPage);

/**
 * Moves the requests of all processed launches from a resource of sluiceAddDemandProxies into its
 * set. Call it after each sluiceProcessDemandRequests.
 *
 * Requests beyond maxRequestsPerLaunch are made again by the next launch that hits the proxies.
 * SluiceDemandRequests.missingCount counts a proxy in every launch that hits it.
 *
 * Indices of removed proxies become free when the launches begun before this call are processed,
 * and a launch since then has requested at most maxRequestsPerLaunch pages in all.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE or SLUICE_ERROR_STALE_TEXTURE for
 *         an unknown or removed resource; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the
 *         resource has pfnFill or bytes, or its pageCount is not the set's maxProxyCount.
 * Thread safety: external on `loader` and on `set`.
 */
SLUICE_API SluiceResult sluiceProcessDemandProxies(SluiceDemandLoader *loader,
                                                   SluiceDemandResourceId resourceId,
                                                   SluiceProxySet *set);

/** Geometry of an acceleration structure and its range. */
typedef struct SluiceProxyGeometry {
    uint32_t structSize; ///< sizeof(SluiceProxyGeometry).
    VkAccelerationStructureGeometryKHR geometry;
    VkAccelerationStructureBuildRangeInfoKHR range;
} SluiceProxyGeometry;

/**
 * Gets the geometry for vkCmdBuildAccelerationStructuresKHR: AABBs with a stride of 24 bytes at
 * `address`, where sluiceWriteProxyBoxes has written them, one for each index below indexCount.
 * gl_PrimitiveID is then the index of the proxy. The flag
 * VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR is set, VK_GEOMETRY_OPAQUE_BIT_KHR is not.
 *
 * Build or update the structure after proxies were added or removed. Vulkan allows an update only
 * if primitiveCount is the same. With an empty set primitiveCount is 0.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for address 0 unless the set is empty;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a wrong structSize, a set with
 *         materials, or an `address` that is not a multiple of 8.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetProxyGeometry(const SluiceProxySet *set, VkDeviceAddress address,
                                               SluiceProxyGeometry *pGeometry);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_PROXY_H */
