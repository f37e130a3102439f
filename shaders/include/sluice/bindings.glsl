/*
 * Declares the descriptor set of a frame (SluiceStreamingFrame.descriptorSet), and the macros of
 * buffers.glsl. Include it before the files that you use:
 *
 *     #define SLUICE_SET 0                   // set number; default 0
 *     #define SLUICE_PAGED true              // as in buffers.glsl; leave it out: never paged mode
 *     #define SLUICE_PAGED_PER_TEXTURE true  // for pagedTextures; default: false
 *     #define SLUICE_FEEDBACK_IN_TURNS       // for feedbackInTurns; default: every texture
 *     #define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED  // as the streamer's textureArray; default: none
 *     #include "sluice/bindings.glsl"
 *     #include "sluice/sample.glsl"
 *     #include "sluice/feedback.glsl"
 *
 * With SLUICE_TEXTURE_ARRAY all textures of the streamer are in the set, at their tableIndex:
 *
 *     vec4 color = sluiceSample(tableIndex, tableIndex, uv, 0.0, 1.0, missing);
 *
 * tableIndex may differ between invocations. SLUICE_TEXTURES_SEPARATE has images and samplers. Cube
 * maps are in the set, too, for sample_cube.glsl: the number is the tableIndex of the first face.
 *
 * The pipeline layout has the set layout of sluiceGetVulkanDescriptorSetLayout at that number.
 *
 * Requires the device features runtimeDescriptorArray and
 * shaderSampledImageArrayNonUniformIndexing with SLUICE_PAGED and with SLUICE_TEXTURE_ARRAY. Without
 * them define SLUICE_PAGE_LOOP as the number of pages: maxPageChunkCount in paged mode and with
 * pagedTextures, else 1. There is no array of textures then.
 */
#ifndef SLUICE_BINDINGS_GLSL
#define SLUICE_BINDINGS_GLSL

#include "language.glsl"
#ifndef SLUICE_HLSL
#extension GL_EXT_nonuniform_qualifier : require
#endif
#include "shared/bindings.h"
#include "shared/texture_table.h"

#ifndef SLUICE_SET
#define SLUICE_SET 0
#endif

SLUICE_BUFFER(SLUICE_SET, SLUICE_BINDING_TEXTURE_TABLE, SluiceTextureTable, SluiceTextureEntry, sluiceTextureEntries)
#define SLUICE_TEXTURE_ENTRY(i) sluiceTextureEntries[i]

SLUICE_BUFFER(SLUICE_SET, SLUICE_BINDING_MIN_MIP, SluiceMinMip, uint, sluiceMinMipWords)
#define SLUICE_MIN_MIP_WORD(i) sluiceMinMipWords[i]

SLUICE_WRITTEN_BUFFER(SLUICE_SET, SLUICE_BINDING_FEEDBACK, SluiceFeedback, uint, sluiceFeedbackWords)
#define SLUICE_FEEDBACK_WORD(i) sluiceFeedbackWords[i]

#ifdef SLUICE_FEEDBACK_IN_TURNS
SLUICE_BUFFER(SLUICE_SET, SLUICE_BINDING_FEEDBACK_TURNS, SluiceFeedbackTurns, uint, sluiceFeedbackTurnWords)
#define SLUICE_FEEDBACK_TURN_WORD(i) sluiceFeedbackTurnWords[i]
#endif

#ifdef SLUICE_PAGED
SLUICE_BUFFER(SLUICE_SET, SLUICE_BINDING_PAGE_TABLE, SluicePageTable, uint, sluicePageTableWords)
#define SLUICE_PAGE_TABLE_WORD(i) sluicePageTableWords[i]

#ifdef SLUICE_PAGE_LOOP
#define SLUICE_PAGE_INDEX(i) i
#define SLUICE_PAGE_COUNT SLUICE_PAGE_LOOP
#else
#define SLUICE_PAGE_INDEX(i) SLUICE_NON_UNIFORM(i)
#define SLUICE_PAGE_COUNT
#endif
#ifdef SLUICE_HLSL
[[vk::binding(SLUICE_BINDING_PAGES, SLUICE_SET)]] Texture2DArray sluicePages[SLUICE_PAGE_COUNT];
[[vk::binding(SLUICE_BINDING_PAGES, SLUICE_SET)]] SamplerState sluicePageSamplers[SLUICE_PAGE_COUNT];
#define SLUICE_PAGE_SAMPLER(i) sluicePageSamplers[SLUICE_PAGE_INDEX(i)]
#else
layout(set = SLUICE_SET, binding = SLUICE_BINDING_PAGES) uniform sampler2DArray sluicePages[SLUICE_PAGE_COUNT];
#endif
#define SLUICE_PAGE_TEXTURE(i) sluicePages[SLUICE_PAGE_INDEX(i)]
#endif

