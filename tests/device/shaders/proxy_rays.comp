/* Casts rays without ray tracing: tests every box for every ray. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "proxy_rays.glsl"

layout(local_size_x = 64) in;

void main()
{
    if (gl_GlobalInvocationID.x >= params.rayCount)
        return;
    ProxyRay ray = rays[gl_GlobalInvocationID.x];
    float nearest = ray.tMax, t;
    ProxyHit hit;
    hit.proxy = PROXY_RAY_MISS;
    uint face;
    for (uint i = 0u; i < params.boxCount; i++) {
        if (!meetBox(i, vectorOf(ray.origin), vectorOf(ray.direction), 0.0, nearest, t, face))
            continue;
        if (params.through != 0u) {
            sluiceRequestMaterialProxy(params.firstMaterial, i);
        } else {
            nearest = t;
            hit = hitOf(t, i, face);
        }
    }
    if (hit.proxy != PROXY_RAY_MISS)
        sluiceRequestGeometryProxy(params.firstGeometry, hit.proxy);
    hits[gl_GlobalInvocationID.x] = hit;
}
