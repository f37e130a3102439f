/* Requests of proxies, and the order of their list. */
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "proxy/proxy_box.h"
#include "proxy/proxy_set.h"

#include <inttypes.h>
#include <math.h>

SluiceResult sluiceAddProxyRequests(SluiceProxySet *set, const SluiceProxyRequests *pRequests)
{
    if (!set || !pRequests)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceProxyRequests requests = {.structSize = sizeof requests};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceProxyRequests), &requests, pRequests, &set->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (requests.indexCount && !requests.pIndices)
        return SLUICE_ERROR_NULL_POINTER;
    if (requests.processedLaunch > requests.begunLaunch)
        return slc_log_refusal(&set->log,
                               "processedLaunch is %" PRIu64 ", above begunLaunch, %" PRIu64,
                               requests.processedLaunch, requests.begunLaunch);
    for (uint32_t i = 0; i < requests.indexCount; i++)
        if (slc_bits_has(&set->live, requests.pIndices[i]))
            slc_bits_add(&set->requested, requests.pIndices[i]);
    slc_proxy_release(set, requests.begunLaunch, requests.processedLaunch);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceClearProxyRequests(SluiceProxySet *set, SluiceProxyId proxyId)
{
    uint32_t index;
    if (!set)
        return SLUICE_ERROR_NULL_POINTER;
    if (proxyId == SLUICE_ALL_PROXIES) {
        slc_bits_remove_all(&set->requested);
        return SLUICE_SUCCESS;
    }
    SluiceResult result = slc_proxy_find(set, proxyId, &index);
    if (result == SLUICE_SUCCESS)
        slc_bits_remove(&set->requested, index);
    return result;
}

/* Heap of requests; the root is the last in order. */
struct heap {
    const SluiceProxySet *set;
    const SluiceProxyListInfo *info;
    SluiceProxyId *ids;
    uint32_t count;
};

static double key(const struct heap *heap, SluiceProxyId id)
{
    const SluiceProxyBox *box = &slc_proxy_at(heap->set, (uint32_t)id)->is.box;
    return heap->info->order == SLUICE_PROXY_ORDER_VOLUME
               ? -slc_proxy_box_volume(box)
               : slc_proxy_box_distance(box, heap->info->point);
}

static bool is_before(const struct heap *heap, SluiceProxyId a, SluiceProxyId b)
{
    double key_a = key(heap, a), key_b = key(heap, b);
    return key_a != key_b ? key_a < key_b : (uint32_t)a < (uint32_t)b;
}

/* Replaces the root by `id` and restores the heap. */
static void sink(struct heap *heap, SluiceProxyId id)
{
    uint32_t at = 0, child;
    while ((child = 2 * at + 1) < heap->count) {
        child += child + 1 < heap->count && is_before(heap, heap->ids[child], heap->ids[child + 1]);
        if (!is_before(heap, id, heap->ids[child]))
            break;
        heap->ids[at] = heap->ids[child];
        at = child;
    }
    heap->ids[at] = id;
}

static void push(struct heap *heap, SluiceProxyId id)
{
    uint32_t at = heap->count++;
    while (at && is_before(heap, heap->ids[(at - 1) / 2], id)) {
        heap->ids[at] = heap->ids[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    heap->ids[at] = id;
}

static void list_by_index(const SluiceProxySet *set, uint32_t count, SluiceProxyId *ids)
{
    uint32_t index = slc_bits_next(&set->requested, 0);
    for (uint32_t i = 0; i < count; i++, index = slc_bits_next(&set->requested, index + 1))
        ids[i] = slc_proxy_id(set, index);
}

/* Lists the first `capacity` requests in order, sorted. */
static void list_by_key(struct heap *heap, uint32_t capacity)
{
    const struct slc_bit_tree *requested = &heap->set->requested;
    for (uint32_t i = slc_bits_next(requested, 0); i != SLC_BIT_NONE && capacity;
         i = slc_bits_next(requested, i + 1)) {
        SluiceProxyId id = slc_proxy_id(heap->set, i);
        if (heap->count < capacity)
            push(heap, id);
        else if (is_before(heap, id, heap->ids[0]))
            sink(heap, id);
    }
    while (heap->count > 1) {
        SluiceProxyId last = heap->ids[0];
        heap->count--;
        sink(heap, heap->ids[heap->count]);
        heap->ids[heap->count] = last;
    }
}

static SluiceResult check(const SluiceProxySet *set, const SluiceProxyListInfo *info)
{
    if ((uint32_t)info->order > SLUICE_PROXY_ORDER_DISTANCE)
        return slc_log_refusal(&set->log, "order is %u; the limit is %d", (uint32_t)info->order,
                               SLUICE_PROXY_ORDER_DISTANCE);
    if (info->order == SLUICE_PROXY_ORDER_INDEX)
        return SLUICE_SUCCESS;
    for (uint32_t axis = 0; axis < 3; axis++)
        if (info->order == SLUICE_PROXY_ORDER_DISTANCE && !isfinite(info->point[axis]))
            return slc_log_refusal(&set->log, "point[%u] is not finite", axis);
    return slc_proxy_require_boxes(set, "sluiceGetRequestedProxies");
}

SluiceResult sluiceGetRequestedProxies(const SluiceProxySet *set, const SluiceProxyListInfo *pInfo,
                                       uint32_t *pCount, SluiceProxyId *pProxyIds)
{
    SluiceProxyListInfo info = {.structSize = sizeof info};
    SluiceResult result = SLUICE_SUCCESS;
    if (!set || !pCount || !pProxyIds)
        return SLUICE_ERROR_NULL_POINTER;
    if (pInfo)
        result = slc_struct_read(SLC_STRUCT(SluiceProxyListInfo), &info, pInfo, &set->log);
    if (result == SLUICE_SUCCESS)
        result = check(set, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t capacity = *pCount;
    *pCount = slc_min_u32(capacity, set->requested.count);
    if (info.order == SLUICE_PROXY_ORDER_INDEX)
        list_by_index(set, *pCount, pProxyIds);
    else
        list_by_key(&(struct heap){set, &info, pProxyIds, 0}, capacity);
    return capacity < set->requested.count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}
