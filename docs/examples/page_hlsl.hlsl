/* Compiled by glslang, whose HLSL has no non-uniform indices: see docs/hlsl.md. */
#define SLUICE_NON_UNIFORM(i) i
#define SLUICE_PAGE_LOOP 64
#define SLUICE_TEXTURE_COUNT 1024

#define SLUICE_FRAGMENT_SHADER
#define SLUICE_SET 0
#define SLUICE_PAGED true
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/sample.glsl"
#include "sluice/feedback.glsl"
#include "sluice/stochastic.glsl"

float4 main(float4 position : SV_Position, float2 uv : TEXCOORD0, nointerpolation uint tableIndex : TEXCOORD1,
            nointerpolation uint frame : TEXCOORD2) : SV_Target0
{
    uint missing;
    float2 dx = ddx(uv), dy = ddy(uv);
    float4 color = sluiceSample(tableIndex, tableIndex, uv, 0.0, 8.0, missing);
    if (sluiceSelectRandomFragmentQuad(position.xy, frame, 1.0 / 16.0))
        sluiceWriteQuadFeedback(tableIndex, uv, dx, dy, 0.0, 8.0, uint2(position.xy), frame);
    return color;
}
