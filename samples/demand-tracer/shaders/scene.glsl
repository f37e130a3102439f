/* The scene's buffers, and the surface at a hit: see tracer_shared.h. */
#ifndef TRACER_SCENE_GLSL
#define TRACER_SCENE_GLSL

#include "../tracer_shared.h"
#include "sluice/ray_footprint.glsl"

layout(std430, set = 1, binding = TRACER_BINDING_VERTICES) readonly buffer Vertices
{
    TracerVertex vertices[];
};
layout(std430, set = 1, binding = TRACER_BINDING_INDICES) readonly buffer Indices
{
    uint indices[];
};
layout(std430, set = 1, binding = TRACER_BINDING_INSTANCES) readonly buffer Instances
{
    TracerInstance instances[];
};

/** The nearest surface on a ray. */
struct Surface {
    float distance; /* below 0: no hit */
    SluiceRayCone cone; /* cone at the surface */
    uint flags;         /* flags of the instance */
    bool complete;      /* the texture was resident */
    vec3 albedo;
    float alpha;
    vec3 normal; /* shading normal; faces the ray, length 1 */
    vec3 face;   /* normal of the triangle; faces the ray, length 1 */
};

/** A point on a triangle, and the triangle's uv mapping. */
struct Patch {
    vec3 normal; /* interpolated, length 1 */
    vec2 uv;
    SluiceRayTriangle triangle; /* in meters */
};

vec3 toWorld(TracerInstance i, vec3 p, float w)
{
    return vec3(dot(vec4(i.toWorld[0], i.toWorld[1], i.toWorld[2], i.toWorld[3]), vec4(p, w)),
                dot(vec4(i.toWorld[4], i.toWorld[5], i.toWorld[6], i.toWorld[7]), vec4(p, w)),
                dot(vec4(i.toWorld[8], i.toWorld[9], i.toWorld[10], i.toWorld[11]), vec4(p, w)));
}

vec3 toObject(TracerInstance i, vec3 p, float w)
{
    return vec3(dot(vec4(i.toObject[0], i.toObject[1], i.toObject[2], i.toObject[3]), vec4(p, w)),
                dot(vec4(i.toObject[4], i.toObject[5], i.toObject[6], i.toObject[7]), vec4(p, w)),
                dot(vec4(i.toObject[8], i.toObject[9], i.toObject[10], i.toObject[11]), vec4(p, w)));
}

/** Transforms by the transposed inverse. */
vec3 normalToWorld(TracerInstance i, vec3 n)
{
    return normalize(vec3(i.toObject[0] * n.x + i.toObject[4] * n.y + i.toObject[8] * n.z,
                          i.toObject[1] * n.x + i.toObject[5] * n.y + i.toObject[9] * n.z,
                          i.toObject[2] * n.x + i.toObject[6] * n.y + i.toObject[10] * n.z));
}

vec3 vertexPosition(uint v)
{
    return vec3(vertices[v].position[0], vertices[v].position[1], vertices[v].position[2]);
}

vec3 vertexNormal(uint v)
{
    return vec3(vertices[v].normal[0], vertices[v].normal[1], vertices[v].normal[2]);
}

vec2 vertexUv(uint v)
{
    return vec2(vertices[v].uv[0], vertices[v].uv[1]);
}

/** Evaluates a triangle at the weights of its second and third corner. */
Patch patchAt(TracerInstance instance, uint triangle, vec2 weights)
{
    uint first = instance.firstIndex + 3u * triangle;
    uvec3 corner = uvec3(indices[first], indices[first + 1u], indices[first + 2u]);
    vec3 origin = vertexPosition(corner.x);
    vec2 uv = vertexUv(corner.x);
    Patch p;
    p.triangle = sluiceFindRayTriangle(vec3(0.0),
                                       toWorld(instance, vertexPosition(corner.y) - origin, 0.0),
                                       toWorld(instance, vertexPosition(corner.z) - origin, 0.0),
                                       uv, vertexUv(corner.y), vertexUv(corner.z));
    p.uv = uv + weights.x * p.triangle.uv1 + weights.y * p.triangle.uv2;
    p.normal = normalToWorld(instance, vertexNormal(corner.x) * (1.0 - weights.x - weights.y) +
                                           vertexNormal(corner.y) * weights.x +
                                           vertexNormal(corner.z) * weights.y);
    return p;
}

/** Samples the texture. Sets `complete` to false if it is not resident. */
vec4 patchColor(TracerInstance instance, Patch p, vec3 direction, SluiceRayCone cone,
                inout bool complete)
{
    vec2 dx, dy;
    sluiceConeGradients(p.triangle, cone, direction, dx, dy);
    bool resident;
    vec4 color = sluiceDemandGrad(instance.texture, p.uv, dx, dy, resident);
    complete = complete && resident;
    uint components = bitfieldExtract(SLUICE_DEMAND_TEXTURE(instance.texture).shape,
                                      SLUICE_DEMAND_COMPONENTS_SHIFT, 3);
    return components == 1u ? vec4(color.rrr, color.a) : color;
}

/** Returns whether the ray passes through a hole of the texture. A texture that is not resident has
 * no holes. */
bool isHole(uint instanceIndex, uint triangle, vec2 weights, vec3 direction, SluiceRayCone cone,
            inout bool complete)
{
    TracerInstance instance = instances[instanceIndex];
    bool resident = true;
    float alpha =
        patchColor(instance, patchAt(instance, triangle, weights), direction, cone, resident).a;
    complete = complete && resident;
    return alpha < 0.5 && (resident || preview);
}

Surface surfaceAt(uint instanceIndex, uint triangle, vec2 weights, vec3 direction, float distance,
                  SluiceRayCone cone)
{
    TracerInstance instance = instances[instanceIndex];
    Patch p = patchAt(instance, triangle, weights);
    Surface s;
    s.distance = distance;
    s.cone = sluicePropagateCone(cone, distance);
    s.flags = instance.flags;
    s.complete = true;
    vec4 color = patchColor(instance, p, direction, s.cone, s.complete);
    /* files may hold anything */
    s.albedo = any(isnan(color.rgb)) ? vec3(0.0) : clamp(color.rgb, 0.0, 1.0);
    s.alpha = color.a;
    s.face = dot(p.triangle.normal, direction) > 0.0 ? -p.triangle.normal : p.triangle.normal;
    s.normal = dot(p.normal, s.face) < 0.0 ? -p.normal : p.normal;
    return s;
}

#endif
