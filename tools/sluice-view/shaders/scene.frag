#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require

/* Early tests keep hidden pixels from writing feedback. Masked pixels are discarded later, so they cannot use these
 * tests. */
#ifndef MASKED
layout(early_fragment_tests) in;
#endif
layout(constant_id = 0) const bool paged = false;
#define SLUICE_PAGED paged
#define SLUICE_SET 0
#define SLUICE_FEEDBACK_IN_TURNS
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "scene_push.glsl"
#undef SLUICE_FEEDBACK_TURN_WORD
#define SLUICE_FEEDBACK_TURN_WORD(i) (feedbackBy() == BY_TURNS ? sluiceFeedbackTurnWords[i] : 0xFFFFFFFFu)
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"

#include "scene_material.glsl"
#include "scene_digits.glsl"
#include "view_colors.glsl"
#include "scene_marks.glsl"
#include "scene_light.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 uvs;
layout(location = 0) out vec4 outColor;

vec3 encode(vec3 color)
{
    color = clamp(color, 0.0, 1.0);
    return mix(1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, 12.92 * color, lessThan(color, vec3(0.0031308)));
}

vec3 decode(vec3 color)
{
    return mix(pow((color + 0.055) / 1.055, vec3(2.4)), color / 12.92, lessThanEqual(color, vec3(0.04045)));
}

/* Mixes the gray picture with a color, so that both are visible. */
vec3 cover(vec3 picture, vec3 color)
{
    float gray = dot(picture, vec3(0.3, 0.6, 0.1));
    return mix(vec3(gray), color * (0.6 + 0.4 * gray), push.tint);
}

bool onBorder(vec2 texels, vec2 perPixel, vec2 tileSize)
{
    vec2 away = abs(fract(texels / tileSize + 0.5) - 0.5) * tileSize;
    return any(lessThan(away, perPixel * 0.75));
}

/* Texels of the slots, and the largest number of missing levels. */
vec4 texels[SLOT_COUNT] = vec4[](vec4(1.0), vec4(1.0), vec4(0.5, 0.5, 1.0, 1.0), vec4(1.0), vec4(1.0));
uint missingLevels = 0u, missingSlot = 0u;
/* Derivatives of the UVs, taken before masks discard pixels. */
vec4 uvsDx, uvsDy;

vec2 turnBySlot(Slot slot, vec4 sets)
{
    vec2 uv = (slot.flags & SLOT_SECOND_UV) != 0u ? sets.zw : sets.xy;
    return vec2(dot(slot.turn.xy, uv), dot(slot.turn.zw, uv));
}

/* Returns the LOD bias of a sample. Rounding of the sampler never reaches a level finer than the finest allowed one. */
float biasOf(uint tableIndex, vec2 dx, vec2 dy)
{
    uint finest = push.flags >> FINEST_SHIFT & FINEST_MASK;
    if (finest == 0u)
        return push.lodBias;
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    float lod = sluiceComputeLod(dx * size, dy * size, 0.0, push.anisotropy);
    return max(push.lodBias, float(finest) - lod + sluiceLodMargin(push.anisotropy) + 1.0 / 64.0);
}

/* Samples the center of one texel of one level, where bilinear filtering mixes in no other texel. */
vec4 sampleNearest(uint tableIndex, vec2 uv, float bias, out uint missing)
{
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dFdx(uv), dFdy(uv), bias, 1.0);
    missing = sluiceMissingLevels(s);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_FALLBACK_COLOR;
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    uint level = min(max(uint(max(s.lod + 0.5, 0.0)), s.level), entry.mipLevelCount - 1u);
    vec2 size = vec2(max(uvec2(entry.sizeX, entry.sizeY) >> level, uvec2(1u)));
    return sluiceSampleAtLevel(tableIndex, tableIndex, level, (floor(s.uv * size) + 0.5) / size);
}

