/*
 * Finds the texels that the sampler itself reads. Each channel of each layer is non-zero in one
 * tile of one level only, so a non-zero channel identifies a touched tile.
 */
#extension GL_GOOGLE_include_directive : require

#include "conform_shared.h"
#include "truth_shared.h"

layout(std430, binding = 0) readonly buffer Inputs { ConformInput inputs[]; };
layout(std430, binding = 1) writeonly buffer Touched { uint touched[]; };
layout(binding = 2) uniform sampler2DArray tex;
layout(push_constant) uniform Push { TruthParams params; };

void addTexel(inout uint words[TRUTH_WORDS], uint layer, vec4 texel)
{
    for (uint i = 0u; i < 4u; i++)
        if (texel[i] > 0.0)
            words[layer / 8u] |= 1u << (layer % 8u * 4u + i);
}

void writeWords(uint at, uint words[TRUTH_WORDS])
{
    for (uint i = 0u; i < TRUTH_WORDS; i++)
        touched[at * TRUTH_WORDS + i] = words[i];
}
