#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require

/* Or else what is hidden would write feedback too. Masks decide later whether they are there. */
#ifndef MASKED
layout(early_fragment_tests) in;
#endif
layout(constant_id = 0) const bool paged = false;
#define SLUICE_PAGED paged
#define SLUICE_SET 0
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"
#include "scene_push.glsl"

#include "scene_material.glsl"
#include "scene_light.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 uvs;
layout(location = 0) out vec4 outColor;

const uint VIEW_RESIDENT = 2, VIEW_MISSING = 3, VIEW_WANTED = 4, VIEW_IDENTITY = 6, VIEW_WRITTEN = 7,
           VIEW_CHECKS = 9;

/* panels.c has the same colors. */
const vec3 levelColors[8] = vec3[](vec3(214, 40, 40), vec3(247, 127, 0), vec3(252, 191, 73), vec3(190, 210, 110),
                                   vec3(102, 194, 165), vec3(50, 136, 189), vec3(70, 80, 170), vec3(50, 40, 100));

vec3 encode(vec3 color)
{
    color = clamp(color, 0.0, 1.0);
    return mix(1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, 12.92 * color, lessThan(color, vec3(0.0031308)));
}

vec3 levelColor(uint level)
{
    return levelColors[min(level, 7u)] / 255.0;
}

vec3 missingColor(uint missing)
{
    return missing == 1u ? vec3(240, 228, 66) / 255.0 : missing == 2u ? vec3(230, 159, 0) / 255.0 : vec3(213, 94, 0) / 255.0;
}

vec3 identityColor(uint index)
{
    float hue = fract(float(index) * 0.61803399);
    return 0.55 + 0.4 * cos(6.2831853 * (hue + vec3(0.0, 0.33, 0.67)));
}

/* The picture in gray under a color, so that one sees both. */
vec3 cover(vec3 picture, vec3 color)
{
    float gray = dot(picture, vec3(0.3, 0.6, 0.1));
    return mix(vec3(gray), color * (0.6 + 0.4 * gray), push.tint);
}

bool onBorder(vec2 texels, vec2 perPixel, float tileSize)
{
    vec2 away = abs(fract(texels / tileSize + 0.5) - 0.5) * tileSize;
    return any(lessThan(away, perPixel * 0.75));
}

/* Texels of the slots, and how many levels are missing at most. */
vec4 texels[SLOT_COUNT] = vec4[](vec4(1.0), vec4(1.0), vec4(0.5, 0.5, 1.0, 1.0), vec4(1.0), vec4(1.0));
uint missingLevels = 0u;
/* Of the coordinates, taken before masks end pixels. */
vec4 uvsDx, uvsDy;

vec2 turnBySlot(Slot slot, vec4 sets)
{
    vec2 uv = (slot.flags & SLOT_SECOND_UV) != 0u ? sets.zw : sets.xy;
    return vec2(dot(slot.turn.xy, uv), dot(slot.turn.zw, uv));
}

/* In loops, since compilers need long for what a sample is made of. */
void sampleSlots()
{
    [[dont_unroll]] for (uint i = 0u; i < SLOT_COUNT; i++) {
        Slot slot = materials[push.material].slots[i];
        uint missing;
        if (slot.tableIndex == NO_TEXTURE)
            continue;
        texels[i] = sluiceSample(slot.tableIndex, slot.tableIndex, turnBySlot(slot, uvs) + slot.offset,
                                 push.lodBias, push.anisotropy, missing);
        missingLevels = max(missingLevels, missing);
    }
}

void writeSlots()
{
    [[dont_unroll]] for (uint i = 0u; i < SLOT_COUNT; i++) {
        Slot slot = materials[push.material].slots[i];
        if (slot.tableIndex != NO_TEXTURE && (slot.flags & SLOT_WRITES) != 0u)
            sluiceWriteQuadFeedback(slot.tableIndex, turnBySlot(slot, uvs) + slot.offset, turnBySlot(slot, uvsDx),
                                    turnBySlot(slot, uvsDy), push.lodBias, push.anisotropy,
                                    uvec2(gl_FragCoord.xy), push.seed);
    }
}

