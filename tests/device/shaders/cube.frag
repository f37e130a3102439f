/* Compiles the fragment forms of sample_cube.glsl, and feedback that the pixels of a quad share. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

layout(set = 1, binding = 0) uniform samplerCube tex;
layout(set = 1, binding = 1) uniform samplerCubeArray texs;
layout(set = 1, binding = 2) uniform samplerCube cubes[];
layout(location = 0) in vec3 direction;
layout(location = 0) out vec4 color;

#define SLUICE_SET 0
#define SLUICE_CUBE_TEXTURE(i) cubes[nonuniformEXT(i)]
#include "sluice/bindings.glsl"
#include "sluice/feedback_cube.glsl"
#include "sluice/sample_cube.glsl"
#include "sluice/stochastic.glsl"

void main()
{
    uint missing, also, too;
    color = sluiceSampleCube(tex, 0u, direction, 0.0, 8.0, missing) +
            sluiceSampleCube(texs, 2u, 6u, direction, 0.0, 1.0, also) +
            sluiceSampleCube(3u, 12u, direction, 0.0, 1.0, too);
    vec3 dx = dFdx(direction), dy = dFdy(direction);
    if (sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, missing, 1.0 / 16.0))
        sluiceWriteCubeQuadFeedback(0u, direction, dx, dy, 0.0, 8.0, uvec2(gl_FragCoord.xy), missing);
}
