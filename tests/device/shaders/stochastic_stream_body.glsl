/* Shared by stochastic_stream.comp and .hlsl after their bindings: evaluates one input. */
#include "sluice/sample_stochastic.glsl"

void sampleStochastic(uint id)
{
    uint at = params.first + id, kernel = params.flags & STOCHASTIC_KERNEL, missing = 0u;
    bool mark = (params.flags & STOCHASTIC_MARK) != 0u, wanted = (params.flags & STOCHASTIC_WANTED) != 0u;
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    float lod = inputs[at].lodBias, sigma = inputs[at].maxAnisotropy;
    vec2 random = sluiceRandomPair(uvec3(at, params.flags >> STOCHASTIC_SEED_SHIFT, 7u)), same = random;
    SluiceGrid grid = sluiceReadGrid(params.tableIndex);
    SluicePick pick;
    if (wanted)
        pick = sluicePickTexel(uv, lod, uvec2(grid.size), sluiceMipCount(grid), sluiceAddressModes(grid), kernel,
                               sigma, random);
    else
        pick = sluicePickStreamed(params.tableIndex, uv, lod, kernel, sigma, false, random, missing);
    vec4 color = SLUICE_SPLAT(vec4, 0.0);
    if (!wanted)
        color = sluiceSampleStochastic(SLUICE_PASS_SAMPLER(tex), params.tableIndex, uv, lod, kernel, sigma, mark, same, missing);
    for (uint c = 0u; c < 4u; c++)
        outputs[at].color[c] = color[c];
    outputs[at].missingLevels = missing;
    outputs[at].level = pick.level;
    outputs[at].footprint[0] = uint(pick.texel.x);
    outputs[at].footprint[1] = uint(pick.texel.y);
    outputs[at].footprint[2] = pick.border ? 1u : 0u;
}
