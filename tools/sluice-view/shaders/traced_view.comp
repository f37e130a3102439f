/* Finds resident and wanted level of each pixel. Requests no page, and marks none as used. */
#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_QUIET true
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"

#include "../../../samples/demand-pbrt/pbrt_shared.h"
#include "../traced_shared.h"

layout(local_size_x = 64) in;

layout(std430, set = 1, binding = 0) readonly buffer Probes
{
    PbrtProbe probes[];
};
layout(std430, set = 1, binding = 1) writeonly buffer Views
{
    TracedView views[];
};
layout(push_constant) uniform Push
{
    uint count; /* pixels */
}
push;

/* Returns true if a page is resident. Unlike sluiceFindDemandPage, does not keep the page from being evicted. */
bool isResident(uint page)
{
    uint block = SLUICE_DEMAND_DIRECTORY_WORD(page / SLUICE_DEMAND_BLOCK_PAGES);
    uint index = page % SLUICE_DEMAND_BLOCK_PAGES;
    return block != SLUICE_DEMAND_NO_BLOCK && (SLUICE_DEMAND_MASKS(block).resident & 1u << index) != 0u &&
           SLUICE_DEMAND_BLOCK_WORD(block * SLUICE_DEMAND_BLOCK_WORDS + index) < SLUICE_DEMAND_PAGE_REFUSED;
}

float inTexture(float at, uint mode)
{
    if (mode == SLUICE_ADDRESS_MODE_REPEAT)
        return at - floor(at);
    if (mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT)
        return 1.0 - abs(at - 2.0 * floor(0.5 * at) - 1.0);
    return clamp(at, 0.0, 1.0);
}

uint pageAt(SluiceDemandTexture t, uint level, vec2 at)
{
    ivec2 shift = sluiceDemandTileShift(t.shape);
    uvec2 size = max(uvec2(t.width, t.height) >> level, uvec2(1u));
    uvec2 tile = min(uvec2(at * vec2(size)), size - 1u) >> shift;
    uint columns = (size.x + (1u << shift.x) - 1u) >> shift.x;
    return SLUICE_DEMAND_LEVEL_WORD(t.levels + level) + tile.y * columns + tile.x;
}

/* Finds the finest resident level. Without any page, the color of the last level is resident. */
void findResident(SluiceDemandTexture t, vec2 at, inout TracedView view)
{
    uint regular = sluiceDemandRegularCount(t.shape);
    for (uint level = 0u; level < regular; level++) {
        view.page = pageAt(t, level, at);
        view.resident = level;
        if (isResident(view.page))
            return;
    }
    bool hasTail = isResident(t.tailPage);
    view.page = hasTail ? t.tailPage : 0xffffffffu;
    view.resident = hasTail ? regular : sluiceDemandLastLevel(t.shape);
}

void main()
{
    uint pixel = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
    if (pixel >= push.count)
        return;
    PbrtProbe probe = probes[pixel];
    TracedView view;
    view.texture = probe.texture;
    view.state = TRACED_NOT_OPEN;
    view.wanted = view.levelCount = 0u;
    view.resident = TRACED_NO_LEVEL;
    view.page = 0xffffffffu;
    view.lod = view.density = view.uv[0] = view.uv[1] = 0.0;
    view.reserved[0] = view.reserved[1] = 0u;
    if (probe.texture != PBRT_NONE) {
        SluiceDemandTexture t = SLUICE_DEMAND_TEXTURE(probe.texture);
        uvec2 modes = sluiceDemandModes(t.shape);
        vec2 at = vec2(inTexture(probe.uv[0], modes.x), inTexture(probe.uv[1], modes.y));
        vec2 dx = vec2(probe.dx[0] * t.width, probe.dx[1] * t.height);
        vec2 dy = vec2(probe.dy[0] * t.width, probe.dy[1] * t.height);
        view.uv[0] = at.x;
        view.uv[1] = at.y;
        if (t.state == SLUICE_DEMAND_TEXTURE_OPEN) {
            float most = clamp(t.maxAnisotropy, 1.0, SLUICE_DEMAND_MAX_ANISOTROPY);
            uint last = sluiceDemandLastLevel(t.shape);
            view.state = TRACED_OPEN;
            view.levelCount = last + 1u;
            view.lod = sluiceDemandComputeLod(dx, dy, most) + t.lodBias;
            view.density = sqrt(min(dot(dx, dx), dot(dy, dy)));
            view.wanted = uint(clamp(view.lod, 0.0, float(last)));
            findResident(t, at, view);
        } else if (t.state == SLUICE_DEMAND_TEXTURE_FAILED) {
            view.state = TRACED_FAILED;
        }
    }
    views[pixel] = view;
}
