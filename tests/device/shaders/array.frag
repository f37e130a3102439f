/* A textured floor up to the horizon, of one layer, with the fragments' own derivatives. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "array.glsl"

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint at = pixel.y * PICTURE_SIZE + pixel.x;
    /* inputs[0]: the eye over the floor in uv, its height in dx.x, one pixel's angle in dx.y */
    vec2 screen = (gl_FragCoord.xy - vec2(0.5 * float(PICTURE_SIZE), -1.0)) * inputs[0].dx[1];
    float distance = inputs[0].dx[0] / screen.y;
    vec2 uv = vec2(inputs[0].uv[0], inputs[0].uv[1]) + vec2(screen.x, 1.0) * distance;
    float bias = inputs[0].lodBias, anisotropy = inputs[0].maxAnisotropy;
    uint layer = params.flags;
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    uint missing, missingOfLayer;
    vec4 color = sluiceSampleArray(layersTex, params.tableIndex, layer, uv, bias, anisotropy, missing);
    vec4 ofLayer = sluiceSample(layerTex, params.tableIndex, uv, bias, anisotropy, missingOfLayer);
    writeBoth(at, color, missing, ofLayer, missingOfLayer);
    if (pixel.x < PICTURE_SIZE / 2u)
        sluiceWriteFeedback(params.tableIndex, uv, dx, dy, bias, anisotropy);
}
