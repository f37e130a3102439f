/* Draws the surfaces again to find out what all their samples together request. */
#version 460
#extension GL_GOOGLE_include_directive : require

/* Hidden fragments request nothing, as in the drawing pass. */
layout(early_fragment_tests) in;

#include "gallery.glsl"

/* Feedback goes to a buffer that the streamer does not read. */
layout(set = 2, binding = GALLERY_BINDING_REQUIRED, std430) buffer Required { uint words[]; } required;
#undef SLUICE_FEEDBACK_WORD
#define SLUICE_FEEDBACK_WORD(i) required.words[i]

#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) flat in vec3 normal;
layout(location = 3) flat in vec3 tangent;
layout(location = 0) out vec4 outColor;

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    uint missing = sluiceMissingLevels(sluiceResolveSampling(draw.colorTexture, uv, dx, dy,
                                                             frame.lodBias, frame.maxAnisotropy));
    sluiceWriteFeedback(draw.colorTexture, uv, dx, dy, frame.lodBias, frame.maxAnisotropy);
    if ((draw.flags & GALLERY_PAINTED) != 0u) /* even if the relief shares feedback */
        sluiceWriteFeedback(draw.reliefTexture, uv, dx, dy, frame.lodBias, frame.maxAnisotropy);
    outColor = vec4(0.0);

    atomicAdd(counts.sampled, 1u);
    if (missing > 0u)
        atomicAdd(counts.missingPixels, 1u);
}
