/* Samples integer textures and writes their feedback. INTEGER_SIGNED: of SINT formats. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "probe_shared.h"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { ProbeParams params; };
layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 3) readonly buffer Inputs { ProbeInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { ProbeOutput outputs[]; };
#ifdef INTEGER_SIGNED
layout(binding = 5) uniform isampler2D tex;
#define SAMPLE sluiceSampleIntGrad
#else
layout(binding = 5) uniform usampler2D tex;
#define SAMPLE sluiceSampleUintGrad
#endif

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#include "sluice/feedback.glsl"
#include "sluice/sample_integer.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    uint at = params.first + gl_GlobalInvocationID.x, missing;
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    vec2 dx = vec2(inputs[at].dx[0], inputs[at].dx[1]), dy = vec2(inputs[at].dy[0], inputs[at].dy[1]);
    uvec4 number = uvec4(SAMPLE(tex, params.tableIndex, uv, dx, dy, missing));
    SluiceSampling s = sluiceResolveSampling(params.tableIndex, uv, dx, dy, 0.0, 1.0);
    for (uint i = 0u; i < 4u; i++)
        outputs[at].footprint[i] = number[i];
    outputs[at].missingLevels = missing;
    outputs[at].level = uint(sluiceNearestLevel(params.tableIndex, s));
    outputs[at].wantedLevel = s.wantedLevel;
    outputs[at].lod = s.lod;
    if ((params.flags & PROBE_FEEDBACK) != 0u)
        sluiceWriteFeedback(params.tableIndex, uv, dx, dy, 0.0, 1.0);
}
