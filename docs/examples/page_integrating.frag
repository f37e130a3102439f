#version 450
#extension GL_GOOGLE_include_directive : require
layout(constant_id = 0) const bool paged = false;
#define SLUICE_SET 0
#define SLUICE_PAGED paged
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/sample.glsl"
#include "sluice/feedback.glsl"
#include "sluice/stochastic.glsl"

layout(push_constant) uniform Material { uint color, normal, roughness, frame; } material;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 shaded;

void main()
{
    uint missing;
    vec4 color = sluiceSample(material.color, material.color, uv, 0.0, 8.0, missing);
    vec4 normal = sluiceSample(material.normal, material.normal, uv, 0.0, 8.0, missing);
    vec4 roughness = sluiceSample(material.roughness, material.roughness, uv, 0.0, 8.0, missing);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    if (sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, material.frame, 1.0 / 16.0))
        sluiceWriteQuadFeedback(material.color, uv, dx, dy, 0.0, 8.0, uvec2(gl_FragCoord.xy), material.frame);
    shaded = color * (0.5 + 0.5 * normal.z) * (1.0 - 0.5 * roughness.x);
}
