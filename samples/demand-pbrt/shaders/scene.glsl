/* The tables of the scene: see pbrt_shared.h. */
#ifndef PBRT_SCENE_GLSL
#define PBRT_SCENE_GLSL

#include "../pbrt_shared.h"

layout(push_constant) uniform Launch
{
    PbrtLaunch launch;
};
layout(std430, set = 1, binding = PBRT_BINDING_MESHES) readonly buffer Meshes
{
    PbrtMesh meshes[];
};
layout(std430, set = 1, binding = PBRT_BINDING_PLACES) readonly buffer Places
{
    PbrtPlace places[];
};
layout(std430, set = 1, binding = PBRT_BINDING_SURFACES) readonly buffer Surfaces
{
    PbrtSurface surfaces[];
};
layout(std430, set = 1, binding = PBRT_BINDING_OPS) readonly buffer Ops
{
    PbrtOp ops[];
};
layout(std430, set = 1, binding = PBRT_BINDING_LIGHTS) readonly buffer Lights
{
    PbrtLight lights[];
};
layout(std430, set = 1, binding = PBRT_BINDING_EMITTERS) readonly buffer Emitters
{
    PbrtEmitter emitters[];
};
layout(std430, set = 1, binding = PBRT_BINDING_WANTED) buffer Wanted
{
    uint wanted[]; /* by surface: 1 + log2 of the requested texels per unit of uv */
};
layout(std430, set = 1, binding = PBRT_BINDING_USED) writeonly buffer Used
{
    uint used[]; /* by place: the last launch that hit it */
};

layout(std430, set = 1, binding = PBRT_BINDING_PROBES) writeonly buffer Probes
{
    PbrtProbe probes[]; /* probe of each pixel; absent unless `preview` is set */
};

/** The words of a mesh. */
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words
{
    uint at[];
};

vec3 toVector(float v[3])
{
    return vec3(v[0], v[1], v[2]);
}

vec3 readVector(Words words, uint at)
{
    return uintBitsToFloat(uvec3(words.at[at], words.at[at + 1u], words.at[at + 2u]));
}

vec2 readPair(Words words, uint at)
{
    return uintBitsToFloat(uvec2(words.at[at], words.at[at + 1u]));
}

/** Input and output of a ray that meets a surface. */
struct Payload {
    /* Input: */
    float coneWidth, coneSpread;
    bool isShadow; /* true: only whether something is hit matters */
    /* Output: */
    float distance; /* below 0: no hit */
    bool missing;   /* something is not resident yet */
    vec3 normal;    /* shading normal, length 1 */
    vec3 face;      /* geometric normal, length 1 */
    vec3 diffuse, specular, transmission;
    vec3 emission; /* toward the ray's origin */
    float density; /* sampled points per area of an emitter; 0: its points are never sampled */
    uint kind;     /* kind of the surface */
    float roughness, eta;
    uint place;
    uint triangle; /* input: pixel whose probe the surface writes, or PBRT_NONE */
};

/** Color of surfaces whose material is requested but not made yet. */
#define PROXY_MATERIAL_COLOR vec3(0.8, 0.8, 0.1)

#endif
