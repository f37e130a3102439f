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

#extension GL_EXT_nonuniform_qualifier : require

#include "shared/bindings.h"
#include "shared/demand.h"

#ifndef SLUICE_DEMAND_SET
#define SLUICE_DEMAND_SET 0
#endif

layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_TEXTURES) readonly buffer SluiceDemandTextures
{
    SluiceDemandTexture sluiceDemandTextures[];
};
#define SLUICE_DEMAND_TEXTURE(i) sluiceDemandTextures[i]

layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_LEVELS) readonly buffer SluiceDemandLevels
{
    uint sluiceDemandLevelWords[];
};
#define SLUICE_DEMAND_LEVEL_WORD(i) sluiceDemandLevelWords[i]

layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_DIRECTORY) readonly buffer SluiceDemandDirectory
{
    uint sluiceDemandDirectoryWords[];
};
#define SLUICE_DEMAND_DIRECTORY_WORD(i) sluiceDemandDirectoryWords[i]

layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_BLOCKS) readonly buffer SluiceDemandBlocks
{
    uint sluiceDemandBlockWords[];
};
#define SLUICE_DEMAND_BLOCK_WORD(i) sluiceDemandBlockWords[i]

layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_MASKS) buffer SluiceDemandMasks
{
    SluiceDemandBlockMasks sluiceDemandMasks[];
};
#define SLUICE_DEMAND_MASKS(i) sluiceDemandMasks[i]

layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_REQUESTS) buffer SluiceDemandRequests
{
    uint sluiceDemandRequestWords[];
};
#define SLUICE_DEMAND_REQUEST_WORD(i) sluiceDemandRequestWords[i]

layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_SECTIONS) buffer SluiceDemandSections
{
    uint sluiceDemandSectionWords[];
};
#define SLUICE_DEMAND_SECTION_WORD(i) sluiceDemandSectionWords[i]

/* Buffers with byte pages. */
layout(std430, set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_BYTES) readonly buffer SluiceDemandByteChunk
{
    uint words[];
} sluiceDemandByteChunks[SLUICE_DEMAND_BYTE_CHUNKS];
#ifdef SLUICE_PAGE_LOOP
#define SLUICE_DEMAND_BYTE_WORD(chunk, i) sluiceDemandByteChunks[chunk].words[i]
#else
#define SLUICE_DEMAND_BYTE_WORD(chunk, i) sluiceDemandByteChunks[nonuniformEXT(chunk)].words[i]
#endif

/*
 * Demand loading has its own array of pages, also in shaders that include bindings.glsl. A new page
 * image is in the two arrays at different times.
 */
#ifdef SLUICE_PAGE_LOOP
layout(set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_PAGES) uniform sampler2DArray sluiceDemandPages[SLUICE_PAGE_LOOP];
#define SLUICE_DEMAND_PAGE_TEXTURE(i) sluiceDemandPages[i]
#else
layout(set = SLUICE_DEMAND_SET, binding = SLUICE_DEMAND_BINDING_PAGES) uniform sampler2DArray sluiceDemandPages[];
#define SLUICE_DEMAND_PAGE_TEXTURE(i) sluiceDemandPages[nonuniformEXT(i)]
#endif

#endif
