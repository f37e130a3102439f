/*
 * Declares the descriptor set of a launch (SluiceDemandLaunch.descriptorSet), and the macros of
 * demand.glsl and demand_pages.glsl. Include it before the files that you use:
 *
 *     #define SLUICE_DEMAND_SET 0            // set number; default 0
 *     #include "sluice/demand_bindings.glsl"
 *     #include "sluice/demand.glsl"
 *
 * The pipeline layout has the set layout of sluiceGetDemandDescriptorSetLayout at that number.
 *
 * Requires the device features runtimeDescriptorArray and
 * shaderSampledImageArrayNonUniformIndexing. Without them define SLUICE_PAGE_LOOP as
 * maxPageChunkCount. Byte pages (demand_bytes.glsl) require
 * shaderStorageBufferArrayNonUniformIndexing; with SLUICE_PAGE_LOOP
 * shaderStorageBufferArrayDynamicIndexing.
 */
#ifndef SLUICE_DEMAND_BINDINGS_GLSL
#define SLUICE_DEMAND_BINDINGS_GLSL

#include "language.glsl"
#ifndef SLUICE_HLSL
#extension GL_EXT_nonuniform_qualifier : require
#endif
#include "shared/bindings.h"
#include "shared/demand.h"

#ifndef SLUICE_DEMAND_SET
#define SLUICE_DEMAND_SET 0
#endif

SLUICE_BUFFER(SLUICE_DEMAND_SET, SLUICE_DEMAND_BINDING_TEXTURES, SluiceDemandTextures, SluiceDemandTexture, sluiceDemandTextures)
#define SLUICE_DEMAND_TEXTURE(i) sluiceDemandTextures[i]

SLUICE_BUFFER(SLUICE_DEMAND_SET, SLUICE_DEMAND_BINDING_LEVELS, SluiceDemandLevels, uint, sluiceDemandLevelWords)
#define SLUICE_DEMAND_LEVEL_WORD(i) sluiceDemandLevelWords[i]

SLUICE_BUFFER(SLUICE_DEMAND_SET, SLUICE_DEMAND_BINDING_DIRECTORY, SluiceDemandDirectory, uint, sluiceDemandDirectoryWords)
#define SLUICE_DEMAND_DIRECTORY_WORD(i) sluiceDemandDirectoryWords[i]

SLUICE_BUFFER(SLUICE_DEMAND_SET, SLUICE_DEMAND_BINDING_BLOCKS, SluiceDemandBlocks, uint, sluiceDemandBlockWords)
#define SLUICE_DEMAND_BLOCK_WORD(i) sluiceDemandBlockWords[i]

SLUICE_WRITTEN_BUFFER(SLUICE_DEMAND_SET, SLUICE_DEMAND_BINDING_MASKS, SluiceDemandMasks, SluiceDemandBlockMasks, sluiceDemandMasks)
#define SLUICE_DEMAND_MASKS(i) sluiceDemandMasks[i]

SLUICE_WRITTEN_BUFFER(SLUICE_DEMAND_SET, SLUICE_DEMAND_BINDING_REQUESTS, SluiceDemandRequests, uint, sluiceDemandRequestWords)
#define SLUICE_DEMAND_REQUEST_WORD(i) sluiceDemandRequestWords[i]

SLUICE_WRITTEN_BUFFER(SLUICE_DEMAND_SET, SLUICE_DEMAND_BINDING_SECTIONS, SluiceDemandSections, uint, sluiceDemandSectionWords)
#define SLUICE_DEMAND_SECTION_WORD(i) sluiceDemandSectionWords[i]

/* Buffers with byte pages. */
#ifdef SLUICE_PAGE_LOOP
#define SLUICE_DEMAND_INDEX(i) i
#define SLUICE_DEMAND_PAGE_COUNT SLUICE_PAGE_LOOP
#else
#define SLUICE_DEMAND_INDEX(i) SLUICE_NON_UNIFORM(i)
#define SLUICE_DEMAND_PAGE_COUNT
#endif
#ifdef SLUICE_HLSL
[[vk::binding(SLUICE_DEMAND_BINDING_BYTES, SLUICE_DEMAND_SET)]] StructuredBuffer<uint> sluiceDemandByteChunks[SLUICE_DEMAND_BYTE_CHUNKS];
#define SLUICE_DEMAND_BYTE_WORD(chunk, i) sluiceDemandByteChunks[SLUICE_DEMAND_INDEX(chunk)][i]
#else
layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_BYTES) readonly buffer SluiceDemandByteChunk
{
    uint words[];
} sluiceDemandByteChunks[SLUICE_DEMAND_BYTE_CHUNKS];
#define SLUICE_DEMAND_BYTE_WORD(chunk, i) sluiceDemandByteChunks[SLUICE_DEMAND_INDEX(chunk)].words[i]
#endif

/*
 * Demand loading has its own array of pages, also in shaders that include bindings.glsl. A new page
 * image is in the two arrays at different times.
 */
#ifdef SLUICE_HLSL
[[vk::binding(SLUICE_DEMAND_BINDING_PAGES, SLUICE_DEMAND_SET)]] Texture2DArray sluiceDemandPages[SLUICE_DEMAND_PAGE_COUNT];
[[vk::binding(SLUICE_DEMAND_BINDING_PAGES, SLUICE_DEMAND_SET)]] SamplerState sluiceDemandPageSamplers[SLUICE_DEMAND_PAGE_COUNT];
#define SLUICE_DEMAND_PAGE_SAMPLER(i) sluiceDemandPageSamplers[SLUICE_DEMAND_INDEX(i)]
#else
layout(set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_PAGES) uniform sampler2DArray sluiceDemandPages[SLUICE_DEMAND_PAGE_COUNT];
#endif
#define SLUICE_DEMAND_PAGE_TEXTURE(i) sluiceDemandPages[SLUICE_DEMAND_INDEX(i)]

#endif
