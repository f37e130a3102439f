/* Lines that proxies.md shows: the nearest proxy is requested, and shaded as a box. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/demand_bindings.glsl"
#include "sluice/proxy.glsl"

layout(push_constant) uniform Push
{
    uint firstPage;
};
layout(location = 0) rayPayloadInEXT vec3 color;

void main()
{
    sluiceRequestGeometryProxy(firstPage, uint(gl_PrimitiveID));
    vec3 normal = sluiceProxyFaceNormal(gl_HitKindEXT);
    color = 0.5 + 0.5 * normal;
}
