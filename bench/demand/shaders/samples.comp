/* Samples a grid of textures, each over all of its extent. */
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require

#include "demand_bench_shared.h"
#include "sluice/shared/demand.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kind = DEMAND_BENCH_NOTHING;

layout(std430, set = 0, binding = 0) readonly buffer Textures { SluiceDemandTexture textures[]; };
layout(std430, set = 0, binding = 1) readonly buffer Levels { uint levels[]; };
layout(std430, set = 0, binding = 2) readonly buffer Directory { uint directory[]; };
layout(std430, set = 0, binding = 3) readonly buffer Blocks { uint blocks[]; };
layout(std430, set = 0, binding = 4) buffer Masks { SluiceDemandBlockMasks masks[]; };
layout(std430, set = 0, binding = 5) buffer Requests { uint requests[]; };
layout(std430, set = 0, binding = 6) buffer Sections { uint sections[]; };
layout(std430, set = 0, binding = 7) buffer Outputs { uint outputs[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Picture { uint picture[]; };
layout(set = 0, binding = 9) uniform sampler2D plain[DEMAND_BENCH_TEXTURES];
layout(set = 1, binding = 0) uniform sampler2DArray pages[DEMAND_BENCH_CHUNKS];
layout(push_constant) uniform Push { DemandBenchParams params; };

#define SLUICE_DEMAND_TEXTURE(i) textures[i]
#define SLUICE_DEMAND_LEVEL_WORD(i) levels[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) directory[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) blocks[i]
#define SLUICE_DEMAND_MASKS(i) masks[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) requests[i]
#define SLUICE_DEMAND_SECTION_WORD(i) sections[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#define SLUICE_DEMAND_CUBIC (kind == DEMAND_BENCH_CUBIC)
#include "sluice/demand.glsl"

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (max(at.x, at.y) >= params.edge)
        return;
    uint field = params.edge / params.columns;
    uint which = at.y / field * params.columns + at.x / field;
    vec2 uv = (vec2(at % field) + 0.5) / float(field);
    float lod = max(uv.x, uv.y) < params.fineEdge ? params.fineLod : params.lod;
    float step = exp2(lod) / params.textureSize;
    vec2 dx = vec2(step, 0.0), dy = vec2(0.0, step);
    vec4 color = vec4(uv, step, 1.0);
    bool resident = true;
    if (kind == DEMAND_BENCH_SAMPLED || kind == DEMAND_BENCH_CUBIC)
        color = sluiceDemandGrad(params.textures[which], uv, dx, dy, resident);
    else if (kind == DEMAND_BENCH_SLOPES) {
        vec4 du, dv;
        color = sluiceDemandDerivatives(params.textures[which], uv, dx, dy, du, dv, resident);
        color.xy = (du.xy + dv.xy) / params.textureSize;
    } else if (kind == DEMAND_BENCH_BYTES) {
        uvec2 value;
        uint page = at.y * params.edge + at.x;
        resident = page >= params.pageCount || sluiceMapOrRequest(params.firstPage + page, value);
    } else if (kind == DEMAND_BENCH_PLAIN)
        color = textureGrad(plain[nonuniformEXT(which)], uv, dx, dy);
    picture[at.y * params.edge + at.x] = packUnorm4x8(color);
    if (params.counting != 0u && !resident)
        atomicAdd(outputs[DEMAND_BENCH_MISSING], 1u);
}
