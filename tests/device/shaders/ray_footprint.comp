/* Follows cones and differentials along paths that the caller describes. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/ray_footprint.glsl"
#include "ray_footprint_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Calls { RayCall calls[]; };
layout(push_constant) uniform Push { uint count; };

vec3 toVec3(float v[3]) { return vec3(v[0], v[1], v[2]); }
vec3 nineth(float v[9], uint i) { return vec3(v[3u * i], v[3u * i + 1u], v[3u * i + 2u]); }

float distanceTo(RaySurface s, vec3 origin, vec3 direction)
{
    if (s.radius == 0.0)
        return (s.offset - dot(toVec3(s.center), origin)) / dot(toVec3(s.center), direction);
    vec3 o = origin - toVec3(s.center);
    float b = dot(o, direction), root = sqrt(max(b * b - dot(o, o) + s.radius * s.radius, 0.0));
    return s.far != 0u ? root - b : -root - b;
}

/* Moves the ray to the surface, and continues it in its new direction. */
void meet(RaySurface s, inout vec3 at, inout vec3 direction, inout SluiceRayCone cone,
          inout SluiceRayDifferential ray)
{
    float distance = distanceTo(s, at, direction);
    at += distance * direction;
    bool plane = s.radius == 0.0;
    vec3 normal = plane ? toVec3(s.center) : (at - toVec3(s.center)) / s.radius;
    float side = dot(normal, direction) > 0.0 ? -1.0 : 1.0;
    normal *= side;
    float curvature = plane ? 0.0 : side / s.radius;
    cone = sluicePropagateCone(cone, distance);
    ray = sluiceTransferDifferential(ray, direction, distance, normal);
    vec3 normalX = ray.positionX * curvature, normalY = ray.positionY * curvature;
    if (s.event == RAY_EVENT_REFLECT) {
        cone = sluiceReflectCone(cone, direction, normal, curvature);
        ray = sluiceReflectDifferential(ray, direction, normal, normalX, normalY);
        direction = reflect(direction, normal);
    } else {
        vec3 refracted = refract(direction, normal, s.eta);
        cone = sluiceRefractCone(cone, direction, normal, s.eta, curvature);
        ray = sluiceRefractDifferential(ray, direction, normal, normalX, normalY, s.eta);
        direction = refracted == vec3(0.0) ? reflect(direction, normal) : refracted;
    }
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    RayCall call = calls[i];
    vec3 p0 = nineth(call.positions, 0u), p1 = nineth(call.positions, 1u), p2 = nineth(call.positions, 2u);
    vec3 n0 = nineth(call.normals, 0u), n1 = nineth(call.normals, 1u), n2 = nineth(call.normals, 2u);
    SluiceRayTriangle triangle =
        sluiceFindRayTriangle(p0, p1, p2, vec2(call.uvs[0], call.uvs[1]), vec2(call.uvs[2], call.uvs[3]),
                              vec2(call.uvs[4], call.uvs[5]));
    if (call.function == RAY_NORMAL) {
        vec3 change = sluiceNormalAlong(triangle, n0, n1, n2, vec2(call.weights[0], call.weights[1]),
                                        toVec3(call.step));
        for (uint k = 0u; k < 3u; k++)
            calls[i].normalChange[k] = change[k];
        calls[i].curvature = sluiceTriangleCurvature(p0, p1, p2, n0, n1, n2);
        return;
    }
    vec3 at = toVec3(call.origin), direction = normalize(toVec3(call.toward));
    SluiceRayCone cone = SluiceRayCone(0.0, call.pixelSpread);
    SluiceRayDifferential ray =
        sluiceCameraDifferential(toVec3(call.toward), toVec3(call.right), toVec3(call.down));
    for (uint k = 0u; k < RAY_SURFACES; k++)
        if (call.surfaces[k].event != RAY_EVENT_NONE)
            meet(call.surfaces[k], at, direction, cone, ray);
    float distance = dot(triangle.normal, p0 - at) / dot(triangle.normal, direction);
    cone = sluicePropagateCone(cone, distance);
    ray = sluiceTransferDifferential(ray, direction, distance, triangle.normal);
    vec2 dx, dy, size = vec2(call.size[0], call.size[1]);
    sluiceConeGradients(triangle, cone, direction, dx, dy);
    calls[i].coneGradientLod = sluiceGradientLod(dx, dy, size);
    calls[i].coneLod = sluiceConeLod(triangle, cone, direction, size);
    for (uint k = 0u; k < 2u; k++) {
        calls[i].cone[k] = dx[k];
        calls[i].cone[2u + k] = dy[k];
    }
    sluiceDifferentialGradients(triangle, ray, dx, dy);
    for (uint k = 0u; k < 2u; k++) {
        calls[i].differential[k] = dx[k];
        calls[i].differential[2u + k] = dy[k];
    }
}
