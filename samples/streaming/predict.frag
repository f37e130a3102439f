/* Draws the streamed surfaces from the future camera to request their tiles. Writes no color. */
#version 460
#extension GL_GOOGLE_include_directive : require

/* Fragments that will be hidden request nothing. */
layout(early_fragment_tests) in;

#include "gallery.glsl"
#include "sluice/feedback.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) flat in vec3 normal;
layout(location = 3) flat in vec3 tangent;

/* Limits the request to one level finer than now: the camera often approaches less than
 * predicted. */
float farther()
{
    float now = distance(toVec3(frame.presentEye), position);
    float ahead = distance(toVec3(frame.eye), position);
    return max(1.0, 0.5 * now / max(ahead, 1.0e-6));
}

void main()
{
    /* Derivatives at the size of the picture's pixels. */
    float scale = frame.pixelScale * farther();
    vec2 dx = dFdx(uv) * scale, dy = dFdy(uv) * scale;
    sluiceWriteFeedback(draw.colorTexture, uv, dx, dy, frame.lodBias, frame.maxAnisotropy);
    if (draw.reliefFeedback != 0u)
        sluiceWriteFeedback(draw.reliefTexture, uv, dx, dy, frame.lodBias, frame.maxAnisotropy);
}
