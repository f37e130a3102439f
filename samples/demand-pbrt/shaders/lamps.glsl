/* Lights that are no shapes and not infinitely large. */
#ifndef PBRT_LAMPS_GLSL
#define PBRT_LAMPS_GLSL

#define FAR 1.0e30

/** Light of a lamp at a point, without shadow; false if it is no lamp. */
bool lampAt(uint i, vec3 at, out vec3 toward, out float distance, out vec3 color)
{
    uint kind = lights[i].kind;
    color = toVector(lights[i].color);
    toward = toVector(lights[i].direction);
    distance = FAR;
    if (kind == 0u)
        return true;
    if (kind > 2u)
        return false;
    vec3 way = toVector(lights[i].position) - at;
    distance = length(way);
    toward = way / max(distance, 1.0e-30);
    color /= max(distance * distance, 1.0e-30);
    if (kind == 2u) {
        float c = dot(-toward, toVector(lights[i].direction));
        float f = clamp((c - lights[i].cosOuter) /
                            max(lights[i].cosInner - lights[i].cosOuter, 1.0e-6), 0.0, 1.0);
        color *= (launch.flags & PBRT_LAUNCH_VERSION_4) != 0u ? f * f * (3.0 - 2.0 * f)
                                                               : f * f * f * f;
    }
    return true;
}

/** What a preview shows of a surface as if it were matt. */
vec3 previewColor(Payload s)
{
    vec3 color = s.diffuse;
    if (s.kind == PBRT_SURFACE_MIRROR || s.kind == PBRT_SURFACE_GLASS)
        color += 0.5 * (s.specular + s.transmission);
    return color;
}

float highlight(Payload s, vec3 direction, vec3 normal, vec3 toward)
{
    float exponent = clamp(2.0 / max(s.roughness * s.roughness, 1.0e-4), 2.0, 1000.0);
    return pow(max(dot(reflect(direction, normal), toward), 0.0), exponent);
}

/** Lamps without shadows, and some light from everywhere. The sky comes in addition. */
vec3 shadePreview(Payload s, vec3 at, vec3 direction, vec3 normal)
{
    vec3 albedo = previewColor(s);
    vec3 light = s.emission + 0.4 * albedo;
    for (uint i = 0u; i < launch.lightCount; i++) {
        vec3 toward, color;
        float distance;
        if (!lampAt(i, at, toward, distance, color) || dot(normal, toward) <= 0.0)
            continue;
        light += albedo * color * dot(normal, toward);
        if (s.kind == PBRT_SURFACE_GLOSSY)
            light += s.specular * color * highlight(s, direction, normal, toward);
    }
    if ((launch.flags & PBRT_LAUNCH_HEADLIGHT) != 0u)
        light += 0.6 * albedo * abs(dot(normal, direction));
    return light;
}

#endif
