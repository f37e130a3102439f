/* Boxes in place of parts that are not built. Include demand.glsl and scene.glsl before. */
#ifndef PBRT_BOX_GLSL
#define PBRT_BOX_GLSL

#include "sluice/proxy.glsl"

layout(std430, set = 1, binding = PBRT_BINDING_BOXES) readonly buffer Boxes
{
    float boxes[]; /* six numbers per box: the least corner, then the most */
};

/** Intersects a box. A ray that begins inside hits it at distance 0. */
bool intersectBox(uint box, vec3 origin, vec3 direction, float far, out float distance,
                  out uint face)
{
    uint at = 6u * box;
    if (!sluiceIntersectProxyBox(vec3(boxes[at], boxes[at + 1u], boxes[at + 2u]),
                                 vec3(boxes[at + 3u], boxes[at + 4u], boxes[at + 5u]), origin,
                                 direction, 0.0, far, distance, face))
        return false;
    /* Request the box if the ray begins inside, because the ray enters it before it hits
     * anything. */
    if (distance == 0.0)
        sluiceRequestGeometryProxy(launch.proxyPage, box);
    return true;
}

/** Shades a box that is the nearest hit, and requests the part that it stands for. */
void meetBox(inout Payload payload, uint box, float distance, uint face)
{
    /* Colors of the faces: -x red, +x yellow, -y green, +y cyan, -z blue, +z magenta. */
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
