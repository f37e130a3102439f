/*
 * Buffers of the gallery's shaders, and lighting of its surfaces. Included by the entry points. Set
 * 0 is the streamer's; set 1 has the textures of a surface.
 */
#ifndef GALLERY_GLSL
#define GALLERY_GLSL

#include "gallery_shared.h"
#define SLUICE_SET 0
#include "sluice/bindings.glsl"

layout(set = 2, binding = GALLERY_BINDING_FRAME, std430) readonly buffer Frame { GalleryFrame frame; };
layout(set = 2, binding = GALLERY_BINDING_LIGHTS, std430) readonly buffer Lights { GalleryLight lights[]; };
layout(set = 2, binding = GALLERY_BINDING_COUNTS, std430) buffer Counts { GalleryCounts counts; };

layout(push_constant) uniform Draw { GalleryDraw draw; };

vec3 toVec3(float v[3])
{
    return vec3(v[0], v[1], v[2]);
}

/** Light of one lamp on a surface point; x: diffuse, y: shine of varnish. */
vec2 lampLight(GalleryLight lamp, vec3 position, vec3 normal, vec3 toEye, float shine)
{
    vec3 toLamp = toVec3(lamp.position) - position;
    float squared = dot(toLamp, toLamp);
    vec3 l = toLamp * inversesqrt(squared);
    float cone = clamp((dot(-l, toVec3(lamp.direction)) - lamp.cosOuter) /
                       (lamp.cosInner - lamp.cosOuter), 0.0, 1.0);
    float strength = cone * cone * (3.0 - 2.0 * cone) * 6.6 / squared;
    float diffuse = max(dot(normal, l), 0.0) * strength;
    if (shine == 0.0 || diffuse == 0.0)
        return vec2(diffuse, 0.0);
    float facing = max(dot(normal, normalize(l + toEye)), 0.0);
    facing *= facing;
    facing *= facing;
    facing *= facing;
    facing *= facing;
    facing *= facing;
    return vec2(diffuse, strength * shine * facing);
}

/** Light from the skylight and the walls, less in the corners. */
float ambientLight(vec3 position, vec3 normal)
{
    vec3 size = toVec3(frame.roomSize);
    vec3 distances = vec3(0.5 * size.x - abs(position.x), min(position.y, size.y - position.y),
                          min(-position.z, size.z + position.z));
    vec3 open = distances / (distances + 0.28);
    vec3 facing = abs(normal); /* a plane does not shade itself */
    vec3 shade = mix(open, vec3(1.0), max(facing, vec3(0.35)));
    float above = normal.y > 0.0 ? 0.50 + 0.20 * normal.y : 0.50 + 0.12 * normal.y;
    return above * shade.x * shade.y * shade.z;
}

vec3 lightSurface(vec3 albedo, vec3 position, vec3 normal, float shine)
{
    vec3 toEye = normalize(toVec3(frame.eye) - position);
    vec3 diffuse = vec3(0.93, 0.98, 1.05) * ambientLight(position, normal);
    vec3 specular = vec3(0.0);
    const vec3 lamp = vec3(1.08, 1.0, 0.88);
    for (int i = 0; i < GALLERY_LIGHTS_PER_DRAW; i++) {
        if (draw.lights[i] == GALLERY_NO_TEXTURE)
            continue;
        vec2 light = lampLight(lights[draw.lights[i]], position, normal, toEye, shine);
        diffuse += lamp * light.x;
        specular += lamp * light.y;
    }
    return albedo * diffuse + specular;
}

/** Applies a film-like curve and sRGB encoding. Any input gives a valid color. */
vec3 develop(vec3 color)
{
    color = mix(color, vec3(0.0), isnan(color));
    color = clamp(color, vec3(0.0), vec3(1.0e4)) * 0.82;
    color = clamp(color * (2.51 * color + 0.03) / (color * (2.43 * color + 0.59) + 0.14), 0.0, 1.0);
    return mix(1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, 12.92 * color,
               lessThan(color, vec3(0.0031308)));
}

#endif
