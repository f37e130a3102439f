/* Converts the film of a traced scene to a picture, like the PNG files of demand-pbrt, and draws a view over it. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "../../../samples/demand-pbrt/pbrt_shared.h"
#include "../traced_shared.h"
#include "view_colors.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 0) readonly buffer Sums
{
    vec4 sums[]; /* sums of complete samples; w: their number */
};
layout(std430, set = 0, binding = 1) readonly buffer Latest
{
    vec4 latest[]; /* the last sample; w: 1 if something was missing */
};
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D picture;
layout(std430, set = 0, binding = 3) readonly buffer Probes
{
    PbrtProbe probes[];
};
layout(std430, set = 0, binding = 4) readonly buffer Views
{
    TracedView views[];
};
layout(std430, set = 0, binding = 5) readonly buffer Tiles
{
    uvec2 tiles[]; /* hash map: page, and age in the layout of marks */
};
layout(std430, set = 0, binding = 6) readonly buffer Pictures
{
    uint pictures[]; /* per texture: 1 + picture << 1, | 1 if a side is not a power of two; 0: unknown */
};

layout(push_constant) uniform Push
{
    uint width, height;
    float scale, tint;
    uint view;
    uint launch;       /* last launch that traced rays; 0: none in this frame */
    uint tileMask;     /* entries of `tiles` - 1 */
    uint pictureCount; /* entries of `pictures` */
    uint isShort;      /* 1: memory is short, and the loader has a LOD bias */
}
push;

vec3 encode(vec3 x)
{
    return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
}

/* Replaces infinite and undefined numbers, which would spread in the window's filter. */
float clean(float x)
{
    return isnan(x) ? 0.0 : clamp(x, 0.0, 1.0);
}

/* Same function as cover in scene.frag. */
vec3 cover(vec3 under, vec3 color)
{
    float gray = dot(under, vec3(0.3, 0.6, 0.1));
    return mix(vec3(gray), color * (0.6 + 0.4 * gray), push.tint);
}

vec3 patterned(vec3 color, uint reason, uvec2 at)
{
    return markPattern(reason, at) ? color * 0.12 : color;
}

/* Draws view 3. Yellow, at pixels without a texture: a shape or a material is missing. */
vec3 showMissing(vec3 color, uint pixel, uvec2 at)
{
    TracedView v = views[pixel];
    bool lacks = latest[pixel].w > 0.0;
    vec3 gray = vec3(dot(color, vec3(0.3, 0.6, 0.1)));
    color = mix(color, gray, push.tint);
    if (v.texture == PBRT_NONE || v.state != TRACED_OPEN)
        return lacks ? mix(color, vec3(240.0, 228.0, 66.0) / 255.0, push.tint) : color;
    uint missing = v.resident > v.wanted ? v.resident - v.wanted : lacks ? 1u : 0u;
    if (missing == 0u)
        return color;
    uint reason = lacks ? MARK_COMING : push.isShort != 0u ? MARK_BUDGET : MARK_NOTHING;
    return patterned(mix(color, missingColor(missing), push.tint), reason, at);
}

vec3 showAge(vec3 color, uint page, uvec2 at)
{
    uint slot = (page * 0x9e3779b1u) & push.tileMask;
    while (tiles[slot].x != page && tiles[slot].x != PBRT_NONE)
        slot = (slot + 1u) & push.tileMask;
    if (tiles[slot].x != page)
        return color;
    if ((tiles[slot].y & MARK_THRASHES) != 0u)
        return patterned(vec3(1.0, 0.0, 1.0), MARK_FAILED, at);
    return cover(color, ageColor(float(tiles[slot].y >> 16) / 16.0));
}

vec3 showIdentity(vec3 color, PbrtProbe probe, TracedView v)
{
    uint word = probe.texture < push.pictureCount ? pictures[probe.texture] : 0u;
    if (word == 0u)
        return color;
    vec2 at = vec2(v.uv[0], v.uv[1]), away = min(at, 1.0 - at);
    vec2 perPixel = abs(vec2(probe.dx[0], probe.dx[1])) + abs(vec2(probe.dy[0], probe.dy[1]));
    if ((word & 1u) != 0u && any(lessThan(away, perPixel * 1.5)))
        return vec3(1.0);
    return cover(color, identityColor((word >> 1) - 1u));
}

vec3 show(vec3 color, uint pixel, uvec2 at)
{
    TracedView v = views[pixel];
    if (push.view == VIEW_WRITTEN)
        return push.launch != 0u && probes[pixel].launch == push.launch ? vec3(1.0, 0.85, 0.2) : color * 0.35;
    if (push.view == VIEW_MISSING)
        return showMissing(color, pixel, at);
    if (v.texture == PBRT_NONE)
        return color;
    if (push.view == VIEW_IDENTITY)
        return showIdentity(color, probes[pixel], v);
    if (push.view == VIEW_CHECKS)
        return v.state != TRACED_OPEN ? vec3(1.0, 0.0, 1.0) : cover(color, densityColor(v.density));
    if (v.state != TRACED_OPEN)
        return color;
    if (push.view == VIEW_WANTED)
        return cover(color, levelColor(v.wanted));
    if (push.view == VIEW_RESIDENT)
        return cover(color, levelColor(v.resident));
    return push.view == VIEW_AGE ? showAge(color, v.page, at) : color;
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= push.width || at.y >= push.height)
        return;
    uint pixel = at.y * push.width + at.x;
    vec3 light = sums[pixel].w > 0.0 ? sums[pixel].rgb / sums[pixel].w : latest[pixel].rgb;
    light *= push.scale;
    vec3 color = encode(vec3(clean(light.r), clean(light.g), clean(light.b)));
    if (push.view > 1u)
        color = show(color, pixel, at);
    imageStore(picture, ivec2(at), vec4(color, 1.0));
}
