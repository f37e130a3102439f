/* Samples a streamed cube map and writes feedback for what is visible. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_SET 0
#define SLUICE_PAGED true
#include "sluice/bindings.glsl"
#include "sluice/feedback_cube.glsl"
#include "sluice/sample_cube.glsl"

#include "sky.glsl"

layout(set = 1, binding = 0) uniform samplerCube sky;
layout(location = 0) in vec3 direction;
layout(location = 0) out vec4 color;

void main()
{
    vec3 dx = dFdx(direction), dy = dFdy(direction);
    uint missing;
    color = sluiceSampleCube(sky, view.tableIndex, direction, 0.0, 1.0, missing);
    sluiceWriteCubeFeedback(view.tableIndex, direction, dx, dy, 0.0, 1.0);
    vec3 size = abs(direction);
    float longest = max(max(size.x, size.y), size.z), shortest = min(min(size.x, size.y), size.z);
    float middle = size.x + size.y + size.z - longest - shortest;
    if (longest - middle < view.edges * longest)
        color = vec4(1.0, 0.1, 0.1, 1.0);
}
