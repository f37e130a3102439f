/* Samples a layer with given derivatives. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "array.glsl"

layout(local_size_x = 64) in;

void main()
{
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    uint at = params.first + gl_GlobalInvocationID.x;
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    vec2 dx = vec2(inputs[at].dx[0], inputs[at].dx[1]);
    vec2 dy = vec2(inputs[at].dy[0], inputs[at].dy[1]);
    float bias = inputs[at].lodBias, anisotropy = inputs[at].maxAnisotropy;
    uint missing, missingOfLayer;
    bool all = (params.flags & PROBE_ALL_LAYERS) != 0u;
    uint layer = all ? at % (params.flags & ~PROBE_ALL_LAYERS) : params.flags;
    uint tableIndex = params.tableIndex + (all ? layer : 0u);
    vec4 color = sluiceSampleArrayGrad(layersTex, tableIndex, layer, uv, dx, dy, bias, anisotropy,
                                       missing);
    vec4 ofLayer = sluiceSampleGrad(layerTex, params.tableIndex, uv, dx, dy, bias, anisotropy,
                                    missingOfLayer);
    writeBoth(at, color, missing, ofLayer, missingOfLayer);
    /* every second sample, so that the others show what happens to be there */
    if ((at & 1u) == 0u)
        sluiceWriteFeedback(params.tableIndex, uv, dx, dy, bias, anisotropy);
}
