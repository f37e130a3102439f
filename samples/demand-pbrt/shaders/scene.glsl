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
    uint wanted[]; /* of each surface that is asked for: 1 + log2 of texels per unit of uv */
};
layout(std430, set = 1, binding = PBRT_BINDING_USED) writeonly buffer Used
{
    uint used[]; /* of each place: the last launch that hit it */
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

/** What a ray tells the surfaces that it meets, and what they tell it. */
struct Payload {
    /* In: */
    float coneWidth, coneSpread;
    bool isShadow; /* only whether there is something matters */
    /* Out: */
    float distance; /* below 0: nothing */
    bool missing;   /* something is not there yet */
    vec3 normal;    /* for shading, of length 1 */
    vec3 face;      /* geometric, of length 1 */
    vec3 diffuse, specular, transmission;
    vec3 emission; /* toward the ray's origin */
    float density; /* of chosen points per area, where it emits; 0: its points are never chosen */
    uint kind;     /* of the surface */
    float roughness, eta;
    uint place, triangle; /* for --debug */
};

/** Of places that were asked for and are not there yet. */
#define PROXY_MATERIAL_COLOR vec3(0.8, 0.8, 0.1)

#endif
