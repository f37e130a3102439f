/* Infinite lights. Include programs.glsl before. */
#ifndef PBRT_SKY_GLSL
#define PBRT_SKY_GLSL

/** Maps a direction to a square like pbrt-v4's EqualAreaSphereToSquare: Clarberg, "Fast Equal-Area
 * Mapping of the (Hemi)Sphere using SIMD", 2008. */
vec2 equalAreaSquare(vec3 d)
{
    float x = abs(d.x), y = abs(d.y), z = abs(d.z);
    float r = sqrt(max(1.0 - z, 0.0)), a = max(x, y), b = a == 0.0 ? 0.0 : min(x, y) / a;
    float phi = atan(b) * 2.0 / PI;
    phi = x < y ? 1.0 - phi : phi;
    float v = phi * r, u = r - v;
    if (d.z < 0.0) {
        float swap = u;
        u = 1.0 - v;
        v = 1.0 - swap;
    }
    return (vec2(d.x < 0.0 ? -u : u, d.y < 0.0 ? -v : v) + 1.0) * 0.5;
}

vec2 skyCoordinates(uint light, vec3 direction)
{
    vec3 d = normalize(applyRows(lights[light].worldToLight, direction, 0.0));
    if (lights[light].skyLayout == 1u)
        return equalAreaSquare(d);
    return vec2(atan(d.y, d.x) / (2.0 * PI), acos(clamp(d.z, -1.0, 1.0)) / PI);
}

/** Returns the light from infinity. `spread`: cone angle in radians; from 7 on, the mean. Sets
 * `resident` to false if texels of a picture are missing. */
vec3 skyLight(vec3 direction, float spread, inout bool resident)
{
    vec3 sum = toVector(launch.background);
    for (uint i = 0u; i < launch.lightCount; i++) {
        if (lights[i].kind != 3u)
            continue;
        vec3 color = toVector(lights[i].color);
        if (lights[i].texture != PBRT_NONE) {
            bool here;
            float width = spread >= 7.0 ? 1.0e9 : spread / PI;
            vec4 texel = sluiceDemandGrad(lights[i].texture, skyCoordinates(i, direction),
                                          vec2(0.5 * width, 0.0), vec2(0.0, width), here);
            resident = resident && here;
            color *= texel.rgb;
        }
        sum += color;
    }
    return sum;
}

#endif