/* Without tangents in the vertices: Mikkelsen: "Bump Mapping Unparametrized Surfaces on the GPU", 2010. */
vec3 bendNormal(vec3 straight)
{
    Slot slot = materials[push.material].slots[SLOT_NORMAL];
    if (slot.tableIndex == NO_TEXTURE)
        return straight;
    vec3 bent = 2.0 * texels[SLOT_NORMAL].xyz - 1.0;
    bent.xy *= materials[push.material].normalScale;
    bool second = (slot.flags & SLOT_SECOND_UV) != 0u;
    vec3 px = dFdx(position), py = dFdy(position);
    vec2 ux = second ? uvsDx.zw : uvsDx.xy, uy = second ? uvsDy.zw : uvsDy.xy;
    vec3 r1 = cross(py, straight), r2 = cross(straight, px);
    vec3 tangent = r1 * ux.x + r2 * uy.x, bitangent = r1 * ux.y + r2 * uy.y;
    float size = inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-30));
    vec3 sum = (tangent * bent.x - bitangent * bent.y) * size * sign(dot(px, r1)) + straight * bent.z;
    return dot(sum, sum) > 1e-20 ? normalize(sum) : straight;
}

vec4 baseColor()
{
    Material m = materials[push.material];
    if ((m.flags & MATERIAL_MISSING) != 0u) {
        vec2 cell = floor(uvs.xy * 16.0);
        return vec4(mod(cell.x + cell.y, 2.0) < 0.5 ? vec3(0.05) : vec3(0.75, 0.5, 0.05), 1.0);
    }
    return texels[SLOT_COLOR] * m.color;
}

vec3 lit(vec3 color)
{
    Material m = materials[push.material];
    vec2 rough = texels[SLOT_ROUGHNESS].gb * vec2(m.roughness, m.metalness);
    float open = mix(1.0, texels[SLOT_OCCLUSION].r, m.occlusion);
    vec3 emitted = m.emissive.rgb * texels[SLOT_EMISSIVE].rgb;
    vec3 toEye = normalize(push.eye - position);
    vec3 straight = normalize(normal) * (gl_FrontFacing ? 1.0 : -1.0);
    return emitted + shade(color, clamp(rough.y, 0.0, 1.0), clamp(rough.x, 0.0, 1.0), bendNormal(straight),
                           toEye, open);
}

vec3 bordered(vec3 picture, vec3 color, Slot slot, vec2 uv, vec2 dx, vec2 dy, float tileSize)
{
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(slot.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(slot.tableIndex).sizeY);
    bool border = (push.flags & 1u) != 0u && onBorder(uv * size, (abs(dx) + abs(dy)) * size, tileSize);
    return border ? color : picture;
}

/* Views show the color image of a material. */
vec3 show(vec3 picture, Slot slot, bool wrote)
{
    vec2 uv = turnBySlot(slot, uvs) + slot.offset, dx = turnBySlot(slot, uvsDx), dy = turnBySlot(slot, uvsDy);
    if (push.view == VIEW_WRITTEN)
        return wrote ? vec3(1.0, 0.85, 0.2) : picture * 0.35;
    if (push.view == VIEW_MISSING)
        return missingLevels == 0u ? picture : cover(picture, missingColor(missingLevels));
    if (slot.tableIndex == NO_TEXTURE)
        return picture;
    if (push.view == VIEW_IDENTITY)
        return cover(picture, identityColor(slot.tableIndex));
    if (push.view <= 1u)
        return bordered(picture, vec3(1.0, 0.85, 0.2), slot, uv, dx, dy, 128.0);
    SluiceSampling wanted = sluiceResolveSampling(slot.tableIndex, uv, dx, dy, push.lodBias, push.anisotropy);
    SluiceSampling here = sluiceResolveSampling(slot.tableIndex, uv, dx * 1e-5, dy * 1e-5, 0.0, 1.0);
    if (push.view == VIEW_WANTED)
        return cover(picture, levelColor(wanted.wantedLevel));
    if (push.view == VIEW_CHECKS)
        return here.level == 255u ? vec3(1.0, 0.0, 1.0) : picture;
    return bordered(cover(picture, levelColor(here.level)), vec3(0.05), slot, uv, dx, dy,
                    128.0 * exp2(float(here.level)));
}

void main()
{
    uvsDx = dFdx(uvs);
    uvsDy = dFdy(uvs);
    sampleSlots();
    vec4 base = baseColor();
    vec3 picture = encode(lit(base.rgb));
    bool writes = push.probability > 0.0 &&
                  sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, push.seed, push.probability);
    if (push.view > 1u || push.flags != 0u)
        picture = show(picture, materials[push.material].slots[SLOT_COLOR], writes);
#ifdef MASKED
    if (base.a < materials[push.material].emissive.w)
        discard;
#endif
    outColor = vec4(picture, base.a);
    if (writes)
        writeSlots();
}
