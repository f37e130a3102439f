/* Samples a streamed texture and writes feedback for what is visible. One source for all residency
 * modes. */
#version 450
#extension GL_GOOGLE_include_directive : require

layout(constant_id = 0) const bool paged = false;
#define SLUICE_PAGED paged
#define SLUICE_SET 0
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"

layout(push_constant) uniform Draw { uint surface, tableIndex, frame; float aspect, eyeZ; } draw;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv); /* before the branch: derivatives need the whole quad */
    uint missing;
    color = sluiceSample(draw.tableIndex, draw.tableIndex, uv, 0.0, 1.0, missing);
    if (sluiceSelectFragmentLattice(gl_FragCoord.xy, draw.frame))
        sluiceWriteFeedback(draw.tableIndex, uv, dx, dy, 0.0, 1.0);
}