#ifdef SLUICE_TEXTURE_ARRAY
#if defined(SLUICE_HLSL)
#ifdef SLUICE_TEXTURE_COUNT /* some compilers need a size, at most the set's */
#define SLUICE_CUBE_COUNT (SLUICE_TEXTURE_COUNT + 5) / 6
#else
#define SLUICE_TEXTURE_COUNT
#define SLUICE_CUBE_COUNT
#endif
[[vk::binding(SLUICE_BINDING_TEXTURES, SLUICE_SET)]] Texture2D sluiceTextures[SLUICE_TEXTURE_COUNT];
[[vk::binding(SLUICE_BINDING_CUBES, SLUICE_SET)]] TextureCube sluiceCubes[SLUICE_CUBE_COUNT];
#define SLUICE_TEXTURE(i) sluiceTextures[SLUICE_NON_UNIFORM(i)]
#define SLUICE_CUBE_TEXTURE(i) sluiceCubes[SLUICE_NON_UNIFORM((i) / 6u)]
#if SLUICE_TEXTURE_ARRAY == SLUICE_TEXTURES_SEPARATE
[[vk::binding(SLUICE_BINDING_SAMPLERS, SLUICE_SET)]] SamplerState sluiceSamplers[SLUICE_SAMPLER_COUNT];
#define SLUICE_TEXTURE_SAMPLER(i) sluiceSamplers[SLUICE_NON_UNIFORM(SLUICE_TEXTURE_ENTRY(i).samplerIndex)]
#define SLUICE_CUBE_TEXTURE_SAMPLER(i) SLUICE_TEXTURE_SAMPLER(i)
#else
[[vk::binding(SLUICE_BINDING_TEXTURES, SLUICE_SET)]] SamplerState sluiceSamplers[SLUICE_TEXTURE_COUNT];
[[vk::binding(SLUICE_BINDING_CUBES, SLUICE_SET)]] SamplerState sluiceCubeSamplers[SLUICE_CUBE_COUNT];
#define SLUICE_TEXTURE_SAMPLER(i) sluiceSamplers[SLUICE_NON_UNIFORM(i)]
#define SLUICE_CUBE_TEXTURE_SAMPLER(i) sluiceCubeSamplers[SLUICE_NON_UNIFORM((i) / 6u)]
#endif
#elif SLUICE_TEXTURE_ARRAY == SLUICE_TEXTURES_SEPARATE
layout(set = SLUICE_SET, binding = SLUICE_BINDING_TEXTURES) uniform texture2D sluiceTextureImages[];
layout(set = SLUICE_SET, binding = SLUICE_BINDING_SAMPLERS) uniform sampler sluiceSamplers[SLUICE_SAMPLER_COUNT];
layout(set = SLUICE_SET, binding = SLUICE_BINDING_CUBES) uniform textureCube sluiceCubeImages[];
#define SLUICE_TEXTURE(i)                                                                         \
    nonuniformEXT(sampler2D(sluiceTextureImages[nonuniformEXT(i)],                                 \
                            sluiceSamplers[nonuniformEXT(SLUICE_TEXTURE_ENTRY(i).samplerIndex)]))
#define SLUICE_CUBE_TEXTURE(i)                                                                    \
    nonuniformEXT(samplerCube(sluiceCubeImages[nonuniformEXT((i) / 6u)],                           \
                              sluiceSamplers[nonuniformEXT(SLUICE_TEXTURE_ENTRY(i).samplerIndex)]))
#else
layout(set = SLUICE_SET, binding = SLUICE_BINDING_TEXTURES) uniform sampler2D sluiceTextures[];
layout(set = SLUICE_SET, binding = SLUICE_BINDING_CUBES) uniform samplerCube sluiceCubes[];
#define SLUICE_TEXTURE(i) sluiceTextures[nonuniformEXT(i)]
#define SLUICE_CUBE_TEXTURE(i) sluiceCubes[nonuniformEXT((i) / 6u)]
#endif
#endif

#endif
