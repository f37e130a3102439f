/* The nearest surface: asks for its alpha, then for its material, then for their texels. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

#include "demand.glsl"
#include "scene.glsl"
#include "hit.glsl"
#include "programs.glsl"
#include "sluice/proxy.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;
hitAttributeEXT vec2 weights;

/** Also tells how sharp its pictures have to be. */
void requestSurface(uint surface, Hit hit)
{
    float lod = sluiceDemandComputeLod(hit.dx, hit.dy, 1.0);
    atomicMax(wanted[surface], 1u + uint(clamp(ceil(-lod), 0.0, 30.0)));
    sluiceRequestMaterialProxy(launch.surfacePage, surface);
    payload.missing = true;
}

vec3 emissionOf(PbrtPlace place, Hit hit)
{
    bool front = dot(hit.face, gl_WorldRayDirectionEXT) < 0.0;
    if ((place.flags & PBRT_PLACE_EMITS) == 0u ||
        (!front && (place.flags & PBRT_PLACE_TWO_SIDED) == 0u))
        return vec3(0.0);
    return toVector(lights[place.light].color);
}

void main()
{
    PbrtPlace place = places[gl_InstanceCustomIndexEXT];
    float width = payload.coneWidth + payload.coneSpread * gl_HitTEXT;
    Hit hit = findHit(place, gl_PrimitiveID, weights, gl_WorldRayDirectionEXT, width,
                      gl_ObjectToWorldEXT, gl_WorldToObjectEXT);
    used[gl_InstanceCustomIndexEXT] = launch.launchIndex;
    payload.distance = gl_HitTEXT;
    payload.normal = hit.normal;
    payload.face = hit.face;
    payload.place = gl_InstanceCustomIndexEXT;
    payload.triangle = gl_PrimitiveID;
    payload.kind = 0u;
    payload.emission = emissionOf(place, hit);
    payload.density =
        (place.flags & PBRT_PLACE_LISTED) != 0u ? lights[place.light].density : 0.0;
    payload.diffuse = PROXY_MATERIAL_COLOR;
    payload.specular = payload.transmission = vec3(0.0);

    /* Alpha first: 0. Then diffuse, specular, transmission. */
    vec3 values[4];
    bool resident = true;
    for (uint i = place.alpha == PBRT_NONE ? 1u : 0u; i < 4u && resident; i++) {
        uint surface = i == 0u ? place.alpha : place.surface;
        Hit seen = i == 0u ? withoutFootprint(hit) : hit;
        if (i > 0u && payload.isShadow)
            return;
        if (surfaces[surface].realized == 0u) {
            requestSurface(surface, seen);
            return;
        }
        uint program = i <= 1u ? surfaces[surface].diffuse
                               : i == 2u ? surfaces[surface].specular : surfaces[surface].transmission;
        values[i] = runProgram(program, seen, resident);
    }
    if (!resident) {
        payload.missing = true;
        return;
    }
    payload.diffuse = clamp(values[1], 0.0, 1.0);
    payload.specular = clamp(values[2], 0.0, 1.0);
    payload.transmission = clamp(values[3], 0.0, 1.0);
    payload.kind = surfaces[place.surface].kind;
    payload.roughness = surfaces[place.surface].roughness;
    payload.eta = surfaces[place.surface].eta;
}
