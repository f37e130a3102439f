/* Compiles the fragment forms of sample_integer.glsl. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_SET 0
#include "sluice/bindings.glsl"
#include "sluice/sample_integer.glsl"

layout(set = 1, binding = 0) uniform usampler2D names;
layout(set = 1, binding = 1) uniform isampler2D offsets;
layout(location = 0) in vec2 uv;
layout(location = 0) out uvec4 number;

void main()
{
    uint missing, also;
    number = sluiceSampleUint(names, 0u, uv, missing) + uvec4(sluiceSampleInt(offsets, 1u, uv, also));
}
