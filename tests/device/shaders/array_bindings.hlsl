/* array.glsl in HLSL: bindings, and the two samples of a layer. */
#include "sluice/shared/texture_table.h"
#include "probe_shared.h"

[[vk::binding(0)]] StructuredBuffer<SluiceTextureEntry> textureTable;
[[vk::binding(1)]] StructuredBuffer<uint> minMip;
[[vk::binding(2)]] RWStructuredBuffer<uint> feedback;
[[vk::binding(3)]] StructuredBuffer<ProbeInput> inputs;
[[vk::binding(4)]] RWStructuredBuffer<ProbeOutput> outputs;
[[vk::binding(5)]] Texture2DArray layersTex;
[[vk::binding(5)]] SamplerState layersTexSampler;
[[vk::binding(6)]] Texture2D layerTex;
[[vk::binding(6)]] SamplerState layerTexSampler;
[[vk::binding(0, 1)]] StructuredBuffer<uint> pageTable;
#define ARRAY_LOOPED_CHUNKS 2
[[vk::binding(1, 1)]] Texture2DArray pages[ARRAY_LOOPED_CHUNKS];
[[vk::binding(1, 1)]] SamplerState pageSamplers[ARRAY_LOOPED_CHUNKS];
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
#define SLUICE_PAGE_LOOP ARRAY_LOOPED_CHUNKS
#include "sluice/feedback.glsl"
#include "sluice/sample_array.glsl"