/* Samples all slots. The loop is not unrolled, since compilers take long for each sample. */
void sampleSlots()
{
    [[dont_unroll]] for (uint i = 0u; i < SLOT_COUNT; i++) {
        Slot slot = materials[push.material].slots[i];
        uint missing;
        if (slot.tableIndex == NO_TEXTURE)
            continue;
        vec2 uv = turnBySlot(slot, uvs) + slot.offset;
        float bias = biasOf(slot.tableIndex, turnBySlot(slot, uvsDx), turnBySlot(slot, uvsDy));
        texels[i] = (push.flags & FLAG_NEAREST) != 0u
                        ? sampleNearest(slot.tableIndex, uv, bias, missing)
                        : sluiceSample(slot.tableIndex, slot.tableIndex, uv, bias, push.anisotropy, missing);
        if (missing > missingLevels) {
            missingLevels = missing;
            missingSlot = i;
        }
    }
}

bool isSelected()
{
    if (!(push.probability > 0.0))
        return false;
    if (feedbackBy() == BY_QUADS)
        return sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, push.seed, push.probability);
    return feedbackBy() != BY_LATTICE || sluiceSelectFragmentLattice(gl_FragCoord.xy, push.seed);
}

bool slotWrites(Slot slot)
{
    uint writing = (push.flags & FLAG_NO_SETS) != 0u ? SLOT_WRITES | SLOT_WRITES_ALONE : SLOT_WRITES;
    return slot.tableIndex != NO_TEXTURE && (slot.flags & writing) != 0u && sluiceTakesPart(slot.tableIndex);
}

bool anySlotWrites()
{
    bool any = false;
    [[dont_unroll]] for (uint i = 0u; i < SLOT_COUNT; i++)
        any = any || slotWrites(materials[push.material].slots[i]);
    return any;
}

/* Writes feedback of all slots. With BY_QUADS, the pixels of a quad share the work. */
void writeSlots()
{
    [[dont_unroll]] for (uint i = 0u; i < SLOT_COUNT; i++) {
        Slot slot = materials[push.material].slots[i];
        if (!slotWrites(slot))
            continue;
        vec2 uv = turnBySlot(slot, uvs) + slot.offset, dx = turnBySlot(slot, uvsDx), dy = turnBySlot(slot, uvsDy);
        float bias = biasOf(slot.tableIndex, dx, dy);
        if (feedbackBy() != BY_QUADS)
            sluiceWriteFeedback(slot.tableIndex, uv, dx, dy, bias, push.anisotropy);
        else
            sluiceWriteQuadFeedback(slot.tableIndex, uv, dx, dy, bias, push.anisotropy, uvec2(gl_FragCoord.xy),
                                    push.seed);
    }
}

/* Applies the normal map without tangents. Mikkelsen: "Bump Mapping Unparametrized Surfaces on the GPU", 2010. */
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

/* A point of a slot's image, with derivatives. */
struct Place {
    vec2 uv, dx, dy, size; // size: texels of level 0
};

Place placeOf(Slot slot)
{
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(slot.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(slot.tableIndex).sizeY);
    return Place(turnBySlot(slot, uvs) + slot.offset, turnBySlot(slot, uvsDx), turnBySlot(slot, uvsDy), size);
}

uint markOf(Slot slot, Place at)
{
    return markAt(slot.flags >> SLOT_IMAGE_SHIFT, uvec2(fract(at.uv) * at.size));
}

/* Draws column and row of the tile into its upper left corner. 28 points of the font are as wide as a tile. */
bool onNumber(vec2 texels, vec2 tileSize)
{
    vec2 tile = floor(texels / tileSize), at = fract(texels / tileSize) * 28.0 - 1.5;
    if (any(lessThan(at, vec2(0.0))) || at.y >= 13.0)
        return false;
    bool below = at.y >= 7.0;
    return numberAt(uint(below ? tile.y : tile.x), uvec2(at.x, below ? at.y - 7.0 : at.y));
}

vec3 bordered(vec3 picture, vec3 color, Slot slot, Place at, float level)
{
    if ((push.flags & FLAG_BORDERS) == 0u)
        return picture;
    vec2 tileSize = vec2(markTileSize(slot.flags >> SLOT_IMAGE_SHIFT)) * exp2(level);
    vec2 perPixel = (abs(at.dx) + abs(at.dy)) * at.size, pixels = tileSize / perPixel;
    if (min(pixels.x, pixels.y) < 4.0) /* borders would hide the picture */
        return picture;
    bool numbered = (push.flags & FLAG_NUMBERS) != 0u && min(pixels.x, pixels.y) >= 28.0;
    return onBorder(at.uv * at.size, perPixel, tileSize) ||
                   (numbered && onNumber(fract(at.uv) * at.size, tileSize))
               ? color
               : picture;
}

