#version 450
#extension GL_GOOGLE_include_directive : require
/* Each invocation samples level 0 of its own texture, at the center of the texel in the middle. */
layout(constant_id = 0) const bool paged = false;
#define SLUICE_PAGED paged
#define SLUICE_SET 0
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "crowd_shared.h"

layout(local_size_x = CROWD_GROUP) in;
layout(std430, set = 1, binding = 0) buffer Outputs { CrowdOutput outputs[]; };
layout(push_constant) uniform Params { CrowdParams params; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    uint index = params.first + i, missing;
    vec2 texel = 1.0 / vec2(SLUICE_TEXTURE_ENTRY(index).sizeX, SLUICE_TEXTURE_ENTRY(index).sizeY);
    vec2 uv = vec2(0.5) + 0.5 * texel, dx = vec2(texel.x, 0.0), dy = vec2(0.0, texel.y);
    vec4 color = sluiceSampleGrad(index, index, uv, dx, dy, 0.0, 1.0, missing);
    sluiceWriteFeedback(index, uv, dx, dy, 0.0, 1.0);
    for (uint c = 0u; c < 4u; c++)
        outputs[params.place + i].color[c] = color[c];
    outputs[params.place + i].missing = missing;
}
