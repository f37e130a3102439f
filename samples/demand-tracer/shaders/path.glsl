/*
 * Paths of light. Who includes this has defined
 *     Surface traceNearest(vec3 origin, vec3 direction, Cone cone)
 *     bool traceSun(vec3 origin, vec3 direction, Cone cone, inout bool complete)
 */
#ifndef TRACER_PATH_GLSL
#define TRACER_PATH_GLSL

#define PI 3.14159265
#define SUN_DIRECTION normalize(vec3(-0.62, 0.52, 0.46))
#define SUN_LIGHT vec3(4.9, 3.9, 2.7) /* that a surface gets which faces it */
#define SUN_SPREAD 0.02               /* radians: of shadow rays */
#define DIFFUSE_SPREAD 0.35           /* after a diffuse bounce detail does not matter */
#define HAZE_DISTANCE 70.0

/** Numbers of [0, 1) that depend on pixel, sample and how many were drawn before. */
struct Random {
    uint pixel, index, drawn;
};

uint hash(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/** Samples of a pixel are spread evenly: Roberts' R2 sequence, shifted for each pixel and use. */
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
    vec3 sky = mix(vec3(0.68, 0.80, 0.95), vec3(0.07, 0.21, 0.60), pow(up, 0.45));
    float toSun = max(dot(direction, SUN_DIRECTION), 0.0);
    sky += vec3(1.0, 0.72, 0.42) * (0.35 * pow(toSun, 8.0) + 0.6 * pow(toSun, 64.0));
    return direction.y < 0.0 ? mix(sky, vec3(0.22, 0.20, 0.15), min(-direction.y * 6.0, 1.0)) : sky;
}

/** What comes from all around where nothing stands in the way; some does. */
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

/** Of the sun: a lobe around the mirrored direction, as bright as its width lets it be. */
float highlight(Surface s, vec3 direction)
{
    float along = max(dot(reflect(direction, s.normal), SUN_DIRECTION), 0.0);
    return 14.0 * pow(along, 320.0);
}

vec3 sunOn(Surface s, vec3 at, vec3 direction, float fresnel, inout bool complete)
{
    float facing = dot(s.normal, SUN_DIRECTION);
    bool thin = (s.flags & TRACER_CUT_OUT) != 0u;
    float share = thin ? (facing > 0.0 ? 0.75 * facing : -0.55 * facing) : max(facing, 0.0);
    vec3 origin = at + s.face * (dot(s.face, SUN_DIRECTION) < 0.0 ? -1.0 : 1.0) * (2e-4 + 1e-4 * s.distance);
    if (share <= 0.0 || !traceSun(origin, SUN_DIRECTION, Cone(s.coneWidth, SUN_SPREAD), complete))
        return vec3(0.0);
    vec3 tint = thin && facing < 0.0 ? s.albedo * vec3(1.15, 1.1, 0.55) : s.albedo;
    return SUN_LIGHT * (tint * share + fresnel * highlight(s, direction));
}

/** `complete` becomes false where any of its textures was not resident. */
vec3 tracePath(vec3 origin, vec3 direction, Cone cone, uint bounces, inout Random random,
               inout bool complete)
{
    vec3 light = vec3(0.0), share = vec3(1.0);
    for (uint depth = 0u;; depth++) {
        Surface s = traceNearest(origin, direction, cone);
        complete = complete && s.complete;
        if (s.distance < 0.0)
            return light + share * skyLight(direction);
        vec3 at = origin + direction * s.distance;
        float haze = depth == 0u ? 1.0 - exp(-s.distance / HAZE_DISTANCE) : 0.0;
        light += share * haze * skyLight(normalize(vec3(direction.x, 0.03, direction.z)));
        share *= 1.0 - haze;

        bool glossy = (s.flags & TRACER_GLOSSY) != 0u;
        float facing = clamp(-dot(direction, s.normal), 0.0, 1.0);
        float fresnel = glossy ? 0.04 + 0.96 * pow(1.0 - facing, 5.0) : 0.0;
        vec2 u = random2(random), lobe = random2(random);
        light += share * sunOn(s, at, direction, fresnel, complete);
        bool mirrored = lobe.x < fresnel;
        vec3 next = mirrored ? reflect(direction, s.normal) : cosineDirection(s.normal, u);
        if (dot(next, s.face) < 0.0)
            next -= 2.0 * dot(next, s.face) * s.face;
        if (!mirrored)
            share *= s.albedo;
        if (depth == bounces)
            return light + share * (mirrored ? skyLight(next) : ambientLight(s.normal));
        origin = at + s.face * (2e-4 + 1e-4 * s.distance);
        direction = next;
        cone = Cone(s.coneWidth, mirrored ? cone.spread : DIFFUSE_SPREAD);
    }
}

#endif
