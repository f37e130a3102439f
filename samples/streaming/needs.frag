/* The same surfaces once more, to find out what all of their samples together ask for. */
#version 460
#extension GL_GOOGLE_include_directive : require

/* As where they are drawn: what is hidden counts as little here as there. */
layout(early_fragment_tests) in;

#include "gallery.glsl"

/* The streamer must not see this feedback. */
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
    if ((draw.flags & GALLERY_PAINTED) != 0u) /* what it samples, whatever it follows */
        sluiceWriteFeedback(draw.reliefTexture, uv, dx, dy, frame.lodBias, frame.maxAnisotropy);
    outColor = vec4(0.0);

    atomicAdd(counts.sampled, 1u);
    if (missing > 0u)
        atomicAdd(counts.missingPixels, 1u);
}
