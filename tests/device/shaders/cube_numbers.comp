/* Each invocation samples a cube map of the streamer's array, by a number of its own. */
#version 450
#extension GL_GOOGLE_include_directive : require

layout(constant_id = 0) const bool paged = false;
#define SLUICE_PAGED paged
#define SLUICE_SET 0
#define SLUICE_TEXTURE_ARRAY CUBE_NUMBERS_ARRAY
#include "sluice/bindings.glsl"
#include "sluice/feedback_cube.glsl"
#include "sluice/sample_cube.glsl"
#include "cube_shared.h"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) readonly buffer Inputs { CubeInput inputs[]; };
layout(std430, set = 1, binding = 1) buffer Outputs { ProbeOutput outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint at = gl_GlobalInvocationID.x, missing;
    if (at >= count)
        return;
    uint number = inputs[at].number;
    vec3 direction = vec3(inputs[at].direction[0], inputs[at].direction[1], inputs[at].direction[2]);
    vec3 dx = vec3(inputs[at].dx[0], inputs[at].dx[1], inputs[at].dx[2]);
    vec3 dy = vec3(inputs[at].dy[0], inputs[at].dy[1], inputs[at].dy[2]);
    vec4 color = sluiceSampleCubeGrad(number, number, direction, dx, dy, 0.0, 1.0, missing);
    for (uint c = 0u; c < 4u; c++)
        outputs[at].color[c] = color[c];
    outputs[at].missingLevels = missing;
    sluiceWriteCubeFeedback(number, direction, dx, dy, 0.0, 1.0);
}
