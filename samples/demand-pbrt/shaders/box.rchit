/* A box is the nearest hit: asks for what it stands for. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

#include "demand.glsl"
#include "scene.glsl"
#include "sluice/proxy.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;

void main()
{
    /* -x red, +x yellow, -y green, +y cyan, -z blue, +z magenta */
    const vec3 colors[6] = vec3[6](vec3(0.8, 0.1, 0.1), vec3(0.8, 0.8, 0.1), vec3(0.1, 0.7, 0.1),
                                   vec3(0.1, 0.8, 0.8), vec3(0.1, 0.1, 0.8), vec3(0.8, 0.1, 0.8));
    sluiceRequestGeometryProxy(launch.proxyPage, gl_PrimitiveID);
    payload.distance = gl_HitTEXT;
    payload.missing = true;
    payload.normal = payload.face = sluiceProxyFaceNormal(gl_HitKindEXT);
    payload.diffuse = colors[gl_HitKindEXT];
    payload.specular = payload.transmission = payload.emission = vec3(0.0);
    payload.density = 0.0;
    payload.kind = 0u;
    payload.place = gl_PrimitiveID;
    payload.triangle = PBRT_NONE;
}
