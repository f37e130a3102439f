/*
 * Evaluates a ray's hit on a triangle or a box. The nearest hit requests whatever it lacks. Include
 * demand.glsl, scene.glsl, hit.glsl, programs.glsl and alpha.glsl before, and declare `Payload
 * payload`.
 */
#ifndef PBRT_SURFACE_GLSL
#define PBRT_SURFACE_GLSL

#include "sluice/proxy.glsl"

/** A ray that meets a triangle. */
struct Meeting {
    uint place, triangle;
    vec2 weights; /* barycentric weights of the second and third corner */
    float distance;
    vec3 origin, direction; /* ray in world space */
    mat4x3 objectToWorld, worldToObject;
};

Hit hitOf(Meeting m)
{
    return findHit(places[m.place], m.triangle, m.weights, m.direction,
                   payload.coneWidth + payload.coneSpread * m.distance, m.objectToWorld,
                   m.worldToObject);
}

/** Requests a surface, and tells how many texels per unit of uv its pictures need. */
void requestSurface(uint surface, Hit hit)
{
    float lod = sluiceDemandComputeLod(hit.dx, hit.dy, 1.0);
    atomicMax(wanted[surface], 1u + uint(clamp(ceil(-lod), 0.0, 30.0)));
    sluiceRequestMaterialProxy(launch.surfacePage, surface);
    payload.missing = true;
}

vec3 emissionOf(PbrtPlace place, Hit hit, vec3 direction)
{
    bool front = dot(hit.face, direction) < 0.0;
    if ((place.flags & PBRT_PLACE_EMITS) == 0u ||
        (!front && (place.flags & PBRT_PLACE_TWO_SIDED) == 0u))
        return vec3(0.0);
    return toVector(lights[place.light].color);
}

void describeHit(Meeting m, PbrtPlace place, Hit hit)
{
    used[m.place] = launch.launchIndex;
    payload.distance = m.distance;
    payload.normal = hit.normal;
    payload.face = hit.face;
    payload.place = m.place;
    payload.triangle = m.triangle;
    payload.kind = 0u;
    payload.emission = emissionOf(place, hit, m.direction);
    payload.density =
        (place.flags & PBRT_PLACE_LISTED) != 0u ? lights[place.light].density : 0.0;
    payload.diffuse =
        (launch.flags & PBRT_LAUNCH_GRAY) != 0u ? vec3(0.5) : PROXY_MATERIAL_COLOR;
    payload.specular = payload.transmission = vec3(0.0);
}

void describeSurface(uint surface, vec3 values[4])
{
    payload.diffuse = clamp(values[1], 0.0, 1.0);
    payload.specular = clamp(values[2], 0.0, 1.0);
    payload.transmission = clamp(values[3], 0.0, 1.0);
    payload.kind = surfaces[surface].kind;
    payload.roughness = surfaces[surface].roughness;
    payload.eta = surfaces[surface].eta;
}

/**
 * Evaluates a hit. The nearest surface requests its alpha, then its material, then their texels.
 *
 * With `isCandidate` the hit is a candidate on the ray's way. The function then returns whether the
 * ray passes through a hole. SLUICE_DEMAND_QUIET must be true: a candidate whose alpha is not
 * resident counts as solid, and requests its alpha only once it is the nearest hit. So nothing
 * behind another surface is requested.
 *
 * One function serves both cases because compilers inline programs at each call.
 */
bool meetTriangle(Meeting m, bool isCandidate)
{
    PbrtPlace place = places[m.place];
    Hit hit = hitOf(m);
    uint probed = isCandidate ? PBRT_NONE : payload.triangle;
    if (!isCandidate)
        describeHit(m, place, hit);
    if (preview && probed != PBRT_NONE)
        probes[probed].texture = PBRT_NONE;
    /* Index 0 is alpha. 1 to 3 are diffuse, specular and transmission. */
    vec3 values[4] = vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    bool resident = true, known = false;
    values[0] = vec3(place.alphaValue);
    for (uint i = place.alpha == PBRT_NONE ? 1u : 0u; i < (isCandidate ? 1u : 4u) && resident; i++) {
        uint surface = i == 0u ? place.alpha : place.surface;
        Hit seen = hit;
        if (i == 0u)
            seen = withoutFootprint(hit);
        else if (payload.isShadow)
            return false;
        if (surfaces[surface].realized == 0u) {
            if (!isCandidate)
                requestSurface(surface, seen);
            return false;
        }
        uint program = i <= 1u ? surfaces[surface].diffuse
                               : i == 2u ? surfaces[surface].specular : surfaces[surface].transmission;
        probedPixel = i == 0u ? PBRT_NONE : probed;
        values[i] = runProgram(program, seen, resident);
        probed = i == 0u ? probed : probedPixel;
        known = i > 0u;
    }
    if (isCandidate)
        return resident && cutsOut(values[0].x, m.origin, m.direction);
    if (resident || (preview && known))
        describeSurface(place.surface, values);
    if (!resident)
        payload.missing = true;
    return false;
}

#endif
