/* Draws the surfaces again to count samples that would read a texel that is not resident. */
#version 460
#extension GL_GOOGLE_include_directive : require

layout(early_fragment_tests) in;

#include "gallery.glsl"
#include "sluice/residency.glsl"

layout(set = 1, binding = 2) uniform sampler2D colorTexture;
layout(set = 1, binding = 3) uniform sampler2D reliefTexture;

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) flat in vec3 normal;
layout(location = 3) flat in vec3 tangent;
layout(location = 0) out vec4 outColor;

uint missingLevels(uint tableIndex, vec2 dx, vec2 dy)
{
    uint missing = sluiceMissingLevels(
        sluiceResolveSampling(tableIndex, uv, dx, dy, frame.lodBias, frame.maxAnisotropy));
    return min(missing, SLUICE_TEXTURE_ENTRY(tableIndex).mipLevelCount);
}

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    uint nonResident = sluiceCountNonResident(colorTexture, draw.colorTexture, uv, dx, dy,
                                              frame.lodBias, frame.maxAnisotropy);
    if ((draw.flags & GALLERY_PAINTED) != 0u)
        nonResident += sluiceCountNonResident(reliefTexture, draw.reliefTexture, uv, dx, dy,
                                              frame.lodBias, frame.maxAnisotropy);
    uint missing = missingLevels(draw.colorTexture, dx, dy);
    outColor = vec4(0.0);

    atomicAdd(counts.sampled, 1u);
    if (nonResident > 0u)
        atomicAdd(counts.nonResident, nonResident);
    if (missing > 0u) {
        atomicAdd(counts.missingPixels, 1u);
        atomicAdd(counts.missingLevels, missing);
    }
}
