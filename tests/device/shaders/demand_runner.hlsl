/* demand_runner.comp in HLSL: its cube maps with RUNNER_SAMPLES_CUBES, else its grids. */
#include "sluice/shared/demand.h"
#include "demand_runner_shared.h"

[[vk::binding(0)]] StructuredBuffer<SluiceDemandTexture> textures;
[[vk::binding(1)]] StructuredBuffer<uint> levels;
[[vk::binding(2)]] StructuredBuffer<uint> directory;
[[vk::binding(3)]] StructuredBuffer<uint> blocks;
[[vk::binding(4)]] RWStructuredBuffer<SluiceDemandBlockMasks> masks;
[[vk::binding(5)]] RWStructuredBuffer<uint> requests;
[[vk::binding(6)]] RWStructuredBuffer<uint> sections;
[[vk::binding(7)]] StructuredBuffer<RunnerInput> inputs;
[[vk::binding(8)]] RWStructuredBuffer<RunnerOutput> outputs;
/* The first of the images: drivers compile code for each element. */
#define RUNNER_LOOPED_CHUNKS 2
[[vk::binding(9)]] Texture2DArray pages[RUNNER_LOOPED_CHUNKS];
[[vk::binding(9)]] SamplerState pageSamplers[RUNNER_LOOPED_CHUNKS];
struct Push {
    uint count;
};
[[vk::push_constant]] ConstantBuffer<Push> push;

#define SLUICE_DEMAND_TEXTURE(i) textures[i]
#define SLUICE_DEMAND_LEVEL_WORD(i) levels[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) directory[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) blocks[i]
#define SLUICE_DEMAND_MASKS(i) masks[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) requests[i]
#define SLUICE_DEMAND_SECTION_WORD(i) sections[i]
#define SLUICE_PAGE_TEXTURE(i) pages[i]
#define SLUICE_PAGE_SAMPLER(i) pageSamplers[i]
#define SLUICE_PAGE_LOOP RUNNER_LOOPED_CHUNKS
#ifdef RUNNER_SAMPLES_CUBES
#include "sluice/demand_cubes.glsl"

float3 directionAt(uint at, uint i)
{
    return float3(inputs[at].direction[i], inputs[at].direction[i + 1u], inputs[at].direction[i + 2u]);
}

float4 sampleAt(uint at, out bool resident)
{
    return sluiceDemandCubeGrad(inputs[at].index, inputs[at].cell, directionAt(at, 0u), directionAt(at, 3u),
                                directionAt(at, 6u), resident);
}
#else
#include "sluice/demand_grids.glsl"

float4 sampleAt(uint at, out bool resident)
{
    uint kind = inputs[at].kind, index = inputs[at].index;
    float2 uv = float2(inputs[at].uv[0], inputs[at].uv[1]);
    float2 dx = float2(inputs[at].dx[0], inputs[at].dx[1]), dy = float2(inputs[at].dy[0], inputs[at].dy[1]);
    if (kind == RUNNER_LAYER_GRAD)
        return sluiceDemandLayerGrad(index, inputs[at].cell, uv, dx, dy, resident);
    if (kind == RUNNER_LAYER_LOD)
        return sluiceDemandLayerLod(index, inputs[at].cell, uv, dx.x, resident);
    return sluiceDemandUdimGrad(index, uv, dx, dy, resident);
}
#endif

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    if (id.x >= push.count)
        return;
    bool resident;
    float4 color = sampleAt(id.x, resident);
    for (uint c = 0u; c < 4u; c++)
        outputs[id.x].color[c] = color[c];
    outputs[id.x].resident = resident ? 1u : 0u;
}
