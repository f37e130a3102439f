/* The lines that docs/sampling.md shows, compiled as they are there. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_SET 2
#define SLUICE_DEMAND_CUBIC true
#include "sluice/bindings.glsl"
#include "sluice/sample_stochastic.glsl"
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"
#include "sluice/demand_jitter.glsl"
#include "sluice/ray_footprint.glsl"

layout(std430, set = 1, binding = 0) buffer Answer { vec4 colors[]; } answer;
layout(push_constant) uniform Draw { uint index; } draw;
layout(set = 1, binding = 1) uniform sampler2D tex;
layout(local_size_x = 8, local_size_y = 8) in;

vec3 bumpNormal(uint index, vec2 uv, vec2 dx, vec2 dy, float height, vec3 tangent, vec3 bitangent, vec3 normal)
{
    vec4 du, dv;
    bool resident;
    vec4 color = sluiceDemandDerivatives(index, uv, dx, dy, du, dv, resident);
    /* tangent and bitangent: the change of position per unit of u and v */
    vec3 alongU = tangent + height * du.r * normal, alongV = bitangent + height * dv.r * normal;
    return normalize(cross(alongU, alongV));
}

vec4 hitJittered(uint index, vec2 at, vec2 dx, vec2 dy, vec2 random)
{
    bool resident;
    vec2 jittered = sluiceDemandJitter(index, at, dx, dy, SLUICE_JITTER_TENT, random);
    vec4 color = sluiceDemandGrad(index, jittered, dx, dy, resident);
    return color;
}

vec4 sampleStochastic(uint tableIndex, uvec2 pixel, uint frame, vec2 uv, float lod)
{
    uint missing;
    vec2 random = sluiceRandomPair(uvec3(pixel, frame));
    vec4 color = sluiceSampleStochastic(tex, tableIndex, uv, lod, SLUICE_PICK_CUBIC, 0.0, true, random, missing);
    return color;
}

vec4 hitWithCone(uint index, inout SluiceRayCone cone, vec3 p[3], vec3 n[3], vec2 uv[3], vec2 at, vec3 direction,
                 float distance, vec3 normal)
{
    vec2 dx, dy;
    bool resident;
    SluiceRayTriangle t = sluiceFindRayTriangle(p[0], p[1], p[2], uv[0], uv[1], uv[2]);
    cone = sluicePropagateCone(cone, distance);
    sluiceConeGradients(t, cone, direction, dx, dy);
    vec4 color = sluiceDemandGrad(index, at, dx, dy, resident);
    float curvature = sluiceTriangleCurvature(p[0], p[1], p[2], n[0], n[1], n[2]);
    cone = sluiceReflectCone(cone, direction, normal, curvature);
    return color;
}

vec4 hitWithDifferential(uint index, inout SluiceRayDifferential ray, SluiceRayTriangle t, vec3 n[3], vec2 weights,
                         vec2 at, vec3 direction, float distance, vec3 normal)
{
    vec2 dx, dy;
    bool resident;
    ray = sluiceTransferDifferential(ray, direction, distance, t.normal);
    sluiceDifferentialGradients(t, ray, dx, dy);
    vec3 normalX = sluiceNormalAlong(t, n[0], n[1], n[2], weights, ray.positionX);
    vec3 normalY = sluiceNormalAlong(t, n[0], n[1], n[2], weights, ray.positionY);
    ray = sluiceReflectDifferential(ray, direction, normal, normalX, normalY);
    return sluiceDemandGrad(index, at, dx, dy, resident);
}

void main()
{
    vec3 normal = bumpNormal(draw.index, vec2(0.5), vec2(0.01, 0.0), vec2(0.0, 0.01), 0.1, vec3(1.0, 0.0, 0.0),
                             vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
    answer.colors[0] = vec4(normal, 1.0);
    vec3 p[3] = vec3[](vec3(1.0, 0.0, 0.0), vec3(1.0, 1.0, 0.0), vec3(1.0, 0.0, 1.0));
    vec3 n[3] = vec3[](vec3(-1.0, 0.0, 0.0), vec3(-1.0, 0.0, 0.0), vec3(-1.0, 0.0, 0.0));
    vec2 uv[3] = vec2[](vec2(0.0), vec2(1.0, 0.0), vec2(0.0, 1.0));
    vec3 direction = vec3(1.0, 0.0, 0.0);
    SluiceRayCone cone = SluiceRayCone(0.0, sluicePixelSpread(1.0, 1080.0));
    answer.colors[1] = hitWithCone(draw.index, cone, p, n, uv, vec2(0.5), direction, 1.0, n[0]);
    SluiceRayDifferential ray = sluiceCameraDifferential(direction, vec3(0.0, 0.001, 0.0), vec3(0.0, 0.0, 0.001));
    answer.colors[3] = hitJittered(draw.index, uv[0], vec2(0.01, 0.0), vec2(0.0, 0.01), vec2(0.25));
    answer.colors[4] = sampleStochastic(draw.index, gl_GlobalInvocationID.xy, 1u, vec2(0.5), 1.5);
    SluiceRayTriangle t = sluiceFindRayTriangle(p[0], p[1], p[2], uv[0], uv[1], uv[2]);
    answer.colors[2] = hitWithDifferential(draw.index, ray, t, n, vec2(0.0), uv[0], direction, 1.0, n[0]);
}
