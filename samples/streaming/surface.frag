/* Shades floor, walls and pictures, whose textures are streamed, and writes feedback. */
#version 460
#extension GL_GOOGLE_include_directive : require

/* Prevents hidden surfaces from writing feedback. */
layout(early_fragment_tests) in;

#include "gallery.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"

layout(set = 1, binding = 0) uniform sampler2D colorTexture;
layout(set = 1, binding = 1) uniform sampler2D reliefTexture;

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) flat in vec3 normal;
layout(location = 3) flat in vec3 tangent;
layout(location = 0) out vec4 outColor;

bool selectedForFeedback()
{
    if (frame.latticeFrame != GALLERY_NO_TEXTURE)
        return sluiceSelectFragmentLattice(gl_FragCoord.xy, frame.latticeFrame);
    return sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, frame.feedbackSeed,
                                          frame.feedbackProbability);
}

/* Writes feedback: for single pixels of the lattice, or for random quads, whose pixels share the
 * work. */
void writeFeedback(uint tableIndex, vec2 dx, vec2 dy)
{
    if (frame.latticeFrame != GALLERY_NO_TEXTURE)
        sluiceWriteFeedback(tableIndex, uv, dx, dy, frame.lodBias, frame.maxAnisotropy);
    else
        sluiceWriteQuadFeedback(tableIndex, uv, dx, dy, frame.lodBias, frame.maxAnisotropy,
                                uvec2(gl_FragCoord.xy), frame.feedbackSeed);
}

/** Returns the normal, tilted by the relief's change of height along the surface. */
vec3 bentNormal(float height)
{
    vec3 bitangent = cross(normal, tangent);
    vec3 dx = dFdx(position), dy = dFdy(position);
    vec2 slope = vec2(dFdx(height), dFdy(height));
    vec3 r1 = cross(dy, normal), r2 = cross(normal, dx);
    float area = dot(dx, r1);
    vec3 bent = normal * abs(area) - draw.reliefScale * sign(area) * (slope.x * r1 + slope.y * r2);
    float size = dot(bent, bent);
    return size > 1e-30 ? bent * inversesqrt(size) : normal;
}

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    uint missing, reliefMissing = 0u;
    vec4 texel = sluiceSample(colorTexture, draw.colorTexture, uv, frame.lodBias,
                              frame.maxAnisotropy, missing);
    vec3 albedo = ((draw.flags & GALLERY_GRAY) != 0u ? texel.rrr : texel.rgb) * draw.exposure;

    vec3 bent = normal;
    float shine = 0.0;
    if ((draw.flags & GALLERY_PAINTED) != 0u) {
        float height = sluiceSample(reliefTexture, draw.reliefTexture, uv, frame.lodBias,
                                    frame.maxAnisotropy, reliefMissing).r;
        bent = bentNormal(height);
        shine = 0.05;
    }
    vec3 color = lightSurface(albedo, position, bent, shine);
    if (frame.highlight != 0u && missing + reliefMissing > 0u)
        color = mix(color, vec3(1.2, 0.1, 0.35), missing > 0u ? 0.55 : 0.2);
    outColor = vec4(develop(color), 1.0);

    if (selectedForFeedback()) {
        writeFeedback(draw.colorTexture, dx, dy);
        if (draw.reliefFeedback != 0u)
            writeFeedback(draw.reliefTexture, dx, dy);
    }
}
