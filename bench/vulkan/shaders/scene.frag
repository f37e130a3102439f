/* The scene by a fragment shader, with its own derivatives. */
#version 450
#extension GL_GOOGLE_include_directive : require

layout(early_fragment_tests) in;

#include "scene.glsl"

layout(location = 0) out vec4 outColor;

void main()
{
    Place p = scenePlace(gl_FragCoord.xy);
    uint missing;
    if (streamed)
        outColor = sluiceSample(streamedTexture, params.tableIndex, p.uv, 0.0, anisotropy, missing);
    else
        outColor = texture(plainTexture, p.uv);
    writeSceneFeedback(sluiceFragmentPixel(gl_FragCoord.xy), p);
}
