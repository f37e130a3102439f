/*
 * A textured floor up to the horizon, sampled with the fragments' own derivatives. Colors and
 * checks go to a buffer, so that no rounding hides a difference.
 */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "probe_shared.h"

layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 3) readonly buffer Inputs { ProbeInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { ProbeOutput outputs[]; };
layout(binding = 5) uniform sampler2D tex;
layout(binding = 6) uniform sampler2D nearestMipTex;
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[PROBE_PAGE_CHUNKS];
layout(constant_id = 0) const bool paged = false;
layout(constant_id = 2) const bool mixed = false;
layout(push_constant) uniform Push { ProbeParams params; };

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#define SLUICE_PAGED paged
#define SLUICE_PAGED_PER_TEXTURE mixed
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"
#ifndef PROBE_CODES
#define SLUICE_NO_RESIDENCY_CODES
#endif
#include "sluice/residency.glsl"

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint at = pixel.y * PICTURE_SIZE + pixel.x;
    /* inputs[0]: the eye over the floor in uv, its height in dx.x, one pixel's angle in dx.y */
    vec2 screen = (gl_FragCoord.xy - vec2(0.5 * float(PICTURE_SIZE), -1.0)) * inputs[0].dx[1];
    float distance = inputs[0].dx[0] / screen.y;
    vec2 uv = vec2(inputs[0].uv[0], inputs[0].uv[1]) + vec2(screen.x, 1.0) * distance;
    float bias = inputs[0].lodBias, anisotropy = inputs[0].maxAnisotropy;
    vec2 dx = dFdx(uv), dy = dFdy(uv);
#if defined(SLUICE_FEEDBACK_QUERY) && !defined(PICTURE_QUERY_LATE)
    float lod = sluiceQueryLod(tex, uv);
#endif

    uint missing;
    vec4 color = sluiceSample(tex, params.tableIndex, uv, bias, anisotropy, missing);
    SluiceSampling s = sluiceResolveSampling(params.tableIndex, uv, dx, dy, bias, anisotropy);
    for (uint i = 0u; i < 4u; i++)
        outputs[at].color[i] = color[i];
    outputs[at].missingLevels = missing;
    outputs[at].level = s.level;
    outputs[at].wantedLevel = s.wantedLevel;
    outputs[at].lod = s.lod;
    outputs[at].footprint[0] = floatBitsToUint(s.dx.x);
    outputs[at].footprint[1] = floatBitsToUint(s.dx.y);
    outputs[at].footprint[2] = floatBitsToUint(s.dy.x);
    outputs[at].footprint[3] = floatBitsToUint(s.dy.y);
    outputs[at].minLod = s.minLod;
    outputs[at].nonResident += sluiceCountNonResident(nearestMipTex, params.tableIndex, uv, dx, dy,
                                                      bias, anisotropy);
    bool selected = (params.flags & PICTURE_LATTICE) != 0u
                        ? sluiceSelectFragmentLattice(gl_FragCoord.xy, params.first)
                        : sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, params.first, 1.0 / 16.0);
#ifdef PICTURE_QUERY_LATE /* behind branches in which the pixels of a quad parted */
    sluiceWriteFeedbackQuery(tex, params.tableIndex, uv, bias, anisotropy, selected);
#else
    if (selected)
#ifdef SLUICE_FEEDBACK_QUERY
        sluiceWriteFeedbackQueried(lod, params.tableIndex, uv, dx, dy, bias, anisotropy);
#else
        sluiceWriteFeedback(params.tableIndex, uv, dx, dy, bias, anisotropy);
#endif
#endif
}
