/* Lines that proxies.md shows. Compiled, not run. */
#include <sluice/vulkan_proxy.h>

#include <stdbool.h>

enum { MOST_AT_ONCE = 64 };

bool has_time(void);
void build_geometry(uint32_t index);

SluiceResult add_boxes(SluiceDemandLoader *loader, const SluiceProxyBox *bounds, uint32_t count,
                       SluiceProxySet **pSet, SluiceDemandResourceId *pResource,
                       uint32_t *pFirstPage);
SluiceResult add_boxes(SluiceDemandLoader *loader, const SluiceProxyBox *bounds, uint32_t count,
                       SluiceProxySet **pSet, SluiceDemandResourceId *pResource,
                       uint32_t *pFirstPage)
{
    const SluiceProxySetCreateInfo info = {
        .structSize = sizeof info, .kind = SLUICE_PROXY_KIND_GEOMETRY, .maxProxyCount = 1u << 20};
    SluiceProxySet *set;
    SluiceResult result = sluiceCreateProxySet(&info, &set);
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++) {
        SluiceProxyId id; /* of a new set: its index is i */
        result = sluiceAddGeometryProxy(set, &bounds[i], &id);
    }
    if (result == SLUICE_SUCCESS)
        result = sluiceAddDemandProxies(loader, set, 0, pResource, pFirstPage);
    *pSet = set;
    return result;
}

SluiceResult write_boxes(const SluiceProxySet *set, SluiceProxyBox *mapped, uint32_t capacity,
                         VkDeviceAddress address, uint64_t *pVersion,
                         SluiceProxyGeometry *pGeometry);
SluiceResult write_boxes(const SluiceProxySet *set, SluiceProxyBox *mapped, uint32_t capacity,
                         VkDeviceAddress address, uint64_t *pVersion,
                         SluiceProxyGeometry *pGeometry)
{
    SluiceProxyRange ranges[16];
    uint32_t rangeCount;
    const SluiceProxyBoxWrite write = {.structSize = sizeof write,
                                       .capacity = capacity,
                                       .pBoxes = mapped,
                                       .rangeCapacity = 16,
                                       .pRanges = ranges};
    SluiceResult result = sluiceWriteProxyBoxes(set, &write, pVersion, &rangeCount);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetProxyGeometry(set, address, pGeometry);
    return result;
}

SluiceResult resolve(SluiceDemandLoader *loader, const SluiceDemandLaunch *launch,
                     SluiceDemandResourceId resource, SluiceProxySet *set, const float eye[3]);
SluiceResult resolve(SluiceDemandLoader *loader, const SluiceDemandLaunch *launch,
                     SluiceDemandResourceId resource, SluiceProxySet *set, const float eye[3])
{
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    SluiceResult result = sluiceProcessDemandRequests(loader, launch, UINT64_MAX, &requests, NULL);
    if (result == SLUICE_SUCCESS)
        result = sluiceProcessDemandProxies(loader, resource, set);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceProxyListInfo nearest = {.structSize = sizeof nearest,
                                         .order = SLUICE_PROXY_ORDER_DISTANCE,
                                         .point = {eye[0], eye[1], eye[2]}};
    SluiceProxyId ids[MOST_AT_ONCE];
    uint32_t count = MOST_AT_ONCE;
    result = sluiceGetRequestedProxies(set, &nearest, &count, ids);
    for (uint32_t i = 0; i < count && has_time(); i++) {
        build_geometry((uint32_t)ids[i]);
        sluiceRemoveProxy(set, ids[i]);
    }
    return result < 0 ? result : sluiceClearProxyRequests(set, SLUICE_ALL_PROXIES);
}
