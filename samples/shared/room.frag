/* Samples a streamed texture and writes feedback for what is visible. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_SET 0
#define SLUICE_PAGED true
#include "sluice/bindings.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"

#include "room.glsl"

layout(set = 1, binding = 0) uniform sampler2D albedo;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    uint missing;
    color = sluiceSample(albedo, draw.tableIndex, uv, 0.0, 1.0, missing);
    sluiceWriteFeedback(draw.tableIndex, uv, dx, dy, 0.0, 1.0);
}
