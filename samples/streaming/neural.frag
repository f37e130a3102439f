/*
 * Pictures of a neural set that are decoded while sampling. Texels are chosen at random, decoded
 * and averaged. The chosen texels are the feedback.
 */
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

/* Prevents hidden surfaces from requesting pages. */
layout(early_fragment_tests) in;

#include "gallery.glsl"
#include "sluice/shared/demand.h"
#include "sluice/stochastic_filter.glsl"

layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_LEVELS) readonly buffer Levels { uint words[]; } levels;
layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_DIRECTORY) readonly buffer Directory { uint words[]; } directory;
layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_BLOCKS) readonly buffer Blocks { uint words[]; } blocks;
layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_MASKS) buffer Masks { SluiceDemandBlockMasks entries[]; } masks;
layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_REQUESTS) buffer Requests { uint words[]; } requests;
layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_SECTIONS) buffer Sections { uint words[]; } sections;
layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_SET) readonly buffer Set { GalleryNeuralSet neuralSet; };
layout(std430, set = 3, binding = GALLERY_NEURAL_BINDING_WEIGHTS) readonly buffer Weights { uint words[]; } weights;

#define SLUICE_DEMAND_LEVEL_WORD(i) levels.words[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) directory.words[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) blocks.words[i]
#define SLUICE_DEMAND_MASKS(i) masks.entries[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) requests.words[i]
#define SLUICE_DEMAND_SECTION_WORD(i) sections.words[i]
#define SLUICE_NEURAL_PAGES(s) neuralSet.pages
#define SLUICE_NEURAL_FIRST_PAGE(s) neuralSet.firstPage
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights.words[i]
#define SLUICE_NEURAL_VECTOR_WEIGHTS(s) weights.words
#include "sluice/neural_pages.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) flat in vec3 normal;
layout(location = 3) flat in vec3 tangent;
layout(location = 0) out vec4 outColor;

/** Returns the channels of the picture, linear. */
vec3 colorOf(float channels[SLUICE_NEURAL_CHANNELS])
{
    vec3 color = vec3(0.0);
    uint first = draw.colorTexture, count = (draw.flags & GALLERY_GRAY) != 0u ? 1u : 3u;
    /* 16-bit float textures also keep and filter negative values. */
    vec2 range = (draw.flags & GALLERY_HDR) != 0u ? vec2(-65504.0, 65504.0) : vec2(0.0, 1.0);
    for (uint c = 0u; c < count; c++)
        color[c] = clamp(sluiceNeuralToLinear(channels[first + c], draw.reliefTexture >> 2u * c & 3u), range.x, range.y);
    return count == 1u ? color.rrr : color;
}

void main()
{
    uvec2 size = uvec2(neuralSet.pages.width, neuralSet.pages.height);
    float lod = sluiceComputeLod(dFdx(uv) * vec2(size), dFdy(uv) * vec2(size), frame.lodBias, 1.0);
    vec3 sum = vec3(0.0);
    bool coarser = false;
    uint picks = max(frame.neuralPicks, 1u);
    for (uint i = 0u; i < picks; i++) {
        vec2 random = sluiceRandomPair(uvec3(gl_FragCoord.xy, frame.feedbackSeed * 64u + i));
        SluicePick pick = sluicePickTexel(uv, lod, size, neuralSet.pages.mipCount,
                                          uvec2(SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE), SLUICE_PICK_LINEAR, 0.0,
                                          random);
        float channels[SLUICE_NEURAL_CHANNELS];
        uint shown;
        sluiceNeuralSampleOrRequest(0u, pick.texel, pick.level, shown, channels);
        coarser = coarser || shown > pick.level;
        sum += colorOf(channels);
    }
    vec3 color = lightSurface(sum / float(picks) * draw.exposure, position, normal, 0.0);
    if (frame.highlight != 0u && coarser)
        color = mix(color, vec3(1.2, 0.1, 0.35), 0.55);
    outColor = vec4(develop(color), 1.0);
}
