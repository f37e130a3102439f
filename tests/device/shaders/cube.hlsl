/* cube.comp in HLSL. */
#include "sluice/shared/texture_table.h"
#include "cube_shared.h"

[[vk::binding(0)]] StructuredBuffer<SluiceTextureEntry> textureTable;
[[vk::binding(1)]] StructuredBuffer<uint> minMip;
[[vk::binding(2)]] RWStructuredBuffer<uint> feedback;
[[vk::binding(3)]] StructuredBuffer<CubeInput> inputs;
[[vk::binding(4)]] RWStructuredBuffer<ProbeOutput> outputs;
[[vk::binding(5)]] TextureCube cubeTex;
[[vk::binding(5)]] SamplerState cubeTexSampler;
[[vk::binding(0, 1)]] StructuredBuffer<uint> pageTable;
#define CUBE_LOOPED_CHUNKS 2
[[vk::binding(1, 1)]] Texture2DArray pages[CUBE_LOOPED_CHUNKS];
[[vk::binding(1, 1)]] SamplerState pageSamplers[CUBE_LOOPED_CHUNKS];
[[vk::constant_id(0)]] const bool paged = false;
[[vk::constant_id(2)]] const bool mixed = false;
[[vk::push_constant]] ConstantBuffer<ProbeParams> params;

#define SLUICE_TEXTURE_ENTRY(i) textureTable[i]
#define SLUICE_MIN_MIP_WORD(i) minMip[i]
#define SLUICE_FEEDBACK_WORD(i) feedback[i]
#define SLUICE_PAGED paged
#define SLUICE_PAGED_PER_TEXTURE mixed
#define SLUICE_PAGE_TABLE_WORD(i) pageTable[i]
#define SLUICE_PAGE_TEXTURE(i) pages[i]
#define SLUICE_PAGE_SAMPLER(i) pageSamplers[i]
#define SLUICE_PAGE_LOOP CUBE_LOOPED_CHUNKS
#define CUBE_FORM cubeTex, cubeTexSampler
#include "cube_body.glsl"

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    if (id.x < params.count)
        probeCube(id.x);
}
