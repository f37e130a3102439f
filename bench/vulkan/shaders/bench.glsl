/* Buffers and images of all shaders here, and Sluice's functions over them. Built with BENCH_PAGED, too. */
#ifdef BENCH_PAGED
#extension GL_EXT_nonuniform_qualifier : require
#endif
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "bench_shared.h"

layout(std430, set = 0, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, set = 0, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, set = 0, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, set = 0, binding = 3) buffer Outputs { uint outputs[]; };
layout(std430, set = 0, binding = 4) readonly buffer Indices { uint tableIndices[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Picture { uint picture[]; };
layout(set = 0, binding = 6) uniform sampler2D streamedTexture;
layout(set = 0, binding = 7) uniform sampler2D plainTexture;
#ifdef BENCH_PAGED
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[BENCH_PAGE_CHUNKS];
#endif
layout(push_constant) uniform Push { BenchParams params; };

layout(constant_id = BENCH_CONSTANT_STREAMED) const bool streamed = false;
layout(constant_id = BENCH_CONSTANT_SCENE) const uint scene = 0;
layout(constant_id = BENCH_CONSTANT_FEEDBACK) const uint feedbackKind = 0;
layout(constant_id = BENCH_CONSTANT_ANISOTROPY) const float anisotropy = 1.0;
layout(constant_id = BENCH_CONSTANT_COUNTING) const bool counting = false;

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#ifdef BENCH_PAGED
#define SLUICE_PAGED true
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#endif
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"
