/* Boxes that stand for what is not built. Include demand.glsl and scene.glsl before. */
#ifndef PBRT_BOX_GLSL
#define PBRT_BOX_GLSL

#include "sluice/proxy.glsl"

layout(std430, set = 1, binding = PBRT_BINDING_BOXES) readonly buffer Boxes
{
    float boxes[]; /* six of each: the least corner, the most */
};

/** A ray that begins in a box hits it there. */
bool intersectBox(uint box, vec3 origin, vec3 direction, float far, out float distance,
                  out uint face)
{
    uint at = 6u * box;
    if (!sluiceIntersectProxyBox(vec3(boxes[at], boxes[at + 1u], boxes[at + 2u]),
                                 vec3(boxes[at + 3u], boxes[at + 4u], boxes[at + 5u]), origin,
                                 direction, 0.0, far, distance, face))
        return false;
    /* Whatever a ray hits that begins in a box, it has entered the box before. */
    if (distance == 0.0)
        sluiceRequestGeometryProxy(launch.proxyPage, box);
    return true;
}

/** The nearest hit is a box: asks for what it stands for. */
void meetBox(inout Payload payload, uint box, float distance, uint face)
{
    /* -x red, +x yellow, -y green, +y cyan, -z blue, +z magenta */
    const vec3 colors[6] = vec3[6](vec3(0.8, 0.1, 0.1), vec3(0.8, 0.8, 0.1), vec3(0.1, 0.7, 0.1),
                                   vec3(0.1, 0.8, 0.8), vec3(0.1, 0.1, 0.8), vec3(0.8, 0.1, 0.8));
    sluiceRequestGeometryProxy(launch.proxyPage, box);
    payload.distance = distance;
    payload.missing = true;
    payload.normal = payload.face = sluiceProxyFaceNormal(face);
    payload.diffuse = (launch.flags & PBRT_LAUNCH_GRAY) != 0u ? vec3(0.5) : colors[face];
    payload.specular = payload.transmission = payload.emission = vec3(0.0);
    payload.density = 0.0;
    payload.kind = 0u;
    payload.place = box;
    payload.triangle = PBRT_NONE;
}

#endif
