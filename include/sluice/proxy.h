/**
 * Proxies: boxes that stand for geometry, and numbers that stand for materials, until a ray hits
 * them. Part of `sluice`. Needs no device.
 *
 * A ray tracer adds a proxy for whatever it has not built. Shaders that hit the proxy request it
 * (shaders/include/sluice/proxy.glsl). The application gets the requested proxies after a launch,
 * builds what they stand for, and removes them:
 *
 *     sluiceProcessDemandRequests(loader, &launch, UINT64_MAX, &requests, NULL);
 *     sluiceProcessDemandProxies(loader, resource, set);          (vulkan_proxy.h)
 *     sluiceGetRequestedProxies(set, NULL, &count, ids);
 *     for each id: build what it stands for; sluiceRemoveProxy(set, id);
 *
 * A proxy stays requested until it is removed or its request is cleared. A request for a proxy that
 * was removed meanwhile is ignored. docs/proxies.md explains each step.
 *
 * The index of a proxy is the low 32 bits of its id. Shaders name proxies by index, and the index
 * is the number of the box among the AABB primitives. Indices are dense: the lowest free one is
 * used next. An index is used again only when all launches that could name the removed proxy are
 * processed (sluiceAddProxyRequests). So applications may keep arrays by index.
 *
 * Equal calls give equal ids, requests and orders on every machine.
 *
 * Thread safety, unless a function says otherwise: external on the set.
 */
#ifndef SLUICE_PROXY_H
#define SLUICE_PROXY_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Proxies of one kind. */
typedef struct SluiceProxySet SluiceProxySet;

/** Id of a proxy. Never 0. The low 32 bits are its index, the high 32 bits its generation. Ids are
 *  never reused. */
typedef uint64_t SluiceProxyId;

/** No proxy. Value of an id in a zeroed struct. */
#define SLUICE_NO_PROXY ((SluiceProxyId)0)
/** All proxies of a set, in calls that say so. Never the id of a proxy. */
#define SLUICE_ALL_PROXIES ((SluiceProxyId)UINT64_MAX)

/** Kind of the proxies of a set. */
typedef enum SluiceProxyKind {
    SLUICE_PROXY_KIND_GEOMETRY = 0, ///< With boxes.
    SLUICE_PROXY_KIND_MATERIAL = 1  ///< Without boxes.
} SluiceProxyKind;

/** Settings of a set. A field of zero selects its default. */
typedef struct SluiceProxySetCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceProxySetCreateInfo).
    SluiceProxyKind kind;
    /**
     * Most proxies at a time, including removed ones whose index is not free yet. At most 2^31 - 1.
     * Default: 2^20. Virtual: memory follows the largest index ever used. It is the pageCount of
     * the set's resource, of the loader's pageCapacity.
     */
    uint32_t maxProxyCount;
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;                       ///< Receives the reasons of refusals.
} SluiceProxySetCreateInfo;

/**
 * Creates an empty set. `*pSet` belongs to the caller, who destroys it with sluiceDestroyProxySet.
 *
 * A set takes 29 bytes of host memory for each index up to the largest ever used, in steps of
 * 1024 indices, and 24 bytes for each box that the application keeps in a buffer
 * (sluiceWriteProxyBoxes).
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateProxySet(const SluiceProxySetCreateInfo *pCreateInfo,
                                             SluiceProxySet **pSet);

/** Destroys a set. NULL is allowed. Resources of loaders for it are not removed. */
SLUICE_API void sluiceDestroyProxySet(SluiceProxySet *set);

/** Axis-aligned box. The layout is that of VkAabbPositionsKHR: 24 bytes. Never grows. */
typedef struct SluiceProxyBox {
    float min[3], max[3];
} SluiceProxyBox;

/**
 * Adds a geometry proxy.
 *
 * A box that is too thin to be hit is widened: along each axis where it is thinner than 2^-20 times
 * its largest coordinate (absolute value), both sides move out by half of that. So boxes may have
 * zero thickness in one or two axes. sluiceGetProxyBox returns the box after that.
 *
 * Errors, with nothing changed: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a
 * log message, if a coordinate is not finite or beyond 2^100, if min is above max, if the box is a
 * point, if all coordinates are below 2^-100, or if the set has materials;
 *         SLUICE_ERROR_LIMIT_EXCEEDED above maxProxyCount; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceAddGeometryProxy(SluiceProxySet *set, const SluiceProxyBox *pBox,
                                               SluiceProxyId *pProxyId);

/**
 * Adds a material proxy. Its index is yours to use, such as for a table of materials in a buffer:
 * no launch that is under way reads the entry for a removed proxy of the same index.
 *
 * Errors, with nothing changed: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a
 * log message, if the set has geometry; SLUICE_ERROR_LIMIT_EXCEEDED above maxProxyCount;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceAddMaterialProxy(SluiceProxySet *set, SluiceProxyId *pProxyId);

/**
 * Removes a proxy. Its request is dropped. Its index is used again when all launches begun so far
 * are processed (sluiceAddProxyRequests).
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE if no proxy ever had this id;
 *         SLUICE_ERROR_STALE_TEXTURE if the proxy was removed before.
 */
SLUICE_API SluiceResult sluiceRemoveProxy(SluiceProxySet *set, SluiceProxyId proxyId);