/* Returns true on the edge of an image with a side that is not a power of two. */
bool onOddEdge(Place at)
{
    uvec2 size = uvec2(at.size + 0.5);
    vec2 away = abs(fract(at.uv + 0.5) - 0.5), perPixel = abs(at.dx) + abs(at.dy);
    return any(notEqual(size & (size - 1u), uvec2(0u))) && any(lessThan(away, perPixel * 1.5));
}

/* Returns texels of level 0 per pixel, along the shorter side of the pixel's footprint. */
float densityOf(Place at)
{
    vec2 x = at.dx * at.size, y = at.dy * at.size;
    return sqrt(min(dot(x, x), dot(y, y)));
}

vec3 patterned(vec3 color, uint reason)
{
    return markPattern(reason, uvec2(gl_FragCoord.xy)) ? color * 0.12 : color;
}

vec3 showMissing(vec3 picture)
{
    Slot slot = materials[push.material].slots[missingSlot];
    if (slot.tableIndex == NO_TEXTURE)
        return picture;
    Place at = placeOf(slot);
    if (missingLevels == 0u)
        return densityOf(at) < 0.5 && markReason(markOf(slot, at)) == MARK_NOTHING
                   ? cover(picture, markPattern(MARK_FINEST, uvec2(gl_FragCoord.xy)) ? vec3(0.34, 0.71, 0.91) : picture)
                   : picture;
    return patterned(cover(picture, missingColor(missingLevels)), markReason(markOf(slot, at)));
}

vec3 showAge(vec3 picture, Slot slot, Place at)
{
    uint word = markOf(slot, at);
    if ((word & MARK_THRASHES) != 0u)
        return patterned(vec3(1.0, 0.0, 1.0), MARK_FAILED);
    return cover(picture, ageColor(markAge(word)));
}

/* Draws a view of the material's color image. Mixes encoded colors, like the legends. */
vec3 show(vec3 picture, Slot slot, bool wrote)
{
    if (push.view == VIEW_WRITTEN)
        return wrote ? vec3(1.0, 0.85, 0.2) : picture * 0.35;
    if (push.view == VIEW_MISSING)
        return showMissing(picture);
    if (slot.tableIndex == NO_TEXTURE)
        return picture;
    if (push.view == VIEW_IDENTITY)
        return onOddEdge(placeOf(slot)) ? vec3(1.0)
                                        : cover(picture, identityColor(slot.flags >> SLOT_IMAGE_SHIFT));
    Place at = placeOf(slot);
    if (push.view == VIEW_AGE)
        return showAge(picture, slot, at);
    if (push.view <= 1u)
        return bordered(picture, vec3(1.0, 0.85, 0.2), slot, at, 0.0);
    SluiceSampling wanted =
        sluiceResolveSampling(slot.tableIndex, at.uv, at.dx, at.dy, biasOf(slot.tableIndex, at.dx, at.dy),
                              push.anisotropy);
    SluiceSampling here =
        sluiceResolveSampling(slot.tableIndex, at.uv, at.dx * 1e-5, at.dy * 1e-5, 0.0, 1.0);
    if (push.view == VIEW_WANTED)
        return cover(picture, levelColor(wanted.wantedLevel));
    if (push.view == VIEW_CHECKS)
        return here.level == 255u ? vec3(1.0, 0.0, 1.0) : cover(picture, densityColor(densityOf(at)));
    return bordered(cover(picture, levelColor(here.level)), vec3(0.05), slot, at, float(here.level));
}

void main()
{
    uvsDx = dFdx(uvs);
    uvsDy = dFdy(uvs);
    sampleSlots();
    vec4 base = baseColor();
    vec3 picture = lit(base.rgb);
    bool writes = isSelected();
    if (push.view > 1u || (push.flags & FLAG_BORDERS) != 0u)
        picture = decode(show(encode(picture), materials[push.material].slots[SLOT_COLOR], writes && anySlotWrites()));
#ifdef MASKED
    if (base.a < materials[push.material].emissive.w && (push.flags & FLAG_NO_ALPHA_TEST) == 0u)
        discard;
    base.a = 1.0;
#endif
    outColor = vec4(clamp(picture, 0.0, 1.0), base.a);
    if (writes)
        writeSlots();
}
