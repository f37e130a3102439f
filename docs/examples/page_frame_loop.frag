#version 450
#extension GL_GOOGLE_include_directive : require
#define SLUICE_SET 0
#include "sluice/bindings.glsl"
#include "sluice/sample.glsl"
#include "sluice/feedback.glsl"
#include "sluice/stochastic.glsl"

layout(set = 1, binding = 0) uniform sampler2D albedo;
layout(push_constant) uniform Draw { uint tableIndex; uint frameSeed; } draw;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;

void main()
{
    uint tableIndex = draw.tableIndex, frameSeed = draw.frameSeed;
    /* 0.0 is the LOD bias, 8.0 the sampler's maxAnisotropy (1.0: none) */
    uint missing;
    vec4 color = sluiceSample(albedo, tableIndex, uv, 0.0, 8.0, missing);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    if (sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, frameSeed, 1.0 / 16.0))
        sluiceWriteQuadFeedback(tableIndex, uv, dx, dy, 0.0, 8.0, uvec2(gl_FragCoord.xy), frameSeed);
    result = color;
}
