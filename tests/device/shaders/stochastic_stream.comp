/* Samples streamed textures by one texel that is chosen at random. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "stochastic_stream_shared.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool paged = false;
layout(push_constant) uniform Push { ProbeParams params; };
layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 3) readonly buffer Inputs { ProbeInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { ProbeOutput outputs[]; };
layout(binding = 5) uniform sampler2D tex;
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[PROBE_PAGE_CHUNKS];

#define SLUICE_PAGED paged
#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "sluice/sample_stochastic.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    uint at = params.first + gl_GlobalInvocationID.x, kernel = params.flags & STOCHASTIC_KERNEL, missing = 0u;
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
    vec4 color = wanted ? vec4(0.0)
                        : sluiceSampleStochastic(tex, params.tableIndex, uv, lod, kernel, sigma, mark, same, missing);
    for (uint c = 0u; c < 4u; c++)
        outputs[at].color[c] = color[c];
    outputs[at].missingLevels = missing;
    outputs[at].level = pick.level;
    outputs[at].footprint[0] = uint(pick.texel.x);
    outputs[at].footprint[1] = uint(pick.texel.y);
    outputs[at].footprint[2] = pick.border ? 1u : 0u;
}
