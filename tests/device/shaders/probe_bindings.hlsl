/* Bindings and constants of probe.comp in HLSL, and of shaders with the same ones. */
#include "sluice/shared/texture_table.h"
#include "probe_shared.h"

[[vk::binding(0)]] StructuredBuffer<SluiceTextureEntry> textureTable;
[[vk::binding(1)]] StructuredBuffer<uint> minMip;
[[vk::binding(2)]] RWStructuredBuffer<uint> feedback;
[[vk::binding(3)]] StructuredBuffer<ProbeInput> inputs;
[[vk::binding(4)]] RWStructuredBuffer<ProbeOutput> outputs;
/* An image and a sampler of one binding are a combined image sampler. */
[[vk::binding(5)]] Texture2D tex;
[[vk::binding(5)]] SamplerState texSampler;
[[vk::binding(6)]] Texture2D nearestMipTex;
[[vk::binding(6)]] SamplerState nearestMipTexSampler;
[[vk::binding(0, 1)]] StructuredBuffer<uint> pageTable;
/* The first of them, for textures of one format: drivers compile code for each element. */
#define PROBE_LOOPED_CHUNKS 2
[[vk::binding(1, 1)]] Texture2DArray pages[PROBE_LOOPED_CHUNKS];
[[vk::binding(1, 1)]] SamplerState pageSamplers[PROBE_LOOPED_CHUNKS];
[[vk::constant_id(0)]] const bool paged = false;
[[vk::constant_id(2)]] const bool mixed = false;
[[vk::constant_id(1)]] const bool cubic = false;
[[vk::push_constant]] ConstantBuffer<ProbeParams> params;

#define SLUICE_TEXTURE_ENTRY(i) textureTable[i]
#define SLUICE_MIN_MIP_WORD(i) minMip[i]
#define SLUICE_FEEDBACK_WORD(i) feedback[i]
#define SLUICE_PAGED paged
#define SLUICE_PAGED_PER_TEXTURE mixed
#define SLUICE_CUBIC cubic
#define SLUICE_PAGE_TABLE_WORD(i) pageTable[i]
#define SLUICE_PAGE_TEXTURE(i) pages[i]
#define SLUICE_PAGE_SAMPLER(i) pageSamplers[i]
#define SLUICE_PAGE_LOOP PROBE_LOOPED_CHUNKS
