/*
 * Paths of light, one ray at a time. The caller finds the hits:
 *
 *     for (Path path = startPath(...); !path.done;)
 *         if (path.toSun)
 *             endSunRay(path, true if nothing is in its way);
 *         else
 *             meetSurface(path, nearest hit, bounces);
 */
#ifndef TRACER_PATH_GLSL
#define TRACER_PATH_GLSL

#define PI 3.14159265
#define SUN_DIRECTION normalize(vec3(-0.62, 0.52, 0.46))
#define SUN_LIGHT vec3(4.9, 3.9, 2.7) /* irradiance of a surface that faces the sun */
#define SUN_SPREAD 0.02               /* radians; spread of shadow rays */
#define DIFFUSE_SPREAD 0.35           /* after a diffuse bounce: detail does not matter */
#define HAZE_DISTANCE 70.0

/** Random numbers in [0, 1) from the pixel, the sample and the count of numbers drawn before. */
struct Random {
    uint pixel, index, drawn;
};

uint hash(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/** Draws two numbers. Samples of a pixel are spread evenly: Roberts' R2 sequence, shifted per pixel
 * and use. */
vec2 random2(inout Random r)
{
    r.drawn++;
    uint h = hash(r.pixel * 0x9e3779b1u ^ hash(r.drawn));
    vec2 shift = vec2(float(h >> 8), float(hash(h) >> 8)) / 16777216.0;
    return fract(shift + float(r.index) * vec2(0.7548776662, 0.5698402910));
}

vec3 skyLight(vec3 direction)
{
    float up = max(direction.y, 0.0);
    vec3 sky = mix(vec3(0.60, 0.76, 0.98), vec3(0.05, 0.19, 0.62), pow(up, 0.45));
    float toSun = max(dot(direction, SUN_DIRECTION), 0.0);
    sky += vec3(1.0, 0.72, 0.42) * (0.35 * pow(toSun, 8.0) + 0.6 * pow(toSun, 64.0));
    return direction.y < 0.0 ? mix(sky, vec3(0.22, 0.20, 0.15), min(-direction.y * 6.0, 1.0)) : sky;
}

/** Ambient light, reduced for average occlusion. */
vec3 ambientLight(vec3 normal)
{
    return mix(vec3(0.28, 0.25, 0.20), vec3(0.52, 0.60, 0.72), 0.5 + 0.5 * normal.y) * 0.6;
}

vec3 cosineDirection(vec3 normal, vec2 u)
{
    vec3 side = normalize(abs(normal.x) > 0.5 ? vec3(normal.y, -normal.x, 0.0)
                                              : vec3(0.0, normal.z, -normal.y));
    float angle = 2.0 * PI * u.x, radius = sqrt(u.y);
    return normalize(radius * (cos(angle) * side + sin(angle) * cross(normal, side)) +
                     sqrt(max(1.0 - u.y, 0.0)) * normal);
}

/** Highlight of the sun: a lobe around the mirrored direction. */
float highlight(Surface s, vec3 direction)
{
    float along = max(dot(reflect(direction, s.normal), SUN_DIRECTION), 0.0);
    return 14.0 * pow(along, 320.0);
}

struct Path {
    vec3 origin, direction; /* next ray to trace */
    SluiceRayCone cone;
    bool toSun; /* true: a shadow ray, ended by any hit */
    bool done;
    bool complete; /* all textures on the way were resident */
    vec3 light;    /* so far */
    vec3 share;    /* throughput: factor for light found later */
    vec3 sunLight; /* light to add if the ray to the sun is free */
    vec3 nextOrigin, nextDirection; /* ray after the one to the sun */
    SluiceRayCone nextCone;
    uint depth;
    Random random;
};

Path startPath(vec3 origin, vec3 direction, float spread, Random random)
{
    Path path;
    path.origin = origin;
    path.direction = direction;
    path.cone = SluiceRayCone(0.0, spread);
    path.toSun = false;
    path.done = false;
    path.complete = true;
    path.light = vec3(0.0);
    path.share = vec3(1.0);
    path.depth = 0u;
    path.random = random;
    return path;
}

void continuePath(inout Path path, uint bounces)
{
    path.toSun = false;
    path.done = path.depth++ == bounces;
    path.origin = path.nextOrigin;
    path.direction = path.nextDirection;
    path.cone = path.nextCone;
}

void endSunRay(inout Path path, bool isFree, uint bounces)
{
    if (isFree)
        path.light += path.sunLight;
    continuePath(path, bounces);
}

/** Sunlight on a surface. Leaves let light through, in another color. */
vec3 sunOn(Surface s, vec3 direction, float fresnel)
{
    float facing = dot(s.normal, SUN_DIRECTION);
    if ((s.flags & TRACER_CUT_OUT) == 0u)
        return SUN_LIGHT * step(0.0, facing) *
               (s.albedo * facing + fresnel * highlight(s, direction));
    return SUN_LIGHT * s.albedo *
           (facing > 0.0 ? vec3(0.75 * facing) : -0.55 * facing * vec3(1.15, 1.1, 0.55));
}

/** Offsets the origin from the face, to the side of `direction`. */
vec3 leave(Surface s, vec3 at, vec3 direction)
{
    return at + sign(dot(s.face, direction)) * (2e-4 + 1e-4 * s.distance) * s.face;
}

/** Sets the next ray: mirrored with probability `fresnel`, else diffuse. */
void scatter(inout Path path, Surface s, vec3 at, float fresnel, uint bounces)
{
    vec2 u = random2(path.random), lobe = random2(path.random);
    bool mirrored = lobe.x < fresnel;
    vec3 next = mirrored ? reflect(path.direction, s.normal) : cosineDirection(s.normal, u);
    next -= 2.0 * min(dot(next, s.face), 0.0) * s.face;
    if (!mirrored)
        path.share *= s.albedo;
    if (path.depth == bounces)
        path.light += path.share * (mirrored ? skyLight(next) : ambientLight(s.normal));
    path.nextDirection = next;
    path.nextOrigin = leave(s, at, next);
    path.nextCone = SluiceRayCone(s.cone.width, mirrored ? s.cone.spread : DIFFUSE_SPREAD);
}

void meetSurface(inout Path path, Surface s, uint bounces)
{
    if (s.distance < 0.0) {
        path.light += path.share * skyLight(path.direction);
        path.done = true;
        return;
    }
    if (path.depth == 0u) {
        float clear = exp(-s.distance / HAZE_DISTANCE);
        vec3 haze = skyLight(normalize(vec3(path.direction.x, 0.03, path.direction.z)));
        path.light += (1.0 - clear) * haze;
        path.share *= clear;
    }
    vec3 at = path.origin + path.direction * s.distance;
    float facing = clamp(-dot(path.direction, s.normal), 0.0, 1.0);
    bool glossy = (s.flags & TRACER_GLOSSY) != 0u;
    float fresnel = glossy ? 0.04 + 0.96 * pow(1.0 - facing, 5.0) : 0.0;
    path.sunLight = path.share * sunOn(s, path.direction, fresnel);
    scatter(path, s, at, fresnel, bounces);
    if (path.sunLight == vec3(0.0) && s.complete) {
        continuePath(path, bounces);
        return;
    }
    path.toSun = true;
    path.origin = leave(s, at, SUN_DIRECTION);
    path.direction = SUN_DIRECTION;
    path.cone = SluiceRayCone(s.cone.width, SUN_SPREAD);
}

#endif
