/* Rays through the boxes of a set of proxies. Shared by the programs of proxy_rays.*. */
#include "sluice/demand_bindings.glsl"
#include "sluice/proxy.glsl"

#include "proxy_rays_shared.h"

layout(std430, set = 1, binding = 0) readonly buffer Boxes
{
    float boxes[]; /* six for each */
};
layout(std430, set = 1, binding = 1) readonly buffer Rays
{
    ProxyRay rays[];
};
layout(std430, set = 1, binding = 2) buffer Hits
{
    ProxyHit hits[];
};
layout(push_constant) uniform Params
{
    ProxyRayParams params;
};

vec3 vectorOf(float v[3])
{
    return vec3(v[0], v[1], v[2]);
}

bool meetBox(uint index, vec3 origin, vec3 direction, float tMin, float tMax, out float t, out uint face)
{
    uint at = 6u * index;
    return sluiceIntersectProxyBox(vec3(boxes[at], boxes[at + 1u], boxes[at + 2u]),
                                   vec3(boxes[at + 3u], boxes[at + 4u], boxes[at + 5u]), origin, direction, tMin, tMax,
                                   t, face);
}

ProxyHit hitOf(float t, uint proxy, uint face)
{
    vec3 normal = sluiceProxyFaceNormal(face);
    return ProxyHit(t, proxy, face, float[3](normal.x, normal.y, normal.z));
}
