/* Encodes blocks of texels with encode_blocks.glsl, one per invocation. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/encode_blocks.glsl"
#include "encode_blocks_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Texels { EncodeInput inputs[]; };
layout(std430, binding = 1) writeonly buffer Blocks { uvec4 blocks[]; };
layout(push_constant) uniform Push { uint count, format; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    vec4 texels[16];
    float red[16], green[16];
    for (uint t = 0; t < 16; t++) {
        texels[t] = vec4(inputs[i].rgba[4 * t], inputs[i].rgba[4 * t + 1], inputs[i].rgba[4 * t + 2],
                         inputs[i].rgba[4 * t + 3]);
        red[t] = texels[t].r;
        green[t] = texels[t].g;
    }
    uvec4 block = uvec4(0);
    if (format == ENCODE_BC1)
        block.xy = sluiceEncodeBc1(texels);
    else if (format == ENCODE_BC4)
        block.xy = sluiceEncodeBc4(red);
    else if (format == ENCODE_BC5)
        block = sluiceEncodeBc5(red, green);
    else
        block = sluiceEncodeBc7(texels);
    blocks[i] = block;
}
