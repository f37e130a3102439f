/* Samples 64 x 64 texels of one streamed texture, at full detail, and asks for them. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_SET 0
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"

layout(std430, set = 1, binding = 0) buffer Answer { uint missingLevels; vec4 color; } answer;
layout(push_constant) uniform Draw { uint tableIndex; } draw;
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    vec2 size = vec2(4096.0);
    vec2 uv = vec2(0.25, 0.75) + vec2(gl_GlobalInvocationID.xy) / size;
    vec2 dx = vec2(1.0 / size.x, 0.0), dy = vec2(0.0, 1.0 / size.y); /* one pixel is one texel */
    uint missing;
    vec4 color = sluiceSampleGrad(draw.tableIndex, draw.tableIndex, uv, dx, dy, 0.0, 1.0, missing);
    /* Larger pictures select a few pixels first: see stochastic.glsl. */
    sluiceWriteFeedback(draw.tableIndex, uv, dx, dy, 0.0, 1.0);
    atomicMax(answer.missingLevels, missing);
    if (gl_GlobalInvocationID.xy == uvec2(0u))
        answer.color = color;
}
