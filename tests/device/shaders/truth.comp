/* Explicit derivatives, with the LOD bias in them, and explicit levels. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "truth.glsl"

layout(local_size_x = 64) in;

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= params.count)
        return;
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    float scale = exp2(inputs[at].lodBias);
    vec2 dx = vec2(inputs[at].dx[0], inputs[at].dx[1]) * scale;
    vec2 dy = vec2(inputs[at].dy[0], inputs[at].dy[1]) * scale;
    uint words[TRUTH_WORDS] = uint[TRUTH_WORDS](0u, 0u, 0u, 0u);
    for (uint layer = 0u; layer < params.layerCount; layer++) {
        vec3 place = vec3(uv, float(layer));
        addTexel(words, layer, inputs[at].mode == CONFORM_LOD ? textureLod(tex, place, inputs[at].lod)
                                                              : textureGrad(tex, place, dx, dy));
    }
    writeWords(at, words);
}
