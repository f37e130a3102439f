/* Buffers of the conformance tests, and one sample's feedback. */
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "conform_shared.h"

layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 2) readonly buffer Inputs { ConformInput inputs[]; };
layout(push_constant) uniform Push { uint count; };

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#include "sluice/feedback.glsl"

vec2 inputUv(uint at) { return vec2(inputs[at].uv[0], inputs[at].uv[1]); }
vec2 inputDx(uint at) { return vec2(inputs[at].dx[0], inputs[at].dx[1]); }
vec2 inputDy(uint at) { return vec2(inputs[at].dy[0], inputs[at].dy[1]); }

void writeSample(uint at, vec2 uv, vec2 dx, vec2 dy)
{
    if (inputs[at].mode == CONFORM_LOD)
        sluiceWriteFeedbackLod(inputs[at].tableIndex, uv, inputs[at].lod);
    else if (inputs[at].mode == CONFORM_QUAD)
        for (uint i = 0u; i < 4u; i++)
            sluiceWriteQuadFeedback(inputs[at].tableIndex, uv, dx, dy, inputs[at].lodBias,
                                    inputs[at].maxAnisotropy, uvec2(7u + i, 4u + i / 2u), at);
    else if (inputs[at].mode == CONFORM_TURNS)
        for (uint i = 0u; i < 4u; i++)
            sluiceWriteQuadFeedback(inputs[at].tableIndex, uv, dx, dy, inputs[at].lodBias,
                                    inputs[at].maxAnisotropy, uvec2(at, at / 2u), at * 3u + i);
    else
        sluiceWriteFeedback(inputs[at].tableIndex, uv, dx, dy, inputs[at].lodBias,
                            inputs[at].maxAnisotropy);
}
