/*
 * Each pixel samples a random texture by number. With BINDLESS_ALONE all pixels sample one texture,
 * an ordinary sampler2D, and those that would have chosen it store the result: the oracle.
 */

layout(constant_id = 0) const bool paged = false;
layout(constant_id = 1) const bool mixed = false;
#define SLUICE_PAGED paged
#define SLUICE_PAGED_PER_TEXTURE mixed
#define SLUICE_SET 0
#ifndef BINDLESS_ALONE
#define SLUICE_TEXTURE_ARRAY BINDLESS_ARRAY
#endif
#include "sluice/bindings.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"
#include "bindless_shared.h"

layout(std430, set = 1, binding = 0) buffer Outputs { BindlessOutput outputs[]; };
layout(std430, set = 1, binding = 1) readonly buffer Textures { BindlessTexture textures[]; };
layout(set = 1, binding = 2) uniform sampler2D alone;
layout(push_constant) uniform Params { BindlessParams params; };

#ifdef BINDLESS_ALONE
#define TEXTURE alone
#else
#define TEXTURE index
#endif

uint chosen(uvec2 pixel)
{
    return sluiceHash(uvec3(pixel >> params.shift, params.seed)) % params.count;
}

/* The derivatives of a texture that is scaled and turned a little. */
vec2 place(vec2 pixel, float scale)
{
    return mat2(1.0, 0.2, -0.3, 0.9) * pixel * scale - vec2(0.4);
}

void store(uvec2 pixel, uint choice, vec4 color, vec4 texel, uint missing)
{
    uint at = pixel.y * BINDLESS_SIZE + pixel.x;
    for (uint c = 0u; c < 4u; c++) {
        outputs[at].color[c] = color[c];
        outputs[at].texel[c] = texel[c];
    }
    outputs[at].missing = missing;
    outputs[at].texture = choice;
}
