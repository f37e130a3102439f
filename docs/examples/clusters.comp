/* One work group per visible cluster of a mesh: finds the cluster's vertices, which are a byte page, and
 * bounds them. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_SET 0
#include "sluice/demand_bindings.glsl"
#include "sluice/demand_bytes.glsl"

#define VERTEX_COUNT 256
#define VERTEX_WORDS 4 /* position, color */

struct Bounds {
    vec4 low, high;
};

layout(std430, set = 1, binding = 0) buffer Answer {
    uint firstPage;
    uint missing; /* clusters */
    uint visible[126];
    Bounds bounds[126];
} answer;
layout(local_size_x = 64) in;

shared vec3 low[64], high[64];

vec3 position(SluiceDemandBytes bytes, uint vertex)
{
    uint at = vertex * VERTEX_WORDS;
    return vec3(sluiceDemandFloat(bytes, at), sluiceDemandFloat(bytes, at + 1u),
                sluiceDemandFloat(bytes, at + 2u));
}

void main()
{
    uint i = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    uint cluster = answer.visible[i];
    SluiceDemandBytes bytes;
    if (!sluiceMapBytesOrRequest(answer.firstPage + cluster, bytes)) {
        if (lane == 0u)
            atomicAdd(answer.missing, 1u);
        return; /* the same for all lanes */
    }
    low[lane] = high[lane] = position(bytes, lane);
    for (uint v = lane + 64u; v < VERTEX_COUNT; v += 64u) {
        low[lane] = min(low[lane], position(bytes, v));
        high[lane] = max(high[lane], position(bytes, v));
    }
    barrier();
    for (uint l = 1u; lane == 0u && l < 64u; l++) {
        low[0] = min(low[0], low[l]);
        high[0] = max(high[0], high[l]);
    }
    if (lane == 0u)
        answer.bounds[i] = Bounds(vec4(low[0], 0.0), vec4(high[0], 0.0));
}
