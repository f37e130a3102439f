#include "proxy/naive_set.h"

#include "support/test.h"

#include <stdlib.h>

void naive_init(struct naive_set *set, uint32_t capacity)
{
    set->capacity = capacity;
    set->proxies = calloc(capacity, sizeof *set->proxies);
    assert_non_null(set->proxies);
}

void naive_finish(struct naive_set *set)
{
    free(set->proxies);
}

static SluiceProxyId id_of(const struct naive_set *set, uint32_t index)
{
    return (uint64_t)set->proxies[index].generation << 32 | index;
}

SluiceProxyId naive_add(struct naive_set *set, const SluiceProxyBox *box)
{
    for (uint32_t i = 0; i < set->capacity; i++) {
        struct naive_proxy *proxy = &set->proxies[i];
        if (proxy->state != NAIVE_NEW && proxy->state != NAIVE_FREE)
            continue;
        *proxy = (struct naive_proxy){
            .state = NAIVE_LIVE, .generation = proxy->generation + 1, .box = *box};
        return id_of(set, i);
    }
    return SLUICE_NO_PROXY;
}

void naive_remove(struct naive_set *set, uint32_t index)
{
    set->proxies[index].state = NAIVE_REMOVED;
    set->proxies[index].requested = set->proxies[index].noted = false;
}

void naive_request(struct naive_set *set, uint64_t begun, uint64_t processed, uint32_t count,
                   const uint32_t *indices)
{
    for (uint32_t i = 0; i < count; i++)
        if (indices[i] < set->capacity && set->proxies[indices[i]].state == NAIVE_LIVE)
            set->proxies[indices[i]].requested = true;
    for (uint32_t i = 0; i < set->capacity; i++) {
        struct naive_proxy *proxy = &set->proxies[i];
        if (proxy->state != NAIVE_REMOVED)
            continue;
        if (!proxy->noted)
            proxy->launch = begun;
        proxy->noted = true;
        if (proxy->launch <= processed)
            proxy->state = NAIVE_FREE;
    }
}

/* Key by the definition in proxy.h, computed from the corners, unlike the library. */
static double key_of(const SluiceProxyBox *box, const SluiceProxyListInfo *info)
{
    double volume = 1, distance = 0;
    for (uint32_t axis = 0; axis < 3; axis++) {
        double min = box->min[axis], max = box->max[axis], point = info->point[axis];
        double nearest = point < min ? min : point > max ? max : point;
        volume *= max - min;
        distance += (nearest - point) * (nearest - point);
    }
    return info->order == SLUICE_PROXY_ORDER_VOLUME     ? -volume
           : info->order == SLUICE_PROXY_ORDER_DISTANCE ? distance
                                                        : 0;
}

uint32_t naive_list(const struct naive_set *set, const SluiceProxyListInfo *info,
                    SluiceProxyId *ids)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->capacity; i++) {
        if (set->proxies[i].state != NAIVE_LIVE || !set->proxies[i].requested)
            continue;
        uint32_t at = count++;
        double key = key_of(&set->proxies[i].box, info);
        for (; at && key_of(&set->proxies[(uint32_t)ids[at - 1]].box, info) > key; at--)
            ids[at] = ids[at - 1];
        ids[at] = id_of(set, i);
    }
    return count;
}
