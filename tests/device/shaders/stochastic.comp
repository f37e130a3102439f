/* Draws texels with stochastic_filter.glsl: `draws` for each call. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/stochastic_filter.glsl"
#include "stochastic_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Calls { StochasticCall calls[]; };
layout(std430, binding = 1) writeonly buffer Picks { StochasticPick picks[]; };
layout(push_constant) uniform Push { uint count, draws; };

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= count)
        return;
    StochasticCall call = calls[at / draws];
    uint i = at % draws;
    vec2 random = vec2(call.random[0], call.random[1]);
    if (call.seed != 0u)
        random = sluiceRandomPair(uvec3(i, 0u, call.seed));
    else if (call.grid != 0u)
        random[call.axis] = (float(i % call.grid) + 0.5) / float(call.grid);
    SluicePick pick = sluicePickTexel(vec2(call.uv[0], call.uv[1]), call.lod, uvec2(call.width, call.height),
                                      call.levelCount, uvec2(call.modeU, call.modeV), call.kernel, call.sigma,
                                      random);
    for (uint k = 0u; k < 2u; k++) {
        picks[at].texel[k] = pick.texel[k];
        picks[at].random[k] = random[k];
    }
    picks[at].level = pick.level;
    picks[at].border = pick.border ? 1u : 0u;
}
