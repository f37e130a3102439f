/* Lights that paths sample: all except infinite ones. */
#ifndef PBRT_LAMPS_GLSL
#define PBRT_LAMPS_GLSL

#define FAR 1.0e30

/** Light of a lamp at a point, without shadows. Returns false if light `i` is no lamp. */
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

/** Weight of one sampling technique beside another that finds the same light: power heuristic with
 * exponent 2 (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo
 * Rendering", 1995). Arguments are probabilities per solid angle. */
float weightOf(float found, float other)
{
    float ratio = other / max(found, 1.0e-30);
    return 1.0 / (1.0 + ratio * ratio);
}

/** Probability per solid angle of a sampled point on an emitter. */
float emitterChance(float density, float distance, float cosine)
{
    return density * distance * distance / max(cosine, 1.0e-20);
}

/** Returns the last emitter whose `below` is at most `chosen`. */
uint findEmitter(float chosen)
{
    uint least = 0u, most = launch.emitterCount;
    while (most - least > 1u) {
        uint middle = (least + most) / 2u;
        if (emitters[middle].below <= chosen)
            least = middle;
        else
            most = middle;
    }
    return least;
}

/**
 * Light from a random point on the emitting shapes, without shadows. Returns false if no light
 * reaches `at`. `color` is divided by the point's probability, and weighted against a diffuse
 * bounce that finds the same point.
 */
bool emitterAt(vec3 chosen, vec3 at, vec3 normal, out vec3 toward, out float distance,
               out vec3 color)
{
    if (launch.emitterCount == 0u)
        return false;
    uint i = findEmitter(chosen.x);
    uint light = emitters[i].light;
    float root = sqrt(chosen.y);
    vec3 way = toVector(emitters[i].corner) +
               root * (1.0 - chosen.z) * toVector(emitters[i].side1) +
               root * chosen.z * toVector(emitters[i].side2) - at;
    distance = length(way);
    toward = way / max(distance, 1.0e-30);
    float cosine = -dot(toVector(emitters[i].outside), toward);
    if (emitters[i].isTwoSided != 0u)
        cosine = abs(cosine);
    float here = dot(normal, toward);
    if (cosine <= 0.0 || here <= 0.0 || distance <= 0.0)
        return false;
    float chance = emitterChance(lights[light].density, distance, cosine);
    color = toVector(lights[light].color) / chance * weightOf(chance, here / PI);
    return true;
}

/** Diffuse color of a surface in previews. Mirrors and glass appear matte. */
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

/** Shades with lamps without shadows and some ambient light. The caller adds the sky. */
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
