/* Implicit derivatives and the sampler's own way with a bias: one sample per quad. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "truth.glsl"

void main()
{
    uvec2 quad = uvec2(gl_FragCoord.xy) >> 1u;
    uvec2 lane = uvec2(gl_FragCoord.xy) & 1u;
    uint at = quad.y * (CONFORM_TARGET_SIZE / 2u) + quad.x;
    bool inside = at < params.count;
    at = min(at, params.count - 1u); /* derivatives need all four */
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]) +
              float(lane.x) * vec2(inputs[at].dx[0], inputs[at].dx[1]) +
              float(lane.y) * vec2(inputs[at].dy[0], inputs[at].dy[1]);
    uint words[TRUTH_WORDS] = uint[TRUTH_WORDS](0u, 0u, 0u, 0u);
    for (uint layer = 0u; layer < params.layerCount; layer++)
        addTexel(words, layer, texture(tex, vec3(uv, float(layer)), inputs[at].lodBias));
    if (inside && lane == uvec2(0u))
        writeWords(at, words);
}
