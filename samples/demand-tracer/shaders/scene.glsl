/* The scene's buffers, and what a ray sees where it hits them: see tracer_shared.h. */
#ifndef TRACER_SCENE_GLSL
#define TRACER_SCENE_GLSL

#include "../tracer_shared.h"

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

/** A cone around a ray: what a pixel covers. */
struct Cone {
    float width;  /* meters, where the ray begins */
    float spread; /* radians */
};

/** What a ray met first. */
struct Surface {
    float distance; /* below 0: nothing */
    float coneWidth;
    uint flags;     /* of the instance */
    bool complete;  /* the texture was resident */
    vec3 albedo;
    float alpha;
    vec3 normal; /* both on the ray's side, of length 1 */
    vec3 face;   /* of the triangle */
};

/** A place on a triangle, and how uv lies over it. */
struct Patch {
    vec3 normal, face; /* of length 1, as the triangle has them */
    vec2 uv;
    vec3 edge1, edge2; /* meters */
    vec2 uv1, uv2;     /* along the edges */
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

/** By the transposed inverse. */
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

/** At `weights`, of the triangle's second and third corner. */
Patch patchAt(TracerInstance instance, uint triangle, vec2 weights)
{
    uint first = instance.firstIndex + 3u * triangle;
    uvec3 corner = uvec3(indices[first], indices[first + 1u], indices[first + 2u]);
    vec3 origin = vertexPosition(corner.x);
    vec2 uv = vertexUv(corner.x);
    Patch p;
    p.edge1 = toWorld(instance, vertexPosition(corner.y) - origin, 0.0);
    p.edge2 = toWorld(instance, vertexPosition(corner.z) - origin, 0.0);
    p.uv1 = vertexUv(corner.y) - uv;
    p.uv2 = vertexUv(corner.z) - uv;
    p.uv = uv + weights.x * p.uv1 + weights.y * p.uv2;
    p.face = normalize(cross(p.edge1, p.edge2));
    p.normal = normalToWorld(instance, vertexNormal(corner.x) * (1.0 - weights.x - weights.y) +
                                           vertexNormal(corner.y) * weights.x +
                                           vertexNormal(corner.z) * weights.y);
    return p;
}

/** How uv changes along a step across the triangle's plane. */
vec2 uvAlong(Patch p, vec3 along)
{
    float area = dot(p.face, cross(p.edge1, p.edge2));
    return (dot(p.face, cross(along, p.edge2)) * p.uv1 +
            dot(p.face, cross(p.edge1, along)) * p.uv2) / area;
}

/**
 * The axes, in uv, of the ellipse that a cone of `width` meters around `direction` cuts out of the
 * triangle's plane. Akenine-Moeller et al., "Improved Shader and Texture Level of Detail Using Ray
 * Cones", JCGT 10(1), 2021.
 */
void footprint(Patch p, vec3 direction, float width, out vec2 dx, out vec2 dy)
{
    vec3 a = direction - dot(p.face, direction) * p.face;
    if (dot(a, a) < 1.0e-8) /* straight on: any axis does */
        a = p.edge1;
    vec3 b = cross(p.face, a);
    a *= width / max(length(a - dot(direction, a) * direction), 1.0e-4 * length(a));
    b *= width / max(length(b - dot(direction, b) * direction), 1.0e-4 * length(b));
    dx = uvAlong(p, a);
    dy = uvAlong(p, b);
}

/** `complete` becomes false where the texture is not resident. */
vec4 patchColor(TracerInstance instance, Patch p, vec3 direction, float width,
                inout bool complete)
{
    vec2 dx, dy;
    footprint(p, direction, width, dx, dy);
    bool resident;
    vec4 color = sluiceDemandGrad(instance.texture, p.uv, dx, dy, resident);
    complete = complete && resident;
    uint components = bitfieldExtract(SLUICE_DEMAND_TEXTURE(instance.texture).shape,
                                      SLUICE_DEMAND_COMPONENTS_SHIFT, 3);
    return components == 1u ? vec4(color.rrr, color.a) : color;
}

/** Whether a ray goes on through a hole of the texture. What is not resident has no holes yet. */
bool isHole(uint instanceIndex, uint triangle, vec2 weights, vec3 direction, float width,
            inout bool complete)
{
    TracerInstance instance = instances[instanceIndex];
    bool resident = true;
    float alpha =
        patchColor(instance, patchAt(instance, triangle, weights), direction, width, resident).a;
    complete = complete && resident;
    return alpha < 0.5 && (resident || preview);
}

Surface surfaceAt(uint instanceIndex, uint triangle, vec2 weights, vec3 direction, float distance,
                  Cone cone)
{
    TracerInstance instance = instances[instanceIndex];
    Patch p = patchAt(instance, triangle, weights);
    Surface s;
    s.distance = distance;
    s.coneWidth = cone.width + cone.spread * distance;
    s.flags = instance.flags;
    s.complete = true;
    vec4 color = patchColor(instance, p, direction, s.coneWidth, s.complete);
    /* files may hold anything */
    s.albedo = any(isnan(color.rgb)) ? vec3(0.0) : clamp(color.rgb, 0.0, 1.0);
    s.alpha = color.a;
    s.face = dot(p.face, direction) > 0.0 ? -p.face : p.face;
    s.normal = dot(p.normal, s.face) < 0.0 ? -p.normal : p.normal;
    return s;
}

#endif
