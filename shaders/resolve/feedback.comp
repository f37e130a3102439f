/* Packs the feedback of one texture to a byte per region, four to a word, and clears it. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/resolve.h"
#include "sluice/shared/texture_table.h"

layout(local_size_x = SLUICE_RESOLVE_GROUP_SIZE) in;
layout(std430, binding = 0) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 1) writeonly buffer Resolved { uint words[]; } resolved;
layout(push_constant) uniform Push { SluiceResolveParams params; };

void main()
{
    uint first = gl_GlobalInvocationID.x * 4u;
    if (first >= params.regionCount)
        return;
    uint bytes = 0u;
    for (uint i = 0u; i < 4u; i++) {
        uint level = SLUICE_MIP_UNTOUCHED;
        if (first + i < params.regionCount) {
            uint at = params.feedbackOffset + first + i;
            level = feedback.words[at];
            if (level != SLUICE_MIP_UNTOUCHED)
                feedback.words[at] = SLUICE_MIP_UNTOUCHED;
        }
        bytes |= min(level, SLUICE_MIP_UNTOUCHED) << (8u * i);
    }
    resolved.words[params.resolvedOffset + gl_GlobalInvocationID.x] = bytes;
}
