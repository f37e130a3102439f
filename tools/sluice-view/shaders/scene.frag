#version 460
#extension GL_GOOGLE_include_directive : require

layout(early_fragment_tests) in;
layout(constant_id = 0) const bool paged = false;
#define SLUICE_PAGED paged
#define SLUICE_SET 0
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"
#include "scene_push.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 outColor;

const uint NO_TEXTURE = 0xFFFFFFFFu;
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

vec3 show(vec3 picture, vec2 dx, vec2 dy, bool wrote)
{
    if (push.view == VIEW_IDENTITY)
        return cover(picture, identityColor(push.tableIndex));
    if (push.view == VIEW_WRITTEN)
        return wrote ? vec3(1.0, 0.85, 0.2) : picture * 0.35;
    SluiceSampling wanted = sluiceResolveSampling(push.tableIndex, uv, dx, dy, push.lodBias, push.anisotropy);
    SluiceSampling here = sluiceResolveSampling(push.tableIndex, uv, dx * 1e-5, dy * 1e-5, 0.0, 1.0);
    if (push.view == VIEW_WANTED)
        return cover(picture, levelColor(wanted.wantedLevel));
    if (push.view == VIEW_MISSING)
        return wanted.missing == 0u ? picture : cover(picture, missingColor(wanted.missing));
    if (push.view == VIEW_CHECKS)
        return here.level == 255u ? vec3(1.0, 0.0, 1.0) : picture;
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(push.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(push.tableIndex).sizeY);
    bool border = (push.flags & 1u) != 0u && onBorder(uv * size, (abs(dx) + abs(dy)) * size, 128.0 * exp2(float(here.level)));
    return border ? vec3(0.05) : cover(picture, levelColor(here.level));
}

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    float light = 0.55 + 0.45 * abs(dot(normalize(normal), normalize(vec3(0.35, 0.8, 0.5))));
    if (push.tableIndex == NO_TEXTURE) {
        outColor = vec4(encode(push.color.rgb * light), 1.0);
        return;
    }
    uint missing;
    vec4 texel = sluiceSample(push.tableIndex, push.tableIndex, uv, push.lodBias, push.anisotropy, missing);
    bool writes = push.probability > 0.0 &&
                  sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, push.seed, push.probability);
    vec3 picture = encode(texel.rgb * push.color.rgb * light);
    if (push.view > 1u)
        picture = show(picture, dx, dy, writes);
    else if ((push.flags & 1u) != 0u) {
        vec2 size = vec2(SLUICE_TEXTURE_ENTRY(push.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(push.tableIndex).sizeY);
        if (onBorder(uv * size, (abs(dx) + abs(dy)) * size, 128.0))
            picture = vec3(1.0, 0.85, 0.2);
    }
    outColor = vec4(picture, 1.0);
    if (writes)
        sluiceWriteQuadFeedback(push.tableIndex, uv, dx, dy, push.lodBias, push.anisotropy, uvec2(gl_FragCoord.xy), push.seed);
}
