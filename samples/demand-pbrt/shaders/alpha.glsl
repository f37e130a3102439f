/* Cut-outs by alpha. */
#ifndef PBRT_ALPHA_GLSL
#define PBRT_ALPHA_GLSL

uint hashWord(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/** Returns a number in [0, 1) that depends only on the ray. */
float hashRay(vec3 origin, vec3 direction)
{
    uvec3 o = floatBitsToUint(origin), d = floatBitsToUint(direction);
    uint h = hashWord(o.x);
    h = hashWord(h ^ o.y);
    h = hashWord(h ^ o.z);
    h = hashWord(h ^ d.x);
    h = hashWord(h ^ d.y);
    h = hashWord(h ^ d.z);
    return float(h >> 8) / 16777216.0;
}

/** Returns whether alpha lets the ray through. pbrt-v3 does so where alpha is exactly 0; pbrt-v4
 * stops rays with probability alpha. */
bool cutsOut(float alpha, vec3 origin, vec3 direction)
{
    if ((launch.flags & PBRT_LAUNCH_VERSION_4) == 0u)
        return alpha == 0.0;
    return alpha < 1.0 && hashRay(origin, direction) >= alpha;
}

#endif