/**
 * Gets the box of a geometry proxy, as it was widened.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE and SLUICE_ERROR_STALE_TEXTURE as
 *         sluiceRemoveProxy; SLUICE_ERROR_INVALID_ARGUMENT if the set has materials.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetProxyBox(const SluiceProxySet *set, SluiceProxyId proxyId,
                                          SluiceProxyBox *pBox);

/**
 * Gets the box around all geometry proxies. Visits every index in use.
 *
 * Returns SLUICE_NOT_READY, with `*pBox` unchanged, if the set is empty.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the set has materials.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetProxyBounds(const SluiceProxySet *set, SluiceProxyBox *pBox);

/** Present state of a set. */
typedef struct SluiceProxySetInfo {
    uint32_t structSize; ///< sizeof(SluiceProxySetInfo).
    SluiceProxyKind kind;
    uint32_t maxProxyCount;
    uint32_t proxyCount;     ///< Live proxies.
    uint32_t requestedCount; ///< Live proxies that are requested.
    uint32_t removedCount;   ///< Removed proxies whose index is not free yet.
    uint32_t indexCount;     ///< 1 + the largest index of a live proxy; 0 if there is none.
    uint64_t hostMemorySize; ///< Bytes that the set has allocated.
} SluiceProxySetInfo;

/**
 * Gets counts.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetProxySetInfo(const SluiceProxySet *set, SluiceProxySetInfo *pInfo);

/** Requests of launches, in numbers that count up by any rule of yours. */
typedef struct SluiceProxyRequests {
    uint32_t structSize;  ///< sizeof(SluiceProxyRequests).
    uint64_t begunLaunch; ///< The last launch that was begun.
    uint64_t
        processedLaunch; ///< The last launch whose requests were added, with this call or before.
    uint32_t indexCount; ///< Elements of pIndices.
    const uint32_t *pIndices; ///< Indices of proxies that shaders requested, in any order.
} SluiceProxyRequests;

/**
 * Adds the requests of launches. sluiceProcessDemandProxies calls it; call it yourself only if your
 * shaders report in a way of their own.
 *
 * Live proxies become requested. All other indices are ignored. Indices of removed proxies stay in
 * use until the launch that was begunLaunch at the first call after the removal is processed. Call
 * it without requests, too: otherwise no index is used again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if
 *         processedLaunch is above begunLaunch.
 */
SLUICE_API SluiceResult sluiceAddProxyRequests(SluiceProxySet *set,
                                               const SluiceProxyRequests *pRequests);

/** Order of requested proxies. Equal ones ascend by index. */
typedef enum SluiceProxyOrder {
    SLUICE_PROXY_ORDER_INDEX = 0,   ///< Ascending index.
    SLUICE_PROXY_ORDER_VOLUME = 1,  ///< Largest box first.
    SLUICE_PROXY_ORDER_DISTANCE = 2 ///< Nearest box first. Boxes around the point have distance 0.
} SluiceProxyOrder;

/** Order of requested proxies in a list. */
typedef struct SluiceProxyListInfo {
    uint32_t structSize; ///< sizeof(SluiceProxyListInfo).
    SluiceProxyOrder order;
    float point[3]; ///< DISTANCE: such as the camera's position. Finite.
} SluiceProxyListInfo;

/**
 * Lists requested proxies, each once. Changes nothing: a proxy is listed again until it is removed
 * or its request is cleared.
 *
 * Set `*pCount` to the capacity of `pProxyIds`. The call sets it to the number of ids written.
 * Returns SLUICE_INCOMPLETE if more proxies are requested; the ids written are the first in order.
 * SluiceProxySetInfo.requestedCount counts all. `pInfo` may be NULL: SLUICE_PROXY_ORDER_INDEX.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for an
 * order that is unknown or needs boxes that the set does not have, or a point that is not finite.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetRequestedProxies(const SluiceProxySet *set,
                                                  const SluiceProxyListInfo *pInfo,
                                                  uint32_t *pCount, SluiceProxyId *pProxyIds);

/**
 * Clears the request of a proxy, or of SLUICE_ALL_PROXIES. The proxies stay, and so do their ids.
 * They are requested again when later launches hit them.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE and SLUICE_ERROR_STALE_TEXTURE as
 *         sluiceRemoveProxy.
 */
SLUICE_API SluiceResult sluiceClearProxyRequests(SluiceProxySet *set, SluiceProxyId proxyId);

/** A run of boxes. Never grows. */
typedef struct SluiceProxyRange {
    uint32_t first, count;
} SluiceProxyRange;

/** Memory for boxes, and ranges of written boxes. */
typedef struct SluiceProxyBoxWrite {
    uint32_t structSize;       ///< sizeof(SluiceProxyBoxWrite).
    uint32_t capacity;         ///< Boxes of pBoxes. At least indexCount.
    SluiceProxyBox *pBoxes;    ///< By index of proxy. May be mapped memory: it is only written.
    uint32_t rangeCapacity;    ///< Elements of pRanges. At least 1.
    SluiceProxyRange *pRanges; ///< Receives the runs that were written, ascending.
} SluiceProxyBoxWrite;

/**
 * Writes the boxes that have changed, each at its index, so that a buffer holds the primitives of
 * an acceleration structure (sluiceGetProxyGeometry in vulkan_proxy.h).
 *
 * `*pVersion` is the state of your memory: 0 if it has no boxes yet, otherwise what the last call
 * for this memory returned. Keep a version for each buffer. Boxes are written in groups of 64; more
 * than rangeCapacity runs are joined. Indices without a live proxy get boxes of size 0,
 * which sluiceIntersectProxyBox never hits. `*pRangeCount` is the number of runs: 0 if nothing has
 * changed.
 *
 * Errors, with nothing written: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a
 * log message, if the set has materials, the capacity is below indexCount, or rangeCapacity is 0.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceWriteProxyBoxes(const SluiceProxySet *set,
                                              const SluiceProxyBoxWrite *pWrite, uint64_t *pVersion,
                                              uint32_t *pRangeCount);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_PROXY_H */
