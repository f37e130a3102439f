/* Buffers of the demand loading probe, and its code for one input. */
#include "sluice/shared/demand.h"
#include "demand_probe_shared.h"

#include "sluice/language.glsl"

#ifdef SLUICE_HLSL
[[vk::binding(0)]] StructuredBuffer<SluiceDemandTexture> textures;
[[vk::binding(1)]] StructuredBuffer<uint> levels;
[[vk::binding(2)]] StructuredBuffer<uint> directory;
[[vk::binding(3)]] StructuredBuffer<uint> blocks;
[[vk::binding(4)]] RWStructuredBuffer<SluiceDemandBlockMasks> masks;
[[vk::binding(5)]] RWStructuredBuffer<uint> requests;
[[vk::binding(6)]] RWStructuredBuffer<uint> sections;
[[vk::binding(7)]] StructuredBuffer<DemandInput> inputs;
[[vk::binding(8)]] RWStructuredBuffer<DemandOutput> outputs;
[[vk::binding(9)]] Texture2DArray pages[DEMAND_CHUNKS];
[[vk::binding(9)]] SamplerState pageSamplers[DEMAND_CHUNKS];
[[vk::binding(10)]] Texture2D plain;
[[vk::binding(10)]] SamplerState plainSampler;
[[vk::constant_id(0)]] const bool preview = false;
[[vk::constant_id(1)]] const bool cubic = false;
struct DemandPush { uint count; };
[[vk::push_constant]] ConstantBuffer<DemandPush> push;

#define SLUICE_DEMAND_TEXTURE(i) textures[i]
#define SLUICE_DEMAND_LEVEL_WORD(i) levels[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) directory[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) blocks[i]
#define SLUICE_DEMAND_MASKS(i) masks[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) requests[i]
#define SLUICE_DEMAND_SECTION_WORD(i) sections[i]
#define SLUICE_PAGE_SAMPLER(i) pageSamplers[i]
#else
layout(std430, binding = 0) readonly buffer Textures { SluiceDemandTexture entries[]; } textures;
layout(std430, binding = 1) readonly buffer Levels { uint words[]; } levels;
layout(std430, binding = 2) readonly buffer Directory { uint words[]; } directory;
layout(std430, binding = 3) readonly buffer Blocks { uint words[]; } blocks;
layout(std430, binding = 4) buffer Masks { SluiceDemandBlockMasks entries[]; } masks;
layout(std430, binding = 5) buffer Requests { uint words[]; } requests;
layout(std430, binding = 6) buffer Sections { uint words[]; } sections;
layout(std430, binding = 7) readonly buffer Inputs { DemandInput inputs[]; };
layout(std430, binding = 8) buffer Outputs { DemandOutput outputs[]; };
layout(binding = 9) uniform sampler2DArray pages[DEMAND_CHUNKS];
layout(binding = 10) uniform sampler2D plain;
layout(constant_id = 0) const bool preview = false;
layout(constant_id = 1) const bool cubic = false;
layout(push_constant) uniform Push { uint count; };

#define SLUICE_DEMAND_TEXTURE(i) textures.entries[i]
#define SLUICE_DEMAND_LEVEL_WORD(i) levels.words[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) directory.words[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) blocks.words[i]
#define SLUICE_DEMAND_MASKS(i) masks.entries[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) requests.words[i]
#define SLUICE_DEMAND_SECTION_WORD(i) sections.words[i]
#endif
#define SLUICE_DEMAND_PREVIEW preview
#define SLUICE_DEMAND_CUBIC cubic
#ifdef DEMAND_PAGE_LOOP
#define SLUICE_PAGE_TEXTURE(i) pages[i]
#define SLUICE_PAGE_LOOP DEMAND_CHUNKS
#else
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#endif
#include "sluice/demand.glsl"

/* Samples with one call in the source, because drivers take seconds to compile each call. */
mat3x4 sampleDemand(uint at, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    uint index = inputs[at].index;
#ifdef DEMAND_FUNCTION
    vec4 du = SLUICE_SPLAT(vec4, 0.0), dv = SLUICE_SPLAT(vec4, 0.0);
    vec4 color = DEMAND_FUNCTION;
    return mat3x4(color, du, dv);
#else
    uint kind = inputs[at].kind;
    uint way = kind == DEMAND_CUBIC    ? SLUICE_DEMAND_AS_SMART
               : kind == DEMAND_SLOPES ? SLUICE_DEMAND_AS_SLOPES
                                       : SLUICE_DEMAND_AS_TEXTURE;
    return sluiceDemandSample(index, uv, dx, dy, kind == DEMAND_LOD, inputs[at].lod, way, resident);
#endif
}

void probeDemand(uint at)
{
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    vec2 dx = vec2(inputs[at].dx[0], inputs[at].dx[1]);
    vec2 dy = vec2(inputs[at].dy[0], inputs[at].dy[1]);
    uint kind = inputs[at].kind;
    uvec2 value = SLUICE_SPLAT(uvec2, 0u);
    mat3x4 color = SLUICE_SPLAT(mat3x4, 0.0);
    bool resident = true;
    if (kind == DEMAND_MAP)
        resident = sluiceMapOrRequest(inputs[at].index, value);
    else if (kind == DEMAND_FORMULA)
        outputs[at].lod = sluiceDemandComputeLod(dx, dy, inputs[at].lod);
    else if (kind == DEMAND_HARDWARE)
        color[0] = SLUICE_TEXTURE_GRAD(plain, SLUICE_SAMPLER_OF(plain), uv, dx, dy);
    else if (kind == DEMAND_PLACE)
        value = uvec2(sluiceDemandTailPlace(SLUICE_DEMAND_TEXTURE(inputs[at].index).shape, inputs[at].word,
                                            uint(inputs[at].lod)));
    else
        color = sampleDemand(at, uv, dx, dy, resident);
    for (uint i = 0u; i < 4u; i++) {
        outputs[at].color[i] = color[0][i];
        outputs[at].du[i] = color[1][i];
        outputs[at].dv[i] = color[2][i];
    }
    outputs[at].resident = resident ? 1u : 0u;
    outputs[at].value[0] = value.x;
    outputs[at].value[1] = value.y;
}
