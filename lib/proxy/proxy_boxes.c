/* Queries of boxes: one box, bounds of all, and primitives in the caller's memory. */
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "proxy/proxy_set.h"

#include <math.h>
#include <string.h>

SluiceResult sluiceGetProxyBox(const SluiceProxySet *set, SluiceProxyId proxyId,
                               SluiceProxyBox *pBox)
{
    uint32_t index;
    if (!set || !pBox)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_proxy_require_boxes(set, __func__);
    if (result == SLUICE_SUCCESS)
        result = slc_proxy_find(set, proxyId, &index);
    if (result == SLUICE_SUCCESS)
        *pBox = slc_proxy_at(set, index)->is.box;
    return result;
}

SluiceResult sluiceGetProxyBounds(const SluiceProxySet *set, SluiceProxyBox *pBox)
{
    if (!set || !pBox)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_proxy_require_boxes(set, __func__);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t index = slc_bits_next(&set->live, 0);
    if (index == SLC_BIT_NONE)
        return SLUICE_NOT_READY;
    SluiceProxyBox bounds = slc_proxy_at(set, index)->is.box;
    for (; index != SLC_BIT_NONE; index = slc_bits_next(&set->live, index + 1)) {
        const SluiceProxyBox *box = &slc_proxy_at(set, index)->is.box;
        for (uint32_t axis = 0; axis < 3; axis++) {
            bounds.min[axis] = fminf(bounds.min[axis], box->min[axis]);
            bounds.max[axis] = fmaxf(bounds.max[axis], box->max[axis]);
        }
    }
    *pBox = bounds;
    return SLUICE_SUCCESS;
}

/* Adds a range. Joins adjacent groups; without free ranges, extends the last range. */
static void add_range(const SluiceProxyBoxWrite *write, uint32_t *range_count, uint32_t first,
                      uint32_t end)
{
    SluiceProxyRange *last = *range_count ? &write->pRanges[*range_count - 1] : NULL;
    if (last && (last->first + last->count == first || *range_count == write->rangeCapacity))
        last->count = end - last->first;
    else
        write->pRanges[(*range_count)++] = (SluiceProxyRange){first, end - first};
}

/* Returns the box of an index. A removed proxy becomes a point at its former box, because inactive
 * primitives are optional in drivers and prevent updates of structures. */
static SluiceProxyBox box_of(const SluiceProxySet *set, uint32_t index)
{
    SluiceProxyBox box = slc_proxy_at(set, index)->is.box;
    if (!slc_bits_has(&set->live, index))
        memcpy(box.max, box.min, sizeof box.max);
    return box;
}

static void write_range(const SluiceProxySet *set, const SluiceProxyRange *range,
                        SluiceProxyBox *boxes)
{
    for (uint32_t i = range->first; i < range->first + range->count; i++)
        boxes[i] = box_of(set, i);
}

SluiceResult sluiceWriteProxyBoxes(const SluiceProxySet *set, const SluiceProxyBoxWrite *pWrite,
                                   uint64_t *pVersion, uint32_t *pRangeCount)
{
    if (!set || !pWrite || !pVersion || !pRangeCount)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceProxyBoxWrite write = {.structSize = sizeof write};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceProxyBoxWrite), &write, pWrite, &set->log);
    if (result == SLUICE_SUCCESS)
        result = slc_proxy_require_boxes(set, __func__);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t last = slc_bits_last(&set->live), count = last == SLC_BIT_NONE ? 0 : last + 1;
    /* Includes boxes behind the last live proxy, which a later proxy may make primitives again. */
    uint32_t end = slc_min_u32(set->index_count, write.capacity);
    if (!write.pRanges || (end && !write.pBoxes))
        return SLUICE_ERROR_NULL_POINTER;
    if (write.capacity < count || write.rangeCapacity == 0)
        return slc_log_refusal(&set->log,
                               "capacity is %u, rangeCapacity is %u; %u boxes and 1 range are "
                               "required",
                               write.capacity, write.rangeCapacity, count);
    *pRangeCount = 0;
    for (uint32_t first = 0; first < end; first += SLC_PROXY_GROUP)
        if (set->changed[first / SLC_PROXY_GROUP] > *pVersion)
            add_range(&write, pRangeCount, first, slc_min_u32(first + SLC_PROXY_GROUP, end));
    for (uint32_t i = 0; i < *pRangeCount; i++)
        write_range(set, &write.pRanges[i], write.pBoxes);
    *pVersion = set->version;
    return SLUICE_SUCCESS;
}
