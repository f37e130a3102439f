/* Takes the samples that a test requests, through the loader's own buffers. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require
#ifdef RUNNER_READS_BYTES
#extension GL_EXT_buffer_reference_uvec2 : require
#endif

#include "sluice/shared/demand.h"
#include "sluice/shared/bindings.h"
#include "demand_runner_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Textures { SluiceDemandTexture entries[]; } textures;
layout(std430, binding = 1) readonly buffer Levels { uint words[]; } levels;
layout(std430, binding = 2) readonly buffer Directory { uint words[]; } directory;
layout(std430, binding = 3) readonly buffer Blocks { uint words[]; } blocks;
layout(std430, binding = 4) buffer Masks { SluiceDemandBlockMasks entries[]; } masks;
layout(std430, binding = 5) buffer Requests { uint words[]; } requests;
layout(std430, binding = 6) buffer Sections { uint words[]; } sections;
layout(std430, binding = 7) readonly buffer Inputs { RunnerInput inputs[]; };
layout(std430, binding = 8) writeonly buffer Outputs { RunnerOutput outputs[]; };
layout(binding = 9) uniform sampler2DArray pages[RUNNER_CHUNKS];
layout(push_constant) uniform Push { uint count; };

#define SLUICE_DEMAND_TEXTURE(i) textures.entries[i]
#define SLUICE_DEMAND_LEVEL_WORD(i) levels.words[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) directory.words[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) blocks.words[i]
#define SLUICE_DEMAND_MASKS(i) masks.entries[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) requests.words[i]
#define SLUICE_DEMAND_SECTION_WORD(i) sections.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "sluice/demand.glsl"
#include "sluice/demand_jitter.glsl"
#ifdef RUNNER_SAMPLES_CUBES
#include "sluice/demand_cubes.glsl"
#endif
#ifdef RUNNER_SAMPLES_GRIDS
#include "sluice/demand_grids.glsl"

vec4 sampleGrid(RunnerInput i, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    if (i.kind == RUNNER_LAYER_GRAD)
        return sluiceDemandLayerGrad(i.index, i.cell, uv, dx, dy, resident);
    if (i.kind == RUNNER_UDIM_GRAD)
        return sluiceDemandUdimGrad(i.index, uv, dx, dy, resident);
    return sluiceDemandLayerLod(i.index, i.cell, uv, dx.x, resident);
}
#endif

#ifdef RUNNER_READS_BYTES
layout(std430, binding = 10) readonly buffer Chunk { uint words[]; } chunks[SLUICE_DEMAND_BYTE_CHUNKS];
#define SLUICE_DEMAND_BYTE_WORD(chunk, i) chunks[nonuniformEXT(chunk)].words[i]
#include "sluice/demand_bytes.glsl"

layout(std430, buffer_reference, buffer_reference_align = 16) readonly buffer Words { uint words[]; };

/* FNV-1a of all bytes. */
uint hash(uint sum, uint word, uint at, uint size)
{
    for (uint b = 0u; b < 4u && at * 4u + b < size; b++)
        sum = (sum ^ bitfieldExtract(word, int(b) * 8, 8)) * 16777619u;
    return sum;
}

uvec2 readBytes(uint kind, uint page, uint size, out bool resident)
{
    SluiceDemandBytes bytes;
    uvec2 value;
    uint sum = 2166136261u;
    if (kind == RUNNER_BYTES)
        resident = sluiceMapBytesOrRequest(page, bytes);
    else
        resident = sluiceMapOrRequest(page, value);
    for (uint i = 0u; resident && i * 4u < size; i++)
        sum = hash(sum, kind == RUNNER_BYTES ? sluiceDemandWord(bytes, i) : Words(value).words[i], i, size);
    bool odd = kind == RUNNER_BYTES ? bytes.offset % 16u != 0u : value.x % 16u != 0u;
    return uvec2(sum, uint(resident && odd));
}
#endif

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= count)
        return;
    RunnerInput i = inputs[at];
    vec2 uv = vec2(i.uv[0], i.uv[1]), dx = vec2(i.dx[0], i.dx[1]), dy = vec2(i.dy[0], i.dy[1]);
    vec4 color = vec4(0.0);
    uvec2 value = uvec2(0u);
    bool resident;
#ifndef RUNNER_SAMPLES_GRIDS
    if (i.kind == RUNNER_JITTER) {
        uv = sluiceDemandJitter(i.index, uv, dx.xy, dx.yx, i.cell, dy);
        dy = dx.yx;
    }
#endif
    if (i.kind == RUNNER_MAP)
        resident = sluiceMapOrRequest(i.index, value);
#ifdef RUNNER_READS_BYTES
    else if (i.kind == RUNNER_BYTES || i.kind == RUNNER_ADDRESS)
        value = readBytes(i.kind, i.index, uint(i.dx[0]), resident);
#endif
#ifdef RUNNER_SAMPLES_CUBES
    else if (i.kind == RUNNER_CUBE_GRAD)
        color = sluiceDemandCubeGrad(i.index, i.cell, vec3(i.direction[0], i.direction[1], i.direction[2]),
                                     vec3(i.direction[3], i.direction[4], i.direction[5]),
                                     vec3(i.direction[6], i.direction[7], i.direction[8]), resident);
#endif
#ifdef RUNNER_SAMPLES_GRIDS
    else if (i.kind >= RUNNER_LAYER_GRAD)
        color = sampleGrid(i, uv, dx, dy, resident);
#endif
    else if (i.kind == RUNNER_LOD)
        color = sluiceDemandLod(i.index, uv, dx.x, resident);
    else
        color = sluiceDemandGrad(i.index, uv, dx, dy, resident);
    for (uint c = 0u; c < 4u; c++)
        outputs[at].color[c] = color[c];
    outputs[at].value[0] = value.x;
    outputs[at].value[1] = value.y;
    outputs[at].resident = uint(resident);
}
