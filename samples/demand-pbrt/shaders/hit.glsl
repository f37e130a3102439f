/* Hit of a ray on a mesh triangle, and the pixel's footprint there. */
#ifndef PBRT_HIT_GLSL
#define PBRT_HIT_GLSL

#include "sluice/ray_footprint.glsl"

struct Hit {
    vec3 position, face, normal; /* world space; `face` and `normal` have length 1 */
    vec2 uv, dx, dy;
    vec3 px, py; /* axes of the pixel's footprint, world space */
};

/** Reads the uv of the corners. Without uvs they are (0, 0), (1, 0) and (1, 1). */
void readUvs(PbrtMesh mesh, Words words, uvec3 corner, out vec2 uv[3])
{
    uv[0] = vec2(0.0);
    uv[1] = vec2(1.0, 0.0);
    uv[2] = vec2(1.0);
    if (mesh.uvs != 0u)
        for (uint i = 0u; i < 3u; i++)
            uv[i] = readPair(words, mesh.uvs + 2u * corner[i]);
}

vec3 shadingNormal(PbrtPlace place, PbrtMesh mesh, Words words, uvec3 corner, vec3 weights,
                   mat4x3 worldToObject, vec3 face)
{
    if (mesh.normals == 0u)
        return face;
    vec3 n = weights.x * readVector(words, mesh.normals + 3u * corner.x) +
             weights.y * readVector(words, mesh.normals + 3u * corner.y) +
             weights.z * readVector(words, mesh.normals + 3u * corner.z);
    n = (n * worldToObject).xyz;
    float square = dot(n, n);
    if (!(square > 0.0))
        return face;
    n *= inversesqrt(square);
    return (place.flags & PBRT_PLACE_NEGATED) != 0u ? -n : n;
}

/** Computes the axes of the cone's footprint on the triangle's plane, in world space. */
void coverPlane(vec3 face, vec3 direction, float width, out vec3 px, out vec3 py)
{
    vec3 a = direction - dot(face, direction) * face;
    if (dot(a, a) < 1.0e-8)
        a = cross(face, abs(face.x) > 0.5 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0));
    a *= inversesqrt(max(dot(a, a), 1.0e-30)) * width;
    px = a / max(abs(dot(direction, face)), SLUICE_RAY_LEAST_COSINE);
    py = cross(face, a);
}

Hit findHit(PbrtPlace place, uint triangle, vec2 weights, vec3 direction, float width,
            mat4x3 objectToWorld, mat4x3 worldToObject)
{
    PbrtMesh mesh = meshes[place.mesh];
    Words words = Words(uvec2(mesh.address[0], mesh.address[1]));
    uint first = mesh.indices + 3u * triangle;
    uvec3 corner = uvec3(words.at[first], words.at[first + 1u], words.at[first + 2u]);
    vec3 p[3];
    vec2 uv[3];
    for (uint i = 0u; i < 3u; i++)
        p[i] = objectToWorld * vec4(readVector(words, 3u * corner[i]), 1.0);
    readUvs(mesh, words, corner, uv);
    vec3 w = vec3(1.0 - weights.x - weights.y, weights);
    SluiceRayTriangle t = sluiceFindRayTriangle(p[0], p[1], p[2], uv[0], uv[1], uv[2]);
    Hit hit;
    hit.position = w.x * p[0] + w.y * p[1] + w.z * p[2];
    hit.face = (place.flags & PBRT_PLACE_REVERSED) != 0u ? -t.normal : t.normal;
    hit.normal = shadingNormal(place, mesh, words, corner, w, worldToObject, hit.face);
    if (dot(hit.face, hit.normal) < 0.0)
        hit.face = -hit.face; /* the file's normals decide which side is the front */
    hit.uv = w.x * uv[0] + w.y * uv[1] + w.z * uv[2];
    coverPlane(hit.face, direction, width, hit.px, hit.py);
    hit.dx = sluiceUvAlong(t, hit.px);
    hit.dy = sluiceUvAlong(t, hit.py);
    return hit;
}

/** Removes the footprint for alpha, which both versions of pbrt look up in the finest level. */
Hit withoutFootprint(Hit hit)
{
    hit.dx = hit.dy = vec2(0.0);
    hit.px = hit.py = vec3(0.0);
    return hit;
}

#endif
